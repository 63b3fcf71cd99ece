//! Random changes of a file.

use fastrand::Rng;

/// The longest input in bytes.
pub const MAX_BYTES: usize = 1 << 16;

/// Integers at the limits of types and of plausible counts.
const INTEGERS: [u64; 14] = [
    0,
    1,
    2,
    0x7f,
    0x80,
    0xff,
    0x7fff,
    0xffff,
    0x7fff_ffff,
    0x8000_0000,
    0xffff_ffff,
    0x4000_0000,
    0x7fff_ffff_ffff_ffff,
    0xffff_ffff_ffff_ffff,
];

/// Words in the place of a number in a text.
const WORDS: [&str; 20] = [
    "0",
    "-1",
    "1",
    "3",
    "65536",
    "4294967295",
    "4294967296",
    "18446744073709551615",
    "9223372036854775807",
    "99999999999999999999999",
    "1e308",
    "-1e308",
    "1e999",
    "1e-320",
    "nan",
    "inf",
    "-0.0",
    "0x10",
    "",
    "..",
];

/// Changes a copy of a seed by one to eight random operations. Parts of other seeds may be inserted.
pub fn mutate(seeds: &[Vec<u8>], rng: &mut Rng) -> Vec<u8> {
    let mut bytes = rng.choice(seeds).cloned().unwrap_or_default();
    for _ in 0..1 << rng.u32(0..4) {
        change(&mut bytes, seeds, rng);
    }
    bytes.truncate(MAX_BYTES);
    bytes
}

fn change(bytes: &mut Vec<u8>, seeds: &[Vec<u8>], rng: &mut Rng) {
    if bytes.is_empty() {
        bytes.push(rng.u8(..));
        return;
    }
    // Headers decide most, so half of the changes are near the start.
    let limit = if rng.bool() { bytes.len().min(512) } else { bytes.len() };
    let at = rng.usize(..limit);
    let longest = if rng.bool() { 8 } else { 4096 };
    let length = rng.usize(1..=longest.min(bytes.len() - at));
    match rng.u8(..10) {
        0 => bytes[at] ^= 1 << rng.u8(..8),
        1 => bytes[at] = rng.u8(..),
        2 | 3 => integer(bytes, at, rng),
        4 => drop(bytes.drain(at..at + length)),
        5 => {
            let copy = bytes[at..at + length].to_vec();
            let to = rng.usize(..=bytes.len());
            bytes.splice(to..to, copy);
        }
        6 => {
            let other = rng.choice(seeds).map_or(&[][..], Vec::as_slice);
            let from = rng.usize(..=other.len());
            let part = other[from..(from + length).min(other.len())].to_vec();
            bytes.splice(at..at, part);
        }
        7 => bytes.truncate(at),
        _ => number(bytes, at, rng),
    }
}

/// Overwrites bytes with an integer of 1 to 8 bytes.
fn integer(bytes: &mut [u8], at: usize, rng: &mut Rng) {
    let value = INTEGERS[rng.usize(..INTEGERS.len())].wrapping_add(rng.u64(..3)).wrapping_sub(1);
    let size = (1 << rng.u32(0..4)).min(bytes.len() - at);
    let (little, big) = (value.to_le_bytes(), value.to_be_bytes());
    let source = if rng.bool() { &little[..size] } else { &big[8 - size..] };
    bytes[at..at + size].copy_from_slice(source);
}

/// Replaces the number in a text at or after a position.
fn number(bytes: &mut Vec<u8>, at: usize, rng: &mut Rng) {
    let Some(start) = bytes[at..].iter().position(u8::is_ascii_digit).map(|offset| at + offset) else {
        return;
    };
    let is_part = |byte: &u8| byte.is_ascii_digit() || matches!(byte, b'.' | b'e' | b'-' | b'+');
    let end =
        bytes[start..].iter().position(|byte| !is_part(byte)).map_or(bytes.len(), |offset| start + offset);
    bytes.splice(start..end, WORDS[rng.usize(..WORDS.len())].bytes());
}
