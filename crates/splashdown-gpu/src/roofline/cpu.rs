//! The CPU code of the measurements.

use glam::Vec4;
use rayon::prelude::*;

use super::{CountBindings, LINKS, StreamBindings};
use crate::CpuWork;

/// Vectors per task of the copy: half a mebibyte.
const COPIED_PER_TASK: usize = 1 << 15;
/// Vectors processed together: enough lanes to fill several of the widest registers.
const TOGETHER: usize = 16;

pub(super) fn copy(StreamBindings { values, results }: StreamBindings<'_>) {
    let n = values.len().min(results.len());
    let tasks = results[..n].par_chunks_mut(COPIED_PER_TASK).zip(values[..n].par_chunks(COPIED_PER_TASK));
    tasks.for_each(|(to, from)| to.copy_from_slice(from));
}

pub(super) fn madd(work: CpuWork<'_>, StreamBindings { values, results }: StreamBindings<'_>) {
    let n = values.len().min(results.len()).min(work.items as usize);
    let tasks = results[..n].par_chunks_mut(TOGETHER).zip(values[..n].par_chunks(TOGETHER)).with_min_len(64);
    tasks.for_each(|(to, from)| {
        // A short chunk is padded, so that the loop has a fixed length.
        let mut block = [Vec4::ZERO; TOGETHER];
        block[..from.len()].copy_from_slice(from);
        chains(bytemuck::cast_mut(&mut block));
        to.copy_from_slice(&block[..to.len()]);
    });
}

fn chains(x: &mut [f32; 4 * TOGETHER]) {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma") {
        // SAFETY: the processor has both.
        unsafe { fused(x) };
        return;
    }
    work(x, |a, b, c| a * b + c);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn fused(x: &mut [f32; 4 * TOGETHER]) {
    work(x, f32::mul_add);
}

/// Applies one factor after the other to all lanes; on the CPU the lanes are the independent chains.
#[inline(always)]
fn work(x: &mut [f32; 4 * TOGETHER], fma: impl Fn(f32, f32, f32) -> f32) {
    let begin = *x;
    let mut sum = [0.0; 4 * TOGETHER];
    for factor in [0.0, 1e-4, 2e-4, 3e-4, 4e-4, 5e-4, 6e-4, 7e-4] {
        let mut lanes = begin;
        for _ in 0..LINKS {
            for lane in &mut lanes {
                *lane = fma(*lane, factor, *lane);
            }
        }
        for (sum, lane) in sum.iter_mut().zip(lanes) {
            *sum += lane;
        }
    }
    *x = sum;
}

pub(super) fn nothing(CountBindings { counter }: CountBindings<'_>) {
    counter[0] = counter[0].wrapping_add(1);
}
