//! Numbers in scene files.

use glam::Vec3;
use toml_edit::{Array, Item, value};

/// The number with the shortest decimal notation that gives the same `f32`.
fn shortest(x: f32) -> f64 {
    x.to_string().parse().unwrap_or(f64::from(x))
}

pub fn number(x: f32) -> Item {
    value(shortest(x))
}

pub fn vector(v: Vec3) -> Item {
    value(v.to_array().map(shortest).into_iter().collect::<Array>())
}
