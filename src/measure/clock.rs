//! What time is it, for whom?

use cpu_time::{ProcessTime, ThreadTime};
use std::time::Instant;

/// Reads clocks. Tests put another one in its place; everything else reads [`Cpu`].
pub(crate) trait Clock: Sync {
    /// Seconds that this thread has had a processor.
    fn thread_s(&self) -> f64;
    /// Seconds that all threads of the process have had one, those included that have ended.
    fn process_s(&self) -> f64;
    /// Seconds on the wall, from any beginning.
    fn wall_s(&self) -> f64;
}

/// The clocks of the machine, from when this was made.
pub(crate) struct Cpu(Instant);

impl Cpu {
    /// Begins to count the wall's seconds.
    pub(crate) fn new() -> Self {
        Self(Instant::now())
    }
}

impl Default for Cpu {
    fn default() -> Self {
        Self::new()
    }
}

impl Clock for Cpu {
    fn thread_s(&self) -> f64 {
        ThreadTime::now().as_duration().as_secs_f64()
    }

    fn process_s(&self) -> f64 {
        ProcessTime::now().as_duration().as_secs_f64()
    }

    fn wall_s(&self) -> f64 {
        self.0.elapsed().as_secs_f64()
    }
}

/// Seconds on a thread's CPU clock and on the wall.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Spent {
    /// CPU seconds of the thread.
    pub cpu: f64,
    /// Wall seconds.
    pub wall: f64,
}
