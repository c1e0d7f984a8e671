//! Error against time as a picture: log-log, one curve per strategy, its interval as a band.
//!
//! The file names fonts and holds none; whoever shows it chooses them. Coordinates are whole pixels, so that the same rows
//! give the same bytes everywhere.

use super::curve::{Curve, Point, rows_of};
use super::figures;
use super::mark::Mark;
use crate::base::error::{Error, Result};
use crate::record::{Claim, Row, SceneRecord, Summary};
use plotters::coord::Shift;
use plotters::element::DashedPathElement;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Drawn = std::result::Result<(), DrawingAreaErrorKind<std::io::Error>>;

/// Size of the picture in pixels; a long legend makes it taller.
const WIDTH: i32 = 1200;
const HEIGHT: i32 = 720;
/// The plot's own rectangle.
const LEFT: i32 = 88;
const RIGHT: i32 = 842;
const TOP: i32 = 82;
const BELOW: i32 = 74;
/// Where the legend begins.
const LEGEND: i32 = 872;

const INK: RGBColor = RGBColor(40, 40, 40);
const FAINT: RGBColor = RGBColor(110, 110, 110);

/// A strategy as it is drawn.
struct Entry<'a> {
    summary: &'a Summary,
    /// Only what logarithmic axes can show.
    curve: Curve,
    /// Whether there are points with an error of exactly 0.
    exact: bool,
    mark: Mark,
}

/// The plot of a scene as SVG: relMSE over receivers against CPU seconds, set-up included, means over runs with 95 % intervals.
///
/// Biased strategies are dashed and hollow. What a logarithmic axis cannot show (an error of exactly 0) is named under the legend.
/// `rows` may hold other scenes too.
pub fn plot(scene: &SceneRecord, rows: &[Row]) -> Result<String> {
    let mut summaries: Vec<&Summary> = scene.summaries.iter().collect();
    summaries.sort_by(|a, b| figures::order(a, b));
    let rows = rows_of(rows, &scene.name);
    let entries: Vec<Entry> = summaries
        .into_iter()
        .map(|summary| {
            // By name and not by rank: a strategy keeps its look from scene to scene of a run.
            let coloured = |s: &Summary| !matches!(s.claim, Claim::Floor | Claim::Ceiling | Claim::Oracle);
            let before = scene.summaries.iter().filter(|s| coloured(s) && s.strategy < summary.strategy);
            let nth = before.count();
            let mut curve = Curve::of(&rows, &summary.strategy);
            let exact = curve.is_exact();
            curve.points.retain(Point::is_drawable);
            Entry { summary, curve, exact, mark: Mark::new(&summary.claim, nth) }
        })
        .collect();
    let mut svg = String::new();
    draw(&mut svg, scene, &entries)
        .map_err(|e| Error::Invalid(format!("cannot draw the plot of `{}`: {e}", scene.name)))?;
    Ok(svg)
}

fn draw(svg: &mut String, scene: &SceneRecord, entries: &[Entry]) -> Drawn {
    let legend = legend_lines(entries);
    let height = HEIGHT.max(legend.last().map_or(0, |line| line.y) + 40);
    let area = SVGBackend::with_string(svg, (WIDTH as u32, height as u32)).into_drawing_area();
    area.fill(&WHITE)?;
    let runs = entries.iter().map(|e| e.summary.runs).max().unwrap_or(0);
    text(&area, &scene.name, (LEFT, 34), 27, INK, (HPos::Left, VPos::Center))?;
    let subtitle = format!("relMSE against CPU seconds, set-up included; mean of {runs} runs, bands: 95 % intervals");
    text(&area, &subtitle, (LEFT, 61), 18, FAINT, (HPos::Left, VPos::Center))?;
    let points = || entries.iter().flat_map(|e| &e.curve.points);
    if points().next().is_none() {
        text(&area, "no points to draw", ((LEFT + RIGHT) / 2, height / 2), 20, FAINT, (HPos::Center, VPos::Center))?;
    } else {
        let frame = Frame {
            x: Axis::over(points().map(|p| p.seconds), LEFT, RIGHT),
            // As tall as it is wide at most, however long the legend.
            y: Axis::over(points().map(|p| p.error), (height - BELOW).min(TOP + RIGHT - LEFT), TOP),
        };
        grid(&area, &frame)?;
        entries.iter().try_for_each(|entry| band(&area, &frame, entry))?;
        entries.iter().try_for_each(|entry| line(&area, &frame, entry))?;
    }
    legend.iter().try_for_each(|line| line.draw(&area))?;
    area.present()
}

/// One logarithmic axis: from powers of ten to pixels.
struct Axis {
    /// Decimal logarithms of the ends.
    low: f64,
    high: f64,
    from: i32,
    to: i32,
}

impl Axis {
    /// An axis that holds all `values`, with some room at both ends; at least one decade long.
    fn over(values: impl Iterator<Item = f64>, from: i32, to: i32) -> Self {
        let (low, high) =
            values.map(f64::log10).fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
        let room = (0.06 * (high - low)).max(0.5 * (1.0 - (high - low))).max(0.08);
        Self { low: low - room, high: high + room, from, to }
    }

    /// The pixel of `value`, held within the axis.
    fn at(&self, value: f64) -> i32 {
        let share = ((value.log10() - self.low) / (self.high - self.low)).clamp(0.0, 1.0);
        self.from + (share * f64::from(self.to - self.from)).round() as i32
    }

    /// Values to mark, each with whether it is a power of ten and whether it gets a label.
    fn ticks(&self) -> Vec<(f64, bool, bool)> {
        let decades = self.low.floor() as i32..=self.high.floor() as i32;
        // A short axis may hold only one power of ten: 2 and 5 are then needed to read it.
        let short = self.high - self.low < 2.2;
        let steps = |d: i32| (1..10).map(move |step| (d, step));
        let inside = |v: f64| (self.low..=self.high).contains(&v.log10());
        decades
            .flat_map(steps)
            // From text, so that labels are exact: 3 * 10^-2 is 0.03 and no neighbour of it.
            .filter_map(|(d, step)| Some((format!("{step}e{d}").parse().ok()?, step)))
            .filter(|&(v, _)| inside(v))
            .map(|(v, step)| (v, step == 1, step == 1 || short && (step == 2 || step == 5)))
            .collect()
    }
}

/// Both axes.
struct Frame {
    x: Axis,
    y: Axis,
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
    text(area, "CPU seconds", ((LEFT + RIGHT) / 2, bottom + 42), 19, INK, (HPos::Center, VPos::Top))?;
    let upright = style(19, INK, (HPos::Center, VPos::Top)).transform(FontTransform::Rotate270);
    area.draw(&Text::new("relMSE", (16, (top + bottom) / 2), upright))
}

/// The interval about the curve; a whisker where there is a single budget.
fn band(area: &Area, frame: &Frame, Entry { curve, mark, .. }: &Entry) -> Drawn {
    let ends = curve.points.iter().filter(|p| p.half_width.is_finite()).map(|p| {
        // What reaches down to 0 or below ends at the axis.
        let low = (p.error - p.half_width).max(f64::MIN_POSITIVE);
        (frame.x.at(p.seconds), frame.y.at(low), frame.y.at(p.error + p.half_width))
    });
    let ends: Vec<(i32, i32, i32)> = ends.collect();
    if let &[(x, low, high)] = &ends[..] {
        return area.draw(&PathElement::new(vec![(x, low), (x, high)], mark.colour.stroke_width(2)));
    }
    let lower = ends.iter().map(|&(x, low, _)| (x, low));
    let upper = ends.iter().rev().map(|&(x, _, high)| (x, high));
    area.draw(&Polygon::new(lower.chain(upper).collect::<Vec<_>>(), mark.colour.mix(0.14)))
}

fn line(area: &Area, frame: &Frame, Entry { curve, mark, .. }: &Entry) -> Drawn {
    let at: Vec<(i32, i32)> = curve.points.iter().map(|p| (frame.x.at(p.seconds), frame.y.at(p.error))).collect();
    stroke(area, &at, mark)?;
    at.into_iter().try_for_each(|point| mark.draw(area, point))
}

/// A line in the look of `mark`: dashed when it is hollow.
fn stroke(area: &Area, at: &[(i32, i32)], mark: &Mark) -> Drawn {
    let look = mark.colour.stroke_width(2);
    if at.len() < 2 {
        Ok(())
    } else if mark.hollow {
        area.draw(&DashedPathElement::new(at.iter().copied(), 7, 5, look))
    } else {
        area.draw(&PathElement::new(at.to_vec(), look))
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

/// The names of what is drawn in the order of the table, parameters on lines of their own, then what is not drawn and why.
fn legend_lines(entries: &[Entry]) -> Vec<LegendLine> {
    let mut lines: Vec<LegendLine> = Vec::new();
    let mut push = |step: i32, text: &str, mark| {
        let y = lines.last().map_or(TOP + 10, |last| last.y + step);
        lines.push(LegendLine { y, text: text.to_owned(), mark });
    };
    for Entry { summary, mark, .. } in entries.iter().filter(|e| !e.curve.points.is_empty()) {
        let (name, parameters) = summary.strategy.split_once(':').unwrap_or((&summary.strategy, ""));
        push(27, name, Some(*mark));
        wrapped(parameters).iter().for_each(|line| push(19, line, None));
    }
    if entries.iter().any(|e| e.mark.hollow && !e.curve.points.is_empty()) {
        push(34, "dashed and hollow: biased", None);
    }
    for (at, entry) in entries.iter().filter(|e| e.exact).enumerate() {
        push(if at == 0 { 25 } else { 19 }, &format!("exact, not drawn: {}", entry.summary.strategy), None);
    }
    lines
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
    if (1e-3..1e5).contains(&value) { format!("{value}") } else { format!("{value:e}") }
}

fn style(size: i32, colour: RGBColor, (h, v): (HPos, VPos)) -> TextStyle<'static> {
    ("Helvetica, Arial, sans-serif", size).into_font().color(&colour).pos(Pos::new(h, v))
}

fn text(area: &Area, what: &str, at: (i32, i32), size: i32, colour: RGBColor, anchor: (HPos, VPos)) -> Drawn {
    area.draw(&Text::new(what.to_owned(), at, style(size, colour, anchor)))
}
