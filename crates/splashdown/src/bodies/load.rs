//! Loads the bodies of a scene: meshes, solids, masses, and boundary particles.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use glam::{Mat3, Quat, Vec2, Vec3, Vec4};
use splashdown_io::{IoError, Mesh};

use super::BodyMesh;
use super::types::{Body, Contact};
use crate::boundary::{KernelPair, PlaneFraction, SolidDistance, closed_bounds};
use crate::models;
use crate::scene::{self, BoundaryKind, Hinge, MeshShape, MeshSource, Motion, Script, SolidContact, UpAxis};
use crate::solid::{self, Placed, Solid, SolidError, SolidKind, SolidSettings, Surroundings};
use crate::state::Params;

/// Why a mesh could not be used: of a body, an outlet, a sink or a piece of fluid.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BodyError {
    /// The file could not be read.
    #[error("{owner}: {source}")]
    File {
        /// What the mesh is for, such as `body "raft"`.
        owner: String,
        /// What is wrong with the file.
        source: IoError,
    },
    /// There is no built-in model of this name.
    #[error("{owner}: there is no model {model:?}; there are {}. A file name needs its extension", known())]
    NoModel {
        /// What the mesh is for.
        owner: String,
        /// The name given.
        model: String,
    },
    /// No solid can be made of the shape.
    #[error("{owner}: {source}")]
    Solid {
        /// What the mesh is for.
        owner: String,
        /// What is wrong with the shape.
        source: SolidError,
    },
    /// The size of the mesh is implausible in this domain.
    #[error("{owner} is {size:.4} m long, the domain is {domain:.4} m: {advice}")]
    Scale {
        /// What the mesh is for.
        owner: String,
        /// Its longest edge in m.
        size: f32,
        /// The domain's longest edge in m.
        domain: f32,
        /// Which scale to use.
        advice: String,
    },
    /// The mesh is open where a closed one is required.
    #[error(
        "{owner}: its mesh is open ({open_edges} open edges) and encloses no volume; close it, or export the object as a solid; for \
         fluid.mesh, shell = false fills it in spite of its holes"
    )]
    Open {
        /// What the mesh is for.
        owner: String,
        /// Number of edges with a single triangle.
        open_edges: u32,
    },
    /// This build does not support dynamic bodies.
    #[error(
        "{owner}: this build cannot compute dynamic bodies; build with the Cargo feature `rigid`, or make the body static or scripted"
    )]
    NoCollisions {
        /// What the mesh is for.
        owner: String,
    },
    /// The outlet is too small for a particle.
    #[error(
        "{owner}: the outline of its mesh across the direction is too small for particles of {spacing} m; the mesh's \
         origin must lie inside it: enlarge it, check up and rotation, or refine particle_spacing"
    )]
    Outline {
        /// What the mesh is for.
        owner: String,
        /// The particle spacing in m.
        spacing: f32,
    },
    /// An emitter may create fewer particles than it emits at once.
    #[error(
        "emitter {name:?}: max_particles = {most} is less than a layer of its outlet, {layer} particles, so that it would emit \
         nothing: raise max_particles, or make the outlet smaller"
    )]
    LessThanLayer {
        /// Name of the emitter.
        name: String,
        /// Its `max_particles`.
        most: u32,
        /// Particles of a layer.
        layer: u32,
    },
}

/// How messages name an object with a mesh, for example `body "raft" (raft.stl)`.
pub(crate) fn owner(kind: &str, name: &str, source: &MeshSource) -> String {
    match &source.shape {
        MeshShape::Model(_) => format!("{kind} {name:?}"),
        MeshShape::File(path) => {
            format!("{kind} {name:?} ({})", path.file_name().unwrap_or_default().to_string_lossy())
        }
    }
}

fn known() -> String {
    models::names().iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ")
}

/// A body ready for a device.
#[derive(Clone)]
pub struct LoadedBody {
    /// Its name.
    pub name: String,
    /// Its shape.
    pub solid: Solid,
    /// Its state at t = 0. The offsets into the maps are not set yet.
    pub state: Body,
    /// Boundary particles in the mesh's frame with their volumes in m^3; empty if the body uses a map.
    pub samples: Vec<Vec4>,
    /// Its script, if it is scripted.
    pub script: Option<Script>,
    /// Linear RGB.
    pub colour: Option<[f32; 3]>,
    /// Contact with other solids.
    pub contact: SolidContact,
    /// Density of a dynamic body in kg/m^3; 0 for other bodies.
    density: f32,
}

impl LoadedBody {
    /// Moves a scripted body to where its script is at the start of a simulation at this time in s.
    pub(crate) fn start_at(&mut self, time: f64) {
        if let Some(script) = &self.script {
            follow(&mut self.state, script, time);
        }
    }

    /// The mass of a dynamic body in kg; 1 for other bodies.
    pub fn mass(&self) -> f32 {
        if self.density > 0.0 { self.density * self.solid.mass.volume } else { 1.0 }
    }

    /// The position of the mesh's origin in m and the mesh's rotation, at t = 0.
    pub fn pose(&self) -> (Vec3, Quat) {
        let rotation = self.state.rotation();
        (self.state.position - rotation * self.state.center, rotation)
    }
}

/// Reads a mesh in metres, y up, in its own frame. `owner` names its purpose in messages.
///
/// # Errors
/// [`BodyError`] if the file cannot be read or the model does not exist.
pub fn mesh_of(owner: &str, source: &MeshSource) -> Result<Mesh, BodyError> {
    #[cfg(test)]
    crate::work::count("mesh read");
    let mut mesh = match &source.shape {
        MeshShape::Model(model) => models::build(model)
            .ok_or_else(|| BodyError::NoModel { owner: owner.into(), model: model.clone() })?,
        MeshShape::File(path) => splashdown_io::read_mesh(path)
            .map_err(|source| BodyError::File { owner: owner.into(), source })?,
    };
    for v in &mut mesh.vertices {
        let [x, y, z] = (Vec3::from(*v) * source.scale).to_array();
        *v = match source.up {
            UpAxis::Y => [x, y, z],
            UpAxis::Z => [x, z, -y],
            UpAxis::X => [-y, x, z],
        };
    }
    mesh.normals.clear();
    // Those of a frame of a run mean nothing for a solid.
    mesh.velocities.clear();
    Ok(mesh)
}

/// The shapes of a scene's bodies without their solids, for drawing.
///
/// # Errors
/// The first [`BodyError`] of reading.
pub fn body_meshes(scene: &scene::Scene) -> Result<Vec<BodyMesh>, BodyError> {
    let shape = |body: &scene::Body| {
        let mesh = mesh_of(&owner("body", &body.name, &body.mesh), &body.mesh)?;
        let mesh = Arc::new(solid::repair(&mesh, body.shell).0);
        Ok(BodyMesh { name: body.name.clone(), mesh, colour: body.colour })
    };
    scene.bodies.iter().map(shape).collect()
}

/// Builds the bodies of a scene from their meshes, which [`mesh_of`] has read in the order of the scene. `progress`
/// is called with what is computed, such as `distance field of "tug"`, and the completed part of it in [0, 1].
///
/// # Errors
/// The first [`BodyError`].
pub fn load(
    scene: &scene::Scene,
    meshes: Vec<Result<Mesh, BodyError>>,
    params: &Params,
    kernels: KernelPair,
    cache: Option<PathBuf>,
    progress: &(dyn Fn(&str, f32) + Sync),
) -> Result<Vec<LoadedBody>, BodyError> {
    let mut loaded: Vec<LoadedBody> = Vec::with_capacity(meshes.len());
    for (body, mesh) in scene.bodies.iter().zip(meshes) {
        let body = load_one(scene, body, mesh, params, kernels, &loaded, cache.clone(), progress)?;
        loaded.push(body);
    }
    Ok(loaded)
}

#[expect(clippy::too_many_arguments, reason = "the inputs of one body")]
fn load_one(
    scene: &scene::Scene,
    body: &scene::Body,
    mesh: Result<Mesh, BodyError>,
    params: &Params,
    kernels: KernelPair,
    earlier: &[LoadedBody],
    cache: Option<PathBuf>,
    progress: &(dyn Fn(&str, f32) + Sync),
) -> Result<LoadedBody, BodyError> {
    let owner = owner("body", &body.name, &body.mesh);
    if !cfg!(feature = "rigid") && matches!(body.motion, Motion::Dynamic { .. }) {
        return Err(BodyError::NoCollisions { owner });
    }
    let mesh = mesh?;
    check_scale(&owner, &body.mesh, &mesh, &scene.domain)?;
    let spacing = params.particle_spacing;
    let half_thickness = half_thickness(body, spacing);
    let region = reachable(body, &scene.domain, params.support_radius + half_thickness);
    let settings = SolidSettings {
        cell_size: cell_size(
            solid::within(solid::bounds(&mesh), region),
            spacing,
            params.support_radius,
            half_thickness,
        ),
        support_radius: params.support_radius,
        fraction: plane_fraction(params, kernels),
        half_thickness,
        shell: body.shell,
        region,
        cache,
    };
    let solid_error = |source| BodyError::Solid { owner: owner.clone(), source };
    let others = if body.motion == Motion::Static { static_solids(earlier) } else { Vec::new() };
    let surroundings = Surroundings {
        position: body.mesh.position,
        rotation: body.mesh.rotation,
        closed: closed_bounds(params.domain_min, params.domain_max, params.closed),
        others: others.clone(),
    };
    let surroundings = surroundings
        .within(solid::bounds(&mesh), params.support_radius + half_thickness)
        .filter(|_| body.motion == Motion::Static);
    let task = format!("distance field of {:?}", body.name);
    let complete = Mutex::new(0.0);
    let report = |part: f32| {
        let mut complete = complete.lock().unwrap_or_else(PoisonError::into_inner);
        *complete += part;
        // The parts add up to one with rounding errors.
        progress(&task, f32::min(*complete, 0.999));
    };
    let solid = Solid::build_within(&mesh, &settings, surroundings.as_ref(), &report).map_err(solid_error)?;
    if complete.into_inner().unwrap_or_else(PoisonError::into_inner) > 0.0 {
        progress(&task, 1.0);
    }
    let mut state = Body {
        position: body.mesh.position,
        orientation: Vec4::from(body.mesh.rotation),
        friction: body.friction,
        adhesion: body.adhesion,
        way: if body.boundary == BoundaryKind::Particles { Body::PARTICLES } else { Body::MAP },
        is_complete: u32::from(body.motion == Motion::Static && body.boundary == BoundaryKind::Map),
        ..bytemuck::Zeroable::zeroed()
    };
    let mut script = None;
    match &body.motion {
        Motion::Static => {}
        Motion::Scripted(written) => {
            state.kind = Body::SCRIPTED;
            follow(&mut state, written, 0.0);
            script = Some(written.clone());
        }
        Motion::Dynamic { density, velocity, angular_velocity, hinge } => {
            solid.require_volume().map_err(solid_error)?;
            let mass = solid.mass;
            state.kind = Body::DYNAMIC;
            state.center = mass.center;
            state.position += body.mesh.rotation * mass.center;
            state.inverse_mass = 1.0 / (density * mass.volume);
            let inertia = mass.inertia * *density;
            (state.inertia, state.inertia_products) = parts(inertia);
            (state.inverse_inertia, state.inverse_inertia_products) =
                parts(mass.inverse_inertia() / *density);
            (state.velocity, state.angular_velocity) = (*velocity, *angular_velocity);
            if let Some(hinge) = hinge {
                attach_hinge(&mut state, hinge, inertia);
            }
        }
    }
    let farthest = |x: &[f32; 3]| Vec3::from(*x).distance(state.center);
    state.reach = solid.mesh.vertices.iter().map(farthest).fold(0.0, f32::max);
    state.radius = state.reach + params.support_radius + settings.half_thickness + 4.0 * settings.cell_size;
    let samples = match body.boundary {
        BoundaryKind::Map => Vec::new(),
        BoundaryKind::Particles => {
            let mut samples = boundary_particles(&solid, params, kernels);
            for sample in &mut samples {
                let x = body.mesh.position + body.mesh.rotation * sample.truncate();
                // The part of its cell that lies in an earlier solid is counted there.
                sample.w *= others.iter().map(|other| other.open_part(x, spacing)).product::<f32>();
            }
            samples.retain(|sample| sample.w > 0.0);
            samples
        }
    };
    let density = if let Motion::Dynamic { density, .. } = body.motion { density } else { 0.0 };
    let (name, contact) = (body.name.clone(), body.contact);
    Ok(LoadedBody { name, solid, state, samples, script, colour: body.colour, contact, density })
}

/// Gives a body the pose and the velocities of its script at a time in s.
fn follow(state: &mut Body, script: &Script, time: f64) {
    let pose = script.pose(time);
    state.position = pose.position;
    state.orientation = Vec4::from(pose.orientation);
    (state.velocity, state.angular_velocity) = (pose.velocity, pose.angular_velocity);
}

/// The solids of the static bodies.
fn static_solids(bodies: &[LoadedBody]) -> Vec<Placed<'_>> {
    let is_static = |body: &&LoadedBody| body.state.kind == Body::STATIC;
    let placed = |body| {
        let (position, rotation) = LoadedBody::pose(body);
        Placed { solid: &body.solid, position, rotation }
    };
    bodies.iter().filter(is_static).map(placed).collect()
}

/// Attaches a dynamic body, with this inertia about its centre of mass, to a hinge: the body rotates about the point
/// of the hinge. Its inverse inertia is zero about all axes but the hinge's.
fn attach_hinge(state: &mut Body, hinge: &Hinge, inertia: Mat3) {
    let rotation = state.rotation();
    let arm = rotation.conjugate() * (state.position - hinge.point);
    let axis = rotation.conjugate() * hinge.axis;
    let mass = 1.0 / state.inverse_mass;
    let about_axis = axis.dot(inertia * axis) + mass * (arm.length_squared() - arm.dot(axis).powi(2));
    let along = Mat3::from_cols(axis * axis.x, axis * axis.y, axis * axis.z);
    state.center -= arm;
    state.position = hinge.point;
    state.moment = mass * arm;
    state.inverse_mass = 0.0;
    (state.inertia, state.inertia_products) = parts(along * about_axis);
    (state.inverse_inertia, state.inverse_inertia_products) = parts(along * about_axis.recip());
    state.velocity = Vec3::ZERO;
    state.angular_velocity = state.angular_velocity.dot(hinge.axis) * hinge.axis;
    if let Some(motor) = hinge.motor {
        state.motor = motor.speed * hinge.axis;
        state.motor_torque = motor.torque.unwrap_or(f32::MAX);
    }
}

/// The diagonal of a symmetric matrix, and its elements xy, xz, yz.
fn parts(m: Mat3) -> (Vec3, Vec3) {
    (Vec3::new(m.x_axis.x, m.y_axis.y, m.z_axis.z), Vec3::new(m.y_axis.x, m.z_axis.x, m.z_axis.y))
}

/// The size in bytes of the maps and contacts of a scene's bodies on a device. `extents` are the corners of their
/// meshes; a mesh that cannot be read has `None` and is not counted, because loading it fails later.
pub(crate) fn forecast(scene: &scene::Scene, extents: &[Option<(Vec3, Vec3)>], particles: u64) -> u64 {
    if scene.bodies.is_empty() {
        return 0;
    }
    let spacing = scene.fluid.particle_spacing;
    let support = scene.solver.support_radius(spacing);
    let maps: u64 = scene
        .bodies
        .iter()
        .zip(extents)
        .filter_map(|(body, extent)| {
            let half = half_thickness(body, spacing);
            Some((solid::within((*extent)?, reachable(body, &scene.domain, support + half)), half))
        })
        .map(|((low, high), half)| {
            let cell = cell_size((low, high), spacing, support, half);
            let nodes = ((high - low + 2.0 * (support + half + 2.0 * cell)) / cell).ceil() + 1.0;
            nodes.element_product() as u64 * size_of::<Vec2>() as u64
        })
        .sum();
    maps + particles * 2 * size_of::<Contact>() as u64
}

/// The box in the frame of a static body that fluid can reach, with a margin; `None` for a body that moves.
fn reachable(body: &scene::Body, domain: &scene::Domain, margin: f32) -> Option<(Vec3, Vec3)> {
    if body.motion != Motion::Static {
        return None;
    }
    let (low, high) = (0..8).fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), k| {
        let pick = |axis: usize| if k >> axis & 1 == 0 { domain.min[axis] } else { domain.max[axis] };
        let x = body.mesh.rotation.conjugate() * (Vec3::new(pick(0), pick(1), pick(2)) - body.mesh.position);
        (low.min(x), high.max(x))
    });
    Some((low - margin, high + margin))
}

/// The part of the kernel that a plane fills in the maps. With an implicit pressure it is the density of the lattice that would fill
/// the body.
fn plane_fraction(params: &Params, kernels: KernelPair) -> PlaneFraction {
    if params.is_implicit == 1 {
        PlaneFraction { kernels, stretch: params.solid_stretch, offset: params.solid_offset }
    } else {
        PlaneFraction::of(kernels)
    }
}

/// Half the thickness in m of an open mesh.
fn half_thickness(body: &scene::Body, spacing: f32) -> f32 {
    body.half_thickness.unwrap_or(0.5 * spacing)
}

/// The cell size of a body's grid: half a particle spacing, or more if the grid would exceed the limit of nodes.
pub(super) fn cell_size((low, high): (Vec3, Vec3), spacing: f32, support: f32, half_thickness: f32) -> f32 {
    const MOST_NODES: f32 = 6e6;
    let volume = |cell: f32| ((high - low + 2.0 * (support + half_thickness)) / cell + 4.0).element_product();
    let mut cell = 0.5 * spacing;
    while volume(cell) > MOST_NODES && cell.is_finite() {
        cell *= 1.1;
    }
    cell
}

/// Rejects a mesh that is more than 100 times as long as the domain, or less than a thousandth of it: its unit is
/// probably wrong.
pub(crate) fn check_scale(
    owner: &str,
    source: &MeshSource,
    mesh: &Mesh,
    domain: &scene::Domain,
) -> Result<(), BodyError> {
    let (low, high) = solid::bounds(mesh);
    let (size, domain) = ((high - low).max_element(), domain.size().max_element());
    let scale = source.scale.max_element();
    let advice = match size / domain {
        ratio if ratio > 100.0 && scale == 1.0 => {
            "its mesh is probably in millimetres; give it scale = \"mm\"".to_owned()
        }
        ratio if ratio > 100.0 => format!("give it a smaller scale, for example {}", 0.001 * scale),
        ratio if ratio > 0.0 && ratio < 0.001 && scale < 0.05 => {
            format!("its mesh is probably not in {}; take scale out", unit_word(scale))
        }
        ratio if ratio > 0.0 && ratio < 0.001 => {
            format!("give it a larger scale, for example {}", 1000.0 * scale)
        }
        _ => return Ok(()),
    };
    Err(BodyError::Scale { owner: owner.to_owned(), size, domain, advice })
}

/// The name of the unit that this scale converts to metres.
fn unit_word(scale: f32) -> String {
    let known = [(0.001, "millimetres"), (0.01, "centimetres"), (0.0254, "inches")];
    let word = known.iter().find(|(unit, _)| (scale / unit - 1.0).abs() < 1e-4);
    word.map_or_else(|| format!("units of {scale} m"), |(_, word)| (*word).to_owned())
}

/// Samples boundary particles half a spacing inside the surface (on the sheet of a shell) with volumes 1 / sum W
/// (Akinci et al. 2012). The volumes are scaled once, so that the density half a spacing outside the surface is that
/// of a plane wall.
fn boundary_particles(solid: &Solid, params: &Params, kernels: KernelPair) -> Vec<Vec4> {
    let (spacing, support) = (params.particle_spacing, params.support_radius);
    let shell = solid.kind == SolidKind::Shell;
    let depth = if shell { 0.0 } else { 0.5 * spacing };
    let places = solid.sample_surface(spacing, depth);
    let near = Neighbours::new(&places, support);
    let volumes: Vec<f32> =
        places.iter().map(|&x| 1.0 / near.sum(x, |r| kernels.w(r / support) / support.powi(3))).collect();
    let mut scale = 1.0;
    if !shell {
        // Their gradient is that of their sum, so they need no stretch.
        let offset = spacing * SolidDistance::of_density(kernels, support / spacing).offset;
        let wanted = kernels.density((0.5 * spacing + offset) / support).0;
        let (mut kernel_fraction, mut count) = (0.0f64, 0.0f64);
        for &x in &places {
            let e = 0.5 * solid.field.cell_size;
            let slope = |axis: Vec3| solid.field.distance(x + e * axis) - solid.field.distance(x - e * axis);
            let normal = Vec3::new(slope(Vec3::X), slope(Vec3::Y), slope(Vec3::Z)).normalize_or_zero();
            let outside = x + normal * (0.5 * spacing - solid.field.distance(x));
            kernel_fraction +=
                f64::from(near.weighted(outside, &volumes, |r| kernels.w(r / support) / support.powi(3)));
            count += 1.0;
        }
        if kernel_fraction > 0.0 {
            scale = (f64::from(wanted) * count / kernel_fraction) as f32;
        }
    }
    places.iter().zip(volumes).map(|(x, v)| x.extend(v * scale)).collect()
}

/// Points in a hash map of cells, for sums over neighbours during loading.
struct Neighbours<'a> {
    points: &'a [Vec3],
    cells: std::collections::HashMap<[i32; 3], Vec<u32>>,
    reach: f32,
}

impl<'a> Neighbours<'a> {
    fn new(points: &'a [Vec3], reach: f32) -> Self {
        let mut cells: std::collections::HashMap<_, Vec<u32>> = std::collections::HashMap::new();
        for (i, x) in points.iter().enumerate() {
            cells.entry((x / reach).floor().as_ivec3().to_array()).or_default().push(i as u32);
        }
        Self { points, cells, reach }
    }

    fn for_each(&self, x: Vec3, mut f: impl FnMut(usize, f32)) {
        let home = (x / self.reach).floor().as_ivec3();
        for k in 0..27 {
            let cell = home + glam::IVec3::new(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
            for &j in self.cells.get(&cell.to_array()).into_iter().flatten() {
                let r = x.distance(self.points[j as usize]);
                if r < self.reach {
                    f(j as usize, r);
                }
            }
        }
    }

    fn sum(&self, x: Vec3, w: impl Fn(f32) -> f32) -> f32 {
        let mut sum = 0.0;
        self.for_each(x, |_, r| sum += w(r));
        sum
    }

    fn weighted(&self, x: Vec3, weights: &[f32], w: impl Fn(f32) -> f32) -> f32 {
        let mut sum = 0.0;
        self.for_each(x, |j, r| sum += weights[j] * w(r));
        sum
    }
}
