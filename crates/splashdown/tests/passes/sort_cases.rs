//! The passes of the sort by cells. They work with integers, so all outputs are compared exactly.

use glam::{UVec2, Vec4, Vec4Swizzles};
use splashdown::cells::Grid;
use splashdown::state::{DEAD_ESCAPED, DEAD_NON_FINITE, Params, StepCounters, StepState};
use splashdown_gpu::{DispatchSize, PassDesc};

use super::cases::{next_state, same_state, state_of};
use super::harness::{Case, Check, Compare, Data, exact};
use super::world::{Shuffled, World, params, points, state};

/// The pass with this label.
pub fn pass(label: &str) -> &'static PassDesc {
    let passes = splashdown::passes();
    passes
        .into_iter()
        .find(|pass| pass.label == label)
        .unwrap_or_else(|| panic!("no pass has the label {label}"))
}

/// All outputs are bit-identical.
fn exact_all() -> Compare {
    Box::new(|a, b| {
        a.iter()
            .zip(b)
            .enumerate()
            .try_for_each(|(k, (a, b))| exact(&format!("output {k}"), a.words(), b.words()))
    })
}

fn expecting(expected: Vec<Data>) -> Check {
    Box::new(move |out| exact_all()(out, &expected))
}

pub fn case(
    label: &str,
    name: &str,
    items: usize,
    input: Vec<Data>,
    expected: Vec<Data>,
    control: fn(&mut [Data]),
) -> Case {
    Case {
        pass: pass(label),
        name: name.into(),
        size: DispatchSize::Items(items as u32),
        input,
        compare: exact_all(),
        oracle: expecting(expected),
        control,
    }
}

pub fn cases() -> Vec<Case> {
    let world = World::new(params(2.0), 1500);
    let n = world.len();
    let mut cases = vec![
        count("with every kind of wrong particle", 0.01, 0),
        count("after a step", 0.01, 1),
        count("after the last step", 4e-4, 1),
    ];
    for (name, run) in [("all", n), ("some", n - 700), ("a complete frame", 0)] {
        cases.push(keys(&world, name, run));
    }
    cases.extend([scatter(&world, "all", 0), scatter(&world, "after a step", 1)]);
    cases.extend([reorder(&world), bounds(&world)]);
    cases
}

/// The cell of a point by definition, in f64.
pub fn cell(grid: &Grid, x: glam::Vec3) -> u32 {
    let at = (x.as_dvec3() - grid.origin.as_dvec3()) * grid.cells_per_metre.as_dvec3();
    let ghosts = [grid.slices, 1, 1];
    let index = |axis: usize, size: u32| {
        (at[axis].floor().max(f64::from(ghosts[axis])) as u32).min(size - ghosts[axis] - 1)
    };
    let [i, j, k] = [index(0, grid.size_x), index(1, grid.size_y), index(2, grid.size_z)];
    (k * grid.size_y + j) * grid.size_x + i
}

fn count(name: &str, remaining: f32, moved: u32) -> Case {
    let params = params(2.0);
    let grid = Grid::new(params.domain_min, params.domain_max, params.support_radius)
        .and_then(|grid| grid.with_slices(4))
        .unwrap();
    let mut positions: Vec<Vec4> = points(&params, 1300).iter().map(|x| x.extend(0.0)).collect();
    let mut velocities = vec![Vec4::new(1.0, -2.0, 0.5, 1000.0); positions.len()];
    // Particles with every kind of error, among the others.
    let (inf, nan) = (f32::INFINITY, f32::NAN);
    for (i, wrong) in [nan, inf, -inf, 1e30, -1e30, 3.4e38, 0.71, -0.31].into_iter().enumerate() {
        for axis in 0..3 {
            positions[100 + 10 * i + axis][axis] = wrong;
        }
    }
    for (i, wrong) in [nan, inf, -inf, 1e30, -2e19].into_iter().enumerate() {
        velocities[300 + 5 * i][i % 3] = wrong;
    }
    (velocities[340].w, velocities[341].w) = (nan, inf);
    for i in [400, 401, 402] {
        positions[i] = Vec4::new(nan, 0.2, 0.3, if i == 401 { DEAD_ESCAPED } else { DEAD_NON_FINITE });
    }
    let n = positions.len();
    let state = StepState { remaining, ..state(n) };
    let cell_counts = zero_cell_counts(&grid, n);
    let mut counters = vec![0; StepCounters::WORDS];
    counters[StepCounters::MOVED] = moved;
    let input = vec![
        Data::Params(params),
        Data::Grid(grid),
        Data::State(state),
        Data::Vec4(positions.clone()),
        Data::Vec4(velocities.clone()),
        Data::U32(cell_counts.clone()),
        Data::U32(counters.clone()),
    ];
    let mut expected = judge(&params, &grid, &positions, &velocities, counters);
    // After the last step of a frame nothing is counted.
    let is_count_unused = moved == 1 && state.is_last_step();
    if is_count_unused {
        expected[1] = Data::U32(cell_counts);
    }
    Case {
        pass: pass("cells.count"),
        name: name.into(),
        size: DispatchSize::Items(n as u32),
        input,
        compare: exact_all(),
        oracle: expecting(expected),
        // One particle moves to the next cell.
        control: |input| {
            let Data::Vec4(positions) = &mut input[3] else { panic!("no positions") };
            positions[20].y =
                if positions[20].y > 0.25 { positions[20].y - 0.11 } else { positions[20].y + 0.11 };
        },
    }
}

/// Cell counts of zero, with poisoned particle cells.
pub fn zero_cell_counts(grid: &Grid, particles: usize) -> Vec<u32> {
    let mut cell_counts = vec![0; grid.cell_count as usize + 1];
    cell_counts.extend(vec![u32::MAX; particles]);
    cell_counts
}

/// Positions, cell counts and counters, for each particle.
fn judge(
    params: &Params,
    grid: &Grid,
    positions: &[Vec4],
    velocities: &[Vec4],
    mut counters: Vec<u32>,
) -> Vec<Data> {
    let mut positions = positions.to_vec();
    let mut counts = vec![0; grid.cell_count as usize + 1];
    let mut cells = Vec::new();
    for (p, v) in positions.iter_mut().zip(velocities) {
        let x = p.xyz();
        let v = v.to_array().map(f64::from);
        // The square of a speed must be finite in f32.
        let speed = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
        let moderate = speed <= f64::from(f32::MAX) && v[3].is_finite();
        let within = |a: usize| x[a] >= params.domain_min[a] && x[a] <= params.domain_max[a];
        let mut at = grid.cell_count;
        if p.w == 0.0 {
            if !x.is_finite() {
                *p = params.domain_min.extend(DEAD_NON_FINITE);
                counters[StepCounters::NON_FINITE] += 1;
            } else if !moderate {
                p.w = DEAD_NON_FINITE;
                counters[StepCounters::NON_FINITE] += 1;
            } else if !(0..3).all(within) {
                p.w = DEAD_ESCAPED;
                counters[StepCounters::ESCAPED] += 1;
            } else {
                at = cell(grid, x);
            }
        }
        cells.push(at);
        counts[at as usize] += 1;
    }
    counts.extend(cells);
    vec![Data::Vec4(positions), Data::U32(counts), Data::U32(counters)]
}

/// The first `run` entries of `all`, followed by poison.
fn only(all: &Data, run: usize) -> Data {
    let words = all.words().len();
    let mut some = all.clone();
    let n = match all {
        Data::Vec4(v) => v.len(),
        Data::UVec2(v) => v.len(),
        _ => words,
    };
    some.words_mut()[run * (words / n)..].fill(u32::MAX);
    some
}

fn keys(world: &World, name: &str, run: usize) -> Case {
    let (cell_counts, cells) = world.shuffled().cell_counts(world);
    let pairs = cells.iter().enumerate().map(|(i, &cell)| UVec2::new(cell, i as u32));
    let pairs = Data::UVec2(pairs.collect());
    let input = vec![Data::Grid(world.grid), Data::State(state(run)), Data::U32(cell_counts), pairs.poison()];
    let control: fn(&mut [Data]) = |input| {
        let Data::Grid(grid) = &input[0] else { panic!("no grid") };
        let first = grid.cell_count as usize + 1;
        let Data::U32(cell_counts) = &mut input[2] else { panic!("no cell_counts") };
        cell_counts[first] ^= 1;
        // In a complete frame nothing may be written, so the control adds one entry.
        let Data::State(state) = &mut input[1] else { panic!("no state") };
        state.run_count = state.run_count.max(1);
    };
    case("cells.keys", name, world.len(), input, vec![only(&pairs, run)], control)
}

fn scatter(world: &World, name: &str, moved: u32) -> Case {
    let shuffled = world.shuffled();
    let (cell_counts, cells) = shuffled.cell_counts(world);
    let params = Params { particle_count: world.len() as u32, ..world.params };
    let (before, ids) = (state(world.len()), shuffled.of(&world.ids));
    let mut counters = vec![0; StepCounters::WORDS];
    counters[StepCounters::MOVED] = moved;
    let mut after = before;
    if moved == 1 {
        let maxima = [0.5, 10.0, 0.002, 0.0];
        for (k, value) in maxima[..3].iter().enumerate() {
            counters[StepCounters::MAX_SPEED + k] = f32::to_bits(*value);
        }
        after = next_state(&params, &before, maxima.map(f64::from));
    }
    let slots = Data::UVec2(vec![UVec2::ZERO; world.len()]);
    let input = vec![
        Data::Params(params),
        Data::Grid(world.grid),
        Data::State(before),
        Data::U32(counters),
        Data::U32(cell_counts),
        Data::U32(world.cell_start.clone()),
        Data::U32(ids.clone()),
        slots.poison(),
    ];
    // All particles have been subtracted from the cell counts; their cells are still stored.
    let mut taken = vec![0; world.grid.cell_count as usize + 1];
    taken.extend(&cells);
    // The order of arrival is irrelevant: each cell's entries contain its particles.
    let starts = world.cell_start.clone();
    let mut expected: Vec<[u32; 3]> =
        cells.iter().zip(&ids).enumerate().map(|(i, (&cell, &id))| [cell, id, i as u32]).collect();
    expected.sort_unstable();
    let oracle: Check = Box::new(move |out| {
        same_state(&state_of(&out[0]), &after)?;
        exact("counters", out[1].words(), &[0; StepCounters::WORDS])?;
        exact("cell_counts", out[2].words(), &taken)?;
        exact("entries", &in_cells(&starts, &out[3]), &expected.concat())
    });
    let starts = world.cell_start.clone();
    Case {
        pass: pass("cells.scatter"),
        name: name.into(),
        size: DispatchSize::Items(world.len() as u32),
        input,
        compare: Box::new(move |a, b| {
            same_state(&state_of(&a[0]), &state_of(&b[0]))?;
            exact_all()(&a[1..3], &b[1..3])?;
            exact("entries", &in_cells(&starts, &a[3]), &in_cells(&starts, &b[3]))
        }),
        oracle,
        control: |input| {
            let Data::U32(ids) = &mut input[6] else { panic!("no ids") };
            ids.swap(3, 4);
        },
    }
}

/// Cell, id and index of every entry, in order.
fn in_cells(starts: &[u32], slots: &Data) -> Vec<u32> {
    let Data::UVec2(slots) = slots else { panic!("no entries") };
    let cell = |k: usize| starts.partition_point(|&start| start as usize <= k) as u32 - 1;
    let mut all: Vec<[u32; 3]> =
        slots.iter().enumerate().map(|(k, entry)| [cell(k), entry.x, entry.y]).collect();
    all.sort_unstable();
    all.concat()
}

/// The unsorted index of each sorted particle.
fn places(order: &[u32]) -> Vec<u32> {
    let mut places = vec![0; order.len()];
    for (i, &k) in order.iter().enumerate() {
        places[k as usize] = i as u32;
    }
    places
}

fn bounds(world: &World) -> Case {
    let shuffled = world.shuffled();
    let (_, cells) = shuffled.cell_counts(world);
    let ids = shuffled.of(&world.ids);
    let order = places(&shuffled.order);
    let pairs = order.iter().map(|&i| UVec2::new(cells[i as usize], i)).collect();
    let slots = order.iter().map(|&i| UVec2::new(ids[i as usize], i)).collect();
    let (starts, slots) = (Data::U32(world.cell_start.clone()), Data::UVec2(slots));
    let input = vec![
        Data::Grid(world.grid),
        Data::State(state(world.len())),
        Data::UVec2(pairs),
        Data::U32(ids),
        starts.poison(),
        slots.poison(),
    ];
    case("cells.bounds", "all", world.len() + 1, input, vec![starts, slots], |input| {
        let Data::UVec2(pairs) = &mut input[2] else { panic!("no pairs") };
        let k = pairs.windows(2).position(|pair| pair[0].x < pair[1].x).unwrap();
        pairs[k].x += 1;
    })
}

/// Grid, counts, starts and entries of shuffled particles, the first inputs of the passes that reorder. The entries of a
/// cell are in the order of arrival, which is not that of ids.
pub fn before_reordering(world: &World, shuffled: &Shuffled) -> Vec<Data> {
    let (cell_counts, cells) = shuffled.cell_counts(world);
    let ids = shuffled.of(&world.ids);
    let mut entries = vec![UVec2::ZERO; world.len()];
    let mut next = world.cell_start.clone();
    for (i, &cell) in cells.iter().enumerate() {
        let entry = &mut next[cell as usize];
        entries[*entry as usize] = UVec2::new(ids[i], i as u32);
        *entry += 1;
    }
    vec![
        Data::Grid(world.grid),
        Data::U32(cell_counts),
        Data::U32(world.cell_start.clone()),
        Data::UVec2(entries),
    ]
}

/// Swaps the ids of two entries of one cell.
pub fn swap_ids(input: &mut [Data]) {
    let Data::U32(starts) = &input[2] else { panic!("no starts") };
    let crowded = starts.windows(2).position(|bounds| bounds[1] - bounds[0] >= 2).unwrap();
    let k = starts[crowded] as usize;
    let Data::UVec2(entries) = &mut input[3] else { panic!("no entries") };
    (entries[k].x, entries[k + 1].x) = (entries[k + 1].x, entries[k].x);
}

fn reorder(world: &World) -> Case {
    let shuffled = world.shuffled();
    let sorted = [
        Data::Vec4(world.positions.clone()),
        Data::Vec4(world.velocities.clone()),
        Data::U32(world.ids.clone()),
    ];
    let mut input = before_reordering(world, &shuffled);
    input.extend([Data::Vec4(shuffled.of(&world.positions)), Data::Vec4(shuffled.of(&world.velocities))]);
    input.extend(sorted.iter().map(Data::poison));
    case("cells.reorder", "all", world.len(), input, sorted.to_vec(), swap_ids)
}
