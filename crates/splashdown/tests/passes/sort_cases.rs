//! The passes of the sort by cells: whole numbers, so all that they leave is compared to the last bit.

use glam::{UVec2, Vec4, Vec4Swizzles};
use splashdown::cells::Grid;
use splashdown::passes::{DEAD_ESCAPED, DEAD_NON_FINITE, Params, Tally};
use splashdown_gpu::{Grid as Extent, PassDesc};

use super::harness::{Case, Check, Compare, Data, exact};
use super::world::{World, params, points, state};

/// The pass of this label.
pub fn pass(label: &str) -> &'static PassDesc {
    let passes = splashdown::passes();
    passes.into_iter().find(|pass| pass.label == label).unwrap_or_else(|| panic!("there is no pass {label}"))
}

/// All outputs equal to the last bit.
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

fn case(
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
        extent: Extent::Items(items as u32),
        input,
        compare: exact_all(),
        oracle: expecting(expected),
        control,
    }
}

pub fn cases() -> Vec<Case> {
    let world = World::new(params(2.0), 1500);
    let n = world.len();
    let mut cases = vec![count()];
    for (name, run) in [("all", n), ("only some", n - 700), ("a frame that is complete", 0)] {
        cases.extend([keys(&world, name, run), scatter(&world, name, run), reorder(&world, name, run)]);
    }
    cases.extend([bounds(&world), order(&world)]);
    cases.retain(|case| case.name != "a frame that is complete" || can_notice(case));
    cases
}

/// A frame that is complete changes nothing, whatever the input; its case is about the poison that must stay.
fn can_notice(case: &Case) -> bool {
    case.pass.label == "cells.keys"
}

/// What the definition of cells says of a point, in f64.
fn cell(grid: &Grid, x: glam::Vec3) -> u32 {
    let at = (x.as_dvec3() - grid.origin.as_dvec3()) / f64::from(grid.cell_size);
    let index = |axis: usize, size: u32| (at[axis].floor().max(1.0) as u32).min(size - 2);
    let [i, j, k] = [index(0, grid.size_x), index(1, grid.size_y), index(2, grid.size_z)];
    (k * grid.size_y + j) * grid.size_x + i
}

fn count() -> Case {
    let params = params(2.0);
    let grid = Grid::new(params.domain_min, params.domain_max, params.support_radius).unwrap();
    let mut positions: Vec<Vec4> = points(&params, 1300).iter().map(|x| x.extend(0.0)).collect();
    let mut velocities = vec![Vec4::new(1.0, -2.0, 0.5, 1000.0); positions.len()];
    // Everything that can be wrong with a particle, in the middle of the others.
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
    let poisoned = Data::UVec2(vec![UVec2::ZERO; n]).poison();
    let zeros = |n: usize| Data::U32(vec![0; n]);
    let input = vec![
        Data::Params(params),
        Data::Grid(grid),
        Data::State(state(n)),
        Data::Vec4(positions.clone()),
        Data::Vec4(velocities.clone()),
        poisoned,
        zeros(grid.cell_count as usize + 1),
        zeros(Tally::WORDS),
    ];
    let expected = judge(&params, &grid, &positions, &velocities);
    // Ranks follow the order of arrival, which is nobody's business: they must only be different and without gaps.
    let same = |a: &[Data], b: &[Data]| {
        let (Data::UVec2(ranks), Data::UVec2(other)) = (&a[1], &b[1]) else { panic!("no ranks") };
        let cells = |ranks: &[UVec2]| ranks.iter().map(|c| c.x).collect::<Vec<_>>();
        exact("cells", &cells(ranks), &cells(other))?;
        let sorted = |ranks: &[UVec2]| {
            let mut all: Vec<[u32; 2]> = ranks.iter().map(|c| c.to_array()).collect();
            all.sort_unstable();
            all.concat()
        };
        exact("ranks", &sorted(ranks), &sorted(other))?;
        for k in [0, 2, 3] {
            exact(&format!("output {k}"), a[k].words(), b[k].words())?;
        }
        Ok(())
    };
    Case {
        pass: pass("cells.count"),
        name: "with every kind of wrong particle".into(),
        extent: Extent::Items(n as u32),
        input,
        compare: Box::new(same),
        oracle: Box::new(move |out| same(out, &expected)),
        // One particle moves to the next cell.
        control: |input| {
            let Data::Vec4(positions) = &mut input[3] else { panic!("no positions") };
            positions[20].y =
                if positions[20].y > 0.25 { positions[20].y - 0.11 } else { positions[20].y + 0.11 };
        },
    }
}

/// Positions, cells with ranks in order of number, counts and tally, particle by particle.
fn judge(params: &Params, grid: &Grid, positions: &[Vec4], velocities: &[Vec4]) -> Vec<Data> {
    let mut positions = positions.to_vec();
    let mut counts = vec![0; grid.cell_count as usize + 1];
    let mut tally = vec![0; Tally::WORDS];
    let mut ranks = Vec::new();
    for (p, v) in positions.iter_mut().zip(velocities) {
        let x = p.xyz();
        let v = v.to_array().map(f64::from);
        // The square of a speed must have a value in f32.
        let speed = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
        let moderate = speed <= f64::from(f32::MAX) && v[3].is_finite();
        let within = |a: usize| x[a] >= params.domain_min[a] && x[a] <= params.domain_max[a];
        let mut at = grid.cell_count;
        if p.w == 0.0 {
            if !x.is_finite() {
                *p = params.domain_min.extend(DEAD_NON_FINITE);
                tally[Tally::NON_FINITE] += 1;
            } else if !moderate {
                p.w = DEAD_NON_FINITE;
                tally[Tally::NON_FINITE] += 1;
            } else if !(0..3).all(within) {
                p.w = DEAD_ESCAPED;
                tally[Tally::ESCAPED] += 1;
            } else {
                at = cell(grid, x);
            }
        }
        ranks.push(UVec2::new(at, counts[at as usize]));
        counts[at as usize] += 1;
    }
    vec![Data::Vec4(positions), Data::UVec2(ranks), Data::U32(counts), Data::U32(tally)]
}

/// The first `run` entries of `all`, and poison behind.
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
    let cell_rank = world.shuffled().cell_rank;
    let pairs = cell_rank.iter().enumerate().map(|(i, c)| UVec2::new(c.x, i as u32));
    let pairs = Data::UVec2(pairs.collect());
    let input = vec![Data::State(state(run)), Data::UVec2(cell_rank), pairs.poison()];
    let control: fn(&mut [Data]) = |input| {
        let Data::UVec2(cell_rank) = &mut input[1] else { panic!("no cells") };
        cell_rank[0].x ^= 1;
        // In a frame that is complete nothing may be written at all: what must be noticed there is one entry more.
        let Data::State(state) = &mut input[0] else { panic!("no state") };
        state.run_count = state.run_count.max(1);
    };
    case("cells.keys", name, world.len(), input, vec![only(&pairs, run)], control)
}

fn scatter(world: &World, name: &str, run: usize) -> Case {
    let cell_rank = world.shuffled().cell_rank;
    let mut slots = vec![u32::MAX; world.len()];
    for (i, c) in cell_rank.iter().enumerate().take(run) {
        slots[(world.cell_start[c.x as usize] + c.y) as usize] = i as u32;
    }
    let slots = Data::U32(slots);
    let input = vec![
        Data::State(state(run)),
        Data::UVec2(cell_rank),
        Data::U32(world.cell_start.clone()),
        slots.poison(),
    ];
    case("cells.scatter", name, world.len(), input, vec![slots], |input| {
        let Data::UVec2(cell_rank) = &mut input[1] else { panic!("no cells") };
        cell_rank.swap(3, 4);
    })
}

fn reorder(world: &World, name: &str, run: usize) -> Case {
    let shuffled = world.shuffled();
    let sorted = [
        Data::Vec4(world.positions.clone()),
        Data::Vec4(world.velocities.clone()),
        Data::U32(world.ids.clone()),
    ];
    let mut input = vec![
        Data::State(state(run)),
        Data::U32(places(&shuffled.order)),
        Data::Vec4(shuffled.of(&world.positions)),
        Data::Vec4(shuffled.of(&world.velocities)),
        Data::U32(shuffled.of(&world.ids)),
    ];
    input.extend(sorted.iter().map(Data::poison));
    let expected = sorted.iter().map(|all| only(all, run)).collect();
    case("cells.reorder", name, world.len(), input, expected, |input| {
        let Data::U32(order) = &mut input[1] else { panic!("no order") };
        order.swap(5, 6);
    })
}

/// Where each sorted particle stands among the unsorted.
fn places(order: &[u32]) -> Vec<u32> {
    let mut places = vec![0; order.len()];
    for (i, &k) in order.iter().enumerate() {
        places[k as usize] = i as u32;
    }
    places
}

fn bounds(world: &World) -> Case {
    let shuffled = world.shuffled();
    let slots = places(&shuffled.order);
    let pairs = slots.iter().map(|&i| UVec2::new(shuffled.cell_rank[i as usize].x, i)).collect();
    let (starts, slots) = (Data::U32(world.cell_start.clone()), Data::U32(slots));
    let input = vec![
        Data::Grid(world.grid),
        Data::State(state(world.len())),
        Data::UVec2(pairs),
        starts.poison(),
        slots.poison(),
    ];
    case("cells.bounds", "all", world.len() + 1, input, vec![starts, slots], |input| {
        let Data::UVec2(pairs) = &mut input[2] else { panic!("no pairs") };
        let k = pairs.windows(2).position(|pair| pair[0].x < pair[1].x).unwrap();
        pairs[k].x += 1;
    })
}

fn order(world: &World) -> Case {
    let shuffled = world.shuffled();
    // Slots in the order of arrival, which is not that of ids.
    let mut slots = vec![0; world.len()];
    for (i, c) in shuffled.cell_rank.iter().enumerate() {
        slots[(world.cell_start[c.x as usize] + c.y) as usize] = i as u32;
    }
    let ordered = Data::U32(places(&shuffled.order));
    let input = vec![
        Data::State(state(world.len())),
        Data::UVec2(shuffled.cell_rank.clone()),
        Data::U32(world.cell_start.clone()),
        Data::U32(slots),
        Data::U32(shuffled.of(&world.ids)),
        ordered.poison(),
    ];
    case("cells.order", "all", world.len(), input, vec![ordered], |input| {
        let Data::UVec2(cell_rank) = &input[1] else { panic!("no cells") };
        let (mut a, mut b) = (0, 1);
        'found: for i in 0..cell_rank.len() {
            for j in i + 1..cell_rank.len() {
                if cell_rank[i].x == cell_rank[j].x {
                    (a, b) = (i, j);
                    break 'found;
                }
            }
        }
        let Data::U32(ids) = &mut input[4] else { panic!("no ids") };
        ids.swap(a, b);
    })
}
