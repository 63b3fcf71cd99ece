//! Quantities of the fluid particles: normals, potentials, number of new particles.

use std::f64::consts::PI;

use glam::{DVec3, Vec3, Vec4, Vec4Swizzles};
use splashdown_gpu::DispatchSize;

use super::super::harness::{Case, Data, exact, wide};
use super::super::sort_cases::pass;
use super::super::world::{World, params};
use super::{W, foam, masked, near, now, place, seed, speed, unit, volume};

pub(super) fn normals() -> Case {
    let world = World::new(params(2.0), 1500);
    let support = f64::from(world.params.support_radius);
    let mut expected = vec![f64::NAN; 4 * world.len()];
    let mut edge = vec![false; world.len()];
    let mut count = 0;
    for i in 0..world.active() {
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
    assert!(count > 200 && count + 200 < world.active(), "{count} on the surface");
    let tolerance = vec![2e-5; expected.len()];
    let same = move |a: &[f32], b: &[f64]| masked("normals", a, b, &tolerance, &edge);
    let again = same.clone();
    Case {
        pass: pass("foam.normals"),
        name: "a cloud in a box".into(),
        size: DispatchSize::Items(world.len() as u32),
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

/// Normals, a third of which are zero.
fn some_normals(world: &World) -> Vec<Vec4> {
    let unit = |i: usize| world.normals[i].xyz().normalize_or(Vec3::Y).extend(1.0);
    (0..world.len()).map(|i| if i % 3 == 0 { Vec4::ZERO } else { unit(i) }).collect()
}

pub(super) fn potentials() -> Case {
    let world = World::new(params(2.0), 1500);
    let (support, least) = (f64::from(world.params.support_radius), f64::from(foam().energy_least));
    let normals = some_normals(&world);
    let mut expected = vec![f64::NAN; 4 * world.len()];
    let mut tolerance = vec![1e-6; 4 * world.len()];
    let mut edge = vec![false; world.len()];
    let (mut slow, mut crests) = (0, 0);
    for i in 0..world.active() {
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
        size: DispatchSize::Items(world.len() as u32),
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

pub(super) fn count() -> Case {
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
    for i in 0..world.active() {
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
        size: DispatchSize::Items(world.len() as u32),
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
