//! Forecasts the memory of a simulation.

use glam::UVec4;

use crate::cells::Grid;
use crate::check::Built;
use crate::sample::{self, Inventory};
use crate::scene::{Scene, Sort};
use crate::schemes::Scheme;
use crate::state::{CARRIED, bytes_per_particle, list_layers};
use crate::surface::{self, SurfaceParams};
use crate::{SimulationError, bodies, foam};

/// Bytes per particle in the largest single buffer: a position is four floats, the correction of a gradient eight.
const POSITION: u64 = 16;
const CORRECTION_MATRIX: u64 = 32;
/// Bytes per particle in all buffers of [`Fields`](crate::state::Fields) and [`Cells`](crate::cells::Cells): the carried
/// quantities, a cell and an entry.
const PER_PARTICLE: u64 = bytes_per_particle(CARRIED) + 4 + 8;
/// Bytes per particle of buffers that only some scenes need: accelerations, normals, corrections of the gradients and
/// shifting velocities, contributions of bodies to the corrections, pairs of the bitonic sort.
const ACCELERATION: u64 = 16;
const NORMAL: u64 = 16;
const CORRECTION: u64 = 32 + 16;
const BOUNDARY_MATRIX: u64 = 32;
const PAIR: u64 = 8;
/// Of the implicit pressure: four vectors, a part of the sums of 64 particles, the carried pressure; and the gradient of
/// bodies.
const IMPLICIT: u64 = 4 * 16 + 8;
const SOLID_GRADIENT: u64 = 16;
/// Of the implicit viscosity: four vectors.
const VISCOUS: u64 = 4 * 16;
/// Bytes per cell: its count and its start.
const PER_CELL: u64 = 8;

/// The largest number of particles whose buffers fit a device that binds at most this many bytes, where the density is
/// summed.
pub fn largest_particle_count(largest_buffer: u64) -> u64 {
    count_in(largest_buffer, POSITION)
}

/// [`largest_particle_count`] for a scene.
pub(crate) fn largest_particle_count_of(scene: &Scene, largest_buffer: u64) -> u64 {
    count_in(largest_buffer, largest_per_particle(scene))
}

fn count_in(largest_buffer: u64, per_particle: u64) -> u64 {
    (largest_buffer / per_particle).min(u64::from(u32::MAX) - 1)
}

fn largest_per_particle(scene: &Scene) -> u64 {
    let motion = if Scheme::new(scene).extras(false).corrections { CORRECTION_MATRIX } else { POSITION };
    let contacts = if scene.bodies.is_empty() { 0 } else { bodies::CONTACT_BYTES };
    motion.max(contacts).max(surface::largest_per_particle(&scene.surface))
}

/// Checks that a device can hold a number of particles of a scene. The error contains the largest number and the smallest spacing
/// that fit. Every buffer is bound as a whole: buffers are not split, because each pass would then have to determine the
/// part that contains a neighbour.
///
/// # Errors
/// [`SimulationError::TooMany`].
pub fn check_particles(particles: u64, largest_buffer: u64, scene: &Scene) -> Result<(), SimulationError> {
    let allowed = largest_particle_count_of(scene, largest_buffer);
    if particles <= allowed {
        return Ok(());
    }
    let fitting = sample::fitting_spacing(scene.fluid.particle_spacing, particles, allowed);
    Err(SimulationError::TooMany {
        what: "particles",
        given: particles,
        allowed,
        advice: format!(
            "a buffer of this device holds {} MB, and a particle takes {} bytes of the largest. Use a fluid.particle_spacing of {fitting} m \
             or more, or a device with larger buffers (`splashdown doctor` lists them)",
            largest_buffer / 1_000_000,
            largest_per_particle(scene)
        ),
    })
}

/// The size in bytes of the buffers of a scene's simulation, and of its surface and foam if the scene enables them.
/// Particles inside bodies, which a simulation removes, are included, because finding them requires loading the bodies
/// ([`memory_forecast_of`]).
///
/// The buffers of an unusually large surface may exceed the forecast.
pub fn memory_forecast(scene: &Scene) -> u64 {
    forecast(scene, Built::of(scene).count(scene))
}

/// As [`memory_forecast`], for a scene whose particles have been counted by [`inventory`](crate::inventory).
pub fn memory_forecast_of(scene: &Scene, inventory: &Inventory) -> u64 {
    forecast(scene, inventory.particles)
}

/// The bytes that the search for neighbours takes in addition to [`memory_forecast`], for a number of particles. They depend on the
/// device: lists of neighbours for `dfsph`, and on a GPU the cells of divided cubes ([`Grid`]).
///
/// On the CPU, where `gpu_buffer` is `None`, a neighbour takes 8 bytes, and a sphere of the support radius contains 33
/// at a support ratio of two. An implicit viscosity has lists of its own. On a GPU, whose largest buffer has
/// `gpu_buffer` bytes, a neighbour takes 4 bytes, and the lists have room for more.
pub fn neighbour_search_forecast(scene: &Scene, particles: u64, gpu_buffer: Option<u64>) -> u64 {
    let extras = Scheme::new(scene).extras(false);
    // With those that emitters add.
    let particles = Built::of(scene).flow(scene).unwrap_or_default().capacity(particles, u64::MAX);
    let ratio = scene.solver.support_radius(scene.fluid.particle_spacing) / scene.fluid.particle_spacing;
    if let Some(largest) = gpu_buffer {
        let layers = if extras.implicit { list_layers(ratio, particles, largest) } else { 0 };
        let lists = particles.saturating_mul(size_of::<UVec4>() as u64 * layers);
        let count = u32::try_from(particles).unwrap_or(u32::MAX);
        let cells =
            grid_of(scene).map_or(0, |grid| grid.for_gpu(count, largest).cell_count - grid.cell_count);
        return lists.saturating_add(u64::from(cells) * PER_CELL);
    }
    let lists = u64::from(extras.implicit) + u64::from(extras.viscous);
    let neighbours = 4.0 / 3.0 * std::f32::consts::PI * ratio.powi(3);
    // The positions are kept to compare them, and with the pressures; the ends of the lists.
    lists.saturating_mul(particles).saturating_mul(8 * neighbours as u64 + 48)
}

fn forecast(scene: &Scene, particles: u64) -> u64 {
    // A mesh that cannot be read is reported when the simulation starts.
    let built = Built::of(scene);
    let particles = built.flow(scene).unwrap_or_default().capacity(particles, u64::MAX);
    let motion = particles.saturating_mul(per_particle(scene)).saturating_add(bodies::forecast(
        scene,
        &built.extents(scene),
        particles,
    ));
    // A domain with too many cells is an error when the simulation starts.
    let Some(grid) = grid_of(scene) else {
        return motion.saturating_add(PER_CELL << 31);
    };
    let surface = if scene.surface.enabled {
        let params = SurfaceParams::of_scene(
            &scene.surface,
            scene.fluid.particle_spacing,
            surface::Walls::of_domain(&scene.domain),
        );
        let count = u32::try_from(particles).unwrap_or(u32::MAX);
        surface::forecast(&params, &grid, count).unwrap_or(0)
    } else {
        0
    };
    let foam = if scene.foam.enabled { foam::forecast(&scene.foam, particles) } else { 0 };
    motion.saturating_add(u64::from(grid.cell_count) * PER_CELL).saturating_add(surface).saturating_add(foam)
}

/// Bytes per particle in the buffers of a scene's simulation, without those of its bodies.
fn per_particle(scene: &Scene) -> u64 {
    let is_plain = scene.bodies.is_empty()
        && scene.emitters.is_empty()
        && scene.sinks.is_empty()
        && scene.probes.is_empty()
        && Scheme::new(scene).is_fused();
    let some = |needed: bool, bytes: u64| if needed { bytes } else { 0 };
    let extras = Scheme::new(scene).extras(!scene.bodies.is_empty());
    PER_PARTICLE
        + some(!is_plain, ACCELERATION)
        + some(extras.normals, NORMAL)
        + some(extras.corrections, CORRECTION)
        + some(extras.boundary_matrices, BOUNDARY_MATRIX)
        + some(extras.implicit, IMPLICIT)
        + some(extras.solid_gradients, SOLID_GRADIENT)
        + some(extras.viscous, VISCOUS)
        + some(scene.solver.sort == Sort::Bitonic, PAIR)
}

/// The grid of a scene, whose cells are cubes; `None` if there are too many.
pub(crate) fn grid_of(scene: &Scene) -> Option<Grid> {
    Grid::new(scene.domain.min, scene.domain.max, grid_reach(scene))
}

/// The smallest size of a cube of the grid in metres: the simulation and the surface use the same grid.
fn grid_reach(scene: &Scene) -> f32 {
    let spacing = scene.fluid.particle_spacing;
    scene.solver.support_radius(spacing).max(scene.surface.support_ratio * spacing)
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use splashdown_gpu::{CpuExecutor, Executor};

    use super::*;
    use crate::cells::Cells;
    use crate::scene::{Derived, SurfaceKernels, SurfaceSettings};
    use crate::state::Params;
    use crate::state::{Extras, Fields};
    use crate::{Device, Simulation};

    /// The size in bytes of all buffers for this number of particles in one grid.
    fn in_arrays(particles: u32, extras: Extras, sort: Sort) -> u64 {
        let mut executor = Executor::from(CpuExecutor::new());
        let params = Params { particle_count: particles, ..bytemuck::Zeroable::zeroed() };
        let mut fields = Fields::new(&mut executor, &params, extras).unwrap();
        if extras.normals {
            fields.make_accelerations(&mut executor).unwrap();
        }
        let grid = Grid::new(Vec3::ZERO, Vec3::ONE, 0.1).unwrap();
        Cells::new(&mut executor, grid, particles, sort.into()).unwrap();
        executor.bytes()
    }

    #[test]
    fn the_search_on_a_gpu_takes_the_cells_of_divided_cubes() {
        let text = "[scene]\nname = \"box\"\nduration = 1.0\n[domain]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n[fluid]\n\
                    particle_spacing = 0.05\n[[fluid.block]]\nposition = [0, 0, 0]\nsize = [0.5, 0.5, 0.5]\n\
                    [solver]\nmethod = \"wcsph\"\n";
        let scene = Scene::parse(text, "box.toml").unwrap();
        let grid = grid_of(&scene).unwrap();
        let allocated = |grid| {
            let mut executor = Executor::from(CpuExecutor::new());
            let before = executor.bytes();
            let cells = Cells::new(&mut executor, grid, 1000, crate::cells::Sort::Counting).unwrap();
            let starts = cells.cell_start.len() + cells.cell_counts.len();
            assert!(executor.bytes() > before);
            4 * u64::from(starts)
        };
        let more = allocated(grid.for_gpu(1000, u64::MAX)) - allocated(grid);
        assert_eq!(neighbour_search_forecast(&scene, 1000, Some(u64::MAX)), more);
        assert_eq!(neighbour_search_forecast(&scene, 1000, None), 0, "the CPU sorts into cubes");
        assert!(more > 0);
    }

    #[test]
    fn with_all_optional_buffers_a_particle_takes_at_most_212_bytes() {
        let per_particle =
            |extras, sort| (in_arrays(3 << 16, extras, sort) - in_arrays(1 << 16, extras, sort)) / (2 << 16);
        let plain = per_particle(Extras::default(), Sort::Counting);
        assert_eq!(plain, 92);
        assert_eq!(plain, PER_PARTICLE);
        // With all optional buffers.
        let all = Extras { normals: true, corrections: true, boundary_matrices: true, ..Extras::default() };
        let most = per_particle(all, Sort::Bitonic);
        assert_eq!(most, PER_PARTICLE + ACCELERATION + NORMAL + CORRECTION + BOUNDARY_MATRIX + PAIR);
        assert!(most <= 212, "{most}");
    }

    #[test]
    fn the_forecast_matches_the_size_of_the_buffers() {
        for (name, text) in crate::scene::presets() {
            let mut scene = Scene::parse(text, name).unwrap();
            if Derived::new(&scene).particles > 20_000 {
                continue;
            }
            for (smoothing_iterations, sort, kernels) in [
                (0, Sort::Counting, SurfaceKernels::Isotropic),
                (5, Sort::Bitonic, SurfaceKernels::Anisotropic),
            ] {
                scene.surface.smoothing_iterations = smoothing_iterations;
                scene.surface.kernels = kernels;
                // The foam is not part of a simulation.
                scene.foam.enabled = false;
                scene.solver.sort = sort;
                // Without the particles inside bodies, which the simulation removes.
                let inventory = crate::inventory(&scene, &|_, _| {}).unwrap();
                let forecast = memory_forecast_of(&scene, &inventory);
                assert!(memory_forecast(&scene) >= forecast, "{name}");
                let mut simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
                let without_surface = simulation.memory();
                simulation.surface(&scene.surface).unwrap();
                let taken = simulation.memory();
                // Tables and uniforms of fixed size and the block sums of scans are not included: some tens of kB.
                let difference = taken.abs_diff(forecast);
                // The grid of an open mesh is slightly larger; whether a mesh is open is known only after loading.
                let part = if scene.bodies.is_empty() { 100 } else { 25 };
                assert!(difference < taken / part + 50_000, "{name}: {forecast} forecast, {taken} taken");
                // Controls: the surface is a large part (with maps of bodies a smaller one), and a scene without a
                // surface takes what the simulation takes.
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

    /// A block of this depth, in a domain of fixed size.
    fn block(spacing: f64, depth: f64) -> Scene {
        let text = format!(
            "[scene]\nname = \"block\"\nduration = 1.0\n[domain]\nmin = [0, 0, 0]\nmax = [3, 2, 2]\n\
             [fluid]\nparticle_spacing = {spacing}\n\
             [[fluid.block]]\nposition = [0, 0, 0]\nsize = [1, 1, {depth}]\n[solver]\nmethod = \"wcsph\"\n"
        );
        Scene::parse(&text, "block").unwrap()
    }

    /// The size in bytes of the buffers of a `wcsph` simulation, and its number of particles.
    fn taken(depth: f64) -> [f64; 2] {
        let simulation = Simulation::new(&block(1.0 / 16.0, depth), &Device::Cpu).unwrap();
        [simulation.memory() as f64, f64::from(simulation.stats().particles)]
    }

    #[test]
    fn a_particle_takes_at_most_160_bytes() {
        // The same domain twice, so that the cells cancel.
        let [less, more] = [taken(0.5), taken(1.0)];
        let each = (more[0] - less[0]) / (more[1] - less[1]);
        assert!((each / PER_PARTICLE as f64 - 1.0).abs() < 0.01, "{each} bytes");
        assert!(each <= 160.0, "{each} bytes");
    }

    fn dense(particle_spacing: f64, density: &str) -> Scene {
        let text = format!(
            "[scene]\nname = \"box\"\nduration = 1\n[domain]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n[fluid]\n\
             particle_spacing = {particle_spacing}\n[[fluid.block]]\nposition = [0, 0, 0]\nsize = [1, 0.5, 1]\n\
             [solver]\ndensity = \"{density}\"\n"
        );
        Scene::parse(&text, "box.toml").unwrap()
    }

    fn without_surface(scene: Scene) -> Scene {
        Scene { surface: SurfaceSettings { enabled: false, ..scene.surface.clone() }, ..scene }
    }

    #[test]
    fn ten_million_particles_fit_four_gibibytes() {
        let budget = 4 << 30;
        let scene = |spacing| without_surface(block(spacing, 2.0));
        let bound = |density, bytes| {
            check_particles(10_000_000, bytes, &without_surface(dense(0.00584, density))).is_ok()
        };
        let bare = scene(0.00584);
        assert!((10_000_000..10_200_000).contains(&Derived::new(&bare).particles));
        // The simulation without surface takes less than a third of the budget.
        assert!(memory_forecast(&bare) < budget / 3, "{}", memory_forecast(&bare));
        // Control: sixty million do not fit.
        assert!(memory_forecast(&scene(0.0032)) > budget);
        // Their largest buffer exceeds the size that every device supports.
        assert!(!bound("summation", 128 << 20) && bound("summation", 160_000_000));
        // A correction takes twice as much as a position, as does a droplet of the surface.
        assert!(!bound("continuity", 160_000_000) && bound("continuity", 320_000_000));
        assert!(check_particles(10_000_000, 160_000_000, &dense(0.00584, "summation")).is_err());
        assert!(check_particles(10_000_000, 320_000_000, &dense(0.00584, "summation")).is_ok());
    }

    #[test]
    fn the_reported_count_and_spacing_fit() {
        let scene = without_surface(dense(0.01, "summation"));
        let error = check_particles(20_000_000, 128 << 20, &scene).unwrap_err();
        assert!(matches!(error, SimulationError::TooMany { allowed: 8_388_608, .. }), "{error}");
        let text = error.to_string();
        assert!(text.contains("at most 8388608 fit") && text.contains("134 MB"), "{text}");
        let (_, rest) = text.split_once("particle_spacing of ").unwrap();
        let reported: f64 = rest.split(' ').next().unwrap().parse().unwrap();
        let fitting = 20e6 * (0.01 / reported).powi(3);
        assert!((7e6..8_388_608.0).contains(&fitting), "{reported} m gives {fitting}");
    }
}
