//! Quantities derived from a scene. `splashdown check` prints them, and the solvers use them.

use glam::Vec3;
use serde::Serialize;

use super::solver::{KernelKind, Method, Solver, SurfaceTension};
use super::things::Motion;
use super::types::{Scene, Shape};
use crate::kernel::WendlandBlend;

/// Ratio of the speed of sound to the reference speed. With this value the density varies by at most one per
/// cent (Monaghan 1994).
const SOUND_RATIO: f32 = 10.0;
/// Lower bound of the reference speed in m/s, for scenes in which nothing drives the fluid.
pub(crate) const MIN_SPEED: f32 = 0.01;

/// Quantities derived from a scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Derived {
    /// Number of particles at the start. [`Derived::new`] includes those inside bodies,
    /// [`Derived::with_inventory`] does not.
    pub particles: u64,
    /// Number of particles that emitters create until the end.
    pub emitted: u64,
    /// Average number of particles over the scene's duration, if none are removed.
    pub mean_particles: f64,
    /// Mass of a particle in kg: `rest_density * particle_spacing^3`.
    pub particle_mass: f32,
    /// The sum of `W * particle_spacing^3` over the infinite lattice, with the kernel of the density.
    pub lattice_sum: f64,
    /// Volume of the fluid in m^3: `particles * particle_spacing^3`.
    pub volume: f32,
    /// Support radius in m.
    pub support_radius: f32,
    /// Height in m of the fluid's highest point above the domain's lowest, along gravity; 0 without gravity.
    pub head: f32,
    /// The largest expected speed in m/s: `sqrt(4 g head + v0^2)` plus the largest speed of the oscillating
    /// domain, where v0 is the largest initial speed of blocks, meshes, files, emitters and bodies. The term
    /// `2 sqrt(g head)` is the speed of the front of a dam break (Ritter 1892). It exceeds the speed `sqrt(2
    /// g head)` of a free fall. The capillary speed `sqrt(2 sigma / (rho spacing))` is a lower bound if
    /// surface tension is enabled.
    pub reference_speed: f32,
    /// Speed of sound in m/s: given, computed from the stiffness, or ten times the reference speed.
    pub sound_speed: f32,
    /// Stiffness of the equation of state: Tait's `c^2 rho0 / exponent` in Pa (`wcsph`), or `c^2` in m^2/s^2
    /// (`mueller2003`).
    pub stiffness: f32,
    /// Expected time step in s: the smallest of `cfl_factor * support_radius / 2 / sound_speed`,
    /// `0.125 (support_radius / 2)^2 / viscosity` (Morris et al. 1997), `0.17 support_radius / 2 / (density_diffusion *
    /// sound_speed)` with `density = "continuity"`, and `max_dt`. With `dfsph` the first is `cfl_factor *
    /// particle_spacing / reference_speed`, and `sqrt(0.02 particle_spacing / gravity)` is another limit.
    pub dt_estimate: f32,
    /// The limit that determines the time step: `sound`, `viscosity`, `diffusion` or `max_dt`; with `dfsph` also `speed`,
    /// `gravity`, `pressure` or `surface tension`.
    pub dt_limit: &'static str,
    /// Number of frames.
    pub frames: u32,
    /// Expected number of steps.
    pub steps_estimate: u64,
}

/// The extent and the speed of the fluid of a mesh or file.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reach {
    /// Lower corner in m.
    pub low: Vec3,
    /// Upper corner in m.
    pub high: Vec3,
    /// Largest speed in m/s.
    pub speed: f32,
}

impl Derived {
    /// Sets the number of particles at the start, the number that emitters create, and how many of these
    /// exist on average over the scene's duration.
    pub(crate) fn with_particles(
        self,
        scene: &Scene,
        particles: u64,
        (emitted, present): (u64, f64),
    ) -> Self {
        let volume = f64::from(scene.fluid.particle_spacing).powi(3);
        Self {
            particles,
            emitted,
            mean_particles: particles as f64 + present,
            volume: (particles as f64 * volume) as f32,
            ..self
        }
    }

    /// All quantities except the numbers of particles, which are zero. `reaches` are the extents of the
    /// fluid's meshes and files.
    pub(crate) fn of(scene: &Scene, reaches: &[Reach]) -> Self {
        let (fluid, solver) = (&scene.fluid, &scene.solver);
        let spacing = fluid.particle_spacing;
        let density = fluid.material.rest_density;
        let support_radius = solver.support_radius(spacing);
        let lattice_sum = lattice_sum(solver.method, solver.kernel, f64::from(solver.support_ratio));
        let head = head(scene, reaches);
        let reference_speed = reference_speed(scene, head, reaches);
        // Both equations of state have the slope c^2 = dp/drho at rest.
        let per_square = match solver.method {
            Method::Wcsph | Method::Dfsph => density / solver.exponent,
            Method::Mueller2003 => 1.0,
        };
        let from_stiffness = solver.stiffness.map(|stiffness| (stiffness / per_square).sqrt());
        let sound_speed = solver.sound_speed.or(from_stiffness).unwrap_or(SOUND_RATIO * reference_speed);
        let half = 0.5 * support_radius;
        let limits = [
            match solver.method {
                Method::Dfsph => (solver.cfl_factor * spacing / reference_speed, "speed"),
                _ => (solver.cfl_factor * half / sound_speed, "sound"),
            },
            match solver.method {
                Method::Dfsph => (Self::body_force_dt(scene), "gravity"),
                _ => (f32::INFINITY, "gravity"),
            },
            match solver.method {
                // The pressure at rest; see state/end_step.
                Method::Dfsph => (0.5 * spacing / (scene.gravity.length() * head).sqrt(), "pressure"),
                _ => (f32::INFINITY, "pressure"),
            },
            (
                if Self::has_implicit_viscosity(scene) { f32::INFINITY } else { Self::viscous_dt(scene) },
                "viscosity",
            ),
            match solver.method {
                Method::Dfsph => (f32::INFINITY, "diffusion"),
                _ => (
                    0.17 * half / (solver.density_diffusion * sound_speed).max(f32::MIN_POSITIVE),
                    "diffusion",
                ),
            },
            match solver.method {
                Method::Dfsph => (Self::capillary_dt(scene), "surface tension"),
                _ => (f32::INFINITY, "surface tension"),
            },
            (solver.max_dt, "max_dt"),
        ];
        let (dt_estimate, dt_limit) =
            limits.into_iter().min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((solver.max_dt, "max_dt"));
        let frames = scene.frame_count();
        let steps_per_frame = (f64::from(scene.frame_duration()) / f64::from(dt_estimate)).ceil() as u64;
        Self {
            particles: 0,
            emitted: 0,
            mean_particles: 0.0,
            particle_mass: fluid.particle_mass() as f32,
            lattice_sum,
            volume: 0.0,
            support_radius,
            head,
            reference_speed,
            sound_speed,
            stiffness: solver.stiffness.unwrap_or(sound_speed * sound_speed * per_square),
            dt_estimate,
            dt_limit,
            frames,
            steps_estimate: steps_per_frame.saturating_mul(u64::from(frames)),
        }
    }
}

impl Derived {
    /// The largest time step in s for which an explicit integration of the viscosity is stable.
    pub(crate) fn viscous_dt(scene: &Scene) -> f32 {
        let half = 0.5 * scene.solver.support_radius(scene.fluid.particle_spacing);
        0.125 * half * half / scene.fluid.material.viscosity
    }

    /// The numerical viscosity in m^2/s of the continuum surface force: 0.12 c H with the capillary speed
    /// c = sqrt(sigma / (rho0 H)). It damps waves of a few spacings, which the force does not resolve.
    pub fn capillary_viscosity(scene: &Scene) -> f32 {
        let material = &scene.fluid.material;
        let support_radius = scene.solver.support_radius(scene.fluid.particle_spacing);
        match scene.solver.surface_tension {
            SurfaceTension::Csf => {
                0.12 * (material.surface_tension * support_radius / material.rest_density).sqrt()
            }
            _ => 0.0,
        }
    }

    /// The largest time step in s for the continuum surface force (Brackbill, Kothe & Zemach 1992).
    pub(crate) fn capillary_dt(scene: &Scene) -> f32 {
        let (material, spacing) = (&scene.fluid.material, scene.fluid.particle_spacing);
        match scene.solver.surface_tension {
            SurfaceTension::Csf if material.surface_tension > 0.0 => {
                let tension = 4.0 * std::f32::consts::PI * material.surface_tension;
                (material.rest_density * spacing * spacing * spacing / tension).sqrt()
            }
            _ => f32::INFINITY,
        }
    }

    /// True if the viscosity is integrated implicitly: with `dfsph`, where it would otherwise determine the time step. The
    /// limit by the speed is not considered, because it is not known.
    pub(crate) fn has_implicit_viscosity(scene: &Scene) -> bool {
        let solver = &scene.solver;
        solver.method == Method::Dfsph
            && Self::viscous_dt(scene) < Self::falling_dt(scene, 0.02).min(solver.max_dt)
    }

    /// The largest time step in s that body forces allow with `dfsph`. With a motion of 0.1 spacings instead of 0.02 every
    /// implicit solver that was tried gained energy at a CFL factor of 1. An implicit viscosity dissipates it.
    pub(crate) fn body_force_dt(scene: &Scene) -> f32 {
        Self::falling_dt(scene, if Self::has_implicit_viscosity(scene) { 0.1 } else { 0.02 })
    }

    /// The largest number of iterations of the implicit pressure in a step: that of the scene, or a quarter of the spacings
    /// along the longest side of the domain. An iteration carries a change of the pressure over one support radius, so that
    /// an impact on wide and deep water needs more iterations the finer it is resolved. 40 are enough for most scenes, and
    /// more than 400 would take longer than the shorter steps that follow steps without convergence. Where the fluid fills a
    /// closed domain, one more only measures.
    pub fn max_iterations(scene: &Scene) -> u32 {
        let measuring = u32::from(scene.solver.method == Method::Dfsph && scene.is_full());
        let size = scene.domain.max - scene.domain.min;
        let across = 0.25 * size.max_element() / scene.fluid.particle_spacing;
        let usual = across.clamp(Solver::USUAL_ITERATIONS as f32, 400.0) as u32;
        measuring + scene.solver.max_iterations.unwrap_or(usual)
    }

    /// The time step in s in which body forces move a particle by this many spacings.
    fn falling_dt(scene: &Scene, spacings: f32) -> f32 {
        let oscillation = scene.domain.oscillation.map_or(0.0, |oscillation| {
            let rate = std::f32::consts::TAU / oscillation.period;
            oscillation.amplitude.length() * rate * rate
        });
        let force = scene.gravity.length() + oscillation;
        (spacings * scene.fluid.particle_spacing / force.max(1e-20)).sqrt()
    }
}

/// Height of the fluid's highest point above the domain's lowest corner, against gravity.
fn head(scene: &Scene, reaches: &[Reach]) -> f32 {
    let Some(down) = scene.gravity.try_normalize() else { return 0.0 };
    let corner = |low: Vec3, high: Vec3, lowest: bool| {
        let pick = |a: usize| if (down[a] > 0.0) == lowest { high[a] } else { low[a] };
        down.dot(Vec3::new(pick(0), pick(1), pick(2)))
    };
    let floor = corner(scene.domain.min, scene.domain.max, true);
    let tops = scene.fluid.blocks.iter().map(|block| match block.shape {
        Shape::Box { min, size } => corner(min, min + size, false),
        Shape::Sphere { center, radius } => down.dot(center) - radius,
    });
    let outlets = scene.emitters.iter().map(|emitter| down.dot(emitter.position));
    let others = reaches.iter().map(|reach| corner(reach.low, reach.high, false));
    (floor - tops.chain(outlets).chain(others).fold(floor, f32::min)).max(0.0)
}

fn reference_speed(scene: &Scene, head: f32, reaches: &[Reach]) -> f32 {
    let blocks = scene.fluid.blocks.iter().map(|block| block.velocity.length());
    let emitters = scene.emitters.iter().map(|emitter| emitter.speed);
    // Only the speed of a body's origin counts: its extent is unknown before its mesh is read.
    let bodies = scene.bodies.iter().map(|body| match &body.motion {
        Motion::Static => 0.0,
        Motion::Scripted(script) => script.max_speed(f64::from(scene.duration), 0.0),
        Motion::Dynamic { velocity, .. } => velocity.length(),
    });
    let others = reaches.iter().map(|reach| reach.speed);
    let fastest = blocks
        .chain(emitters)
        .chain(bodies)
        .chain(others)
        .filter(|speed| speed.is_finite())
        .fold(0.0, f32::max);
    let oscillation = scene.domain.oscillation.map_or(0.0, |oscillation| oscillation.max_speed());
    let driven = (4.0 * scene.gravity.length() * head + fastest * fastest).sqrt() + oscillation;
    let material = &scene.fluid.material;
    let capillary = match scene.solver.surface_tension {
        SurfaceTension::None => 0.0,
        _ => (2.0 * material.surface_tension / (material.rest_density * scene.fluid.particle_spacing)).sqrt(),
    };
    driven.max(capillary).max(MIN_SPEED)
}

/// The sum of `W dx^3` over the infinite lattice of spacing dx, for a support radius of `ratio * dx`. W is
/// the kernel of the method's density (poly6 for `mueller2003`).
pub fn lattice_sum(method: Method, kernel: KernelKind, ratio: f64) -> f64 {
    let weight = |q: f64| match (method, kernel) {
        (Method::Mueller2003, _) => 315.0 / 64.0 * (1.0 - q * q).powi(3),
        (_, KernelKind::WendlandC2) => 10.5 * (1.0 - q).powi(4) * (1.0 + 4.0 * q),
        (_, KernelKind::WendlandBlend) => WendlandBlend::exact(q)[0] * std::f64::consts::PI,
        (_, KernelKind::CubicSpline) if q <= 0.5 => 8.0 * (6.0 * q * q * (q - 1.0) + 1.0),
        (_, KernelKind::CubicSpline) => 16.0 * (1.0 - q).powi(3),
    };
    // The ratio of a checked scene is at most 4. The clamp bounds the loops for scenes built in code.
    let reach = (ratio.ceil() as i64).clamp(0, 32);
    let mut sum = 0.0;
    for (i, j) in (-reach..=reach).flat_map(|i| (-reach..=reach).map(move |j| (i, j))) {
        for k in -reach..=reach {
            let q = ((i * i + j * j + k * k) as f64).sqrt() / ratio;
            if q < 1.0 {
                sum += weight(q);
            }
        }
    }
    sum / (std::f64::consts::PI * ratio.powi(3))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values computed independently with a computer algebra system, rounded to four or five digits.
    #[test]
    fn lattice_sums_match_independent_values() {
        let c2 = |ratio| lattice_sum(Method::Wcsph, KernelKind::WendlandC2, ratio);
        let blend = |ratio| lattice_sum(Method::Dfsph, KernelKind::WendlandBlend, ratio);
        let cubic = |ratio| lattice_sum(Method::Wcsph, KernelKind::CubicSpline, ratio);
        let poly6 = |ratio| lattice_sum(Method::Mueller2003, KernelKind::WendlandC2, ratio);
        let known = [
            (c2(2.0), 1.0338),
            (c2(2.4), 1.0175),
            (c2(3.0), 1.0031),
            (c2(4.0), 1.0006),
            (blend(2.0), 1.02708),
            (blend(3.0), 1.00281),
            (cubic(2.0), 0.99997),
            (cubic(2.4), 1.0008),
            (cubic(3.0), 1.0018),
            (poly6(2.0), 1.0098),
            (poly6(2.4), 1.0008),
        ];
        for (ours, published) in known {
            assert!((ours - published).abs() < 6e-5, "{ours} is not {published}");
        }
        assert!((c2(2.0) - 1.0175).abs() > 6e-5, "negative control: the value of another ratio");
    }
}
