//! Foam, spray and bubbles.

use std::f64::consts::{PI, TAU};

use glam::{DVec3, Vec3, Vec4, Vec4Swizzles};
use splashdown::foam::{Diffuse, FoamParams, FoamState};
use splashdown::passes::Params;
use splashdown_gpu::{Grid as Extent, bytemuck, testing};

use super::harness::{Case, Data, close, exact, wide};
use super::oracle::Kernel;
use super::sort_cases::pass;
use super::world::{SPACING, World, params, state};

const W: Kernel = Kernel::WendlandC2;

pub fn cases() -> Vec<Case> {
    let mut cases = vec![
        begin("in a frame", |_, _| {}),
        begin("too early", |state, _| state.time = 0.701),
        begin("at a frame's end", |state, _| {
            (state.time, state.frame_duration) = (0.701, 0.0);
        }),
        begin("without an order", |state, _| state.run_count = 0),
        begin("for the first time", |_, foam| foam.has_begun = 0),
        begin("without time passed", |state, _| (state.time, state.frame_duration) = (0.7, 0.0)),
        normals(),
        potentials(),
        count(),
        advect(),
        plan("with room", 5000, 300),
        plan("with little room", 1000, 300),
        plan("full", 600, 300),
        plan("beyond what counts in 20 bits", 3_000_000, 3_999_999),
        settle(),
        emit("all of them", 4096),
        emit("a part of them", 1700),
    ];
    let idle: Vec<Case> = cases.iter().filter_map(when_not_due).collect();
    cases.extend(idle);
    cases
}

fn foam() -> FoamParams {
    FoamParams {
        capacity: 5000,
        interval: 0.004,
        trapped_air: 900.0,
        wave_crest: 2000.0,
        trapped_air_least: 0.1,
        trapped_air_scale: 0.7,
        wave_crest_least: 0.05,
        wave_crest_scale: 3.0,
        energy_least: 0.15,
        energy_scale: 2.0,
        lifetime_least: 1.5,
        lifetime_range: 2.0,
        buoyancy: 2.0,
        drag: 80.0,
        spray_below: 12.5,
        bubble_above: 18.5,
        bubble_again_above: 21.5,
    }
}

fn now() -> FoamState {
    FoamState { time: 0.7, dt: 0.011, is_due: 1, has_begun: 1, step: 17, ..bytemuck::Zeroable::zeroed() }
}

fn unit(i: u32) -> f64 {
    f64::from(testing::noise(i) >> 8) / f64::from(1 << 24)
}

fn seed(id: u32, step: u32) -> u32 {
    testing::noise(id ^ testing::noise(step))
}

/// The same pass in an update that is not due: nothing changes.
fn when_not_due(case: &Case) -> Option<Case> {
    let due = |data: &Data| matches!(data, Data::FoamState(state) if state.is_due == 1);
    // The one that decides it is no case of this.
    let at = case.input.iter().position(due).filter(|_| case.pass.label != "foam.begin")?;
    let plans = case.pass.label == "foam.plan";
    let mut input = case.input.clone();
    let Data::FoamState(state) = &mut input[at] else { unreachable!() };
    state.is_due = 0;
    // A plan says that nobody was born.
    state.born = if plans { 0 } else { state.born };
    let written = |k: &usize| case.pass.bindings[*k].access == splashdown_gpu::Access::ReadWrite;
    let before: Vec<Data> = (0..input.len()).filter(written).map(|k| input[k].clone()).collect();
    let same = |a: &[Data], b: &[Data]| {
        a.iter().zip(b).try_for_each(|(a, b)| exact("what was there", a.words(), b.words()))
    };
    Some(Case {
        pass: case.pass,
        name: format!("{}, not due", case.name),
        extent: case.extent,
        input,
        compare: Box::new(same),
        oracle: Box::new(move |out| same(out, &before)),
        control: |input| {
            for data in input {
                if let Data::FoamState(state) = data {
                    state.is_due = 1;
                }
            }
        },
    })
}

fn begin(name: &'static str, change: fn(&mut splashdown::passes::StepState, &mut FoamState)) -> Case {
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
        extent: Extent::Groups(1),
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

fn place(world: &World, i: usize) -> DVec3 {
    world.positions[i].xyz().as_dvec3()
}

fn speed(world: &World, i: usize) -> DVec3 {
    world.velocities[i].xyz().as_dvec3()
}

fn volume() -> f64 {
    f64::from(SPACING).powi(3)
}

/// All living particles within the support of `x` but those in the very place: what is further is the distance.
fn near(world: &World, x: DVec3, mut visit: impl FnMut(usize, DVec3, f64)) {
    let support = f64::from(world.params.support_radius);
    for j in 0..world.living() {
        let d = x - place(world, j);
        if d.length() < support {
            visit(j, d, d.length());
        }
    }
}

/// Floats where they say the same, except where what they depend on is on an edge.
fn masked(what: &str, a: &[f32], b: &[f64], tolerance: &[f64], edge: &[bool]) -> Result<(), String> {
    let per = a.len() / edge.len();
    let keep: Vec<usize> = (0..a.len()).filter(|k| !edge[k / per]).collect();
    assert!(keep.len() * 50 > a.len() * 49, "{what}: too many are on an edge");
    let pick = |values: &[f64]| keep.iter().map(|&k| values[k]).collect::<Vec<_>>();
    let a: Vec<f32> = keep.iter().map(|&k| a[k]).collect();
    close(what, &a, &pick(b), &pick(tolerance))
}

fn normals() -> Case {
    let world = World::new(params(2.0), 1500);
    let support = f64::from(world.params.support_radius);
    let mut expected = vec![f64::NAN; 4 * world.len()];
    let mut edge = vec![false; world.len()];
    let mut count = 0;
    for i in 0..world.living() {
        let x = place(&world, i);
        let mut n = DVec3::ZERO;
        near(&world, x, |_, d, r| {
            if r > 0.0 {
                let q = r / support;
                let slope = -210.0 / PI * q * (1.0 - q).powi(3) / support.powi(4);
                n -= support * volume() * slope * d / r;
            }
        });
        for axis in 0..3 {
            let below = x[axis] - f64::from(world.params.domain_min[axis]);
            let above = f64::from(world.params.domain_max[axis]) - x[axis];
            edge[i] |= [below, above].iter().any(|gap| (gap - support).abs() < 1e-6);
            if below < support {
                n[axis] = n[axis].max(0.0);
            }
            if above < support {
                n[axis] = n[axis].min(0.0);
            }
        }
        edge[i] |= (n.length() - 0.5).abs() < 1e-4;
        let on_surface = n.length() >= 0.5;
        let n = if on_surface { n.normalize_or_zero() } else { DVec3::ZERO };
        count += usize::from(on_surface);
        expected[4 * i..4 * i + 4].copy_from_slice(&[n.x, n.y, n.z, f64::from(u8::from(on_surface))]);
    }
    assert!(count > 200 && count + 200 < world.living(), "{count} on the surface");
    let tolerance = vec![2e-5; expected.len()];
    let same = move |a: &[f32], b: &[f64]| masked("normals", a, b, &tolerance, &edge);
    let again = same.clone();
    Case {
        pass: pass("foam.normals"),
        name: "a cloud in a box".into(),
        extent: Extent::Items(world.len() as u32),
        input: vec![
            Data::Params(world.params),
            Data::Grid(world.grid),
            Data::FoamState(now()),
            Data::U32(world.cell_start.clone()),
            Data::Vec4(world.positions.clone()),
            Data::Vec4(world.positions.clone()).poison(),
        ],
        compare: Box::new(move |a, b| same(a[0].floats(), &wide(b[0].floats()))),
        oracle: Box::new(move |out| again(out[0].floats(), &expected)),
        control: |input| input[0].params().support_radius *= 1.001,
    }
}

/// Normals of which a third are none.
fn some_normals(world: &World) -> Vec<Vec4> {
    let unit = |i: usize| world.normals[i].xyz().normalize_or(Vec3::Y).extend(1.0);
    (0..world.len()).map(|i| if i % 3 == 0 { Vec4::ZERO } else { unit(i) }).collect()
}

fn potentials() -> Case {
    let world = World::new(params(2.0), 1500);
    let (support, least) = (f64::from(world.params.support_radius), f64::from(foam().energy_least));
    let normals = some_normals(&world);
    let mut expected = vec![f64::NAN; 4 * world.len()];
    let mut tolerance = vec![1e-6; 4 * world.len()];
    let mut edge = vec![false; world.len()];
    let (mut slow, mut crests) = (0, 0);
    for i in 0..world.living() {
        let (x, v, n) = (place(&world, i), speed(&world, i), normals[i].xyz().as_dvec3());
        let energy = v.length_squared() / 2.0;
        let (mut trapped, mut curvature, mut doubtful) = (0.0, 0.0, 0.0);
        if energy > least {
            near(&world, x, |j, d, r| {
                let w = W.w(r / support) / support.powi(3) * volume();
                let u = v - speed(&world, j);
                let away = if r > 0.0 { u.normalize_or_zero().dot(d / r) } else { 0.0 };
                trapped += w * u.length() * (1.0 - away);
                let term = w * f64::from(normals[j].w) * (1.0 - n.dot(normals[j].xyz().as_dvec3()));
                if d.dot(n) > 0.0 {
                    curvature += term;
                }
                if d.dot(n).abs() < 1e-7 {
                    doubtful += term;
                }
            });
            let forwards = v.dot(n) - 0.6 * v.length();
            edge[i] |= forwards.abs() < 1e-5;
            let is_crest = forwards >= 0.0 && normals[i].w > 0.0;
            curvature = if is_crest { curvature } else { 0.0 };
            crests += usize::from(curvature > 0.1);
        } else {
            slow += 1;
        }
        edge[i] |= (energy - least).abs() < 1e-5;
        expected[4 * i..4 * i + 4].copy_from_slice(&[trapped, curvature, energy, 0.0]);
        tolerance[4 * i] += 2e-5 * trapped;
        tolerance[4 * i + 1] += 2e-5 * curvature + doubtful;
    }
    assert!(slow > 100 && crests > 30, "{slow} are slow, {crests} are crests");
    let same = move |a: &[f32], b: &[f64]| masked("potentials", a, b, &tolerance, &edge);
    let again = same.clone();
    Case {
        pass: pass("foam.potentials"),
        name: "a cloud in a box".into(),
        extent: Extent::Items(world.len() as u32),
        input: vec![
            Data::Params(world.params),
            Data::Grid(world.grid),
            Data::Foam(foam()),
            Data::FoamState(now()),
            Data::U32(world.cell_start.clone()),
            Data::Vec4(world.positions.clone()),
            Data::Vec4(world.velocities.clone()),
            Data::Vec4(normals),
            Data::Vec4(world.positions.clone()).poison(),
        ],
        compare: Box::new(move |a, b| same(a[0].floats(), &wide(b[0].floats()))),
        oracle: Box::new(move |out| again(out[0].floats(), &expected)),
        control: |input| input[0].params().particle_spacing *= 1.001,
    }
}

fn count() -> Case {
    let world = World::new(params(2.0), 1500);
    let (foam, now) = (foam(), now());
    let potentials: Vec<Vec4> = (0..world.len() as u32)
        .map(|i| {
            let part = |k: u32| unit(9 * i + k) as f32;
            Vec4::new(2.5 * part(0), 0.7 * part(1), part(2), 0.0)
        })
        .collect();
    let ramp = |x: f32, least: f32, scale: f32| {
        ((f64::from(x) - f64::from(least)) * f64::from(scale)).clamp(0.0, 1.0)
    };
    let mut expected = vec![u32::MAX; world.len()];
    let mut edge = vec![false; world.len()];
    for i in 0..world.living() {
        let p = potentials[i];
        let rate = f64::from(foam.trapped_air) * ramp(p.x, foam.trapped_air_least, foam.trapped_air_scale)
            + f64::from(foam.wave_crest) * ramp(p.y, foam.wave_crest_least, foam.wave_crest_scale);
        let energy = ramp(p.z, foam.energy_least, foam.energy_scale);
        let number = energy * rate * f64::from(now.dt) + unit(seed(world.ids[i], now.step));
        edge[i] = (number - number.round()).abs() < 1e-4;
        expected[i] = number.floor() as u32;
    }
    let kinds = [0, 1, 2, 10].map(|n| expected.iter().filter(|&&count| count == n).count());
    assert!(kinds.iter().all(|&n| n > 5), "{kinds:?}");
    let same = move |a: &[u32], b: &[u32]| {
        let keep = |values: &[u32]| -> Vec<u32> {
            values.iter().zip(&edge).filter(|(_, edge)| !**edge).map(|(v, _)| *v).collect()
        };
        assert!(keep(a).len() * 50 > a.len() * 49);
        exact("counts", &keep(a), &keep(b))
    };
    let again = same.clone();
    Case {
        pass: pass("foam.count"),
        name: "every potential".into(),
        extent: Extent::Items(world.len() as u32),
        input: vec![
            Data::Grid(world.grid),
            Data::Foam(foam),
            Data::FoamState(now),
            Data::U32(world.cell_start.clone()),
            Data::U32(world.ids.clone()),
            Data::Vec4(potentials),
            Data::U32(vec![u32::MAX; world.len()]),
        ],
        compare: Box::new(move |a, b| same(a[0].words(), b[0].words())),
        oracle: Box::new(move |out| again(out[0].words(), &expected)),
        control: |input| {
            let Data::FoamState(state) = &mut input[2] else { panic!("no state") };
            state.dt *= 1.001;
        },
    }
}

/// The part of a ball of this radius whose centre is inside of the closed sides, by each side's cap.
fn part_inside(world: &World, x: DVec3) -> f64 {
    let p = &world.params;
    let (low, high) = (p.domain_min.as_dvec3(), p.domain_max.as_dvec3());
    let mut part = 1.0;
    for axis in 0..3 {
        for (side, gap) in [(0, x[axis] - low[axis]), (1, high[axis] - x[axis])] {
            if p.closed >> (2 * axis + side) & 1 == 1 {
                // A cap of height 1 - t of the unit ball has the volume pi (1 - t)^2 (2 + t) / 3.
                let t = (gap / f64::from(p.support_radius)).clamp(0.0, 1.0);
                part *= 1.0 - (1.0 - t).powi(2) * (2.0 + t) / 4.0;
            }
        }
    }
    part
}

/// Mean velocity, neighbours, and whether a neighbour is on the edge of the support.
fn around(world: &World, x: DVec3) -> (DVec3, f64, bool) {
    let support = f64::from(world.params.support_radius);
    let (mut sum, mut weight, mut number) = (DVec3::ZERO, 0.0, 0.0);
    near(world, x, |j, _, r| {
        sum += W.w(r / support) * speed(world, j);
        weight += W.w(r / support);
        number += 1.0;
    });
    let edge = (0..world.living()).any(|j| ((x - place(world, j)).length() - support).abs() < 1e-6);
    (if weight > 0.0 { sum / weight } else { sum }, number / part_inside(world, x), edge)
}

fn kind(neighbours: f64, was: u32) -> u32 {
    match neighbours {
        few if few < 12.5 => 0,
        many if many > if was == 1 { 21.5 } else { 18.5 } => 2,
        _ => 1,
    }
}

fn words(particles: &[Diffuse]) -> Vec<f32> {
    bytemuck::cast_slice(particles).to_vec()
}

/// Particles of foam everywhere in the box of the world, some on their way out, some about to dissolve.
fn diffuse(world: &World, n: u32) -> Vec<Diffuse> {
    let p = &world.params;
    let random = |i: u32, k: u32| unit(100_000 + 11 * i + k) as f32;
    (0..n)
        .map(|i| {
            let at = Vec3::new(random(i, 0), random(i, 1), random(i, 2));
            let v = Vec3::new(random(i, 3), random(i, 4), random(i, 5)) * 6.0 - 3.0;
            Diffuse {
                position: p.domain_min + at * (p.domain_max - p.domain_min),
                lifetime: if i.is_multiple_of(5) { 0.01 * random(i, 6) } else { 1.0 + random(i, 6) },
                velocity: v,
                tag: ((1000 + i) << 2) | (i % 3),
            }
        })
        .collect()
}

/// Equal particles: numbers and kinds to the bit, all else nearly.
fn alike(a: &[f32], b: &[f64], edge: &[bool]) -> Result<(), String> {
    // A tag read as a float is a tiny number or NaN; as a whole number it is compared apart.
    let tags = |k: usize| k % 8 == 7;
    let certain = |k: &usize| tags(*k) && !edge[k / 8];
    let a_tags: Vec<u32> = (0..a.len()).filter(certain).map(|k| a[k].to_bits()).collect();
    let b_tags: Vec<u32> = (0..a.len()).filter(certain).map(|k| b[k] as u32).collect();
    exact("tags", &a_tags, &b_tags)?;
    let a: Vec<f32> = (0..a.len()).map(|k| if tags(k) { 0.0 } else { a[k] }).collect();
    let b: Vec<f64> = (0..a.len()).map(|k| if tags(k) { 0.0 } else { b[k] }).collect();
    // The GPU's cosine is good to 2^-11 of a particle's radius.
    let tolerance: Vec<f64> = b.iter().map(|b| 2e-5 + 2e-5 * b.abs()).collect();
    masked("particles", &a, &b, &tolerance, edge)
}

/// Particles as numbers, the tag as a whole one.
fn numbers(words: &[f32]) -> Vec<f64> {
    let number = |(k, word): (usize, &f32)| {
        if k % 8 == 7 { f64::from(word.to_bits()) } else { f64::from(*word) }
    };
    words.iter().enumerate().map(number).collect()
}

fn advect() -> Case {
    let mut world = World::new(params(2.0), 700);
    world.params.closed = 0b11_1101;
    let (foam, mut now) = (foam(), now());
    let n = 1200;
    now.count = n - 100;
    let pool = diffuse(&world, n);
    let dt = f64::from(now.dt);
    let p = &world.params;
    let phase = f64::from(p.shake_rate) * (f64::from(now.time) - dt / 2.0);
    let pull = p.gravity.as_dvec3() + p.shake.as_dvec3() * phase.sin();
    let mut expected = vec![f64::NAN; 8 * n as usize];
    let mut alive = vec![7; n as usize];
    let mut edge = vec![false; n as usize];
    let (mut kinds, mut dead) = ([0; 3], 0);
    for i in 0..now.count as usize {
        let (from, v) = (pool[i].position.as_dvec3(), pool[i].velocity.as_dvec3());
        let fall = dt * dt / 2.0 * pull;
        let was_spray = pool[i].tag & 3 == 0;
        let (velocity, neighbours, doubtful) =
            around(&world, from + dt * v + if was_spray { fall } else { DVec3::ZERO });
        let kind = kind(neighbours, pool[i].tag & 3);
        let (mut x, mut u) = match kind {
            0 => (from + dt * v + fall, v + dt * pull),
            1 => (from + dt * (v + velocity) / 2.0, velocity),
            _ => {
                let risen = velocity - f64::from(foam.buoyancy) * pull / f64::from(foam.drag);
                let u = risen + (v - risen) * (-f64::from(foam.drag) * dt).exp();
                (from + dt * (v + u) / 2.0, u)
            }
        };
        let (mut out, mut lies) = (false, false);
        let (low, high) = (p.domain_min.as_dvec3(), p.domain_max.as_dvec3());
        for axis in 0..3 {
            if x[axis] <= low[axis] || x[axis] >= high[axis] {
                lies = true;
                // The side at max x is open.
                out |= axis == 0 && x[axis] >= high[axis];
                u[axis] = if x[axis] <= low[axis] { u[axis].max(0.0) } else { u[axis].min(0.0) };
                x[axis] = x[axis].clamp(low[axis], high[axis]);
            }
        }
        let ages = kind == 1 || pool[i].tag & 3 == 1 || kind == 0 && lies;
        let left = f64::from(pool[i].lifetime) - if ages { dt } else { 0.0 };
        edge[i] = doubtful || [12.5, 18.5, 21.5].iter().any(|limit| (neighbours - limit).abs() < 1e-4);
        let tag = f64::from(pool[i].tag & !3 | kind);
        expected[8 * i..8 * i + 8].copy_from_slice(&[x.x, x.y, x.z, left, u.x, u.y, u.z, tag]);
        alive[i] = u32::from(!out && left > 0.0);
        kinds[kind as usize] += 1;
        dead += usize::from(alive[i] == 0);
    }
    assert!(kinds.iter().all(|&k| k > 50) && dead > 30, "{kinds:?}, {dead} dead");
    for tag in expected.iter_mut().skip(8 * now.count as usize + 7).step_by(8) {
        *tag = f64::from(u32::MAX);
    }
    let same = move |a: &[Data], b: &[f64], alive: &[u32]| {
        alike(a[0].floats(), b, &edge)?;
        let keep = |values: &[u32]| -> Vec<u32> {
            values.iter().zip(&edge).filter(|(_, edge)| !**edge).map(|(v, _)| *v).collect()
        };
        exact("alive", &keep(a[1].words()), &keep(alive))
    };
    let again = same.clone();
    Case {
        pass: pass("foam.advect"),
        name: "in the air, on the water, under it".into(),
        extent: Extent::Items(n),
        input: vec![
            Data::Params(world.params),
            Data::Grid(world.grid),
            Data::Foam(foam),
            Data::FoamState(now),
            Data::U32(world.cell_start.clone()),
            Data::Vec4(world.positions.clone()),
            Data::Vec4(world.velocities.clone()),
            Data::Diffuse(pool.clone()),
            Data::Diffuse(pool).poison(),
            Data::U32(vec![7; n as usize]),
        ],
        compare: Box::new(move |a, b| same(a, &numbers(b[0].floats()), b[1].words())),
        oracle: Box::new(move |out| again(out, &expected, &alive)),
        control: |input| {
            let Data::FoamState(state) = &mut input[3] else { panic!("no state") };
            state.dt *= 1.001;
        },
    }
}

/// 500 are kept; `wanted` want to be born.
fn plan(name: &'static str, capacity: u32, wanted: u32) -> Case {
    let kept = 500;
    let room = capacity - kept;
    let mut share = 4096;
    if wanted > room {
        // In halves while there are more than 2^20, as the shader has no longer numbers.
        let halvings = room.ilog2().saturating_sub(19);
        let all = (0..halvings).fold(wanted, |all, _| all.div_ceil(2));
        share = (u64::from(room >> halvings) * 4096 / u64::from(all)) as u32;
    }
    let born = (u64::from(wanted) * u64::from(share) / 4096) as u32;
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
    assert!(born <= room && born + 1 + wanted / 4096 >= wanted.min(room));
    Case {
        pass: pass("foam.plan"),
        name: name.into(),
        extent: Extent::Groups(1),
        input: vec![
            Data::Params(Params { particle_count: 3, ..params(2.0) }),
            Data::Foam(FoamParams { capacity, ..foam() }),
            // What lies behind the last is of no account.
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

fn settle() -> Case {
    let world = World::new(params(2.0), 500);
    let (moved, pool) = (diffuse(&world, 300), diffuse(&world, 700)[400..].to_vec());
    let indices: Vec<u32> = (0..300).filter(|i| i % 7 != 3).collect();
    let kept = indices.len();
    let mut expected = pool.clone();
    for (place, &i) in expected.iter_mut().zip(&indices) {
        *place = moved[i as usize];
    }
    let mut list = indices;
    list.resize(300, 299);
    Case {
        pass: pass("foam.settle"),
        name: "a seventh has dissolved".into(),
        extent: Extent::Items(300),
        input: vec![
            Data::FoamState(FoamState { kept: kept as u32, count: 300, ..now() }),
            Data::U32(list),
            Data::Diffuse(moved),
            Data::Diffuse(pool),
        ],
        compare: Box::new(|a, b| exact("pool", a[0].words(), b[0].words())),
        oracle: Box::new(move |out| exact("pool", out[0].words(), Data::Diffuse(expected.clone()).words())),
        control: |input| {
            let Data::U32(list) = &mut input[1] else { panic!("no list") };
            list[17] += 1;
        },
    }
}

fn emit(name: &'static str, share: u32) -> Case {
    let world = World::new(params(2.0), 1500);
    let living = world.living();
    // One of the fluid goes straight up, where the usual direction across it is none.
    let mut world = world;
    world.velocities[7] = Vec4::new(0.0, 1.5, 0.0, 1000.0);
    let counts: Vec<u32> = (0..living).map(|i| if i % 4 == 0 { 3 } else { u32::from(i % 7 == 0) }).collect();
    let mut starts = vec![0; world.len() + 1];
    for i in 0..world.len() {
        starts[i + 1] = starts[i] + counts.get(i).copied().unwrap_or(0);
    }
    let wanted = starts[world.len()];
    let place_of = |m: u32| (u64::from(m) * u64::from(share) / 4096) as u32;
    let (kept, born) = (40, place_of(wanted));
    let now = FoamState { kept, born, share, wanted, count: kept + born, next_id: 5000 + born, ..now() };
    let foam = foam();
    let pool = diffuse(&world, kept + born + 20);
    let mut expected = numbers(&words(&pool));
    let mut edge = vec![false; pool.len()];
    let radius = f64::from(SPACING);
    for i in 0..living {
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
    assert!(born > 300, "{born}");
    let same = move |a: &[f32], b: &[f64]| alike(a, b, &edge);
    let again = same.clone();
    Case {
        pass: pass("foam.emit"),
        name: name.into(),
        extent: Extent::Items(world.len() as u32),
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
