//! Generates the map of the code: a picture and a table of the crates, a table of their modules, and the graph of
//! modules in `ARCHITECTURE.md`.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};

use super::PAGES;
use crate::modules;
use crate::process::root;

/// A crate of the workspace.
pub struct Package {
    pub name: String,
    /// Folder relative to the repository.
    pub folder: String,
    description: String,
    /// Crates of the workspace that it depends on, optional ones included.
    pub uses: BTreeSet<String>,
}

impl Package {
    /// The folder with its source files.
    pub fn source(&self) -> PathBuf {
        let folder = root().join(&self.folder);
        // The crate of the documents' examples is a single file.
        if folder.join("src").exists() { folder.join("src") } else { folder }
    }
}

/// The generated files with their contents.
///
/// # Errors
/// If a manifest or a module cannot be read.
pub fn files() -> Result<Vec<(PathBuf, String)>> {
    let packages = packages()?;
    let folder = root().join(PAGES).join("generated");
    Ok(vec![
        (folder.join("crates.svg"), picture(&packages)),
        (folder.join("crates.md"), crates_table(&packages)),
        (folder.join("modules.md"), modules_table(&packages)?),
        architecture(&packages)?,
    ])
}

/// The crates that the map shows: all except the build tools.
///
/// # Errors
/// If a manifest cannot be read.
pub fn packages() -> Result<Vec<Package>> {
    let mut packages = workspace()?;
    packages.retain(|package| package.folder == "web" || package.folder.starts_with("crates/"));
    Ok(packages)
}

/// All members of the workspace.
///
/// # Errors
/// If a manifest cannot be read.
pub fn workspace() -> Result<Vec<Package>> {
    let manifest = fs::read_to_string(root().join("Cargo.toml")).context("cannot read Cargo.toml")?;
    let mut folders = Vec::new();
    for member in members(&manifest) {
        match member.strip_suffix("/*") {
            Some(folder) => {
                for entry in fs::read_dir(root().join(folder))? {
                    folders.push(format!("{folder}/{}", entry?.file_name().to_string_lossy()));
                }
            }
            None => folders.push(member.to_owned()),
        }
    }
    folders.sort();
    folders.retain(|folder| root().join(folder).join("Cargo.toml").exists());
    let manifest = |folder: &String| {
        let path = root().join(folder).join("Cargo.toml");
        let text = fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
        Ok(package(folder, &text))
    };
    folders.iter().map(manifest).collect()
}

/// The folders that the manifest of a workspace lists as members.
fn members(manifest: &str) -> Vec<&str> {
    let list = manifest.lines().find_map(|line| line.strip_prefix("members = ["));
    list.into_iter().flat_map(|list| list.split('"').skip(1).step_by(2)).collect()
}

/// Reads the keys of a manifest that the map shows.
fn package(folder: &str, manifest: &str) -> Package {
    let text = |key: &str| {
        let line = manifest.lines().find_map(|line| line.strip_prefix(key)?.trim().strip_prefix('='));
        line.unwrap_or_default().trim().trim_matches('"').to_owned()
    };
    let mut uses = BTreeSet::new();
    let mut is_dependency = false;
    for line in manifest.lines() {
        if let Some(section) = line.strip_prefix('[') {
            is_dependency = section.ends_with("dependencies]")
                && !section.contains("dev-")
                && !section.contains("build-");
        } else if is_dependency && line.starts_with("splashdown") {
            let end = line.find([' ', '.', '=']).unwrap_or(line.len());
            uses.insert(line[..end].to_owned());
        }
    }
    Package { name: text("name"), folder: folder.to_owned(), description: text("description"), uses }
}

/// The longest path from each crate to one without dependencies.
fn levels(packages: &[Package]) -> BTreeMap<&str, usize> {
    let mut levels: BTreeMap<&str, usize> =
        packages.iter().map(|package| (package.name.as_str(), 0)).collect();
    // Cargo allows no cycles, so this ends after at most as many rounds as there are crates.
    for _ in packages {
        for package in packages {
            let above =
                package.uses.iter().filter_map(|name| levels.get(name.as_str())).max().map(|level| level + 1);
            levels.insert(&package.name, above.unwrap_or(0));
        }
    }
    levels
}

/// True if `from` reaches `to` through another crate.
fn is_indirect(packages: &[Package], from: &Package, to: &str) -> bool {
    let find = |name: &str| packages.iter().find(|package| package.name == name);
    from.uses
        .iter()
        .filter(|name| *name != to)
        .filter_map(|name| find(name))
        .any(|between| between.uses.contains(to) || is_indirect(packages, between, to))
}

const BOX: [usize; 2] = [170, 36];
const GAP: [usize; 2] = [24, 44];

/// Boxes in rows by level, with lines to the direct dependencies.
fn picture(packages: &[Package]) -> String {
    let levels = levels(packages);
    let highest = levels.values().copied().max().unwrap_or(0);
    let row = |level: usize| -> Vec<&Package> {
        packages.iter().filter(|package| levels[package.name.as_str()] == level).collect()
    };
    let most = (0..=highest).map(|level| row(level).len()).max().unwrap_or(1);
    let size = [most * (BOX[0] + GAP[0]) + GAP[0], (highest + 1) * (BOX[1] + GAP[1]) + GAP[1] / 2];
    let mut places = BTreeMap::new();
    for level in 0..=highest {
        let width = row(level).len() * (BOX[0] + GAP[0]) - GAP[0];
        for (index, package) in row(level).into_iter().enumerate() {
            let x = (size[0] - width) / 2 + index * (BOX[0] + GAP[0]);
            let y = (highest - level) * (BOX[1] + GAP[1]) + GAP[1] / 2;
            places.insert(package.name.as_str(), [x, y]);
        }
    }
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" font-family=\"sans-serif\" font-size=\"14\">\n\
         <defs><marker id=\"tip\" viewBox=\"0 0 8 8\" refX=\"8\" refY=\"4\" markerWidth=\"8\" markerHeight=\"8\" orient=\"auto\">\
         <path d=\"M0 0L8 4L0 8z\" fill=\"#56788c\"/></marker></defs>\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n",
        size[0], size[1]
    );
    for package in packages {
        let [x, y] = places[package.name.as_str()];
        for name in package.uses.iter().filter(|name| !is_indirect(packages, package, name)) {
            let Some([to_x, to_y]) = places.get(name.as_str()) else { continue };
            let middle = BOX[0] / 2;
            let _ = writeln!(
                svg,
                "<path d=\"M{} {}L{} {}\" stroke=\"#56788c\" fill=\"none\" marker-end=\"url(#tip)\"/>",
                x + middle,
                y + BOX[1],
                to_x + middle,
                to_y
            );
        }
    }
    for package in packages {
        let [x, y] = places[package.name.as_str()];
        let [width, height] = BOX;
        let _ = writeln!(
            svg,
            "<rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" rx=\"5\" fill=\"#e3eef5\" stroke=\"#56788c\"/>\
             <text x=\"{}\" y=\"{}\" text-anchor=\"middle\" fill=\"#1d3646\">{}</text>",
            x + width / 2,
            y + height / 2 + 5,
            package.name
        );
    }
    svg + "</svg>\n"
}

fn crates_table(packages: &[Package]) -> String {
    let levels = levels(packages);
    let mut sorted: Vec<_> = packages.iter().collect();
    sorted.sort_by_key(|package| (levels[package.name.as_str()], &package.name));
    let mut text = "| crate | folder | purpose |\n|---|---|---|\n".to_owned();
    for package in sorted {
        let _ =
            writeln!(text, "| `{}` | `{}` | {} |", package.name, package.folder, cell(&package.description));
    }
    text
}

/// `ARCHITECTURE.md` with the graph of modules between its markers.
fn architecture(packages: &[Package]) -> Result<(PathBuf, String)> {
    const MARKS: [&str; 2] = ["<!-- ANCHOR: modules -->\n", "<!-- ANCHOR_END: modules -->"];
    let path = root().join("ARCHITECTURE.md");
    let text = fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
    let text = text.replace("\r\n", "\n");
    let parts =
        text.split_once(MARKS[0]).and_then(|(before, rest)| Some((before, rest.split_once(MARKS[1])?.1)));
    let (before, after) =
        parts.with_context(|| format!("{} lacks the markers of the module graph", path.display()))?;
    let levels = levels(packages);
    let mut sorted: Vec<_> = packages.iter().collect();
    sorted.sort_by_key(|package| (levels[package.name.as_str()], &package.name));
    let mut section = String::new();
    for package in sorted {
        let modules = modules::read(&package.source())?;
        let problems = modules.problems();
        ensure!(problems.is_empty(), "imports of {}:\n  {}", package.name, problems.join("\n  "));
        let lines = modules.lines();
        if !lines.is_empty() {
            let _ = write!(section, "\n`{}`:\n\n```text\n{lines}```\n", package.name);
        }
    }
    Ok((path, format!("{before}{}{section}\n{}{after}", MARKS[0], MARKS[1])))
}

fn modules_table(packages: &[Package]) -> Result<String> {
    let levels = levels(packages);
    let mut sorted: Vec<_> = packages.iter().collect();
    sorted.sort_by_key(|package| (levels[package.name.as_str()], &package.name));
    let mut text = String::new();
    for package in sorted {
        let source = package.source();
        let (purposes, graph) = (purposes(&source)?, modules::read(&source)?);
        if purposes.is_empty() {
            continue;
        }
        let _ = write!(
            text,
            "{}### {}\n\n| module | purpose | imports |\n|---|---|---|\n",
            if text.is_empty() { "" } else { "\n" },
            package.name
        );
        for name in graph.sorted() {
            let purpose = purposes.get(&name).map_or("", String::as_str);
            let imports = graph.imports(&name).join("`, `");
            let imports = if imports.is_empty() { imports } else { format!("`{imports}`") };
            let _ = writeln!(text, "| `{name}` | {} | {imports} |", cell(purpose));
        }
    }
    Ok(text)
}

/// The modules in a source folder with the first sentence of their documentation.
fn purposes(source: &Path) -> Result<BTreeMap<String, String>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(source).with_context(|| format!("cannot read {}", source.display()))? {
        let path = entry?.path();
        let Some(name) = path.file_stem().and_then(|name| name.to_str()).map(str::to_owned) else { continue };
        let file = if path.is_dir() { path.join("mod.rs") } else { path };
        let is_root = matches!(name.as_str(), "lib" | "main" | "tests");
        if is_root || file.extension().is_none_or(|end| end != "rs") || !file.exists() {
            continue;
        }
        found.insert(name, first_sentence(&fs::read_to_string(&file)?));
    }
    Ok(found)
}

/// The first sentence of a module's documentation, without links.
fn first_sentence(text: &str) -> String {
    let lines = text.lines().map_while(|line| line.strip_prefix("//!")).map(str::trim);
    let paragraph: Vec<&str> = lines.take_while(|line| !line.is_empty()).collect();
    let paragraph = paragraph.join(" ");
    let end = paragraph.find(". ").map_or(paragraph.len(), |end| end + 1);
    let mut sentence = String::new();
    let mut rest = &paragraph[..end];
    while let Some((before, after)) = rest.split_once('[') {
        sentence += before;
        let (inside, after) = after.split_once(']').unwrap_or((after, ""));
        sentence += inside;
        rest = match after.strip_prefix('(') {
            Some(target) => target.split_once(')').map_or("", |(_, after)| after),
            None => after,
        };
    }
    sentence + rest
}

/// Text for a cell of a table.
fn cell(text: &str) -> String {
    text.replace('|', "\\|")
}

#[cfg(test)]
mod tests {
    use super::{first_sentence, is_indirect, levels, members, package};

    #[test]
    fn the_members_of_a_workspace_are_read() {
        let manifest = "[workspace]\nmembers = [\"crates/*\", \"web\"]\ndefault-members = [\"crates/*\"]\n";
        assert_eq!(members(manifest), ["crates/*", "web"]);
        assert_eq!(members("[package]\n"), [""; 0]);
    }

    #[test]
    fn manifests_are_read() {
        let text = "[package]\nname = \"splashdown-x\"\ndescription = \"An \\\"x\\\"\"\n[features]\nsplashdown-no = []\n\
                    [dependencies]\nsplashdown-gpu.workspace = true\nsplashdown = { workspace = true, optional = true }\nserde = \"1\"\n\
                    [dev-dependencies]\nsplashdown-io.workspace = true\n";
        let package = package("crates/x", text);
        assert_eq!(package.name, "splashdown-x");
        assert_eq!(package.uses.iter().collect::<Vec<_>>(), ["splashdown", "splashdown-gpu"]);
    }

    #[test]
    fn levels_and_indirect_dependencies() {
        let make = |name: &str, uses: &[&str]| {
            let lines: String = uses.iter().map(|name| format!("{name} = \"1\"\n")).collect();
            package("", &format!("name = \"{name}\"\n[dependencies]\n{lines}"))
        };
        let packages = [
            make("splashdown-c", &["splashdown-a", "splashdown-b"]),
            make("splashdown-b", &["splashdown-a"]),
            make("splashdown-a", &[]),
        ];
        let levels = levels(&packages);
        assert_eq!([levels["splashdown-a"], levels["splashdown-b"], levels["splashdown-c"]], [0, 1, 2]);
        assert!(is_indirect(&packages, &packages[0], "splashdown-a"));
        assert!(!is_indirect(&packages, &packages[0], "splashdown-b"));
    }

    #[test]
    fn the_first_sentence_has_no_links() {
        let text = "//! From [`A`](crate::A) to [B],\n//! and on. Then more.\n//!\n//! Other.\n";
        assert_eq!(first_sentence(text), "From `A` to B, and on.");
        assert_eq!(first_sentence("use x;"), "");
    }
}
