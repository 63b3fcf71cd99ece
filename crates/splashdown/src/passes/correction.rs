//! The correction of kernel gradients (Bonet & Lok 1999).
//!
//! The sum M = -sum V_j (x_i - x_j) (x) grad W is the unit matrix where particles are ordered and the kernel is
//! complete. A sum with B grad W instead of grad W, B = M^-1, is exact for linear fields, for any order of the particles.
//! Near a free surface the neighbours do not determine all of M. For det M < 1 the inverse therefore fades to the unit
//! matrix: B = adj M + (1 - det M) I, which needs no division.
//!
//! det M also measures how complete a particle's neighbourhood is: about 0.95 to 1 inside the fluid, 0.3 at a flat
//! surface, 0 for a fragment of one or two particles.

use splashdown_gpu::WgslModule;

use crate::state::{Params, Symmetric};

/// The WGSL side, which imports [`SYMMETRIC`](crate::state::SYMMETRIC).
pub const WGSL: WgslModule = WgslModule { name: "sph/correction", source: include_str!("correction.wgsl") };

/// B and det M for M.
#[inline(always)]
pub(crate) fn correction(matrix: Symmetric) -> (Symmetric, f32) {
    let (Symmetric { diagonal, others }, determinant) = matrix.adjugate();
    let scale = 1.0 / determinant.max(1.0);
    let missing = 1.0 - determinant.clamp(0.0, 1.0);
    (Symmetric { diagonal: scale * diagonal + missing, others: scale * others }, determinant)
}

/// Coefficient of the particle shifting.
const SHIFTING: f32 = 4.0;

/// The coefficient in m^2/s of the shifting velocity -a sum V_j (1 + 0.2 (W / W(dx))^4) grad W, after Lind et al. (2012)
/// and Sun et al. (2017), who use the largest speed. This one is Galilean invariant and vanishes at second order:
/// a = 4 H^2 (|S| - S0) with the rate of strain S, and S0 = [`rest_strain`] in scenes with bodies, otherwise zero. It fades out
/// towards a free surface.
#[inline(always)]
pub(crate) fn shifting(params: &Params, strain: Symmetric, rest_strain: f32, determinant: f32) -> f32 {
    let complete = ((determinant - 0.45) / 0.45).clamp(0.0, 1.0);
    let deformation = (strain.contract(strain).sqrt() - rest_strain).max(0.0);
    complete * SHIFTING * params.support_radius * params.support_radius * deformation
}

/// The rate of strain in 1/s of fluid around bodies that is almost at rest: 0.1 sqrt(g / H) at a support of two spacings,
/// zero from three.
///
/// Still water around bodies moves a little, because the forces at bodies do not balance exactly. With few neighbours this
/// motion grew while it shifted particles: around a floating torus tenfold in three seconds.
pub(crate) fn rest_strain(params: &Params) -> f32 {
    let narrow = (3.0 - params.support_radius / params.particle_spacing).clamp(0.0, 1.0);
    narrow * 0.1 * (params.gravity.length() / params.support_radius).sqrt()
}

/// Coefficient of the [recovery of the volume](volume_recovery).
const RECOVERY: f32 = 4.0;

/// The rate in 1/s by which the density of a particle, over itself, follows the positions of its neighbours.
///
/// The continuity equation does not know the positions. Disorder of the particles compacts the fluid without a rise of the
/// density, and shifting dilates it (Jandaghian, Krimi & Shakibaeinia 2021). The trace of M over that of a lattice is the
/// density from the positions over the integrated one. The rate is its excess, times the rate of strain S: both errors grow
/// with S, and fluid at rest remains as it is. A deficit counts only inside the fluid: M lacks neighbours at a free
/// surface. It fades out as det M falls from 0.9 to 0.82, which is that of the second layer with a support of three spacings.
#[inline(always)]
pub(crate) fn volume_recovery(
    params: &Params,
    matrix: Symmetric,
    strain: Symmetric,
    determinant: f32,
) -> f32 {
    let excess = matrix.diagonal.element_sum() / (3.0 * params.lattice_moment) - 1.0;
    let complete = (12.5 * (determinant - 0.82)).clamp(0.0, 1.0);
    RECOVERY * strain.contract(strain).sqrt() * (excess.max(0.0) + complete * excess.min(0.0))
}

/// The density of a particle after its fragment has lost its tension. The continuity equation would let two particles
/// that separate pull one another together without bound. Below det M = 1/4 a deficit of density is reduced.
#[inline(always)]
pub(crate) fn without_tension(params: &Params, density: f32, determinant: f32) -> f32 {
    let deficit = (density - params.rest_density).min(0.0);
    density - (1.0 - (4.0 * determinant).clamp(0.0, 1.0)) * deficit
}

#[cfg(test)]
mod tests {
    use glam::{Mat3, Vec3};

    use super::*;
    use crate::kernel::{Kernel, WendlandC2};

    fn matrix(m: Symmetric) -> Mat3 {
        let ([xx, yy, zz], [xy, xz, yz]) = (m.diagonal.to_array(), m.others.to_array());
        Mat3::from_cols_array(&[xx, xy, xz, xy, yy, yz, xz, yz, zz])
    }

    #[test]
    fn the_correction_is_the_inverse_of_a_complete_matrix() {
        let m = Symmetric { diagonal: Vec3::new(1.2, 1.1, 1.3), others: Vec3::new(0.1, -0.2, 0.05) };
        let (b, determinant) = correction(m);
        assert!((determinant - matrix(m).determinant()).abs() < 1e-5);
        assert!(determinant > 1.0);
        assert!(matrix(b).abs_diff_eq(matrix(m).inverse(), 1e-5));
        // Control: another matrix.
        let other = Symmetric { diagonal: Vec3::new(1.2, 1.1, 1.31), ..m };
        assert!(!matrix(b).abs_diff_eq(matrix(other).inverse(), 1e-3));
    }

    #[test]
    fn the_correction_of_a_lone_particle_is_the_unit_matrix() {
        let (b, determinant) = correction(Symmetric::default());
        assert_eq!((matrix(b), determinant), (Mat3::IDENTITY, 0.0));
        // A layer has neighbours in its plane only.
        let layer = Symmetric { diagonal: Vec3::new(0.8, 0.0, 0.8), others: Vec3::ZERO };
        let (b, _) = correction(layer);
        assert!(matrix(b).abs_diff_eq(Mat3::from_diagonal(Vec3::new(1.0, 1.64, 1.0)), 1e-6), "{b:?}");
    }

    /// The sum M on a lattice whose spacing is that of `params` times `stretch`, and `layers` of it on one side.
    fn moment(params: &Params, stretch: f32, layers: i32) -> Symmetric {
        let mut sum = Symmetric::default();
        for (i, j, k) in (0..11_i32.pow(3)).map(|n| (n % 11 - 5, n / 11 % 11 - 5, n / 121 - 5)) {
            let d = stretch * params.particle_spacing * Vec3::new(i as f32, j as f32, k as f32);
            if k <= layers && d.length() < params.support_radius {
                let g = WendlandC2::g(d.length() / params.support_radius) / params.support_radius.powi(5);
                sum.diagonal -= params.particle_spacing.powi(3) * g * d * d;
            }
        }
        sum
    }

    #[test]
    fn the_density_follows_the_positions_inside_the_fluid() {
        for ratio in [2.0, 3.0] {
            let text = format!(
                "[scene]\nname = \"t\"\nduration = 1\n[domain]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n[solver]\n\
                 density = \"continuity\"\nsupport_ratio = {ratio:?}\n[fluid]\nparticle_spacing = 0.1\n\
                 [[fluid.block]]\nposition = [0, 0, 0]\nsize = [1, 1, 1]\n"
            );
            let params = crate::schemes::params(&crate::scene::Scene::parse(&text, "t").unwrap(), 0);
            let strain = Symmetric { diagonal: Vec3::new(1.0, -1.0, 0.0), others: Vec3::ZERO };
            let rate = |stretch: f32, layers: i32, strain: Symmetric| {
                let m = moment(&params, stretch, layers);
                volume_recovery(&params, m, strain, m.adjugate().1)
            };
            // 3 % too dense and too dilute: the density rises and falls by about 4 times this and the rate of strain.
            assert!(rate(1.0, 5, strain).abs() < 1e-4, "{}", rate(1.0, 5, strain));
            assert!((0.08..0.3).contains(&rate(0.99, 5, strain)), "{}", rate(0.99, 5, strain));
            assert!((-0.3..-0.08).contains(&rate(1.01, 5, strain)), "{}", rate(1.01, 5, strain));
            // The first layer at a free surface has half of its neighbours; fluid at rest does not change.
            assert_eq!(rate(1.01, 0, strain), 0.0);
            assert_eq!(rate(0.99, 5, Symmetric::default()), 0.0);
        }
    }

    #[test]
    fn fluid_at_rest_is_not_shifted() {
        let params = |gravity: f32, ratio: f32| Params {
            gravity: Vec3::new(0.0, -gravity, 0.0),
            support_radius: 0.04,
            particle_spacing: 0.04 / ratio,
            ..bytemuck::Zeroable::zeroed()
        };
        let shift = |gravity: f32, ratio: f32, rate: f32| {
            let strain = Symmetric { diagonal: Vec3::new(rate, 0.0, 0.0), others: Vec3::ZERO };
            let params = params(gravity, ratio);
            shifting(&params, strain, rest_strain(&params), 1.0)
        };
        let rest = 0.1 * (9.81f32 / 0.04).sqrt();
        assert_eq!(shift(9.81, 2.0, 0.99 * rest), 0.0);
        let expected = 4.0 * 0.04 * 0.04 * rest;
        assert!((shift(9.81, 2.0, 2.0 * rest) - expected).abs() < 1e-4 * expected);
        // Without gravity, and with many neighbours, every deformation shifts.
        for (gravity, ratio) in [(0.0, 2.0), (9.81, 3.0)] {
            assert!((shift(gravity, ratio, rest) - expected).abs() < 1e-4 * expected);
        }
    }

    #[test]
    fn fragments_lose_tension_but_no_pressure() {
        let params = Params { rest_density: 1000.0, ..bytemuck::Zeroable::zeroed() };
        assert_eq!(without_tension(&params, 900.0, 0.0), 1000.0);
        assert_eq!(without_tension(&params, 900.0, 0.125), 950.0);
        assert_eq!(without_tension(&params, 900.0, 0.3), 900.0);
        assert_eq!(without_tension(&params, 1100.0, 0.0), 1100.0);
    }
}
