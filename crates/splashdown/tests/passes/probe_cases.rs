//! Probes.

use std::f64::consts::PI;

use glam::{DVec3, Vec3, Vec4, Vec4Swizzles};
use splashdown::bodies::Body;
use splashdown::probes::{Account, POSE, ProbePoint, ROW, VALUES};
use splashdown_gpu::{DispatchSize, bytemuck, testing};

use super::harness::{Case, Data, close, exact, wide};
use super::sort_cases::pass;
use super::world::{SPACING, World, params};

pub fn cases() -> Vec<Case> {
    vec![sample(), flux(), accumulate()]
}

/// A point in the fluid, one in a corner, one far above the fluid; a vertical and a tilted column; the force on a body;
/// two rectangles; the state of a body.
fn probes() -> Vec<ProbePoint> {
    let none: ProbePoint = bytemuck::Zeroable::zeroed();
    let lean = Vec3::new(0.48, 0.8, -0.36);
    let normal = Vec3::new(0.6, 0.0, 0.8);
    let flow = ProbePoint {
        kind: ProbePoint::FLOW,
        position: Vec3::new(0.03, 0.22, 0.41),
        normal,
        along: Vec3::new(0.8, 0.0, -0.6),
        across: Vec3::new(0.0, -1.0, 0.0),
        half_along: 0.2,
        half_across: 0.15,
        ..none
    };
    let column = ProbePoint { kind: ProbePoint::HEIGHT, position: Vec3::new(0.11, 0.103, 0.37), ..none };
    vec![
        ProbePoint { position: Vec3::new(0.021, 0.213, 0.404), ..none },
        ProbePoint { position: Vec3::new(-0.3, 0.0, 0.1), ..none },
        ProbePoint { position: Vec3::new(0.0, 7.0, 0.0), ..none },
        ProbePoint { normal: Vec3::Y, half_along: 0.397, ..column },
        ProbePoint { normal: lean, half_along: 0.3, ..column },
        ProbePoint { kind: ProbePoint::FORCE, body: 1, ..none },
        flow,
        ProbePoint { normal: -normal, half_along: 0.1, ..flow },
        ProbePoint { kind: ProbePoint::BODY, body: 1, ..none },
    ]
}

fn sample() -> Case {
    let world = World::new(params(2.0), 2500);
    let noise = |i: usize| testing::noise(i as u32) as f32 / u32::MAX as f32 - 0.5;
    let accelerations: Vec<Vec4> = (0..world.len())
        .map(|i| Vec4::new(20.0 * noise(3 * i), 20.0 * noise(3 * i + 1), 20.0 * noise(3 * i + 2), 0.0))
        .collect();
    let probes = probes();
    let support = f64::from(world.params.support_radius);
    let volume = f64::from(SPACING).powi(3);
    let outer = world.params.body_acceleration(world.state.time).as_dvec3();
    let mut expected = vec![7.0; probes.len() * VALUES];
    let mut near = Vec::new();
    for (k, probe) in probes.iter().enumerate().take(5) {
        let (mut weight, mut pressure, mut offset, mut acceleration) = (0.0, 0.0, DVec3::ZERO, DVec3::ZERO);
        let mut count = 0;
        let support = if probe.kind == ProbePoint::HEIGHT { 1.5 * support } else { support };
        for (i, drive) in accelerations.iter().enumerate().take(world.active()) {
            let mut d = world.positions[i].xyz().as_dvec3() - probe.position.as_dvec3();
            if probe.kind == ProbePoint::HEIGHT {
                let normal = probe.normal.as_dvec3();
                if d.dot(normal) < 0.0 {
                    continue;
                }
                d -= d.dot(normal) * normal;
            }
            let q = d.length() / support;
            if q < 1.0 {
                let w = (1.0 - q).powi(4) * (4.0 * q + 1.0);
                weight += w;
                pressure += w * f64::from(world.densities[i].y);
                offset += w * d;
                acceleration += w * drive.xyz().as_dvec3();
                count += 1;
            }
        }
        near.push(count);
        expected[k * VALUES] = if probe.kind == ProbePoint::HEIGHT {
            volume * weight * 7.0 / (PI * support * support)
        } else if count == 0 {
            0.0
        } else {
            let share = volume * weight * 21.0 / (2.0 * PI * support.powi(3));
            let gradient = f64::from(world.params.rest_density) * (outer - acceleration / weight);
            (pressure / weight - gradient.dot(offset / weight)) * (share / 0.1).min(1.0)
        };
    }
    assert!(near[0] > 10 && near[1] > 5 && near[2] == 0 && near[3] > 20 && near[4] > 20, "{near:?}");
    let same = |a: &[f32], b: &[f64]| {
        let tolerance: Vec<f64> = b.iter().map(|b| 1e-5 * b.abs() + 1e-6).collect();
        close("values", a, b, &tolerance)
    };
    Case {
        pass: pass("probes.sample"),
        name: "points in the fluid, in a corner and outside, vertical and tilted columns".into(),
        size: DispatchSize::Groups(probes.len() as u32),
        input: vec![
            Data::Params(world.params),
            Data::Grid(world.grid),
            Data::State(world.state),
            Data::U32(world.cell_start.clone()),
            Data::Probes(probes.clone()),
            Data::Vec4(world.positions.clone()),
            Data::Vec2(world.densities.clone()),
            Data::Vec4(accelerations),
            Data::F32(vec![7.0; probes.len() * VALUES]),
        ],
        compare: Box::new(move |a, b| same(a[0].floats(), &wide(b[0].floats()))),
        oracle: Box::new(move |out| same(out[0].floats(), &expected)),
        control: |input| {
            let Data::Probes(probes) = &mut input[4] else { panic!("no probes") };
            probes[4].position.x += 1e-4;
        },
    }
}

fn flux() -> Case {
    let world = World::new(params(2.0), 6000);
    let noise = |i: usize| testing::noise(i as u32 + 900) as f32 / u32::MAX as f32 - 0.5;
    let moved: Vec<Vec4> = (0..world.len())
        .map(|i| {
            world.positions[i]
                + 2.0 * SPACING * Vec4::new(noise(3 * i), noise(3 * i + 1), noise(3 * i + 2), 0.0)
        })
        .collect();
    let probes = probes();
    let before: Vec<u32> = (0..probes.len() as u32).map(|k| k.wrapping_sub(3)).collect();
    let mut expected = before.clone();
    let mut crossed = [0; 2];
    for (before, after) in world.positions.iter().zip(&moved).take(world.active()) {
        let [a, b] = [before, after].map(|p| p.xyz().as_dvec3());
        for (k, probe) in probes.iter().enumerate().skip(6).take(2) {
            let [center, normal] = [probe.position, probe.normal].map(|v| v.as_dvec3());
            let [above, below] = [a, b].map(|x| (x - center).dot(normal));
            if (above < 0.0) == (below < 0.0) {
                continue;
            }
            let at = a + (b - a) * (above / (above - below)) - center;
            let inside = at.dot(probe.along.as_dvec3()).abs() <= f64::from(probe.half_along)
                && at.dot(probe.across.as_dvec3()).abs() <= f64::from(probe.half_across);
            if inside {
                crossed[k - 6] += 1;
                expected[k] = expected[k].wrapping_add(if above < 0.0 { 1 } else { u32::MAX });
            }
        }
    }
    assert!(crossed[0] > 40 && crossed[1] > 10 && crossed[1] < crossed[0], "{crossed:?}");
    Case {
        pass: pass("probes.flux"),
        name: "two rectangles that face each other".into(),
        size: DispatchSize::Items(world.len() as u32),
        input: vec![
            Data::Grid(world.grid),
            Data::State(world.state),
            Data::U32(world.cell_start.clone()),
            Data::Probes(probes),
            Data::Vec4(world.positions.clone()),
            Data::Vec4(moved),
            Data::U32(before),
        ],
        compare: Box::new(|a, b| exact("counts", a[0].words(), b[0].words())),
        oracle: Box::new(move |out| exact("counts", out[0].words(), &expected)),
        control: |input| {
            let Data::Probes(probes) = &mut input[3] else { panic!("no probes") };
            probes[6].position.x += 0.1 * SPACING;
        },
    }
}

fn accumulate() -> Case {
    let world = World::new(params(2.0), 500);
    let state = world.state;
    let elapsed = state.frame_duration - state.remaining + state.dt;
    let mut probes = probes();
    // Due: the first, one within half a step, the force, a flow, the state of a body. Not due: one by more than half a
    // step. Full: the fourth.
    let next = [
        elapsed - 0.001,
        elapsed + 0.4 * state.dt,
        elapsed + 0.6 * state.dt,
        0.0,
        1.0,
        0.0,
        elapsed,
        1.0,
        elapsed,
    ];
    let none: Body = bytemuck::Zeroable::zeroed();
    // A turn of 120 degrees about the diagonal maps x to y, y to z and z to x.
    let pushed = Body {
        force: Vec3::new(3.0, -40.0, 0.5),
        torque: Vec3::new(0.25, 6.0, -2.0),
        position: Vec3::new(1.0, 2.0, 4.0),
        orientation: Vec4::splat(0.5),
        velocity: Vec3::new(0.5, -1.0, 3.0),
        angular_velocity: Vec3::new(0.0, 0.0, 2.0),
        center: Vec3::new(0.25, 0.5, 0.125),
        ..none
    };
    // The origin of the mesh is at -(0.125, 0.25, 0.5) from the centre.
    let pose = [0.875, 1.75, 3.5, 0.5, 0.5, 0.5, 0.5, 1.0, -1.25, 3.0, 0.0, 0.0, 2.0];
    let mut accounts = Vec::new();
    let mut first_row = 1;
    for (k, probe) in probes.iter_mut().enumerate() {
        probe.interval = 0.003;
        probe.first_row = first_row;
        probe.most_rows = 3;
        first_row += probe.most_rows;
        let mut account =
            vec![next[k].to_bits(), if k == 3 { 3 } else { k as u32 % 3 }, 0.0013_f32.to_bits()];
        account.extend((0..VALUES).map(|v| (0.02 * (v as f32 + 1.0) - 0.01 * k as f32).to_bits()));
        accounts.extend(account);
    }
    let rows = vec![-1.0_f32; first_row as usize * ROW];
    let values: Vec<f32> = (0..probes.len() * VALUES).map(|k| 13.0 + k as f32).collect();
    let counts: Vec<u32> = (0..probes.len() as u32).map(|k| 5_u32.wrapping_sub(2 * k)).collect();

    let volume = f64::from(SPACING).powi(3);
    let (mut new_accounts, mut new_rows, mut new_counts) =
        (wide(bytemuck::cast_slice(&accounts)), wide(&rows), counts.clone());
    let dt = f64::from(state.dt);
    for (k, account) in new_accounts.chunks_exact_mut(Account::WORDS).enumerate() {
        account[Account::TIME] += dt;
        let sums = &mut account[Account::SUMS..];
        match probes[k].kind {
            ProbePoint::FORCE | ProbePoint::BODY => {
                for (a, value) in [pushed.force, pushed.torque].iter().flat_map(|v| v.to_array()).enumerate()
                {
                    sums[a] += f64::from(value) * dt;
                }
            }
            ProbePoint::FLOW => {
                sums[0] += f64::from(counts[k] as i32) * volume;
                new_counts[k] = 0;
            }
            _ => sums[0] += f64::from(values[k * VALUES]) * dt,
        }
        if ![0, 1, 5, 6, 8].contains(&k) {
            continue;
        }
        let row = accounts[k * Account::WORDS + Account::ROWS];
        let at = (probes[k].first_row + row) as usize * ROW;
        new_rows[at] = f64::from(elapsed);
        let mut means = at + 1;
        if probes[k].kind == ProbePoint::BODY {
            new_rows[means..][..POSE].copy_from_slice(&pose);
            means += POSE;
        }
        for v in 0..VALUES {
            new_rows[means + v] = account[Account::SUMS + v] / account[Account::TIME];
            account[Account::SUMS + v] = 0.0;
        }
        account[Account::TIME] = 0.0;
        account[Account::ROWS] = f64::from(f32::from_bits(row + 1));
        account[Account::NEXT] = (f64::from(next[k]) + 0.003).max(f64::from(elapsed));
    }
    let same = |a: [&[f32]; 2], b: [&[f64]; 2]| {
        for (what, (a, b)) in ["accounts", "rows"].iter().zip(a.iter().zip(b)) {
            let tolerance: Vec<f64> = b.iter().map(|b| 1e-6 * b.abs()).collect();
            close(what, a, b, &tolerance)?;
        }
        Ok(())
    };
    let counted = new_counts.clone();
    Case {
        pass: pass("probes.accumulate"),
        name: "due, nearly due, not due, full".into(),
        size: DispatchSize::Items(probes.len() as u32),
        input: vec![
            Data::Params(world.params),
            Data::State(state),
            Data::Probes(probes),
            Data::Bodies(vec![none, pushed]),
            Data::F32(values),
            Data::U32(counts),
            Data::U32(accounts),
            Data::F32(rows),
        ],
        compare: Box::new(move |a, b| {
            exact("counts", a[0].words(), b[0].words())?;
            same([a[1].floats(), a[2].floats()], [&wide(b[1].floats()), &wide(b[2].floats())])
        }),
        oracle: Box::new(move |out| {
            exact("counts", out[0].words(), &counted)?;
            same([out[1].floats(), out[2].floats()], [&new_accounts, &new_rows])
        }),
        control: |input| {
            let Data::State(state) = &mut input[1] else { panic!("no state") };
            state.dt *= 1.001;
        },
    }
}
