//! The operations from which schemes compose a step.

use splashdown_gpu::{Grid as DispatchSize, PassDesc, Recording};

use super::Scheme;
use crate::bodies::Bodies;
use crate::cells::Cells;
use crate::coupling::{Coupling, Stage, StepRecorder};
use crate::flow::Flow;
use crate::mouse_force::MouseForceCoupling;
use crate::passes::{
    acceleration, continuity, density, force_integrate, integrate, mueller, normals, state_equation,
};
use crate::probes::Probes;
use crate::scene::{KernelKind, Method};
use crate::state::Fields;

/// The couplings of a simulation.
#[derive(Clone, Copy, Default)]
pub struct Couplings<'a> {
    /// Rigid bodies.
    pub bodies: Option<&'a Bodies>,
    /// Emitters and sinks.
    pub flow: Option<&'a Flow>,
    /// Probes.
    pub probes: Option<&'a Probes>,
    /// The mouse force.
    pub mouse_force: Option<&'a MouseForceCoupling>,
}

impl<'a> Couplings<'a> {
    /// True if there are none.
    pub fn is_empty(&self) -> bool {
        self.all().next().is_none()
    }

    /// The couplings, in the order in which they act within a stage.
    fn all(&self) -> impl Iterator<Item = &'a dyn Coupling> {
        let Self { bodies, flow, probes, mouse_force } = *self;
        [
            bodies.map(|bodies| bodies as &dyn Coupling),
            flow.map(|flow| flow as &dyn Coupling),
            mouse_force.map(|force| force as &dyn Coupling),
            probes.map(|probes| probes as &dyn Coupling),
        ]
        .into_iter()
        .flatten()
    }

    /// True if a coupling acts in this stage.
    fn act_in(&self, stage: Stage) -> bool {
        self.all().any(|coupling| coupling.stages().contains(&stage))
    }
}

/// A step while a scheme composes it. Each operation appends the passes that the scene needs for it, and none where it
/// needs none.
pub struct Step<'a> {
    scheme: Scheme,
    couplings: Couplings<'a>,
    recorder: StepRecorder<'a>,
    /// Particles, dead ones and those to be emitted included.
    count: u32,
}

impl<'a> Step<'a> {
    pub(super) fn new(
        scheme: Scheme,
        label: &str,
        cells: &'a Cells,
        fields: &'a Fields,
        couplings: &Couplings<'a>,
        count: u32,
    ) -> Self {
        let recorder = StepRecorder {
            recording: Recording::new(label),
            cells,
            fields,
            // An invocation where there is no particle, so that time advances.
            particles: DispatchSize::Items(count.max(1)),
            is_density_integrated: scheme.is_density_integrated,
        };
        Self { scheme, couplings: *couplings, recorder, count }
    }

    pub(super) fn finish(self) -> Recording {
        self.recorder.recording
    }

    /// True if forces and integration are one pass.
    pub(super) fn is_fused(&self) -> bool {
        self.scheme.is_fused() && self.couplings.is_empty()
    }

    /// Ends the step before, and sorts the persistent arrays by cell into the sorted ones. Ids go straight into the
    /// persistent array, which takes the sorted order when the step integrates back into it.
    pub(super) fn sort(&mut self) {
        let StepRecorder { recording, cells, fields, .. } = &mut self.recorder;
        cells.record_sort(recording, fields, fields.ids);
    }

    /// The passes of all couplings that act in this stage.
    pub(super) fn couple(&mut self, stage: Stage) {
        for coupling in self.couplings.all().filter(|coupling| coupling.stages().contains(&stage)) {
            coupling.record(stage, &mut self.recorder);
        }
    }

    /// Density of fluid and walls, by summation or by the continuity equation, and the pressure that follows.
    pub(super) fn density_and_pressure(&mut self) {
        match self.scheme.method {
            Method::Mueller2003 => self.summed_density(&density::POLY6),
            Method::Wcsph if self.scheme.is_density_integrated => self.continuity(),
            Method::Wcsph => {
                self.summed_density(self.by_kernel(&density::WENDLAND_C2, &density::CUBIC_SPLINE));
            }
        }
    }

    fn summed_density(&mut self, pass: &'static PassDesc) {
        let StepRecorder { recording, cells, fields, particles, .. } = &mut self.recorder;
        let buffers = [
            fields.params.id(),
            cells.grid_uniform.id(),
            cells.cell_start.id(),
            fields.sorted_positions.id(),
            fields.wall_table.id(),
            fields.densities.id(),
        ];
        recording.dispatch(pass, *particles, &buffers);
    }

    fn continuity(&mut self) {
        let pass = self.by_kernel(&continuity::WENDLAND_C2, &continuity::CUBIC_SPLINE);
        let StepRecorder { recording, cells, fields, particles, .. } = &mut self.recorder;
        let buffers = [
            fields.params.id(),
            cells.grid_uniform.id(),
            fields.state.id(),
            cells.cell_start.id(),
            fields.sorted_positions.id(),
            fields.sorted_velocities.id(),
            fields.wall_table.id(),
            fields.densities.id(),
        ];
        recording.dispatch(pass, *particles, &buffers);
    }

    /// The normals that surface tension needs.
    pub(super) fn surface_normals(&mut self) {
        if !self.scheme.has_tension {
            return;
        }
        let pass = self.by_kernel(&normals::WENDLAND_C2, &normals::CUBIC_SPLINE);
        let StepRecorder { recording, cells, fields, particles, .. } = &mut self.recorder;
        let buffers = [
            fields.params.id(),
            cells.grid_uniform.id(),
            cells.cell_start.id(),
            fields.sorted_positions.id(),
            fields.densities.id(),
            fields.normals.id(),
        ];
        recording.dispatch(pass, *particles, &buffers);
    }

    /// Accelerations by fluid, walls and body forces, in one visit of the neighbours.
    pub(super) fn acceleration(&mut self) {
        let wcsph = self.by_kernel(&acceleration::WENDLAND_C2, &acceleration::CUBIC_SPLINE);
        let StepRecorder { recording, cells, fields, particles, .. } = &mut self.recorder;
        let (params, grid, state) = (fields.params.id(), cells.grid_uniform.id(), fields.state.id());
        let neighbours = [cells.cell_start.id(), fields.sorted_positions.id(), fields.sorted_velocities.id()];
        let [cell_start, positions, velocities] = neighbours;
        let (densities, wall_table) = (fields.densities.id(), fields.wall_table.id());
        let accelerations = fields.accelerations.id();
        match self.scheme.method {
            Method::Wcsph => {
                let normals = fields.normals.id();
                let buffers = [
                    params,
                    grid,
                    state,
                    cell_start,
                    positions,
                    velocities,
                    densities,
                    normals,
                    wall_table,
                    accelerations,
                ];
                recording.dispatch(wcsph, *particles, &buffers);
            }
            Method::Mueller2003 => {
                let buffers = [
                    params,
                    grid,
                    state,
                    cell_start,
                    positions,
                    velocities,
                    densities,
                    wall_table,
                    accelerations,
                ];
                recording.dispatch(&mueller::MUELLER, *particles, &buffers);
            }
        }
    }

    /// Forces and integration in one pass.
    pub(super) fn force_integrate(&mut self) {
        let pass = self.by_kernel(&force_integrate::WENDLAND_C2, &force_integrate::CUBIC_SPLINE);
        let StepRecorder { recording, cells, fields, particles, .. } = &mut self.recorder;
        let buffers = [
            fields.params.id(),
            cells.grid_uniform.id(),
            fields.state.id(),
            fields.wall_table.id(),
            cells.cell_start.id(),
            fields.sorted_positions.id(),
            fields.sorted_velocities.id(),
            fields.densities.id(),
            fields.positions.id(),
            fields.velocities.id(),
            fields.counters.id(),
            cells.cell_counts.id(),
        ];
        recording.dispatch(pass, *particles, &buffers);
    }

    /// Velocity, then position (symplectic Euler), and the count for the next sort.
    pub(super) fn integrate(&mut self) {
        let pass = if self.couplings.act_in(Stage::Emission) {
            &integrate::UNCOUNTED
        } else {
            &integrate::INTEGRATE
        };
        let StepRecorder { recording, cells, fields, particles, .. } = &mut self.recorder;
        let buffers = [
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
        ];
        recording.dispatch(pass, *particles, &buffers);
    }

    /// The count for the next sort, where emitted particles have to be counted with the others.
    pub(super) fn count_emitted(&mut self) {
        if self.couplings.act_in(Stage::Emission) {
            let StepRecorder { recording, cells, fields, .. } = &mut self.recorder;
            cells.record_count(recording, fields);
        }
    }

    /// Sort, boundary lookup, density and pressure of particles that have not moved yet.
    pub(super) fn initial_state(&mut self) {
        // Without particles there is nothing to compute, and time stands still.
        self.recorder.particles = DispatchSize::Items(self.count);
        let StepRecorder { recording, cells, fields, .. } = &mut self.recorder;
        recording.append(&super::begin_frame(cells, fields));
        self.sort();
        self.couple(Stage::BoundaryLookup);
        let StepRecorder { recording, fields, particles, .. } = &mut self.recorder;
        recording.copy(fields.sorted_positions, fields.positions);
        recording.copy(fields.sorted_velocities, fields.velocities);
        if self.scheme.is_density_integrated {
            // The densities are those the particles come with.
            let buffers =
                [fields.params.id(), fields.state.id(), fields.sorted_velocities.id(), fields.densities.id()];
            recording.dispatch(&state_equation::STATE_EQUATION, *particles, &buffers);
        } else {
            self.density_and_pressure();
            self.couple(Stage::BoundaryDensity);
        }
    }

    fn by_kernel(
        &self,
        wendland_c2: &'static PassDesc,
        cubic_spline: &'static PassDesc,
    ) -> &'static PassDesc {
        match self.scheme.kernel {
            KernelKind::WendlandC2 => wendland_c2,
            KernelKind::CubicSpline => cubic_spline,
        }
    }
}
