//! A step as a list of passes that reads like the paper.

mod mueller2003;
#[cfg(test)]
mod tests;
mod wcsph;

use splashdown_gpu::{Grid as Extent, Recording};

use crate::bodies::Bodies;
use crate::boundary::{KernelPair, wall_offset};
use crate::cells::Cells;
use crate::fields::Fields;
use crate::flow::Flow;
use crate::mouse_force::MouseForceCoupling;
use crate::passes::{Params, begin, end_step, integrate, state_equation};
use crate::probes::Probes;
use crate::scene::{DensityMode, Derived, KernelKind, Method, NegativePressure, Scene, SurfaceTension};

/// gamma of Akinci's surface tension for one N/m, times rho0^2 H^2. Chosen with `examples/droplet.rs`: the
/// period of a swinging drop then gives 1.1 to 2.0 times the material's sigma at five to eight spacings of
/// radius. It is no more than that: the model is made for looks, not for measuring (Akinci, Akinci & Teschner
/// 2013).
const AKINCI_PER_SIGMA: f32 = 100.0;

/// Viscosity that `mueller2003` adds to the material's, over c0 H. Its density (poly6) and its pressure (spiky)
/// do not come from one energy, so it heats up where nothing rubs: water in a tank then boils at 0.5 sqrt(g
/// depth). The thesis and its successors set a large viscosity by hand; this much calms a tank to under one per
/// cent after two seconds.
const MUELLER_VISCOSITY: f32 = 0.015;

/// What meets the fluid, as far as a scene has it.
#[derive(Clone, Copy, Default)]
pub struct Couplings<'a> {
    /// Solids.
    pub bodies: Option<&'a Bodies>,
    /// Emitters and sinks.
    pub flow: Option<&'a Flow>,
    /// Gauges.
    pub probes: Option<&'a Probes>,
    /// A hand.
    pub mouse_force: Option<&'a MouseForceCoupling>,
}

impl Couplings<'_> {
    /// True if there is nothing.
    pub fn is_empty(&self) -> bool {
        self.bodies.is_none() && self.flow.is_none() && self.probes.is_none() && self.mouse_force.is_none()
    }
}

/// What a scene's solver section asks for.
#[derive(Clone, Copy, Debug)]
pub struct Solver {
    method: Method,
    kernel: KernelKind,
    continuity: bool,
    tension: bool,
}

impl Solver {
    /// The solver of a scene.
    pub fn new(scene: &Scene) -> Self {
        Self {
            method: scene.solver.method,
            kernel: scene.solver.kernel,
            continuity: scene.solver.method == Method::Wcsph
                && scene.solver.density == DensityMode::Continuity,
            tension: scene.solver.surface_tension == SurfaceTension::Akinci2013,
        }
    }

    /// The kernels whose integrals the walls use.
    pub fn walls(&self) -> KernelPair {
        match (self.method, self.kernel) {
            (Method::Mueller2003, _) => KernelPair::Mueller,
            (Method::Wcsph, KernelKind::WendlandC2) => KernelPair::WendlandC2,
            (Method::Wcsph, KernelKind::CubicSpline) => KernelPair::CubicSpline,
        }
    }

    /// True if the surface's normals are needed.
    pub fn needs_normals(&self) -> bool {
        self.tension
    }

    /// True if forces and motion of a step without [`Couplings`] are one pass, which needs no accelerations.
    pub fn fuses(&self) -> bool {
        self.method == Method::Wcsph && !self.tension
    }

    /// One step: the settling of the last one, sort, density and pressure, accelerations, motion. Before the
    /// first one of a frame goes [`begin_frame`], behind the last one of a submission `end_step`. Needs
    /// accelerations unless it [fuses](Self::fuses) and there are no things.
    pub fn step(
        &self,
        cells: &Cells,
        fields: &Fields,
        couplings: &Couplings<'_>,
        particles: u32,
    ) -> Recording {
        let Couplings { bodies, flow, probes, mouse_force } = *couplings;
        let mut step = Recording::new("step");
        // An invocation where there is no particle, so that time goes on.
        let all = Extent::Items(particles.max(1));
        // The persistent arrays take the sorted order when the step integrates back into them; the ids do so at once.
        cells.record_sort(&mut step, fields, fields.ids);
        if let Some(bodies) = bodies {
            bodies.record_boundary_lookup(&mut step, cells, fields, all);
        }
        match self.method {
            Method::Wcsph => self.wcsph_pressure(&mut step, cells, fields, all),
            Method::Mueller2003 => self.mueller2003_pressure(&mut step, cells, fields, all),
        }
        if let Some(bodies) = bodies {
            bodies.record_boundary_density(&mut step, cells, fields, all, self.continuity);
        }
        if self.fuses() && couplings.is_empty() {
            self.wcsph_force_integrate(&mut step, cells, fields, all);
            return step;
        }
        match self.method {
            Method::Wcsph => self.wcsph_forces(&mut step, cells, fields, all),
            Method::Mueller2003 => self.mueller2003_forces(&mut step, cells, fields, all),
        }
        if let Some(bodies) = bodies {
            bodies.record_boundary_force(&mut step, fields, all);
            bodies.record_motion(&mut step, fields);
        }
        if let Some(flow) = flow {
            flow.record_before_integrate(&mut step, cells, fields, all);
        }
        if let Some(mouse_force) = mouse_force {
            mouse_force.record(&mut step, cells, fields, all);
        }
        let emits = flow.is_some_and(Flow::emits);
        step.dispatch(
            if emits { &integrate::UNCOUNTED } else { &integrate::INTEGRATE },
            all,
            &[
                fields.params.id(),
                cells.grid_uniform.id(),
                fields.state.id(),
                fields.sorted_positions.id(),
                fields.sorted_velocities.id(),
                fields.densities.id(),
                fields.accelerations.id(),
                fields.positions.id(),
                fields.velocities.id(),
                fields.counters.id(),
                cells.cell_counts.id(),
            ],
        );
        if let Some(probes) = probes {
            probes.record(&mut step, cells, fields, all);
        }
        if let Some(flow) = flow {
            flow.record_after_integrate(&mut step, cells, fields);
        }
        if emits {
            cells.record_count(&mut step, fields);
        }
        step
    }

    /// Sort, density and pressure without motion: what the first frame shows.
    pub fn prime(
        &self,
        cells: &Cells,
        fields: &Fields,
        bodies: Option<&Bodies>,
        particles: u32,
    ) -> Recording {
        let mut prime = Recording::new("prime");
        prime.append(&begin_frame(cells, fields));
        cells.record_sort(&mut prime, fields, fields.ids);
        let all = Extent::Items(particles);
        if let Some(bodies) = bodies {
            bodies.record_boundary_lookup(&mut prime, cells, fields, all);
        }
        prime.copy(fields.sorted_positions, fields.positions);
        prime.copy(fields.sorted_velocities, fields.velocities);
        self.pressure(&mut prime, cells, fields, all);
        if let Some(bodies) = bodies
            && !self.continuity
        {
            bodies.record_boundary_density(&mut prime, cells, fields, all, false);
        }
        prime
    }

    fn pressure(&self, recording: &mut Recording, cells: &Cells, fields: &Fields, all: Extent) {
        match self.method {
            Method::Wcsph if self.continuity => {
                let buffers = [
                    fields.params.id(),
                    fields.state.id(),
                    fields.sorted_velocities.id(),
                    fields.densities.id(),
                ];
                recording.dispatch(&state_equation::STATE_EQUATION, all, &buffers);
            }
            Method::Wcsph => self.wcsph_pressure(recording, cells, fields, all),
            Method::Mueller2003 => self.mueller2003_pressure(recording, cells, fields, all),
        }
    }
}

/// Begins a frame of the length that `duration` holds: the next sort finds the particles counted.
pub fn begin_frame(cells: &Cells, fields: &Fields) -> Recording {
    let mut recording = Recording::new("begin frame");
    let buffers = [fields.params.id(), fields.duration.id(), fields.state.id()];
    recording.dispatch(&begin::BEGIN, Extent::Groups(1), &buffers);
    cells.record_first_count(&mut recording, fields);
    recording
}

/// Settles the last step, where no other follows that does: the host, or another step's passes, may look at the
/// state then.
pub fn end_step(fields: &Fields) -> Recording {
    let mut recording = Recording::new("end_step");
    let buffers = [fields.params.id(), fields.state.id(), fields.counters.id()];
    recording.dispatch(&end_step::END_STEP, Extent::Groups(1), &buffers);
    recording
}

/// The constants of a scene.
pub fn params(scene: &Scene, particles: u32) -> Params {
    let (solver, material) = (&scene.solver, &scene.fluid.material);
    let derived = Derived::without_particles(scene);
    let support_radius = derived.support_radius;
    let rest_density = material.rest_density;
    let (shake, shake_rate) = scene.domain.shake.map_or_else(Default::default, |shake| {
        let rate = std::f32::consts::TAU / shake.period;
        (shake.amplitude * rate * rate, rate)
    });
    let closed = scene.domain.closed.as_flattened();
    let kind = Solver::new(scene);
    let numerical_viscosity = match solver.method {
        Method::Wcsph => 0.0,
        Method::Mueller2003 => MUELLER_VISCOSITY * derived.sound_speed * support_radius,
    };
    Params {
        gravity: scene.gravity,
        support_radius,
        domain_min: scene.domain.min,
        particle_spacing: scene.fluid.particle_spacing,
        domain_max: scene.domain.max,
        particle_mass: derived.particle_mass,
        shake,
        shake_rate,
        rest_density,
        sound_speed: derived.sound_speed,
        wall_offset: scene.fluid.particle_spacing * wall_offset(kind.walls(), solver.support_ratio),
        exponent: solver.exponent,
        viscosity: material.viscosity + numerical_viscosity,
        artificial_viscosity: solver.artificial_viscosity,
        density_diffusion: solver.density_diffusion,
        surface_tension: match solver.surface_tension {
            SurfaceTension::None => 0.0,
            SurfaceTension::ColourField => material.surface_tension,
            SurfaceTension::Akinci2013 => {
                AKINCI_PER_SIGMA * material.surface_tension / (rest_density * support_radius).powi(2)
            }
        },
        wall_friction: solver.wall_friction,
        cfl_factor: solver.cfl_factor,
        max_dt: solver.max_dt,
        min_dt: solver.min_dt,
        closed: closed.iter().enumerate().map(|(bit, &closed)| u32::from(closed) << bit).sum(),
        clamp_pressure: u32::from(solver.negative_pressure == NegativePressure::Clamp),
        particle_count: particles,
        wall_damping: if kind.continuity { 0.0 } else { 1.0 },
    }
}
