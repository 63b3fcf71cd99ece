//! The compression of the tables: differences of integers in as few bytes as possible, and LZ4.

use std::collections::HashMap;

/// Arrays of fewer integers are stored as they are.
pub(super) const SHORTEST: usize = 16;

/// Encodes integers: the commonest difference, two bits per integer for the size of its difference, and the differences that
/// are not the commonest.
pub(super) fn integers(values: &[i32]) -> Vec<u8> {
    if values.is_empty() {
        return Vec::new();
    }
    let previous = std::iter::once(0).chain(values.iter().copied());
    let differences: Vec<i32> =
        values.iter().zip(previous).map(|(value, previous)| value.wrapping_sub(previous)).collect();
    let mut counts: HashMap<i32, usize> = HashMap::new();
    for &difference in &differences {
        *counts.entry(difference).or_default() += 1;
    }
    // Of two that are as common the larger one, so that the same data gives the same file.
    let commonest =
        counts.into_iter().map(|(value, count)| (count, value)).max().map_or(0, |(_, value)| value);
    let mut sizes = vec![0_u8; differences.len().div_ceil(4)];
    let mut rest = Vec::new();
    for (n, &difference) in differences.iter().enumerate() {
        let size = if difference == commonest {
            0
        } else if let Ok(byte) = i8::try_from(difference) {
            rest.extend(byte.to_le_bytes());
            1
        } else if let Ok(short) = i16::try_from(difference) {
            rest.extend(short.to_le_bytes());
            2
        } else {
            rest.extend(difference.to_le_bytes());
            3
        };
        sizes[n / 4] |= size << (2 * (n % 4));
    }
    [commonest.to_le_bytes().to_vec(), sizes, rest].concat()
}

/// [`integers`] of a value from 1 to 127 that is repeated: one difference of a byte, followed by differences of zero.
pub(super) fn repeated(value: i8, count: usize) -> Vec<u8> {
    let mut bytes = vec![0; 4 + count.div_ceil(4) + 1];
    bytes[4] = 1;
    bytes[4 + count.div_ceil(4)] = value.cast_unsigned();
    bytes
}

/// Compresses bytes as one LZ4 block, preceded by its size and by the number of further blocks, which is zero.
pub(super) fn compressed(bytes: &[u8]) -> Vec<u8> {
    let block = lz4_flex::block::compress(bytes);
    let size = block.len() as u64 + 1;
    [&size.to_le_bytes()[..], &[0], &block].concat()
}

#[cfg(test)]
mod tests {
    use super::{integers, repeated};

    /// The example in Pixar's `integerCoding.cpp`.
    #[test]
    fn integers_are_encoded_as_documented() {
        let encoded = integers(&[123, 124, 125, 100_125, 100_125, 100_126, 100_126]);
        let expected: &[u8] = &[1, 0, 0, 0, 0b1100_0001, 0b01_00_01, 123, 0xa0, 0x86, 1, 0, 0, 0];
        assert_eq!(encoded, expected);
    }

    #[test]
    fn repeated_integers_are_encoded_alike() {
        for count in [3, 16, 17, 100] {
            assert_eq!(repeated(3, count), integers(&vec![3; count]), "{count}");
        }
    }
}
