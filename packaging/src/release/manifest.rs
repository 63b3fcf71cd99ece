//! The version in `Cargo.toml` and `Cargo.lock`. Comments and layout are preserved.

use anyhow::{Context, Result, ensure};
use semver::Version;
use toml_edit::{DocumentMut, Item, Value};

/// The version of the workspace.
pub fn version(manifest: &str) -> Result<Version> {
    let document: DocumentMut = manifest.parse().context("Cargo.toml is not TOML")?;
    let version = document["workspace"]["package"]["version"].as_str();
    Ok(Version::parse(version.context("Cargo.toml has no workspace.package.version")?)?)
}

/// `Cargo.toml` with the new version of the workspace and of the dependencies inside it.
pub fn with_version(manifest: &str, old: &Version, new: &Version) -> Result<String> {
    let mut document: DocumentMut = manifest.parse()?;
    set(&mut document["workspace"]["package"]["version"], new)?;
    let dependencies = document["workspace"]["dependencies"].as_table_like_mut();
    let dependencies = dependencies.context("Cargo.toml has no workspace.dependencies")?;
    for (name, dependency) in dependencies.iter_mut() {
        let Some(table) = dependency.as_table_like_mut().filter(|table| table.contains_key("path")) else {
            continue;
        };
        let version =
            table.get_mut("version").with_context(|| format!("{name} has a path but no version"))?;
        let found = version.as_str().unwrap_or_default();
        ensure!(found == old.to_string(), "{name} has version {found:?}, the workspace has {old}");
        set(version, new)?;
    }
    Ok(document.to_string())
}

/// `Cargo.lock` with the new version of the packages of the workspace, which have no source.
pub fn lock_with_version(lock: &str, old: &Version, new: &Version) -> Result<String> {
    let mut document: DocumentMut = lock.parse().context("Cargo.lock is not TOML")?;
    let packages = document["package"].as_array_of_tables_mut().context("Cargo.lock lists no packages")?;
    let mut changed = 0;
    for package in packages.iter_mut() {
        let version = package.get("version").and_then(Item::as_str) == Some(&old.to_string());
        if version && !package.contains_key("source") {
            set(&mut package["version"], new)?;
            changed += 1;
        }
    }
    ensure!(changed > 0, "Cargo.lock has no package of this workspace with version {old}");
    Ok(document.to_string())
}

/// Replaces a text and preserves the surrounding layout.
fn set(item: &mut Item, version: &Version) -> Result<()> {
    let value = item.as_value_mut().context("a version is not a string")?;
    let surroundings = value.decor().clone();
    *value = Value::from(version.to_string());
    *value.decor_mut() = surroundings;
    Ok(())
}
