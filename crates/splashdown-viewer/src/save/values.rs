//! Numbers in scene files.

use glam::{DQuat, EulerRot, Quat, Vec3};
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

/// A rotation as degrees about x, then y, then z. They are computed in double precision, because the angles are ill-conditioned
/// near 90 degrees about y.
pub fn degrees(rotation: Quat) -> Item {
    let rotation = DQuat::from_array(rotation.to_array().map(f64::from)).normalize();
    let (z, y, x) = rotation.to_euler(EulerRot::ZYX);
    value([x, y, z].map(|angle| shortest(angle.to_degrees() as f32)).into_iter().collect::<Array>())
}
