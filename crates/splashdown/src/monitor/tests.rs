use super::*;
use crate::run::{Event, Frame, Run, RunOptions};
use crate::scene::OnBurst;
use crate::{Device, SimulationError};

/// The frames of a scene in a box of 1.6 m, with these sections added.
fn frames(scene: &str, fluid: &str, rest: &str) -> Vec<Frame> {
    let (frames, error, _) = run(scene, fluid, rest, OnBurst::Stop);
    assert!(error.is_none(), "{error:?}");
    frames
}

/// The frames, the error and the alarms of a run.
fn run(
    scene: &str,
    fluid: &str,
    rest: &str,
    on_burst: OnBurst,
) -> (Vec<Frame>, Option<SimulationError>, Vec<Alarm>) {
    let text = format!(
        "[scene]\nname = \"test\"\n{scene}\n[domain]\nmin = [0, 0, 0]\nmax = [1.6, 1.6, 1.6]\n[surface]\nenabled = false\n\
         [fluid]\nparticle_spacing = 0.1\n{fluid}\n{rest}"
    );
    run_text(&text, on_burst)
}

/// The same for a whole scene.
fn run_text(text: &str, on_burst: OnBurst) -> (Vec<Frame>, Option<SimulationError>, Vec<Alarm>) {
    let scene = Scene::parse(text, "test.toml").unwrap_or_else(|errors| panic!("{errors}"));
    let options = RunOptions::new(&scene).with_device(Device::Cpu).with_on_burst(on_burst);
    let (mut frames, mut alarms) = (Vec::new(), Vec::new());
    for event in Run::new(&scene, options).unwrap() {
        match event {
            Ok(Event::Frame(frame)) => frames.push(frame),
            Ok(Event::Alarm(alarm)) => alarms.push(alarm),
            Ok(_) => {}
            Err(error) => return (frames, Some(error), alarms),
        }
    }
    (frames, None, alarms)
}

const BLOCK: &str = "[[fluid.block]]\nposition = [0.5, 0.8, 0.5]\nsize = [0.5, 0.5, 0.5]";

const WCSPH: &str = "[solver]\nmethod = \"wcsph\"";

/// The largest remainder of the balance in a frame, as a fraction of the energy that took part until the end.
fn remainder(frames: &[Frame]) -> f64 {
    let largest = frames.iter().map(|frame| frame.energy.dissipated.abs()).fold(0.0, f64::max);
    largest / frames[frames.len() - 1].energy.available
}

#[test]
fn the_balance_of_a_free_fall_closes() {
    // The steps of the default are so long that a fall is first-order accurate.
    let frames = frames("duration = 0.3", BLOCK, WCSPH);
    let (start, end) = (frames[0].energy, frames[frames.len() - 1].energy);
    assert!(end.kinetic > 0.3 * start.potential, "it falls: {end:?}");
    assert!(remainder(&frames) < 0.01, "{end:?}");
}

#[test]
fn the_work_of_shaking_is_the_kinetic_energy_of_a_floating_block() {
    let scene = "duration = 0.4\ngravity = [0, 0, 0]";
    // The work of a step is first-order accurate.
    let rest = "[solver]\nmethod = \"wcsph\"\ncfl_factor = 0.3\n[domain.oscillation]\namplitude = [0.1, 0.0, 0.05]\nperiod = 0.7";
    let frames = frames(scene, BLOCK, rest);
    let end = frames[frames.len() - 1].energy;
    assert!(end.shaking > 1.0 && end.kinetic > 1.0, "{end:?}");
    assert!(remainder(&frames) < 0.01, "{end:?}");
}

#[test]
fn a_jet_brings_its_kinetic_energy_and_a_sink_takes_it() {
    let scene = "duration = 0.9\ngravity = [0, 0, 0]";
    let jet = "[[emitter]]\nname = \"jet\"\nposition = [0.5, 0.8, 0.8]\ndirection = [1, 0, 0]\nspeed = 2.0\nradius = 0.25\n\
        [[sink]]\nname = \"drain\"\nmin = [1.2, 0.0, 0.0]\nmax = [1.6, 1.6, 1.6]";
    let frames = frames(scene, "", jet);
    let end = &frames[frames.len() - 1];
    let each = 2.0 * 1000.0 * 0.001;
    assert!((end.energy.emitted / (each * f64::from(end.stats.emitted)) - 1.0).abs() < 0.02, "{end:?}");
    assert!((end.energy.removed / (each * f64::from(end.stats.drained)) - 1.0).abs() < 0.02, "{end:?}");
    assert!(end.stats.drained > 50 && remainder(&frames) < 0.01, "{:?}", end.energy);
}

#[test]
fn a_body_that_pushes_water_does_the_work_that_the_water_gains() {
    let scene = "duration = 0.2\ngravity = [0, 0, 0]";
    let fluid = "[[fluid.block]]\nposition = [0.0, 0.0, 0.0]\nsize = [1.6, 0.5, 1.6]";
    let plate = "[[body]]\nname = \"plate\"\nmesh = \"cube\"\nscale = 0.3\nposition = [0.8, 0.75, 0.8]\nmove = [\"0\", \"-1.0*t\", \"0\"]";
    let frames = frames(scene, fluid, plate);
    let end = frames[frames.len() - 1].energy;
    assert!(end.bodies > 1.0, "{end:?}");
    // The water is inviscid apart from numerical damping, which takes a part and never adds.
    assert!(end.dissipated > -0.01 * end.bodies && end.dissipated < 0.6 * end.bodies, "{end:?}");
}

#[test]
fn collapsed_fluid_stops_the_run_after_its_frame() {
    let soft = "[solver]\nsound_speed = 0.05";
    let fluid =
        "initial_pressure = \"zero\"\n[[fluid.block]]\nposition = [0.0, 0.0, 0.0]\nsize = [1.6, 1.2, 1.6]";
    let (stopped, error, alarms) = run("duration = 1.0", fluid, soft, OnBurst::Stop);
    let Some(SimulationError::Burst { time, message }) = error else { panic!("{error:?}") };
    let last = stopped.last().unwrap();
    assert!(last.level == Level::Stop && (last.time - time).abs() < 1e-9, "{time} {message}");
    assert!(
        message.contains("% ")
            && message.contains(" m at the side ")
            && message.contains("Raise solver.sound_speed"),
        "{message}"
    );
    assert!(alarms.iter().any(|alarm| alarm.level == Level::Stop && alarm.message == message));
    // Control: with another reaction it continues to the end.
    let (all, error, alarms) = run("duration = 1.0", fluid, soft, OnBurst::Warn);
    assert!(error.is_none() && all.len() == 51 && !alarms.is_empty(), "{error:?}");
}

/// Three impacts meet in the corner and compress the water by a fifth, so that sound travels 1.7 times as fast there. With
/// steps for the speed of sound at rest the water gained 61 % energy.
#[test]
fn water_that_is_thrown_into_a_corner_gains_no_energy() {
    let text = "[scene]\nname = \"throw\"\nduration = 0.01\nframe_rate = 500\ngravity = [0, 0, 0]\n\
        [domain]\nmin = [0, 0, 0]\nmax = [0.4, 0.3, 0.5]\n[fluid]\nparticle_spacing = 0.025\n\
        initial_pressure = \"zero\"\n[[fluid.block]]\nposition = [0, 0, 0]\nsize = [0.4, 0.175, 0.5]\n\
        velocity = [-3.4, -4.8, 2.1]\n[solver]\nmethod = \"wcsph\"\ndensity = \"continuity\"";
    let (frames, error, alarms) = run_text(text, OnBurst::Stop);
    assert!(error.is_none() && frames.len() == 6, "{error:?}");
    let gains = alarms.iter().filter(|alarm| alarm.watched == Watched::EnergyGain);
    assert_eq!(gains.count(), 0, "{alarms:?}");
    // The impact happens: most of the kinetic energy is in the compressed water after a frame.
    assert!(frames[1].energy.kinetic < 0.5 * frames[0].energy.kinetic);
}

/// The surface has few neighbours, and its summed density is below that at rest.
#[test]
fn an_imploding_surface_is_explained() {
    let fluid = "[[fluid.block]]\nposition = [0.3, 0.0, 0.3]\nsize = [0.8, 0.8, 0.8]";
    let keep = format!("{WCSPH}\nnegative_pressure = \"keep\"");
    let (_, error, _) = run("duration = 0.2", fluid, &keep, OnBurst::Stop);
    let Some(SimulationError::Burst { message, .. }) = error else { panic!("{error:?}") };
    assert!(message.contains("energy from nowhere") && message.contains("\"clamp\""), "{message}");
}

#[test]
fn a_plain_dam_break_raises_no_alarm() {
    let fluid = "[[fluid.block]]\nposition = [0.0, 0.0, 0.0]\nsize = [0.6, 1.0, 1.6]";
    let (frames, error, alarms) = run("duration = 0.5", fluid, "", OnBurst::Stop);
    assert!(error.is_none() && alarms.iter().all(|alarm| alarm.level < Level::Warning), "{alarms:?}");
    let end = frames[frames.len() - 1].energy;
    assert!(end.dissipated > 0.0, "{end:?}");
}

#[test]
fn a_later_rise_within_a_level_is_reported_again() {
    let scene = Scene::builder("box", 1.0)
        .domain([0.0; 3], [0.8, 0.8, 0.4])
        .particle_spacing(0.05)
        .block([0.0; 3], [0.4, 0.4, 0.4])
        .set("solver.method", "wcsph")
        .build()
        .unwrap();
    let mut simulation = crate::Simulation::new(&scene, &Device::Cpu).unwrap();
    let particles = simulation.particles().unwrap();
    let mut monitor = simulation.monitor();
    let mut observe = |density_error: f32| {
        let stats = Stats { density_error, ..Stats::default() };
        let nearest = |_: Vec3| None;
        let observed =
            Observed { time: 0.1, stats: &stats, particles: &particles, bodies: &[], nearest: &nearest };
        let found = monitor.observe(observed);
        found.alarms.into_iter().map(|alarm| (alarm.level, alarm.watched)).collect::<Vec<_>>()
    };
    assert_eq!(observe(0.01), []);
    assert_eq!(observe(0.44), [(Level::Warning, Watched::Compression)]);
    assert_eq!(observe(0.46), []);
    assert_eq!(observe(0.95), [(Level::Warning, Watched::Compression)]);
    assert_eq!(observe(10.15), [(Level::Stop, Watched::Compression)]);
    assert_eq!(observe(10.2), []);
    assert_eq!(observe(f32::NAN), [] as [(Level, Watched); 0], "already at the highest level");
}

/// Water 0.4 m deep in a half of a box.
fn still_water() -> Scene {
    Scene::builder("box", 1.0)
        .domain([0.0; 3], [0.8, 0.8, 0.4])
        .particle_spacing(0.05)
        .block([0.0; 3], [0.4, 0.4, 0.4])
        .build()
        .unwrap()
}

#[test]
fn overlapping_particles_are_named_as_the_cause_only_if_they_overlap() {
    let scene = still_water();
    let message = |scale: f32| {
        let mut simulation = crate::Simulation::new(&scene, &Device::Cpu).unwrap();
        let mut particles = simulation.particles().unwrap();
        particles.positions.iter_mut().flatten().for_each(|x| *x *= scale);
        let mut monitor = simulation.monitor();
        let mut observe = |steps, speed: f32, particles: &mut Particles| {
            particles.velocities.fill([0.0, speed, 0.0]);
            let stats = Stats { steps, ..Stats::default() };
            let time = 1e-4 * steps as f64;
            monitor.observe(Observed { time, stats: &stats, particles, bodies: &[], nearest: &|_| None })
        };
        observe(0, 0.0, &mut particles);
        let found = observe(1, 50.0, &mut particles);
        found.alarms.into_iter().find(|alarm| alarm.watched == Watched::Speed).unwrap().message
    };
    assert!(message(0.9).contains("overlap at the start"), "{}", message(0.9));
    assert!(!message(1.0).contains("overlap at the start"), "{}", message(1.0));
}

/// A cloud of particles without gravity that relaxed by half a spacing was reported as a burst.
#[test]
fn fluid_that_nothing_drives_may_move_by_a_part_of_a_spacing() {
    let scene = Scene::builder("box", 1.0)
        .domain([0.0; 3], [0.8, 0.8, 0.8])
        .particle_spacing(0.05)
        .block([0.2; 3], [0.4; 3])
        .set("scene.gravity", [0.0; 3])
        .build()
        .unwrap();
    let noticeable = |reference_speed| energy::noticeable_speed(&scene, reference_speed);
    assert!((noticeable(0.01_f32.into()) - 0.1).abs() < 1e-6 && noticeable(0.02) == 0.0);
    let levels = |speed: f32| {
        let mut simulation = crate::Simulation::new(&scene, &Device::Cpu).unwrap();
        let mut particles = simulation.particles().unwrap();
        let mut monitor = simulation.monitor();
        let mut observe = |time, steps, speed: f32| {
            particles.velocities.iter_mut().enumerate().for_each(|(i, v)| v[i % 3] = speed);
            let stats = Stats { steps, ..Stats::default() };
            let observed =
                Observed { time, stats: &stats, particles: &particles, bodies: &[], nearest: &|_| None };
            monitor.observe(observed);
        };
        observe(0.0, 0, 0.0);
        observe(0.1, 1, speed);
        monitor.level()
    };
    // Two spacings in the time of the scene are 0.1 m/s.
    assert_eq!(levels(0.01), Level::Sound);
    assert!(levels(1.0) >= Level::Warning, "negative control: ten times that");
}

/// Findings of still water with the speeds of its first particles, at the start and after a step.
fn with_speeds(speeds: &[f32], later: &[f32]) -> (Vec<Alarm>, Vec<Alarm>) {
    let scene = still_water();
    let mut simulation = crate::Simulation::new(&scene, &Device::Cpu).unwrap();
    let mut particles = simulation.particles().unwrap();
    let mut monitor = simulation.monitor();
    let mut observe = |steps, speeds: &[f32]| {
        particles.velocities.fill([0.0; 3]);
        for (v, &speed) in particles.velocities.iter_mut().zip(speeds) {
            *v = [0.0, speed, 0.0];
        }
        let stats = Stats { steps, ..Stats::default() };
        let time = 1e-3 * steps as f64;
        let observed =
            Observed { time, stats: &stats, particles: &particles, bodies: &[], nearest: &|_| None };
        monitor.observe(observed).alarms
    };
    (observe(0, speeds), observe(1, later))
}

#[test]
fn a_single_fast_particle_is_reported_and_does_not_permit_others_to_be_fast() {
    // The fluid is 0.4 m high: 2.8 m/s.
    let (start, later) = with_speeds(&[300.0], &[300.0, 100.0]);
    assert!(start.len() == 1 && start[0].level == Level::Warning, "{start:?}");
    assert!(start[0].message.contains("1 particle starts at up to 300.000 m/s"), "{}", start[0].message);
    let fast = |alarms: &[Alarm]| {
        alarms.iter().find(|alarm| alarm.watched == Watched::Speed).map(|alarm| alarm.level)
    };
    assert_eq!(fast(&later), Some(Level::Stop), "another one at 100 m/s: {later:?}");
    // Controls: the particle itself is not a burst, and neither is a fast piece of fluid.
    assert_eq!(fast(&with_speeds(&[300.0], &[300.0, 2.0]).1), None);
    let (start, later) = with_speeds(&[300.0; 8], &[100.0; 8]);
    assert!(start.is_empty() && fast(&later).is_none(), "{start:?} {later:?}");
}

/// The largest level of the speed in a run of a falling block with a body that is moved like this in the first second.
fn scripted_speed(position: [f32; 3], motion: &str) -> f64 {
    let [x, y, z] = position;
    let text = format!(
        "[scene]\nname = \"test\"\nduration = 0.2\n[domain]\nmin = [0, 0, 0]\nmax = [1.6, 1.6, 1.6]\n[surface]\nenabled = false\n\
         [fluid]\nparticle_spacing = 0.1\n[[fluid.block]]\nposition = [0, 0, 0]\nsize = [0.8, 0.4, 1.6]\n\
         [[body]]\nname = \"fan\"\nmesh = \"cube\"\nscale = 0.2\nposition = [{x}, {y}, {z}]\n{motion}\n"
    );
    let scene = Scene::parse(&text, "test.toml").unwrap_or_else(|errors| panic!("{errors}"));
    let mut simulation = crate::Simulation::new(&scene, &Device::Cpu).unwrap();
    let mut monitor = simulation.monitor();
    for frame in 0..4 {
        if frame > 0 {
            simulation.advance(0.05).unwrap();
        }
        splashdown_gpu::block_on(simulation.examine_async(&mut monitor)).unwrap();
    }
    monitor.body_speed
}

#[test]
fn only_bodies_near_the_fluid_permit_it_to_be_fast() {
    let turning = "turn = [\"0\", \"3000 * t\", \"0\"]";
    let fast = scripted_speed([0.8, 0.3, 0.8], turning);
    assert!(fast > 5.0, "control: beside the fluid, {fast}");
    assert_eq!(scripted_speed([1.3, 1.4, 0.8], turning), 0.0);
    // A jump by 0.3 m.
    let jump = scripted_speed([0.6, 0.3, 0.8], "move = [\"0.3 * floor(t / 0.1)\", \"0\", \"0\"]");
    assert!(jump < 4.0 * 0.3 / 0.05 + 1.0, "{jump}");
}

#[test]
fn corrections_at_a_dynamic_body_advise_shorter_steps() {
    let body = |name: &str, rest: &str| {
        format!(
            "[[body]]\nname = \"{name}\"\nmesh = \"sphere\"\nscale = 0.3\nposition = [0.8, 1.2, 0.8]\n{rest}\n"
        )
    };
    let text = format!(
        "[scene]\nname = \"test\"\nduration = 1\n[domain]\nmin = [0, 0, 0]\nmax = [1.6, 1.6, 1.6]\n\
         [fluid]\nparticle_spacing = 0.1\n{BLOCK}\n{}{}",
        body("cork", "motion = \"dynamic\"\ndensity = 300"),
        body("post", "")
    );
    let scene = Scene::parse(&text, "test.toml").unwrap_or_else(|errors| panic!("{errors}"));
    let context = Context::new(&scene, 10.0, 1.0);
    let message = |name| {
        let place = Some(Vec3::splat(0.8));
        let watched = Watched::WallCorrections;
        let (value, time, body) = (2.0, 1.0, Some((0.0, name)));
        context.message(&Rise { watched, value, time, place, body, allowed_speed: 1.0 })
    };
    assert!(message("cork").contains("Lower solver.cfl_factor (now 0.7)"), "{}", message("cork"));
    // Control: nothing moves a static body.
    assert!(message("post").contains("parts or gaps thinner"), "{}", message("post"));
    assert!(!message("post").contains("meets water"), "{}", message("post"));
}
