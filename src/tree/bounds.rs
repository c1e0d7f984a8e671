//! What bounds a set of lights, and how much do they differ from one another?
//!
//! Every light of the tree sends `peak * clamp((w.d - cut) / (full - cut), 0, 1)` or less in the unit direction `d`: exactly
//! that for a point (`w` = 0, cut -1, full 0) and for a triangle (`w` its normal, cut 0, full 1); the square of it for a spot
//! (`w` its axis, between the cosines of its cones). So one form serves all three, and a set of lights is bounded by a box of
//! places, a box of vectors `w` and the least cut.

use crate::base::colour::luminance;
use crate::scene::light::{Kind, Light, LightId};
use glam::{DVec3, Vec3, Vec3A};
use std::f32::consts::{FRAC_PI_2, PI};

/// One light, as the build sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Item {
    pub(super) low: Vec3A,
    pub(super) high: Vec3A,
    pub(super) axis: Vec3A,
    pub(super) cut: f32,
    pub(super) full: f32,
    /// Luminance of the peak intensity in cd; positive.
    pub(super) peak: f32,
    pub(super) light: LightId,
}

impl Item {
    /// `None` for a light that is nowhere (directional) or black.
    pub(super) fn new(light: LightId, of: &Light) -> Option<Self> {
        if of.colour.max_element() <= 0.0 || of.kind() == Kind::Directional {
            return None;
        }
        let place = Vec3A::from(of.position);
        let (low, high, axis, cut, full) = match of.kind() {
            Kind::Triangle => {
                // In f64: corners rounded to f32 might leave a part of the triangle outside.
                let corner = of.position.as_dvec3();
                let corners = [corner, corner + of.a.as_dvec3(), corner + of.b.as_dvec3()];
                let low = corners.into_iter().fold(corner, DVec3::min);
                let high = corners.into_iter().fold(corner, DVec3::max);
                let axis = of.c.as_dvec3().normalize_or_zero().as_vec3a();
                (round(low, f32::next_down), round(high, f32::next_up), axis, 0.0, 1.0)
            }
            Kind::Spot => (place, place, Vec3A::from(of.a), of.b.z, of.c.x),
            Kind::Point | Kind::Directional => (place, place, Vec3A::ZERO, -1.0, 0.0),
        };
        Some(Self { low, high, axis, cut, full, peak: peak(of), light })
    }

    /// The `power`-th power of the emission averaged over all directions, as a share of that of the peak.
    pub(super) fn moment(&self, power: u8) -> f32 {
        if self.cut < 0.0 {
            return 1.0;
        }
        // Linear between `cut` and `full` for a triangle, squared for a spot.
        let degree = if self.cut == 0.0 && self.full == 1.0 { 1 } else { 2 };
        0.5 * ((1.0 - self.full) + (self.full - self.cut) / f32::from(degree * power + 1))
    }

    pub(super) fn centre(&self) -> Vec3A {
        0.5 * self.low + 0.5 * self.high
    }
}

/// Luminance of a light's peak intensity in cd, never 0: one too weak for f32 may still add something.
pub(super) fn peak(of: &Light) -> f32 {
    luminance(of.peak_intensity()).clamp(f32::MIN_POSITIVE, f32::MAX)
}

/// The nearest f32 on the side to which `outward` steps, or the number itself.
fn round(exact: DVec3, outward: impl Fn(f32) -> f32) -> Vec3A {
    let component = |x: f64| {
        let near = x as f32;
        let out = outward(near);
        // `near` lies on the wrong side of x if x lies between it and the next number outward.
        if (f64::from(near) < x) == (out > near) && f64::from(near) != x { out } else { near }
    };
    Vec3A::new(component(exact.x), component(exact.y), component(exact.z))
}

/// What bounds a set of lights. Of none: boxes inside out.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    pub(super) low: Vec3A,
    pub(super) high: Vec3A,
    pub(super) axis_low: Vec3A,
    pub(super) axis_high: Vec3A,
    pub(super) cut: f32,
    /// Sum of the peaks, in cd.
    pub(super) peak: f64,
}

impl Bounds {
    pub(super) const NONE: Self = Self {
        low: Vec3A::INFINITY,
        high: Vec3A::NEG_INFINITY,
        axis_low: Vec3A::INFINITY,
        axis_high: Vec3A::NEG_INFINITY,
        cut: 1.0,
        peak: 0.0,
    };

    pub(super) fn of(items: &[Item]) -> Self {
        let mut bounds = Self::NONE;
        items.iter().for_each(|item| bounds.add(item));
        bounds
    }

    #[inline]
    pub(super) fn add(&mut self, item: &Item) {
        self.low = self.low.min(item.low);
        self.high = self.high.max(item.high);
        self.axis_low = self.axis_low.min(item.axis);
        self.axis_high = self.axis_high.max(item.axis);
        self.cut = self.cut.min(item.cut);
        self.peak += f64::from(item.peak);
    }

    #[inline]
    pub(super) fn union(&mut self, other: &Self) {
        self.low = self.low.min(other.low);
        self.high = self.high.max(other.high);
        self.axis_low = self.axis_low.min(other.axis_low);
        self.axis_high = self.axis_high.max(other.axis_high);
        self.cut = self.cut.min(other.cut);
        self.peak += other.peak;
    }

    /// What a cluster costs: strength times size times spread of directions (the surface area orientation heuristic).
    pub(super) fn cost(&self) -> f64 {
        self.peak * f64::from(self.size() * self.spread())
    }

    /// Half the surface area of the box and a share of its squared diagonal: the area alone is 0 for a row of lamps, which
    /// would then be split anywhere.
    fn size(&self) -> f32 {
        let extent = self.high - self.low;
        let area = extent.x * extent.y + extent.y * extent.z + extent.z * extent.x;
        area + 0.5 * extent.length_squared()
    }

    /// The orientation measure of Conty Estevez and Kulla 2018: pi for one direction of a Lambertian emitter, 4 pi for all.
    fn spread(&self) -> f32 {
        // The common cases: points among them, or triangles that all face one way.
        if self.cut < 0.0 {
            return 4.0 * PI;
        }
        if self.cut == 0.0 && self.axis_low == self.axis_high {
            return PI;
        }
        let (around, emission) = (self.cosine().min(1.0).acos(), self.cut.max(0.0).acos());
        let all = (around + emission).min(PI);
        let (sin, cos) = around.sin_cos();
        2.0 * PI * (1.0 - cos) + FRAC_PI_2 * (2.0 * (all - around) * sin - (around - 2.0 * all).cos() + cos)
    }

    /// Cosine of a half-angle around the centre of the box of directions that holds them all; of lights with directions.
    ///
    /// For a unit vector w within half a diagonal `r` of `c`: c.w = (1 + |c|^2 - |w - c|^2) / 2 >= (1 + |c|^2 - r^2) / 2.
    fn cosine(&self) -> f32 {
        let centre = 0.5 * (self.axis_low + self.axis_high);
        let (c2, r2) = (centre.length_squared(), (0.5 * (self.axis_high - self.axis_low)).length_squared());
        // Opposite ones.
        if c2 < 1e-6 { -1.0 } else { (0.5 * (1.0 + c2 - r2) / c2.sqrt()).max(-1.0) }
    }
}

/// Centre and half extents of a box, in f32: the centre is any number near the middle, the half extents reach from it to
/// beyond both ends.
pub(crate) fn centred(low: Vec3A, high: Vec3A) -> (Vec3, Vec3) {
    let centre = 0.5 * low + 0.5 * high;
    let (exact, low, high) = (centre.as_dvec3(), low.as_dvec3(), high.as_dvec3());
    (centre.into(), round((high - exact).max(exact - low), f32::next_up).into())
}
