//! The buffers of a simulation.

use bytemuck::Zeroable;
use glam::{Vec2, Vec4};
use splashdown_gpu::{Buffer, BufferSet, Executor, GpuError, buffer_set};

use super::{Params, StepCounters, StepState};

/// Every buffer that passes share, but for those of the sort. One entry per particle unless said otherwise.
#[derive(Clone, Copy, Debug)]
pub struct Fields {
    /// Constants; a uniform.
    pub params: Buffer<Params>,
    /// What changes from step to step; one.
    pub state: Buffer<StepState>,
    /// Length of the frame to begin, in seconds; one.
    pub duration: Buffer<f32>,
    /// Counters and maxima, [`StepCounters::WORDS`] words.
    pub counters: Buffer<u32>,
    /// Overlap of half-spaces; see [`boundary::wall_table`](crate::boundary::wall_table).
    pub wall_table: Buffer<Vec4>,
    /// Persistent: position in metres, and 0 or why the particle is dead.
    pub positions: Buffer<Vec4>,
    /// Persistent: velocity in m/s, and density in kg/m^3.
    pub velocities: Buffer<Vec4>,
    /// Persistent: number of the particle since the start.
    pub ids: Buffer<u32>,
    /// Sorted by cell: as `positions`.
    pub sorted_positions: Buffer<Vec4>,
    /// Sorted by cell: as `velocities`.
    pub sorted_velocities: Buffer<Vec4>,
    /// Sorted by cell: as `ids`, after a sort without a step. A step puts them straight to the persistent ones.
    pub sorted_ids: Buffer<u32>,
    /// Density in kg/m^3 and pressure in Pa, in the order of the last step's sort, which is that of the persistent arrays
    /// once the step is done.
    pub densities: Buffer<Vec2>,
    /// Acceleration in m/s^2; the fourth component is zero. Order as `densities`. One entry where forces and motion are
    /// one pass.
    pub accelerations: Buffer<Vec4>,
    /// Normals for surface tension; order as `densities`. One entry where there is none.
    pub normals: Buffer<Vec4>,
}

impl Fields {
    /// Makes the buffers; `wall_table` is the table of the [overlaps](crate::boundary::wall_table).
    ///
    /// # Errors
    /// As [`Executor::create`].
    pub fn new(
        executor: &mut Executor,
        params: &Params,
        wall_table: &[Vec4],
        normals: bool,
    ) -> Result<Self, GpuError> {
        let n = params.particle_count as usize;
        Ok(Self {
            params: executor.create_uniform("params", params)?,
            state: executor.create_small("state", &[StepState::zeroed()])?,
            duration: executor.create_from("duration", &[0.0])?,
            counters: executor.create_from("counters", &[0; StepCounters::WORDS])?,
            wall_table: executor.create_small("wall_table", wall_table)?,
            positions: executor.create("positions", n)?,
            velocities: executor.create("velocities", n)?,
            ids: executor.create("ids", n)?,
            sorted_positions: executor.create("sorted_positions", n)?,
            sorted_velocities: executor.create("sorted_velocities", n)?,
            sorted_ids: executor.create("sorted_ids", n)?,
            densities: executor.create("densities", n)?,
            accelerations: executor.create("accelerations", 1)?,
            normals: executor.create("normals", if normals { n } else { 1 })?,
        })
    }

    /// The buffers by name, for recordings.
    pub fn buffers(&self) -> BufferSet {
        buffer_set!(self =>
            params, state, duration, counters, wall_table, positions, velocities, ids, sorted_positions,
            sorted_velocities, sorted_ids, densities, accelerations, normals,
        )
    }

    /// Makes room for the accelerations, which a step in one pass less does without.
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
