//! SPH with implicit pressure: the density constraint of DFSPH (Bender & Koschier 2015, 2017), solved by nonsmooth
//! nonlinear conjugate gradients ([`passes::implicit`](crate::passes::implicit)).

use super::Step;
use crate::boundary::part::Part;
use crate::coupling::Stage;
use crate::kernel::WendlandBlend;
use crate::passes::implicit::residual::SMALLEST_SURFACE_GRADIENT;
use crate::scene::KernelKind;

/// One step: sort, lists of neighbours, the system, all other forces, viscosity, the pressure that keeps the density, integration.
pub(super) fn dfsph(step: &mut Step<'_>) {
    step.sort();
    step.list_neighbours();
    step.couple(Stage::BoundaryLookup);
    step.implicit_system();
    step.couple(Stage::BoundaryDensity);
    step.surface_tension();
    step.couple(Stage::BoundaryForces(Part::Other));
    step.couple(Stage::ExternalForces);
    step.implicit_viscosity();
    step.implicit_pressure();
    step.couple(Stage::BoundaryForces(Part::Pressure));
    step.couple(Stage::BodyMotion);
    step.integrate();
    step.couple(Stage::Measurement);
    step.couple(Stage::Emission);
    step.count_emitted();
}

/// The tolerance of the implicit viscosity for that of the pressure: the part of its reference at which its residual is
/// accepted, that of Weiler et al. (2018) by default.
pub(super) fn viscous_tolerance(tolerance: f32) -> f32 {
    10.0 * tolerance
}

/// The largest number of iterations of the implicit viscosity for that of the pressure: they are several times cheaper.
pub(super) fn most_viscous_iterations(max_iterations: u32) -> u32 {
    5 * max_iterations
}

/// The distance in spacings within which an emitter searches for particles (`flow/emit`).
const EMISSION_CLEARANCE: f32 = 0.7;

/// The largest distance that a particle may move in a step, in spacings, for a CFL factor and a support radius in spacings.
/// The time step follows from the speeds of the step before. Emitters search for particles in the cells, which are as wide as
/// the support, after they have moved.
pub(super) fn longest_motion(cfl_factor: f32, support_ratio: f32) -> f32 {
    (2.0 * cfl_factor).min(support_ratio - EMISSION_CLEARANCE).max(0.5)
}

/// Relaxation of the Jacobi map at the beginning of a step, for a support radius in spacings. With a support of two spacings
/// the largest eigenvalue of the system over its diagonal was at most 3.5 in a study, for which 0.57 is the limit of the map
/// alone; with conjugate directions 0.65 and 0.8 also converged, in a seventh fewer iterations than 0.5. The diagonal
/// decreases with the number of neighbours: with 0.6, a pool at rest did not converge at a support of 2.5 spacings, and
/// needed 16 instead of seven iterations at 3.
pub(super) fn relaxation(support_ratio: f32) -> f32 {
    let wider = support_ratio.max(2.0) / 2.0;
    0.6 / (wider * wider)
}

/// Square of the sound speed of the implicit pressure, over the acceleration by gravity and shaking times the diagonal of the
/// domain.
const STIFFNESS: f32 = 2e4;
/// The same where fluid fills a closed domain. Without a free surface a small excess of density raises the pressure
/// everywhere, in proportion to this number. The weight of the fluid compresses it by less than 0.1 %.
const FULL_STIFFNESS: f32 = 1e3;
/// Square of the sound speed in such a domain over the square of the largest speed, in addition. The dynamic pressure compresses
/// by 0.1 %.
pub(super) const MOTION_STIFFNESS: f32 = 400.0;
/// The largest mean excess of density that is accepted in such a domain. Particles that are not on a lattice have a larger sum
/// of the kernel in the same space. What is above it raises the pressure, which keeps them apart.
pub(super) const ACCEPTED_EXCESS: f32 = 0.002;
/// Below this acceleration in m/s^2 the fluid has no compressibility: the weight is no measure of the pressure then.
const WEAKEST_GRAVITY: f32 = 0.1;

/// The relative excess of density that remains per unit of k = p rho0 / rho^2, in s^2/m^2. Water at rest that fills the domain
/// is compressed by less than 0.005 % at its floor. No pressure gives the rest density to a sealed space that is overfull:
/// without a compressibility the pressure grows with every iteration, which shortens the step, and a shorter step needs a
/// larger pressure.
pub(super) fn compressibility(acceleration: f32, diagonal: f32, is_full: bool) -> f32 {
    let stiffness = if is_full { FULL_STIFFNESS } else { STIFFNESS };
    if acceleration < WEAKEST_GRAVITY { 0.0 } else { 1.0 / (stiffness * acceleration * diagonal) }
}

/// The mechanical pressure of a lattice over that in the forces: the sum of -V r dW/dr / 3 over the lattice, where V is
/// the volume for which it has the rest density. With a support of two spacings it is 0.98 for the blend of Wendland's
/// functions and 0.95 for Wendland C2: the sum underestimates the gradient of a linear pressure by this factor, so the
/// solution is larger.
pub(super) fn pressure_factor(kernel: KernelKind, ratio: f64) -> f32 {
    let (mut density, mut virial) = (0.0, 0.0);
    visit_lattice(kernel, ratio, |_, w, slope| {
        density += w;
        virial += slope;
    });
    (virial / density / 3.0) as f32
}

/// The factor c for which the uppermost layer of a lattice has the rest density if c (H |g| - 0.3)^1.5 is added, where g is
/// the gradient of the sum of V W: 0.23 to 0.36. Zero where H |g| of that layer is below 0.6, with supports of less than 1.65
/// spacings: the layer lacks at most 7 % there, and disorder has gradients as large.
pub(super) fn surface_completion(kernel: KernelKind, ratio: f64) -> f32 {
    let (mut density, mut missing, mut gradient) = (0.0, 0.0, 0.0);
    visit_lattice(kernel, ratio, |[i, j, k], w, slope| {
        density += w;
        if k > 0 {
            missing += w;
            gradient += ratio * f64::from(k) * slope / f64::from(i * i + j * j + k * k);
        }
    });
    let (missing, gradient) = (missing / density, gradient / density);
    let smallest = f64::from(SMALLEST_SURFACE_GRADIENT);
    if gradient < 2.0 * smallest { 0.0 } else { (missing / (gradient - smallest).powf(1.5)) as f32 }
}

/// The strength of the continuum surface force over that of the tension. The force fades out where the normals become
/// short, which takes 14 % of the gradient of a lattice's surface, and is weaker between close particles. Both the pressure and the
/// period of drops with radii of 5 and 10 spacings correspond to 0.70 to 0.79 of the tension without this factor (physics case
/// `drop`).
pub(super) const CSF_PER_SIGMA: f32 = 1.35;

/// Calls `visit` with the indices of each point of a cubic lattice within the support around the origin, and W and -q dW/dq
/// there, times a common factor. The ratio is that of the support to the spacing.
fn visit_lattice(kernel: KernelKind, ratio: f64, mut visit: impl FnMut([i32; 3], f64, f64)) {
    let terms = |q: f64| match kernel {
        KernelKind::WendlandC2 => {
            (10.5 * (1.0 - q).powi(4) * (1.0 + 4.0 * q), 210.0 * q * q * (1.0 - q).powi(3))
        }
        KernelKind::WendlandBlend => WendlandBlend::exact(q).into(),
        KernelKind::CubicSpline if q <= 0.5 => {
            (8.0 * (6.0 * q * q * (q - 1.0) + 1.0), 48.0 * q * q * (2.0 - 3.0 * q))
        }
        KernelKind::CubicSpline => (16.0 * (1.0 - q).powi(3), 48.0 * q * (1.0 - q).powi(2)),
    };
    // The ratio of a checked scene is at most 4. The clamp bounds the loops for scenes built in code.
    let reach = (ratio.ceil() as i32).clamp(0, 32);
    for (i, j) in (-reach..=reach).flat_map(|i| (-reach..=reach).map(move |j| (i, j))) {
        for k in -reach..=reach {
            let q = f64::from(i * i + j * j + k * k).sqrt() / ratio;
            if q < 1.0 {
                let (w, slope) = terms(q);
                visit([i, j, k], w, slope);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// At the weight of a column as high as the domain, of 8 m in this case.
    #[test]
    fn the_compressibility_is_small_and_vanishes_without_gravity() {
        let compression = |is_full| compressibility(9.81, 8.0, is_full) * 9.81 * 8.0;
        assert!((compression(false) - 5e-5).abs() < 1e-9, "{}", compression(false));
        assert!((compression(true) - 1e-3).abs() < 1e-8, "{}", compression(true));
        assert_eq!(compressibility(0.0, 8.0, false), 0.0);
    }

    #[test]
    fn motions_leave_the_search_of_emitters_within_neighbouring_cells() {
        for (cfl_factor, support_ratio, expected) in
            [(0.1, 2.0, 0.5), (0.5, 2.0, 1.0), (0.7, 2.0, 1.3), (1.0, 3.0, 2.0)]
        {
            let motion = longest_motion(cfl_factor, support_ratio);
            assert!((motion - expected).abs() < 1e-6, "{motion}");
            assert!(motion + EMISSION_CLEARANCE <= support_ratio + 1e-6);
        }
    }

    #[test]
    fn the_relaxation_decreases_with_the_support() {
        assert_eq!([1.5, 2.0, 4.0].map(relaxation), [0.6, 0.6, 0.15]);
    }

    /// Values computed independently.
    #[test]
    fn the_pressure_factor_matches_independent_values() {
        for (kernel, ratio, expected) in [
            (KernelKind::WendlandC2, 2.0, 0.950_149),
            (KernelKind::WendlandC2, 3.0, 0.997_486),
            (KernelKind::WendlandBlend, 2.0, 0.976_665),
            (KernelKind::CubicSpline, 2.0, 1.020_07),
        ] {
            let factor = pressure_factor(kernel, ratio);
            assert!((factor - expected).abs() < 1e-5, "{kernel} {ratio}: {factor}");
        }
    }

    /// The sums over a half space were computed independently.
    #[test]
    fn the_completion_gives_the_uppermost_layer_the_rest_density() {
        for (kernel, ratio, missing, gradient) in [
            (KernelKind::WendlandC2, 2.0, 0.1236, 0.9501),
            (KernelKind::WendlandC2, 3.0, 0.2495, 1.2847),
            (KernelKind::WendlandC2, 1.7, 0.0680, 0.6451),
            (KernelKind::WendlandBlend, 2.0, 0.1397, 0.9767),
            (KernelKind::CubicSpline, 2.0, 0.1497, 1.0201),
            (KernelKind::CubicSpline, 4.0, 0.3250, 1.3121),
        ] {
            let added =
                |gradient: f64| f64::from(surface_completion(kernel, ratio)) * (gradient - 0.3).powf(1.5);
            assert!((added(gradient) - missing).abs() < 1e-4, "{kernel} {ratio}: {}", added(gradient));
            assert!((added(1.1 * gradient) - missing).abs() > 1e-2, "negative control: a steeper gradient");
        }
        assert_eq!(surface_completion(KernelKind::WendlandC2, 1.5), 0.0);
        assert_eq!(surface_completion(KernelKind::CubicSpline, 1.5), 0.0);
    }
}
