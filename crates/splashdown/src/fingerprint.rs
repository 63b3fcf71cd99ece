//! Fingerprints of data, by which a checkpoint identifies its meshes.

/// The FNV-1a hash of these bytes.
pub(crate) fn hash(bytes: &[u8]) -> u64 {
    let mix = |hash: u64, &byte: &u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, mix)
}
