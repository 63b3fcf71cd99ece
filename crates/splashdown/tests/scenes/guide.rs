//! The TOML examples of the user guide are valid scenes, valid parts of one, or camera paths.

use std::fs;
use std::path::Path;

use splashdown::scene::CameraPath;
use toml::{Table, Value};

use crate::{CUBE, parse};

/// The TOML code blocks of a page with their lines.
fn blocks(page: &str) -> Vec<(usize, String)> {
    let mut blocks = Vec::new();
    let mut block: Option<(usize, String)> = None;
    for (index, line) in page.lines().enumerate() {
        match (&mut block, line.trim()) {
            (None, "```toml") => block = Some((index + 1, String::new())),
            (Some(_), "```") => blocks.extend(block.take()),
            (Some((_, text)), _) => *text += &format!("{line}\n"),
            (None, _) => {}
        }
    }
    blocks
}

/// Adds the keys of a part to a scene. Lists grow; other values are replaced.
fn merge(scene: &mut Table, part: Table) {
    for (key, value) in part {
        match (scene.get_mut(&key), value) {
            (Some(Value::Table(old)), Value::Table(new)) => merge(old, new),
            (Some(Value::Array(old)), Value::Array(new)) if new.iter().all(Value::is_table) => {
                old.extend(new)
            }
            (_, value) => {
                scene.insert(key, value);
            }
        }
    }
}

/// A block as a complete scene: a part is merged into the scene of the cube with a larger domain.
fn completed(block: &str) -> String {
    let part: Table = block.parse().unwrap_or_else(|error| panic!("{error}"));
    if part.contains_key("scene") {
        return block.to_owned();
    }
    let mut scene: Table =
        CUBE.replace("max = [1, 1, 1]", "max = [1.6, 1, 1]").parse().expect("the cube is TOML");
    merge(&mut scene, part);
    scene.to_string()
}

#[test]
fn every_scene_of_the_guide_is_valid() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/guide/src");
    let mut count = 0;
    for entry in fs::read_dir(folder).expect("the guide's folder") {
        let path = entry.expect("an entry").path();
        if path.extension().is_none_or(|end| end != "md") {
            continue;
        }
        for (line, block) in blocks(&fs::read_to_string(&path).expect("a page")) {
            if block.starts_with("[dependencies]") {
                continue;
            }
            if block.contains("\n[[keyframe]]\n") {
                let camera = &parse(CUBE).expect("the cube is valid").camera;
                let read = CameraPath::parse(&block, "a camera path", camera);
                read.unwrap_or_else(|errors| panic!("{}:{line}: {errors}", path.display()));
                continue;
            }
            let scene = parse(&completed(&block))
                .unwrap_or_else(|errors| panic!("{}:{line}: {errors}", path.display()));
            let mut warnings = scene.warnings.iter().map(ToString::to_string);
            if let Some(warning) = warnings.find(|warning| warning.contains("deprecated")) {
                panic!("{}:{line}: {warning}", path.display());
            }
            count += 1;
        }
    }
    assert!(count > 15, "only {count} examples were found");
}

/// Negative control: a wrong key in an example is detected.
#[test]
fn an_invalid_example_is_rejected() {
    let page = "Text\n\n```toml\n[solver]\nmethd = \"wcsph\"\n```\n";
    let [(line, block)] = &blocks(page)[..] else { panic!("one block") };
    assert_eq!(*line, 3);
    assert!(parse(&completed(block)).is_err());
    assert!(parse(&completed("[solver]\nsupport_ratio = 3\n")).is_ok());
}
