use rayon::prelude::*;

use super::AdvectBindings;
use crate::foam::surroundings::Around;
use crate::foam::{Diffuse, DiffuseKind, FoamParams, FoamState};

pub(super) fn advect(buffers: AdvectBindings<'_>) {
    let AdvectBindings {
        params,
        grid,
        foam,
        foam_state,
        cell_start,
        sorted_positions: positions,
        sorted_velocities: velocities,
        foam_pool: pool,
        foam_moved: moved,
        foam_alive: alive,
    } = buffers;
    let now = *foam_state;
    if now.is_due == 0 {
        return;
    }
    let around = Around { params, grid, cell_start, positions, velocities };
    let n = now.count as usize;
    let moved = moved[..n].par_iter_mut().with_min_len(256);
    let alive = &mut alive[..n];
    moved.zip(alive).zip(&pool[..n]).for_each(|((moved, alive), before)| {
        let is_in;
        (*moved, is_in) = advected(&around, foam, &now, before);
        *alive = u32::from(is_in && moved.lifetime > 0.0);
    });
}

/// The particle after the step, and whether it is still in the domain.
fn advected(around: &Around<'_>, foam: &FoamParams, now: &FoamState, before: &Diffuse) -> (Diffuse, bool) {
    let (params, dt, v) = (around.params, now.dt, before.velocity);
    let pull = params.body_acceleration(now.time - 0.5 * dt);
    let was_spray = before.kind() == DiffuseKind::Spray;
    let mut x = before.position + dt * v;
    if was_spray {
        x += 0.5 * dt * dt * pull;
    }
    let near = around.at(x);
    let was_foam = before.kind() == DiffuseKind::Foam;
    let kind = foam.kind_of(near.neighbours, was_foam);
    let mut u;
    if kind == DiffuseKind::Spray {
        u = v + dt * pull;
        if !was_spray {
            x += 0.5 * dt * dt * pull;
        }
    } else {
        if was_spray {
            x -= 0.5 * dt * dt * pull;
        }
        u = near.velocity;
        if kind == DiffuseKind::Bubble {
            let follow = 1.0 - (-foam.drag * dt).exp();
            let rise = near.velocity - foam.buoyancy / foam.drag * pull;
            u = v + follow * (rise - v);
        }
        x += 0.5 * dt * (u - v);
    }
    let (mut is_in, mut touches) = (true, false);
    for axis in 0..3 {
        let is_closed = |side: usize| params.closed >> (2 * axis + side) & 1 == 1;
        let (low, high) = (params.domain_min[axis], params.domain_max[axis]);
        if x[axis] <= low {
            is_in &= is_closed(0);
            touches = true;
            x[axis] = low;
            u[axis] = u[axis].max(0.0);
        } else if x[axis] >= high {
            is_in &= is_closed(1);
            touches = true;
            x[axis] = high;
            u[axis] = u[axis].min(0.0);
        }
    }
    let ages = kind == DiffuseKind::Foam || was_foam || (kind == DiffuseKind::Spray && touches);
    let lifetime = before.lifetime - if ages { dt } else { 0.0 };
    (Diffuse { position: x, lifetime, velocity: u, tag: before.tag & !3 | kind as u32 }, is_in)
}
