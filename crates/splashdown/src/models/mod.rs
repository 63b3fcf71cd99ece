//! Meshes that come with the program, made by its own code.

mod shapes;

use splashdown_io::Mesh;

/// The models: their names and what they are.
pub fn names() -> &'static [(&'static str, &'static str)] {
    &[("cube", "a cube of 1 m, its middle at the origin")]
}

/// Makes a model in m, y up; `None` if there is none of this name.
pub fn build(name: &str) -> Option<Mesh> {
    match name {
        "cube" => Some(shapes::cuboid([1.0; 3])),
        _ => None,
    }
}
