//! One whole step: the CPU runs it up to a pass, the GPU from there, and the result is compared with the CPU's.

use glam::{Vec2, Vec4};
use splashdown::cells::{Cells, Grid};
use splashdown::sample;
use splashdown::scene::Scene;
use splashdown::schemes::{self, Couplings, Scheme};
use splashdown::state::{self, Fields, Reordered, StepCounters, StepState};
use splashdown_gpu::{Command, CpuExecutor, Executor, GpuElement, GpuExecutor, Recording, bytemuck, testing};

fn scene(solver: &str, viscosity: f32) -> Scene {
    let text = format!(
        r#"
        [scene]
        name = "block"
        duration = 1.0
        [domain]
        min = [0, 0, 0]
        max = [1.0, 1.0, 0.75]
        open = ["y_max"]
        [fluid]
        particle_spacing = 0.0625
        viscosity = {viscosity}
        [[fluid.block]]
        position = [0, 0, 0]
        size = [0.5, 0.625, 0.5]
        velocity = [0.5, -0.25, 0.25]
        [solver]
        {solver}
        "#
    );
    Scene::parse(&text, "block.toml").unwrap_or_else(|errors| panic!("{errors}"))
}

/// The buffers of one executor, and the step that uses them.
struct Rig {
    executor: Executor,
    fields: Fields,
    cells: Cells,
    step: Recording,
}

impl Rig {
    fn new(scene: &Scene, mut executor: Executor) -> Self {
        // A pass must not read what no pass of the step has written.
        executor.poison();
        let particles = sample::particles(scene).unwrap();
        let n = particles.positions.len() as u32;
        let (params, way) = (schemes::params(scene, n), Scheme::new(scene));
        let mut fields =
            Fields::with_table(&mut executor, &params, way.extras(false), way.carried()).unwrap();
        if !way.is_fused() {
            fields.make_accelerations(&mut executor).unwrap();
        }
        executor.write(fields.counters, &[0; StepCounters::WORDS]).unwrap();
        let grid = Grid::new(scene.domain.min, scene.domain.max, params.support_radius)
            .unwrap()
            .for_gpu(4096, u64::MAX);
        let cells = Cells::new(&mut executor, grid, n, scene.solver.sort.into()).unwrap();
        let nudge = |i: usize| 0.01 * (testing::noise(i as u32) as f32 / u32::MAX as f32 - 0.5);
        let (x, v) = (&particles.positions, &particles.velocities);
        let positions: Vec<Vec4> = (0..x.len())
            .map(|i| Vec4::new(x[i][0] + nudge(3 * i), x[i][1] + nudge(3 * i + 1), x[i][2], 0.0))
            .collect();
        let velocities: Vec<Vec4> = v.iter().map(|v| Vec4::new(v[0], v[1], v[2], 1001.0)).collect();
        executor.write(fields.positions, &positions).unwrap();
        executor.write(fields.velocities, &velocities).unwrap();
        executor.write(fields.ids, &(0..n).rev().collect::<Vec<_>>()).unwrap();
        let state = StepState {
            dt: 2e-4,
            stable_dt: 2e-4,
            remaining: 0.1,
            frame_duration: 0.1,
            run_count: n,
            ..bytemuck::Zeroable::zeroed()
        };
        executor.write(fields.state, &[state]).unwrap();
        let mut count = Recording::new("count");
        cells.record_first_count(&mut count, &fields);
        executor.run(&count).unwrap();
        let mut step = way.step(&cells, &fields, &Couplings::default(), n, &way.solver_rounds());
        step.append(&state::end_step::record(&fields));
        Self { executor, fields, cells, step }
    }

    /// Runs a part of the step.
    fn run(&mut self, commands: &[Command]) {
        let mut recording = Recording::new("part of a step");
        recording.commands = commands.to_vec();
        self.executor.run(&recording).unwrap();
    }

    /// Makes the lists of neighbours, which exist on a GPU only.
    fn list_neighbours(&mut self) {
        let is_list = |command: &&Command| matches!(command, Command::Dispatch { pass, .. } if pass.label == "neighbours");
        let lists: Vec<Command> = self.step.commands.iter().filter(is_list).cloned().collect();
        self.run(&lists);
    }

    /// Copies the buffers of another rig.
    fn take_from(&mut self, other: &mut Self) {
        fn carry<T: GpuElement>(
            from: &mut Executor,
            to: &mut Executor,
            source: splashdown_gpu::Buffer<T>,
            target: splashdown_gpu::Buffer<T>,
        ) {
            let content = from.read(source).unwrap();
            to.write(target, &content).unwrap();
        }
        let (a, b, from, to) =
            (other.fields.clone(), self.fields.clone(), &mut other.executor, &mut self.executor);
        carry(from, to, a.state, b.state);
        carry(from, to, a.counters, b.counters);
        carry(from, to, a.ids, b.ids);
        carry(from, to, a.solve, b.solve);
        carry(from, to, a.viscous, b.viscous);
        carry(from, to, a.impulses, b.impulses);
        for (a, b) in a.carried.iter().zip(&b.carried) {
            if let (
                Some(Reordered::Scalar { persistent, sorted, .. }),
                Some(Reordered::Scalar { persistent: to_persistent, sorted: to_sorted, .. }),
            ) = (a.reordered(), b.reordered())
            {
                carry(from, to, persistent, to_persistent);
                carry(from, to, sorted, to_sorted);
            }
        }
        carry(from, to, a.densities, b.densities);
        carry(from, to, other.cells.cell_start, self.cells.cell_start);
        for (source, target) in [
            (a.positions, b.positions),
            (a.velocities, b.velocities),
            (a.sorted_positions, b.sorted_positions),
            (a.sorted_velocities, b.sorted_velocities),
            (a.accelerations, b.accelerations),
            (a.normals, b.normals),
            (a.corrections, b.corrections),
            (a.shifts, b.shifts),
            (a.stiffness, b.stiffness),
            (a.iterates, b.iterates),
            (a.free_velocities, b.free_velocities),
            (a.predicted, b.predicted),
            (a.residuals, b.residuals),
            (a.viscous_residuals, b.viscous_residuals),
            (a.viscous_products, b.viscous_products),
            (a.viscous_directions, b.viscous_directions),
            (a.viscous_images, b.viscous_images),
        ] {
            carry(from, to, source, target);
        }
    }

    /// Positions, velocities, densities, and state with counters, as floats.
    fn result(&mut self) -> [Vec<f32>; 4] {
        let (fields, executor) = (self.fields.clone(), &mut self.executor);
        let positions: Vec<Vec4> = executor.read(fields.positions).unwrap();
        let velocities: Vec<Vec4> = executor.read(fields.velocities).unwrap();
        let densities: Vec<Vec2> = executor.read(fields.densities).unwrap();
        let state = executor.read(fields.state).unwrap()[0];
        let counters = executor.read(fields.counters).unwrap();
        [
            bytemuck::cast_slice(&positions).to_vec(),
            bytemuck::cast_slice(&velocities).to_vec(),
            bytemuck::cast_slice(&densities).to_vec(),
            [state.dt, state.stable_dt, state.time, state.max_speed, state.max_acceleration]
                .into_iter()
                .chain(
                    counters[StepCounters::ESCAPED..=StepCounters::LIMITED].iter().map(|&count| count as f32),
                )
                .collect(),
        ]
    }
}

/// The largest difference over the largest magnitude, of each of the four.
fn difference(a: &[Vec<f32>; 4], b: &[Vec<f32>; 4]) -> [f32; 4] {
    std::array::from_fn(|k| {
        let size = b[k].iter().fold(0.0_f32, |most, v| most.max(v.abs()));
        // A NaN counts as the largest difference; `max` would ignore it.
        let gap = |a: &f32, b: &f32| if (a - b).is_nan() { f32::INFINITY } else { (a - b).abs() };
        a[k].iter().zip(&b[k]).fold(0.0_f32, |most, (a, b)| most.max(gap(a, b))) / size
    })
}

/// Positions have one rounding. Velocities change by accelerations that are differences of large forces, pressures are
/// differences of densities times c0^2, and both have a few hundred roundings.
const TOLERANCE: [f32; 4] = [1e-6, 1e-4, 1e-3, 1e-4];

fn holds(difference: [f32; 4]) -> bool {
    (0..4).all(|k| difference[k] <= TOLERANCE[k])
}

#[test]
fn the_gpu_can_continue_from_any_pass() {
    let Some(gpu) = testing::gpu_or_skip("the_gpu_can_continue_from_any_pass") else { return };
    for (solver, viscosity) in [
        ("method = \"wcsph\"", 1e-6),
        ("method = \"wcsph\"\ndensity = \"continuity\"", 1e-6),
        ("method = \"wcsph\"\nsurface_tension = \"akinci2013\"", 1e-6),
        // The step has the largest length. A shorter one removes too little of the excess of density for a pressure.
        ("method = \"dfsph\"\nmax_dt = 2e-4", 1e-6),
        // Implicit.
        ("method = \"dfsph\"\nmax_dt = 2e-4", 1.0),
        ("method = \"mueller2003\"", 1e-6),
    ] {
        let scene = scene(solver, viscosity);
        let cpu = || Rig::new(&scene, CpuExecutor::new().into());
        let mut reference = cpu();
        reference.run(&reference.step.commands.clone());
        let expected = reference.result();
        assert_eq!(expected[3][5..], [0.0; 4], "{solver}: particles are lost, corrected or limited");
        let commands = reference.step.commands.len();
        // Not between the passes of the sort, whose buffers are private.
        let sorted = reference
            .step
            .commands
            .iter()
            .position(
                |command| matches!(command, Command::Dispatch { pass, .. } if pass.label == "cells.reorder"),
            )
            .unwrap();
        for from in std::iter::once(0).chain(sorted + 1..commands) {
            let mut first = cpu();
            first.run(&first.step.commands.clone()[..from]);
            let mut second = Rig::new(&scene, GpuExecutor::new(gpu.clone()).into());
            second.take_from(&mut first);
            second.list_neighbours();
            second.run(&second.step.commands.clone()[from..]);
            let measured = difference(&second.result(), &expected);
            assert!(holds(measured), "{solver}: the GPU from command {from} of {commands} on: {measured:?}");
        }
        // Control: omitting any single pass of the step changes the result.
        for left_out in sorted + 1..commands {
            let mut rig = cpu();
            let mut step = rig.step.commands.clone();
            // The contribution of the normals in a first step is too small. The CPU has lists of another kind, and a new
            // simulation has no pressures to reorder. No step is suspended. The tests of the passes cover them.
            let small = |command: &Command| match command {
                Command::Dispatch { pass, .. } => {
                    ["normals", "neighbours", "cells.reorder_carried", "suspension"]
                        .iter()
                        .any(|prefix| pass.label.starts_with(prefix))
                }
                _ => true,
            };
            if small(&step[left_out]) {
                continue;
            }
            let removed = step.remove(left_out);
            rig.run(&step);
            let measured = difference(&rig.result(), &expected);
            assert!(
                !holds(measured),
                "{solver}: omitting command {left_out} of {commands} is not detected: {measured:?}; {removed:?}"
            );
        }
    }
}
