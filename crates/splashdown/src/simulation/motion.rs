//! Changing the motion of the particles between two frames, and ending a frame early.

use glam::{Vec3, Vec4, Vec4Swizzles};
use splashdown_gpu::block_on;

use super::Simulation;
use crate::state::{Params, StepState};
use crate::{SimulationError, Stats};

/// What replaces the motion of the particles.
#[derive(Clone, Copy)]
enum Replaced<'a> {
    Positions(&'a [[f32; 3]]),
    Velocities(&'a [[f32; 3]]),
}

impl Replaced<'_> {
    fn values(&self) -> &[[f32; 3]] {
        match self {
            Self::Positions(values) | Self::Velocities(values) => values,
        }
    }

    fn name(&self) -> &'static str {
        match self {
            Self::Positions(_) => "positions",
            Self::Velocities(_) => "velocities",
        }
    }
}

impl Simulation {
    /// Replaces the positions of all active particles, in m, in the order of [`particles`](Self::particles). Call it
    /// between two frames: a frame in progress ends at its last step.
    ///
    /// Particles that are closer than a particle spacing repel each other strongly. Densities and pressures that are
    /// read before the next step are those of the last step.
    ///
    /// ```
    /// use splashdown::{Device, Scene, Simulation};
    /// # let scene = Scene::parse(include_str!("../../scenes/dam-break-small.toml"), "dam-break-small.toml")?;
    /// let mut simulation = Simulation::new(&scene, &Device::Cpu)?;
    /// let mut positions = simulation.particles()?.positions;
    /// positions.iter_mut().for_each(|position| position[0] += 0.01);
    /// simulation.set_positions(&positions)?;
    /// assert_eq!(simulation.particles()?.positions, positions);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`SimulationError::Count`] unless there is one position per particle; [`SimulationError::NotFinite`];
    /// [`SimulationError::OutsideDomain`]; those of the device. Nothing changes then.
    pub fn set_positions(&mut self, positions: &[[f32; 3]]) -> Result<(), SimulationError> {
        block_on(self.replace(Replaced::Positions(positions)))
    }

    /// Replaces the velocities of all active particles, in m/s, in the order of [`particles`](Self::particles). Call it
    /// between two frames: a frame in progress ends at its last step. The time step is reduced as far as the largest
    /// speed requires. The speed of sound does not change, so that speeds much above those that the scene leads to
    /// compress the fluid.
    ///
    /// # Errors
    /// [`SimulationError::Count`] unless there is one velocity per particle; [`SimulationError::NotFinite`]; those of the
    /// device. Nothing changes then.
    pub fn set_velocities(&mut self, velocities: &[[f32; 3]]) -> Result<(), SimulationError> {
        block_on(self.replace(Replaced::Velocities(velocities)))
    }

    /// Ends the frame in progress at its last complete step, and returns the statistics. Without a frame in progress it
    /// has no effect.
    ///
    /// # Errors
    /// As [`advance`](Self::advance).
    pub fn end_frame_early(&mut self) -> Result<Stats, SimulationError> {
        block_on(self.end_frame_early_async())
    }

    /// [`end_frame_early`](Self::end_frame_early) where blocking is not possible, as on a web page.
    ///
    /// # Errors
    /// As [`advance`](Self::advance).
    pub async fn end_frame_early_async(&mut self) -> Result<Stats, SimulationError> {
        if self.frame.is_none() {
            return Ok(self.stats);
        }
        self.end_suspended_step()?;
        let state = self.executor.fetch(self.fields.state).await?[0];
        self.frame = None;
        self.stable_dt = state.stable_dt;
        self.end_frame(state).await
    }

    async fn replace(&mut self, replaced: Replaced<'_>) -> Result<(), SimulationError> {
        self.check_replaced(replaced)?;
        self.end_frame_early_async().await?;
        let n = self.params.particle_count as usize;
        let mut positions: Vec<Vec4> = self.executor.fetch_first(self.fields.positions, n).await?;
        let ids = self.executor.fetch_first(self.fields.ids, n).await?;
        let order = active_in_order(&positions, &ids);
        let (values, given, expected) = (replaced.values(), replaced.values().len(), order.len());
        if given != expected {
            return Err(SimulationError::Count { what: replaced.name(), given, expected });
        }
        match replaced {
            Replaced::Positions(_) => {
                for (&i, &value) in order.iter().zip(values) {
                    positions[i as usize] = Vec3::from(value).extend(0.0);
                }
                self.executor.write(self.fields.positions, &positions)?;
            }
            Replaced::Velocities(_) => {
                let mut all: Vec<Vec4> = self.executor.fetch_first(self.fields.velocities, n).await?;
                let mut fastest = 0.0_f32;
                for (&i, &value) in order.iter().zip(values) {
                    let velocity = &mut all[i as usize];
                    *velocity = Vec3::from(value).extend(velocity.w);
                    fastest = fastest.max(velocity.xyz().length());
                }
                self.executor.write(self.fields.velocities, &all)?;
                self.limit_time_step(fastest, 0.0).await?;
            }
        }
        Ok(())
    }

    /// The checks that need no data of the device.
    fn check_replaced(&self, replaced: Replaced<'_>) -> Result<(), SimulationError> {
        let Params { domain_min, domain_max, .. } = self.params;
        for (index, &value) in replaced.values().iter().enumerate() {
            let what = replaced.name();
            let vector = Vec3::from(value);
            if !vector.is_finite() {
                return Err(SimulationError::NotFinite { what, index, value });
            }
            let is_outside = vector.cmplt(domain_min).any() || vector.cmpgt(domain_max).any();
            if matches!(replaced, Replaced::Positions(_)) && is_outside {
                let (min, max) = (domain_min.to_array(), domain_max.to_array());
                return Err(SimulationError::OutsideDomain { index, position: value, min, max });
            }
        }
        Ok(())
    }

    /// Reduces the next time step to what this speed in m/s and relative excess of density allow.
    pub(super) async fn limit_time_step(&mut self, speed: f32, excess: f32) -> Result<(), SimulationError> {
        let allowed = self.params.longest_step(speed, 0.0, excess).max(self.params.min_dt);
        let state = self.executor.fetch(self.fields.state).await?[0];
        self.stable_dt = state.stable_dt.min(allowed);
        let state = StepState { stable_dt: self.stable_dt, dt: self.stable_dt, ..state };
        Ok(self.executor.write(self.fields.state, &[state])?)
    }
}

/// The indices of the active particles in the order of their ids.
pub(super) fn active_in_order(positions: &[Vec4], ids: &[u32]) -> Vec<u32> {
    // The fourth component of a position marks removed particles.
    let mut order: Vec<u32> = (0..ids.len() as u32).filter(|&i| positions[i as usize].w == 0.0).collect();
    order.sort_unstable_by_key(|&i| ids[i as usize]);
    order
}

#[cfg(test)]
mod tests {
    use splashdown_gpu::{CpuExecutor, Executor};

    use crate::{Device, Scene, Simulation, SimulationError};

    fn simulation() -> Simulation {
        let scene = Scene::builder("box", 1.0)
            .domain([0.0; 3], [0.8, 0.8, 0.4])
            .particle_spacing(0.05)
            .block([0.0; 3], [0.4, 0.4, 0.4])
            .set("solver.method", "wcsph")
            .build()
            .unwrap();
        Simulation::new(&scene, &Device::Cpu).unwrap()
    }

    /// Thousands of short steps: a running sum in single precision would be 0.0018 s late.
    #[test]
    fn the_time_on_the_device_is_that_of_the_host() {
        let scene = Scene::builder("box", 10.0)
            .domain([0.0; 3], [0.2, 0.2, 0.2])
            .particle_spacing(0.05)
            .block([0.0; 3], [0.1, 0.1, 0.1])
            .set("solver.method", "wcsph")
            .set("solver.max_dt", 1e-4)
            .build()
            .unwrap();
        let mut simulation = Simulation::new(&scene, &Device::Cpu).unwrap();
        for _ in 0..40 {
            simulation.advance(0.1).unwrap();
        }
        let stats = simulation.stats();
        assert!(stats.steps >= 40_000 && stats.time > 3.99, "{stats:?}");
        let state = simulation.executor.read(simulation.fields.state).unwrap()[0];
        assert!((f64::from(state.time) - stats.time).abs() < 1e-6, "{} and {}", state.time, stats.time);
    }

    #[test]
    fn particles_of_a_program_need_unique_ids_and_complete_quantities() {
        let mut simulation = simulation();
        let scene = simulation.scene().clone();
        let particles = simulation.particles().unwrap();
        let with =
            |particles| Simulation::with_particles(&scene, CpuExecutor::new().into(), &particles).map(drop);
        with(particles.clone()).unwrap();
        let mut twins = particles.clone();
        twins.ids[3] = twins.ids[7];
        let id = twins.ids[7];
        assert!(matches!(with(twins), Err(SimulationError::DuplicateId { id: found }) if found == id));
        let mut fewer = particles.clone();
        fewer.velocities.pop();
        let message = with(fewer).unwrap_err().to_string();
        let n = particles.len();
        assert!(
            message.starts_with(&format!("{} velocities are given, but there are {n}", n - 1)),
            "{message}"
        );
    }

    #[test]
    fn written_motion_is_read_back_and_moves_the_particles() {
        let mut simulation = simulation();
        simulation.advance(0.02).unwrap();
        let before = simulation.particles().unwrap();
        let n = before.positions.len();
        let raised: Vec<[f32; 3]> = before.positions.iter().map(|&[x, y, z]| [x, y + 0.3, z]).collect();
        simulation.set_positions(&raised).unwrap();
        simulation.set_velocities(&vec![[0.5, 0.0, 0.0]; n]).unwrap();
        let written = simulation.particles().unwrap();
        assert_eq!(written.positions, raised);
        assert_eq!(written.velocities, vec![[0.5, 0.0, 0.0]; n]);
        assert_eq!(written.ids, before.ids);

        simulation.advance(0.05).unwrap();
        let after = simulation.particles().unwrap();
        // Free fall of the centre from rest: 0.5 g t^2 downwards and 0.5 m/s along x. The front particles meet no wall.
        let mean =
            |list: &[[f32; 3]], axis: usize| list.iter().map(|x| f64::from(x[axis])).sum::<f64>() / n as f64;
        let fallen = mean(&raised, 1) - mean(&after.positions, 1);
        assert!((fallen - 0.5 * 9.81 * 0.05 * 0.05).abs() < 1e-3, "{fallen}");
        let shifted = mean(&after.positions, 0) - mean(&raised, 0);
        assert!((shifted - 0.025).abs() < 1e-3, "{shifted}");
        // Negative control: without the written velocity nothing moves along x by as much.
        assert!((mean(&before.positions, 0) - mean(&raised, 0)).abs() < 1e-6);
    }

    #[test]
    fn a_fast_fluid_gets_a_shorter_first_step() {
        let mut simulation = simulation();
        let n = simulation.stats().particles as usize;
        let before = simulation.dt();
        simulation.set_velocities(&vec![[0.0, 0.1, 0.0]; n]).unwrap();
        let slow = simulation.dt();
        simulation.set_velocities(&vec![[0.0, 200.0, 0.0]; n]).unwrap();
        assert!(slow <= before && simulation.dt() < 0.2 * slow, "{before} {slow} {}", simulation.dt());
    }

    #[test]
    fn fast_particles_get_a_short_first_step() {
        let given = simulation().particles().unwrap();
        let dt = |velocity: [f32; 3]| {
            let mut particles = given.clone();
            particles.velocities = vec![velocity; given.positions.len()];
            let executor = Executor::from(CpuExecutor::new());
            let started = Simulation::with_particles(simulation().scene(), executor, &particles);
            started.unwrap().dt()
        };
        assert!(dt([0.0, 200.0, 0.0]) < 0.2 * dt([0.0; 3]));
    }

    #[test]
    fn wrong_motion_is_refused_and_changes_nothing() {
        let mut simulation = simulation();
        let before = simulation.particles().unwrap();
        let n = before.positions.len();
        let error = simulation.set_velocities(&vec![[0.0; 3]; n - 1]).unwrap_err();
        assert!(
            matches!(error, SimulationError::Count { given, expected, .. } if given == n - 1 && expected == n)
        );
        let mut wrong = before.positions.clone();
        wrong[7] = [0.1, f32::NAN, 0.1];
        let error = simulation.set_positions(&wrong).unwrap_err();
        assert!(matches!(error, SimulationError::NotFinite { index: 7, .. }), "{error}");
        wrong[7] = [0.1, 0.81, 0.1];
        let error = simulation.set_positions(&wrong).unwrap_err();
        assert!(error.to_string().contains("position 7 is (0.1, 0.81, 0.1) m"), "{error}");
        assert_eq!(simulation.particles().unwrap(), before);
    }

    #[test]
    fn a_frame_can_end_early_and_the_simulation_continues() {
        let mut simulation = simulation();
        simulation.begin(10.0).unwrap();
        simulation.set_steps_at_once(4);
        assert!(simulation.continue_frame().unwrap().is_none());
        let stats = simulation.end_frame_early().unwrap();
        assert!(stats.steps > 0 && stats.time > 0.0 && stats.time < 1.0, "{stats:?}");
        assert_eq!(simulation.end_frame_early().unwrap(), stats);
        let next = simulation.advance(0.01).unwrap();
        assert!((next.time - stats.time - 0.01).abs() < 1e-6 && next.steps > stats.steps);
        assert_eq!(next.particles, stats.particles);
    }
}
