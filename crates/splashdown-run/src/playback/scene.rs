//! The scene of a run, found from its folder.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;
use splashdown::scene::{Scene, SceneErrors, presets};

use crate::settings::Notes;
use crate::{FoundCheckpoint, RunError, RunFolder, find_checkpoint};

/// The scene of a run: the one whose text is in `run.json`, else that of the newest checkpoint, else the one that `run.json`
/// names. The last two are those of runs of earlier versions. The settings of the run are applied to the first two.
///
/// # Errors
/// As [`reported_scene`].
pub fn scene_of_run(folder: &Path) -> Result<Scene, RunError> {
    if let Some(scene) = Report::read(folder).ok().and_then(|report| report.scene_in_text()) {
        return Ok(scene);
    }
    if let Ok(FoundCheckpoint { checkpoint, notes, .. }) = find_checkpoint(folder)
        && let Ok(mut scene) = checkpoint.scene()
    {
        notes.settings().apply_to(&mut scene);
        return Ok(scene);
    }
    reported_scene(folder)
}

/// The scene that the report of a run contains, else the one that it names, as it is now.
///
/// # Errors
/// [`RunError::UnknownScene`] if there is no report, or the scene it names does not exist or has problems.
pub fn reported_scene(folder: &Path) -> Result<Scene, RunError> {
    let path = RunFolder::new(folder.to_owned(), 0).report();
    let unknown =
        || RunError::UnknownScene(format!("`{}` does not name the scene of this run", path.display()));
    let report = Report::read(folder).map_err(RunError::UnknownScene)?;
    if let Some(scene) = report.scene_in_text() {
        return Ok(scene);
    }
    let name = report.word("file").or_else(|| report.word("scene")).ok_or_else(unknown)?;
    let invalid = |error: SceneErrors| RunError::UnknownScene(error.to_string());
    // A run folder that was moved, or is read from another working directory, still names the file by its absolute path.
    let files = [Some(name), report.word("scene_path")].into_iter().flatten().map(PathBuf::from);
    if let Some(file) = files.into_iter().find(|file| file.is_file()) {
        return Scene::load(&file).map_err(invalid);
    }
    match presets().iter().find(|(preset, _)| *preset == name) {
        Some((name, text)) => Scene::parse(text, &format!("{name}.toml (built in)")).map_err(invalid),
        None => Err(RunError::UnknownScene(format!(
            "the scene `{name}` that `{}` names does not exist here",
            path.display()
        ))),
    }
}

/// The report of a run, which may be that of another version or damaged.
struct Report(Value);

impl Report {
    /// # Errors
    /// Why it cannot be read.
    fn read(folder: &Path) -> Result<Self, String> {
        let path = RunFolder::new(folder.to_owned(), 0).report();
        let text = fs::read_to_string(&path).map_err(|error| {
            if folder.is_dir() {
                format!("`{}` cannot be read: {error}; give the output folder of a run", path.display())
            } else {
                format!("there is no folder `{}`: give the output folder of a run", folder.display())
            }
        })?;
        serde_json::from_str(&text)
            .map(Self)
            .map_err(|error| format!("`{}` is damaged: {error}", path.display()))
    }

    fn word(&self, key: &str) -> Option<&str> {
        self.0.get(key)?.as_str()
    }

    /// The scene whose text the report contains, with the settings of the run; `None` without a valid text.
    fn scene_in_text(&self) -> Option<Scene> {
        let text = self.word("scene_text")?;
        let scene = match self.word("scene_path") {
            Some(path) => Scene::parse_unopened(text, Path::new(path)),
            None => Scene::parse(text, self.word("scene").unwrap_or("scene")),
        };
        let mut scene = scene.ok()?;
        if let Some(notes) = self.0.get("settings").cloned().and_then(Notes::in_report) {
            notes.settings().apply_to(&mut scene);
        }
        Some(scene)
    }
}
