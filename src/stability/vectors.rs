//! Do solid angle and irradiance agree with a file of exact values?
//!
//! Each row holds a triangle seen from the origin, the receiver's normal there, and the exact solid angle and irradiance; see
//! [`COLUMNS`]. A header, with or without `#` before it, has these in this order. Rows are judged by category.

use super::tally::{Finding, Tally, relative};
use super::textbook;
use crate::base::error::{Error, Result};
use crate::base::names;
use crate::base::triangle::Seen;
use glam::Vec3;
use std::f64::consts::PI;
use std::fs;
use std::path::Path;

/// What each column of a file is: corners in f32, a unit normal, signed solid angle in sr (positive when `a·(b×c) > 0`), irradiance
/// for unit radiance clipped at the horizon.
pub(crate) const COLUMNS: [&str; 15] =
    ["category", "ax", "ay", "az", "bx", "by", "bz", "cx", "cy", "cz", "nx", "ny", "nz", "solid_angle", "irradiance"];

/// The categories; those of [`AREALESS`] are judged by their absolute error.
pub(crate) const CATEGORIES: [&str; 10] =
    ["ordinary", "distant", "sliver", "vertex", "micro", "huge", "touching", "grazing", "degenerate", "repeated"];

/// Triangles of no area, or next to none.
pub(crate) const AREALESS: [&str; 2] = ["degenerate", "repeated"];

/// Worst relative error of a solid angle that is right.
pub(crate) const SOLID_ANGLE_LIMIT: f64 = 2e-6;
/// Worst error in sr of a solid angle that is right, of a triangle of no area.
pub(crate) const AREALESS_LIMIT: f64 = 1e-12;
/// Worst error of an irradiance that is right, relative to it or to [`IRRADIANCE_FLOOR`], whichever is more.
pub(crate) const IRRADIANCE_LIMIT: f64 = 1e-5;
/// A ten-millionth of what a whole sky of unit radiance gives.
pub(crate) const IRRADIANCE_FLOOR: f64 = 1e-7 * PI;

/// A row of a file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Vector {
    /// One of [`CATEGORIES`].
    pub category: &'static str,
    /// The triangle.
    pub corners: [Vec3; 3],
    /// The receiver's normal.
    pub normal: Vec3,
    /// Exact signed solid angle in sr.
    pub solid_angle: f64,
    /// Exact irradiance.
    pub irradiance: f64,
}

/// What was found of one category.
#[derive(Clone, Debug)]
pub(crate) struct Judged {
    /// The category.
    pub category: &'static str,
    /// Relative error of the solid angle; in sr for triangles of no area.
    pub solid_angle: Finding,
    /// Error of the irradiance over the exact one or [`IRRADIANCE_FLOOR`].
    pub irradiance: Finding,
}

/// Reads a file of rows.
///
/// # Errors
/// A file that cannot be read; as [`parse`].
pub(crate) fn read(file: &Path) -> Result<Vec<Vector>> {
    parse(&fs::read(file).map_err(Error::io("read", file))?, file)
}

/// Reads rows from the text of a file, whose name is for messages alone.
///
/// # Errors
/// A header or a row that cannot be used, with its line and column; a file without rows.
pub(crate) fn parse(text: &[u8], file: &Path) -> Result<Vec<Vector>> {
    // Fields hold no commas and no line ends, so lines are rows: a line's number is then what an editor shows.
    let mut vectors = Vec::new();
    let wrong = |line: usize, at: usize, message: &str| Error::Input {
        file: file.to_owned(),
        line: Some(line),
        field: COLUMNS.get(at).copied().unwrap_or_default().to_owned(),
        message: format!("column {}: {message}", at + 1),
    };
    for (line, bytes) in (1..).zip(text.split(|byte| *byte == b'\n')) {
        let row = std::str::from_utf8(bytes).map_err(|error| {
            let at = bytes[..error.valid_up_to()].iter().filter(|byte| **byte == b',').count();
            wrong(line, at, "this is no text; a CSV file in UTF-8 is right")
        })?;
        let row = row.trim_start_matches('\u{feff}').trim();
        let remark = row.starts_with('#');
        let fields: Vec<&str> = row.trim_start_matches('#').split(',').map(str::trim).collect();
        if fields[0] == COLUMNS[0] && (remark || vectors.is_empty()) {
            check_header(&fields).map_err(|(at, message)| wrong(line, at, &message))?;
            continue;
        }
        if row.is_empty() || remark {
            continue;
        }
        vectors.push(Vector::of(&fields).map_err(|(at, message)| wrong(line, at, &message))?);
    }
    if vectors.is_empty() {
        return Err(wrong(1, 0, &format!("there are no rows; at least one is right, of {}", COLUMNS.join(","))));
    }
    Ok(vectors)
}

/// Whether a header, also one that is a remark, has the right columns; else the first (from 0) that has not.
fn check_header(fields: &[&str]) -> std::result::Result<(), (usize, String)> {
    let Some(at) = (0..fields.len().max(COLUMNS.len())).find(|at| fields.get(*at) != COLUMNS.get(*at)) else {
        return Ok(());
    };
    let what = match (fields.get(at), COLUMNS.get(at)) {
        (Some(found), Some(right)) => format!("the header says `{found}`; `{right}` is right"),
        (Some(found), None) => format!("the header goes on with `{found}`; {} columns are right", COLUMNS.len()),
        (None, _) => format!("the header ends here, with {at} columns; {} are right", COLUMNS.len()),
    };
    Err((at, format!("{what}, of {}", COLUMNS.join(","))))
}

impl Vector {
    /// A row; where it cannot be used, the column (from 0) and what is wrong.
    fn of(record: &[&str]) -> std::result::Result<Self, (usize, String)> {
        if record.len() != COLUMNS.len() {
            let at = record.len().min(COLUMNS.len());
            let what = if record.len() < COLUMNS.len() { "the row ends here" } else { "the row goes on here" };
            return Err((at, format!("{what}, with {} columns; 15 are right: {}", record.len(), COLUMNS.join(","))));
        }
        let name = record[0];
        let category = CATEGORIES
            .into_iter()
            .find(|category| *category == name)
            .ok_or_else(|| (0, format!("unknown category `{name}`{}", names::hint(name, CATEGORIES))))?;
        let number = |at: usize| match record[at].parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => Err((at, format!("`{}` is not a finite number; one like -1.25e-3 is right", record[at]))),
        };
        let short = |at: usize| {
            let short = number(at)? as f32;
            let message = || (at, format!("`{}` is beyond f32; magnitudes up to 3.4e38 are right", record[at]));
            if short.is_finite() { Ok(short) } else { Err(message()) }
        };
        let vector = |at: usize| Ok(Vec3::new(short(at)?, short(at + 1)?, short(at + 2)?));
        let corners = [vector(1)?, vector(4)?, vector(7)?];
        let normal = vector(10)?;
        let length = normal.as_dvec3().length();
        // f32 rounding leaves 1e-7.
        if (length - 1.0).abs() > 1e-3 {
            return Err((10, format!("the normal's length is {length}; 1 is right")));
        }
        let (solid_angle, irradiance) = (number(13)?, number(14)?);
        if solid_angle.abs() > 2.0 * PI + 1e-9 {
            return Err((13, format!("{solid_angle} sr; a plane triangle fills -2 pi to 2 pi")));
        }
        if !(0.0..=PI + 1e-9).contains(&irradiance) {
            return Err((14, format!("{irradiance}; 0 to pi is right")));
        }
        Ok(Self { category, corners, normal, solid_angle, irradiance })
    }
}

/// Judges rows by category, in the order of [`CATEGORIES`]; those without a row are left out.
pub(crate) fn judge(vectors: &[Vector]) -> Vec<Judged> {
    let one = |category| {
        let rows: Vec<&Vector> = vectors.iter().filter(|vector| vector.category == category).collect();
        (!rows.is_empty()).then(|| judge_category(category, &rows))
    };
    CATEGORIES.into_iter().filter_map(one).collect()
}

fn judge_category(category: &'static str, rows: &[&Vector]) -> Judged {
    let arealess = AREALESS.contains(&category);
    let off = |found: f64, exact: f64| if arealess { (found - exact).abs() } else { relative(found, exact) };
    let off_irradiance = |found: f64, exact: f64| (found - exact).abs() / exact.max(IRRADIANCE_FLOOR);
    let mut tallies: [Tally; 4] = Default::default();
    let [angle, angle_textbook, light, light_textbook] = &mut tallies;
    for row in rows {
        let seen = Seen::new(row.corners.map(Vec3::as_dvec3));
        let (found, exact) = (seen.solid_angle(), row.solid_angle);
        angle.add(found, off(found, exact));
        let found = f64::from(textbook::solid_angle(row.corners));
        angle_textbook.add(found, off(found, exact));
        let (found, exact) = (seen.irradiance(row.normal.as_dvec3().normalize()), row.irradiance);
        light.add_positive(found, off_irradiance(found, exact));
        let found = f64::from(textbook::irradiance(row.corners, row.normal));
        light_textbook.add_positive(found, off_irradiance(found, exact));
    }
    let [angle, angle_textbook, light, light_textbook] = tallies;
    let limit = if arealess { AREALESS_LIMIT } else { SOLID_ANGLE_LIMIT };
    Judged {
        category,
        solid_angle: Finding { ours: angle, textbook: Some(angle_textbook), limit },
        irradiance: Finding { ours: light, textbook: Some(light_textbook), limit: IRRADIANCE_LIMIT },
    }
}
