//! What a visit loads of each neighbour at once, on the CPU.
//!
//! The positions do not change in a solve, and [`predict`](super::predict) computes the velocities that
//! [`residual`](super::residual) visits. So both passes share these arrays, and keep them from iteration to iteration. The
//! memory is kept from step to step, because new memory is slow.

use glam::Vec4;
use rayon::prelude::*;

use crate::pairs::Outputs;

/// Particles per task.
pub(super) const CHUNK: usize = 4096;

/// Arrays with an item for each active particle.
#[derive(Default)]
pub(super) struct Points {
    /// The position, and the pressure as the fourth component.
    pub pressures: Vec<Vec4>,
    /// The position, and the predicted velocity.
    pub velocities: Vec<[Vec4; 2]>,
    /// The iteration whose predicted velocities these are.
    pub predicted_in: Option<u32>,
}

impl Points {
    /// The number of particles, if all arrays have it.
    pub fn count(&self) -> Option<usize> {
        Some(self.pressures.len()).filter(|&count| count == self.velocities.len())
    }

    /// Stores the positions.
    pub fn begin(&mut self, positions: &[Vec4]) {
        self.pressures.resize(positions.len(), Vec4::ZERO);
        self.velocities.resize(positions.len(), [Vec4::ZERO; 2]);
        self.predicted_in = None;
        let points = self.pressures.par_iter_mut().zip(&mut self.velocities);
        points.zip(positions).with_min_len(CHUNK).for_each(|((point, moving), x)| {
            *point = *x;
            moving[0] = *x;
        });
    }

    /// Stores all predicted velocities, for a pass that runs without the one before it.
    pub fn set_velocities(&mut self, positions: &[Vec4], predicted: &[Vec4]) {
        self.velocities.resize(positions.len(), [Vec4::ZERO; 2]);
        let points = self.velocities.par_iter_mut().zip(positions).zip(predicted);
        points.with_min_len(CHUNK).for_each(|((point, x), u)| *point = [*x, *u]);
    }
}

/// Stores results as the second vectors of pairs.
pub(super) struct Second<'a>(pub &'a mut [[Vec4; 2]]);

impl Outputs<Vec4> for Second<'_> {
    fn split_at(self, middle: usize) -> (Self, Self) {
        let (first, second) = self.0.split_at_mut(middle);
        (Self(first), Self(second))
    }

    #[inline(always)]
    fn put(&mut self, i: usize, value: Vec4) {
        self.0[i][1] = value;
    }
}
