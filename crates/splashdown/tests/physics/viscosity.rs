//! Implicit viscosity: flows between walls and between bodies against their exact solutions, and a body in a viscous fluid.

use std::f64::consts::PI;

use glam::{Quat, Vec3};
use splashdown::Simulation;
use splashdown::scene::{Hinge, Keyframe, Motion, Script};
use tempfile::TempDir;

use super::cases::{Case, Variant};
use super::figures::Figures;
use super::meshes::cuboid;
use super::shapes::{body, file};
use super::{executor, scene, vec, velocity_sum};

/// Width of the channels in m.
const WIDTH: f64 = 0.1;
/// Viscosity in m^2/s: momentum crosses a channel in a second.
const VISCOSITY: f64 = 0.01;

/// The gates are 2 % at 40 and 1 % at 80 spacings. The smallest case has the gate that is in proportion.
const SIZES: &[u32] = &[20, 40, 80];
const DFSPH: &[Variant] = &[Variant::new("dfsph", "")];

static DUCT: Case = Case { name: "flow in a square duct", across: "width", sizes: SIZES, variants: DFSPH };
static PLATES: Case =
    Case { name: "flow between moving plates", across: "width", sizes: SIZES, variants: DFSPH };
static CARRIED: Case =
    Case { name: "light cube in a viscous fluid", across: "edge", sizes: &[6], variants: DFSPH };
pub const CASES: &[&Case] = &[&DUCT, &PLATES, &CARRIED];

/// The square root of the sum of the squared errors over that of the exact values.
fn error(found: &[f64], exact: &[f64]) -> f64 {
    let square = |values: &mut dyn Iterator<Item = f64>| values.map(|v| v * v).sum::<f64>();
    let wrong = square(&mut found.iter().zip(exact).map(|(a, b)| a - b));
    (wrong / square(&mut exact.iter().copied())).sqrt()
}

/// The acceleration along the duct in m/s^2: the fluid moves by a third of the width.
const FORCE: f64 = 2.0;

/// The velocity in a square duct at rest until the time 0 (the product form of Poiseuille's flow), with the lower corner at 0.
fn duct(viscosity: f64, y: f64, z: f64, time: f64) -> f64 {
    let odd = || (1..60).step_by(2).map(f64::from);
    let mut sum = 0.0;
    for (m, n) in odd().flat_map(|m| odd().map(move |n| (m, n))) {
        let rate = viscosity * PI * PI * (m * m + n * n) / (WIDTH * WIDTH);
        let shape = (m * PI * y / WIDTH).sin() * (n * PI * z / WIDTH).sin();
        sum += 16.0 / (PI * PI * m * n) * shape * (1.0 - (-rate * time).exp()) / rate;
    }
    FORCE * sum
}

/// A plug of fluid in a duct with no-slip walls, open at both ends, so that there is no pressure gradient.
fn plug(across: u32, friction: f64) -> Simulation {
    let w = WIDTH;
    let scene = scene(&format!(
        r#"
        [scene]
        name = "duct"
        duration = 1.0
        gravity = [{FORCE}, 0, 0]
        [domain]
        min = [0, 0, 0]
        max = [{}, {w}, {w}]
        open = ["x_min", "x_max"]
        [fluid]
        particle_spacing = {}
        viscosity = {VISCOSITY}
        [[fluid.block]]
        position = [{}, 0, 0]
        size = [{}, {w}, {w}]
        [solver]
        method = "dfsph"
        wall_friction = {friction}
        tolerance = 0.0001
        max_dt = 0.001
        "#,
        3.5 * w,
        w / f64::from(across),
        0.25 * w,
        2.5 * w,
    ));
    Simulation::with_executor(&scene, executor()).unwrap()
}

/// The positions and velocities along the duct in its middle.
fn middle_of_duct(simulation: &mut Simulation) -> Vec<([f64; 2], f64)> {
    let particles = simulation.particles().unwrap();
    let all = particles.positions.iter().zip(&particles.velocities).map(|(&x, &v)| (vec(x), vec(v)));
    all.filter(|(x, _)| (x.x / WIDTH - 1.6).abs() < 0.3).map(|(x, v)| ([x.y, x.z], v.x)).collect()
}

#[test]
fn flow_in_a_duct_develops_as_the_exact_solution() {
    DUCT.run(|_, across, figures| {
        let mut simulation = plug(across, 1.0);
        let mut unconverged = 0;
        for time in [0.05, 0.1, 0.2] {
            let stats = simulation.advance((time - simulation.stats().time) as f32).unwrap();
            let found = middle_of_duct(&mut simulation);
            assert!(found.len() > 100, "{}", found.len());
            let velocities: Vec<f64> = found.iter().map(|row| row.1).collect();
            let exact = |viscosity| {
                found.iter().map(|([y, z], _)| duct(viscosity, *y, *z, time)).collect::<Vec<f64>>()
            };
            figures
                .error(format!("error of the profile after {time} s"), error(&velocities, &exact(VISCOSITY)));
            if time > 0.15 {
                // Control: a viscosity that is wrong by a twentieth.
                let wrong = error(&velocities, &exact(1.05 * VISCOSITY));
                figures.measure("error for 1.05 times the viscosity", wrong);
                figures.report("most viscosity iterations", f64::from(stats.most_viscous_iterations));
            }
            unconverged += stats.viscous_unconverged;
        }
        figures.measure("steps that did not converge", f64::from(unconverged));
    });
}

/// Speed of each plate in m/s.
const PLATE_SPEED: f64 = 0.1;

/// The velocity between plates that move in opposite directions since the time 0 (Morris, Fox & Zhu 1997), where y = 0 is
/// the middle.
fn couette(viscosity: f64, y: f64, time: f64) -> f64 {
    let half = 0.5 * WIDTH;
    let transient: f64 = (1..40)
        .map(|n| {
            let (n, sign) = (f64::from(n), if n % 2 == 0 { 1.0 } else { -1.0 });
            let decay = (-n * n * PI * PI * viscosity * time / (half * half)).exp();
            2.0 * PLATE_SPEED / (n * PI) * sign * (n * PI * y / half).sin() * decay
        })
        .sum();
    PLATE_SPEED * y / half + transient
}

/// Fluid between two plates that move in opposite directions along x.
fn plates(folder: &TempDir, across: u32, friction: f32) -> Simulation {
    let (w, spacing) = (WIDTH, WIDTH / f64::from(across));
    let mut scene = scene(&format!(
        r#"
        [scene]
        name = "plates"
        duration = 1.0
        gravity = [0, 0, 0]
        [domain]
        min = [{}, {}, 0]
        max = [{}, {}, {}]
        [fluid]
        particle_spacing = {spacing}
        viscosity = {VISCOSITY}
        [[fluid.block]]
        position = [0, {}, 0]
        size = [{}, {w}, {}]
        [solver]
        method = "dfsph"
        tolerance = 0.0001
        max_dt = 0.001
        "#,
        -0.4 * w,
        -0.8 * w,
        4.4 * w,
        0.8 * w,
        8.0 * spacing,
        -0.5 * w,
        4.0 * w,
        8.0 * spacing,
    ));
    for (name, side) in [("lower", -1.0_f32), ("upper", 1.0)] {
        let (near, far) = (0.5 * side * w as f32, 0.9 * side * w as f32);
        let (low, high) = (near.min(far), near.max(far));
        let mesh = cuboid(Vec3::new(-0.1, low, -0.1), Vec3::new(0.5, high, 0.2));
        let shape = file(folder.path(), &format!("{name}.obj"), &mesh);
        let keyframe = |time: f64| Keyframe {
            time,
            position: Vec3::new(side * (PLATE_SPEED * time) as f32, 0.0, 0.0),
            orientation: Quat::IDENTITY,
        };
        // At the first and the last keyframe a body rests.
        let keyframes = [-1.0, 0.0, 1.0, 2.0].map(keyframe).to_vec();
        let script = Script { keyframes, shift: None, turn: None };
        let mut plate = body(name, shape, 1.0, Vec3::ZERO, Motion::Scripted(script));
        plate.friction = friction;
        scene.bodies.push(plate);
    }
    Simulation::with_executor(&scene, executor()).unwrap()
}

#[test]
fn flow_between_moving_plates_develops_as_the_exact_solution() {
    let folder = TempDir::new().unwrap();
    PLATES.run(|_, across, figures| {
        let mut simulation = plates(&folder, across, 1.0);
        let mut unconverged = 0;
        for time in [0.02, 0.05, 0.15] {
            let stats = simulation.advance((time - simulation.stats().time) as f32).unwrap();
            let particles = simulation.particles().unwrap();
            let all = particles.positions.iter().zip(&particles.velocities).map(|(&x, &v)| (vec(x), vec(v)));
            let found: Vec<(f64, f64)> =
                all.filter(|(x, _)| (x.x / WIDTH - 2.0).abs() < 0.5).map(|(x, v)| (x.y, v.x)).collect();
            let velocities: Vec<f64> = found.iter().map(|row| row.1).collect();
            let exact =
                |viscosity| found.iter().map(|(y, _)| couette(viscosity, *y, time)).collect::<Vec<f64>>();
            let what = format!("error of the profile after {time} s");
            figures.error(what, error(&velocities, &exact(VISCOSITY)));
            if time < 0.03 {
                // Control: a viscosity that is wrong by a tenth.
                let wrong = error(&velocities, &exact(1.1 * VISCOSITY));
                figures.measure("error for 1.1 times the viscosity", wrong);
            }
            unconverged += stats.viscous_unconverged;
        }
        figures.measure("steps that did not converge", f64::from(unconverged));
    });
}

/// Momentum of fluid and body in kg m/s, and the velocity of the body, after fluid at 0.5 m/s has carried a light cube along.
fn carried(friction: f32) -> (f64, f64, f64) {
    let mut scene = scene(
        r#"
        [scene]
        name = "carried"
        duration = 1.0
        gravity = [0, 0, 0]
        [domain]
        min = [-0.5, -0.5, -0.5]
        max = [0.5, 0.5, 0.5]
        open = ["x_min", "x_max", "y_min", "y_max", "z_min", "z_max"]
        [fluid]
        particle_spacing = 0.02
        viscosity = 0.1
        [[fluid.block]]
        position = [-0.14, -0.14, -0.14]
        size = [0.28, 0.28, 0.28]
        velocity = [0.5, 0, 0]
        [solver]
        method = "dfsph"
        max_dt = 0.005
        "#,
    );
    let density = 100.0;
    let motion =
        Motion::Dynamic { density, velocity: Vec3::ZERO, angular_velocity: Vec3::ZERO, hinge: None::<Hinge> };
    let mut cube = body("cube", splashdown::scene::MeshShape::Model("cube".into()), 0.12, Vec3::ZERO, motion);
    cube.friction = friction;
    scene.bodies.push(cube);
    let mut simulation = Simulation::with_executor(&scene, executor()).unwrap();
    let particle = f64::from(simulation.params().particle_mass);
    let before = particle * velocity_sum(&simulation.particles().unwrap()).x;
    simulation.advance(0.1).unwrap();
    let fluid = particle * velocity_sum(&simulation.particles().unwrap()).x;
    let speed = f64::from(simulation.body_states().unwrap()[0].velocity.x);
    let mass = f64::from(density) * 0.12_f64.powi(3);
    ((fluid + mass * speed) / before - 1.0, speed, before / (before / 0.5 + mass))
}

#[test]
fn a_light_body_is_carried_along_and_momentum_is_conserved() {
    let mut figures = Figures::new(&CARRIED, "dfsph", 6);
    let (change, speed, common) = carried(1.0);
    figures.measure("relative change of momentum", change.abs());
    figures.measure("speed over the common one", speed / common);
    figures.close();
}

/// How far honey has spread in 0.2 s depended on the tolerance by a tenth, when the pressures of many steps ago pushed it apart.
#[test]
fn honey_spreads_alike_with_every_tolerance() {
    let (_, text) =
        splashdown::scene::presets().iter().find(|(name, _)| *name == "honey").expect("a built-in scene");
    let radius = |tolerance: f32| {
        let keys = format!("method = \"dfsph\"\ntolerance = {tolerance}");
        let scene = scene(&text.replacen("method = \"dfsph\"", &keys, 1));
        let mut simulation = Simulation::with_executor(&scene, executor()).unwrap();
        simulation.advance(0.2).unwrap();
        let positions = simulation.particles().unwrap().positions;
        let square = |[x, _, z]: &[f32; 3]| f64::from((x - 0.07).powi(2) + (z - 0.07).powi(2));
        (positions.iter().map(square).sum::<f64>() / positions.len() as f64).sqrt()
    };
    let (loose, strict) = (radius(1e-3), radius(1e-4));
    assert!((loose / strict - 1.0).abs() < 0.02, "root mean squares of the radius: {loose} m and {strict} m");
    // Control: the honey has spread, from a column whose root mean square is 16 mm.
    assert!(strict > 0.024, "{strict} m");
}
