//! Forces and torques on bodies, summed in 64-bit fixed point: the sum does not depend on the order of its terms.

use glam::Vec3;
use splashdown_gpu::WgslModule;

use super::types::{Body, SUM_WORDS};
use crate::state::Params;

/// The WGSL side.
pub(super) const WGSL: WgslModule =
    WgslModule { name: "sph/reaction", source: include_str!("reaction.wgsl") };

/// The force in N of one unit of the sums: the particle mass times 1e-5 m/s^2. The unit of torques is this times the
/// support radius.
fn quantum(params: &Params) -> f32 {
    1e-5 * params.particle_mass
}

/// The sums of one task, one entry per body; empty if there are no terms.
pub(super) type Totals = Vec<[i64; 6]>;

/// Adds a force in N on a body at a point.
pub(super) fn react(total: &mut [i64; 6], params: &Params, body: &Body, point: Vec3, force: Vec3) {
    let torque = (point - body.position).cross(force);
    let quantum = quantum(params);
    for axis in 0..3 {
        total[axis] += fixed(force[axis] / quantum);
        total[3 + axis] += fixed(torque[axis] / (quantum * params.support_radius));
    }
}

/// Adds the sums of all tasks to those in the buffer.
pub(super) fn store(sums: &mut [u32], totals: &[Totals]) {
    for (b, words) in sums.chunks_exact_mut(SUM_WORDS).enumerate() {
        for (component, pair) in words.chunks_exact_mut(2).enumerate() {
            let before = u64::from(pair[0]) | u64::from(pair[1]) << 32;
            let more: i64 = totals.iter().filter_map(|chunk| chunk.get(b)).map(|sum| sum[component]).sum();
            let after = before.wrapping_add(more as u64);
            (pair[0], pair[1]) = (after as u32, (after >> 32) as u32);
        }
    }
}

/// Force in N and torque in N m of the words of a body.
pub(super) fn force_and_torque(params: &Params, words: &[u32]) -> [Vec3; 2] {
    let quantum = quantum(params);
    let [force, torque] = [0, 6].map(|first| {
        let words = &words[first..first + 6];
        Vec3::new(value(words, 0), value(words, 2), value(words, 4))
    });
    [quantum * force, quantum * params.support_radius * torque]
}

/// Converts a 64-bit sum to a float, with the rounding of the GPU: half by half. The sign is separated first, because
/// the halves of a small negative number are large.
fn value(words: &[u32], first: usize) -> f32 {
    let sum = (u64::from(words[first]) | u64::from(words[first + 1]) << 32).cast_signed();
    let size = sum.unsigned_abs();
    let value = (size >> 32) as f32 * 4_294_967_296.0 + size as u32 as f32;
    if sum < 0 { -value } else { value }
}

/// Rounds to whole units of a sum; NaN becomes zero.
fn fixed(value: f32) -> i64 {
    // A million of the largest terms still fit into the sum.
    value.clamp(-1e12, 1e12).round_ties_even() as i64
}
