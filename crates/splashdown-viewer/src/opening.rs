//! Reading what the user opens: scenes, runs, checkpoints and meshes. It runs on a thread of its own, because a checkpoint
//! may have gigabytes.

use std::path::{Path, PathBuf};

use glam::Vec3;
use splashdown::Checkpoint;
use splashdown::scene::{Scene, presets};
use splashdown_run::{FoundCheckpoint, RunFrames, find_checkpoint, scene_of_run};

use crate::problem;

/// The content of a file or a folder.
pub enum Contents {
    /// A scene.
    Scene(Box<Scene>),
    /// The frames of a run.
    Run(Box<RunFrames>),
    /// A checkpoint that can be resumed.
    Checkpoint(Box<Resumable>),
    /// A mesh: its file and its bounding box, in the units of the file.
    Mesh(PathBuf, [Vec3; 2]),
}

/// A checkpoint that can be resumed.
pub struct Resumable {
    /// The checkpoint.
    pub checkpoint: Checkpoint,
    /// Its scene.
    pub scene: Scene,
    /// Newer checkpoints that cannot be used, and why.
    pub skipped: Vec<String>,
}

/// Reads a file or a folder according to its content: a folder is a run, whose frames are played, or which is continued if
/// it has none. `scene` is that of a run that does not name it: a file or the name of a built-in scene.
///
/// # Errors
/// A message that names the file.
pub fn read(path: &Path, scene: Option<&Path>) -> Result<Contents, String> {
    if path.is_dir() {
        if !RunFrames::exist_in(path) {
            return newest_checkpoint(path);
        }
        let scene = scene.map(load).transpose()?;
        let run = RunFrames::open(path, scene).map_err(|error| error.to_string())?;
        return Ok(Contents::Run(Box::new(run)));
    }
    match ending(path).as_str() {
        "toml" => Ok(Contents::Scene(Box::new(load(path)?))),
        Checkpoint::ENDING => newest_checkpoint(path),
        _ => mesh(path),
    }
}

/// Reads a scene file, or a built-in scene by its name if there is no such file.
fn load(path: &Path) -> Result<Scene, String> {
    let preset = presets().iter().find(|(name, _)| !path.exists() && path == Path::new(name));
    let scene = match preset {
        Some((name, text)) => Scene::parse(text, name),
        None => Scene::load(path),
    };
    scene.map_err(|errors| problem::of_file(&errors))
}

/// The scene with which a run was opened, if its folder does not name the same one: a file, or the name of a built-in
/// scene.
pub fn given_scene(run: &RunFrames) -> Option<PathBuf> {
    let scene = run.scene();
    let is_preset = || presets().iter().any(|(name, text)| *name == scene.name && **text == *scene.text);
    let given = scene.source.clone().or_else(|| is_preset().then(|| PathBuf::from(&scene.name)))?;
    let named = scene_of_run(run.folder());
    named.map_or(true, |named| named != *scene).then_some(given)
}

/// Whether a path is that of a mesh and not of a scene, a checkpoint or a run, by its ending.
pub fn is_mesh(path: &Path) -> bool {
    splashdown_io::Format::of(path).is_some_and(|format| format.reads_meshes())
}

fn ending(path: &Path) -> String {
    path.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase()).unwrap_or_default()
}

/// Reads a mesh.
///
/// # Errors
/// A message that names the file.
pub fn mesh(path: &Path) -> Result<Contents, String> {
    let mesh = splashdown_io::read_mesh(path).map_err(|error| error.to_string())?;
    let corners = mesh.vertices.iter().map(|&vertex| Vec3::from(vertex));
    let low = corners.clone().fold(Vec3::INFINITY, Vec3::min);
    let high = corners.fold(Vec3::NEG_INFINITY, Vec3::max);
    Ok(Contents::Mesh(path.to_owned(), [low, high]))
}

/// Reads a checkpoint, or the newest usable one of a run.
///
/// # Errors
/// As [`find_checkpoint`], and if the checkpoint cannot be resumed.
pub fn newest_checkpoint(path: &Path) -> Result<Contents, String> {
    let FoundCheckpoint { checkpoint, skipped, .. } =
        find_checkpoint(path).map_err(|error| error.to_string())?;
    // An unusable checkpoint does not replace the running simulation.
    let scene = checkpoint.check().and_then(|()| checkpoint.scene());
    let scene = scene.map_err(|error| format!("{}: {error}", path.display()))?;
    Ok(Contents::Checkpoint(Box::new(Resumable { checkpoint, scene, skipped })))
}

#[cfg(test)]
mod tests {
    use super::*;
    use splashdown::{Device, Simulation};

    const SCENE: &str = "[scene]\nname = \"small\"\nduration = 1\n[domain]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n\
                         [fluid]\nparticle_spacing = 0.1\n[[fluid.block]]\nposition = [0, 0, 0]\nsize = [0.3, 0.3, 0.3]\n";
    const MESH: &str = "v 0 0 0\nv 2 0 0\nv 0 3 0\nv 0 0 -4\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

    #[test]
    fn every_kind_of_file_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let [scene, mesh, checkpoint] =
            ["a.toml", "a.OBJ", "a.checkpoint"].map(|name| folder.path().join(name));
        let checkpoint = checkpoint.with_extension(Checkpoint::ENDING);
        std::fs::write(&scene, SCENE).unwrap();
        std::fs::write(&mesh, MESH).unwrap();
        let parsed = Scene::parse(SCENE, "a.toml").unwrap();
        let mut simulation = Simulation::new(&parsed, &Device::Cpu).unwrap();
        let bytes = simulation.checkpoint(SCENE).unwrap().to_bytes().unwrap();
        std::fs::write(&checkpoint, &bytes).unwrap();
        assert!(matches!(read(&scene, None), Ok(Contents::Scene(scene)) if scene.name == "small"));
        let bounds = [Vec3::new(0.0, 0.0, -4.0), Vec3::new(2.0, 3.0, 0.0)];
        assert!(
            matches!(read(&mesh, None), Ok(Contents::Mesh(path, read)) if path == mesh && read == bounds)
        );
        let resumable = match read(&checkpoint, None) {
            Ok(Contents::Checkpoint(resumable)) => resumable,
            other => panic!("{:?}", other.err()),
        };
        assert_eq!((resumable.scene.name.as_str(), resumable.skipped.len()), ("small", 0));
        // Damaged and missing files are named.
        std::fs::write(&checkpoint, &bytes[..bytes.len() / 2]).unwrap();
        std::fs::write(&mesh, "v 0\n").unwrap();
        std::fs::write(&scene, "[scene").unwrap();
        let missing = folder.path().join("b.toml");
        for path in [&checkpoint, &mesh, &scene, &missing, &folder.path().to_owned()] {
            let error = read(path, None).err().unwrap_or_else(|| panic!("{}", path.display()));
            let name = path.file_name().unwrap().to_string_lossy();
            assert!(error.contains(&*name), "{error}");
        }
    }

    #[test]
    fn a_run_that_names_no_scene_is_opened_with_the_remembered_one() {
        let folder = tempfile::tempdir().unwrap();
        let (run, scene) = (folder.path().join("run"), folder.path().join("a.toml"));
        std::fs::create_dir_all(run.join("particles")).unwrap();
        std::fs::write(run.join("particles/particles_0000.ply"), "").unwrap();
        std::fs::write(&scene, SCENE).unwrap();
        let frames = RunFrames::open(&run, Some(Scene::load(&scene).unwrap())).unwrap();
        assert_eq!(given_scene(&frames), Some(scene.clone()));
        let preset = Scene::parse(presets()[0].1, presets()[0].0).unwrap();
        let frames = RunFrames::open(&run, Some(preset)).unwrap();
        assert_eq!(given_scene(&frames), Some(PathBuf::from(presets()[0].0)));
        for scene in [&scene, Path::new(presets()[0].0)] {
            assert!(matches!(read(&run, Some(scene)), Ok(Contents::Run(_))), "{}", scene.display());
        }
        // Control: without the scene it cannot be opened.
        assert!(read(&run, None).is_err());
        // A scene that the folder names need not be remembered.
        let report = format!("{{\"file\": {:?}}}", scene.display().to_string());
        std::fs::write(run.join("run.json"), report).unwrap();
        let frames = RunFrames::open(&run, Some(Scene::load(&scene).unwrap())).unwrap();
        assert_eq!(given_scene(&frames), None);
    }
}
