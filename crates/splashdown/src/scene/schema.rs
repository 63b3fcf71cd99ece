//! The JSON schema and the reference of the scene file, both from the table of keys.

use std::fmt::Write;

use serde_json::{Map, Value, json};

use super::keys::ROOT;
use super::presets::presets;
use super::spec::{Key, Kind, Range, Table, UNITS, Word};
use super::types::Scene;
use super::values::describe;
use crate::flow::outlet;
use crate::sample;

/// The JSON schema (draft 2020-12) of the scene file, for editors: types, ranges, words, required keys; no
/// others allowed. What depends on several keys at once (a sphere needs a radius, blocks lie in the domain)
/// only [`crate::scene::Scene::parse`] checks.
pub fn schema() -> Value {
    let mut schema = table(&ROOT);
    if let Value::Object(root) = &mut schema {
        root.insert("$schema".into(), "https://json-schema.org/draft/2020-12/schema".into());
        root.insert("title".into(), "Splashdown scene".into());
    }
    schema
}

fn table(spec: &Table) -> Value {
    let properties: Map<String, Value> =
        spec.keys.iter().map(|key| (key.name.to_owned(), property(key))).collect();
    let required: Vec<_> = spec.keys.iter().filter(|key| key.required).map(|key| key.name).collect();
    json!({
        "type": "object",
        "description": spec.about,
        "properties": properties,
        "required": required,
        "additionalProperties": false,
    })
}

fn property(key: &Key) -> Value {
    let mut value = match key.kind {
        Kind::Number(range) => number("number", range),
        Kind::Numbers(count, range) => list(count, number("number", range)),
        Kind::Scale(range) => {
            let units: Vec<_> = UNITS.iter().map(|(word, _)| *word).collect();
            json!({ "anyOf": [number("number", range), { "type": "string", "enum": units }] })
        }
        Kind::Integer(range) => number("integer", range),
        Kind::Integers(count, range) => list(count, number("integer", range)),
        Kind::Boolean => json!({ "type": "boolean" }),
        Kind::Name => json!({ "type": "string", "pattern": "^[A-Za-z0-9][A-Za-z0-9_-]{0,63}$" }),
        Kind::Text(_) => json!({ "type": "string", "minLength": 1 }),
        Kind::Texts(count, _) => list(count, json!({ "type": "string", "minLength": 1 })),
        Kind::Word(words) => one_of(&words()),
        Kind::Words(words) => json!({ "type": "array", "items": one_of(&words()), "uniqueItems": true }),
        Kind::Table(inner) => table(inner),
        Kind::Tables(inner, most) => {
            json!({ "type": "array", "items": table(inner), "minItems": 1, "maxItems": most })
        }
    };
    value["description"] = about(key).into();
    if let Some(default) = default_value(key) {
        value["default"] = default;
    }
    value
}

fn number(kind: &str, range: Range) -> Value {
    let end = |x: f64| if kind == "integer" { json!(x as i64) } else { json!(x) };
    json!({ "type": kind, "minimum": end(range.least), "maximum": end(range.most) })
}

fn list(count: usize, items: Value) -> Value {
    json!({ "type": "array", "items": items, "minItems": count, "maxItems": count })
}

fn one_of(words: &[Word]) -> Value {
    let names: Vec<_> = words.iter().map(|(word, _)| *word).collect();
    json!({ "type": "string", "enum": names })
}

/// The key's sentence with its unit and the meaning of its words.
fn about(key: &Key) -> String {
    let mut text = key.about.to_owned();
    match key.kind {
        Kind::Number(range) | Kind::Numbers(_, range) | Kind::Integers(_, range)
            if !range.unit.is_empty() =>
        {
            let _ = write!(text, " In {}.", range.unit);
        }
        Kind::Word(words) | Kind::Words(words) => {
            for (word, about) in words() {
                let _ = write!(text, " {word}: {}.", about.trim_end_matches('.'));
            }
        }
        _ => {}
    }
    text
}

fn default_value(key: &Key) -> Option<Value> {
    if key.default.is_empty() {
        return None;
    }
    let line: toml::Table = format!("value = {}", key.default).parse().ok()?;
    serde_json::to_value(line.get("value")?).ok()
}

/// The scenes that come with the program and every key of the scene file, as a page of Markdown.
pub fn reference() -> String {
    let mut page =
        String::from("# Scenes\n\n| scene | particles | method | what one sees |\n|---|---|---|---|\n");
    for (name, text) in presets() {
        let (count, method) = Scene::parse(text, name)
            .map(|scene| (particles(&scene), scene.solver.method.to_string()))
            .unwrap_or_default();
        let lines = text.lines().map_while(|line| line.strip_prefix("# "));
        let _ = writeln!(
            page,
            "| [{name}]({name}.toml) | {count} | {method} | {} |",
            lines.collect::<Vec<_>>().join(" ")
        );
    }
    page.push_str(
        "\n# The scene file\n\nTOML; SI units; y is up. Unknown keys are errors. A default of `-` follows from other values, as the key's \
         meaning tells. `#:schema scene.schema.json` as a file's first line gives completion in editors that know Taplo.\n",
    );
    describe_table(&mut page, &ROOT, "", false);
    page
}

/// Those at the start, and those that emitters bring.
fn particles(scene: &Scene) -> String {
    let count = sample::count(scene);
    match outlet::forecast(scene) {
        Ok((emitted @ 1.., _)) if count == 0 => format!("up to {emitted}"),
        Ok((emitted @ 1.., _)) => format!("{count}, up to {}", count + emitted),
        _ => count.to_string(),
    }
}

fn describe_table(page: &mut String, spec: &Table, path: &str, many: bool) {
    let values = spec.keys.iter().filter(|key| !matches!(key.kind, Kind::Table(_) | Kind::Tables(..)));
    if !path.is_empty() {
        let header = if many { format!("[[{path}]]") } else { format!("[{path}]") };
        let _ = write!(
            page,
            "\n## `{header}`\n\n{}\n\n| key | meaning | allowed | default |\n|---|---|---|---|\n",
            spec.about
        );
        for key in values {
            let default = match (key.required, key.default) {
                (true, _) => "required".to_owned(),
                (false, "") => "-".to_owned(),
                (false, text) => format!("`{text}`"),
            };
            let _ = writeln!(page, "| `{}` | {} | {} | {default} |", key.name, about(key), describe(key));
        }
    }
    for key in spec.keys {
        if let Kind::Table(inner) | Kind::Tables(inner, _) = key.kind {
            let inner_path =
                if path.is_empty() { key.name.to_owned() } else { format!("{path}.{}", key.name) };
            describe_table(page, inner, &inner_path, matches!(key.kind, Kind::Tables(..)));
        }
    }
}
