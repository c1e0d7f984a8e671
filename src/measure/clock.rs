//! What did this thread just spend?

use cpu_time::ThreadTime;
use std::time::Instant;

/// Seconds on this thread's CPU clock and on the wall.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spent {
    /// CPU seconds of this thread.
    pub cpu: f64,
    /// Wall seconds.
    pub wall: f64,
}

impl std::ops::AddAssign for Spent {
    fn add_assign(&mut self, other: Self) {
        self.cpu += other.cpu;
        self.wall += other.wall;
    }
}

/// Runs `work` on this thread and says what it took.
pub fn timed<T>(work: impl FnOnce() -> T) -> (T, Spent) {
    let (cpu, wall) = (ThreadTime::now(), Instant::now());
    let result = work();
    (result, Spent { cpu: cpu.elapsed().as_secs_f64(), wall: wall.elapsed().as_secs_f64() })
}
