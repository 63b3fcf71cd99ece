//! Errors in the files that a scene refers to, with the line of the scene.

use std::fs;
use std::path::Path;

use splashdown::scene::Scene;
use splashdown_io::{Mesh, write_mesh};

use crate::CUBE;

/// One square metre in two triangles: a sheet.
const SHEET: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";

fn load(folder: &Path, addition: &str) -> Result<Scene, String> {
    let path = folder.join("scene.toml");
    fs::write(&path, format!("{CUBE}\n{addition}\n")).expect("written");
    Scene::load(&path).map_err(|errors| errors.to_string())
}

fn warnings(scene: &Scene) -> String {
    scene.warnings.iter().map(|warning| format!("{warning}\n")).collect()
}

fn body(mesh: &str) -> String {
    format!("[[body]]\nname = \"rock\"\nmesh = {mesh:?}\nposition = [0.7, 0.5, 0.7]")
}

fn write_cube(path: &Path, edge: f32) {
    let mut cube: Mesh = splashdown::models::build("cube").expect("a model");
    for v in &mut cube.vertices {
        *v = v.map(|c| c * edge);
    }
    write_mesh(path, &cube).expect("written");
}

#[test]
fn broken_files_are_reported_with_file_line_and_name() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("written");
    write("empty.obj", "");
    write("points.obj", "v 0 0 0\nv 1 0 0\n");
    write("nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n");
    write("text.stl", "this is a letter");
    write("short.ply", "ply\nformat ascii 1.0\n");
    write("sheet.obj", SHEET);
    write("picture.png", "x");
    let file = |name: &str| format!("[[fluid.file]]\nfile = {name:?}");
    let fill = |name: &str| format!("[[fluid.mesh]]\nmesh = {name:?}");
    let emitter = |name: &str| {
        format!(
            "[[emitter]]\nname = \"tap\"\nshape = \"mesh\"\nmesh = {name:?}\nposition = [0.5, 0.5, 0.5]\ndirection = [0, 0, 1]\nspeed = 1"
        )
    };
    let sink = |name: &str| format!("[[sink]]\nname = \"drain\"\nshape = \"mesh\"\nmesh = {name:?}");
    for (text, parts) in [
        (body("gone.obj"), &["scene.toml:22:8", "body[0].mesh: there is no file", "gone.obj"][..]),
        (body("empty.obj"), &["scene.toml:22:8", "body \"rock\"", "empty.obj", "none of its 0 lines"]),
        (body("points.obj"), &["body \"rock\"", "points.obj"]),
        (body("nan.obj"), &["body \"rock\"", "nan.obj", "not finite"]),
        (body("text.stl"), &["body \"rock\"", "text.stl"]),
        (body("picture.png"), &["body \"rock\"", "picture.png", ".obj"]),
        (file("gone.ply"), &["scene.toml:21:8", "fluid.file[0].file: there is no file"]),
        (file("short.ply"), &["scene.toml:21:8", "fluid.file[0] (\"short.ply\")"]),
        (file("sheet.obj"), &["fluid.file[0]", ".npy"]),
        (fill("gone.obj"), &["scene.toml:21:8", "fluid.mesh[0].mesh: there is no file"]),
        (fill("sheet.obj"), &["scene.toml:21:8", "fluid.mesh[0] (\"sheet.obj\")", "is open", "close it"]),
        (fill("thin-cup"), &["fluid.mesh[0] (\"thin-cup\")", "is open"]),
        (emitter("sheet.obj"), &["scene.toml:23:8", "emitter \"tap\" (sheet.obj)", "is open"]),
        (sink("sheet.obj"), &["scene.toml:23:8", "sink \"drain\" (sheet.obj)", "is open"]),
        (sink("gone.obj"), &["sink[0].mesh: there is no file"]),
    ] {
        let message = load(folder.path(), &text).map(drop).expect_err(&text);
        for part in parts {
            assert!(message.contains(part), "{text}\n{message}");
        }
    }
}

#[test]
fn implausible_sizes_are_rejected_with_a_suggested_unit() {
    let folder = tempfile::tempdir().expect("a folder");
    write_cube(&folder.path().join("cube.stl"), 300.0);
    let message = load(folder.path(), &body("cube.stl")).map(drop).expect_err("300 m");
    assert!(message.contains("body \"rock\" (cube.stl) is 300.0000 m long"), "{message}");
    assert!(message.contains("give it scale = \"mm\"") && message.contains("scene.toml:20"), "{message}");
    let scene = load(folder.path(), &format!("{}\nscale = \"mm\"", body("cube.stl")))
        .expect("the suggestion is valid");
    assert!(scene.warnings.is_empty(), "{}", warnings(&scene));
    write_cube(&folder.path().join("cube.stl"), 0.3);
    let message =
        load(folder.path(), &format!("{}\nscale = \"mm\"", body("cube.stl"))).map(drop).expect_err("0.3 mm");
    assert!(message.contains("probably not in millimetres; take scale out"), "{message}");
    let filled = "[[fluid.mesh]]\nmesh = \"cube.stl\"\nposition = [0.7, 0.7, 0.7]\nscale = 1000";
    let message = load(folder.path(), filled).map(drop).expect_err("300 m");
    assert!(message.contains("give it a smaller scale, for example 1"), "{message}");
    let small = "[[fluid.mesh]]\nmesh = \"cube.stl\"\nposition = [0.7, 0.7, 0.7]\nscale = 0.05";
    let message = load(folder.path(), small).map(drop).expect_err("15 mm are less than a spacing");
    assert!(message.contains("fluid.mesh[0]") && message.contains("0.05 m"), "{message}");
}

#[test]
fn fluid_outside_the_domain_is_rejected() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = "[[fluid.mesh]]\nmesh = \"sphere\"\nposition = [0.95, 0.7, 0.7]";
    let message = load(folder.path(), text).map(drop).expect_err("partly outside");
    assert!(message.contains("fluid.mesh[0] (\"sphere\") reaches outside the domain"), "{message}");
    assert!(load(folder.path(), &text.replace("0.95", "0.7")).is_ok(), "control");
}

#[test]
fn bodies_outside_the_domain_give_a_warning() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = body("block").replace("0.5,", "2.5,");
    let found = warnings(&load(folder.path(), &text).expect("valid"));
    assert!(
        found.contains("body \"rock\" lies entirely outside the domain") && found.contains("scene.toml:23"),
        "{found}"
    );
    let comes = format!("{text}\nmove = [\"0\", \"-4*t\", \"0\"]");
    let found = load(folder.path(), &comes).expect("valid");
    assert!(found.warnings.is_empty(), "control: it enters later: {}", warnings(&found));
    let leaves = format!("{text}\nmove = [\"0\", \"4*t\", \"0\"]");
    let found = warnings(&load(folder.path(), &leaves).expect("valid"));
    assert!(found.contains("entirely outside"), "{found}");
}

#[test]
fn an_outlet_inside_a_body_is_rejected() {
    let folder = tempfile::tempdir().expect("a folder");
    let tap = |y: f32| {
        format!(
            "[[emitter]]\nname = \"tap\"\nshape = \"rectangle\"\nsize = [0.1, 0.1]\nposition = [0.7, {y}, 0.7]\ndirection = [0, 1, 0]\nspeed = 1"
        )
    };
    let message =
        load(folder.path(), &format!("{}\n{}", body("block"), tap(0.5))).map(drop).expect_err("inside");
    assert!(
        message.contains("emitter \"tap\" lies inside body \"rock\"") && message.contains("scene.toml:28"),
        "{message}"
    );
    let moving = format!("{}\nmove = [\"t\", \"0\", \"0\"]\n{}", body("block"), tap(0.5));
    let found = warnings(&load(folder.path(), &moving).expect("valid"));
    assert!(found.contains("until the body moves away"), "{found}");
    for y in [0.6, 0.75] {
        let scene = load(folder.path(), &format!("{}\n{}", body("block"), tap(y)))
            .expect("on the surface and outside");
        assert!(scene.warnings.is_empty(), "{}", warnings(&scene));
    }
}

#[test]
fn an_outlet_of_a_mesh_must_hold_a_particle_and_lie_in_the_domain() {
    let folder = tempfile::tempdir().expect("a folder");
    let tap = |scale: f32, x: f32| {
        format!(
            "[[emitter]]\nname = \"tap\"\nshape = \"mesh\"\nmesh = \"cube\"\nscale = {scale}\nposition = [{x}, 0.8, 0.5]\n\
             direction = [0, -1, 0]\nspeed = 1"
        )
    };
    assert!(load(folder.path(), &tap(0.3, 0.5)).is_ok());
    let message = load(folder.path(), &tap(0.03, 0.5)).map(drop).expect_err("too small");
    assert!(
        message.contains("emitter \"tap\": the outline of its mesh") && message.contains("0.05 m"),
        "{message}"
    );
    let message = load(folder.path(), &tap(0.3, 0.99)).map(drop).expect_err("outside");
    assert!(message.contains("outlet of emitter \"tap\" reaches out of the domain"), "{message}");
}
