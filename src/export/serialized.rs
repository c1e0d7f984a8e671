//! Mitsuba's `serialized` container: many meshes in one file.
//!
//! A mesh is a header of four bytes and a zlib stream; at the end stand the offsets of all and their number. Streams
//! are stored, not compressed: corners as f32 shrink little.
//! Source: Mitsuba 3, documentation of the `serialized` shape, version 4 of the format; RFC 1950 and 1951.

use super::meshes::Corners;

/// f32 positions, and each face its own normal.
const FLAGS: u32 = 0x1000 | 0x0010;

/// The bytes of a file with these meshes, each triangle with three corners of its own.
pub(super) fn encode<'a>(meshes: impl IntoIterator<Item = &'a [Corners]>) -> Vec<u8> {
    let (mut bytes, mut offsets) = (Vec::new(), Vec::new());
    for triangles in meshes {
        offsets.push(bytes.len() as u64);
        bytes.extend([0x1c, 0x04, 4, 0]);
        let mut data = FLAGS.to_le_bytes().to_vec();
        data.push(0); // an empty name, ended
        let corners = 3 * triangles.len() as u64;
        data.extend(corners.to_le_bytes());
        data.extend((triangles.len() as u64).to_le_bytes());
        data.extend_from_slice(bytemuck::cast_slice(triangles));
        data.extend((0..corners as u32).flat_map(u32::to_le_bytes));
        store(&data, &mut bytes);
    }
    bytes.extend(offsets.iter().flat_map(|offset| offset.to_le_bytes()));
    bytes.extend((offsets.len() as u32).to_le_bytes());
    bytes
}

/// Appends `data` as a zlib stream of stored blocks.
fn store(data: &[u8], out: &mut Vec<u8>) {
    out.extend([0x78, 0x01]);
    let mut blocks = data.chunks(usize::from(u16::MAX)).peekable();
    while let Some(block) = blocks.next() {
        let length = block.len() as u16;
        out.push(u8::from(blocks.peek().is_none()));
        out.extend(length.to_le_bytes());
        out.extend((!length).to_le_bytes());
        out.extend(block);
    }
    out.extend(adler32(data).to_be_bytes());
}

/// The checksum of RFC 1950.
fn adler32(data: &[u8]) -> u32 {
    let (mut a, mut b) = (1u32, 0u32);
    // 5,552 bytes: the most whose sums fit 32 bits.
    for run in data.chunks(5_552) {
        for &byte in run {
            a += u32::from(byte);
            b += a;
        }
        (a, b) = (a % 65_521, b % 65_521);
    }
    b << 16 | a
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_checksum_is_that_of_the_rfc() {
        assert_eq!(adler32(b"Wikipedia"), 0x11e6_0398);
        assert_eq!(adler32(b""), 1);
        // Long enough for both sums to overflow their moduli; the value is zlib's.
        assert_eq!(adler32(&[0xff; 20_000]), 0x9f51_d664);
    }
}
