//! The passes without neighbours: begin of a frame, end of a step, equation of state, time integration.

use glam::{DVec3, Vec2, Vec4, Vec4Swizzles};
use splashdown::cells::Grid;
use splashdown::state::{DEAD_ESCAPED, DEAD_NON_FINITE, Params, StepCounters, StepState};
use splashdown_gpu::{DispatchSize, testing};

use super::harness::{Case, Check, Compare, Data, close, exact, wide};
use super::oracle;
use super::sort_cases::{cell, pass, zero_cell_counts};
use super::world::{SPACING, World, params, state};

pub fn cases() -> Vec<Case> {
    let mut cases = vec![
        begin("a frame", 0.02, 5e-4, 0),
        begin("a frame of even steps", 0.0203, 5e-4, 1),
        begin("shorter than a step", 1e-5, 5e-4, 0),
        begin("a little longer than a step", 1.05e-4, 1e-4, 0),
        begin("of length zero", 0.0, 5e-4, 0),
        begin("limited by new parameters", 0.02, 0.1, 0),
        begin("of even steps, limited by new parameters", 0.9, 0.1, 1),
    ];
    cases.extend(end_step_cases());
    for (name, exponent, clamp_pressure) in [
        ("exponent 7", 7.0, 0),
        ("exponent 7, clamped", 7.0, 1),
        ("exponent 1", 1.0, 0),
        ("exponent 4.5", 4.5, 0),
    ] {
        cases.push(state_equation(name, Params { exponent, clamp_pressure, ..params(2.0) }));
    }
    let open = Params { closed: 0b110101, ..params(2.0) };
    cases.push(integrate("integrate", "closed", params(2.0), 0.01, true));
    cases.push(integrate("integrate", "open above and at one side", open, 0.01, true));
    cases.push(integrate("integrate", "the last step of a frame", params(2.0), 4e-4, false));
    cases.push(integrate("integrate.uncounted", "before births", open, 0.01, false));
    cases.push(integrate("shifted_integrate", "closed", params(2.0), 0.01, true));
    cases.push(integrate("shifted_integrate", "open above and at one side", open, 0.01, true));
    cases.push(integrate("shifted_integrate.uncounted", "before births", open, 0.01, false));
    cases
}

pub fn state_of(data: &Data) -> StepState {
    let Data::State(state) = data else { panic!("no state") };
    *state
}

/// Times, limits and maxima within a few roundings; counters exactly.
pub fn same_state(a: &StepState, b: &StepState) -> Result<(), String> {
    let counters = |s: &StepState| [s.done, s.run_count, s.steps, s.too_small];
    exact("done, run_count, steps, too_small", &counters(a), &counters(b))?;
    let floats = |s: &StepState| {
        [
            s.dt,
            s.stable_dt,
            s.time,
            s.remaining,
            s.max_speed,
            s.max_acceleration,
            s.density_error,
            s.frame_duration,
        ]
    };
    let expected = wide(&floats(b));
    // Five roundings; a GPU may compute square root and division less accurately.
    let tolerance: Vec<f64> = expected.iter().map(|v| 2e-6 * v.abs() + 1e-12).collect();
    close("dt, stable_dt, time, remaining, maxima, duration", &floats(a), &expected, &tolerance)
}

fn compare_states() -> Compare {
    Box::new(|a, b| {
        same_state(&state_of(&a[0]), &state_of(&b[0]))?;
        a.iter().zip(b).skip(1).try_for_each(|(a, b)| exact("counters", a.words(), b.words()))
    })
}

/// The speed of a body in m/s that limits the first step of a frame.
const BODY_SPEED: f32 = 70.0;

/// The frame starts 12.5 s after the run. `stable_dt` may be longer than the parameters allow: they may change between two
/// frames.
fn begin(name: &str, length: f32, stable_dt: f32, is_implicit: u32) -> Case {
    let params = Params { particle_count: 1234, is_implicit, ..params(2.0) };
    let old = StepState { done: 1, run_count: 0, steps: 77, stable_dt, ..state(1234) };
    let limits = limits(&params, old.max_speed.max(BODY_SPEED).into(), old.max_acceleration.into(), 0.0);
    let stable = limits.into_iter().fold(f64::from(stable_dt), f64::min) as f32;
    let expected = StepState {
        time: 12.5,
        frame_start: 12.5,
        body_speed: BODY_SPEED,
        stable_dt: stable,
        frame_duration: length,
        remaining: length,
        dt: match length {
            _ if length <= stable => length,
            _ if is_implicit == 1 => length / (length / stable).ceil(),
            _ if length < 2.0 * stable => 0.5 * length,
            _ => stable,
        },
        done: 0,
        run_count: 1234,
        steps: 0,
        density_error: 0.0,
        ..old
    };
    Case {
        pass: pass("begin"),
        name: name.into(),
        size: DispatchSize::Groups(1),
        input: vec![Data::Params(params), Data::F32(vec![length, 12.5, BODY_SPEED]), Data::State(old)],
        compare: compare_states(),
        oracle: Box::new(move |out| same_state(&state_of(&out[0]), &expected)),
        control: |input| {
            let Data::F32(times) = &mut input[1] else { panic!("no times") };
            times[0] = times[0] * 1.00001 + 1e-9;
        },
    }
}

fn end_step_cases() -> Vec<Case> {
    let state = state(100);
    let calm = [0.5, 10.0, 0.002, 0.0];
    let implicit = Params { is_implicit: 1, implicit_viscosity: 0.0, ..params(2.0) };
    let long = StepState { stable_dt: 5e-3, ..state };
    let large = Params { cfl_factor: 0.8, ..params(2.0) };
    let softer = Params { exponent: 5.0, ..large };
    let viscous = Params { implicit_viscosity: 0.02, ..implicit };
    let ways: [(&str, StepState, [f32; 4], Params); 17] = [
        ("grown by a tenth", StepState { stable_dt: 1e-4, ..state }, calm, params(2.0)),
        ("limited by sound", long, calm, params(2.0)),
        ("limited by compressed fluid", long, [0.5, 10.0, 0.2, 0.0], large),
        ("limited by compressed fluid, another exponent", long, [0.5, 10.0, 0.3, 0.0], softer),
        ("limited by acceleration", state, [0.5, 1e6, 0.0, 0.0], params(2.0)),
        ("limited by speed", state, [300.0, 10.0, 0.2, 0.0], Params { sound_speed: 0.1, ..params(2.0) }),
        ("limited by viscosity", state, calm, Params { viscosity: 5.0, ..params(2.0) }),
        ("below the smallest", state, [0.5, 1e9, 0.0, 0.0], Params { min_dt: 1e-5, ..params(2.0) }),
        ("implicit, grown by half", state, [0.5, 1e6, 0.0, 4.0], implicit),
        (
            "implicit, limited by a fast body",
            StepState { body_speed: 90.0, ..state },
            [0.5, 1e6, 0.0, 4.0],
            implicit,
        ),
        ("implicit, limited by the pressure", state, [0.5, 1e6, 0.0, 1e4], implicit),
        ("implicit and viscous, limited by the pressure", state, [0.5, 1e6, 0.0, 1e4], viscous),
        (
            "implicit, five even steps",
            StepState { remaining: 3.3e-3, ..state },
            [0.5, 1e6, 0.0, 4.0],
            implicit,
        ),
        ("implicit, the last", StepState { remaining: 6e-4, ..state }, [0.5, 1e6, 0.0, 4.0], implicit),
        ("two steps before the last", StepState { remaining: 1.3e-3, ..state }, calm, params(2.0)),
        ("before the last", StepState { remaining: 7e-4, ..state }, calm, params(2.0)),
        ("the last", StepState { remaining: 4e-4, ..state }, calm, params(2.0)),
    ];
    let mut cases: Vec<Case> =
        ways.map(|(name, state, maxima, params)| end_step(name, state, maxima, params)).into();
    // After a complete frame, or a step that has already ended, nothing changes. The control is a step that has not ended.
    let mut complete = end_step("complete", StepState { run_count: 0, done: 1, ..state }, calm, params(2.0));
    complete.control = |input| {
        let Data::U32(counters) = &mut input[2] else { panic!("no counters") };
        counters[StepCounters::MOVED] = 1;
    };
    cases.push(complete);
    // After iterations that did not converge, 0.7 times the step: the oracle lets it grow from a smaller one.
    let slow = StepState { dt: 3e-4, ..state };
    let equal = StepState { stable_dt: 0.7 / 1.5 * 3e-4, ..slow };
    let mut shortened = end_step("implicit, not converged", equal, [0.5, 1e6, 0.0, 4.0], implicit);
    shortened.input[1] = Data::State(slow);
    let Data::U32(counters) = &mut shortened.input[2] else { panic!("no counters") };
    counters[StepCounters::SHORTEN] = 1;
    cases.push(shortened);
    cases
}

/// The least limit of a step is that of the densest fluid, by a tenth and more.
#[test]
fn compressed_fluid_limits_the_steps_of_its_cases() {
    let large = Params { cfl_factor: 0.8, ..params(2.0) };
    for (exponent, excess) in [(7.0, 0.2), (5.0, 0.3)] {
        let least = |excess| {
            let limits = limits(&Params { exponent, ..large }, 0.5, 10.0, excess);
            limits.into_iter().fold(5.5e-3, f64::min)
        };
        assert!(least(excess) < 0.9 * least(0.0), "{exponent}: {} {}", least(excess), least(0.0));
    }
}

fn end_step(name: &str, state: StepState, maxima: [f32; 4], params: Params) -> Case {
    let mut left = vec![0; StepCounters::WORDS];
    left[..4].copy_from_slice(&[5, 6, 7, 8]);
    let mut counters = left.clone();
    counters[StepCounters::MOVED] = u32::from(state.run_count > 0);
    let words = [
        StepCounters::MAX_SPEED,
        StepCounters::MAX_ACCELERATION,
        StepCounters::MAX_EXCESS,
        StepCounters::MAX_PRESSURE,
    ];
    for (word, value) in words.into_iter().zip(maxima) {
        counters[word] = value.to_bits();
    }
    let (expected, left) = if state.run_count == 0 {
        (state, counters.clone())
    } else {
        (next_state(&params, &state, maxima.map(f64::from)), left)
    };
    let oracle: Check = Box::new(move |out| {
        same_state(&state_of(&out[0]), &expected)?;
        exact("counters", out[1].words(), &left)
    });
    Case {
        pass: pass("end_step"),
        name: name.into(),
        size: DispatchSize::Groups(1),
        input: vec![Data::Params(params), Data::State(state), Data::U32(counters)],
        compare: compare_states(),
        oracle,
        // A step that is longer or shorter by 1e-5.
        control: |input| {
            let Data::State(state) = &mut input[1] else { panic!("no state") };
            state.dt *= 1.00001;
            state.frame_start *= 1.00001;
        },
    }
}

/// The limits of Monaghan and Morris in s, in f64, without that by the pressure.
fn limits(params: &Params, speed: f64, acceleration: f64, excess: f64) -> Vec<f64> {
    let p = |value: f32| f64::from(value);
    let (h, factor) = (0.5 * p(params.support_radius), p(params.cfl_factor));
    let common = [p(params.max_dt), 0.125 * h * h / p(params.viscosity)];
    let by_motion = if params.is_implicit == 1 {
        vec![factor * p(params.particle_spacing) / speed]
    } else {
        vec![
            factor * h / (p(params.sound_speed) + speed),
            factor.max(0.9) * h
                / (p(params.sound_speed) * (1.0 + excess).powf(0.5 * (p(params.exponent) - 1.0)) + speed),
            factor * (h / acceleration).sqrt(),
            factor * 0.4 * p(params.particle_spacing) / speed,
            0.17 * h / (p(params.density_diffusion) * p(params.sound_speed)),
        ]
    };
    common.into_iter().chain(by_motion).collect()
}

/// The state after a step, in f64.
pub fn next_state(
    params: &Params,
    state: &StepState,
    [speed, acceleration, excess, pressure]: [f64; 4],
) -> StepState {
    let p = |value: f32| f64::from(value);
    // Of x'' = -w^2 x - g x' with implicit damping: dt^2 w^2 = 4 + 2 g dt, where 2 / w is the limit without damping.
    let undamped = 0.5 * p(params.particle_spacing) / pressure.sqrt();
    let rate = 3.0 * p(params.implicit_viscosity) / p(params.particle_spacing).powi(2);
    let half = 0.25 * rate * undamped * undamped;
    let grown = if params.is_implicit == 1 {
        (1.5 * p(state.stable_dt)).min(half + (half * half + undamped * undamped).sqrt())
    } else {
        1.1 * p(state.stable_dt)
    };
    let fastest = speed.max(p(state.body_speed));
    let least = limits(params, fastest, acceleration, excess).into_iter().fold(grown, f64::min);
    let stable = least.max(p(params.min_dt));
    // In the same order as the pass: the remaining time is a difference, and another rounding would change it.
    let complete = state.dt >= state.remaining;
    let remaining = if complete { 0.0 } else { state.remaining - state.dt };
    let dt = match p(remaining) {
        _ if complete => p(state.dt),
        // As few equal steps as the limit allows.
        left if params.is_implicit == 1 => {
            (1..).map(|n| left / f64::from(n)).find(|dt| *dt <= 1.05 * stable).unwrap()
        }
        left if left <= stable => left,
        left if left < 2.0 * stable => 0.5 * left,
        _ => stable,
    };
    StepState {
        dt: dt as f32,
        stable_dt: stable as f32,
        time: state.frame_start + (state.frame_duration - remaining),
        remaining,
        done: u32::from(complete),
        run_count: if complete { 0 } else { state.run_count },
        steps: state.steps + 1,
        too_small: u32::from(least < p(params.min_dt)),
        max_speed: speed as f32,
        max_acceleration: acceleration as f32,
        density_error: state.density_error.max(excess as f32),
        ..*state
    }
}

fn state_equation(name: &str, params: Params) -> Case {
    let world = World::new(params, 500);
    let n = world.len();
    // (rho / rho0)^exponent has a few roundings, and rho0 c0^2 / exponent scales them to Pa.
    let stiffness = f64::from(params.rest_density * params.sound_speed * params.sound_speed);
    let expected: Vec<f64> = world
        .velocities
        .iter()
        .flat_map(|v| [f64::from(v.w), oracle::pressure(&world, f64::from(v.w))])
        .collect();
    let tolerance: Vec<f64> = (0..n).flat_map(|_| [0.0, 3e-6 * stiffness]).collect();
    let (for_oracle, for_both) = (tolerance.clone(), tolerance);
    Case {
        pass: pass("state_equation"),
        name: name.into(),
        size: DispatchSize::Items(n as u32),
        input: vec![
            Data::Params(params),
            Data::State(state(n)),
            Data::Vec4(world.velocities.clone()),
            Data::Vec2(vec![Vec2::ZERO; n]).poison(),
        ],
        compare: Box::new(move |a, b| close("densities", a[0].floats(), &wide(b[0].floats()), &for_both)),
        oracle: Box::new(move |out| close("densities", out[0].floats(), &expected, &for_oracle)),
        control: |input| input[0].params().sound_speed *= 1.001,
    }
}

/// Positions within two roundings; velocities within these divided by the step, because contacts divide by it.
fn motion_tolerance(dt: f64, velocities: &[f64]) -> (f64, Vec<f64>) {
    let position = 1.3e-7;
    (position, velocities.iter().map(|v| position / dt + 1e-5 * v.abs()).collect())
}

fn same_motion(
    out: &[Data],
    positions: &[f64],
    velocities: &[f64],
    expected_counters: &[u32],
) -> Result<(), String> {
    let (position, velocity) = motion_tolerance(4e-4, velocities);
    close("positions", out[0].floats(), positions, &vec![position; positions.len()])?;
    close("velocities", out[1].floats(), velocities, &velocity)?;
    let (counts, maxima) = out[2].words().split_at(StepCounters::MAX_SPEED);
    exact("counters", counts, &expected_counters[..StepCounters::MAX_SPEED])?;
    let floats = |words: &[u32]| words.iter().map(|&w| f32::from_bits(w)).collect::<Vec<f32>>();
    let expected = wide(&floats(&expected_counters[StepCounters::MAX_SPEED..]));
    let tolerance: Vec<f64> = expected.iter().map(|v| 1e-5 * v).collect();
    close("maxima", &floats(maxima), &expected, &tolerance)
}

/// `counts`: whether the pass counts the particles for the next step.
fn integrate(label: &str, name: &str, params: Params, remaining: f32, counts: bool) -> Case {
    let mut world = World::new(params, 1500);
    let (active, n) = (world.active(), world.len());
    let signed = |i: usize| testing::noise(i as u32 + 9) as f32 / (u32::MAX / 2) as f32 - 1.0;
    let mut accelerations: Vec<Vec4> =
        (0..n).map(|i| 50.0 * Vec4::new(signed(3 * i), signed(3 * i + 1), signed(3 * i + 2), 0.0)).collect();
    for (i, a) in accelerations.iter_mut().enumerate().take(active) {
        match i % 50 {
            // Faster than half a spacing per step, some by orders of magnitude.
            7 => world.velocities[i].x = 80.0 * signed(i),
            8 => a.y = 1e7 * signed(i),
            // Held by a nozzle: not shifted.
            9 => a.w = 1.0,
            // Particles that must be removed.
            21 if i % 100 < 50 => a.z = f32::NAN,
            21 => a.x = f32::INFINITY,
            // Slightly behind a closed wall, or through an open side.
            33 => world.positions[i].x = params.domain_min.x - 1e-3,
            34 => world.positions[i].y = params.domain_max.y + 2e-3,
            _ => {}
        }
    }
    let grid = world.grid;
    let cell_counts = zero_cell_counts(&grid, n);
    let is_shifted = label.starts_with("shifted");
    let size = if is_shifted { 0.5 } else { 0.0 };
    let shifts: Vec<Vec4> = (0..n)
        .map(|i| {
            // Some exceed a tenth of a spacing per step.
            let size = if i % 5 == 0 { 60.0 * size } else { size };
            [3 * i, 3 * i + 1, 3 * i + 2].map(|k| size * signed(k + 17))
        })
        .zip(&world.densities)
        .map(|([x, y, z], density)| Vec4::new(x, y, z, density.x))
        .collect();
    let input = vec![
        Data::Params(params),
        Data::Grid(grid),
        Data::State(StepState { remaining, ..world.state }),
        Data::Vec4(world.positions.clone()),
        Data::Vec4(world.velocities.clone()),
        if is_shifted { Data::Vec4(shifts.clone()) } else { Data::Vec2(world.densities.clone()) },
        Data::Vec4(accelerations.clone()),
        Data::Vec4(vec![Vec4::ZERO; n]).poison(),
        Data::Vec4(vec![Vec4::ZERO; n]).poison(),
        Data::U32(vec![0, 3, 1, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0]),
        Data::U32(cell_counts.clone()),
    ];
    let (positions, velocities, counters) = moved(&world, &accelerations, &shifts);
    assert!((1..4).all(|k| counters[k] > 5) || params.closed != 0b111111, "{counters:?}");
    Case {
        pass: pass(label),
        name: name.into(),
        size: DispatchSize::Items(n as u32),
        input,
        compare: Box::new(|a, b| same_motion(a, &wide(b[0].floats()), &wide(b[1].floats()), b[2].words())),
        oracle: Box::new(move |out| {
            same_motion(out, &positions, &velocities, &counters)?;
            let expected = if counts { cell_counts_of(&grid, &out[0]) } else { cell_counts.clone() };
            exact("cell_counts", out[3].words(), &expected)
        }),
        // One particle has a slightly larger acceleration.
        control: |input| {
            let Data::Vec4(accelerations) = &mut input[6] else { panic!("no accelerations") };
            accelerations[100].y += 4.0;
            accelerations[101].y -= 4.0;
        },
    }
}

/// The cell counts of particles at the positions that a pass wrote.
pub fn cell_counts_of(grid: &Grid, positions: &Data) -> Vec<u32> {
    let Data::Vec4(positions) = positions else { panic!("no positions") };
    let mut counts = vec![0; grid.cell_count as usize + 1];
    let mut cells = Vec::new();
    for p in positions {
        let at = if p.w == 0.0 { cell(grid, p.xyz()) } else { grid.cell_count };
        counts[at as usize] += 1;
        cells.push(at);
    }
    counts.extend(cells);
    counts
}

/// Symplectic Euler with its limits, for each particle in f64.
fn moved(world: &World, accelerations: &[Vec4], shifts: &[Vec4]) -> (Vec<f64>, Vec<f64>, Vec<u32>) {
    let (params, dt) = (&world.params, f64::from(world.state.dt));
    let (min, max) = (params.domain_min.as_dvec3(), params.domain_max.as_dvec3());
    let closed = |axis: usize, side: usize| params.closed >> (2 * axis + side) & 1 == 1;
    let (mut positions, mut velocities) = (Vec::new(), Vec::new());
    let mut counters = [0, 3, 1, 2, 0, 0, 0, 0, 1, 0, 0, 0, 0];
    let mut highest = [0.0_f64; 3];
    for (i, &p) in world.positions.iter().enumerate() {
        let (old, a) = (world.velocities[i], accelerations[i].xyz().as_dvec3());
        let rho = f64::from(world.densities[i].x);
        if p.w != 0.0 {
            positions.extend(wide(&p.to_array()));
            velocities.extend(wide(&old.to_array()));
            continue;
        }
        let x = p.xyz().as_dvec3();
        let mut v = old.xyz().as_dvec3() + dt * a;
        let most = 0.5 * f64::from(SPACING) / dt;
        if v.length() > most {
            v *= most / v.length();
            counters[StepCounters::LIMITED] += 1;
        }
        if !a.is_finite() {
            counters[StepCounters::NON_FINITE] += 1;
            positions.extend(wide(&p.xyz().extend(DEAD_NON_FINITE).to_array()));
            velocities.extend([0.0, 0.0, 0.0, f64::from(params.rest_density)]);
            continue;
        }
        // Not closer to a closed side than a quarter of a spacing; particles that are closer may not approach it.
        let near = 0.25 * f64::from(SPACING);
        let shift = if accelerations[i].w == 0.0 { shifts[i].xyz().as_dvec3() } else { DVec3::ZERO };
        let mut motion = v + shift.clamp_length_max(0.1 * f64::from(SPACING) / dt);
        for axis in 0..3 {
            for v in [&mut v[axis], &mut motion[axis]] {
                if closed(axis, 0) {
                    *v = v.max(-(x[axis] - min[axis] - near).max(0.0) / dt);
                }
                if closed(axis, 1) {
                    *v = v.min((max[axis] - x[axis] - near).max(0.0) / dt);
                }
            }
        }
        let mut next = x + dt * motion;
        for axis in 0..3 {
            if (closed(axis, 0) && next[axis] < min[axis]) || (closed(axis, 1) && next[axis] > max[axis]) {
                next[axis] = next[axis].clamp(min[axis], max[axis]);
                v[axis] = 0.0;
                counters[StepCounters::CORRECTIONS] += 1;
            }
        }
        let excess = (rho / f64::from(params.rest_density) - 1.0).max(0.0);
        for (highest, value) in highest.iter_mut().zip([v.length(), a.length(), excess]) {
            *highest = highest.max(value);
        }
        let push = |out: &mut Vec<f64>, v: DVec3, w: f64| out.extend([v.x, v.y, v.z, w]);
        let escaped = next.cmplt(min).any() || next.cmpgt(max).any();
        counters[StepCounters::ESCAPED] += u32::from(escaped);
        push(&mut positions, next, if escaped { f64::from(DEAD_ESCAPED) } else { 0.0 });
        push(&mut velocities, v, rho);
    }
    for (k, value) in highest.iter().enumerate() {
        counters[StepCounters::MAX_SPEED + k] = (*value as f32).to_bits();
    }
    (positions, velocities, counters.to_vec())
}
