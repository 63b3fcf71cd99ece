//! Derived values of a scene, compared with values calculated by hand.

use glam::Vec3;
use splashdown::scene::{DensityMode, Derived, NegativePressure, Scene};

use crate::{CUBE, changed, parse};

fn derived(text: &str) -> Derived {
    Derived::new(&parse(text).unwrap_or_else(|errors| panic!("{errors}")))
}

/// Equal within 1e-4, the precision of the values calculated by hand.
fn near(value: f32, by_hand: f64) -> bool {
    (f64::from(value) - by_hand).abs() <= 1e-4 * by_hand.abs()
}

#[test]
fn derived_values_of_the_cube() {
    let cube = derived(CUBE);
    assert_eq!((cube.particles, cube.frames), (1000, 25));
    assert!(near(cube.volume, 0.125));
    assert!(near(cube.support_radius, 0.1));
    // 998.2 * 0.05^3
    assert!(near(cube.particle_mass, 0.124_775), "{}", cube.particle_mass);
    // 2 sqrt(9.81 * 0.5), ten times that, 0.7 * 0.05 / 44.294
    assert!(near(cube.head, 0.5));
    assert!(near(cube.reference_speed, 4.42945));
    assert!(near(cube.sound_speed, 44.2945));
    assert!(near(cube.dt_estimate, 7.90166e-4), "{}", cube.dt_estimate);
    assert_eq!(cube.dt_limit, "sound");
    // 0.04 s / dt = 50.6 steps a frame
    assert_eq!(cube.steps_estimate, 51 * 25);
    // Tait: 998.2 * 44.2945^2 / 7
    assert!(near(cube.stiffness, 279_783.0), "{}", cube.stiffness);
}

#[test]
fn stiffness_and_sound_speed_are_equivalent() {
    let wcsph = derived(&format!("{CUBE}stiffness = 279783\n"));
    assert!(near(wcsph.sound_speed, 44.2945), "{}", wcsph.sound_speed);
    let mueller = derived(&changed("\"wcsph\"", "\"mueller2003\"\nstiffness = 900"));
    assert!(near(mueller.sound_speed, 30.0));
    let back = derived(&changed("\"wcsph\"", "\"mueller2003\"\nsound_speed = 30"));
    assert!(near(back.stiffness, 900.0));
}

#[test]
fn the_reference_speed_follows_from_the_driving_forces() {
    let speed = |text: &str| derived(text).reference_speed;
    // A block in the air: its top is 1 m above the floor. sqrt(4 * 9.81 * 1).
    assert!(near(speed(&changed("position = [0, 0, 0]", "position = [0, 0.5, 0]")), 6.26418));
    // With a velocity: sqrt(4 * 9.81 * 0.5 + 9).
    assert!(near(
        speed(&changed("position = [0, 0, 0]", "position = [0, 0, 0]\nvelocity = [3, 0, 0]")),
        5.34977
    ));
    // Sideways gravity: the block leans at x = 0, gravity pulls to +x: 1 m of fall.
    assert!(near(speed(&changed("frame_rate = 25", "gravity = [9.81, 0, 0]")), 6.26418));
    // An oscillating domain adds 2 pi 0.1 / 0.5.
    assert!(near(
        speed(&changed("[fluid]", "oscillation = { amplitude = [0.1, 0, 0], period = 0.5 }\n[fluid]")),
        4.42945 + 1.25664
    ));
    // No driving force; then surface tension alone: sqrt(2 * 0.07274 / (998.2 * 0.05)).
    let floating = changed("frame_rate = 25", "gravity = [0, 0, 0]");
    assert!(near(speed(&floating), 0.01));
    assert!(near(speed(&format!("{floating}surface_tension = \"akinci2013\"\n")), 0.053_990));
}

#[test]
fn each_time_step_limit_can_be_the_smallest() {
    let thick = derived(&changed("particle_spacing = 0.05", "particle_spacing = 0.05\nviscosity = 10"));
    assert_eq!(thick.dt_limit, "viscosity");
    assert!(near(thick.dt_estimate, 0.125 * 0.05 * 0.05 / 10.0));
    let short = derived(&format!("{CUBE}max_dt = 1e-5\n"));
    assert_eq!((short.dt_limit, short.dt_estimate), ("max_dt", 1e-5));
}

#[test]
fn the_frame_count_is_free_of_rounding_errors() {
    let frames = |duration: &str, rate: &str| {
        parse(&changed("duration = 1.0", &format!("duration = {duration}")).replace("25", rate))
            .expect("valid")
            .frame_count()
    };
    assert_eq!(frames("0.1", "30"), 3);
    assert_eq!(frames("1.5", "40"), 60);
    assert_eq!(frames("0.11", "30"), 4, "a fraction of a frame counts as a frame");
    assert_eq!(frames("1e-4", "1"), 1);
}

#[test]
fn an_oscillating_domain_adds_the_opposite_acceleration() {
    let text = changed("[fluid]", "oscillation = { amplitude = [0.1, 0, 0], period = 0.5 }\n[fluid]");
    let scene: Scene = parse(&text).expect("valid");
    let oscillation = scene.domain.oscillation.expect("the domain oscillates");
    let place = |t: f64| 0.1 * (std::f64::consts::TAU * t / 0.5).sin();
    let (t, step) = (0.13, 1e-4);
    let tank = (place(t + step) - 2.0 * place(t) + place(t - step)) / (step * step);
    assert!((f64::from(oscillation.acceleration(t).x) + tank).abs() < 1e-3 * tank.abs());
    assert_eq!(oscillation.acceleration(t) * Vec3::new(0.0, 1.0, 1.0), Vec3::ZERO);
}

#[test]
fn engineering_accuracy_selects_the_settings_for_pressures() {
    let with = |keys: &str| {
        parse(&CUBE.replace("[solver]", &format!("[solver]\naccuracy = \"engineering\"\n{keys}")))
    };
    let solver = with("").unwrap().solver;
    assert_eq!(solver.density, DensityMode::Continuity);
    assert_eq!((solver.support_ratio, solver.artificial_viscosity), (3.0, 0.0));
    assert_eq!(solver.negative_pressure, NegativePressure::Keep);
    // Explicit keys take precedence, unless they contradict the purpose.
    assert_eq!(with("support_ratio = 2.5").unwrap().solver.support_ratio, 2.5);
    let error = with("density = \"summation\"").unwrap_err().to_string();
    assert!(error.contains("does not work with accuracy = \"engineering\""), "{error}");
    // Control: the defaults are others.
    let usual = parse(CUBE).unwrap().solver;
    assert_eq!((usual.density, usual.support_ratio), (DensityMode::Summation, 2.0));
}
