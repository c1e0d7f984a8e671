//! Does another run, or another seed, give other picks?
//!
//! Intervals are taken over runs: runs that repeat one another look like certainty. A strategy whose picks do not change
//! from pass to pass, since it lists its lights or has no choice, leaves nothing to chance and may repeat itself.

use super::calls::{choices, count_different};
use super::check::Check;
use super::subject::Subject;
use crate::base::random::RunKey;
use crate::strategy::Frame;

/// The check's name.
pub(super) const ANOTHER: &str = "another-seed";

/// Independent runs that are compared, each with every other: twice as many as go in a pattern of four.
const RUNS: u32 = 8;

/// Passes of each at each receiver: few, and where these leave less to chance than [`SURE`] asks, many.
const PASSES: [u32; 2] = [8, 64];

/// Where two honest runs would be the same with a greater chance than this, they cannot be told from copies.
const SURE: f64 = 1e-9;

/// Runs that are the same, pick for pick, in all passes at all receivers.
pub(super) fn another(subject: &Subject<'_>) -> Check {
    let seed = subject.options.seed;
    let frame = subject.receivers;
    for passes in PASSES {
        let picks = |key| choices(subject.sampler, Frame::new(frame, key), frame, 0..passes);
        let first = picks(subject.key(0));
        let chance = same_by_chance(&first, passes as usize);
        if chance == 1.0 {
            return Check::new(
                ANOTHER,
                0.0,
                0.0,
                "picks do not change from pass to pass: nothing is left to chance".into(),
            );
        }
        if chance > SURE {
            continue;
        }
        let mut runs: Vec<Vec<u64>> = (1..RUNS).map(|run| picks(subject.key(run))).collect();
        runs.insert(0, first);
        runs.push(picks(RunKey { seed: !seed, run: 0 }));
        let pairs = || (0..runs.len()).flat_map(|a| (a + 1..runs.len()).map(move |b| (a, b)));
        let same: Vec<(usize, usize)> = pairs().filter(|&(a, b)| count_different(&runs[a], &runs[b]) == 0).collect();
        let which = same.first().map_or_else(String::new, |&(a, b)| {
            let name = |i| if i < RUNS as usize { format!("run {i}") } else { format!("run 0 of seed {}", !seed) };
            format!("; {} and {}", name(a), name(b))
        });
        let detail =
            format!("pairs of runs, of {}, with the same picks throughout{which}; seed {seed}", pairs().count());
        return Check::new(ANOTHER, same.len() as f64, 0.0, detail);
    }
    Check::new(ANOTHER, 0.0, 0.0, "too little is left to chance to tell runs apart".into())
}

/// The chance that two independent runs are the same, from how often two passes of one run are.
fn same_by_chance(run: &[u64], passes: usize) -> f64 {
    let at_receiver = |calls: &[u64]| {
        let pairs = (1..passes).map(|apart| count_different(&calls[apart..], calls)).sum::<usize>() as f64;
        let alike = 1.0 - pairs / (0.5 * (passes * (passes - 1)) as f64);
        // Numbers that are spread over passes differ more than independent ones: never taken for quite certain.
        alike.max(0.25).powi(passes as i32)
    };
    run.chunks(passes).map(at_receiver).product()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_never_changes_is_the_same_for_certain_and_a_fair_choice_seldom() {
        assert_eq!(same_by_chance(&[3; 32], 8), 1.0);
        let toss: Vec<u64> = (0..32).map(|i| i % 2).collect();
        // Two passes of eight are alike in 12 of 28 pairs.
        let wanted = (12.0f64 / 28.0).powi(32);
        assert!((same_by_chance(&toss, 8) / wanted - 1.0).abs() < 1e-9);
    }
}
