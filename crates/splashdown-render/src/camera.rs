//! The camera.

use crate::{Domain, RenderError};
use glam::{Mat4, Vec2, Vec3, Vec4};

/// A perspective camera.
///
/// Right-handed, y up. Depth is reversed, with the far plane at infinity: 1 at the near plane, 0 at
/// infinity, and `near / distance` in between. Floats are densest near 0, which makes the relative
/// precision uniform over the range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Position of the eye, metres.
    pub eye: [f32; 3],
    /// Point in the middle of the picture, metres.
    pub target: [f32; 3],
    /// Up direction in the picture; not parallel to the view direction.
    pub up: [f32; 3],
    /// Vertical angle of view, degrees, between 1 and 170.
    pub field_of_view_deg: f32,
}

/// The axes of a camera for one picture size. `right` and `up` are scaled to half the picture at
/// unit distance.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View {
    pub eye: Vec3,
    pub right: Vec3,
    pub up: Vec3,
    pub forward: Vec3,
    pub near: f32,
    pub clip_from_world: Mat4,
}

impl View {
    /// The same view from another point of a lens and through another point of the pixels:
    /// `picture` in halves of the picture's width and height, `lens` in metres to the right and up.
    /// What lies at the distance `focus` in metres along the view remains in place. Returns the view
    /// and the vector to add to its rays.
    pub fn shifted(&self, picture: Vec2, lens: Vec2, focus: f32) -> (View, Vec3) {
        let (right, up) = (self.right.normalize_or_zero(), self.up.normalize_or_zero());
        let moved = right * lens.x + up * lens.y;
        let eye = self.eye + moved;
        let shift = self.right * picture.x + self.up * picture.y - moved / focus;
        let row_w = self.forward.extend(-self.forward.dot(eye));
        let row = |axis: Vec3, half: f32| (axis.extend(-axis.dot(eye)) - row_w * shift.dot(axis)) / half;
        let row_z = Vec4::new(0.0, 0.0, 0.0, self.near);
        let rows = [row(right, self.right.length()), row(up, self.up.length()), row_z, row_w];
        let clip_from_world = Mat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose();
        (View { eye, clip_from_world, ..*self }, shift)
    }
}

impl Camera {
    /// A camera on a sphere around `target`, metres and degrees.
    ///
    /// Azimuth 0 is on the +z side, 90 on the +x side. Elevation 0 is level with the target, 90
    /// vertically above it.
    pub fn orbit(
        target: [f32; 3],
        distance: f32,
        azimuth_deg: f32,
        elevation_deg: f32,
        field_of_view_deg: f32,
    ) -> Camera {
        let (sin_azimuth, cos_azimuth) = azimuth_deg.to_radians().sin_cos();
        let (sin_elevation, cos_elevation) = elevation_deg.to_radians().sin_cos();
        let out = Vec3::new(sin_azimuth * cos_elevation, sin_elevation, cos_azimuth * cos_elevation);
        let eye = Vec3::from(target) + distance * out;
        // The limit of the up vector is used at the poles, so that it is never parallel to the
        // view.
        let up = Vec3::new(-sin_azimuth * sin_elevation, cos_elevation, -cos_azimuth * sin_elevation);
        Camera { eye: eye.into(), target, up: up.into(), field_of_view_deg }
    }

    /// An orbit camera at the distance where the whole box fits into a picture of the given aspect
    /// ratio (width / height).
    pub fn framing(
        domain: &Domain,
        azimuth_deg: f32,
        elevation_deg: f32,
        field_of_view_deg: f32,
        aspect_ratio: f32,
    ) -> Camera {
        let (low, high) = (Vec3::from(domain.min), Vec3::from(domain.max));
        let centre = 0.5 * (low + high);
        let unit = Camera::orbit(centre.into(), 1.0, azimuth_deg, elevation_deg, field_of_view_deg);
        let forward = centre - Vec3::from(unit.eye);
        let up = Vec3::from(unit.up);
        let right = forward.cross(up);
        let tan_y = (0.5 * field_of_view_deg.clamp(1.0, 170.0)).to_radians().tan();
        let tan_x = tan_y * aspect_ratio.max(1e-3);
        // A corner at offset c from the centre is visible if |c.right| <= (distance + c.forward)
        // tan_x; likewise for up.
        let distance = domain
            .corners()
            .iter()
            .map(|&corner| {
                let c = corner - centre;
                let sideways = (c.dot(right).abs() / tan_x).max(c.dot(up).abs() / tan_y);
                sideways - c.dot(forward)
            })
            .fold(0.0, f32::max);
        Camera::orbit(centre.into(), 1.06 * distance, azimuth_deg, elevation_deg, field_of_view_deg)
    }

    /// Projects a point into a picture of the given size: pixels from the upper left corner, or
    /// `None` if the point is behind the eye.
    ///
    /// # Errors
    /// [`RenderError::Camera`] if the camera is invalid.
    pub fn project(&self, point: [f32; 3], picture_size: [u32; 2]) -> Result<Option<[f32; 2]>, RenderError> {
        let [width, height] = picture_size.map(|side| side as f32);
        let clip = self.view(width / height)?.clip_from_world * Vec3::from(point).extend(1.0);
        if clip.w.is_nan() || clip.w <= 0.0 {
            return Ok(None);
        }
        let ndc = clip.truncate() / clip.w;
        Ok(Some([(0.5 + 0.5 * ndc.x) * width, (0.5 - 0.5 * ndc.y) * height]))
    }

    /// Axes and matrix for a picture of the given aspect ratio (width / height).
    pub(crate) fn view(&self, aspect_ratio: f32) -> Result<View, RenderError> {
        let bad = |reason: String| Err(RenderError::Camera { reason });
        let (eye, target, up) = (Vec3::from(self.eye), Vec3::from(self.target), Vec3::from(self.up));
        if !(eye.is_finite() && target.is_finite() && up.is_finite()) {
            return bad(format!("eye {eye}, target {target} and up {up} must be finite numbers"));
        }
        if !(1.0..=170.0).contains(&self.field_of_view_deg) {
            let given = self.field_of_view_deg;
            return bad(format!("the field of view is {given} degrees, allowed is 1 to 170"));
        }
        let distance = eye.distance(target);
        let Some(forward) = (target - eye).try_normalize() else {
            return bad(format!("eye and target are both at {eye}; move one of them"));
        };
        let Some(right) =
            forward.cross(up).try_normalize().filter(|_| forward.cross(up).length() > 1e-4 * up.length())
        else {
            return bad(format!("up {up} is parallel to the view {forward}; choose another up"));
        };
        let up = right.cross(forward);
        let tan_y = (0.5 * self.field_of_view_deg).to_radians().tan();
        let tan_x = tan_y * aspect_ratio;
        let near = (1e-3 * distance).max(1e-5);
        let row_x = right.extend(-right.dot(eye)) / tan_x;
        let row_y = up.extend(-up.dot(eye)) / tan_y;
        let row_z = Vec4::new(0.0, 0.0, 0.0, near);
        let row_w = forward.extend(-forward.dot(eye));
        let clip_from_world = Mat4::from_cols(row_x, row_y, row_z, row_w).transpose();
        Ok(View { eye, right: right * tan_x, up: up * tan_y, forward, near, clip_from_world })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: [f32; 3], b: [f32; 3]) -> bool {
        Vec3::from(a).distance(Vec3::from(b)) < 1e-5
    }

    #[test]
    fn orbit_places_the_eye_by_azimuth_and_elevation() {
        assert!(close(Camera::orbit([1.0, 2.0, 3.0], 2.0, 0.0, 0.0, 40.0).eye, [1.0, 2.0, 5.0]));
        assert!(close(Camera::orbit([1.0, 2.0, 3.0], 2.0, 90.0, 0.0, 40.0).eye, [3.0, 2.0, 3.0]));
        assert!(close(Camera::orbit([1.0, 2.0, 3.0], 2.0, 30.0, 90.0, 40.0).eye, [1.0, 4.0, 3.0]));
        // Negative control: the opposite azimuth.
        assert!(!close(Camera::orbit([1.0, 2.0, 3.0], 2.0, -90.0, 0.0, 40.0).eye, [3.0, 2.0, 3.0]));
    }

    #[test]
    fn the_target_is_projected_to_the_middle_and_up_points_upwards() {
        for elevation in [-80.0, 0.0, 35.0, 90.0] {
            let camera = Camera::orbit([0.3, -0.2, 0.1], 4.0, 25.0, elevation, 45.0);
            let middle = camera.project([0.3, -0.2, 0.1], [640, 480]).unwrap().unwrap();
            assert!((middle[0] - 320.0).abs() < 0.01 && (middle[1] - 240.0).abs() < 0.01, "{middle:?}");
        }
        let camera = Camera::orbit([0.0; 3], 4.0, 0.0, 20.0, 45.0);
        let above = camera.project([0.0, 0.5, 0.0], [640, 480]).unwrap().unwrap();
        let right = camera.project([0.5, 0.0, 0.0], [640, 480]).unwrap().unwrap();
        assert!(above[1] < 200.0 && right[0] > 360.0, "{above:?} {right:?}");
    }

    #[test]
    fn the_field_of_view_spans_the_height_of_the_picture() {
        let camera = Camera::orbit([0.0; 3], 2.0, 0.0, 0.0, 90.0);
        let edge = camera.project([0.0, 2.0, 0.0], [300, 200]).unwrap().unwrap();
        assert!((edge[0] - 150.0).abs() < 1e-3 && edge[1].abs() < 1e-3, "{edge:?}");
        assert_eq!(camera.project([0.0, 0.0, 3.0], [300, 200]).unwrap(), None);
    }

    #[test]
    fn depth_is_reversed() {
        let view = Camera::orbit([0.0; 3], 2.0, 0.0, 0.0, 60.0).view(1.0).unwrap();
        let depth = |z: f32| {
            let clip = view.clip_from_world * Vec4::new(0.0, 0.0, z, 1.0);
            clip.z / clip.w
        };
        assert!((depth(2.0 - view.near) - 1.0).abs() < 1e-3);
        assert!(depth(1.0) > depth(0.0) && depth(0.0) > depth(-1000.0) && depth(-1000.0) > 0.0);
    }

    #[test]
    fn a_lens_moves_everything_but_the_plane_of_focus() {
        let view = Camera::orbit([0.0; 3], 2.0, 30.0, 20.0, 50.0).view(1.5).unwrap();
        let seen = |view: &View, point: Vec3| {
            let clip = view.clip_from_world * point.extend(1.0);
            Vec2::new(clip.x, clip.y) / clip.w
        };
        let (same, _) = view.shifted(Vec2::ZERO, Vec2::ZERO, 2.0);
        let (moved, shift) = view.shifted(Vec2::ZERO, Vec2::new(0.05, -0.02), 2.0);
        for (x, y) in [(0.0, 0.0), (0.7, -0.4)] {
            let at = |depth: f32| view.eye + depth * (view.forward + x * view.right + y * view.up);
            assert!(seen(&same, at(3.0)).distance(Vec2::new(x, y)) < 1e-5);
            assert!(seen(&moved, at(2.0)).distance(Vec2::new(x, y)) < 1e-5);
            // Negative control: what is out of focus moves.
            assert!(seen(&moved, at(3.0)).distance(Vec2::new(x, y)) > 1e-3);
            // The ray of the pixel passes through what the matrix puts there.
            let point = moved.eye + 3.0 * (view.forward + shift + x * view.right + y * view.up);
            assert!(seen(&moved, point).distance(Vec2::new(x, y)) < 1e-5);
        }
    }

    #[test]
    fn framing_fits_the_box_tightly() {
        let domain = Domain::closed([-1.0, 0.0, -0.2], [2.0, 1.0, 0.6]);
        for (azimuth, elevation, size) in
            [(30.0, 20.0, [1280, 720]), (200.0, -10.0, [300, 900]), (0.0, 89.0, [64, 64])]
        {
            let aspect = size[0] as f32 / size[1] as f32;
            let camera = Camera::framing(&domain, azimuth, elevation, 40.0, aspect);
            let mut reach = 0.0f32;
            for corner in domain.corners() {
                let [x, y] = camera.project(corner.into(), size).unwrap().unwrap();
                let from_middle = [2.0 * x / size[0] as f32 - 1.0, 2.0 * y / size[1] as f32 - 1.0];
                reach = reach.max(from_middle[0].abs()).max(from_middle[1].abs());
            }
            assert!(reach < 1.0 && reach > 0.85, "the box covers {reach} of the picture");
        }
    }

    #[test]
    fn invalid_cameras_are_refused_with_the_reason() {
        let good = Camera::orbit([0.0; 3], 2.0, 0.0, 0.0, 60.0);
        let message = |camera: Camera| camera.view(1.0).unwrap_err().to_string();
        assert!(message(Camera { eye: [0.0; 3], ..good }).contains("move one"));
        assert!(message(Camera { up: [0.0, 0.0, 1.0], ..good }).contains("parallel"));
        assert!(message(Camera { field_of_view_deg: 180.0, ..good }).contains("1 to 170"));
        assert!(message(Camera { eye: [f32::NAN, 0.0, 0.0], ..good }).contains("finite"));
    }
}
