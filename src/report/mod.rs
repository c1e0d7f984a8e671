//! Tables, pages and plots from records alone: made again at any time, without measuring anything.
//!
//! [`report`] writes them into a result folder, [`check`] says whether they are what its raw rows say. The same records give the
//! same bytes. Nothing here knows a strategy: names, claims and figures come from the records.

mod curve;
pub mod figures;
mod mark;
mod number;
mod page;
mod plot;
mod sheet;
pub mod splice;
mod table;

pub use page::{page, section};
pub use plot::plot;
pub use table::table;

use crate::base::error::{Error, Result};
use crate::base::file::write_whole;
use crate::record::{Row, RunRecord, store};
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// A derived file: its name within the result folder and its content.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Derived {
    /// `<scene>.md` or `<scene>.svg`.
    pub name: String,
    /// All of it.
    pub text: String,
}

/// The pages and plots of all scenes, in their order.
pub fn derive(run: &RunRecord, rows: &[Row]) -> Result<Vec<Derived>> {
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
        files.push(Derived { text: page(run, scene, rows, &plot_name), name: page_name });
        files.push(Derived { text: plot(scene, rows)?, name: plot_name });
    }
    Ok(files)
}

/// Writes the pages and plots of a result folder again, from its `run.json` and `runs.csv`; gives their paths.
pub fn report(folder: &Path) -> Result<Vec<PathBuf>> {
    let files = read(folder)?;
    files.iter().try_for_each(|file| write_whole(&folder.join(&file.name), file.text.as_bytes()))?;
    Ok(files.into_iter().map(|file| folder.join(file.name)).collect())
}

/// A derived file that is not what the raw rows say.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Drift {
    /// It is not there.
    #[error("{}: missing", .0.display())]
    Missing(PathBuf),
    /// It says something else, from this line on.
    #[error("{}:{line}: differs from the raw rows", .file.display())]
    Differs {
        /// The file.
        file: PathBuf,
        /// The first line that differs, from 1.
        line: usize,
    },
}

/// Compares the pages and plots in a result folder with what its raw rows say; none differs where the list is empty.
pub fn check(folder: &Path) -> Result<Vec<Drift>> {
    let mut drifts = Vec::new();
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

fn read(folder: &Path) -> Result<Vec<Derived>> {
    let run = store::read_run(folder)?;
    derive(&run, &store::read_rows(folder)?.rows)
}

/// The line, from 1, in which two different texts part.
fn first_difference(a: &[u8], b: &[u8]) -> usize {
    let same = a.iter().zip(b).take_while(|(a, b)| a == b);
    1 + same.filter(|(byte, _)| **byte == b'\n').count()
}
