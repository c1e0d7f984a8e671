//! Which of a stage's receivers are looked at?

use crate::scene::receiver::Receiver;

/// `wanted` of the receivers, in golden-ratio steps, so that no regular street pattern is met in step.
pub(super) fn spread(receivers: &[Receiver], wanted: usize) -> Vec<Receiver> {
    let n = receivers.len();
    if n <= wanted {
        return receivers.to_vec();
    }
    (0..wanted).map(|i| receivers[((0.5 + i as f64 * 0.618_033_988_749_895).fract() * n as f64) as usize]).collect()
}
