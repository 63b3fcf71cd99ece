//! The camera of pictures that are drawn again.

use splashdown::scene::Camera;

/// Where the camera stands, relative to that of the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orbit {
    /// Added to the azimuth of the first frame, in degrees.
    pub azimuth: f32,
    /// Added to the azimuth from the first to the last frame, in degrees.
    pub turn: f32,
    /// Elevation above the horizon in degrees; `None`: that of the scene.
    pub elevation: Option<f32>,
    /// Factor on the distance.
    pub distance: f32,
}

impl Default for Orbit {
    fn default() -> Self {
        Self { azimuth: 0.0, turn: 0.0, elevation: None, distance: 1.0 }
    }
}

impl Orbit {
    /// The camera beside that of the scene; `progress` is 0 for the first and 1 for the last picture of the film.
    pub(super) fn camera(&self, mut camera: Camera, progress: f32) -> Camera {
        camera.azimuth += self.azimuth + self.turn * progress;
        camera.elevation = self.elevation.unwrap_or(camera.elevation);
        camera.distance *= self.distance;
        camera
    }
}
