//! The passes of the continuum surface force.

use glam::{DMat3, DVec3, Vec4, Vec4Swizzles};
use splashdown::state::Params;

use super::corrected_oracle::symmetric;
use super::harness::{Case, Data};
use super::neighbour_cases::{BLEND, C2, CUBIC, Expected, Kernels, base, corrections, word, world};
use super::oracle::{Sum, constants, neighbours};
use super::world::{World, params};

pub fn cases() -> Vec<Case> {
    let surface = |ratio: f32| {
        let params = params(ratio);
        Params {
            tension_factor: 40.0,
            interface_depth: 0.7 * params.particle_spacing,
            largest_curvature: 2.0 / params.particle_spacing,
            weakest_normal: 0.2,
            ..params
        }
    };
    let open = Params { closed: 0b110111, ..surface(2.5) };
    // 120 degrees.
    let repelled = |params: Params| Params { wetting: -1.0 / params.support_radius, ..params };
    let mut cases = Vec::new();
    for kernels in [C2, BLEND, CUBIC] {
        cases.push(smooth_normals("closed", kernels, surface(2.0)));
        for is_corrected in [false, true] {
            cases.push(tension_force("closed", kernels, surface(2.0), is_corrected));
            cases.push(tension_force("wider support, open above", kernels, open, is_corrected));
            cases.push(tension_force("repelled, open above", kernels, repelled(open), is_corrected));
            cases.push(tension_force("repelled", kernels, repelled(surface(2.0)), is_corrected));
            for params in [open, repelled(open)] {
                let implicit = Params { is_implicit: 1, ..params };
                cases.push(tension_force("implicit pressure", kernels, implicit, is_corrected));
            }
        }
    }
    cases
}

fn smooth_normals(name: &str, kernels: Kernels, params: Params) -> Case {
    let world = world(params);
    let c = constants(&world);
    let mut expected = Expected::new();
    for i in 0..world.active() {
        let (mut sum, mut weight) = (Sum::default(), 0.0);
        neighbours(&world, i, |j, d, by, _| {
            let w = kernels.gradient.w(d.length() / c.support);
            sum.add(w * by.sign * world.normals[j].xyz().as_dvec3());
            weight += w;
        });
        expected.vector(&Sum { value: sum.value / weight, size: sum.size / weight });
    }
    let mut input = base(&world);
    input.extend([
        Data::U32(world.cell_start.clone()),
        Data::Vec4(world.positions.clone()),
        Data::Vec4(world.normals.clone()),
    ]);
    let output = Data::Vec4(vec![Vec4::ZERO; world.len()]);
    expected.case(format!("smooth_normals.{}", word(kernels)), name, &world, input, output, |input| {
        let Data::Vec4(normals) = &mut input[4] else { panic!("not the normals") };
        normals.iter_mut().for_each(|n| *n *= 1.002);
    })
}

fn tension_force(name: &str, kernels: Kernels, params: Params, is_corrected: bool) -> Case {
    let world = world(params);
    // Some normals are too short to count.
    let shorter = |k: usize| -> Vec<Vec4> {
        let length = |i: usize| [1.0, 0.3, 0.1][(i + k) % 3];
        world.normals.iter().enumerate().map(|(i, &n)| length(i) * n).collect()
    };
    let (normals, smooth) = (shorter(0), shorter(1));
    let corrections = if is_corrected { corrections(&world) } else { vec![Vec4::NAN] };
    let before: Vec<Vec4> = (0..world.len()).map(|i| 0.1 * world.normals[(i + 3) % world.len()]).collect();
    let mut expected = Expected::new();
    let forces = forces(&world, kernels, &normals, &smooth, is_corrected.then_some(&corrections));
    for (i, start) in before.iter().enumerate() {
        let none = Sum::default();
        let force = forces.get(i).unwrap_or(&none);
        for (k, start) in start.to_array().map(f64::from).into_iter().enumerate() {
            let (value, size) = if k < 3 { (force.value[k], force.size) } else { (0.0, 0.0) };
            expected.push(start + value, size + if value == 0.0 { 0.0 } else { start.abs() });
        }
    }
    let mut input = base(&world);
    input.extend([
        Data::U32(world.cell_start.clone()),
        Data::Vec4(world.positions.clone()),
        Data::Vec4(normals),
        Data::Vec4(smooth),
        Data::Vec4(corrections),
    ]);
    let suffix = if is_corrected { "_corrected" } else { "" };
    let label = format!("tension_force.{}{suffix}", word(kernels));
    let control: fn(&mut [Data]) = if params.is_implicit == 1 {
        |input: &mut [Data]| input[0].params().is_implicit = 0
    } else if params.wetting == 0.0 {
        |input: &mut [Data]| input[0].params().tension_factor *= 1.002
    } else {
        |input: &mut [Data]| input[0].params().wetting *= 1.01
    };
    expected.case_over(label, name, &world, input, Data::Vec4(before), control)
}

/// The inner normal of each closed side, and the distance of a point from it.
fn closed_sides(params: &Params, x: DVec3) -> impl Iterator<Item = (DVec3, f64)> {
    let (min, max) = (params.domain_min.as_dvec3(), params.domain_max.as_dvec3());
    let sides = DVec3::AXES.map(|axis| [(axis, axis.dot(x - min)), (-axis, axis.dot(max - x))]);
    let closed = params.closed;
    sides
        .into_iter()
        .flatten()
        .enumerate()
        .filter_map(move |(bit, side)| (closed >> bit & 1 == 1).then_some(side))
}

/// The accelerations by the surface force; see `passes::tension_force`.
fn forces(
    world: &World,
    kernels: Kernels,
    normals: &[Vec4],
    smooth: &[Vec4],
    corrections: Option<&Vec<Vec4>>,
) -> Vec<Sum> {
    let (c, p) = (constants(world), &world.params);
    let weakest = f64::from(p.weakest_normal);
    let normal = |list: &[Vec4], i: usize| list[i].xyz().as_dvec3();
    let weight = |n: DVec3| ((n.length() - weakest) / (1.5 * weakest)).clamp(0.0, 1.0);
    let matrix = |i: usize| corrections.map_or(DMat3::IDENTITY, |list| symmetric(list, i));
    let [factor, limit, depth] = [p.tension_factor, p.largest_curvature, p.interface_depth].map(f64::from);
    let force = |i: usize| {
        let own_weight = weight(normal(normals, i));
        if own_weight == 0.0 {
            return Sum::default();
        }
        let u = normal(smooth, i).normalize_or_zero();
        let [mut gradient, mut close, mut turn, mut extent] = [Sum::default(); 4];
        neighbours(world, i, |j, d, by, _| {
            // Without unit: g d / H^5 is the gradient of the kernel.
            let g = c.support.powi(5) * kernels.gradient.gradient(d, c.support);
            let reflection = DMat3::from_diagonal(by.sign);
            let parts = [matrix(i) * g, reflection * matrix(j) * reflection * g];
            gradient.add_parts(&parts);
            let closeness = (1.0 - 4.0 * d.length() / c.support).max(0.0);
            close.add_parts(&parts.map(|part| closeness * part));
            let image = by.sign * normal(smooth, j);
            let weighted = weight(image);
            turn.add_parts(&[
                DVec3::X * weighted * image.normalize_or_zero().dot(g),
                -DVec3::X * weighted * u.dot(g),
            ]);
            let along = d.dot(u);
            let slope = if d == DVec3::ZERO { 0.0 } else { g.dot(d) / d.length_squared() };
            extent.add(DVec3::X * weighted * slope * (d.length_squared() - along * along));
        });
        let most = -1e-3 * c.support.powi(2);
        let inverse = 1.0 / extent.value.x.min(most);
        let free = 2.0 * turn.value.x * inverse;
        let inner = free.clamp(-limit, limit);
        let divisor = (1.0 + 0.5 * depth * inner).max(0.25);
        let curvature = inner / divisor;
        let curvature_size = (2.0 * turn.size + free.abs() * extent.size) * inverse.abs() / divisor.powi(2);
        let strength = factor * own_weight;
        let mut pull = DVec3::ZERO;
        let mut reach = 0.0;
        for (normal, distance) in closed_sides(p, world.positions[i].xyz().as_dvec3()) {
            let share = f64::from(p.wetting) * (1.0 - distance / c.support).clamp(0.0, 1.0);
            pull -= share * (gradient.value - gradient.value.dot(normal) * normal);
            reach += share.abs();
        }
        let repulsion = if p.is_implicit == 1 { 4.0 } else { 0.0 };
        let force = curvature * gradient.value + pull - repulsion * curvature.abs() * close.value;
        let size = (curvature.abs() + reach) * gradient.size
            + repulsion * curvature.abs() * close.size
            + curvature_size * (gradient.value.length() + repulsion * close.value.length());
        Sum { value: strength * force, size: strength * size }
    };
    (0..world.active()).map(force).collect()
}
