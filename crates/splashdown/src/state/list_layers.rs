//! The size of the lists of neighbours on a GPU, which [`passes::neighbours`](crate::passes::neighbours) makes.

use glam::UVec4;

/// The words of a list over the particles at the rest density in the support. Compressed fluid has more neighbours.
const MARGIN: f32 = 1.3;

/// The layers of the lists of a number of particles, for a support radius of this many spacings: as many as a buffer of
/// this many bytes holds, and no more than neighbours need.
pub(crate) fn list_layers(support_ratio: f32, particles: u64, largest_buffer: u64) -> u64 {
    let neighbours = 4.0 / 3.0 * std::f32::consts::PI * support_ratio.powi(3);
    let wanted = ((1.0 + MARGIN * neighbours) / 4.0).ceil() as u64;
    wanted.min(largest_buffer / (size_of::<UVec4>() as u64 * particles.max(1)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_have_room_for_compressed_fluid_and_fit_a_buffer() {
        // A sphere of two spacings contains 33 particles; with the header 12 layers hold 47.
        assert_eq!(list_layers(2.0, 1000, 1 << 30), 12);
        assert_eq!(list_layers(3.0, 1000, 1 << 30), 38);
        assert_eq!(list_layers(2.0, 1 << 20, 128 << 20), 8);
        assert_eq!(list_layers(2.0, 10 << 20, 128 << 20), 0);
        assert_eq!(list_layers(2.0, 0, 128 << 20), 12);
    }
}
