//! The size of the lists of neighbours on a GPU, which [`passes::neighbours`](crate::passes::neighbours) makes.

use glam::UVec4;
use splashdown_gpu::Executor;

use super::Params;

/// The fewest layers of a list: the rows of candidates take 19 words.
pub(crate) const FEWEST_LAYERS: usize = 5;
/// The words of a list over the particles at the rest density in the support. Compressed fluid has more neighbours.
const MARGIN: f32 = 1.3;

/// The layers of the lists of a number of particles. None on the CPU; fewer than usual if a buffer of the device holds no
/// more.
pub(super) fn list_layers(executor: &Executor, params: &Params, particles: usize) -> usize {
    if executor.gpu().is_none() {
        return 0;
    }
    let fit = executor.largest_buffer() / (size_of::<UVec4>() * particles.max(1)) as u64;
    list_layers_on_gpu(params.support_radius / params.particle_spacing).min(fit as usize).max(FEWEST_LAYERS)
}

/// [`list_layers`] on a GPU without a limit to its buffers, for a support radius of this many spacings.
pub(crate) fn list_layers_on_gpu(support_ratio: f32) -> usize {
    let neighbours = 4.0 / 3.0 * std::f32::consts::PI * support_ratio.powi(3);
    (((1.0 + MARGIN * neighbours) / 4.0).ceil() as usize).max(FEWEST_LAYERS)
}

#[cfg(test)]
mod tests {
    use super::*;

    // The header, and begin and end of nine rows.
    const _: () = assert!(4 * FEWEST_LAYERS > 2 * 9);

    #[test]
    fn lists_have_room_for_compressed_fluid() {
        // A sphere of two spacings contains 33 particles; with the header 12 layers hold 47.
        assert_eq!(list_layers_on_gpu(2.0), 12);
        assert_eq!(list_layers_on_gpu(1.0), FEWEST_LAYERS);
    }
}
