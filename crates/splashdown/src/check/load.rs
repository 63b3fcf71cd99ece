//! Reads a scene from a path or a text.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::{files, warnings};
use crate::sample::Sources;
use crate::scene::{
    Derived, Fluid, FluidMesh, MeshShape, Reported, Scene, SceneBuilder, SceneErrors, SceneProblem, Section,
    closest, parse, presets,
};

/// Maximum size of a scene file in bytes.
const MAX_BYTES: u64 = 4 << 20;

impl Scene {
    /// Reads and checks a scene file.
    ///
    /// # Errors
    /// All problems at once: a file that is unreadable, too large, not text or not TOML; unknown or missing
    /// keys; values out of range or inconsistent; meshes and particle files that are missing or cannot be
    /// used.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, SceneErrors> {
        let path = path.as_ref();
        let file = path.display().to_string();
        let refuse =
            |message: String, hint: &str| SceneErrors::one(SceneProblem::of_file(&file, message, hint));
        if path.is_dir() {
            return Err(refuse(
                "this is a folder, not a scene file".into(),
                "name a file that ends in .toml",
            ));
        }
        if path.metadata().is_ok_and(|data| !data.is_file()) {
            return Err(refuse(
                "this is a pipe or a device, not a scene file".into(),
                "save its text to a file that ends in .toml",
            ));
        }
        let opened = File::open(path).map_err(|error| {
            let hint = match error.kind() {
                std::io::ErrorKind::NotFound => not_found_hint(path),
                _ => String::new(),
            };
            refuse(format!("cannot open the scene file: {error}"), &hint)
        })?;
        let mut bytes = Vec::new();
        opened
            .take(MAX_BYTES + 1)
            .read_to_end(&mut bytes)
            .map_err(|error| refuse(format!("cannot read the scene file: {error}"), ""))?;
        if bytes.len() as u64 > MAX_BYTES {
            let message =
                format!("the file is larger than {} MiB: this is not a scene file", MAX_BYTES >> 20);
            return Err(refuse(message, "scene files are short texts in TOML"));
        }
        // The parent of a bare file name is the empty path, relative to which files are found as well.
        let scene = Self::from_bytes(&bytes, &file, path.parent())?;
        Ok(Self { source: Some(path.to_owned()), ..scene })
    }

    /// Checks the text of a scene file; `file_name` is for messages. The files named in the scene are not
    /// opened: paths stay as written, and problems with the files are reported when a simulation starts.
    ///
    /// # Errors
    /// As [`Scene::load`].
    pub fn parse(text: &str, file_name: &str) -> Result<Self, SceneErrors> {
        Self::from_bytes(text.as_bytes(), file_name, None)
    }

    /// As [`load`](Self::load), from the text of a scene file that has been moved or changed. The files named
    /// in the scene are searched relative to the folder of `path`.
    ///
    /// # Errors
    /// As [`Scene::load`].
    pub fn parse_beside(text: &str, path: &Path) -> Result<Self, SceneErrors> {
        let scene = Self::from_bytes(text.as_bytes(), &path.display().to_string(), path.parent())?;
        Ok(Self { source: Some(path.to_owned()), ..scene })
    }

    fn from_bytes(bytes: &[u8], file: &str, folder: Option<&Path>) -> Result<Self, SceneErrors> {
        let refuse = |message: String| {
            SceneErrors::one(SceneProblem::of_file(
                file,
                message,
                "scene files are texts in TOML, encoded as UTF-8",
            ))
        };
        if bytes.len() as u64 > MAX_BYTES {
            return Err(refuse(format!(
                "the text is larger than {} MiB: this is not a scene",
                MAX_BYTES >> 20
            )));
        }
        if bytes.contains(&0) {
            return Err(refuse("this is a binary file, not a scene".into()));
        }
        match std::str::from_utf8(bytes) {
            Ok(text) => parse(text.strip_prefix('\u{feff}').unwrap_or(text), file, folder, check),
            Err(error) => {
                let line = bytes[..error.valid_up_to()].iter().filter(|byte| **byte == b'\n').count() + 1;
                Err(refuse(format!("line {line} is not UTF-8 text")))
            }
        }
    }
}

impl SceneBuilder {
    /// Checks the scene. The files named in it are opened when a simulation starts, relative to the current
    /// folder.
    ///
    /// # Errors
    /// All problems of the scene, with the lines of [`to_toml`](Self::to_toml).
    pub fn build(&self) -> Result<Scene, SceneErrors> {
        Scene::parse(&self.to_toml(), "scene builder")
    }
}

/// Checks a scene after its values have been read.
fn check(scene: &Scene, root: &Section<'_>) -> Result<(), Reported> {
    let is_model = |filled: &&FluidMesh| matches!(filled.mesh.shape, MeshShape::Model(_));
    let fluid = &scene.fluid;
    let opens_files = !fluid.files.is_empty() || !fluid.meshes.iter().all(|filled| is_model(&filled));
    if root.has_folder() {
        files::check(scene, root)?;
    } else if opens_files {
        // Without a folder no file is opened, so only built-in models are considered.
        let meshes = fluid.meshes.iter().filter(is_model).cloned().collect();
        let models = Fluid { meshes, files: Vec::new(), ..fluid.clone() };
        return warnings::check(scene, root, &Derived::of(scene, &Sources::read(&models).reaches(&models)));
    }
    warnings::check(scene, root, &Derived::without_particles(scene))
}

/// The hint for a missing scene file: the command that lists the built-in scenes, and a similar name.
fn not_found_hint(path: &Path) -> String {
    let list = "`splashdown scenes` lists the scenes that come with the program";
    let names: Vec<_> = presets().iter().map(|(name, _)| *name).collect();
    let meant = path.file_stem().and_then(|stem| closest(&stem.to_string_lossy(), &names));
    meant.map_or_else(|| list.to_owned(), |name| format!("did you mean {name:?}? {list}"))
}
