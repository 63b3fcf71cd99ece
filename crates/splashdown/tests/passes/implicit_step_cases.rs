//! The passes of the implicit pressure without sums over neighbours: the begin, the decision after an iteration, and the end.

use glam::{DVec3, Vec3, Vec4, Vec4Swizzles};
use splashdown::state::{Params, SolveState, StepCounters, StepState};

use super::harness::{Case, Data, wide};
use super::iterative::{Output, base, case, poisoned, signed, vectors, world};
use super::oracle::{constants, speed};
use super::world::params;

pub fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    cases.push(begin("a step", 1500, 4e-4));
    cases.push(begin("the longest step", 1500, 4e-3));
    cases.push(begin("after the frame", 0, 4e-4));
    let viscous = Params { implicit_viscosity: 0.02, ..params(2.0) };
    let weightless = Params { gravity: Vec3::ZERO, compressibility: 0.0, ..params(2.0) };
    let full = full();
    let last = SolveState { iteration: 4, ..solving() };
    let first = SolveState { iteration: 0, best: f32::MAX, ..solving() };
    cases.extend([
        decide("the first iteration", first, 1.0, [25.0, 0.01]),
        decide("a further iteration", solving(), 1.0, [25.0, 0.01]),
        decide("after a longer change", SolveState { change: 1e-7, ..solving() }, 1.0, [25.0, 0.01]),
        decide("far above the best", SolveState { best: 1e-5, ..solving() }, 1.0, [25.0, 0.01]),
        decide("converged", solving(), 0.1, [5.0, 0.01]),
        decide("not enough for deep, calm water", solving(), 0.1, [25.0, 0.01]),
        decide("enough for deep water in motion", solving(), 0.1, [25.0, 0.4]),
        decide("the last iteration", last, 1.0, [25.0, 0.01]),
        decide_in(
            Sums { params: viscous, ..sums() },
            "converged in a viscous fluid",
            solving(),
            0.1,
            [5.0, 0.01],
        ),
        decide_in(Sums { worst: 0.4, ..sums() }, "an excess in one part", solving(), 0.01, [5.0, 0.01]),
        decide_in(
            Sums { worst: 0.3, ..sums() },
            "the largest accepted excess in one part",
            solving(),
            0.01,
            [5.0, 0.01],
        ),
        decide_in(
            Sums { worst: 0.4, ..sums() },
            "the last iteration with an excess in one part",
            last,
            0.01,
            [5.0, 0.01],
        ),
        decide_in(Sums { params: weightless, ..sums() }, "without gravity", solving(), 0.1, [5.0, 0.001]),
        // Root mean square displacements of 0.09, 0.2 and 20 spacings: the step is 1, 0.2 and 0.1 times as long.
        decide_in(
            Sums { impulse: 1.5e4, ..sums() },
            "an impact that is too weak",
            solving(),
            0.1,
            [5.0, 0.3],
        ),
        decide_in(Sums { impulse: 1e5, ..sums() }, "an impact", solving(), 0.1, [5.0, 0.3]),
        decide_in(Sums { impulse: 1e9, ..sums() }, "a strong impact", solving(), 0.1, [5.0, 0.3]),
        decide_in(
            Sums { params: viscous, impulse: 1e5, ..sums() },
            "a viscous impact",
            solving(),
            0.1,
            [5.0, 0.3],
        ),
        decide_in(Sums { impulse: 1e5, ..sums() }, "an impact that does not converge", last, 1.0, [5.0, 0.3]),
        decide_in(
            Sums { params: full, ..sums() },
            "a small excess in a full domain",
            first,
            0.1,
            [5.0, 0.01],
        ),
        decide_in(Sums { params: full, ..sums() }, "an excess in a full domain", first, 1.0, [5.0, 0.01]),
        decide_in(
            Sums { params: full, ..sums() },
            "the first update in a full domain",
            SolveState { iteration: 1, change: 1e-7, ..solving() },
            1.0,
            [5.0, 0.01],
        ),
        decide_in(Sums { params: full, ..sums() }, "converged in a full domain", solving(), 0.1, [5.0, 0.01]),
    ]);
    cases.push(finish("a violent step", 0.3, 0.0, 1.0));
    cases.push(finish("a calm step", 0.02, 0.0, 1.0));
    cases.push(finish("a larger pressure before", 0.8, 5.0, 1.0));
    cases.push(finish("a shortened step", 0.3, 0.0, 0.25));
    cases
}

/// Of a closed domain that is full of fluid.
pub fn full() -> Params {
    Params { clamp_pressure: 1, accepted_excess: 0.002, motion_stiffness: 400.0, ..params(2.0) }
}

/// The compressibility of the implicit pressure in a step.
pub fn compressibility(params: &Params, state: &StepState) -> f64 {
    let [weight, motion] = [params.compressibility, params.motion_stiffness].map(f64::from);
    let least = 0.01 * f64::from(params.particle_spacing) / f64::from(state.dt);
    let speed = f64::from(state.max_speed.max(state.body_speed)).max(least);
    let stiffness = if weight > 0.0 { 1.0 / weight } else { 0.0 } + motion * speed * speed;
    if stiffness > 0.0 { 1.0 / stiffness } else { 0.0 }
}

/// A state in the middle of a solve.
pub fn solving() -> SolveState {
    SolveState {
        stopped: 0,
        iteration: 2,
        beta: 0.7,
        relaxation: 0.5,
        change: 1e9,
        best: 0.3,
        warm_start: 1.0,
        scale: 1.0,
        renewal: 1.0,
        dt_ratio: 0.4,
        advanced_part: 1.0,
        mean_excess: 0.0,
    }
}

fn begin(name: &str, run_count: u32, dt: f32) -> Case {
    let mut world = world(Params { is_implicit: 1, relaxation: 0.3, ..params(2.5) });
    (world.state.run_count, world.state.dt) = (run_count, dt);
    (world.state.max_speed, world.state.body_speed) = (2.0, 5.0);
    let (n, c) = (world.len(), constants(&world));
    let pressures: Vec<f32> = (0..n).map(|i| 3.0 * signed(i, 0)).collect();
    let other = vectors(n, 4);
    let mut solve = Output::new("solve", Data::Solve(solving()).poison());
    let mut iterates = Output::new("iterates", poisoned(n));
    let mut free_velocities = Output::new("free_velocities", poisoned(n));
    // The fastest body moves by 0.3 spacings in 3 ms.
    let longest = 0.3 * f64::from(world.params.particle_spacing) / 5.0;
    let dt_ratio = (c.dt / longest).min(1.0);
    let expected = SolveState::new(run_count == 0, 0.3, dt_ratio as f32);
    // Only this ratio is rounded.
    for value in wide(Data::Solve(expected).floats()) {
        solve.push(value, if value == f64::from(expected.dt_ratio) { dt_ratio } else { 0.0 });
    }
    for i in 0..world.active() {
        iterates.push(pressures[i].into(), 0.0);
        (0..2).for_each(|_| iterates.push(0.0, 0.0));
        iterates.push(f64::from(world.densities[i].x) / c.rest - 1.0, 1.0);
        let v = speed(&world, i) + c.dt * other[i].xyz().as_dvec3();
        (0..3).for_each(|k| free_velocities.push(v[k], 1.0));
        free_velocities.push(other[i].w.into(), 0.0);
    }
    let mut input = base(&world);
    input.extend([
        Data::U32(world.cell_start.clone()),
        Data::Vec4(world.velocities.clone()),
        Data::F32(pressures),
        Data::Vec4(other),
        Data::Vec2(world.densities.clone()),
    ]);
    let outputs = vec![solve, iterates, free_velocities];
    let title = "implicit.begin".to_owned();
    if run_count == 0 {
        return case(title, name, n, input, outputs, |input| {
            let Data::State(state) = &mut input[2] else { panic!("no state") };
            state.run_count = 1500;
        });
    }
    case(title, name, n, input, outputs, |input| {
        let Data::State(state) = &mut input[2] else { panic!("no state") };
        state.dt *= 2.0;
    })
}

fn decide(name: &str, before: SolveState, scale: f32, motion: [f32; 2]) -> Case {
    decide_in(sums(), name, before, scale, motion)
}

/// What the sums over the particles contain.
struct Sums {
    params: Params,
    /// One sum of residuals is at least this.
    worst: f32,
    /// The largest sum of the squared changes of the velocity by the pressure.
    impulse: f32,
}

fn sums() -> Sums {
    Sums { params: params(2.0), worst: 0.0, impulse: 40.0 }
}

/// The mean square of the pressure is that of water `depth` spacings deep, which moves by `moved` spacings per step.
fn decide_in(
    Sums { params, worst, impulse }: Sums,
    name: &str,
    before: SolveState,
    scale: f32,
    [depth, moved]: [f32; 2],
) -> Case {
    let world = world(params);
    let groups = world.active().div_ceil(64);
    let mut residuals: Vec<Vec4> = vectors(groups, 0).iter().map(|v| scale * v.abs()).collect();
    residuals[groups / 2].x = residuals[groups / 2].x.max(worst);
    let layer = world.params.gravity.length() * world.params.particle_spacing;
    let n = world.active() as f32;
    let speed = moved * world.params.particle_spacing / world.state.dt;
    let impulses: Vec<Vec4> = (0..groups)
        .map(|i| {
            let share = n / groups as f32;
            let pressure2 = share * (layer * depth).powi(2) / 3.0;
            Vec4::new(impulse * signed(i, 8).abs(), pressure2, share * speed * speed, 0.0)
        })
        .collect();
    let impulse: f64 = impulses.iter().map(|v| f64::from(v.x)).sum();
    let total: Vec<f64> = (0..4).map(|k| residuals.iter().map(|v| f64::from(v[k])).sum()).collect();
    let n = world.active() as f64;
    let error = total[0] / n;
    let (mut state, mut solve) = (world.state, before);
    let mut counters = vec![5_u32; StepCounters::WORDS];
    if before.iteration == 0 {
        state.compression += (total[2] / n) as f32;
    }
    solve.iteration += 1;
    let accepted = f64::from(params.accepted_excess);
    let is_measuring = accepted > 0.0 && before.iteration == 0;
    let worst = residuals.iter().map(|sum| f64::from(sum.x)).fold(0.0, f64::max) / 64.0;
    let has_converged = error <= 0.001;
    let deep = if layer > 0.0 { f64::from(depth) } else { n.cbrt() }.max(5.0);
    let strictness = (5.0 / deep).powi(2).max(0.1 * f64::from(moved) / (deep * 0.001)).clamp(0.02, 1.0);
    if is_measuring {
        solve.mean_excess = (total[3] / n).min(accepted) as f32;
    } else if worst <= 0.005 && error <= 0.001 * strictness || solve.iteration == 5 {
        solve.stopped = 1;
        let squares: f64 = impulses.iter().map(|v| f64::from(v.y)).sum();
        let work = impulse + compressibility(&params, &world.state) * squares;
        solve.scale = ((1.0 + total[3] / work) as f32).clamp(0.5, 1.1);
        let moved = state.max_speed * state.dt / world.params.particle_spacing;
        let spent = solve.iteration - u32::from(accepted > 0.0);
        let late = strictness as f32 * (spent as f32 - 3.0) / 8.0;
        solve.renewal =
            if world.params.implicit_viscosity > 0.0 { 1.0 } else { moved.max(late).clamp(0.02, 1.0) };
        let displaced = (impulse / n).sqrt() * f64::from(state.dt) / f64::from(world.params.particle_spacing);
        if has_converged && displaced > 0.1 && world.params.implicit_viscosity == 0.0 {
            solve.advanced_part = (0.05 / displaced).max(0.1) as f32;
            state.dt *= solve.advanced_part;
        }
        state.iterations += solve.iteration;
        state.most_iterations = state.most_iterations.max(solve.iteration);
        state.residual = state.residual.max(error as f32);
        if !has_converged {
            solve.warm_start = 0.5;
            counters[StepCounters::UNCONVERGED] += 1;
            counters[StepCounters::SHORTEN] = 1;
        }
    } else {
        if error > 4.0 * f64::from(before.best) {
            (solve.relaxation, solve.beta, solve.best) = (0.25, 0.0, error as f32);
        } else {
            let restarts =
                solve.iteration == 1 + u32::from(accepted > 0.0) || total[1] > f64::from(before.change);
            solve.beta = if restarts { 0.0 } else { (total[1] / f64::from(before.change)) as f32 };
            solve.best = before.best.min(error as f32);
        }
        solve.change = total[1] as f32;
    }
    let mut outputs = vec![
        Output::new("state", Data::State(world.state)),
        Output::new("solve", Data::Solve(before)),
        Output::new("counters", Data::U32(vec![5; StepCounters::WORDS])),
    ];
    for (output, data) in
        outputs.iter_mut().zip([Data::State(state), Data::Solve(solve), Data::U32(counters)])
    {
        for value in wide(data.floats()) {
            output.push(value, value.abs());
        }
    }
    let mut input = vec![Data::Params(world.params), Data::Grid(world.grid)];
    input.extend([Data::U32(world.cell_start.clone()), Data::Vec4(residuals), Data::Vec4(impulses)]);
    case("implicit.decide".into(), name, 1, input, outputs, |input| {
        let Data::Vec4(residuals) = &mut input[3] else { panic!("no sums") };
        residuals.iter_mut().for_each(|sum| *sum *= 1.01);
        let Data::Vec4(impulses) = &mut input[4] else { panic!("no sums") };
        impulses.iter_mut().for_each(|sum| *sum *= 1.01);
    })
}

/// With the part of the new pressure in the mean, the largest pressure that was found before, and the length of the step over
/// the length that the pressure was solved for.
fn finish(name: &str, renewal: f32, before: f32, advanced_part: f32) -> Case {
    let world = world(params(2.0));
    let (n, dt) = (world.len(), f64::from(world.state.dt));
    let solve = SolveState { warm_start: 0.5, scale: 0.9, renewal, advanced_part, stopped: 1, ..solving() };
    let old: Vec<f32> = (0..n).map(|i| signed(i, 12)).collect();
    let predicted: Vec<Vec4> = vectors(n, 0)
        .iter()
        .enumerate()
        .map(|(i, v)| if i % 9 == 0 { v.with_w(SolveState::NO_PRESSURE) } else { *v })
        .collect();
    let other = vectors(n, 4);
    let mut after = Output::new("predicted", Data::Vec4(predicted.clone()));
    let mut accelerations = Output::new("accelerations", Data::Vec4(other.clone()));
    let mut densities = Output::new("densities", Data::Vec2(world.densities.clone()));
    let mut pressures = Output::new("pressures", Data::F32(vec![0.0; n]).poison());
    let mut words = vec![0; StepCounters::WORDS];
    words[StepCounters::MAX_PRESSURE] = before.to_bits();
    let mut counters = Output::new("counters", Data::U32(words));
    let mut largest = f64::from(before);
    for i in 0..n {
        if i >= world.active() {
            pressures.push(0.0, 0.0);
            continue;
        }
        let by_other = |dt: f64| speed(&world, i) + dt * other[i].xyz().as_dvec3();
        let part = f64::from(advanced_part);
        let solved = by_other(dt / part);
        let scale = f64::from(0.9_f32);
        let has_pressure = predicted[i].w != SolveState::NO_PRESSURE;
        let impulse =
            if has_pressure { scale * (predicted[i].xyz().as_dvec3() - solved) } else { DVec3::ZERO };
        let free = if has_pressure { by_other(dt) } else { solved };
        let u = free + impulse;
        let k = if has_pressure { scale * f64::from(predicted[i].w) / part } else { 0.0 };
        // The acceleration by the pressure alone, which bodies continue along their surface.
        let by_pressure = (u - free) / dt;
        (0..3).for_each(|axis| after.push(by_pressure[axis], 2.0 / dt));
        after.push(k, 1.0 / part);
        let a = (u - speed(&world, i)) / dt;
        (0..3).for_each(|k| accelerations.push(a[k], 2.0 / dt));
        accelerations.push(other[i].w.into(), 0.0);
        let rho = f64::from(world.densities[i].x);
        densities.push(rho, 0.0);
        densities.push(f64::from(0.9_f32) * k * rho * rho / 1000.0, k.abs() * 1000.0);
        let old = f64::from(old[i]);
        pressures.push(0.5 * (old + f64::from(renewal) * (k * part - old)), 1.0);
        largest = largest.max(old + f64::from(renewal.max(1.0 - renewal)) * (k - old));
    }
    for word in 0..StepCounters::WORDS {
        let is_largest = word == StepCounters::MAX_PRESSURE;
        counters.push(if is_largest { largest } else { 0.0 }, if is_largest { 1.0 } else { 0.0 });
    }
    let mut input = base(&world);
    input.extend([
        Data::Solve(solve),
        Data::U32(world.cell_start.clone()),
        Data::Vec4(world.velocities.clone()),
        Data::F32(old),
    ]);
    case(
        "implicit.finish".into(),
        name,
        n,
        input,
        vec![after, accelerations, densities, pressures, counters],
        |input| {
            let Data::Solve(solve) = &mut input[3] else { panic!("no state of the solver") };
            solve.warm_start = 0.501;
        },
    )
}
