//! Advances a scene and prints its statistics and the time of every pass:
//! `cargo run --release -p splashdown --example step -- SCENE [DEVICE] [FRAMES] [unchecked] [apart]`
//!
//! `unchecked` runs shaders without bounds checks; `apart` sets a mouse force without effect, so that forces and
//! integration are separate passes.

use glam::Vec3;
use splashdown::{Device, MouseForce, Simulation, scene::Scene};

#[expect(clippy::print_stdout, reason = "an example that prints")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let scene = Scene::load(arguments.next().ok_or("give a scene file")?)?;
    let device: Device = arguments.next().unwrap_or_else(|| "auto".into()).parse()?;
    let frames: u32 = arguments.next().map_or(Ok(3), |text| text.parse())?;
    let flags: Vec<String> = arguments.collect();
    let has = |flag: &str| flags.iter().any(|given| given == flag);
    let executor = if has("unchecked") {
        // SAFETY: only the simulation uses the executor.
        unsafe { device.unchecked_executor()? }
    } else {
        device.executor()?
    };
    let mut simulation = Simulation::with_executor(&scene, executor)?;
    if has("apart") {
        simulation.set_mouse_force(Some(MouseForce::new(Vec3::ZERO, Vec3::NEG_Y, Vec3::ZERO, 1.0, 0.0)))?;
    }
    println!(
        "{} particles on {}, {} MB",
        simulation.stats().particles,
        simulation.device_name(),
        simulation.memory() >> 20
    );
    for _ in 0..frames {
        let begun = std::time::Instant::now();
        let stats = simulation.advance(scene.frame_duration())?;
        let wall = begun.elapsed().as_secs_f64();
        let steps = f64::from(stats.steps_in_frame);
        let velocities = simulation.particles()?.velocities;
        let sum: f64 = velocities.iter().flatten().map(|&v| f64::from(v).powi(2)).sum();
        println!(
            "t {:.4} s: {} steps, {:.2} ms each, rms speed {:.4} m/s, dt {:.2e} s, density error {:.4}, max speed {:.3} m/s, limits {}, walls {}",
            stats.time,
            stats.steps_in_frame,
            1e3 * wall / steps,
            (sum / velocities.len().max(1) as f64).sqrt(),
            stats.dt,
            stats.density_error,
            stats.max_speed,
            stats.speed_limits,
            stats.wall_corrections
        );
    }
    if simulation.enable_timing() {
        simulation.take_timings();
        let steps = simulation.advance(scene.frame_duration())?.steps_in_frame;
        for (label, time) in simulation.take_timings().passes {
            println!("{label:30} {:8.3} ms per step", 1e3 * time.total.as_secs_f64() / f64::from(steps));
        }
    }
    Ok(())
}
