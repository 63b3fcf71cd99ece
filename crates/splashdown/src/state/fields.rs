//! The buffers of a simulation.

use bytemuck::Zeroable;
use glam::{UVec4, Vec2, Vec4};
use splashdown_gpu::{Buffer, BufferSet, Executor, GpuError, buffer_set};

use super::list_layers::list_layers;
use super::{
    Array, CARRIED, Carried, CarriedArrays, Params, SolveState, StepCounters, StepState, Suspension,
    ViscousState,
};

/// The arrays that a scheme needs in addition; without them the buffers have a single entry.
#[derive(Clone, Copy, Debug, Default)]
pub struct Extras {
    /// Normals for surface tension.
    pub normals: bool,
    /// Smooth normals for the continuum surface force.
    pub smooth_normals: bool,
    /// Corrections and shifting velocities.
    pub corrections: bool,
    /// The contributions of bodies to the corrections.
    pub boundary_matrices: bool,
    /// The arrays of the implicit pressure.
    pub implicit: bool,
    /// The contributions of bodies to the system of the implicit pressure.
    pub solid_gradients: bool,
    /// The arrays of the implicit viscosity.
    pub viscous: bool,
}

/// The buffers shared by all passes, except those of the sort. One entry per particle unless noted otherwise.
#[derive(Clone)]
pub struct Fields {
    /// Constants; a uniform.
    pub params: Buffer<Params>,
    /// The state of the step; one entry.
    pub state: Buffer<StepState>,
    /// What a frame begins with ([`StepState::frame_input`]); three entries.
    pub frame_input: Buffer<f32>,
    /// Counters and maxima, [`StepCounters::WORDS`] words.
    pub counters: Buffer<u32>,
    /// Persistent: position in metres; the fourth component is 0 for an active particle, else why it is not active.
    pub positions: Buffer<Vec4>,
    /// Persistent: velocity in m/s, and density in kg/m^3.
    pub velocities: Buffer<Vec4>,
    /// Persistent: the unique id of the particle.
    pub ids: Buffer<u32>,
    /// Sorted by cell: as `positions`.
    pub sorted_positions: Buffer<Vec4>,
    /// Sorted by cell: as `velocities`.
    pub sorted_velocities: Buffer<Vec4>,
    /// Sorted by cell: as `ids`, after a sort without a step. A step writes the sorted ids to `ids`.
    pub sorted_ids: Buffer<u32>,
    /// Density in kg/m^3 and pressure in Pa, in the order of the last step's sort, which is also the order of the
    /// persistent arrays after the step.
    pub densities: Buffer<Vec2>,
    /// Acceleration in m/s^2; the fourth component is 1 where a nozzle determines the motion, else 0. Order as `densities`. A single entry if forces and
    /// integration are one pass.
    pub accelerations: Buffer<Vec4>,
    /// Normals for surface tension; order as `densities`. A single entry without surface tension.
    pub normals: Buffer<Vec4>,
    /// Their means over the neighbours; order as `densities`. A single entry without the continuum surface force.
    pub smooth_normals: Buffer<Vec4>,
    /// The matrices that correct kernel gradients, and the coefficients of the shifting: two vectors per particle, as
    /// `passes::continuity` describes. Order as `densities`. A single entry where the density is summed.
    pub corrections: Buffer<Vec4>,
    /// Shifting velocity in m/s, and density. Order and size as `corrections`, one vector per particle.
    pub shifts: Buffer<Vec4>,
    /// The contributions of bodies to the matrices, two vectors per particle. A single entry without bodies.
    pub boundary_matrices: Buffer<Vec4>,
    /// Lists of neighbours on a GPU, as `passes::neighbours` describes. A single entry on the CPU, where
    /// none are used, and where a buffer cannot hold a layer.
    pub neighbours: Buffer<UVec4>,
    /// The state of the implicit pressure; one entry.
    pub solve: Buffer<SolveState>,
    /// The sum of the gradients in 1/m, and the sum of their squares in 1/m^2: the diagonal of the implicit pressure. Order
    /// as `densities`. A single entry if the pressure is explicit, as all of the following.
    pub stiffness: Buffer<Vec4>,
    /// An iteration of the implicit pressure: its result in m^2/s^2, the previous direction, the change; and the relative
    /// excess of density of the present positions.
    pub iterates: Buffer<Vec4>,
    /// Velocity in m/s at the end of the step by all forces but the pressure; the fourth component is that of `accelerations`.
    pub free_velocities: Buffer<Vec4>,
    /// Velocity in m/s at the end of the step by the present pressure, and this pressure over the rest density in m^2/s^2;
    /// -1 where a nozzle determines the motion.
    pub predicted: Buffer<Vec4>,
    /// The gradient of the bodies' part of the density in 1/m, and its product with the velocity of the bodies in 1/s. A
    /// single entry without bodies.
    pub solid_gradients: Buffer<Vec4>,
    /// Sums over 64 particles: residual, squared change, relative excess of density, pressure times residual.
    pub residuals: Buffer<Vec4>,
    /// Sums over 64 particles: of the squared change of the velocity in m^2/s^2, by pressure or by all forces but
    /// viscosity; of the squared pressure over the rest density in m^4/s^4; of the squared velocity in m^2/s^2.
    pub impulses: Buffer<Vec4>,
    /// The state of the implicit viscosity; one entry.
    pub viscous: Buffer<ViscousState>,
    /// What a suspended step needs to continue; one entry.
    pub suspension: Buffer<Suspension>,
    /// The residual of the implicit viscosity in m/s, and one over the diagonal of its matrix; zero where a nozzle
    /// determines the motion. A single entry if the viscosity is explicit, as all of the following.
    pub viscous_residuals: Buffer<Vec4>,
    /// The product of the matrix with the preconditioned residual, in m/s.
    pub viscous_products: Buffer<Vec4>,
    /// The direction in which the velocities change, in m/s.
    pub viscous_directions: Buffer<Vec4>,
    /// The product of the matrix with this direction, in m/s.
    pub viscous_images: Buffer<Vec4>,
    /// The arrays of the carried quantities, row by row of their table: those above, and others.
    pub carried: Vec<CarriedArrays>,
    table: &'static [Carried],
}

impl Fields {
    /// Creates the buffers.
    ///
    /// # Errors
    /// As [`Executor::create`].
    pub fn new(executor: &mut Executor, params: &Params, extras: Extras) -> Result<Self, GpuError> {
        Self::with_table(executor, params, extras, CARRIED)
    }

    /// [`new`](Self::new) with another table of carried quantities, which begins with the rows of [`CARRIED`].
    ///
    /// # Errors
    /// As [`Executor::create`].
    pub fn with_table(
        executor: &mut Executor,
        params: &Params,
        extras: Extras,
        table: &'static [Carried],
    ) -> Result<Self, GpuError> {
        let n = params.particle_count as usize;
        let some = |needed: bool, entries: usize| if needed { entries } else { 1 };
        // The CPU has lists of another kind.
        let lists = if extras.implicit && executor.gpu().is_some() {
            let support_ratio = params.support_radius / params.particle_spacing;
            list_layers(support_ratio, n as u64, executor.largest_buffer()) as usize
        } else {
            0
        };
        let carried = CarriedArrays::create(executor, table, n)?;
        let [
            CarriedArrays {
                persistent: Array::Vec4(positions),
                sorted: Some(Array::Vec4(sorted_positions)),
                ..
            },
            CarriedArrays {
                persistent: Array::Vec4(velocities),
                sorted: Some(Array::Vec4(sorted_velocities)),
                ..
            },
            CarriedArrays { persistent: Array::Vec2(densities), .. },
            CarriedArrays { persistent: Array::U32(ids), sorted: Some(Array::U32(sorted_ids)), .. },
            ..,
        ] = carried[..]
        else {
            unreachable!("the table begins with the rows of CARRIED")
        };
        Ok(Self {
            params: executor.create_uniform("params", params)?,
            state: executor.create_small("state", &[StepState::zeroed()])?,
            frame_input: executor.create_from("frame_input", &StepState::frame_input(0.0, 0.0, 0.0))?,
            counters: executor.create_from("counters", &[0; StepCounters::WORDS])?,
            positions,
            velocities,
            ids,
            sorted_positions,
            sorted_velocities,
            sorted_ids,
            densities,
            accelerations: executor.create("accelerations", 1)?,
            normals: executor.create("normals", some(extras.normals, n))?,
            smooth_normals: executor.create("smooth_normals", some(extras.smooth_normals, n))?,
            corrections: executor.create("corrections", some(extras.corrections, 2 * n))?,
            shifts: executor.create("shifts", some(extras.corrections, n))?,
            boundary_matrices: executor.create("boundary_matrices", some(extras.boundary_matrices, 2 * n))?,
            neighbours: executor.create("neighbours", some(lists > 0, lists * n))?,
            solve: executor.create_small("solve", &[SolveState::new(true, 0.0, 1.0)])?,
            stiffness: executor.create("stiffness", some(extras.implicit, n))?,
            iterates: executor.create("iterates", some(extras.implicit, n))?,
            free_velocities: executor.create("free_velocities", some(extras.implicit, n))?,
            predicted: executor.create("predicted", some(extras.implicit, n))?,
            solid_gradients: executor.create("solid_gradients", some(extras.solid_gradients, n))?,
            residuals: executor.create("residuals", some(extras.implicit, n.div_ceil(64)))?,
            impulses: executor.create("impulses", some(extras.implicit, n.div_ceil(64)))?,
            viscous: executor.create_small("viscous", &[ViscousState::new(true)])?,
            suspension: executor.create_from("suspension", &[Suspension::zeroed()])?,
            viscous_residuals: executor.create("viscous_residuals", some(extras.viscous, n))?,
            viscous_products: executor.create("viscous_products", some(extras.viscous, n))?,
            viscous_directions: executor.create("viscous_directions", some(extras.viscous, n))?,
            viscous_images: executor.create("viscous_images", some(extras.viscous, n))?,
            carried,
            table,
        })
    }

    /// The table of the carried quantities.
    pub fn table(&self) -> &'static [Carried] {
        self.table
    }

    /// The buffers by name, for recordings.
    pub fn buffers(&self) -> BufferSet {
        // The names of the fields are compared with the labels in the table.
        let mut set = buffer_set!(self =>
            params, state, frame_input, counters, positions, velocities, ids, sorted_positions,
            sorted_velocities, sorted_ids, densities, accelerations, normals, smooth_normals, corrections, shifts,
            boundary_matrices, solve, stiffness, iterates, free_velocities, predicted, neighbours, solid_gradients, residuals, impulses,
            viscous, suspension, viscous_residuals, viscous_products, viscous_directions, viscous_images,
        );
        self.carried.iter().for_each(|arrays| arrays.add_to(&mut set));
        set
    }

    /// Resizes the buffer of accelerations to all particles; a fused step does not need it.
    ///
    /// # Errors
    /// As [`Executor::create`].
    pub fn make_accelerations(&mut self, executor: &mut Executor) -> Result<(), GpuError> {
        match self.positions.len() {
            n if n > self.accelerations.len() => executor.resize(&mut self.accelerations, n as usize),
            _ => Ok(()),
        }
    }
}
