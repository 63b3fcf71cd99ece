//! Checkpoints: a simulation in a file, from which it can be resumed.
//!
//! *Content.* All data that a step reads and that cannot be derived from the scene: the persistent arrays of the
//! particles, the state on the device, the counters, the bodies with the state of their collisions, the state of
//! emitters and probes, and the text of the scene. Data derived from the scene (grids, maps, constants) is computed
//! again. Fingerprints detect changes of the meshes that the scene names. On the CPU and on the same adapter, a resumed
//! simulation is bit-identical to an uninterrupted one.
//!
//! *The file* is a ZIP of NPY arrays ([`Archive`]), which `numpy.load` opens. `positions` (N, 4) in m, with a fourth
//! component of zero for active particles; `velocities` (N, 4) in m/s with the density in kg/m^3; `ids` (N,);
//! `scene.toml` with the scene; `about.json` with a description of the file.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use serde::{Deserialize, Serialize, de::DeserializeOwned};
use splashdown_io::{Archive, IoError};

use crate::Stats;
use crate::bodies::{BodiesChanged, BodyKey};
use crate::foam::{Diffuse, FoamState, KeptFoam};
use crate::scene::{Scene, SceneErrors};

/// The version of the format.
const VERSION: u32 = 10;
/// Words per diffuse particle.
const FOAM_COLUMNS: usize = size_of::<Diffuse>() / 4;

/// A checkpoint cannot be written, read or used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CheckpointError {
    /// The file cannot be read or written.
    #[error(transparent)]
    Io(#[from] IoError),
    /// The file is not a checkpoint, or it is damaged.
    #[error("this is not a usable checkpoint: {0}")]
    Malformed(String),
    /// Another program version made it.
    #[error(
        "this checkpoint has format {given}, written by Splashdown {program}; this program reads format {VERSION}: use \
         that version, or run the scene again"
    )]
    Version {
        /// Its format.
        given: u32,
        /// The version of the program that wrote it.
        program: String,
    },
    /// The scene in the checkpoint cannot be read any more.
    #[error("the scene in the checkpoint cannot be used: {0}")]
    Scene(#[from] SceneErrors),
    /// A mesh of an emitter or a sink has changed.
    #[error(
        "the mesh of an outlet or a sink is not the one of the checkpoint: restore the old file, or run the scene again"
    )]
    FlowChanged,
    /// The mesh of a body has changed.
    #[error(
        "body {body:?} is not the one of the checkpoint: its mesh had {then}, now it has {now}. Restore the old mesh, or run the \
         scene again"
    )]
    BodyChanged {
        /// The body's name.
        body: String,
        /// Properties of the mesh in the checkpoint.
        then: String,
        /// Properties of the mesh now.
        now: String,
    },
}

impl From<BodiesChanged> for CheckpointError {
    fn from(changed: BodiesChanged) -> Self {
        match changed {
            BodiesChanged::Mesh { now, then } => {
                Self::BodyChanged { body: now.name.clone(), then: then.to_string(), now: now.to_string() }
            }
            BodiesChanged::Count { now, then } => {
                Self::Malformed(format!("it has {then} bodies, but its scene has {now}"))
            }
        }
    }
}

/// The description of the file, for readers other than this program.
#[derive(Serialize, Deserialize)]
struct About {
    format: String,
    version: u32,
    program: String,
    scene: String,
    /// The path of the scene file.
    source: Option<PathBuf>,
    /// The name of the adapter, or `CPU`.
    device: Option<String>,
    time: f64,
    particles: u32,
}

/// The state of a simulation on the host.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct HostState {
    pub stats: Stats,
    pub stable_dt: f32,
    pub sound_speed: f32,
    pub capacity: u32,
    pub initial: u32,
    pub removed: u32,
    /// Emitters that have already reported full buffers.
    pub reported: Vec<bool>,
    pub bodies: Vec<BodyKey>,
    /// Fingerprint of the emitters and sinks.
    pub flow: u64,
}

impl HostState {
    /// Checks that the values are possible in a simulation.
    fn check(&self) -> Result<(), &'static str> {
        let Self { stats, stable_dt, sound_speed, initial, capacity, .. } = self;
        let is_positive = |x: f32| x.is_finite() && x > 0.0;
        let is_time = stats.time.is_finite() && stats.time >= 0.0;
        if !(is_time && is_positive(*stable_dt) && is_positive(*sound_speed)) {
            return Err("its time, its time step or its speed of sound is not a positive number");
        }
        let (created, lost) = (
            u64::from(*initial) + u64::from(stats.emitted),
            u64::from(stats.escaped) + u64::from(stats.drained) + u64::from(stats.non_finite),
        );
        let is_consistent = created.checked_sub(lost) == Some(u64::from(stats.particles));
        if !is_consistent || initial > capacity || stats.particles > *capacity || stats.steps > 1 << 60 {
            return Err("its counts of particles contradict each other");
        }
        Ok(())
    }
}

/// The state of a simulation between two frames. [`Simulation::checkpoint`](crate::Simulation::checkpoint) creates it,
/// and [`Simulation::resume`](crate::Simulation::resume) continues from it.
///
/// ```
/// use splashdown::{Checkpoint, Device, Simulation, scene::Scene};
/// # let text = include_str!("../scenes/dam-break-small.toml");
/// let scene = Scene::parse(text, "dam-break-small.toml")?;
/// let mut first = Simulation::new(&scene, &Device::Cpu)?;
/// first.advance(0.001)?;
/// let bytes = first.checkpoint(&scene.text)?.to_bytes()?; // or write(path)
///
/// let mut second = Simulation::resume(&Checkpoint::from_bytes(&bytes)?, Device::Cpu.executor()?)?;
/// first.advance(0.001)?;
/// second.advance(0.001)?;
/// assert_eq!(first.particles()?, second.particles()?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Checkpoint {
    pub(crate) archive: Archive,
    /// The scene, once it has been read. Reading it also reads the files that it names.
    scene: OnceLock<Scene>,
}

impl PartialEq for Checkpoint {
    fn eq(&self, other: &Self) -> bool {
        self.archive == other.archive
    }
}

impl Checkpoint {
    /// The file name extension of checkpoints.
    pub const ENDING: &'static str = "splashdown";

    pub(crate) fn new(archive: Archive, scene: &Scene, text: &str, device: String, host: &HostState) -> Self {
        let mut checkpoint = Self { archive, scene: OnceLock::new() };
        let about = About {
            format: "Splashdown checkpoint".to_owned(),
            version: VERSION,
            program: env!("CARGO_PKG_VERSION").to_owned(),
            scene: scene.name.clone(),
            // An absolute path is valid in every working folder.
            source: scene
                .source
                .as_ref()
                .map(|path| std::path::absolute(path).unwrap_or_else(|_| path.clone())),
            device: Some(device),
            time: host.stats.time,
            particles: host.stats.particles,
        };
        // Cannot fail: the values are strings and numbers.
        let about = serde_json::to_string_pretty(&about).unwrap_or_default();
        checkpoint.archive.set_text("about.json", &about);
        checkpoint.archive.set_text("scene.toml", text);
        checkpoint.set("host.bin", host);
        checkpoint
    }

    /// Writes the file atomically. Returns its size in bytes.
    ///
    /// # Errors
    /// [`CheckpointError::Io`].
    pub fn write(&self, path: &Path) -> Result<u64, CheckpointError> {
        Ok(self.archive.write(path)?)
    }

    /// Reads a file.
    ///
    /// # Errors
    /// [`CheckpointError::Io`] if it cannot be read; [`CheckpointError::Malformed`] if it is not a checkpoint, truncated
    /// or damaged; [`CheckpointError::Version`] if it has another version.
    pub fn read(path: &Path) -> Result<Self, CheckpointError> {
        let named = |reason: String| CheckpointError::Malformed(format!("`{}`: {reason}", path.display()));
        let archive = Archive::read(path).map_err(|error| match error {
            IoError::Malformed { reason, .. } => named(reason),
            other => other.into(),
        })?;
        Self::of(archive).map_err(|error| match error {
            CheckpointError::Malformed(reason) => named(reason),
            other => other,
        })
    }

    /// The content of the file.
    ///
    /// # Errors
    /// [`CheckpointError::Malformed`] if it is larger than the format allows.
    pub fn to_bytes(&self) -> Result<Vec<u8>, CheckpointError> {
        self.archive.to_bytes().map_err(CheckpointError::Malformed)
    }

    /// Reads the content of a file.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, CheckpointError> {
        Self::of(Archive::from_bytes(bytes).map_err(CheckpointError::Malformed)?)
    }

    fn of(archive: Archive) -> Result<Self, CheckpointError> {
        let checkpoint = Self { archive, scene: OnceLock::new() };
        let About { format, version, program, .. } = checkpoint.about()?;
        if format != "Splashdown checkpoint" {
            return Err(CheckpointError::Malformed(format!("its format is {format:?}")));
        }
        if version != VERSION {
            return Err(CheckpointError::Version { given: version, program });
        }
        Ok(checkpoint)
    }

    fn about(&self) -> Result<About, CheckpointError> {
        let text = self.archive.text("about.json").map_err(CheckpointError::Malformed)?;
        serde_json::from_str(text)
            .map_err(|error| CheckpointError::Malformed(format!("its entry `about.json`: {error}")))
    }

    /// The scene that is simulated.
    ///
    /// # Errors
    /// [`CheckpointError::Scene`], for example if a file that it names does not exist any more.
    pub fn scene(&self) -> Result<Scene, CheckpointError> {
        if let Some(scene) = self.scene.get() {
            return Ok(scene.clone());
        }
        let text = self.archive.text("scene.toml").map_err(CheckpointError::Malformed)?;
        let About { scene, source, .. } = self.about()?;
        let scene = match source {
            Some(path) => Scene::parse_beside(text, &path)?,
            None => Scene::parse(text, &scene)?,
        };
        Ok(self.scene.get_or_init(|| scene).clone())
    }

    /// Simulated time in seconds.
    ///
    /// # Errors
    /// [`CheckpointError::Malformed`].
    pub fn time(&self) -> Result<f64, CheckpointError> {
        Ok(self.host()?.stats.time)
    }

    /// The device on which the checkpoint was made: the name of an adapter, or `CPU`. On this device a resumed run is
    /// bit-identical. `None` if an earlier version did not store it.
    ///
    /// # Errors
    /// [`CheckpointError::Malformed`].
    pub fn device(&self) -> Result<Option<String>, CheckpointError> {
        Ok(self.about()?.device)
    }

    /// The text that a front end has stored with [`set_notes`](Self::set_notes), if any.
    pub fn notes(&self) -> Option<&str> {
        self.archive.text("notes.json").ok()
    }

    /// Stores a text of a front end in the file, for example its settings.
    pub fn set_notes(&mut self, text: &str) {
        self.archive.set_text("notes.json", text);
    }

    pub(crate) fn host(&self) -> Result<HostState, CheckpointError> {
        let host: HostState = self.get("host.bin")?;
        host.check().map_err(|reason| CheckpointError::Malformed(reason.to_owned()))?;
        Ok(host)
    }

    /// Checks that a simulation can be resumed from it, as far as this is possible without resuming.
    ///
    /// # Errors
    /// [`CheckpointError`].
    pub fn check(&self) -> Result<(), CheckpointError> {
        self.scene()?;
        let n = self.host()?.capacity as usize;
        for (name, columns) in [("positions", 4), ("velocities", 4), ("densities", 2)] {
            self.numbers::<f32>(name, columns * n)?;
        }
        self.numbers::<u32>("ids", n)?;
        self.foam()?;
        Ok(())
    }

    pub(crate) fn has(&self, name: &str) -> bool {
        self.archive.bytes(name).is_ok()
    }

    /// Stores the foam of the simulation.
    pub fn set_foam(&mut self, kept: &KeptFoam) {
        self.archive.set_array("foam_state", bytemuck::cast_slice::<_, u32>(&[kept.state]), 1);
        self.archive.set_array("foam", bytemuck::cast_slice::<_, u32>(&kept.pool), FOAM_COLUMNS);
    }

    /// The foam in the checkpoint, if any.
    ///
    /// # Errors
    /// [`CheckpointError::Malformed`].
    pub fn foam(&self) -> Result<Option<KeptFoam>, CheckpointError> {
        let Ok(state) = self.numbers::<u32>("foam_state", size_of::<FoamState>() / 4) else {
            return Ok(None);
        };
        let state: FoamState = bytemuck::pod_read_unaligned(bytemuck::cast_slice(&state));
        let words = self.numbers::<u32>("foam", FOAM_COLUMNS * state.count as usize)?;
        let rows = words.chunks_exact(FOAM_COLUMNS);
        let pool = rows.map(|row| bytemuck::pod_read_unaligned(bytemuck::cast_slice(row))).collect();
        Ok(Some(KeptFoam { state, pool }))
    }

    /// Stores a value as its exact bits.
    pub(crate) fn set(&mut self, name: &str, value: &impl Serialize) {
        // Fails only for types of unknown length, which are not used here.
        if let Ok(bytes) = postcard::to_stdvec(value) {
            self.archive.set_bytes(name, bytes);
        }
    }

    pub(crate) fn get<T: DeserializeOwned>(&self, name: &str) -> Result<T, CheckpointError> {
        let bytes = self.archive.bytes(name).map_err(CheckpointError::Malformed)?;
        postcard::from_bytes(bytes)
            .map_err(|error| CheckpointError::Malformed(format!("its entry `{name}`: {error}")))
    }

    /// An array of this many numbers.
    pub(crate) fn numbers<T: splashdown_io::NpyElement>(
        &self,
        name: &str,
        count: usize,
    ) -> Result<Vec<T>, CheckpointError> {
        let numbers = self.archive.array(name).map_err(CheckpointError::Malformed)?;
        if numbers.len() != count {
            let reason =
                format!("its entry `{name}` has {} numbers, but its scene needs {count}", numbers.len());
            return Err(CheckpointError::Malformed(reason));
        }
        Ok(numbers)
    }
}
