//! Tables, pages and plots from records alone: made again at any time, without measuring anything.
//!
//! [`report`] writes them into a result folder, [`check`] says whether they are what its raw rows say. The same records
//! give the same bytes. Nothing here knows a strategy: names, claims and figures come from the records.

mod chart;
mod complete;
mod facts;
mod headline;
mod mark;
mod markdown;
mod number;
mod order;
mod page;
mod plot;
mod ratios;
pub(crate) mod replicates;
mod rows;
mod sheet;
pub(crate) mod splice;
mod study;
mod sweep;
mod table;
mod tuned;

#[cfg(feature = "cli")]
pub(crate) use chart::{Area, Chart, Dot, Drawn, FAINT, INK, Scale, Series, WIDTH, text, ticks};
#[cfg(feature = "cli")]
pub(crate) use mark::{Line, Mark};
pub(crate) use number::{grouped, short};
pub(crate) use page::{page, section};
pub(crate) use plot::plot;
#[cfg(feature = "cli")]
pub(crate) use sheet::{WIDTH as USUAL_COLUMNS, broken};
pub(crate) use study::study_text;
pub(crate) use table::table;

use crate::base::error::{Error, Result};
use crate::base::file::write_whole;
use crate::record::study::Study;
use crate::record::study_store::{is_study, read_study};
use crate::record::{Parameters, ResultFolder, Row, RunRecord, TunedFamily, store};
use replicates::families;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// A derived file: its name within the result folder and its content.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Derived {
    /// `<scene>.md`, `<scene>.svg` or `<scene>-<parameter>.svg`, `replicates-<family>.md` or `.svg`, `<study>.md` or
    /// `<study>-<plot>.svg`, `tuned-<family>.md` or `frontier-<family>.svg`.
    pub name: String,
    /// All of it.
    pub text: String,
}

/// The pages and plots of all scenes, in their order, then those of families of replicates.
///
/// # Errors
/// Two pages or plots that would be written to one file; a plot that cannot be drawn.
pub(crate) fn derive(run: &RunRecord, rows: &[Row]) -> Result<Vec<Derived>> {
    let mut files: Vec<Derived> = Vec::new();
    for scene in &run.scenes {
        let stem = store::file_name(&scene.name);
        let (page_name, plot_name) = (format!("{stem}.md"), format!("{stem}.svg"));
        if files.iter().any(|f| f.name == page_name) {
            return Err(Error::Invalid(format!(
                "two scenes would both be written to `{page_name}`: rename `{}`",
                scene.name
            )));
        }
        let swept = sweep::sweeps(scene)?.into_iter().map(|(parameter, text)| {
            let name = format!("{}.svg", store::file_name(&format!("{}-{parameter}", scene.name)));
            Derived { name, text }
        });
        let swept: Vec<Derived> = swept.collect();
        if let Some(twice) = swept
            .iter()
            .find(|plot| run.scenes.iter().any(|s| plot.name == format!("{}.svg", store::file_name(&s.name))))
        {
            let text = format!("two plots would both be written to `{}`: rename a scene", twice.name);
            return Err(Error::Invalid(text));
        }
        let mut text = page(run, scene, rows, &plot_name);
        swept.iter().for_each(|plot| text.push_str(&format!("\n![{0}]({0})\n", plot.name)));
        files.push(Derived { text, name: page_name });
        files.push(Derived { text: plot(scene)?, name: plot_name });
        files.extend(swept);
    }
    for family in families(run) {
        let [page, plot] = family.files();
        let own = [Derived { text: family.page(run), name: page }, Derived { text: family.plot()?, name: plot }];
        add(&mut files, own)?;
    }
    Ok(files)
}

/// All that follows from a comparison's records in `folder`: as [`derive()`], then the page and the plot of what was tuned for
/// each recipe.
///
/// # Errors
/// As [`derive()`]; what was tuned, where it cannot be read.
pub(crate) fn derive_all(folder: &Path, run: &RunRecord, rows: &[Row]) -> Result<Vec<Derived>> {
    let mut files = derive(run, rows)?;
    for TunedFamily { family, file, .. } in run.parameters.iter().flat_map(Parameters::tuned) {
        let found = crate::record::tuned::read(&folder.join(file))?;
        let [page, plot] = tuned::files(family);
        let text = tuned::page(family, &found, &plot);
        add(&mut files, [Derived { text, name: page }, Derived { text: tuned::plot(family, &found)?, name: plot }])?;
    }
    Ok(files)
}

/// Adds files that no scene's may be named as.
fn add(files: &mut Vec<Derived>, own: [Derived; 2]) -> Result<()> {
    if let Some(twice) = own.iter().find(|file| files.iter().any(|other| other.name == file.name)) {
        let text = format!("two files would both be written to `{}`: rename a scene", twice.name);
        return Err(Error::Invalid(text));
    }
    files.extend(own);
    Ok(())
}

/// The page and the plots of a study.
///
/// # Errors
/// A plot that cannot be drawn.
pub(crate) fn derive_study(record: &Study) -> Result<Vec<Derived>> {
    let name = format!("{}.md", store::file_name(&record.record.study));
    let plots = study::plots(record)?.into_iter().map(|(name, text)| Derived { name, text });
    Ok(std::iter::once(Derived { name, text: study::page(record) }).chain(plots).collect())
}

/// A named section for a page that people write.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Section {
    /// The scene's name, that of a family of replicates after "replicates ", or the study's after "study ".
    pub name: String,
    /// Its Markdown.
    pub body: String,
}

/// The sections of a result folder for `page`, in order: one a scene, but one for all replicates of a family; or one for
/// all of a study. What they point to is
/// named relative to the page's folder where it lies in there.
///
/// # Errors
/// A folder without a record of a comparison or a study; a record or rows that cannot be read, or with a mistake.
pub(crate) fn sections(folder: &Path, page: &Path) -> Result<Vec<Section>> {
    let seen = page.parent().and_then(|home| folder.strip_prefix(home).ok()).unwrap_or(folder);
    if is_study(folder) {
        let record = read_study(folder)?;
        let name = markdown::comment(&format!("study {}", record.record.study));
        return Ok(vec![Section { body: study::section(&record, &seen.join("").display().to_string()), name }]);
    }
    let (run, rows) = (store::read_run(folder)?, store::read_rows(folder)?.rows);
    let families = families(&run);
    let plot_of = |file: &str| seen.join(file).display().to_string();
    let by_itself = run.scenes.iter().filter(|scene| !families.iter().any(|family| family.holds(scene)));
    let of_scenes = by_itself.map(|scene| {
        let plot = plot_of(&format!("{}.svg", store::file_name(&scene.name)));
        Section { name: markdown::comment(&scene.name), body: section(&run, scene, &rows, &plot) }
    });
    let of_families = families.iter().map(|family| Section {
        name: markdown::comment(&format!("replicates {}", family.name)),
        body: family.section(&run, &plot_of(&family.files()[1])),
    });
    Ok(of_scenes.chain(of_families).collect())
}

/// Writes the pages and plots of a result folder again, from its raw records and rows; gives their paths.
///
/// # Errors
/// A folder without a record of a comparison or a study, or that another process writes in; records and rows with a
/// mistake; what cannot be read, drawn or written.
pub(crate) fn report(folder: &Path) -> Result<Vec<PathBuf>> {
    let _held = ResultFolder::hold(folder)?;
    let files = read(folder)?;
    write(folder, &files)?;
    Ok(files.into_iter().map(|file| folder.join(file.name)).collect())
}

/// Writes derived files into a result folder.
///
/// # Errors
/// A file that cannot be written.
pub(crate) fn write(folder: &Path, files: &[Derived]) -> Result<()> {
    files.iter().try_for_each(|file| write_whole(&folder.join(&file.name), file.text.as_bytes()))
}

/// A derived file that is not what the raw rows say.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum Drift {
    /// It is not there.
    #[error("{}: missing", .0.display())]
    Missing(PathBuf),
    /// Raw rows that are doubled, missing or of nothing that was run.
    #[error("{}: {what}", .file.display())]
    Rows {
        /// The file that they stand in, or should.
        file: PathBuf,
        /// Which they are.
        what: String,
    },
    /// It says something else, from this line on.
    #[error("{}:{line}: differs from the raw rows", .file.display())]
    Differs {
        /// The file.
        file: PathBuf,
        /// The first line that differs, from 1.
        line: usize,
    },
}

/// Looks for raw rows that are doubled or missing, and compares the pages and plots in a result folder with what the
/// rows say; all is right where the list is empty.
///
/// # Errors
/// A folder without a record of a comparison or a study; records and rows with a mistake; what cannot be read or drawn.
pub(crate) fn check(folder: &Path) -> Result<Vec<Drift>> {
    let mut drifts: Vec<Drift> = faults(folder)?;
    for Derived { name, text } in read(folder)? {
        let file = folder.join(name);
        match fs::read(&file) {
            Ok(there) if there == text.as_bytes() => {}
            Ok(there) => drifts.push(Drift::Differs { line: first_difference(&there, text.as_bytes()), file }),
            Err(e) if e.kind() == ErrorKind::NotFound => drifts.push(Drift::Missing(file)),
            Err(e) => return Err(Error::io("read", file)(e)),
        }
    }
    Ok(drifts)
}

fn faults(folder: &Path) -> Result<Vec<Drift>> {
    if is_study(folder) {
        let of = |(table, what): (String, String)| Drift::Rows { file: folder.join(format!("{table}.csv")), what };
        return Ok(complete::doubled(&read_study(folder)?).into_iter().map(of).collect());
    }
    let faults = complete::faults(&store::read_run(folder)?, &store::read_rows(folder)?.rows);
    Ok(faults.into_iter().map(|what| Drift::Rows { file: folder.join(store::ROWS_FILE), what }).collect())
}

fn read(folder: &Path) -> Result<Vec<Derived>> {
    if is_study(folder) {
        return derive_study(&read_study(folder)?);
    }
    let run = store::read_run(folder)?;
    derive_all(folder, &run, &store::read_rows(folder)?.rows)
}

/// The line, from 1, in which two different texts part.
fn first_difference(a: &[u8], b: &[u8]) -> usize {
    let same = a.iter().zip(b).take_while(|(a, b)| a == b);
    1 + same.filter(|(byte, _)| **byte == b'\n').count()
}
