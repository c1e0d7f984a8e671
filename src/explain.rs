//! What does a strategy do at one receiver: what is picked, what becomes of it, and what should be picked?

use crate::base::colour::luminance;
use crate::base::error::{Error, Result};
use crate::base::random::RunKey;
use crate::scene::light::LightId;
use crate::scene::receiver::Receiver;
use crate::shading::contribution::{EarlyOut, contribution};
use crate::strategy::{AnySampler, BuildContext, Configured, Frame, Pick, PickBuffer, blocks};
use crate::verify::Truth;
use crate::visibility::occluders::Met;
use crate::visibility::stage::Stage;
use crate::visibility::view::Seen;
use glam::Vec3;

/// What became of a pick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Fate {
    /// It added light.
    Adds,
    /// No shadow ray was cast.
    Ends(EarlyOut),
    /// Its shadow ray met something; `None` where that could not be told from what the ray may pass over.
    Blocked(Option<Met>),
}

/// A pick and what became of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Explained {
    /// Which light.
    pub light: LightId,
    /// What its contribution is multiplied with.
    pub weight: f32,
    /// The point on it in metres; none of a directional light, or of a pick that ended before a ray.
    pub point: Option<Vec3>,
    /// Luminance that it adds to the pass, weight included, in cd/m^2; where it is blocked, what it would have added.
    pub adds: f32,
    /// Picks of this light in a pass that are expected; none where the strategy cannot tell.
    pub expected: Option<f32>,
    /// What became of it.
    pub fate: Fate,
}

/// What a light adds at the receiver, and how often it is picked there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Share {
    /// Which light.
    pub light: LightId,
    /// Luminance in cd/m^2: exact, but of a triangle a mean over points.
    pub exact: f64,
    /// Picks a pass that are expected; none where the strategy cannot tell.
    pub expected: Option<f32>,
}

/// A strategy at one receiver.
pub(crate) struct Explanation {
    /// The receiver.
    pub at: Receiver,
    /// The picks of each pass.
    pub passes: Vec<Vec<Explained>>,
    /// Every light that adds anything or is picked, those that add most first.
    pub shares: Vec<Share>,
}

impl Explanation {
    /// What all lights add, in cd/m^2.
    pub(crate) fn exact(&self) -> f64 {
        self.shares.iter().map(|share| share.exact).sum()
    }

    /// What the passes say that they add, on average.
    pub(crate) fn mean(&self) -> f64 {
        let added = self.passes.iter().flatten().filter(|pick| pick.fate == Fate::Adds);
        added.map(|pick| f64::from(pick.adds)).sum::<f64>() / self.passes.len().max(1) as f64
    }
}

/// Points on the triangles at the receiver, in each of 8 repetitions, on top of one a light.
const POINTS: u32 = 1024;

/// Explains a strategy at a pixel, over so many passes: the very picks that `render` makes with this seed.
///
/// # Errors
/// A pixel outside the film, or that sees the sky or an emitter; a strategy that cannot serve the scene, or that picks a
/// light which there is not.
pub(crate) fn explain(
    stage: &Stage,
    strategy: &Configured,
    [x, y]: [u32; 2],
    passes: u32,
    seed: u64,
) -> Result<Explanation> {
    let at = receiver(stage, [x, y])?;
    let key = RunKey { seed, run: 0 };
    let sampler = strategy.build(BuildContext { stage, seed })?;
    let picks = picks(stage, sampler.as_ref(), &at, key, passes);
    let mut counts = vec![0.0; stage.scene().lights().len()];
    let mut picked = vec![false; counts.len()];
    for pick in picks.iter().flatten() {
        let light = pick.light;
        let there = picked.get_mut(light as usize);
        *there.ok_or_else(|| Error::Invalid(format!("light {light} is picked, and there is no such light")))? = true;
    }
    let told = sampler.expected_counts(&at, &mut counts);
    let truth = Truth::new(stage, &at, POINTS, seed);
    let mut shares: Vec<Share> = (0..)
        .zip(truth.lights())
        .map(|(light, &exact)| Share { light, exact, expected: told.then(|| counts[light as usize]) })
        .filter(|share| {
            share.exact > 0.0 || picked[share.light as usize] || share.expected.is_some_and(|count| count > 0.0)
        })
        .collect();
    shares.sort_by(|a, b| b.exact.total_cmp(&a.exact).then(a.light.cmp(&b.light)));
    let expected = |pick: &Pick| told.then(|| counts[pick.light as usize]);
    let explained = |pick: &Pick| Explained { expected: expected(pick), ..fate(stage, &at, pick) };
    let passes = picks.iter().map(|pass| pass.iter().map(explained).collect()).collect();
    Ok(Explanation { at, passes, shares })
}

/// The receiver that a pixel sees.
fn receiver(stage: &Stage, [x, y]: [u32; 2]) -> Result<Receiver> {
    match stage.view().seen(x, y)? {
        Seen::Receiver(index) => Ok(stage.receivers()[index as usize]),
        Seen::Sky => Err(Error::Invalid(format!("pixel {x},{y} sees the sky, where no light is chosen"))),
        Seen::Emitter(_) | Seen::EmitterBack => {
            Err(Error::Invalid(format!("pixel {x},{y} sees an emitter, where no light is chosen")))
        }
    }
}

/// The picks of each pass.
fn picks(stage: &Stage, sampler: &dyn AnySampler, at: &Receiver, key: RunKey, passes: u32) -> Vec<Vec<Pick>> {
    let frame = Frame::new(stage.receivers(), key);
    let mut all = Vec::new();
    let mut buffer = PickBuffer::default();
    for passes in blocks(sampler, 0..passes) {
        let block = sampler.begin(frame, passes.clone());
        block.worker(false).fill(std::slice::from_ref(at), passes, true, &mut buffer);
        all.extend(buffer.calls().map(<[Pick]>::to_vec));
    }
    all
}

fn fate(stage: &Stage, at: &Receiver, pick: &Pick) -> Explained {
    let light = &stage.scene().lights()[pick.light as usize];
    let arrival = match contribution::<0b1111>(stage.light_sampling(), light, pick.uv, at) {
        Ok(arrival) => arrival,
        Err(end) => {
            let Pick { light, weight, .. } = *pick;
            return Explained { light, weight, point: None, adds: 0.0, expected: None, fate: Fate::Ends(end) };
        }
    };
    let segment = stage.ray_ends().segment(at, light, arrival.direction, arrival.distance);
    let fate = if stage.occluders().visible(&segment) {
        Fate::Adds
    } else {
        let along = segment.along.as_dvec3();
        let within = |way: f64| way >= f64::from(segment.t_min) && way <= f64::from(segment.t_max);
        let first = stage.occluders().first(segment.origin, along.normalize());
        Fate::Blocked(first.filter(|(_, distance)| within(distance / along.length())).map(|(met, _)| met))
    };
    let point = arrival.distance.is_finite().then(|| at.position + arrival.direction * arrival.distance);
    let adds = luminance(arrival.radiance) * pick.weight;
    Explained { light: pick.light, weight: pick.weight, point, adds, expected: None, fate }
}
