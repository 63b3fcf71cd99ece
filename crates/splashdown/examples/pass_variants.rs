//! Measures variants of passes on the best GPU, in microseconds per dispatch, with and without bounds checks:
//! `cargo run --release -p splashdown --example pass_variants -- FOLDER PARTICLE_SPACING...`
//!
//! The folder contains WGSL. A file `LABEL@NAME.wgsl` replaces that of the pass with the label, whose declaration it must
//! match. All variants read the state after a step of a cubic metre of `dfsph`, and write to the same buffers.

use std::error::Error;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use glam::Vec4;
use splashdown::cells::{Cells, Grid};
use splashdown::sample;
use splashdown::scene::Scene;
use splashdown::schemes::{self, Couplings, Scheme};
use splashdown::state::{self, Fields, SolveState, StepCounters, StepState};
use splashdown_gpu::{
    BufferSet, DeviceRequest, DispatchSize, Executor, Gpu, GpuExecutor, PassDesc, Recording, bytemuck,
    testing,
};

/// Dispatches in the shorter and in the longer recording. The difference of their times has no constant part.
const DISPATCHES: [u32; 2] = [20, 120];
/// Runs of each recording.
const RUNS: u32 = 4;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = arguments.next().ok_or("give a folder with variants, and particle spacings in metres")?;
    for spacing in arguments {
        let gpu = || Gpu::open(&DeviceRequest::Auto);
        measure(Path::new(&folder), &spacing, gpu()?)?;
        // SAFETY: the variants are trusted like the passes.
        measure(Path::new(&folder), &spacing, unsafe { gpu()?.without_shader_checks() })?;
    }
    Ok(())
}

#[expect(clippy::print_stdout, reason = "an example that prints")]
fn measure(folder: &Path, spacing: &str, gpu: Gpu) -> Result<(), Box<dyn Error>> {
    let checks = if gpu.checks_shaders() { "checked" } else { "unchecked" };
    let mut executor = Executor::from(GpuExecutor::new(Arc::new(gpu)));
    let (particles, buffers) = after_a_step(spacing, &mut executor)?;
    let mut files: Vec<_> = std::fs::read_dir(folder)?.collect::<Result<_, _>>()?;
    files.sort_by_key(std::fs::DirEntry::path);
    for file in files {
        let name = file.path().file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let label = name.split('@').next().unwrap_or_default();
        let pass = splashdown::passes().into_iter().find(|pass| pass.label == label);
        let pass = pass.ok_or_else(|| format!("no pass has the label {label}"))?;
        // Declarations are static.
        let wgsl: &'static str = Box::leak(std::fs::read_to_string(file.path())?.into_boxed_str());
        let variant: &'static PassDesc = Box::leak(Box::new(PassDesc { wgsl, ..*pass }));
        let mut seconds = [0.0; 2];
        for (seconds, count) in seconds.iter_mut().zip(DISPATCHES) {
            let mut recording = Recording::new("variants");
            (0..count).for_each(|_| recording.dispatch(variant, DispatchSize::Items(particles), &buffers));
            executor.run(&recording)?;
            executor.wait()?;
            let start = Instant::now();
            (0..RUNS).try_for_each(|_| executor.run(&recording))?;
            executor.wait()?;
            *seconds = start.elapsed().as_secs_f64() / f64::from(RUNS);
        }
        let each = (seconds[1] - seconds[0]) / f64::from(DISPATCHES[1] - DISPATCHES[0]);
        println!("{particles} {checks} {name}: {:.1} us", 1e6 * each);
    }
    Ok(())
}

/// The number of particles, and the buffers after a step from a lattice with small displacements.
fn after_a_step(spacing: &str, executor: &mut Executor) -> Result<(u32, BufferSet), Box<dyn Error>> {
    let text = format!(
        "[scene]\nname = \"block\"\nduration = 1.0\n[domain]\nmin = [0, 0, 0]\nmax = [2, 1, 1]\n[fluid]\n\
         particle_spacing = {spacing}\n[[fluid.block]]\nposition = [0, 0, 0]\nsize = [1, 1, 1]\n"
    );
    let scene = Scene::parse(&text, "block.toml")?;
    let lattice = sample::particles(&scene)?.positions;
    let n = lattice.len() as u32;
    let (params, scheme) = (schemes::params(&scene, n), Scheme::new(&scene));
    let mut fields = Fields::with_table(executor, &params, scheme.extras(false), scheme.carried())?;
    fields.make_accelerations(executor)?;
    let grid =
        Grid::new(scene.domain.min, scene.domain.max, params.support_radius).ok_or("too many cells")?;
    let cells = Cells::new(executor, grid.for_gpu(n, u64::MAX), n, scene.solver.sort.into())?;
    let noise =
        |i: usize| 0.2 * params.particle_spacing * (testing::noise(i as u32) as f32 / u32::MAX as f32 - 0.5);
    let positions: Vec<Vec4> = lattice
        .iter()
        .enumerate()
        .map(|(i, x)| Vec4::new(x[0] + noise(3 * i), x[1] + noise(3 * i + 1), x[2] + noise(3 * i + 2), 0.0))
        .collect();
    executor.write(fields.positions, &positions)?;
    executor.write(fields.velocities, &vec![Vec4::new(0.1, -0.2, 0.0, 1000.0); positions.len()])?;
    executor.write(fields.ids, &(0..n).collect::<Vec<_>>())?;
    executor.write(fields.counters, &[0; StepCounters::WORDS])?;
    let state = StepState {
        dt: 1e-4,
        stable_dt: 1e-4,
        remaining: 0.1,
        frame_duration: 0.1,
        run_count: n,
        ..bytemuck::Zeroable::zeroed()
    };
    executor.write(fields.state, &[state])?;
    let mut step = Recording::new("step");
    cells.record_first_count(&mut step, &fields);
    step.append(&scheme.step(&cells, &fields, &Couplings::default(), n, &scheme.solver_rounds()));
    step.append(&state::end_step::record(&fields));
    executor.run(&step)?;
    // The passes of the iterations do nothing once the solver has stopped.
    executor.write(fields.solve, &[SolveState::new(false, params.relaxation, 1.0)])?;
    Ok((n, fields.buffers().and(&cells.buffers())))
}
