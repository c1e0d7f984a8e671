//! How a strategy is told from the others in a plot: colour, shape, and hollow and dashed when it is biased; other
//! renderers are dotted.

use crate::base::claim::Claim;
use plotters::prelude::*;
use plotters::style::Color;

/// Colours that stay apart for the colour-blind and on white (after Okabe and Ito 2008, the yellow left out).
const COLOURS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
    RGBColor(117, 76, 41),
];

/// The corners of the shapes, about a centre, in pixels; a circle has none.
const SHAPES: [&[(i32, i32)]; 5] = [
    &[],
    &[(-5, -5), (5, -5), (5, 5), (-5, 5)],
    &[(0, -7), (6, 5), (-6, 5)],
    &[(0, -7), (7, 0), (0, 7), (-7, 0)],
    &[(0, 7), (6, -5), (-6, -5)],
];

/// How the points of a curve are joined.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Line {
    /// Most curves.
    Solid,
    /// With hollow shapes.
    Dashed,
    /// Other renderers.
    Dotted,
    /// Hollow shapes by themselves.
    Loose,
}

/// The look of one strategy.
#[derive(Clone, Copy)]
pub(crate) struct Mark {
    /// Of lines and shapes.
    pub(crate) colour: RGBColor,
    /// None where the points are too many to be marked.
    shape: Option<&'static [(i32, i32)]>,
    /// Between its shapes.
    pub(crate) line: Line,
}

impl Mark {
    /// The look of the `nth` strategy that is neither floor nor ceiling: 35 differ. Floor and ceiling are grey and
    /// black.
    pub(crate) fn new(claim: &Claim, nth: usize) -> Self {
        match claim {
            Claim::Floor => Self { colour: RGBColor(150, 150, 150), shape: Some(SHAPES[1]), line: Line::Solid },
            Claim::Ceiling | Claim::Oracle => Self { colour: BLACK, shape: Some(SHAPES[1]), line: Line::Solid },
            Claim::External { .. } => Self { line: Line::Dotted, ..Self::nth(nth, false) },
            Claim::Unbiased | Claim::Biased { .. } => Self::nth(nth, matches!(claim, Claim::Biased { .. })),
        }
    }

    /// The look of the `nth` curve, dashed with hollow shapes if `hollow`: 35 differ.
    pub(crate) fn nth(nth: usize, hollow: bool) -> Self {
        // 7 and 5 have no common divisor: neighbours differ in both.
        Self {
            colour: COLOURS[nth % COLOURS.len()],
            shape: Some(SHAPES[nth % SHAPES.len()]),
            line: if hollow { Line::Dashed } else { Line::Solid },
        }
    }

    /// The shapes of the `nth` curve, hollow and without a line.
    pub(crate) fn loose(nth: usize) -> Self {
        Self { line: Line::Loose, ..Self::nth(nth, true) }
    }

    /// The line of the `nth` curve without its shapes.
    #[cfg(feature = "cli")]
    pub(crate) fn line(nth: usize, line: Line) -> Self {
        Self { shape: None, line, ..Self::nth(nth, false) }
    }

    /// Draws the shape about a pixel.
    pub(crate) fn draw<DB: DrawingBackend>(
        &self,
        area: &DrawingArea<DB, plotters::coord::Shift>,
        (x, y): (i32, i32),
    ) -> Result<(), DrawingAreaErrorKind<DB::ErrorType>> {
        let Some(shape) = self.shape else { return Ok(()) };
        // The inside hides the lines behind it, so that hollow shapes read as hollow.
        let hollow = matches!(self.line, Line::Dashed | Line::Loose);
        let inside = if hollow { WHITE.filled() } else { self.colour.filled() };
        let edge = if hollow { self.colour.stroke_width(2) } else { WHITE.stroke_width(1) };
        if shape.is_empty() {
            area.draw(&Circle::new((x, y), 6, inside))?;
            return area.draw(&Circle::new((x, y), 6, edge));
        }
        let mut corners: Vec<(i32, i32)> = shape.iter().map(|(dx, dy)| (x + dx, y + dy)).collect();
        area.draw(&Polygon::new(corners.clone(), inside))?;
        // The outline goes on to the second corner, so that the joint at the first one closes.
        corners.extend_from_within(..2);
        area.draw(&PathElement::new(corners, edge))
    }
}
