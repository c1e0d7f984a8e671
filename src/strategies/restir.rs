//! Reuse of neighbours' choices within a pass: spatial resampling, ReSTIR for direct lighting without its temporal
//! half.
//!
//! Each receiver first chooses one candidate as `resampled` does, the point on the light included. A few receivers near
//! it in the image lend it theirs, and it chooses among them by what each adds here. `combine` is how candidates that
//! could have come from several receivers are weighed:
//!
//! - `pairwise`: each neighbour i shares its part of the frame's work with the receiver c alone. With p the target, at
//!   the receiver named by its index, and k neighbours, a neighbour's candidate y counts `p_i / (k p_i + p_c)` and the
//!   receiver's own the mean over i of `p_c / (k p_i + p_c)`. At any y with p_c > 0 these sum to 1: unbiased.
//! - `1/M`: all count the same. Where a neighbour cannot produce y the sum falls short of 1: dark at edges and shadows.
//!
//! With `visibility=on` a receiver's own candidate is dropped where it is hidden, so that p includes visibility, and
//! `pairwise` tests candidates at both receivers. Who is a neighbour is decided by geometry and random numbers that no
//! candidate depends on.
//!
//! Passes are independent: nothing is reused over time. A history would make them correlated, and the error of the mean
//! would no longer fall with their number, which is what is measured here.
//!
//! Source: Bitterli et al., ACM TOG 39(4), 2020; pairwise weights: Bitterli, thesis, Dartmouth, 2022; Lin et al., ACM
//! TOG 41(4), 2022.

use super::parts::candidates::{Candidates, Pool, Recipe, Value};
use crate::base::draws::{Draws, Sequence};
use crate::base::error::Result;
use crate::base::random::Stream;
use crate::scene::receiver::Receiver;
use crate::strategy::{
    Arguments, BuildContext, Claim, Frame, FrameSampler, Info, LightSampler, PerPass, Pick, Picks, Strategy, Tally,
};
use glam::Vec3;
use std::f32::consts::TAU;
use std::sync::OnceLock;

/// How candidates of several receivers are weighed.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Combine {
    Pairwise,
    OneOverM,
}

/// Neighbours' normals differ by no more than 25 degrees: its cosine.
const LEAST_COSINE: f32 = 0.906_308;

/// Neighbours' distances from the camera differ by no more than this share of the greater.
const MOST_DEPTH: f32 = 0.1;

/// One light a pass, from the candidates of a receiver and its neighbours.
pub(super) struct Restir {
    recipe: Recipe,
    neighbours: u32,
    radius: f32,
    combine: Combine,
    visibility: bool,
}

impl Strategy for Restir {
    const INFO: Info = Info {
        name: "restir",
        summary: "resampled, then a choice among the candidates of neighbours in the image",
        source: "Bitterli et al., ACM TOG 39(4), 2020; Lin et al., ACM TOG 41(4), 2022",
        claim: Claim::Unbiased,
    };
    type Sampler = PerPass<Sampler>;
    const GRID: &'static str = "m={4,16,64},neighbours={2,5}";

    fn configure(arguments: &mut Arguments<'_>) -> Result<Self> {
        let recipe = Recipe::configure(arguments)?;
        // Seen on downtown at 160 x 90, error x CPU time: 0.121 so, 0.130 with 3 neighbours, 0.138 with 3 within 20
        // pixels.
        let neighbours = arguments.count("neighbours", 5, 1..=64, "neighbours asked for their candidate")?;
        let radius = arguments.real("radius", 10.0, 1.0..=1000.0, "how far neighbours may be, in pixels")?;
        let meaning = "how candidates that several receivers could have given are weighed";
        let combine =
            [Combine::Pairwise, Combine::OneOverM][arguments.choice("combine", 0, &["pairwise", "1/M"], meaning)?];
        let meaning = "whether candidates that are hidden are dropped before they are reused";
        let visibility = arguments.choice("visibility", 1, &["off", "on"], meaning)? == 1;
        Ok(Self { recipe, neighbours, radius, combine, visibility })
    }

    fn info(&self) -> Info {
        let claim = match (self.recipe.claim(), self.combine) {
            (Claim::Unbiased, Combine::OneOverM) => {
                Claim::biased("counts candidates that a neighbour could not have given as if it could")
            }
            (claim, _) => claim,
        };
        Info { claim, ..Self::INFO }
    }

    fn gives_candidates(&self) -> bool {
        false
    }

    fn build(&self, context: BuildContext<'_>) -> Result<PerPass<Sampler>> {
        let scene = context.stage.scene();
        let (width, height) = context.stage.view().resolution();
        Ok(PerPass(Sampler {
            candidates: self.recipe.build(context)?,
            neighbours: self.neighbours,
            radius: self.radius,
            combine: self.combine,
            visibility: self.visibility,
            eye: scene.camera().position(),
            width,
            height,
        }))
    }
}

/// [`Restir`] for a scene.
pub(super) struct Sampler {
    candidates: Candidates,
    neighbours: u32,
    radius: f32,
    combine: Combine,
    visibility: bool,
    eye: Vec3,
    width: u32,
    height: u32,
}

impl FrameSampler for Sampler {
    type Pass<'a> = Pass<'a>;

    fn begin<'a>(&'a self, frame: Frame<'a>, pass: u32) -> Pass<'a> {
        // Receivers made by hand, as those of a study, may be numbered beyond the camera's pixels.
        let pixels = frame.receivers.iter().map(|at| at.pixel as usize + 1).max().unwrap_or(0);
        let mut of_pixel = vec![NOBODY; pixels.max(self.width as usize * self.height as usize)];
        for (at, index) in frame.receivers.iter().zip(0..) {
            of_pixel[at.pixel as usize] = index;
        }
        let own = frame.receivers.iter().map(|_| OnceLock::new()).collect();
        Pass { sampler: self, frame, pass, of_pixel, own }
    }

    fn expected_counts(&self, _at: &Receiver, _counts: &mut [f32]) -> bool {
        false
    }

    fn heap_bytes(&self) -> usize {
        self.candidates.heap_bytes()
    }
}

/// In the table of receivers by pixel: the pixel has none in this frame.
const NOBODY: u32 = u32::MAX;

/// A candidate that was chosen at some receiver: the pick with the weight that makes it stand for all of them, and its
/// target value there. `None` if there was nothing to choose from, which is a candidate of weight 0.
type Chosen = Option<(Pick, f32)>;

/// One pass over a frame.
pub(super) struct Pass<'a> {
    sampler: &'a Sampler,
    frame: Frame<'a>,
    pass: u32,
    of_pixel: Vec<u32>,
    /// What each receiver chose by itself, made when it is first asked for: a function of the key, the pass and the
    /// receiver, so that it does not matter who asks.
    own: Vec<OnceLock<Chosen>>,
}

/// One worker's storage.
#[derive(Default)]
pub(super) struct Scratch {
    pool: Pool,
    neighbours: Vec<u32>,
}

/// One of several candidates, chosen as they come in proportion to their worth.
#[derive(Default)]
struct Reservoir {
    total: f64,
    chosen: Chosen,
}

impl Reservoir {
    /// Takes in a candidate of value `here` at the receiver, which counts with `share`.
    fn offer(&mut self, pick: Pick, here: f32, share: f32, stream: &mut Stream) {
        let worth = f64::from(share) * f64::from(here) * f64::from(pick.weight);
        self.total += worth;
        if stream.uniform64() * self.total < worth {
            self.chosen = Some((pick, here));
        }
    }
}

impl Pass<'_> {
    /// What a receiver of the frame chooses by itself.
    fn own<T: Tally>(&self, index: u32, pool: &mut Pool, tally: &mut T) -> Chosen {
        *self.own[index as usize].get_or_init(|| self.choose(&self.frame.receivers[index as usize], pool, tally))
    }

    fn choose<T: Tally>(&self, at: &Receiver, pool: &mut Pool, tally: &mut T) -> Chosen {
        let candidates = &self.sampler.candidates;
        let mut draws = Sequence::new(self.frame.key, at.pixel, self.frame.points).pass(self.pass);
        candidates.arrive(at, pool, tally);
        candidates.draw(Value::Point, at, &mut draws, pool, tally);
        let (pick, value) = candidates.choose(pool, draws.stream().uniform64())?;
        let hidden = self.sampler.visibility && candidates.target.of_visible_point(&pick, at, tally) == 0.0;
        (!hidden).then_some((pick, value))
    }

    /// The neighbours of a receiver in this pass: points of the disc about its pixel, where there is a receiver like
    /// it.
    fn neighbours<'s>(&'s self, at: &'s Receiver, stream: &'s mut Stream) -> impl Iterator<Item = u32> + 's {
        let Sampler { neighbours, radius, eye, width, height, .. } = *self.sampler;
        let (x, y) = ((at.pixel % width) as f32 + 0.5, (at.pixel / width) as f32 + 0.5);
        let depth = eye.distance(at.position);
        (0..neighbours).filter_map(move |_| {
            let [u, v] = stream.uniform2();
            let (sin, cos) = (TAU * v).sin_cos();
            let reach = radius * u.sqrt();
            let (x, y) = ((x + reach * cos).floor(), (y + reach * sin).floor());
            if x < 0.0 || y < 0.0 || x >= width as f32 || y >= height as f32 {
                return None;
            }
            let pixel = y as u32 * width + x as u32;
            let index = self.of_pixel[pixel as usize];
            if index == NOBODY || pixel == at.pixel {
                return None;
            }
            let other = &self.frame.receivers[index as usize];
            let other_depth = eye.distance(other.position);
            let alike = at.normal.dot(other.normal) >= LEAST_COSINE
                && (depth - other_depth).abs() <= MOST_DEPTH * depth.max(other_depth);
            alike.then_some(index)
        })
    }

    /// The target value of a candidate at a receiver that did not choose it.
    fn value<T: Tally>(&self, pick: &Pick, at: &Receiver, tally: &mut T) -> f32 {
        let target = &self.sampler.candidates.target;
        // Combining by 1/M saves these rays: it is biased with them too.
        if self.sampler.visibility && self.sampler.combine == Combine::Pairwise {
            target.of_visible_point(pick, at, tally)
        } else {
            target.of_point(pick, at, tally)
        }
    }

    /// The share in which the receiver's own candidate counts.
    fn share_of_own<T: Tally>(&self, own: &Pick, here: f32, neighbours: &[u32], tally: &mut T) -> f32 {
        let k = neighbours.len() as f32;
        if self.sampler.combine == Combine::OneOverM || neighbours.is_empty() {
            return 1.0 / (k + 1.0);
        }
        let beside = |&index: &u32| {
            let there = self.value(own, &self.frame.receivers[index as usize], tally);
            here / (k * there + here)
        };
        neighbours.iter().map(beside).sum::<f32>() / k
    }

    /// The share in which the candidate of one of `k` neighbours counts, of value `there` where it was chosen.
    fn share_of_lent(&self, there: f32, here: f32, k: f32) -> f32 {
        match self.sampler.combine {
            Combine::OneOverM => 1.0 / (k + 1.0),
            Combine::Pairwise => there / (k * there + here),
        }
    }
}

impl LightSampler for Pass<'_> {
    type Scratch = Scratch;

    fn sample<T: Tally>(&self, at: &Receiver, _draws: &mut Draws, scratch: &mut Scratch, out: &mut Picks<'_, T>) {
        let Scratch { pool, neighbours } = scratch;
        let key = self.frame.key;
        // Numbers of its own: those of the pass made this receiver's candidate, here or where it was lent.
        let word = u64::from_le_bytes(*b"spatial.");
        let mut stream =
            Stream::keyed(&[word, key.seed, u64::from(key.run), u64::from(self.pass), u64::from(at.pixel)]);
        neighbours.clear();
        neighbours.extend(self.neighbours(at, &mut stream));
        let mut reservoir = Reservoir::default();
        if let Some((pick, here)) = self.own(self.of_pixel[at.pixel as usize], pool, out.tally) {
            let share = self.share_of_own(&pick, here, neighbours, out.tally);
            reservoir.offer(pick, here, share, &mut stream);
        }
        for &index in neighbours.iter() {
            if let Some((pick, there)) = self.own(index, pool, out.tally) {
                let here = self.value(&pick, at, out.tally);
                let share = self.share_of_lent(there, here, neighbours.len() as f32);
                reservoir.offer(pick, here, share, &mut stream);
            }
        }
        if let Some((pick, here)) = reservoir.chosen {
            let weight = (reservoir.total / f64::from(here)).min(f64::from(f32::MAX));
            out.push_at(pick.light, weight as f32, pick.uv);
        }
    }

    fn expected_counts(&self, _at: &Receiver, _counts: &mut [f32]) -> bool {
        false
    }

    fn heap_bytes(&self) -> usize {
        self.sampler.candidates.heap_bytes() + size_of_val(&self.of_pixel[..]) + size_of_val(&self.own[..])
    }
}
