//! How much memory a simulation takes, before it takes it.

use crate::SimulationError;
use crate::scene::{Derived, Scene, SurfaceTension};

/// Bytes per particle in the largest single buffer: a position is four floats.
const LARGEST_PER_PARTICLE: u64 = 16;
/// Bytes per particle in all buffers of [`Fields`](crate::Fields) and [`Cells`](crate::cells::Cells): two positions, two
/// velocities, two ids, density and pressure, acceleration, cell and rank, slot, order.
const PER_PARTICLE: u64 = 4 * 16 + 2 * 4 + 8 + 16 + 8 + 4 + 4;
/// Bytes per cell: its count and its start.
const PER_CELL: u64 = 8;

/// The largest number of particles whose buffers fit a device that binds at most this many bytes.
pub fn largest_particle_count(largest_buffer: u64) -> u64 {
    (largest_buffer / LARGEST_PER_PARTICLE).min(u64::from(u32::MAX) - 1)
}

/// Refuses what does not fit.
pub(crate) fn check(particles: u64, largest_buffer: u64) -> Result<(), SimulationError> {
    let allowed = largest_particle_count(largest_buffer);
    if particles > allowed {
        return Err(SimulationError::TooMany {
            what: "particles",
            given: particles,
            allowed,
            advice: "make fluid.particle_spacing larger, or use a device with larger buffers (`splashdown doctor`)".into(),
        });
    }
    Ok(())
}

/// Bytes in the simulation's buffers, without the surface.
pub fn memory_forecast(scene: &Scene) -> u64 {
    let derived = Derived::new(scene);
    let normals = if scene.solver.surface_tension == SurfaceTension::Akinci2013 { 16 } else { 0 };
    let (min, max) = (scene.domain.min, scene.domain.max);
    let cells =
        crate::cells::Grid::new(min, max, derived.support_radius).map_or(1 << 31, |grid| grid.cell_count);
    derived.particles * (PER_PARTICLE + normals) + u64::from(cells) * PER_CELL
}
