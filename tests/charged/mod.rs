//! Promise: a strategy is charged for all that it starts and waits for, and what it leaves on other threads is found.
//!
//! | file | what it shows |
//! |---|---|
//! | `callers` | every caller that times strategies charges the same |
//! | `units` | whatever a unit starts is on its clock, or found by the clock of the process |
//!
//! The clock of the process must see one test alone: they run one by one in a process of their own.
use cpu_time::ThreadTime;
use std::hint::black_box;
use std::process::Command;
use std::sync::{Mutex, MutexGuard, PoisonError};

mod callers;
mod units;

/// Is set where these tests have a process to themselves.
const ALONE: &str = "CITYLIGHTS_CHARGED_ALONE";

#[test]
fn in_a_process_of_their_own_these_tests_pass() {
    if std::env::var_os(ALONE).is_some() {
        return;
    }
    let output = Command::new(std::env::current_exe().expect("this program"))
        .args(["promises::charged", "--nocapture"])
        .env(ALONE, "1")
        .output()
        .expect("started");
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success() && said.matches(BEGUN).count() == 6, "{said}");
}

/// What a test says that has the process to itself.
const BEGUN: &str = "alone in this process";

/// The right to look at the clock of the process, for one test at a time; none where other tests run beside it.
pub(crate) fn to_itself() -> Option<MutexGuard<'static, ()>> {
    static ONE: Mutex<()> = Mutex::new(());
    std::env::var_os(ALONE)?;
    let guard = ONE.lock().unwrap_or_else(PoisonError::into_inner);
    println!("{BEGUN}");
    Some(guard)
}

/// Keeps a processor busy for so many CPU seconds of the calling thread. Not for so many rounds: a processor that other tests
/// keep busy too is slower, and the same work then takes more of its time.
pub(crate) fn spin(seconds: f64) {
    let begun = ThreadTime::now();
    while begun.elapsed().as_secs_f64() < seconds {
        black_box(
            (0..1_000u64).fold(1, |x: u64, i| black_box(x.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(i))),
        );
    }
}
