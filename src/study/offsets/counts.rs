//! What becomes of the same rays under each policy: how many are acne, how many are leaks?

use super::geometry;
use crate::base::error::Result;
use crate::base::random::Stream;
use crate::record::study::Cell;
use crate::scene::Scene;
use crate::scene::light::Kind;
use crate::scene::light_sampling::LightSampling;
use crate::shading::contribution::contribution;
use crate::stability::tracer::{Tracer, Truth, tolerance};
use crate::visibility::occluders::Occluders;
use crate::visibility::offset::Offset;
use rayon::prelude::*;
use std::ops::AddAssign;

/// The policies: the default, then the others. Not the one that is wrong on purpose: half of its rays are acne anywhere.
pub(super) const POLICIES: [(&str, Offset); 4] = Offset::NAMED;

/// What became of rays.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Counts {
    rays: u64,
    undecided: u64,
    differ: u64,
    lit: u64,
    pub(super) acne: u64,
    dark: u64,
    pub(super) leaks: u64,
    /// In m; the same for all.
    tolerance: f64,
}

impl AddAssign for Counts {
    fn add_assign(&mut self, other: Self) {
        self.rays += other.rays;
        self.undecided += other.undecided;
        self.differ += other.differ;
        self.lit += other.lit;
        self.acne += other.acne;
        self.dark += other.dark;
        self.leaks += other.leaks;
        self.tolerance = self.tolerance.max(other.tolerance);
    }
}

impl Counts {
    /// Counts a ray that is what `truth` says, lit without a tolerance if `exact`, and `seen` under the policy.
    fn note(&mut self, truth: Truth, exact: bool, seen: bool) {
        self.rays += 1;
        match truth {
            Truth::Undecided => {
                self.undecided += 1;
                self.differ += u64::from(seen != exact);
            }
            Truth::Lit => {
                self.lit += 1;
                self.acne += u64::from(!seen);
            }
            Truth::Dark => {
                self.dark += 1;
                self.leaks += u64::from(seen);
            }
        }
    }

    pub(super) fn cells(self) -> impl Iterator<Item = Cell> {
        let decided = self.lit + self.dark;
        let wrong = (decided > 0).then(|| (self.acne + self.leaks) as f64 / decided as f64);
        let whole =
            [self.rays, self.undecided, self.differ, self.lit, self.acne, self.dark, self.leaks].map(Cell::from);
        whole.into_iter().chain([wrong.into(), self.tolerance.into()])
    }
}

/// The same rays of `count` receivers under each policy.
pub(super) fn counts(scene: &Scene, count: usize, seed: u64) -> Result<[Counts; POLICIES.len()]> {
    let tolerance = tolerance(scene);
    let occluders = Occluders::new(scene);
    let tracer = Tracer::new(scene);
    let ends = POLICIES.map(|(_, policy)| policy.in_scene(scene));
    let found = (0..count).into_par_iter().map(|number| {
        let mut stream = Stream::keyed(&[seed, u64::from_le_bytes(*b"offsets\0"), number as u64]);
        let at = geometry::receiver(scene, &mut stream, number);
        let mut counts = [Counts { tolerance, ..Counts::default() }; POLICIES.len()];
        let mut emitter = scene.surfaces().len();
        for light in scene.lights() {
            let own = (light.kind() == Kind::Triangle).then_some(emitter);
            emitter += usize::from(own.is_some());
            let uv = stream.uniform2();
            let Ok(arrival) = contribution::<0b1111>(LightSampling::Area, light, uv, &at) else { continue };
            let (truth, exact) = tracer.sees(tolerance, &at, (light, own), uv);
            for (ends, counts) in ends.iter().zip(&mut counts) {
                let ray = ends.segment(&at, light, arrival.direction, arrival.distance);
                counts.note(truth, exact, occluders.visible(&ray));
            }
        }
        counts
    });
    let add = |mut all: [Counts; POLICIES.len()], more: [Counts; POLICIES.len()]| {
        all.iter_mut().zip(more).for_each(|(all, more)| *all += more);
        all
    };
    Ok(found.reduce(|| [Counts::default(); POLICIES.len()], add))
}
