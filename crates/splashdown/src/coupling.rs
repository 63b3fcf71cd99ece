//! Couplings: what acts on the fluid beside its own forces, or measures it. Each declares where in a step it acts.

use splashdown_gpu::{BufferSet, DispatchSize, PassDesc, Recording};

use crate::cells::Cells;
use crate::state::Fields;

/// A place in a step where couplings act, in the order of the step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stage {
    /// Behind the sort: finds the boundaries near each particle.
    BoundaryLookup,
    /// Behind the density of the fluid: adds the boundary's contribution.
    BoundaryDensity,
    /// Behind the accelerations by fluid and walls: boundary forces, their reactions, and the motion of bodies.
    BoundaryForces,
    /// Behind all forces: changes accelerations, or removes particles.
    ExternalForces,
    /// Behind the motion of the particles: reads the fields before and after it.
    Measurement,
    /// At the end of the step: adds particles.
    Emission,
}

impl Stage {
    /// All stages, in the order of the step.
    pub const ALL: [Self; 6] = [
        Self::BoundaryLookup,
        Self::BoundaryDensity,
        Self::BoundaryForces,
        Self::ExternalForces,
        Self::Measurement,
        Self::Emission,
    ];
}

/// A step while it is recorded: where couplings and schemes append their passes.
pub struct StepRecorder<'a> {
    /// The passes so far.
    pub recording: Recording,
    /// The buffers of fields, cells and couplings, which passes find by name.
    pub buffers: BufferSet,
    /// The sorting grid and its buffers.
    pub cells: &'a Cells,
    /// The buffers that passes share.
    pub fields: &'a Fields,
    /// One invocation for each particle.
    pub particles: DispatchSize,
    /// True if the density is integrated by the continuity equation, false if it is summed.
    pub is_density_integrated: bool,
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

/// Something that acts on the fluid in a step, or measures it.
pub trait Coupling {
    /// The stages in which it acts.
    fn stages(&self) -> &'static [Stage];

    /// The buffers that its passes bind beside those of fields and cells.
    fn buffers(&self) -> BufferSet;

    /// Appends its passes of one of its [`stages`](Self::stages).
    fn record(&self, stage: Stage, step: &mut StepRecorder<'_>);
}
