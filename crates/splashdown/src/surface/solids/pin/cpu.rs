use glam::Vec4Swizzles;
use rayon::prelude::*;

use super::PinBindings;
use crate::bodies;

/// A vertex lies on a body if it is within this many cells of its surface. At sharp edges, which the map rounds, vertices are
/// a quarter of a cell away.
const ON_BODY: f32 = 0.3;

pub(super) fn pin(buffers: PinBindings<'_>) {
    let PinBindings { lattice, status, bodies, maps, vertex_positions } = buffers;
    let vertices = &mut vertex_positions[..status.vertices as usize];
    vertices.par_iter_mut().with_min_len(2048).for_each(|vertex| {
        let x = vertex.xyz();
        let near = bodies.iter().filter(|body| x.distance_squared(body.position) < body.radius * body.radius);
        let distance = bodies::nearest(near, maps, x, lattice.support_radius);
        if distance.is_some_and(|distance| distance.abs() < ON_BODY * lattice.cell_size) {
            vertex.w = 0.0;
        }
    });
}
