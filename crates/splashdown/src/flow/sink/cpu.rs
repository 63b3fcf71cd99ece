use glam::{UVec3, Vec3, Vec4Swizzles};
use rayon::prelude::*;

use super::SinkBindings;
use crate::flow::SinkShape;
use crate::state::{DEAD_DRAINED, StepCounters};

pub(super) fn sink(buffers: SinkBindings<'_>) {
    let SinkBindings { grid, state, cell_start, drains, drain_maps, sorted_positions, counters } = buffers;
    let active = cell_start[grid.cell_count as usize];
    let n = active.min(state.run_count) as usize;
    let maps = drain_maps;
    let positions = sorted_positions[..n].par_iter_mut().with_min_len(4096);
    let drained = positions
        .filter_map(|p| {
            let is_drained = p.w == 0.0 && drains.iter().any(|drain| takes(drain, maps, p.xyz()));
            is_drained.then(|| p.w = DEAD_DRAINED)
        })
        .count();
    counters[StepCounters::DRAINED] += drained as u32;
}

fn takes(drain: &SinkShape, maps: &[f32], x: Vec3) -> bool {
    if drain.kind == SinkShape::BELOW {
        return (x - drain.low).dot(drain.high) < 0.0;
    }
    let inside = x.cmpge(drain.low).all() && x.cmple(drain.high).all();
    if drain.kind == SinkShape::BOX || !inside {
        return inside;
    }
    let at = (x - drain.low) / drain.cell_size;
    let c = at.as_uvec3().min(drain.nodes - UVec3::splat(2));
    let f = at - c.as_vec3();
    let (row, plane) = (drain.nodes.x as usize, (drain.nodes.x * drain.nodes.y) as usize);
    let first = drain.first_node as usize + c.z as usize * plane + c.y as usize * row + c.x as usize;
    let mix = |a: f32, b: f32, t: f32| a * (1.0 - t) + b * t;
    let sides = [first, first + plane]
        .map(|k| mix(mix(maps[k], maps[k + 1], f.x), mix(maps[k + row], maps[k + row + 1], f.x), f.y));
    mix(sides[0], sides[1], f.z) < 0.0
}
