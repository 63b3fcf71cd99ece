//! Probes in complete scenes.

use glam::DVec3;
use splashdown::probes::ProbeRows;
use splashdown::scene::Scene;
use splashdown::{Device, Event, Run, RunOptions, Simulation};
use splashdown_gpu::{Executor, testing};

/// A tank of still water, 0.4 m deep, with a cube of 0.15 m away from the walls.
const TANK: &str = r#"
    [scene]
    name = "tank"
    duration = 0.4
    frame_rate = 5
    [domain]
    min = [0, 0, 0]
    max = [0.4, 0.6, 0.4]
    [solver]
    density = "continuity"
    support_ratio = 3
    [fluid]
    particle_spacing = 0.025
    [[fluid.block]]
    position = [0, 0, 0]
    size = [0.4, 0.4, 0.4]
    [surface]
    enabled = false
    [[body]]
    name = "cube"
    mesh = "cube"
    scale = 0.15
    position = [0.2, 0.2, 0.2]
    [[probe]]
    name = "floor"
    quantity = "pressure"
    position = [0.06, 0, 0.06]
    interval = 0.05
    [[probe]]
    name = "wall"
    quantity = "pressure"
    position = [0, 0.2, 0.34]
    [[probe]]
    name = "air"
    quantity = "pressure"
    position = [0.2, 0.55, 0.2]
    [[probe]]
    name = "level"
    quantity = "height"
    position = [0.06, 0, 0.34]
    [[probe]]
    name = "cube"
    quantity = "force"
    body = "cube"
    "#;

fn mean(rows: &ProbeRows, column: usize, from: f64) -> f64 {
    let late: Vec<f64> = rows.iter().filter(|row| row[0] > from).map(|row| row[column]).collect();
    assert!(late.len() > 3, "{} rows after {from} s", late.len());
    late.iter().sum::<f64>() / late.len() as f64
}

#[test]
fn probes_in_still_water_measure_hydrostatic_pressure_and_level() {
    let scene = Scene::parse(TANK, "tank.toml").unwrap();
    for (name, executor) in testing::executors("probes_in_still_water_measure_hydrostatic_pressure_and_level")
    {
        let mut simulation = Simulation::with_executor(&scene, executor).unwrap();
        let mut taken: Vec<ProbeRows> = vec![Vec::new(); 5];
        for frame in 0..2 {
            simulation.advance(0.2).unwrap();
            for (all, rows) in taken.iter_mut().zip(simulation.take_probe_rows()) {
                assert!(!rows.is_empty(), "{name}: frame {frame}");
                all.extend(rows);
            }
        }
        assert!(simulation.take_probe_rows().iter().all(Vec::is_empty), "{name}: rows were returned twice");
        // The times of rows are exact within half a step, and in order.
        for (rows, interval) in taken.iter().zip([0.05, 0.02, 0.02, 0.02, 0.02]) {
            assert!((rows.len() as f64 - 0.4 / interval).abs() <= 1.0, "{name}: {} rows", rows.len());
            for (k, row) in rows.iter().enumerate() {
                assert!((row[0] - interval * (k + 1) as f64).abs() < 1e-3, "{name}: row {k} at {}", row[0]);
            }
        }
        // The water fills the volume of the tank minus that of the cube.
        let depth = f64::from(simulation.stats().particles) * 0.025_f64.powi(3) + 0.15_f64.powi(3);
        let depth = depth / 0.16;
        let weight = 1000.0 * 9.81 * depth;
        let floor = mean(&taken[0], 1, 0.2);
        assert!((floor - weight).abs() < 0.04 * weight, "{name}: {floor} Pa at the floor of {weight}");
        let wall = mean(&taken[1], 1, 0.2);
        let above = weight - 9810.0 * 0.2;
        assert!((wall - above).abs() < 0.05 * above, "{name}: {wall} Pa at the wall of {above}");
        assert!(taken[2].iter().all(|row| row[1] == 0.0), "{name}: pressure in the air");
        let level = mean(&taken[3], 1, 0.2);
        assert!((level - depth).abs() < 0.025, "{name}: level {level} m of {depth}");
        let lift = mean(&taken[4], 2, 0.2);
        let displaced = 9810.0 * 0.15_f64.powi(3);
        assert!((lift - displaced).abs() < 0.25 * displaced, "{name}: {lift} N of {displaced}");
        let aside = mean(&taken[4], 1, 0.2).abs();
        assert!(aside < 0.05 * displaced, "{name}: {aside} N along x");
    }
}

/// A jet without gravity, through a rectangle, past another one, and through one with the opposite normal.
const JET: &str = r#"
    [scene]
    name = "jet"
    duration = 0.5
    frame_rate = 10
    gravity = [0, 0, 0]
    [domain]
    min = [0, 0, 0]
    max = [1, 1, 1]
    open = ["x_max"]
    [fluid]
    particle_spacing = 0.02
    [surface]
    enabled = false
    [[emitter]]
    name = "nozzle"
    radius = 0.1
    position = [0.2, 0.5, 0.5]
    direction = [1, 0, 0]
    speed = 2
    [[probe]]
    name = "through"
    quantity = "flow"
    position = [0.5, 0.5, 0.5]
    normal = [2, 0, 0]
    size = [0.4, 0.4]
    interval = 0.05
    [[probe]]
    name = "against"
    quantity = "flow"
    position = [0.5, 0.5, 0.5]
    normal = [-1, 0, 0.5]
    size = [0.6, 0.6]
    [[probe]]
    name = "past"
    quantity = "flow"
    position = [0.5, 0.8, 0.5]
    normal = [1, 0, 0]
    size = [0.2, 0.2]
    "#;

#[test]
fn the_measured_flow_equals_the_emitted_flow() {
    let scene = Scene::parse(JET, "jet.toml").unwrap();
    let poured = std::f64::consts::PI * 0.1_f64.powi(2) * 2.0;
    for (name, executor) in testing::executors("the_measured_flow_equals_the_emitted_flow") {
        let mut simulation = Simulation::with_executor(&scene, executor).unwrap();
        let mut taken: Vec<ProbeRows> = vec![Vec::new(); 3];
        for _ in 0..5 {
            simulation.advance(0.1).unwrap();
            for (all, rows) in taken.iter_mut().zip(simulation.take_probe_rows()) {
                all.extend(rows);
            }
        }
        // The jet arrives after 0.15 s.
        assert!(taken[0].iter().all(|row| row[0] > 0.14 || row[1] == 0.0), "{name}: {:?}", taken[0]);
        let through = mean(&taken[0], 1, 0.21);
        assert!((through - poured).abs() < 0.06 * poured, "{name}: {through} of {poured} m^3/s");
        let against = mean(&taken[1], 1, 0.21);
        assert!((against + poured).abs() < 0.06 * poured, "{name}: {against} of {poured} m^3/s");
        assert!(taken[2].iter().all(|row| row[1] == 0.0), "{name}: {:?}", taken[2]);
    }
}

#[test]
fn a_run_returns_probe_rows_with_its_frames() {
    let mut scene = Scene::parse(JET, "jet.toml").unwrap();
    scene.probes.truncate(1);
    let options = RunOptions::new(&scene).with_device(Device::Cpu).with_frames(2);
    let mut counts = Vec::new();
    for event in Run::new(&scene, options).unwrap() {
        if let Event::Frame(frame) = event.unwrap() {
            assert_eq!(frame.probes.len(), 1);
            counts.push(frame.probes[0].len());
        }
    }
    assert_eq!(counts, [0, 2, 2]);
}

#[test]
fn a_probe_inside_a_body_is_reported() {
    let text = TANK.replace("position = [0, 0.2, 0.34]", "position = [0.2, 0.2, 0.2]");
    let scene = Scene::parse(&text, "tank.toml").unwrap();
    let options = RunOptions::new(&scene).with_device(Device::Cpu).with_frames(0);
    let warnings: Vec<String> = Run::new(&scene, options)
        .unwrap()
        .filter_map(|event| if let Event::Warning(text) = event.unwrap() { Some(text) } else { None })
        .collect();
    assert!(warnings[0].contains("probe \"wall\" is 75 mm inside body \"cube\""), "{warnings:?}");
    assert_eq!(warnings.len(), 1, "{warnings:?}");
}

/// A frame of the caller may be longer than one of the scene.
#[test]
fn no_row_is_lost_in_a_long_frame() {
    let text =
        TANK.replace("interval = 0.05", "interval = 0.001").replace("frame_rate = 5", "frame_rate = 50");
    let scene = Scene::parse(&text, "tank.toml").unwrap();
    let mut simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
    simulation.advance(0.4).unwrap();
    let rows = simulation.take_probe_rows();
    // The rows of the others begin elsewhere in a longer frame.
    for (probe, rows) in scene.probes.iter().zip(&rows) {
        let times: Vec<f64> = rows.iter().map(|row| row[0]).collect();
        // A row is due once per interval, or once per step where steps are longer.
        let most = times.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
        let (name, interval) = (&probe.name, probe.interval.map_or(0.01, f64::from));
        assert!(
            most < interval + 0.003 && times.len() as f64 > 0.4 / (interval + 0.001),
            "{name}: {times:?}"
        );
    }
}

/// A cube that falls into water and floats, a stone that falls to the floor, and a paddle that a script moves.
const BODIES: &str = r#"
    [scene]
    name = "bodies"
    duration = 0.4
    frame_rate = 10
    [domain]
    min = [0, 0, 0]
    max = [0.5, 0.5, 0.4]
    [fluid]
    particle_spacing = 0.025
    [[fluid.block]]
    position = [0, 0, 0]
    size = [0.5, 0.2, 0.4]
    [surface]
    enabled = false
    [[body]]
    name = "cube"
    mesh = "cube"
    scale = 0.1
    position = [0.15, 0.26, 0.2]
    rotation = [10, 20, 0]
    motion = "dynamic"
    density = 500
    [[body]]
    name = "stone"
    mesh = "sphere"
    scale = 0.1
    position = [0.35, 0.06, 0.1]
    motion = "dynamic"
    density = 3000
    [[body]]
    name = "paddle"
    mesh = "cube"
    scale = 0.05
    position = [0.35, 0.15, 0.3]
    motion = "scripted"
    move = ["0.03*sin(10*t)", "0", "0"]
    [[probe]]
    name = "cube"
    quantity = "body"
    body = "cube"
    interval = 0.02
    [[probe]]
    name = "cube_force"
    quantity = "force"
    body = "cube"
    interval = 0.02
    [[probe]]
    name = "stone"
    quantity = "body"
    body = "stone"
    interval = 0.005
    [[probe]]
    name = "paddle"
    quantity = "body"
    body = "paddle"
    interval = 0.005
    "#;

const EXPLICIT: &str = "[solver]\nmethod = \"wcsph\"\n";

/// The columns of a body probe after the time.
const POSITION: usize = 1;
const ORIENTATION: usize = 4;
const VELOCITY: usize = 8;
const FORCE: usize = 14;

/// The simulation of [`BODIES`] after this many frames of 0.1 s, and its rows.
fn bodies_after(frames: usize, extra: &str, executor: Executor) -> (Simulation, Vec<ProbeRows>) {
    let scene = Scene::parse(&format!("{BODIES}{extra}"), "bodies.toml").unwrap();
    let mut simulation = Simulation::with_executor(&scene, executor).unwrap();
    for _ in 0..frames {
        simulation.advance(0.1).unwrap();
    }
    let rows = simulation.take_probe_rows();
    (simulation, rows)
}

fn vector(row: &[f64], first: usize) -> DVec3 {
    DVec3::from_slice(&row[first..])
}

/// The largest difference in N s between the changes of momentum of the cube and the impulses of these rows' forces and of
/// gravity.
fn lost_impulse(rows: &[Vec<f64>], forces: &[Vec<f64>], gravity: f64) -> f64 {
    let mass = 500.0 * 0.1_f64.powi(3);
    let difference = |(pair, force): (&[Vec<f64>], &Vec<f64>)| {
        let gained = mass * (vector(&pair[1], VELOCITY) - vector(&pair[0], VELOCITY));
        let total = vector(force, FORCE) - mass * gravity * DVec3::Y;
        (gained - (pair[1][0] - pair[0][0]) * total).length()
    };
    rows.windows(2).zip(forces).map(difference).fold(0.0, f64::max)
}

#[test]
fn the_motion_of_a_floating_body_follows_from_the_force_in_its_probe() {
    for (frames, extra) in [(4, ""), (2, EXPLICIT)] {
        for (name, executor) in
            testing::executors("the_motion_of_a_floating_body_follows_from_the_force_in_its_probe")
        {
            let (_, rows) = bodies_after(frames, extra, executor);
            let [cube, force] = [&rows[0], &rows[1]];
            assert!([cube.len(), force.len()] == [5 * frames; 2], "{name}: {} rows", cube.len());
            // Both accumulate the same numbers in the same order.
            assert!(
                cube.iter().zip(force).all(|(cube, force)| cube[FORCE..] == force[1..]),
                "{name}: forces"
            );
            // Single precision: each of up to forty steps of a row rounds a momentum of 0.5 N s by 3e-8 of it, and the times
            // of rows are exact to 1e-8 s, at forces below 20 N. The impulse of gravity in a row is 0.1 N s.
            let lost = lost_impulse(cube, &cube[1..], 9.81);
            assert!(lost < 1e-6, "{name}: {lost} N s");
            // Controls: the forces of the previous rows, and a gravity that is wrong by a ten thousandth.
            let controls = [lost_impulse(cube, cube, 9.81), lost_impulse(cube, &cube[1..], 9.811)];
            assert!(controls[0] > 1e-3 && controls[1] > 5e-6, "{name}: {controls:?} N s");
        }
    }
}

#[test]
fn the_last_row_of_a_body_is_its_state_after_contacts() {
    for (frames, extra) in [(4, ""), (2, EXPLICIT)] {
        for (name, executor) in testing::executors("the_last_row_of_a_body_is_its_state_after_contacts") {
            let (mut simulation, rows) = bodies_after(frames, extra, executor);
            let states = simulation.body_states().unwrap();
            for (state, rows) in states.iter().zip([&rows[0], &rows[2], &rows[3]]) {
                let last = rows.last().unwrap();
                assert!(
                    (last[0] - 0.1 * frames as f64).abs() < 1e-6,
                    "{name}: the last row is at {} s",
                    last[0]
                );
                // The same single-precision formula on the device and on the host.
                let same = |first: usize, values: &[f32]| {
                    let rows = last[first..].iter();
                    rows.zip(values).all(|(a, b)| (a - f64::from(*b)).abs() < 1e-6)
                };
                assert!(same(POSITION, &state.position.to_array()), "{name}: {last:?} {state:?}");
                assert!(same(ORIENTATION, &state.orientation.to_array()), "{name}: {last:?} {state:?}");
                assert!(same(VELOCITY, &state.velocity.to_array()), "{name}: {last:?} {state:?}");
            }
            // With an implicit pressure contacts act after every step. The stone rests on the floor. Before the contact acts,
            // gravity has accelerated it in every step.
            if extra.is_empty() {
                let late = rows[2].iter().filter(|row| row[0] > 0.3).map(|row| row[VELOCITY + 1]);
                let (sum, count) = late.fold((0.0, 0), |(sum, count), speed| (sum + speed, count + 1));
                let (mean, step) = (sum / f64::from(count), 9.81 * f64::from(simulation.stats().dt));
                assert!(mean.abs() < 0.2 * step, "{name}: {mean} m/s, gravity in a step {step} m/s");
            }
        }
    }
}

#[test]
fn the_rows_of_a_scripted_body_follow_its_script() {
    for (name, executor) in testing::executors("the_rows_of_a_scripted_body_follow_its_script") {
        let (_, rows) = bodies_after(4, "", executor);
        let error = |shift: f64| {
            let paddle = rows[3].iter();
            let difference = |row: &Vec<f64>| {
                let (sine, cosine) = (10.0 * (row[0] + shift)).sin_cos();
                (row[POSITION] - 0.35 - 0.03 * sine).abs() + (row[VELOCITY] - 0.3 * cosine).abs() / 10.0
            };
            paddle.map(difference).fold(0.0, f64::max)
        };
        // The motion is interpolated between samples every 1.6 ms.
        assert!(error(0.0) < 1e-5, "{name}: {}", error(0.0));
        // Control: the states a tenth of a millisecond later.
        assert!(error(1e-4) > 2e-5, "{name}: {}", error(1e-4));
        let pushed = rows[3].iter().map(|row| vector(row, FORCE).length()).fold(0.0, f64::max);
        assert!(pushed > 0.5, "{name}: the water exerts {pushed} N");
    }
}
