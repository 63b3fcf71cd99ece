//! Warnings of a run: lost particles and bodies, and the alarms of the monitor.

use super::{Event, Run, Stage};
use crate::check::Built;
use crate::monitor::{Alarm, Level};
use crate::scene::OnBurst;
use crate::{BodyState, SimulationError, Stats};

/// The mean of an implicit pressure above which a run warns.
const MAX_MEAN_EXCESS: f32 = 0.02;

/// Emitters that would add fewer particles than this are not compared with their flow.
const MANY_EMITTED: f64 = 100.0;
/// The part of its flow below which an emitter counts as blocked.
const MOST_BLOCKED: f64 = 0.8;

impl Run {
    /// Notes particles that left through open sides since the last report: the first ones, and every doubling.
    pub(super) fn note_escaped(&mut self, stats: &Stats) {
        let before = self.escaped;
        if stats.escaped > 0 && stats.escaped >= 2 * before {
            self.escaped = stats.escaped;
            let plural = if stats.escaped == 1 { "" } else { "s" };
            let text = format!(
                "at {:.4} s: {} particle{plural} left the domain through open sides",
                stats.time, stats.escaped
            );
            self.pending_events.push_back(Event::Note(text));
        }
    }

    /// Warns of an implicit pressure that did not converge, or compresses the fluid on average.
    pub(super) fn warn_of_pressure(&mut self, stats: &Stats) {
        let before = self.last;
        if self.simulation.params().is_implicit == 0 {
            return;
        }
        if stats.compression > MAX_MEAN_EXCESS && before.compression <= MAX_MEAN_EXCESS {
            let text = format!(
                "at {:.4} s: the density is on average {:.0} % above the rest density: the fluid does not fit into the \
                 available space, or is pressed into a wall. Check emitters in closed or narrow places, and overlapping \
                 particles",
                stats.time,
                100.0 * stats.compression
            );
            self.pending_events.push_back(Event::Warning(text));
        }
        // The first ones, and again whenever their number has doubled.
        let count = stats.unconverged.saturating_sub(before.unconverged);
        if count > 0 && stats.unconverged.checked_ilog2() > before.unconverged.checked_ilog2() {
            let plural = if count == 1 { "" } else { "s" };
            let text = format!(
                "at {:.4} s: {count} step{plural} did not reach solver.tolerance within solver.max_iterations; their pressure \
                 is inexact. Lower solver.cfl_factor, raise max_iterations or tolerance, or make light bodies heavier",
                stats.time
            );
            self.pending_events.push_back(Event::Warning(text));
        }
    }

    /// Warns at the end of a scene of emitters that have added less than their flow.
    pub(super) fn warn_of_blocked_emitters(&mut self, stats: &Stats) {
        let planned = self.planned_emission as f64;
        let share = f64::from(stats.emitted) / planned.max(1.0);
        // A run of a part of the scene is not compared.
        if planned < MANY_EMITTED || share > MOST_BLOCKED || self.frames < self.scene_frames {
            return;
        }
        let scene = self.simulation.scene();
        let length = Built::of(scene).flow(scene).map_or(0.0, |flow| flow.longest_nozzle());
        let text = format!(
            "the emitters have added {} particles, {:.0} % of the {planned} of their flow: there was no room in a nozzle, \
             which begins up to {length:.3} m behind its outlet, or in front of it. Move nozzles out of the water with \
             all of this length, or make room in front of them",
            stats.emitted,
            100.0 * share
        );
        self.pending_events.push_back(Event::Warning(text));
    }

    /// Warns of an implicit viscosity that did not converge.
    pub(super) fn warn_of_viscosity(&mut self, stats: &Stats) {
        let before = self.last;
        let count = stats.viscous_unconverged.saturating_sub(before.viscous_unconverged);
        // The first ones, and again whenever their number has doubled.
        if count == 0
            || stats.viscous_unconverged.checked_ilog2() <= before.viscous_unconverged.checked_ilog2()
        {
            return;
        }
        let params = self.simulation.params();
        let plural = if count == 1 { "" } else { "s" };
        let text = format!(
            "at {:.4} s: the viscosity of {} m^2/s did not converge in {count} step{plural}: after {} iterations the \
             residual is {:.1} % of the change of the velocity by all other forces, and {:.1} % are allowed. The flow is \
             inexact, and the next step is shorter. Lower fluid.viscosity, use a coarser particle_spacing or a shorter \
             solver.max_dt, or raise solver.max_iterations or solver.tolerance",
            stats.time,
            params.implicit_viscosity,
            stats.most_viscous_iterations,
            100.0 * stats.viscous_residual,
            100.0 * params.viscous_tolerance
        );
        self.pending_events.push_back(Event::Warning(text));
    }

    /// Reports alarms. The run ends after this frame if the fluid has burst.
    pub(super) fn report(&mut self, alarms: Vec<Alarm>) {
        let burst = alarms.iter().find(|alarm| alarm.level == Level::Stop);
        if let (Some(alarm), OnBurst::Stop) = (burst, self.on_burst) {
            let (time, message) = (alarm.time, alarm.message.clone());
            self.stage = Stage::Burst(SimulationError::Burst { time, message });
        }
        self.pending_events.extend(alarms.into_iter().map(Event::Alarm));
    }

    /// Warns once of each dynamic body whose distance from the domain exceeds the domain's size or is NaN.
    pub(super) fn warn_of_lost_bodies(&mut self, bodies: &[BodyState], time: f64) {
        let far = self.domain.size().max_element();
        for ((state, watched), mesh) in
            bodies.iter().zip(&mut self.watched).zip(self.simulation.body_meshes())
        {
            let x = state.position;
            let away = (self.domain.min - x).max(x - self.domain.max).max_element();
            if *watched && (away.is_nan() || away >= far) {
                *watched = false;
                let text = format!("at {time:.4} s: body {:?} has left the domain, at {x} m", mesh.name);
                self.pending_events.push_back(Event::Warning(text));
            }
        }
    }
}
