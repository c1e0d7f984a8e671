//! Which lights should the rays of a budget go to: how near is the lecture's heuristic to the best?

use super::measure::{Contender, PIXELS, measure};
use super::scene::several_lights;
use crate::base::error::Result;
use crate::base::random::Stream;
use crate::measure::reference::Reference;
use crate::measure::target::{Target, spread};
use crate::record::study::{Cell, Format, TableRecord};
use crate::record::study_store::StudyWriter;
use crate::render::exact::shadowed;
use crate::scene::light::{Kind, Light};
use crate::scene::receiver::Receiver;
use crate::shading::importance::importance;
use crate::strategies::allocate::Sampler;
use crate::strategy::BuildContext;
use crate::study::cells::cells;
use crate::study::columns::{column, interval, plot};
use crate::study::session::Session;
use crate::visibility::offset::Offset;
use crate::visibility::stage::{LeaveOut, Stage};
use rayon::prelude::*;

/// Points on each triangle by fixed counts: the budgets of the others are what these add up to.
const COUNTS: [u32; 4] = [1, 4, 16, 64];
/// Points that the variance of a light at a receiver is measured by.
const PILOT: u32 = 2048;
const HEURISTIC: &str = "heuristic";
const FIXED: &str = "fixed counts";
const BEST: &str = "optimal";

pub(super) fn table(session: &Session<'_>) -> TableRecord {
    let mut columns = vec![
        column("passes", "points a\ntriangle", Format::Whole),
        column("by", "shared out by", Format::Name),
        column("rays", "rays a\nreceiver", Format::Number),
    ];
    columns.extend(interval("cpu_s_a_receiver", "CPU ns\na receiver", Format::Nanoseconds));
    columns.extend(interval("mse", "MSE", Format::Number));
    columns.extend(interval("gain", "gain over\nfixed", Format::Number));
    columns.extend(interval("distance", "times the\noptimal", Format::Number));
    TableRecord {
        name: "shares".into(),
        title: "which light the rays go to: six lights from a lamp to a sign".into(),
        columns,
        notes: vec![
            format!("{} receivers; independent points; MSE in (cd/m^2)^2, which is what the optimal shares minimise.", session.pixels(PIXELS)),
            "fixed counts: `all`, the same number for each triangle at each receiver; the others have as many points in all. heuristic: solid \
             angle x radiance x albedo, as the lecture has it, made unbiased by Russian roulette (`allocate`)."
                .into(),
            format!(
                "optimal: from the second moment q and variance v of each light at each receiver ({PILOT} points) and one price c for all: \
                 sqrt(q / c) points where that is less than 1, else the whole n from which on one more saves less, v / (n (n + 1)) < c."
            ),
        ],
        plots: vec![plot("shares", "error against rays", "by", ("rays", "rays a receiver"), ("mse", "MSE, (cd/m^2)^2"))],
    }
}

pub(super) fn run(session: &Session<'_>, writer: &mut StudyWriter) -> Result<()> {
    if writer.has("shares", &[], 3 * COUNTS.len()) {
        return Ok(());
    }
    let stage = Stage::new(several_lights(session)?, LeaveOut::Yes, Offset::SCALED);
    let target = Target::of(&stage, spread(stage.receivers(), session.pixels(PIXELS)));
    let receivers: &[Receiver] = &target.frame;
    let reference = Reference::compute(&target, 1e-5, &session.options.cache, session.watch)?;
    let moments: Vec<Vec<Moment>> = receivers.par_iter().map(|at| pilot(&stage, at, session.options.seed)).collect();
    // What fixed counts spend: a point on each triangle that can add anything.
    let facing = receivers.iter().map(|at| triangles(&stage).filter(|light| importance(light, at) > 0.0).count());
    let each = facing.sum::<usize>() as f64 / receivers.len().max(1) as f64;
    let fixed = session
        .options
        .registry
        .parse("all:points=random")?
        .build(BuildContext { stage: &stage, seed: session.options.seed })?;
    let shared: Vec<[Sampler; 2]> = COUNTS
        .into_iter()
        .map(|count| {
            let budget = f64::from(count) * each;
            let table = receivers.iter().map(|at| at.pixel).zip(best(&moments, budget)).collect();
            [Sampler::new(&stage, receivers, budget), Sampler::by_table(&stage, table)]
        })
        .collect();
    let contenders: Vec<Contender<'_>> = COUNTS
        .iter()
        .zip(&shared)
        .flat_map(|(&count, [heuristic, best])| {
            [
                Contender { stage: &stage, sampler: &*fixed, passes: count },
                Contender { stage: &stage, sampler: heuristic, passes: 1 },
                Contender { stage: &stage, sampler: best, passes: 1 },
            ]
        })
        .collect();
    let measured = measure(session, "shares of rays", &contenders, receivers, &reference.truth)?;
    let mut rows = Vec::new();
    for (count, found) in COUNTS.into_iter().zip(measured.chunks_exact(3)) {
        for (by, own) in [FIXED, HEURISTIC, BEST].into_iter().zip(found) {
            let mut row: Vec<Cell> = vec![u64::from(count).into(), by.into(), own.rays.into()];
            row.extend(cells(own.cpu_s));
            row.extend(cells(own.mse()));
            row.extend(cells(found[0].mse_over(own)));
            row.extend(cells(own.mse_over(&found[2])));
            rows.push(row);
        }
    }
    writer.put("shares", &[], rows)
}

/// The triangles, in the stage's order.
fn triangles(stage: &Stage) -> impl Iterator<Item = &Light> {
    let lights = stage.lights().iter().map(|&id| &stage.scene().lights()[id as usize]);
    lights.filter(|light| light.kind() == Kind::Triangle)
}

/// What one point on a light adds: variance and second moment.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Moment {
    variance: f64,
    square: f64,
}

/// Of each triangle, in the stage's order.
fn pilot(stage: &Stage, at: &Receiver, seed: u64) -> Vec<Moment> {
    let mut rng = Stream::keyed(&[seed, u64::from(at.pixel), u64::from_le_bytes(*b"moments\0")]);
    let moment = |light| {
        let (mut sum, mut squares) = (0.0, 0.0);
        for _ in 0..PILOT {
            let x = shadowed(stage, stage.light_sampling(), at, light, rng.uniform2(), &mut 0).element_sum() / 3.0;
            sum += x;
            squares += x * x;
        }
        let (mean, square) = (sum / f64::from(PILOT), squares / f64::from(PILOT));
        Moment { variance: (square - mean * mean).max(0.0), square }
    };
    triangles(stage).map(moment).collect()
}

/// Points of each light at each receiver that leave the least squared error in all, about `budget` of them a receiver.
///
/// A light of whole n >= 1 points leaves v / n, so that one more saves v / (n (n + 1)); one that is met with chance n < 1 leaves q / n - m^2.
fn best(moments: &[Vec<Moment>], budget: f64) -> Vec<Vec<f32>> {
    // Where a point more saves less than `price`.
    let points = |of: &Moment, price: f64| {
        let chance = (of.square / price).sqrt();
        if chance < 1.0 { chance } else { (0.5 + (0.25 + of.variance / price).sqrt()).floor().max(1.0) }
    };
    let total = |price: f64| moments.iter().flatten().map(|of| points(of, price)).sum::<f64>();
    let wanted = budget * moments.len() as f64;
    // Prices by their logarithms: from one that all can pay to one that none can.
    let (mut low, mut high) = (-200.0f64, 200.0f64);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if total(middle.exp2()) > wanted { low = middle } else { high = middle }
    }
    // A light that no point of the pilot met is met now and then.
    let least = 1e-3;
    moments.iter().map(|row| row.iter().map(|of| points(of, high.exp2()).max(least) as f32).collect()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_shares_meet_the_budget_and_no_other_do_better() {
        let moment = |mean: f64, variance: f64| Moment { variance, square: variance + mean * mean };
        let moments = vec![vec![moment(1.0, 4.0), moment(0.1, 0.01)], vec![moment(0.0, 1.0), moment(2.0, 0.0)]];
        let error = |rows: &[Vec<f32>]| -> f64 {
            let each = moments.iter().flatten().zip(rows.iter().flatten());
            each.map(|(of, &n)| {
                let n = f64::from(n);
                if n >= 1.0 { of.variance / n } else { of.square / n - (of.square - of.variance) }
            })
            .sum()
        };
        for budget in [0.5, 1.0, 3.0, 8.0] {
            let rows = best(&moments, budget);
            let total: f32 = rows.iter().flatten().sum();
            assert!((f64::from(total) - 2.0 * budget).abs() <= 1.0, "{budget}: {rows:?}");
            let least = error(&rows);
            let flat: Vec<f32> = rows.iter().flatten().copied().collect();
            for (i, j) in (0..4).flat_map(|i| (0..4).map(move |j| (i, j))).filter(|(i, j)| i != j) {
                // A point moves where both numbers are whole, a part of one where both are chances.
                let part = if flat[i] > 1.0 && flat[j] >= 1.0 { 1.0 } else { 0.01 * flat[i] };
                if part < 1.0 && (flat[i] > 1.0 || flat[j] + part > 1.0) {
                    continue;
                }
                let mut moved = rows.clone();
                moved[i / 2][i % 2] -= part;
                moved[j / 2][j % 2] += part;
                assert!(error(&moved) >= least * (1.0 - 1e-3), "{budget}: {part} from {i} to {j} of {rows:?}");
            }
        }
    }
}
