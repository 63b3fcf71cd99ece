//! Foam, spray and bubbles (Ihmsen, Akinci, Akinci & Teschner 2012, "Unified spray, foam and air
//! bubbles for particle-based fluids", The Visual Computer 28).
//!
//! *How it works.* Diffuse particles are generated where the fluid traps air or breaks (`normals`,
//! `potentials`, `count`, `emit`), are advected (`advect`), stay outside of bodies (`collide`), and
//! dissolve. The coupling is one-way: the fluid affects them and they do not affect the fluid. They are therefore computed after the
//! fluid and not in its steps: [`Simulation::advance_foam`](crate::Simulation::advance_foam)
//! advances them to the simulated time every few milliseconds or once per frame, at the cost of two
//! neighbour loops. A simulation without foam has no overhead.
//!
//! *Reproducibility.* Nothing depends on the order of invocations: active particles are compacted
//! in order, new ones are counted and appended by a scan, and random numbers are a hash of a
//! particle's id and the number of the update.
//!
//! *Scaling.* The potentials of the paper grow with the number of neighbours, and its limits are in
//! joules and sums of m/s for a scene of several metres. Here potentials do not depend on the
//! resolution, and their limits are fractions of the [reference
//! speed](crate::scene::Derived::reference_speed) of the scene: similar dam breaks of different
//! size produce similar foam.
//!
//! *Cost.* For a dam break of 28,000 particles over 1.5 s, with up to 18,000 diffuse particles, on
//! two cores: 2.9 % of the time of the steps, half of it for the potentials.
//!
//! *Why not* in the step: foam needs only one update per about 16 steps. *Why not* a ring buffer
//! that overwrites the oldest particles: old foam would vanish while recent spray remained. If the
//! pool is full, fewer particles are generated, evenly everywhere, and a warning is reported.

mod advect;
mod ambient;
mod begin;
mod collide;
mod compact;
mod count;
mod emit;
mod normals;
mod plan;
mod potentials;
mod types;

pub use types::DiffuseKind;
#[doc(hidden)]
pub use types::{Diffuse, FoamParams, FoamState};

use glam::Vec4;
use splashdown_gpu::bytemuck::Zeroable;
use splashdown_gpu::compact::Compact;
use splashdown_gpu::scan::Scan;
use splashdown_gpu::{Buffer, DispatchSize, Executor, GpuError, PassDesc, Recording, WgslModule, wgsl};
use splashdown_io::{Attribute, Particles};

use crate::bodies::Solids;
use crate::cells::{Cells, GRID, ROWS};
use crate::kernel;
use crate::scene::FoamSettings;
use crate::state::{Fields, PARAMS, Params, STATE};

/// The WGSL side of [`FoamParams`], [`FoamState`] and [`Diffuse`].
pub(crate) const FOAM: WgslModule = WgslModule { name: "sph/foam", source: include_str!("foam.wgsl") };
/// The velocity and the number of neighbours of the fluid at a point.
const AMBIENT: WgslModule = WgslModule { name: "sph/foam_ambient", source: include_str!("ambient.wgsl") };
/// Imports of the passes that evaluate the fluid at diffuse particles.
const AMBIENT_IMPORTS: &[WgslModule] = &[wgsl::INDEX, STATE, PARAMS, GRID, ROWS, kernel::WGSL, FOAM, AMBIENT];

/// Default capacity: diffuse particles per particle of the fluid.
const PER_PARTICLE: u64 = 4;
/// Largest default capacity.
const STANDARD_MOST: u64 = 1 << 22;
/// Bytes of a diffuse particle in the largest buffer.
const LARGEST_PER_DIFFUSE: u64 = size_of::<Diffuse>() as u64;
/// Shortest time between two updates within a frame, in seconds: too short to be visible, and many
/// steps of the fluid.
const INTERVAL: f32 = 0.004;
/// Number of neighbours inside the fluid in the setup of Ihmsen et al., to which their limits of 6
/// and 20 refer: a ball with a radius of two spacings.
const IHMSEN_NEIGHBOURS: f32 = 33.5;

/// The passes of this module.
#[doc(hidden)]
pub fn passes() -> Vec<&'static PassDesc> {
    vec![
        &begin::BEGIN,
        &normals::NORMALS,
        &potentials::POTENTIALS,
        &count::COUNT,
        &advect::ADVECT,
        &plan::PLAN,
        &compact::COMPACT,
        &emit::EMIT,
        &collide::COLLIDE,
    ]
}

impl FoamParams {
    /// The constants for the settings of a scene, the parameters of the fluid and a reference speed
    /// (m/s).
    pub fn new(settings: &FoamSettings, params: &Params, reference_speed: f32, capacity: u32) -> Self {
        let range = |[least, most]: [f32; 2], unit: f32| (least * unit, 1.0 / ((most - least) * unit));
        let (trapped_air_least, trapped_air_scale) = range(settings.trapped_air_limits, reference_speed);
        let (wave_crest_least, wave_crest_scale) = range(settings.wave_crest_limits, 1.0);
        let [slow, fast] = settings.speed_limits.map(|part| part * part);
        let (energy_least, energy_scale) = range([slow, fast], 0.5 * reference_speed * reference_speed);
        // Number of neighbours inside the fluid.
        let ratio = params.support_radius / params.particle_spacing;
        let full = 4.0 / 3.0 * std::f32::consts::PI * ratio.powi(3);
        Self {
            capacity,
            interval: INTERVAL,
            trapped_air: settings.trapped_air,
            wave_crest: settings.wave_crest,
            trapped_air_least,
            trapped_air_scale,
            wave_crest_least,
            wave_crest_scale,
            energy_least,
            energy_scale,
            lifetime_least: settings.lifetime[0],
            lifetime_range: settings.lifetime[1] - settings.lifetime[0],
            buoyancy: settings.buoyancy,
            drag: settings.drag,
            spray_below: 6.0 / IHMSEN_NEIGHBOURS * full,
            bubble_above: 20.0 / IHMSEN_NEIGHBOURS * full,
            bubble_again_above: 24.0 / IHMSEN_NEIGHBOURS * full,
        }
    }
}

/// The requested number of diffuse particles exceeds the largest buffer of the device.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TooMuchFoam {
    pub given: u64,
    pub allowed: u64,
}

/// The capacity of a scene in diffuse particles.
pub(crate) fn capacity(settings: &FoamSettings, particles: u64, largest: u64) -> Result<u32, TooMuchFoam> {
    let allowed = (largest / LARGEST_PER_DIFFUSE).min(1 << 30);
    match settings.max_particles {
        Some(given) if u64::from(given) > allowed => Err(TooMuchFoam { given: given.into(), allowed }),
        Some(given) => Ok(given.max(1)),
        None => Ok((PER_PARTICLE * particles).clamp(1, STANDARD_MOST).min(allowed) as u32),
    }
}

/// Bytes in the foam buffers of a scene.
pub(crate) fn forecast(settings: &FoamSettings, particles: u64) -> u64 {
    let most = capacity(settings, particles, u64::MAX).map_or(0, u64::from);
    // The pool and a copy, flags of active particles, their scan and list; normals, potentials,
    // counts, starts.
    most * (2 * LARGEST_PER_DIFFUSE + 3 * 4) + particles.saturating_mul(2 * 16 + 2 * 4)
}

/// The foam of a simulation, on its device.
#[derive(Debug)]
pub struct Foam {
    params: Buffer<FoamParams>,
    capacity: u32,
    state: Buffer<FoamState>,
    pool: Buffer<Diffuse>,
    potentials: Buffer<Vec4>,
    recording: Recording,
    has_warned: bool,
}

impl Foam {
    /// Creates the buffers and the list of passes. `particles`: largest number of particles of the
    /// fluid.
    pub(crate) fn new(
        executor: &mut Executor,
        constants: &FoamParams,
        fields: &Fields,
        cells: &Cells,
        solids: Option<Solids>,
        particles: u32,
    ) -> Result<Self, GpuError> {
        let (n, capacity) = (particles as usize, constants.capacity);
        let most = capacity as usize;
        let params = executor.create_uniform("foam", constants)?;
        let state = executor.create_from("foam_state", &[FoamState::zeroed()])?;
        let pool = executor.create("foam_pool", most)?;
        let moved = executor.create::<Diffuse>("foam_moved", most)?;
        let alive = executor.create::<u32>("foam_alive", most)?;
        let indices = executor.create::<u32>("foam_indices", most)?;
        let counted = executor.create::<u32>("foam_counted", 4)?;
        let groups = executor.create::<u32>("foam_groups", 3)?;
        let normals = executor.create::<Vec4>("foam_normals", n)?;
        let potentials = executor.create::<Vec4>("foam_potentials", n)?;
        let counts = executor.create::<u32>("foam_counts", n)?;
        let starts = executor.create::<u32>("foam_starts", n + 1)?;
        let compact = Compact::new(executor, capacity, 64)?;
        let scan = Scan::new(executor, particles)?;

        let mut buffers = fields.buffers().and(&cells.buffers());
        buffers.add("foam", params);
        buffers.add("foam_state", state);
        buffers.add("foam_pool", pool);
        buffers.add("foam_moved", moved);
        buffers.add("foam_alive", alive);
        buffers.add("foam_indices", indices);
        buffers.add("foam_counted", counted);
        buffers.add("foam_groups", groups);
        buffers.add("foam_normals", normals);
        buffers.add("foam_potentials", potentials);
        buffers.add("foam_counts", counts);
        buffers.add("foam_starts", starts);

        let one = DispatchSize::Groups(1);
        let all = DispatchSize::Items(particles);
        let diffuse = DispatchSize::indirect(groups);
        let mut r = Recording::new("foam");
        r.dispatch(&begin::BEGIN, one, &buffers);
        r.dispatch(&normals::NORMALS, all, &buffers);
        r.dispatch(&potentials::POTENTIALS, all, &buffers);
        r.clear(counts);
        r.dispatch(&count::COUNT, all, &buffers);
        scan.record(&mut r, counts, starts);
        r.clear(alive);
        r.dispatch(&advect::ADVECT, diffuse, &buffers);
        compact.record(&mut r, alive, indices, counted);
        r.dispatch(&plan::PLAN, one, &buffers);
        r.dispatch(&compact::COMPACT, diffuse, &buffers);
        r.dispatch(&emit::EMIT, all, &buffers);
        if let Some(solids) = solids {
            let buffers = buffers.and(&solids.buffers());
            r.dispatch(&collide::COLLIDE, DispatchSize::Items(capacity), &buffers);
        }
        Ok(Self { params, capacity, state, pool, potentials, recording: r, has_warned: false })
    }

    /// The passes of an update, which do nothing if no update is due.
    pub(crate) fn recording(&self) -> &Recording {
        &self.recording
    }

    /// Removes all diffuse particles and restarts at the next simulated time.
    ///
    /// # Errors
    /// If the device was lost.
    #[doc(hidden)]
    pub fn clear(&self, executor: &mut Executor) -> Result<(), GpuError> {
        executor.write(self.state, &[FoamState::zeroed()])
    }

    /// Largest number of diffuse particles.
    pub fn capacity(&self) -> u32 {
        self.capacity
    }

    /// The particles; the first [`FoamState::count`] are valid.
    #[doc(hidden)]
    pub fn pool(&self) -> Buffer<Diffuse> {
        self.pool
    }

    /// The state, with the number of particles.
    #[doc(hidden)]
    pub fn state(&self) -> Buffer<FoamState> {
        self.state
    }

    /// Trapped air (m/s), wave crest and energy (J/kg) of each particle of the fluid at the last
    /// update, in sorted order.
    #[doc(hidden)]
    pub fn potentials(&self) -> Buffer<Vec4> {
        self.potentials
    }

    /// The constants, a uniform buffer.
    #[doc(hidden)]
    pub fn params(&self) -> Buffer<FoamParams> {
        self.params
    }

    /// Restores whether the overflow of the pool has already been reported.
    pub(crate) fn restore_overflow(&mut self, state: &FoamState) {
        self.has_warned |= state.refused > 0;
    }

    /// Returns a warning when the pool has overflowed for the first time.
    pub(crate) fn overflow_warning(&mut self, state: &FoamState) -> Option<String> {
        (state.refused > 0 && !std::mem::replace(&mut self.has_warned, true)).then(|| {
            format!(
                "the pool of {} particles of foam, spray and bubbles is full; from now on fewer are generated. Raise \
                 foam.max_particles, or lower foam.trapped_air and foam.wave_crest",
                self.capacity
            )
        })
    }
}

/// The saved state of foam, for [checkpoints](crate::Checkpoint::set_foam).
#[derive(Clone, Debug, PartialEq)]
pub struct KeptFoam {
    pub(crate) state: FoamState,
    pub(crate) pool: Vec<Diffuse>,
}

/// The name of the attribute of diffuse particles in files: the remaining lifetime as foam in s.
pub const LIFETIME: &str = "lifetime";

/// The diffuse particles at one time, on the host; in order of age, the oldest first.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct DiffuseParticles {
    /// Consecutive numbers in the order of generation.
    pub ids: Vec<u32>,
    /// Positions in m.
    pub positions: Vec<[f32; 3]>,
    /// Velocities in m/s.
    pub velocities: Vec<[f32; 3]>,
    /// Kinds.
    pub kinds: Vec<DiffuseKind>,
    /// Remaining lifetimes as foam, in s.
    pub lifetimes: Vec<f32>,
}

impl DiffuseParticles {
    /// Unpacks the contents of a pool.
    #[doc(hidden)]
    pub fn new(pool: &[Diffuse]) -> Self {
        Self {
            ids: pool.iter().map(Diffuse::id).collect(),
            positions: pool.iter().map(|p| p.position.to_array()).collect(),
            velocities: pool.iter().map(|p| p.velocity.to_array()).collect(),
            kinds: pool.iter().map(Diffuse::kind).collect(),
            lifetimes: pool.iter().map(|p| p.lifetime).collect(),
        }
    }

    /// Number of particles.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// True if there are no particles.
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// The particles of a kind, with ids, positions, velocities and the attribute [`LIFETIME`].
    pub fn of_kind(&self, kind: DiffuseKind) -> Particles {
        let of_kind = || (0..self.len()).filter(|&i| self.kinds[i] == kind);
        let values = of_kind().map(|i| self.lifetimes[i]).collect();
        Particles::from_positions(of_kind().map(|i| self.positions[i]).collect())
            .with_ids(of_kind().map(|i| self.ids[i]).collect())
            .with_velocities(of_kind().map(|i| self.velocities[i]).collect())
            .with_attributes(vec![Attribute { name: LIFETIME.to_owned(), components: 1, values }])
    }

    /// The inverse of [`of_kind`](Self::of_kind), for particles that were read from files. Without ids they are numbered from
    /// 0, without velocities they rest, and without the attribute [`LIFETIME`] they do not fade.
    pub fn of_kinds(parts: &[(DiffuseKind, Particles)]) -> Self {
        let mut rows = Vec::new();
        for (kind, particles) in parts {
            let lifetimes = particles.attributes.iter().find(|attribute| attribute.name == LIFETIME);
            let lifetimes = lifetimes.map_or(&[][..], |attribute| &attribute.values);
            rows.extend(particles.positions.iter().enumerate().map(|(i, &position)| {
                let id = particles.ids.get(i).copied().unwrap_or(i as u32);
                let velocity = particles.velocities.get(i).copied().unwrap_or_default();
                (id, position, velocity, *kind, lifetimes.get(i).copied().unwrap_or(f32::MAX))
            }));
        }
        // The order of age, in which they are drawn.
        rows.sort_by_key(|row| row.0);
        Self {
            ids: rows.iter().map(|row| row.0).collect(),
            positions: rows.iter().map(|row| row.1).collect(),
            velocities: rows.iter().map(|row| row.2).collect(),
            kinds: rows.iter().map(|row| row.3).collect(),
            lifetimes: rows.iter().map(|row| row.4).collect(),
        }
    }

    /// Number of particles of a kind.
    pub fn count(&self, kind: DiffuseKind) -> usize {
        self.kinds.iter().filter(|&&other| other == kind).count()
    }
}
