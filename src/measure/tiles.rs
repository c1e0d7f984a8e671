//! Finished tiles of a reference on disk: appended one by one, so that an interruption loses none.

use crate::base::error::{Error, Result};
use crate::render::exact::Exact;
use glam::DVec3;
use std::fs::{File, OpenOptions};
use std::io::Write;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Receivers a tile.
pub(super) const TILE: usize = 32;

/// A file of finished tiles. Each record is the tile's index, its values and a checksum; a record cut short by an
/// interruption, and whatever follows it, is dropped.
pub(super) struct TileFile {
    path: PathBuf,
    file: File,
}

/// One receiver as stored: nine f64 of radiance and a count of rays.
const VALUE: usize = 80;

impl TileFile {
    /// Opens or makes the file of `name` in `folder` and reads the tiles that it holds, of `receivers` receivers.
    pub(super) fn open(folder: &Path, name: &str, receivers: usize) -> Result<(Self, Vec<Option<Vec<Exact>>>)> {
        std::fs::create_dir_all(folder).map_err(Error::io("create", folder))?;
        let path = folder.join(format!("{name}.tiles"));
        let mut tiles: Vec<Option<Vec<Exact>>> = vec![None; receivers.div_ceil(TILE)];
        let bytes = match std::fs::read(&path) {
            Ok(bytes) => bytes,
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => Vec::new(),
            Err(e) => return Err(Error::io("read", &path)(e)),
        };
        let mut good = 0;
        while let Some((tile, values, end)) = record(&bytes, good, receivers) {
            tiles[tile] = Some(values);
            good = end;
        }
        let file = OpenOptions::new()
            .create(true)
            .truncate(false)
            .write(true)
            .open(&path)
            .map_err(Error::io("write", &path))?;
        file.set_len(good as u64).map_err(Error::io("write", &path))?;
        let mut opened = Self { path, file };
        use std::io::Seek;
        opened.file.seek(std::io::SeekFrom::End(0)).map_err(Error::io("write", &opened.path))?;
        Ok((opened, tiles))
    }

    /// Appends a finished tile.
    pub(super) fn append(&mut self, tile: usize, values: &[Exact]) -> Result<()> {
        let mut bytes = Vec::with_capacity(values.len() * VALUE + 24);
        bytes.extend((tile as u64).to_le_bytes());
        for value in values {
            for vector in [value.sum, value.halves[0], value.halves[1]] {
                vector.to_array().iter().for_each(|x| bytes.extend(x.to_le_bytes()));
            }
            bytes.extend(value.rays.to_le_bytes());
        }
        bytes.extend(checksum(&bytes));
        self.file.write_all(&bytes).map_err(Error::io("write", &self.path))
    }
}

/// The receivers of a tile.
pub(super) fn range(tile: usize, receivers: usize) -> Range<usize> {
    tile * TILE..((tile + 1) * TILE).min(receivers)
}

fn record(bytes: &[u8], start: usize, receivers: usize) -> Option<(usize, Vec<Exact>, usize)> {
    let tile = usize::try_from(u64::from_le_bytes(bytes.get(start..start + 8)?.try_into().ok()?)).ok()?;
    if tile >= receivers.div_ceil(TILE) {
        return None;
    }
    let end = start + 8 + range(tile, receivers).len() * VALUE;
    if bytes.get(end..end + 16)? != checksum(&bytes[start..end]) {
        return None;
    }
    let number = |at: usize| bytes[at..at + 8].try_into().map_or(f64::NAN, f64::from_le_bytes);
    let vector = |at: usize| DVec3::new(number(at), number(at + 8), number(at + 16));
    let values = (start + 8..end).step_by(VALUE).map(|at| Exact {
        sum: vector(at),
        halves: [vector(at + 24), vector(at + 48)],
        rays: number(at + 72).to_bits(),
    });
    Some((tile, values.collect(), end + 16))
}

fn checksum(bytes: &[u8]) -> [u8; 16] {
    let mut short = [0; 16];
    short.copy_from_slice(&blake3::hash(bytes).as_bytes()[..16]);
    short
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cut_off_tail_loses_only_itself() {
        let folder = tempfile::tempdir().expect("a folder");
        let value = |x: f64| Exact { sum: DVec3::splat(x), halves: [DVec3::splat(-x); 2], rays: 7 };
        let n = TILE + 3;
        let (mut file, tiles) = TileFile::open(folder.path(), "t", n).expect("a new file");
        assert!(tiles.iter().all(Option::is_none));
        file.append(1, &[value(2.0); 3]).expect("written");
        file.append(0, &vec![value(1.0); TILE]).expect("written");
        let path = folder.path().join("t.tiles");
        let length = std::fs::metadata(&path).expect("there").len();
        OpenOptions::new().write(true).open(&path).and_then(|f| f.set_len(length - 5)).expect("cut");
        let (mut file, tiles) = TileFile::open(folder.path(), "t", n).expect("a cut file");
        assert_eq!(tiles[1].as_deref(), Some(&[value(2.0); 3][..]));
        assert!(tiles[0].is_none());
        file.append(0, &vec![value(3.0); TILE]).expect("written");
        let (_, tiles) = TileFile::open(folder.path(), "t", n).expect("a whole file");
        assert_eq!(tiles[0].as_ref().map(|t| t[5]), Some(value(3.0)));
    }
}
