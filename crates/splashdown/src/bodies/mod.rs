//! Bodies in the fluid: meshes that are static, scripted or dynamic.
//!
//! *How it works.* The solid of a body ([`crate::solid`]) is a grid of distances in the frame of its mesh. Every step
//! runs its passes on the device, without the host. `boundary_lookup` finds the bodies near each particle and the
//! distances to them. `boundary_matrix` computes what they contribute to corrected gradients, where the density is
//! integrated. `boundary_density` adds their contribution to the density. `boundary_force` adds their forces and sums
//! the reactions. `motion` moves the bodies. Between batches of steps the host resolves collisions of bodies with one
//! another and with the domain (`rigid`).

mod boundary_density;
mod boundary_force;
mod boundary_lookup;
mod boundary_matrix;
mod closed;
mod coupling;
mod field;
mod key;
mod load;
mod motion;
mod pressure_force;
mod pressure_reaction;
mod pressure_response;
mod reaction;
#[cfg(feature = "rigid")]
mod rigid;
#[cfg(not(feature = "rigid"))]
#[path = "no_rigid.rs"]
mod rigid;
mod scripted;
mod solid_gradient;
mod solid_velocity;
mod stable_step;
mod support;
mod types;
mod viscous;

pub(crate) use closed::{closed_solid, solid_of};
pub(crate) use field::{MAP, nearest, penetration};
pub(crate) use key::{BodiesChanged, BodyKey};
pub(crate) use load::forecast;
pub use load::{BodyError, LoadedBody, body_meshes, load, mesh_of};
pub(crate) use load::{check_scale, owner};
pub use types::{Body, Contact, SCRIPT_SAMPLES, SUM_WORDS, ScriptSample, WGSL as BODY};

use std::sync::Arc;

use glam::{Quat, UVec3, Vec2, Vec3, Vec4};
use splashdown_gpu::{Buffer, BufferSet, Executor, GpuError, PassDesc, buffer_set};
use splashdown_io::{Mesh, Particles};

use crate::boundary::KernelPair;
use crate::scene::Domain;
use crate::solid::{DistanceField, RepairReport};
use crate::state::Params;
use rigid::Rigid;
use scripted::ScriptedMotion;
use types::{SUPPORTS, Support};

/// Numbers per body in a checkpoint: five vectors, a quaternion and the work.
const MOTION_COLUMNS: usize = 20;

/// The bodies of a simulation, for passes outside of its steps.
#[derive(Clone, Copy, Debug)]
pub struct Solids {
    /// Their states.
    pub bodies: Buffer<Body>,
    /// Their maps.
    pub maps: Buffer<Vec2>,
}

impl Solids {
    /// The buffers by name, for recordings.
    pub(crate) fn buffers(&self) -> BufferSet {
        buffer_set!(self => bodies, maps)
    }
}

/// The shape of a body.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct BodyMesh {
    /// The body's name in the scene.
    pub name: String,
    /// Its repaired triangles in m, in the mesh's own frame: rotate and move them by [`BodyState`].
    pub mesh: Arc<Mesh>,
    /// Linear RGB in [0, 1], if the scene gives one.
    pub colour: Option<[f32; 3]>,
}

/// The position and velocity of a body, and the force of the fluid on it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct BodyState {
    /// Position of the mesh's origin in m.
    pub position: Vec3,
    /// The mesh's rotation.
    pub orientation: Quat,
    /// Velocity of the mesh's origin in m/s.
    pub velocity: Vec3,
    /// Angular velocity in rad/s.
    pub angular_velocity: Vec3,
    /// Force of the fluid in the last step, in N.
    pub force: Vec3,
    /// Its torque in N m about the centre of mass of a dynamic body, the hinge of a hinged one, and else the origin of the mesh.
    pub torque: Vec3,
    /// The work of the body on the fluid since the start, in J.
    pub work: f32,
}

impl BodyState {
    /// The names with units of the columns of a table of states; the first is the time.
    pub const COLUMNS: [&'static str; 20] = [
        "time (s)",
        "position x (m)",
        "position y (m)",
        "position z (m)",
        "orientation x",
        "orientation y",
        "orientation z",
        "orientation w",
        "velocity x (m/s)",
        "velocity y (m/s)",
        "velocity z (m/s)",
        "angular velocity x (rad/s)",
        "angular velocity y (rad/s)",
        "angular velocity z (rad/s)",
        "force x (N)",
        "force y (N)",
        "force z (N)",
        "torque x (N m)",
        "torque y (N m)",
        "torque z (N m)",
    ];

    /// A body at rest without forces, with its mesh's origin at a position in m.
    pub fn at(position: Vec3, orientation: Quat) -> Self {
        let [velocity, angular_velocity, force, torque] = [Vec3::ZERO; 4];
        Self { position, orientation, velocity, angular_velocity, force, torque, work: 0.0 }
    }

    /// Transforms a point in m from the mesh's frame into the world.
    pub fn world(&self, y: Vec3) -> Vec3 {
        self.position + self.orientation * y
    }
}

/// Bytes per particle of the contacts, of which each particle has two.
pub(crate) const CONTACT_BYTES: u64 = 2 * size_of::<Contact>() as u64;

/// The passes of this module.
pub fn passes() -> Vec<&'static PassDesc> {
    [
        &boundary_lookup::WENDLAND_C2,
        &boundary_lookup::WENDLAND_BLEND,
        &boundary_lookup::CUBIC_SPLINE,
        &boundary_lookup::MUELLER,
        &boundary_density::SUMMATION,
        &boundary_density::CONTINUITY,
        &boundary_matrix::BOUNDARY_MATRIX,
        &boundary_force::ALL,
        &boundary_force::CORRECTED,
        &boundary_force::PRESSURE,
        &boundary_force::OTHER,
        &motion::MOTION,
        &solid_gradient::SOLID_GRADIENT,
        &pressure_reaction::PRESSURE_REACTION,
        &pressure_response::PRESSURE_RESPONSE,
        &solid_velocity::SOLID_VELOCITY,
        &pressure_force::PRESSURE_FORCE,
    ]
    .into_iter()
    .chain(viscous::passes())
    .collect()
}

/// The bodies of a simulation, on its device and on the host.
pub struct Bodies {
    kernels: KernelPair,
    /// The states of the bodies, one per body.
    pub bodies: Buffer<Body>,
    /// Distances, effective distances and boundary particles of all bodies.
    pub maps: Buffer<Vec2>,
    /// The contacts of particles with bodies, two per particle.
    pub contacts: Buffer<Contact>,
    /// The reactions to the boundary forces, [`SUM_WORDS`] words per body.
    pub sums: Buffer<u32>,
    /// The forces of the present implicit pressure, as `sums`.
    pub pressure_sums: Buffer<u32>,
    /// The velocity and the angular velocity of each body by the present implicit pressure, two vectors per body.
    pub responses: Buffer<Vec4>,
    /// The contacts that support the bodies, eight per body.
    pub supports: Buffer<Support>,
    /// The unknowns of the implicit viscosity, ten vectors per body.
    pub unknowns: Buffer<Vec4>,
    /// True if forces move a body.
    has_dynamic: bool,
    /// The largest [mobility](stable_step::mobility) of a body in m^2/kg.
    mobility: f32,
    scripts: Buffer<ScriptSample>,
    /// One per scripted body.
    scripted: Vec<ScriptedMotion>,
    meshes: Vec<BodyMesh>,
    reports: Vec<RepairReport>,
    /// The distance fields, for counting particles inside bodies on the host.
    fields: Vec<DistanceField>,
    rigid: Option<Rigid>,
    /// Whether contacts hold bodies in the pressure solve.
    holds: bool,
    /// Whether the device has such contacts.
    are_supported: bool,
}

impl Bodies {
    /// Creates the buffers of the bodies on a device.
    ///
    /// # Errors
    /// As [`Executor::create`].
    pub fn new(
        executor: &mut Executor,
        loaded: Vec<LoadedBody>,
        params: &Params,
        kernels: KernelPair,
        domain: &Domain,
    ) -> Result<Self, GpuError> {
        let mut maps = Vec::new();
        let mut states = Vec::new();
        let mut scripted = Vec::new();
        for body in &loaded {
            let mut state = body.state;
            place_map(body, params, &mut state, &mut maps);
            state.coupling = state.coupling_of(area(&body.solid.mesh));
            if let Some(script) = &body.script {
                state.script = scripted.len() as u32;
                scripted.push(ScriptedMotion { script: script.clone(), reach: state.reach });
            }
            states.push(state);
        }
        let rigid = Rigid::new(&loaded, &states, domain);
        let mobility = largest_mobility(&loaded);
        let scripts = vec![bytemuck::Zeroable::zeroed(); scripted.len().max(1) * SCRIPT_SAMPLES];
        Ok(Self {
            kernels,
            bodies: executor.create_from("bodies", &states)?,
            maps: executor.create_from("maps", &maps)?,
            contacts: executor.create("contacts", 2 * params.particle_count.max(1) as usize)?,
            sums: executor.create_from("sums", &vec![0; SUM_WORDS * states.len()])?,
            pressure_sums: executor.create_from("pressure_sums", &vec![0; SUM_WORDS * states.len()])?,
            responses: executor.create("responses", 2 * states.len())?,
            supports: executor
                .create_from("supports", &vec![bytemuck::Zeroable::zeroed(); SUPPORTS * states.len()])?,
            unknowns: executor.create("unknowns", viscous::VECTORS * states.len())?,
            has_dynamic: states.iter().any(|state| state.kind == Body::DYNAMIC),
            mobility,
            scripts: executor.create_from("scripts", &scripts)?,
            scripted,
            meshes: loaded
                .iter()
                .map(|body| BodyMesh {
                    name: body.name.clone(),
                    mesh: Arc::new(body.solid.mesh.clone()),
                    colour: body.colour,
                })
                .collect(),
            reports: loaded.iter().map(|body| body.solid.report).collect(),
            fields: loaded.into_iter().map(|body| body.solid.field).collect(),
            rigid,
            holds: params.is_implicit == 1,
            are_supported: false,
        })
    }

    /// Samples the motion of the scripted bodies during a frame for the device. `start` and `duration` in seconds. Returns
    /// the largest speed in m/s of a point of a scripted body in the domain during the frame.
    ///
    /// # Errors
    /// If the device was lost.
    pub fn begin_frame(
        &self,
        executor: &mut Executor,
        start: f64,
        duration: f64,
        params: &Params,
    ) -> Result<f32, GpuError> {
        if self.scripted.is_empty() {
            return Ok(0.0);
        }
        let domain = (params.domain_min, params.domain_max);
        let mut fastest = 0.0_f32;
        let mut samples = Vec::with_capacity(self.scripted.len() * SCRIPT_SAMPLES);
        for motion in &self.scripted {
            let of_body = motion.sample(start, duration);
            fastest = fastest.max(motion.speed_in(&of_body, duration, domain));
            samples.extend(of_body);
        }
        executor.write(self.scripts, &samples)?;
        Ok(fastest)
    }

    /// The constants of a simulation with the limit of an explicit time step by the bodies.
    pub fn limit_step(&self, params: Params) -> Params {
        stable_step::limited(params, self.mobility)
    }

    /// True if bodies can collide, so that the host has to resolve collisions between batches of steps.
    pub fn collide(&self) -> bool {
        self.rigid.is_some()
    }

    /// Resolves the collisions of the last `seconds`. Returns the states if collisions have changed them.
    ///
    /// # Errors
    /// If the device was lost.
    pub async fn resolve_collisions(
        &mut self,
        executor: &mut Executor,
        seconds: f32,
    ) -> Result<Option<Vec<Body>>, GpuError> {
        let Some(rigid) = &mut self.rigid else { return Ok(None) };
        let mut states = executor.fetch(self.bodies).await?;
        let collided = rigid.resolve(&mut states, seconds);
        // An explicit pressure does not ask for the response of bodies.
        let supports = if self.holds { rigid.supports(&states) } else { Vec::new() };
        // Most bodies have none, most of the time.
        if self.are_supported || !supports.is_empty() {
            self.are_supported = !supports.is_empty();
            let none = bytemuck::Zeroable::zeroed();
            let all = if supports.is_empty() { vec![none; SUPPORTS * states.len()] } else { supports };
            executor.write(self.supports, &all)?;
        }
        if !collided {
            return Ok(None);
        }
        executor.write(self.bodies, &states)?;
        Ok(Some(states))
    }

    /// Sets the positions and velocities of bodies; `None` leaves a body unchanged.
    ///
    /// # Errors
    /// If the device was lost.
    pub async fn place(
        &mut self,
        executor: &mut Executor,
        states: &[Option<BodyState>],
    ) -> Result<(), GpuError> {
        let mut bodies = executor.fetch(self.bodies).await?;
        for (body, state) in bodies.iter_mut().zip(states) {
            if let Some(state) = state {
                let arm = state.orientation * body.center;
                body.position = state.position + arm;
                body.orientation = Vec4::from(state.orientation);
                body.velocity = state.velocity + state.angular_velocity.cross(arm);
                body.angular_velocity = state.angular_velocity;
            }
        }
        if let Some(rigid) = &mut self.rigid {
            rigid.place(&bodies);
        }
        executor.write(self.bodies, &bodies)
    }

    /// The fingerprints of the bodies, in the order of the scene.
    pub(crate) fn keys(&self) -> Vec<BodyKey> {
        self.meshes.iter().map(BodyKey::new).collect()
    }

    /// Returns an error if the meshes differ from those of a checkpoint.
    pub(crate) fn check_keys(&self, then: &[BodyKey]) -> Result<(), BodiesChanged> {
        let now = self.keys();
        match now.iter().zip(then).find(|(now, then)| now != then) {
            Some((now, then)) => Err(BodiesChanged::Mesh { now: now.clone(), then: then.clone() }),
            None if now.len() != then.len() => Err(BodiesChanged::Count { now: now.len(), then: then.len() }),
            None => Ok(()),
        }
    }

    /// Numbers per body in [`fetch_motion`](Self::fetch_motion).
    pub(crate) fn motion_columns(&self) -> usize {
        MOTION_COLUMNS
    }

    /// Position, velocity, angular velocity, force, torque, orientation and work of each body.
    pub(crate) async fn fetch_motion(&self, executor: &mut Executor) -> Result<Vec<f32>, GpuError> {
        let bodies = executor.fetch(self.bodies).await?;
        let vectors = |b: &Body| [b.position, b.velocity, b.angular_velocity, b.force, b.torque];
        let row = |b: &Body| {
            let motion = vectors(b).into_iter().flat_map(|v| v.to_array());
            motion.chain(b.orientation.to_array()).chain([b.work])
        };
        Ok(bodies.iter().flat_map(|b| row(b).collect::<Vec<f32>>()).collect())
    }

    /// The state of the collisions.
    pub(crate) fn collisions(&self) -> &Option<Rigid> {
        &self.rigid
    }

    /// Restores the results of [`fetch_motion`](Self::fetch_motion) and [`collisions`](Self::collisions).
    pub(crate) async fn restore(
        &mut self,
        executor: &mut Executor,
        motion: &[f32],
        collisions: Option<Rigid>,
    ) -> Result<(), GpuError> {
        let mut bodies = executor.fetch(self.bodies).await?;
        for (body, row) in bodies.iter_mut().zip(motion.chunks_exact(MOTION_COLUMNS)) {
            let vector = |k: usize| Vec3::from_slice(&row[3 * k..]);
            (body.position, body.velocity, body.angular_velocity) = (vector(0), vector(1), vector(2));
            (body.force, body.torque) = (vector(3), vector(4));
            body.orientation = Vec4::from_slice(&row[15..19]);
            body.work = row[19];
        }
        self.rigid = collisions;
        if let (Some(rigid), true) = (&self.rigid, self.holds) {
            let supports = rigid.supports(&bodies);
            self.are_supported = !supports.is_empty();
            if self.are_supported {
                executor.write(self.supports, &supports)?;
            }
        }
        executor.write(self.bodies, &bodies)
    }

    /// Pulls a dynamic body by one of its points: see [`Body::pull`].
    ///
    /// # Errors
    /// If the device was lost.
    pub async fn pull(
        &self,
        executor: &mut Executor,
        body: usize,
        anchor: Vec3,
        target: Vec3,
        rate: f32,
    ) -> Result<(), GpuError> {
        let mut bodies = executor.fetch(self.bodies).await?;
        if let Some(body) = bodies.get_mut(body).filter(|body| body.kind == Body::DYNAMIC) {
            body.pull(anchor, target, rate);
            executor.write(self.bodies, &bodies)?;
        }
        Ok(())
    }

    /// The meshes, in the order of the scene.
    pub fn meshes(&self) -> &[BodyMesh] {
        &self.meshes
    }

    /// The repairs of the meshes, in the order of the scene.
    pub fn reports(&self) -> &[RepairReport] {
        &self.reports
    }

    /// The states of the bodies, in the order of the scene.
    ///
    /// # Errors
    /// If the device was lost.
    pub async fn states(&self, executor: &mut Executor) -> Result<Vec<BodyState>, GpuError> {
        Ok(executor.fetch(self.bodies).await?.iter().map(state_of).collect())
    }

    /// The distance in m from a point to the surface of the nearest body, negative inside, and the name of the body.
    /// Computed on the host, on any thread.
    pub fn nearest<'a>(
        &'a self,
        states: &'a [BodyState],
    ) -> impl Fn(Vec3) -> Option<(f32, &'a str)> + Sync + 'a {
        // Not `self`: on a web page buffers stay on their thread.
        let (fields, meshes) = (&self.fields, &self.meshes);
        move |x| {
            let distances = fields.iter().zip(states).zip(meshes).map(|((field, state), mesh)| {
                (field.distance(state.orientation.conjugate() * (x - state.position)), mesh.name.as_str())
            });
            distances.min_by(|a, b| a.0.total_cmp(&b.0))
        }
    }

    /// The buffers that passes outside of the steps need.
    pub(crate) fn solids(&self) -> Solids {
        Solids { bodies: self.bodies, maps: self.maps }
    }

    /// The number of these particles that lie inside a body. Computed on the host.
    pub fn inside(&self, states: &[BodyState], particles: &Particles) -> u32 {
        let within = |x: Vec3| {
            self.fields.iter().zip(states).any(|(field, state)| {
                field.distance(state.orientation.conjugate() * (x - state.position)) < 0.0
            })
        };
        particles.positions.iter().filter(|&&x| within(x.into())).count() as u32
    }
}

/// The state of the origin of a body's mesh.
pub(crate) fn state_of(body: &Body) -> BodyState {
    let orientation = body.rotation();
    let arm = orientation * -body.center;
    BodyState {
        position: body.position + arm,
        orientation,
        velocity: body.velocity + body.angular_velocity.cross(arm),
        angular_velocity: body.angular_velocity,
        force: body.force,
        torque: body.torque,
        work: body.work,
    }
}

/// The area of a mesh in m^2.
fn area(mesh: &Mesh) -> f32 {
    let triangle = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|k| Vec3::from(mesh.vertices[k as usize]));
        0.5 * (b - a).cross(c - a).length()
    };
    mesh.triangles.iter().map(triangle).sum()
}

/// As [`Bodies::limit_step`], for bodies that are not on a device.
pub(crate) fn limit_step(params: Params, loaded: &[LoadedBody]) -> Params {
    stable_step::limited(params, largest_mobility(loaded))
}

fn largest_mobility(loaded: &[LoadedBody]) -> f32 {
    let mobility = |body: &LoadedBody| stable_step::mobility(&body.solid.mesh, &body.state);
    loaded.iter().map(mobility).fold(0.0, f32::max)
}

/// Appends the distances of a body and its boundary particles, if any.
fn place_map(body: &LoadedBody, params: &Params, state: &mut Body, maps: &mut Vec<Vec2>) {
    let field = &body.solid.field;
    state.first_node = maps.len() as u32;
    state.field_min = field.min;
    state.cell_size = field.cell_size;
    [state.nodes_x, state.nodes_y, state.nodes_z] = field.nodes;
    maps.extend_from_slice(&field.values);
    if body.samples.is_empty() {
        return;
    }
    let extent = (UVec3::from_array(field.nodes) - UVec3::ONE).as_vec3() * field.cell_size;
    let cells = (extent / params.support_radius).ceil().as_uvec3().max(UVec3::ONE);
    [state.samples_x, state.samples_y, state.samples_z] = cells.to_array();
    let cell_of = |x: Vec3| {
        let c = ((x - field.min) / params.support_radius).as_uvec3().min(cells - UVec3::ONE);
        (c.z * cells.y + c.y) * cells.x + c.x
    };
    let mut sorted: Vec<(u32, Vec4)> = body.samples.iter().map(|s| (cell_of(s.truncate()), *s)).collect();
    sorted.sort_by_key(|(cell, _)| *cell);
    state.first_sample_cell = maps.len() as u32;
    let count = (cells.x * cells.y * cells.z) as usize;
    // The boundary particles follow the cells: two entries each, starting at an even index.
    let first = (maps.len() + count).div_ceil(2);
    for cell in 0..count as u32 {
        let [begin, end] = [cell, cell + 1].map(|c| first + sorted.partition_point(|(s, _)| *s < c));
        maps.push(Vec2::new(f32::from_bits(begin as u32), f32::from_bits(end as u32)));
    }
    maps.resize(2 * first, Vec2::ZERO);
    for (_, s) in sorted {
        maps.extend([Vec2::new(s.x, s.y), Vec2::new(s.z, s.w)]);
    }
}
