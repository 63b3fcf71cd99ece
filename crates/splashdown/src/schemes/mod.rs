//! Schemes: each is one function that records the passes of a time step, in the order of its paper.
//!
//! | scheme | function | reference |
//! |---|---|---|
//! | `wcsph` | `wcsph::wcsph` | Monaghan 1994; Becker & Teschner 2007; delta-SPH: Molteni & Colagrossi 2009 |
//! | `dfsph` | `dfsph::dfsph` | Bender & Koschier 2015, 2017; solver: Silcowitz, Niebe & Erleben 2010 |
//! | `mueller2003` | `mueller2003::mueller2003` | Müller, Charypar & Gross 2003 |
//!
//! The functions call the operations of [`Step`], which select the variant of a pass by the scene's kernel, density
//! formulation and surface tension. Parameters of a single scheme are defined beside its function.

mod dfsph;
mod mueller2003;
mod params;
mod rounds;
mod step;
#[cfg(test)]
mod tests;
mod wcsph;

pub use params::{longest_step, params};
pub use rounds::SolverRounds;
pub use step::{Couplings, Step};

use splashdown_gpu::{DispatchSize, Recording};

use crate::boundary::KernelPair;
#[cfg(test)]
use crate::boundary::part::Part;
use crate::cells::{self, Cells};
#[cfg(test)]
use crate::coupling::Stage;
use crate::passes::suspension;
use crate::scene::{self, DensityMode, Derived, KernelKind, Method, Scene, Solver, SurfaceTension};
use crate::state::{CARRIED, CARRIED_IMPLICIT, Carried, Extras, Fields, begin, end_step};

/// Prefixes of the labels of passes that may run again after the end of a frame without testing its flag. Each computes
/// its output from its input alone, and with empty cells there is no input; the cells of a suspended step are empty as
/// well. `flow.emit` follows the schedule, which is empty after the end of a frame. All other passes of a step read the flag.
pub(crate) const REPEATABLE: &[&str] = &[
    "scan.",
    "sort.",
    "cells.reorder",
    "neighbours",
    "density.",
    "normals.",
    "smooth_normals.",
    "tension_force.",
    "bodies.boundary_lookup.",
    "bodies.boundary_matrix",
    "flow.emit",
];

/// A scheme with the choices of a scene's `[solver]` section that select passes.
#[derive(Clone, Copy, Debug)]
pub struct Scheme {
    method: Method,
    kernel: KernelKind,
    is_density_integrated: bool,
    surface_tension: SurfaceTension,
    max_iterations: u32,
    most_viscous_iterations: u32,
    has_implicit_viscosity: bool,
}

impl Scheme {
    /// The scheme of a scene.
    pub fn new(scene: &Scene) -> Self {
        Self {
            method: scene.solver.method,
            kernel: scene.solver.kernel,
            is_density_integrated: scene.solver.method == Method::Wcsph
                && scene.solver.density == DensityMode::Continuity,
            surface_tension: scene.solver.surface_tension,
            max_iterations: Derived::max_iterations(scene),
            most_viscous_iterations: dfsph::most_viscous_iterations(
                scene.solver.max_iterations.unwrap_or(Solver::USUAL_ITERATIONS),
            ),
            has_implicit_viscosity: Derived::has_implicit_viscosity(scene),
        }
    }

    /// The kernels whose integrals bodies and the friction of walls use.
    pub fn walls(&self) -> KernelPair {
        match (self.method, self.kernel) {
            (Method::Mueller2003, _) => KernelPair::Mueller,
            (_, KernelKind::WendlandC2) => KernelPair::WendlandC2,
            (_, KernelKind::WendlandBlend) => KernelPair::WendlandBlend,
            (_, KernelKind::CubicSpline) => KernelPair::CubicSpline,
        }
    }

    /// The arrays that it needs for each particle, for a scene with or without bodies.
    pub fn extras(&self, bodies: bool) -> Extras {
        Extras {
            normals: self.has_normals(),
            smooth_normals: self.has_tension_force(),
            corrections: self.is_density_integrated,
            boundary_matrices: self.is_density_integrated && bodies,
            implicit: self.is_implicit(),
            solid_gradients: self.is_implicit() && bodies,
            viscous: self.has_implicit_viscosity,
        }
    }

    /// True if surface tension needs normals.
    fn has_normals(&self) -> bool {
        matches!(self.surface_tension, SurfaceTension::Akinci2013 | SurfaceTension::Csf)
    }

    /// True if surface tension is a force on each particle of the surface.
    fn has_tension_force(&self) -> bool {
        self.surface_tension == SurfaceTension::Csf
    }

    /// True if the pressure is implicit.
    pub fn is_implicit(&self) -> bool {
        self.method == Method::Dfsph
    }

    /// True if the viscosity is implicit.
    pub fn has_implicit_viscosity(&self) -> bool {
        self.has_implicit_viscosity
    }

    /// The table of the quantities that its particles carry.
    pub fn carried(&self) -> &'static [Carried] {
        if self.is_implicit() { CARRIED_IMPLICIT } else { CARRIED }
    }

    /// True if the forces and integration of a step without [`Couplings`] are one pass, which stores no accelerations.
    pub fn is_fused(&self) -> bool {
        self.method == Method::Wcsph && !self.has_normals() && !self.is_density_integrated
    }

    /// The largest numbers of iterations of a step.
    pub fn solver_rounds(&self) -> SolverRounds {
        SolverRounds::new(self.max_iterations, self.most_viscous_iterations)
    }

    /// Records one step. [`begin_frame`] precedes the first step of a frame, and
    /// [`end_step`](crate::state::end_step::record) follows the last step of a submission. Needs a buffer of
    /// accelerations unless the scheme [is fused](Self::is_fused) and there are no couplings.
    pub fn step(
        &self,
        cells: &Cells,
        fields: &Fields,
        couplings: &Couplings<'_>,
        particles: u32,
        rounds: &SolverRounds,
    ) -> Recording {
        let mut step = Step::new(*self, "step", cells, fields, couplings, particles).with_rounds(rounds);
        match self.method {
            Method::Wcsph => wcsph::wcsph(&mut step),
            Method::Mueller2003 => mueller2003::mueller2003(&mut step),
            Method::Dfsph => dfsph::dfsph(&mut step),
        }
        step.finish()
    }

    /// Records the sort, density and pressure without integration, for the fields of the first frame.
    pub fn initial_state(
        &self,
        cells: &Cells,
        fields: &Fields,
        couplings: &Couplings<'_>,
        particles: u32,
    ) -> Recording {
        let mut step = Step::new(*self, "initial state", cells, fields, couplings, particles);
        step.initial_state();
        step.finish()
    }
}

/// The passes of a step up to the accelerations, of which only a part is computed.
#[cfg(test)]
pub(crate) fn part_of_forces(
    scheme: Scheme,
    cells: &Cells,
    fields: &Fields,
    couplings: &Couplings<'_>,
    particles: u32,
    part: Part,
) -> Recording {
    let mut step = Step::new(scheme, "part of forces", cells, fields, couplings, particles);
    step.sort();
    step.couple(Stage::BoundaryLookup);
    step.density_and_pressure();
    step.couple(Stage::BoundaryDensity);
    step.acceleration(part);
    step.couple(Stage::BoundaryForces(part));
    step.finish()
}

/// Begins a frame whose start and duration are in `frame_input`, and counts the particles for the first sort.
pub fn begin_frame(cells: &Cells, fields: &Fields) -> Recording {
    let mut recording = Recording::new("begin frame");
    recording.dispatch(&begin::BEGIN, DispatchSize::Groups(1), &fields.buffers());
    cells.record_first_count(&mut recording, fields);
    recording
}

/// Ends a suspended step by a step with all iterations; without one it has no effect.
pub(crate) fn end_suspended_step(step: &Recording, cells: &Cells, fields: &Fields) -> Recording {
    let buffers = fields.buffers().and(&cells.buffers());
    let mut recording = Recording::new("end of a suspended step");
    recording.dispatch(&suspension::suspend::HOLD, DispatchSize::Groups(1), &buffers);
    recording.append(step);
    recording.append(&end_step::record(fields));
    recording.dispatch(&suspension::resume::RELEASE, DispatchSize::Groups(1), &buffers);
    recording
}

impl From<scene::Sort> for cells::Sort {
    fn from(sort: scene::Sort) -> Self {
        match sort {
            scene::Sort::Counting => Self::Counting,
            scene::Sort::Bitonic => Self::Bitonic,
        }
    }
}
