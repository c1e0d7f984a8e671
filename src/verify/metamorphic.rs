//! What must not change when the scene changes in a way that changes nothing?
//!
//! Level 2: the scene is scaled, turned, moved and permuted, a light is split, a black one and a hidden one are added.
//! The image then stays as it was, and so must the mean of every unbiased strategy, which is held to the truth of the
//! changed scene; a strategy may well choose by other probabilities there, since a hierarchy that was built anew need
//! not be the same. Only a scene of another size must leave probabilities alone: lengths times s and intensities times
//! s^2 are the same scene in other units. Biased strategies are held to the contract alone.
//!
//! The table of lights is whole on both sides: nothing is left out.

use super::check::Check;
use super::estimate::{Distance, surprise};
use super::impossible::{picks_in_range, picks_valid};
use super::observe;
use super::options::VerifyOptions;
use super::spread::spread;
use super::subject::Subject;
use super::verifier::Verifier;
use crate::base::error::Result;
use crate::base::random::hash;
use crate::base::statistics::{sidak, student_quantile};
use crate::scene::light::Shape;
use crate::scene::light_sampling::LightSampling;
use crate::scene::receiver::Receiver;
use crate::scene::{Parts, Scene};
use crate::sources::small::{cuboid, point};
use crate::strategy::{AnySampler, BuildContext, Configured};
use crate::visibility::offset::Offset;
use crate::visibility::stage::{LeaveOut, Stage};
use glam::{DQuat, DVec3, Vec3};
use std::collections::{HashMap, HashSet};

/// The checks' names.
const VALID: &str = "changed-valid";
const COUNTS: &str = "scaled-counts";

/// How many checks of level 2 a right strategy may fail by chance: one for each of `CHANGES`.
pub(crate) const CHANCES: usize = CHANGES.len();

/// What is done to a scene, and how far apart the images may be, as a share of the mean.
///
/// Receivers and corners are rounded anew, and shadow rays keep off surfaces by a share of the greatest coordinate: a
/// light on the edge of a shadow may come or go. 10^5 m from the origin coordinates are rounded to 8 mm, and rays keep
/// off by 2 cm where they start and where they end: the image is the same in its mean only.
const CHANGES: [(&str, Change, f64); 8] = [
    ("scaled-down", Change::Scaled(1.0 / 128.0), 1e-3),
    ("scaled-up", Change::Scaled(128.0), 1e-3),
    ("turned", Change::Turned, 1e-2),
    ("moved", Change::Moved, 0.1),
    ("permuted", Change::Permuted, 1e-5),
    ("split", Change::Split, 1e-5),
    ("black", Change::Black, 1e-5),
    ("hidden", Change::Hidden, 1e-5),
];

/// The names of the checks.
pub(super) fn names() -> impl Iterator<Item = &'static str> {
    CHANGES.iter().map(|(name, ..)| *name).chain([VALID, COUNTS])
}

#[derive(Clone, Copy, PartialEq)]
enum Change {
    /// Lengths by this factor, intensities by its square. A power of two rounds nothing: two splits or ranges that are equal
    /// stay equal.
    Scaled(f64),
    /// By a radian about an axis that is none of the coordinates'.
    Turned,
    /// By 10^5 m.
    Moved,
    /// The table of lights in another order.
    Permuted,
    /// The light that adds most, as two of half the strength.
    Split,
    /// Lights of no strength, before all others.
    Black,
    /// A strong light in a closed box below everything.
    Hidden,
}

/// Enough pixels of a film for checks: a view is built anew for every change, and a frame-wide sampler looks at all of
/// it in every pass.
pub(crate) const PIXELS: u32 = 64 * 36;

/// A scene and its changed copies, made ready.
pub(crate) struct Copies {
    whole: Stage,
    changed: Vec<Stage>,
}

impl Copies {
    /// Changes a scene in every way; its shadow rays and points on lights are those of the stage that it is compared
    /// with.
    ///
    /// # Errors
    /// A copy that is no scene: one so large, so bright or so small that its numbers have no place in an f32.
    pub(crate) fn new(scene: &Scene, offset: Offset, by: LightSampling) -> Result<Self> {
        let mut parts = Parts { groups: Vec::new(), ..scene.parts() };
        parts.camera = parts.camera.shrunk(PIXELS);
        let ready = |parts: Parts| Ok(Stage::new(Scene::new(parts)?, LeaveOut::No, offset).with_light_sampling(by));
        let whole = ready(parts.clone())?;
        let changed = CHANGES.iter().map(|(_, change, _)| ready(change.of(parts.clone(), &whole)));
        Ok(Self { changed: changed.collect::<Result<_>>()?, whole })
    }
}

/// A scene and its changed copies, with what is true there: checks any number of strategies, on any threads.
pub(crate) struct Metamorphic<'a> {
    whole: Verifier<'a>,
    changed: Vec<Verifier<'a>>,
}

impl<'a> Metamorphic<'a> {
    /// Finds the truth at a few receivers of each copy.
    pub(crate) fn new(copies: &'a Copies, options: VerifyOptions) -> Self {
        let whole = Verifier::new(&copies.whole, options);
        let scale = copies.whole.scene().radius();
        let changed = CHANGES.iter().zip(&copies.changed).map(|((_, change, _), stage)| {
            let there: HashMap<u32, &Receiver> = stage.receivers().iter().map(|at| (at.pixel, at)).collect();
            let same = |at: &Receiver| {
                let place = change.place(at.position);
                // On another side of a silhouette a pixel sees something else.
                let tolerance = 1e-3 * change.factor() as f32 * scale + 0.02;
                there.get(&at.pixel).copied().filter(|there| there.position.distance(place) < tolerance)
            };
            let receivers: Vec<Receiver> = whole.receivers.iter().filter_map(same).copied().collect();
            Verifier::at(stage, &receivers, options)
        });
        Self { changed: changed.collect(), whole }
    }

    /// Checks the truth itself: the image of each copy is that of the scene.
    pub(crate) fn image(&self) -> Vec<Check> {
        let sum = |verifier: &Verifier<'_>, pixels: &HashSet<u32>| {
            let (receivers, truths) = verifier.bright();
            let kept = receivers.iter().zip(truths).filter(|(at, _)| pixels.contains(&at.pixel));
            kept.map(|(_, truth)| truth.sum(|_| true))
                .fold((0.0, 0.0, 8), |(mean, variance, _), m| (mean + m.mean, variance + m.variance / m.n as f64, m.n))
        };
        let check = |((name, _, tolerance), changed): (&(&'static str, Change, f64), &Verifier<'_>)| {
            // Those that are bright in both.
            let of = |verifier: &Verifier<'_>| verifier.bright().0.iter().map(|at| at.pixel).collect::<HashSet<u32>>();
            let pixels = &of(&self.whole) & &of(changed);
            let (wanted, own, n) = sum(&self.whole, &pixels);
            let (found, other, _) = sum(changed, &pixels);
            let error = (own + other + (tolerance * wanted).powi(2)).sqrt();
            let t = if found == wanted { 0.0 } else { ((found - wanted) / error).abs() };
            let limit = student_quantile(1.0 - 0.5 * self.whole.options.level.powi(2), 2 * n - 2);
            let off = 100.0 * (found / wanted.max(f64::MIN_POSITIVE) - 1.0);
            let detail = format!("|t| of the image at {} pixels: {off:+.4} % off", pixels.len());
            Check::new(name, t, limit, if wanted > 0.0 { detail } else { "the image is black".into() })
        };
        CHANGES.iter().zip(&self.changed).map(check).collect()
    }

    /// Checks a strategy on each copy.
    ///
    /// # Errors
    /// A strategy that cannot serve the scene, or a copy of it.
    pub(crate) fn verify(&self, strategy: &Configured) -> Result<Vec<Check>> {
        let seed = self.whole.options.seed;
        let build = |verifier: &Verifier<'_>| strategy.build(BuildContext { stage: verifier.stage, seed });
        let base = build(&self.whole)?;
        let samplers = self.changed.iter().map(build).collect::<Result<Vec<_>>>()?;
        let pairs = || self.changed.iter().zip(&samplers);
        let mut checks = vec![valid(pairs().map(|(verifier, sampler)| verifier.subject(&**sampler)))];
        if strategy.info().claim.bias().is_some() || !checks[0].passed {
            return Ok(checks);
        }
        // A choice by shadow rays depends on how far they keep off surfaces, which is no length of the scene.
        if strategy.scale_free() {
            checks.extend(self.counts(&*base, &samplers));
        }
        for ((name, ..), (verifier, sampler)) in CHANGES.iter().zip(pairs()) {
            let mut check = estimate(name, &verifier.bright_subject(&**sampler));
            if !check.passed {
                check = estimate(name, &verifier.second().bright_subject(&**sampler));
            }
            checks.push(check);
        }
        Ok(checks)
    }

    /// Expected counts at the scaled place of each receiver against those at the place itself, if the sampler tells
    /// them.
    fn counts(&self, base: &dyn AnySampler, samplers: &[Box<dyn AnySampler>]) -> Option<Check> {
        let lights = self.whole.stage.scene().lights().len();
        let mut worst = (0.0f64, None, String::new());
        for ((name, change, _), other) in CHANGES.iter().zip(samplers) {
            let Change::Scaled(_) = change else { continue };
            for at in self.whole.bright().0 {
                let (mut here, mut there) = (vec![0.0; lights], vec![0.0; lights]);
                let moved = Receiver { position: change.place(at.position), ..*at };
                if !(base.expected_counts(at, &mut here) && other.expected_counts(&moved, &mut there)) {
                    return None;
                }
                let total: f64 = here.iter().map(|&c| f64::from(c)).sum();
                let apart: f64 = here.iter().zip(&there).map(|(&a, &b)| f64::from((a - b).abs())).sum();
                let share = if apart == 0.0 { 0.0 } else { apart / total };
                if share > worst.0 || share.is_nan() {
                    worst = (share, Some(at.pixel), format!(", {name}"));
                }
            }
        }
        let detail = format!("greatest share of expected counts that a change of scale moves{}", worst.2);
        // Nothing is rounded but lights that are scaled to less than f32 holds with all its digits.
        Some(Check::new(COUNTS, worst.0, 1e-5, detail).at(worst.1, None))
    }
}

/// Picks on every copy are lights of the table with weights that are finite and 0 or more.
fn valid<'v>(subjects: impl Iterator<Item = Subject<'v>>) -> Check {
    let (mut wrong, mut all) = (0, 0);
    for subject in subjects {
        let picks = subject.calls(subject.stage.receivers(), subject.receivers, 0..8).concat();
        wrong += picks_in_range(&picks, subject.stage.scene().lights().len()) + picks_valid(&picks);
        all += picks.len();
    }
    Check::new(VALID, wrong as f64, 0.0, format!("ids beyond the table and impossible weights, of {all} picks"))
}

/// The mean estimate on a copy is the truth there.
fn estimate(name: &'static str, subject: &Subject<'_>) -> Check {
    let options = subject.options;
    let seen = observe::seen(subject);
    let (sites, distance) = (&seen.sites, Distance::new(&seen, options));
    let (worst, pixel, off) = distance.worst();
    let limit = surprise(sidak(options.level, sites.len() + 1));
    let (mean, tested) = (distance.of_mean(), distance.tested());
    let detail = format!(
        "greatest ln 1/p of {} receivers and their mean ({mean:.2}), {tested:.2} % tested, seed {}{off}",
        sites.len(),
        options.seed
    );
    Check::new(name, worst.max(mean), limit, detail).at(pixel, None)
}

impl Change {
    fn factor(self) -> f64 {
        if let Self::Scaled(factor) = self { factor } else { 1.0 }
    }

    fn turn(self) -> DQuat {
        if self == Self::Turned {
            DQuat::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), 1.0)
        } else {
            DQuat::IDENTITY
        }
    }

    /// Where a point comes to lie.
    fn place(self, at: Vec3) -> Vec3 {
        let shift = if self == Self::Moved { DVec3::new(1e5, -1e5, 0.0) } else { DVec3::ZERO };
        (self.turn() * at.as_dvec3() * self.factor() + shift).as_vec3()
    }

    fn direction(self, along: Vec3) -> Vec3 {
        (self.turn() * along.as_dvec3()).as_vec3()
    }

    /// The parts of the changed scene.
    fn of(self, mut parts: Parts, whole: &Stage) -> Parts {
        match self {
            Self::Scaled(_) | Self::Turned | Self::Moved => self.carry(&mut parts),
            Self::Permuted => {
                let mut order: Vec<usize> = (0..parts.lights.len()).collect();
                order.sort_by_key(|&i| hash(&[i as u64]));
                parts.lights = order.iter().map(|&i| parts.lights[i]).collect();
            }
            Self::Split => {
                if let Some(brightest) = brightest(whole) {
                    let half = with_colour(parts.lights[brightest], |colour| colour * 0.5);
                    parts.lights[brightest] = half;
                    parts.lights.push(half);
                }
            }
            Self::Black => {
                let black: Vec<Shape> = parts
                    .lights
                    .iter()
                    .filter(|light| !matches!(light, Shape::Triangle { .. }))
                    .take(3)
                    .map(|light| with_colour(*light, |_| Vec3::ZERO))
                    .chain([point(whole.scene().bounds().1, 0.0)])
                    .collect();
                parts.lights.splice(0..0, black);
            }
            Self::Hidden => {
                let (low, high) = whole.scene().bounds();
                let size = 0.05 * whole.scene().radius();
                let corner = Vec3::new(0.5 * (low.x + high.x), 0.5 * (low.y + high.y), low.z - 4.0 * size);
                parts.surfaces.extend(cuboid(corner, corner + size));
                let strength: f32 =
                    whole.scene().lights().iter().map(|light| light.peak_intensity().max_element()).sum();
                parts.lights.push(point(corner + 0.5 * size, strength.clamp(1.0, 1e20)));
            }
        }
        parts
    }

    /// Carries everything to its place.
    fn carry(self, parts: &mut Parts) {
        let squared = (self.factor() * self.factor()) as f32;
        for light in &mut parts.lights {
            match light {
                Shape::Point { position, intensity } => {
                    *position = self.place(*position);
                    *intensity *= squared;
                }
                Shape::Spot { position, axis, intensity, .. } => {
                    *position = self.place(*position);
                    *axis = self.direction(*axis);
                    *intensity *= squared;
                }
                Shape::Directional { towards, .. } => *towards = self.direction(*towards),
                Shape::Triangle { corners, .. } => *corners = corners.map(|corner| self.place(corner)),
            }
        }
        for surface in &mut parts.surfaces {
            surface.corners = surface.corners.map(|corner| self.place(corner));
        }
        parts.camera = parts.camera.turned(self.place(parts.camera.position()), self.turn());
    }
}

/// The light that adds most at a few receivers with nothing in between; `None` where none adds anything.
fn brightest(stage: &Stage) -> Option<usize> {
    let receivers = spread(stage.receivers(), 64);
    let added =
        |light| receivers.iter().map(|at| f64::from(crate::shading::importance::importance(light, at))).sum::<f64>();
    let sums: Vec<f64> = stage.scene().lights().iter().map(added).collect();
    (0..sums.len()).filter(|&i| sums[i] > 0.0).max_by(|&a, &b| sums[a].total_cmp(&sums[b]))
}

fn with_colour(mut shape: Shape, change: impl Fn(Vec3) -> Vec3) -> Shape {
    match &mut shape {
        Shape::Point { intensity: colour, .. }
        | Shape::Spot { intensity: colour, .. }
        | Shape::Directional { irradiance: colour, .. }
        | Shape::Triangle { radiance: colour, .. } => *colour = change(*colour),
    }
    shape
}
