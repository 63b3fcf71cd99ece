use glam::Vec4;
use rayon::prelude::*;
use splashdown_gpu::Scratch;

use super::super::points::{CHUNK, Points, Second};
use super::super::{GROUP, GROUPS};
use super::PredictBindings;
use crate::boundary::Images;
use crate::kernel::Kernel;
use crate::pairs::{NeighbourLists, Sorted, Values};
use crate::state::SolveState;

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
    let mut points = std::mem::take(scratch.get::<Points>());
    // The particles keep their places for all iterations of a step.
    let is_first = solve.iteration == 0 || points.count() != Some(n);
    if is_first {
        points.begin(&positions[..n]);
    }
    points.pressures.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, points)| {
        for (k, point) in points.iter_mut().enumerate() {
            point.w = pass.pressure(chunk * CHUNK + k);
        }
    });
    let all = scratch.get::<NeighbourLists<K>>();
    let lists = if is_first { all.of(sorted) } else { all.kept(sorted) };
    let (pressures, outputs) = (&points.pressures, (&mut *predicted, Second(&mut points.velocities)));
    lists.for_each(sorted, outputs, &Values(pressures), |i, negative, images| {
        let own = pressures[i].w;
        let of_image = |(gradient, _, j): (Vec4, Vec4, usize)| (own + pressures[j].w) * gradient;
        let sum = images.iter().map(of_image).sum::<Vec4>() - negative;
        let result = pass.finish(i, own, pass.factor * sum);
        (result, result)
    });
    points.predicted_in = Some(solve.iteration);
    *scratch.get::<Points>() = points;
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

    /// The velocity of a particle with the pressure `k`, from the sum of D' k over its neighbours. The fourth components of
    /// the sums have no meaning.
    #[inline(always)]
    fn finish(&self, i: usize, k: f32, sum: Vec4) -> Vec4 {
        let free = self.free_velocities[i];
        // A nozzle determines the motion.
        if free.w == 1.0 {
            return free.with_w(SolveState::NO_PRESSURE);
        }
        let solid = if BODIES { k * self.solid_gradients[i] } else { Vec4::ZERO };
        (free - self.dt * (sum + solid)).with_w(k)
    }
}
