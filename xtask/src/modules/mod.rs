//! The import graph of a crate's modules, for the test that forbids cycles and upward imports, and for
//! `ARCHITECTURE.md`.
//!
//! The source text is scanned for `crate::`, `self::` and `super::` paths outside comments, strings and items that exist
//! only for tests. Method calls and trait implementations are not recorded.

mod graph;
mod imports;
mod layers;
mod tokens;

use std::fmt::Write;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result};

use graph::Graph;

/// The graph of a crate, and the order that its root declares.
pub struct Modules {
    graph: Graph,
    order: Option<Vec<Vec<String>>>,
}

/// Reads the source folder of a crate.
///
/// # Errors
/// If a file cannot be read.
pub fn read(source: &Path) -> Result<Modules> {
    let sources = graph::sources(source)?;
    let roots = ["lib.rs", "main.rs", "examples.rs"];
    let root = roots.iter().map(|name| source.join(name)).find(|path| path.exists());
    let root = root.with_context(|| format!("{} has no root", source.display()))?;
    let text = fs::read_to_string(&root).with_context(|| format!("cannot read {}", root.display()))?;
    Ok(Modules { graph: graph::graph(&sources), order: layers::declared(&text) })
}

impl Modules {
    /// Cycles, and imports that violate the declared order.
    pub fn problems(&self) -> Vec<String> {
        layers::problems(&self.graph, self.order.as_deref())
    }

    /// The modules that a module imports, from top to bottom.
    pub fn imports(&self, module: &str) -> Vec<String> {
        let Some(edges) = self.graph.get(module) else { return Vec::new() };
        self.sorted().into_iter().filter(|to| edges.contains_key(to)).collect()
    }

    /// The modules from top to bottom.
    pub fn sorted(&self) -> Vec<String> {
        layers::sorted(&self.graph, self.order.as_deref())
    }

    /// One line for each module, from top to bottom: its name and its imports.
    pub fn lines(&self) -> String {
        let sorted = self.sorted();
        let width = sorted.iter().map(String::len).max().unwrap_or(0);
        let mut text = String::new();
        for name in &sorted {
            let line = format!("{name:width$}  {}", self.imports(name).join(" "));
            let _ = writeln!(text, "{}", line.trim_end());
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use anyhow::Result;

    use super::read;
    use crate::guide::map;
    use crate::process::root;

    /// The crates of the workspace from bottom to top. A crate may depend only on those before it.
    const CRATES: [&str; 15] = [
        "splashdown-gpu",
        "splashdown-io",
        "splashdown",
        "splashdown-render",
        "splashdown-run",
        "splashdown-viewer",
        "splashdown-cli",
        "splashdown-py",
        "splashdown-web",
        "splashdown-docs",
        "splashdown-bindgen",
        "splashdown-packaging",
        "splashdown-shaders",
        "fuzz",
        "xtask",
    ];

    /// The dependencies of each crate that do not point down.
    fn upward(packages: &[map::Package]) -> Vec<String> {
        let height = |name: &str| CRATES.iter().position(|known| *known == name);
        let mut found = Vec::new();
        for package in packages {
            let Some(own) = height(&package.name) else {
                found.push(format!("the order of crates lacks {}", package.name));
                continue;
            };
            for used in package.uses.iter().filter(|used| height(used).is_none_or(|other| other >= own)) {
                found.push(format!("{} depends on {used}", package.name));
            }
        }
        found
    }

    #[test]
    fn imports_between_modules_point_down() -> Result<()> {
        let mut problems = Vec::new();
        for package in map::workspace()? {
            let (found, name) = (read(&package.source())?.problems(), package.name);
            problems.extend(found.into_iter().map(|problem| format!("{name}: {problem}")));
        }
        assert!(problems.is_empty(), "\n{}\n", problems.join("\n"));
        // Control: the largest crate declares its order, and its known imports are found.
        let modules = read(&root().join("crates/splashdown/src"))?;
        assert!(modules.order.is_some());
        assert!(modules.imports("cells").contains(&"state".to_owned()));
        Ok(())
    }

    #[test]
    fn dependencies_between_crates_point_down() -> Result<()> {
        let mut packages = map::workspace()?;
        assert_eq!(packages.len(), CRATES.len());
        assert_eq!(upward(&packages), [""; 0]);
        // Control: an upward dependency is found.
        let lowest = packages.iter_mut().find(|package| package.name == CRATES[0]);
        lowest.into_iter().for_each(|package| package.uses.extend(["splashdown".to_owned()]));
        assert_eq!(upward(&packages), ["splashdown-gpu depends on splashdown"]);
        Ok(())
    }

    #[test]
    fn the_graph_in_the_documents_is_up_to_date() -> Result<()> {
        for (path, text) in map::files()? {
            let name = path.file_name().unwrap_or_default();
            if name != "ARCHITECTURE.md" && name != "modules.md" {
                continue;
            }
            let committed = std::fs::read_to_string(&path)?.replace("\r\n", "\n");
            assert!(committed == text, "{} is out of date: run `cargo xtask guide`", path.display());
        }
        Ok(())
    }
}
