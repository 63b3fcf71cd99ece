//! Advection and compaction of diffuse particles.

use glam::DVec3;
use splashdown::foam::FoamState;
use splashdown_gpu::DispatchSize;

use super::super::harness::{Case, Data, exact};
use super::super::sort_cases::pass;
use super::super::world::{World, params};
use super::pool::{alike, around, diffuse, kind, numbers};
use super::{foam, now};

pub(super) fn advect() -> Case {
    let mut world = World::new(params(2.0), 700);
    world.params.closed = 0b11_1101;
    let (foam, mut now) = (foam(), now());
    let n = 1200;
    now.count = n - 100;
    let pool = diffuse(&world, n);
    let dt = f64::from(now.dt);
    let p = &world.params;
    let phase = f64::from(p.oscillation_rate) * (f64::from(now.time) - dt / 2.0);
    let pull = p.gravity.as_dvec3() + p.oscillation.as_dvec3() * phase.sin();
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
        size: DispatchSize::Items(n),
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

pub(super) fn compact() -> Case {
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
        pass: pass("foam.compact"),
        name: "a seventh has dissolved".into(),
        size: DispatchSize::Items(300),
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
