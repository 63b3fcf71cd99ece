use glam::{Vec2, Vec3, Vec4, Vec4Swizzles};

use super::EmitBindings;
use crate::cells::Grid;
use crate::flow::{EmissionSchedule, Nozzle};
use crate::state::Params;

/// The smallest distance of a new particle from others, in spacings.
const NEAREST: f32 = 0.7;

pub(super) fn emit(buffers: EmitBindings<'_>) {
    let EmitBindings {
        params,
        grid,
        cell_start,
        nozzles,
        points,
        schedules,
        positions,
        velocities,
        ids,
        densities,
    } = buffers;
    let schedules = schedules.chunks_exact_mut(EmissionSchedule::WORDS);
    for (nozzle, schedule) in nozzles.iter().zip(schedules) {
        if schedule[EmissionSchedule::LAYER] == 0 {
            continue;
        }
        let distance = f32::from_bits(schedule[EmissionSchedule::DISTANCE]);
        let first = nozzle.first_point as usize;
        for (place, q) in points[first..first + nozzle.points as usize].iter().enumerate() {
            let forward = (distance + q.z) * nozzle.direction;
            let id = schedule[EmissionSchedule::ID] + place as u32;
            let beside = q.xy() + nozzle.wobble * Nozzle::beside(id);
            let x = nozzle.back + forward + beside.x * nozzle.across + beside.y * nozzle.up;
            if !is_free(params, grid, cell_start, positions, x) {
                schedule[EmissionSchedule::BLOCKED] += 1;
                continue;
            }
            let slot = schedule[EmissionSchedule::SLOT] as usize + place;
            positions[slot] = x.extend(0.0);
            velocities[slot] = (nozzle.speed * nozzle.direction).extend(params.rest_density);
            ids[slot] = id;
            densities[slot] = Vec2::new(params.rest_density, 0.0);
            schedule[EmissionSchedule::EMITTED] += 1;
        }
    }
}

fn is_free(params: &Params, grid: &Grid, cell_start: &[u32], positions: &[Vec4], x: Vec3) -> bool {
    let nearest = NEAREST * params.particle_spacing;
    let near = |p: &Vec4| p.w == 0.0 && (p.xyz() - x).length_squared() < nearest * nearest;
    let mut runs = grid.runs_around(cell_start, grid.cube_of(x)).into_iter();
    !runs.any(|run| positions[run].iter().any(near))
}
