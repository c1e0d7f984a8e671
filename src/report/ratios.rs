//! How do ratios over replicates look as a picture? A line a strategy: a dot for each replicate, and the mean with its
//! interval.

use super::chart::{Area, Drawn, FAINT, INK, Scale, WIDTH, text, ticks};
use super::mark::Mark;
use crate::base::error::{Error, Result};
use crate::record::Interval;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

/// A strategy.
pub(super) struct Bar {
    /// Its name.
    pub(super) name: String,
    /// The mean of its ratios, and its interval.
    pub(super) interval: Interval,
    /// Its ratios, each with the number of its view.
    pub(super) dots: Vec<(f64, usize)>,
}

/// The plot's own rectangle, in pixels; names stand left of it.
const LEFT: i32 = 330;
const RIGHT: i32 = WIDTH - 40;
const TOP: i32 = 112;
/// Height of a strategy's line.
const STEP: i32 = 38;
/// Most letters of a name.
const LONGEST: usize = 38;

/// The plot of `bars`, from the top, as SVG; views are named where there are several.
///
/// # Errors
/// A plot that cannot be drawn.
pub(super) fn ratios(title: &str, subtitle: &str, bars: &[Bar], views: &[&str]) -> Result<String> {
    let mut svg = String::new();
    let bottom = TOP + STEP * bars.len().max(1) as i32;
    let mut draw = || -> Drawn {
        let area = SVGBackend::with_string(&mut svg, (WIDTH as u32, (bottom + 74) as u32)).into_drawing_area();
        area.fill(&WHITE)?;
        text(&area, title, (40, 34), 27, INK, (HPos::Left, VPos::Center))?;
        text(&area, subtitle, (40, 61), 18, FAINT, (HPos::Left, VPos::Center))?;
        if views.len() > 1 {
            legend(&area, views)?;
        }
        let axis = Axis::over(bars);
        grid(&area, &axis, bottom)?;
        for (at, bar) in bars.iter().enumerate() {
            line(&area, &axis, bar, TOP + STEP * at as i32 + STEP / 2)?;
        }
        area.present()
    };
    draw().map_err(|e| Error::Invalid(format!("cannot draw the plot of `{title}`: {e}")))?;
    Ok(svg)
}

/// From ratios to pixels, by their logarithms.
struct Axis {
    low: f64,
    high: f64,
}

impl Axis {
    /// An axis that holds 1 and all dots, with some room; intervals may go on beyond it.
    fn over(bars: &[Bar]) -> Self {
        // What overflows or vanishes is held at the frame.
        let ratios = bars.iter().flat_map(|bar| &bar.dots).map(|(ratio, _)| ratio.clamp(1e-100, 1e100));
        let (low, high) = ratios.fold((1.0f64, 1.0f64), |(low, high), ratio| (low.min(ratio), high.max(ratio)));
        let room = (high / low).powf(0.06).max(1.2);
        Self { low: low / room, high: high * room }
    }

    /// The pixel of a ratio, held within the axis.
    fn at(&self, ratio: f64) -> i32 {
        let share = ((ratio / self.low).ln() / (self.high / self.low).ln()).clamp(0.0, 1.0);
        LEFT + (share * f64::from(RIGHT - LEFT)).round() as i32
    }
}

fn grid(area: &Area<'_>, axis: &Axis, bottom: i32) -> Drawn {
    let scale = Scale { label: String::new(), logarithmic: true };
    let upright = |x: i32, colour: RGBColor, width| {
        area.draw(&PathElement::new(vec![(x, TOP), (x, bottom)], colour.stroke_width(width)))
    };
    for (share, label) in ticks(&scale, [axis.low, axis.high]) {
        let x = LEFT + (share * f64::from(RIGHT - LEFT)).round() as i32;
        upright(x, RGBColor(222, 222, 222), 1)?;
        text(area, &label, (x, bottom + 10), 18, INK, (HPos::Center, VPos::Top))?;
    }
    upright(axis.at(1.0), FAINT, 2)?;
    area.draw(&Rectangle::new([(LEFT, TOP), (RIGHT, bottom)], INK.stroke_width(1)))?;
    text(area, "ratio, less is better", ((LEFT + RIGHT) / 2, bottom + 42), 19, INK, (HPos::Center, VPos::Top))
}

fn line(area: &Area<'_>, axis: &Axis, bar: &Bar, y: i32) -> Drawn {
    let cut = bar.name.chars().count() > LONGEST;
    let name: String =
        bar.name.chars().take(if cut { LONGEST - 1 } else { LONGEST }).chain(cut.then_some('…')).collect();
    text(area, &name, (LEFT - 14, y), 17, INK, (HPos::Right, VPos::Center))?;
    // Below the middle, where no dot hides it.
    let Interval { mean, low, high } = bar.interval;
    let below = y + 10;
    area.draw(&PathElement::new(vec![(axis.at(low), below), (axis.at(high), below)], INK.stroke_width(2)))?;
    for end in [low, high] {
        area.draw(&PathElement::new(vec![(axis.at(end), below - 4), (axis.at(end), below + 4)], INK.stroke_width(2)))?;
    }
    let at = axis.at(mean);
    let corners = vec![(at - 5, below), (at, below - 5), (at + 5, below), (at, below + 5)];
    area.draw(&Polygon::new(corners, INK.filled()))?;
    bar.dots.iter().try_for_each(|&(ratio, view)| dot(area, (axis.at(ratio), y - 6), view))
}

/// A replicate, in the colour of its view.
fn dot(area: &Area<'_>, at: (i32, i32), view: usize) -> Drawn {
    let colour = Mark::nth(view, false).colour;
    area.draw(&Circle::new(at, 4, colour.mix(0.5).filled()))?;
    area.draw(&Circle::new(at, 4, colour.stroke_width(1)))
}

fn legend(area: &Area<'_>, views: &[&str]) -> Drawn {
    let mut x = LEFT;
    for (at, view) in views.iter().enumerate() {
        dot(area, (x, 92), at)?;
        text(area, view, (x + 12, 92), 17, INK, (HPos::Left, VPos::Center))?;
        x += 40 + 9 * view.chars().count() as i32;
    }
    Ok(())
}
