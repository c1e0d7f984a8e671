//! What breaks files: bytes flipped, cut out, doubled and swapped, numbers replaced.

use citylights::base::random::Stream;

/// Numbers at which readers break.
pub(crate) const NUMBERS: [&str; 33] = [
    "0",
    "1",
    "-1",
    "2",
    "3",
    "4",
    "7",
    "255",
    "256",
    "65535",
    "65536",
    "2147483647",
    "4294967295",
    "4294967296",
    "9223372036854775807",
    "18446744073709551615",
    "99999999999999999999999",
    "0.5",
    "-0.0",
    "1e-320",
    "1e38",
    "1e39",
    "1e308",
    "1e999",
    "nan",
    "null",
    "inf",
    "true",
    "0.1",
    "89.9999999",
    "1e7",
    "5e-324",
    "18446744073709551616",
];

/// One of many, at random.
pub(crate) fn below(stream: &mut Stream, n: usize) -> usize {
    ((stream.uniform64() * n as f64) as usize).min(n.saturating_sub(1))
}

/// Breaks bytes in one to four places, half of the time in one.
pub(crate) fn broken(stream: &mut Stream, mut bytes: Vec<u8>) -> Vec<u8> {
    for _ in 0..=below(stream, 4) * below(stream, 2) {
        let at = below(stream, bytes.len());
        let end = (at + 1 + below(stream, 40)).min(bytes.len());
        match below(stream, 13) {
            0 => bytes.get_mut(at).into_iter().for_each(|byte| *byte ^= 1 << below(stream, 8)),
            1 => bytes.get_mut(at).into_iter().for_each(|byte| *byte = below(stream, 256) as u8),
            2 => drop(bytes.drain(at..end)),
            3 => bytes.splice(at..at, bytes[at..end].to_vec()).for_each(drop),
            4 if below(stream, 4) == 0 => bytes.truncate(at),
            5 => {
                let from = below(stream, bytes.len());
                let piece = bytes[from..(from + end - at).min(bytes.len())].to_vec();
                bytes.splice(at..end, piece).for_each(drop);
            }
            6 => {
                let word = [0u32, 1, 0xff, 0xffff, 0x7f80_0000, 0x7fc0_0000, 0xffff_ffff][below(stream, 7)];
                bytes.iter_mut().skip(at).zip(word.to_le_bytes()).for_each(|(byte, new)| *byte = new);
            }
            // The rest of the line, dropped or doubled.
            7 => {
                let end = bytes.iter().skip(at).position(|&byte| byte == b'\n').map_or(end, |length| at + length);
                let twice = bytes[at..end].repeat(2 * below(stream, 2));
                bytes.splice(at..end, twice).for_each(drop);
            }
            _ => number(stream, &mut bytes, at),
        }
    }
    bytes
}

/// Replaces the first number from `at` on.
fn number(stream: &mut Stream, bytes: &mut Vec<u8>, at: usize) {
    let part = |byte: &u8| byte.is_ascii_digit() || b".+-eE_".contains(byte);
    let Some(from) = bytes.iter().skip(at).position(u8::is_ascii_digit).map(|from| from + at) else { return };
    let end = from + bytes[from..].iter().take_while(|byte| part(byte)).count();
    bytes.splice(from..end, NUMBERS[below(stream, NUMBERS.len())].bytes()).for_each(drop);
}
