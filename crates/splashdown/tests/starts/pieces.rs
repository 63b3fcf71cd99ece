//! Fluid made of pieces: blocks, meshes and files that touch or overlap by a part of a spacing.

use std::path::PathBuf;

use glam::Vec3;
use splashdown::scene::Scene;
use splashdown::{Device, Particles, Simulation, sample};

use crate::meshes::cuboid;

/// The largest density error of a sound start.
const SOUND: f32 = 0.02;

fn scene(fluid: &str) -> Scene {
    let text = format!(
        "[scene]\nname = \"pieces\"\nduration = 1.0\n[domain]\nmin = [0, 0, 0]\nmax = [0.6, 0.8, 0.48]\nopen = [\"y_max\"]\n\
         [fluid]\nparticle_spacing = 0.04\n{fluid}"
    );
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("pieces.toml");
    Scene::parse_beside(&text, &path).unwrap_or_else(|errors| panic!("{errors}"))
}

fn block(position: [f32; 3], size: [f32; 3]) -> String {
    format!("[[fluid.block]]\nposition = {position:?}\nsize = {size:?}\n")
}

/// Mechanical energy in J for particles of 1 kg, above the floor.
fn energy(particles: &Particles) -> f32 {
    let each = particles.positions.iter().zip(&particles.velocities);
    each.map(|(x, v)| 9.81 * x[1] + 0.5 * Vec3::from(*v).length_squared()).sum()
}

#[test]
fn a_column_on_a_pool_of_another_height_does_not_burst() {
    let scene = scene(&format!(
        "{}{}",
        block([0.0; 3], [0.6, 0.19, 0.48]),
        block([0.0, 0.19, 0.0], [0.2, 0.4, 0.48])
    ));
    let mut simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
    let packing = simulation.packing().unwrap();
    eprintln!("{packing}");
    // The column continues the lattice of the pool, so nothing is relaxed.
    assert!(packing.after.is_none() && packing.before.excess < SOUND, "{packing:?}");
    let before = energy(&simulation.particles().unwrap());
    simulation.advance(0.05).unwrap();
    let after = simulation.particles().unwrap();
    let fastest = after.velocities.iter().map(|v| Vec3::from(*v).length()).fold(0.0, f32::max);
    // Free fall from the top of the column takes 0.29 s; in 0.05 s nothing becomes faster than a few times g t.
    assert!(fastest < 2.0, "{fastest} m/s");
    assert!(energy(&after) < 1.001 * before, "{} of {before}", energy(&after));
}

#[test]
fn blocks_with_gaps_and_overlaps_are_relaxed() {
    // A ball of fluid that touches the pool has a lattice of its own.
    let pieces = [
        block([0.0; 3], [0.6, 0.2, 0.48])
            + "[[fluid.block]]\nshape = \"sphere\"\ncenter = [0.31, 0.33, 0.23]\nradius = 0.145\n",
        // The lattices of both blocks end at walls, a part of a spacing apart.
        block([0.0; 3], [0.29, 0.2, 0.48]) + &block([0.29, 0.0, 0.0], [0.31, 0.2, 0.48]),
    ];
    for fluid in pieces {
        let scene = scene(&fluid);
        let simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
        let packing = simulation.packing().unwrap();
        eprintln!("{packing}");
        assert!(packing.is_sound(), "{packing:?}");
        assert!(packing.density().excess < SOUND);
        assert!(packing.moved < 0.04, "{packing:?}");
    }
}

#[test]
fn a_mesh_on_a_pool_does_not_burst() {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
    let low = Vec3::new(0.0, 0.213, 0.0);
    splashdown_io::write_mesh(&folder.join("upper-half.obj"), &cuboid(low, Vec3::new(0.6, 0.4, 0.48)))
        .unwrap();
    let scene =
        scene(&format!("{}[[fluid.mesh]]\nmesh = \"upper-half.obj\"\n", block([0.0; 3], [0.6, 0.2, 0.48])));
    let mut simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
    let packing = simulation.packing().unwrap().clone();
    eprintln!("{packing}");
    // Control: the particles as they are placed would burst or leave a gap.
    let placed = sample::particles(&scene).unwrap();
    let heights = |particles: &Particles| {
        let mut heights: Vec<f32> = particles.positions.iter().map(|x| x[1]).collect();
        heights.sort_by(f32::total_cmp);
        heights.dedup_by(|a, b| (*a - *b).abs() < 1e-4);
        heights
    };
    assert!(heights(&placed).windows(2).any(|pair| (pair[1] - pair[0] - 0.04).abs() > 0.004));
    assert!(packing.density().excess < SOUND, "{packing:?}");
    // The mesh is 4.7 spacings high and gets five layers: the fluid settles, but does not burst.
    let before = energy(&simulation.particles().unwrap());
    simulation.advance(0.1).unwrap();
    let last = simulation.particles().unwrap();
    assert!(energy(&last) < 1.001 * before, "{} of {before}", energy(&last));
    assert_eq!(last.len(), placed.len());
}

/// Particles of a lattice with these neighbours per particle, in a box.
fn cloud(kind: &str, spacing: f32) -> Vec<[f32; 3]> {
    let (low, high) = (Vec3::new(0.02, 0.02, 0.02), Vec3::new(0.58, 0.4, 0.46));
    let mut points = Vec::new();
    let mut seed = 1_u32;
    let mut random = || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 8) as f32 / 16_777_216.0 - 0.5
    };
    let n = ((high - low) / spacing).ceil().as_ivec3() * 2;
    for k in 0..n.z {
        for j in 0..n.y {
            for i in 0..n.x {
                let index = Vec3::new(i as f32, j as f32, k as f32);
                let x = match kind {
                    // Hexagonal layers.
                    "hexagonal" => {
                        let shift = 0.5 * (j % 2) as f32;
                        Vec3::new(index.x + shift, index.y * 0.816, (index.z + shift * 0.577) * 0.866)
                    }
                    "random" => index + 0.8 * Vec3::new(random(), random(), random()),
                    _ => index,
                };
                let x = low + x * spacing;
                if x.cmple(high).all() && x.cmpge(low).all() {
                    points.push(x.to_array());
                }
            }
        }
    }
    points
}

#[test]
fn imported_clouds_are_relaxed_or_reported() {
    for (kind, spacing) in [
        // The same number density, and 1.08 and 1.35 times it.
        ("hexagonal", 0.04 * 1.122),
        ("random", 0.04),
        ("cubic", 0.04 / 1.08_f32.cbrt()),
        ("cubic", 0.04 / 1.35_f32.cbrt()),
    ] {
        let positions = cloud(kind, spacing);
        let name = format!("{kind}-{spacing}.ply");
        let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(&name);
        splashdown_io::write_particles(&path, &Particles::from_positions(positions)).unwrap();
        let scene = scene(&format!("[[fluid.file]]\nfile = \"{name}\"\n"));
        let mut simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
        let packing = simulation.packing().unwrap().clone();
        eprintln!("{kind} {spacing}: {packing}");
        assert!(packing.density().excess < SOUND, "{packing:?}");
        let stats = simulation.advance(0.02).unwrap();
        let fastest = simulation.particles().unwrap();
        let fastest = fastest.velocities.iter().map(|v| Vec3::from(*v).length()).fold(0.0, f32::max);
        // Free fall reaches 0.2 m/s; today's clouds burst at 31 m/s.
        assert!(fastest < 0.8, "{kind}: {fastest} m/s, {stats:?}");
    }
}

#[test]
fn clouds_that_cannot_rest_are_refused() {
    let start = |name: &str, positions: Vec<[f32; 3]>| {
        let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
        splashdown_io::write_particles(&path, &Particles::from_positions(positions)).unwrap();
        let scene = scene(&format!("[[fluid.file]]\nfile = {name:?}\n"));
        Simulation::new(&scene, &Device::Cpu).map(|simulation| simulation.packing().unwrap().clone())
    };
    // Half the spacing: 8 times the density. The densities of a million particles in one place are never summed.
    let dense = start("dense.ply", cloud("cubic", 0.02)).expect_err("8 times as dense").to_string();
    assert!(dense.contains("times as dense as at rest") && dense.contains("particle_spacing"), "{dense}");
    let points: Vec<_> = (0..1_000_000).map(|i| [0.3 + 1e-9 * i as f32, 0.2, 0.2]).collect();
    let point = start("point.ply", points).expect_err("all in one place").to_string();
    assert!(point.contains("the fluid starts on average 1000000.0 times"), "{point}");
    // Control: a few particles inside one another are relaxed.
    let mut few = cloud("cubic", 0.04);
    few.extend_from_within(..3);
    assert!(start("few.ply", few).unwrap().density().excess < SOUND);
}

#[test]
fn an_emitter_inside_the_pool_starts_without_overlap() {
    let scene = scene(&format!(
        "{}[[emitter]]\nname = \"jet\"\nposition = [0.31, 0.17, 0.23]\ndirection = [1, 0, 0]\nspeed = 0.5\nradius = 0.07\n[solver]\nmethod = \"wcsph\"\n",
        block([0.0; 3], [0.6, 0.4, 0.48])
    ));
    let mut simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
    let packing = simulation.packing().unwrap().clone();
    eprintln!("{packing}");
    assert!(packing.density().excess < SOUND, "{packing:?}");
    simulation.advance(0.05).unwrap();
    let particles = simulation.particles().unwrap();
    let fastest = particles.velocities.iter().map(|v| Vec3::from(*v).length()).fold(0.0, f32::max);
    assert!(fastest < 1.5, "{fastest} m/s");
}

#[test]
fn a_box_between_walls_starts_at_rest_density() {
    // 10.5 and 20.4 spacings between the walls.
    let text = "[scene]\nname = \"between\"\nduration = 1\n[domain]\nmin = [0, 0, 0]\nmax = [0.525, 1, 1.02]\n[fluid]\n\
                particle_spacing = 0.05\n[[fluid.block]]\nposition = [0, 0, 0]\nsize = [0.525, 0.6, 1.02]\n";
    let scene = Scene::parse(text, "between").unwrap_or_else(|errors| panic!("{errors}"));
    // The lowest and the highest density of particles below the surface, over that at rest.
    let densities = |positions: &[[f32; 3]]| {
        let particles = Particles::from_positions(positions.to_vec());
        let executor = Device::Cpu.executor().unwrap();
        let mut simulation = Simulation::with_particles(&scene, executor, &particles).unwrap();
        let rest = simulation.params().rest_density;
        let found = simulation.particles().unwrap();
        let inner = found.positions.iter().zip(&found.densities).filter(|(x, _)| x[1] < 0.4);
        inner.fold((f32::INFINITY, 0.0_f32), |(low, high), (_, density)| {
            (low.min(density / rest), high.max(density / rest))
        })
    };
    let positions = sample::particles(&scene).unwrap().positions;
    let (low, high) = densities(&positions);
    assert!(low > 0.99 && high < 1.01, "{low} {high}");
    // Control: with layers a spacing apart there are gaps at the walls.
    let cubic: Vec<[f32; 3]> = (0..10 * 12 * 20)
        .map(|i| [i % 10, i / 10 % 12, i / 120].map(|k| 0.05 * (k as f32 + 0.5)))
        .map(|[x, y, z]| [x + 0.0125, y, z + 0.01])
        .collect();
    let (low, _) = densities(&cubic);
    assert!(low < 0.98, "{low}");
}
