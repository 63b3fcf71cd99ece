use glam::Vec3;
use splashdown::scene::{Outlet, Scene, SinkRegion, UpAxis};

use crate::{CUBE, parse};

fn with(text: &str) -> Scene {
    parse(&format!("{CUBE}\n{text}\n")).unwrap_or_else(|errors| panic!("{errors}"))
}

fn refusal(text: &str) -> String {
    parse(&format!("{CUBE}\n{text}\n")).map(drop).expect_err(text).to_string()
}

const TAP: &str = "[[emitter]]\nname = \"tap\"\nradius = 0.1\nposition = [0.5, 0.9, 0.5]\ndirection = [0, -2, 0]\nspeed = 2";

#[test]
fn emitters_and_sinks_are_read() {
    let scene = with(&format!(
        "{TAP}\nstart = 0.1\nend = 0.5\nmax_particles = 100\n[[emitter]]\nname = \"slot\"\nshape = \"rectangle\"\nsize = [0.2, 0.1]\n\
         position = [0, 0.5, 0.5]\ndirection = [1, 0, 0]\nspeed = 1\n[[sink]]\nname = \"drain\"\nmin = [0, 0, 0]\nmax = [0.1, 0.1, 0.1]\n\
         [[sink]]\nname = \"floor\"\nshape = \"below\"\npoint = [0, 0.1, 0]\nnormal = [0, 3, 0]"
    ));
    let tap = &scene.emitters[0];
    assert_eq!((&tap.outlet, tap.direction, tap.speed), (&Outlet::Disc { radius: 0.1 }, Vec3::NEG_Y, 2.0));
    assert_eq!((tap.start, tap.end, tap.max_particles), (0.1, Some(0.5), Some(100)));
    assert_eq!(scene.emitters[1].outlet, Outlet::Rectangle { size: [0.2, 0.1] });
    assert_eq!(scene.sinks[0].region, SinkRegion::Box { min: Vec3::ZERO, max: Vec3::splat(0.1) });
    assert_eq!(scene.sinks[1].region, SinkRegion::Below { point: Vec3::new(0.0, 0.1, 0.0), normal: Vec3::Y });
}

#[test]
fn outlets_and_sinks_may_be_meshes() {
    let scene = with(
        "[[emitter]]\nname = \"cross\"\nshape = \"mesh\"\nmesh = \"gear\"\nscale = 0.5\nup = \"z\"\nrotation = [0, 0, 90]\n\
         position = [0.5, 0.5, 0.5]\ndirection = [0, 0, 1]\nspeed = 1\n\
         [[sink]]\nname = \"ball\"\nshape = \"mesh\"\nmesh = \"sphere\"\nscale = \"cm\"\nposition = [0.9, 0.1, 0.9]",
    );
    let Outlet::Mesh(outlet) = &scene.emitters[0].outlet else { panic!("{:?}", scene.emitters[0]) };
    assert_eq!((outlet.scale, outlet.up, outlet.position), (Vec3::splat(0.5), UpAxis::Z, Vec3::splat(0.5)));
    assert!((outlet.rotation * Vec3::X).distance(Vec3::Y) < 1e-6);
    let SinkRegion::Mesh(sink) = &scene.sinks[0].region else { panic!("{:?}", scene.sinks[0]) };
    assert_eq!((sink.scale, sink.position), (Vec3::splat(0.01), Vec3::new(0.9, 0.1, 0.9)));
}

#[test]
fn an_emitter_can_replace_the_blocks() {
    let block = "[[fluid.block]]\nposition = [0, 0, 0]\nsize = [0.5, 0.5, 0.5]\n";
    let dry = CUBE.replace(block, "");
    assert!(parse(&format!("{dry}\n{TAP}\n")).is_ok());
    assert!(parse(&dry).is_err());
}

#[test]
fn errors_in_emitters_and_sinks_are_reported() {
    for (text, part) in [
        (TAP.replace("radius = 0.1\n", ""), "emitter[0].radius is missing: a disc needs it"),
        (TAP.replace("0.9", "1.9"), "outside the domain"),
        (TAP.replace("[0, -2, 0]", "[0, 0, 0]"), "is the zero vector"),
        (format!("{TAP}\nstart = 1\nend = 0.5"), "ends at 0.5 s"),
        (TAP.replace("speed = 2", ""), "speed is missing"),
        (format!("{TAP}\n{TAP}"), "there are two emitters called \"tap\""),
        (
            "[[sink]]\nname = \"a\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n".repeat(2),
            "there are two sinks called \"a\"",
        ),
        (TAP.replace("0.1", "0.6"), "the outlet of emitter \"tap\" reaches out of the domain"),
        (TAP.replace("radius = 0.1", "shape = \"mesh\""), "emitter[0].mesh is missing: a mesh needs it"),
        (
            TAP.replace("radius", "shape = \"mesh\"\nmesh = \"cube\"\nradius"),
            "emitter[0].radius does not belong",
        ),
        ("[[sink]]\nname = \"a\"\nmesh = \"cube\"".into(), "sink[0].mesh does not belong to shape = \"box\""),
        ("[[sink]]\nname = \"a\"\nmin = [0, 0, 0]\nmax = [1, 0, 1]".into(), "not above min"),
        ("[[sink]]\nname = \"a\"\nshape = \"below\"\npoint = [0, 0, 0]".into(), "normal is missing"),
    ] {
        let message = refusal(&text);
        assert!(message.contains(part), "{text}\n{message}");
    }
}

#[test]
fn fluid_that_nothing_holds_gives_a_warning() {
    let warnings = |gravity: &str, open: &str, rest: &str| {
        let text = format!(
            "[scene]\nname = \"held\"\nduration = 1\ngravity = {gravity}\n[domain]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n\
             open = [{open}]\n[fluid]\nparticle_spacing = 0.05\n[[fluid.block]]\nposition = [0, 0, 0]\nsize = [0.5, 0.5, 1]\n{rest}\n"
        );
        parse(&text).expect("valid").warnings.iter().map(ToString::to_string).collect::<String>()
    };
    let leaves = "points at the open side y_max";
    assert!(warnings("[0, 9.81, 0]", "\"y_max\"", "").contains(leaves));
    assert!(!warnings("[0, -9.81, 0]", "\"y_max\"", "").contains("points at"), "towards the floor");
    assert!(!warnings("[-5, 9.81, 0]", "\"y_max\"", "").contains("points at"), "held by a side");
    assert!(!warnings("[0, 0, 0]", "\"y_max\"", "").contains("points at"), "without gravity");
    let plate = "[[body]]\nname = \"plate\"\nmesh = \"block\"\nposition = [0.5, 0.9, 0.5]";
    assert!(!warnings("[0, 9.81, 0]", "\"y_max\"", plate).contains("points at"), "held by a body");
}

#[test]
fn surface_tension_without_effect_or_in_a_small_vessel_gives_a_warning() {
    let warnings = |size: f32, fluid: &str, solver: &str| {
        let spacing = size / 20.0;
        let text = format!(
            "[scene]\nname = \"drop\"\nduration = 1\n[domain]\nmin = [0, 0, 0]\nmax = [{size}, {size}, {size}]\n[fluid]\n\
             particle_spacing = {spacing}\n{fluid}\n[[fluid.block]]\nposition = [0, 0, 0]\nsize = [{size}, {}, {size}]\n[solver]\n{solver}\n",
            0.5 * size
        );
        parse(&text).expect("valid").warnings.iter().map(ToString::to_string).collect::<String>()
    };
    let (csf, given) = ("surface_tension = \"csf\"", "surface_tension = 0.07");
    let useless = "fluid.surface_tension has no effect";
    assert!(warnings(1.0, given, "").contains(useless));
    assert!(!warnings(1.0, given, csf).contains(useless));
    assert!(!warnings(1.0, "", "").contains(useless));
    let small = "capillary lengths";
    assert!(warnings(0.008, "", csf).contains(small));
    assert!(!warnings(0.08, "", csf).contains(small), "a larger vessel");
    assert!(!warnings(0.008, "", "accuracy = \"engineering\"\nsurface_tension = \"csf\"").contains(small));
}

#[test]
fn frames_longer_than_the_scene_give_a_warning() {
    let warnings = |rate: f32| {
        let text = format!(
            "[scene]\nname = \"slow\"\nduration = 1\nframe_rate = {rate}\n[domain]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n[fluid]\n\
             particle_spacing = 0.05\n[[fluid.block]]\nposition = [0, 0, 0]\nsize = [0.5, 0.5, 1]\n"
        );
        parse(&text).expect("valid").warnings.iter().map(ToString::to_string).collect::<String>()
    };
    let longer = "the run simulates 2 s instead of 1 s";
    assert!(warnings(0.5).contains(longer), "{}", warnings(0.5));
    assert!(warnings(24.0).is_empty(), "{}", warnings(24.0));
}

#[test]
fn emitters_that_overfill_a_closed_domain_give_a_warning() {
    let scene = |size: f32, solver: &str, rest: &str| {
        let text = format!(
            "[scene]\nname = \"full\"\nduration = 1\n[domain]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n[fluid]\n\
             particle_spacing = 0.05\n[[fluid.block]]\nposition = [0, 0, 0]\nsize = [1, {size}, 1]\n[solver]\n{solver}\n{rest}\n"
        );
        parse(&text).expect("valid").warnings.iter().map(ToString::to_string).collect::<String>()
    };
    let adds = "the emitters add 6.";
    assert!(scene(0.95, "", TAP).contains(adds), "{}", scene(0.95, "", TAP));
    assert!(!scene(0.5, "", TAP).contains(adds));
    assert!(!scene(0.95, "", &format!("{TAP}\nmax_particles = 300")).contains(adds));
    let sink = "[[sink]]\nname = \"drain\"\nmin = [0, 0, 0]\nmax = [0.1, 0.1, 0.1]";
    assert!(!scene(0.95, "", &format!("{TAP}\n{sink}")).contains(adds));
}

/// The warnings of a scene in a file with these emitters and sinks.
fn warnings(text: &str) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, format!("{CUBE}\n{text}\n")).unwrap();
    Scene::load(&path).unwrap().warnings.iter().map(ToString::to_string).collect()
}

#[test]
fn emitters_in_sinks_are_reported() {
    let reported = |sink: &str| {
        let expected = "emitter \"tap\" lies in sink \"drain\"";
        warnings(&format!("{TAP}\n[[sink]]\nname = \"drain\"\n{sink}"))
            .iter()
            .any(|text| text.contains(expected))
    };
    assert!(reported("min = [0.3, 0.8, 0.3]\nmax = [0.7, 1, 0.7]"));
    assert!(reported("shape = \"below\"\npoint = [0, 0.95, 0]\nnormal = [0, 1, 0]"));
    assert!(reported("shape = \"mesh\"\nmesh = \"cube\"\nscale = 0.4\nposition = [0.5, 0.9, 0.5]"));
    // In front of the outlet, and over a small part of it.
    assert!(!reported("min = [0.3, 0, 0.3]\nmax = [0.7, 0.3, 0.7]"));
    assert!(!reported("min = [0.58, 0, 0]\nmax = [1, 1, 1]"));
}

#[test]
fn outlets_that_cross_are_reported() {
    let reported = |other: &str| {
        let second =
            format!("[[emitter]]\nname = \"jet\"\nradius = 0.1\ndirection = [1, 0, 0]\nspeed = 1\n{other}");
        let expected = "emitters \"tap\" and \"jet\" cross";
        warnings(&format!("{TAP}\n{second}")).iter().any(|text| text.contains(expected))
    };
    assert!(reported("position = [0.5, 0.9, 0.5]"));
    assert!(!reported("position = [0.2, 0.5, 0.5]"));
    // One after the other.
    let later = "position = [0.5, 0.9, 0.5]\nstart = 0.2";
    assert!(reported(later));
    let tap = format!(
        "{TAP}\nend = 0.1\n[[emitter]]\nname = \"jet\"\nradius = 0.1\ndirection = [1, 0, 0]\nspeed = 1\n{later}"
    );
    assert!(!warnings(&tap).iter().any(|text| text.contains("cross")));
}

#[test]
fn sinks_that_contain_all_fluid_are_reported() {
    let reported = |max: f32| {
        let sink = format!("[[sink]]\nname = \"drain\"\nmin = [0, 0, 0]\nmax = [1, {max}, 1]");
        warnings(&sink).iter().any(|text| text.contains("contain all fluid"))
    };
    assert!(reported(1.0));
    assert!(!reported(0.04), "control: a part of it");
}

#[test]
fn an_outlet_in_front_of_a_wall_is_reported() {
    let reported = |y: f32, direction: &str| {
        let text = TAP
            .replace("position = [0.5, 0.9, 0.5]", &format!("position = [0.5, {y}, 0.5]"))
            .replace("direction = [0, -2, 0]", &format!("direction = {direction}"));
        warnings(&text).iter().any(|text| text.contains("points at the wall y_min"))
    };
    assert!(reported(0.05, "[0, -1, 0]"));
    // Control: with room, along the wall, and out of it.
    assert!(!reported(0.5, "[0, -1, 0]"));
    assert!(!reported(0.12, "[1, 0, 0]") && !reported(0.05, "[0, 1, 0]"));
}
