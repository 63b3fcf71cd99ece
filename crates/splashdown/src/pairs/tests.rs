use glam::{Vec3, Vec4, Vec4Swizzles};
use rayon::prelude::*;

use super::boxes::for_each_box_with;
use super::lists::NeighbourLists;
use super::near::{Differences, NearImages, Projections, Values};
use super::particles::for_each_with;
use super::points::sums_at_with;
use super::*;
use crate::boundary::Reflection;
use crate::kernel::{Kernel, WendlandC2};
use crate::simd::{Register, Simd};

const SUPPORT: f32 = 0.1;

/// Sums the number of neighbours and a value.
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
    fn finish(&self, _: usize, sums: [f32; 2]) -> [f32; 2] {
        sums
    }
}

/// The same in more sums, so that the neighbours are packed first.
struct Long<'a>(Count<'a>);

impl PairSum<4, 6> for Long<'_> {
    type Output = [f32; 2];

    #[inline(always)]
    fn load(&self, j: usize) -> [f32; 4] {
        PairSum::load(&self.0, j)
    }

    #[inline(always)]
    fn pair<V: Register>(&self, i: usize) -> impl Fn([V; 4]) -> [V; 6] {
        let pair = PairSum::pair::<V>(&self.0, i);
        #[inline(always)]
        move |values| {
            let [n, sum] = pair(values);
            [n, sum, n, sum, n, sum]
        }
    }

    #[inline(always)]
    fn finish(&self, _: usize, sums: [f32; 6]) -> [f32; 2] {
        assert_eq!(sums[..2], sums[4..]);
        [sums[2], sums[3]]
    }
}

/// Particles in a box of 6 x 5 x 4 support radii, sorted: a random cloud, a dense cell with 200,
/// and empty cells.
fn cloud() -> (Grid, Vec<u32>, Vec<Vec4>) {
    let inner = SUPPORT * Vec3::new(6.0, 5.0, 4.0);
    let grid =
        Grid::new(Vec3::ZERO, inner, SUPPORT).and_then(|grid| grid.with_slices(4)).expect("a small grid");
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

impl PointSum<4, 2> for Count<'_> {
    #[inline(always)]
    fn load(&self, j: usize) -> [f32; 4] {
        PairSum::load(self, j)
    }

    #[inline(always)]
    fn pair<V: Register>(&self, x: [V; 3]) -> impl Fn([V; 4]) -> [V; 2] {
        let (one, zero, bound) = (V::splat(1.0), V::splat(0.0), V::splat(self.bound));
        #[inline(always)]
        move |[x_j, y_j, z_j, value]| {
            let d = difference(x, [x_j, y_j, z_j]);
            let inside = dot(d, d).if_less(bound, one, zero);
            [inside, inside * value]
        }
    }
}

/// The number of neighbours, and the sum of a value over them.
type Counts = Vec<[f32; 2]>;

/// The particles, their values, and the square of the bound in `factor` support radii.
struct Case {
    grid: Grid,
    cell_start: Vec<u32>,
    positions: Vec<Vec4>,
    values: Vec<f32>,
    bound: f32,
}

impl Case {
    fn new(factor: f32) -> Self {
        let (grid, cell_start, positions) = cloud();
        let values = (0..positions.len()).map(|j| 0.1 + (j % 17) as f32 * 0.37).collect();
        let bound = (factor * SUPPORT) * (factor * SUPPORT);
        Self { grid, cell_start, positions, values, bound }
    }

    fn sorted(&self) -> Sorted<'_> {
        Sorted::new(SUPPORT, &self.grid, &self.cell_start, &self.positions)
    }

    fn pass(&self) -> Count<'_> {
        Count { positions: &self.positions, values: &self.values, bound: self.bound }
    }

    /// The counts at a point by brute force.
    fn expected(&self, x: Vec3) -> [f32; 2] {
        let near = self.positions.iter().zip(&self.values).filter(|(other, _)| {
            let d = x - other.xyz();
            d.x * d.x + d.y * d.y + d.z * d.z < self.bound
        });
        near.fold([0.0; 2], |[n, sum], (_, value)| [n + 1.0, sum + value])
    }

    fn expected_at_particles(&self) -> Counts {
        self.positions.iter().map(|p| self.expected(p.xyz())).collect()
    }

    /// The counts at the particles for every available kind of register.
    fn found(&self) -> Vec<(Simd, Counts)> {
        let run = |simd| {
            let mut out = vec![[0.0; 2]; self.positions.len()];
            for_each_with(simd, self.sorted(), out.as_mut_slice(), &self.pass());
            (simd, out)
        };
        kinds().map(run).collect()
    }
}

fn kinds() -> impl Iterator<Item = Simd> {
    Simd::ALL.into_iter().filter(|simd| simd.is_available())
}

/// Compares counts with those of the brute force, and the bits between the kinds of registers.
fn compare(expected: &Counts, found: &[(Simd, Counts)]) {
    for (simd, out) in found {
        for (i, (out, expected)) in out.iter().zip(expected).enumerate() {
            assert_eq!(out[0], expected[0], "target {i} with {} registers", simd.name());
            assert!((out[1] - expected[1]).abs() <= 1e-4 * expected[1], "target {i}: {out:?}");
        }
        assert!(*out == found[0].1, "{} registers give other bits", simd.name());
    }
}

#[test]
fn every_neighbour_is_visited_once_and_every_register_gives_the_same_bits() {
    let case = Case::new(1.0);
    let expected = case.expected_at_particles();
    let most = expected.iter().map(|[n, _]| *n).fold(0.0, f32::max);
    assert!(most > 200.0, "particles in the dense cell have {most} neighbours");
    compare(&expected, &case.found());
}

/// Negative control: with a support radius that is too small, the engine misses neighbours.
#[test]
fn particles_beyond_the_support_are_not_all_visited() {
    let case = Case::new(1.5);
    let missed = |(expected, out): (&[f32; 2], &[f32; 2])| out[0] < expected[0];
    assert!(case.expected_at_particles().iter().zip(&case.found()[0].1).any(missed));
}

/// Points in the box, in the ghost cells and outside of the grid, several in a cell, and none at
/// all.
#[test]
fn sums_at_points_equal_those_of_the_brute_force() {
    let case = Case::new(1.0);
    let spread =
        |i: usize| Vec3::new(i as f32 * 0.0137, (i * 7 % 80) as f32 * 0.0081, (i * 13 % 60) as f32 * 0.009);
    let mut points: Vec<Vec3> = (0..60).map(|i| spread(i) - 0.1).collect();
    points.extend((0..40).map(|i| case.positions[17 * i % case.positions.len()].xyz() + 0.01));
    points.extend([Vec3::splat(-0.05), Vec3::new(0.65, 0.3, 0.2), Vec3::splat(40.0), Vec3::NAN]);
    let expected = points.iter().map(|&x| case.expected(x)).collect();
    let found = |points: &[Vec3]| -> Vec<(Simd, Counts)> {
        kinds().map(|simd| (simd, sums_at_with(simd, case.sorted(), points, &case.pass()))).collect()
    };
    compare(&expected, &found(&points));
    assert!(expected.iter().any(|[n, _]| *n > 20.0), "some points are among particles");
    // Sums do not depend on the order of the points.
    points.reverse();
    let reversed = found(&points);
    points.reverse();
    assert!(reversed[0].1.iter().rev().eq(&found(&points)[0].1));
    assert!(found(&[])[0].1.is_empty());
    assert_eq!(
        sums_at(case.sorted(), &points, &case.pass()),
        reversed[0].1.iter().rev().copied().collect::<Counts>()
    );
}

/// Counts the particles near a box.
struct InBox<'a> {
    positions: &'a [Vec4],
    boxes: &'a [[Vec3; 2]],
}

fn distance2(x: Vec3, [low, high]: [Vec3; 2]) -> f32 {
    (x - x.clamp(low, high)).length_squared()
}

impl<'a> BoxPass<3> for InBox<'a> {
    type Output = &'a mut u32;

    fn load(&self, j: usize) -> [f32; 3] {
        self.positions[j].xyz().to_array()
    }

    fn corners(&self, i: usize) -> [Vec3; 2] {
        self.boxes[i]
    }

    #[inline(always)]
    fn visit<V: Register>(&self, i: usize, [x, y, z]: [&[f32]; 3], out: &mut Self::Output) {
        assert!(x.len() % crate::simd::BLOCK == 0 && x.len() == y.len() && x.len() == z.len());
        let near = x.iter().zip(y).zip(z).map(|((&x, &y), &z)| Vec3::new(x, y, z));
        **out = near.filter(|&x| distance2(x, self.boxes[i]) < SUPPORT * SUPPORT).count() as u32;
    }
}

#[test]
fn boxes_receive_all_particles_within_the_support() {
    let case = Case::new(1.0);
    let boxes = [
        [Vec3::new(0.21, 0.22, 0.2), Vec3::new(0.3, 0.25, 0.27)],
        [Vec3::splat(-0.3), Vec3::splat(0.05)],
        [Vec3::splat(0.3), Vec3::splat(7.0)],
        [Vec3::splat(8.0), Vec3::splat(9.0)],
        [Vec3::splat(-9.0), Vec3::splat(-8.0)],
        [Vec3::splat(-1.0), Vec3::splat(1.0)],
    ];
    let expected = boxes.map(|corners| {
        let is_near = |x: &&Vec4| distance2(x.xyz(), corners) < SUPPORT * SUPPORT;
        case.positions.iter().filter(is_near).count() as u32
    });
    assert!(expected[0] > 50 && expected[5] as usize == case.positions.len() && expected[3] == 0);
    for simd in kinds() {
        let pass = InBox { positions: &case.positions, boxes: &boxes };
        let mut counts = [0; 6];
        for_each_box_with(simd, case.sorted(), counts.par_iter_mut(), &pass);
        assert_eq!(counts, expected, "{} registers", simd.name());
    }
}

/// Walls at three sides of the particles.
fn images() -> Images {
    Images::between(
        Vec3::new(-0.01, 0.0, f32::NEG_INFINITY),
        Vec3::new(f32::INFINITY, f32::INFINITY, 4.0 * SUPPORT),
    )
}

/// The neighbours of particle `i` by brute force: gradients, signs of reflections and indices.
fn listed(case: &Case, i: usize, images: Images) -> Vec<(Vec3, Vec3, usize)> {
    let x = case.positions[i].xyz();
    let itself = Reflection { sign: Vec3::ONE, shift: Vec3::ZERO };
    let reflections: Vec<_> = [itself].into_iter().chain(images.near(x, x, SUPPORT)).collect();
    let mut found = Vec::new();
    for by in reflections {
        for (j, other) in case.positions.iter().enumerate() {
            let d = x - (by.sign * other.xyz() + by.shift);
            if d.length_squared() < SUPPORT * SUPPORT && d != Vec3::ZERO {
                found.push((WendlandC2::g(d.length() / SUPPORT) * d, by.sign, j));
            }
        }
    }
    found
}

/// For each particle the sums of [`Near`] over particles and images.
fn sums_of_lists(simd: Simd, case: &Case, images: Images) -> Vec<[Vec4; 4]> {
    let sorted = case.sorted().with_images(images);
    let vectors: Vec<Vec4> = case.values.iter().map(|v| Vec4::new(*v, 1.0 - v, 0.5 * v * v, 0.0)).collect();
    let mut lists = NeighbourLists::<WendlandC2>::default();
    let lists = lists.of_with(simd, sorted);
    let points: Vec<Vec4> =
        case.positions.iter().zip(&case.values).map(|(x, v)| x.xyz().extend(*v)).collect();
    let of = |formula: &dyn Fn(&mut [[Vec4; 2]])| {
        let mut out = vec![[Vec4::ZERO; 2]; case.positions.len()];
        formula(&mut out);
        out
    };
    let result = |i: usize, sum: Vec4, images: NearImages<'_>| {
        let own = vectors[i];
        let of_images = images.iter().map(|(s, sign, j)| s * (own - sign * vectors[j])).sum::<Vec4>();
        [sum, of_images].map(|sum| sum.xyz().extend(0.0))
    };
    let pairs: Vec<_> = case.positions.iter().zip(&vectors).map(|(x, v)| [*x, *v]).collect();
    let differences = || Differences(&pairs);
    let values = of(&|out| lists.for_each(sorted, out, &Values(&points), result));
    let others = of(&|out| lists.for_each(sorted, out, &differences(), result));
    let projections = of(&|out| lists.for_each(sorted, out, &Projections(differences()), result));
    let sums = values.into_iter().zip(others).zip(projections);
    sums.map(|(([v, images], [d, _]), [p, _])| [-v, d, p, images]).collect()
}

#[test]
fn lists_contain_the_neighbours_and_their_images() {
    let case = Case::new(1.0);
    let found = sums_of_lists(Simd::Portable, &case, images());
    let vector = |j: usize| {
        let v = case.values[j];
        Vec3::new(v, 1.0 - v, 0.5 * v * v)
    };
    let mut seen_images = 0;
    for (i, sums) in found.iter().enumerate() {
        let near = listed(&case, i, images());
        let (particles, reflected): (Vec<_>, Vec<_>) =
            near.into_iter().partition(|(_, sign, _)| *sign == Vec3::ONE);
        seen_images += reflected.len();
        let values: Vec3 = particles.iter().map(|(g, _, j)| (case.values[i] + case.values[*j]) * *g).sum();
        let differences: Vec3 = particles.iter().map(|(g, _, j)| *g * (vector(i) - vector(*j))).sum();
        let of_images: Vec3 =
            reflected.iter().map(|(g, sign, j)| *g * (vector(i) - *sign * vector(*j))).sum();
        let bound = 1e-6 * 7.05 * SUPPORT * 20.0 * (particles.len() + reflected.len() + 1) as f32;
        for (sum, expected) in [(sums[0], values), (sums[1], differences), (sums[3], of_images)] {
            assert!(sum.xyz().abs_diff_eq(expected, bound), "particle {i}: {sum} and {expected}");
        }
    }
    assert!(seen_images > 1000, "{seen_images}");
    // Negative control: without the images the sums differ.
    let without = sums_of_lists(Simd::Portable, &case, Images::NONE);
    assert!(found.iter().zip(&without).any(|(a, b)| a[3].distance(b[3]) > 0.5 * SUPPORT));
}

#[test]
fn every_register_makes_the_same_lists_and_sums() {
    let case = Case::new(1.0);
    let expected = sums_of_lists(Simd::Portable, &case, images());
    assert!(expected.iter().any(|sums| sums[2].length() > 0.1 * SUPPORT));
    for simd in kinds() {
        assert!(
            sums_of_lists(simd, &case, images()) == expected,
            "{} registers give other bits",
            simd.name()
        );
    }
}

#[test]
fn lists_follow_the_particles() {
    let mut case = Case::new(1.0);
    let mut lists = NeighbourLists::<WendlandC2>::default();
    let count = |lists: &NeighbourLists<WendlandC2>, case: &Case| -> Vec<usize> {
        lists.neighbours(case.sorted()).iter().map(Vec::len).collect()
    };
    let before = count(lists.of(case.sorted()), &case);
    let first = before.iter().position(|count| *count > 0).expect("neighbours");
    assert_eq!(before[first], listed(&case, first, Images::NONE).len());
    // Within its cell, but elsewhere.
    case.positions[first].x += 0.3 * SUPPORT;
    let after = count(lists.of(case.sorted()), &case);
    assert_eq!(after[first], listed(&case, first, Images::NONE).len());
    assert_ne!(before, after);
}

#[test]
fn long_formulas_run_on_the_neighbours_only() {
    const { assert!(<Long<'_> as PairSum<4, 6>>::IS_LONG && !<Count<'_> as PairSum<4, 2>>::IS_LONG) };
    for images in [Images::NONE, images()] {
        // The second bound is beyond the support: those neighbours are left out.
        for factor in [1.0, 1.2] {
            let case = Case::new(factor);
            let sorted = case.sorted().with_images(images);
            let counts = |simd| {
                let (mut short, mut long) =
                    (vec![[0.0; 2]; case.positions.len()], vec![[0.0; 2]; case.positions.len()]);
                for_each_with(simd, sorted, short.as_mut_slice(), &Case::new(1.0).pass());
                for_each_with(simd, sorted, long.as_mut_slice(), &Long(case.pass()));
                (short, long)
            };
            let (short, long) = counts(Simd::Portable);
            for (short, long) in short.iter().zip(&long) {
                assert!(
                    short[0] == long[0] && (short[1] - long[1]).abs() <= 1e-5 * short[1],
                    "{short:?}, {long:?}"
                );
            }
            for simd in kinds() {
                assert!(counts(simd).1 == long, "{} registers give other bits", simd.name());
            }
        }
    }
}

#[test]
fn a_vector_that_is_not_finite_reaches_the_neighbours_only() {
    let case = Case::new(1.0);
    let mut lists = NeighbourLists::<WendlandC2>::default();
    let lists = lists.of(case.sorted());
    let neighbours = lists.neighbours(case.sorted());
    for bad in 0..8 {
        let vector = |j: usize| if j == bad { Vec4::NAN } else { Vec4::ONE };
        let pairs: Vec<_> = case.positions.iter().enumerate().map(|(j, x)| [*x, vector(j)]).collect();
        let mut sums = vec![Vec4::ZERO; pairs.len()];
        lists.for_each(case.sorted(), sums.as_mut_slice(), &Differences(&pairs), |_, sum, _| sum);
        for (i, sum) in sums.iter().enumerate() {
            let is_reached = neighbours[i].contains(&bad);
            assert!(i == bad || sum.is_finite() != is_reached, "particle {i}, vector {bad}: {sum}");
        }
    }
}
