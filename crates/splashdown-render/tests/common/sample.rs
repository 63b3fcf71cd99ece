//! Synthetic input: a collapsing column of particles, a tank of water with waves, a ball.

use std::f32::consts::TAU;

/// Positions, velocities, densities and pressures.
#[derive(Default)]
pub struct Cloud {
    pub positions: Vec<[f32; 3]>,
    pub velocities: Vec<[f32; 3]>,
    pub densities: Vec<f32>,
    pub pressures: Vec<f32>,
}

/// A closed triangle mesh, counterclockwise as seen from outside.
pub struct Mesh {
    pub vertices: Vec<[f32; 3]>,
    pub normals: Vec<[f32; 3]>,
    pub triangles: Vec<[u32; 3]>,
}

/// A collapsing column of water: a lattice below a profile that falls from left to right.
pub fn collapsing_column(size: [f32; 3], spacing: f32) -> Cloud {
    let mut cloud = Cloud::default();
    let count = size.map(|side| (side / spacing) as usize);
    for k in 0..count[2] {
        for i in 0..count[0] {
            let (x, z) = ((i as f32 + 0.5) * spacing, (k as f32 + 0.5) * spacing);
            let u = x / size[0];
            let top = size[1] * ((1.0 - u).powi(2) * 0.85 + 0.03 * (9.0 * u + 4.0 * z).sin() * u + 0.06);
            for j in 0..((top / spacing) as usize).max(1) {
                let y = (j as f32 + 0.5) * spacing;
                cloud.positions.push([x, y, z]);
                cloud.velocities.push([3.0 * u, -1.2 * (1.0 - u) * y / size[1], 0.0]);
                let pressure = 9810.0 * (top - y).max(0.0);
                cloud.pressures.push(pressure);
                cloud.densities.push(1000.0 * (1.0 + pressure / 1e6));
            }
        }
    }
    cloud
}

/// Water with waves that fills a box from `min` to a mean height; `cells` quads along x and z each.
pub fn waves(min: [f32; 3], size: [f32; 3], cells: usize) -> Mesh {
    let side = cells + 1;
    let height = |u: f32, v: f32| {
        let ripple = 0.05 * (TAU * (3.0 * u + 1.3 * v)).sin() + 0.03 * (TAU * (1.1 * u - 4.2 * v)).sin();
        let swell = 0.34 * (-18.0 * (u - 0.30 - 0.1 * (TAU * v).sin()).powi(2)).exp();
        size[1] * (0.55 + ripple + swell - 0.15 * u)
    };
    let at = |i: usize, k: usize| [i as f32 / cells as f32, k as f32 / cells as f32];
    let mut mesh = Mesh { vertices: Vec::new(), normals: Vec::new(), triangles: Vec::new() };
    let step = 1e-3;
    // Upper face, with the normals of the height field.
    for k in 0..side {
        for i in 0..side {
            let [u, v] = at(i, k);
            let slope_x = (height(u + step, v) - height(u - step, v)) / (2.0 * step * size[0]);
            let slope_z = (height(u, v + step) - height(u, v - step)) / (2.0 * step * size[2]);
            mesh.vertices.push([min[0] + u * size[0], min[1] + height(u, v), min[2] + v * size[2]]);
            mesh.normals.push([-slope_x, 1.0, -slope_z]);
        }
    }
    for k in 0..cells {
        for i in 0..cells {
            let a = (k * side + i) as u32;
            let (b, c, d) = (a + 1, a + side as u32, a + side as u32 + 1);
            mesh.triangles.extend([[a, c, b], [b, c, d]]);
        }
    }
    // Walls and bottom: strips with separate vertices, so that edges stay sharp.
    let rim: Vec<([usize; 2], [f32; 3])> = (0..=cells)
        .map(|i| ([i, 0], [0.0, 0.0, -1.0]))
        .chain((0..=cells).map(|k| ([cells, k], [1.0, 0.0, 0.0])))
        .chain((0..=cells).rev().map(|i| ([i, cells], [0.0, 0.0, 1.0])))
        .chain((0..=cells).rev().map(|k| ([0, k], [-1.0, 0.0, 0.0])))
        .collect();
    for wall in rim.chunks(side) {
        for (index, &([i, k], normal)) in wall.iter().enumerate() {
            let [u, v] = at(i, k);
            let place = mesh.vertices.len() as u32;
            mesh.vertices.push([min[0] + u * size[0], min[1] + height(u, v), min[2] + v * size[2]]);
            mesh.vertices.push([min[0] + u * size[0], min[1], min[2] + v * size[2]]);
            mesh.normals.extend([normal; 2]);
            if index > 0 {
                let (upper, lower) = (place, place + 1);
                mesh.triangles.extend([[upper - 2, upper, lower], [upper - 2, lower, lower - 2]]);
            }
        }
    }
    let bottom = mesh.vertices.len() as u32;
    for [u, v] in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] {
        mesh.vertices.push([min[0] + u * size[0], min[1], min[2] + v * size[2]]);
        mesh.normals.push([0.0, -1.0, 0.0]);
    }
    mesh.triangles.extend([[bottom, bottom + 1, bottom + 2], [bottom, bottom + 2, bottom + 3]]);
    mesh
}

/// A ball with `rings` rings of latitude.
pub fn ball(centre: [f32; 3], radius: f32, rings: usize) -> Mesh {
    let columns = 2 * rings;
    let mut mesh = Mesh { vertices: Vec::new(), normals: Vec::new(), triangles: Vec::new() };
    for ring in 0..=rings {
        let (sin_polar, cos_polar) = (0.5 * TAU * ring as f32 / rings as f32).sin_cos();
        for column in 0..columns {
            let (sin, cos) = (TAU * column as f32 / columns as f32).sin_cos();
            let normal = [sin_polar * cos, cos_polar, sin_polar * sin];
            mesh.vertices.push(std::array::from_fn(|axis| centre[axis] + radius * normal[axis]));
            mesh.normals.push(normal);
        }
    }
    for ring in 0..rings as u32 {
        for column in 0..columns as u32 {
            let next = (column + 1) % columns as u32;
            let (a, b) = (ring * columns as u32 + column, ring * columns as u32 + next);
            let (c, d) = (a + columns as u32, b + columns as u32);
            mesh.triangles.extend([[a, b, c], [b, d, c]]);
        }
    }
    mesh
}
