//! How does a plate become a picture in a file?
//!
//! Lines and words are drawn by `plotters`. Pixels are embedded as PNG images between its background and all else: its own way to do
//! that names them `data:png`, which no browser knows, draws each pixel of the file at one pixel of the page, and
//! takes a second image library.

use super::dots::Dots;
use super::plate::{Bars, Bitmap, ColourBar, Drawing, Panel, Plate, Row};
use crate::base::error::{Error, Result};
use crate::image::map::magma;
use crate::image::png::encode_texels;
use crate::report::{Area, Drawn, FAINT, INK, WIDTH, broken, text};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};
use std::fmt::Write;

/// Margins and gaps in pixels. Two panels of 192 pixels side by side are then shown three times as large.
const MARGIN: i32 = 16;
const GAP: i32 = 16;
/// Heights in pixels: of a line of a title and of a caption, of a colour bar and with its words.
const TITLE_LINE: i32 = 26;
const LINE: i32 = 22;
const BAR: i32 = 14;
const BAR_WITH_WORDS: i32 = BAR + 52;
/// Of letters, as the drawing library counts them.
const TITLE_SIZE: i32 = 23;
const SIZE: i32 = 20;
/// Pixels that a letter takes, on average and with some to spare.
const LETTER: f64 = 8.9;
const TITLE_LETTER: f64 = 10.4;
/// How tall charts are, and where bars stand in theirs.
const CHART: i32 = 460;
const BARS: [i32; 4] = [88, 842, 60, 320];

/// The plate as SVG.
pub(super) fn svg(plate: &Plate) -> Result<String> {
    let height = plate.rows.iter().fold(top(plate), |y, row| y + height(row));
    let mut svg = String::new();
    let mut images = String::new();
    draw(plate, height, &mut svg, &mut images)
        .map_err(|e| Error::Invalid(format!("cannot draw `{}`: {e}", plate.title)))?;
    // After the background, which is drawn first and closes the first element of its own.
    let begin = svg.find("/>\n").map_or(svg.len(), |at| at + 3);
    svg.insert_str(begin, &images);
    Ok(svg)
}

fn draw(plate: &Plate, height: i32, svg: &mut String, images: &mut String) -> Drawn {
    let area = SVGBackend::with_string(svg, (WIDTH as u32, height as u32)).into_drawing_area();
    area.fill(&WHITE)?;
    line(&area, &plate.title, (MARGIN, 30), 30, INK)?;
    for (i, subtitle) in subtitle(plate).iter().enumerate() {
        line(&area, subtitle, (MARGIN, 60 + LINE * i as i32), SIZE, FAINT)?;
    }
    let mut y = top(plate);
    for row in &plate.rows {
        let part = area.clone().shrink((0, y), (WIDTH, self::height(row)));
        match row {
            Row::Panels(panels) => {
                let heights = heights(panels);
                for (i, panel) in panels.iter().enumerate() {
                    let x = MARGIN + i as i32 * (width(panels.len()) + GAP);
                    draw_panel(&part, panel, (x, width(panels.len())), &heights, y, images)?;
                }
            }
            Row::Chart(chart) => chart.draw_on(&part, chart.height(CHART))?,
            Row::Bars(bars) => draw_bars(&part, bars)?,
        }
        y += self::height(row);
    }
    area.present()
}

fn subtitle(plate: &Plate) -> Vec<String> {
    lines(&plate.subtitle, WIDTH - 2 * MARGIN, LETTER)
}

/// Where the first row begins.
fn top(plate: &Plate) -> i32 {
    62 + LINE * subtitle(plate).len() as i32
}

fn line(area: &Area<'_>, what: &str, at: (i32, i32), size: i32, colour: RGBColor) -> Drawn {
    text(area, what, at, size, colour, (HPos::Left, VPos::Center))
}

/// Width of each of so many panels.
fn width(panels: usize) -> i32 {
    let panels = panels.max(1) as i32;
    (WIDTH - 2 * MARGIN - (panels - 1) * GAP) / panels
}

/// `text` in lines of a width in pixels.
fn lines(text: &str, width: i32, letter: f64) -> Vec<String> {
    broken(text, (f64::from(width) / letter) as usize).iter().map(|line| line.trim_start().to_owned()).collect()
}

/// Heights of the parts of a row of panels: of its titles, its pictures, its colour bars and its captions.
struct Heights {
    titles: i32,
    pictures: i32,
    bars: i32,
    captions: i32,
}

fn heights(panels: &[Panel]) -> Heights {
    let width = width(panels.len());
    let most = |of: &dyn Fn(&Panel) -> i32| panels.iter().map(of).max().unwrap_or(0);
    Heights {
        titles: most(&|panel| TITLE_LINE * lines(&panel.title, width, TITLE_LETTER).len() as i32),
        pictures: most(&|panel| match &panel.drawing {
            Drawing::Bitmap(bitmap) => scaled(bitmap, width),
            Drawing::Dots(dots) => dots_height(dots, width),
        }),
        bars: most(&|panel| match &panel.drawing {
            Drawing::Bitmap(Bitmap { bar: Some(_), .. }) => BAR_WITH_WORDS,
            _ => 8,
        }),
        captions: most(&|panel| LINE * lines(&panel.caption, width, LETTER).len() as i32),
    }
}

fn height(row: &Row) -> i32 {
    match row {
        Row::Panels(panels) => {
            let Heights { titles, pictures, bars, captions } = heights(panels);
            titles + pictures + bars + captions + 20
        }
        Row::Chart(chart) => chart.height(CHART),
        Row::Bars(_) => BARS[3] + 80,
    }
}

/// Height of a bitmap of a width on the page.
fn scaled(bitmap: &Bitmap, width: i32) -> i32 {
    (f64::from(width) * f64::from(bitmap.height) / f64::from(bitmap.width)).round().max(1.0) as i32
}

/// Height of a flat triangle of a width on the page: no more than it is wide.
fn dots_height(dots: &Dots, width: i32) -> i32 {
    let (low, high) = dots.frame();
    (f64::from(width) * ((high[1] - low[1]) / (high[0] - low[0])).min(1.0)).round() as i32
}

/// `top` is where the area begins on the page: images are placed there.
fn draw_panel(
    area: &Area<'_>,
    panel: &Panel,
    (x, width): (i32, i32),
    heights: &Heights,
    top: i32,
    images: &mut String,
) -> Drawn {
    for (i, title) in lines(&panel.title, width, TITLE_LETTER).iter().enumerate() {
        line(area, title, (x, 13 + TITLE_LINE * i as i32), TITLE_SIZE, INK)?;
    }
    let y = heights.titles;
    let below = match &panel.drawing {
        Drawing::Bitmap(bitmap) => {
            let height = scaled(bitmap, width);
            embed(images, bitmap.width, bitmap.height, &bitmap.texels, [x, top + y, width, height]);
            draw_marks(area, bitmap, [x, y, width, height])?;
            if let Some(bar) = &bitmap.bar {
                draw_bar(area, bar, [x, y + height + 6, width], top, images)?;
            }
            y + height + if bitmap.bar.is_some() { BAR_WITH_WORDS } else { 8 }
        }
        Drawing::Dots(dots) => {
            draw_dots(area, dots, [x, y, width, heights.pictures])?;
            y + heights.pictures + 8
        }
    };
    for (i, caption) in lines(&panel.caption, width, LETTER).iter().enumerate() {
        line(area, caption, (x, below + LINE / 2 + LINE * i as i32), SIZE, FAINT)?;
    }
    Ok(())
}

/// Puts pixels on the page, each as a square.
fn embed(images: &mut String, width: u32, height: u32, texels: &[[u8; 3]], [x, y, w, h]: [i32; 4]) {
    // What cannot be encoded has no pixels.
    let Ok(png) = encode_texels(width, height, texels) else { return };
    _ = writeln!(
        images,
        "<image x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" preserveAspectRatio=\"none\" \
         style=\"image-rendering:pixelated\" href=\"data:image/png;base64,{}\"/>",
        STANDARD.encode(png)
    );
}

fn draw_marks(area: &Area<'_>, bitmap: &Bitmap, [x, y, width, height]: [i32; 4]) -> Drawn {
    area.draw(&Rectangle::new([(x, y), (x + width, y + height)], FAINT.stroke_width(1)))?;
    let along = |pixel: u32, pixels: u32, length: i32| {
        ((f64::from(pixel) + 0.5) / f64::from(pixels) * f64::from(length)).round() as i32
    };
    // White on black, so that it shows on any ground.
    for (colour, thick) in [(BLACK, 5), (CYAN, 2)] {
        let stroke = |from, to, thick| area.draw(&PathElement::new(vec![from, to], colour.stroke_width(thick)));
        if let Some([px, py]) = bitmap.cross {
            let (cx, cy) = (x + along(px, bitmap.width, width), y + along(py, bitmap.height, height));
            for (dx, dy) in [(-1, 0), (1, 0), (0, -1), (0, 1)] {
                stroke((cx + 5 * dx, cy + 5 * dy), (cx + 16 * dx, cy + 16 * dy), thick)?;
            }
        }
        if let Some(ends) = bitmap.line {
            let [from, to] =
                ends.map(|[px, py]| (x + along(px, bitmap.width, width), y + along(py, bitmap.height, height)));
            stroke(from, to, thick - 1)?;
        }
    }
    Ok(())
}

fn draw_bar(area: &Area<'_>, bar: &ColourBar, [x, y, width]: [i32; 3], top: i32, images: &mut String) -> Drawn {
    let texels: Vec<[u8; 3]> = (0..128).map(|i| magma(f64::from(i) / 127.0)).collect();
    embed(images, 128, 1, &texels, [x, top + y, width, BAR]);
    area.draw(&Rectangle::new([(x, y), (x + width, y + BAR)], FAINT.stroke_width(1)))?;
    // Labels that would run into the one before are left out.
    let mut free = x;
    for (place, label) in &bar.ticks {
        let at = x + (place * f64::from(width)).round() as i32;
        let half = (0.5 * LETTER * label.chars().count() as f64) as i32 + 2;
        area.draw(&PathElement::new(vec![(at, y + BAR), (at, y + BAR + 4)], FAINT.stroke_width(1)))?;
        let centre = at.clamp(x + half, x + width - half);
        if centre - half >= free {
            text(area, label, (centre, y + BAR + 6), 18, INK, (HPos::Center, VPos::Top))?;
            free = centre + half + 4;
        }
    }
    text(area, &bar.label, (x + width / 2, y + BAR + 26), 18, INK, (HPos::Center, VPos::Top))
}

fn draw_dots(area: &Area<'_>, dots: &Dots, [x, y, width, height]: [i32; 4]) -> Drawn {
    area.draw(&Rectangle::new([(x, y), (x + width, y + height)], FAINT.stroke_width(1)))?;
    let (low, high) = dots.frame();
    let scale = (f64::from(width) / (high[0] - low[0])).min(f64::from(height) / (high[1] - low[1]));
    let at = |p: &[f64; 2]| {
        let right = scale * (p[0] - 0.5 * (low[0] + high[0]));
        let up = scale * (p[1] - 0.5 * (low[1] + high[1]));
        (x + width / 2 + right.round() as i32, y + height / 2 - up.round() as i32)
    };
    area.draw(&Polygon::new(dots.part.iter().map(at).collect::<Vec<_>>(), RGBColor(255, 236, 200).filled()))?;
    let outline: Vec<(i32, i32)> = dots.corners.iter().chain(dots.corners.first()).map(at).collect();
    area.draw(&PathElement::new(outline, INK.stroke_width(2)))?;
    for point in &dots.points {
        area.draw(&Circle::new(at(point), 3, RGBColor(0, 114, 178).filled()))?;
    }
    let (cx, cy) = at(&dots.receiver);
    for (dx, dy) in [(7, 7), (7, -7)] {
        let ends = vec![(cx - dx, cy - dy), (cx + dx, cy + dy)];
        area.draw(&PathElement::new(ends, RGBColor(213, 94, 0).stroke_width(3)))?;
    }
    Ok(())
}

/// A share in per cent with as many digits as stand over a bar.
fn short_share(share: f64) -> String {
    match 100.0 * share {
        0.0 => "0".to_owned(),
        ..0.01 => "<0.01".to_owned(),
        small @ ..1.0 => format!("{small:.2}"),
        large => format!("{large:.0}"),
    }
}

fn draw_bars(area: &Area<'_>, bars: &Bars) -> Drawn {
    let [left, right, top, bottom] = BARS;
    line(area, &bars.title, (left, 22), 25, INK)?;
    let most = bars.groups.iter().flat_map(|(_, shares)| shares).fold(0.0f64, |most, share| most.max(*share));
    let scale = crate::report::Scale { label: String::new(), logarithmic: false };
    let high = 100.0 * if most > 0.0 { 1.05 * most } else { 1.0 };
    let up = |place: f64| bottom - (place * f64::from(bottom - top)).round() as i32;
    for (place, label) in crate::report::ticks(&scale, [0.0, high]) {
        let grey = RGBColor(226, 226, 226).stroke_width(1);
        area.draw(&PathElement::new(vec![(left, up(place)), (right, up(place))], grey))?;
        text(area, &label, (left - 8, up(place)), 18, INK, (HPos::Right, VPos::Center))?;
    }
    let each = (right - left) / bars.groups.len().max(1) as i32;
    let thick = (each - 14) / bars.names.len().max(1) as i32;
    for (i, (label, shares)) in bars.groups.iter().enumerate() {
        let x = left + i as i32 * each + 7;
        for (j, (share, (_, mark))) in shares.iter().zip(&bars.names).enumerate() {
            let from = x + j as i32 * thick;
            let corner = (from + thick - 2, up(100.0 * share / high));
            area.draw(&Rectangle::new([(from, corner.1), (corner.0, bottom)], mark.colour.filled()))?;
            text(
                area,
                &short_share(*share),
                (from + thick / 2 - 1, corner.1 - 2),
                15,
                INK,
                (HPos::Center, VPos::Bottom),
            )?;
        }
        for (line, words) in label.iter().enumerate() {
            let at = (x + (each - 14) / 2, bottom + 10 + 20 * line as i32);
            text(area, words, at, 17, INK, (HPos::Center, VPos::Top))?;
        }
    }
    area.draw(&PathElement::new(vec![(left, bottom), (right, bottom)], INK.stroke_width(1)))?;
    text(area, &bars.label, (left, bottom + 56), 18, INK, (HPos::Left, VPos::Top))?;
    for (i, (name, mark)) in bars.names.iter().enumerate() {
        let y = top + 10 + 28 * i as i32;
        area.draw(&Rectangle::new([(right + 30, y - 8), (right + 50, y + 8)], mark.colour.filled()))?;
        line(area, name, (right + 60, y), 19, INK)?;
    }
    Ok(())
}
