//! A small pool of still water, and the measure of its stillness.

use std::fmt;
use std::path::{Path, PathBuf};

use glam::{Quat, Vec3};
use splashdown::scene::{Body, BoundaryKind, MeshShape, MeshSource, Motion, Scene, SolidContact, UpAxis};
use splashdown::{Device, Simulation};
use splashdown_io::Mesh;

/// Particle spacing in m of the cases that the tests run.
pub const SPACING: f32 = 0.05;
/// Size of the domain and depth of the water in m.
pub const SIZE: Vec3 = Vec3::new(0.6, 0.8, 0.5);
pub const DEPTH: f32 = 0.4;

/// The forms of the equations: name and keys of `[solver]`.
pub const FORMS: [(&str, &str); 4] = [
    ("summation", "method = \"wcsph\"\ndensity = \"summation\"\n"),
    ("continuity", "method = \"wcsph\"\ndensity = \"continuity\"\n"),
    ("mueller2003", "method = \"mueller2003\"\n"),
    ("dfsph", "method = \"dfsph\"\n"),
];

/// A pool that is open at the top, without bodies. `form` are keys of `[solver]`, and `spacing` is in m.
pub fn pool(form: &str, spacing: f32) -> Scene {
    let [x, _, z] = SIZE.to_array();
    let block = format!("[[fluid.block]]\nposition = [0, 0, 0]\nsize = [{x}, {DEPTH}, {z}]\n");
    pool_of(form, spacing, &block, Path::new("pool.toml"))
}

/// A [`pool`] of other fluid, whose files lie beside `path`.
pub fn pool_of(form: &str, spacing: f32, fluid: &str, path: &Path) -> Scene {
    let [x, y, z] = SIZE.to_array();
    let text = format!(
        "[scene]\nname = \"pool\"\nduration = 1.0\n[domain]\nmin = [0, 0, 0]\nmax = [{x}, {y}, {z}]\nopen = [\"y_max\"]\n[solver]\n{form}\
         [fluid]\nparticle_spacing = {spacing}\n{fluid}"
    );
    Scene::parse_beside(&text, path).unwrap_or_else(|errors| panic!("{errors}"))
}

/// A static body with this mesh, which is written to a temporary file.
pub fn body(name: &str, mesh: &Mesh, boundary: BoundaryKind) -> Body {
    Body {
        name: name.into(),
        mesh: MeshSource {
            shape: MeshShape::File(file(name, mesh)),
            scale: Vec3::ONE,
            up: UpAxis::Y,
            position: Vec3::ZERO,
            rotation: Quat::IDENTITY,
        },
        motion: Motion::Static,
        friction: 0.0,
        adhesion: 0.0,
        contact: SolidContact::default(),
        boundary,
        half_thickness: None,
        shell: None,
        colour: None,
    }
}

fn file(name: &str, mesh: &Mesh) -> PathBuf {
    use std::sync::atomic::{AtomicU32, Ordering};
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
    let number = COUNT.fetch_add(1, Ordering::Relaxed);
    let path = folder.join(format!("starts-{}-{number}-{name}.obj", std::process::id()));
    splashdown_io::write_mesh(&path, mesh).unwrap();
    path
}

/// How a pool behaves in its first second.
pub struct Outcome {
    pub particles: usize,
    /// Largest density error at the start, over the rest density, and its place.
    pub start: (f32, Vec3),
    /// Largest rms speed of 20 samples, and that of the last, over the square root of g times the depth.
    pub peak: f32,
    pub rms: f32,
    pub lost: u32,
    pub inside: u32,
    pub corrections: u64,
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { particles, start: (error, at), peak, rms, lost, inside, corrections } = self;
        write!(
            f,
            "{particles:5} particles, start {:+6.1} % at {at:.3}, peak {:5.2} %, rms {:6.3} %, lost {lost}, inside {inside}, \
             corrections {corrections}",
            100.0 * error,
            100.0 * peak,
            100.0 * rms,
        )
    }
}

/// Runs a scene for a second.
pub fn run(scene: &Scene) -> Outcome {
    let mut simulation = Simulation::new(scene, &Device::Cpu).unwrap();
    let first = simulation.particles().unwrap();
    let rest = simulation.params().rest_density;
    let (densest, _) =
        first.densities.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)).expect("particles");
    let start = (first.densities[densest] / rest - 1.0, Vec3::from(first.positions[densest]));
    let scale = (scene.gravity.length() * DEPTH).sqrt();
    let (mut peak, mut rms) = (0.0_f32, 0.0);
    for _ in 0..20 {
        simulation.advance(0.05).unwrap();
        let particles = simulation.particles().unwrap();
        let squares = particles.velocities.iter().map(|v| Vec3::from(*v).length_squared());
        rms = (squares.sum::<f32>() / particles.len().max(1) as f32).sqrt() / scale;
        peak = peak.max(rms);
    }
    let last = simulation.particles().unwrap();
    let stats = simulation.stats();
    Outcome {
        particles: first.len(),
        start,
        peak,
        rms,
        lost: (first.len() - last.len()) as u32,
        inside: simulation.inside_bodies(&last).unwrap(),
        corrections: u64::from(stats.wall_corrections),
    }
}
