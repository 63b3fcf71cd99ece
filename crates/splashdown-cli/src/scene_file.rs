//! Loading the scene named on the command line: a file, or a built-in scene.

use std::path::Path;

use splashdown::scene::{Scene, presets};

use crate::exit::Failure;

/// Loads a scene. A file takes precedence over a built-in scene of the same name.
///
/// # Errors
/// Every problem of the scene at once.
pub fn load(path: &Path) -> Result<Scene, Failure> {
    if !path.exists()
        && let Some((name, text)) = path.to_str().and_then(preset)
    {
        return Ok(Scene::parse(text, &format!("{name}.toml (built in)"))?);
    }
    Ok(Scene::load(path)?)
}

/// Name and text of a built-in scene.
pub fn preset(name: &str) -> Option<(&'static str, &'static str)> {
    presets().iter().find(|(known, _)| *known == name).copied()
}
