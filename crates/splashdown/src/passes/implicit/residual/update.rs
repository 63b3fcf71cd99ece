//! The next pressures of a group of particles, and the sums over the group, in registers.

use glam::{Mat4, Vec4};

use super::limits::{Limits, most_removed, smaller};
use super::{LARGEST_COMPLETED, LARGEST_PULLED_DEFICIT, LARGEST_PULLED_GRADIENT, SMALLEST_SURFACE_GRADIENT};
use crate::passes::implicit::GROUP;
use crate::simd::{Leaf, Register};
use crate::state::{Params, SolveState};

/// A component of the vectors of a group, one number per particle.
type Column = [f32; GROUP];

/// What the update of a particle depends on.
#[derive(Clone, Copy)]
pub(super) struct Update<'a, const BODIES: bool> {
    pub params: &'a Params,
    pub solve: &'a SolveState,
    pub dt: f32,
    /// That of [`Params::compressibility_in`].
    pub compressibility: f32,
    pub predicted: &'a [Vec4],
    pub stiffness: &'a [Vec4],
    pub solid_gradients: &'a [Vec4],
}

/// Updates the particles of a few groups, from particle `first` on. The first component of an iterate is the fluid's part of
/// the rate of the density; the old pressure is not needed.
pub(super) struct Groups<'a, const BODIES: bool> {
    pub update: &'a Update<'a, BODIES>,
    pub first: usize,
    pub iterates: &'a mut [Vec4],
    /// One sum per group.
    pub sums: &'a mut [Vec4],
}

impl<const BODIES: bool> Leaf for Groups<'_, BODIES> {
    #[inline(always)]
    fn run<V: Register>(self) {
        let Self { update, first, iterates, sums } = self;
        for (group, (iterates, sum)) in iterates.chunks_mut(GROUP).zip(sums).enumerate() {
            let terms = update.group::<V>(first + group * GROUP, iterates);
            // One after the other, for every width of the registers.
            *sum = terms[..iterates.len()].iter().sum();
        }
    }
}

impl<const BODIES: bool> Update<'_, BODIES> {
    /// Updates a group, and returns the contributions of its particles to the sums.
    #[inline(always)]
    fn group<V: Register>(&self, first: usize, iterates: &mut [Vec4]) -> [Vec4; GROUP] {
        let particles = first..first + iterates.len();
        let mut iterate_columns = columns(iterates);
        let stiffness = columns(&self.stiffness[particles.clone()]);
        let predicted = columns(&self.predicted[particles.clone()]);
        let solid = if BODIES { columns(&self.solid_gradients[particles]) } else { [[0.0; GROUP]; 4] };
        let mut terms = [[0.0; GROUP]; 4];
        for k in (0..GROUP).step_by(V::WIDTH) {
            let (iterate, contributions) = self.registers::<V>(
                load(&iterate_columns, k),
                load(&stiffness, k),
                load(&predicted, k),
                load(&solid, k),
            );
            store(iterate, &mut iterate_columns, k);
            store(contributions, &mut terms, k);
        }
        let count = iterates.len();
        iterates.copy_from_slice(&vectors(&iterate_columns)[..count]);
        vectors(&terms)
    }

    /// The new iterates of a register of particles, and their contributions to the sums.
    #[inline(always)]
    fn registers<V: Register>(
        &self,
        [rate, direction, change, excess]: [V; 4],
        [sx, sy, sz, squares]: [V; 4],
        [ux, uy, uz, k]: [V; 4],
        [bx, by, bz, b_speed]: [V; 4],
    ) -> ([V; 4], [V; 4]) {
        let Self { params, solve, dt, compressibility, .. } = *self;
        let (zero, one) = (V::splat(0.0), V::splat(1.0));
        let (mut rate, mut gradient, mut normal) = (rate, [sx, sy, sz], [sx, sy, sz]);
        let mut is_free = one; // not next to a body
        if BODIES {
            rate = rate + ((bx * ux + by * uy + bz * uz) - b_speed);
            gradient = [sx + bx, sy + by, sz + bz];
            normal = [sx + bx * 0.5, sy + by * 0.5, sz + bz * 0.5];
            let magnitude = |value: V| value.max(zero - value);
            let largest = magnitude(bx).max(magnitude(by)).max(magnitude(bz)).max(magnitude(b_speed));
            is_free = zero.if_less(largest, zero, one);
        }
        let square = |[x, y, z]: [V; 3]| x * x + y * y + z * z;
        let removed = smaller(excess, V::splat(most_removed(params.tolerance, solve.dt_ratio)));
        let room = (V::splat(LARGEST_COMPLETED * solve.dt_ratio) - excess).max(zero);
        let complete = removed + smaller(self.missing_density(square(normal)), room);
        let change_of_density = rate * dt - k * compressibility - solve.mean_excess;
        let mut limits = Limits::of(complete);
        let tension_limit = params.tension_limit();
        if tension_limit > 0.0 {
            let steepest = LARGEST_PULLED_GRADIENT / params.support_radius;
            let is_inside = V::splat(-LARGEST_PULLED_DEFICIT).if_less(complete, is_free, zero);
            let is_inside = square(normal).if_less(V::splat(steepest * steepest), is_inside, zero);
            let inside = Limits::inside(tension_limit, params.closing_rate() * dt, complete);
            limits = inside.where_less(zero, is_inside, limits);
        }
        let residual = limits.residual(k, change_of_density);
        let scale = 1.0 / params.support_radius;
        let sum = (square(gradient) + squares).max(V::splat(1e-6 * scale * scale));
        let diagonal = sum * (dt * dt) + compressibility;
        let is_measuring = solve.is_measuring(params);
        let next =
            if is_measuring { k } else { limits.next(k, change_of_density, solve.relaxation, diagonal) };
        let new_change = next - k;
        let direction = direction * solve.beta + change;
        let error = limits.error(k, residual, diagonal);
        let work = if is_measuring { complete + rate * dt } else { zero.if_less(error, k * residual, zero) };
        // A nozzle determines the motion of the particles without a pressure.
        let driven = V::splat(0.5 * SolveState::NO_PRESSURE);
        let of_others = |value: V| k.if_less(driven, zero, value);
        let iterate = [of_others(next), of_others(direction), of_others(new_change), excess];
        let terms = [error, diagonal * new_change * new_change, work].map(of_others);
        (iterate, [terms[0], terms[1], excess.max(zero), terms[2]])
    }

    /// What particles at the free surface lack of the rest density, for the square of the gradient of the sum of V W over
    /// fluid and bodies.
    #[inline(always)]
    fn missing_density<V: Register>(&self, gradient2: V) -> V {
        let support2 = self.params.support_radius * self.params.support_radius;
        let (squared, bound) = (gradient2 * support2, SMALLEST_SURFACE_GRADIENT);
        let (zero, bound2) = (V::splat(0.0), V::splat(bound * bound));
        // Most particles are not at the surface, and two roots take long.
        if squared.less_bits(bound2).count_ones() as usize == V::WIDTH {
            return zero;
        }
        let beyond = (squared.sqrt() - bound).max(zero);
        squared.if_less(bound2, zero, beyond * self.params.surface_completion * beyond.sqrt())
    }
}

/// The components of the vectors of a group; zero after the last one.
#[inline(always)]
fn columns(vectors: &[Vec4]) -> [Column; 4] {
    let mut columns = [[0.0; GROUP]; 4];
    for (k, four) in vectors.chunks(4).enumerate() {
        let [a, b, c, d] = std::array::from_fn(|l| four.get(l).copied().unwrap_or(Vec4::ZERO));
        let rows = Mat4::from_cols(a, b, c, d).transpose();
        for (column, row) in columns.iter_mut().zip([rows.x_axis, rows.y_axis, rows.z_axis, rows.w_axis]) {
            column[4 * k..4 * k + 4].copy_from_slice(&row.to_array());
        }
    }
    columns
}

/// The vectors with these components.
#[inline(always)]
fn vectors(columns: &[Column; 4]) -> [Vec4; GROUP] {
    let mut vectors = [Vec4::ZERO; GROUP];
    for (k, four) in vectors.chunks_exact_mut(4).enumerate() {
        let [a, b, c, d] = columns.each_ref().map(|column| Vec4::from_slice(&column[4 * k..4 * k + 4]));
        let rows = Mat4::from_cols(a, b, c, d).transpose();
        four.copy_from_slice(&[rows.x_axis, rows.y_axis, rows.z_axis, rows.w_axis]);
    }
    vectors
}

/// A register of each component, from particle `k` of the group on.
#[inline(always)]
fn load<V: Register>(columns: &[Column; 4], k: usize) -> [V; 4] {
    assert!(k + V::WIDTH <= GROUP);
    // SAFETY: the assertion above.
    columns.each_ref().map(|column| unsafe { V::load(column.as_ptr().add(k)) })
}

/// Stores a register of each component.
#[inline(always)]
fn store<V: Register>(values: [V; 4], columns: &mut [Column; 4], k: usize) {
    assert!(k + V::WIDTH <= GROUP);
    for (value, column) in values.into_iter().zip(columns) {
        // SAFETY: the assertion above.
        unsafe { value.store(column.as_mut_ptr().add(k)) };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::{Simd, run_with};

    /// Pressures of both signs and without one, deficits and excesses, at the surface, inside, and next to bodies.
    fn vectors(seed: u32) -> Vec<Vec4> {
        let number = |k: u32| splashdown_gpu::testing::noise(seed + k) as f32 / u32::MAX as f32 - 0.5;
        let vector =
            |i: u32| Vec4::new(number(4 * i), number(4 * i + 1), number(4 * i + 2), number(4 * i + 3));
        (0..150).map(vector).collect()
    }

    fn results<const BODIES: bool>(simd: Simd, gravity: f32) -> [Vec<[u32; 4]>; 2] {
        results_in::<BODIES>(simd, gravity, 0.0, 2)
    }

    /// In a full domain if an excess is accepted.
    fn results_in<const BODIES: bool>(
        simd: Simd,
        gravity: f32,
        accepted_excess: f32,
        iteration: u32,
    ) -> [Vec<[u32; 4]>; 2] {
        let params = Params {
            gravity: glam::Vec3::new(0.0, -gravity, 0.0),
            particle_spacing: 0.5,
            support_radius: 1.0,
            rest_density: 1000.0,
            surface_completion: 0.24,
            compressibility: 2e-5,
            tolerance: 0.001,
            accepted_excess,
            ..bytemuck::Zeroable::zeroed()
        };
        let mut solve = SolveState::new(false, 0.5, 0.7);
        (solve.beta, solve.iteration, solve.mean_excess) = (0.3, iteration, 0.5 * accepted_excess);
        let (mut iterates, mut predicted) = (vectors(0), vectors(1000));
        for (k, predicted) in predicted.iter_mut().enumerate().filter(|(k, _)| k % 3 > 0) {
            predicted.w = if k % 3 == 1 { 0.0 } else { SolveState::NO_PRESSURE };
        }
        let mut solid_gradients = vectors(2000);
        solid_gradients.iter_mut().step_by(2).for_each(|solid| *solid = Vec4::ZERO);
        let stiffness = vectors(3000);
        let mut sums = vec![Vec4::ZERO; 3];
        let update = Update::<BODIES> {
            params: &params,
            solve: &solve,
            dt: 0.2,
            compressibility: params.compressibility,
            predicted: &predicted[..],
            stiffness: &stiffness[..],
            solid_gradients: &solid_gradients[..],
        };
        run_with(simd, Groups { update: &update, first: 0, iterates: &mut iterates, sums: &mut sums });
        [iterates, sums].map(|vectors| vectors.iter().map(|v| v.to_array().map(f32::to_bits)).collect())
    }

    #[test]
    fn all_registers_have_the_same_results() {
        let expected = results::<true>(Simd::Portable, 10.0);
        for simd in Simd::ALL.into_iter().filter(|simd| simd.is_available()) {
            assert_eq!(results::<true>(simd, 10.0), expected, "{}", simd.name());
            assert_eq!(
                results::<false>(simd, 10.0),
                results::<false>(Simd::Portable, 10.0),
                "{}",
                simd.name()
            );
        }
        for iteration in [0, 1] {
            let of = |simd| results_in::<true>(simd, 10.0, 0.002, iteration);
            for simd in Simd::ALL.into_iter().filter(|simd| simd.is_available()) {
                assert_eq!(of(simd), of(Simd::Portable), "{}, iteration {iteration}", simd.name());
            }
            assert_ne!(of(Simd::Portable), expected, "control: a full domain");
        }
        assert_ne!(results::<false>(Simd::Portable, 10.0), expected, "control: without bodies");
        assert_ne!(results::<true>(Simd::Portable, 0.0), expected, "control: without tension");
    }

    #[test]
    fn a_particle_without_a_pressure_keeps_its_excess_only() {
        let [iterates, _] = results::<false>(Simd::Portable, 10.0);
        let [_, _, _, excess] = vectors(0)[2].to_array();
        assert_eq!(iterates[2], [0.0, 0.0, 0.0, excess].map(f32::to_bits));
        assert_ne!(iterates[1][0], 0, "control: a particle with a pressure");
    }
}
