//! What numbers does an accessor name?
//!
//! Every range is checked against the bytes that are there before anything is read, and nothing is allocated for what
//! a file merely announces.

use super::reader::Reader;
use crate::base::error::Result;
use std::fmt::Display;

const U8: u32 = 5121;
const U16: u32 = 5123;
const U32: u32 = 5125;
const F32: u32 = 5126;

/// Positions, read one by one.
#[derive(Clone, Copy)]
pub(super) struct Positions<'a>(Strided<'a>);

/// Indices, read one by one.
#[derive(Clone, Copy)]
pub(super) struct Indices<'a> {
    of: Strided<'a>,
    size: usize,
}

/// Elements at equal distances.
#[derive(Clone, Copy)]
struct Strided<'a> {
    bytes: &'a [u8],
    stride: usize,
    count: usize,
}

impl Positions<'_> {
    /// How many there are.
    pub(super) fn len(&self) -> usize {
        self.0.count
    }

    /// The position of a vertex; `i` is below [`len`](Self::len).
    pub(super) fn get(&self, i: usize) -> [f32; 3] {
        let bytes = &self.0.bytes[i * self.0.stride..][..12];
        [0, 4, 8].map(|at| f32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]))
    }
}

impl Indices<'_> {
    /// How many there are.
    pub(super) fn len(&self) -> usize {
        self.of.count
    }

    /// One of them; `i` is below [`len`](Self::len).
    pub(super) fn get(&self, i: usize) -> usize {
        let bytes = &self.of.bytes[i * self.of.stride..][..self.size];
        bytes.iter().rev().fold(0, |value, &byte| value << 8 | usize::from(byte))
    }
}

impl<'a> Reader<'a> {
    /// The accessor of that number, which the document names at `field`, as positions.
    pub(super) fn positions(&self, id: u32, field: &dyn Display) -> Result<Positions<'a>> {
        self.strided(id, field, "VEC3", &[(F32, 12)], "three floats, `VEC3` of 5126").map(|(of, _)| Positions(of))
    }

    /// The accessor of that number, which the document names at `field`, as indices.
    pub(super) fn indices(&self, id: u32, field: &dyn Display) -> Result<Indices<'a>> {
        let sizes = [(U8, 1), (U16, 2), (U32, 4)];
        self.strided(id, field, "SCALAR", &sizes, "a `SCALAR` of 5121, 5123 or 5125")
            .map(|(of, size)| Indices { of, size })
    }

    fn strided(
        &self,
        id: u32,
        field: &dyn Display,
        shape: &str,
        sizes: &[(u32, usize)],
        wanted: &str,
    ) -> Result<(Strided<'a>, usize)> {
        let accessors = &self.document.accessors;
        let accessor =
            accessors.get(id as usize).ok_or_else(|| self.no_such("accessor", id, accessors.len(), field))?;
        let wrong = |name: &str, message: &dyn Display| self.wrong(format_args!("accessors[{id}].{name}"), message);
        let size = sizes.iter().find(|(kind, _)| *kind == accessor.component_type && accessor.shape == shape);
        let Some(&(_, size)) = size else {
            let (kind, shape) = (accessor.component_type, &accessor.shape);
            return Err(wrong(
                "componentType",
                &format_args!("`{shape}` of {kind} is given; `{field}` needs {wanted}"),
            ));
        };
        if accessor.sparse.is_some() {
            return Err(wrong("sparse", &"sparse accessors are not read; write the values out in full"));
        }
        let Some(view_id) = accessor.buffer_view else {
            return Err(wrong("bufferView", &"is missing; the number of a buffer view is asked for"));
        };
        let views = &self.document.buffer_views;
        let view = views.get(view_id as usize).ok_or_else(|| {
            self.no_such("buffer view", view_id, views.len(), &format_args!("accessors[{id}].bufferView"))
        })?;
        let of_view =
            |name: &str, message: &dyn Display| self.wrong(format_args!("bufferViews[{view_id}].{name}"), message);
        let bytes = self.buffers.get(view.buffer as usize).ok_or_else(|| {
            self.no_such("buffer", view.buffer, self.buffers.len(), &format_args!("bufferViews[{view_id}].buffer"))
        })?;
        let (from, length) = (view.byte_offset, view.byte_length);
        let bytes = slice(bytes, from, length).ok_or_else(|| {
            let there = bytes.len();
            of_view("byteLength", &format_args!("bytes {from} and {length} more are named of a buffer of {there}"))
        })?;
        let stride = view.byte_stride.unwrap_or(size as u64);
        if stride < size as u64 || view.byte_stride.is_some_and(|stride| stride > 252 || stride % 4 != 0) {
            let text = format_args!("{stride} is given; a multiple of 4 from {size} to 252 is asked for");
            return Err(of_view("byteStride", &text));
        }
        let component = if shape == "VEC3" { 4 } else { size as u64 };
        if (accessor.byte_offset.wrapping_add(from)) % component != 0 {
            let at = accessor.byte_offset;
            let text =
                format_args!("{at} is given after {from} of the view; the sum must be a multiple of {component}");
            return Err(wrong("byteOffset", &text));
        }
        let Some(gaps) = accessor.count.checked_sub(1) else {
            return Err(wrong("count", &"0 is given; 1 or more is asked for"));
        };
        let needed = gaps.checked_mul(stride).and_then(|bytes| bytes.checked_add(size as u64));
        let bytes = needed.and_then(|needed| slice(bytes, accessor.byte_offset, needed)).ok_or_else(|| {
            let (count, at) = (accessor.count, accessor.byte_offset);
            wrong(
                "count",
                &format_args!(
                    "{count} elements every {stride} bytes from byte {at} do not fit in the {length} of its view"
                ),
            )
        })?;
        Ok((Strided { bytes, stride: stride as usize, count: accessor.count as usize }, size))
    }
}

/// `length` bytes from `from` on, if they are there.
fn slice(bytes: &[u8], from: u64, length: u64) -> Option<&[u8]> {
    let (from, length) = (usize::try_from(from).ok()?, usize::try_from(length).ok()?);
    bytes.get(from..from.checked_add(length)?)
}
