//! The passes of the bodies in a step.

use splashdown_gpu::{BufferSet, DispatchSize, PassDesc, buffer_set};

use super::{
    Bodies, boundary_density, boundary_force, boundary_lookup, boundary_matrix, motion, pressure_force,
    pressure_reaction, pressure_response, solid_gradient, solid_velocity, viscous,
};
use crate::boundary::KernelPair;
use crate::boundary::part::Part;
use crate::coupling::{Coupling, Stage, StepRecorder, ViscousStage};

impl Coupling for Bodies {
    fn stages(&self) -> &'static [Stage] {
        &[
            Stage::BoundaryLookup,
            Stage::BoundaryDensity,
            Stage::BoundaryForces(Part::All),
            Stage::BoundaryForces(Part::Pressure),
            Stage::BoundaryForces(Part::Other),
            Stage::Viscosity(ViscousStage::Start),
            Stage::Viscosity(ViscousStage::Product),
            Stage::Viscosity(ViscousStage::Sum),
            Stage::Viscosity(ViscousStage::Update),
            Stage::Viscosity(ViscousStage::Force),
            Stage::PressureIteration,
            Stage::BodyMotion,
        ]
    }

    fn buffers(&self) -> BufferSet {
        buffer_set!(self => bodies, maps, contacts, sums, scripts, pressure_sums, responses, supports, unknowns)
    }

    fn record(&self, stage: Stage, step: &mut StepRecorder<'_>) {
        match stage {
            Stage::BoundaryLookup => self.record_boundary_lookup(step),
            Stage::BoundaryDensity => self.record_boundary_density(step),
            Stage::BoundaryForces(part) => self.record_boundary_force(part, step),
            Stage::Viscosity(stage) => self.record_viscous(stage, step),
            Stage::PressureIteration => self.record_pressure_iteration(step),
            _ => self.record_motion(step),
        }
    }
}

impl Bodies {
    fn record_boundary_lookup(&self, step: &mut StepRecorder<'_>) {
        step.dispatch_particles(self.by_kernels(
            &boundary_lookup::WENDLAND_C2,
            &boundary_lookup::WENDLAND_BLEND,
            &boundary_lookup::CUBIC_SPLINE,
            &boundary_lookup::MUELLER,
        ));
        if step.is_density_integrated {
            step.dispatch_particles(&boundary_matrix::BOUNDARY_MATRIX);
        }
    }

    fn record_boundary_density(&self, step: &mut StepRecorder<'_>) {
        step.dispatch_particles(if step.is_density_integrated {
            &boundary_density::CONTINUITY
        } else {
            &boundary_density::SUMMATION
        });
        if step.is_implicit {
            step.dispatch_particles(&solid_gradient::SOLID_GRADIENT);
        }
    }

    fn record_boundary_force(&self, part: Part, step: &mut StepRecorder<'_>) {
        step.dispatch_particles(match part {
            Part::All if step.is_density_integrated => &boundary_force::CORRECTED,
            Part::All => &boundary_force::ALL,
            Part::Pressure if step.is_implicit => &pressure_force::PRESSURE_FORCE,
            Part::Pressure => &boundary_force::PRESSURE,
            Part::Other => &boundary_force::OTHER,
        });
    }

    /// The response of the bodies to the present implicit pressure.
    fn record_pressure_iteration(&self, step: &mut StepRecorder<'_>) {
        if !self.has_dynamic {
            return;
        }
        let buffers = step.buffers.clone().with("sums", self.pressure_sums);
        step.recording.dispatch(&pressure_reaction::PRESSURE_REACTION, step.particles, &buffers);
        step.dispatch(&pressure_response::PRESSURE_RESPONSE, DispatchSize::Items(self.bodies.len()));
        step.dispatch_particles(&solid_velocity::SOLID_VELOCITY);
    }

    /// The friction of bodies in the implicit viscosity.
    fn record_viscous(&self, stage: ViscousStage, step: &mut StepRecorder<'_>) {
        let buffers = step.buffers.clone().with("sums", self.pressure_sums);
        let bodies = DispatchSize::Items(self.bodies.len());
        match stage {
            ViscousStage::Start => {
                step.recording.dispatch(&viscous::start::VISCOUS_FRICTION, step.particles, &buffers);
                step.dispatch(&viscous::begin::VISCOUS_BODIES, bodies);
            }
            ViscousStage::Product => {
                step.recording.dispatch(&viscous::product::VISCOUS_PRODUCT, step.particles, &buffers);
            }
            ViscousStage::Sum if self.has_dynamic => {
                step.dispatch(&viscous::sum::VISCOUS_SUM, DispatchSize::Groups(1));
            }
            ViscousStage::Update if self.has_dynamic => {
                step.dispatch(&viscous::update::VISCOUS_BODY_UPDATE, bodies);
            }
            ViscousStage::Sum | ViscousStage::Update => {}
            ViscousStage::Force => step.dispatch_particles(&viscous::force::VISCOUS_FORCE),
        }
    }

    fn record_motion(&self, step: &mut StepRecorder<'_>) {
        step.dispatch(&motion::MOTION, DispatchSize::Items(self.bodies.len()));
    }

    fn by_kernels(
        &self,
        wendland_c2: &'static PassDesc,
        wendland_blend: &'static PassDesc,
        cubic_spline: &'static PassDesc,
        mueller: &'static PassDesc,
    ) -> &'static PassDesc {
        match self.kernels {
            KernelPair::WendlandC2 => wendland_c2,
            KernelPair::WendlandBlend => wendland_blend,
            KernelPair::CubicSpline => cubic_spline,
            KernelPair::Mueller => mueller,
        }
    }
}
