//! Warnings of a run: lost particles, limited speeds, implausible densities.

use super::{Event, Run};
use crate::{BodyState, Stats};

/// The relative excess of density above which a run warns.
const MAX_EXCESS: f32 = 0.3;

impl Run {
    /// Warns of problems since the last frame.
    pub(super) fn warn(&mut self, stats: &Stats) {
        let before = std::mem::replace(&mut self.stats_before, *stats);
        if stats.density_error > MAX_EXCESS && before.density_error <= MAX_EXCESS {
            let text = format!(
                "at {:.4} s: the density is up to {:.0} % above the rest density: the fluid does not fit into the \
                 available space, or is pressed into a wall. Check emitters in closed or narrow places, and overlapping particles",
                stats.time,
                100.0 * stats.density_error
            );
            self.pending_events.push_back(Event::Warning(text));
        }
        let mut warn = |count: u32, noun: &str, what: &str| {
            if count > 0 {
                let plural = if count == 1 { "" } else { "s" };
                let text = format!("at {:.4} s: {count} {noun}{plural} {what}", stats.time);
                self.pending_events.push_back(Event::Warning(text));
            }
        };
        warn(stats.escaped - before.escaped, "particle", "left the domain through open sides");
        let [x, y, z] = stats.non_finite_place;
        let lost = format!(
            "became NaN or infinite and were removed; the first, id {}, was last at ({x:.4}, {y:.4}, {z:.4}) m. \
             Lower solver.cfl_factor, or check for overlapping particles",
            stats.non_finite_id
        );
        warn(stats.non_finite - before.non_finite, "particle", &lost);
        warn(
            stats.wall_corrections - before.wall_corrections,
            "time",
            "a particle was moved back through a closed wall or the surface of a body",
        );
        warn(
            stats.speed_limits - before.speed_limits,
            "time",
            "a particle was limited to half a spacing per step: the time step is too long for its speed. \
             Lower solver.cfl_factor, or raise solver.sound_speed",
        );
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
