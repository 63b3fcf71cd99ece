//! Walls and bodies combined: flush, overlapping, or with gaps of up to two spacings.

use glam::{Quat, Vec3};
use splashdown::boundary::{KernelPair, PlaneFraction};
use splashdown::scene::BoundaryKind;
use splashdown::solid::{Solid, SolidSettings, Surroundings};
use splashdown::{Device, Simulation, sample};
use splashdown_io::Mesh;

use crate::meshes::{cuboid, tub};
use crate::pool::{self, FORMS, SIZE, SPACING};

/// Gaps in spacings.
const GAPS: [f32; 5] = [0.0, 0.25, 0.5, 1.0, 2.0];

/// Edge length of a cube in m.
const CUBE: f32 = 0.2;

/// The bodies of a case, with a gap in m.
type Bodies = fn(f32) -> Vec<Mesh>;

const CASES: [(&str, Bodies); 9] = [
    ("none", |_| vec![]),
    ("floor", |gap| vec![cube(Vec3::new(0.2, gap, 0.15))]),
    ("wall", |gap| vec![cube(Vec3::new(gap, 0.1, 0.15))]),
    ("corner", |gap| vec![cube(Vec3::splat(gap))]),
    ("touching", |gap| vec![cube(Vec3::new(0.1, 0.1, 0.15)), cube(Vec3::new(0.3 + gap, 0.1, 0.15))]),
    // Two bodies on the floor that overlap by a half, apart from the gap.
    ("overlapping", |gap| vec![cube(Vec3::new(0.1, 0.0, 0.15)), cube(Vec3::new(0.2 + gap, 0.05, 0.2))]),
    ("tub", |gap| vec![tub(Vec3::splat(gap), (SIZE - gap).with_y(SIZE.y - 0.1), 0.1)]),
    ("piston", |gap| {
        let low = Vec3::new(0.4, gap, gap);
        vec![cuboid(low, Vec3::new(0.5, 0.7, SIZE.z - gap))]
    }),
    ("slab", |gap| vec![cuboid(Vec3::new(0.0, gap, 0.0), Vec3::new(SIZE.x, gap + 0.1, SIZE.z))]),
];

fn cube(low: Vec3) -> Mesh {
    cuboid(low, low + CUBE)
}

/// Whether the test command runs this form.
fn is_tested(form: &str) -> bool {
    matches!(form, "summation" | "dfsph")
}

/// The largest density error of a sound start.
const SOUND: f32 = 0.02;

/// Runs the selected cases. In all of them the fluid must start at rest density, and no particle may be lost or enter a
/// body. Where the bodies leave the fluid a box, it must also be still after a second. Other submerged bodies cause
/// currents at their edges, at walls and away from them (docs/validation.md), which are reported.
fn check(selected: impl Fn(&str, f32, &str, BoundaryKind) -> bool) {
    let [word, only, spacing] =
        ["STARTS", "STARTS_FORM", "STARTS_SPACING"].map(|name| std::env::var(name).unwrap_or_default());
    let spacing = if spacing.is_empty() { SPACING } else { spacing.parse().expect("STARTS_SPACING in m") };
    let (mut count, mut moving, mut failures) = (0, 0, Vec::new());
    for (case, bodies) in CASES {
        if !case.contains(&word) {
            continue;
        }
        for gap in GAPS {
            for (form, text) in FORMS {
                for boundary in [BoundaryKind::Map, BoundaryKind::Particles] {
                    let is_repeated = case == "none" && (gap > 0.0 || boundary == BoundaryKind::Particles);
                    if is_repeated || !form.contains(&only) || !selected(case, gap, form, boundary) {
                        continue;
                    }
                    let mut scene = pool::pool(text, spacing);
                    for (k, mesh) in bodies(gap * spacing).iter().enumerate() {
                        scene.bodies.push(pool::body(&format!("{case}{k}"), mesh, boundary));
                    }
                    let outcome = pool::run(&scene);
                    count += 1;
                    let mut line = format!("{case:11} gap {gap:.2} {form:11} {boundary:9?} {outcome}");
                    if outcome.rms > 0.01 {
                        moving += 1;
                        line += "  MOVES";
                    }
                    eprintln!("{line}");
                    // An integrated density starts at the rest density, whatever the packing.
                    let is_dense = form != "continuity" && outcome.start.0 > SOUND;
                    let is_box = case == "none" || case == "tub" && gap == 0.0;
                    let is_moving = is_tested(form) && is_box && outcome.rms > 0.01;
                    if is_dense || is_moving || outcome.lost > 0 || outcome.inside > 0 {
                        failures.push(line);
                    }
                }
            }
        }
    }
    eprintln!("{moving} of {count} move");
    assert!(failures.is_empty(), "{} of {count}:\n{}", failures.len(), failures.join("\n"));
}

#[test]
fn a_pool_with_bodies_at_walls_starts_at_rest_density() {
    let full = std::env::var_os("SPLASHDOWN_FULL").is_some();
    // The test command runs bodies that are flush, and one with a gap that holds no fluid.
    check(|case, gap, form, boundary| {
        let is_small = is_tested(form) && (gap == 0.0 || case == "floor" && gap == 0.5);
        full || is_small && (boundary == BoundaryKind::Map || case == "tub")
    });
}

/// With linear interpolation of the map the edges of this tank moved at 9 % of the square root of g times the depth, and all of
/// its water at 2.5 %.
#[test]
fn water_in_the_edges_of_a_mesh_tank_comes_to_rest() {
    let spacing = 0.025;
    let gap = 2.0 * spacing;
    let mut scene = pool::pool("method = \"dfsph\"\n", spacing);
    let tank = tub(Vec3::splat(gap), (SIZE - gap).with_y(SIZE.y - 0.1), 0.1);
    scene.bodies.push(pool::body("tank", &tank, BoundaryKind::Map));
    let outcome = pool::run(&scene);
    assert!(outcome.rms < 0.01, "{outcome}");
    assert!(outcome.lost == 0 && outcome.inside == 0, "{outcome}");
}

#[test]
fn a_tank_mesh_at_the_sides_of_the_domain_does_not_count_twice() {
    let settings = SolidSettings {
        cell_size: 0.5 * SPACING,
        support_radius: 2.0 * SPACING,
        fraction: PlaneFraction::of(KernelPair::WendlandC2),
        half_thickness: 0.5 * SPACING,
        shell: None,
        region: None,
        cache: None,
    };
    let tub = tub(Vec3::ZERO, SIZE, 0.1);
    let surroundings = Surroundings {
        position: Vec3::ZERO,
        rotation: Quat::IDENTITY,
        closed: [Vec3::ZERO, SIZE.with_y(f32::INFINITY)],
        others: Vec::new(),
    };
    let alone = Solid::build(&tub, &settings, &|_| {}).unwrap();
    let within = Solid::build_within(&tub, &settings, Some(&surroundings), &|_| {}).unwrap();
    // The fraction of the kernel at the node nearest to a point half a spacing above the floor.
    let fraction = |solid: &Solid| {
        let field = &solid.field;
        let at = ((Vec3::new(0.3, 0.5 * SPACING, 0.25) - field.min) / field.cell_size).round().as_uvec3();
        let [nx, ny, _] = field.nodes;
        let effective = field.values[((at.z * ny + at.y) * nx + at.x) as usize].y;
        settings.fraction.kernels.density((effective / settings.support_radius).clamp(0.0, 1.0)).0
    };
    assert!(fraction(&within) < 1e-4, "{}", fraction(&within));
    // Control: without the sides the floor of the tub fills the kernel below.
    assert!(fraction(&alone) > 0.1, "{}", fraction(&alone));
}

#[test]
fn a_body_between_the_layers_of_a_block_displaces_its_volume() {
    // Faces at a quarter and three quarters of a spacing, and on layers of particles.
    for shift in [0.25, 0.4, 0.5] {
        let low = Vec3::new(0.2, 0.1, 0.15) + shift * SPACING;
        let mut scene = pool::pool("method = \"dfsph\"\n", SPACING);
        let lattice = sample::particles(&scene).unwrap().positions;
        scene.bodies.push(pool::body("cut", &cube(low), BoundaryKind::Map));
        let packed = Simulation::new(&scene, &Device::Cpu).unwrap().particles().unwrap().positions;
        let displaced = lattice.len() - packed.len();
        assert!((56..=72).contains(&displaced), "{shift}: the cube of 64 displaces {displaced}");
        // Control: without the particles closer than half a spacing the cube displaces more.
        let near = |p: &&[f32; 3]| {
            let beyond = (Vec3::from(**p) - low - 0.5 * CUBE).abs() - 0.5 * CUBE;
            beyond.max_element() < 0.49 * SPACING
        };
        let near = lattice.iter().filter(near).count();
        assert!(near > 72, "{shift}: {near}");
    }
}

/// Particles closer than half a spacing to the tank were removed: a seventh of this water.
#[test]
fn water_of_a_mesh_fills_a_tank_of_a_mesh() {
    let spacing = 0.02;
    let (low, size) = (Vec3::new(0.15, 0.1, 0.15), Vec3::new(0.3, 0.2, 0.2));
    let middle = low + 0.5 * size;
    let turn = |mut mesh: Mesh| {
        let turn = Quat::from_rotation_y(0.5);
        mesh.vertices.iter_mut().for_each(|v| *v = (middle + turn * (Vec3::from(*v) - middle)).to_array());
        mesh
    };
    let folder = std::path::PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
    splashdown_io::write_mesh(&folder.join("water.obj"), &turn(cuboid(low, low + size))).unwrap();
    let fluid = "[[fluid.mesh]]\nmesh = \"water.obj\"\n";
    let mut scene = pool::pool_of("method = \"dfsph\"\n", spacing, fluid, &folder.join("tank.toml"));
    let tank = turn(tub(low, low + size.with_y(0.3), 0.05));
    scene.bodies.push(pool::body("tank", &tank, BoundaryKind::Map));
    let mut simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
    let excess = simulation.packing().unwrap().density().excess;
    assert!(excess < SOUND, "{excess}");
    let volume = simulation.stats().particles as f32 * spacing.powi(3) / size.element_product();
    assert!((volume - 1.0).abs() < 0.02, "the particles have {volume} times the volume of the mesh");
    let height = |particles: &splashdown::Particles| {
        particles.positions.iter().map(|x| x[1]).sum::<f32>() / particles.len() as f32 - low.y
    };
    let before = height(&simulation.particles().unwrap());
    let stats = simulation.advance(1.0).unwrap();
    let particles = simulation.particles().unwrap();
    let speeds = particles.velocities.iter().map(|v| f64::from(Vec3::from(*v).length_squared()));
    let rms = (speeds.sum::<f64>() / particles.len() as f64).sqrt();
    // It sinks by less than half a spacing, and currents at the edges of the tank die out.
    let sunk = 2.0 * (before - height(&particles)) / spacing;
    eprintln!("sinks by {sunk} spacings, {rms} m/s after a second");
    assert!(sunk.abs() < 0.5 && rms < 0.03 * f64::from(9.81 * size.y).sqrt(), "{sunk} spacings, {rms} m/s");
    assert_eq!((particles.len() as u32, stats.wall_corrections), (stats.particles, 0), "{stats:?}");
    // Control: the lattice has particles that close to the tank.
    let away = (Quat::from_rotation_y(-0.5), 0.5 * size - 0.49 * spacing);
    let is_near = |x: &&[f32; 3]| {
        (away.0 * (Vec3::from(**x) - middle)).abs().with_y(0.0).cmpgt(away.1.with_y(1.0)).any()
    };
    let lattice = sample::particles(&scene).unwrap().positions;
    assert!(lattice.iter().filter(is_near).count() > lattice.len() / 20);
}

#[test]
fn a_frame_of_a_run_around_a_body_can_be_imported() {
    let low = Vec3::new(0.2, 0.0, 0.15);
    for (form, text) in [FORMS[3], FORMS[0]] {
        let mut scene = pool::pool(text, SPACING);
        let mesh = cube(low);
        scene.bodies.push(pool::body("earlier", &mesh, BoundaryKind::Map));
        let mut earlier = Simulation::new(&scene, &Device::Cpu).unwrap();
        earlier.advance(0.2).unwrap();
        let frame = earlier.particles().unwrap();
        let near = |x: &&[f32; 3]| {
            let beyond = (Vec3::from(**x) - low - 0.5 * CUBE).abs() - 0.5 * CUBE;
            beyond.max_element() < 0.49 * SPACING
        };
        // Control: particles that a block would start without.
        let near = frame.positions.iter().filter(near).count();
        assert!(near > 20, "{form}: {near}");
        let name = format!("frame-{form}.ply");
        let folder = std::path::PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
        splashdown_io::write_particles(&folder.join(&name), &frame).unwrap();
        let fluid = format!("[[fluid.file]]\nfile = \"{name}\"\n");
        let mut later = pool::pool_of(text, SPACING, &fluid, &folder.join("later.toml"));
        later.bodies.push(pool::body("later", &mesh, BoundaryKind::Map));
        let mut later = Simulation::new(&later, &Device::Cpu).unwrap();
        let imported = later.particles().unwrap();
        assert_eq!(imported.positions.len(), frame.positions.len(), "{form}");
        assert!(later.packing().unwrap().density().excess < SOUND, "{form}: {:?}", later.packing());
    }
}
