//! The interactive camera: orbit, pan, zoom and fly.

use glam::{Vec2, Vec3};
use splashdown::scene::Scene;
use splashdown_render::Camera;

/// Degrees per point of the screen.
const ORBIT: f32 = 0.3;
/// Width over height of the pictures for which scenes set their cameras.
const REFERENCE_ASPECT: f32 = 16.0 / 9.0;
/// Speed of flight per second, relative to the distance from the target.
const FLIGHT: f32 = 0.8;

/// A camera on a sphere around a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orbit {
    /// The point in the middle of the picture, in m.
    pub target: Vec3,
    /// Distance of the eye from it, in m.
    pub distance: f32,
    /// Degrees around the y axis; the camera is on the +z side at 0 and on the +x side at 90.
    pub azimuth: f32,
    /// Degrees above the horizon.
    pub elevation: f32,
    /// Vertical angle of view in degrees.
    pub field_of_view: f32,
    /// Length of the domain's diagonal, in m, which limits the distance.
    extent: f32,
}

impl Orbit {
    /// The scene's camera.
    pub fn of_scene(scene: &Scene) -> Self {
        let camera = scene.camera;
        Self {
            target: camera.target,
            distance: camera.distance,
            azimuth: camera.azimuth,
            elevation: camera.elevation,
            field_of_view: camera.field_of_view,
            extent: scene.domain.size().length(),
        }
    }

    /// The camera of the renderer for a picture with this aspect ratio (width over height).
    pub fn camera(&self, aspect_ratio: f32) -> Camera {
        let angle = self.vertical_angle(aspect_ratio);
        Camera::orbit(self.target.into(), self.distance, self.azimuth, self.elevation, angle)
    }

    /// Vertical angle of view in degrees. A picture that is narrower than the reference shows the same width, and
    /// therefore a larger height.
    fn vertical_angle(&self, aspect_ratio: f32) -> f32 {
        let wider = (REFERENCE_ASPECT / aspect_ratio.clamp(0.1, 10.0)).max(1.0);
        (2.0 * (self.half_height() * wider).atan().to_degrees()).min(150.0)
    }

    /// Half the height of the reference picture at unit distance.
    fn half_height(&self) -> f32 {
        (0.5 * self.field_of_view).to_radians().tan()
    }

    /// Metres per point at the target's distance, in a picture of this size in points.
    pub fn metres_per_point(&self, size: Vec2) -> f32 {
        let angle = self.vertical_angle(size.x / size.y.max(1.0));
        2.0 * self.distance * (0.5 * angle).to_radians().tan() / size.y.max(1.0)
    }

    /// Orbits by a drag in points.
    pub fn orbit(&mut self, drag: Vec2) {
        self.azimuth = (self.azimuth - ORBIT * drag.x).rem_euclid(360.0);
        self.elevation = (self.elevation + ORBIT * drag.y).clamp(-89.0, 89.0);
    }

    /// Pans so that a point at the distance of the target stays under the mouse. `size` is that of the picture, in points.
    pub fn pan(&mut self, drag: Vec2, size: Vec2) {
        let [right, up, _] = self.axes();
        let scale = self.metres_per_point(size);
        self.target += scale * (drag.y * up - drag.x * right);
        self.clamp_target();
    }

    /// Zooms in by a factor above 1, or out by one below 1.
    pub fn zoom(&mut self, factor: f32) {
        if factor > 0.0 && factor.is_finite() {
            self.distance = (self.distance / factor).clamp(1e-3 * self.extent, 20.0 * self.extent);
        }
    }

    /// Flies for `seconds`. The components of `direction` are right, up and ahead, in [-1, 1].
    pub fn fly(&mut self, direction: Vec3, seconds: f32) {
        let [right, _, forward] = self.axes();
        let direction = direction.x * right + direction.y * Vec3::Y + direction.z * forward;
        self.target += FLIGHT * self.distance.max(0.2 * self.extent) * seconds * direction;
        self.clamp_target();
    }

    /// A point of the picture as a ray: the eye in m, and a unit vector. `point` and `size` are in points.
    pub fn ray(&self, point: Vec2, size: Vec2) -> (Vec3, Vec3) {
        let [right, up, forward] = self.axes();
        let scale = self.metres_per_point(size) / self.distance;
        let (x, y) = (scale * (point.x - 0.5 * size.x), scale * (0.5 * size.y - point.y));
        (Vec3::from(self.camera(REFERENCE_ASPECT).eye), (forward + x * right + y * up).normalize_or(forward))
    }

    /// Right, up and ahead of the picture.
    pub fn axes(&self) -> [Vec3; 3] {
        let camera = self.camera(REFERENCE_ASPECT);
        let forward = (self.target - Vec3::from(camera.eye)).normalize_or(Vec3::NEG_Z);
        let right = forward.cross(camera.up.into()).normalize_or(Vec3::X);
        [right, right.cross(forward), forward]
    }

    /// Limits the distance of the target from the origin.
    fn clamp_target(&mut self) {
        let limit = Vec3::splat(10.0 * self.extent);
        self.target = self.target.clamp(-limit, limit);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn orbit() -> Orbit {
        Orbit {
            target: Vec3::new(0.3, 0.2, -0.1),
            distance: 2.0,
            azimuth: 30.0,
            elevation: 20.0,
            field_of_view: 40.0,
            extent: 1.5,
        }
    }

    #[test]
    fn a_ray_passes_through_the_point_projected_onto_its_pixel() {
        let (orbit, size) = (orbit(), Vec2::new(640.0, 360.0));
        let seen = Vec3::new(0.5, 0.1, 0.2);
        let [x, y] = orbit.camera(640.0 / 360.0).project(seen.into(), [640, 360]).unwrap().unwrap();
        let (eye, direction) = orbit.ray(Vec2::new(x, y), size);
        let off = (seen - eye).cross(direction).length();
        assert!(off < 1e-4, "{off}");
        // Also in a narrow picture.
        let [x, y] = orbit.camera(0.5).project(seen.into(), [300, 600]).unwrap().unwrap();
        let (eye, direction) = orbit.ray(Vec2::new(x, y), Vec2::new(300.0, 600.0));
        let off = (seen - eye).cross(direction).length();
        assert!(off < 1e-4, "{off}");
        let [x, y] = orbit.camera(640.0 / 360.0).project(seen.into(), [640, 360]).unwrap().unwrap();
        // Control: the ray of another pixel does not.
        let (eye, direction) = orbit.ray(Vec2::new(x + 5.0, y), size);
        assert!((seen - eye).cross(direction).length() > 1e-3);
    }

    #[test]
    fn a_pan_keeps_the_target_under_the_mouse() {
        let mut orbit = orbit();
        let before = orbit.target;
        orbit.pan(Vec2::new(50.0, -20.0), Vec2::new(640.0, 360.0));
        let [x, y] = orbit.camera(640.0 / 360.0).project(before.into(), [640, 360]).unwrap().unwrap();
        assert!((x - 370.0).abs() < 0.1 && (y - 160.0).abs() < 0.1, "{x} {y}");
    }

    #[test]
    fn distance_and_elevation_are_limited() {
        let mut orbit = orbit();
        orbit.zoom(1e9);
        orbit.orbit(Vec2::new(0.0, 1e6));
        assert!(orbit.distance > 1e-4 && orbit.elevation <= 89.0);
        orbit.zoom(f32::NAN);
        assert!(orbit.camera(1.0).project([0.0; 3], [64, 64]).is_ok());
    }
}
