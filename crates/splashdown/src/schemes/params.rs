//! Computes the constants of a simulation from its scene.

use glam::Vec2;

use super::{Scheme, dfsph, mueller2003, wcsph};
use crate::boundary::SolidDistance;
use crate::passes::viscous;
use crate::scene::{Derived, Method, NegativePressure, Scene, Solver, SurfaceTension};
use crate::state::Params;

/// Lower limit of the viscosity in the friction at bodies where the density is integrated, as an alpha.
const SMALLEST_BOUNDARY_ALPHA: f32 = 0.05;

/// Mean depth in spacings of the particles on which the continuum surface force acts: mostly the first layer, half a
/// spacing below the surface.
const INTERFACE_DEPTH: f32 = 0.7;
/// The length of a normal is about 1.3 in the first layer, and 0.1 to 0.2 inside by the irregular order of the particles.
const WEAKEST_NORMAL: f32 = 0.2;

/// The cosine of the contact angle, and zero without one: that of a right angle is not zero in single precision.
fn wetting_cosine(solver: &Solver) -> f32 {
    let is_neutral = solver.contact_angle == Solver::NEUTRAL_ANGLE;
    if solver.surface_tension != SurfaceTension::Csf || is_neutral {
        return 0.0;
    }
    solver.contact_angle.to_radians().cos()
}

/// The longest time step of a scene in s, whatever the speeds: `max_dt` and the limits by body forces, viscosity and surface
/// tension.
pub fn longest_step(scene: &Scene) -> f32 {
    let longest = params(scene, 0).max_dt;
    if Scheme::new(scene).is_implicit() { longest } else { longest.min(Derived::viscous_dt(scene)) }
}

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
    let is_full = scheme.is_implicit() && scene.is_full();
    let numerical_viscosity = match solver.method {
        Method::Wcsph | Method::Dfsph => Derived::capillary_viscosity(scene),
        Method::Mueller2003 => mueller2003::ADDED_VISCOSITY * derived.sound_speed * support_radius,
    };
    // The artificial viscosity acts as the viscosity alpha c0 H / 20 (Monaghan 2005). Where the density is integrated, alpha
    // is usually zero, and water would slip along bodies without a lower limit. The limit applies to the sum with the
    // viscosity of the fluid: added to that, it would be too much beside a body that resolves its boundary layer.
    let per_alpha = derived.sound_speed * support_radius / 20.0;
    let artificial = solver.artificial_viscosity * per_alpha;
    let boundary_viscosity = if scheme.is_density_integrated {
        artificial.max(SMALLEST_BOUNDARY_ALPHA * per_alpha - material.viscosity - numerical_viscosity)
    } else {
        artificial
    };
    let is_viscous = scheme.has_implicit_viscosity();
    let implicit_viscosity = if is_viscous { material.viscosity } else { 0.0 };
    let volume = derived.particle_mass / rest_density;
    let max_dt = if scheme.is_implicit() {
        let half = 0.5 * support_radius;
        let explicit = numerical_viscosity + if is_viscous { 0.0 } else { material.viscosity };
        let by_viscosity = 0.125 * half * half / (explicit + artificial).max(1e-20);
        solver.max_dt.min(Derived::body_force_dt(scene)).min(Derived::capillary_dt(scene)).min(by_viscosity)
    } else {
        solver.max_dt
    };
    let pressure_factor = dfsph::pressure_factor(solver.kernel, f64::from(solver.support_ratio));
    let solid = if scheme.is_implicit() {
        SolidDistance::of_lattice(scheme.walls(), solver.support_ratio)
    } else if solver.method == Method::Wcsph {
        // An integrated density needs no normalised kernel.
        let whole = if scheme.is_density_integrated { derived.lattice_sum as f32 } else { 1.0 };
        SolidDistance::of_layers(scheme.walls(), solver.support_ratio, whole)
    } else {
        SolidDistance::of_density(scheme.walls(), solver.support_ratio)
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
        solid_offset: scene.fluid.particle_spacing * solid.offset,
        exponent: solver.exponent,
        viscosity: material.viscosity + numerical_viscosity - implicit_viscosity,
        artificial_viscosity: solver.artificial_viscosity,
        density_diffusion: solver.density_diffusion,
        surface_tension: match solver.surface_tension {
            SurfaceTension::None | SurfaceTension::Csf => 0.0,
            SurfaceTension::ColourField => material.surface_tension,
            SurfaceTension::Akinci2013 => {
                wcsph::AKINCI_PER_SIGMA * material.surface_tension / (rest_density * support_radius).powi(2)
            }
        },
        wall_friction: solver.wall_friction,
        cfl_factor: solver.cfl_factor,
        max_dt,
        min_dt: solver.min_dt,
        closed: closed.iter().enumerate().map(|(bit, &closed)| u32::from(closed) << bit).sum(),
        clamp_pressure: u32::from(if scheme.is_implicit() {
            is_viscous || is_full || solver.surface_tension != SurfaceTension::None
        } else {
            solver.negative_pressure == NegativePressure::Clamp
        }),
        particle_count: particles,
        approach_damping_factor: if scheme.is_density_integrated || scheme.is_implicit() { 0.0 } else { 1.0 },
        summed_mass: if scheme.is_density_integrated {
            derived.particle_mass
        } else {
            (f64::from(derived.particle_mass) / derived.lattice_sum) as f32
        },
        inverse_kernel_at_spacing: 1.0 / scheme.walls().w(1.0 / solver.support_ratio),
        boundary_viscosity,
        is_implicit: u32::from(scheme.is_implicit()),
        tolerance: solver.tolerance,
        max_iterations: Derived::max_iterations(scene),
        longest_motion: if scheme.is_implicit() {
            dfsph::longest_motion(solver.cfl_factor, solver.support_ratio)
        } else {
            0.5
        },
        pressure_factor,
        implicit_viscosity,
        viscous_factor: implicit_viscosity * volume * viscous::pair::factor(support_radius)
            / viscous::pair::lattice_factor(f64::from(solver.support_ratio)) as f32,
        viscous_tolerance: dfsph::viscous_tolerance(solver.tolerance),
        most_viscous_iterations: scheme.most_viscous_iterations,
        tension_factor: match solver.surface_tension {
            SurfaceTension::Csf => {
                let scale = 1.0 / support_radius;
                let strength = if scheme.is_implicit() { dfsph::CSF_PER_SIGMA } else { 1.0 };
                strength * material.surface_tension / rest_density
                    * volume
                    * (scale * scale)
                    * (scale * scale)
                    * scale
            }
            _ => 0.0,
        },
        largest_curvature: 2.0 / scene.fluid.particle_spacing,
        interface_depth: INTERFACE_DEPTH * scene.fluid.particle_spacing,
        weakest_normal: WEAKEST_NORMAL,
        wetting: 2.0 * wetting_cosine(solver) / support_radius,
        relaxation: dfsph::relaxation(solver.support_ratio),
        compressibility: dfsph::compressibility(
            scene.gravity.length() + oscillation.length(),
            (scene.domain.max - scene.domain.min).length(),
            is_full,
        ),
        // The cohesion of Akinci's model is fitted to a surface that is compressed.
        surface_completion: match solver.surface_tension {
            SurfaceTension::Akinci2013 => 0.0,
            _ => dfsph::surface_completion(solver.kernel, f64::from(solver.support_ratio)),
        },
        solid_stretch: solid.stretch,
        slope_offset: scene.fluid.particle_spacing * solid.slope_offset,
        background_pressure: 0.0,
        lattice_moment: pressure_factor * derived.lattice_sum as f32,
        accepted_excess: if is_full { dfsph::ACCEPTED_EXCESS } else { 0.0 },
        motion_stiffness: if is_full { dfsph::MOTION_STIFFNESS } else { 0.0 },
        unused: Vec2::ZERO,
    }
}
