//! The passes of the implicit viscosity, on random clouds.

use std::f64::consts::PI;

use glam::{DVec3, Vec4, Vec4Swizzles};
use splashdown::state::{Params, StepCounters, ViscousState};

use super::harness::{Case, Data, wide};
use super::iterative::{KERNELS, Output, base, case, lists, poisoned, signed, suffix, vectors, world};
use super::oracle::{Kernel, constants, neighbours, speed};
use super::world::{World, params};

pub fn cases() -> Vec<Case> {
    let open = Params { closed: 0b110111, wall_friction: 0.3, ..params(2.5) };
    let mut cases = Vec::new();
    let clouds = [("closed", params(2.0)), ("wider support, open above, less friction", open)];
    for (name, params) in clouds {
        for (kernel, word) in KERNELS {
            for bodies in [false, true] {
                cases.push(start(name, kernel, word, params, bodies));
            }
        }
        for bodies in [false, true] {
            cases.push(product(name, params, bodies));
        }
    }
    cases.push(product("without friction", Params { wall_friction: 0.0, ..params(2.0) }, false));
    cases.push(begin("a step", 1500));
    cases.push(begin("after the frame", 0));
    let first = ViscousState { iteration: 0, updates: 0, ..solving() };
    cases.extend([
        decide("the first iteration", first, 1.0),
        decide("a further iteration", solving(), 1.0),
        decide("a restart", ViscousState { alpha: 1e-6, ..solving() }, 1.0),
        decide("converged", ViscousState { target_residual: 1e9, ..solving() }, 1.0),
        decide("the last iteration", ViscousState { iteration: 5, ..solving() }, 1.0),
    ]);
    cases.push(update("the first", ViscousState { updates: 1, beta: 0.0, ..solving() }));
    cases.push(update("a further one", solving()));
    cases.push(finish("after iterations", solving()));
    cases.push(finish("without iterations", ViscousState { updates: 0, ..solving() }));
    cases
}

/// A state in the middle of a solve.
fn solving() -> ViscousState {
    ViscousState {
        stopped: 0,
        iteration: 2,
        updates: 2,
        alpha: 0.8,
        beta: 0.4,
        gamma: 900.0,
        reference: 0.5,
        target_residual: 1e-3,
    }
}

/// The viscous force on particle i with these velocities over viscosity and volume, the magnitude of its terms, and the
/// trace of the diagonal of its matrix. Written from the definition of the images: in front of a wall with friction f, the
/// image has the part f of the opposite velocity and the rest of the reflected one.
pub fn force(world: &World, i: usize, velocity: impl Fn(usize) -> DVec3) -> (DVec3, f64, f64) {
    let c = constants(world);
    let friction = f64::from(world.params.wall_friction);
    let (mut sum, mut size, mut trace) = (DVec3::ZERO, 0.0, 0.0);
    let v = velocity(i);
    neighbours(world, i, |j, d, by, _| {
        let (r2, u) = (d.length_squared(), velocity(j));
        let q = r2.sqrt() / c.support;
        let weight = 525.0 / PI * (1.0 - q) * (1.0 - 0.8 * q)
            / c.support.powi(5)
            / (r2 + 1e-6 * c.support * c.support);
        let term = if by.sign == DVec3::ONE {
            weight * d * d.dot(v - u)
        } else {
            let slip = d * d.dot(v - by.sign * u);
            // The mean of the matrices of the distance and of its reflection, for a velocity that changes its sign at each wall.
            let e = by.sign * d;
            let w = v - by.sign.element_product() * u;
            let stick = 0.5 * (d * d.dot(w) + e * e.dot(w));
            weight * ((1.0 - friction) * slip + friction * stick)
        };
        sum += term;
        size += weight * r2 * (v.length() + u.length());
        trace += weight * r2;
    });
    (sum, size, trace)
}

/// Viscosity times volume.
pub fn strength(world: &World) -> f64 {
    let p = &world.params;
    f64::from(p.implicit_viscosity) * f64::from(p.particle_mass) / f64::from(p.rest_density)
}

/// A factor of the sums that is wrong by 1/200.
fn thicker(input: &mut [Data]) {
    input[0].params().viscous_factor *= 1.005;
}

fn start(name: &str, kernel: Kernel, word: &str, params: Params, bodies: bool) -> Case {
    let world = world(params);
    let (n, c) = (world.len(), constants(&world));
    let iterates: Vec<Vec4> =
        vectors(n, 0).iter().map(|v| Vec4::new(2.0 * v.x.abs(), 0.0, 0.0, 0.0)).collect();
    let accelerations: Vec<Vec4> = vectors(n, 4)
        .iter()
        .enumerate()
        .map(|(i, v)| (50.0 * *v).with_w(if i % 11 == 0 { 1.0 } else { 0.0 }))
        .collect();
    let solid: Vec<Vec4> = vectors(n, 8).iter().map(|v| 20.0 * *v).collect();
    let mut after = Output::new("iterates", Data::Vec4(iterates.clone()));
    let mut residuals = Output::new("viscous_residuals", poisoned(n));
    let groups = world.active().div_ceil(64);
    let mut impulses = Output::new("impulses", Data::Vec4(vec![Vec4::ZERO; groups]).poison());
    let mut squares = vec![0.0; groups];
    let rate = strength(&world);
    for i in 0..world.active() {
        let own = f64::from(iterates[i].x);
        after.push(own, 0.0);
        if accelerations[i].w == 1.0 {
            (0..3).for_each(|_| after.push(0.0, 0.0));
            (0..4).for_each(|_| residuals.push(0.0, 0.0));
            continue;
        }
        let (viscous, viscous_size, trace) = force(&world, i, |j| speed(&world, j));
        let (mut pressure, mut pressure_size) = (DVec3::ZERO, 0.0);
        neighbours(&world, i, |j, d, _, _| {
            let term = (own + f64::from(iterates[j].x)) * c.mass / c.rest * kernel.gradient(d, c.support);
            pressure -= term;
            pressure_size += term.length();
        });
        if bodies {
            let term = own * solid[i].xyz().as_dvec3();
            pressure -= term;
            pressure_size += term.length();
        }
        (0..3).for_each(|k| after.push(pressure[k], pressure_size));
        let other = accelerations[i].xyz().as_dvec3();
        let r = c.dt * (other + pressure - rate * viscous);
        let size = c.dt * (other.length() + pressure_size + rate * viscous_size);
        (0..3).for_each(|k| residuals.push(r[k], size));
        residuals.push(1.0 / (1.0 + c.dt * rate * trace / 3.0), 1.0);
        squares[i / 64] += c.dt * c.dt * other.length_squared();
    }
    for &value in &squares {
        impulses.push(value, value);
        (0..3).for_each(|_| impulses.push(0.0, 0.0));
    }
    let mut input = base(&world);
    input.extend([
        Data::Viscous(solving()),
        Data::U32(world.cell_start.clone()),
        Data::Vec4(world.positions.clone()),
        Data::Vec4(world.velocities.clone()),
        Data::Vec4(accelerations.clone()),
        Data::Vec4(if bodies { solid.clone() } else { vec![Vec4::NAN] }),
    ]);
    let label = format!("viscous.start.{word}{}", suffix(bodies));
    case(label, name, n, input, vec![after, residuals, impulses], thicker)
}

fn product(name: &str, params: Params, bodies: bool) -> Case {
    let world = world(params);
    let (n, c) = (world.len(), constants(&world));
    let given: Vec<Vec4> = vectors(n, 0)
        .iter()
        .enumerate()
        .map(|(i, v)| v.with_w(if i % 13 == 0 { 0.0 } else { 0.6 + 0.3 * v.w }))
        .collect();
    let is_driven = |i: usize| given[i].w == 0.0;
    let before: Vec<Vec4> =
        vectors(n, 4).iter().enumerate().map(|(i, v)| if is_driven(i) { Vec4::ZERO } else { *v }).collect();
    let z = |j: usize| f64::from(given[j].w) * given[j].xyz().as_dvec3();
    let start = if bodies { Data::Vec4(before.clone()) } else { poisoned(n) };
    let mut products = Output::new("viscous_products", start);
    let mut residuals = Output::new("residuals", poisoned(world.active().div_ceil(64)));
    let mut sums = vec![([0.0; 4], [0.0; 4]); world.active().div_ceil(64)];
    let rate = strength(&world);
    for i in 0..world.active() {
        if is_driven(i) {
            (0..4).for_each(|_| products.push(0.0, 0.0));
            continue;
        }
        let (viscous, size, _) = force(&world, i, z);
        let mut w = z(i) + c.dt * rate * viscous;
        let mut w_size = z(i).length() + c.dt * rate * size;
        if bodies {
            w += before[i].xyz().as_dvec3();
            w_size += 1.0;
        }
        (0..3).for_each(|k| products.push(w[k], w_size));
        // The fourth component has no meaning.
        products.push(0.0, 2.0 / 2e-5);
        let r = given[i].xyz().as_dvec3();
        let (values, sizes) = &mut sums[i / 64];
        let terms = [r.dot(z(i)), z(i).dot(w), r.length_squared(), z(i).length_squared()];
        let magnitudes =
            [r.length() * z(i).length(), z(i).length() * w_size, r.length_squared(), z(i).length_squared()];
        for k in 0..4 {
            values[k] += terms[k];
            sizes[k] += magnitudes[k];
        }
    }
    for (values, sizes) in &sums {
        (0..4).for_each(|k| residuals.push(values[k], sizes[k]));
    }
    let mut input = base(&world);
    input.extend([
        Data::Viscous(solving()),
        Data::U32(world.cell_start.clone()),
        Data::Vec4(world.positions.clone()),
        lists(&world),
        Data::Vec4(given),
    ]);
    let label = format!("viscous.product{}", suffix(bodies));
    case(label, name, n, input, vec![products, residuals], thicker)
}

fn begin(name: &str, run_count: u32) -> Case {
    let mut world = world(params(2.0));
    world.state.run_count = run_count;
    let n = world.len();
    let pressures: Vec<f32> = (0..n).map(|i| 3.0 * signed(i, 0)).collect();
    let mut viscous = Output::new("viscous", Data::Viscous(solving()).poison());
    let mut iterates = Output::new("iterates", poisoned(n));
    let expected = Data::Viscous(ViscousState::new(run_count == 0));
    wide(expected.floats()).into_iter().for_each(|value| viscous.push(value, 0.0));
    for &pressure in &pressures[..world.active()] {
        iterates.push(pressure.max(0.0).into(), 0.0);
        (0..3).for_each(|_| iterates.push(0.0, 0.0));
    }
    let mut input = vec![Data::Grid(world.grid), Data::State(world.state)];
    input.extend([Data::U32(world.cell_start.clone()), Data::F32(pressures)]);
    case("viscous.begin".into(), name, n, input, vec![viscous, iterates], |input| {
        let Data::State(state) = &mut input[1] else { panic!("no state") };
        state.run_count = 1500 - state.run_count;
    })
}

fn decide(name: &str, before: ViscousState, scale: f32) -> Case {
    let world = world(params(2.0));
    let groups = world.active().div_ceil(64);
    let residuals: Vec<Vec4> = vectors(groups, 0).iter().map(|v| scale * 40.0 * v.abs()).collect();
    let impulses: Vec<Vec4> =
        (0..groups).map(|i| Vec4::new(40.0 * signed(i, 8).abs(), 0.0, 0.0, 0.0)).collect();
    let n = world.active() as f64;
    let total: Vec<f64> = (0..4).map(|k| residuals.iter().map(|v| f64::from(v[k])).sum()).collect();
    let impulse: f64 = impulses.iter().map(|v| f64::from(v.x)).sum();
    let residual = (total[2] / n).sqrt();
    let (mut state, mut viscous) = (world.state, before);
    let mut counters = vec![5_u32; StepCounters::WORDS];
    if before.iteration == 0 {
        viscous.reference = ((impulse + total[3]) / n).sqrt() as f32;
        viscous.target_residual = 0.01 * viscous.reference + 1e-6 * state.max_speed;
    }
    viscous.iteration += 1;
    let has_converged = residual <= f64::from(viscous.target_residual);
    if has_converged || viscous.iteration == 6 {
        viscous.stopped = 1;
        state.viscous_iterations += viscous.iteration;
        state.most_viscous_iterations = state.most_viscous_iterations.max(viscous.iteration);
        state.viscous_residual =
            f64::from(state.viscous_residual).max(residual / f64::from(viscous.reference)) as f32;
        if !has_converged {
            counters[StepCounters::VISCOUS_UNCONVERGED] += 1;
            counters[StepCounters::SHORTEN] = 1;
        }
    } else {
        let (mut beta, mut denominator) = (0.0, total[1]);
        if before.updates > 0 {
            let next = total[0] / f64::from(before.gamma);
            let conjugate = total[1] - next * total[0] / f64::from(before.alpha);
            if conjugate > 1e-3 * total[1] {
                (beta, denominator) = (next, conjugate);
            }
        }
        (viscous.beta, viscous.alpha) = (beta as f32, (total[0] / denominator) as f32);
        viscous.gamma = total[0] as f32;
        viscous.updates += 1;
    }
    let mut outputs = vec![
        Output::new("state", Data::State(world.state)),
        Output::new("viscous", Data::Viscous(before)),
        Output::new("counters", Data::U32(vec![5; StepCounters::WORDS])),
    ];
    for (output, data) in
        outputs.iter_mut().zip([Data::State(state), Data::Viscous(viscous), Data::U32(counters)])
    {
        for value in wide(data.floats()) {
            // The length of a change contains the difference of two sums.
            output.push(value, 10.0 * value.abs());
        }
    }
    let mut input = vec![Data::Params(world.params), Data::Grid(world.grid)];
    input.extend([Data::U32(world.cell_start.clone()), Data::Vec4(residuals), Data::Vec4(impulses)]);
    case("viscous.decide".into(), name, 1, input, outputs, |input| {
        let Data::Vec4(residuals) = &mut input[3] else { panic!("no sums") };
        residuals.iter_mut().for_each(|sum| *sum *= 1.01);
    })
}

fn update(name: &str, viscous: ViscousState) -> Case {
    let world = world(params(2.0));
    let n = world.len();
    let given: Vec<Vec4> = vectors(n, 0).iter().map(|v| v.with_w(0.6 + 0.3 * v.w)).collect();
    let (products, directions, images, predicted) =
        (vectors(n, 4), vectors(n, 8), vectors(n, 12), vectors(n, 1));
    let mut after = ["viscous_residuals", "viscous_directions", "viscous_images", "predicted"]
        .into_iter()
        .zip([&given, &directions, &images, &predicted])
        .map(|(name, before)| Output::new(name, Data::Vec4(before.clone())))
        .collect::<Vec<_>>();
    let (alpha, beta) = (f64::from(viscous.alpha), f64::from(viscous.beta));
    let wide = |v: Vec4| v.xyz().as_dvec3();
    for i in 0..world.active() {
        let p = f64::from(given[i].w) * wide(given[i]) + beta * wide(directions[i]);
        let s = wide(products[i]) + beta * wide(images[i]);
        let before = if viscous.updates == 1 { speed(&world, i) } else { wide(predicted[i]) };
        let values = [wide(given[i]) - alpha * s, p, s, before + alpha * p];
        for (k, (output, value)) in after.iter_mut().zip(values).enumerate() {
            (0..3).for_each(|axis| output.push(value[axis], 4.0));
            output.push(if k == 0 { given[i].w.into() } else { 0.0 }, 0.0);
        }
    }
    let input = vec![
        Data::Grid(world.grid),
        Data::State(world.state),
        Data::Viscous(viscous),
        Data::U32(world.cell_start.clone()),
        Data::Vec4(world.velocities.clone()),
        Data::Vec4(products),
    ];
    case("viscous.update".into(), name, n, input, after, |input| {
        let Data::Viscous(viscous) = &mut input[2] else { panic!("no state of the solver") };
        viscous.alpha *= 1.001;
    })
}

fn finish(name: &str, viscous: ViscousState) -> Case {
    let world = world(params(2.0));
    let (n, dt) = (world.len(), f64::from(world.state.dt));
    let (residuals, predicted, iterates) = (vectors(n, 0), vectors(n, 4), vectors(n, 8));
    let other: Vec<Vec4> = vectors(n, 12)
        .iter()
        .enumerate()
        .map(|(i, v)| v.with_w(if i % 7 == 0 { 1.0 } else { 0.0 }))
        .collect();
    let mut accelerations = Output::new("accelerations", Data::Vec4(other.clone()));
    for i in 0..world.active() {
        let before = speed(&world, i);
        let solution = if viscous.updates == 0 { before } else { predicted[i].xyz().as_dvec3() };
        let pressure = DVec3::new(iterates[i].y.into(), iterates[i].z.into(), iterates[i].w.into());
        let a = match other[i].w {
            1.0 => other[i].xyz().as_dvec3(),
            _ => (solution + residuals[i].xyz().as_dvec3() - before) / dt - pressure,
        };
        (0..3).for_each(|k| accelerations.push(a[k], 4.0 / dt));
        accelerations.push(other[i].w.into(), 0.0);
    }
    let input = vec![
        Data::Grid(world.grid),
        Data::State(world.state),
        Data::Viscous(viscous),
        Data::U32(world.cell_start.clone()),
        Data::Vec4(world.velocities.clone()),
        Data::Vec4(residuals),
        Data::Vec4(predicted),
        Data::Vec4(iterates),
    ];
    case("viscous.finish".into(), name, n, input, vec![accelerations], |input| {
        let Data::State(state) = &mut input[1] else { panic!("no state") };
        state.dt *= 1.001;
    })
}
