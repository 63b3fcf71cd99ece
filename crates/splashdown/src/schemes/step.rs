//! The operations from which schemes compose a step.

use splashdown_gpu::{DispatchSize, PassDesc, Recording};

use super::Scheme;
use crate::bodies::Bodies;
use crate::boundary::part::Part;
use crate::cells::Cells;
use crate::coupling::{Coupling, Stage, StepRecorder};
use crate::flow::Flow;
use crate::mouse_force::MouseForceCoupling;
use crate::passes::{
    acceleration, continuity, corrected_acceleration, density, force_integrate, integrate, mueller, normals,
    shifted_integrate, state_equation,
};
use crate::probes::Probes;
use crate::scene::{KernelKind, Method};
use crate::state::{CarriedArrays, Fields, Reordered};

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

    /// Ends the previous step, and sorts the persistent arrays by cell into the sorted ones. The ids are written to the
    /// persistent array, because the step integrates the other arrays back in sorted order.
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

    /// Density of fluid and walls, by summation or by the continuity equation, and the resulting pressure.
    pub(super) fn density_and_pressure(&mut self) {
        let pass = match self.scheme.method {
            Method::Mueller2003 => &density::POLY6,
            Method::Wcsph if self.scheme.is_density_integrated && self.couplings.bodies.is_some() => {
                self.by_kernel(&continuity::WENDLAND_C2_BODIES, &continuity::CUBIC_SPLINE_BODIES)
            }
            Method::Wcsph if self.scheme.is_density_integrated => {
                self.by_kernel(&continuity::WENDLAND_C2, &continuity::CUBIC_SPLINE)
            }
            Method::Wcsph => self.by_kernel(&density::WENDLAND_C2, &density::CUBIC_SPLINE),
        };
        self.recorder.dispatch_particles(pass);
    }

    /// The normals that surface tension needs.
    pub(super) fn surface_normals(&mut self) {
        if !self.scheme.has_tension {
            return;
        }
        let pass = self.by_kernel(&normals::WENDLAND_C2, &normals::CUBIC_SPLINE);
        self.recorder.dispatch_particles(pass);
    }

    /// Accelerations by a part of the forces of fluid, walls and body forces, in one loop over the neighbours. They
    /// replace the previous accelerations. The forces of bodies follow by [`Stage::BoundaryForces`] of the same part.
    ///
    /// # Panics
    /// If the scheme is `mueller2003` or integrates the density, whose forces are one pass, and the part is another.
    pub(super) fn acceleration(&mut self, part: Part) {
        let pass = match (self.scheme.method, part) {
            (Method::Wcsph, Part::All) if self.scheme.is_density_integrated => {
                self.by_kernel(&corrected_acceleration::WENDLAND_C2, &corrected_acceleration::CUBIC_SPLINE)
            }
            (Method::Wcsph, _) if self.scheme.is_density_integrated => {
                panic!("corrected accelerations have no pass for {part:?}")
            }
            (Method::Wcsph, Part::All) => {
                self.by_kernel(&acceleration::WENDLAND_C2, &acceleration::CUBIC_SPLINE)
            }
            (Method::Wcsph, Part::Pressure) => {
                self.by_kernel(&acceleration::WENDLAND_C2_PRESSURE, &acceleration::CUBIC_SPLINE_PRESSURE)
            }
            (Method::Wcsph, Part::Other) => {
                self.by_kernel(&acceleration::WENDLAND_C2_OTHER, &acceleration::CUBIC_SPLINE_OTHER)
            }
            (Method::Mueller2003, Part::All) => &mueller::MUELLER,
            (Method::Mueller2003, _) => panic!("mueller2003 has no pass for {part:?}"),
        };
        self.recorder.dispatch_particles(pass);
    }

    /// Forces and integration in one pass.
    pub(super) fn force_integrate(&mut self) {
        let pass = self.by_kernel(&force_integrate::WENDLAND_C2, &force_integrate::CUBIC_SPLINE);
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
        cubic_spline: &'static PassDesc,
    ) -> &'static PassDesc {
        match self.scheme.kernel {
            KernelKind::WendlandC2 => wendland_c2,
            KernelKind::CubicSpline => cubic_spline,
        }
    }
}
