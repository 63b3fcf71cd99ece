//! Single particles that start much faster than the others.
//!
//! A particle of an imported cloud whose velocity is wrong, or one on its own, would raise the largest allowed speed for
//! the whole run, also after it has left. It is reported at the start and not compared with that speed; the fluid that it
//! hits is.

use glam::Vec3;
use serde::{Deserialize, Serialize};
use splashdown_io::Particles;

/// Fewer fast particles than this are no piece of fluid.
const FEWEST: usize = 8;
/// An outlier is faster than this many times the largest speed that the others allow: the limit of a warning.
pub(super) const MUCH_FASTER: f64 = 2.7;

/// The ids of outliers, the fastest first.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Outliers(Vec<u32>);

impl Outliers {
    /// The outliers among the particles at the start, and the largest speed in m/s that the others allow: `driven` is the
    /// one without initial speeds, which contains that of emitters, `emitted`. `None` if there are fewer than eight particles.
    pub fn find(particles: &Particles, driven: f64, emitted: f64) -> Option<(Self, f64)> {
        let mut fastest: Vec<(f32, u32)> = Vec::with_capacity(FEWEST + 1);
        for (&v, &id) in particles.velocities.iter().zip(&particles.ids) {
            let speed = Vec3::from(v).length();
            if fastest.len() == FEWEST && speed <= fastest[FEWEST - 1].0 {
                continue;
            }
            let at = fastest.partition_point(|(other, _)| *other >= speed);
            fastest.insert(at, (speed, id));
            fastest.truncate(FEWEST);
        }
        if fastest.len() < FEWEST {
            return None;
        }
        // Fluid in a nozzle has the speed of its emitter at the start, which must not count twice.
        let initial = f64::from(fastest[FEWEST - 1].0).powi(2) - emitted.powi(2);
        let others = (driven.powi(2) + initial.max(0.0)).sqrt();
        let is_outlier = |(speed, _): &&(f32, u32)| f64::from(*speed) > MUCH_FASTER * others;
        let ids: Vec<u32> = fastest.iter().take_while(is_outlier).map(|(_, id)| *id).collect();
        Some((Self(ids), others))
    }

    pub fn ids(&self) -> &[u32] {
        &self.0
    }

    pub fn contain(&self, id: u32) -> bool {
        !self.0.is_empty() && self.0.contains(&id)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_speed_of_fluid_in_a_nozzle_counts_once() {
        let velocities = |speed: f32| {
            let mut cloud = Particles::from_positions(vec![[0.0; 3]; 10]).with_ids((0..10).collect());
            cloud.velocities = vec![[speed, 0.0, 0.0]; 10];
            cloud
        };
        let allowed = |speed: f32| Outliers::find(&velocities(speed), 0.5, 0.4).unwrap().1;
        assert!((allowed(0.4) - 0.5).abs() < 1e-6);
        assert!((allowed(1.0) - (0.25_f64 + 1.0 - 0.16).sqrt()).abs() < 1e-6);
    }
}
