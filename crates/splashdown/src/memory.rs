//! How much memory a simulation takes, before it takes it.

use crate::cells::Grid;
use crate::flow::LoadedFlow;
use crate::sample::{self, Inventory};
use crate::scene::{Scene, Sort, SurfaceTension};
use crate::surface::{self, SurfaceParams};
use crate::{SimulationError, bodies, foam};

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

/// Bytes in the buffers of a scene's simulation and, where the scene asks for them, of its surface and its foam. Particles inside bodies, which a
/// simulation leaves out, are counted: to know them takes loading the bodies ([`memory_forecast_of`]).
///
/// A splash with more surface than most makes the surface's buffers grow beyond this.
pub fn memory_forecast(scene: &Scene) -> u64 {
    forecast(scene, sample::count(scene))
}

/// As [`memory_forecast`], for a scene whose particles have been counted by [`sample::inventory`].
pub fn memory_forecast_of(scene: &Scene, inventory: &Inventory) -> u64 {
    forecast(scene, inventory.particles)
}

fn forecast(scene: &Scene, particles: u64) -> u64 {
    // A mesh that cannot be read is reported where the simulation starts.
    let flow = LoadedFlow::new(scene).unwrap_or_default();
    let particles = flow.capacity(particles, u64::MAX);
    let normals = if scene.solver.surface_tension == SurfaceTension::Akinci2013 { 16 } else { 0 };
    let pairs = if scene.solver.sort == Sort::Bitonic { 8 } else { 0 };
    let motion = particles
        .saturating_mul(PER_PARTICLE + normals + pairs)
        .saturating_add(bodies::forecast(scene, particles));
    // A domain of more cells than there can be is refused at the start.
    let Some(grid) = Grid::new(scene.domain.min, scene.domain.max, grid_reach(scene)) else {
        return motion.saturating_add(PER_CELL << 31);
    };
    let surface = if scene.surface.enabled {
        let params = SurfaceParams::of_scene(&scene.surface, scene.fluid.particle_spacing);
        let count = u32::try_from(particles).unwrap_or(u32::MAX);
        surface::forecast(&params, &grid, count).unwrap_or(0)
    } else {
        0
    };
    let foam = if scene.foam.enabled { foam::forecast(&scene.foam, particles) } else { 0 };
    motion.saturating_add(u64::from(grid.cell_count) * PER_CELL).saturating_add(surface).saturating_add(foam)
}

/// What a cell of the grid must span, in metres: one grid serves the motion and the surface.
pub(crate) fn grid_reach(scene: &Scene) -> f32 {
    let spacing = scene.fluid.particle_spacing;
    scene.solver.support_radius(spacing).max(scene.surface.support_ratio * spacing)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Derived, SurfaceSettings};
    use crate::{Device, Simulation};

    #[test]
    fn the_forecast_is_what_the_buffers_take() {
        for (name, text) in crate::scene::presets() {
            let mut scene = Scene::parse(text, name).unwrap();
            if Derived::new(&scene).particles > 20_000 {
                continue;
            }
            for (smoothing_iterations, sort) in [(0, Sort::Counting), (5, Sort::Bitonic)] {
                scene.surface.smoothing_iterations = smoothing_iterations;
                scene.solver.sort = sort;
                // Without what the bodies displace, which the simulation leaves out.
                let inventory = sample::inventory(&scene).unwrap();
                let forecast = memory_forecast_of(&scene, &inventory);
                assert!(memory_forecast(&scene) >= forecast, "{name}");
                let mut simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
                let without_surface = simulation.memory();
                simulation.surface(&scene.surface).unwrap();
                let taken = simulation.memory();
                // Tables and uniforms of fixed size, and the sums of the scans' blocks, are left out: some tens of kB.
                let difference = taken.abs_diff(forecast);
                // Whether a mesh is a sheet, whose grid is a little larger, is known only when it has been looked at.
                let part = if scene.bodies.is_empty() { 100 } else { 25 };
                assert!(difference < taken / part + 50_000, "{name}: {forecast} forecast, {taken} taken");
                // Controls: the surface matters (beside maps of bodies less so), and a scene without one takes what the motion takes.
                assert!(
                    without_surface < forecast / 2 || !scene.bodies.is_empty(),
                    "{name}: {without_surface} of {forecast}"
                );
                let bare = Scene {
                    surface: SurfaceSettings { enabled: false, ..scene.surface.clone() },
                    ..scene.clone()
                };
                assert!(
                    memory_forecast_of(&bare, &inventory).abs_diff(without_surface)
                        < without_surface / part + 50_000,
                    "{name}"
                );
            }
        }
    }
}
