//! The graph of modules: which module of a crate imports which, for the test that forbids cycles and imports upward, and
//! for `ARCHITECTURE.md`.
//!
//! It is a scan of the text: `crate::`, `self::` and `super::` paths outside of comments, strings and items for tests
//! alone. Methods and trait implementations are not seen.

mod graph;
mod imports;
mod layers;
mod tokens;

use std::fmt::Write;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result};

use graph::Graph;

/// The crates of the workspace from bottom to top. A crate may depend on those before it alone.
pub const CRATES: [&str; 10] = [
    "splashdown-gpu",
    "splashdown-io",
    "splashdown",
    "splashdown-render",
    "splashdown-run",
    "splashdown-viewer",
    "splashdown-cli",
    "splashdown-web",
    "splashdown-bindgen",
    "xtask",
];

/// A crate's graph, and the order that its root declares.
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
    let root = ["lib.rs", "main.rs"].iter().map(|name| source.join(name)).find(|path| path.exists());
    let root = root.with_context(|| format!("{} has no root", source.display()))?;
    let text = fs::read_to_string(&root).with_context(|| format!("cannot read {}", root.display()))?;
    Ok(Modules { graph: graph::graph(&sources), order: layers::declared(&text) })
}

impl Modules {
    /// Cycles, and imports against the declared order.
    pub fn problems(&self) -> Vec<String> {
        layers::problems(&self.graph, self.order.as_deref())
    }

    /// The modules from top to bottom.
    pub fn sorted(&self) -> Vec<String> {
        layers::sorted(&self.graph, self.order.as_deref())
    }

    /// One line for each module, from top to bottom: its name, and what it imports.
    pub fn lines(&self) -> String {
        let sorted = self.sorted();
        let width = sorted.iter().map(String::len).max().unwrap_or(0);
        let mut text = String::new();
        for name in &sorted {
            let imported: Vec<&str> = sorted
                .iter()
                .filter(|to| self.graph.get(name).is_some_and(|edges| edges.contains_key(*to)))
                .map(String::as_str)
                .collect();
            let line = format!("{name:width$}  {}", imported.join(" "));
            let _ = writeln!(text, "{}", line.trim_end());
        }
        text
    }
}
