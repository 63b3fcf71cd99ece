//! The speed of scripted bodies that can act on the fluid.

use glam::Vec3;

use crate::BodyState;

/// A body is faster than its displacement in a frame shows by at most this factor, unless it keeps its speed.
const UNSTEADY: f32 = 4.0;

/// The scripted bodies of a scene.
#[derive(Clone, Debug)]
pub(super) struct ScriptedBodies {
    /// For each body, the largest distance in m of its points from its origin; `None` if it is not scripted.
    reaches: Vec<Option<f32>>,
    support_radius: f32,
    /// The time in s of the last frame, and position and speed of each body then.
    before: Option<(f64, Vec<(Vec3, f32)>)>,
}

impl ScriptedBodies {
    pub fn new(reaches: Vec<Option<f32>>, support_radius: f32) -> Self {
        Self { reaches, support_radius, before: None }
    }

    /// Starts with the bodies of a frame.
    pub fn begin(&mut self, time: f64, bodies: &[BodyState]) {
        let state = |body: &BodyState| (body.position, body.velocity.length());
        self.before = Some((time, bodies.iter().map(state).collect()));
    }

    /// The speed in m/s of the fastest point of the bodies near the fluid, or `so_far` if that is more.
    pub fn fastest(&mut self, time: f64, bodies: &[BodyState], fluid: &[[f32; 3]], so_far: f64) -> f64 {
        let mut fastest = so_far;
        for (k, (body, reach)) in bodies.iter().zip(&self.reaches).enumerate() {
            let Some(reach) = *reach else { continue };
            let speed = f64::from(self.steady_speed(k, time, body) + reach * body.angular_velocity.length());
            let near = reach + self.support_radius;
            let is_near = |x: &[f32; 3]| Vec3::from(*x).distance_squared(body.position) < near * near;
            if speed > fastest && fluid.iter().any(is_near) {
                fastest = speed;
            }
        }
        self.begin(time, bodies);
        fastest
    }

    /// The speed of the origin of body `k` in m/s. The speed of a jump within a step does not count: neither the
    /// displacement in the frame nor the speed in the last frame confirms it.
    fn steady_speed(&self, k: usize, time: f64, body: &BodyState) -> f32 {
        let now = body.velocity.length();
        let Some((earlier, states)) = &self.before else { return now };
        let Some(&(position, speed)) = states.get(k) else { return now };
        let duration = ((time - earlier) as f32).max(f32::MIN_POSITIVE);
        let confirmed = UNSTEADY * position.distance(body.position) / duration;
        now.min(speed.max(confirmed))
    }
}
