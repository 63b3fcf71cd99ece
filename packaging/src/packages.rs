//! Tests of the crates as published: complete, described, and without files from outside their folders.
//! `cargo package --list` compiles nothing; `cargo xtask package` builds every crate from its package.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Component, Path, PathBuf};

use anyhow::{Context, Result};

use crate::command::{cargo, output, root};
use crate::metadata::{Metadata, Package};

/// The published crates.
fn published() -> Result<Vec<Package>> {
    let packages = Metadata::ask(&["--no-deps", "--offline"])?.packages;
    Ok(packages.into_iter().filter(|package| package.publish.is_none()).collect())
}

/// The files of a package, as `cargo package` would pack them.
fn listed(package: &Package) -> Result<BTreeSet<PathBuf>> {
    let arguments = ["package", "--list", "--allow-dirty", "--offline", "--package", &package.name];
    Ok(output(&mut cargo(arguments))?.lines().map(PathBuf::from).collect())
}

/// The paths that a source file includes at compile time: the arguments of `include_str!` and `include_bytes!`. For
/// `concat!(..)`, the text before the first variable part.
fn included(source: &str) -> Vec<String> {
    let calls = ["include_str!(", "include_bytes!("];
    let starts = calls.iter().flat_map(|call| source.match_indices(call).map(|(at, call)| at + call.len()));
    starts
        .filter_map(|at| {
            let argument = source[at..].trim_start();
            let argument = argument.strip_prefix("concat!(").unwrap_or(argument).trim_start();
            Some(argument.strip_prefix('"')?.split('"').next()?.to_owned())
        })
        .collect()
}

/// A path relative to the folder of a file, without `.` and `..`; `None` if it leaves the package.
fn resolved(file: &Path, path: &str) -> Option<PathBuf> {
    let mut parts: Vec<Component> = file.parent()?.components().collect();
    for part in Path::new(path).components() {
        match part {
            Component::ParentDir => drop(parts.pop()?),
            Component::CurDir => {}
            part => parts.push(part),
        }
    }
    Some(parts.iter().collect())
}

/// The files that a source file includes and the package does not contain.
fn missing(file: &Path, source: &str, listed: &BTreeSet<PathBuf>) -> Vec<String> {
    let present = |path: &str| {
        resolved(file, path).is_some_and(|inside| {
            let folder = path.ends_with('/');
            listed.iter().any(|name| if folder { name.starts_with(&inside) } else { *name == inside })
        })
    };
    included(source).into_iter().filter(|path| !present(path)).collect()
}

#[test]
fn every_included_file_is_in_the_package() -> Result<()> {
    let mut count = 0;
    for package in published()? {
        let files = listed(&package)?;
        for file in files.iter().filter(|file| file.extension().is_some_and(|extension| extension == "rs")) {
            let source = fs::read_to_string(package.folder().join(file))?;
            let missing = missing(file, &source, &files);
            assert!(missing.is_empty(), "{}: {} includes {missing:?}", package.name, file.display());
            count += included(&source).len();
        }
    }
    assert!(count > 50, "only {count} included files were found");
    Ok(())
}

#[test]
fn an_included_file_outside_the_package_is_found() {
    let listed = BTreeSet::from(["src/lib.rs", "src/a.wgsl", "data/x.toml"].map(PathBuf::from));
    let check = |source: &str| missing(Path::new("src/lib.rs"), source, &listed);
    assert!(check(r#"include_str!("a.wgsl"); include_bytes!( "../data/x.toml")"#).is_empty());
    assert!(check(r#"include_str!(concat!("../data/", $name, ".toml"))"#).is_empty());
    assert_eq!(check(r#"include_str!("../../README.md")"#), ["../../README.md"]);
    assert_eq!(check(r#"include_str!("b.wgsl")"#), ["b.wgsl"]);
    assert_eq!(check(r#"include_bytes!(concat!("../pictures/", $name))"#), ["../pictures/"]);
}

#[test]
fn every_package_has_its_readme_and_licences() -> Result<()> {
    for package in published()? {
        let files = listed(&package)?;
        for name in ["README.md", "LICENSE-MIT", "LICENSE-APACHE"] {
            assert!(files.contains(Path::new(name)), "{} is packed without {name}", package.name);
        }
        for name in ["LICENSE-MIT", "LICENSE-APACHE"] {
            let ours = fs::read_to_string(root().join(name))?;
            // A clone on Windows may contain the target of the link instead of the linked text.
            let packed = fs::read_to_string(package.folder().join(name))?;
            assert!(packed == ours || packed.trim() == format!("../../{name}"), "{}: {name}", package.name);
        }
    }
    Ok(())
}

#[test]
fn every_package_is_described() -> Result<()> {
    let packages = published()?;
    assert!(packages.iter().any(|package| package.name == "splashdown"), "the library is published");
    for package in &packages {
        let name = &package.name;
        assert!(package.description.is_some(), "{name} has no description");
        assert!(package.license.is_some(), "{name} has no licence");
        assert!(package.repository.is_some(), "{name} has no repository");
        assert!(package.readme.is_some(), "{name} has no readme");
        // The registry's limits.
        assert!((1..=5).contains(&package.keywords.len()), "{name} has {} keywords", package.keywords.len());
        assert!((1..=5).contains(&package.categories.len()), "{name} has {:?}", package.categories);
        assert!(package.keywords.iter().all(|keyword| keyword.len() <= 20), "{name}: {:?}", package.keywords);
    }
    for name in ["xtask", "splashdown-docs", "splashdown-web", "splashdown-packaging"] {
        assert!(!packages.iter().any(|package| package.name == name), "{name} must not be published");
    }
    Ok(())
}

#[test]
fn no_readme_of_a_package_links_to_a_file_of_the_repository() -> Result<()> {
    for package in published()? {
        let readme = package.readme.as_deref().context("a readme")?;
        let text = fs::read_to_string(package.folder().join(readme))?;
        for target in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            let works = target.starts_with("https://") || target.starts_with('#');
            assert!(works, "{}: the link to {target} works only in the repository", package.name);
        }
    }
    Ok(())
}
