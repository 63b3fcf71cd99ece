use std::f32::consts::PI;

use glam::{UVec3, Vec3, Vec4Swizzles};

use super::{COLUMN, SampleBindings, WETTED};
use crate::cells::Grid;
use crate::probes::{ProbePoint, VALUES};

pub(super) fn sample(buffers: SampleBindings<'_>) {
    let SampleBindings {
        params,
        grid,
        state,
        cell_start,
        probes,
        sorted_positions,
        densities,
        accelerations,
        probe_values: values,
    } = buffers;
    if state.run_count == 0 {
        return;
    }
    let positions = sorted_positions;
    let values = values.chunks_exact_mut(VALUES);
    let volume = params.particle_spacing.powi(3);
    for (probe, values) in probes.iter().zip(values) {
        let column = probe.kind == ProbePoint::HEIGHT;
        if !column && probe.kind != ProbePoint::PRESSURE {
            continue;
        }
        let support = params.support_radius * if column { COLUMN } else { 1.0 };
        let (mut total, mut pressure) = (0.0, 0.0);
        let (mut offset, mut drive) = (Vec3::ZERO, Vec3::ZERO);
        for_each_near(grid, cell_start, probe, support, |j| {
            let p = positions[j];
            let mut d = p.xyz() - probe.position;
            if column {
                let up = d.dot(probe.normal);
                // Fluid below the base of the column does not count.
                if up < 0.0 {
                    return;
                }
                d -= up * probe.normal;
            }
            let q = d.length() / support;
            if q < 1.0 && p.w == 0.0 {
                let w = (1.0 - q).powi(4) * (1.0 + 4.0 * q);
                total += w;
                pressure += w * densities[j].y;
                offset += w * d;
                drive += w * accelerations[j].xyz();
            }
        });
        values[0] = if column {
            7.0 * volume * total / (PI * support * support)
        } else if total > 0.0 {
            let wet = 21.0 * volume * total / (2.0 * PI * support.powi(3));
            let gradient = params.rest_density * (params.body_acceleration(state.time) - drive / total);
            (pressure / total - gradient.dot(offset / total)) * (wet / WETTED).min(1.0)
        } else {
            0.0
        };
    }
}

/// Calls `visit` with every particle in the cells within reach of a probe.
fn for_each_near(
    grid: &Grid,
    cell_start: &[u32],
    probe: &ProbePoint,
    support: f32,
    mut visit: impl FnMut(usize),
) {
    let length = if probe.kind == ProbePoint::HEIGHT { probe.half_along } else { 0.0 };
    let end = probe.position + length * probe.normal;
    let first = inner_cell(grid, probe.position.min(end) - support);
    let last = inner_cell(grid, probe.position.max(end) + support);
    for z in first.z..=last.z {
        for y in first.y..=last.y {
            let line = ((z * grid.size_y + y) * grid.size_x) as usize;
            let begin = cell_start[line + first.x as usize] as usize;
            (begin..cell_start[line + last.x as usize + 1] as usize).for_each(&mut visit);
        }
    }
}

fn inner_cell(grid: &Grid, x: Vec3) -> UVec3 {
    let cell = grid.cell_of(x);
    UVec3::new(cell % grid.size_x, cell / grid.size_x % grid.size_y, cell / (grid.size_x * grid.size_y))
}
