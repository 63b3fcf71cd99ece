//! Emitters and sinks: they add and remove fluid during a simulation.
//!
//! *How it works.* The buffers have room for the particles that the emitters create within the duration of the scene.
//! Particles not yet emitted are marked as such from the start, and the sort places them behind the active ones. The
//! nozzle of an emitter is a short pipe that ends at its outlet. At its back face layers of particles are created on a
//! lattice (`emission_schedule`, `emit`) and travel to the outlet like a piston (`inflow_constraint`), so that the fluid
//! leaves at rest density and at the given speed. The columns of a falling jet are staggered; otherwise gravity, which
//! stretches the jet, would separate it into discs. It leaves with a velocity towards its axis, with which it keeps its
//! density while it gets faster and thinner. A sink marks the particles inside it as removed (`sink`); their
//! places in the arrays are reused.

mod conflicts;
mod emission_schedule;
mod emit;
mod inflow_constraint;
pub mod outlet;
mod sink;
mod types;

pub use types::{EmissionSchedule, Nozzle, SinkShape};

use glam::{UVec3, Vec3, Vec4};
use splashdown_gpu::{Buffer, BufferSet, DispatchSize, Executor, GpuError, PassDesc, WgslModule, buffer_set};
use splashdown_io::Particles;

use crate::bodies::{BodyError, closed_solid, owner};
use crate::coupling::{Coupling, Stage, StepRecorder};
use crate::fingerprint::hash;
use crate::scene::outlet::Layer;
use crate::scene::{Emitter, Scene, Sink, SinkRegion};

/// The WGSL side of [`Nozzle`], [`SinkShape`] and [`EmissionSchedule`].
pub const FLOW: WgslModule = WgslModule { name: "sph/flow", source: include_str!("flow.wgsl") };

/// The largest number of nodes along an edge of the map of a sink's mesh.
const MOST_NODES: f32 = 128.0;

/// The passes of this module.
pub fn passes() -> Vec<&'static PassDesc> {
    vec![
        &emission_schedule::EMISSION_SCHEDULE,
        &emit::EMIT,
        &inflow_constraint::INFLOW_CONSTRAINT,
        &sink::SINK,
    ]
}

/// The emitters and sinks of a scene, before they are placed on a device.
#[derive(Clone, Debug, Default)]
pub struct LoadedFlow {
    nozzles: Vec<Nozzle>,
    names: Vec<String>,
    /// Points along the nozzle's `across`, `up` and `direction` in m.
    points: Vec<Vec4>,
    drains: Vec<SinkShape>,
    maps: Vec<f32>,
    expected: u64,
}

impl LoadedFlow {
    /// Loads the emitters and sinks of a scene.
    ///
    /// # Errors
    /// [`BodyError`] of the meshes of outlets and sinks.
    pub fn new(scene: &Scene) -> Result<Self, BodyError> {
        let mut loaded = Self::default();
        for emitter in &scene.emitters {
            loaded.add_emitter(emitter, scene)?;
        }
        for sink in &scene.sinks {
            loaded.add_sink(sink, scene)?;
        }
        Ok(loaded)
    }

    /// Adds an emitter of the scene; returns its layer, in m along the axes of its outlet.
    ///
    /// # Errors
    /// [`BodyError`] of the outlet's mesh.
    pub(crate) fn add_emitter(&mut self, emitter: &Emitter, scene: &Scene) -> Result<Layer, BodyError> {
        let duration = scene.duration.max(scene.frame_count() as f32 * scene.frame_duration());
        #[cfg(test)]
        crate::work::count("emitter built");
        let (mut nozzle, layer) = outlet::nozzle(emitter, scene)?;
        nozzle.first_point = self.points.len() as u32;
        self.expected = self.expected.saturating_add(outlet::expected(&nozzle, duration));
        let depth = outlet::stagger(nozzle.direction, scene.gravity, nozzle.interval);
        self.points.extend(outlet::staggered(&layer, depth));
        self.nozzles.push(nozzle);
        self.names.push(emitter.name.clone());
        Ok(layer)
    }

    /// Adds a sink of the scene.
    ///
    /// # Errors
    /// [`BodyError`] of the sink's mesh.
    pub(crate) fn add_sink(&mut self, sink: &Sink, scene: &Scene) -> Result<(), BodyError> {
        #[cfg(test)]
        crate::work::count("sink built");
        let shape = self.drain(sink, scene)?;
        self.drains.push(shape);
        Ok(())
    }

    /// Replaces the fluid inside the nozzles that emit from the start by their layers, which then continue without a jump.
    /// Returns whether there was any. In front of an inlet in a wall the fluid stays as it is: its lattice begins at the wall
    /// too, and layers that are relaxed against it would hold back the first ones that are emitted.
    pub(crate) fn fill_nozzles(&self, particles: &mut Particles, scene: &Scene) -> bool {
        let spacing = scene.fluid.particle_spacing;
        let before = particles.positions.len();
        let mut layers = Vec::new();
        let is_filled = |nozzle: &&Nozzle| nozzle.start <= 0.0 && !is_inlet_in_wall(nozzle, scene);
        for nozzle in self.nozzles.iter().filter(is_filled) {
            let holds = |x: &[f32; 3]| nozzle.holds(Vec3::from(*x), spacing);
            if !particles.positions.iter().any(holds) {
                continue;
            }
            let kept: Vec<bool> = particles.positions.iter().map(|x| !holds(x)).collect();
            let mut flags = kept.iter();
            particles.velocities.retain(|_| *flags.next().unwrap_or(&true));
            let mut flags = kept.iter();
            particles.positions.retain(|_| *flags.next().unwrap_or(&true));
            let points = &self.points[nozzle.first_point as usize..][..nozzle.points as usize];
            // The first layer is emitted at the back face in the first step.
            for layer in 1..=(nozzle.length / nozzle.interval) as u32 {
                for q in points {
                    let forward = (layer as f32 * nozzle.interval + q.z) * nozzle.direction;
                    let x = nozzle.back + forward + q.x * nozzle.across + q.y * nozzle.up;
                    if holds(&x.to_array()) {
                        layers.push((x.to_array(), (nozzle.speed * nozzle.direction).to_array()));
                    }
                }
            }
        }
        let is_changed = !layers.is_empty() || particles.positions.len() != before;
        for (x, v) in layers {
            particles.positions.push(x);
            particles.velocities.push(v);
        }
        if is_changed {
            particles.ids = (0..particles.positions.len() as u32).collect();
        }
        is_changed
    }

    /// The particles that the emitters create until `duration` (s): their number, and how many of them exist on average
    /// over that time, without obstacles and sinks.
    pub(crate) fn forecast(&self, duration: f32) -> (u64, f64) {
        let (mut all, mut average) = (0u64, 0.0);
        for nozzle in &self.nozzles {
            let emitted = outlet::expected(nozzle, duration);
            // The flow is steady from its start until its end, or until the largest number of particles is reached.
            let per_second = nozzle.points as f32 * nozzle.speed / nozzle.interval;
            let busy = (nozzle.end.min(duration) - nozzle.start).clamp(0.0, emitted as f32 / per_second);
            let present = (duration - nozzle.start - 0.5 * busy) / duration;
            all = all.saturating_add(emitted);
            average += emitted as f64 * f64::from(present.clamp(0.0, 1.0));
        }
        (all, average)
    }

    /// The particles that the emitters add to the fluid until `duration` (s), without those that a sink removes at once.
    pub(crate) fn planned(&self, duration: f32) -> u64 {
        let swallowed = self.swallowed();
        let counts = self.nozzles.iter().enumerate().map(|(k, nozzle)| {
            let is_swallowed = swallowed.iter().any(|[emitter, _]| *emitter == k);
            if is_swallowed { 0 } else { outlet::expected(nozzle, duration) }
        });
        counts.fold(0, u64::saturating_add)
    }

    /// A fingerprint of the emitters and sinks, by which a checkpoint identifies them.
    pub(crate) fn hash(&self) -> u64 {
        let parts = [
            hash(bytemuck::cast_slice(&self.nozzles)),
            hash(bytemuck::cast_slice(&self.points)),
            hash(bytemuck::cast_slice(&self.drains)),
            hash(bytemuck::cast_slice(&self.maps)),
        ];
        hash(bytemuck::cast_slice(&parts))
    }

    /// True if there are no emitters and no sinks.
    pub fn is_empty(&self) -> bool {
        self.nozzles.is_empty() && self.drains.is_empty()
    }

    /// The number of particles for which buffers need room, with `initial` particles at the start; at most `allowed`.
    pub fn capacity(&self, initial: u64, allowed: u64) -> u64 {
        initial.saturating_add(self.expected).min(allowed).max(initial)
    }

    fn drain(&mut self, sink: &Sink, scene: &Scene) -> Result<SinkShape, BodyError> {
        let none = SinkShape {
            low: Vec3::ZERO,
            kind: SinkShape::BOX,
            high: Vec3::ZERO,
            cell_size: 0.0,
            nodes: UVec3::ZERO,
            first_node: 0,
        };
        Ok(match &sink.region {
            SinkRegion::Box { min, max } => SinkShape { low: *min, high: *max, ..none },
            SinkRegion::Below { point, normal } => {
                SinkShape { kind: SinkShape::BELOW, low: *point, high: *normal, ..none }
            }
            SinkRegion::Mesh(source) => {
                let solid = {
                    let (owner, spacing) = (owner("sink", &sink.name, source), scene.fluid.particle_spacing);
                    closed_solid(&owner, source, &scene.domain, spacing)?
                };
                let world = |v: &[f32; 3]| source.position + source.rotation * Vec3::from(*v);
                let corners = solid.mesh.vertices.iter().map(world);
                let (low, high) =
                    corners.fold((Vec3::MAX, Vec3::MIN), |(low, high), x| (low.min(x), high.max(x)));
                let cell_size =
                    (0.5 * scene.fluid.particle_spacing).max((high - low).max_element() / MOST_NODES);
                let nodes = ((high - low) / cell_size).ceil().as_uvec3() + UVec3::ONE;
                let nodes = nodes.max(UVec3::splat(2));
                let first_node = self.maps.len() as u32;
                for k in 0..nodes.element_product() {
                    let node = UVec3::new(k % nodes.x, k / nodes.x % nodes.y, k / (nodes.x * nodes.y));
                    let x = low + node.as_vec3() * cell_size;
                    let local = source.rotation.conjugate() * (x - source.position);
                    self.maps.push(solid.field.distance(local));
                }
                SinkShape { kind: SinkShape::MAP, low, high, cell_size, nodes, first_node }
            }
        })
    }
}

/// Whether a nozzle begins at a closed side of the domain: its back face is half a spacing in front of it, to the quarter
/// of a spacing (`outlet::forward`).
fn is_inlet_in_wall(nozzle: &Nozzle, scene: &Scene) -> bool {
    let near = 0.8 * scene.fluid.particle_spacing;
    (0..3).any(|axis| {
        let [low, high] = scene.domain.closed[axis];
        let (at, along) = (nozzle.back[axis], nozzle.direction[axis]);
        low && along > 0.99 && (at - scene.domain.min[axis]).abs() < near
            || high && along < -0.99 && (at - scene.domain.max[axis]).abs() < near
    })
}

/// The counters of emitters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FlowCount {
    /// Particles created so far.
    pub emitted: u32,
    /// Particles not created because the buffers were full.
    pub refused: u32,
}

/// Emitters and sinks on a device.
#[derive(Debug)]
pub struct Flow {
    /// See [`LoadedFlow::hash`].
    hash: u64,
    nozzles: Option<Nozzles>,
    drains: Option<(Buffer<SinkShape>, Buffer<f32>)>,
}

#[derive(Debug)]
struct Nozzles {
    names: Vec<String>,
    nozzles: Buffer<Nozzle>,
    points: Buffer<Vec4>,
    schedules: Buffer<u32>,
    /// The emitters whose lack of room has been reported.
    reported: Vec<bool>,
}

impl Flow {
    /// Creates the buffers on a device. The first particle emitted gets the id `next_id`.
    ///
    /// # Errors
    /// As [`Executor::create`].
    pub fn new(executor: &mut Executor, loaded: &LoadedFlow, next_id: u32) -> Result<Self, GpuError> {
        let nozzles = if loaded.nozzles.is_empty() {
            None
        } else {
            // The first layer is due in the first step.
            let mut schedules = vec![0; loaded.nozzles.len() * EmissionSchedule::WORDS + 1];
            for (schedule, nozzle) in schedules.chunks_exact_mut(EmissionSchedule::WORDS).zip(&loaded.nozzles)
            {
                schedule[EmissionSchedule::PHASE] = nozzle.interval.to_bits();
            }
            schedules[loaded.nozzles.len() * EmissionSchedule::WORDS] = next_id;
            Some(Nozzles {
                names: loaded.names.clone(),
                nozzles: executor.create_from("nozzles", &loaded.nozzles)?,
                points: executor.create_from("points", &loaded.points)?,
                schedules: executor.create_from("schedules", &schedules)?,
                reported: vec![false; loaded.nozzles.len()],
            })
        };
        let drains = if loaded.drains.is_empty() {
            None
        } else {
            let maps = if loaded.maps.is_empty() { &[0.0][..] } else { &loaded.maps };
            Some((executor.create_from("drains", &loaded.drains)?, executor.create_from("drain_maps", maps)?))
        };
        Ok(Self { hash: loaded.hash(), nozzles, drains })
    }

    /// A fingerprint of the emitters and sinks, by which a checkpoint identifies them.
    pub(crate) fn hash(&self) -> u64 {
        self.hash
    }

    /// True if there are emitters.
    pub fn emits(&self) -> bool {
        self.nozzles.is_some()
    }

    /// The state of the emitters from step to step, if there are any.
    pub(crate) fn schedules(&self) -> Option<Buffer<u32>> {
        self.nozzles.as_ref().map(|nozzles| nozzles.schedules)
    }

    /// The emitters whose lack of room has been reported.
    pub(crate) fn reported(&self) -> &[bool] {
        self.nozzles.as_ref().map_or(&[], |nozzles| &nozzles.reported)
    }

    /// Sets the emitters whose lack of room has been reported.
    pub(crate) fn set_reported(&mut self, reported: &[bool]) {
        if let Some(nozzles) = &mut self.nozzles {
            for (present, &restored) in nozzles.reported.iter_mut().zip(reported) {
                *present = restored;
            }
        }
    }

    /// Appends the inflow constraint of the emitters, and the sinks.
    fn record_forces(&self, step: &mut StepRecorder<'_>) {
        if self.nozzles.is_some() {
            step.dispatch_particles(&inflow_constraint::INFLOW_CONSTRAINT);
        }
        if self.drains.is_some() {
            step.dispatch_particles(&sink::SINK);
        }
    }

    /// Appends the emission of particles into the persistent arrays.
    fn record_emission(&self, step: &mut StepRecorder<'_>) {
        let Some(nozzles) = &self.nozzles else { return };
        step.dispatch(&emission_schedule::EMISSION_SCHEDULE, DispatchSize::Groups(1));
        step.dispatch(&emit::EMIT, DispatchSize::Items(nozzles.points.len()));
    }

    /// The number of particles emitted so far, and a warning for each emitter that found no room for the first time.
    ///
    /// # Errors
    /// If the device was lost.
    pub async fn count(&mut self, executor: &mut Executor) -> Result<(FlowCount, Vec<String>), GpuError> {
        let mut count = FlowCount::default();
        let mut messages = Vec::new();
        let Some(nozzles) = &mut self.nozzles else { return Ok((count, messages)) };
        let schedules = executor.fetch(nozzles.schedules).await?;
        for (k, schedule) in schedules.chunks_exact(EmissionSchedule::WORDS).enumerate() {
            count.emitted += schedule[EmissionSchedule::EMITTED];
            count.refused += schedule[EmissionSchedule::REFUSED];
            if schedule[EmissionSchedule::REFUSED] > 0 && !std::mem::replace(&mut nozzles.reported[k], true) {
                messages.push(format!(
                    "emitter {:?} found no room for more after {} particles: the buffers are sized for the duration of \
                     the scene. Increase duration, or add a sink",
                    nozzles.names[k],
                    schedule[EmissionSchedule::EMITTED]
                ));
            }
        }
        Ok((count, messages))
    }
}

impl Coupling for Flow {
    fn stages(&self) -> &'static [Stage] {
        if self.emits() { &[Stage::ExternalForces, Stage::Emission] } else { &[Stage::ExternalForces] }
    }

    fn buffers(&self) -> BufferSet {
        let mut buffers = BufferSet::new();
        if let Some(emitters) = &self.nozzles {
            buffers.extend(&buffer_set!(emitters => nozzles, points, schedules));
        }
        if let Some((drains, drain_maps)) = self.drains {
            buffers.add("drains", drains);
            buffers.add("drain_maps", drain_maps);
        }
        buffers
    }

    fn record(&self, stage: Stage, step: &mut StepRecorder<'_>) {
        if stage == Stage::Emission { self.record_emission(step) } else { self.record_forces(step) }
    }
}
