//! The JSON schema and the reference: up to date, consistent with the parser, and satisfied by every scene.

use std::fs;

use serde_json::{Value, json};
use splashdown::check::reference;
use splashdown::scene::{DensityMode, Method, Solver, SurfaceSettings, presets, schema};

use crate::{CUBE, parse, presets::folder};

/// Compares a generated text with the committed file, or rewrites the file if `UPDATE_EXPECT` is set.
fn expect_file(name: &str, generated: &str) {
    let path = folder().join(name);
    if std::env::var_os("UPDATE_EXPECT").is_some() {
        fs::write(&path, generated).expect("writing the file");
    }
    let committed = fs::read_to_string(&path).unwrap_or_default().replace("\r\n", "\n");
    assert!(
        committed == generated,
        "crates/splashdown/scenes/{name} is out of date: run `UPDATE_EXPECT=1 cargo test -p splashdown --test scenes` and commit it"
    );
}

#[test]
fn the_schema_is_as_committed() {
    let text = serde_json::to_string_pretty(&schema()).expect("the schema is plain data") + "\n";
    expect_file("scene.schema.json", &text);
}

#[test]
fn the_reference_is_as_committed() {
    expect_file("README.md", &reference());
}

/// The violations of a schema by a value, for the part of JSON Schema that the project uses.
fn complaints(value: &Value, schema: &Value, path: &str) -> Vec<String> {
    if let Some(choices) = schema["anyOf"].as_array() {
        let fits = choices.iter().any(|choice| complaints(value, choice, path).is_empty());
        return if fits { Vec::new() } else { vec![format!("{path}: matches none of the choices")] };
    }
    let mut found = Vec::new();
    let kind = schema["type"].as_str().unwrap_or_default();
    let fits = match kind {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "boolean" => value.is_boolean(),
        "number" => value.is_number(),
        "integer" => value.is_i64(),
        other => panic!("{path}: the checker does not support the type {other:?}"),
    };
    if !fits {
        return vec![format!("{path}: not of type {kind}")];
    }
    if schema["enum"].as_array().is_some_and(|words| !words.contains(value)) {
        found.push(format!("{path}: not one of the allowed values"));
    }
    if let Some(number) = value.as_f64() {
        let in_range = schema["minimum"].as_f64().is_none_or(|least| number >= least)
            && schema["maximum"].as_f64().is_none_or(|most| number <= most);
        if !in_range {
            found.push(format!("{path}: out of range"));
        }
    }
    if let Some(items) = value.as_array() {
        let count = items.len() as u64;
        if schema["minItems"].as_u64().is_some_and(|least| count < least)
            || schema["maxItems"].as_u64().is_some_and(|most| count > most)
        {
            found.push(format!("{path}: wrong number of items"));
        }
        for (index, item) in items.iter().enumerate() {
            found.extend(complaints(item, &schema["items"], &format!("{path}[{index}]")));
        }
    }
    if let Some(object) = value.as_object() {
        assert_eq!(schema["additionalProperties"], json!(false), "{path}: every table rejects unknown keys");
        for name in schema["required"].as_array().into_iter().flatten().filter_map(Value::as_str) {
            if !object.contains_key(name) {
                found.push(format!("{path}: {name} is missing"));
            }
        }
        for (name, item) in object {
            match schema["properties"].get(name) {
                Some(inner) => found.extend(complaints(item, inner, &format!("{path}.{name}"))),
                None => found.push(format!("{path}: {name} is unknown")),
            }
        }
    }
    found
}

fn as_json(text: &str) -> Value {
    let table: toml::Table = text.parse().expect("TOML");
    serde_json::to_value(table).expect("no dates in scenes")
}

#[test]
fn every_scene_satisfies_the_schema() {
    let schema = schema();
    for (name, text) in presets() {
        assert_eq!(complaints(&as_json(text), &schema, name), Vec::<String>::new());
    }
    assert!(complaints(&as_json(CUBE), &schema, "cube").is_empty());
}

/// Negative controls of the checker above, and consistency of schema and parser: both reject each of these errors and
/// accept the cube.
#[test]
fn schema_and_parser_reject_the_same_errors() {
    let schema = schema();
    let mistakes = [
        ("duration = 1.0", "duration = \"1.0\""),
        ("duration = 1.0", "duration = 0"),
        ("duration = 1.0", ""),
        ("frame_rate", "frame_rte"),
        ("0.05", "100"),
        ("0.05", "[0.05]"),
        ("[1, 1, 1]", "[1, 1]"),
        ("[1, 1, 1]", "[1, 1, \"1\"]"),
        ("\"wcsph\"", "\"sph\""),
        ("\"wcsph\"", "3"),
        ("[solver]", "[solver]\nsmoothing_iterations = 3"),
        ("[solver]", "[surface]\nsmoothing_iterations = 3.5\n[solver]"),
        ("[solver]", "[surface]\nenabled = 1\n[solver]"),
        ("[solver]", "[output]\nformats = [\"png\"]\n[solver]"),
        ("[[fluid.block]]", "[fluid.block]"),
        ("[domain]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n", ""),
    ];
    for (from, to) in mistakes {
        let text = crate::changed(from, to);
        assert!(
            !complaints(&as_json(&text), &schema, "cube").is_empty(),
            "the schema accepts {to:?} for {from:?}"
        );
        assert!(parse(&text).is_err(), "the parser accepts {to:?} for {from:?}");
    }
}

/// Tests every key of the schema with its default or an allowed value: the parser accepts it, and the documented
/// defaults are the actual defaults.
#[test]
fn the_parser_accepts_every_key_of_the_schema_and_uses_its_defaults() {
    let schema = schema();
    let plain = parse(CUBE).expect("the cube is valid");
    let mut seen = 0;
    for (section, table) in schema["properties"].as_object().expect("sections") {
        // The keys of lists of sections are tested with the lists.
        let Some(keys) = table["properties"].as_object() else { continue };
        for (name, key) in keys {
            let Some(default) = key.get("default") else { continue };
            // Keys without effect for the plain method; their defaults are compared below.
            if ["density_diffusion", "contact_angle"].contains(&name.as_str()) {
                continue;
            }
            let header = format!("[{section}]");
            let line = format!("{header}\n{name} = {default}\n");
            let text = if !CUBE.contains(&header) {
                format!("{CUBE}{line}")
            } else if CUBE.contains(&format!("\n{name} = ")) {
                continue;
            } else {
                CUBE.replacen(&format!("{header}\n"), &line, 1)
            };
            let scene = parse(&text).unwrap_or_else(|errors| panic!("{section}.{name}: {errors}"));
            let scene = {
                let mut changed = scene;
                changed.text = plain.text.clone();
                changed
            };
            assert_eq!(scene, plain, "{section}.{name} = {default} is not the default");
            seen += 1;
        }
    }
    assert!(seen > 20, "only {seen} defaults were compared");
    assert_eq!(plain.solver, Solver::with(Method::Wcsph, DensityMode::Summation));
    assert_eq!(plain.surface, SurfaceSettings::for_spacing(0.05));
    for (name, standard) in
        [("density_diffusion", plain.solver.density_diffusion), ("contact_angle", plain.solver.contact_angle)]
    {
        let default = &schema["properties"]["solver"]["properties"][name]["default"];
        assert_eq!(default.as_f64().map(|x| x as f32), Some(standard), "{name}");
    }
}

#[test]
fn a_scene_without_a_method_uses_the_default_that_its_keys_allow() {
    let solver = |keys: &str| parse(&CUBE.replace("method = \"wcsph\"", keys)).map(|scene| scene.solver);
    assert_eq!(solver("").unwrap(), Solver::default());
    assert_eq!(solver("").unwrap().method, Method::Dfsph);
    for (keys, method) in [
        ("tolerance = 0.002", Method::Dfsph),
        ("support_ratio = 3", Method::Dfsph),
        ("density = \"continuity\"", Method::Wcsph),
        ("sound_speed = 20", Method::Wcsph),
        ("accuracy = \"engineering\"", Method::Wcsph),
        ("accuracy = \"standard\"", Method::Dfsph),
    ] {
        assert_eq!(solver(keys).unwrap().method, method, "{keys}");
    }
    // Keys of both.
    let errors = solver("tolerance = 0.002\nsound_speed = 20").unwrap_err().to_string();
    assert!(errors.contains("solver.tolerance has no effect with method = \"wcsph\""), "{errors}");
}
