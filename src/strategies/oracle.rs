//! The best choice of one light: by what each adds here with its shadow ray already cast.
//!
//! Exhaustive, and so never timed: the floor under the error of every strategy that picks a light and leaves the point
//! on it to chance. A triangle is weighed by the root mean square over points on it, the probability of least variance
//! (Rath et al., ACM TOG 39(4), 2020): the more points, the more it would add with nothing in between. They may all be
//! hidden while it is not: `mix` of the picks goes to triangles by what they would add with nothing in between.
//!
//! Strategies that choose points by visibility too, or reuse their neighbours', may lie below it.

use super::parts::target_function::TargetFunction;
use super::parts::weighed::draw;
use crate::base::discrete::Cumulative;
use crate::base::draws::Draws;
use crate::base::error::Result;
use crate::base::random::Stream;
use crate::scene::light::{Kind, LightId};
use crate::scene::receiver::Receiver;
use crate::strategy::{Arguments, BuildContext, Claim, Info, LightSampler, Pick, Picks, Strategy, Tally, Uncounted};

/// About so many points on a triangle that faces a receiver, on average: shared out by what each would add.
const POINTS: f64 = 9.0;

/// Fewest points along each side of a triangle's grid.
const LEAST_SIDE: u32 = 2;

/// One light, with a probability in proportion to what it adds, shadows included.
pub(super) struct Oracle {
    mix: f32,
}

impl Strategy for Oracle {
    const INFO: Info = Info {
        name: "oracle",
        summary: "weighs every light with its shadow ray already cast: the floor of all choice, never timed",
        source: "the integrand itself; Rath et al., ACM TOG 39(4), 2020",
        claim: Claim::Oracle,
    };
    type Sampler = Sampler;

    fn configure(arguments: &mut Arguments<'_>) -> Result<Self> {
        let meaning = "share of the picks that goes to triangles by what they would add with nothing in between";
        // None at all would leave out a triangle whose few points are hidden, and nothing else a lamp; the fewer picks, the
        // greater their weight where a sliver shows after all.
        Ok(Self { mix: arguments.real("mix", 0.1, 0.001..=0.5, meaning)? })
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Sampler> {
        Ok(Sampler { target: TargetFunction::new(context), lights: context.stage.lights().to_vec(), mix: self.mix })
    }
}

/// [`Oracle`] for a scene.
pub(super) struct Sampler {
    target: TargetFunction,
    lights: Vec<LightId>,
    mix: f32,
}

/// The weights of all lights at a receiver.
#[derive(Default)]
pub(super) struct Weighed {
    seen: Vec<f32>,
    open: Vec<f32>,
    sums: Cumulative,
}

impl Sampler {
    /// Weighs every light: a function of the receiver alone.
    fn weigh<T: Tally>(&self, at: &Receiver, weighed: &mut Weighed, tally: &mut T) {
        let Weighed { seen, open, sums } = weighed;
        let pick = |light| Pick { light, weight: 1.0, uv: [0.0; 2] };
        let extended = |light: LightId| self.target.scene().lights()[light as usize].kind() == Kind::Triangle;
        let total = |values: &[f32]| values.iter().map(|&v| f64::from(v)).sum::<f64>();
        open.clear();
        for &light in &self.lights {
            open.push(if extended(light) { self.target.of_light(&pick(light), at, tally) } else { 0.0 });
        }
        let all_open = total(open);
        let points = POINTS * open.iter().filter(|&&whole| whole > 0.0).count() as f64;
        seen.clear();
        for (&light, &whole) in self.lights.iter().zip(open.iter()) {
            seen.push(if !extended(light) {
                self.target.of_visible_point(&pick(light), at, tally)
            } else if whole > 0.0 {
                let side = (points * f64::from(whole) / all_open).sqrt() as u32;
                self.of_grid(light, side.max(LEAST_SIDE), at, tally)
            } else {
                0.0
            });
        }
        let all_seen = total(seen);
        let mix = if all_open > 0.0 { f64::from(self.mix) } else { 0.0 };
        let share = |mix: f64, total: f64| if total > 0.0 { mix / total } else { 0.0 };
        let (by_seen, by_open) = (share(1.0 - mix, all_seen), share(mix, all_open));
        sums.clear();
        for (&seen, &open) in seen.iter().zip(open.iter()) {
            sums.push((by_seen * f64::from(seen) + by_open * f64::from(open)) as f32);
        }
    }

    /// Root mean square over a jittered grid of points on a triangle, shadows included.
    fn of_grid<T: Tally>(&self, light: LightId, side: u32, at: &Receiver, tally: &mut T) -> f32 {
        let step = 1.0 / side as f32;
        let words = [u64::from_le_bytes(*b"oracle's"), u64::from(at.pixel), u64::from(light)];
        let mut stream = Stream::keyed(&words);
        let squares = (0..side * side).map(|cell| {
            let [u, v] = stream.uniform2();
            let uv = [((cell % side) as f32 + u) * step, ((cell / side) as f32 + v) * step];
            let uv = uv.map(|x| x.min(1.0 - f32::EPSILON));
            f64::from(self.target.of_visible_point(&Pick { light, weight: 1.0, uv }, at, tally)).powi(2)
        });
        (squares.sum::<f64>() / f64::from(side * side)).sqrt() as f32
    }
}

impl LightSampler for Sampler {
    type Scratch = Weighed;

    fn arrive<T: Tally>(&self, at: &Receiver, weighed: &mut Weighed, tally: &mut T) {
        self.weigh(at, weighed, tally);
    }

    fn sample<T: Tally>(&self, _at: &Receiver, draws: &mut Draws, weighed: &mut Weighed, out: &mut Picks<'_, T>) {
        draw(&weighed.sums, &self.lights, 1, draws, out);
    }

    fn expected_counts(&self, at: &Receiver, counts: &mut [f32]) -> bool {
        let mut weighed = Weighed::default();
        self.weigh(at, &mut weighed, &mut Uncounted);
        for (index, &light) in self.lights.iter().enumerate() {
            counts[light as usize] += weighed.sums.pmf(index) as f32;
        }
        true
    }

    fn heap_bytes(&self) -> usize {
        size_of_val(&self.lights[..])
    }
}
