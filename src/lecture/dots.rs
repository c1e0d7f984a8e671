//! Points in a triangle that is laid flat.

/// A triangle, points in it, and where its viewer is.
pub(super) struct Dots {
    /// The corners, in the triangle's plane: x to the right, y up, in metres.
    pub(super) corners: [[f64; 2]; 3],
    /// The points.
    pub(super) points: Vec<[f64; 2]>,
    /// The part that is told apart: its corners.
    pub(super) part: [[f64; 2]; 3],
    /// Foot of the perpendicular from the receiver, held near the triangle.
    pub(super) receiver: [f64; 2],
}

impl Dots {
    /// Corners of the box around all of it.
    fn bounds(&self) -> ([f64; 2], [f64; 2]) {
        let all = self.corners.iter().chain([&self.receiver]);
        all.fold(([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]), |(low, high), p| {
            ([low[0].min(p[0]), low[1].min(p[1])], [high[0].max(p[0]), high[1].max(p[1])])
        })
    }

    /// Corners of that box with room about it, as large in both ways.
    pub(super) fn frame(&self) -> ([f64; 2], [f64; 2]) {
        let (low, high) = self.bounds();
        let room = 0.06 * (high[0] - low[0]).max(high[1] - low[1]).max(1e-9);
        (low.map(|low| low - room), high.map(|high| high + room))
    }
}
