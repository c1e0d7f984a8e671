//! `citylights stability`: is the arithmetic right where it is hardest?

use super::outcome::Outcome;
use super::terminal::{print, side_by_side};
use crate::stability::vectors::{self, AREALESS, AREALESS_LIMIT, IRRADIANCE_LIMIT, Judged, SOLID_ANGLE_LIMIT};
use crate::stability::{CASES, Finding, Tally};
use clap::Args;
use rayon::prelude::*;
use std::path::{Path, PathBuf};

#[derive(Args)]
pub(super) struct Arguments {
    /// Judge solid angle and irradiance by a CSV file of exact values instead: rows of
    /// category,ax,ay,az,bx,by,bz,cx,cy,cz, nx,ny,nz,solid_angle,irradiance
    #[arg(long, value_name = "FILE")]
    vectors: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments) -> anyhow::Result<Outcome> {
    let failed = match &arguments.vectors {
        Some(file) => of_file(file)?,
        None => of_cases()?,
    };
    if failed.is_empty() {
        print("every error is within its limit\n")?;
        return Ok(Outcome::Done);
    }
    print(&format!("{} beyond its limit: {}\n", failed.len(), failed.join(", ")))?;
    Ok(Outcome::CheckFailed)
}

/// Judges the rows of a file, prints what was found and gives the names of what failed.
fn of_file(file: &Path) -> anyhow::Result<Vec<String>> {
    let rows = vectors::read(file)?;
    let judged = vectors::judge(&rows);
    print(&format!("{}: {} triangles\n\n", file.display(), rows.len()))?;
    let mut failed = Vec::new();
    let angle = format!("solid angle: relative error, at most {SOLID_ANGLE_LIMIT:e}");
    let no_area = format!("of {}: error in sr, at most {AREALESS_LIMIT:e}", AREALESS.join(" and "));
    let light = format!("irradiance: error over the exact value or 1e-7 pi, at most {IRRADIANCE_LIMIT:e}");
    type Part = fn(&Judged) -> &Finding;
    let quantities: [(&str, String, Part); 2] = [
        ("solid angle", format!("{angle}; {no_area}"), |judged| &judged.solid_angle),
        ("irradiance", light, |judged| &judged.irradiance),
    ];
    for (quantity, title, part) in quantities {
        print(&format!("{title}\n{}", head("category", 12)))?;
        for one in &judged {
            let finding = part(one);
            print(&side_by_side(&line(one.category, 12, finding)))?;
            if !finding.passed() {
                failed.push(format!("{quantity} of {}", one.category));
            }
        }
        print("\n")?;
    }
    Ok(failed)
}

/// Tries the built-in cases, prints what was found and gives the names of what failed.
fn of_cases() -> anyhow::Result<Vec<String>> {
    let width = CASES.iter().map(|case| case.name.len()).max().unwrap_or(0);
    let findings: Vec<Finding> = CASES.par_iter().map(|case| (case.run)()).collect();
    print(&head("case", width))?;
    let mut failed = Vec::new();
    for (case, finding) in CASES.iter().zip(&findings) {
        let mut parts = line(case.name, width, finding).to_vec();
        parts.push(format!(" {}", case.what));
        print(&side_by_side(&parts))?;
        if !finding.passed() {
            failed.push(case.name.to_owned());
        }
    }
    print("\n")?;
    Ok(failed)
}

fn head(name: &str, width: usize) -> String {
    let first = [format!("{:width$} {:>6} {:^23}", "", "", "ours"), format!(" {:^23}", "textbook, f32")];
    let errors = format!("{:>8} {:>8} {:>5}", "worst", "99 %", "bad");
    let second =
        [format!("{name:width$} {:>6} {errors}", "tried"), format!(" {errors}"), format!(" {:>8} verdict", "limit")];
    side_by_side(&first) + &side_by_side(&second)
}

/// Errors, those of the textbook, and the verdict.
fn line(name: &str, width: usize, finding: &Finding) -> [String; 3] {
    let Finding { ours, textbook, limit } = finding;
    let textbook = textbook.as_ref().map_or_else(String::new, errors);
    [
        format!("{name:width$} {:>6} {}", ours.count(), errors(ours)),
        format!(" {textbook:>23}"),
        format!(" {limit:>8.0e} {:7}", if finding.passed() { "pass" } else { "FAIL" }),
    ]
}

/// Worst and 99 % error; then how many were NaN, infinite or negative.
fn errors(tally: &Tally) -> String {
    format!(
        "{:>8} {:>8} {:>5}",
        short(tally.worst()),
        short(tally.p99()),
        format!("{}/{}/{}", tally.nan, tally.infinite, tally.negative)
    )
}

fn short(error: f64) -> String {
    if error == 0.0 { "0".to_owned() } else { format!("{error:.1e}") }
}
