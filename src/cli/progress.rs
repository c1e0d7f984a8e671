//! Progress on stderr, and Ctrl-C.

use super::say;
use crate::measure::observer::Observer;
use indicatif::{ProgressBar, ProgressStyle};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// Shows progress on stderr and stops long work on Ctrl-C: the first asks it to stop, a second ends the process.
pub(super) struct Progress {
    stopped: Arc<AtomicBool>,
    bar: Mutex<ProgressBar>,
    scene: Mutex<String>,
}

impl Progress {
    pub(super) fn new() -> anyhow::Result<Self> {
        let stopped = Arc::new(AtomicBool::new(false));
        let flag = Arc::clone(&stopped);
        ctrlc::set_handler(move || {
            if flag.swap(true, Ordering::SeqCst) {
                std::process::exit(130);
            }
            say("\nstopping; what is finished is kept (once more to stop at once)");
        })?;
        Ok(Self { stopped, bar: Mutex::new(ProgressBar::hidden()), scene: Mutex::default() })
    }

    /// Names the scene in front of what follows.
    pub(super) fn scene(&self, name: &str) {
        if let Ok(mut scene) = self.scene.lock() {
            name.clone_into(&mut scene);
        }
    }

    fn with(&self, act: impl FnOnce(&mut ProgressBar)) {
        if let Ok(mut bar) = self.bar.lock() {
            act(&mut bar);
        }
    }
}

impl Observer for Progress {
    fn begin(&self, what: &str, total: u64) {
        let scene = self.scene.lock().map(|scene| scene.clone()).unwrap_or_default();
        self.with(|bar| {
            *bar = ProgressBar::new(total);
            if bar.is_hidden() {
                // No terminal: a line a stage.
                say(&format!("{scene}: {what}, {total} steps"));
                return;
            }
            let style = ProgressStyle::with_template("{prefix:>24} {bar:40} {pos}/{len}  {elapsed} (about {eta} left)");
            bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
            bar.set_prefix(format!("{scene}: {what}"));
            bar.enable_steady_tick(Duration::from_millis(200));
        });
    }

    fn advance(&self, steps: u64) {
        self.with(|bar| bar.inc(steps));
    }

    fn end(&self) {
        self.with(|bar| bar.finish_and_clear());
    }

    fn stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }
}
