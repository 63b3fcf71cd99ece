//! What a run warns of: what was lost, limited, or cannot be right.

use super::{Event, Run};
use crate::{BodyState, Stats};

/// An excess of density that no sound has: something is told of it.
const DENSE: f32 = 0.3;

impl Run {
    /// Puts into words what was lost since the last frame.
    pub(super) fn warn(&mut self, stats: &Stats) {
        let before = std::mem::replace(&mut self.stats_before, *stats);
        if stats.density_error > DENSE && before.density_error <= DENSE {
            let text = format!(
                "at {:.4} s: the density is up to {:.0} % above that at rest: more fluid than there is room for, or fluid \
                 pushed into a wall. Look at emitters in closed or narrow places, and at particles placed inside one another",
                stats.time,
                100.0 * stats.density_error
            );
            self.waiting.push_back(Event::Warning(text));
        }
        let mut tell = |more: u32, thing: &str, what: &str| {
            if more > 0 {
                let plural = if more == 1 { "" } else { "s" };
                let text = format!("at {:.4} s: {more} {thing}{plural} {what}", stats.time);
                self.waiting.push_back(Event::Warning(text));
            }
        };
        tell(stats.escaped - before.escaped, "particle", "left through open sides and taken out");
        let [x, y, z] = stats.non_finite_place;
        let lost = format!(
            "NaN or infinite and taken out; the first, id {}, was last at ({x:.4}, {y:.4}, {z:.4}) m. \
             Lower solver.cfl_factor, or look for particles placed inside one another",
            stats.non_finite_id
        );
        tell(stats.non_finite - before.non_finite, "particle", &lost);
        tell(
            stats.wall_corrections - before.wall_corrections,
            "time",
            "a particle was put back through a closed wall or the surface of a body",
        );
        tell(
            stats.speed_limits - before.speed_limits,
            "time",
            "a particle was slowed down to half a spacing per step: the time step is too long for this motion. \
             Lower solver.cfl_factor, or raise solver.sound_speed",
        );
    }

    /// Tells once of each free body that is farther outside the domain than the domain is large, or nowhere.
    pub(super) fn tell_lost(&mut self, bodies: &[BodyState], time: f64) {
        let far = self.domain.size().max_element();
        for ((state, watched), mesh) in
            bodies.iter().zip(&mut self.watched).zip(self.simulation.body_meshes())
        {
            let x = state.position;
            let away = (self.domain.min - x).max(x - self.domain.max).max_element();
            if *watched && (away.is_nan() || away >= far) {
                *watched = false;
                let text =
                    format!("at {time:.4} s: body {:?} has left the domain for good, at {x} m", mesh.name);
                self.waiting.push_back(Event::Warning(text));
            }
        }
    }
}
