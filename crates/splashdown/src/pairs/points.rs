//! Sums over the particles near arbitrary points.

use glam::Vec3;
use rayon::prelude::*;

use super::Sorted;
use super::candidates::{Candidates, Region};
use super::columns::Columns;
use crate::simd::{Leaf, Register, Simd, run_with};

/// A pass that sums `S` quantities over the particles near a point, from `F` columns. The first
/// three columns are the position.
///
/// Functions with registers as arguments must be `#[inline(always)]`.
pub(crate) trait PointSum<const F: usize, const S: usize>: Sync {
    /// The values of particle `j` in the columns; see [`PairSum::load`](super::PairSum::load).
    fn load(&self, j: usize) -> [f32; F];

    /// The contributions of a register of particles to the sums at the point `x`.
    fn pair<V: Register>(&self, x: [V; 3]) -> impl Fn([V; F]) -> [V; S];
}

/// The sums at every point, in the order of the points.
///
/// The points of a cube share their candidates. The sums at a point depend on which other points
/// are in its cube, only in the last bits and not on their order.
pub(crate) fn sums_at<const F: usize, const S: usize, P: PointSum<F, S>>(
    sorted: Sorted<'_>,
    points: &[Vec3],
    pass: &P,
) -> Vec<[f32; S]> {
    sums_at_with(Simd::in_use(), sorted, points, pass)
}

pub(super) fn sums_at_with<const F: usize, const S: usize, P: PointSum<F, S>>(
    simd: Simd,
    sorted: Sorted<'_>,
    points: &[Vec3],
    pass: &P,
) -> Vec<[f32; S]> {
    let mut sums = vec![[0.0; S]; points.len()];
    if points.is_empty() {
        return sums;
    }
    let columns = &Columns::new(sorted.active_count(), |j| pass.load(j));
    let entry = |(i, &x): (usize, &Vec3)| u64::from(sorted.grid.cube_of(x)) << 32 | i as u64;
    let mut entries: Vec<u64> = points.par_iter().enumerate().map(entry).collect();
    entries.par_sort_unstable();

    let mut by_cube = vec![[0.0; S]; points.len()];
    let mut rest = &mut by_cube[..];
    let mut groups = Vec::new();
    for entries in entries.chunk_by(|a, b| a >> 32 == b >> 32) {
        let (sums, after) = rest.split_at_mut(entries.len());
        rest = after;
        groups.push((entries, sums));
    }
    groups.into_par_iter().with_min_len(8).for_each_init(Candidates::new, |candidates, (entries, sums)| {
        run_with(simd, Group { sorted, columns, candidates, entries, points, sums, pass })
    });
    for (entry, value) in entries.iter().zip(by_cube) {
        sums[index(*entry)] = value;
    }
    sums
}

/// The index of the point of an entry (cube, index).
fn index(entry: u64) -> usize {
    (entry & u64::from(u32::MAX)) as usize
}

/// The points of one cube.
struct Group<'a, const F: usize, const S: usize, P: PointSum<F, S>> {
    sorted: Sorted<'a>,
    columns: &'a Columns<F>,
    candidates: &'a mut Candidates<F>,
    entries: &'a [u64],
    points: &'a [Vec3],
    sums: &'a mut [[f32; S]],
    pass: &'a P,
}

impl<const F: usize, const S: usize, P: PointSum<F, S>> Leaf for Group<'_, F, S, P> {
    #[inline(always)]
    fn run<V: Register>(self) {
        let Self { sorted, columns, candidates, entries, points, sums, pass } = self;
        let cube = (entries[0] >> 32) as usize;
        let targets = entries.iter().map(|&entry| points[index(entry)]);
        let region = Region::around(targets, sorted.support_radius);
        candidates.pack::<V>(columns, &sorted.runs_around(cube), &region);
        for (&entry, sums) in entries.iter().zip(sums) {
            let x = points[index(entry)].to_array().map(V::splat);
            *sums = candidates.sum::<V, S>(pass.pair::<V>(x));
        }
    }
}
