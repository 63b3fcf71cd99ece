//! The contacts that support dynamic bodies, in the response to the implicit pressure.
//!
//! The pressure of fluid on a body that rests on a floor cannot move it. The solver must know: for the pressure that makes
//! a free body yield, the density would rise in every step, because the collisions then move the body back into the fluid.
//! Water that was at rest over a light body burst.
//!
//! *How it works.* After a batch of steps the host gives the contacts of each body that carried a load. The response of a
//! body is then the one nearest to that of the free body, measured by kinetic energy, with which none of these points
//! approaches its solid: unilateral constraints, solved by projected Gauss-Seidel sweeps (Moreau & Jean 1996). A body that
//! the fluid lifts is free at once. Friction is left to the collisions, which resolve the motion itself.

use glam::Vec3;
use splashdown_gpu::WgslModule;

#[cfg(feature = "rigid")]
use super::types::SUPPORTS;
use super::types::{Body, Support};

/// The WGSL side.
pub(super) const WGSL: WgslModule = WgslModule { name: "sph/support", source: include_str!("support.wgsl") };

/// Maximum number of sweeps over the contacts. For a plate on its corners the error falls to two fifths in each.
const SWEEPS: usize = 16;

/// The velocities that the supports allow, for those that a body would have without them.
pub(super) fn supported(body: &Body, supports: &mut [Support], free: [Vec3; 2]) -> [Vec3; 2] {
    let [mut velocity, mut angular_velocity] = free;
    let count = supports.iter().take_while(|support| support.normal != Vec3::ZERO).count();
    let supports = &mut supports[..count];
    supports.iter_mut().for_each(|support| support.impulse = 0.0);
    let q = body.rotation();
    for _ in 0..SWEEPS {
        let mut has_changed = false;
        for support in &mut *supports {
            let normal = support.normal;
            let lever = support.arm.cross(normal);
            let spin = q * (body.inverse_inertia_matrix() * (q.conjugate() * lever));
            let response = body.inverse_mass + lever.dot(spin);
            if response > 0.0 {
                let approach = support.min_speed - normal.dot(velocity) - lever.dot(angular_velocity);
                let before = support.impulse;
                support.impulse = (before + approach / response).max(0.0);
                has_changed |= support.impulse != before;
                velocity += (support.impulse - before) * body.inverse_mass * normal;
                angular_velocity += (support.impulse - before) * spin;
            }
        }
        if !has_changed {
            break;
        }
    }
    [velocity, angular_velocity]
}

/// The contacts of a body that are farthest from one another, at most [`SUPPORTS`], with zeros behind them. `reach` is that of
/// the body in m.
#[cfg(feature = "rigid")]
pub(super) fn spread(mut all: Vec<Support>, reach: f32) -> [Support; SUPPORTS] {
    let mut chosen = [bytemuck::Zeroable::zeroed(); SUPPORTS];
    // The order of the contacts is not part of a checkpoint.
    let key = |s: &Support| s.arm.to_array().map(|c| (c + 0.0).to_bits());
    all.sort_unstable_by_key(|support| (key(support), support.normal.to_array().map(f32::to_bits)));
    let far = |a: &Support, b: &Support| {
        (a.arm - b.arm).length_squared() + reach * reach * (a.normal - b.normal).length_squared()
    };
    for index in 0..SUPPORTS.min(all.len()) {
        let apart = |s: &Support| chosen[..index].iter().map(|c| far(s, c)).fold(f32::INFINITY, f32::min);
        let next = (0..all.len()).max_by(|&a, &b| apart(&all[a]).total_cmp(&apart(&all[b])).then(b.cmp(&a)));
        if let Some(next) = next {
            chosen[index] = all.swap_remove(next);
        }
    }
    chosen
}

#[cfg(all(test, feature = "rigid"))]
mod tests {
    use super::*;

    /// A plate of 0.4 x 0.04 x 0.4 m and 1 kg.
    fn plate() -> Body {
        let moments = Vec3::new(0.16 + 0.0016, 0.32, 0.16 + 0.0016) / 12.0;
        Body {
            kind: Body::DYNAMIC,
            orientation: glam::Vec4::W,
            inverse_mass: 1.0,
            inertia: moments,
            inverse_inertia: moments.recip(),
            ..bytemuck::Zeroable::zeroed()
        }
    }

    fn corner(x: f32, z: f32) -> Support {
        Support { normal: Vec3::Y, arm: Vec3::new(x, -0.02, z), ..bytemuck::Zeroable::zeroed() }
    }

    fn corners() -> [Support; SUPPORTS] {
        let all = [[-0.2, -0.2], [-0.2, 0.2], [0.2, -0.2], [0.2, 0.2]].map(|[x, z]| corner(x, z));
        spread(all.to_vec(), 0.3)
    }

    #[test]
    fn a_plate_on_its_corners_neither_sinks_nor_tilts() {
        for free in [[Vec3::NEG_Y, Vec3::ZERO], [Vec3::NEG_Y, Vec3::new(1.0, 0.0, -2.0)]] {
            let [velocity, spin] = supported(&plate(), &mut corners(), free);
            assert!(velocity.y > -1e-4 && velocity.y < 0.2, "{velocity}");
            for support in &corners()[..4] {
                let speed = (velocity + spin.cross(support.arm)).y;
                assert!(speed > -1e-3, "{speed}");
            }
        }
        // Control: without its corners it does.
        let free = [Vec3::NEG_Y, Vec3::X];
        assert_eq!(supported(&plate(), &mut spread(Vec::new(), 0.3), free), free);
    }

    #[test]
    fn supports_push_and_do_not_pull() {
        let free = [Vec3::new(0.5, 1.0, 0.0), Vec3::new(0.0, 3.0, 0.0)];
        assert_eq!(supported(&plate(), &mut corners(), free), free);
        // Along the floor nothing is held.
        let [velocity, spin] = supported(&plate(), &mut corners(), [Vec3::new(1.0, -1.0, 0.0), Vec3::Y]);
        assert!(
            (velocity - Vec3::X).length() < 1e-3 && (spin - Vec3::Y).length() < 1e-3,
            "{velocity} {spin}"
        );
    }

    #[test]
    fn a_rising_support_lifts() {
        let mut rising = corners();
        rising[..4].iter_mut().for_each(|support| support.min_speed = 0.3);
        let [velocity, spin] = supported(&plate(), &mut rising, [Vec3::NEG_Y, Vec3::ZERO]);
        assert!((velocity.y - 0.3).abs() < 1e-3 && spin.length() < 1e-2, "{velocity} {spin}");
    }

    #[test]
    fn the_farthest_contacts_are_kept() {
        let row = (0..100).map(|k| corner(0.002 * k as f32, 0.0)).collect();
        let arms = spread(row, 0.3).map(|support| support.arm.x);
        assert!(arms.contains(&0.0) && arms.iter().any(|x| (x - 0.198).abs() < 1e-6), "{arms:?}");
    }
}
