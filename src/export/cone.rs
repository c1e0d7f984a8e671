//! The cone of a spot in formats whose edge has another profile.
//!
//! Ours is that of `KHR_lights_punctual`: `t^2`, where `t` runs from 0 to 1 in the cosine between the outer and the
//! inner cone.

use crate::scene::light::Shape;

/// Farthest angle from the axis that a table reaches: a plane of directions ends before 90 degrees.
const FARTHEST_COS: f64 = 0.087_155_742_747_658_17; // 85 degrees
/// Most texels of all tables together, 64 MiB of them.
const MOST_TEXELS: usize = 1 << 24;

/// The cosines of the inner and the outer half-angle, as bits: spots of equal cones share a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Cone {
    inner: u32,
    outer: u32,
}

impl Cone {
    /// The cone of a spot, `None` for other lights.
    pub(super) fn of(shape: &Shape) -> Option<Self> {
        let Shape::Spot { cos_inner, cos_outer, .. } = shape else { return None };
        Some(Self { inner: cos_inner.to_bits(), outer: cos_outer.to_bits() })
    }

    /// The cosines of the inner and the outer half-angle.
    pub(super) fn cosines(self) -> (f64, f64) {
        (f64::from(f32::from_bits(self.inner)), f64::from(f32::from_bits(self.outer)))
    }

    /// What of the peak goes out at an angle of cosine `cos` to the axis.
    fn profile(self, cos: f64) -> f64 {
        let (inner, outer) = self.cosines();
        ((cos - outer) / (inner - outer)).clamp(0.0, 1.0).powi(2)
    }

    /// The profile over the plane at distance 1 from the light, `side` texels wide.
    pub(super) fn table(self, side: usize) -> Table {
        let cos_cutoff = self.cosines().1.max(FARTHEST_COS);
        let reach = (1.0 / (cos_cutoff * cos_cutoff) - 1.0).sqrt();
        let at = |i: usize| reach * ((2 * i + 1) as f64 / side as f64 - 1.0);
        let texels: Vec<f32> = (0..side * side)
            .map(|i| {
                let (x, y) = (at(i % side), at(i / side));
                self.profile(1.0 / (1.0 + x * x + y * y).sqrt()) as f32
            })
            .collect();
        let mut table = Table { side, reach, texels, worst: self.profile(cos_cutoff), flux_error: 0.0 };
        table.compare(self);
        table
    }
}

/// A tabulated cone.
pub(super) struct Table {
    side: usize,
    /// Tangent of the angle at which the table ends.
    reach: f64,
    texels: Vec<f32>,
    /// Greatest distance from the profile, in shares of the peak.
    pub(super) worst: f64,
    /// Relative error of the flux.
    pub(super) flux_error: f64,
}

impl Table {
    /// How many texels wide so many tables can be.
    pub(super) fn side(tables: usize) -> usize {
        let each = MOST_TEXELS / tables.max(1);
        each.isqrt().clamp(8, 512)
    }

    /// The angle at which the table ends, in radians.
    pub(super) fn cutoff(&self) -> f64 {
        self.reach.atan()
    }

    /// The table as a grey portable float map, little-endian, rows from the bottom.
    pub(super) fn pfm(&self) -> Vec<u8> {
        let mut bytes = format!("Pf\n{0} {0}\n-1.0\n", self.side).into_bytes();
        bytes.extend_from_slice(bytemuck::cast_slice(&self.texels));
        bytes
    }

    /// The table between its texels, bilinear; `x` and `y` on the plane at distance 1.
    fn lookup(&self, x: f64, y: f64) -> f64 {
        let last = self.side - 1;
        let place = |v: f64| ((v / self.reach + 1.0) * 0.5 * self.side as f64 - 0.5).clamp(0.0, last as f64);
        let (u, v) = (place(x), place(y));
        let (i, j) = (u as usize, v as usize);
        let texel = |i: usize, j: usize| f64::from(self.texels[j.min(last) * self.side + i.min(last)]);
        let row = |j: usize| texel(i, j) + (texel(i + 1, j) - texel(i, j)) * u.fract();
        row(j) + (row(j + 1) - row(j)) * v.fract()
    }

    /// Measures the errors along three radii, over the cosines of the whole cone.
    fn compare(&mut self, cone: Cone) {
        const STEPS: usize = 4096;
        let (_, outer) = cone.cosines();
        let cos_cutoff = self.cutoff().cos();
        let (mut flux, mut truth) = (0.0, 0.0);
        for azimuth in [0.0, 0.3, 0.785] {
            let (sin, cos) = f64::sin_cos(azimuth);
            for step in 0..STEPS {
                let c = 1.0 - (1.0 - outer) * (step as f64 + 0.5) / STEPS as f64;
                let want = cone.profile(c);
                let r = (1.0 / (c * c) - 1.0).sqrt();
                let got = if c > cos_cutoff { self.lookup(r * cos, r * sin) } else { 0.0 };
                self.worst = self.worst.max((got - want).abs());
                flux += got;
                truth += want;
            }
        }
        self.flux_error = (flux / truth - 1.0).abs();
    }
}

/// A cone whose edge is the smoothstep in the cosine, as pbrt's, with the flux of ours.
pub(super) struct Smooth {
    /// Cosine of the angle up to which it is full.
    pub(super) inner: f64,
    /// Cosine of the angle where it ends.
    pub(super) outer: f64,
    /// Greatest distance from our profile, in shares of the peak.
    pub(super) worst: f64,
}

impl Smooth {
    /// The cone of equal flux that comes nearest to `cone`.
    ///
    /// Let `u` be 0 at our outer and 1 at our inner cosine. A ramp from `a` to `b` has the flux of `u^2` where
    /// `a + b = 4/3`: both integrals are 1/3 then. Of those, the greatest distance is least for [`START`]; an inner
    /// cone so narrow that `b` would lie beyond the axis needs a later start.
    pub(super) fn of(cone: Cone) -> Self {
        let (inner, outer) = cone.cosines();
        let width = inner - outer;
        let axis = (1.0 - outer) / width;
        let start = START.max(4.0 / 3.0 - axis);
        let end = 4.0 / 3.0 - start;
        let distance = |u: f64| {
            let t = ((u - start) / (end - start)).clamp(0.0, 1.0);
            (u.clamp(0.0, 1.0).powi(2) - t * t * (3.0 - 2.0 * t)).abs()
        };
        let worst = (0..=1000).map(|i| distance(f64::from(i) * 1e-3 * end)).fold(0.0, f64::max);
        Self { inner: (outer + end * width).min(1.0), outer: outer + start * width, worst }
    }
}

/// Where the smoothstep starts: the least greatest distance from `u^2`.
const START: f64 = 0.1823;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::light::cone_flux;
    use std::f64::consts::TAU;

    /// Half-angles in degrees: of lamps, nearly the narrowest that recipes know, the widest, without a full cone, almost
    /// without an edge.
    const CONES: [[f64; 2]; 6] = [[30.0, 75.0], [0.3, 0.5], [20.0, 90.0], [0.0, 45.0], [0.0, 90.0], [59.9, 60.0]];

    fn cones() -> impl Iterator<Item = Cone> {
        CONES.into_iter().map(|angles| {
            let [inner, outer] = angles.map(|angle| (angle.to_radians().cos().max(0.0) as f32).to_bits());
            Cone { inner, outer }
        })
    }

    /// The flux of a profile per candela of its peak, by the midpoint rule in the cosine.
    fn flux(from: f64, profile: impl Fn(f64) -> f64) -> f64 {
        const STEPS: u32 = 100_000;
        let step = (1.0 - from) / f64::from(STEPS);
        (0..STEPS).map(|i| TAU * step * profile(from + step * (f64::from(i) + 0.5))).sum()
    }

    fn truth(cone: Cone) -> f64 {
        f64::from(cone_flux(f32::from_bits(cone.inner), f32::from_bits(cone.outer)))
    }

    #[test]
    fn a_smoothstep_cone_has_the_same_flux_and_says_how_far_it_is_off() {
        for cone in cones() {
            let smooth = Smooth::of(cone);
            assert!(smooth.inner > smooth.outer && smooth.inner <= 1.0, "{} {}", smooth.inner, smooth.outer);
            let ramp = |c: f64| {
                let t = ((c - smooth.outer) / (smooth.inner - smooth.outer)).clamp(0.0, 1.0);
                t * t * (3.0 - 2.0 * t)
            };
            let (_, outer) = cone.cosines();
            let ratio = flux(outer, ramp) / flux(outer, |c| cone.profile(c));
            assert!((ratio - 1.0).abs() < 1e-6, "{:?}: {ratio}", cone.cosines());
            // f32 has few digits of 1 - cos for the narrowest.
            assert!((flux(outer, ramp) / truth(cone) - 1.0).abs() < 2e-3, "{:?}", cone.cosines());
            let worst = (0..=5000).map(|i| outer + (1.0 - outer) * f64::from(i) / 5000.0);
            let worst = worst.map(|c| (ramp(c) - cone.profile(c)).abs()).fold(0.0, f64::max);
            assert!(worst <= smooth.worst + 1e-3 && smooth.worst < 0.15, "{worst}, said to be {}", smooth.worst);
        }
        // A lamp's inner cone leaves room for the best of them.
        assert!((Smooth::of(cones().next().expect("the first")).worst - 0.0653).abs() < 1e-3);
    }

    #[test]
    fn a_table_says_how_far_it_is_off() {
        for cone in cones() {
            let table = cone.table(512);
            assert!(table.flux_error < 1e-3, "{:?}: {}", cone.cosines(), table.flux_error);
            assert!(
                table.worst < 0.01 || cone.cosines().0 - cone.cosines().1 < 0.01,
                "{:?}: {}",
                cone.cosines(),
                table.worst
            );
            let coarse = cone.table(64);
            assert!(coarse.worst >= table.worst && coarse.worst.is_finite());
        }
    }

    #[test]
    fn all_tables_together_stay_small() {
        assert_eq!(Table::side(1), 512);
        for tables in [64, 65, 1000, 100_000] {
            assert!(Table::side(tables).pow(2) * tables <= MOST_TEXELS, "{tables}");
        }
    }
}
