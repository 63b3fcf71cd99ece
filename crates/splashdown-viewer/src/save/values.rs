//! Numbers in scene files.

use glam::{DQuat, EulerRot, Quat, Vec3};
use toml_edit::{Array, Item, value};

use crate::items::{decimal, decimals};

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

pub fn pair(values: [f32; 2]) -> Item {
    value(values.map(shortest).into_iter().collect::<Array>())
}

/// A unit vector with six decimals. Reading it normalises it.
pub fn direction(v: Vec3) -> Item {
    vector(decimals(v, 0.002))
}

/// A rotation as degrees about x, then y, then z. They are computed in double precision, because the angles are ill-conditioned
/// near 90 degrees about y, and have four decimals.
pub fn degrees(rotation: Quat) -> Item {
    let rotation = DQuat::from_array(rotation.to_array().map(f64::from)).normalize();
    let (z, y, x) = rotation.to_euler(EulerRot::ZYX);
    value(
        [x, y, z]
            .map(|angle| shortest(decimal(angle.to_degrees() as f32, 0.2)))
            .into_iter()
            .collect::<Array>(),
    )
}
