//! Every file, mesh and particle set of a scene is read or built only once.

use std::path::Path;

use splashdown_io::Particles;

use crate::scene::{Derived, Scene};
use crate::{Checkpoint, Device, Simulation, inventory, memory_forecast, memory_forecast_of, models, work};

/// A scene with a file in every section that can name one.
const SCENE: &str = "
    [scene]
    name = \"everything\"
    duration = 0.1
    [domain]
    min = [0, 0, 0]
    max = [1, 1, 1]
    [fluid]
    particle_spacing = 0.05
    [[fluid.block]]
    position = [0, 0, 0]
    size = [1, 0.1, 1]
    [[fluid.mesh]]
    mesh = \"cube.stl\"
    scale = 0.2
    position = [0.2, 0.4, 0.2]
    [[fluid.file]]
    file = \"drop.ply\"
    [[body]]
    name = \"post\"
    mesh = \"cube.stl\"
    scale = 0.2
    position = [0.5, 0.1, 0.5]
    [[emitter]]
    name = \"tap\"
    shape = \"mesh\"
    mesh = \"cube.stl\"
    scale = 0.2
    position = [0.8, 0.8, 0.2]
    direction = [0, -1, 0]
    speed = 1
    [[sink]]
    name = \"hole\"
    shape = \"mesh\"
    mesh = \"cube.stl\"
    scale = 0.1
    position = [0.8, 0.1, 0.8]
";

/// The expected counts if everything is done once. A body, an outlet, a sink and a piece of fluid have a mesh
/// each.
const ONCE: [(&str, u32); 6] = [
    ("emitter built", 1),
    ("fluid sampled", 1),
    ("mesh read", 4),
    ("particle file read", 1),
    ("sink built", 1),
    ("solid built", 4),
];

fn write(folder: &Path) -> std::path::PathBuf {
    splashdown_io::write_mesh(&folder.join("cube.stl"), &models::build("cube").unwrap()).unwrap();
    let positions = (0..27).map(|i| [i % 3, i / 3 % 3, i / 9].map(|c| 0.6 + 0.05 * c as f32)).collect();
    let drop = Particles::from_positions(positions);
    splashdown_io::write_particles(&folder.join("drop.ply"), &drop).unwrap();
    let path = folder.join("everything.toml");
    std::fs::write(&path, SCENE).unwrap();
    path
}

fn is_once(counts: &work::Counts) -> bool {
    counts.iter().map(|(kind, count)| (*kind, *count)).eq(ONCE)
}

#[test]
fn loading_and_running_a_scene_builds_everything_once() {
    let folder = tempfile::tempdir().unwrap();
    let path = write(folder.path());
    let ((scene, derived, simulation), counts) = work::counted(|| {
        let scene = Scene::load(&path).unwrap();
        let derived = Derived::new(&scene);
        assert!(memory_forecast(&scene) > 0);
        let simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
        (scene, derived, simulation)
    });
    assert!(is_once(&counts), "{counts:?}");
    assert_eq!(derived.particles, 800 + 64 + 27);
    assert!(u64::from(simulation.stats().particles) <= derived.particles);
    // A value without influence on the geometry leaves the cache valid.
    let mut other = scene.clone();
    other.solver.cfl_factor = 0.2;
    assert!(work::counted(|| Derived::new(&other)).1.is_empty());
    // Negative controls: a changed scene is sampled again, and so is one whose particles have been taken.
    other.fluid.particle_spacing = 0.06;
    let (_, counts) = work::counted(|| Derived::new(&other));
    assert_eq!(counts["fluid sampled"], 1);
    let (_, counts) = work::counted(|| Simulation::new(&scene, &Device::Cpu).unwrap());
    assert_eq!(counts["fluid sampled"], 1);
}

#[test]
fn checking_a_scene_builds_everything_once() {
    let folder = tempfile::tempdir().unwrap();
    let path = write(folder.path());
    let ((), counts) = work::counted(|| {
        let scene = Scene::load(&path).unwrap();
        let counted = inventory(&scene, &|_, _| {}).unwrap();
        Derived::with_inventory(&scene, &counted);
        assert!(memory_forecast_of(&scene, &counted) > 0);
    });
    assert!(is_once(&counts), "{counts:?}");
}

#[test]
fn a_scene_of_models_is_built_once_from_its_text() {
    let text = SCENE
        .replace("cube.stl", "cube")
        .replace("[[fluid.file]]", "[[fluid.mesh]]")
        .replace("file = \"drop.ply\"", "mesh = \"cube\"\nscale = 0.2\nposition = [0.2, 0.7, 0.8]");
    let ((), counts) = work::counted(|| {
        let scene = Scene::parse(&text, "models.toml").unwrap();
        Derived::new(&scene);
        memory_forecast(&scene);
        Simulation::new(&scene, &Device::Cpu).unwrap();
    });
    assert_eq!(
        (counts["mesh read"], counts["solid built"], counts["fluid sampled"]),
        (5, 5, 1),
        "{counts:?}"
    );
}

#[test]
fn resuming_reads_every_file_once() {
    let folder = tempfile::tempdir().unwrap();
    let path = write(folder.path());
    let scene = Scene::load(&path).unwrap();
    let bytes = {
        let mut simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
        simulation.checkpoint(&scene.text).unwrap().to_bytes().unwrap()
    };
    let checkpoint = Checkpoint::from_bytes(&bytes).unwrap();
    let (resumed, counts) = work::counted(|| {
        checkpoint.scene().unwrap();
        Simulation::resume(&checkpoint, Device::Cpu.executor().unwrap()).unwrap()
    });
    assert!(is_once(&counts), "{counts:?}");
    assert_eq!(resumed.scene(), &scene);
}
