//! Caches the files, meshes and particles of a scene, so that each is read or built once.
//!
//! *How it works.* A [`Built`] creates each part when it is first needed, and a scene carries its `Built` in a slot that
//! clones share. Scenes are plain values that callers may change. A `Built` therefore stores the sections that it was
//! built from, and [`Built::of`] replaces it if the scene differs in one of them. The particles and the meshes of bodies
//! take much memory: the simulation takes them out of the `Built`.

use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use glam::Vec3;
use splashdown_io::{Mesh, Particles};

use crate::bodies::{BodyError, mesh_of, owner};
use crate::flow::LoadedFlow;
use crate::sample::{self, SampleError, Sources};
use crate::scene::{Derived, Domain, Emitter, Fluid, MeshSource, Reach, Scene, Sink, lattice};
use crate::solid;

/// The files, meshes and particles of a scene. Each part is created on first use.
#[derive(Default)]
pub(crate) struct Built {
    inputs: Option<Inputs>,
    bodies: Mutex<BodyMeshes>,
    flow: OnceLock<Result<Arc<LoadedFlow>, BodyError>>,
    fluid: Mutex<FluidParts>,
}

/// The sections of a scene from which the parts are built.
#[derive(PartialEq)]
struct Inputs {
    domain: Domain,
    fluid: Fluid,
    bodies: Vec<(String, MeshSource)>,
    emitters: Vec<Emitter>,
    sinks: Vec<Sink>,
    gravity: Vec3,
    times: [f32; 2],
    support_ratio: f32,
}

/// The lower and the upper corner of each mesh in m, in its own frame; `None` for a mesh that cannot be read.
type Extents = Arc<[Option<(Vec3, Vec3)>]>;

/// The meshes of the bodies, in the order of the scene.
#[derive(Default)]
struct BodyMeshes {
    /// `None` after a simulation has taken them.
    meshes: Option<Vec<Result<Mesh, BodyError>>>,
    /// Lower and upper corners in m, in the meshes' own frames; `None` for a mesh that cannot be read.
    extents: Option<Extents>,
}

#[derive(Default)]
struct FluidParts {
    /// The meshes and files of the fluid; `None` after they have been turned into particles.
    sources: Option<Sources>,
    reaches: Option<Arc<[Reach]>>,
    /// `None` after a simulation has taken them.
    particles: Option<Particles>,
    count: Option<u64>,
}

impl Built {
    /// The `Built` of this scene. It is replaced by an empty one if the scene has changed.
    pub fn of(scene: &Scene) -> Arc<Self> {
        let inputs = Inputs::of(scene);
        if let Some(built) = scene.built.get::<Self>()
            && built.inputs.as_ref() == Some(&inputs)
        {
            return built;
        }
        let built = Arc::new(Self { inputs: Some(inputs), ..Self::default() });
        scene.built.set(Arc::clone(&built));
        built
    }

    /// Stores the results of checking a scene's files. `fluid` is given if the fluid has meshes or files.
    pub fn store(&self, meshes: Vec<Mesh>, flow: LoadedFlow, fluid: Option<(Particles, Vec<Reach>)>) {
        lock(&self.bodies).put(meshes.into_iter().map(Ok).collect());
        // Cannot fail: the cell is still empty because the scene has just been read.
        let _ = self.flow.set(Ok(Arc::new(flow)));
        if let Some((particles, reaches)) = fluid {
            let mut parts = lock(&self.fluid);
            parts.count = Some(particles.len() as u64);
            parts.reaches = Some(reaches.into());
            parts.particles = Some(particles);
        }
    }

    /// Takes the meshes of the bodies out; reads them again if they have been taken before.
    pub fn take_meshes(&self, scene: &Scene) -> Vec<Result<Mesh, BodyError>> {
        let mut bodies = lock(&self.bodies);
        let meshes = bodies.meshes.take();
        meshes.unwrap_or_else(|| {
            bodies.put(read_meshes(scene));
            bodies.meshes.take().unwrap_or_default()
        })
    }

    /// The corners of each body's mesh in its own frame in m; `None` for a mesh that cannot be read.
    pub fn extents(&self, scene: &Scene) -> Arc<[Option<(Vec3, Vec3)>]> {
        let mut bodies = lock(&self.bodies);
        if bodies.extents.is_none() {
            bodies.put(read_meshes(scene));
        }
        bodies.extents.clone().unwrap_or_default()
    }

    /// Emitters and sinks.
    ///
    /// # Errors
    /// [`BodyError`] of the meshes of outlets and sinks.
    pub fn flow(&self, scene: &Scene) -> Result<Arc<LoadedFlow>, BodyError> {
        self.flow.get_or_init(|| LoadedFlow::new(scene).map(Arc::new)).clone()
    }

    /// The particles that the emitters create until the scene's end: their number, and how many of them exist on average
    /// over the scene's time.
    ///
    /// # Errors
    /// As [`flow`](Self::flow).
    pub fn emitted(&self, scene: &Scene) -> Result<(u64, f64), BodyError> {
        Ok(self.flow(scene)?.forecast(scene.duration))
    }

    /// The extents and speeds of the meshes and files of the fluid; those that cannot be read are left out.
    pub fn reaches(&self, scene: &Scene) -> Arc<[Reach]> {
        let mut parts = lock(&self.fluid);
        if let Some(reaches) = &parts.reaches {
            return Arc::clone(reaches);
        }
        let sources = parts.sources.get_or_insert_with(|| Sources::read(&scene.fluid));
        let reaches: Arc<[Reach]> = sources.reaches(&scene.fluid).into();
        parts.reaches = Some(Arc::clone(&reaches));
        reaches
    }

    /// Takes the scene's particles at t = 0 out; creates them again if they have been taken before.
    ///
    /// # Errors
    /// As [`sample::particles`].
    pub fn take_particles(&self, scene: &Scene) -> Result<Particles, SampleError> {
        match lock(&self.fluid).take(scene)? {
            particles if particles.is_empty() && scene.emitters.is_empty() => {
                Err(SampleError::Empty { spacing: scene.fluid.particle_spacing })
            }
            particles => Ok(particles),
        }
    }

    /// The number of particles at the start. The particles of blocks are counted without storing them: the number is
    /// exact up to [`sample::MAX_PARTICLES`] and an estimate from the volumes above. Meshes are filled and files are
    /// read, and these particles are kept for the simulation. If a mesh or file cannot be used, only blocks are counted.
    pub fn count(&self, scene: &Scene) -> u64 {
        let fluid = &scene.fluid;
        let mut parts = lock(&self.fluid);
        if let Some(count) = parts.count {
            return count;
        }
        let of_blocks = lattice::count(&scene.domain, fluid);
        let count = if of_blocks > sample::MAX_PARTICLES || sample::has_blocks_only(fluid) {
            of_blocks
        } else {
            match parts.take(scene) {
                Ok(particles) => {
                    let count = particles.len() as u64;
                    parts.particles = Some(particles);
                    count
                }
                Err(SampleError::TooMany { count, .. }) => count,
                Err(_) => of_blocks,
            }
        };
        parts.count = Some(count);
        count
    }

    /// The derived quantities of the scene, given the number of particles at the start.
    pub fn derived(&self, scene: &Scene, particles: u64) -> Derived {
        // An invalid outlet is reported when the simulation starts.
        let emitted = self.emitted(scene).unwrap_or_default();
        Derived::of(scene, &self.reaches(scene)).with_particles(scene, particles, emitted)
    }

    /// Frees the parts that only the start of a simulation needs.
    pub fn release(&self) {
        lock(&self.bodies).meshes = None;
        let mut parts = lock(&self.fluid);
        (parts.sources, parts.particles) = (None, None);
    }
}

impl Inputs {
    fn of(scene: &Scene) -> Self {
        Self {
            domain: scene.domain.clone(),
            fluid: scene.fluid.clone(),
            bodies: scene.bodies.iter().map(|body| (body.name.clone(), body.mesh.clone())).collect(),
            emitters: scene.emitters.clone(),
            sinks: scene.sinks.clone(),
            gravity: scene.gravity,
            times: [scene.duration, scene.frame_rate],
            support_ratio: scene.solver.support_ratio,
        }
    }
}

impl BodyMeshes {
    fn put(&mut self, meshes: Vec<Result<Mesh, BodyError>>) {
        self.extents = Some(meshes.iter().map(|mesh| Some(solid::bounds(mesh.as_ref().ok()?))).collect());
        self.meshes = Some(meshes);
    }
}

impl FluidParts {
    fn take(&mut self, scene: &Scene) -> Result<Particles, SampleError> {
        if let Some(particles) = self.particles.take() {
            return Ok(particles);
        }
        let sources = self.sources.take().unwrap_or_else(|| Sources::read(&scene.fluid));
        if self.reaches.is_none() {
            self.reaches = Some(sources.reaches(&scene.fluid).into());
        }
        sample::fill(scene, sources)
    }
}

/// The number of a scene's particles at the start, including those inside bodies. This fills meshes and reads
/// files; a simulation of the same scene uses the results.
pub fn count(scene: &Scene) -> u64 {
    Built::of(scene).count(scene)
}

fn read_meshes(scene: &Scene) -> Vec<Result<Mesh, BodyError>> {
    scene.bodies.iter().map(|body| mesh_of(&owner("body", &body.name, &body.mesh), &body.mesh)).collect()
}

fn lock<T>(part: &Mutex<T>) -> MutexGuard<'_, T> {
    part.lock().unwrap_or_else(PoisonError::into_inner)
}
