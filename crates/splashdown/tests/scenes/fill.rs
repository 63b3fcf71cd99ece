//! Meshes filled with fluid, and files with initial particles.

use std::path::Path;

use glam::Vec3;
use splashdown::scene::{Derived, Scene};
use splashdown::{Device, Simulation, check, memory_forecast, sample};
use splashdown_io::{Particles, write_particles};

use crate::{changed, parse};

const BLOCK: &str = "[[fluid.block]]\nposition = [0, 0, 0]\nsize = [0.5, 0.5, 0.5]\n";

/// The tank of the cube with these pieces of fluid instead of its block, and another spacing.
fn tank(spacing: f32, pieces: &str) -> String {
    changed(BLOCK, pieces).replace("0.05", &spacing.to_string())
}

fn valid(text: &str) -> Scene {
    parse(text).unwrap_or_else(|errors| panic!("{errors}"))
}

/// Loads a scene from a folder.
fn load(folder: &Path, text: &str) -> Result<Scene, String> {
    let path = folder.join("scene.toml");
    std::fs::write(&path, text).expect("written");
    Scene::load(&path).map_err(|errors| errors.to_string())
}

/// Volume of a mesh in m^3 by the divergence theorem, independent of the particles.
fn volume(mesh: &splashdown_io::Mesh) -> f64 {
    let corner = |v: u32| Vec3::from(mesh.vertices[v as usize]).as_dvec3();
    mesh.triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(corner);
            a.dot(b.cross(c)) / 6.0
        })
        .sum()
}

#[test]
fn a_filled_mesh_has_the_volume_of_the_mesh() {
    for (model, scale, spacing) in
        [("sphere", 2.0f32, 0.02f32), ("torus-knot", 1.2, 0.008), ("lighthouse", 0.8, 0.015)]
    {
        let scene = valid(&tank(
            spacing,
            &format!(
                "[[fluid.mesh]]\nmesh = \"{model}\"\nscale = {scale}\nposition = [0.5, 0.4, 0.5]\nrotation = [0, 30, 10]\n\
                 velocity = [0, -1, 0]\n"
            ).replace("0.4", if model == "lighthouse" { "0.1" } else { "0.5" }),
        ));
        let particles = sample::particles(&scene).expect("it can be filled");
        assert_eq!(check::count(&scene), particles.len() as u64);
        assert!(particles.velocities.iter().all(|v| *v == [0.0, -1.0, 0.0]));
        let exact = volume(&splashdown::models::build(model).expect("a model")) * f64::from(scale).powi(3);
        let error = particles.len() as f64 * f64::from(spacing).powi(3) / exact - 1.0;
        assert!(error.abs() < 0.03, "{model}: {} particles, {error}", particles.len());
        // Control: a scale larger by 2 % is detected.
        assert!((1.0 + error) / 1.02f64.powi(3) < 0.97 + 0.03, "{model}");
    }
}

#[test]
fn a_filled_cube_is_the_block_of_its_size() {
    let block = valid(&tank(0.05, BLOCK));
    let mesh =
        valid(&tank(0.05, "[[fluid.mesh]]\nmesh = \"cube\"\nscale = 0.5\nposition = [0.25, 0.25, 0.25]\n"));
    let (a, b) = (sample::particles(&block).expect("sampled"), sample::particles(&mesh).expect("filled"));
    assert_eq!(a.len(), b.len());
    for (x, y) in a.positions.iter().zip(&b.positions) {
        assert!(Vec3::from(*x).distance(Vec3::from(*y)) < 1e-5, "{x:?} {y:?}");
    }
}

#[test]
fn overlapping_fluid_is_removed_from_the_later_piece() {
    let ball = "[[fluid.mesh]]\nmesh = \"sphere\"\nscale = 2\nposition = [0.5, 0.5, 0.5]\n";
    let alone = check::count(&valid(&tank(0.02, ball)));
    let folder = tempfile::tempdir().expect("a folder");
    let both = load(folder.path(), &tank(0.02, &format!("{BLOCK}{ball}"))).expect("valid");
    let warning = both.warnings.iter().map(ToString::to_string).collect::<String>();
    assert!(
        warning.contains("fluid.mesh[0] (\"sphere\") overlaps") && warning.contains("are left out"),
        "{warning}"
    );
    let points = sample::particles(&both).expect("sampled").positions;
    let block = check::count(&valid(&tank(0.02, BLOCK)));
    // An eighth of the ball is in the block.
    let kept = points.len() as f64 - block as f64;
    assert!((kept / alone as f64 - 0.875).abs() < 0.04, "{kept} of {alone}");
    let nearest = points[block as usize..]
        .iter()
        .flat_map(|x| points[..block as usize].iter().map(|y| Vec3::from(*x).distance(Vec3::from(*y))))
        .fold(f32::INFINITY, f32::min);
    assert!(nearest >= 0.6 * 0.02 - 1e-6, "{nearest}");
    let separate = load(folder.path(), &tank(0.02, ball)).expect("valid");
    assert!(separate.warnings.is_empty(), "control: {}", separate.warnings[0]);
}

fn some_particles(velocities: bool) -> Particles {
    let positions: Vec<[f32; 3]> =
        (0..1000).map(|i| [i % 10, i / 10 % 10, i / 100].map(|c| 50.0 * c as f32)).collect();
    Particles::from_positions(positions).with_velocities(if velocities {
        vec![[1000.0, 0.0, 0.0]; 1000]
    } else {
        Vec::new()
    })
}

#[test]
fn particles_of_a_file_are_scaled_and_rotated_with_their_velocities() {
    let folder = tempfile::tempdir().expect("a folder");
    for has_velocities in [true, false] {
        write_particles(&folder.path().join("drop.ply"), &some_particles(has_velocities)).expect("written");
        let piece = "[[fluid.file]]\nfile = \"drop.ply\"\nscale = \"mm\"\nposition = [0.6, 0.1, 0.1]\nrotation = [0, 0, 90]\n\
                     velocity = [0, 0, 2]\n";
        let scene = load(folder.path(), &tank(0.05, piece)).expect("valid");
        assert!(scene.warnings.is_empty(), "{}", scene.warnings[0]);
        let particles = sample::particles(&scene).expect("read");
        assert_eq!((particles.len(), check::count(&scene)), (1000, 1000));
        assert!(Vec3::from(particles.positions[9]).distance(Vec3::new(0.6, 0.55, 0.1)) < 1e-5);
        let expected = Vec3::new(0.0, if has_velocities { 1.0 } else { 0.0 }, 2.0);
        assert!(particles.velocities.iter().all(|v| Vec3::from(*v).distance(expected) < 1e-5));
        let derived = Derived::new(&scene);
        // Twice the square root of g times the head of 0.55 m, and the speed in the file.
        let fastest = (4.0 * 9.81 * 0.55 + expected.length_squared()).sqrt();
        assert!((derived.reference_speed / fastest - 1.0).abs() < 1e-3, "{}", derived.reference_speed);
    }
}

#[test]
fn a_file_with_another_spacing_or_position_gives_a_warning() {
    let folder = tempfile::tempdir().expect("a folder");
    write_particles(&folder.path().join("drop.ply"), &some_particles(false)).expect("written");
    let warnings = |text: &str| {
        let scene = load(folder.path(), text).expect("valid");
        scene.warnings.iter().map(|warning| format!("{warning}\n")).collect::<String>()
    };
    let piece = "[[fluid.file]]\nfile = \"drop.ply\"\nscale = \"mm\"\nposition = [0.1, 0.1, 0.1]\n";
    let spacing = warnings(&tank(0.02, piece));
    assert!(
        spacing.contains("scene.toml:14")
            && spacing.contains("about 0.05 m apart, but fluid.particle_spacing is 0.02 m")
            && spacing.contains("use fluid.particle_spacing = 0.05"),
        "{spacing}"
    );
    let outside = warnings(&tank(0.05, &piece.replace("[0.1, 0.1, 0.1]", "[0.78, 0.1, 0.1]")));
    assert!(
        outside.contains("500 of the 1,000 particles of fluid.file[0] (\"drop.ply\") lie outside"),
        "{outside}"
    );
    let far = load(folder.path(), &tank(0.05, &piece.replace("\"mm\"", "1"))).map(drop).expect_err("metres");
    assert!(far.contains("lies mostly outside the domain") && far.contains("scene.toml:14"), "{far}");
}

#[test]
fn a_scene_with_a_mesh_and_a_file_runs() {
    let folder = tempfile::tempdir().expect("a folder");
    write_particles(&folder.path().join("drop.ply"), &some_particles(true)).expect("written");
    let text = tank(
        0.05,
        "[[fluid.mesh]]\nmesh = \"sphere\"\nscale = 2.4\nposition = [0.3, 0.3, 0.3]\n\
         [[fluid.file]]\nfile = \"drop.ply\"\nscale = \"mm\"\nposition = [0.1, 0.5, 0.5]\n\
         [[body]]\nname = \"post\"\nmesh = \"block\"\nposition = [0.3, 0.3, 0.3]\n",
    );
    let scene = load(folder.path(), &text).expect("valid");
    let inventory = splashdown::inventory(&scene, &|_, _| {}).expect("it can be counted");
    let mut simulation = Simulation::new(&scene, &Device::Cpu).expect("it starts");
    assert_eq!(u64::from(simulation.stats().particles), inventory.particles);
    assert_eq!(u64::from(simulation.removed()), inventory.removed);
    assert!(inventory.removed > 10 && inventory.emitted == 0, "{inventory:?}");
    assert_eq!(inventory.particles + inventory.removed, check::count(&scene));
    let stats = simulation.advance(0.002).expect("it runs");
    assert!(stats.steps > 0 && stats.non_finite == 0 && stats.escaped == 0, "{stats:?}");
    let (forecast, taken) = (memory_forecast(&scene), simulation.memory());
    assert!(forecast > taken / 2, "{forecast} forecast, {taken} taken");
}

#[test]
fn particles_of_emitters_are_counted_in_advance() {
    let scene = valid(&tank(
        0.05,
        "[[emitter]]\nname = \"tap\"\nshape = \"rectangle\"\nsize = [0.2, 0.1]\nposition = [0.5, 0.8, 0.5]\ndirection = [0, -1, 0]\nspeed = 2\n\
         start = 0.25\nend = 0.75\n",
    ));
    let derived = Derived::new(&scene);
    // 8 particles a layer, 20 layers in half a second and one more.
    assert_eq!((derived.particles, derived.emitted), (0, 8 * 21));
    // On average they exist for half of the second.
    assert!((derived.mean_particles / 84.0 - 1.0).abs() < 0.1, "{}", derived.mean_particles);
    let inventory = splashdown::inventory(&scene, &|_, _| {}).expect("it can be counted");
    assert_eq!((inventory.particles, inventory.removed, inventory.emitted), (0, 0, 168));
    let mut capped = scene;
    capped.emitters[0].max_particles = Some(50);
    assert_eq!(Derived::new(&capped).emitted, 50);
}

/// Particles of two runs of another program, if the files exist.
#[test]
fn particles_of_another_program_are_read() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/particles");
    let file = folder.join("mid64k.npy");
    if !file.exists() {
        eprintln!("SKIPPED: {} does not exist", file.display());
        return;
    }
    let text = changed(BLOCK, &format!("[[fluid.file]]\nfile = {:?}\n", file.display().to_string()))
        .replace("min = [0, 0, 0]\nmax = [1, 1, 1]", "min = [-3.3, 0, -1.1]\nmax = [3.3, 3, 1.1]");
    let place = tempfile::tempdir().expect("a folder");
    let scene = load(place.path(), &text).expect("valid");
    assert!(scene.warnings.is_empty(), "{}", scene.warnings[0]);
    let read = sample::particles(&scene).expect("read");
    assert_eq!(read.len(), 64_000);
    let expected = splashdown_io::read_particles(&file).expect("read");
    assert_eq!(read.positions, expected.positions);
    let coarse = load(place.path(), &text.replace("0.05", "0.07")).expect("valid");
    let warning = coarse.warnings.iter().map(ToString::to_string).collect::<String>();
    assert!(warning.contains("use fluid.particle_spacing = 0.05"), "control: {warning}");
}
