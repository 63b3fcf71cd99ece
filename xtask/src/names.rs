//! Checks that public signatures name only types that users can name too: each type of this workspace in a documented
//! signature is documented itself or re-exported.
//!
//! The check reads the description of a crate that rustdoc writes as JSON, without hidden items. Signatures are those of
//! functions, fields, constants and associated types, and the headers of implementations. Methods of trait
//! implementations are not read: their signatures are those of the trait.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use anyhow::{Context, Result, ensure};
use serde_json::Value;

/// Crates whose types count, by the beginning of their names.
const WORKSPACE: &str = "splashdown";

/// Keys of an item whose value is a list of the items in it.
const CHILDREN: [&str; 5] = ["items", "impls", "fields", "variants", "tuple"];

/// Reads a description and lists the types without a public name.
///
/// # Errors
/// If the file cannot be read, or has another format.
pub fn check(file: &Path) -> Result<Vec<String>> {
    let text = std::fs::read_to_string(file).with_context(|| format!("cannot read {}", file.display()))?;
    let description: Value = serde_json::from_str(&text)?;
    let names = Names::of(&description)?;
    ensure!(names.used.len() > 10, "{} has another format: it uses no types", file.display());
    Ok(names.unnamed())
}

/// What a user of a crate sees.
struct Names<'a> {
    description: &'a Value,
    /// Items with a public path, re-exported ones of other crates included.
    public: BTreeSet<u64>,
    /// Types in signatures, each with one item that uses it.
    used: BTreeMap<u64, String>,
}

impl<'a> Names<'a> {
    fn of(description: &'a Value) -> Result<Self> {
        let root = description["root"].as_u64().context("the description has no root")?;
        let mut names = Self { description, public: BTreeSet::new(), used: BTreeMap::new() };
        names.visit(root, "");
        Ok(names)
    }

    /// Records an item, the types in its signature, and the items in it.
    fn visit(&mut self, id: u64, parent: &str) {
        let item = &self.description["index"][id.to_string()];
        if !self.public.insert(id) || item.is_null() {
            return;
        }
        let name = item["name"].as_str().unwrap_or_default();
        let path = if parent.is_empty() || name.is_empty() {
            format!("{parent}{name}")
        } else {
            format!("{parent}::{name}")
        };
        let Some((kind, inner)) = item["inner"].as_object().and_then(|inner| inner.iter().next()) else {
            return;
        };
        match kind.as_str() {
            "use" => {
                let Some(target) = inner["id"].as_u64() else { return };
                let module = &self.description["index"][target.to_string()]["inner"]["module"];
                if inner["is_glob"] == true && module.is_object() {
                    self.walk(module, parent);
                } else {
                    self.visit(target, parent);
                }
            }
            // Implementations for every type are not part of this crate's API.
            "impl" if !inner["blanket_impl"].is_null() || inner["is_synthetic"] == true => {}
            "impl" if !inner["trait"].is_null() => {
                self.walk(&inner["trait"], &path);
                for id in inner["items"].as_array().into_iter().flatten().filter_map(Value::as_u64) {
                    if self.description["index"][id.to_string()]["inner"]["assoc_type"].is_object() {
                        self.visit(id, &path);
                    }
                }
            }
            _ => self.walk(inner, &path),
        }
    }

    /// Records the types in a part of an item, and the items that it lists.
    fn walk(&mut self, value: &Value, path: &str) {
        match value {
            Value::Object(map) => {
                if let Some(id) = map.get("resolved_path").and_then(|used| used["id"].as_u64()) {
                    self.used.entry(id).or_insert_with(|| path.to_owned());
                }
                for (key, value) in map.iter().filter(|(key, _)| *key != "implementations") {
                    let is_list = CHILDREN.contains(&key.as_str());
                    for id in
                        value.as_array().filter(|_| is_list).into_iter().flatten().filter_map(Value::as_u64)
                    {
                        self.visit(id, path);
                    }
                    self.walk(value, path);
                }
            }
            Value::Array(list) => list.iter().for_each(|value| self.walk(value, path)),
            _ => {}
        }
    }

    /// The types of the workspace in signatures that have no public path.
    fn unnamed(&self) -> Vec<String> {
        let mut found = Vec::new();
        for (id, user) in self.used.iter().filter(|(id, _)| !self.public.contains(id)) {
            let summary = &self.description["paths"][id.to_string()];
            let path = summary["path"].as_array().into_iter().flatten().filter_map(Value::as_str);
            let path = path.collect::<Vec<_>>().join("::");
            if path.starts_with(WORKSPACE) {
                found.push(format!("`{path}`, used by `{user}`"));
            }
        }
        found.sort();
        found
    }
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::Names;

    /// A crate with `pub fn f(x: &Hidden) -> Option<Other>`, where `Other` belongs to another crate of the workspace.
    fn description() -> Value {
        let of = |id: u64, args: Value| json!({ "resolved_path": { "path": "", "id": id, "args": args } });
        let output = of(9, json!({ "angle_bracketed": { "args": [{ "type": of(3, Value::Null) }] } }));
        json!({
            "root": 0,
            "index": {
                "0": { "name": "splashdown", "inner": { "module": { "items": [1] } } },
                "1": { "name": "f", "inner": { "function": { "sig": {
                    "inputs": [["x", { "borrowed_ref": { "type": of(2, Value::Null) } }]],
                    "output": output,
                } } } },
                "2": { "name": "Hidden", "inner": { "struct": { "kind": "unit", "impls": [] } } },
            },
            "paths": {
                "2": { "crate_id": 0, "path": ["splashdown", "private", "Hidden"] },
                "3": { "crate_id": 5, "path": ["splashdown_gpu", "Other"] },
                "9": { "crate_id": 1, "path": ["core", "option", "Option"] },
            },
        })
    }

    #[test]
    fn types_without_a_public_name_are_found() {
        let found = Names::of(&description()).unwrap().unnamed();
        let user = "used by `splashdown::f`";
        assert_eq!(
            found,
            [format!("`splashdown::private::Hidden`, {user}"), format!("`splashdown_gpu::Other`, {user}")]
        );
    }

    #[test]
    fn documented_and_re_exported_types_are_accepted() {
        let mut description = description();
        description["index"]["0"]["inner"]["module"]["items"] = json!([1, 2, 4]);
        description["index"]["4"] =
            json!({ "name": null, "inner": { "use": { "id": 3, "name": "Other", "is_glob": false } } });
        assert_eq!(Names::of(&description).unwrap().unnamed(), [""; 0]);
    }

    #[test]
    fn methods_of_trait_implementations_are_not_read_but_their_associated_types_are() {
        let mut description = description();
        let index = &mut description["index"];
        index["2"]["inner"]["struct"]["impls"] = json!([5]);
        index["0"]["inner"]["module"]["items"] = json!([2]);
        index["5"] = json!({ "name": null, "inner": { "impl": { "trait": { "path": "T", "id": 8 }, "items": [1, 6] } } });
        index["6"] = json!({ "name": "Item", "inner": { "assoc_type": { "type": null } } });
        assert_eq!(Names::of(&description).unwrap().unnamed(), [""; 0]);
        description["index"]["6"]["inner"]["assoc_type"]["type"] = json!({ "resolved_path": { "id": 3 } });
        let found = Names::of(&description).unwrap().unnamed();
        assert_eq!(found, ["`splashdown_gpu::Other`, used by `splashdown::Hidden::Item`"]);
    }
}
