//! What does a sampler pick?

use crate::base::random::hash;
use crate::scene::receiver::Receiver;
use crate::strategy::{AnySampler, Frame, Pick, PickBuffer, blocks};
use std::ops::Range;

/// Shows `take` the picks of each call: the receiver's place in the list, the pass, and what was picked. A receiver's
/// passes come one after the other, in blocks that the sampler can begin together.
///
/// With `points`, those on lights are drawn as the harness draws them; without, only a strategy's own are there.
pub(super) fn visit(
    sampler: &dyn AnySampler,
    frame: Frame<'_>,
    receivers: &[Receiver],
    passes: Range<u32>,
    points: bool,
    mut take: impl FnMut(usize, u32, &[Pick]),
) {
    let mut buffer = PickBuffer::default();
    for block in blocks(sampler, passes) {
        let begun = sampler.begin(frame, block.clone());
        let mut worker = begun.worker(false);
        for (i, at) in receivers.iter().enumerate() {
            worker.fill(std::slice::from_ref(at), block.clone(), points, &mut buffer);
            block.clone().zip(buffer.calls()).for_each(|(pass, call)| take(i, pass, call));
        }
    }
}

/// The picks of each call, by receiver and pass; `points` as in [`visit`].
pub(super) fn calls(
    sampler: &dyn AnySampler,
    frame: Frame<'_>,
    receivers: &[Receiver],
    passes: Range<u32>,
    points: bool,
) -> Vec<Vec<Pick>> {
    let mut calls = vec![Vec::new(); receivers.len() * passes.len()];
    visit(sampler, frame, receivers, passes.clone(), points, |i, pass, call| {
        calls[i * passes.len() + (pass - passes.start) as usize] = call.to_vec();
    });
    calls
}

/// A hash of what each call chooses, by receiver and pass: lights, weights and a strategy's own points. A call may list
/// a million lights.
pub(super) fn choices(
    sampler: &dyn AnySampler,
    frame: Frame<'_>,
    receivers: &[Receiver],
    passes: Range<u32>,
) -> Vec<u64> {
    let mut choices = vec![0; receivers.len() * passes.len()];
    visit(sampler, frame, receivers, passes.clone(), false, |i, pass, call| {
        let pair = |high: u32, low: u32| u64::from(high) << 32 | u64::from(low);
        let words = call.iter().flat_map(|pick| {
            let [u, v] = pick.uv.map(f32::to_bits);
            [pair(pick.light, pick.weight.to_bits()), pair(u, v)]
        });
        choices[i * passes.len() + (pass - passes.start) as usize] = words.fold(0, |state, word| hash(&[state, word]));
    });
    choices
}

/// How many of two lists differ.
pub(super) fn count_different<T: PartialEq>(a: &[T], b: &[T]) -> usize {
    a.iter().zip(b).filter(|(a, b)| a != b).count()
}
