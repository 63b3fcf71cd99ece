//! Neighbour search compared with brute force, for both sorting methods on both executors.

use std::collections::HashSet;

use glam::{Vec3, Vec4, Vec4Swizzles};
use proptest::prelude::*;
use splashdown::cells::{Cells, Grid, Sort};
use splashdown::scene::Scene;
use splashdown::schemes;
use splashdown::state::{DEAD_ESCAPED, DEAD_NON_FINITE, Extras, Fields, Params, StepCounters, StepState};
use splashdown_gpu::{CpuExecutor, Executor, Recording, bytemuck, testing};

const SUPPORT: f32 = 0.1;

fn params(particles: u32) -> Params {
    let text = "
        [scene]
        name = \"box\"
        duration = 1.0
        [domain]
        min = [-0.25, 0.0, 0.5]
        max = [0.75, 0.6, 1.3]
        [fluid]
        particle_spacing = 0.05
        [[fluid.block]]
        position = [0.0, 0.1, 0.6]
        size = [0.2, 0.2, 0.2]
    ";
    let params = schemes::params(&Scene::parse(text, "box.toml").unwrap(), particles);
    assert_eq!(params.support_radius, SUPPORT);
    params
}

fn grid() -> Grid {
    let params = params(0);
    Grid::new(params.domain_min, params.domain_max, params.support_radius)
        .and_then(|grid| grid.with_slices(4))
        .unwrap()
}

/// The result of a sort.
#[derive(Debug, Clone, PartialEq)]
struct Sorted {
    cell_start: Vec<u32>,
    ids: Vec<u32>,
    /// Positions and velocities as bits, so that a NaN equals itself.
    positions: Vec<[u32; 4]>,
    velocities: Vec<[u32; 4]>,
    counters: Vec<u32>,
}

fn bits(values: &[Vec4]) -> Vec<[u32; 4]> {
    values.iter().map(|v| v.to_array().map(f32::to_bits)).collect()
}

impl Sorted {
    fn position(&self, k: usize) -> Vec3 {
        Vec4::from_array(self.positions[k].map(f32::from_bits)).xyz()
    }

    fn mark(&self, k: usize) -> f32 {
        f32::from_bits(self.positions[k][3])
    }

    fn active(&self) -> usize {
        self.cell_start[grid().cell_count as usize] as usize
    }
}

/// Ids with gaps, which are not a permutation of the indices.
fn id(i: usize, n: usize) -> u32 {
    // Odd multiples are invertible modulo a power of two, so all are different.
    (i as u32).wrapping_mul(2_654_435_761) % (4 * n.next_power_of_two() as u32)
}

fn sort(executor: &mut Executor, points: &[Vec3], way: Sort) -> Sorted {
    let n = points.len();
    let params = params(n as u32);
    let fields = Fields::new(executor, &params, Extras::default()).unwrap();
    let cells = Cells::new(executor, grid(), n as u32, way).unwrap();
    let positions: Vec<Vec4> = points.iter().map(|p| p.extend(0.0)).collect();
    let velocities: Vec<Vec4> = (0..n).map(|i| Vec4::new(i as f32, -(i as f32), 0.5, 1000.0)).collect();
    executor.write(fields.positions, &positions).unwrap();
    executor.write(fields.velocities, &velocities).unwrap();
    executor.write(fields.ids, &(0..n).map(|i| id(i, n)).collect::<Vec<_>>()).unwrap();
    let state = StepState { run_count: n as u32, ..bytemuck::Zeroable::zeroed() };
    executor.write(fields.state, &[state]).unwrap();
    let mut recording = Recording::new("sort");
    cells.record_first_count(&mut recording, &fields);
    cells.record_sort(&mut recording, &fields, fields.sorted_ids);
    executor.run(&recording).unwrap();
    Sorted {
        cell_start: executor.read(cells.cell_start).unwrap(),
        ids: executor.read(fields.sorted_ids).unwrap(),
        positions: bits(&executor.read(fields.sorted_positions).unwrap()),
        velocities: bits(&executor.read(fields.sorted_velocities).unwrap()),
        counters: executor.read(fields.counters).unwrap(),
    }
}

fn cpu() -> Executor {
    let mut executor = Executor::from(CpuExecutor::new());
    executor.poison();
    executor
}

/// The indices within the support of particle `k`, from the nine row ranges of `cell_start`.
fn walk(sorted: &Sorted, k: usize) -> HashSet<usize> {
    let grid = grid();
    let x = sorted.position(k);
    let mut near = HashSet::new();
    for j in grid.runs_around(&sorted.cell_start, grid.cube_of(x)).into_iter().flatten() {
        if sorted.position(j).distance_squared(x) < SUPPORT * SUPPORT {
            assert!(near.insert(j), "index {j} is in two of the nine ranges");
        }
    }
    near
}

fn brute_force(sorted: &Sorted, k: usize) -> HashSet<usize> {
    let x = sorted.position(k);
    (0..sorted.active()).filter(|&j| sorted.position(j).distance_squared(x) < SUPPORT * SUPPORT).collect()
}

/// Checks all properties of a sort of these points; neighbours are compared for about `sample` of them.
fn check(sorted: &Sorted, points: &[Vec3], sample: usize) -> Result<(), String> {
    let (n, grid, params) = (points.len(), grid(), params(points.len() as u32));
    let inside =
        |p: &Vec3| p.is_finite() && p.cmpge(params.domain_min).all() && p.cmple(params.domain_max).all();
    let expect = |good: bool, what: &str| if good { Ok(()) } else { Err(what.to_owned()) };
    expect(sorted.cell_start.len() == grid.cell_count as usize + 2, "starts")?;
    expect(
        sorted.cell_start[0] == 0 && sorted.cell_start.is_sorted(),
        "`cell_start` does not increase from 0",
    )?;
    expect(
        sorted.cell_start[grid.cell_count as usize + 1] as usize == n,
        "the last entry of `cell_start` is not the number of particles",
    )?;
    let active = points.iter().filter(|p| inside(p)).count();
    expect(sorted.active() == active, "the number of active particles")?;
    let finite = points.iter().filter(|p| p.is_finite()).count();
    expect(
        sorted.counters[StepCounters::ESCAPED] as usize == finite - active,
        "the number of escaped particles",
    )?;
    expect(
        sorted.counters[StepCounters::NON_FINITE] as usize == n - finite,
        "the number of non-finite particles",
    )?;
    // The sort is a permutation that moves all data of a particle together.
    let mut place = vec![usize::MAX; n];
    let by_id: std::collections::HashMap<u32, usize> = (0..n).map(|i| (id(i, n), i)).collect();
    for (k, id) in sorted.ids.iter().enumerate() {
        let i = *by_id.get(id).ok_or("an unknown id")?;
        expect(place[i] == usize::MAX, "a duplicate id")?;
        place[i] = k;
        expect(f32::from_bits(sorted.velocities[k][0]) == i as f32, "the velocity of another particle")?;
        let x = sorted.position(k);
        if !points[i].is_finite() {
            expect(
                sorted.mark(k) == DEAD_NON_FINITE && x == params.domain_min,
                "the mark of non-finite particles",
            )?;
        } else {
            let mark = if inside(&points[i]) { 0.0 } else { DEAD_ESCAPED };
            expect(sorted.mark(k) == mark && x == points[i], "a position or its mark")?;
        }
    }
    for cell in 0..=grid.cell_count as usize {
        let places = sorted.cell_start[cell] as usize..sorted.cell_start[cell + 1] as usize;
        expect(sorted.ids[places.clone()].is_sorted(), "ids are not in order inside a cell")?;
        for k in places.filter(|_| cell < grid.cell_count as usize) {
            expect(grid.cell_of(sorted.position(k)) as usize == cell, "a particle in the wrong cell")?;
        }
    }
    for k in (0..active).step_by((active / sample.max(1)).max(1)) {
        expect(walk(sorted, k) == brute_force(sorted, k), "neighbours differ from brute force")?;
    }
    Ok(())
}

fn random(n: usize) -> Vec<Vec3> {
    let params = params(0);
    let unit = |i: usize| testing::noise(i as u32) as f32 / u32::MAX as f32;
    let size = params.domain_max - params.domain_min;
    (0..n)
        .map(|i| params.domain_min + size * Vec3::new(unit(3 * i), unit(3 * i + 1), unit(3 * i + 2)))
        .collect()
}

/// Distributions that are difficult for a sort, by name.
fn clouds() -> Vec<(String, Vec<Vec3>)> {
    let mut clouds: Vec<(String, Vec<Vec3>)> =
        [1, 2, 63, 64, 65, 255, 256, 257, 4097, 70_000].map(|n| (format!("{n} at random"), random(n))).into();
    let (grid, params) = (grid(), params(0));
    // On cell borders, on the domain's faces, edges and corners, and where rounding may go either way.
    let border =
        |i: u32, j: u32, k: u32| grid.origin + Vec3::new(i as f32, j as f32, k as f32) / grid.cells_per_metre;
    let mut borders = Vec::new();
    // Without points outside: the sort does not order more than 1,024 removed particles, and other clouds contain them.
    for i in grid.slices..=grid.size_x - grid.slices {
        for j in 1..grid.size_y {
            borders.extend((1..grid.size_z).map(|k| border(i, j, k)));
        }
    }
    clouds.push(("cell borders".into(), borders));
    let (min, max) = (params.domain_min, params.domain_max);
    let corner = |bits: u32| {
        Vec3::from_array(std::array::from_fn(|a| if bits >> a & 1 == 1 { max[a] } else { min[a] }))
    };
    let corners = (0..8).map(corner).chain([min.with_x(0.1), max.with_y(0.3), min.with_z(0.9)]);
    clouds.push(("corners, edges and faces".into(), corners.collect()));
    let spot = Vec3::new(0.1, 0.2, 0.7);
    clouds.push(("all in one cell".into(), random(300).iter().map(|x| spot + 0.02 * x).collect()));
    clouds.push(("all at one position".into(), vec![spot; 130]));
    let mut lost = random(500);
    for (i, x) in lost.iter_mut().enumerate().step_by(3) {
        let away = [1e-6, 0.5, 30.0, 1e9, 1e30, f32::INFINITY, f32::NAN];
        x[i % 3] = (if i % 2 == 0 { max } else { -min })[i % 3] + away[i % 7];
        x[i % 3] *= if i % 2 == 0 { 1.0 } else { -1.0 };
    }
    clouds.push(("outside and non-finite".into(), lost));
    clouds.push(("all outside".into(), vec![Vec3::splat(7.0), Vec3::splat(-7.0), Vec3::NAN]));
    // Exactly one support radius apart along all axes: rounding must not put them two cells apart.
    let chain = (0..120).map(|i| {
        let step = Vec3::AXES[i % 3] * SUPPORT * (i / 3 % 7) as f32;
        min + Vec3::splat(0.013 * (i / 21) as f32) + step.min(max - min)
    });
    clouds.push(("one support apart".into(), chain.collect()));
    clouds
}

#[test]
fn both_sorting_methods_on_both_executors_agree_with_brute_force() {
    for (name, points) in clouds() {
        let sample = if points.len() > 5000 { 300 } else { points.len() };
        let mut reference: Option<Sorted> = None;
        for (device, mut executor) in testing::executors("neighbours") {
            for way in [Sort::Counting, Sort::Bitonic] {
                let sorted = sort(&mut executor, &points, way);
                if let Some(reference) = &reference {
                    assert!(&sorted == reference, "{name}, {device}, {way:?}: differs from the first method");
                } else {
                    check(&sorted, &points, sample).unwrap_or_else(|what| panic!("{name}: {what}"));
                    reference = Some(sorted);
                }
            }
        }
    }
}

#[test]
fn sorting_without_particles_succeeds() {
    for (device, mut executor) in testing::executors("sorting_without_particles_succeeds") {
        for way in [Sort::Counting, Sort::Bitonic] {
            let sorted = sort(&mut executor, &[], way);
            assert!(sorted.cell_start.iter().all(|&start| start == 0), "{device}, {way:?}");
            assert_eq!((sorted.ids.len(), sorted.active()), (0, 0));
        }
    }
}

/// Negative controls: the checks must detect each of these errors.
#[test]
fn incorrect_sorts_are_detected() {
    let points = random(4097);
    let sound = sort(&mut cpu(), &points, Sort::Counting);
    check(&sound, &points, 4097).unwrap();
    let crowded = sound.cell_start.windows(2).position(|bounds| bounds[1] - bounds[0] >= 2).unwrap();
    let k = sound.cell_start[crowded] as usize;
    let notice = |what: &str, change: fn(&mut Sorted, usize, usize)| {
        let mut wrong = sound.clone();
        change(&mut wrong, crowded, k);
        assert!(check(&wrong, &points, 4097).is_err(), "{what} is not detected");
    };
    notice("two particles of a cell in the wrong order", |s, _, k| {
        s.ids.swap(k, k + 1);
        s.positions.swap(k, k + 1);
        s.velocities.swap(k, k + 1);
    });
    notice("an id without its position", |s, _, k| s.ids.swap(k, k + 900));
    notice("a border moved by one", |s, cell, _| s.cell_start[cell + 1] -= 1);
    notice("a particle counted as escaped", |s, _, _| s.counters[StepCounters::ESCAPED] += 1);
    notice("a position changed in its last bit", |s, _, k| s.positions[k][1] ^= 1);
    // The traversal itself: without its last row it misses neighbours.
    let missed = (0..4097).any(|k| {
        let x = sound.position(k);
        let lower: HashSet<usize> = walk(&sound, k)
            .into_iter()
            .filter(|&j| grid().cell_of(sound.position(j)) <= grid().cell_of(x) + grid().size_x)
            .collect();
        lower != brute_force(&sound, k)
    });
    assert!(missed, "the last rows contain no neighbours in this cloud");
}

fn coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![
        8 => -0.3_f32..1.4,
        // On a lattice of half support radii, where cells, supports and faces meet.
        4 => (-6_i32..28).prop_map(|i| i as f32 * 0.05),
        1 => prop_oneof![Just(f32::NAN), Just(f32::INFINITY), Just(-1e30_f32), Just(f32::MIN_POSITIVE), Just(-0.0)],
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn neighbours_of_any_cloud_agree_with_brute_force(
        points in prop::collection::vec((coordinate(), coordinate(), coordinate()), 1..400),
        repeat in 1_usize..3,
    ) {
        let points: Vec<Vec3> = points.iter().map(|&(x, y, z)| Vec3::new(x, y, z)).collect::<Vec<_>>().repeat(repeat);
        let counting = sort(&mut cpu(), &points, Sort::Counting);
        prop_assert_eq!(check(&counting, &points, points.len()), Ok(()));
        prop_assert!(sort(&mut cpu(), &points, Sort::Bitonic) == counting);
    }
}
