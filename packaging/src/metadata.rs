//! The part of `cargo metadata` that packaging needs.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use semver::Version;
use serde::Deserialize;

use crate::command::{cargo, output};

/// Packages and, optionally, their dependencies.
#[derive(Debug, Deserialize)]
pub struct Metadata {
    pub packages: Vec<Package>,
    pub resolve: Option<Resolve>,
    pub target_directory: PathBuf,
}

/// One package.
#[derive(Debug, Deserialize)]
#[cfg_attr(not(test), expect(dead_code, reason = "the test of the packages reads all fields"))]
pub struct Package {
    pub id: String,
    pub name: String,
    pub version: Version,
    pub description: Option<String>,
    pub license: Option<String>,
    pub license_file: Option<PathBuf>,
    pub repository: Option<String>,
    pub readme: Option<PathBuf>,
    pub keywords: Vec<String>,
    pub categories: Vec<String>,
    pub manifest_path: PathBuf,
    pub publish: Option<Vec<String>>,
    /// The registry of the package; `None` for packages of this workspace.
    pub source: Option<String>,
}

impl Package {
    /// The folder of the package.
    pub fn folder(&self) -> &Path {
        self.manifest_path.parent().unwrap_or(&self.manifest_path)
    }
}

/// The dependencies between packages.
#[derive(Debug, Deserialize)]
pub struct Resolve {
    nodes: Vec<Node>,
}

#[derive(Debug, Deserialize)]
struct Node {
    id: String,
    deps: Vec<Dependency>,
}

#[derive(Debug, Deserialize)]
struct Dependency {
    pkg: String,
    dep_kinds: Vec<DependencyKind>,
}

#[derive(Debug, Deserialize)]
struct DependencyKind {
    /// `build` or `dev`; `None` for a normal dependency.
    kind: Option<String>,
}

impl Metadata {
    /// Runs `cargo metadata` with further arguments.
    ///
    /// # Errors
    /// If cargo fails.
    pub fn ask(arguments: &[&str]) -> Result<Self> {
        let text = output(cargo(["metadata", "--format-version", "1"]).args(arguments))?;
        serde_json::from_str(&text).context("cannot read the output of `cargo metadata`")
    }

    /// The dependencies of a package that are linked into it, by id.
    pub fn dependencies(&self, id: &str) -> Vec<&str> {
        let nodes = self.resolve.iter().flat_map(|resolve| &resolve.nodes);
        let own = nodes.filter(|node| node.id == id).flat_map(|node| &node.deps);
        let linked = own.filter(|dependency| dependency.dep_kinds.iter().any(|kind| kind.kind.is_none()));
        linked.map(|dependency| dependency.pkg.as_str()).collect()
    }

    /// The packages that are linked into a package, itself included, by name and version.
    ///
    /// # Errors
    /// If there is no such package.
    pub fn linked_into(&self, name: &str) -> Result<Vec<&Package>> {
        let start = self.packages.iter().find(|package| package.name == name && package.source.is_none());
        let start = start.with_context(|| format!("no package is called {name}"))?;
        let nodes = self.resolve.as_ref().context("`cargo metadata` printed no dependencies")?;
        let nodes: BTreeMap<&str, &Node> = nodes.nodes.iter().map(|node| (node.id.as_str(), node)).collect();
        let packages: BTreeMap<&str, &Package> =
            self.packages.iter().map(|package| (package.id.as_str(), package)).collect();
        let mut found = BTreeMap::new();
        let mut open = vec![start.id.as_str()];
        while let Some(id) = open.pop() {
            let package = packages.get(id).with_context(|| format!("no package has the id {id}"))?;
            if found.insert((&package.name, &package.version), *package).is_some() {
                continue;
            }
            let dependencies = nodes.get(id).map_or(&[][..], |node| &node.deps);
            open.extend(
                dependencies
                    .iter()
                    .filter(|dependency| dependency.dep_kinds.iter().any(|kind| kind.kind.is_none()))
                    .map(|dependency| dependency.pkg.as_str()),
            );
        }
        Ok(found.into_values().collect())
    }
}
