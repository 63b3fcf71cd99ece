//! The passes of the implicit pressure, on random clouds.

use glam::{DVec3, Vec2, Vec3, Vec4, Vec4Swizzles};
use splashdown::state::{Params, SolveState, StepCounters};
use splashdown_gpu::{DispatchSize, testing};

use super::harness::{Case, Data, close, wide};
use super::neighbour_lists;
use super::oracle::{self, Kernel, Parts, constants, neighbours, speed};
use super::sort_cases::pass;
use super::world::{World, params};

/// As for the other sums over neighbours.
const ROUNDING: f64 = 2e-5;

const KERNELS: [(Kernel, &str); 3] = [
    (Kernel::WendlandC2, "wendland_c2"),
    (Kernel::WendlandBlend, "wendland_blend"),
    (Kernel::CubicSpline, "cubic_spline"),
];

pub fn cases() -> Vec<Case> {
    // Without tension.
    let open = Params {
        closed: 0b110111,
        artificial_viscosity: 0.0,
        clamp_pressure: 1,
        tolerance: 0.003,
        ..params(2.5)
    };
    let mut cases = Vec::new();
    for (kernel, word) in KERNELS {
        for (name, params) in [("closed", params(2.0)), ("wider support, open above", open)] {
            cases.push(system(name, kernel, word, params));
            for bodies in [false, true] {
                cases.push(predict(name, kernel, word, params, bodies));
                cases.push(residual(name, kernel, word, params, bodies));
            }
        }
    }
    cases.push(begin("a step", 1500, 4e-4));
    cases.push(begin("the longest step", 1500, 4e-3));
    cases.push(begin("after the frame", 0, 4e-4));
    let viscous = Params { implicit_viscosity: 0.02, ..params(2.0) };
    let weightless = Params { gravity: Vec3::ZERO, compressibility: 0.0, ..params(2.0) };
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
        decide_in(viscous, 0.0, "converged in a viscous fluid", solving(), 0.1, [5.0, 0.01]),
        decide_in(params(2.0), 0.4, "an excess in one part", solving(), 0.01, [5.0, 0.01]),
        decide_in(params(2.0), 0.3, "the largest accepted excess in one part", solving(), 0.01, [5.0, 0.01]),
        decide_in(params(2.0), 0.4, "the last iteration with an excess in one part", last, 0.01, [5.0, 0.01]),
        decide_in(weightless, 0.0, "without gravity", solving(), 0.1, [5.0, 0.001]),
    ]);
    cases.push(finish("a violent step", 0.3, 0.0));
    cases.push(finish("a calm step", 0.02, 0.0));
    cases.push(finish("a larger pressure before", 0.8, 5.0));
    cases
}

/// A state in the middle of a solve.
fn solving() -> SolveState {
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
        unused: 0.0,
        unused_2: 0.0,
    }
}

/// Numbers in [-1, 1].
pub(super) fn signed(i: usize, k: usize) -> f32 {
    2.0 * (testing::noise((16 * i + k) as u32 + 9_000_000) as f32 / u32::MAX as f32) - 1.0
}

pub(super) fn vectors(n: usize, k: usize) -> Vec<Vec4> {
    (0..n).map(|i| Vec4::new(signed(i, k), signed(i, k + 1), signed(i, k + 2), signed(i, k + 3))).collect()
}

/// The written bindings: name, expected values, tolerances, and the content before the pass.
pub(super) struct Output {
    pub name: &'static str,
    pub values: Vec<f64>,
    pub tolerances: Vec<f64>,
    pub before: Data,
}

impl Output {
    pub fn new(name: &'static str, before: Data) -> Self {
        Self { name, values: Vec::new(), tolerances: Vec::new(), before }
    }

    /// One number, and the magnitude of its terms.
    pub fn push(&mut self, value: f64, size: f64) {
        self.values.push(value);
        self.tolerances.push(ROUNDING * size);
    }
}

pub(super) fn case(
    label: String,
    name: &str,
    items: usize,
    mut input: Vec<Data>,
    outputs: Vec<Output>,
    control: fn(&mut [Data]),
) -> Case {
    let mut expected = Vec::new();
    for Output { name, mut values, mut tolerances, before } in outputs {
        // What the pass does not write keeps its content.
        let rest = wide(&before.floats()[values.len()..]);
        tolerances.resize(tolerances.len() + rest.len(), 0.0);
        values.extend(rest);
        input.push(before);
        expected.push((name, values, tolerances));
    }
    let tolerances: Vec<_> =
        expected.iter().map(|(name, _, tolerances)| (*name, tolerances.clone())).collect();
    Case {
        pass: pass(&label),
        name: name.into(),
        size: DispatchSize::Items(items as u32),
        input,
        compare: Box::new(move |a, b| {
            for ((a, b), (name, tolerances)) in a.iter().zip(b).zip(&tolerances) {
                close(name, a.floats(), &wide(b.floats()), tolerances)?;
            }
            Ok(())
        }),
        oracle: Box::new(move |out| {
            for (out, (name, values, tolerances)) in out.iter().zip(&expected) {
                close(name, out.floats(), values, tolerances)?;
            }
            Ok(())
        }),
        control,
    }
}

/// A mass that is wrong by 1/500.
fn heavier(input: &mut [Data]) {
    input[0].params().summed_mass *= 1.002;
}

pub(super) fn base(world: &World) -> Vec<Data> {
    vec![Data::Params(world.params), Data::Grid(world.grid), Data::State(world.state)]
}

/// The lists of neighbours. With wide supports those of most particles contain the rows of candidates.
pub(super) fn lists(world: &World) -> Data {
    let layers = if world.params.support_radius > 2.2 * world.params.particle_spacing { 12 } else { 60 };
    Data::UVec4(neighbour_lists::lists(world, layers))
}

pub(super) fn poisoned(n: usize) -> Data {
    Data::Vec4(vec![Vec4::ZERO; n]).poison()
}

pub(super) fn world(params: Params) -> World {
    World::new(params, 1500)
}

/// Closed sides within the support radius, with the rounding of the pass.
fn sides_near(params: &Params, x: Vec3) -> u32 {
    let near = |distance: f32, bit: u32| params.closed >> bit & 1 == 1 && distance < params.support_radius;
    (0..3)
        .map(|axis| {
            let (low, high) = (x[axis] - params.domain_min[axis], params.domain_max[axis] - x[axis]);
            u32::from(near(low, 2 * axis as u32)) + u32::from(near(high, 2 * axis as u32 + 1))
        })
        .sum()
}

fn system(name: &str, kernel: Kernel, word: &str, params: Params) -> Case {
    let world = world(params);
    let (n, c) = (world.len(), constants(&world));
    let mut densities = Output::new("densities", Data::Vec2(vec![Vec2::ZERO; n]).poison());
    let mut accelerations = Output::new("accelerations", poisoned(n));
    let mut stiffness = Output::new("stiffness", poisoned(n));
    let volume = c.mass / c.rest;
    let forces = oracle::acceleration(&world, kernel, Parts { pressure: false, other: true });
    for (i, rho) in oracle::density(&world, kernel).into_iter().enumerate() {
        densities.push(rho, rho);
        densities.push(0.0, 0.0);
        (0..3).for_each(|k| accelerations.push(forces[i].value[k], forces[i].size));
        accelerations.push(0.0, 0.0);
        let (mut sum, mut size, mut squares) = (DVec3::ZERO, 0.0, 0.0);
        neighbours(&world, i, |_, d, _, _| {
            let g = volume * kernel.gradient(d, c.support);
            sum += g;
            size += g.length();
            squares += g.length_squared();
        });
        (0..3).for_each(|k| stiffness.push(sum[k], size));
        let factor = 1.0 + f64::from(sides_near(&world.params, world.positions[i].xyz())) / 3.0;
        stiffness.push(factor * squares, factor * squares);
    }
    let mut input = base(&world);
    input.extend([
        Data::U32(world.cell_start.clone()),
        Data::Vec4(world.positions.clone()),
        lists(&world),
        Data::Vec4(world.velocities.clone()),
    ]);
    let outputs = vec![densities, accelerations, stiffness];
    case(format!("implicit.system.{word}"), name, n, input, outputs, heavier)
}

fn suffix(bodies: bool) -> &'static str {
    if bodies { ".bodies" } else { "" }
}

fn predict(name: &str, kernel: Kernel, word: &str, params: Params, bodies: bool) -> Case {
    let world = world(params);
    let (n, c) = (world.len(), constants(&world));
    let solve = solving();
    let limit = f64::from(world.params.tension_limit());
    // A third is under tension, partly above the limit.
    let iterates: Vec<Vec4> = vectors(n, 0)
        .iter()
        .enumerate()
        .map(|(i, v)| v.with_x(if i % 3 == 0 { -limit as f32 * v.x.abs() } else { 2.0 * v.x.abs() }))
        .collect();
    let free_velocities: Vec<Vec4> = vectors(n, 4)
        .iter()
        .enumerate()
        .map(|(i, v)| v.with_w(if i % 11 == 0 { 1.0 } else { 0.0 }))
        .collect();
    let solid: Vec<Vec4> = vectors(n, 8).iter().map(|v| 20.0 * *v).collect();
    let pressure = |j: usize| {
        let least = if iterates[j].x < 0.0 { -limit } else { 0.0 };
        (f64::from(iterates[j].x) + f64::from(0.7_f32) * f64::from(iterates[j].y)).max(least)
    };
    let mut predicted = Output::new("predicted", poisoned(n));
    let groups = world.active().div_ceil(64);
    let mut impulses = Output::new("impulses", Data::Vec4(vec![Vec4::ZERO; groups]).poison());
    let mut squares = vec![(0.0, 0.0); groups];
    let mut pressures = vec![0.0_f64; groups];
    let mut speeds = vec![(0.0, 0.0); groups];
    for i in 0..world.active() {
        let v = free_velocities[i].xyz().as_dvec3();
        if free_velocities[i].w == 1.0 {
            (0..3).for_each(|k| predicted.push(v[k], 1.0));
            predicted.push(SolveState::NO_PRESSURE.into(), 0.0);
            speeds[i / 64].0 += v.length_squared();
            speeds[i / 64].1 += 2.0 * v.length() * (v.length() + 0.1);
            continue;
        }
        let (mut q, mut size) = (DVec3::ZERO, 0.0);
        neighbours(&world, i, |j, d, _, _| {
            let term = (pressure(i) + pressure(j)) * c.mass / c.rest * kernel.gradient(d, c.support);
            q += term;
            size += term.length();
        });
        if bodies {
            let term = pressure(i) * solid[i].xyz().as_dvec3();
            q += term;
            size += term.length();
        }
        let u = v - c.dt * q;
        (0..3).for_each(|k| predicted.push(u[k], v.length() + 0.1 + c.dt * size));
        predicted.push(pressure(i), 1.0);
        pressures[i / 64] += pressure(i).powi(2);
        speeds[i / 64].0 += u.length_squared();
        speeds[i / 64].1 += 2.0 * u.length() * (v.length() + 0.1 + c.dt * size);
        squares[i / 64].0 += c.dt * c.dt * q.length_squared();
        // The CPU takes the change as a difference of velocities.
        squares[i / 64].1 += 2.0 * c.dt * q.length() * (v.length() + 0.1 + c.dt * size);
    }
    for group in 0..groups {
        impulses.push(squares[group].0, squares[group].1);
        impulses.push(pressures[group], pressures[group]);
        impulses.push(speeds[group].0, speeds[group].1);
        impulses.push(0.0, 0.0);
    }
    let mut input = base(&world);
    input.extend([
        Data::Solve(solve),
        Data::U32(world.cell_start.clone()),
        Data::Vec4(world.positions.clone()),
        lists(&world),
        Data::Vec4(free_velocities.clone()),
        Data::Vec4(if bodies { solid.clone() } else { vec![Vec4::NAN] }),
        Data::Vec4(iterates.clone()),
    ]);
    let label = format!("implicit.predict.{word}{}", suffix(bodies));
    // The velocities hide a small change of the mass: a factor of the next direction that is wrong by a hundredth.
    case(label, name, n, input, vec![predicted, impulses], |input| {
        let Data::Solve(solve) = &mut input[3] else { panic!("no state of the solver") };
        solve.beta *= 1.01;
    })
}

fn residual(name: &str, kernel: Kernel, word: &str, params: Params, bodies: bool) -> Case {
    let world = world(params);
    let (n, c) = (world.len(), constants(&world));
    let solve = solving();
    let limit = world.params.tension_limit();
    let predicted: Vec<Vec4> = vectors(n, 0)
        .iter()
        .enumerate()
        .map(|(i, v)| {
            v.with_w(match i % 13 {
                0 => SolveState::NO_PRESSURE,
                // Tension within the limit and above it.
                1..=3 => -limit * v.w.abs(),
                4 => -1.5 * limit,
                _ => (2.0 * v.w).max(0.0),
            })
        })
        .collect();
    // Some of the gradients times the support are below the threshold of the free surface, some above.
    let stiffness: Vec<Vec4> = vectors(n, 4).iter().map(|v| (6.0 * *v).with_w(400.0 * (1.1 + v.w))).collect();
    // Half of the particles are next to a body.
    let solid: Vec<Vec4> = vectors(n, 8).iter().enumerate().map(|(i, v)| 6.0 * (i % 2) as f32 * *v).collect();
    // With an excess of density as the fourth component: deficits around 2 %, larger ones, and those of spray.
    let excess = |i: usize, w: f32| [0.1 * w, 0.03 * w, -0.3 + 0.1 * w][i % 3];
    let before: Vec<Vec4> =
        vectors(n, 12).iter().enumerate().map(|(i, v)| v.with_w(excess(i, v.w))).collect();
    // Particles that may be under tension, and those among them with a deficit.
    let mut inside = [0, 0];
    // Particles with an excess that the step does not remove.
    let mut larger = 0;
    let label = format!("implicit.residual.{word}{}", suffix(bodies));
    let mut iterates = Output::new("iterates", Data::Vec4(before.clone()));
    let mut residuals = Output::new("residuals", poisoned(n.div_ceil(64)));
    let mut sums = vec![([0.0; 4], [0.0; 4]); n.div_ceil(64)];
    for i in 0..world.active() {
        let excess = f64::from(before[i].w);
        let (u, k) = (predicted[i].xyz().as_dvec3(), f64::from(predicted[i].w));
        let (values, sizes) = &mut sums[i / 64];
        values[2] += excess.max(0.0);
        sizes[2] += 1.0;
        if predicted[i].w == SolveState::NO_PRESSURE {
            (0..3).for_each(|_| iterates.push(0.0, 0.0));
            iterates.push(excess, 0.0);
            continue;
        }
        let (mut rate, mut size) = (0.0, 0.0);
        neighbours(&world, i, |j, d, by, _| {
            let other = by.sign * predicted[j].xyz().as_dvec3();
            let g = c.mass / c.rest * kernel.gradient(d, c.support);
            rate += g.dot(u - other);
            size += g.length() * (u.length() + other.length());
        });
        let mut gradient = stiffness[i].xyz().as_dvec3();
        let mut normal = gradient;
        if bodies {
            let b = solid[i].xyz().as_dvec3();
            rate += b.dot(u) - f64::from(solid[i].w);
            size += b.length() * u.length() + f64::from(solid[i].w).abs();
            gradient += b;
            normal += b / 2.0;
        }
        let steepness = (c.support * normal.length() - 0.3).max(0.0);
        let missing = f64::from(world.params.surface_completion) * steepness.powf(1.5);
        let dt_ratio = f64::from(solve.dt_ratio);
        let least = 0.002_f64.max(2.0 * f64::from(world.params.tolerance));
        let removed = excess.min(least + 0.05 * dt_ratio * dt_ratio);
        larger += usize::from(removed < excess);
        let complete = removed + missing.min((0.02 * dt_ratio - excess).max(0.0));
        let compressibility = f64::from(world.params.compressibility);
        let is_inside = limit > 0.0
            && complete > -0.3
            && c.support * normal.length() < 0.7
            && (!bodies || solid[i] == Vec4::ZERO);
        let (mut least, mut pushed, mut pulled) = (0.0, complete, complete);
        if is_inside {
            (least, inside[0]) = (f64::from(-limit), inside[0] + 1);
            if complete < 0.0 {
                let closing = (2.0 * f64::from(world.params.gravity.length())
                    / f64::from(world.params.particle_spacing))
                .sqrt()
                    * c.dt;
                (pulled, inside[1]) = ((closing * complete).max(complete), inside[1] + 1);
                pushed = pulled.min(complete + 0.02);
            }
        }
        let change = c.dt * rate - compressibility * k;
        let r = match k {
            k if k > 0.0 => pushed + change,
            k if k < 0.0 => pulled + change,
            _ if pushed + change > 0.0 => pushed + change,
            _ => (pulled + change).min(0.0),
        };
        let r_size = 1.0 + c.dt * size;
        let diagonal =
            c.dt * c.dt * (gradient.length_squared() + f64::from(stiffness[i].w)) + compressibility;
        let [above, below] = [pushed, pulled].map(|excess| k + 0.5 * (excess + change) / diagonal);
        let next = if above > 0.0 { above } else { below.clamp(least, 0.0) };
        let step_size = k.abs() + 0.5 * r_size / diagonal;
        iterates.push(next, step_size);
        iterates.push(f64::from(0.7_f32) * f64::from(before[i].y) + f64::from(before[i].z), 2.0);
        iterates.push(next - k, step_size);
        iterates.push(excess, 0.0);
        let error = if k > least { r.abs() } else { r.max(diagonal * (least - k)) };
        values[0] += error;
        sizes[0] += r_size + diagonal * (least - k).max(0.0);
        values[3] += if error > 0.0 { k * r } else { 0.0 };
        sizes[3] += k.abs() * r_size;
        values[1] += diagonal * (next - k) * (next - k);
        sizes[1] += 2.0 * diagonal * (next - k).abs() * step_size;
    }
    for (values, sizes) in &sums[..world.active().div_ceil(64)] {
        (0..4).for_each(|k| residuals.push(values[k], sizes[k]));
    }
    let some = if limit > 0.0 { 20 } else { 0 };
    assert!(larger > 20, "{label}, {name}: {larger} with a large excess");
    assert!(inside[0] >= 2 * some && inside[1] >= some, "{label}, {name}: {inside:?} inside");
    let mut input = base(&world);
    input.extend([
        Data::Solve(solve),
        Data::U32(world.cell_start.clone()),
        Data::Vec4(world.positions.clone()),
        lists(&world),
        Data::Vec4(stiffness),
        Data::Vec4(if bodies { solid } else { vec![Vec4::NAN] }),
        Data::Vec4(predicted),
    ]);
    // A workgroup behind the active particles writes sums of zero on a GPU, which nothing reads.
    residuals.before = match residuals.before {
        Data::Vec4(all) => Data::Vec4(all[..world.active().div_ceil(64)].to_vec()),
        other => other,
    };
    case(label, name, n, input, vec![iterates, residuals], |input| {
        let Data::Params(params) = &mut input[0] else { panic!("no constants") };
        params.surface_completion *= 1.1;
    })
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
    decide_in(params(2.0), 0.0, name, before, scale, motion)
}

/// The mean square of the pressure is that of water `depth` spacings deep, which moves by `moved` spacings per step. One sum
/// of residuals is at least `worst`.
fn decide_in(
    params: Params,
    worst: f32,
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
            Vec4::new(40.0 * signed(i, 8).abs(), pressure2, share * speed * speed, 0.0)
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
    let worst = residuals.iter().map(|sum| f64::from(sum.x)).fold(0.0, f64::max) / 64.0;
    let has_converged = error <= 0.001;
    let deep = if layer > 0.0 { f64::from(depth) } else { n.cbrt() }.max(5.0);
    let strictness = (5.0 / deep).powi(2).max(0.1 * f64::from(moved) / (deep * 0.001)).clamp(0.02, 1.0);
    if worst <= 0.005 && error <= 0.001 * strictness || solve.iteration == 5 {
        solve.stopped = 1;
        let squares: f64 = impulses.iter().map(|v| f64::from(v.y)).sum();
        let work = impulse + f64::from(world.params.compressibility) * squares;
        solve.scale = ((1.0 + total[3] / work) as f32).clamp(0.5, 1.1);
        let moved = state.max_speed * state.dt / world.params.particle_spacing;
        let late = strictness as f32 * (solve.iteration as f32 - 3.0) / 8.0;
        solve.renewal =
            if world.params.implicit_viscosity > 0.0 { 1.0 } else { moved.max(late).clamp(0.02, 1.0) };
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
            let restarts = solve.iteration == 1 || total[1] > f64::from(before.change);
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
    })
}

/// With the part of the new pressure in the mean, and the largest pressure that was found before.
fn finish(name: &str, renewal: f32, before: f32) -> Case {
    let world = world(params(2.0));
    let (n, dt) = (world.len(), f64::from(world.state.dt));
    let solve = SolveState { warm_start: 0.5, scale: 0.9, renewal, stopped: 1, ..solving() };
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
        let free = speed(&world, i) + dt * other[i].xyz().as_dvec3();
        let scale = f64::from(0.9_f32);
        let u = free + scale * (predicted[i].xyz().as_dvec3() - free);
        let has_pressure = predicted[i].w != SolveState::NO_PRESSURE;
        let k = if has_pressure { scale * f64::from(predicted[i].w) } else { 0.0 };
        // The acceleration by the pressure alone, which bodies continue along their surface.
        let by_pressure = (u - free) / dt;
        (0..3).for_each(|axis| after.push(by_pressure[axis], 2.0 / dt));
        after.push(k, 1.0);
        let a = (u - speed(&world, i)) / dt;
        (0..3).for_each(|k| accelerations.push(a[k], 2.0 / dt));
        accelerations.push(other[i].w.into(), 0.0);
        let rho = f64::from(world.densities[i].x);
        densities.push(rho, 0.0);
        densities.push(f64::from(0.9_f32) * k * rho * rho / 1000.0, k.abs() * 1000.0);
        let old = f64::from(old[i]);
        pressures.push(0.5 * (old + f64::from(renewal) * (k - old)), 1.0);
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
