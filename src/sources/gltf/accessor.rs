//! What numbers does an accessor name?
//!
//! Every range is checked against the bytes that are there before anything is read, and nothing is allocated for what
//! a file merely announces. Integers are taken as they are or, where the accessor is `normalized`, as shares of their
//! greatest; what is sparse lies over its base, or over zeros.

use super::document::{Accessor, Sparse};
use super::reader::Reader;
use crate::base::error::Result;
use std::fmt::Display;

const I8: u32 = 5120;
const U8: u32 = 5121;
const I16: u32 = 5122;
const U16: u32 = 5123;
const U32: u32 = 5125;
const F32: u32 = 5126;

/// Most elements of an accessor that has no bytes of its own, unless the file's buffers have more bytes than that.
const MOST_ZEROS: u64 = 1 << 16;

/// Most elements of all sparse accessors: checking 2^27 takes a second.
const MOST_SPARSE: usize = 1 << 27;

/// What an attribute may be made of.
pub(super) struct Form {
    /// Its `type`.
    shape: &'static str,
    /// Its component types, and whether those that are no floats must be normalised.
    kinds: &'static [u32],
    normalized: bool,
    /// All of that in words.
    wanted: &'static str,
}

/// Positions and what morph targets add to them: floats, or any of the integers of `KHR_mesh_quantization`.
pub(super) const POSITIONS: Form = Form {
    shape: "VEC3",
    kinds: &[F32, I8, U8, I16, U16],
    normalized: false,
    wanted: "three floats, `VEC3` of 5126, or integers of 5120 to 5123",
};
/// Texture coordinates, likewise.
pub(super) const COORDINATES: Form = Form {
    shape: "VEC2",
    kinds: &[F32, I8, U8, I16, U16],
    normalized: false,
    wanted: "two floats, `VEC2` of 5126, or integers of 5120 to 5123",
};
/// Translations and scales of instances.
pub(super) const VECTORS: Form =
    Form { shape: "VEC3", kinds: &[F32], normalized: false, wanted: "three floats, `VEC3` of 5126" };
/// Rotations of instances.
pub(super) const ROTATIONS: Form = Form {
    shape: "VEC4",
    kinds: &[F32, I8, I16],
    normalized: true,
    wanted: "four floats, `VEC4` of 5126, or normalized integers of 5120 or 5122",
};
const INDICES: Form =
    Form { shape: "SCALAR", kinds: &[U8, U16, U32], normalized: false, wanted: "a `SCALAR` of 5121, 5123 or 5125" };

/// Vectors, read one by one.
pub(super) struct Numbers<'a> {
    elements: Elements<'a>,
    kind: u32,
    /// What integers are divided by.
    unit: f32,
}

/// Indices, read one by one.
pub(super) struct Indices<'a> {
    elements: Elements<'a>,
    size: usize,
}

/// The bytes of each element.
struct Elements<'a> {
    /// Zeros where there is none.
    base: Option<Strided<'a>>,
    count: usize,
    over: Option<Over<'a>>,
}

/// Elements at equal distances.
#[derive(Clone, Copy)]
struct Strided<'a> {
    bytes: &'a [u8],
    stride: usize,
}

/// Elements in place of others.
struct Over<'a> {
    /// Which, ascending.
    indices: Strided<'a>,
    index_size: usize,
    count: usize,
    values: Strided<'a>,
}

const ZEROS: [u8; 16] = [0; 16];

impl<'a> Elements<'a> {
    fn get(&self, i: usize, size: usize) -> &'a [u8] {
        if let Some(over) = &self.over
            && let Some(at) = over.find(i)
        {
            return &over.values.bytes[at * over.values.stride..][..size];
        }
        self.base.map_or(&ZEROS[..size], |base| &base.bytes[i * base.stride..][..size])
    }
}

impl Over<'_> {
    fn index(&self, at: usize) -> usize {
        whole(&self.indices.bytes[at * self.indices.stride..][..self.index_size])
    }

    fn find(&self, i: usize) -> Option<usize> {
        let (mut low, mut high) = (0, self.count);
        while low < high {
            let middle = low.midpoint(high);
            if self.index(middle) < i { low = middle + 1 } else { high = middle }
        }
        (low < self.count && self.index(low) == i).then_some(low)
    }
}

impl Numbers<'_> {
    /// How many there are.
    pub(super) fn len(&self) -> usize {
        self.elements.count
    }

    /// One of them; `i` is below [`len`](Self::len), `N` as many components as its form has.
    pub(super) fn get<const N: usize>(&self, i: usize) -> [f32; N] {
        let size = size_of(self.kind);
        let bytes = self.elements.get(i, N * size);
        std::array::from_fn(|component| {
            let b = &bytes[component * size..];
            match self.kind {
                I8 => (f32::from(b[0] as i8) / self.unit).max(self.least()),
                U8 => f32::from(b[0]) / self.unit,
                I16 => (f32::from(i16::from_le_bytes([b[0], b[1]])) / self.unit).max(self.least()),
                U16 => f32::from(u16::from_le_bytes([b[0], b[1]])) / self.unit,
                _ => f32::from_le_bytes([b[0], b[1], b[2], b[3]]),
            }
        })
    }

    /// The least that a signed integer stands for: the one number without an opposite is -1 too.
    fn least(&self) -> f32 {
        if self.unit > 1.0 { -1.0 } else { f32::NEG_INFINITY }
    }
}

impl Indices<'_> {
    /// How many there are.
    pub(super) fn len(&self) -> usize {
        self.elements.count
    }

    /// One of them; `i` is below [`len`](Self::len).
    pub(super) fn get(&self, i: usize) -> usize {
        whole(self.elements.get(i, self.size))
    }
}

impl<'a> Reader<'a> {
    /// The accessor of that number, which the document names at `field`, as vectors of a form.
    pub(super) fn numbers(&self, id: u32, field: &dyn Display, form: &Form) -> Result<Numbers<'a>> {
        let (accessor, elements) = self.elements(id, field, form)?;
        let kind = accessor.component_type;
        let unit = match kind {
            _ if !accessor.normalized => 1.0,
            I8 => f32::from(i8::MAX),
            U8 => f32::from(u8::MAX),
            I16 => f32::from(i16::MAX),
            U16 => f32::from(u16::MAX),
            _ => 1.0,
        };
        Ok(Numbers { elements, kind, unit })
    }

    /// The accessor of that number, which the document names at `field`, as indices.
    pub(super) fn indices(&self, id: u32, field: &dyn Display) -> Result<Indices<'a>> {
        let (accessor, elements) = self.elements(id, field, &INDICES)?;
        Ok(Indices { elements, size: size_of(accessor.component_type) })
    }

    fn elements(&self, id: u32, field: &dyn Display, form: &Form) -> Result<(&'a Accessor, Elements<'a>)> {
        let accessors = &self.document.accessors;
        let accessor =
            accessors.get(id as usize).ok_or_else(|| self.no_such("accessor", id, accessors.len(), field))?;
        let wrong = |name: &str, message: &dyn Display| self.wrong(format_args!("accessors[{id}].{name}"), message);
        let kind = accessor.component_type;
        let fits = form.shape == accessor.shape && form.kinds.contains(&kind);
        if !fits || (form.normalized && kind != F32 && !accessor.normalized) {
            let (shape, wanted) = (&accessor.shape, form.wanted);
            return Err(wrong(
                "componentType",
                &format_args!("`{shape}` of {kind} is given; `{field}` needs {wanted}"),
            ));
        }
        let size = components(form.shape).unwrap_or(1) * size_of(kind);
        let name = format!("accessors[{id}].");
        let view = Part { name: &name, view: accessor.buffer_view, offset: accessor.byte_offset, kind, size };
        if accessor.count == 0 {
            return Err(wrong("count", &"0 is given; 1 or more is asked for"));
        }
        let over = accessor.sparse.as_ref().map(|sparse| self.over(id, accessor.count, sparse, kind, size));
        let base = match (accessor.buffer_view, &over) {
            (None, None) => {
                let compressed = "is missing; the number of a buffer view is asked for: in a compressed mesh the \
                                  numbers lie elsewhere, and it must be written without compression";
                return Err(wrong("bufferView", &compressed));
            }
            (None, Some(_)) => {
                let most = self.buffers.iter().map(|buffer| buffer.len() as u64).sum::<u64>().max(MOST_ZEROS);
                if accessor.count > most {
                    let count = accessor.count;
                    let text = format_args!("{count} elements without a buffer view are given; {most} are the most");
                    return Err(wrong("count", &text));
                }
                None
            }
            (Some(_), _) => Some(self.strided(&view, accessor.count, "count")?),
        };
        Ok((accessor, Elements { base, count: accessor.count as usize, over: over.transpose()? }))
    }

    /// Fails unless the elements of each sparse accessor ascend, which finding one relies on.
    pub(super) fn check_sparse(&self) -> Result<()> {
        let mut total = 0;
        for (id, accessor) in self.document.accessors.iter().enumerate() {
            let Some(sparse) = &accessor.sparse else { continue };
            let Some(components) = components(&accessor.shape) else { continue };
            let wrong =
                |name: &str, message: &dyn Display| self.wrong(format_args!("accessors[{id}].sparse.{name}"), message);
            let (kind, size) = (accessor.component_type, components * size_of(accessor.component_type));
            let over = self.over(id as u32, accessor.count, sparse, kind, size)?;
            total += over.count;
            if total > MOST_SPARSE {
                let text = format_args!("with {} here there are more than {MOST_SPARSE} in all, the most", over.count);
                return Err(wrong("count", &text));
            }
            let mut least = 0;
            for at in 0..over.count {
                let (index, count) = (over.index(at), accessor.count);
                if index < least || index as u64 >= count {
                    let text = format_args!("index {at} is {index}; {least} to below {count} is asked for");
                    return Err(wrong("indices", &text));
                }
                least = index + 1;
            }
        }
        Ok(())
    }

    /// What lies over an accessor's base.
    fn over(&self, id: u32, elements: u64, sparse: &'a Sparse, kind: u32, size: usize) -> Result<Over<'a>> {
        let wrong =
            |name: &str, message: &dyn Display| self.wrong(format_args!("accessors[{id}].sparse.{name}"), message);
        if sparse.count == 0 || sparse.count > elements {
            let text = format_args!("{} is given; 1 to {elements}, the accessor's own, is asked for", sparse.count);
            return Err(wrong("count", &text));
        }
        let index_kind = sparse.indices.component_type.unwrap_or_default();
        if ![U8, U16, U32].contains(&index_kind) {
            let text = format_args!("{index_kind} is given; 5121, 5123 or 5125 is asked for");
            return Err(wrong("indices.componentType", &text));
        }
        let index_size = size_of(index_kind);
        let part = |name: &str, part: &super::document::SparsePart, kind, size| {
            let name = format!("accessors[{id}].sparse.{name}.");
            let part = Part { name: &name, view: Some(part.buffer_view), offset: part.byte_offset, kind, size };
            self.strided(&part, sparse.count, "bufferView")
        };
        Ok(Over {
            indices: part("indices", &sparse.indices, index_kind, index_size)?,
            index_size,
            count: sparse.count as usize,
            values: part("values", &sparse.values, kind, size)?,
        })
    }

    /// `count` elements of a buffer view; `counted` is the field that says how many.
    fn strided(&self, part: &Part, count: u64, counted: &str) -> Result<Strided<'a>> {
        let Part { name, kind, size, .. } = *part;
        let wrong = |field: &str, message: &dyn Display| self.wrong(format_args!("{name}{field}"), message);
        let view_id = part.view.unwrap_or_default();
        let bytes = self.bytes_of_view(view_id, &format_args!("{name}bufferView"))?;
        let view = &self.document.buffer_views[view_id as usize];
        let stride = view.byte_stride.unwrap_or(size as u64);
        if stride < size as u64 || view.byte_stride.is_some_and(|stride| stride > 252 || stride % 4 != 0) {
            let text = format_args!("{stride} is given; a multiple of 4 from {size} to 252 is asked for");
            return Err(self.wrong(format_args!("bufferViews[{view_id}].byteStride"), text));
        }
        let component = size_of(kind) as u64;
        if !part.offset.wrapping_add(view.byte_offset).is_multiple_of(component) {
            let (at, from) = (part.offset, view.byte_offset);
            let text =
                format_args!("{at} is given after {from} of the view; the sum must be a multiple of {component}");
            return Err(wrong("byteOffset", &text));
        }
        let needed = (count - 1).checked_mul(stride).and_then(|bytes| bytes.checked_add(size as u64));
        let bytes = needed.and_then(|needed| slice(bytes, part.offset, needed)).ok_or_else(|| {
            let (at, length) = (part.offset, view.byte_length);
            wrong(
                counted,
                &format_args!(
                    "{count} elements every {stride} bytes from byte {at} do not fit in the {length} of its view"
                ),
            )
        })?;
        Ok(Strided { bytes, stride: stride as usize })
    }

    /// The bytes of a buffer view, which the document names at `field`.
    pub(super) fn bytes_of_view(&self, id: u32, field: &dyn Display) -> Result<&'a [u8]> {
        let views = &self.document.buffer_views;
        let view = views.get(id as usize).ok_or_else(|| self.no_such("buffer view", id, views.len(), field))?;
        let bytes = self.buffers.get(view.buffer as usize).ok_or_else(|| {
            self.no_such("buffer", view.buffer, self.buffers.len(), &format_args!("bufferViews[{id}].buffer"))
        })?;
        let (from, length) = (view.byte_offset, view.byte_length);
        slice(bytes, from, length).ok_or_else(|| {
            let there = bytes.len();
            let text = format_args!("bytes {from} and {length} more are named of a buffer of {there}");
            self.wrong(format_args!("bufferViews[{id}].byteLength"), text)
        })
    }
}

/// Elements in a buffer view.
struct Part<'n> {
    /// What stands before the fields' names in errors.
    name: &'n str,
    view: Option<u32>,
    offset: u64,
    kind: u32,
    /// Bytes of an element.
    size: usize,
}

/// Components of an element.
fn components(shape: &str) -> Option<usize> {
    Some(match shape {
        "SCALAR" => 1,
        "VEC2" => 2,
        "VEC3" => 3,
        "VEC4" => 4,
        _ => return None,
    })
}

/// Bytes of a component.
fn size_of(kind: u32) -> usize {
    match kind {
        I8 | U8 => 1,
        I16 | U16 => 2,
        _ => 4,
    }
}

/// The number that up to four bytes spell, the least first.
fn whole(bytes: &[u8]) -> usize {
    bytes.iter().rev().fold(0, |value, &byte| value << 8 | usize::from(byte))
}

/// `length` bytes from `from` on, if they are there.
fn slice(bytes: &[u8], from: u64, length: u64) -> Option<&[u8]> {
    let (from, length) = (usize::try_from(from).ok()?, usize::try_from(length).ok()?);
    bytes.get(from..from.checked_add(length)?)
}
