//! A tank at rest: p = rho g (surface - y), the level, the load on the walls (after 2 s).
//!
//! The tank starts at hydrostatic pressure, as scenes do by default. Water released without pressure would oscillate for
//! a long time, because its viscosity is low. The continuity form, intended for measurements, has a support of three spacings; at two, the kernel
//! underestimates the pressure gradient of a lattice by 5 %. The summation form and mueller2003 use the defaults of
//! scenes; their pressure is reported without a gate.

use glam::Vec3;
use splashdown::{MouseForce, Simulation};
use splashdown_gpu::{Executor, testing};

use super::cases::{CONTROL, Case, Variant};
use super::figures::Figures;
use super::{executor, rms_speed, scene};

const GRAVITY: f64 = 9.81;

/// The height of the water in m.
const HEIGHT: f64 = 0.4;

/// `mueller2003` is not intended for measurements. Particles that sink to a quarter of a spacing are supported by the contact
/// in the integration, which the force on the walls does not contain.
static TANK: Case = Case {
    name: "tank at rest",
    across: "depth",
    sizes: &[16, 20, 40],
    variants: &[
        Variant::new("continuity", CONTINUITY),
        Variant::new("summation", SUMMATION),
        Variant::new("mueller2003", MUELLER),
        Variant::extra("engineering", "accuracy = \"engineering\""),
        Variant::extra("dfsph", "method = \"dfsph\""),
        CONTROL,
    ],
};
/// A tank small enough for software Vulkan: seven particles wide, eight deep. It runs for half a second instead of two,
/// with a gate of 5 % for the speed instead of 1 %.
static SMALL_TANK: Case = Case {
    name: "small tank at rest",
    across: "depth",
    sizes: &[8],
    variants: &[Variant::new("continuity", CONTINUITY), Variant::new("mueller2003", MUELLER)],
};
pub const CASES: &[&Case] = &[&TANK, &SMALL_TANK];

struct Tank {
    /// Particles along x, y and z.
    size: [u32; 3],
    spacing: f64,
    solver: &'static str,
    /// The simulated gravity in m/s^2; the figures are relative to 9.81 m/s^2.
    gravity: f64,
}

struct Rest {
    pressure: f64,
    level: f64,
    rms_speed: f64,
    max_speed: f64,
    load: f64,
    floor: f64,
    corrections: u32,
}

const CONTINUITY: &str =
    "method = \"wcsph\"\ndensity = \"continuity\"\nartificial_viscosity = 0.1\nsupport_ratio = 3";
const SUMMATION: &str = "method = \"wcsph\"\nartificial_viscosity = 0.1";
const MUELLER: &str = "method = \"mueller2003\"";

impl Tank {
    fn height(&self) -> f64 {
        f64::from(self.size[1]) * self.spacing
    }

    fn simulation(&self, executor: Executor) -> Simulation {
        let [x, y, z] = self.size.map(|n| f64::from(n) * self.spacing);
        let scene = scene(&format!(
            r#"
            [scene]
            name = "tank"
            duration = 2.0
            gravity = [0, {}, 0]
            [domain]
            min = [0, 0, 0]
            max = [{x}, {}, {z}]
            open = ["y_max"]
            [fluid]
            particle_spacing = {}
            viscosity = 1e-6
            [[fluid.block]]
            position = [0, 0, 0]
            size = [{x}, {y}, {z}]
            [solver]
            {}
            "#,
            -self.gravity,
            1.5 * y,
            self.spacing,
            self.solver
        ));
        Simulation::with_executor(&scene, executor).unwrap()
    }

    /// Lets the tank settle for `seconds` and measures it.
    fn settle(&self, executor: Executor, seconds: f32) -> Rest {
        let mut simulation = self.simulation(executor);
        // A mouse force without effect: the fused pass for forces and integration stores no accelerations.
        let mouse_force = MouseForce::new(Vec3::ZERO, Vec3::NEG_Y, Vec3::ZERO, 1.0, 0.0);
        simulation.set_mouse_force(Some(mouse_force)).unwrap();
        assert_eq!(simulation.stats().particles, self.size.iter().product::<u32>());
        simulation.advance(0.7 * seconds).unwrap();
        // The load oscillates with the remaining sound waves, so it is averaged over many of them.
        let samples = 100;
        let mut load = 0.0;
        for _ in 0..samples {
            simulation.advance(0.3 * seconds / samples as f32).unwrap();
            load += self.load(&mut simulation) / f64::from(samples);
        }
        let particles = simulation.particles().unwrap();
        let rest_density = f64::from(simulation.params().rest_density);
        let exact = |y: f64| rest_density * GRAVITY * (self.height() - y).max(0.0);
        let (mut error, mut norm, mut bottom) = (0.0, 0.0, (0.0, 0.0));
        for (x, &p) in particles.positions.iter().zip(&particles.pressures) {
            let (y, p) = (f64::from(x[1]), f64::from(p));
            error += (p - exact(y)).powi(2);
            norm += exact(y).powi(2);
            if y < self.spacing {
                bottom = (bottom.0 + p + rest_density * GRAVITY * y, bottom.1 + 1.0);
            }
        }
        let wave = (GRAVITY * self.height()).sqrt();
        let stats = simulation.stats();
        assert_eq!((stats.escaped, stats.non_finite), (0, 0), "{stats:?}");
        Rest {
            pressure: (error / norm).sqrt(),
            level: (self.level(&particles.positions) - self.height()) / self.spacing,
            rms_speed: rms_speed(&particles) / wave,
            max_speed: f64::from(stats.max_speed) / wave,
            load,
            floor: bottom.0 / bottom.1 / exact(0.0),
            corrections: stats.wall_corrections,
        }
    }

    /// The vertical force of the walls on the fluid over the weight of the particles: the sum of the accelerations
    /// without gravity. Pair forces cancel.
    fn load(&self, simulation: &mut Simulation) -> f64 {
        let accelerations = simulation.fields().accelerations;
        let accelerations = simulation.executor().read(accelerations).unwrap();
        let sum: f64 = accelerations.iter().map(|a| f64::from(a.y) + self.gravity).sum();
        sum / (accelerations.len() as f64 * GRAVITY)
    }

    /// The upper side of the highest particle, averaged over the columns.
    fn level(&self, positions: &[[f32; 3]]) -> f64 {
        let [nx, _, nz] = self.size.map(|n| n as usize);
        let mut tops = vec![0.0_f64; nx * nz];
        for x in positions {
            let column = |x: f32, n: usize| ((f64::from(x) / self.spacing) as usize).min(n - 1);
            let top = &mut tops[column(x[2], nz) * nx + column(x[0], nx)];
            *top = top.max(f64::from(x[1]) + 0.5 * self.spacing);
        }
        tops.iter().sum::<f64>() / tops.len() as f64
    }
}

impl Rest {
    fn write(&self, figures: &mut Figures) {
        figures.error("pressure, L2 relative", self.pressure);
        figures.error("speed, rms over sqrt(gH)", self.rms_speed);
        figures.report("speed, largest over sqrt(gH)", self.max_speed);
        figures.measure("level - fill, spacings", self.level);
        figures.measure("vertical wall force over particles' weight", self.load);
        figures.report("pressure at the floor over rho g H", self.floor);
        figures.measure("corrections at walls", f64::from(self.corrections));
    }
}

#[test]
fn a_tank_at_rest_has_the_hydrostatic_pressure() {
    TANK.run(|variant, across, figures| {
        let width = (3 * across).div_ceil(4);
        let size = [width, across, width];
        let tank = Tank { size, spacing: HEIGHT / f64::from(across), solver: variant.keys, gravity: GRAVITY };
        tank.settle(executor(), 2.0).write(figures);
    });
}

#[test]
fn weaker_gravity_is_detected() {
    let mut figures = Figures::new(&TANK, "control", 8);
    let tank = Tank { size: [7, 8, 7], spacing: 0.025, solver: CONTINUITY, gravity: 0.9 * GRAVITY };
    let light = tank.settle(executor(), 1.0);
    figures.measure("pressure, L2 relative, with 0.9 g", light.pressure);
    figures.measure("relative error of the wall force, with 0.9 g", (light.load - 1.0).abs());
    figures.close();
}

#[test]
fn a_small_tank_comes_to_rest_on_every_executor() {
    for &Variant { name: variant, keys: solver, .. } in SMALL_TANK.variants {
        for (name, executor) in testing::executors("a_small_tank_comes_to_rest_on_every_executor") {
            let mut figures = Figures::new(&SMALL_TANK, variant, 8).on(name);
            let tank = Tank { size: [7, 8, 7], spacing: 0.025, solver, gravity: GRAVITY };
            tank.settle(executor, 0.5).write(&mut figures);
            figures.close();
        }
    }
}
