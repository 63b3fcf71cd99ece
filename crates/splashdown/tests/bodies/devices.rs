use glam::{Quat, Vec3};
use splashdown::scene::{
    BoundaryKind, DensityMode, Hinge, Keyframe, Method, Motion, NegativePressure, Script,
};
use splashdown::{BodyState, Simulation};
use splashdown_gpu::{CpuExecutor, Executor, GpuExecutor, testing};
use splashdown_io::Particles;

use crate::{body, free, tank};

/// Particles and bodies after some steps.
fn run(
    executor: Executor,
    method: Method,
    density: DensityMode,
    boundary: BoundaryKind,
    viscosity: f32,
) -> (Particles, Vec<BodyState>, u64) {
    let mut scene = tank(0.025, [0.4, 0.4, 0.3], 0.2);
    scene.solver.select_method(method);
    scene.solver.density = density;
    scene.fluid.material.viscosity = viscosity;
    if method == Method::Dfsph {
        // Six equal steps, with pressures that are solved far enough that the last iteration makes no difference. The
        // rounding of a density causes a pressure proportional to 1 / dt^2.
        scene.solver.max_dt = 0.005;
        scene.solver.tolerance = 1e-6;
        scene.solver.max_iterations = Some(400);
    }
    if density == DensityMode::Continuity {
        scene.solver.negative_pressure = NegativePressure::Keep;
    }
    // No particle lies on a line of a body's grid: the slope of the body's map is discontinuous there, and
    // rounding would select the side.
    let mut standing = body("standing", "cube", 0.1, Vec3::new(0.1213, 0.0517, 0.1391), Motion::Static);
    standing.mesh.rotation = Quat::from_rotation_y(0.4);
    standing.friction = 0.7;
    standing.adhesion = 2.0;
    standing.boundary = boundary;
    let keyframe = |time: f64, x: f32| Keyframe {
        time,
        position: Vec3::new(x, 0.1233, 0.1177),
        orientation: Quat::from_rotation_z(x),
    };
    let script =
        Script { keyframes: vec![keyframe(0.0, 0.3031), keyframe(1.0, 0.4)], shift: None, turn: None };
    let scripted = body("scripted", "cube", 0.08, Vec3::ZERO, Motion::Scripted(script));
    let carried = body("carried", "cube", 0.09, Vec3::new(0.2023, 0.2219, 0.1987), free(300.0));
    // On a hinge beside its centre, so that the fluid and its weight rotate it.
    let mut hung = body("hung", "cube", 0.07, Vec3::new(0.3217, 0.2093, 0.2179), free(700.0));
    let axis = Vec3::new(0.48, -0.36, 0.8);
    if let Motion::Dynamic { hinge, .. } = &mut hung.motion {
        *hinge = Some(Hinge { point: Vec3::new(0.3, 0.21, 0.22), axis, motor: None });
    }
    scene.bodies = vec![standing, scripted, carried, hung];
    let mut simulation = Simulation::with_executor(&scene, executor).unwrap();
    // Enough steps for the bodies to move, but too few for rounding errors to grow.
    let dt = simulation.dt();
    let stats = simulation.advance(6.0 * dt).unwrap();
    (simulation.particles().unwrap(), simulation.body_states().unwrap(), stats.steps)
}

fn distance(a: &[f32; 3], b: &[f32; 3]) -> f32 {
    Vec3::from(*a).distance(Vec3::from(*b))
}

#[test]
fn gpu_and_cpu_agree_on_particles_and_bodies() {
    let Some(gpu) = testing::gpu_or_skip("gpu_and_cpu_agree_on_particles_and_bodies") else { return };
    for (method, density, boundary, viscosity) in [
        (Method::Wcsph, DensityMode::Summation, BoundaryKind::Map, 1e-6),
        (Method::Wcsph, DensityMode::Continuity, BoundaryKind::Map, 1e-6),
        (Method::Wcsph, DensityMode::Summation, BoundaryKind::Particles, 1e-6),
        (Method::Mueller2003, DensityMode::Summation, BoundaryKind::Map, 1e-6),
        (Method::Dfsph, DensityMode::Summation, BoundaryKind::Map, 1e-6),
        // An implicit viscosity.
        (Method::Dfsph, DensityMode::Summation, BoundaryKind::Map, 0.1),
    ] {
        let what = format!("{method} {density} {boundary} {viscosity} m^2/s");
        let mut poisoned: Executor = GpuExecutor::new(gpu.clone()).into();
        poisoned.poison();
        let (one, bodies_one, steps) = run(CpuExecutor::new().into(), method, density, boundary, viscosity);
        let (two, bodies_two, steps_two) = run(poisoned, method, density, boundary, viscosity);
        assert_eq!((steps, one.ids.len()), (steps_two, two.ids.len()), "{what}");
        assert!(steps >= 6, "{what}: {steps}");
        // Speeds are a few hundredths of a metre per second here; rounding is a ten-thousandth of that.
        let moved = one.velocities.iter().map(|&v| Vec3::from(v).length()).fold(0.0, f32::max);
        assert!(moved > 0.01, "{what}: {moved}");
        let mut apart: Vec<f32> =
            one.velocities.iter().zip(&two.velocities).map(|(a, b)| distance(a, b)).collect();
        apart.sort_by(f32::total_cmp);
        // Where a clamped pressure becomes positive, its hydrostatic part in a wall starts with a jump, and
        // rounding determines the step in which this happens. It affects a few particles of the lowest layer,
        // by a hundredth of the speed.
        let most = apart[apart.len() * 19 / 20];
        assert!(most < 2e-3 * moved, "{what}: {most} of {moved} m/s");
        assert!(apart[apart.len() - 1] < 0.03 * moved, "{what}: {:?} of {moved} m/s", apart.last());
        // The implicit pressure multiplies the rounding of densities by (spacing / dt)^2: a thousandth of the displaced
        // weight of 7 N. It acts on a body of 0.2 kg for 30 ms and 4 mm, at an arm of half an edge.
        let floor = if method == Method::Dfsph { 7e-3 } else { 0.0 };
        for (a, b) in bodies_one.iter().zip(&bodies_two) {
            assert!(a.position.distance(b.position) < 1e-6 + 2e-3 * floor, "{what}: {a:?} {b:?}");
            assert!(a.velocity.distance(b.velocity) < 1e-4 + 0.14 * floor, "{what}: {a:?} {b:?}");
            assert!(a.orientation.dot(b.orientation).abs() > 1.0 - 1e-6, "{what}: {a:?} {b:?}");
            let force = a.force.length();
            assert!(a.force.distance(b.force) < 5e-3 * force + 1e-3 + floor, "{what}: {a:?} {b:?}");
            // A torque is the small difference of large ones: a hundredth of the force at an arm of half an edge.
            let apart = a.torque.distance(b.torque);
            assert!(apart < 5e-4 * force + 1e-4 + 0.045 * floor, "{what}: {a:?} {b:?}");
            // Iterations on two devices end at pressures that differ by more than rounding.
            let share = if method == Method::Dfsph { 0.1 } else { 0.02 };
            assert!(
                (a.work - b.work).abs() < share * a.work.abs() + 1e-8 + 4e-3 * floor,
                "{what}: {a:?} {b:?}"
            );
        }
        assert!(bodies_one.iter().any(|body| body.work.abs() > 1e-7), "{what}: {bodies_one:?}");
        // Control: the fluid exerts a force, and the states of the bodies differ.
        assert!(bodies_one[0].force.length() > 0.1, "{what}: {:?}", bodies_one[0]);
        let axis = Vec3::new(0.48, -0.36, 0.8);
        let spin = bodies_one[3].angular_velocity;
        assert!(spin.length() > 1e-3 && spin.cross(axis).length() < 1e-4 * spin.length(), "{what}: {spin}");
        assert!(bodies_one[1].velocity.length() > 1e-4 && bodies_one[2].velocity.length() > 1e-3, "{what}");
    }
}

#[test]
fn repeated_runs_are_bit_identical() {
    let once =
        || run(CpuExecutor::new().into(), Method::Wcsph, DensityMode::Summation, BoundaryKind::Map, 1e-6);
    let ((one, bodies_one, _), (two, bodies_two, _)) = (once(), once());
    assert_eq!((one, bodies_one), (two, bodies_two));
}
