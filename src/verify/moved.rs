//! Does a sampler serve the receiver that it was told to arrive at, though its pixel was seen elsewhere before?
//!
//! Where receivers move, a pixel's next pass lies somewhere else. What a strategy keeps of a pixel from one arrival to the
//! next is then of another place.

use super::calls::{choices, count_different};
use super::check::Check;
use super::subject::Subject;
use crate::scene::receiver::Receiver;
use crate::strategy::Frame;

/// The check's name.
pub(super) const MOVED: &str = "moved";

/// Passes at each receiver.
const PASSES: u32 = 2;

/// Calls at receivers that differ from those of a worker which comes there first, where another receiver of the same pixel
/// was served just before. A sampler that looks at whole frames begins each anew, and is not asked.
pub(super) fn moved(subject: &Subject<'_>) -> Check {
    let receivers = subject.receivers;
    let detail = |calls: usize| format!("calls that depend on where their pixel was seen before, of {calls}");
    if subject.sampler.most_passes() == 1 {
        return Check::new(MOVED, 0.0, 0.0, detail(0));
    }
    let (mut differ, mut first) = (0, None);
    for (at, other) in receivers.iter().zip(receivers.iter().cycle().skip(1)) {
        // What a pixel's next pass visits; where receivers stay or that is nowhere, what another pixel sees.
        let next = subject.stage.visits().moves().then(|| subject.stage.visited(at, 1)).flatten();
        let before = next.unwrap_or(Receiver { pixel: at.pixel, ..*other });
        let serve = |receivers: &[Receiver]| {
            choices(subject.sampler, Frame::new(subject.frame, subject.key(0)), receivers, 0..PASSES)
        };
        let (alone, after) = (serve(&[*at]), serve(&[before, *at]));
        let here = count_different(&alone, &after[PASSES as usize..]);
        if here > 0 {
            first.get_or_insert(at.pixel);
        }
        differ += here;
    }
    Check::new(MOVED, differ as f64, 0.0, detail(receivers.len() * PASSES as usize)).at(first, None)
}
