use glam::Vec3;
use rayon::prelude::*;

use super::AdvectBindings;
use crate::foam::ambient::{Ambient, Fluid};
use crate::foam::{Diffuse, DiffuseKind, FoamParams};
use crate::state::Params;

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
    let fluid = Fluid { params, grid, cell_start, positions, velocities };
    let n = now.count as usize;
    let pool = &pool[..n];
    let acceleration = params.body_acceleration(now.time - 0.5 * now.dt);
    let points: Vec<Vec3> =
        pool.par_iter().with_min_len(1024).map(|before| predicted(before, now.dt, acceleration)).collect();
    let ambient = fluid.at(&points);
    let outputs = moved[..n].par_iter_mut().zip(&mut alive[..n]);
    let inputs = pool.par_iter().zip(points).zip(ambient);
    outputs.zip(inputs).with_min_len(1024).for_each(|((moved, alive), ((before, x), near))| {
        let is_in;
        (*moved, is_in) = advected(params, foam, now.dt, acceleration, before, x, near);
        *alive = u32::from(is_in && moved.lifetime > 0.0);
    });
}

/// The position to which a particle's own velocity takes it.
fn predicted(before: &Diffuse, dt: f32, acceleration: Vec3) -> Vec3 {
    let mut x = before.position + dt * before.velocity;
    if before.kind() == DiffuseKind::Spray {
        x += 0.5 * dt * dt * acceleration;
    }
    x
}

/// The particle after the step, from its predicted position and the fluid there; and whether it is
/// in the domain.
fn advected(
    params: &Params,
    foam: &FoamParams,
    dt: f32,
    acceleration: Vec3,
    before: &Diffuse,
    mut x: Vec3,
    near: Ambient,
) -> (Diffuse, bool) {
    let v = before.velocity;
    let was_spray = before.kind() == DiffuseKind::Spray;
    let was_foam = before.kind() == DiffuseKind::Foam;
    let kind = foam.kind_of(near.neighbours, was_foam);
    let mut u;
    if kind == DiffuseKind::Spray {
        u = v + dt * acceleration;
        if !was_spray {
            x += 0.5 * dt * dt * acceleration;
        }
    } else {
        if was_spray {
            x -= 0.5 * dt * dt * acceleration;
        }
        u = near.velocity;
        if kind == DiffuseKind::Bubble {
            let follow = 1.0 - (-foam.drag * dt).exp();
            let rise = near.velocity - foam.buoyancy / foam.drag * acceleration;
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
