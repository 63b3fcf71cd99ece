use glam::{Vec3, Vec4, Vec4Swizzles};
use rayon::prelude::*;
use splashdown_gpu::Scratch;

use super::super::{GROUP, GROUPS};
use super::PredictBindings;
use crate::boundary::Images;
use crate::kernel::Kernel;
use crate::pairs::{NeighbourLists, Sorted, Values};
use crate::state::SolveState;

/// Particles per task.
const CHUNK: usize = 4096;

/// The position and the pressure of every particle. Kept from iteration to iteration, because new memory is slow.
#[derive(Default)]
struct Points(Vec<Vec4>);

pub(super) fn predict<K: Kernel, const BODIES: bool>(scratch: &mut Scratch, buffers: PredictBindings<'_>) {
    let PredictBindings {
        params,
        grid,
        state,
        solve,
        cell_start,
        sorted_positions: positions,
        free_velocities,
        solid_gradients,
        iterates,
        predicted,
        impulses,
        ..
    } = buffers;
    if solve.stopped != 0 {
        return;
    }
    let scale = 1.0 / params.support_radius;
    let volume = params.summed_mass / params.rest_density;
    let pass = Predict::<BODIES> {
        dt: state.dt,
        beta: solve.beta,
        tension_limit: params.tension_limit(),
        free_velocities,
        solid_gradients,
        iterates,
        factor: volume * (scale * scale) * (scale * scale) * scale,
    };
    let sorted =
        Sorted::new(params.support_radius, grid, cell_start, positions).with_images(Images::new(params));
    let n = sorted.active_count();
    let mut points = std::mem::take(&mut scratch.get::<Points>().0);
    points.resize(n, Vec4::ZERO);
    let chunks = points.par_chunks_mut(CHUNK).zip(positions.par_chunks(CHUNK)).enumerate();
    chunks.for_each(|(chunk, (points, positions))| {
        for (k, (point, x)) in points.iter_mut().zip(positions).enumerate() {
            *point = x.xyz().extend(pass.pressure(chunk * CHUNK + k));
        }
    });
    let lists = scratch.get::<NeighbourLists<K>>().of(sorted);
    lists.for_each(sorted, &mut *predicted, &Values(&points), |i, negative, images| {
        let own = points[i].w;
        let of_image = |(gradient, _, j): (Vec4, Vec4, usize)| (own + points[j].w) * gradient;
        let sum = images.iter().map(of_image).sum::<Vec4>() - negative;
        pass.finish(i, own, pass.factor * sum.xyz())
    });
    scratch.get::<Points>().0 = points;
    let predicted = &predicted[..n];
    let tasks = predicted.par_chunks(GROUP * GROUPS).zip(impulses.par_chunks_mut(GROUPS));
    tasks.enumerate().for_each(|(task, (predicted, sums))| {
        for (group, (predicted, sum)) in predicted.chunks(GROUP).zip(sums).enumerate() {
            let first = (task * GROUPS + group) * GROUP;
            let (mut impulses, mut squares) = (Vec4::ZERO, Vec4::ZERO);
            for (free, predicted) in pass.free_velocities[first..].iter().zip(predicted) {
                let impulse = free - predicted;
                let has_pressure = predicted.w != SolveState::NO_PRESSURE;
                let value = if has_pressure { *predicted } else { predicted.with_w(0.0) };
                impulses += impulse * impulse;
                squares += value * value;
            }
            let total = |v: Vec4| v.x + v.y + v.z;
            *sum = Vec4::new(total(impulses), squares.w, total(squares), 0.0);
        }
    });
}

struct Predict<'a, const BODIES: bool> {
    dt: f32,
    beta: f32,
    tension_limit: f32,
    free_velocities: &'a [Vec4],
    solid_gradients: &'a [Vec4],
    iterates: &'a [Vec4],
    /// Factor of the sums.
    factor: f32,
}

impl<const BODIES: bool> Predict<'_, BODIES> {
    #[inline(always)]
    fn pressure(&self, j: usize) -> f32 {
        let iterate = self.iterates[j];
        let least = if iterate.x < 0.0 { -self.tension_limit } else { 0.0 };
        (iterate.x + self.beta * iterate.y).max(least)
    }

    /// True where a nozzle determines the motion.
    #[inline(always)]
    fn is_driven(&self, i: usize) -> bool {
        self.free_velocities[i].w == 1.0
    }

    /// The velocity of a particle with the pressure `k`, from the sum of D' k over its neighbours.
    #[inline(always)]
    fn finish(&self, i: usize, k: f32, sum: Vec3) -> Vec4 {
        let v = self.free_velocities[i].xyz();
        if self.is_driven(i) {
            return v.extend(SolveState::NO_PRESSURE);
        }
        let solid = if BODIES { k * self.solid_gradients[i].xyz() } else { Vec3::ZERO };
        (v - self.dt * (sum + solid)).extend(k)
    }
}
