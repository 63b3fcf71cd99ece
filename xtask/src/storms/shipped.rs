//! The scenes that come with the program: none may warn or stop.

use std::path::Path;

use anyhow::{Context, Result, ensure};

use super::{End, Settings, execute};
use crate::process::{self, say};

/// Runs all scenes to their end, with their spacing multiplied by `coarser`.
pub fn run(settings: &Settings, binary: &Path, coarser: f64) -> Result<()> {
    let folder = process::target().join("storms");
    std::fs::create_dir_all(&folder)?;
    let mut files: Vec<_> = std::fs::read_dir(process::root().join("scenes"))?
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|ending| ending == "toml"))
        .collect();
    files.sort();
    let mut alarmed = 0;
    for path in files {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let text = coarse(&std::fs::read_to_string(&path)?, coarser)?;
        let file = folder.join(format!("shipped-{name}.toml"));
        std::fs::write(&file, text)?;
        let out = folder.join(format!("shipped-{name}"));
        let end = execute(settings, binary, &file, &out)?;
        std::fs::remove_dir_all(&out).ok();
        alarmed += usize::from(end != End::Silent);
        say(format!("{name}: {end:?}"));
    }
    ensure!(alarmed == 0, "{alarmed} scenes warn, stop or fail");
    Ok(())
}

/// The scene with another spacing.
fn coarse(text: &str, factor: f64) -> Result<String> {
    let mut lines = Vec::new();
    for line in text.lines() {
        match line.strip_prefix("particle_spacing = ") {
            Some(rest) => {
                let number = rest.split_whitespace().next().unwrap_or_default();
                let spacing: f64 = number.parse().with_context(|| format!("cannot read {line:?}"))?;
                lines.push(format!("particle_spacing = {}", spacing * factor));
            }
            None => lines.push(line.to_owned()),
        }
    }
    Ok(lines.join("\n"))
}

#[cfg(test)]
mod tests {
    #[test]
    fn only_the_spacing_changes() {
        let text = "[fluid]\nparticle_spacing = 0.02 # m\nmaterial = \"oil\"";
        assert_eq!(super::coarse(text, 2.0).unwrap(), "[fluid]\nparticle_spacing = 0.04\nmaterial = \"oil\"");
    }
}
