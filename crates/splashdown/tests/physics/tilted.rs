//! Water at rest in a tilted tank: once as a domain with tilted gravity, once as a tilted mesh in an upright domain.
//!
//! Both cases have the same water on the lattice of the tank and the same gates: p = rho g depth (L2 within 3 %), at rest
//! (rms within 1 % of sqrt(g depth)) after 2 s, no escaped particles, no wall corrections. Where two walls of one mesh
//! meet, the boundary map replaces them by one plane across the edge, whose hydrostatic pressure differs from that of the
//! two walls. In a tank of 12 particles, a third of the water is near edges and the pressure misses the gate; there it is
//! only reported.

use glam::{Quat, Vec3};
use splashdown::Simulation;
use splashdown::scene::{Motion, Scene};
use splashdown_io::Particles;

use super::cases::{Case, Variant};
use super::figures::Figures;
use super::meshes::tub;
use super::shapes::{body, file};
use super::{executor, rms_speed, scene};

const GRAVITY: f32 = 9.81;
/// The tilt in radians.
const TILT: f32 = 0.35;
/// The width of the tank in m.
const WIDTH: f32 = 0.3;
const CONTINUITY: &str =
    "density = \"continuity\"\nartificial_viscosity = 0.1\nsupport_ratio = 3\nsound_speed = 30";
const DFSPH: &str = "method = \"dfsph\"";

static CASE: Case = Case {
    name: "tilted tank",
    across: "width",
    sizes: &[12, 20, 40],
    variants: &[
        Variant::new("domain", CONTINUITY),
        Variant::new("mesh", CONTINUITY),
        Variant::extra("domain, dfsph", DFSPH),
        Variant::extra("mesh, dfsph", DFSPH),
    ],
};
pub const CASES: &[&Case] = &[&CASE];

/// The rotation from the frame of the tank to the world: the domain stays upright and gravity is tilted, or the mesh is
/// tilted.
struct Tank {
    /// Particles along x, y and z, up to the rim.
    size: [u32; 3],
    spacing: f32,
    turn: Quat,
    solver: &'static str,
}

impl Tank {
    fn new(across: u32, turn: Quat, solver: &'static str) -> Self {
        let size = [across, (1.2 * f64::from(across)) as u32, (0.6 * f64::from(across)) as u32];
        Self { size, spacing: WIDTH / across as f32, turn, solver }
    }

    fn inner(&self) -> Vec3 {
        Vec3::from(self.size.map(|n| n as f32)) * self.spacing
    }

    fn scene(&self, min: Vec3, max: Vec3) -> Scene {
        let gravity = self.turn * Quat::from_rotation_z(-TILT) * Vec3::new(0.0, -GRAVITY, 0.0);
        scene(&format!(
            "[scene]\nname = \"tilted\"\nduration = 2\ngravity = {:?}\n[domain]\nmin = {:?}\nmax = {:?}\n\
             [fluid]\nparticle_spacing = {}\nviscosity = 1e-6\n[[fluid.block]]\nposition = [0, 0, 0]\nsize = [0.1, 0.1, 0.1]\n\
             [solver]\n{}\n",
            gravity.to_array(),
            min.to_array(),
            max.to_array(),
            self.spacing,
            self.solver
        ))
    }

    /// The depth of a point, in the frame of the tank, below a level through the centre of the tank.
    fn depth(&self, x: Vec3) -> f32 {
        (0.5 * self.inner() - x).dot(Quat::from_rotation_z(-TILT) * Vec3::Y)
    }

    /// Water at rest up to the level.
    fn water(&self, scene: &Scene) -> Particles {
        let params = splashdown::schemes::params(scene, 0);
        // Not used by `dfsph`, whose density follows from the positions.
        let per_depth = GRAVITY / params.sound_speed.powi(2);
        let mut particles = Particles::default();
        let [nx, ny, nz] = self.size;
        for k in 0..nx * ny * nz {
            let node = Vec3::new((k % nx) as f32, (k / nx % ny) as f32, (k / (nx * ny)) as f32);
            let x = self.spacing * (node + 0.5);
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

    fn check(&self, scene: &Scene, figures: &mut Figures) {
        let water = self.water(scene);
        let mut simulation = Simulation::with_particles(scene, executor(), &water).unwrap();
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
        figures.error("pressure, L2 relative", (error / norm).sqrt());
        let wave = f64::from(GRAVITY * deepest).sqrt();
        figures.error("speed, rms over sqrt(g depth)", rms_speed(&particles) / wave);
        figures.measure("corrections", f64::from(stats.wall_corrections));
        let inside = simulation.inside_bodies(&particles).unwrap();
        figures.measure("particles inside the wall", f64::from(inside));
    }
}

#[test]
fn water_is_at_rest_in_a_tilted_tank() {
    CASE.run(|variant, across, figures| {
        if variant.name.starts_with("domain") {
            let tank = Tank::new(across, Quat::IDENTITY, variant.keys);
            tank.check(&tank.scene(Vec3::ZERO, tank.inner()), figures);
            return;
        }
        let tank = Tank::new(across, Quat::from_rotation_z(TILT), variant.keys);
        let folder = tempfile::tempdir().unwrap();
        let mesh = tub(Vec3::ZERO, tank.inner(), 3.0 * tank.spacing);
        let reach = Vec3::splat(1.6 * tank.inner().max_element());
        let mut scene = tank.scene(-reach, reach);
        let mut tub = body("tub", file(folder.path(), "tub.obj", &mesh), 1.0, Vec3::ZERO, Motion::Static);
        tub.mesh.rotation = tank.turn;
        scene.bodies.push(tub);
        tank.check(&scene, figures);
    });
}
