//! Is the exact image the sum over all lights?

use super::geometry::{Geometry, Place};
use super::light::{surely_adds, unshadowed};
use super::path::Path;
use crate::base::random::Stream;
use crate::base::statistics::student_quantile;
use crate::scene::light::{Kind, Light};
use crate::scene::receiver::Receiver;
use crate::verify::check::Check;
use glam::DVec3;

/// The check's name.
pub(super) const SUM: &str = "exact-sum";

/// Most receivers that all lights are summed at, and fewest that tell anything.
const RECEIVERS: usize = 16;
const FEWEST: usize = 2;

/// Extra points on triangles of a receiver and half, here and there.
const POINTS: u32 = 256;
const THEIRS: u32 = 2_048;

/// Share of a sum that silhouettes and rounding may change.
const EDGES: f64 = 1e-3;

/// The sum over receivers of what both say, by the noise that their halves show.
pub(super) fn sum(geometry: &Geometry<'_>, path: &dyn Path, seed: u64, level: f64) -> Check {
    let mut rng = Stream::keyed(&[seed, u64::from_le_bytes(*b"exactsum")]);
    let receivers = path.receivers();
    let (mut rays, mut off, mut total, mut variance, mut looked) = (geometry.rays(), 0.0, 0.0, 0.0, 0usize);
    while looked < RECEIVERS && !receivers.is_empty() {
        let at = &receivers[rng.below(receivers.len())];
        let Some((place, cost)) = geometry.place(at).map(|place| (place, cost(geometry, &place))) else { break };
        if cost > rays {
            break;
        }
        rays -= cost;
        looked += 1;
        let own = halves(geometry, &place, &mut rng);
        let theirs = grey(path, at, seed);
        let [mean_own, mean_theirs] = [own, theirs].map(|[a, b]| 0.5 * (a + b));
        off += mean_theirs - mean_own;
        total += mean_own;
        // The variance of a mean of two is a quarter of the square of their difference, on average.
        variance += [own, theirs].map(|[a, b]| 0.25 * (a - b).powi(2)).iter().sum::<f64>();
    }
    if looked < FEWEST {
        let detail = "not looked at: the lights times the triangles of this scene are too many".into();
        return Check::new(SUM, 0.0, 0.0, detail);
    }
    let error = (variance + (EDGES * total).powi(2)).sqrt();
    let limit = student_quantile(1.0 - 0.5 * level, looked);
    let percent = 100.0 / total.max(1e-30);
    let detail = format!(
        "|t| of the exact sum at {looked} receivers: {:+.3} % off, standard error {:.3} %; seed {seed}",
        percent * off,
        percent * error
    );
    Check::new(SUM, if off == 0.0 { 0.0 } else { (off / error).abs() }, limit, detail)
}

fn grey(path: &dyn Path, at: &Receiver, seed: u64) -> [f64; 2] {
    path.exact(at, THEIRS, seed).map(luminance)
}

/// ITU-R BT.709.
fn luminance(rgb: DVec3) -> f64 {
    rgb.dot(DVec3::new(0.2126, 0.7152, 0.0722))
}

/// How many points a triangle gets, by what its middle could add as a share of all.
fn side(share: f64) -> u32 {
    (f64::from(POINTS) * share).sqrt() as u32 + 1
}

/// The middle of a triangle, by area.
const MIDDLE: [f64; 2] = [4.0 / 9.0, 0.5];

/// What each light that can add something could, about, nothing in between.
fn open<'a>(geometry: &'a Geometry<'_>, place: &'a Place) -> impl Iterator<Item = (&'a Light, f64)> {
    let value = |light: &Light| luminance(unshadowed(light, MIDDLE, place).radiance);
    let adds = |light: &Light, value: f64| value > 0.0 || light.kind() == Kind::Triangle && surely_adds(light, place);
    geometry
        .scene
        .lights()
        .iter()
        .map(move |light| (light, value(light)))
        .filter(move |&(light, value)| adds(light, value))
}

/// Shadow rays that [`halves`] takes.
fn cost(geometry: &Geometry<'_>, place: &Place) -> usize {
    open(geometry, place).map(|(light, _)| if light.kind() == Kind::Triangle { 2 } else { 1 }).sum::<usize>()
        + 4 * POINTS as usize
}

/// The sum over all lights, with two independent sets of points on triangles.
fn halves(geometry: &Geometry<'_>, place: &Place, rng: &mut Stream) -> [f64; 2] {
    let of_triangles = |(light, value): (&Light, f64)| if light.kind() == Kind::Triangle { value } else { 0.0 };
    let total: f64 = open(geometry, place).map(of_triangles).sum();
    let seen = |light: &Light, uv: [f64; 2]| {
        let own = unshadowed(light, uv, place);
        let value = luminance(own.radiance);
        if value > 0.0 && geometry.free(place, own.from) { value } else { 0.0 }
    };
    let mut sums = [0.0; 2];
    for (light, value) in open(geometry, place) {
        if light.kind() != Kind::Triangle {
            let value = seen(light, MIDDLE);
            sums.iter_mut().for_each(|sum| *sum += value);
            continue;
        }
        let side = side(value / total.max(f64::MIN_POSITIVE));
        for sum in &mut sums {
            let cells = (0..side * side).map(|cell| {
                let [u, v] = rng.uniform2().map(f64::from);
                seen(
                    light,
                    [(f64::from(cell % side) + u) / f64::from(side), (f64::from(cell / side) + v) / f64::from(side)],
                )
            });
            *sum += cells.sum::<f64>() / f64::from(side * side);
        }
    }
    sums
}
