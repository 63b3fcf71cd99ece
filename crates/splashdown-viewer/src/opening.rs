//! Reading what the user opens: scenes, runs, checkpoints and meshes. It runs on a thread of its own, because a checkpoint
//! may have gigabytes.

use std::path::{Path, PathBuf};

use glam::Vec3;
use splashdown::Checkpoint;
use splashdown::scene::Scene;
use splashdown_run::{FoundCheckpoint, RunFrames, find_checkpoint};

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
/// it has none.
///
/// # Errors
/// A message that names the file.
pub fn read(path: &Path) -> Result<Contents, String> {
    if path.is_dir() {
        if !RunFrames::exist_in(path) {
            return newest_checkpoint(path);
        }
        let run = RunFrames::open(path, None).map_err(|error| error.to_string())?;
        return Ok(Contents::Run(Box::new(run)));
    }
    match ending(path).as_str() {
        "toml" => {
            let scene = Scene::load(path).map_err(|error| error.to_string())?;
            Ok(Contents::Scene(Box::new(scene)))
        }
        Checkpoint::ENDING => newest_checkpoint(path),
        _ => mesh(path),
    }
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
        assert!(matches!(read(&scene), Ok(Contents::Scene(scene)) if scene.name == "small"));
        let bounds = [Vec3::new(0.0, 0.0, -4.0), Vec3::new(2.0, 3.0, 0.0)];
        assert!(matches!(read(&mesh), Ok(Contents::Mesh(path, read)) if path == mesh && read == bounds));
        let resumable = match read(&checkpoint) {
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
            let error = read(path).err().unwrap_or_else(|| panic!("{}", path.display()));
            let name = path.file_name().unwrap().to_string_lossy();
            assert!(error.contains(&*name), "{error}");
        }
    }
}
