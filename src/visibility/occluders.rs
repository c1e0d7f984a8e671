//! Is there anything between two points?
//!
//! Surfaces and emissive triangles, both from both sides, in one binary hierarchy that `obvhs` builds.

use super::bvh::{self, Asked};
use super::offset::{self, Segment};
use super::pairs::Pairs;
use super::triangle::{Triangle, View};
use crate::scene::Scene;
use crate::scene::light::{Kind, LightId};
use glam::{DVec3, Vec3, Vec3A};
use obvhs::ray::Ray;
use std::ops::ControlFlow;

/// What a ray met.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Met {
    /// A surface, by its index in the scene.
    Surface(u32),
    /// An emissive triangle.
    Light(LightId),
}

/// Everything that blocks light.
pub struct Occluders {
    boxes: Pairs,
    /// In the hierarchy's order.
    triangles: Vec<Triangle>,
    /// What each of `triangles` is.
    met: Vec<Met>,
    /// How far, in metres, a height over a plane may be off by rounding, whichever the plane and the triangle.
    rounding: f32,
}

impl Occluders {
    /// Builds the hierarchy of a scene's surfaces and emissive triangles.
    pub fn new(scene: &Scene) -> Self {
        let emitters = scene.lights().iter().zip(0u32..).filter(|(light, _)| light.kind() == Kind::Triangle);
        let (corners, met): (Vec<[Vec3; 3]>, Vec<Met>) = (scene.surfaces().iter().zip(0..))
            .map(|(surface, i)| (surface.corners, Met::Surface(i)))
            .chain(emitters.map(|(light, id)| (light.corners(), Met::Light(id))))
            .unzip();
        let boxes = || corners.iter().map(|[a, b, c]| (a.min(*b).min(*c), a.max(*b).max(*c)));
        let bvh = bvh::build(boxes(), Asked::Rays);
        let order = || bvh.primitive_indices.iter().map(|&i| i as usize);
        let triangles = order().map(|i| Triangle::new(corners[i])).collect();
        let met = order().map(|i| met[i]).collect();
        let all = bvh::around(boxes());
        let rounding = if corners.is_empty() { 0.0 } else { offset::rounding(all.diagonal().into()) };
        Self { boxes: Pairs::new(&bvh), triangles, met, rounding }
    }

    /// How many triangles there are.
    pub fn len(&self) -> usize {
        self.triangles.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// Bytes on the heap.
    pub fn heap_bytes(&self) -> usize {
        self.boxes.heap_bytes() + size_of_val(&self.triangles[..]) + size_of_val(&self.met[..])
    }

    /// The library's hierarchy of the same triangles, and these in its order, for a measurement of the bare library.
    #[cfg(feature = "bench")]
    pub(crate) fn bare(&self) -> (obvhs::bvh2::Bvh2, Vec<[Vec3A; 3]>) {
        let corners: Vec<[Vec3A; 3]> = self.triangles.iter().map(Triangle::corners).collect();
        let boxes = corners.iter().map(|[a, b, c]| (a.min(*b).min(*c).into(), a.max(*b).max(*c).into()));
        let bvh = bvh::build(boxes, Asked::Rays);
        let ordered = bvh.primitive_indices.iter().map(|&i| corners[i as usize]).collect();
        (bvh, ordered)
    }

    /// Whether nothing lies on the segment, but what it passes over.
    #[inline]
    pub fn visible(&self, segment: &Segment) -> bool {
        let arch = pulp::Arch::new();
        // Compiled for each axis that a ray may mostly go along: looked up for each triangle, it made a ray 10 % slower.
        let (free, last) = match segment.along.abs().max_position() {
            0 => arch.dispatch(Way::<0> { occluders: self, segment }),
            1 => arch.dispatch(Way::<1> { occluders: self, segment }),
            _ => arch.dispatch(Way::<2> { occluders: self, segment }),
        };
        // Asked of the one triangle that ended the way: asked within the loop, it made a ray 15 % slower.
        free || (segment.passes_over(&self.triangles[last.0], last.1, self.rounding) && self.visible_beyond(segment))
    }

    /// The same where something was met that is passed over: seldom.
    #[cold]
    #[inline(never)]
    fn visible_beyond(&self, segment: &Segment) -> bool {
        let &Segment { origin, along, t_min, t_max, .. } = segment;
        let ray = ray(origin, along, t_min, t_max);
        let meet = Triangle::any_meet(&ray);
        let mut free = true;
        self.boxes.walk(&ray, |i, _| {
            let t = meet(&self.triangles[i], &ray);
            free = t >= t_max || segment.passes_over(&self.triangles[i], t, self.rounding);
            if free { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        });
        free
    }

    /// The first thing on a ray and its distance, which is that of the triangle's place nearest to the ray.
    pub fn first(&self, origin: Vec3, direction: DVec3) -> Option<(Met, f64)> {
        let ray = ray(origin, direction.as_vec3(), 0.0, f32::INFINITY);
        let meet = Triangle::any_meet(&ray);
        let mut nearest = None;
        self.boxes.walk(&ray, |i, end| {
            let t = meet(&self.triangles[i], &ray);
            if t < *end {
                (nearest, *end) = (Some(i), t);
            }
            ControlFlow::Continue(())
        });
        nearest.map(|i| (self.met[i], self.triangles[i].depth(origin.as_dvec3(), direction)))
    }
}

/// The way of a ray to what ends it, compiled for each instruction set.
struct Way<'a, const DEEP: usize> {
    occluders: &'a Occluders,
    segment: &'a Segment,
}

impl<const DEEP: usize> pulp::NullaryFnOnce for Way<'_, DEEP> {
    /// Whether it is free, and the last triangle asked with its distance.
    type Output = (bool, (usize, f32));

    #[inline(always)]
    fn call(self) -> Self::Output {
        let &Segment { origin, along, t_min, t_max, .. } = self.segment;
        let Occluders { boxes, triangles, .. } = self.occluders;
        let (mut free, mut last) = (true, (0, f32::INFINITY));
        let ray = ray(origin, along, t_min, t_max);
        let view = View::<DEEP>::new(&ray);
        boxes.walk(&ray, |i, _| {
            let t = triangles[i].meet(&ray, &view);
            if t < t_max {
                (free, last) = (false, (i, t));
                return ControlFlow::Break(());
            }
            ControlFlow::Continue(())
        });
        (free, last)
    }
}

/// The one place where rays are made.
///
/// The library turns a direction component under 1.2e-7 into an inverse of 8.4e6, so that a ray along an axis leaves a
/// box 84 m after it came within 1e-5 m of its side. Here the inverse of such a component is 1e30: finite, so that
/// 0 * inverse stays 0. Adding zero turns -0 into +0: both leave a box by the same side.
#[inline]
fn ray(origin: Vec3, direction: Vec3, t_min: f32, t_max: f32) -> Ray {
    let direction = Vec3A::from(direction) + Vec3A::ZERO;
    let inverse = direction.recip().clamp(Vec3A::splat(-1e30), Vec3A::splat(1e30));
    Ray { origin: origin.into(), direction, inv_direction: inverse, tmin: t_min, tmax: t_max }
}
