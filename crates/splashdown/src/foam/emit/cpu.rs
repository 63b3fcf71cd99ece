use glam::{Vec3, Vec4Swizzles};
use rayon::prelude::*;

use super::EmitBindings;
use crate::foam::surroundings::Around;
use crate::foam::types::{place_of, seed_of, unit};
use crate::foam::{Diffuse, FoamParams, FoamState};

/// Velocity away from the cylinder's axis at its side, over the particle's speed.
const SPREAD: f32 = 0.1;

pub(super) fn emit(buffers: EmitBindings<'_>) {
    let EmitBindings {
        params,
        grid,
        foam,
        foam_state,
        cell_start,
        foam_starts: starts,
        sorted_positions: positions,
        sorted_velocities: velocities,
        sorted_ids: ids,
        foam_pool: pool,
    } = buffers;
    let now = *foam_state;
    if now.is_due == 0 || now.born == 0 {
        return;
    }
    let around = Around { params, grid, cell_start, positions, velocities };
    // The m-th that wants to be born is the i-th particle's if starts[i] <= m < starts[i + 1]. Its place in turn is
    // known, so that the places are filled in parallel, each from the last m that goes there.
    let (kept, born) = (now.kept as usize, now.born as usize);
    let places = pool[kept..kept + born].par_iter_mut().with_min_len(64);
    places.enumerate().for_each(|(place, new)| {
        let m = last_at(place as u32, now.share);
        let i = starts.partition_point(|&start| start <= m) - 1;
        let number = now.next_id.wrapping_sub(now.born).wrapping_add(place as u32);
        *new = newborn(&around, foam, &now, i, ids[i], m - starts[i], number);
    });
}

/// The last m with `place_of(m, share) == place`.
fn last_at(place: u32, share: u32) -> u32 {
    let k = ((u64::from(place) + 1) * 4096).div_ceil(u64::from(share & 0xffff));
    let m = ((k << (share >> 16)) - 1) as u32;
    debug_assert!(place_of(m, share) == place && place_of(m + 1, share) > place);
    m
}

fn newborn(
    around: &Around<'_>,
    foam: &FoamParams,
    now: &FoamState,
    i: usize,
    id: u32,
    turn: u32,
    number: u32,
) -> Diffuse {
    let params = around.params;
    let v = around.velocities[i].xyz();
    let speed = v.length();
    let along = v / speed.max(1e-20);
    // Any direction across; the y axis is one if the motion is not along it.
    let e1 = along.cross(if along.y.abs() > 0.9 { Vec3::X } else { Vec3::Y });
    let e1 = e1 / e1.length();
    let e2 = along.cross(e1);
    let s = seed_of(id, now.step).wrapping_add(4 * turn);
    let random = |k: u32| unit(s.wrapping_add(k));
    let (sin, cos) = (std::f32::consts::TAU * random(2)).sin_cos();
    let across = random(1).sqrt() * (cos * e1 + sin * e2);
    let x = around.positions[i].xyz() + params.particle_spacing * across + (random(3) - 0.5) * now.dt * v;
    let x = x.clamp(params.domain_min, params.domain_max);
    let kind = foam.kind_of(around.at(x).neighbours, false);
    Diffuse {
        position: x,
        lifetime: foam.lifetime_least + foam.lifetime_range * random(4),
        velocity: v + SPREAD * speed * across,
        tag: number << 2 | kind as u32,
    }
}
