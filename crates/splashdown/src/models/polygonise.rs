//! Triangulates a shape that is given by its signed distance function.
//!
//! Marching cubes on a grid gives a closed, manifold, oriented mesh for any function (see `marching_cubes`),
//! but with slivers. Several rounds of smoothing remove them: each moves the vertices along the surface
//! towards the mean of their neighbours, and back onto the surface by Newton's method. The normals are the
//! gradients of the function.
//!
//! The nodes of a block share one value if the surface cannot reach the block: a distance function changes by
//! at most the distance moved.

use glam::{UVec3, Vec3, uvec3, vec3};
use rayon::prelude::*;
use splashdown_io::Mesh;

use crate::marching_cubes::TRIANGLES;

/// Number of nodes along an edge of a block.
const BLOCK: u32 = 4;

/// Upper bound of the gradient of a shape's function. Smooth unions and tapers are not exact distances, whose
/// gradient is at most 1.
const SLACK: f32 = 1.6;

/// Number of smoothing rounds.
const ROUNDS: u32 = 7;

/// The zero level of `shape` between `min` and `max` (m), with triangles of about the size `cell` (m).
/// `shape` is an approximate signed distance in m, negative inside.
pub(super) fn polygonise(min: Vec3, max: Vec3, cell: f32, shape: impl Fn(Vec3) -> f32 + Sync) -> Mesh {
    let blocks = ((max - min) / (cell * BLOCK as f32)).ceil().as_uvec3().max(UVec3::ONE);
    let nodes = blocks * BLOCK;
    let values = sample(min, cell, blocks, &shape);
    let (vertices, triangles) = march(min, cell, nodes, &values);
    let (vertices, normals) = relax(vertices, &triangles, cell, &shape);
    Mesh::new(to_arrays(&vertices), triangles).with_normals(to_arrays(&normals))
}

fn to_arrays(points: &[Vec3]) -> Vec<[f32; 3]> {
    points.iter().map(Vec3::to_array).collect()
}

/// The shape's values at the nodes, x fastest.
fn sample(min: Vec3, cell: f32, blocks: UVec3, shape: &(impl Fn(Vec3) -> f32 + Sync)) -> Vec<f32> {
    let nodes = blocks * BLOCK;
    let (row, slab) = (nodes.x as usize, (nodes.x * nodes.y) as usize);
    let at = |node: UVec3| min + cell * node.as_vec3();
    let reach = SLACK * 0.5 * cell * BLOCK as f32 * 3.0_f32.sqrt();
    let mut values = vec![0.0; slab * nodes.z as usize];
    values.par_chunks_mut(slab * BLOCK as usize).enumerate().for_each(|(z, layer)| {
        for (x, y) in (0..blocks.y).flat_map(|y| (0..blocks.x).map(move |x| (x, y))) {
            let first = uvec3(x, y, z as u32) * BLOCK;
            let middle = shape(at(first) + 0.5 * cell * (BLOCK - 1) as f32);
            for k in 0..BLOCK.pow(3) {
                let local = uvec3(k % BLOCK, k / BLOCK % BLOCK, k / (BLOCK * BLOCK));
                let node = first + local;
                let value = if middle.abs() > reach { middle } else { shape(at(node)) };
                layer[local.z as usize * slab + node.y as usize * row + node.x as usize] = value;
            }
        }
    });
    values
}

/// Marching cubes with shared vertices: one vertex per grid edge that crosses the surface.
fn march(min: Vec3, cell: f32, nodes: UVec3, values: &[f32]) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    const NONE: u32 = u32::MAX;
    let step = uvec3(1, nodes.x, nodes.x * nodes.y);
    let index = |node: UVec3| node.dot(step) as usize;
    let mut on_edge = vec![[NONE; 3]; values.len()];
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for z in 0..nodes.z - 1 {
        for y in 0..nodes.y - 1 {
            for x in 0..nodes.x - 1 {
                let node = uvec3(x, y, z);
                let corner = |c: u32| node + uvec3(c & 1, c >> 1 & 1, c >> 2);
                let case =
                    (0..8).filter(|&c| values[index(corner(c))] < 0.0).fold(0_usize, |case, c| case | 1 << c);
                for triangle in &TRIANGLES[case] {
                    triangles.push(triangle.map(|edge| {
                        let axis = usize::from(edge / 4);
                        let (a, b) = (u32::from(edge & 1), u32::from(edge >> 1 & 1));
                        let from = node + [uvec3(0, a, b), uvec3(a, 0, b), uvec3(a, b, 0)][axis];
                        let slot = &mut on_edge[index(from)][axis];
                        if *slot == NONE {
                            *slot = vertices.len() as u32;
                            let to = from + UVec3::AXES[axis];
                            let (v0, v1) = (values[index(from)], values[index(to)]);
                            // Two vertices at the same node would form a triangle without area.
                            let t = (v0 / (v0 - v1)).clamp(0.05, 0.95);
                            let middle = from.as_vec3() + t * (to.as_vec3() - from.as_vec3());
                            vertices.push(min + cell * middle);
                        }
                        *slot
                    }));
                }
            }
        }
    }
    (vertices, triangles)
}

/// Smooths the triangles. Returns the vertices and their unit normals.
fn relax(
    mut vertices: Vec<Vec3>,
    triangles: &[[u32; 3]],
    cell: f32,
    shape: &(impl Fn(Vec3) -> f32 + Sync),
) -> (Vec<Vec3>, Vec<Vec3>) {
    let neighbours = Neighbours::of(vertices.len(), triangles);
    let gradient = |p: Vec3| {
        // Differences over a tetrahedron need four evaluations instead of six.
        let e = 0.1 * cell;
        let corners = [vec3(1.0, -1.0, -1.0), vec3(-1.0, -1.0, 1.0), vec3(-1.0, 1.0, -1.0), Vec3::ONE];
        corners.into_iter().map(|corner| corner * shape(p + e * corner)).sum::<Vec3>() / (4.0 * e)
    };
    // One step of Newton's method, no longer than half a cell.
    let project = |p: Vec3, gradient: Vec3| {
        let step = shape(p) / gradient.length_squared().max(0.25) * gradient;
        p - step.clamp_length_max(0.5 * cell)
    };
    let mut normals: Vec<Vec3> = vertices.par_iter().map(|&p| gradient(p)).collect();
    for _ in 0..ROUNDS {
        let moved = (0..vertices.len()).into_par_iter().map(|i| {
            let (p, normal) = (vertices[i], normals[i].normalize_or_zero());
            let around = neighbours.of_vertex(i);
            let middle =
                around.iter().map(|&j| vertices[j as usize]).sum::<Vec3>() / around.len().max(1) as f32;
            let tangential = (middle - p).reject_from_normalized(normal);
            let q = p + (0.5 * tangential).clamp_length_max(0.3 * cell);
            let q = project(q, normals[i]);
            (q, gradient(q))
        });
        (vertices, normals) = moved.collect();
    }
    vertices.par_iter_mut().zip(&mut normals).for_each(|(p, normal)| {
        *p = project(*p, *normal);
        *normal = gradient(*p).normalize_or(Vec3::Y);
    });
    (vertices, normals)
}

/// The one-ring of each vertex of a closed mesh.
struct Neighbours {
    /// The first entry of each vertex in `list`, followed by the length of `list`.
    starts: Vec<u32>,
    list: Vec<u32>,
}

impl Neighbours {
    /// In a closed oriented mesh each edge belongs to two triangles, in opposite directions. The ends of the
    /// triangle sides that start at a vertex are therefore its neighbours, each once.
    fn of(count: usize, triangles: &[[u32; 3]]) -> Self {
        let mut starts = vec![0; count + 1];
        for &corner in triangles.iter().flatten() {
            starts[corner as usize + 1] += 1;
        }
        for i in 0..count {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut list = vec![0; 3 * triangles.len()];
        for &[a, b, c] in triangles {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                list[next[from as usize] as usize] = to;
                next[from as usize] += 1;
            }
        }
        Self { starts, list }
    }

    fn of_vertex(&self, i: usize) -> &[u32] {
        &self.list[self.starts[i] as usize..self.starts[i + 1] as usize]
    }
}
