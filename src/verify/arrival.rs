//! Do samplers that are built alike agree, whoever arrives first?
//!
//! A table that is made from the first receiver that comes along depends on the order of the work, which threads decide.
//! So neighbours, who would share such a table, are served in several orders by samplers that are built anew for each.

use super::calls::{choices, count_different};
use super::check::Check;
use crate::base::error::Result;
use crate::base::random::RunKey;
use crate::scene::receiver::Receiver;
use crate::strategy::{AnySampler, Frame};

/// The check's name.
pub(super) const ORDER: &str = "arrival-order";

/// Groups of neighbours, and receivers of each: the stage's list keeps squares of 8 x 8 pixels together.
const GROUPS: usize = 4;
const NEIGHBOURS: usize = 12;

/// Passes at each.
const PASSES: u32 = 2;

/// Calls that differ from those of a sampler that serves the neighbours in order: backwards, after having served
/// `others`; and by two threads at once, each every other of them, one of the two backwards.
pub(super) fn order(
    all: &[Receiver],
    others: &[Receiver],
    seed: u64,
    build: impl Fn() -> Result<Box<dyn AnySampler>>,
) -> Result<Check> {
    let neighbours = neighbours(all);
    let is_other = |at: &&Receiver| neighbours.iter().all(|neighbour| neighbour.pixel != at.pixel);
    let frame: Vec<Receiver> = neighbours.iter().chain(others.iter().filter(is_other)).copied().collect();
    let frame = Frame::new(&frame, RunKey { seed, run: 0 });
    let serve = |sampler: &dyn AnySampler, order: &[usize]| {
        let receivers: Vec<Receiver> = order.iter().map(|&i| neighbours[i]).collect();
        choices(sampler, frame, &receivers, 0..PASSES)
    };
    let forwards: Vec<usize> = (0..neighbours.len()).collect();
    let backwards: Vec<usize> = forwards.iter().rev().copied().collect();
    let wanted = serve(&*build()?, &forwards);

    let sampler = build()?;
    choices(&*sampler, frame, others, 0..1);
    let mut found = vec![(backwards.clone(), serve(&*sampler, &backwards))];

    let sampler = build()?;
    let even: Vec<usize> = forwards.iter().copied().step_by(2).collect();
    let odd: Vec<usize> = backwards.iter().copied().filter(|i| i % 2 == 1).collect();
    let (of_even, of_odd) = std::thread::scope(|scope| {
        let other = scope.spawn(|| serve(&*sampler, &odd));
        let own = serve(&*sampler, &even);
        (own, other.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
    });
    found.extend([(even, of_even), (odd, of_odd)]);

    let passes = PASSES as usize;
    let of = |i: usize| i * passes..(i + 1) * passes;
    let (mut differ, mut first) = (0, None);
    for (order, found) in &found {
        for (place, &i) in order.iter().enumerate() {
            let here = count_different(&wanted[of(i)], &found[of(place)]);
            if here > 0 {
                first.get_or_insert(neighbours[i].pixel);
            }
            differ += here;
        }
    }
    let detail = format!("calls that depend on who arrives first, of {} at neighbours; seed {seed}", 2 * wanted.len());
    Ok(Check::new(ORDER, differ as f64, 0.0, detail).at(first, None))
}

/// A few receivers that follow one another, at a few places of the list.
fn neighbours(all: &[Receiver]) -> Vec<Receiver> {
    let apart = (all.len() / GROUPS).max(NEIGHBOURS);
    all.chunks(apart)
        .take(GROUPS)
        .flat_map(|group| group.iter().skip(group.len() / 2).take(NEIGHBOURS))
        .copied()
        .collect()
}
