//! Measures the steps of a scene on the CPU with each kind of SIMD register of this processor, alternately:
//! `cargo run --release -p splashdown --example registers -- SCENE [ROUNDS] [FRAMES]`
//!
//! FRAMES are simulated first (0 by default), so that a fluid at rest can be measured.

use std::collections::BTreeMap;

use splashdown::{Device, Simulation, scene::Scene, simd::Simd};

/// Seconds of every round, by kind of register and pass.
type Times = BTreeMap<(&'static str, &'static str), Vec<f64>>;

#[expect(clippy::print_stdout, reason = "an example that prints")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let scene = Scene::load(arguments.next().ok_or("give a scene file")?)?;
    let rounds: u32 = arguments.next().map_or(Ok(5), |text| text.parse())?;
    let frames: u32 = arguments.next().map_or(Ok(0), |text| text.parse())?;
    let mut simulation = Simulation::new(&scene, &Device::Cpu)?;
    for _ in 0..frames {
        simulation.advance(scene.frame_duration())?;
    }
    simulation.enable_timing();
    let mut times = Times::new();
    // A fraction of a frame: a few dozen steps.
    let piece = scene.frame_duration() / 8.0;
    for _ in 0..rounds {
        for kind in Simd::ALL.into_iter().filter(|kind| kind.is_available()) {
            kind.limit_to();
            simulation.take_timings();
            let steps = f64::from(simulation.advance(piece)?.steps_in_frame);
            let mut all = 0.0;
            for (label, time) in simulation.take_timings().passes {
                let seconds = time.total.as_secs_f64() / steps;
                all += seconds;
                times.entry((kind.name(), label)).or_default().push(seconds);
            }
            times.entry((kind.name(), "all")).or_default().push(all);
        }
    }
    println!("{} particles, {} threads", simulation.stats().particles, rayon::current_num_threads());
    for ((kind, label), mut seconds) in times {
        seconds.sort_by(f64::total_cmp);
        println!(
            "{kind:8} {label:24} median {:7.3} ms, fastest {:7.3} ms",
            1e3 * seconds[seconds.len() / 2],
            1e3 * seconds[0]
        );
    }
    Ok(())
}
