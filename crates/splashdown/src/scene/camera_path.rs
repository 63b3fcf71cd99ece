//! The path of the camera: its places at given times, and the curve between them.

use glam::{DVec3, Vec3};

use super::curve::hermite_weights;
use super::types::{Camera, Scene};

/// The place of the camera at a given time. What is `None` is that of the scene's camera.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[non_exhaustive]
pub struct CameraKeyframe {
    /// Simulated time in s.
    pub time: f64,
    /// The point at the centre of the picture, in m.
    pub target: Option<Vec3>,
    /// The place of the camera in m, instead of `distance`, `azimuth` and `elevation`.
    pub eye: Option<Vec3>,
    /// Distance of the eye from the target, in m.
    pub distance: Option<f32>,
    /// Angle about the y axis in degrees, as [`Camera::azimuth`]; 350 and 370 are a turn of 20 degrees.
    pub azimuth: Option<f32>,
    /// Angle above the horizon in degrees.
    pub elevation: Option<f32>,
    /// Vertical angle of view in degrees.
    pub field_of_view: Option<f32>,
}

/// A camera that moves during the run; without keyframes it does not.
///
/// Targets and azimuths lie on Catmull-Rom splines. Distance, elevation and angle of view lie on monotone cubic curves, so
/// that they never leave the range of their keyframes. The camera starts and ends at rest, and does not move before the
/// first and after the last keyframe.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct CameraPath {
    /// The keyframes in order of increasing time.
    pub keyframes: Vec<CameraKeyframe>,
}

impl Scene {
    /// The camera at a simulated time in s: that of the scene or of its path, turned by `orbit_speed`. The `orbit_speed` of
    /// the returned camera is zero.
    pub fn camera_at(&self, time: f64) -> Camera {
        let mut camera = self.camera_path.at(&self.camera, time).unwrap_or(self.camera);
        camera.azimuth = (f64::from(camera.azimuth) + f64::from(self.camera.orbit_speed) * time) as f32;
        camera.orbit_speed = 0.0;
        camera
    }
}

impl CameraPath {
    /// The camera at a time in s, without `orbit_speed`; `None` without keyframes.
    fn at(&self, camera: &Camera, time: f64) -> Option<Camera> {
        let keys = self.places(camera);
        let next = keys.partition_point(|(at, _)| *at <= time);
        if next == 0 || next == keys.len() {
            let nearest = if next == 0 { keys.first() } else { keys.last() };
            return nearest.map(|(_, camera)| *camera);
        }
        let curve = Curve { keys: &keys, start: next - 1, time };
        let target = |axis: usize| curve.value(spline, |key| key.target.as_dvec3()[axis]);
        let bounded = |value: fn(&Camera) -> f32| curve.value(monotone, |key| f64::from(value(key))) as f32;
        Some(Camera {
            target: DVec3::new(target(0), target(1), target(2)).as_vec3(),
            distance: bounded(|key| key.distance),
            azimuth: curve.value(spline, |key| f64::from(key.azimuth)) as f32,
            elevation: bounded(|key| key.elevation),
            field_of_view: bounded(|key| key.field_of_view),
            orbit_speed: 0.0,
        })
    }

    /// Times in s and cameras of all keyframes.
    fn places(&self, camera: &Camera) -> Vec<(f64, Camera)> {
        let mut places: Vec<(f64, Camera)> = Vec::new();
        for key in &self.keyframes {
            let place = key.camera(camera, places.last().map(|(_, camera)| camera));
            places.push((key.time, place));
        }
        places
    }
}

impl CameraKeyframe {
    /// The camera at this keyframe. Of the azimuths of an `eye`, which differ by whole turns, the one nearest to that of the
    /// `previous` keyframe is chosen.
    pub(super) fn camera(&self, camera: &Camera, previous: Option<&Camera>) -> Camera {
        let mut place = Camera {
            target: self.target.unwrap_or(camera.target),
            distance: self.distance.unwrap_or(camera.distance),
            azimuth: self.azimuth.unwrap_or(camera.azimuth),
            elevation: self.elevation.unwrap_or(camera.elevation),
            field_of_view: self.field_of_view.unwrap_or(camera.field_of_view),
            orbit_speed: 0.0,
        };
        if let Some(eye) = self.eye {
            let offset = eye - place.target;
            place.distance = offset.length();
            place.elevation = offset.y.atan2(offset.x.hypot(offset.z)).to_degrees();
            let azimuth = offset.x.atan2(offset.z).to_degrees();
            let near = previous.map_or(azimuth, |previous| previous.azimuth);
            place.azimuth = azimuth + 360.0 * ((near - azimuth) / 360.0).round();
        }
        place
    }
}

/// A time between two keyframes.
struct Curve<'a> {
    /// Times in s and cameras.
    keys: &'a [(f64, Camera)],
    /// The last keyframe before the time.
    start: usize,
    time: f64,
}

/// The slope at a keyframe from the durations and the slopes of the lines before and after it.
type Slope = fn([f64; 2], [f64; 2]) -> f64;

impl Curve<'_> {
    /// The cubic Hermite curve of a value.
    fn value(&self, slope: Slope, value: impl Fn(&Camera) -> f64) -> f64 {
        let [(begin, a), (finish, b)] = [&self.keys[self.start], &self.keys[self.start + 1]];
        let length = finish - begin;
        let [start, leave, end, arrive] = hermite_weights((self.time - begin) / length);
        let slopes = [self.start, self.start + 1].map(|k| self.slope(k, slope, &value));
        start * value(a) + leave * length * slopes[0] + end * value(b) + arrive * length * slopes[1]
    }

    /// The slope at a keyframe; zero at both ends of the path.
    fn slope(&self, k: usize, slope: Slope, value: &impl Fn(&Camera) -> f64) -> f64 {
        if k == 0 || k + 1 == self.keys.len() {
            return 0.0;
        }
        let line = |first: usize| {
            let [(begin, a), (end, b)] = [&self.keys[first], &self.keys[first + 1]];
            (end - begin, (value(b) - value(a)) / (end - begin))
        };
        let ((before, rise), (after, next_rise)) = (line(k - 1), line(k));
        slope([before, after], [rise, next_rise])
    }
}

/// The slope of the line through the neighbours (Catmull-Rom).
fn spline(durations: [f64; 2], slopes: [f64; 2]) -> f64 {
    (durations[0] * slopes[0] + durations[1] * slopes[1]) / (durations[0] + durations[1])
}

/// The weighted harmonic mean of both slopes, zero at an extremum, which makes the curve monotone (Fritsch and Butland
/// 1984, "A method for constructing local monotone piecewise cubic interpolants").
fn monotone(durations: [f64; 2], slopes: [f64; 2]) -> f64 {
    if slopes[0] * slopes[1] <= 0.0 {
        return 0.0;
    }
    let weights = [2.0 * durations[1] + durations[0], durations[1] + 2.0 * durations[0]];
    (weights[0] + weights[1]) / (weights[0] / slopes[0] + weights[1] / slopes[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key(time: f64, x: f32, distance: f32, elevation: f32) -> CameraKeyframe {
        CameraKeyframe {
            time,
            target: Some(Vec3::new(x, 0.0, 0.0)),
            distance: Some(distance),
            azimuth: Some(10.0 * x),
            elevation: Some(elevation),
            ..CameraKeyframe::default()
        }
    }

    const CAMERA: Camera = Camera {
        target: Vec3::ZERO,
        distance: 1.0,
        azimuth: 0.0,
        elevation: 0.0,
        field_of_view: 35.0,
        orbit_speed: 0.0,
    };

    fn path() -> CameraPath {
        let keyframes = vec![
            key(1.0, 0.0, 0.1, 20.0),
            key(2.0, 1.0, 5.0, 89.0),
            key(2.5, 3.0, 0.1, 89.0),
            key(5.0, 3.5, 0.2, -89.0),
        ];
        CameraPath { keyframes }
    }

    #[test]
    fn a_path_contains_its_keyframes_and_rests_outside() {
        let path = path();
        for (time, camera) in path.places(&CAMERA) {
            assert_eq!(path.at(&CAMERA, time), Some(camera));
        }
        let x = |time: f64| path.at(&CAMERA, time).map(|camera| camera.target.x);
        assert_eq!((x(0.0), x(99.0)), (Some(0.0), Some(3.5)));
        assert_eq!(CameraPath::default().at(&CAMERA, 1.0), None);
    }

    #[test]
    fn the_camera_moves_without_jumps_of_its_velocity() {
        let path = path();
        let speed = |time: f64, of: fn(&Camera) -> f32| {
            let at = |time| f64::from(path.at(&CAMERA, time).map_or(f32::NAN, |key| of(&key)));
            (at(time + 1e-3) - at(time - 1e-3)) / 2e-3
        };
        let values: [fn(&Camera) -> f32; 3] = [|key| key.target.x, |key| key.distance, |key| key.azimuth];
        for of in values {
            for time in [1.0, 2.0, 2.5, 5.0] {
                let (before, after) = (speed(time - 3e-3, of), speed(time + 3e-3, of));
                assert!((after - before).abs() < 2.0, "{time}: {before} and {after}");
            }
        }
        // Control: the targets on straight lines would jump from 1 to 4 m/s.
        assert!((speed(2.0, |key| key.target.x) - 2.0).abs() < 0.1);
    }

    #[test]
    fn distance_and_elevation_never_leave_the_range_of_their_keyframes() {
        let path = path();
        let places = path.places(&CAMERA);
        let mut beyond = false;
        for step in 0..400 {
            let place = path.at(&CAMERA, 1.0 + 0.01 * f64::from(step)).unwrap();
            assert!((0.1 - 1e-6..=5.0 + 1e-6).contains(&place.distance), "{place:?}");
            assert!(place.elevation.abs() <= 89.0 + 1e-4, "{place:?}");
            // Control: a spline through the same distances becomes negative.
            let curve = Curve { keys: &places, start: 2, time: 2.5 + 0.005 * f64::from(step) };
            beyond |= curve.value(spline, |key| f64::from(key.distance)) < 0.0;
        }
        assert!(beyond);
    }
}
