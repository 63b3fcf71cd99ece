use glam::{Vec3, Vec4Swizzles};
use rayon::prelude::*;

use super::EmitBindings;
use crate::foam::ambient::Fluid;
use crate::foam::types::{place_of, seed_of, unit};
use crate::foam::{Diffuse, FoamParams, FoamState};

/// Velocity away from the axis at the surface of the cylinder, divided by the speed of the
/// particle.
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
    let fluid = Fluid { params, grid, cell_start, positions, velocities };
    // Candidate m originates from particle i if starts[i] <= m < starts[i + 1]. Slots are filled in
    // parallel, each from the last m that is assigned to it.
    let (kept, born) = (now.kept as usize, now.born as usize);
    let new = &mut pool[kept..kept + born];
    new.par_iter_mut().with_min_len(64).enumerate().for_each(|(place, new)| {
        let m = last_at(place as u32, now.share);
        let i = starts.partition_point(|&start| start <= m) - 1;
        let number = now.next_id.wrapping_sub(now.born).wrapping_add(place as u32);
        *new = new_particle(&fluid, foam, &now, i, ids[i], m - starts[i], number);
    });
    let points: Vec<Vec3> = new.iter().map(|new| new.position).collect();
    for (new, near) in new.iter_mut().zip(fluid.at(&points)) {
        new.tag |= foam.kind_of(near.neighbours, false) as u32;
    }
}

/// The last m with `place_of(m, share) == place`.
fn last_at(place: u32, share: u32) -> u32 {
    let k = ((u64::from(place) + 1) * 4096).div_ceil(u64::from(share & 0xffff));
    let m = ((k << (share >> 16)) - 1) as u32;
    debug_assert!(place_of(m, share) == place && place_of(m + 1, share) > place);
    m
}

/// A new particle. Its kind is not set.
fn new_particle(
    fluid: &Fluid<'_>,
    foam: &FoamParams,
    now: &FoamState,
    i: usize,
    id: u32,
    turn: u32,
    number: u32,
) -> Diffuse {
    let params = fluid.params;
    let v = fluid.velocities[i].xyz();
    let speed = v.length();
    let along = v / speed.max(1e-20);
    // Any perpendicular direction; the y axis is suitable unless the motion is parallel to it.
    let e1 = along.cross(if along.y.abs() > 0.9 { Vec3::X } else { Vec3::Y });
    let e1 = e1 / e1.length();
    let e2 = along.cross(e1);
    let s = seed_of(id, now.step).wrapping_add(4 * turn);
    let random = |k: u32| unit(s.wrapping_add(k));
    let (sin, cos) = (std::f32::consts::TAU * random(2)).sin_cos();
    let across = random(1).sqrt() * (cos * e1 + sin * e2);
    let x = fluid.positions[i].xyz() + params.particle_spacing * across + (random(3) - 0.5) * now.dt * v;
    let x = x.clamp(params.domain_min, params.domain_max);
    Diffuse {
        position: x,
        lifetime: foam.lifetime_least + foam.lifetime_range * random(4),
        velocity: v + SPREAD * speed * across,
        tag: number << 2,
    }
}
