//! The bill of materials of the program (SBOM): every package in it with version, licence, checksum and dependencies, in
//! the format of CycloneDX 1.6 (ECMA-424).
//!
//! *Why own code:* `cargo-cyclonedx` takes minutes to compile and writes one file per package of the workspace; the
//! format is one JSON object, and `cargo metadata` and `Cargo.lock` contain everything in it.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use serde_json::{Value, json};
use toml_edit::DocumentMut;

use crate::command::{root, say};
use crate::metadata::{Metadata, Package};

/// The package of the program.
const PROGRAM: &str = "splashdown-cli";

/// The command `sbom`.
///
/// # Errors
/// For wrong arguments; if cargo fails or the file cannot be written.
pub fn run(arguments: &[String]) -> Result<()> {
    let out = match arguments {
        [] => None,
        [flag, path] if flag == "--out" => Some(PathBuf::from(path)),
        other => bail!("sbom takes --out FILE or nothing, got {}", other.join(" ")),
    };
    let metadata = Metadata::ask(&["--locked", "--all-features"])?;
    let text = serde_json::to_string_pretty(&bill(&metadata, &checksums()?)?)?;
    let path = out.unwrap_or_else(|| metadata.target_directory.join("splashdown.cdx.json"));
    fs::write(&path, text + "\n").with_context(|| format!("cannot write {}", path.display()))?;
    say(format!("Wrote {}.", path.display()));
    Ok(())
}

/// The checksums in `Cargo.lock` by name and version.
fn checksums() -> Result<BTreeMap<(String, String), String>> {
    let lock: DocumentMut = fs::read_to_string(root().join("Cargo.lock"))?.parse()?;
    let packages = lock["package"].as_array_of_tables().context("Cargo.lock lists no packages")?;
    let text = |table: &toml_edit::Table, key: &str| Some(table.get(key)?.as_str()?.to_owned());
    let entry = |table| Some(((text(table, "name")?, text(table, "version")?), text(table, "checksum")?));
    Ok(packages.iter().filter_map(entry).collect())
}

/// The whole document. It has no date and no serial number, so that the same sources give the same file.
fn bill(metadata: &Metadata, checksums: &BTreeMap<(String, String), String>) -> Result<Value> {
    let packages = metadata.linked_into(PROGRAM)?;
    let program =
        packages.iter().find(|package| package.name == PROGRAM).context("the program is missing")?;
    let inside: BTreeSet<&str> = packages.iter().map(|package| package.id.as_str()).collect();
    let names: BTreeMap<&str, String> =
        packages.iter().map(|package| (package.id.as_str(), reference(package))).collect();
    let dependencies = packages.iter().map(|package| {
        let linked = metadata.dependencies(&package.id).into_iter().filter(|id| inside.contains(id));
        let linked: BTreeSet<&String> = linked.filter_map(|id| names.get(id)).collect();
        json!({ "ref": reference(package), "dependsOn": linked })
    });
    let others = packages.iter().filter(|package| package.name != PROGRAM);
    let mut main = component(program, checksums);
    main["type"] = json!("application");
    Ok(json!({
        "bomFormat": "CycloneDX",
        "specVersion": "1.6",
        "version": 1,
        "metadata": { "component": main },
        "components": others.map(|package| component(package, checksums)).collect::<Vec<_>>(),
        "dependencies": dependencies.collect::<Vec<_>>(),
    }))
}

fn component(package: &Package, checksums: &BTreeMap<(String, String), String>) -> Value {
    let mut component = json!({
        "type": "library",
        "bom-ref": reference(package),
        "name": package.name,
        "version": package.version.to_string(),
        "purl": reference(package),
    });
    if let Some(license) = &package.license {
        // Older packages separate alternatives by a slash.
        component["licenses"] = json!([{ "expression": license.replace('/', " OR ") }]);
    }
    if let Some(checksum) = checksums.get(&(package.name.clone(), package.version.to_string())) {
        component["hashes"] = json!([{ "alg": "SHA-256", "content": checksum }]);
    }
    if let Some(repository) = &package.repository {
        component["externalReferences"] = json!([{ "type": "vcs", "url": repository }]);
    }
    component
}

/// The package URL, which identifies the package.
fn reference(package: &Package) -> String {
    format!("pkg:cargo/{}@{}", package.name, package.version)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::{bill, checksums};
    use crate::metadata::Metadata;

    #[test]
    fn the_bill_lists_every_package_with_licence_checksum_and_dependencies() {
        let metadata = Metadata::ask(&["--locked", "--all-features"]).unwrap();
        let bill = bill(&metadata, &checksums().unwrap()).unwrap();
        let components = bill["components"].as_array().unwrap();
        let known: BTreeSet<&str> = components.iter().filter_map(|it| it["bom-ref"].as_str()).collect();
        assert_eq!(known.len(), components.len(), "references are unique");
        for part in ["wgpu", "zip", "splashdown-io"] {
            assert!(components.iter().any(|it| it["name"] == part), "{part} is missing");
        }
        assert!(!components.iter().any(|it| it["name"] == "proptest"), "a package that only tests use");
        for component in components {
            assert!(component["licenses"][0]["expression"].is_string(), "{component}");
            let is_ours = component["name"].as_str().unwrap().starts_with("splashdown");
            let checksum = component["hashes"][0]["content"].as_str().map(str::len);
            assert_eq!(checksum, (!is_ours).then_some(64), "{component}");
        }
        for node in bill["dependencies"].as_array().unwrap() {
            for on in node["dependsOn"].as_array().unwrap() {
                assert!(known.contains(on.as_str().unwrap()), "{on} is not listed");
            }
        }
    }
}
