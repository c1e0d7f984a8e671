//! Curves as a picture: what any plot is drawn with.
//!
//! The file names fonts and holds none; whoever shows it chooses them. Coordinates are whole pixels, so that the same
//! rows give the same bytes everywhere.

use super::mark::{Line, Mark};
use crate::base::error::{Error, Result};
use plotters::coord::Shift;
use plotters::element::DashedPathElement;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// What is drawn on.
pub(crate) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
/// Whether it was.
pub(crate) type Drawn = std::result::Result<(), DrawingAreaErrorKind<std::io::Error>>;

/// Size of the picture in pixels; a long legend makes it taller.
pub(crate) const WIDTH: i32 = 1200;
const HEIGHT: i32 = 720;
/// The plot's own rectangle.
const LEFT: i32 = 88;
const RIGHT: i32 = 842;
const TOP: i32 = 82;
const BELOW: i32 = 74;
/// Where the legend begins.
const LEGEND: i32 = 872;

pub(crate) const INK: RGBColor = RGBColor(40, 40, 40);
pub(crate) const FAINT: RGBColor = RGBColor(110, 110, 110);

/// A plot before it is drawn.
pub(crate) struct Chart {
    /// What it is.
    pub(crate) title: String,
    /// What is drawn, in smaller letters.
    pub(crate) subtitle: String,
    /// The horizontal axis.
    pub(crate) x: Scale,
    /// The vertical axis.
    pub(crate) y: Scale,
    /// The curves, in the legend's order; those without points are not named.
    pub(crate) series: Vec<Series>,
    /// What stands under the legend, each line with its distance from the one before in pixels.
    pub(crate) remarks: Vec<(i32, String)>,
}

/// What an axis measures.
pub(crate) struct Scale {
    /// What is written along it.
    pub(crate) label: String,
    /// Whether it is logarithmic.
    pub(crate) logarithmic: bool,
}

/// A curve.
pub(crate) struct Series {
    /// Its name; what follows a `:` stands below it. One without a name is not in the legend.
    pub(crate) name: String,
    /// Its look.
    pub(crate) mark: Mark,
    /// Its points from left to right: only what the axes can show.
    pub(crate) points: Vec<Dot>,
}

/// A point of a curve.
#[derive(Clone, Copy)]
pub(crate) struct Dot {
    pub(crate) x: f64,
    pub(crate) y: f64,
    /// The ends of the interval of `y`: infinite where the runs cannot tell one, both not finite where it has none.
    pub(crate) low: f64,
    pub(crate) high: f64,
}

impl Dot {
    fn has_interval(&self) -> bool {
        self.low.is_finite() || self.high.is_finite()
    }
}

impl Scale {
    /// Whether the axis can show a value.
    pub(crate) fn shows(&self, value: f64) -> bool {
        value.is_finite() && (!self.logarithmic || value > 0.0)
    }

    fn place(&self, value: f64) -> f64 {
        if self.logarithmic { value.log10() } else { value }
    }
}

impl Chart {
    /// The plot as SVG.
    pub(crate) fn svg(&self) -> Result<String> {
        let mut svg = String::new();
        self.draw(&mut svg).map_err(|e| Error::Invalid(format!("cannot draw the plot of `{}`: {e}", self.title)))?;
        Ok(svg)
    }

    fn draw(&self, svg: &mut String) -> Drawn {
        let height = self.height(HEIGHT);
        let area = SVGBackend::with_string(svg, (WIDTH as u32, height as u32)).into_drawing_area();
        area.fill(&WHITE)?;
        self.draw_on(&area, height)?;
        area.present()
    }

    /// How tall it is at least: as wanted, unless its legend is longer.
    pub(crate) fn height(&self, wanted: i32) -> i32 {
        wanted.max(self.legend().last().map_or(0, |line| line.y) + 40)
    }

    /// Draws the plot on an area of the full width and of a height.
    pub(crate) fn draw_on(&self, area: &Area<'_>, height: i32) -> Drawn {
        text(area, &self.title, (LEFT, 34), 27, INK, (HPos::Left, VPos::Center))?;
        text(area, &self.subtitle, (LEFT, 61), 18, FAINT, (HPos::Left, VPos::Center))?;
        let points = || self.series.iter().flat_map(|series| &series.points);
        if points().next().is_none() {
            text(area, "no points to draw", ((LEFT + RIGHT) / 2, height / 2), 20, FAINT, (HPos::Center, VPos::Center))?;
        } else {
            let frame = Frame {
                x: Axis::over(&self.x, points().map(|p| p.x), LEFT, RIGHT),
                // As tall as it is wide at most, however long the legend.
                y: self.upright((height - BELOW).min(TOP + RIGHT - LEFT), TOP),
            };
            grid(area, &frame)?;
            self.series.iter().try_for_each(|series| band(area, &frame, series))?;
            self.series.iter().try_for_each(|series| line(area, &frame, series))?;
            self.series.iter().try_for_each(|series| arrows(area, &frame, series))?;
        }
        self.legend().iter().try_for_each(|line| line.draw(area))
    }

    /// The vertical axis between two pixels. It holds the points, and the ends of their intervals unless they are far off.
    fn upright(&self, from: i32, to: i32) -> Axis<'_> {
        let end = |p: &Dot, end: f64| match self.y.logarithmic {
            // Half a decade from its point: a wide interval must not press all curves flat.
            true if p.has_interval() => end.clamp(p.y / 3.0, p.y * 3.0),
            false if end.is_finite() => end,
            _ => p.y,
        };
        let points = self.series.iter().flat_map(|series| &series.points);
        Axis::over(&self.y, points.flat_map(|p| [p.y, end(p, p.low), end(p, p.high)]), from, to)
    }

    /// What the arrows at the frame mean, as far as there are any.
    fn arrows(&self) -> impl Iterator<Item = &'static str> {
        let axis = self.upright(1, 0);
        let points = self.series.iter().flat_map(|series| &series.points).filter(|p| p.has_interval());
        let off: Vec<f64> = points.flat_map(|p| [p.low, p.high]).filter(|&end| !axis.holds(end)).collect();
        let kinds = [
            (off.iter().any(|end| end.is_finite()), "open arrow: the interval goes on"),
            (off.iter().any(|end| end.is_infinite()), "filled arrow: too heavy a tail to say"),
        ];
        kinds.into_iter().filter_map(|(is_there, meaning)| is_there.then_some(meaning))
    }

    /// The names of what is drawn, parameters on lines of their own, then the remarks.
    fn legend(&self) -> Vec<LegendLine> {
        let mut lines: Vec<LegendLine> = Vec::new();
        let mut push = |step: i32, text: &str, mark| {
            let y = lines.last().map_or(TOP + 10, |last| last.y + step);
            lines.push(LegendLine { y, text: text.to_owned(), mark });
        };
        for Series { name, mark, .. } in self.series.iter().filter(|s| !s.points.is_empty() && !s.name.is_empty()) {
            let (name, parameters) = name.split_once(':').unwrap_or((name, ""));
            push(27, name, Some(*mark));
            wrapped(parameters).iter().for_each(|line| push(19, line, None));
        }
        self.remarks.iter().for_each(|(step, remark)| push(*step, remark, None));
        self.arrows().for_each(|meaning| push(25, meaning, None));
        lines
    }
}

/// One axis: from values to pixels.
struct Axis<'a> {
    scale: &'a Scale,
    /// The ends; decimal logarithms of them on a logarithmic one.
    low: f64,
    high: f64,
    from: i32,
    to: i32,
}

impl<'a> Axis<'a> {
    /// An axis that holds all `values`, with some room at both ends; at least one decade long if logarithmic.
    fn over(scale: &'a Scale, values: impl Iterator<Item = f64>, from: i32, to: i32) -> Self {
        let (low, high) = values
            .map(|value| scale.place(value))
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
        let least = if scale.logarithmic {
            (0.5 * (1.0 - (high - low))).max(0.08)
        } else {
            // A single value of a linear axis stands in the middle of an axis as long as it is large.
            if high > low { 0.0 } else { (0.5 * high.abs()).max(0.5) }
        };
        let room = (0.06 * (high - low)).max(least);
        Self { scale, low: low - room, high: high + room, from, to }
    }

    /// Whether `value` is within the axis.
    fn holds(&self, value: f64) -> bool {
        self.scale.shows(value) && (self.low..=self.high).contains(&self.scale.place(value))
    }

    /// The pixel of `value`, held within the axis.
    fn at(&self, value: f64) -> i32 {
        // The logarithm of what is below 0 would be no number; it is below every axis that has one.
        let value = if self.scale.logarithmic { value.max(0.0) } else { value };
        let share = ((self.scale.place(value) - self.low) / (self.high - self.low)).clamp(0.0, 1.0);
        self.from + (share * f64::from(self.to - self.from)).round() as i32
    }

    /// Values to mark, each with whether its line is a strong one and whether it gets a label.
    fn ticks(&self) -> Vec<(f64, bool, bool)> {
        if self.scale.logarithmic { self.decades() } else { self.steps() }
    }

    fn decades(&self) -> Vec<(f64, bool, bool)> {
        let decades = self.low.floor() as i32..=self.high.floor() as i32;
        // A short axis may hold only one power of ten: 2 and 5 are then needed to read it.
        let short = self.high - self.low < 2.2;
        let steps = |d: i32| (1..10).map(move |step| (d, step));
        // Labels stand 24 pixels or more apart.
        let apart = (24.0 * (self.high - self.low) / f64::from((self.to - self.from).abs())).ceil().max(1.0) as i32;
        let inside = |v: f64| (self.low..=self.high).contains(&v.log10());
        decades
            .flat_map(steps)
            // From text, so that labels are exact: 3 * 10^-2 is 0.03 and no neighbour of it.
            .filter_map(|(d, step)| Some((format!("{step}e{d}").parse().ok()?, step, d % apart == 0)))
            .filter(|&(v, ..)| inside(v))
            .map(|(v, step, labelled)| (v, step == 1, step == 1 && labelled || short && (step == 2 || step == 5)))
            .collect()
    }

    /// Multiples of 1, 2 or 5 times a power of ten, five to ten of them.
    fn steps(&self) -> Vec<(f64, bool, bool)> {
        let wanted = (self.high - self.low) / 10.0;
        let decade = wanted.log10().floor() as i32;
        let factors = [(1, decade), (2, decade), (5, decade), (1, decade + 1)];
        let size = |&(factor, decade): &(i64, i32)| factor as f64 * 10f64.powi(decade);
        let step = factors.into_iter().find(|step| size(step) >= wanted).unwrap_or((1, decade + 1));
        let number = |value: f64| (value / size(&step)).ceil() as i64;
        (number(self.low)..=number(self.high))
            .filter_map(|n| format!("{}e{}", n * step.0, step.1).parse().ok())
            .filter(|v| (self.low..=self.high).contains(v))
            .map(|v| (v, v == 0.0, true))
            .collect()
    }
}

/// Values to mark along a scale, each with its place between the ends, 0 to 1, and its label.
pub(crate) fn ticks(scale: &Scale, [low, high]: [f64; 2]) -> Vec<(f64, String)> {
    let axis = Axis { scale, low: scale.place(low), high: scale.place(high), from: 0, to: WIDTH };
    let place = |value: f64| (scale.place(value) - axis.low) / (axis.high - axis.low);
    let labelled = axis.ticks().into_iter().filter(|(_, _, labelled)| *labelled);
    labelled.map(|(value, _, _)| (place(value), label(value))).collect()
}

/// Both axes.
struct Frame<'a> {
    x: Axis<'a>,
    y: Axis<'a>,
}

fn grid(area: &Area, frame: &Frame) -> Drawn {
    let line = |from, to, decade: bool| {
        let colour = if decade { RGBColor(196, 196, 196) } else { RGBColor(236, 236, 236) };
        area.draw(&PathElement::new(vec![from, to], colour.stroke_width(1)))
    };
    let (bottom, top) = (frame.y.from, frame.y.to);
    // Faint lines first, so that decades cross over them.
    for decade in [false, true] {
        for (value, _, _) in frame.x.ticks().into_iter().filter(|t| t.1 == decade) {
            line((frame.x.at(value), bottom), (frame.x.at(value), top), decade)?;
        }
        for (value, _, _) in frame.y.ticks().into_iter().filter(|t| t.1 == decade) {
            line((LEFT, frame.y.at(value)), (RIGHT, frame.y.at(value)), decade)?;
        }
    }
    for (value, _, _) in frame.x.ticks().into_iter().filter(|t| t.2) {
        text(area, &label(value), (frame.x.at(value), bottom + 10), 18, INK, (HPos::Center, VPos::Top))?;
    }
    for (value, _, _) in frame.y.ticks().into_iter().filter(|t| t.2) {
        text(area, &label(value), (LEFT - 10, frame.y.at(value)), 18, INK, (HPos::Right, VPos::Center))?;
    }
    area.draw(&Rectangle::new([(LEFT, top), (RIGHT, bottom)], INK.stroke_width(1)))?;
    text(area, &frame.x.scale.label, ((LEFT + RIGHT) / 2, bottom + 42), 19, INK, (HPos::Center, VPos::Top))?;
    let upright = style(19, INK, (HPos::Center, VPos::Top)).transform(FontTransform::Rotate270);
    area.draw(&Text::new(frame.y.scale.label.clone(), (16, (top + bottom) / 2), upright))
}

/// The intervals about the curve, up or down to the frame where they go on beyond it; a whisker where a point that has
/// one stands alone.
fn band(area: &Area, frame: &Frame, Series { points, mark, .. }: &Series) -> Drawn {
    for stretch in points.chunk_by(|a, b| a.has_interval() && b.has_interval()).filter(|s| s[0].has_interval()) {
        let at = |p: &Dot, end| (frame.x.at(p.x), frame.y.at(end));
        let drawn = match stretch {
            [p] => area.draw(&PathElement::new(vec![at(p, p.low), at(p, p.high)], mark.colour.stroke_width(2))),
            _ => {
                let lower = stretch.iter().map(|p| at(p, p.low));
                let upper = stretch.iter().rev().map(|p| at(p, p.high));
                area.draw(&Polygon::new(lower.chain(upper).collect::<Vec<_>>(), mark.colour.mix(0.14)))
            }
        };
        drawn?;
    }
    Ok(())
}

/// A mark at the frame wherever an interval goes on beyond it: filled where it has no end.
fn arrows(area: &Area, frame: &Frame, Series { points, mark, .. }: &Series) -> Drawn {
    for p in points.iter().filter(|p| p.has_interval()) {
        for (end, inside) in [(p.low, -1), (p.high, 1)].into_iter().filter(|(end, _)| !frame.y.holds(*end)) {
            let (x, tip) = (frame.x.at(p.x), frame.y.at(end));
            let corners = [(x, tip), (x - 6, tip + 10 * inside), (x + 6, tip + 10 * inside)];
            let inner = if end.is_finite() { WHITE.filled() } else { mark.colour.filled() };
            area.draw(&Polygon::new(corners.to_vec(), inner))?;
            let outline: Vec<(i32, i32)> = corners.into_iter().chain([corners[0], corners[1]]).collect();
            area.draw(&PathElement::new(outline, mark.colour.stroke_width(2)))?;
            area.draw(&PathElement::new(vec![(x, frame.y.at(p.y)), (x, tip)], mark.colour.mix(0.5).stroke_width(1)))?;
        }
    }
    Ok(())
}

fn line(area: &Area, frame: &Frame, Series { points, mark, .. }: &Series) -> Drawn {
    let at: Vec<(i32, i32)> = points.iter().map(|p| (frame.x.at(p.x), frame.y.at(p.y))).collect();
    stroke(area, &at, mark)?;
    at.into_iter().try_for_each(|point| mark.draw(area, point))
}

/// A line in the look of `mark`.
fn stroke(area: &Area, at: &[(i32, i32)], mark: &Mark) -> Drawn {
    let look = mark.colour.stroke_width(2);
    if at.len() < 2 {
        return Ok(());
    }
    match mark.line {
        Line::Solid => area.draw(&PathElement::new(at.to_vec(), look)),
        Line::Dashed => area.draw(&DashedPathElement::new(at.iter().copied(), 7, 5, look)),
        Line::Dotted => area.draw(&DashedPathElement::new(at.iter().copied(), 2, 4, look)),
        Line::Loose => Ok(()),
    }
}

/// One line of text beside the plot, with the mark that it explains.
struct LegendLine {
    y: i32,
    text: String,
    mark: Option<Mark>,
}

impl LegendLine {
    fn draw(&self, area: &Area) -> Drawn {
        let (size, colour) = if self.mark.is_some() { (18, INK) } else { (16, FAINT) };
        if let Some(mark) = &self.mark {
            stroke(area, &[(LEGEND, self.y), (LEGEND + 36, self.y)], mark)?;
            mark.draw(area, (LEGEND + 18, self.y))?;
        }
        text(area, &self.text, (LEGEND + 48, self.y), size, colour, (HPos::Left, VPos::Center))
    }
}

/// `parameters` in lines of about 36 characters, broken after commas: what fits beside the plot.
fn wrapped(parameters: &str) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for part in parameters.split_inclusive(',') {
        match lines.last_mut() {
            Some(line) if line.len() + part.len() <= 36 => line.push_str(part),
            _ => lines.push(part.to_owned()),
        }
    }
    lines.retain(|line| !line.is_empty());
    lines
}

/// A tick's value: plain where that is short, a power of ten otherwise.
fn label(value: f64) -> String {
    if value == 0.0 || (1e-3..1e5).contains(&value) { format!("{value}") } else { format!("{value:e}") }
}

fn style(size: i32, colour: RGBColor, (h, v): (HPos, VPos)) -> TextStyle<'static> {
    ("Helvetica, Arial, sans-serif", size).into_font().color(&colour).pos(Pos::new(h, v))
}

/// Writes a line.
pub(crate) fn text(
    area: &Area,
    what: &str,
    at: (i32, i32),
    size: i32,
    colour: RGBColor,
    anchor: (HPos, VPos),
) -> Drawn {
    area.draw(&Text::new(what.to_owned(), at, style(size, colour, anchor)))
}
