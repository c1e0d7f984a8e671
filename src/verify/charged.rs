//! Is a strategy charged for all that it spends?
//!
//! What it leaves running behind a call, and what threads of its own do, is on no worker's clock, but on the process's.

use super::check::Check;

/// The check's name.
const CHARGED: &str = "charged";

/// How far both clocks may be apart: a share of what was spent, and what starting to measure costs, in CPU seconds.
const SHARE: f64 = 0.1;
const START: f64 = 5e-3;

/// Checks CPU seconds charged to a strategy against those that the process spent meanwhile, with nothing else running.
pub(crate) fn charged(charged_s: f64, spent_s: f64) -> Check {
    let detail = format!("CPU seconds between {charged_s:.4} charged and {spent_s:.4} spent by the process");
    Check::new(CHARGED, (spent_s - charged_s).abs(), SHARE * spent_s + START, detail)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_behind_a_call_is_found_and_the_tick_of_a_clock_is_not() {
        assert!(charged(1.0, 1.05).passed && charged(0.0, 0.004).passed);
        assert!(!charged(1.0, 1.2).passed && !charged(1.2, 1.0).passed && !charged(f64::NAN, 1.0).passed);
    }
}
