//! The passes of the implicit pressure that sum over neighbours, on random clouds.

use glam::{DVec3, Vec2, Vec3, Vec4, Vec4Swizzles};
use splashdown::state::{Params, SolveState};

use super::harness::{Case, Data};
use super::implicit_step_cases::{compressibility, full, solving};
use super::iterative::{KERNELS, Output, base, case, lists, poisoned, suffix, vectors, world};
use super::oracle::{self, Kernel, Parts, constants, neighbours};
use super::world::params;

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
                cases.push(residual(name, kernel, word, params, solving(), bodies));
            }
        }
    }
    let (kernel, word) = KERNELS[0];
    let first = SolveState { iteration: 0, beta: 0.0, ..solving() };
    let later = SolveState { mean_excess: 0.0015, ..solving() };
    for bodies in [false, true] {
        cases.push(residual("full, the first iteration", kernel, word, full(), first, bodies));
        cases.push(residual("full, a further iteration", kernel, word, full(), later, bodies));
        let weightless = Params { gravity: Vec3::ZERO, compressibility: 0.0, ..full() };
        cases.push(residual("full and weightless", kernel, word, weightless, later, bodies));
    }
    cases
}

/// A mass that is wrong by 1/500.
fn heavier(input: &mut [Data]) {
    input[0].params().summed_mass *= 1.002;
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

fn residual(name: &str, kernel: Kernel, word: &str, params: Params, solve: SolveState, bodies: bool) -> Case {
    let world = world(params);
    let (n, c) = (world.len(), constants(&world));
    let is_measuring = params.accepted_excess > 0.0 && solve.iteration == 0;
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
        let compressibility = compressibility(&world.params, &world.state);
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
        let change = c.dt * rate - compressibility * k - f64::from(solve.mean_excess);
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
        let next = match above {
            _ if is_measuring => k,
            above if above > 0.0 => above,
            _ => below.clamp(least, 0.0),
        };
        let step_size = k.abs() + 0.5 * r_size / diagonal;
        iterates.push(next, step_size);
        iterates.push(f64::from(solve.beta) * f64::from(before[i].y) + f64::from(before[i].z), 2.0);
        iterates.push(next - k, step_size);
        iterates.push(excess, 0.0);
        let error = if k > least { r.abs() } else { r.max(diagonal * (least - k)) };
        values[0] += error;
        sizes[0] += r_size + diagonal * (least - k).max(0.0);
        values[3] += match error {
            _ if is_measuring => complete + c.dt * rate,
            error if error > 0.0 => k * r,
            _ => 0.0,
        };
        sizes[3] += k.abs().max(1.0) * r_size;
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
