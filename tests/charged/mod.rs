//! Promise: a strategy is charged for all that it starts and waits for, and what it leaves on other threads is found.
//!
//! | file | what it shows |
//! |---|---|
//! | `callers` | every caller that times strategies charges the same |
//! | `units` | whatever a unit starts is on its clock, or found by the clock of the process |
//!
//! The clock of the process must see one test alone: [`alone`] runs them in a process of their own, where each takes one
//! lock.
#![cfg(feature = "measure")]

use std::process::Command;
use std::sync::{Mutex, MutexGuard, PoisonError};

mod callers;
mod units;

#[test]
fn alone() {
    let mut tests = Command::new(std::env::current_exe().expect("this program"));
    tests.args(["promises::charged", "--ignored", "--skip", callers::TAKES_A_MINUTE]);
    let output = tests.output().expect("started");
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success() && said.contains("5 passed"), "{said}");
}

/// Until it is dropped, no other test runs.
pub(crate) fn quiet() -> MutexGuard<'static, ()> {
    static QUIET: Mutex<()> = Mutex::new(());
    QUIET.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Keeps a processor busy.
pub(crate) fn spin(rounds: u64) {
    use std::hint::black_box;
    black_box((0..rounds).fold(1, |x: u64, i| black_box(x.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(i))));
}
