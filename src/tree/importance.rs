//! How is a cluster weighed at a receiver?
//!
//! By an estimate, in lx, of the irradiance that its lights send there with nothing in between: peak intensity times
//! emission times the receiver's cosine over the squared distance. Clusters of points, spots and triangles compare,
//! since all are in one unit: weighed by flux, a lamp would count for four windows. Both ways of weighing are
//! conservative and neither depends on the unit of length. No trigonometric function is called.

use super::how::{Distance, How, Weighing};
use super::node::{Node, direction};
use crate::scene::receiver::Receiver;
use glam::Vec3;

/// What bounds rounding, as a share of the lengths involved: some thirty times half a unit in the last place. What
/// shading finds above a horizon by rounding alone must not be rejected here.
const MARGIN: f32 = 2e-6;

/// Least squared distance at which a cluster around the receiver is weighed, as a share of its squared half diagonal.
const NEAREST: f32 = 1e-5;

/// One over the solid angle of all that lies above a horizon. The mean of cosine over squared distance, over a plane
/// section of a box along the horizon, is the solid angle that it fills over its area: 2 pi at most, however near the
/// box is.
const HALF_SPACE: f32 = 1.0 / (2.0 * std::f32::consts::PI);

/// Least squared distance of the classic weight, as a share of the squared half diagonal: half the radius, as in its
/// source but in its unit.
const HALF_RADIUS2: f32 = 0.25;

/// How evenly a cluster's lights are thought to fill its box: a small share `s` of it above a horizon counts `1 + 1 / EVEN` times,
/// since what a few lights there add is seldom and much. On `downtown` and `metropolis` a light tree errs a fifth less than with
/// the share itself.
const EVEN: f32 = 0.5;

/// The estimates of a node's slots, 0 where no light of a slot can add anything.
pub(super) struct Weights<const N: usize> {
    /// At the distance of the centre, or at the greatest of the box.
    pub(super) far: [f32; N],
    /// At the least distance of the box; the same as `far` unless [`Distance::MinMax`] asks for it.
    pub(super) near: [f32; N],
}

/// Weighs the slots of a node.
#[inline]
pub(super) fn weigh<const N: usize>(node: &Node<N>, at: &Receiver, how: How) -> Weights<N> {
    pulp::Arch::new().dispatch(Weigh { node, at, how })
}

/// The work of [`weigh`], compiled for each instruction set: eight slots fill one register of AVX2. The numbers are the same in
/// all of them.
struct Weigh<'a, const N: usize> {
    node: &'a Node<N>,
    at: &'a Receiver,
    how: How,
}

impl<const N: usize> pulp::NullaryFnOnce for Weigh<'_, N> {
    type Output = Weights<N>;

    #[inline(always)]
    fn call(self) -> Weights<N> {
        let Self { node, at, how } = self;
        match (how.weighing, how.distance) {
            (Weighing::Box, Distance::Mean) => by_box::<N, false>(node, at),
            (Weighing::Box, Distance::MinMax) => by_box::<N, true>(node, at),
            (Weighing::Classic, Distance::Mean) => classic::<N, false>(node, at),
            (Weighing::Classic, Distance::MinMax) => classic::<N, true>(node, at),
        }
    }
}

/// `a` or `b` by a comparison: compiles to a minimum or maximum without the care for NaN that [`f32::max`] takes.
#[inline(always)]
fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

#[inline(always)]
fn smaller(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// Of an interval from `bottom` to `top` > 0: the share above 0, more where that is small, and the mean over that.
#[inline(always)]
fn above(bottom: f32, top: f32) -> (f32, f32) {
    let from = larger(bottom, 0.0);
    let length = top - from;
    ((1.0 + EVEN) * length / (length + EVEN * (top - bottom)), 0.5 * (top + from))
}

#[inline(always)]
fn by_box<const N: usize, const MINMAX: bool>(node: &Node<N>, at: &Receiver) -> Weights<N> {
    let [px, py, pz] = at.position.to_array();
    let [nx, ny, nz] = at.normal.to_array();
    let [mx, my, mz] = at.normal.abs().to_array();
    let mut weights = Weights { far: [0.0; N], near: [0.0; N] };
    for j in 0..N {
        let (vx, vy, vz) = (node.centre[0][j] - px, node.centre[1][j] - py, node.centre[2][j] - pz);
        let (hx, hy, hz) = (node.half[0][j], node.half[1][j], node.half[2][j]);
        let [wx, wy, wz] = direction(&node.axis, j);
        let [ax, ay, az] = direction(&node.axis_half, j);
        let d2 = vx * vx + vy * vy + vz * vz;
        let r2 = hx * hx + hy * hy + hz * hz;
        let (d, r) = (d2.sqrt(), r2.sqrt());
        let margin = MARGIN * (d + r);

        // Heights of the box over the receiver's horizon.
        let height = nx * vx + ny * vy + nz * vz;
        let half_height = mx * hx + my * hy + mz * hz + margin;
        let top = height + half_height;
        let (share, mean) = above(height - half_height, top);

        // The same over the emitters' horizon: distance times (cosine less cut), over places and directions.
        let cut = node.cut[j];
        let facing = -(wx * vx + wy * vy + wz * vz) - cut * d;
        let half_facing = wx.abs() * hx
            + wy.abs() * hy
            + wz.abs() * hz
            + ax * (vx.abs() + hx)
            + ay * (vy.abs() + hy)
            + az * (vz.abs() + hz)
            + cut.abs() * r
            + margin;
        let lit = facing + half_facing;
        let (lit_share, lit_mean) = above(facing - half_facing, lit);

        let near2 = box_distance2([vx, vy, vz], [hx, hy, hz], -1.0);
        let far2 = box_distance2([vx, vy, vz], [hx, hy, hz], 1.0);
        let floored2 = larger(near2, NEAREST * r2);
        // The mean of 1/d^2 for distances evenly between the least and the greatest.
        let typical2 = (floored2 * far2).sqrt();
        // Of the same distance: what hardly rises above a horizon counts little, however near.
        let per_metre = 1.0 / typical2.sqrt();
        let cosine = smaller(1.0, mean * per_metre);
        let emission = lit_share * smaller(1.0, node.gain[j] * lit_mean * per_metre);
        // Where the box does not say which way its lights face, they may face any way.
        let unknown = smaller(1.0, half_facing * per_metre);
        let emission = emission + unknown * (node.any_way[j] - emission);
        let arriving = node.peak[j] * emission * share * cosine;
        // Area of the box seen along the normal.
        let section = 4.0 * (mx * hy * hz + my * hz * hx + mz * hx * hy);
        // Not 0 by underflow, nor beyond f32: only what is rejected weighs nothing.
        let keep = |value: f32| {
            let value = larger(smaller(value, f32::MAX), f32::MIN_POSITIVE);
            if (top > 0.0) & (lit > 0.0) { value } else { 0.0 }
        };
        if MINMAX {
            weights.near[j] = keep(arriving / floored2);
            weights.far[j] = keep(arriving / far2);
        } else {
            weights.far[j] = keep(arriving / (typical2 + cosine * section * HALF_SPACE));
            weights.near[j] = weights.far[j];
        }
    }
    weights
}

/// Squared distance to the nearest (`side` -1) or farthest (1) point of a box.
#[inline(always)]
fn box_distance2(v: [f32; 3], half: [f32; 3], side: f32) -> f32 {
    let along = |k: usize| larger(v[k].abs() + side * half[k], 0.0);
    let (x, y, z) = (along(0), along(1), along(2));
    x * x + y * y + z * z
}

/// Cosine of an angle less another, 1 if that is negative; both within 0 and pi, given by their cosines.
///
/// Never less than exact: where a cosine is near -1 or 1, half its digits are missing from its sine, and these are
/// added.
#[inline(always)]
fn cos_minus(cos_a: f32, cos_b: f32) -> f32 {
    let sin = |cos: f32| (larger(1.0 - cos * cos, 0.0) + MARGIN).sqrt();
    if cos_a > cos_b { 1.0 } else { smaller(cos_a * cos_b + sin(cos_a) * sin(cos_b), 1.0) }
}

#[inline(always)]
fn classic<const N: usize, const MINMAX: bool>(node: &Node<N>, at: &Receiver) -> Weights<N> {
    let [px, py, pz] = at.position.to_array();
    let [nx, ny, nz] = at.normal.to_array();
    let mut weights = Weights { far: [0.0; N], near: [0.0; N] };
    for j in 0..N {
        let (vx, vy, vz) = (node.centre[0][j] - px, node.centre[1][j] - py, node.centre[2][j] - pz);
        let (hx, hy, hz) = (node.half[0][j], node.half[1][j], node.half[2][j]);
        let [wx, wy, wz] = direction(&node.axis, j);
        let [ax, ay, az] = direction(&node.axis_half, j);
        let d2 = vx * vx + vy * vy + vz * vz;
        let r2 = hx * hx + hy * hy + hz * hz;
        let d = larger(d2, f32::MIN_POSITIVE).sqrt();
        // Half-angle of the bounding sphere, wide enough for rounding; within the sphere, any direction.
        let outside = 1.0 - r2 / larger(d2, f32::MIN_POSITIVE);
        let bound = if outside > 0.0 { outside.sqrt() - MARGIN } else { -1.0 };
        // The cone of directions: see `Bounds::cosine`.
        let w2 = wx * wx + wy * wy + wz * wz;
        let (w, a2) = (larger(w2, 1e-6).sqrt(), ax * ax + ay * ay + az * az);
        let cone =
            if (w2 > 1e-6) & (node.cut[j] >= 0.0) { larger(0.5 * (1.0 + w2 - a2) / w - MARGIN, -1.0) } else { -1.0 };
        let towards = larger(smaller(-(wx * vx + wy * vy + wz * vz) / (w * d), 1.0), -1.0);
        let emission = cos_minus(cos_minus(towards, cone), bound) + MARGIN;
        let cosine = smaller((nx * vx + ny * vy + nz * vz).abs() / d, 1.0);
        let arriving = node.peak[j] * larger(emission, 0.0) * cos_minus(cosine, bound);
        let keep = |value: f32| {
            let value = larger(smaller(value, f32::MAX), f32::MIN_POSITIVE);
            if emission > node.cut[j] { value } else { 0.0 }
        };
        if MINMAX {
            let (near2, far2) =
                (box_distance2([vx, vy, vz], [hx, hy, hz], -1.0), box_distance2([vx, vy, vz], [hx, hy, hz], 1.0));
            weights.near[j] = keep(arriving / larger(near2, NEAREST * r2));
            weights.far[j] = keep(arriving / far2);
        } else {
            weights.far[j] = keep(arriving / larger(d2, HALF_RADIUS2 * r2));
            weights.near[j] = weights.far[j];
        }
    }
    weights
}

/// Luminance of the irradiance from a directional light, in lx.
#[inline]
pub(super) fn directional(towards: Vec3, strength: f32, at: &Receiver) -> f32 {
    strength * at.normal.dot(towards).max(0.0)
}
