//! Visits of the particles near boxes.

use glam::Vec3;
use rayon::prelude::*;

use super::Sorted;
use super::candidates::{Candidates, Region};
use super::columns::Columns;
use super::vector::reflected_point;
use crate::boundary::Reflection;
use crate::simd::{Leaf, Register, Simd, run_with};

/// A pass that visits the particles within the support radius of boxes, in `F` columns. The first
/// three columns are the position.
///
/// Functions with registers as arguments must be `#[inline(always)]`.
pub(crate) trait BoxPass<const F: usize>: Sync {
    /// The result of a box.
    type Output: Send;

    /// The column with the square of the distance within which a particle is near a box, if each has its own. It is at most
    /// the support radius.
    const REACH2: Option<usize> = None;

    /// The values of particle `j` in the columns.
    fn load(&self, j: usize) -> [f32; F];

    /// The columns of the images of a register of particles behind a wall.
    #[inline(always)]
    fn reflect<V: Register>(&self, reflection: &Reflection, values: [V; F]) -> [V; F] {
        let mut image = values;
        image[..3].copy_from_slice(&reflected_point(reflection, [values[0], values[1], values[2]]));
        image
    }

    /// The lower and upper corner of box `i`, in metres.
    fn corners(&self, i: usize) -> [Vec3; 2];

    /// Writes the result of a box that needs no visit, and returns whether it has.
    fn shortcut(&self, _i: usize, _out: &mut Self::Output) -> bool {
        false
    }

    /// Computes the result of box `i`. The columns in `near` have equal lengths, a multiple of
    /// [`BLOCK`](crate::simd::BLOCK). The padding at the end is far away, with zeros after the
    /// position.
    fn visit<V: Register>(&self, i: usize, near: [&[f32]; F], out: &mut Self::Output);
}

/// Runs a pass over boxes: box `i` writes item `i` of `outputs`.
pub(crate) fn for_each_box<const F: usize, P: BoxPass<F>>(
    sorted: Sorted<'_>,
    outputs: impl IndexedParallelIterator<Item = P::Output>,
    pass: &P,
) {
    for_each_box_with(Simd::in_use(), sorted, outputs, pass);
}

pub(super) fn for_each_box_with<const F: usize, P: BoxPass<F>>(
    simd: Simd,
    sorted: Sorted<'_>,
    outputs: impl IndexedParallelIterator<Item = P::Output>,
    pass: &P,
) {
    let columns = &Columns::new(sorted.active_count(), |j| pass.load(j));
    outputs.enumerate().for_each_init(Candidates::new, |candidates, (i, mut out)| {
        run_with(simd, OneBox { sorted, columns, candidates, i, out: &mut out, pass })
    });
}

struct OneBox<'a, const F: usize, P: BoxPass<F>> {
    sorted: Sorted<'a>,
    columns: &'a Columns<F>,
    candidates: &'a mut Candidates<F>,
    i: usize,
    out: &'a mut P::Output,
    pass: &'a P,
}

impl<const F: usize, P: BoxPass<F>> Leaf for OneBox<'_, F, P> {
    #[inline(always)]
    fn run<V: Register>(self) {
        let Self { sorted, columns, candidates, i, out, pass } = self;
        if pass.shortcut(i, out) {
            return;
        }
        let corners = pass.corners(i);
        let region = Region::around(corners, sorted.support_radius).with_own_reach2(P::REACH2);
        let reflect = |by: &Reflection, values| pass.reflect(by, values);
        candidates.pack_range::<V>(columns, &sorted, corners, &region, reflect);
        pass.visit::<V>(i, candidates.columns(), out);
    }
}
