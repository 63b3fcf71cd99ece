//! Scene files: accepted and rejected input, error messages, and sampling of blocks.

mod bodies;
mod camera;
mod derived;
mod errors;
mod files;
mod fill;
mod flow;
mod formats;
mod guide;
mod hostile;
mod picture;
mod presets;
mod probes;
mod sampling;
mod schema;

use splashdown::scene::{Scene, SceneErrors};

/// A small valid scene; tests change single lines of it.
const CUBE: &str = "\
[scene]
name = \"cube\"
duration = 1.0
frame_rate = 25

[domain]
min = [0, 0, 0]
max = [1, 1, 1]

[fluid]
particle_spacing = 0.05

[[fluid.block]]
position = [0, 0, 0]
size = [0.5, 0.5, 0.5]

[solver]
method = \"wcsph\"
";

fn parse(text: &str) -> Result<Scene, SceneErrors> {
    Scene::parse(text, "scene.toml")
}

/// The cube with one piece of text replaced by another.
fn changed(from: &str, to: &str) -> String {
    assert!(CUBE.contains(from), "{from:?} is not in the scene");
    CUBE.replace(from, to)
}
