//! An estimate of the energy of the surface of the fluid.

use std::collections::HashSet;

use crate::state::Params;

/// The edge of the cubes in which particles are looked for, in spacings.
const EDGE: f32 = 2.0;

/// The energy of the surface in J for a tension in N/m and the cosine of the contact angle at closed sides: that of the faces
/// between cubes that contain particles and cubes that do not. Faces on closed sides count as far as they repel the fluid.
pub(super) fn surface_energy(params: &Params, positions: &[[f32; 3]], tension: f64, cosine: f64) -> f64 {
    let edge = EDGE * params.particle_spacing;
    let low = params.domain_min.to_array();
    let size = (params.domain_max - params.domain_min).to_array();
    // A little less, so that a domain of whole cubes has no further one.
    let cubes = size.map(|size| (size / edge - 1e-3).ceil().max(1.0) as i32);
    let cube = |x: &[f32; 3]| -> [i32; 3] {
        std::array::from_fn(|axis| {
            let place = ((x[axis] - low[axis]) / edge).floor() as i32;
            // A particle on a closed side belongs to the cube in front of it.
            place.clamp(0, cubes[axis] - 1)
        })
    };
    let filled: HashSet<[i32; 3]> = positions.iter().map(cube).collect();
    let mut faces = 0.0;
    for (cube, axis, side) in
        filled.iter().flat_map(|cube| (0..3).flat_map(move |axis| [-1, 1].map(|side| (cube, axis, side))))
    {
        let mut beside = *cube;
        beside[axis] += side;
        let is_outside = !(0..cubes[axis]).contains(&beside[axis]);
        let is_closed = params.closed >> (2 * axis + usize::from(side > 0)) & 1 == 1;
        faces += match (is_outside, is_closed) {
            (true, true) => (-cosine).max(0.0),
            (false, _) if filled.contains(&beside) => 0.0,
            _ => 1.0,
        };
    }
    tension * faces * f64::from(edge).powi(2)
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    /// A block of 4 x 6 x 10 spacings in the corner of a domain that is open above.
    #[test]
    fn the_energy_of_a_block_is_that_of_its_free_faces() {
        let params = Params {
            domain_max: Vec3::new(0.5, 1.0, 1.0),
            particle_spacing: 0.1,
            closed: 0b110111,
            ..bytemuck::Zeroable::zeroed()
        };
        let at = |k: i32| 0.05 + 0.1 * k as f32;
        let positions: Vec<[f32; 3]> = (0..4)
            .flat_map(|i| (0..6).flat_map(move |j| (0..10).map(move |k| [at(i), at(j), at(k)])))
            .collect();
        let free = 0.6 * 1.0 + 0.4 * 1.0;
        let walls = 0.6 * 1.0 + 0.4 * 1.0 + 2.0 * 0.4 * 0.6;
        for (cosine, expected) in [(0.0, free), (-0.5, free + 0.5 * walls), (0.5, free)] {
            let energy = surface_energy(&params, &positions, 0.07, cosine);
            assert!((energy - 0.07 * expected).abs() < 1e-6, "{energy}, {}", 0.07 * expected);
        }
        let open = Params { closed: 0b111011, domain_max: Vec3::new(0.5, 1.0, 1.0), ..params };
        let energy = surface_energy(&open, &positions, 0.07, -1.0);
        let all = 2.0 * (0.4 * 0.6 + 0.6 + 0.4);
        assert!((energy - 0.07 * all).abs() < 1e-6, "{energy}: sides that repel are as good as open ones");
        let half: Vec<_> = positions.iter().copied().filter(|x| x[1] < 0.35).collect();
        assert!(surface_energy(&params, &half, 0.07, 0.0) < 0.07 * 0.95 * free, "control: a lower block");
        assert_eq!(surface_energy(&params, &[], 0.07, 0.0), 0.0);
    }
}
