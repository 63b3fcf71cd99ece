//! A tank at rest: p = rho g (surface - y), the level, the load on the walls (after 2 s).
//!
//! The tank starts at hydrostatic pressure, as scenes do by default. Water released without pressure would oscillate for
//! a long time, because its viscosity is low. The continuity form, intended for measurements, has a support of three spacings; at two, the kernel
//! underestimates the pressure gradient of a lattice by 5 %. The summation form and mueller2003 use the defaults of
//! scenes; their pressure is reported without a gate.

use glam::Vec3;
use splashdown::{MouseForce, Simulation};
use splashdown_gpu::{Executor, testing};

use super::figures::{Figures, full};
use super::{cpu, rms_speed, scene};

const GRAVITY: f64 = 9.81;

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
    /// The figures with gates for the speed, the level and the load on the walls.
    fn gated_figures(&self, case: &str, speed: f64) -> Figures {
        let mut figures = self.figures(case, speed);
        figures.within("level - fill, spacings", self.level, -0.5, 0.5);
        figures.within("vertical wall force over particles' weight", self.load, 0.99, 1.01);
        figures
    }

    /// The figures with the gates for all solvers: the water comes to rest, and no wall correction is needed.
    fn figures(&self, case: &str, speed: f64) -> Figures {
        let mut figures = Figures::new(case);
        figures.at_most("speed, rms over sqrt(gH)", self.rms_speed, speed);
        figures.at_most("corrections at walls", f64::from(self.corrections), 0.0);
        figures.report("speed, largest over sqrt(gH)", self.max_speed);
        figures.report("pressure at the floor over rho g H", self.floor);
        figures.report("pressure, L2 relative", self.pressure);
        figures
    }

    /// For mueller2003, whose pressure is not intended for measurements. Particles that sink to a quarter of a spacing are
    /// supported by the contact in the integration, which the force on the walls does not contain.
    fn report_mueller(&self, case: &str, speed: f64) {
        let mut figures = self.figures(case, speed);
        figures.report("level - fill, spacings", self.level);
        figures.report("vertical wall force over particles' weight", self.load);
        figures.close();
    }
}

fn tank(solver: &'static str) -> Tank {
    let size = if full() { [20, 20, 20] } else { [12, 16, 12] };
    Tank { size, spacing: 0.025, solver, gravity: GRAVITY }
}

#[test]
fn a_tank_at_rest_has_the_hydrostatic_pressure() {
    let rest = tank(CONTINUITY).settle(cpu(), 2.0);
    let mut figures = rest.gated_figures("hydrostatics, continuity, CPU", 0.01);
    figures.at_most("pressure, L2 relative, gate", rest.pressure, 0.03);
    figures.close();
    // Control: 0.9 g must miss the gates.
    let light = Tank { gravity: 0.9 * GRAVITY, size: [7, 8, 7], ..tank(CONTINUITY) }.settle(cpu(), 1.0);
    let mut figures = Figures::new("hydrostatics, controls, CPU");
    figures.control("pressure, L2 relative, with 0.9 g", light.pressure, 0.03);
    figures.control("relative error of the wall force, with 0.9 g", (light.load - 1.0).abs(), 0.01);
    figures.close();
}

#[test]
fn a_tank_with_summed_densities_comes_to_rest() {
    tank(SUMMATION).settle(cpu(), 2.0).gated_figures("hydrostatics, summation, CPU", 0.01).close();
    tank(MUELLER).settle(cpu(), 2.0).report_mueller("hydrostatics, mueller, CPU", 0.01);
}

/// A tank small enough for software Vulkan: seven particles wide, eight deep. It runs for half a second instead of two,
/// with a gate of 5 % instead of 1 %.
#[test]
fn a_small_tank_comes_to_rest_on_every_executor() {
    for (name, executor) in testing::executors("a_small_tank_comes_to_rest_on_every_executor") {
        let tank = Tank { size: [7, 8, 7], ..tank(CONTINUITY) };
        tank.settle(executor, 0.5).gated_figures(&format!("small tank, continuity, {name}"), 0.05).close();
    }
    for (name, executor) in testing::executors("a_small_tank_comes_to_rest_on_every_executor") {
        let tank = Tank { size: [7, 8, 7], ..tank(MUELLER) };
        tank.settle(executor, 0.5).report_mueller(&format!("small tank, mueller, {name}"), 0.05);
    }
}
