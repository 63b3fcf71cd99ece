//! Water at rest in a tank that stands askew: once as a domain under leaning gravity, once as a leaning mesh in
//! an upright domain.
//!
//! The same water on the tank's own lattice, the same gates: p = rho g depth (L2 within 3 %), at rest (rms
//! within 1 % of sqrt(g depth)) after 2 s, and nothing leaves or has to be put back. Where two walls of one
//! mesh meet, the mesh is felt as a plane across the edge, whose hydrostatic part is not that of the two: in a
//! tank of 12 particles, where a third of the water is beside edges, the pressure misses the gate, and is
//! judged at full size only.

use glam::{Quat, Vec3};
use splashdown::Simulation;
use splashdown::scene::{Motion, Scene};
use splashdown_gpu::CpuExecutor;
use splashdown_io::Particles;

use super::figures::{Figures, full};
use super::shapes::{body, file, tub};
use super::{rms_speed, scene};

const GRAVITY: f32 = 9.81;
/// The tilt in radians.
const TILT: f32 = 0.35;
const SPACING: f32 = 0.025;

/// From the tank's frame into the world: the domain's tank lies still while gravity leans, the mesh's leans itself.
struct Tank {
    /// Particles along x, y and z, to the rim.
    size: [u32; 3],
    turn: Quat,
}

impl Tank {
    fn new(turn: Quat) -> Self {
        Self { size: if full() { [20, 24, 12] } else { [12, 14, 7] }, turn }
    }

    fn inner(&self) -> Vec3 {
        Vec3::from(self.size.map(|n| n as f32)) * SPACING
    }

    fn scene(&self, min: Vec3, max: Vec3) -> Scene {
        let gravity = self.turn * Quat::from_rotation_z(-TILT) * Vec3::new(0.0, -GRAVITY, 0.0);
        scene(&format!(
            "[scene]\nname = \"tilted\"\nduration = 2\ngravity = {:?}\n[domain]\nmin = {:?}\nmax = {:?}\n\
             [fluid]\nparticle_spacing = {SPACING}\nviscosity = 1e-6\n[[fluid.block]]\nposition = [0, 0, 0]\nsize = [0.1, 0.1, 0.1]\n\
             [solver]\ndensity = \"continuity\"\nartificial_viscosity = 0.1\nsupport_ratio = 3\nsound_speed = 30\n",
            gravity.to_array(),
            min.to_array(),
            max.to_array()
        ))
    }

    /// How deep a point of the tank's frame lies under a level through the tank's middle at half of its height.
    fn depth(&self, x: Vec3) -> f32 {
        (0.5 * self.inner() - x).dot(Quat::from_rotation_z(-TILT) * Vec3::Y)
    }

    /// Water at rest up to the level.
    fn water(&self, scene: &Scene) -> Particles {
        let params = splashdown::schemes::params(scene, 0);
        let per_depth = GRAVITY / params.sound_speed.powi(2);
        let mut particles = Particles::default();
        let [nx, ny, nz] = self.size;
        for k in 0..nx * ny * nz {
            let node = Vec3::new((k % nx) as f32, (k / nx % ny) as f32, (k / (nx * ny)) as f32);
            let x = SPACING * (node + 0.5);
            let depth = self.depth(x);
            if depth > 0.0 {
                particles.positions.push((self.turn * x).to_array());
                particles.velocities.push([0.0; 3]);
                particles.densities.push(params.rest_density * (1.0 + per_depth * depth));
            }
        }
        particles.ids = (0..particles.positions.len() as u32).collect();
        particles
    }

    fn judge(&self, case: &str, scene: &Scene) {
        let water = self.water(scene);
        let mut simulation = Simulation::with_particles(scene, CpuExecutor::new().into(), &water).unwrap();
        let stats = simulation.advance(2.0).unwrap();
        assert_eq!((stats.escaped, stats.non_finite), (0, 0), "{stats:?}");
        let particles = simulation.particles().unwrap();
        let (mut error, mut norm, mut deepest) = (0.0, 0.0, 0.0_f32);
        for (x, &p) in particles.positions.iter().zip(&particles.pressures) {
            let depth = self.depth(self.turn.conjugate() * Vec3::from(*x)).max(0.0);
            let exact = simulation.params().rest_density * GRAVITY * depth;
            deepest = deepest.max(depth);
            error += f64::from(p - exact).powi(2);
            norm += f64::from(exact).powi(2);
        }
        let mut figures = Figures::new(case);
        let error = (error / norm).sqrt();
        if full() || scene.bodies.is_empty() {
            figures.at_most("pressure, L2 relative", error, 0.03);
        } else {
            figures.report("pressure, L2 relative", error);
        }
        let wave = f64::from(GRAVITY * deepest).sqrt();
        figures.at_most("speed, rms over sqrt(g depth)", rms_speed(&particles) / wave, 0.01);
        figures.at_most("corrections", f64::from(stats.wall_corrections), 0.0);
        let inside = simulation.inside_bodies(&particles).unwrap();
        figures.at_most("particles inside the wall", f64::from(inside), 0.0);
        figures.close();
    }
}

#[test]
fn water_is_at_rest_in_a_tilted_domain() {
    let tank = Tank::new(Quat::IDENTITY);
    tank.judge("tilted tank, domain, CPU", &tank.scene(Vec3::ZERO, tank.inner()));
}

#[test]
fn water_is_at_rest_in_a_tilted_mesh() {
    let tank = Tank::new(Quat::from_rotation_z(TILT));
    let folder = tempfile::tempdir().unwrap();
    let mesh = tub(Vec3::ZERO, tank.inner(), 3.0 * SPACING);
    let reach = Vec3::splat(1.6 * tank.inner().max_element());
    let mut scene = tank.scene(-reach, reach);
    let mut tub = body("tub", file(folder.path(), "tub.obj", &mesh), 1.0, Vec3::ZERO, Motion::Static);
    tub.mesh.rotation = tank.turn;
    scene.bodies.push(tub);
    tank.judge("tilted tank, mesh, CPU", &scene);
}
