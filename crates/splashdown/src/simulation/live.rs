//! Changes of a running simulation: the mouse force, parameters, and the scene.

use glam::Vec3;
use splashdown_gpu::block_on;

use super::Simulation;
use crate::bodies::{BodyState, LoadedBody};
use crate::mouse_force::{MouseForce, MouseForceCoupling};
use crate::scene::{Motion, Scene, Solver};
use crate::schemes::Scheme;
use crate::state::{Params, StepState};
use crate::{SimulationError, sample, schemes};

impl Simulation {
    /// Sets, changes or removes the mouse force. From the first call with a force, each step takes two more passes.
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
            // Without its passes the force would have no effect, and no later call would report it.
            self.mouse_force = None;
            return Err(error);
        }
        Ok(())
    }

    /// Pulls a dynamic body by the point `anchor` (m, in its own frame) towards `target` (m): changes the velocity
    /// of the body once, so that the point approaches the target at `rate` (1/s) times their distance. Call it between
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

    /// Limits the number of steps in one submission, between 1 and 64; a step that needs many iterations may span several. With fewer steps a GPU is free for drawing
    /// sooner, and [`continue_frame`](Self::continue_frame) on the CPU returns sooner.
    pub fn set_steps_at_once(&mut self, steps: u32) {
        self.most_steps = steps.max(1);
    }

    /// Continues with another scene that differs in parameters only: gravity, the material of the fluid, the
    /// coefficients of the solver, and settings that do not affect motion (camera, picture, output, surface, foam). Returns
    /// false, and changes nothing, if the scene differs in more; use [`rebuild_with`](Self::rebuild_with) then. A wider
    /// support of the surface is more: the surface uses the grid of the simulation.
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
        (twin.foam, twin.picture) = (old.foam, old.picture.clone());
        // It has had its effect.
        twin.fluid.initial_pressure = old.fluid.initial_pressure;
        twin.domain.oscillation = old.domain.oscillation;
        twin.fluid.material.name.clone_from(&old.fluid.material.name);
        // The rest density must not change: it determines the particle mass.
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
            max_iterations: kinds.max_iterations,
            ..old.solver.clone()
        };
        // The passes of a step depend on how the viscosity is integrated.
        let has_implicit_viscosity = |scene| Scheme::new(scene).has_implicit_viscosity();
        let is_wider = scene.surface.support_ratio > old.surface.support_ratio;
        if is_wider || twin != *old || has_implicit_viscosity(scene) != has_implicit_viscosity(old) {
            return Ok(false);
        }
        // The speed of sound must not decrease: the state of the fluid would be too compressed for a softer equation
        // of state, and pressures would burst.
        let params = schemes::params(scene, self.params.particle_count);
        let params = Params { sound_speed: params.sound_speed.max(self.params.sound_speed), ..params };
        let params = self.bodies.as_ref().map_or(params, |bodies| bodies.limit_step(params));
        self.executor.write(self.fields.params, &[params])?;
        self.params = params;
        self.scene = scene.clone();
        Ok(true)
    }

    /// Creates a simulation of another scene with the present fluid, at the present time. Particles retain their
    /// positions, velocities and ids; those outside the new domain or inside a new body are removed. A dynamic body
    /// that both scenes contain, by name, retains its position; scripted bodies are where their scripts are at this time. The
    /// fluid blocks of the scene are not added, and the
    /// counts of its emitters start from zero.
    ///
    /// Afterwards this simulation can be read, but not advanced.
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
        let mut loaded = Self::load_bodies(scene, &|_, _| {})?;
        loaded.iter_mut().for_each(|body| body.start_at(self.stats.time));
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
        // The fluid does not overlap the old bodies: only new ones displace particles.
        let new: Vec<&LoadedBody> = loaded.iter().filter(|body| place(&body.name).is_none()).collect();
        let removed = sample::retain_outside(scene, &mut particles, &new, sample::clearance_of(scene));
        let table = match scene.solver.method == self.scene.solver.method {
            true => self.fields.table(),
            false => Scheme::new(scene).carried(),
        };
        let mut next = Self::with_bodies(scene, self.executor.successor(), &particles, loaded, table).await?;
        next.removed = removed;
        next.most_steps = self.most_steps;
        next.begin_at(self.stats.time, &kept).await?;
        Ok(next)
    }

    /// Sets the time, and the states of retained bodies.
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
