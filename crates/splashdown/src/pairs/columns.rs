//! Quantities of the particles, one array per quantity.

use std::cell::Cell;

use rayon::prelude::*;

use crate::simd::BLOCK;

/// Particles per task.
const CHUNK: usize = 4096;

thread_local! {
    /// The memory of the last columns of this thread. Newly allocated pages would cost as much as
    /// filling them.
    static MEMORY: Cell<Vec<f32>> = const { Cell::new(Vec::new()) };
}

/// `F` columns. A block beyond the end of each may be read.
pub(super) struct Columns<const F: usize> {
    values: Vec<f32>,
    stride: usize,
}

impl<const F: usize> Columns<F> {
    /// The columns of `count` particles.
    pub fn new(count: usize, load: impl Fn(usize) -> [f32; F] + Sync) -> Self {
        let stride = count + BLOCK;
        let mut values = MEMORY.take();
        // Frees the memory of a much larger scene.
        if values.capacity() > 4 * F.max(8) * stride {
            values = Vec::new();
        }
        // Old values are overwritten, or masked when they are read.
        values.resize(values.len().max(F * stride), 0.0);
        let mut rest: [&mut [f32]; F] = {
            let mut columns = values.chunks_exact_mut(stride);
            std::array::from_fn(|_| &mut columns.next().expect("there is a chunk for every column")[..count])
        };
        let mut tasks = Vec::with_capacity(count.div_ceil(CHUNK));
        for begin in (0..count).step_by(CHUNK) {
            let size = CHUNK.min(count - begin);
            let piece = rest
                .each_mut()
                .map(|column| column.split_off_mut(..size).expect("the tasks cover the columns exactly"));
            tasks.push((begin, size, piece));
        }
        tasks.into_par_iter().for_each(|(begin, size, mut piece)| {
            for k in 0..size {
                for (column, value) in piece.iter_mut().zip(load(begin + k)) {
                    column[k] = value;
                }
            }
        });
        Self { values, stride }
    }

    /// A column.
    #[inline(always)]
    pub fn column(&self, f: usize) -> &[f32] {
        &self.values[f * self.stride..(f + 1) * self.stride]
    }
}

impl<const F: usize> Drop for Columns<F> {
    fn drop(&mut self) {
        MEMORY.set(std::mem::take(&mut self.values));
    }
}
