//! A mug with thick walls, and a beaker with walls of zero thickness.

use std::f32::consts::TAU;

use glam::{Vec2, vec2, vec3};
use splashdown_io::Mesh;

use super::polygonise::polygonise;
use super::shape::{cut, join, lathe, profile};

pub(super) fn cup() -> Mesh {
    // The outer and inner profiles of the mug. The foot is a ring below a hollow bottom.
    let outside = profile(&[
        [0.0, 0.0045],
        [0.022, 0.0035],
        [0.0255, 0.0015],
        [0.0305, 0.0015],
        [0.034, 0.0032],
        [0.037, 0.0068],
        [0.039, 0.0118],
        [0.0402, 0.019],
        [0.041, 0.03],
        [0.0413, 0.05],
        [0.0411, 0.075],
        [0.0405, 0.0975],
        [0.0, 0.0975],
    ]);
    let inside = profile(&[
        [0.0, 0.0115],
        [0.024, 0.012],
        [0.0305, 0.015],
        [0.0335, 0.022],
        [0.0345, 0.05],
        [0.0345, 0.085],
        [0.0365, 0.13],
        [0.0, 0.13],
    ]);
    polygonise(vec3(-0.05, -0.006, -0.05), vec3(0.083, 0.108, 0.05), 0.0018, |p| {
        let body = lathe(p, &outside, 0.0015);
        // The handle is a ring in the xy plane, wider at the top, with a flattened cross section.
        let q = vec2(p.x - 0.041, p.y - 0.053);
        let lean = 1.0 + 3.0 * q.y;
        let elliptic_radius = (vec2(q.x / lean, q.y) / vec2(0.0285, 0.0325)).length();
        let across = (elliptic_radius - 1.0) * 0.0295;
        let handle = vec2(across / 0.0043, p.z / 0.0066).length();
        let handle = (handle - 1.0) * 0.0044;
        cut(join(body, handle, 0.007), lathe(p, &inside, 0.0015), 0.004)
    })
}

/// Number of vertices around the beaker.
const AROUND: u32 = 96;

/// A sheet of a bottom and a wall that widens upwards. Normals point out of the beaker.
pub(super) fn thin_cup() -> Mesh {
    let corner = 0.008;
    let mut line: Vec<Vec2> = (1..=8_u8).map(|i| vec2(0.0035 * f32::from(i), 0.0)).collect();
    for i in 1..=8_u8 {
        let (sin, cos) = (f32::from(i) / 8.0 * 85.0_f32.to_radians()).sin_cos();
        line.push(vec2(0.028 + corner * sin, corner * (1.0 - cos)));
    }
    let (foot, rim) = (line[line.len() - 1], vec2(0.0445, 0.1));
    line.extend((1..=28_u8).map(|i| foot.lerp(rim, f32::from(i) / 28.0)));
    let mut mesh = Mesh::new(vec![[0.0; 3]], Vec::new()).with_normals(vec![[0.0, -1.0, 0.0]]);
    let slope = |k: usize| {
        let before = if k == 0 { Vec2::ZERO } else { line[k - 1] };
        let along = line.get(k + 1).copied().unwrap_or(line[k]) - before;
        vec2(along.y, -along.x).normalize_or_zero()
    };
    for (k, point) in line.iter().enumerate() {
        for j in 0..AROUND {
            let (sin, cos) = (TAU * j as f32 / AROUND as f32).sin_cos();
            mesh.vertices.push([point.x * cos, point.y, point.x * sin]);
            mesh.normals.push([slope(k).x * cos, slope(k).y, slope(k).x * sin]);
            let at = |k: u32, j: u32| 1 + k * AROUND + j % AROUND;
            let k = k as u32;
            if k == 0 {
                mesh.triangles.push([0, at(0, j), at(0, j + 1)]);
            } else {
                let (a, b, c, d) = (at(k - 1, j), at(k - 1, j + 1), at(k, j + 1), at(k, j));
                mesh.triangles.extend([[a, c, b], [a, d, c]]);
            }
        }
    }
    mesh
}

/// The interior of a [`thin_cup`]: the same sheet, closed by a lid.
pub(super) fn thin_cup_filling() -> Mesh {
    let mut mesh = thin_cup();
    let middle = mesh.vertices.len() as u32;
    let rim = middle - AROUND;
    let height = mesh.vertices[rim as usize][1];
    mesh.vertices.push([0.0, height, 0.0]);
    mesh.normals.push([0.0, 1.0, 0.0]);
    mesh.triangles.extend((0..AROUND).map(|j| [middle, rim + (j + 1) % AROUND, rim + j]));
    mesh
}
