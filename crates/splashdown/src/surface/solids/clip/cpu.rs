use glam::Vec3;
use rayon::prelude::*;

use super::ClipBindings;
use crate::bodies::{self, Body};
use crate::boundary::KernelPair;
use crate::surface::field::nodes::{LAYER, N, Nodes};
use crate::surface::params::{Lattice, NODES, ROWS};

/// Change of the field per cell at the surface of a body, over the iso level.
const SLOPE: f32 = 0.3;

pub(super) fn clip(buffers: ClipBindings<'_>) {
    let ClipBindings { lattice, status, block_list, bodies, maps, field_values, signs } = buffers;
    let blocks = status.blocks as usize;
    let values = field_values.as_chunks_mut::<NODES>().0;
    let signs = signs.as_chunks_mut::<ROWS>().0;
    let nodes = Nodes { lattice, blocks: block_list };
    let outputs = values[..blocks].par_iter_mut().zip(&mut signs[..blocks]);
    outputs.enumerate().for_each_init(Vec::new, |near: &mut Vec<&Body>, (i, (values, signs))| {
        let [low, high] = nodes.corners(i);
        near.clear();
        near.extend(bodies.iter().filter(|body| {
            let closest = body.position.clamp(low, high);
            closest.distance_squared(body.position) < body.radius * body.radius
        }));
        if near.is_empty() || values.iter().all(|value| *value == 0.0) {
            return;
        }
        let axes = nodes.folded_axes(i);
        for (number, value) in values.iter_mut().enumerate() {
            let at = Vec3::new(axes[0][number % N], axes[1][number / N % N], axes[2][number / LAYER]);
            let distance = bodies::nearest(near.iter().copied(), maps, at, lattice.support_radius);
            if let Some(distance) = distance {
                *value = beside_body(lattice, *value, distance);
            }
        }
        nodes.set_signs(i, values, signs);
    });
}

/// The value of the field at a signed distance in m from a body.
fn beside_body(lattice: &Lattice, value: f32, distance: f32) -> f32 {
    let q = (distance * lattice.inverse_support).clamp(0.0, 1.0);
    let completed = value / (1.0 - KernelPair::CubicSpline.density(q).0);
    completed.min(lattice.iso_level * (1.0 + SLOPE * distance * lattice.inverse_cell))
}
