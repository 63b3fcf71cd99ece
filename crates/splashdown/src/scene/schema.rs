//! The JSON schema of scene files and the description of their keys, generated from the table of keys.

use std::fmt::Write;

use serde_json::{Map, Value, json};

use super::keys::ROOT;
use super::spec::{Key, Kind, LONGEST_LINE, Range, Table, UNITS, Word};
use super::values::describe;

/// The JSON schema (draft 2020-12) of scene files, for editors: types, ranges, values and required keys; other keys are
/// not allowed. Conditions on several keys (a sphere needs a radius, blocks lie in the domain) are only checked by
/// [`crate::scene::Scene::parse`].
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
        Kind::Scale(range) => json!({ "anyOf": [number("number", range), unit()] }),
        Kind::Scales(range) => {
            let axes = list(3, json!({ "anyOf": [number("number", range), unit()] }));
            json!({ "anyOf": [number("number", range), unit(), axes] })
        }
        Kind::Integer(range) => number("integer", range),
        Kind::Integers(count, range) => list(count, number("integer", range)),
        Kind::Boolean => json!({ "type": "boolean" }),
        Kind::Name => json!({ "type": "string", "pattern": "^[A-Za-z0-9][A-Za-z0-9_-]{0,63}$" }),
        Kind::Text(_) => json!({ "type": "string", "minLength": 1 }),
        Kind::Line(_) => json!({ "type": "string", "pattern": format!("^[^\\r\\n]{{0,{LONGEST_LINE}}}$") }),
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

/// The name of a unit of length.
fn unit() -> Value {
    let names: Vec<_> = UNITS.iter().map(|(word, _)| *word).collect();
    json!({ "type": "string", "enum": names })
}

fn list(count: usize, items: Value) -> Value {
    json!({ "type": "array", "items": items, "minItems": count, "maxItems": count })
}

fn one_of(words: &[Word]) -> Value {
    let names: Vec<_> = words.iter().map(|(word, _)| *word).collect();
    json!({ "type": "string", "enum": names })
}

/// The key's description with its unit and the meaning of its values.
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

/// Every key of a scene file, section by section, as Markdown.
pub(crate) fn keys_reference(page: &mut String) {
    describe_table(page, &ROOT, "", false);
}

fn describe_table(page: &mut String, spec: &Table, path: &str, many: bool) {
    let values = spec.keys.iter().filter(|key| !matches!(key.kind, Kind::Table(_) | Kind::Tables(..)));
    if !path.is_empty() {
        let header = if many { format!("[[{path}]]") } else { format!("[{path}]") };
        let _ = write!(
            page,
            "\n### `{header}`\n\n{}\n\n| key | meaning | allowed | default |\n|---|---|---|---|\n",
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
