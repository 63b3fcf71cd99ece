//! Every pass on the GPU compared with its CPU counterpart, from equal input.
//!
//! The two executors create the same buffers in the same order, so that the handles are valid for
//! both. Before each command all buffers are copied from the CPU to the GPU; afterwards all are
//! compared, which also shows that the pass wrote nothing else. New buffers are poisoned.

use glam::{UVec2, Vec3, Vec4};
use splashdown_gpu::{Command, CpuExecutor, Executor, GpuExecutor, Recording, testing};
use splashdown_io::Mesh;

use super::buffers::Buffers;
use super::params::SurfaceParams;
use super::{Surface, Walls, reconstruct};
use crate::scene::SurfaceKernels;

const SPACING: f32 = 0.05;

/// A jittered ball of particles, a thin sheet through its middle, a single particle, and two at the
/// same position.
fn cloud() -> Vec<Vec3> {
    let unit = |i: u32| testing::noise(i) as f32 / u32::MAX as f32 - 0.5;
    let mut points = Vec::new();
    for i in 0..9 * 9 * 9_u32 {
        let lattice = Vec3::new((i % 9) as f32, (i / 9 % 9) as f32, (i / 81) as f32) - 4.0;
        let jitter = 0.3 * Vec3::new(unit(3 * i), unit(3 * i + 1), unit(3 * i + 2));
        if lattice.length() < 4.2 || lattice.y == 0.0 {
            points.push(SPACING * (lattice + jitter));
        }
    }
    points.extend([Vec3::new(0.4, 0.3, 0.1), Vec3::new(0.4, -0.3, 0.1), Vec3::new(0.4, -0.3, 0.1)]);
    points
}

/// A jittered block that is thick enough for blocks of the surface that no particle at its surface reaches.
fn thick() -> Vec<Vec3> {
    let unit = |i: u32| testing::noise(i) as f32 / u32::MAX as f32 - 0.5;
    let place = |i: u32| Vec3::new((i % 16) as f32, (i / 16 % 16) as f32, (i / 256) as f32) - 7.5;
    let jitter = |i: u32| 0.2 * Vec3::new(unit(3 * i), unit(3 * i + 1), unit(3 * i + 2));
    (0..16 * 16 * 16).map(|i| SPACING * (place(i) + jitter(i))).collect()
}

/// The first index at which two columns differ by more than `tolerance`. Equal bits are equal, even
/// for NaN.
fn difference(what: &str, cpu: &[f32], gpu: &[f32], tolerance: f32) -> Option<String> {
    assert_eq!(cpu.len(), gpu.len());
    let same = |a: f32, b: f32| a.to_bits() == b.to_bits() || (a - b).abs() <= tolerance * (1.0 + a.abs());
    let place = (0..cpu.len()).find(|&i| !same(cpu[i], gpu[i]))?;
    Some(format!("{what}[{place}]: CPU {}, GPU {}", cpu[place], gpu[place]))
}

/// Runs code for every buffer of two extractions, one on each executor.
macro_rules! for_each_buffer {
    ($a:expr, $b:expr, $one:ident, $two:ident, $name:ident => $body:block) => {
        for_each_buffer!(@ $a, $b, $one, $two, $name, $body;
            kept kept_starts kept_positions kept_cell_start droplets droplet_count samples neighbour_moments kernel_centres kernel_matrices local_density marks mark_starts block_slot block_list field_values signs rows vertex_counts triangle_counts
            vertex_starts triangle_starts status draw_args block_groups vertex_groups triangle_groups vertex_positions normals
            indices valences one_ring_starts one_rings relaxed)
    };
    (@ $a:expr, $b:expr, $one:ident, $two:ident, $name:ident, $body:block; $($field:ident)*) => {
        $({ let ($one, $two) = ($a.$field, $b.$field); let $name = stringify!($field); $body })*
    };
}

fn copy_all(buffers: [&Buffers; 2], from: &mut Executor, to: &mut Executor) {
    let [a, b] = buffers;
    for_each_buffer!(a, b, source, target, _name => {
        let data = from.read(source).unwrap();
        to.write(target, &data).unwrap();
    });
}

/// One-rings have no order until they are sorted; sorting them compares them as sets.
fn sort_one_rings(starts: &[u32], one_rings: &mut [UVec2]) {
    for range in starts.windows(2) {
        // Before the first scan the starts are poisoned.
        if let Some(ring) = one_rings.get_mut(range[0] as usize..range[1] as usize) {
            ring.sort_unstable_by_key(|pair| pair.x);
        }
    }
}

/// The differences between the executors after a command.
fn compare(buffers: [&Buffers; 2], iso: f32, cpu: &mut Executor, gpu: &mut Executor) -> Vec<String> {
    let [a, b] = buffers;
    let mut wrong = Vec::new();
    let values = cpu.read(a.field_values).unwrap();
    for_each_buffer!(a, b, one, two, name => {
        let (mut here, mut there) = (cpu.read(one).unwrap(), gpu.read(two).unwrap());
        match name {
            // Sums of about thirty terms of order one, in another order: thirty roundings of 6e-8,
            // and the hardware's square root.
            "samples" | "neighbour_moments" | "kernel_centres" | "kernel_matrices" | "local_density" | "field_values" | "vertex_positions" | "relaxed" | "normals" => {
                // A normal is a difference of such values divided by its length, which can be a
                // hundred times smaller.
                let tolerance = if name == "normals" { 5e-4 } else { 1e-5 };
                let (here, there) = (bytemuck::cast_slice(&here), bytemuck::cast_slice(&there));
                wrong.extend(difference(name, here, there, tolerance));
            }
            "signs" => {
                let (here, there): (&[u32], &[u32]) =
                    (bytemuck::cast_slice(&here), bytemuck::cast_slice(&there));
                for (row, (a, b)) in here.iter().zip(there).enumerate() {
                    // A node closer to the iso level than rounding may lie on either side.
                    let certain = (0..32).filter(|i| i / 8 > 0 || (values[8 * row + i] - iso).abs() > 1e-5);
                    if certain.into_iter().any(|i| (a ^ b) >> i & 1 == 1) {
                        wrong.push(format!("signs of row {row}: CPU {a:b}, GPU {b:b}"));
                    }
                }
            }
            _ => {
                if name == "one_rings" {
                    let starts = cpu.read(a.one_ring_starts).unwrap();
                    sort_one_rings(&starts, bytemuck::cast_slice_mut(&mut here));
                    sort_one_rings(&starts, bytemuck::cast_slice_mut(&mut there));
                }
                let (here, there): (&[u32], &[u32]) =
                    (bytemuck::cast_slice(&here), bytemuck::cast_slice(&there));
                if let Some(i) = (0..here.len()).find(|&i| here[i] != there[i]) {
                    wrong.push(format!("{name}[{i}]: CPU {}, GPU {}", here[i], there[i]));
                }
            }
        }
    });
    wrong
}

fn prepare(
    executor: &mut Executor,
    points: &[Vec3],
    params: SurfaceParams,
    capacity: Option<u32>,
) -> Surface {
    executor.poison();
    let input = reconstruct::upload(executor, points, &params).unwrap();
    match capacity {
        None => Surface::new(executor, params, input).unwrap(),
        Some(few) => Surface::with_capacity(executor, params, input, few, 8 * few, 12 * few).unwrap(),
    }
}

/// `components` is the expected number of connected parts of the mesh.
fn command_by_command(
    gpu: &mut Executor,
    points: &[Vec3],
    components: usize,
    params: SurfaceParams,
    capacity: Option<u32>,
) {
    let mut cpu = Executor::from(CpuExecutor::new());
    let surface = prepare(&mut cpu, points, params, capacity);
    let twin = prepare(gpu, points, params, capacity);
    let buffers = [&surface.b, &twin.b];
    assert_eq!(surface.recording.commands.len(), twin.recording.commands.len());
    for (command, other) in surface.recording.commands.iter().zip(&twin.recording.commands) {
        let label = match command {
            Command::Dispatch { pass, .. } => pass.label.to_owned(),
            other => format!("{other:?}"),
        };
        copy_all(buffers, &mut cpu, gpu);
        let alone = |command: &Command| {
            let mut recording = Recording::new(label.clone());
            recording.commands.push(command.clone());
            recording
        };
        cpu.run(&alone(command)).unwrap();
        gpu.run(&alone(other)).unwrap();
        let wrong = compare(buffers, params.iso_level, &mut cpu, gpu);
        assert!(wrong.is_empty(), "{label}: {}", wrong.join("\n"));
    }
    let status = cpu.read(surface.b.status).unwrap()[0];
    assert_eq!(status.overflowed(), capacity.is_some(), "{status:?}");
    if capacity.is_none() {
        let topology = surface.mesh(&mut cpu).unwrap().topology().unwrap();
        assert!(topology.is_watertight() && topology.components == components, "{topology}");
    }
}

#[test]
fn every_pass_agrees_with_its_cpu_counterpart() {
    let Some(gpu) = testing::gpu_or_skip("every_pass_agrees_with_its_cpu_counterpart") else { return };
    // Walls that touch the ball and the single particles.
    let walls =
        Walls::new([-0.215, -0.36, -0.215], [0.43, 0.36, 0.215], [[true, true], [true, false], [true; 2]]);
    for (smoothing_iterations, kernels) in
        [(0, SurfaceKernels::Isotropic), (3, SurfaceKernels::Isotropic), (3, SurfaceKernels::Anisotropic)]
    {
        for walls in [Walls::NONE, walls] {
            let params =
                SurfaceParams { smoothing_iterations, kernels, walls, ..SurfaceParams::new(SPACING) };
            command_by_command(&mut GpuExecutor::new(gpu.clone()).into(), &cloud(), 3, params, None);
            let separated = SurfaceParams { min_blob: 3, min_neighbours: 2, ..params };
            command_by_command(&mut GpuExecutor::new(gpu.clone()).into(), &cloud(), 1, separated, None);
        }
    }
}

/// The values of the field at the nodes, and the mesh.
fn field_and_mesh(points: &[Vec3], params: SurfaceParams) -> (Vec<f32>, Mesh) {
    let mut cpu = Executor::from(CpuExecutor::new());
    let mut surface = prepare(&mut cpu, points, params, None);
    surface.extract(&mut cpu).unwrap();
    let values = cpu.read(surface.b.field_values).unwrap();
    (values, surface.into_mesh(&mut cpu).unwrap())
}

/// Nodes of blocks that are not evaluated.
fn left_out(values: &[f32]) -> usize {
    values.as_chunks::<512>().0.iter().filter(|block| block.iter().all(|value| *value == 1.0)).count() * 512
}

/// A thick block between walls has blocks that no particle at the surface reaches.
#[test]
fn the_interior_of_a_thick_block_agrees_with_its_cpu_counterpart() {
    let walls = Walls::new([-8.0 * SPACING; 3], [8.0 * SPACING; 3], [[true, true], [true, false], [true; 2]]);
    let params = SurfaceParams { kernels: SurfaceKernels::Anisotropic, walls, ..SurfaceParams::new(SPACING) };
    let nodes = left_out(&field_and_mesh(&thick(), params).0);
    assert!(nodes > 20 * 512, "{nodes} nodes inside");
    let Some(gpu) = testing::gpu_or_skip("the_interior_of_a_thick_block_agrees_with_its_cpu_counterpart")
    else {
        return;
    };
    // Large cells of the surface reach more rows of cells than a block distinguishes.
    for cell_size in [params.cell_size, 4.0 * SPACING] {
        let params = SurfaceParams { cell_size, ..params };
        command_by_command(&mut GpuExecutor::new(gpu.clone()).into(), &thick(), 1, params, None);
    }
}

/// The mesh is that of the next higher iso level, for which all blocks are evaluated, also around a missing particle and a
/// cavity inside the fluid.
#[test]
fn blocks_inside_the_fluid_do_not_change_the_mesh() {
    let unit = |i: u32| testing::noise(i) as f32 / u32::MAX as f32 - 0.5;
    let side = 36;
    for jitter in [0.0, 0.2] {
        let mut points = Vec::new();
        for i in 0..side * side * side {
            let x = Vec3::new((i % side) as f32, (i / side % side) as f32, (i / (side * side)) as f32);
            let is_missing = x == Vec3::splat(22.0) || x.distance(Vec3::splat(7.0)) < 2.5;
            if !is_missing {
                points
                    .push(SPACING * (x + jitter * Vec3::new(unit(3 * i), unit(3 * i + 1), unit(3 * i + 2))));
            }
        }
        let params = SurfaceParams { kernels: SurfaceKernels::Anisotropic, ..SurfaceParams::new(SPACING) };
        let [(some, mesh), (all, whole)] = [0.6, 0.6_f32.next_up()]
            .map(|iso_level| field_and_mesh(&points, SurfaceParams { iso_level, ..params }));
        assert!(left_out(&some) > 100 * 512 && left_out(&all) == 0, "{}", left_out(&some));
        assert_eq!(mesh.triangles, whole.triangles);
        assert_eq!(mesh.topology().unwrap().components, 2, "the block and the cavity");
        let farthest = |a: &[[f32; 3]], b: &[[f32; 3]]| {
            let distances = a.iter().zip(b).map(|(a, b)| Vec3::from(*a).distance(Vec3::from(*b)));
            distances.fold(0.0, f32::max)
        };
        let moved = farthest(&mesh.vertices, &whole.vertices) / SPACING;
        let turned = farthest(&mesh.normals, &whole.normals);
        assert!(moved < 1e-3 && turned < 1e-3, "{moved} spacings, normals {turned}");
    }
}

/// With capacities that are too small, neither side writes out of range, and both omit the same
/// elements.
#[test]
fn every_pass_agrees_with_its_cpu_counterpart_with_exceeded_capacities() {
    let Some(gpu) =
        testing::gpu_or_skip("every_pass_agrees_with_its_cpu_counterpart_with_exceeded_capacities")
    else {
        return;
    };
    let params = SurfaceParams { smoothing_iterations: 2, ..SurfaceParams::new(SPACING) };
    for few in [5, 70] {
        command_by_command(&mut GpuExecutor::new(gpu.clone()).into(), &cloud(), 3, params, Some(few));
    }
}

/// Negative control: the smallest changes that the comparison must detect.
#[test]
fn the_comparison_detects_a_wrong_bit_and_a_wrong_digit() {
    let params = SurfaceParams { smoothing_iterations: 2, ..SurfaceParams::new(SPACING) };
    let (mut a, mut b) = (Executor::from(CpuExecutor::new()), Executor::from(CpuExecutor::new()));
    let surface = prepare(&mut a, &cloud(), params, None);
    let twin = prepare(&mut b, &cloud(), params, None);
    let buffers = [&surface.b, &twin.b];
    a.run(&surface.recording).unwrap();
    copy_all(buffers, &mut a, &mut b);
    assert!(compare(buffers, params.iso_level, &mut a, &mut b).is_empty());

    let values = a.read(surface.b.field_values).unwrap();
    let mut changed = values.clone();
    changed[values.iter().position(|&value| value > 0.1).unwrap()] *= 1.0001;
    b.write(twin.b.field_values, &changed).unwrap();
    b.write(twin.b.vertex_positions, &[Vec4::splat(0.001)]).unwrap();
    let mut one_rings = a.read(surface.b.one_rings).unwrap();
    one_rings[0].y += 1;
    b.write(twin.b.one_rings, &one_rings).unwrap();
    let mut signs = a.read(surface.b.signs).unwrap();
    signs[0] ^= 1;
    b.write(twin.b.signs, &signs).unwrap();
    let wrong = compare(buffers, params.iso_level, &mut a, &mut b);
    assert_eq!(wrong.len(), 4, "{wrong:?}");
}
