//! Promise: a strategy is charged for all that it starts and waits for, and what it leaves on other threads is found.
//!
//! | file | what it shows |
//! |---|---|
//! | `callers` | every caller that times strategies charges the same |
//! | `units` | whatever a unit starts is on its clock, or found by the clock of the process |
//!
//! The clock of the process must see one test alone: they run one by one in a process of their own.
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
    // A wrong account is wrong each time; a machine that does other things, and changes its pace meanwhile, is not.
    let said: Vec<String> = (0..3).map_while(alone).collect();
    assert!(said.len() < 3, "{}", said.concat());
}

/// Runs them; what they say, if one fails.
fn alone(_time: u32) -> Option<String> {
    let output = Command::new(std::env::current_exe().expect("this program"))
        .args(["promises::charged", "--nocapture"])
        .env(ALONE, "1")
        .output()
        .expect("started");
    let said = String::from_utf8_lossy(&output.stdout);
    let passed = output.status.success() && said.matches(BEGUN).count() == 5;
    (!passed).then(|| said.into_owned())
}

/// Shares of known work that count as all of it: a third that is on no clock shows, and a processor that changes its pace since other
/// tests run beside does not. On a machine that does nothing else they lie within a hundredth of 1.
const FAIR: std::ops::RangeInclusive<f64> = 0.75..=1.3;

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

/// Keeps a processor busy.
pub(crate) fn spin(rounds: u64) {
    use std::hint::black_box;
    black_box((0..rounds).fold(1, |x: u64, i| black_box(x.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(i))));
}
