//! OpenEXR: linear light as 32-bit floats, out exactly as computed, in from this and other tools.

mod channels;
mod primaries;
mod read;
mod write;

pub(crate) use read::read;
pub(crate) use write::encode;
