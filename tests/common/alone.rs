//! A clock for comparisons that tests run beside one another.

use citylights::measure::clock::{Clock, Cpu};

/// The machine's clocks, but for a process in which nothing else runs: other tests do.
pub(super) struct Alone(Cpu);

impl Alone {
    pub(super) fn new() -> Self {
        Self(Cpu::new())
    }
}

impl Clock for Alone {
    fn thread_s(&self) -> f64 {
        self.0.thread_s()
    }

    fn process_s(&self) -> f64 {
        self.0.thread_s()
    }

    fn wall_s(&self) -> f64 {
        self.0.wall_s()
    }
}
