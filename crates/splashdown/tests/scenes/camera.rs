//! The path of the camera: `[[camera.keyframe]]` and files of camera paths.

use splashdown::glam::Vec3;
use splashdown::scene::{CameraPath, Scene};

use crate::{CUBE, parse};

fn scene(camera: &str) -> Scene {
    parse(&format!("{CUBE}[camera]\n{camera}")).unwrap_or_else(|errors| panic!("{errors}"))
}

#[test]
fn every_key_of_a_keyframe_is_read_and_others_are_those_of_the_camera() {
    let scene = scene(
        "target = [0.1, 0.2, 0.3]\ndistance = 4\nazimuth = 30\nelevation = 10\nfield_of_view = 50\n\
         [[camera.keyframe]]\ntime = 0.5\n\
         [[camera.keyframe]]\ntime = 1\ntarget = [1, 2, 3]\ndistance = 5\nazimuth = 390\nelevation = -60\nfield_of_view = 20\n",
    );
    let [plain, full] = scene.camera_path.keyframes[..] else { panic!("{:?}", scene.camera_path) };
    let camera = scene.camera;
    assert_eq!((plain.time, plain.target, plain.eye, plain.distance), (0.5, None, None, None));
    assert_eq!((plain.azimuth, plain.elevation, plain.field_of_view), (None, None, None));
    let end = scene.camera_at(1.0);
    assert_eq!((full.time, end.target, end.distance), (1.0, Vec3::new(1.0, 2.0, 3.0), 5.0));
    assert_eq!((end.azimuth, end.elevation, end.field_of_view), (390.0, -60.0, 20.0));
    assert_eq!(scene.camera_at(0.0), camera);
    assert_eq!(scene.camera_at(0.75).azimuth, 210.0);
}

#[test]
fn an_orbit_turns_a_camera_with_and_without_a_path() {
    let still = scene("azimuth = 30\norbit_speed = 90");
    assert_eq!((still.camera_at(0.5).azimuth, still.camera_at(0.5).orbit_speed), (75.0, 0.0));
    assert_eq!(still.camera_at(0.5).eye(0.0), still.camera.eye(0.5));
    let moving = scene("azimuth = 30\norbit_speed = 90\n[[camera.keyframe]]\ntime = 0\nazimuth = -60\n");
    assert_eq!(moving.camera_at(0.5).azimuth, -15.0);
}

#[test]
fn an_eye_determines_distance_and_angles() {
    let path = scene(
        "target = [0, 0, 0]\n\
         [[camera.keyframe]]\ntime = 0\neye = [-0.1, 1, -3]\n\
         [[camera.keyframe]]\ntime = 1\neye = [0.1, 1, -3]\ntarget = [0, 1, 0]\n",
    );
    for (time, eye) in [(0.0, Vec3::new(-0.1, 1.0, -3.0)), (1.0, Vec3::new(0.1, 1.0, -3.0))] {
        assert!(path.camera_at(time).eye(0.0).distance(eye) < 1e-5, "{time}");
    }
    // The camera takes the short way past an azimuth of 180 degrees.
    let turn = path.camera_at(1.0).azimuth - path.camera_at(0.0).azimuth;
    assert!((turn + 3.8).abs() < 0.1, "{turn}");
    let middle = path.camera_at(0.5).eye(0.0);
    assert!(middle.z < -2.9 && middle.x.abs() < 1e-4, "{middle}");
}

#[test]
fn mistakes_in_a_path_are_reported() {
    let cases: [(&str, &[&str]); 8] = [
        ("time = 1\n[[camera.keyframe]]\ntime = 1", &["camera.keyframe[1].time = 1 s is not after"]),
        ("time = 1\n[[camera.keyframe]]\ntime = 0.5", &["camera.keyframe[1].time", "increasing"]),
        ("azimuth = 3", &["camera.keyframe[0].time is missing"]),
        ("time = 0\nspeed = 3", &["camera.keyframe[0].speed"]),
        ("time = 0\ntarget = [1, 2, 3]\neye = [1, 2, 3]", &["eye is the target"]),
        ("time = 0\ntarget = [1, 2, 3]\neye = [1, 9, 3]", &["90.0 degrees above", "-89 to 89"]),
        ("time = 0\neye = [5, 5, 5]\nazimuth = 4", &["azimuth is given beside", "remove one"]),
        ("time = 0\ndistance = 0", &["camera.keyframe[0].distance"]),
    ];
    for (keys, words) in cases {
        let text = format!("{CUBE}[[camera.keyframe]]\n{keys}\n");
        let errors = parse(&text).err().unwrap_or_else(|| panic!("accepted: {keys}")).to_string();
        for word in words {
            assert!(errors.contains(word), "{word:?} is missing in:\n{errors}");
        }
    }
}

#[test]
fn a_file_with_a_path_is_that_of_a_scene() {
    let keys = "time = 0\neye = [1, 1, 4]\n[[#]]\ntime = 0.5\ndistance = 3\n";
    let whole = scene(&format!("[[camera.keyframe]]\n{}", keys.replace('#', "camera.keyframe")));
    let text = format!("[[keyframe]]\n{}", keys.replace('#', "keyframe"));
    let path =
        CameraPath::parse(&text, "path.toml", &whole.camera).unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!(path, whole.camera_path);
    for (text, word) in [
        ("", "no [[keyframe]]"),
        ("[[keyframe]]\ntime = ", "not valid TOML"),
        ("[scene]\nname = \"a\"\n[[keyframe]]\ntime = 0", "scene"),
        ("keyframe = 3", "keyframe"),
    ] {
        let errors =
            CameraPath::parse(text, "path.toml", &whole.camera).err().map(|errors| errors.to_string());
        assert!(errors.as_ref().is_some_and(|errors| errors.contains(word)), "{text:?}: {errors:?}");
        assert!(errors.is_some_and(|errors| errors.contains("path.toml")));
    }
}
