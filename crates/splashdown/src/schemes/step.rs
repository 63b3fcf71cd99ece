//! The operations from which schemes compose a step.

use std::mem::offset_of;

use splashdown_gpu::{DispatchSize, Flag, PassDesc, Recording, Rounds};

use super::{Scheme, SolverRounds};
use crate::bodies::Bodies;
use crate::boundary::part::Part;
use crate::cells::Cells;
use crate::coupling::{Coupling, Stage, StepRecorder, ViscousStage};
use crate::flow::Flow;
use crate::mouse_force::MouseForceCoupling;
use crate::passes::{
    acceleration, continuity, corrected_acceleration, density, force_integrate, implicit, integrate, mueller,
    neighbours, normals, shifted_integrate, smooth_normals, state_equation, suspension, tension_force,
    viscous,
};
use crate::probes::Probes;
use crate::scene::{KernelKind, Method, SurfaceTension};
use crate::state::{CarriedArrays, Fields, Reordered, SolveState, ViscousState};

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

/// A step while a scheme composes it. Each operation appends the passes that the scene needs for it, which may be none.
pub struct Step<'a> {
    scheme: Scheme,
    couplings: Couplings<'a>,
    recorder: StepRecorder<'a>,
    rounds: SolverRounds,
    /// Number of particles, including removed ones and those not yet emitted.
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
        let mut buffers = fields.buffers().and(&cells.buffers());
        couplings.all().for_each(|coupling| buffers.extend(&coupling.buffers()));
        let recorder = StepRecorder {
            recording: Recording::new(label),
            buffers,
            cells,
            fields,
            // At least one invocation, so that time advances without particles.
            particles: DispatchSize::Items(count.max(1)),
            is_density_integrated: scheme.is_density_integrated,
            is_implicit: scheme.is_implicit(),
        };
        Self { scheme, couplings: *couplings, recorder, rounds: scheme.solver_rounds(), count }
    }

    /// Records the rounds of the solvers so that the host can change their numbers.
    pub(super) fn with_rounds(self, rounds: &SolverRounds) -> Self {
        Self { rounds: rounds.clone(), ..self }
    }

    pub(super) fn finish(self) -> Recording {
        self.recorder.recording
    }

    /// True if forces and integration are one pass.
    pub(super) fn is_fused(&self) -> bool {
        self.scheme.is_fused() && self.couplings.is_empty()
    }

    /// Ends the previous step, and sorts the persistent arrays by cell into the sorted ones. The ids are written to the
    /// persistent array, because the step integrates the other arrays back in sorted order.
    pub(super) fn sort(&mut self) {
        let StepRecorder { recording, cells, fields, .. } = &mut self.recorder;
        cells.record_sort(recording, fields, fields.ids);
    }

    /// Lists of the neighbours in the sorted arrays.
    pub(super) fn list_neighbours(&mut self) {
        self.recorder.dispatch_particles(&neighbours::LIST_NEIGHBOURS);
    }

    /// The passes of all couplings that act in this stage.
    pub(super) fn couple(&mut self, stage: Stage) {
        for coupling in self.couplings.all().filter(|coupling| coupling.stages().contains(&stage)) {
            coupling.record(stage, &mut self.recorder);
        }
    }

    /// Density of fluid and walls, by summation or by the continuity equation, and the resulting pressure.
    pub(super) fn density_and_pressure(&mut self) {
        let pass = match self.scheme.method {
            Method::Mueller2003 => &density::POLY6,
            Method::Wcsph if self.scheme.is_density_integrated && self.couplings.bodies.is_some() => self
                .by_kernel(
                    &continuity::WENDLAND_C2_BODIES,
                    &continuity::WENDLAND_BLEND_BODIES,
                    &continuity::CUBIC_SPLINE_BODIES,
                ),
            Method::Wcsph if self.scheme.is_density_integrated => self.by_kernel(
                &continuity::WENDLAND_C2,
                &continuity::WENDLAND_BLEND,
                &continuity::CUBIC_SPLINE,
            ),
            _ => self.by_kernel(&density::WENDLAND_C2, &density::WENDLAND_BLEND, &density::CUBIC_SPLINE),
        };
        self.recorder.dispatch_particles(pass);
    }

    /// The normals that surface tension needs.
    pub(super) fn surface_normals(&mut self) {
        if !self.scheme.has_normals() {
            return;
        }
        let pass = self.by_kernel(&normals::WENDLAND_C2, &normals::WENDLAND_BLEND, &normals::CUBIC_SPLINE);
        self.recorder.dispatch_particles(pass);
    }

    /// Adds the continuum surface force to the accelerations.
    pub(super) fn tension_force(&mut self) {
        if self.scheme.has_tension_force() {
            let smooth = self.by_kernel(
                &smooth_normals::WENDLAND_C2,
                &smooth_normals::WENDLAND_BLEND,
                &smooth_normals::CUBIC_SPLINE,
            );
            self.recorder.dispatch_particles(smooth);
            let force = if self.scheme.is_density_integrated {
                self.by_kernel(
                    &tension_force::WENDLAND_C2_CORRECTED,
                    &tension_force::WENDLAND_BLEND_CORRECTED,
                    &tension_force::CUBIC_SPLINE_CORRECTED,
                )
            } else {
                self.by_kernel(
                    &tension_force::WENDLAND_C2,
                    &tension_force::WENDLAND_BLEND,
                    &tension_force::CUBIC_SPLINE,
                )
            };
            self.recorder.dispatch_particles(force);
        }
    }

    /// Accelerations by a part of the forces of fluid, walls and body forces, in one loop over the neighbours. They
    /// replace the previous accelerations. The forces of bodies follow by [`Stage::BoundaryForces`] of the same part.
    ///
    /// # Panics
    /// If the scheme is `mueller2003` or integrates the density, whose forces are one pass, and the part is another.
    pub(super) fn acceleration(&mut self, part: Part) {
        let pass = match (self.scheme.method, part) {
            (Method::Wcsph, Part::All) if self.scheme.is_density_integrated => self.by_kernel(
                &corrected_acceleration::WENDLAND_C2,
                &corrected_acceleration::WENDLAND_BLEND,
                &corrected_acceleration::CUBIC_SPLINE,
            ),
            (Method::Wcsph, _) if self.scheme.is_density_integrated => {
                panic!("corrected accelerations have no pass for {part:?}")
            }
            (Method::Wcsph, Part::All) => self.by_kernel(
                &acceleration::WENDLAND_C2,
                &acceleration::WENDLAND_BLEND,
                &acceleration::CUBIC_SPLINE,
            ),
            (Method::Wcsph, Part::Pressure) => self.by_kernel(
                &acceleration::WENDLAND_C2_PRESSURE,
                &acceleration::WENDLAND_BLEND_PRESSURE,
                &acceleration::CUBIC_SPLINE_PRESSURE,
            ),
            (Method::Wcsph | Method::Dfsph, Part::Other) => self.by_kernel(
                &acceleration::WENDLAND_C2_OTHER,
                &acceleration::WENDLAND_BLEND_OTHER,
                &acceleration::CUBIC_SPLINE_OTHER,
            ),
            (Method::Mueller2003, Part::All) => &mueller::MUELLER,
            (method, part) => panic!("{method} has no pass for {part:?}"),
        };
        self.recorder.dispatch_particles(pass);
    }

    /// Density, diagonal of the implicit pressure, viscosity and body forces.
    pub(super) fn implicit_system(&mut self) {
        let pass = self.by_kernel(
            &implicit::system::WENDLAND_C2,
            &implicit::system::WENDLAND_BLEND,
            &implicit::system::CUBIC_SPLINE,
        );
        self.recorder.dispatch_particles(pass);
    }

    /// Surface tension, which needs the densities. Akinci's is part of all forces but pressure.
    pub(super) fn surface_tension(&mut self) {
        self.surface_normals();
        match self.scheme.surface_tension {
            SurfaceTension::Akinci2013 => self.acceleration(Part::Other),
            _ => self.tension_force(),
        }
    }

    /// The viscosity, if it is implicit, after all other forces.
    pub(super) fn implicit_viscosity(&mut self) {
        if !self.scheme.has_implicit_viscosity {
            return;
        }
        let (start, product) = if self.couplings.bodies.is_some() {
            let start = self.by_kernel(
                &viscous::start::WENDLAND_C2_BODIES,
                &viscous::start::WENDLAND_BLEND_BODIES,
                &viscous::start::CUBIC_SPLINE_BODIES,
            );
            (start, &viscous::product::BODIES)
        } else {
            let start = self.by_kernel(
                &viscous::start::WENDLAND_C2,
                &viscous::start::WENDLAND_BLEND,
                &viscous::start::CUBIC_SPLINE,
            );
            (start, &viscous::product::PRODUCT)
        };
        self.recorder.dispatch_particles(&viscous::begin::BEGIN);
        self.recorder.dispatch_particles(start);
        self.couple(Stage::Viscosity(ViscousStage::Start));
        let step = std::mem::replace(&mut self.recorder.recording, Recording::new("viscosity"));
        self.couple(Stage::Viscosity(ViscousStage::Product));
        self.recorder.dispatch_particles(product);
        self.couple(Stage::Viscosity(ViscousStage::Sum));
        self.recorder.dispatch(&viscous::decide::DECIDE, DispatchSize::Groups(1));
        self.recorder.dispatch_particles(&viscous::update::UPDATE);
        self.couple(Stage::Viscosity(ViscousStage::Update));
        let iteration = std::mem::replace(&mut self.recorder.recording, step);
        let stopped = Flag::new(self.recorder.fields.viscous, offset_of!(ViscousState, stopped));
        let rounds = self.rounds.viscosity.clone();
        let passes = [&suspension::resume::VISCOSITY, &suspension::suspend::VISCOSITY];
        self.iterate(&iteration, &rounds, stopped, passes);
        self.couple(Stage::Viscosity(ViscousStage::Force));
        self.recorder.dispatch_particles(&viscous::finish::FINISH);
    }

    /// The implicit pressure, and the accelerations by all forces.
    pub(super) fn implicit_pressure(&mut self) {
        let has_bodies = self.couplings.bodies.is_some();
        let [predict, residual] = if has_bodies {
            [
                self.by_kernel(
                    &implicit::predict::WENDLAND_C2_BODIES,
                    &implicit::predict::WENDLAND_BLEND_BODIES,
                    &implicit::predict::CUBIC_SPLINE_BODIES,
                ),
                self.by_kernel(
                    &implicit::residual::WENDLAND_C2_BODIES,
                    &implicit::residual::WENDLAND_BLEND_BODIES,
                    &implicit::residual::CUBIC_SPLINE_BODIES,
                ),
            ]
        } else {
            [
                self.by_kernel(
                    &implicit::predict::WENDLAND_C2,
                    &implicit::predict::WENDLAND_BLEND,
                    &implicit::predict::CUBIC_SPLINE,
                ),
                self.by_kernel(
                    &implicit::residual::WENDLAND_C2,
                    &implicit::residual::WENDLAND_BLEND,
                    &implicit::residual::CUBIC_SPLINE,
                ),
            ]
        };
        self.recorder.dispatch_particles(&implicit::begin::BEGIN);
        let step = std::mem::replace(&mut self.recorder.recording, Recording::new("pressure"));
        self.recorder.dispatch_particles(predict);
        self.couple(Stage::PressureIteration);
        self.recorder.dispatch_particles(residual);
        self.recorder.dispatch(&implicit::decide::DECIDE, DispatchSize::Groups(1));
        let iteration = std::mem::replace(&mut self.recorder.recording, step);
        let stopped = Flag::new(self.recorder.fields.solve, offset_of!(SolveState, stopped));
        let rounds = self.rounds.pressure.clone();
        let passes = [&suspension::resume::PRESSURE, &suspension::suspend::PRESSURE];
        self.iterate(&iteration, &rounds, stopped, passes);
        self.recorder.dispatch_particles(&implicit::finish::FINISH);
    }

    /// Repeats an iteration of a solver until it has stopped, or suspends the step after the rounds.
    fn iterate(
        &mut self,
        iteration: &Recording,
        rounds: &Rounds,
        stopped: Flag,
        [resume, suspend]: [&'static PassDesc; 2],
    ) {
        let can_pause = self.recorder.cells.can_pause();
        if can_pause {
            self.recorder.dispatch(resume, DispatchSize::Groups(1));
        }
        self.recorder.recording.repeat(iteration, rounds, stopped);
        if can_pause {
            self.recorder.dispatch(suspend, DispatchSize::Groups(1));
        }
    }

    /// Forces and integration in one pass.
    pub(super) fn force_integrate(&mut self) {
        let pass = self.by_kernel(
            &force_integrate::WENDLAND_C2,
            &force_integrate::WENDLAND_BLEND,
            &force_integrate::CUBIC_SPLINE,
        );
        self.recorder.dispatch_particles(pass);
        self.store_carried();
    }

    /// Velocity, then position (symplectic Euler), and the count for the next sort.
    pub(super) fn integrate(&mut self) {
        let pass = match (self.scheme.is_density_integrated, self.couplings.act_in(Stage::Emission)) {
            (false, false) => &integrate::INTEGRATE,
            (false, true) => &integrate::UNCOUNTED,
            (true, false) => &shifted_integrate::SHIFTED_INTEGRATE,
            (true, true) => &shifted_integrate::UNCOUNTED,
        };
        self.recorder.dispatch_particles(pass);
        self.store_carried();
    }

    /// The carried quantities that a step does not change follow their particles into the persistent arrays.
    fn store_carried(&mut self) {
        let StepRecorder { recording, cells, fields, .. } = &mut self.recorder;
        cells.record_store(recording, fields);
    }

    /// The count for the next sort, if it has to include emitted particles.
    pub(super) fn count_emitted(&mut self) {
        if self.couplings.act_in(Stage::Emission) {
            let StepRecorder { recording, cells, fields, .. } = &mut self.recorder;
            cells.record_count(recording, fields);
        }
    }

    /// Sort, boundary lookup, density and pressure of particles that have not moved yet.
    pub(super) fn initial_state(&mut self) {
        // Time does not advance, so that no invocation is needed without particles.
        self.recorder.particles = DispatchSize::Items(self.count);
        let StepRecorder { recording, cells, fields, .. } = &mut self.recorder;
        recording.append(&super::begin_frame(cells, fields));
        self.sort();
        self.couple(Stage::BoundaryLookup);
        let StepRecorder { recording, fields, .. } = &mut self.recorder;
        recording.copy(fields.sorted_positions, fields.positions);
        recording.copy(fields.sorted_velocities, fields.velocities);
        for arrays in fields.carried.iter().filter_map(CarriedArrays::reordered) {
            match arrays {
                Reordered::Scalar { persistent, sorted, .. } => recording.copy(sorted, persistent),
                Reordered::Vector { persistent, sorted, .. } => recording.copy(sorted, persistent),
            }
        }
        if self.scheme.is_density_integrated {
            // The densities are those of the initial particles.
            self.recorder.dispatch_particles(&state_equation::STATE_EQUATION);
        } else {
            self.density_and_pressure();
            self.couple(Stage::BoundaryDensity);
        }
    }

    fn by_kernel(
        &self,
        wendland_c2: &'static PassDesc,
        wendland_blend: &'static PassDesc,
        cubic_spline: &'static PassDesc,
    ) -> &'static PassDesc {
        match self.scheme.kernel {
            KernelKind::WendlandC2 => wendland_c2,
            KernelKind::WendlandBlend => wendland_blend,
            KernelKind::CubicSpline => cubic_spline,
        }
    }
}
