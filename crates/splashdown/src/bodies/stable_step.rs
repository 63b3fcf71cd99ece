//! The longest explicit time step beside a body that fluid moves easily.
//!
//! *How it works.* The fluid resists compression at a body as at a fixed wall, with a frequency w of sound. All particles
//! of the layer at the body push it at once, so that both together move at w sqrt(1 + r) with r = m / M: M is the mass of
//! the body and m that of a layer as thick as a spacing on all faces that the motion presses into the fluid. Symplectic
//! Euler is unstable beyond 2 / frequency. Where the approach to bodies is damped, each particle is damped implicitly as if
//! the body were fixed, and the body receives the sum of all reactions: a step is stable only if it is short for r times the
//! rate. For a cube r is twice the ratio of the densities over the number of spacings along an edge.
//!
//! *The constants.* Tilted cubes of 2.4 to 4 spacings and plates 6 spacings wide and 0.8 to 2 thick, of 50 to 200 kg/m^3 in
//! water, with a support of two spacings. With summed densities, which are damped, the longest step in half support radii
//! over the speed of sound that did not burst was 0.14 (0.17 did) with r = 33, 0.20 (0.24) with 24, 0.29 (0.5) with 17, and
//! at least 0.7 with 11. The limit here is 0.12, 0.16, 0.23 and 0.36. With integrated densities 0.2 did not burst with 33.
//!
//! *Why not* the coupling of the implicit pressure ([`Body::coupling`]): it is a bound for all directions and
//! underestimates plates, which press with both large faces.

use glam::{Mat3, Vec3};
use splashdown_io::Mesh;

use super::types::Body;
use crate::state::Params;

/// The longest step beside a body of great mass, in half support radii over the speed of sound. It is less than the
/// longest stable one (1.72), because an impact compresses the fluid, and because contacts are not a lattice.
const LONGEST: f32 = 1.2;

/// The same where the approach to bodies is damped, times the ratio of the masses.
const LONGEST_DAMPED: f32 = 4.0;

/// Steps of the power iteration. The largest of three eigenvalues is accurate to a few per cent after these.
const ROUNDS: usize = 32;

/// What pressure on the surface moves, in m^2/kg: the largest eigenvalue of the sum of n n^T dA over the mass, or of the
/// same with the moments of the normals n over the inertia. Zero if forces do not move the body.
pub(super) fn mobility(mesh: &Mesh, state: &Body) -> f32 {
    if state.kind != Body::DYNAMIC {
        return 0.0;
    }
    let (mut forces, mut moments) = (Mat3::ZERO, Mat3::ZERO);
    for corners in &mesh.triangles {
        let [a, b, c] = corners.map(|k| Vec3::from(mesh.vertices[k as usize]) - state.center);
        let double = (b - a).cross(c - a);
        let (area, normal) = (0.5 * double.length(), double.normalize_or_zero());
        forces += area * outer(normal);
        // The middles of the edges integrate a square exactly.
        for middle in [0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)] {
            moments += area / 3.0 * outer(middle.cross(normal));
        }
    }
    let by_force = state.inverse_mass * largest_eigenvalue(forces);
    by_force.max(largest_eigenvalue(state.inverse_inertia_matrix() * moments))
}

/// The constants with the limit by bodies of this largest [`mobility`].
pub(super) fn limited(params: Params, mobility: f32) -> Params {
    if params.is_implicit == 1 || mobility <= 0.0 {
        return params;
    }
    let ratio = params.rest_density * params.particle_spacing * mobility;
    let by_sound = LONGEST / (1.0 + ratio).sqrt();
    let by_damping =
        if params.approach_damping_factor > 0.0 { LONGEST_DAMPED / ratio } else { f32::INFINITY };
    let longest = by_sound.min(by_damping) * 0.5 * params.support_radius / params.sound_speed;
    Params { max_dt: params.max_dt.min(longest.max(params.min_dt)), ..params }
}

fn outer(v: Vec3) -> Mat3 {
    Mat3::from_cols(v * v.x, v * v.y, v * v.z)
}

/// The largest eigenvalue of a product of two positive semi-definite matrices, whose eigenvalues are not negative.
fn largest_eigenvalue(matrix: Mat3) -> f32 {
    // Has a part along every axis of symmetry of a common shape.
    let mut vector = Vec3::new(1.0, 0.77, 0.59);
    let mut value = 0.0;
    for _ in 0..ROUNDS {
        let next = matrix * vector;
        value = next.length();
        if !value.is_normal() {
            return 0.0;
        }
        vector = next / value;
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A box with these edges in m about the origin, of a density in kg/m^3.
    fn cuboid(edges: Vec3, density: f32) -> (Mesh, Body) {
        let corner = |k: u32| {
            let side = |bit: u32| if k >> bit & 1 == 1 { 0.5 } else { -0.5 };
            (edges * Vec3::new(side(0), side(1), side(2))).to_array()
        };
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        let mesh = Mesh::new((0..8).map(corner).collect(), triangles);
        let mass = density * edges.element_product();
        let squares = edges * edges;
        let inertia = mass / 12.0 * (Vec3::splat(squares.element_sum()) - squares);
        let state = Body {
            kind: Body::DYNAMIC,
            inverse_mass: 1.0 / mass,
            inertia,
            inverse_inertia: inertia.recip(),
            ..bytemuck::Zeroable::zeroed()
        };
        (mesh, state)
    }

    #[test]
    fn the_mobility_of_boxes_is_that_of_their_faces() {
        // Two faces of a cube: 2 a^2 / (rho a^3). No rotation presses more.
        let (mesh, state) = cuboid(Vec3::splat(0.1), 500.0);
        assert!((mobility(&mesh, &state) * 500.0 * 0.1 / 2.0 - 1.0).abs() < 0.01);
        // A plate: 2 / (rho t).
        let (mesh, state) = cuboid(Vec3::new(0.3, 0.05, 0.3), 200.0);
        assert!((mobility(&mesh, &state) * 200.0 * 0.05 / 2.0 - 1.0).abs() < 0.01);
        let fixed = Body { kind: Body::STATIC, ..state };
        assert_eq!(mobility(&mesh, &fixed), 0.0);
    }

    #[test]
    fn a_hinged_plate_presses_by_its_rotation_only() {
        let (mesh, mut state) = cuboid(Vec3::new(0.3, 0.05, 0.3), 200.0);
        state.inverse_mass = 0.0;
        state.inverse_inertia = Vec3::new(state.inverse_inertia.x, 0.0, 0.0);
        // 2 (l^4 / 12 + l t^3 / 12) / (rho l^2 t (l^2 + t^2) / 12)
        let (l, t) = (0.3_f32, 0.05_f32);
        let expected = 2.0 * (l.powi(4) + l * t.powi(3)) / (200.0 * l * l * t * (l * l + t * t));
        assert!((mobility(&mesh, &state) / expected - 1.0).abs() < 0.01, "{}", mobility(&mesh, &state));
    }
}
