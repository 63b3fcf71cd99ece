//! The graph of a crate's modules and their imports.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

use super::imports::{Imports, imports};
use super::tokens::{Token, tokens};

/// The name of the crate's root in a graph: `lib.rs` or `main.rs`.
pub const ROOT: &str = "the crate root";

/// Modules at the root of a crate, each with the modules that it imports and a file that contains the import.
pub type Graph = BTreeMap<String, BTreeMap<String, PathBuf>>;

/// A source file by its path below `src`, and its text.
pub type Source = (PathBuf, String);

/// Reads the source files of a crate.
///
/// # Errors
/// If one cannot be read.
pub fn sources(folder: &Path) -> Result<Vec<Source>> {
    let mut found = Vec::new();
    collect(folder, folder, &mut found)?;
    found.sort();
    Ok(found)
}

fn collect(root: &Path, folder: &Path, found: &mut Vec<Source>) -> Result<()> {
    for entry in fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))? {
        let path = entry?.path();
        if path.is_dir() {
            collect(root, &path, found)?;
        } else if path.extension().is_some_and(|end| end == "rs") {
            let text =
                fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
            found.push((path.strip_prefix(root).unwrap_or(&path).to_owned(), text));
        }
    }
    Ok(())
}

/// The graph of these files.
pub fn graph(sources: &[Source]) -> Graph {
    let read: Vec<(Vec<String>, &Path, Imports)> = sources
        .iter()
        .filter(|(path, _)| !path.starts_with("bin"))
        .map(|(path, text)| {
            let module = module_of(path);
            let imports = imports(text, &module);
            (module, path.as_path(), imports)
        })
        .collect();
    let mut excluded = BTreeSet::new();
    for (module, _, imports) in &read {
        for child in &imports.test_modules {
            excluded.insert([module.as_slice(), std::slice::from_ref(child)].concat());
        }
    }
    let is_excluded = |module: &[String]| (1..=module.len()).any(|n| excluded.contains(&module[..n]));
    let modules: BTreeSet<&str> = read
        .iter()
        .filter(|(module, ..)| !is_excluded(module))
        .filter_map(|(module, ..)| module.first().map(String::as_str))
        .collect();
    let root = sources.iter().find(|(path, _)| module_of(path).is_empty());
    let mut origins = root.map(|(_, text)| exports(text)).unwrap_or_default();
    for (module, _, imports) in &read {
        if let Some(module) = module.first() {
            origins.extend(imports.macros.iter().map(|name| (name.clone(), module.clone())));
        }
    }
    let mut graph: Graph = modules.iter().map(|name| ((*name).to_owned(), BTreeMap::new())).collect();
    for (module, path, imports) in &read {
        let Some(from) = module.first().filter(|_| !is_excluded(module)) else { continue };
        for name in &imports.names {
            let Some(to) = origin(name, &modules, &origins) else { continue };
            if to != from {
                let edges = graph.entry(from.clone()).or_default();
                edges.entry(to.to_owned()).or_insert_with(|| path.to_path_buf());
            }
        }
    }
    graph
}

/// The module that a name at the root of the crate belongs to: the module of that name, the module that it is re-exported
/// from, or the root. `None` for names of other crates.
fn origin<'a>(
    name: &'a str,
    modules: &BTreeSet<&str>,
    origins: &'a BTreeMap<String, String>,
) -> Option<&'a str> {
    if modules.contains(name) {
        return Some(name);
    }
    match origins.get(name) {
        Some(module) => modules.contains(module.as_str()).then_some(module),
        None => Some(ROOT),
    }
}

/// The path of the module in a file: empty for the root.
fn module_of(path: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        path.with_extension("").iter().map(|name| name.to_string_lossy().into_owned()).collect();
    let is_index = names.last().is_some_and(|name| name == "mod");
    let is_root = names.len() == 1 && matches!(names[0].as_str(), "lib" | "main");
    if is_index || is_root {
        names.pop();
    }
    names
}

/// The names that the root of a crate re-exports, each with the module or crate that it comes from.
fn exports(root: &str) -> BTreeMap<String, String> {
    let tokens = tokens(root);
    let mut found = BTreeMap::new();
    let mut i = 0;
    while i < tokens.len() {
        if tokens[i].is("use") {
            let end = tokens[i..].iter().position(|token| *token == Token::Sign(';'));
            let end = end.map_or(tokens.len(), |length| i + length);
            read_tree(&tokens[i + 1..end], None, &mut found);
            i = end;
        }
        i += 1;
    }
    found
}

/// A tree of a `use` declaration, whose paths begin in `first`.
fn read_tree(tokens: &[Token], first: Option<&str>, found: &mut BTreeMap<String, String>) {
    let Some(open) = tokens.iter().position(|token| *token == Token::Sign('{')) else {
        let words: Vec<&str> =
            tokens.iter().filter_map(Token::word).filter(|word| *word != "crate").collect();
        if let (Some(name), Some(origin)) = (words.last(), first.or(words.first().copied())) {
            found.insert((*name).to_owned(), origin.to_owned());
        }
        return;
    };
    let prefix =
        tokens[..open].iter().filter_map(Token::word).find(|word| !matches!(*word, "crate" | "self"));
    let first = first.or(prefix);
    let mut depth = 0;
    let mut start = open + 1;
    for (i, token) in tokens.iter().enumerate().skip(open) {
        match token {
            Token::Sign('{') => depth += 1,
            Token::Sign('}') => depth -= 1,
            _ => {}
        }
        let is_end = depth == 0;
        if is_end || (depth == 1 && *token == Token::Sign(',')) {
            read_tree(&tokens[start..i], first, found);
            start = i + 1;
        }
        if is_end {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{ROOT, graph};

    #[test]
    fn names_are_those_of_modules_root_items_and_other_crates() {
        let sources = [
            (
                "lib.rs",
                "mod a; mod b; pub use a::{A, deep::{B as C}}; pub use {glam, other::D}; pub fn item() {}",
            ),
            ("a.rs", "mod deep; #[cfg(test)] mod tests; #[macro_export] macro_rules! made { () => {} }"),
            ("a/deep.rs", "pub struct B;"),
            ("a/tests.rs", "use crate::b;"),
            ("b/mod.rs", "use crate::C; use crate::glam::Vec3; use crate::D; fn f() { crate::item() }"),
            ("c.rs", "fn f() { crate::made!() } use super::b::X; use self::super::b;"),
            ("bin/tool.rs", "use crate::a;"),
        ];
        let sources = sources.map(|(path, text)| (path.into(), text.to_owned()));
        let graph = graph(&sources);
        let edges = |name: &str| graph[name].keys().map(String::as_str).collect::<Vec<_>>();
        assert_eq!(graph.keys().collect::<Vec<_>>(), ["a", "b", "c"]);
        assert_eq!(edges("a"), [""; 0]);
        assert_eq!(edges("b"), ["a", ROOT]);
        assert_eq!(edges("c"), ["a", "b"]);
    }
}
