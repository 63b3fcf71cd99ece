//! The scene of a run, found from its folder.

use std::fs;
use std::path::{Path, PathBuf};

use splashdown::scene::{Scene, presets};

use crate::{FoundCheckpoint, RunError, RunFolder, find_checkpoint};

/// The scene of a run: that of its newest checkpoint, which contains all changes, else the one that `run.json` names.
///
/// # Errors
/// As [`reported_scene`].
pub fn scene_of_run(folder: &Path) -> Result<Scene, RunError> {
    if let Ok(FoundCheckpoint { checkpoint, notes, .. }) = find_checkpoint(folder)
        && let Ok(mut scene) = checkpoint.scene()
    {
        notes.settings().apply_to(&mut scene);
        return Ok(scene);
    }
    reported_scene(folder)
}

/// The scene that the report of a run names, as it is now.
///
/// # Errors
/// [`RunError::UnknownScene`] if there is no report, or the scene it names does not exist or has problems.
pub fn reported_scene(folder: &Path) -> Result<Scene, RunError> {
    let report = RunFolder::new(folder.to_owned(), 0).report();
    let unknown =
        || RunError::UnknownScene(format!("`{}` does not name the scene of this run", report.display()));
    let text = fs::read_to_string(&report).map_err(|_| unknown())?;
    let values: serde_json::Value = serde_json::from_str(&text).map_err(|_| unknown())?;
    let word = |key: &str| values.get(key).and_then(|value| value.as_str());
    let name = word("file").or_else(|| word("scene")).ok_or_else(unknown)?;
    let path = PathBuf::from(name);
    let invalid = |error: splashdown::scene::SceneErrors| RunError::UnknownScene(error.to_string());
    if path.is_file() {
        return Scene::load(&path).map_err(invalid);
    }
    match presets().iter().find(|(preset, _)| *preset == name) {
        Some((name, text)) => Scene::parse(text, &format!("{name}.toml (built in)")).map_err(invalid),
        None => Err(RunError::UnknownScene(format!(
            "the scene `{name}` that `{}` names does not exist here",
            report.display()
        ))),
    }
}
