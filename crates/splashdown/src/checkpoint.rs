//! Checkpoints: a simulation in a file, from which it can be resumed.
//!
//! *Content.* Everything that a step reads and that does not follow from the scene: the persistent arrays of the
//! particles, the state on the device, the counters, the bodies with the state of their collisions, the state of emitters
//! and probes, and the text of the scene. What follows from the scene (grids, maps, constants) is computed again, and
//! compared where a file may have changed. On the CPU and on the same adapter, a resumed simulation is bit-identical to an
//! uninterrupted one.
//!
//! *The file* is a ZIP of NPY arrays ([`Archive`]): `numpy.load` opens it. `positions` (N, 4) in m, the fourth
//! zero for the living; `velocities` (N, 4) in m/s with the density in kg/m^3; `ids` (N,); `scene.toml` the
//! scene; `about.json` describes the file.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use serde::{Deserialize, Serialize, de::DeserializeOwned};
use splashdown_io::{Archive, IoError};

use crate::Stats;
use crate::bodies::{BodiesChanged, BodyKey};
use crate::foam::{Diffuse, FoamState, KeptFoam};
use crate::scene::{Scene, SceneErrors};

/// The number of the format that is written and read.
const VERSION: u32 = 2;
/// Words of a diffuse particle.
const FOAM_COLUMNS: usize = size_of::<Diffuse>() / 4;

/// Why a checkpoint cannot be used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CheckpointError {
    /// The file cannot be read or written.
    #[error(transparent)]
    Io(#[from] IoError),
    /// It is none, or damaged.
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
    /// Its scene cannot be read any more.
    #[error("the scene in the checkpoint cannot be used: {0}")]
    Scene(#[from] SceneErrors),
    /// A mesh of an emitter or a sink has changed.
    #[error(
        "the mesh of an outlet or a sink is not the one of the checkpoint: restore the old file, or run the scene again"
    )]
    FlowChanged,
    /// A file that the scene names has changed.
    #[error(
        "body {body:?} is not the one of the checkpoint: its mesh had {then}, now it has {now}. Put the old mesh back, or run the \
         scene anew"
    )]
    BodyChanged {
        /// The body's name.
        body: String,
        /// The mesh then.
        then: String,
        /// The mesh now.
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
                Self::Malformed(format!("it has {then} bodies, its scene {now}"))
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
    /// The scene's file.
    source: Option<PathBuf>,
    /// Of the adapter, or `CPU`.
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
    /// Emitters whose lack of room has been reported.
    pub reported: Vec<bool>,
    pub bodies: Vec<BodyKey>,
    /// Of the meshes of outlets and sinks.
    pub flow: u64,
}

impl HostState {
    /// Refuses values that no simulation can have.
    fn check(&self) -> Result<(), &'static str> {
        let Self { stats, stable_dt, sound_speed, initial, capacity, .. } = self;
        let is_positive = |x: f32| x.is_finite() && x > 0.0;
        let is_time = stats.time.is_finite() && stats.time >= 0.0;
        if !(is_time && is_positive(*stable_dt) && is_positive(*sound_speed)) {
            return Err("its time, its time step or its speed of sound is no positive number");
        }
        let (made, gone) = (
            u64::from(*initial) + u64::from(stats.emitted),
            u64::from(stats.escaped) + u64::from(stats.drained) + u64::from(stats.non_finite),
        );
        let there = made.checked_sub(gone) == Some(u64::from(stats.particles));
        if !there || initial > capacity || stats.particles > *capacity || stats.steps > 1 << 60 {
            return Err("its counts of particles contradict one another");
        }
        Ok(())
    }
}

/// A simulation between two frames, in memory: [`Simulation::checkpoint`](crate::Simulation::checkpoint) makes it,
/// [`Simulation::resume`](crate::Simulation::resume) continues from it.
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
    /// The scene, once it has been read: with it the files that it names are read.
    scene: OnceLock<Scene>,
}

impl PartialEq for Checkpoint {
    fn eq(&self, other: &Self) -> bool {
        self.archive == other.archive
    }
}

impl Checkpoint {
    /// The ending of a checkpoint's file name.
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
        // Names and numbers always have a JSON form.
        let about = serde_json::to_string_pretty(&about).unwrap_or_default();
        checkpoint.archive.set_text("about.json", &about);
        checkpoint.archive.set_text("scene.toml", text);
        checkpoint.set("host.bin", host);
        checkpoint
    }

    /// Writes it, complete or not at all; returns the file's size in bytes.
    ///
    /// # Errors
    /// [`CheckpointError::Io`].
    pub fn write(&self, path: &Path) -> Result<u64, CheckpointError> {
        Ok(self.archive.write(path)?)
    }

    /// Reads a file.
    ///
    /// # Errors
    /// [`CheckpointError::Io`] where it cannot be read; else [`CheckpointError`]: none, cut short, damaged, or
    /// of another version.
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

    /// The whole file.
    ///
    /// # Errors
    /// [`CheckpointError::Malformed`] where it is larger than the format allows.
    pub fn to_bytes(&self) -> Result<Vec<u8>, CheckpointError> {
        self.archive.to_bytes().map_err(CheckpointError::Malformed)
    }

    /// From a whole file.
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
            return Err(CheckpointError::Malformed(format!("it calls itself {format:?}")));
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
    /// [`CheckpointError::Scene`] where a file that it names is gone, say.
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

    /// What it was made on: an adapter's name, or `CPU`; the same bits follow there. `None` where an earlier
    /// version did not say.
    ///
    /// # Errors
    /// [`CheckpointError::Malformed`].
    pub fn device(&self) -> Result<Option<String>, CheckpointError> {
        Ok(self.about()?.device)
    }

    /// What a front end left with [`set_notes`](Self::set_notes), if it did.
    pub fn notes(&self) -> Option<&str> {
        self.archive.text("notes.json").ok()
    }

    /// Leaves a text of the front end's own in the file: what it was asked for, say.
    pub fn set_notes(&mut self, text: &str) {
        self.archive.set_text("notes.json", text);
    }

    pub(crate) fn host(&self) -> Result<HostState, CheckpointError> {
        let host: HostState = self.get("host.bin")?;
        host.check().map_err(|reason| CheckpointError::Malformed(reason.to_owned()))?;
        Ok(host)
    }

    /// Checks that it can be resumed, as far as that is possible without doing so.
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

    /// Puts foam in beside the simulation that made it.
    pub fn set_foam(&mut self, kept: &KeptFoam) {
        self.archive.set_array("foam_state", bytemuck::cast_slice::<_, u32>(&[kept.state]), 1);
        self.archive.set_array("foam", bytemuck::cast_slice::<_, u32>(&kept.pool), FOAM_COLUMNS);
    }

    /// The foam in it, if any.
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

    /// Puts a value in by its exact bits.
    pub(crate) fn set(&mut self, name: &str, value: &impl Serialize) {
        // Fails only for types whose length is not known before, of which there is none here.
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
                format!("its entry `{name}` has {} numbers; the scene in it needs {count}", numbers.len());
            return Err(CheckpointError::Malformed(reason));
        }
        Ok(numbers)
    }
}
