//! The last image of each finished run, kept while a comparison goes on so that it can be resumed.

use crate::base::error::{Error, Result};
use crate::base::file::write_whole;
use crate::record::store::file_name;
use glam::Vec3;
use std::path::{Path, PathBuf};

/// A folder of images; removed when the comparison has ended.
pub struct Films {
    folder: PathBuf,
}

impl Films {
    /// The films of a result folder.
    pub fn of(results: &Path) -> Self {
        Self { folder: results.join("films") }
    }

    /// Keeps an image.
    pub fn save(&self, scene: &str, strategy: &str, run: u32, image: &[Vec3]) -> Result<()> {
        std::fs::create_dir_all(&self.folder).map_err(Error::io("create", &self.folder))?;
        let path = self.path(scene, strategy, run);
        write_whole(&path, bytemuck::cast_slice(image))
    }

    /// Whether the image of a finished run is there.
    pub fn has(&self, scene: &str, strategy: &str, run: u32) -> bool {
        self.path(scene, strategy, run).is_file()
    }

    /// A kept image of so many receivers, if it is there and whole.
    pub fn load(&self, scene: &str, strategy: &str, run: u32, receivers: usize) -> Option<Vec<Vec3>> {
        let bytes = std::fs::read(self.path(scene, strategy, run)).ok()?;
        let image: Vec<Vec3> = bytes.chunks_exact(size_of::<Vec3>()).map(bytemuck::pod_read_unaligned).collect();
        (image.len() == receivers && bytes.len() == receivers * size_of::<Vec3>()).then_some(image)
    }

    /// Removes all images.
    pub fn remove(&self) -> Result<()> {
        match std::fs::remove_dir_all(&self.folder) {
            Err(e) if e.kind() != std::io::ErrorKind::NotFound => Err(Error::io("remove", &self.folder)(e)),
            _ => Ok(()),
        }
    }

    fn path(&self, scene: &str, strategy: &str, run: u32) -> PathBuf {
        self.folder.join(format!("{}-{}-{run}.f32", file_name(scene), file_name(strategy)))
    }
}
