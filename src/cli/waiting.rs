//! Is something said while a step takes long that cannot tell how far it is?

use super::terminal::{plain, say};
use indicatif::{ProgressBar, ProgressStyle};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::Duration;

/// A step that takes no longer is not spoken of.
const SHORT: Duration = Duration::from_secs(1);

/// Between two lines where stderr is no terminal.
const INTERVAL: Duration = Duration::from_secs(10);

/// Does `work` and shows on stderr that `what` goes on if it takes more than a moment: on a terminal with the time that
/// it has taken, else as a line now and then.
pub(super) fn while_long<T>(what: &str, work: impl FnOnce() -> T) -> T {
    std::thread::scope(|scope| {
        let (done, waits) = mpsc::channel::<()>();
        let told = plain(what).into_owned();
        let teller = scope.spawn(move || tell(&told, &waits));
        let result = work();
        drop(done);
        // It has nothing that could fail; the line must be gone before the next is printed.
        let _ = teller.join();
        result
    })
}

/// Tells of `what` until nobody is left who could say that it is done.
fn tell(what: &str, waits: &mpsc::Receiver<()>) {
    let goes_on = |time| waits.recv_timeout(time) == Err(RecvTimeoutError::Timeout);
    if !goes_on(SHORT) {
        return;
    }
    let bar = ProgressBar::new_spinner().with_elapsed(SHORT);
    if bar.is_hidden() {
        say(what);
        for lines in 1.. {
            if !goes_on(INTERVAL) {
                return;
            }
            say(&format!("{what}, for {} s", (SHORT + lines * INTERVAL).as_secs()));
        }
    }
    let style = ProgressStyle::with_template("{prefix}  {elapsed}");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()));
    bar.set_prefix(what.to_owned());
    bar.enable_steady_tick(Duration::from_millis(200));
    // No message is ever sent: this ends with the work.
    let _ = waits.recv();
    bar.finish_and_clear();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_work_is_done_once_and_its_result_given() {
        let mut times = 0;
        assert_eq!(while_long("town: read", || (times += 1, 7)), ((), 7));
        assert_eq!(times, 1);
    }
}
