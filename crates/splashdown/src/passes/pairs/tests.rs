use glam::{Vec3, Vec4, Vec4Swizzles};

use super::*;

const SUPPORT: f32 = 0.1;

/// The number of neighbours, and the sum of a value over them.
struct Count<'a> {
    positions: &'a [Vec4],
    values: &'a [f32],
    bound: f32,
}

impl PairSum<4, 2> for Count<'_> {
    type Output = [f32; 2];

    #[inline(always)]
    fn load(&self, j: usize) -> [f32; 4] {
        let p = self.positions[j];
        [p.x, p.y, p.z, self.values[j]]
    }

    #[inline(always)]
    fn pair<V: Register>(&self, i: usize) -> impl Fn([V; 4]) -> [V; 2] {
        let x = splat::<V>(self.positions[i]);
        let (one, zero, bound) = (V::splat(1.0), V::splat(0.0), V::splat(self.bound));
        #[inline(always)]
        move |[x_j, y_j, z_j, value]| {
            let d = difference(x, [x_j, y_j, z_j]);
            let inside = dot(d, d).if_less(bound, one, zero);
            [inside, inside * value]
        }
    }

    #[inline(always)]
    fn finish(&self, _: usize, sums: [f32; 2], out: &mut [f32; 2]) {
        *out = sums;
    }
}

/// Particles in a box of 6 x 5 x 4 supports, sorted: a cloud, a cell with two hundred, and empty cells.
fn cloud() -> (Grid, Vec<u32>, Vec<Vec4>) {
    let inner = SUPPORT * Vec3::new(6.0, 5.0, 4.0);
    let grid = Grid::new(Vec3::ZERO, inner, SUPPORT).expect("a small grid");
    let mut state = 1_u32;
    let mut random = move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / (1 << 24) as f32
    };
    let mut positions: Vec<Vec4> =
        (0..700).map(|_| (Vec3::new(random(), random(), random()) * inner).extend(0.0)).collect();
    positions.extend(
        (0..200).map(|_| {
            (SUPPORT * (Vec3::splat(2.0) + 0.9 * Vec3::new(random(), random(), random()))).extend(0.0)
        }),
    );
    positions.retain(|p| p.x < 0.3 || p.y > 0.2);
    positions.sort_by_key(|p| grid.cell_of(p.xyz()));
    let mut cell_start = vec![0; grid.cell_count as usize + 2];
    for p in &positions {
        cell_start[grid.cell_of(p.xyz()) as usize + 1] += 1;
    }
    for cell in 0..cell_start.len() - 1 {
        cell_start[cell + 1] += cell_start[cell];
    }
    (grid, cell_start, positions)
}

/// Number of neighbours and sum over them, for every particle.
type Counts = Vec<[f32; 2]>;

/// What is true, and what every kind of register counts within `bound` times the support.
fn counted(bound: f32) -> (Counts, Vec<(Simd, Counts)>) {
    let (grid, cell_start, positions) = cloud();
    let values: Vec<f32> = (0..positions.len()).map(|j| 0.1 + (j % 17) as f32 * 0.37).collect();
    let bound = (bound * SUPPORT) * (bound * SUPPORT);
    let pass = Count { positions: &positions, values: &values, bound };
    let sorted =
        Sorted { grid: &grid, cell_start: &cell_start, positions: &positions, support_radius: SUPPORT };
    let found = Simd::ALL.into_iter().filter(|simd| simd.is_available()).map(|simd| {
        let mut out = vec![[0.0; 2]; positions.len()];
        for_each_with(simd, sorted, &mut out, &pass);
        (simd, out)
    });
    let expected = positions.iter().map(|p| {
        let near = positions.iter().zip(&values).filter(|(other, _)| {
            let d = p.xyz() - other.xyz();
            d.x * d.x + d.y * d.y + d.z * d.z < bound
        });
        near.fold([0.0; 2], |[n, sum], (_, value)| [n + 1.0, sum + value])
    });
    (expected.collect(), found.collect())
}

#[test]
fn every_neighbour_is_visited_once_and_every_register_gives_the_same_bits() {
    let (expected, found) = counted(1.0);
    let most = expected.iter().map(|[n, _]| *n).fold(0.0, f32::max);
    assert!(most > 200.0, "the clump has {most} neighbours");
    for (simd, out) in &found {
        for (i, (out, expected)) in out.iter().zip(&expected).enumerate() {
            assert_eq!(out[0], expected[0], "particle {i} with {} registers", simd.name());
            assert!((out[1] - expected[1]).abs() < 1e-4 * expected[1], "particle {i}: {out:?}");
        }
        assert!(*out == found[0].1, "{} registers give other bits", simd.name());
    }
}

/// The negative control: a support that was told too small loses neighbours, so the test above can fail.
#[test]
fn what_is_beyond_the_support_is_not_all_visited() {
    let (expected, found) = counted(1.5);
    assert!(expected.iter().zip(&found[0].1).any(|(expected, out)| out[0] < expected[0]));
}
