//! Progress on stderr, and the wish to stop.

use super::signals;
use super::terminal::{plain, say};
use crate::measure::observer::Observer;
use crate::peers;
use indicatif::{ProgressBar, ProgressStyle};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, mpsc};
use std::time::{Duration, Instant};

/// Shows progress on stderr and stops long work on Ctrl-C, TERM and HUP: the first asks it to stop. A second ends the
/// process, and so does work that has not heard the first after [`PATIENCE`].
pub(super) struct Progress {
    stopped: Arc<AtomicBool>,
    /// What to say where the process is ended: how to go on.
    last_words: Arc<Mutex<String>>,
    stage: Mutex<Shown>,
    scene: Mutex<String>,
}

/// The exit code of a program that was asked to stop.
pub(super) const INTERRUPTED: u8 = 130;

/// How long work may take to hear that it is to stop. What is finished is on disk by then: a process that is ended
/// loses what a killed one does, no more.
const PATIENCE: Duration = Duration::from_secs(3);

impl Progress {
    pub(super) fn new() -> anyhow::Result<Self> {
        let (stopped, last_words) = (Arc::new(AtomicBool::new(false)), Arc::new(Mutex::new(String::new())));
        let wishes = signals::wishes()?;
        let (flag, words) = (Arc::clone(&stopped), Arc::clone(&last_words));
        std::thread::spawn(move || {
            if wishes.recv().is_ok() {
                flag.store(true, Ordering::SeqCst);
                say("\nstopping; what is finished is kept (once more to stop at once)");
                end_after(&wishes, &words);
            }
        });
        let stage = Mutex::new(Shown::Bar(ProgressBar::hidden()));
        Ok(Self { stopped, last_words, stage, scene: Mutex::default() })
    }

    /// What is said last if the process must be ended: how to go on.
    pub(super) fn last_words(&self, text: &str) {
        if let Ok(mut words) = self.last_words.lock() {
            text.clone_into(&mut words);
        }
    }

    /// Names the scene in front of what follows.
    pub(super) fn scene(&self, name: &str) {
        if let Ok(mut scene) = self.scene.lock() {
            name.clone_into(&mut scene);
        }
    }

    fn with(&self, act: impl FnOnce(&mut Shown)) {
        if let Ok(mut stage) = self.stage.lock() {
            act(&mut stage);
        }
    }
}

impl Observer for Progress {
    fn begin(&self, what: &str, total: u64) {
        let what = self.scene.lock().map(|scene| format!("{scene}: {what}")).unwrap_or_default();
        let bar = ProgressBar::new(total);
        if bar.is_hidden() {
            say(&format!("{what}, {total} steps"));
            self.with(|stage| *stage = Shown::Log(Log::new(what, total), Instant::now()));
            return;
        }
        let style = ProgressStyle::with_template("{prefix:>24} {bar:40} {pos}/{len}  {elapsed} (about {eta} left)");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        bar.set_prefix(plain(&what).into_owned());
        bar.enable_steady_tick(Duration::from_millis(200));
        self.with(|stage| *stage = Shown::Bar(bar));
    }

    fn advance(&self, steps: u64) {
        self.with(|stage| match stage {
            Shown::Bar(bar) => bar.inc(steps),
            Shown::Log(log, begun) => {
                if let Some(line) = log.advance(steps, begun.elapsed()) {
                    say(&line);
                }
            }
        });
    }

    fn end(&self) {
        self.with(|stage| {
            if let Shown::Bar(bar) = stage {
                bar.finish_and_clear();
            }
        });
    }

    fn stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }
}

/// Ends the process at a second wish to stop, or when the first has not been heard.
fn end_after(wishes: &mpsc::Receiver<()>, last_words: &Mutex<String>) -> ! {
    // Either way.
    let _ = wishes.recv_timeout(PATIENCE);
    peers::end_all();
    if let Some(words) = last_words.lock().ok().filter(|words| !words.is_empty()) {
        say(&words);
    }
    std::process::exit(INTERRUPTED.into())
}

/// How a stage is shown: on a terminal as a bar, else as lines.
enum Shown {
    Bar(ProgressBar),
    Log(Log, Instant),
}

/// A stage told in lines: one now and then, never so many that they fill a log.
struct Log {
    what: String,
    total: u64,
    done: u64,
    /// When the next line is due, since the stage began.
    next: Duration,
}

/// Between two lines, at least.
const INTERVAL: Duration = Duration::from_secs(10);

/// Lines of a stage, about, if it is longer than that many intervals.
const LINES: u32 = 20;

impl Log {
    fn new(what: String, total: u64) -> Self {
        Self { what, total, done: 0, next: INTERVAL }
    }

    /// A line, if one is due so long after the beginning.
    fn advance(&mut self, steps: u64, elapsed: Duration) -> Option<String> {
        self.done += steps;
        if elapsed < self.next || self.done == 0 || self.done >= self.total {
            return None;
        }
        let whole = elapsed.mul_f64(self.total as f64 / self.done as f64);
        self.next = elapsed + INTERVAL.max(whole / LINES);
        let Self { what, done, total, .. } = self;
        let left = (whole - elapsed).as_secs();
        Some(format!("{what}, {done} of {total} after {} s, about {left} s left", elapsed.as_secs()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The lines of a stage of `total` steps that take so many seconds each.
    fn lines(total: u64, step_s: f64) -> Vec<String> {
        let mut log = Log::new("town: runs".into(), total);
        (1..=total).filter_map(|i| log.advance(1, Duration::from_secs_f64(step_s * i as f64))).collect()
    }

    #[test]
    fn a_log_says_every_ten_seconds_what_is_left() {
        assert_eq!(lines(5, 1.0), Vec::<String>::new(), "short stages are no news");
        assert_eq!(
            lines(35, 1.0),
            [
                "town: runs, 10 of 35 after 10 s, about 25 s left",
                "town: runs, 20 of 35 after 20 s, about 15 s left",
                "town: runs, 30 of 35 after 30 s, about 5 s left"
            ]
        );
    }

    #[test]
    fn a_log_of_hours_has_few_lines() {
        let hours = lines(10_000, 3.6);
        assert!((15..=21).contains(&hours.len()), "{} lines", hours.len());
    }
}
