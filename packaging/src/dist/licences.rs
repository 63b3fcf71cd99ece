//! The licences of all packages that are linked into the program.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Result, ensure};

use super::{PACKAGE, target::Target};
use crate::command::say;
use crate::metadata::{Metadata, Package};

/// Prefixes of the names of licence files, in capitals. OFL and UFL are font licences.
const NAMES: [&str; 8] = ["LICENSE", "LICENCE", "COPYING", "COPYRIGHT", "NOTICE", "UNLICENSE", "OFL", "UFL"];

/// Depth of the folders of a package that are searched for licence files.
const DEPTH: usize = 2;

/// A list of the packages with their licences, followed by the texts.
///
/// # Errors
/// If a package states no licence at all.
pub fn text(target: &Target) -> Result<String> {
    let mut arguments = vec!["--locked", "--filter-platform", target.triple.as_str()];
    arguments.extend(["--manifest-path", "crates/splashdown-cli/Cargo.toml"]);
    arguments.extend(target.features());
    let metadata = Metadata::ask(&arguments)?;
    let packages = metadata.linked_into(PACKAGE)?;
    let packages: Vec<&Package> = packages.into_iter().filter(|package| package.source.is_some()).collect();
    let mut list = String::new();
    // Packages with the same text share one copy.
    let mut texts: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let mut without_text = Vec::new();
    for package in packages {
        let name = format!("{} {}", package.name, package.version);
        let found = files(package)?;
        ensure!(package.license.is_some() || !found.is_empty(), "{name} states no licence");
        list += &format!("{name}: {}\n", package.license.as_deref().unwrap_or("see its text below"));
        if let Some(repository) = &package.repository {
            list += &format!("    {repository}\n");
        }
        if found.is_empty() {
            without_text.push(name.clone());
        }
        for file in found {
            let text = fs::read(&file)?;
            let text = String::from_utf8_lossy(&text).replace("\r\n", "\n").trim().to_owned();
            let names = texts.entry(text).or_default();
            if !names.contains(&name) {
                names.push(name.clone());
            }
        }
    }
    if !without_text.is_empty() {
        say(format!("Packages without a licence text, listed by name only: {}", without_text.join(", ")));
    }
    let texts: String =
        texts.iter().map(|(text, names)| format!("\n{RULE}\n{}\n\n{text}\n", names.join(", "))).collect();
    let musl = if target.is_static() { MUSL } else { "" };
    Ok(format!("{HEADING}{musl}\n{list}{texts}"))
}

const RULE: &str = "--------------------------------------------------------------------------------";

const HEADING: &str = "\
Splashdown is licensed under MIT or Apache-2.0. It contains the following packages, listed with their
licences; the texts follow. A package without its own text is under the named standard licences.
It also contains the Rust standard library (MIT or Apache-2.0, https://github.com/rust-lang/rust).
";

const MUSL: &str = "It is linked with musl (MIT, https://musl.libc.org).\n";

/// The licence files of a package.
fn files(package: &Package) -> Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    find(package.folder(), DEPTH, &mut found)?;
    if let Some(file) = &package.license_file {
        let file = package.folder().join(file);
        if file.exists() && !found.contains(&file) {
            found.push(file);
        }
    }
    found.sort();
    Ok(found)
}

fn find(folder: &Path, depth: usize, found: &mut Vec<PathBuf>) -> Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().to_uppercase();
        if path.is_dir() {
            if depth > 0 && !matches!(name.as_str(), "TESTS" | "BENCHES" | "EXAMPLES" | "SRC") {
                find(&path, depth - 1, found)?;
            }
        } else if is_licence(&name) {
            found.push(path);
        }
    }
    Ok(())
}

/// True for `LICENSE-MIT`, `COPYING.TXT` and the like; not for `LICENSE.RS`.
fn is_licence(name: &str) -> bool {
    let known = NAMES.iter().any(|start| name.starts_with(start));
    let extension = Path::new(name).extension().and_then(|extension| extension.to_str());
    known && !matches!(extension, Some("RS" | "TOML" | "JSON" | "HTML"))
}

#[cfg(test)]
mod tests {
    use super::is_licence;

    #[test]
    fn licence_files_are_recognized_by_their_names() {
        for name in ["LICENSE", "LICENSE-MIT", "LICENSE.APACHE-2.0", "COPYING.TXT", "OFL.TXT", "UNLICENSE"] {
            assert!(is_licence(name), "{name}");
        }
        for name in ["README.MD", "LICENSE.RS", "LICENSES.TOML"] {
            assert!(!is_licence(name), "{name}");
        }
    }
}
