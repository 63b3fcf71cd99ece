//! Computes the constants of a simulation from its scene.

use super::{Scheme, mueller2003, wcsph};
use crate::boundary::solid_offset;
use crate::scene::{Derived, Method, NegativePressure, Scene, Solver, SurfaceTension};
use crate::state::Params;

/// The constants of a scene with this number of particles.
pub fn params(scene: &Scene, particles: u32) -> Params {
    let (solver, material) = (&scene.solver, &scene.fluid.material);
    let derived = Derived::without_particles(scene);
    let support_radius = derived.support_radius;
    let rest_density = material.rest_density;
    let (oscillation, oscillation_rate) =
        scene.domain.oscillation.map_or_else(Default::default, |oscillation| {
            let rate = std::f32::consts::TAU / oscillation.period;
            (oscillation.amplitude * rate * rate, rate)
        });
    let closed = scene.domain.closed.as_flattened();
    let scheme = Scheme::new(scene);
    let numerical_viscosity = match solver.method {
        Method::Wcsph => 0.0,
        Method::Mueller2003 => mueller2003::ADDED_VISCOSITY * derived.sound_speed * support_radius,
    };
    // The viscosity of alpha (Monaghan 2005). Where the density is integrated, alpha is usually zero, and the friction
    // uses at least the default of the other form.
    let boundary_alpha = if scheme.is_density_integrated {
        solver.artificial_viscosity.max(Solver::default().artificial_viscosity)
    } else {
        solver.artificial_viscosity
    };
    Params {
        gravity: scene.gravity,
        support_radius,
        domain_min: scene.domain.min,
        particle_spacing: scene.fluid.particle_spacing,
        domain_max: scene.domain.max,
        particle_mass: derived.particle_mass,
        oscillation,
        oscillation_rate,
        rest_density,
        sound_speed: derived.sound_speed,
        solid_offset: scene.fluid.particle_spacing * solid_offset(scheme.walls(), solver.support_ratio),
        exponent: solver.exponent,
        viscosity: material.viscosity + numerical_viscosity,
        artificial_viscosity: solver.artificial_viscosity,
        density_diffusion: solver.density_diffusion,
        surface_tension: match solver.surface_tension {
            SurfaceTension::None => 0.0,
            SurfaceTension::ColourField => material.surface_tension,
            SurfaceTension::Akinci2013 => {
                wcsph::AKINCI_PER_SIGMA * material.surface_tension / (rest_density * support_radius).powi(2)
            }
        },
        wall_friction: solver.wall_friction,
        cfl_factor: solver.cfl_factor,
        max_dt: solver.max_dt,
        min_dt: solver.min_dt,
        closed: closed.iter().enumerate().map(|(bit, &closed)| u32::from(closed) << bit).sum(),
        clamp_pressure: u32::from(solver.negative_pressure == NegativePressure::Clamp),
        particle_count: particles,
        approach_damping_factor: if scheme.is_density_integrated { 0.0 } else { 1.0 },
        summed_mass: if scheme.is_density_integrated {
            derived.particle_mass
        } else {
            (f64::from(derived.particle_mass) / derived.lattice_sum) as f32
        },
        inverse_kernel_at_spacing: 1.0 / scheme.walls().w(1.0 / solver.support_ratio),
        boundary_viscosity: boundary_alpha * derived.sound_speed * support_radius / 20.0,
        unused: 0.0,
    }
}
