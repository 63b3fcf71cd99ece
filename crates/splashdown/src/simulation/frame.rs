//! The steps of a frame, and the statistics at its end.

use glam::Vec4Swizzles;
use splashdown_gpu::{Executor, Readback, block_on};

use super::Simulation;
use super::phases::HostAction;
use crate::bodies::Bodies;
use crate::probes::Probes;
use crate::schemes::Scheme;
use crate::state::{DEAD_NON_FINITE, StepCounters, StepState};
use crate::{SimulationError, Stats};

/// The largest number of steps in one submission to a device: bounds the time for which the device is unresponsive.
pub(super) const MOST_STEPS: u32 = 64;
/// The largest number of iterations of solvers in one submission to a device.
const MOST_ITERATIONS: u32 = 320;
/// The cost of a step without its iterations, in iterations.
const REST_OF_STEP: u32 = 9;
/// The largest number of steps in one submission to a device with an implicit pressure.
const MOST_IMPLICIT_STEPS: u32 = 16;
/// The largest number of steps in one submission on the CPU, whose executor tests for the end of the frame before each step.
const CPU_STEPS: u32 = 16;
/// The largest number of explicit steps between collisions of bodies. At the largest expected speed a body moves by 0.6
/// spacings in this time at a support of two spacings, and by one at three: later, bodies would have passed into one
/// another, and moving them apart would burst the fluid between them.
pub(super) const COLLISION_STEPS: u32 = 8;
/// The same with an implicit pressure: in one of its long steps a body moves by a good part of a spacing.
pub(super) const IMPLICIT_COLLISION_STEPS: u32 = 1;

/// A frame in progress.
pub(super) struct FrameInProgress {
    duration: f32,
    /// Rounds submitted so far: one per step, and more for steps that are suspended.
    submitted: u32,
    /// The state after the batch before the last, so that the device has work while the host reads it, and the rounds up to
    /// it.
    pending: Option<(u32, Readback<StepState>)>,
    pub(super) state: Option<StepState>,
    /// The rounds up to this state.
    rounds: u32,
}

impl FrameInProgress {
    /// The number of rounds to the end of the frame with steps of `stable_dt` seconds, and one more.
    fn expected_rounds(&self, stable_dt: f32) -> u32 {
        let Some(state) = self.state else {
            return ((self.duration / stable_dt).ceil() as u32).saturating_add(1);
        };
        let to_come = f64::from((state.remaining / stable_dt).ceil());
        let per_step = if state.steps > 0 { f64::from(self.rounds) / f64::from(state.steps) } else { 1.0 };
        self.rounds.saturating_add((to_come * per_step).ceil() as u32).saturating_add(1)
    }
}

impl Simulation {
    /// Simulates `seconds`, in as many steps as stability requires, and waits for the end.
    ///
    /// # Errors
    /// [`SimulationError::BadDuration`], [`SimulationError::StepTooSmall`], [`SimulationError::NothingLeft`],
    /// and those of the device.
    pub fn advance(&mut self, seconds: f32) -> Result<Stats, SimulationError> {
        block_on(self.advance_async(seconds))
    }

    /// [`advance`](Self::advance) where blocking is not possible, as on a web page.
    ///
    /// # Errors
    /// As [`advance`](Self::advance).
    pub async fn advance_async(&mut self, seconds: f32) -> Result<Stats, SimulationError> {
        self.begin(seconds)?;
        loop {
            if let Some(stats) = self.continue_frame_async().await? {
                return Ok(stats);
            }
        }
    }

    /// Begins a frame of this many seconds; [`continue_frame`](Self::continue_frame) advances it. A frame of zero
    /// seconds is complete at once, without a step.
    ///
    /// # Errors
    /// [`SimulationError::BadDuration`] if `seconds` is negative or not finite, and those of the device.
    pub fn begin(&mut self, seconds: f32) -> Result<(), SimulationError> {
        if !(seconds >= 0.0 && seconds.is_finite()) {
            return Err(SimulationError::BadDuration { seconds });
        }
        self.end_suspended_step()?;
        if seconds == 0.0 {
            self.frame = None;
            self.stats.steps_in_frame = 0;
            return Ok(());
        }
        if let Some(probes) = &mut self.probes {
            probes.reserve(&mut self.executor, seconds)?;
        }
        let (start, length) = (self.stats.time, f64::from(seconds));
        let body_speed = match &self.bodies {
            Some(bodies) => bodies.begin_frame(&mut self.executor, start, length, &self.params)?,
            None => 0.0,
        };
        let input = StepState::frame_input(seconds, start, body_speed.min(self.params.fastest_body()));
        self.executor.write(self.fields.frame_input, &input)?;
        self.executor.run(&self.begin)?;
        if self.end_suspended.is_some() {
            self.solver_rounds.begin_frame(&self.stats);
        }
        self.frame =
            Some(FrameInProgress { duration: seconds, submitted: 0, pending: None, state: None, rounds: 0 });
        Ok(())
    }

    /// Submits the next steps of the frame, without waiting for them. Returns the statistics once the frame is
    /// complete, and `None` before.
    ///
    /// # Errors
    /// As [`advance`](Self::advance).
    pub fn continue_frame(&mut self) -> Result<Option<Stats>, SimulationError> {
        block_on(self.continue_frame_async())
    }

    /// [`continue_frame`](Self::continue_frame) where blocking is not possible, as on a web page. If the future is
    /// dropped before it completes, the frame is abandoned.
    ///
    /// # Errors
    /// As [`advance`](Self::advance).
    pub async fn continue_frame_async(&mut self) -> Result<Option<Stats>, SimulationError> {
        let Some(mut frame) = self.frame.take() else { return Ok(Some(self.stats)) };
        // The known state is one batch old or absent.
        let remaining = frame.state.map_or(frame.duration, |state| state.remaining);
        let expected = frame.expected_rounds(self.stable_dt);
        let most = self.most_steps.min(self.most_at_once()).min(self.schedule.most_steps());
        let left = expected.saturating_sub(frame.submitted).clamp(1, most);
        let steps = 1 << left.ilog2();
        let (mut state_before, mut action) = (remaining, None);
        for submission in self.schedule.submissions(steps) {
            // The action after the last submission waits for the state that is read below.
            if let Some(action) = action {
                let state = self.executor.fetch(self.fields.state).await?[0];
                if state.done != StepState::SUSPENDED {
                    let passed = state_before - state.remaining;
                    act(action, &mut self.bodies, self.probes.as_ref(), &mut self.executor, passed).await?;
                }
                state_before = state.remaining;
            }
            self.executor.run(submission.recording())?;
            action = submission.action();
        }
        frame.submitted += steps;
        self.may_be_suspended = self.end_suspended.is_some();
        let newest = (frame.submitted, self.executor.request(self.fields.state, 1)?);
        let behind = frame.pending.replace(newest);
        // The host waits for the newest state where nothing can overlap: all expected steps are submitted, the
        // executor is the CPU, or a host action precedes the next step.
        let answer = if frame.submitted >= expected || self.executor.gpu().is_none() || action.is_some() {
            frame.pending.take()
        } else {
            behind
        };
        if let Some((rounds, readback)) = answer {
            let state = readback.take().await?[0];
            self.stable_dt = state.stable_dt;
            if self.end_suspended.is_some() {
                self.solver_rounds.follow(&state);
            }
            // Nothing happens after the end of the frame.
            let is_newest = rounds == frame.submitted;
            if state.done == StepState::COMPLETE || is_newest && state.done != StepState::SUSPENDED {
                self.may_be_suspended = false;
            }
            // A suspended step has not moved anything.
            if let Some(action) = action.filter(|_| state.done != StepState::SUSPENDED) {
                let passed = state_before - state.remaining;
                act(action, &mut self.bodies, self.probes.as_ref(), &mut self.executor, passed).await?;
            }
            (frame.state, frame.rounds) = (Some(state), rounds);
            // With a step below `min_dt` the frame might never end.
            if state.done == StepState::COMPLETE || state.too_small != 0 {
                return self.end_frame(state).await.map(Some);
            }
        }
        self.frame = Some(frame);
        Ok(None)
    }

    /// The largest number of rounds in one submission.
    fn most_at_once(&self) -> u32 {
        if self.executor.gpu().is_none() {
            return CPU_STEPS;
        }
        let scheme = Scheme::new(&self.scene);
        let iterations = self.solver_rounds.total(scheme.has_implicit_viscosity());
        match scheme.is_implicit() {
            true => (MOST_ITERATIONS / (iterations + REST_OF_STEP)).clamp(1, MOST_IMPLICIT_STEPS),
            false => MOST_STEPS,
        }
    }

    /// Ends the present step if it is suspended, so that the particles may be used.
    pub(super) fn end_suspended_step(&mut self) -> Result<(), SimulationError> {
        if let (true, Some(recording)) = (self.may_be_suspended, &self.end_suspended) {
            self.executor.run(recording)?;
        }
        self.may_be_suspended = false;
        Ok(())
    }

    pub(super) async fn end_frame(&mut self, state: StepState) -> Result<Stats, SimulationError> {
        let last = self.stats;
        let is_complete = state.done == StepState::COMPLETE;
        let passed = if is_complete { state.frame_duration } else { state.frame_duration - state.remaining };
        if let Some(probes) = &self.probes {
            let taken = probes.take(&mut self.executor, last.time, passed).await?;
            for (rows, more) in self.rows.iter_mut().zip(taken) {
                rows.extend(more);
            }
        }
        self.stats = Stats {
            time: last.time + f64::from(passed),
            steps: last.steps + u64::from(state.steps),
            steps_in_frame: state.steps,
            dt: state.stable_dt,
            density_error: state.density_error,
            max_speed: state.max_speed,
            iterations: last.iterations + u64::from(state.iterations),
            most_iterations: state.most_iterations,
            residual: state.residual,
            compression: state.compression / state.steps.max(1) as f32,
            mean_compression: (last.mean_compression * last.steps as f64 + f64::from(state.compression))
                / (last.steps + u64::from(state.steps)).max(1) as f64,
            viscous_iterations: last.viscous_iterations + u64::from(state.viscous_iterations),
            most_viscous_iterations: state.most_viscous_iterations,
            viscous_residual: state.viscous_residual,
            ..last
        };
        self.count().await?;
        if state.too_small != 0 {
            return Err(SimulationError::StepTooSmall {
                time: self.stats.time,
                min_dt: self.params.min_dt,
                max_speed: state.max_speed,
                max_acceleration: state.max_acceleration,
                cause: None,
            });
        }
        if self.stats.particles == 0 && self.initial > 0 && self.flow.is_none() {
            return Err(SimulationError::NothingLeft {
                time: self.stats.time,
                reason: format!(
                    "{} left through open sides, {} were not finite",
                    self.stats.escaped, self.stats.non_finite
                ),
            });
        }
        Ok(self.stats)
    }

    /// Updates the statistics of emitted and lost particles.
    pub(super) async fn count(&mut self) -> Result<(), SimulationError> {
        let counters = self.executor.fetch(self.fields.counters).await?;
        let stats = &mut self.stats;
        stats.escaped = counters[StepCounters::ESCAPED];
        stats.wall_corrections = counters[StepCounters::CORRECTIONS];
        stats.speed_limits = counters[StepCounters::LIMITED];
        stats.unconverged = counters[StepCounters::UNCONVERGED];
        stats.viscous_unconverged = counters[StepCounters::VISCOUS_UNCONVERGED];
        stats.drained = counters[StepCounters::DRAINED];
        if let Some(flow) = &mut self.flow {
            let (count, warnings) = flow.count(&mut self.executor).await?;
            (stats.emitted, stats.refused) = (count.emitted, count.refused);
            self.warnings.extend(warnings);
        }
        let lost = stats.escaped + stats.drained + counters[StepCounters::NON_FINITE];
        stats.particles = self.initial + stats.emitted - lost;
        if counters[StepCounters::NON_FINITE] > stats.non_finite {
            stats.non_finite = counters[StepCounters::NON_FINITE];
            let positions = self.executor.fetch(self.fields.positions).await?;
            let ids = self.executor.fetch(self.fields.ids).await?;
            let removed = positions.iter().zip(ids).filter(|(p, _)| p.w == DEAD_NON_FINITE);
            if let Some((p, id)) = removed.min_by_key(|(_, id)| *id) {
                stats.non_finite_place = p.xyz().to_array();
                stats.non_finite_id = id;
            }
        }
        Ok(())
    }
}

/// Executes the action of a host phase, `seconds` of simulated time after the last one.
async fn act(
    action: HostAction,
    bodies: &mut Option<Bodies>,
    probes: Option<&Probes>,
    executor: &mut Executor,
    seconds: f32,
) -> Result<(), SimulationError> {
    match action {
        HostAction::ResolveCollisions => {
            let Some(bodies) = bodies else { return Ok(()) };
            let changed = bodies.resolve_collisions(executor, seconds).await?;
            if let (Some(states), Some(probes)) = (changed, probes) {
                probes.correct_poses(executor, &states).await?;
            }
            Ok(())
        }
    }
}
