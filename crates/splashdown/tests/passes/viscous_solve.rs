//! The iterations of the implicit viscosity on a cloud: against a dense solution in f64, and what they conserve.

use glam::{DVec3, Vec4, Vec4Swizzles};
use splashdown::passes::viscous;
use splashdown::state::{Params, StepCounters, ViscousState};
use splashdown_gpu::{BufferSet, DispatchSize, Executor, Flag, Recording, Rounds, testing};

use super::iterative::vectors;
use super::neighbour_lists;
use super::oracle::{place, speed};
use super::viscous_cases::{force, strength};
use super::world::{World, params};

/// A time step in which the viscosity carries momentum over several spacings.
const DT: f32 = 0.02;

fn cloud(params: Params) -> World {
    // Stiff enough that the solution takes tens of iterations.
    let thicker = 40.0;
    let params = Params {
        implicit_viscosity: thicker * params.implicit_viscosity,
        viscous_factor: thicker * params.viscous_factor,
        viscous_tolerance: 1e-6,
        most_viscous_iterations: 300,
        ..params
    };
    let mut world = World::new(params, 400);
    world.state.dt = DT;
    world
}

/// The accelerations by all other forces.
fn others(world: &World) -> Vec<Vec4> {
    vectors(world.len(), 4).iter().map(|v| (10.0 * *v).with_w(0.0)).collect()
}

/// The velocities after the solve, and its state.
fn solve(executor: &mut Executor, world: &World, other: &[Vec4]) -> (Vec<DVec3>, ViscousState) {
    let n = world.len();
    let mut set = BufferSet::new();
    set.add("params", executor.create_uniform("params", &world.params).unwrap());
    set.add("grid", executor.create_uniform("grid", &world.grid).unwrap());
    set.add("state", executor.create_small("state", &[world.state]).unwrap());
    set.add("cell_start", executor.create_from("cell_start", &world.cell_start).unwrap());
    set.add("sorted_positions", executor.create_from("sorted_positions", &world.positions).unwrap());
    let lists = neighbour_lists::lists(world, 20);
    set.add("neighbours", executor.create_from("neighbours", &lists).unwrap());
    set.add("sorted_velocities", executor.create_from("sorted_velocities", &world.velocities).unwrap());
    set.add("solid_gradients", executor.create_from("solid_gradients", &[Vec4::NAN]).unwrap());
    set.add("iterates", executor.create::<Vec4>("iterates", n).unwrap());
    set.add("sorted_pressures", executor.create_from("sorted_pressures", &vec![0.0_f32; n]).unwrap());
    set.add("counters", executor.create_from("counters", &[0_u32; StepCounters::WORDS]).unwrap());
    for label in
        ["viscous_residuals", "viscous_products", "viscous_directions", "viscous_images", "predicted"]
    {
        set.add(label, executor.create::<Vec4>(label, n).unwrap());
    }
    set.add("residuals", executor.create::<Vec4>("residuals", n.div_ceil(64)).unwrap());
    set.add("impulses", executor.create::<Vec4>("impulses", n.div_ceil(64)).unwrap());
    let accelerations = executor.create_from("accelerations", other).unwrap();
    let state = executor.create_small("viscous", &[ViscousState::new(true)]).unwrap();
    set.add("accelerations", accelerations);
    set.add("viscous", state);

    let particles = DispatchSize::Items(n as u32);
    let mut iteration = Recording::new("iteration");
    iteration.dispatch(&viscous::product::PRODUCT, particles, &set);
    iteration.dispatch(&viscous::decide::DECIDE, DispatchSize::Groups(1), &set);
    iteration.dispatch(&viscous::update::UPDATE, particles, &set);
    let mut recording = Recording::new("viscosity");
    recording.dispatch(&viscous::begin::BEGIN, particles, &set);
    recording.dispatch(&viscous::start::WENDLAND_C2, particles, &set);
    let stopped = Flag::new(state, std::mem::offset_of!(ViscousState, stopped));
    recording.repeat(&iteration, &Rounds::new(world.params.most_viscous_iterations), stopped);
    recording.dispatch(&viscous::finish::FINISH, particles, &set);
    executor.run(&recording).unwrap();

    let accelerations = executor.read(accelerations).unwrap();
    let velocity = |i: usize| speed(world, i) + f64::from(DT) * accelerations[i].xyz().as_dvec3();
    ((0..world.active()).map(velocity).collect(), executor.read(state).unwrap()[0])
}

/// The velocities before the solve by all other forces.
fn free(world: &World, other: &[Vec4]) -> Vec<DVec3> {
    (0..world.active()).map(|i| speed(world, i) + f64::from(DT) * other[i].xyz().as_dvec3()).collect()
}

/// Solves u + dt K u = v for a dense matrix by elimination.
fn dense(world: &World, v: &[DVec3]) -> Vec<DVec3> {
    let n = 3 * v.len();
    let rate = f64::from(DT) * strength(world);
    let mut matrix = vec![vec![0.0; n + 1]; n];
    for column in 0..n {
        let unit = |j: usize| {
            let mut e = DVec3::ZERO;
            if j == column / 3 {
                e[column % 3] = 1.0;
            }
            e
        };
        // Only neighbours of the column's particle have entries.
        let x = place(world, column / 3);
        for i in 0..v.len() {
            let far = place(world, i).distance(x) > 2.0 * f64::from(world.params.support_radius);
            let (k, ..) = if far { (DVec3::ZERO, 0.0, 0.0) } else { force(world, i, unit) };
            for axis in 0..3 {
                matrix[3 * i + axis][column] = f64::from(u8::from(3 * i + axis == column)) + rate * k[axis];
            }
        }
    }
    for (i, row) in matrix.iter().enumerate() {
        for (j, column) in matrix.iter().enumerate().take(i) {
            assert!((row[j] - column[i]).abs() < 1e-9 * row[i], "the matrix is symmetric");
        }
    }
    for (row, value) in matrix.iter_mut().enumerate() {
        value[n] = v[row / 3][row % 3];
    }
    // The matrix is positive, so that no pivot vanishes.
    for pivot in 0..n {
        let row = matrix[pivot].clone();
        assert!(row[pivot] > 0.0, "the matrix is positive");
        for below in &mut matrix[pivot + 1..] {
            let factor = below[pivot] / row[pivot];
            if factor != 0.0 {
                below.iter_mut().zip(&row).skip(pivot).for_each(|(a, b)| *a -= factor * b);
            }
        }
    }
    let mut solution = vec![0.0; n];
    for row in (0..n).rev() {
        let rest: f64 = (row + 1..n).map(|k| matrix[row][k] * solution[k]).sum();
        solution[row] = (matrix[row][n] - rest) / matrix[row][row];
    }
    solution.chunks_exact(3).map(DVec3::from_slice).collect()
}

fn largest_difference(a: &[DVec3], b: &[DVec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
}

#[test]
fn the_velocities_solve_the_system_at_walls_with_friction() {
    let world = cloud(params(2.0));
    let other = others(&world);
    let expected = dense(&world, &free(&world, &other));
    let moved = largest_difference(&expected, &free(&world, &other));
    for (name, mut executor) in testing::executors("the_velocities_solve_the_system_at_walls_with_friction") {
        let (found, state) = solve(&mut executor, &world, &other);
        assert!((10..300).contains(&state.iteration), "{name}: {state:?}");
        let error = largest_difference(&found, &expected);
        // The positions of images are rounded, which turns the direction of the closest pairs: 1.3e-3 m/s.
        assert!(error < 2e-3, "{name}: {error} m/s after {} iterations", state.iteration);
        // Controls: the solution differs from the start by much more, and a tolerance of a tenth is seen.
        assert!(moved > 0.5, "{moved}");
        let loose = World { params: Params { viscous_tolerance: 0.1, ..world.params }, ..world.clone() };
        let (inexact, _) = solve(&mut executor, &loose, &other);
        assert!(largest_difference(&inexact, &expected) > 5e-3, "{name}: control");
    }
}

/// The changes of momentum and of angular momentum over the sum of the magnitudes of their terms.
fn changes(world: &World, before: &[DVec3], after: &[DVec3]) -> [f64; 2] {
    let (mut linear, mut angular, mut size, mut arm) = (DVec3::ZERO, DVec3::ZERO, 0.0, 0.0);
    for (i, (before, after)) in before.iter().zip(after).enumerate() {
        let change = *after - *before;
        linear += change;
        angular += place(world, i).cross(change);
        size += change.length();
        arm += place(world, i).length() * change.length();
    }
    [linear.length() / size, angular.length() / arm]
}

#[test]
fn momentum_and_angular_momentum_are_conserved_after_few_iterations() {
    // Three iterations are far from the solution.
    let few = Params { closed: 0, ..params(2.0) };
    let mut world = cloud(few);
    (world.params.viscous_tolerance, world.params.most_viscous_iterations) = (1e-6, 3);
    let other = others(&world);
    for (name, mut executor) in
        testing::executors("momentum_and_angular_momentum_are_conserved_after_few_iterations")
    {
        let (found, state) = solve(&mut executor, &world, &other);
        assert_eq!(state.iteration, 3, "{name}");
        let changes = changes(&world, &free(&world, &other), &found);
        assert!(changes.iter().all(|&change| change < 1e-5), "{name}: {changes:?}");
        // Control: walls with friction take momentum.
        let mut walls = cloud(params(2.0));
        walls.params.most_viscous_iterations = 3;
        let (found, _) = solve(&mut executor, &walls, &other);
        let taken = self::changes(&walls, &free(&walls, &other), &found);
        assert!(taken.iter().all(|&change| change > 1e-2), "{name}: control {taken:?}");
    }
}

#[test]
fn a_rigid_rotation_feels_no_viscosity() {
    let mut world = cloud(Params { closed: 0, ..params(2.0) });
    let none = vec![Vec4::ZERO; world.len()];
    let flow = |world: &mut World, velocity: fn(DVec3) -> DVec3| {
        for i in 0..world.active() {
            let v = velocity(place(world, i));
            world.velocities[i] = v.as_vec3().extend(1000.0);
        }
    };
    for (name, mut executor) in testing::executors("a_rigid_rotation_feels_no_viscosity") {
        let rotation = |x: DVec3| DVec3::new(1.0, -2.0, 3.0).cross(x - DVec3::new(0.1, 0.2, 0.3)) + 5.0;
        flow(&mut world, rotation);
        let before: Vec<DVec3> = (0..world.active()).map(|i| speed(&world, i)).collect();
        let (after, _) = solve(&mut executor, &world, &none);
        let change = largest_difference(&before, &after);
        assert!(change < 1e-4, "{name}: {change}");
        // Control: a shear flow does.
        flow(&mut world, |x| DVec3::new(3.0 * x.y, 0.0, 0.0));
        let before: Vec<DVec3> = (0..world.active()).map(|i| speed(&world, i)).collect();
        let (after, _) = solve(&mut executor, &world, &none);
        assert!(largest_difference(&before, &after) > 0.1, "{name}: control");
    }
}
