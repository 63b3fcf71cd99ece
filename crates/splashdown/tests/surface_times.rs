//! Times of the surface per pass, beside `splashsurf_lib` in the same run. Not a test of the suite: run it
//! with `cargo test --release -p splashdown --test surface_times -- --ignored --nocapture`.

use std::path::Path;
use std::time::{Duration, Instant};

use splashdown::surface::{SurfaceParams, reconstruct};
use splashdown_gpu::testing;
use splashdown_io::npy;
use splashsurf_lib::nalgebra::Vector3;

const SPACING: f32 = 0.05;
const ROUNDS: usize = 9;

fn median(mut times: Vec<Duration>) -> f64 {
    times.sort_unstable();
    1e3 * times[times.len() / 2].as_secs_f64()
}

fn timed<T>(mut work: impl FnMut() -> T) -> f64 {
    let time = |_| {
        let start = Instant::now();
        work();
        start.elapsed()
    };
    median((0..ROUNDS).map(time).collect())
}

#[test]
#[ignore = "it measures; nothing can fail"]
fn times_per_pass() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/particles/mid64k.npy");
    let points = npy::read_positions(&file).unwrap();
    for (cell_ratio, smoothing_iterations) in [(0.5, 0), (0.5, 25), (0.25, 0)] {
        let params = SurfaceParams {
            cell_size: cell_ratio * SPACING,
            smoothing_iterations,
            ..SurfaceParams::new(SPACING)
        };
        let mut lines = vec![format!(
            "{} particles, cells of {cell_ratio} spacings, {smoothing_iterations} rounds of smoothing",
            points.len()
        )];
        for (name, mut executor) in testing::executors("times_per_pass") {
            let total = timed(|| reconstruct(&points, &params, &mut executor).unwrap());
            lines.push(format!("{name}: {total:.1} ms with sorting and reading back; passes:"));
            executor.enable_timing();
            reconstruct(&points, &params, &mut executor).unwrap();
            for (label, time) in &executor.take_timings().passes {
                lines.push(format!("    {label:20} {:8.2} ms", 1e3 * time.total.as_secs_f64()));
            }
        }
        let theirs = splashsurf_lib::Parameters::new(SPACING / 2.0, params.support_radius, params.cell_size);
        let points: Vec<_> = points.iter().map(|&p| Vector3::from(p)).collect();
        let total = timed(|| splashsurf_lib::reconstruct_surface::<i64, f32>(&points, &theirs).unwrap());
        lines.push(format!("splashsurf_lib, without smoothing and normals: {total:.1} ms"));
        eprintln!("{}", lines.join("\n"));
    }
}
