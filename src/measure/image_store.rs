//! The last image of each finished run, kept while a comparison goes on so that it can be resumed.
//!
//! A film says what it is of and bears a checksum: one that is damaged, or of another plan, scene, run or budget, is as
//! good as none.

use crate::base::error::{Error, Result};
use crate::base::file::{remove_partials, write_whole};
use crate::record::Row;
use crate::record::store::file_name;
use glam::Vec3;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// What films begin with.
const MAGIC: &[u8; 8] = b"clfilm1\n";
/// Bytes of a hash.
const HASH: usize = blake3::OUT_LEN;
/// What ends a film's name.
const EXTENSION: &str = ".film";

/// The films of a result folder; removed when the comparison has ended.
pub(crate) struct ImageStore {
    folder: PathBuf,
    plan: String,
}

impl ImageStore {
    /// The films in a result folder of a comparison by `plan`, which names the content of its scenes.
    pub(crate) fn of(results: &Path, plan: &str) -> Self {
        Self { folder: results.join("films"), plan: plan.to_owned() }
    }

    /// Keeps the image of the run and budget of `row`.
    ///
    /// # Errors
    /// A folder or a file that cannot be written.
    pub(crate) fn save(&self, row: &Row, image: &[Vec3]) -> Result<()> {
        std::fs::create_dir_all(&self.folder).map_err(Error::io("create", &self.folder))?;
        let mut bytes = MAGIC.to_vec();
        bytes.extend(self.identity(row).as_bytes());
        bytes.extend(bytemuck::cast_slice(image));
        bytes.extend(blake3::hash(&bytes).as_bytes());
        write_whole(&self.path(row), &bytes)
    }

    /// The image of the run and budget of `row` at so many receivers, if it is there and whole.
    pub(crate) fn load(&self, row: &Row, receivers: usize) -> Option<Vec<Vec3>> {
        self.read(row).filter(|image| image.len() == receivers)
    }

    fn read(&self, row: &Row) -> Option<Vec<Vec3>> {
        let bytes = std::fs::read(self.path(row)).ok()?;
        let (content, checksum) = bytes.split_last_chunk::<HASH>()?;
        let rest = content.strip_prefix(MAGIC)?.strip_prefix(self.identity(row).as_bytes())?;
        let whole = blake3::hash(content) == *checksum && rest.len().is_multiple_of(size_of::<Vec3>());
        whole.then(|| rest.chunks_exact(size_of::<Vec3>()).map(bytemuck::pod_read_unaligned).collect())
    }

    /// Removes all films; what else somebody has put beside them stays.
    ///
    /// # Errors
    /// A folder that cannot be read; a film or a folder that cannot be removed.
    pub(crate) fn remove(&self) -> Result<()> {
        let entries = match std::fs::read_dir(&self.folder) {
            Err(e) if e.kind() == ErrorKind::NotFound => return Ok(()),
            entries => entries.map_err(Error::io("read", &self.folder))?,
        };
        for entry in entries {
            let path = entry.map_err(Error::io("read", &self.folder))?.path();
            if path.file_name().is_some_and(|name| name.to_string_lossy().ends_with(EXTENSION)) {
                std::fs::remove_file(&path).map_err(Error::io("remove", &path))?;
            }
        }
        remove_partials(&self.folder)?;
        match std::fs::remove_dir(&self.folder) {
            Err(e) if e.kind() != ErrorKind::DirectoryNotEmpty => Err(Error::io("remove", &self.folder)(e)),
            _ => Ok(()),
        }
    }

    /// What the film of `row` is of.
    fn identity(&self, row: &Row) -> blake3::Hash {
        blake3::hash(format!("{:?}", (&self.plan, row.key())).as_bytes())
    }

    fn path(&self, row: &Row) -> PathBuf {
        let readable: String = file_name(&row.strategy).chars().take(80).collect();
        let short = &self.identity(row).to_hex()[..16];
        self.folder.join(format!("{readable}-{}-{short}{EXTENSION}", row.run))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(run: u32, passes: u32) -> Row {
        Row::blank("town".into(), "power:picks=2".into(), run, passes)
    }

    #[test]
    fn a_film_is_of_one_plan_run_and_budget() {
        let folder = tempfile::tempdir().expect("a folder");
        let films = ImageStore::of(folder.path(), "scenes town=1");
        let image = [Vec3::new(1.0, 2.0, 3.0), Vec3::ONE];
        films.save(&row(0, 64), &image).expect("saved");
        assert_eq!(films.load(&row(0, 64), 2).as_deref(), Some(&image[..]));
        assert_eq!(films.load(&row(0, 64), 3), None);
        // Another's film under this one's name.
        for (other, of) in [
            (ImageStore::of(folder.path(), "scenes town=1"), row(1, 64)),
            (ImageStore::of(folder.path(), "scenes town=1"), row(0, 16)),
            (ImageStore::of(folder.path(), "scenes town=2"), row(0, 64)),
        ] {
            other.save(&of, &image).expect("saved");
            std::fs::rename(other.path(&of), films.path(&row(0, 64))).expect("renamed");
            assert_eq!(films.load(&row(0, 64), 2), None, "{:?}", of.key());
        }
    }

    #[test]
    fn no_byte_of_a_film_can_change_unseen() {
        let folder = tempfile::tempdir().expect("a folder");
        let films = ImageStore::of(folder.path(), "plan");
        films.save(&row(0, 1), &[Vec3::ONE; 2]).expect("saved");
        let path = films.path(&row(0, 1));
        let whole = std::fs::read(&path).expect("read");
        for at in 0..whole.len() {
            let mut bytes = whole.clone();
            bytes[at] ^= 1;
            std::fs::write(&path, &bytes).expect("written");
            assert!(films.load(&row(0, 1), 2).is_none(), "byte {at}");
            std::fs::write(&path, &whole[..at]).expect("written");
            assert!(films.load(&row(0, 1), 2).is_none(), "cut to {at} bytes");
        }
        std::fs::write(&path, &whole).expect("written");
        assert!(films.load(&row(0, 1), 2).is_some());
    }

    #[test]
    fn only_films_are_removed() {
        let folder = tempfile::tempdir().expect("a folder");
        let films = ImageStore::of(folder.path(), "plan");
        films.remove().expect("nothing to remove");
        films.save(&row(0, 1), &[Vec3::ONE]).expect("saved");
        let holiday = folder.path().join("films/holiday.mkv");
        std::fs::write(&holiday, "film").expect("written");
        films.remove().expect("removed");
        assert!(holiday.exists() && !films.path(&row(0, 1)).exists());
        std::fs::remove_file(holiday).expect("removed");
        films.remove().expect("removed");
        assert!(!folder.path().join("films").exists());
    }
}
