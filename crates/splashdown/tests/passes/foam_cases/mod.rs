//! Foam, spray and bubbles.

mod births;
mod bodies;
mod fluid;
mod moving;
mod pool;

use glam::{DVec3, Vec4Swizzles};
use splashdown::foam::{FoamParams, FoamState};
use splashdown_gpu::{bytemuck, testing};

use super::harness::{Case, Data, close, exact};
use super::oracle::Kernel;
use super::world::{SPACING, World};

const W: Kernel = Kernel::WendlandC2;

pub fn cases() -> Vec<Case> {
    let mut cases = vec![
        births::begin("in a frame", |_, _| {}),
        births::begin("too early", |state, _| state.time = 0.701),
        births::begin("at a frame's end", |state, _| {
            (state.time, state.frame_duration) = (0.701, 0.0);
        }),
        births::begin("without an order", |state, _| state.run_count = 0),
        births::begin("for the first time", |_, foam| foam.has_begun = 0),
        births::begin("without time passed", |state, _| (state.time, state.frame_duration) = (0.7, 0.0)),
        fluid::normals(),
        fluid::potentials(),
        fluid::count(),
        moving::advect(),
        bodies::collide(),
        births::plan("with room", 5000, 300),
        births::plan("with little room", 1000, 300),
        births::plan("full", 600, 300),
        births::plan("with room for one in a million", 503, 3_000_000),
        births::plan("without any room", 500, 300),
        births::plan("beyond what counts in 20 bits", 3_000_000, 3_999_999),
        moving::compact(),
        births::emit("all of them", 4096),
        births::emit("a part of them", 1700),
        births::emit("a part of them, four by four", 1700 + (2 << 16)),
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

/// The same pass without an update that is due: nothing changes.
fn when_not_due(case: &Case) -> Option<Case> {
    let due = |data: &Data| matches!(data, Data::FoamState(state) if state.is_due == 1);
    // The pass that determines whether an update is due is excluded.
    let at = case.input.iter().position(due).filter(|_| case.pass.label != "foam.begin")?;
    let plans = case.pass.label == "foam.plan";
    let mut input = case.input.clone();
    let Data::FoamState(state) = &mut input[at] else { unreachable!() };
    state.is_due = 0;
    // The plan has no new particles.
    state.born = if plans { 0 } else { state.born };
    let written = |k: &usize| case.pass.bindings[*k].access == splashdown_gpu::Access::ReadWrite;
    let before: Vec<Data> = (0..input.len()).filter(written).map(|k| input[k].clone()).collect();
    let same = |a: &[Data], b: &[Data]| {
        a.iter().zip(b).try_for_each(|(a, b)| exact("what was there", a.words(), b.words()))
    };
    Some(Case {
        pass: case.pass,
        name: format!("{}, not due", case.name),
        size: case.size,
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

fn place(world: &World, i: usize) -> DVec3 {
    world.positions[i].xyz().as_dvec3()
}

fn speed(world: &World, i: usize) -> DVec3 {
    world.velocities[i].xyz().as_dvec3()
}

fn volume() -> f64 {
    f64::from(SPACING).powi(3)
}

/// All active particles within the support of `x`, except those at the same position, with their
/// distances.
fn near(world: &World, x: DVec3, mut visit: impl FnMut(usize, DVec3, f64)) {
    let support = f64::from(world.params.support_radius);
    for j in 0..world.active() {
        let d = x - place(world, j);
        if d.length() < support {
            visit(j, d, d.length());
        }
    }
}

/// Compares floats, except those that depend on a value close to a threshold.
fn masked(what: &str, a: &[f32], b: &[f64], tolerance: &[f64], edge: &[bool]) -> Result<(), String> {
    let per = a.len() / edge.len();
    let keep: Vec<usize> = (0..a.len()).filter(|k| !edge[k / per]).collect();
    assert!(keep.len() * 50 > a.len() * 49, "{what}: too many are on an edge");
    let pick = |values: &[f64]| keep.iter().map(|&k| values[k]).collect::<Vec<_>>();
    let a: Vec<f32> = keep.iter().map(|&k| a[k]).collect();
    close(what, &a, &pick(b), &pick(tolerance))
}
