//! How are the slots of a node laid out?
//!
//! Structure of arrays, so that all slots are weighed together, four a vector register on any x86-64.

use super::bounds::{Bounds, Item, centred};
use super::how::Facing;
use crate::scene::light::LightId;
use crate::scene::receiver::Receiver;
use glam::Vec3;

/// Marks a link to a light; the other bits are its number.
const LIGHT: u32 = 1 << 31;

/// What is in a slot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Slot {
    /// A cluster: its node, counted from this one.
    Node(u32),
    /// A light.
    Light(LightId),
    /// Nothing.
    Empty,
}

/// Directions are kept in 16 bits a component, their boxes rounded outward: a box of directions is then at most two steps
/// wider, and exact for what faces along an axis. A power of two, so that 0 and 1 stay what they are.
pub(crate) const STEP: f32 = 1.0 / 16_384.0;

/// Up to `N` clusters or lights and what bounds each; lengths in metres.
#[derive(Clone, Debug)]
pub(super) struct Node<const N: usize> {
    /// Centres of the boxes.
    pub(super) centre: [[f32; N]; 3],
    /// Half the extents of the boxes.
    pub(super) half: [[f32; N]; 3],
    /// Centres of the boxes of directions, in units of [`STEP`].
    pub(super) axis: [[i16; N]; 3],
    /// Half the extents of the boxes of directions, in units of [`STEP`].
    pub(super) axis_half: [[i16; N]; 3],
    /// No light of the slot shines where the cosine at it is this or less.
    pub(super) cut: [f32; N],
    /// By how much emission grows with the cosine above `cut`, until it is full.
    pub(super) gain: [f32; N],
    /// Emission where nothing is known of the direction, as a share of the peak.
    pub(super) any_way: [f32; N],
    /// Sum of the luminances of the peak intensities, in cd; 0 of an empty slot.
    pub(super) peak: [f32; N],
    link: [u32; N],
    /// Variance of the lights' peaks over their squared mean.
    pub(super) unevenness: f32,
}

impl<const N: usize> Node<N> {
    /// A node over `items`; all slots empty.
    pub(super) fn new(items: &[Item]) -> Self {
        Self {
            centre: [[0.0; N]; 3],
            half: [[0.0; N]; 3],
            axis: [[0; N]; 3],
            axis_half: [[0; N]; 3],
            // Beyond any cosine: an empty slot is rejected as one that shines nowhere.
            cut: [2.0; N],
            gain: [0.0; N],
            any_way: [0.0; N],
            peak: [0.0; N],
            link: [0; N],
            unevenness: unevenness(items),
        }
    }

    /// Puts `items` into slot `j`, with a link to the light if it is one; [`descend`](Self::descend) sets it otherwise.
    pub(super) fn bound(&mut self, j: usize, bounds: &Bounds, items: &[Item], facing: Facing) {
        let (centre, half) = centred(bounds.low, bounds.high);
        for k in 0..3 {
            (self.centre[k][j], self.half[k][j]) = (centre[k], half[k]);
            (self.axis[k][j], self.axis_half[k][j]) = steps(bounds.axis_low[k], bounds.axis_high[k]);
        }
        // By peak.
        let mean = |of: fn(&Item) -> f32| {
            let sum: f64 = items.iter().map(|item| f64::from(of(item)) * f64::from(item.peak)).sum();
            (sum / bounds.peak) as f32
        };
        self.cut[j] = bounds.cut;
        self.gain[j] = 1.0 / (mean(|item| item.full) - bounds.cut).max(f32::EPSILON);
        self.any_way[j] = match facing {
            Facing::Mean => mean(|item| item.moment(1)),
            Facing::Rms => mean(|item| item.moment(2)).sqrt(),
        };
        self.peak[j] = (bounds.peak as f32).min(f32::MAX);
        if let [item] = items {
            self.link[j] = LIGHT | item.light;
        }
    }

    /// Links slot `j` to the node `offset` places on.
    pub(super) fn descend(&mut self, j: usize, offset: usize) {
        self.link[j] = offset as u32;
    }

    /// The node with all boxes grown on each side by so much: at the middle of a box with these half extents, it is as high
    /// over a horizon and as near as it is anywhere in that box.
    pub(super) fn grown(&self, by: Vec3) -> Self {
        let mut grown = self.clone();
        for (half, by) in grown.half.iter_mut().zip(by.to_array()) {
            half.iter_mut().for_each(|half| *half += by);
        }
        grown
    }

    /// What is in slot `j`.
    #[inline]
    pub(super) fn slot(&self, j: usize) -> Slot {
        match self.link[j] {
            0 => Slot::Empty,
            link if link & LIGHT != 0 => Slot::Light(link & !LIGHT),
            offset => Slot::Node(offset),
        }
    }

    /// Least and greatest distance of a slot's box, in metres.
    pub(super) fn distances(&self, j: usize, at: &Receiver) -> [f32; 2] {
        let to_centre = (Self::vector(&self.centre, j) - at.position).abs();
        let half = Self::vector(&self.half, j);
        [(to_centre - half).max(Vec3::ZERO).length(), (to_centre + half).length()]
    }

    /// The most irradiance that the lights of a slot can send, in lx: all of them at the nearest point of the box, with the
    /// greatest cosines that any point of it has.
    pub(super) fn upper_bound(&self, j: usize, at: &Receiver) -> f32 {
        let [centre, half] = [&self.centre, &self.half].map(|lanes| Self::vector(lanes, j));
        let [axis, axis_half] = [&self.axis, &self.axis_half].map(|lanes| Vec3::from(direction(lanes, j)));
        let to_centre = centre - at.position;
        let [near, _] = self.distances(j, at);
        let top = at.normal.dot(to_centre) + at.normal.abs().dot(half);
        // Triangles alone: their emission is the cosine. Others may be full at any.
        let emission = if self.cut[j] == 0.0 && self.gain[j] <= 1.0 {
            let lit = axis_half.dot(to_centre.abs() + half) + axis.abs().dot(half) - axis.dot(to_centre);
            (lit / near).min(1.0)
        } else {
            1.0
        };
        // Two negative cosines would make a bound of what is doubly dark.
        if top <= 0.0 || emission <= 0.0 {
            return 0.0;
        }
        let bound = self.peak[j] * (top / near).min(1.0) * emission / (near * near);
        if bound.is_finite() { bound } else { f32::MAX }
    }

    /// A vector of one slot.
    #[inline]
    fn vector(lanes: &[[f32; N]; 3], j: usize) -> Vec3 {
        Vec3::new(lanes[0][j], lanes[1][j], lanes[2][j])
    }
}

/// Centre and half extent of an interval of directions' components, in units of [`STEP`]; none of it is left out.
pub(crate) fn steps(low: f32, high: f32) -> (i16, i16) {
    let (low, high) = ((low / STEP).floor() as i16, (high / STEP).ceil() as i16);
    let middle = low.midpoint(high);
    (middle, (high - middle).max(middle - low))
}

/// A direction, or half the extent of a box of them, of one slot.
#[inline(always)]
pub(super) fn direction<const N: usize>(lanes: &[[i16; N]; 3], j: usize) -> [f32; 3] {
    [0, 1, 2].map(|k| f32::from(lanes[k][j]) * STEP)
}

fn unevenness(items: &[Item]) -> f32 {
    let peak = |item: &Item| f64::from(item.peak);
    let mean = items.iter().map(peak).sum::<f64>() / items.len() as f64;
    let squares: f64 = items.iter().map(|item| (peak(item) / mean - 1.0).powi(2)).sum();
    (squares / items.len() as f64) as f32
}
