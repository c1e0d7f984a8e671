//! Can a file be written, and how is a picture?

use super::terminal::say;
use crate::base::error::Error;
use crate::image::{self, Format, Picture};
use crate::render::picture::picture;
use crate::visibility::stage::Stage;
use glam::Vec3;
use std::io::ErrorKind;
use std::path::Path;

/// Refuses a picture that could not be written, before the work instead of after it.
pub(super) fn check_output(file: &Path) -> Result<(), Error> {
    Format::of(file)?;
    check_folder(file)
}

/// Refuses a file that could not be written, before the work instead of after it.
pub(super) fn check_folder(file: &Path) -> Result<(), Error> {
    if file.is_dir() {
        return Err(Error::Invalid(format!("cannot write {}: it is a folder", file.display())));
    }
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !folder.is_dir() {
        return Err(Error::Invalid(format!(
            "cannot write {}: there is no folder {}",
            file.display(),
            folder.display()
        )));
    }
    // A name that no file can bear; that nothing bears it is well.
    if let Err(error) = std::fs::symlink_metadata(file)
        && error.kind() != ErrorKind::NotFound
    {
        return Err(Error::io("write", file)(error));
    }
    let probe = folder.join(format!(".citylights-{}", std::process::id()));
    std::fs::write(&probe, b"").and_then(|()| std::fs::remove_file(&probe)).map_err(Error::io("write", file))
}

/// Writes what the camera sees.
pub(super) fn save(stage: &Stage, receivers: &[Vec3], output: &Path) -> Result<(), Error> {
    let (width, height) = stage.view().resolution();
    let picture = Picture { width, height, pixels: picture(stage, receivers) };
    let bad = image::write(output, &picture, stage.scene().exposure())?;
    if bad > 0 {
        say(&format!("{bad} pixels are not finite; they are magenta in the picture"));
    }
    Ok(())
}
