//! Finished tiles of a reference on disk: appended one by one, so that an interruption loses none.
//!
//! A file of tiles says in its head what they are of. Two processes may fill one: each looks at what the other has done
//! and appends under a lock, which ends with its holder.

use crate::base::error::{Error, Result};
use crate::render::exact::Exact;
use glam::DVec3;
use std::fs::{File, OpenOptions};
use std::io::{Read, Seek, SeekFrom, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Receivers a tile.
pub(super) const TILE: usize = 32;

/// A file of finished tiles: a head, then records, each a tile's index, its values and a checksum. A record cut short by
/// an interruption, and whatever follows it, is dropped, as is all of a file with another head.
pub(super) struct TileFile {
    path: PathBuf,
    file: File,
    head: Vec<u8>,
    receivers: usize,
    /// Where the records end that are known of.
    end: u64,
    /// Whether each tile is among them.
    known: Vec<bool>,
}

/// One receiver as stored: nine f64 of radiance, two marks and a count of rays.
const VALUE: usize = 96;

/// Digits of the hash that a file is named by; all of it stands in its head.
const NAME: usize = 32;

/// A tile and its values.
type Tile = (usize, Vec<Exact>);

impl TileFile {
    /// Opens or makes the file of what `hash` names, all that decides the tiles, in `folder`, and reads the tiles that
    /// it holds, of `receivers` receivers.
    pub(super) fn open(folder: &Path, hash: &str, receivers: usize) -> Result<(Self, Vec<Option<Vec<Exact>>>)> {
        let path = folder.join(format!("{}.tiles", &hash[..hash.len().min(NAME)]));
        let head = format!("citylights tiles {hash} {receivers}\n").into_bytes();
        let known = vec![false; receivers.div_ceil(TILE)];
        let mut tiles = vec![None; known.len()];
        let written = std::fs::create_dir_all(folder).map_err(Error::io("create", folder)).and_then(|()| {
            let file = OpenOptions::new().create(true).truncate(false).read(true).write(true).open(&path);
            file.map_err(Error::io("open", &path))
        });
        let file = match written {
            Ok(file) => file,
            // What cannot be written is still good where nothing needs to be.
            Err(refused) => {
                let Some((file, whole)) = whole(&path, &head, receivers) else { return Err(refused) };
                return Ok((Self { path, file, head, receivers, end: 0, known }, whole));
            }
        };
        let mut opened = Self { path, file, head, receivers, end: 0, known };
        for (tile, values) in opened.locked(Self::catch_up)? {
            tiles[tile] = Some(values);
        }
        Ok((opened, tiles))
    }

    /// Appends a finished tile, unless another process has.
    pub(super) fn append(&mut self, tile: usize, values: &[Exact]) -> Result<()> {
        let mut bytes = Vec::with_capacity(values.len() * VALUE + 24);
        bytes.extend((tile as u64).to_le_bytes());
        for value in values {
            for vector in [value.sum, value.halves[0], value.halves[1]] {
                vector.to_array().iter().for_each(|x| bytes.extend(x.to_le_bytes()));
            }
            value.marks.iter().for_each(|mark| bytes.extend(mark.to_le_bytes()));
            bytes.extend(value.rays.to_le_bytes());
        }
        bytes.extend(checksum(&bytes));
        self.locked(|this| {
            this.catch_up()?;
            if !this.known[tile] {
                this.file.write_all(&bytes)?;
                this.end += bytes.len() as u64;
                this.known[tile] = true;
            }
            Ok(())
        })
    }

    /// Does what no other process may do meanwhile.
    fn locked<T>(&mut self, act: impl FnOnce(&mut Self) -> std::io::Result<T>) -> Result<T> {
        let done = self.file.lock().and_then(|()| {
            let done = act(self);
            self.file.unlock()?;
            done
        });
        done.map_err(Error::io("write", &self.path))
    }

    /// Reads the records from where it knows of none, cuts off what is none, and stands at the end.
    fn catch_up(&mut self) -> std::io::Result<Vec<Tile>> {
        let length = self.file.metadata()?.len();
        if length < self.end {
            // Somebody has cut it: what is left is read anew.
            self.end = 0;
            self.known.fill(false);
        }
        let mut bytes = Vec::new();
        self.file.seek(SeekFrom::Start(self.end))?;
        self.file.read_to_end(&mut bytes)?;
        let (mut tiles, mut good) = (Vec::new(), 0);
        if self.end == 0 {
            if bytes.starts_with(&self.head) {
                good = self.head.len();
            } else {
                self.file.set_len(0)?;
                self.file.rewind()?;
                self.file.write_all(&self.head)?;
                self.end = self.head.len() as u64;
                return Ok(tiles);
            }
        }
        while let Some((tile, values, end)) = record(&bytes, good, self.receivers) {
            self.known[tile] = true;
            tiles.push((tile, values));
            good = end;
        }
        self.end += good as u64;
        if good < bytes.len() {
            self.file.set_len(self.end)?;
        }
        self.file.seek(SeekFrom::Start(self.end))?;
        Ok(tiles)
    }
}

/// The file and all its tiles, if it can be read and none is missing.
fn whole(path: &Path, head: &[u8], receivers: usize) -> Option<(File, Vec<Option<Vec<Exact>>>)> {
    let mut file = File::open(path).ok()?;
    let mut bytes = Vec::new();
    file.lock_shared().and_then(|()| file.read_to_end(&mut bytes)).ok()?;
    file.unlock().ok()?;
    let mut at = bytes.starts_with(head).then_some(head.len())?;
    let mut tiles = vec![None; receivers.div_ceil(TILE)];
    while let Some((tile, values, end)) = record(&bytes, at, receivers) {
        tiles[tile] = Some(values);
        at = end;
    }
    tiles.iter().all(Option::is_some).then_some((file, tiles))
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
    let whole = |at: usize| bytes[at..at + 8].try_into().map_or(0, u64::from_le_bytes);
    let number = |at: usize| f64::from_bits(whole(at));
    let vector = |at: usize| DVec3::new(number(at), number(at + 8), number(at + 16));
    let values = (start + 8..end).step_by(VALUE).map(|at| Exact {
        sum: vector(at),
        halves: [vector(at + 24), vector(at + 48)],
        marks: [whole(at + 72), whole(at + 80)],
        rays: whole(at + 88),
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

    fn value(x: f64) -> Exact {
        Exact { sum: DVec3::splat(x), halves: [DVec3::splat(-x); 2], marks: [1, 2], rays: 7 }
    }

    const HASH: &str = "0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef";

    fn file(folder: &Path) -> PathBuf {
        folder.join(format!("{}.tiles", &HASH[..NAME]))
    }

    #[test]
    fn a_cut_off_tail_loses_only_itself() {
        let folder = tempfile::tempdir().expect("a folder");
        let n = TILE + 3;
        let open = || TileFile::open(folder.path(), HASH, n).expect("a file");
        let (mut opened, tiles) = open();
        assert!(tiles.iter().all(Option::is_none));
        opened.append(1, &[value(2.0); 3]).expect("written");
        opened.append(0, &vec![value(1.0); TILE]).expect("written");
        let path = file(folder.path());
        let length = std::fs::metadata(&path).expect("there").len();
        OpenOptions::new().write(true).open(&path).and_then(|f| f.set_len(length - 5)).expect("cut");
        let (mut opened, tiles) = open();
        assert_eq!(tiles[1].as_deref(), Some(&[value(2.0); 3][..]));
        assert!(tiles[0].is_none());
        opened.append(0, &vec![value(3.0); TILE]).expect("written");
        assert_eq!(open().1[0].as_ref().map(|t| t[5]), Some(value(3.0)));
    }

    #[test]
    fn tiles_of_something_else_under_this_name_are_not_taken() {
        let folder = tempfile::tempdir().expect("a folder");
        let (mut other, _) = TileFile::open(folder.path(), &HASH.replace('7', "8"), 3).expect("a file");
        other.append(0, &[value(9.0); 3]).expect("written");
        std::fs::rename(&other.path, file(folder.path())).expect("renamed");
        let (mut own, tiles) = TileFile::open(folder.path(), HASH, 3).expect("a file");
        assert!(tiles[0].is_none());
        own.append(0, &[value(1.0); 3]).expect("written");
        let (_, tiles) = TileFile::open(folder.path(), HASH, 3).expect("a file");
        assert_eq!(tiles[0].as_deref(), Some(&[value(1.0); 3][..]));
    }

    #[test]
    fn only_a_whole_file_is_taken_where_nothing_can_be_written() {
        let folder = tempfile::tempdir().expect("a folder");
        let n = TILE + 3;
        let head = |hash: &str| format!("citylights tiles {hash} {n}\n").into_bytes();
        let found = |hash: &str| whole(&file(folder.path()), &head(hash), n).map(|(_, tiles)| tiles);
        let (mut opened, _) = TileFile::open(folder.path(), HASH, n).expect("a file");
        opened.append(1, &[value(2.0); 3]).expect("written");
        assert!(found(HASH).is_none(), "a tile is missing");
        opened.append(0, &vec![value(1.0); TILE]).expect("written");
        assert!(found(&HASH.replace('7', "8")).is_none(), "it is another's");
        let tiles = found(HASH).expect("whole");
        assert_eq!(tiles[1].as_deref(), Some(&[value(2.0); 3][..]));
        assert_eq!(tiles[0].as_deref(), Some(&vec![value(1.0); TILE][..]));
    }

    #[test]
    fn two_may_fill_one_file() {
        let folder = tempfile::tempdir().expect("a folder");
        let (tiles, receivers) = (64, 64 * TILE);
        let fill = |order: &mut dyn Iterator<Item = usize>| {
            let (mut opened, _) = TileFile::open(folder.path(), HASH, receivers).expect("a file");
            order.for_each(|tile| opened.append(tile, &vec![value(tile as f64); TILE]).expect("written"));
        };
        std::thread::scope(|scope| {
            scope.spawn(|| fill(&mut (0..tiles)));
            scope.spawn(|| fill(&mut (0..tiles).rev()));
        });
        let (opened, found) = TileFile::open(folder.path(), HASH, receivers).expect("a file");
        for (tile, values) in found.iter().enumerate() {
            assert_eq!(values.as_deref(), Some(&vec![value(tile as f64); TILE][..]), "tile {tile}");
        }
        let each = 8 + TILE * VALUE + 16;
        assert_eq!(opened.end as usize, opened.head.len() + tiles * each, "a tile stands twice");
    }
}
