//! Couplings act on the fluid or measure it: bodies, emitters, sinks, probes, the mouse force. Each declares the
//! stages of a step in which it acts.

use splashdown_gpu::{BufferSet, DispatchSize, PassDesc, Recording};

use crate::boundary::part::Part;
use crate::cells::Cells;
use crate::state::Fields;

/// A stage of a step in which couplings act, in the order of the step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stage {
    /// After the sort: finds the boundaries near each particle.
    BoundaryLookup,
    /// After the density of the fluid: adds the boundary's contribution.
    BoundaryDensity,
    /// After the accelerations by fluid and walls: adds a part of the boundary forces, and the reactions to it.
    BoundaryForces(Part),
    /// In an implicit viscosity: adds the friction of bodies.
    Viscosity(ViscousStage),
    /// In each iteration of an implicit pressure, after the velocities of the particles that it leads to: the velocities of
    /// the bodies.
    PressureIteration,
    /// After all boundary forces: moves the bodies by the reactions.
    BodyMotion,
    /// After all forces: changes accelerations, or removes particles.
    ExternalForces,
    /// After the integration of the particles: reads the fields before and after it.
    Measurement,
    /// At the end of the step: adds particles.
    Emission,
}

/// A stage of an implicit viscosity; see [`passes::viscous`](crate::passes::viscous).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ViscousStage {
    /// After the first residual.
    Start,
    /// In each iteration, before the product of the matrix with the preconditioned residual.
    Product,
    /// In each iteration, before the sums are used.
    Sum,
    /// In each iteration, after the velocities have changed.
    Update,
    /// After the iterations.
    Force,
}

/// A step during its recording. Couplings and schemes append their passes to it.
pub struct StepRecorder<'a> {
    /// The passes recorded so far.
    pub recording: Recording,
    /// The buffers of fields, cells and couplings, which passes bind by name.
    pub buffers: BufferSet,
    /// The sorting grid and its buffers.
    pub cells: &'a Cells,
    /// The buffers shared by passes.
    pub fields: &'a Fields,
    /// The dispatch size with one invocation for each particle.
    pub particles: DispatchSize,
    /// True if the density is integrated by the continuity equation, false if it is summed.
    pub is_density_integrated: bool,
    /// True if the pressure is implicit.
    pub is_implicit: bool,
}

impl StepRecorder<'_> {
    /// Appends a pass.
    pub fn dispatch(&mut self, pass: &'static PassDesc, size: DispatchSize) {
        self.recording.dispatch(pass, size, &self.buffers);
    }

    /// Appends a pass with one invocation for each particle.
    pub fn dispatch_particles(&mut self, pass: &'static PassDesc) {
        self.dispatch(pass, self.particles);
    }
}

/// A coupling: acts on the fluid in a step, or measures it.
pub trait Coupling {
    /// The stages in which the coupling acts.
    fn stages(&self) -> &'static [Stage];

    /// The buffers that its passes bind in addition to those of fields and cells.
    fn buffers(&self) -> BufferSet;

    /// Appends the passes of one of its [`stages`](Self::stages).
    fn record(&self, stage: Stage, step: &mut StepRecorder<'_>);
}
