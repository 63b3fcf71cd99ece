use glam::{Vec3, Vec4, Vec4Swizzles};
use rayon::prelude::*;
use splashdown_gpu::Scratch;

use super::super::{GROUP, GROUPS};
use super::{
    LARGEST_COMPLETED, LARGEST_PULLED_DEFICIT, LARGEST_PULLED_GRADIENT, Limits, ResidualBindings,
    SMALLEST_SURFACE_GRADIENT, limits,
};
use crate::boundary::Images;
use crate::kernel::Kernel;
use crate::pairs::{Differences, NeighbourLists, Outputs, Sorted};
use crate::state::{Params, SolveState};

/// Particles per task.
const CHUNK: usize = 4096;

/// The position and the predicted velocity of every particle, which a visit of a neighbour loads at once. Kept from iteration
/// to iteration, because new memory is slow.
#[derive(Default)]
struct Points(Vec<[Vec4; 2]>);

pub(super) fn residual<K: Kernel, const BODIES: bool>(scratch: &mut Scratch, buffers: ResidualBindings<'_>) {
    let ResidualBindings {
        params,
        grid,
        state,
        solve,
        cell_start,
        sorted_positions: positions,
        stiffness,
        solid_gradients,
        predicted,
        iterates,
        residuals,
        ..
    } = buffers;
    if solve.stopped != 0 {
        return;
    }
    let scale = 1.0 / params.support_radius;
    let volume = params.summed_mass / params.rest_density;
    let sorted =
        Sorted::new(params.support_radius, grid, cell_start, positions).with_images(Images::new(params));
    let n = sorted.active_count();
    let mut points = std::mem::take(&mut scratch.get::<Points>().0);
    points.resize(n, [Vec4::ZERO; 2]);
    points
        .par_iter_mut()
        .zip(&positions[..n])
        .zip(predicted)
        .with_min_len(CHUNK)
        .for_each(|((point, x), u)| *point = [*x, *u]);
    let lists = scratch.get::<NeighbourLists<K>>().of(sorted);
    let factor = volume * (scale * scale) * (scale * scale) * scale;
    lists.for_each(sorted, First(&mut *iterates), &Differences(&points), |i, sum, images| {
        let u = predicted[i];
        let of_image = |(gradient, sign, j): (Vec4, Vec4, usize)| gradient * (u - sign * predicted[j]);
        let of_images: Vec4 = images.iter().map(of_image).sum();
        let sum = sum + of_images;
        factor * (sum.x + sum.y + sum.z)
    });

    scratch.get::<Points>().0 = points;
    let (tension_limit, closing) = (params.tension_limit(), params.closing_rate() * state.dt);
    let steepest = LARGEST_PULLED_GRADIENT / params.support_radius;
    let update = |i: usize, iterate: &mut Vec4| {
        let excess = iterate.w;
        let (u, k) = (predicted[i].xyz(), predicted[i].w);
        if k == SolveState::NO_PRESSURE {
            *iterate = Vec3::ZERO.extend(excess);
            return Vec4::new(0.0, 0.0, excess.max(0.0), 0.0);
        }
        let (mut rate, mut gradient, mut normal) = (iterate.x, stiffness[i].xyz(), stiffness[i].xyz());
        if BODIES {
            let solid = solid_gradients[i];
            rate += solid.xyz().dot(u) - solid.w;
            gradient += solid.xyz();
            normal += 0.5 * solid.xyz();
        }
        let most = LARGEST_COMPLETED * solve.dt_ratio;
        let complete = limits::removed(excess, params.tolerance, solve.dt_ratio)
            + missing_density(params, normal).min((most - excess).max(0.0));
        let change_of_density = state.dt * rate - params.compressibility * k;
        let is_inside = tension_limit > 0.0
            && complete > -LARGEST_PULLED_DEFICIT
            && normal.length_squared() < steepest * steepest
            && (!BODIES || solid_gradients[i] == Vec4::ZERO);
        let limits =
            if is_inside { Limits::inside(tension_limit, closing, complete) } else { Limits::of(complete) };
        let residual = limits.residual(k, change_of_density);
        let diagonal = (gradient.length_squared() + stiffness[i].w).max(1e-6 * scale * scale);
        let diagonal = state.dt * state.dt * diagonal + params.compressibility;
        let next = limits.next(k, change_of_density, solve.relaxation, diagonal);
        let change = next - k;
        let direction = solve.beta * iterate.y + iterate.z;
        *iterate = Vec4::new(next, direction, change, excess);
        let error = limits.error(k, residual, diagonal);
        let work = if error > 0.0 { k * residual } else { 0.0 };
        Vec4::new(error, diagonal * change * change, excess.max(0.0), work)
    };
    let tasks = iterates[..n].par_chunks_mut(GROUP * GROUPS).zip(residuals.par_chunks_mut(GROUPS));
    tasks.enumerate().for_each(|(task, (iterates, sums))| {
        for (group, (iterates, sum)) in iterates.chunks_mut(GROUP).zip(sums).enumerate() {
            let first = (task * GROUPS + group) * GROUP;
            *sum = Vec4::ZERO;
            for (k, iterate) in iterates.iter_mut().enumerate() {
                *sum += update(first + k, iterate);
            }
        }
    });
}

/// What a particle at the free surface lacks of the rest density, for the gradient of the sum of V W over fluid and bodies.
#[inline(always)]
fn missing_density(params: &Params, gradient: Vec3) -> f32 {
    let squared = params.support_radius * params.support_radius * gradient.length_squared();
    // Most particles are not at the surface, and two roots take long.
    if squared < SMALLEST_SURFACE_GRADIENT * SMALLEST_SURFACE_GRADIENT {
        return 0.0;
    }
    let beyond = (squared.sqrt() - SMALLEST_SURFACE_GRADIENT).max(0.0);
    params.surface_completion * beyond * beyond.sqrt()
}

/// Stores a result as the first component of a vector: the update does not need the old pressure.
struct First<'a>(&'a mut [Vec4]);

impl Outputs<f32> for First<'_> {
    fn split_at(self, middle: usize) -> (Self, Self) {
        let (first, second) = self.0.split_at_mut(middle);
        (Self(first), Self(second))
    }

    #[inline(always)]
    fn put(&mut self, i: usize, value: f32) {
        self.0[i].x = value;
    }
}
