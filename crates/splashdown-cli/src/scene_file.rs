//! From the word on the command line to a scene: a file, or the name of a scene that comes with the program.

use std::path::Path;

use splashdown::scene::{Scene, presets};

use crate::exit::{Exit, Failure};

/// Loads a scene. A file goes before a built-in scene of the same name.
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

/// As [`load`], with the text of the file.
///
/// # Errors
/// As [`load`], or a file that cannot be read again.
pub fn load_with_text(path: &Path) -> Result<(Scene, String), Failure> {
    let scene = load(path)?;
    let text = match path.to_str().and_then(preset).filter(|_| !path.exists()) {
        Some((_, text)) => text.to_owned(),
        None => std::fs::read_to_string(path)
            .map_err(|error| Failure::new(Exit::Scene, format!("{}: {error}", path.display())))?,
    };
    Ok((scene, text))
}

/// Name and text of a built-in scene.
pub fn preset(name: &str) -> Option<(&'static str, &'static str)> {
    presets().iter().find(|(known, _)| *known == name).copied()
}
