//! Updates that are due, and the number and positions of new particles.

use std::f64::consts::TAU;

use glam::{DVec3, Vec4};
use splashdown::foam::{FoamParams, FoamState};
use splashdown::state::Params;
use splashdown_gpu::DispatchSize;

use super::super::harness::{Case, Data, exact};
use super::super::sort_cases::pass;
use super::super::world::{SPACING, World, params, state};
use super::pool::{alike, around, diffuse, kind, numbers, words};
use super::{foam, now, place, seed, speed, unit};

pub(super) fn begin(
    name: &'static str,
    change: fn(&mut splashdown::state::StepState, &mut FoamState),
) -> Case {
    let mut step = state(1500);
    step.time = 0.7125;
    let mut foam_state = FoamState { count: 70_000 * 64, ..now() };
    change(&mut step, &mut foam_state);
    let is_due = ["in a frame", "at a frame's end"].contains(&name);
    let mut expected = FoamState { dt: 0.0, is_due: 0, ..foam_state };
    let mut groups = [0, 1, 1];
    if is_due {
        let dt = step.time - 0.7;
        expected = FoamState { dt, is_due: 1, step: 18, time: step.time, ..foam_state };
        groups = [35_000, 2, 1];
    } else if name == "for the first time" {
        expected = FoamState { has_begun: 1, time: step.time, ..expected };
    }
    let same = |a: &[Data], b: &[Data]| {
        exact("state", a[0].words(), b[0].words())?;
        exact("groups", a[1].words(), b[1].words())
    };
    Case {
        pass: pass("foam.begin"),
        name: name.into(),
        size: DispatchSize::Groups(1),
        input: vec![
            Data::Foam(foam()),
            Data::State(step),
            Data::FoamState(foam_state),
            Data::U32(vec![7; 3]),
        ],
        compare: Box::new(same),
        oracle: Box::new(move |out| same(out, &[Data::FoamState(expected), Data::U32(groups.to_vec())])),
        control: |input| {
            let Data::State(state) = &mut input[1] else { panic!("no state") };
            (state.run_count, state.frame_duration) = (1, 0.0);
            state.time += 1e-6;
            let Data::FoamState(state) = &mut input[2] else { panic!("no state") };
            state.count += 64;
        },
    }
}

/// The number of accepted candidates before candidate m.
fn place_of(m: u32, share: u32) -> u32 {
    (u64::from(m >> (share >> 16)) * u64::from(share & 0xffff) / 4096) as u32
}

/// 500 particles remain; there are `wanted` candidates.
pub(super) fn plan(name: &'static str, capacity: u32, wanted: u32) -> Case {
    let kept = 500;
    let room = capacity - kept;
    let mut share = 4096;
    if wanted > room {
        // Halved while there are more than 2^20, because the shader has 32-bit arithmetic.
        let halvings = room.max(1).ilog2().saturating_sub(19);
        let all = (0..halvings).fold(wanted, |all, _| all.div_ceil(2));
        share = (u64::from(room >> halvings) * 4096 / u64::from(all)) as u32;
        // While the fraction is zero, twice as many candidates share a slot.
        let halved = |times: u32| (0..times).fold(all, |all, _| all.div_ceil(2));
        if share == 0 && room > 0 {
            let several = (0..32).find(|&times| halved(times) < 4096 * room).unwrap_or(0);
            share = 4096 * room / halved(several) + (several << 16);
        }
    }
    let born = place_of(wanted, share);
    let before = FoamState { count: 640, next_id: 9000, refused: 11, wanted: 3, ..now() };
    let expected = FoamState {
        kept,
        wanted,
        share,
        born,
        count: kept + born,
        refused: 11 + wanted - born,
        next_id: 9000 + born,
        ..before
    };
    let chances = wanted >> (share >> 16);
    assert!(born <= room && born + 1 + chances / 4096 >= wanted.min(room).min(chances), "{born} of {room}");
    Case {
        pass: pass("foam.plan"),
        name: name.into(),
        size: DispatchSize::Groups(1),
        input: vec![
            Data::Params(Params { particle_count: 3, ..params(2.0) }),
            Data::Foam(FoamParams { capacity, ..foam() }),
            // Elements after the last are ignored.
            Data::U32(vec![0, 10, 20, wanted, 7, 7, 7]),
            Data::U32(vec![8, 1, 1, kept]),
            Data::FoamState(before),
        ],
        compare: Box::new(|a, b| exact("state", a[0].words(), b[0].words())),
        oracle: Box::new(move |out| exact("state", out[0].words(), Data::FoamState(expected).words())),
        control: |input| {
            let Data::U32(counted) = &mut input[3] else { panic!("no count") };
            counted[3] -= 1;
        },
    }
}

pub(super) fn emit(name: &'static str, share: u32) -> Case {
    let world = World::new(params(2.0), 1500);
    let active = world.active();
    // One fluid particle moves vertically, where the default perpendicular direction is degenerate.
    let mut world = world;
    world.velocities[7] = Vec4::new(0.0, 1.5, 0.0, 1000.0);
    let counts: Vec<u32> = (0..active).map(|i| if i % 4 == 0 { 3 } else { u32::from(i % 7 == 0) }).collect();
    let mut starts = vec![0; world.len() + 1];
    for i in 0..world.len() {
        starts[i + 1] = starts[i] + counts.get(i).copied().unwrap_or(0);
    }
    let wanted = starts[world.len()];
    let place_of = |m: u32| place_of(m, share);
    let (kept, born) = (40, place_of(wanted));
    let now = FoamState { kept, born, share, wanted, count: kept + born, next_id: 5000 + born, ..now() };
    let foam = foam();
    let pool = diffuse(&world, kept + born + 20);
    let mut expected = numbers(&words(&pool));
    let mut edge = vec![false; pool.len()];
    let radius = f64::from(SPACING);
    for i in 0..active {
        for turn in 0..counts[i] {
            let m = starts[i] + turn;
            if place_of(m) == place_of(m + 1) {
                continue;
            }
            let v = speed(&world, i);
            let along = v.normalize_or_zero();
            let aside = if along.y.abs() > 0.9 { DVec3::X } else { DVec3::Y };
            let e1 = along.cross(aside).normalize_or_zero();
            let e2 = along.cross(e1);
            let random = |k: u32| unit(seed(world.ids[i], now.step).wrapping_add(4 * turn + k));
            let angle = TAU * random(2);
            let across = random(1).sqrt() * (angle.cos() * e1 + angle.sin() * e2);
            let x = place(&world, i) + radius * across + (random(3) - 0.5) * f64::from(now.dt) * v;
            let x = x.clamp(world.params.domain_min.as_dvec3(), world.params.domain_max.as_dvec3());
            let u = v + 0.1 * v.length() * across;
            let lifetime = f64::from(foam.lifetime_least) + f64::from(foam.lifetime_range) * random(4);
            let (_, neighbours, _) = around(&world, x);
            let doubtful = [-1.0, 1.0].iter().any(|step| {
                let aside = x + 1e-5 * step * DVec3::ONE;
                kind(around(&world, aside).1, 0) != kind(neighbours, 0)
            });
            let slot = (kept + place_of(m)) as usize;
            let tag = f64::from((5000 + place_of(m)) << 2 | kind(neighbours, 0));
            expected[8 * slot..8 * slot + 8].copy_from_slice(&[x.x, x.y, x.z, lifetime, u.x, u.y, u.z, tag]);
            edge[slot] = doubtful;
        }
    }
    assert!(born > 300 >> (share >> 16), "{born}");
    let same = move |a: &[f32], b: &[f64]| alike(a, b, &edge);
    let again = same.clone();
    Case {
        pass: pass("foam.emit"),
        name: name.into(),
        size: DispatchSize::Items(world.len() as u32),
        input: vec![
            Data::Params(world.params),
            Data::Grid(world.grid),
            Data::Foam(foam),
            Data::FoamState(now),
            Data::U32(world.cell_start.clone()),
            Data::U32(starts),
            Data::Vec4(world.positions.clone()),
            Data::Vec4(world.velocities.clone()),
            Data::U32(world.ids.clone()),
            Data::Diffuse(pool),
        ],
        compare: Box::new(move |a, b| same(a[0].floats(), &numbers(b[0].floats()))),
        oracle: Box::new(move |out| again(out[0].floats(), &expected)),
        control: |input| {
            let Data::FoamState(state) = &mut input[3] else { panic!("no state") };
            state.step += 1;
        },
    }
}
