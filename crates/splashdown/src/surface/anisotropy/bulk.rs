//! Constants of the kernels that follow from the parameters: the neighbours in the bulk, and the kernel of a lone particle.

use glam::DVec3;

use super::MAX_SIZE;
use crate::surface::SurfaceParams;

/// The number of neighbours in the bulk: the sum of 1 - (r / support)^3 over a cubic lattice of particles.
pub(crate) fn bulk_number(params: &SurfaceParams) -> f32 {
    let ratio = f64::from(params.support_radius) / f64::from(params.particle_spacing);
    // Beyond four spacings the sum is close to the integral.
    if !(1.0..4.0).contains(&ratio) {
        return (2.0 / 3.0 * std::f64::consts::PI * ratio.powi(3)).max(1.0) as f32;
    }
    let places = (-4..=4).flat_map(|z| (-4..=4).flat_map(move |y| (-4..=4).map(move |x| [x, y, z])));
    let weight = |place: [i32; 3]| 1.0 - (DVec3::from(place.map(f64::from)).length() / ratio).powi(3);
    places.map(|place| weight(place).max(0.0)).sum::<f64>() as f32
}

/// The size of the kernel of a lone particle, in support radii, for a mesh of the particle's own volume.
///
/// At an iso level of 0.6 the field of a kernel of size one is a ball with a radius of [`LEVEL_RADIUS`]. The mesh of a ball of
/// radius r has less volume, by the part [`LOSS`] (cell / r)^2, because marching cubes places vertices by linear interpolation.
/// Cells are at most 0.8 spacings here; in coarser ones the mesh of a lone particle depends on its place.
pub(crate) fn lone_size(params: &SurfaceParams) -> f32 {
    let spacing = f64::from(params.particle_spacing);
    let cell = (f64::from(params.cell_size) / spacing).min(0.8);
    let ball = (0.75 / std::f64::consts::PI).cbrt();
    // The radius r in spacings with r^3 - LOSS cell^2 r = ball^3, by Newton's method from above.
    let loss = LOSS * cell * cell;
    let mut r = ball + loss;
    for _ in 0..20 {
        r -= (r * (r * r - loss) - ball.powi(3)) / (3.0 * r * r - loss);
    }
    let size = r * spacing / (LEVEL_RADIUS * f64::from(params.support_radius));
    size.clamp(0.1, f64::from(MAX_SIZE)) as f32
}

/// The radius in support radii at which the cubic spline has fallen to 0.6 of its value at the centre.
const LEVEL_RADIUS: f64 = 0.3113;
/// Measured over 216 places and cells of 0.25 and 0.5 spacings.
const LOSS: f64 = 0.59;
