//! The position of the camera.

use glam::Vec3;

use super::types::{Camera, Domain};

/// Factor on the size of the domain that leaves a margin around it.
const MARGIN: f32 = 1.06;

impl Camera {
    /// Unit vector from the target to the eye at simulated time `t` (s).
    pub fn direction(&self, t: f32) -> Vec3 {
        let (sin_a, cos_a) = (self.azimuth + self.orbit_speed * t).to_radians().sin_cos();
        let (sin_e, cos_e) = self.elevation.to_radians().sin_cos();
        Vec3::new(cos_e * sin_a, sin_e, cos_e * cos_a)
    }

    /// The eye at simulated time `t` (s), in m.
    pub fn eye(&self, t: f32) -> Vec3 {
        self.target + self.direction(t) * self.distance
    }
}

/// The distance in m from which the camera sees all corners of the domain during its whole orbit.
pub(crate) fn fitting_distance(camera: &Camera, domain: &Domain, picture: [u32; 2], duration: f32) -> f32 {
    let moments = if camera.orbit_speed == 0.0 { 1 } else { 48 };
    let half_height = (camera.field_of_view * 0.5).to_radians().tan();
    let half_width = half_height * picture[0] as f32 / picture[1] as f32;
    let mut needed = f32::MIN_POSITIVE;
    for moment in 0..moments {
        let backward = camera.direction(duration * moment as f32 / moments as f32);
        // A camera built in code may look straight down, where any horizontal direction is valid.
        let right = Vec3::Y.cross(backward).normalize_or(Vec3::X);
        let up = backward.cross(right);
        for corner in 0..8 {
            let pick =
                |axis: usize| if corner >> axis & 1 == 0 { domain.min[axis] } else { domain.max[axis] };
            let offset = Vec3::new(pick(0), pick(1), pick(2)) - camera.target;
            let beside = (offset.dot(right).abs() / half_width).max(offset.dot(up).abs() / half_height);
            needed = needed.max(beside * MARGIN + offset.dot(backward));
        }
    }
    needed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn azimuth_zero_looks_from_plus_z_and_ninety_from_plus_x() {
        let mut camera = Camera {
            target: Vec3::ONE,
            distance: 2.0,
            azimuth: 0.0,
            elevation: 0.0,
            field_of_view: 35.0,
            orbit_speed: 90.0,
        };
        assert!(camera.eye(0.0).abs_diff_eq(Vec3::new(1.0, 1.0, 3.0), 1e-6));
        assert!(
            camera.eye(1.0).abs_diff_eq(Vec3::new(3.0, 1.0, 1.0), 1e-6),
            "the azimuth increases along the orbit"
        );
        camera.elevation = 30.0;
        assert!((camera.eye(0.0).y - 2.0).abs() < 1e-6);
    }

    #[test]
    fn the_fitting_distance_shows_every_corner() {
        let domain = Domain {
            min: Vec3::ZERO,
            max: Vec3::new(2.0, 1.0, 0.8),
            closed: [[true; 2]; 3],
            oscillation: None,
        };
        let mut camera = Camera {
            target: domain.center(),
            distance: 0.0,
            azimuth: 25.0,
            elevation: 20.0,
            field_of_view: 35.0,
            orbit_speed: 0.0,
        };
        camera.distance = fitting_distance(&camera, &domain, [1280, 720], 1.0);
        assert!(sees_all(&camera, &domain));
        camera.distance *= 0.85;
        assert!(!sees_all(&camera, &domain), "negative control: a corner is outside at a smaller distance");
    }

    /// The oracle: glam's own view and projection matrices.
    fn sees_all(camera: &Camera, domain: &Domain) -> bool {
        let view = glam::camera::rh::view::look_at_mat4(camera.eye(0.0), camera.target, Vec3::Y);
        let fov = camera.field_of_view.to_radians();
        (0..8).all(|corner| {
            let pick =
                |axis: usize| if corner >> axis & 1 == 0 { domain.min[axis] } else { domain.max[axis] };
            let seen = view.transform_point3(Vec3::new(pick(0), pick(1), pick(2)));
            let height = -seen.z * (fov * 0.5).tan();
            seen.z < 0.0 && seen.y.abs() <= height && seen.x.abs() <= height * 1280.0 / 720.0
        })
    }
}
