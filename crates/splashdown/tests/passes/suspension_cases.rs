//! The passes that suspend and resume a step.

use splashdown::state::{SolveState, StepState, Suspension, ViscousState};
use splashdown_gpu::DispatchSize;
use splashdown_gpu::scan::ScanParams;

use super::harness::{Case, Data, exact};
use super::sort_cases::pass;
use super::world::{World, params, state};

const PARTICLES: usize = 300;
const SCAN: ScanParams = ScanParams { len: 1000, blocks: 1 };
const OFF: ScanParams = ScanParams { len: 0, blocks: 0 };
/// What an earlier suspension left.
const EARLIER: Suspension =
    Suspension { cell_particles: 1, all_particles: 2, scan_len: 3, scan_blocks: 4, count: 5 };
const COMPLETE: u32 = StepState::COMPLETE;
const SUSPENDED: u32 = StepState::SUSPENDED;
const HELD: u32 = StepState::HELD;

pub fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for (solver, other) in [("pressure", 1), ("viscosity", 0)] {
        let stopped = |has_stopped: bool| {
            let mut stopped = [u32::from(has_stopped); 2];
            stopped[other] = u32::from(!has_stopped);
            stopped
        };
        for (name, done, has_stopped, suspends) in [
            ("this solver has not stopped", 0, false, true),
            ("the other has not stopped", 0, true, false),
            ("the frame is complete", COMPLETE, false, false),
            ("the step is suspended", SUSPENDED, false, false),
        ] {
            let label = format!("suspension.suspend.{solver}");
            cases.push(suspend(&label, name, done, stopped(has_stopped), suspends.then_some(SUSPENDED)));
        }
        for (name, done, has_stopped, resumes) in [
            ("this solver has not stopped", SUSPENDED, false, true),
            ("the other has not stopped", SUSPENDED, true, false),
            ("a step that is not suspended", 0, false, false),
            ("the frame is complete", COMPLETE, false, false),
            ("the step is held", HELD, false, false),
        ] {
            let label = format!("suspension.resume.{solver}");
            cases.push(resume(&label, name, done, stopped(has_stopped), resumes));
        }
    }
    for (name, done, holds) in [
        ("between two steps", 0, true),
        ("the frame is complete", COMPLETE, false),
        ("the step is suspended", SUSPENDED, false),
    ] {
        cases.push(suspend("suspension.hold", name, done, [1, 1], holds.then_some(HELD)));
    }
    for (name, done, releases) in [
        ("the step is held", HELD, true),
        ("the step is suspended", SUSPENDED, false),
        ("the frame is complete", COMPLETE, false),
    ] {
        cases.push(resume("suspension.release", name, done, [0, 1], releases));
    }
    cases
}

/// A step in which particles move unless it is suspended or its frame complete.
fn step(done: u32) -> StepState {
    let running = state(PARTICLES);
    StepState { done, run_count: if done == 0 { running.run_count } else { 0 }, ..running }
}

fn solvers([pressure, viscosity]: [u32; 2]) -> [Data; 2] {
    let mut solve = SolveState::new(false, 0.5, 1.0);
    solve.stopped = pressure;
    let mut viscous = ViscousState::new(false);
    viscous.stopped = viscosity;
    [Data::Solve(solve), Data::Viscous(viscous)]
}

/// `becomes`: the value of `done` afterwards, if the pass has an effect.
fn suspend(label: &str, name: &str, done: u32, stopped: [u32; 2], becomes: Option<u32>) -> Case {
    let world = World::new(params(2.0), PARTICLES);
    let before = step(done);
    let cells = world.grid.cell_count as usize;
    let [solve, viscous] = solvers(stopped);
    let input = vec![
        Data::Grid(world.grid),
        solve,
        viscous,
        Data::U32(world.cell_start.clone()),
        Data::Scan(SCAN),
        Data::State(before),
        Data::Suspension(EARLIER),
    ];
    let mut starts = world.cell_start.clone();
    let mut expected = [Data::Scan(SCAN), Data::State(before), Data::Suspension(EARLIER)];
    if let Some(becomes) = becomes {
        let kept = Suspension {
            cell_particles: starts[cells],
            all_particles: starts[cells + 1],
            scan_len: SCAN.len,
            scan_blocks: SCAN.blocks,
            count: EARLIER.count + 1,
        };
        starts[cells..].fill(0);
        let suspended = StepState { done: becomes, run_count: 0, ..before };
        expected = [Data::Scan(OFF), Data::State(suspended), Data::Suspension(kept)];
    }
    let [scan, state, suspension] = expected;
    case(label, name, input, vec![Data::U32(starts), scan, state, suspension], |input| {
        // A step that should end here is complete, and the other way round.
        let [_, Data::Solve(solve), Data::Viscous(viscous), _, _, Data::State(state), _] = input else {
            panic!("other buffers")
        };
        state.done = if state.done == 0 { COMPLETE } else { 0 };
        state.steps += 1;
        (solve.stopped, viscous.stopped) = (0, 0);
    })
}

fn resume(label: &str, name: &str, done: u32, stopped: [u32; 2], resumes: bool) -> Case {
    let world = World::new(params(2.0), PARTICLES);
    let cells = world.grid.cell_count as usize;
    let kept = Suspension {
        cell_particles: world.cell_start[cells],
        all_particles: world.cell_start[cells + 1],
        scan_len: SCAN.len,
        scan_blocks: SCAN.blocks,
        count: 6,
    };
    let mut before = world.cell_start.clone();
    before[cells..].fill(0);
    let state = step(done);
    let [solve, viscous] = solvers(stopped);
    let input = vec![
        Data::Params(world.params),
        Data::Grid(world.grid),
        solve,
        viscous,
        Data::Suspension(kept),
        Data::U32(before.clone()),
        Data::Scan(OFF),
        Data::State(state),
    ];
    let expected = if resumes {
        let running = StepState { done: 0, run_count: world.params.particle_count, ..state };
        vec![Data::U32(world.cell_start.clone()), Data::Scan(SCAN), Data::State(running)]
    } else {
        vec![Data::U32(before), Data::Scan(OFF), Data::State(state)]
    };
    case(label, name, input, expected, |input| {
        // A step that should continue is complete, and the other way round.
        let Data::State(state) = &mut input[7] else { panic!("no state") };
        state.done = if state.done == COMPLETE { SUSPENDED } else { COMPLETE };
        state.steps += 1;
    })
}

/// Whatever is written must have exactly these words.
fn case(label: &str, name: &str, input: Vec<Data>, expected: Vec<Data>, control: fn(&mut [Data])) -> Case {
    let same = |a: &[Data], b: &[Data]| {
        a.iter().zip(b).try_for_each(|(a, b)| exact("written words", a.words(), b.words()))
    };
    Case {
        pass: pass(label),
        name: name.into(),
        size: DispatchSize::Groups(1),
        input,
        compare: Box::new(same),
        oracle: Box::new(move |out| same(out, &expected)),
        control,
    }
}
