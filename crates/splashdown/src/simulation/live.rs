//! Changing a simulation while it runs: a hand in the water, other numbers, other things.

use glam::Vec3;
use splashdown_gpu::block_on;

use super::Simulation;
use crate::bodies::{BodyState, LoadedBody};
use crate::mouse_force::{MouseForce, MouseForceCoupling};
use crate::scene::{Motion, Scene, Solver};
use crate::state::{Params, StepState};
use crate::{SimulationError, sample, schemes};

impl Simulation {
    /// Puts a hand into the water, moves it, or takes it out. From the first hand on, a step takes two more passes.
    ///
    /// # Errors
    /// Those of the device.
    pub fn set_mouse_force(&mut self, mouse_force: Option<MouseForce>) -> Result<(), SimulationError> {
        if mouse_force.is_none() && self.mouse_force.is_none() {
            return Ok(());
        }
        let is_first = self.mouse_force.is_none();
        let coupling = match self.mouse_force.take() {
            Some(coupling) => coupling,
            None => MouseForceCoupling::new(&mut self.executor)?,
        };
        coupling.set(&mut self.executor, mouse_force.unwrap_or(MouseForce::NONE))?;
        self.mouse_force = Some(coupling);
        if is_first && let Err(error) = self.record_step() {
            // Without its pass a hand would do nothing, and nobody would be told.
            self.mouse_force = None;
            return Err(error);
        }
        Ok(())
    }

    /// Pulls a free body by the point `anchor` (m, in its own frame) towards `target` (m): its velocity
    /// becomes, once, the one that brings the point there at `rate` times its distance per second. For between
    /// two frames.
    ///
    /// # Errors
    /// Those of the device.
    pub async fn pull_body_async(
        &mut self,
        body: usize,
        anchor: Vec3,
        target: Vec3,
        rate: f32,
    ) -> Result<(), SimulationError> {
        match &self.bodies {
            Some(bodies) => Ok(bodies.pull(&mut self.executor, body, anchor, target, rate).await?),
            None => Ok(()),
        }
    }

    /// At most this many steps go to a device at once, between 1 and 64: fewer leave it free for drawing
    /// sooner. On the CPU it is also how often a frame comes back to its caller.
    pub fn set_steps_at_once(&mut self, steps: u32) {
        self.most_steps = steps.max(1);
    }

    /// Goes on under another scene that differs in numbers alone: gravity, the fluid's material, the solver's
    /// coefficients, and what is not about motion (camera, output, surface, foam). False, and nothing changed,
    /// if it differs in more; then [`rebuild_with`](Self::rebuild_with) does it.
    ///
    /// # Errors
    /// Those of the device.
    pub fn update_parameters(&mut self, scene: &Scene) -> Result<bool, SimulationError> {
        let old = &self.scene;
        let mut twin = scene.clone();
        (twin.name, twin.warnings, twin.source) =
            (old.name.clone(), old.warnings.clone(), old.source.clone());
        twin.text = old.text.clone();
        (twin.duration, twin.frame_rate, twin.gravity) = (old.duration, old.frame_rate, old.gravity);
        (twin.surface, twin.camera, twin.output) = (old.surface.clone(), old.camera, old.output.clone());
        twin.foam = old.foam;
        twin.domain.shake = old.domain.shake;
        twin.fluid.material.name.clone_from(&old.fluid.material.name);
        // The density at rest counts in the masses of particles, which stay.
        twin.fluid.material.viscosity = old.fluid.material.viscosity;
        twin.fluid.material.surface_tension = old.fluid.material.surface_tension;
        let kinds = &scene.solver;
        twin.solver = Solver {
            method: kinds.method,
            kernel: kinds.kernel,
            support_ratio: kinds.support_ratio,
            density: kinds.density,
            surface_tension: kinds.surface_tension,
            sort: kinds.sort,
            ..old.solver.clone()
        };
        if twin != *old {
            return Ok(false);
        }
        // Water that moves was made for its speed of sound: with a lower one it would be soft, and pressures burst.
        let params = schemes::params(scene, self.params.particle_count);
        let params = Params { sound_speed: params.sound_speed.max(self.params.sound_speed), ..params };
        self.executor.write(self.fields.params, &[params])?;
        self.params = params;
        self.scene = scene.clone();
        Ok(true)
    }

    /// The same fluid, at the same time, under another scene: its bodies, its box, its solver. Particles keep
    /// their places, velocities and ids; those outside the box or inside a new body are taken out. Free bodies
    /// that both scenes have, by name, stay where they are. The scene's own fluid is not added; its emitters
    /// begin to count anew.
    ///
    /// This simulation is of no more use then, but for its results.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn rebuild_with(&mut self, scene: &Scene) -> Result<Self, SimulationError> {
        block_on(self.carry_over_async(scene))
    }

    /// [`rebuild_with`](Self::rebuild_with) where blocking is not possible, as on a web page.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub async fn carry_over_async(&mut self, scene: &Scene) -> Result<Self, SimulationError> {
        let mut particles = self.particles_async().await?;
        let states = self.body_states_async().await?;
        let loaded = Self::load_bodies(scene, &|_, _| {})?;
        let place = |name: &str| self.scene.bodies.iter().position(|old| old.name == name);
        let free = |motion: &Motion| matches!(motion, Motion::Dynamic { .. });
        let kept: Vec<Option<BodyState>> = scene
            .bodies
            .iter()
            .map(|body| {
                let old = place(&body.name)?;
                (free(&body.motion) && free(&self.scene.bodies[old].motion)).then(|| states[old])
            })
            .collect();
        // Fluid is already where the old bodies are not.
        let new: Vec<&LoadedBody> = loaded.iter().filter(|body| place(&body.name).is_none()).collect();
        let removed = sample::retain_outside(scene, &mut particles, &new);
        let mut next = Self::with_bodies(scene, self.executor.successor(), &particles, loaded).await?;
        next.removed = removed;
        next.most_steps = self.most_steps;
        next.begin_at(self.stats.time, &kept).await?;
        Ok(next)
    }

    /// Sets the clock, and bodies that have moved.
    async fn begin_at(&mut self, time: f64, kept: &[Option<BodyState>]) -> Result<(), SimulationError> {
        self.stats.time = time;
        let mut state = self.executor.fetch(self.fields.state).await?;
        state[0] = StepState { time: time as f32, ..state[0] };
        self.executor.write(self.fields.state, &state)?;
        if let Some(bodies) = &mut self.bodies {
            bodies.place(&mut self.executor, kept).await?;
        }
        Ok(())
    }
}
