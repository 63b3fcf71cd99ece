use glam::{Quat, Vec3};
use splashdown::scene::{Body, BoundaryKind, Hinge, MeshShape, Motion, Motor, Scene, UpAxis};

use crate::{CUBE, parse};

fn with_body(body: &str) -> String {
    format!("{CUBE}\n[[body]]\n{body}\n")
}

fn body(text: &str) -> Body {
    let scene = parse(&with_body(text)).unwrap_or_else(|errors| panic!("{errors}"));
    scene.bodies.into_iter().next().expect("one body")
}

fn refusal(text: &str) -> String {
    parse(&with_body(text)).map(drop).expect_err(text).to_string()
}

const PLAIN: &str = "name = \"block\"\nmesh = \"cube\"";

#[test]
fn a_body_has_the_defaults_of_the_reference() {
    let plain = body(PLAIN);
    assert_eq!(plain.motion, Motion::Static);
    assert_eq!(plain.mesh.shape, MeshShape::Model("cube".into()));
    assert_eq!((plain.friction, plain.adhesion, plain.boundary), (0.0, 0.0, BoundaryKind::Map));
    assert_eq!((plain.half_thickness, plain.shell, plain.colour), (None, None, None));
    let schema = splashdown::scene::schema();
    let keys = schema["properties"]["body"]["items"]["properties"].as_object().expect("keys");
    let mut seen = 0;
    for (name, key) in keys {
        // Keys of dynamic bodies are tested separately.
        let Some(default) = key
            .get("default")
            .filter(|_| !matches!(name.as_str(), "density" | "velocity" | "angular_velocity"))
        else {
            continue;
        };
        assert_eq!(body(&format!("{PLAIN}\n{name} = {default}")), plain, "{name}");
        seen += 1;
    }
    assert!(seen >= 6, "{seen}");
}

#[test]
fn a_hinge_is_read_and_its_default_point_is_the_position_of_the_body() {
    let wheel = body(
        "name = \"wheel\"\nmesh = \"gear\"\nmotion = \"dynamic\"\nposition = [0.1, 0.2, 0.3]\nhinge = [0, 0, 2]",
    );
    let Motion::Dynamic { hinge: Some(hinge), .. } = wheel.motion else { panic!("{wheel:?}") };
    assert_eq!(hinge, Hinge { point: Vec3::new(0.1, 0.2, 0.3), axis: Vec3::Z, motor: None });
    let door = body(
        "name = \"door\"\nmesh = \"cube\"\nmotion = \"dynamic\"\nhinge = [0, 1, 0]\nhinge_point = [1, 0, 0]",
    );
    let Motion::Dynamic { hinge: Some(hinge), .. } = door.motion else { panic!("{door:?}") };
    assert_eq!(hinge.point, Vec3::X);
}

#[test]
fn every_key_of_a_body_is_read() {
    let full = body(
        "name = \"boat\"\nmesh = \"parts/boat.stl\"\nscale = 0.001\nup = \"z\"\nposition = [1, 2, 3]\nrotation = [0, 90, 0]\n\
         motion = \"dynamic\"\ndensity = 200\nvelocity = [1, 0, 0]\nangular_velocity = [0, 2, 0]\nfriction = 0.5\nadhesion = 3\n\
         boundary = \"particles\"\nshell = true\nhalf_thickness = 0.01\ncolour = [1, 0.5, 0]",
    );
    assert_eq!(full.mesh.shape, MeshShape::File("parts/boat.stl".into()));
    assert_eq!(
        (full.mesh.scale, full.mesh.up, full.mesh.position),
        (Vec3::splat(0.001), UpAxis::Z, Vec3::new(1.0, 2.0, 3.0))
    );
    assert!((full.mesh.rotation * Vec3::Z).distance(Vec3::X) < 1e-6);
    let velocity = Vec3::new(1.0, 0.0, 0.0);
    let angular_velocity = Vec3::new(0.0, 2.0, 0.0);
    assert_eq!(full.motion, Motion::Dynamic { density: 200.0, velocity, angular_velocity, hinge: None });
    assert_eq!((full.friction, full.adhesion, full.boundary), (0.5, 3.0, BoundaryKind::Particles));
    assert_eq!(
        (full.shell, full.half_thickness, full.colour),
        (Some(true), Some(0.01), Some([1.0, 0.5, 0.0]))
    );
}

#[test]
fn scales_are_numbers_or_units() {
    for (written, expected) in [
        ("2", 2.0),
        ("\"mm\"", 0.001),
        ("\"cm\"", 0.01),
        ("\"m\"", 1.0),
        ("\"in\"", 0.0254),
        ("\"ft\"", 0.3048),
    ] {
        let scale = body(&format!("{PLAIN}\nscale = {written}")).mesh.scale;
        assert_eq!(scale, Vec3::splat(expected), "{written}");
    }
}

#[test]
fn rotations_are_about_x_then_y_then_z() {
    let turned = body(&format!("{PLAIN}\nrotation = [90, 0, 90]")).mesh.rotation;
    let expected = Quat::from_rotation_z(std::f32::consts::FRAC_PI_2)
        * Quat::from_rotation_x(std::f32::consts::FRAC_PI_2);
    assert!((turned * Vec3::Y).distance(expected * Vec3::Y) < 1e-6);
}

#[test]
fn keyframes_and_formulas_define_a_scripted_motion() {
    let Motion::Scripted(script) = body(&format!(
        "{PLAIN}\nposition = [0.5, 0, 0]\nmove = [\"0.1*sin(2*pi*t)\", \"0\", \"0\"]\nturn = [\"0\", \"0\", \"90*t\"]"
    ))
    .motion
    else {
        panic!("formulas make a scripted body")
    };
    assert!(script.pose(0.25).position.distance(Vec3::new(0.6, 0.0, 0.0)) < 1e-6);
    let Motion::Scripted(script) = body(&format!(
        "{PLAIN}\n[[body.keyframe]]\ntime = 0\n[[body.keyframe]]\ntime = 2\nposition = [1, 0, 0]"
    ))
    .motion
    else {
        panic!("keyframes make a scripted body")
    };
    assert!((script.pose(1.0).position.x - 0.5).abs() < 1e-6);
}

#[test]
fn errors_in_bodies_name_the_allowed_values() {
    for (text, parts) in [
        ("mesh = \"cube\"", &["body[0].name is missing"][..]),
        ("name = \"a\"\nmesh = \"cub\"", &["\"cub\"", "did you mean \"cube\"?"]),
        (
            "name = \"a\"\nmesh = \"cube\"\n[[body]]\nname = \"a\"\nmesh = \"cube\"",
            &["two bodies called \"a\""],
        ),
        (
            "name = \"a\"\nmesh = \"cube\"\n[[body]]\nname = \"A\"\nmesh = \"cube\"",
            &["bodies \"a\" and \"A\" differ only in case"],
        ),
        ("name = \"a\"\nmesh = \"cube\"\nmotion = \"scripted\"", &["needs a keyframe, move or turn"]),
        (
            "name = \"a\"\nmesh = \"cube\"\nmotion = \"static\"\nturn = [\"0\", \"t\", \"0\"]",
            &["cannot have keyframes"],
        ),
        ("name = \"a\"\nmesh = \"cube\"\nturn = [\"0\", \"speed*t\", \"0\"]", &["\"speed\"", "sin cos"]),
        ("name = \"a\"\nmesh = \"cube\"\nturn = [\"0\", \"1/t\", \"0\"]", &["not finite at t = 0"]),
        (
            "name = \"a\"\nmesh = \"cube\"\nmove = [\"sqrt(0.5-t)\", \"0\", \"0\"]",
            &["body[0].move", "not finite at t = 0.50"],
        ),
        (
            "name = \"a\"\nmesh = \"cube\"\nmove = [\"0\", \"0.1/(t-0.3333)\", \"0\"]",
            &["at t = 0.3333", "duration"],
        ),
        (
            "name = \"a\"\nmesh = \"cube\"\n[[body.keyframe]]\ntime = 1\n[[body.keyframe]]\ntime = 0.5",
            &["body[0].keyframe[1].time = 0.5", "not after"],
        ),
        (
            "name = \"a\"\nmesh = \"cube\"\nscale = \"millimetre\"",
            &["body[0].scale cannot be \"millimetre\"", "did you mean \"mm\"?"],
        ),
        ("name = \"a\"\nmesh = \"cube\"\nscale = \"0.1\"", &["without quotes"]),
        ("name = \"a\"\nmesh = \"cube\"\nscale = -1", &["body[0].scale is -1", "\"ft\""]),
        ("name = \"a\"\nmesh = \"cube\"\nturn = [\"0\", \"t\"]", &["a list of 3 texts, not of 2"]),
        ("name = \"a\"\nmesh = \"cube\"\nmove = [\"\", \"0\", \"0\"]", &["must not be empty"]),
        (
            "name = \"a\"\nmesh = \"cube\"\n[[body.keyframe]]\ntime = 1\n[[body.keyframe]]\ntime = 1",
            &["body[0].keyframe[1].time", "not after"],
        ),
        ("name = \"a\"\nmesh = \"cube\"\nfriction = 2", &["body[0].friction", "0 to 1"]),
    ] {
        let message = refusal(text);
        for part in parts {
            assert!(message.contains(part), "{text}\n{message}");
        }
    }
}

#[test]
fn a_density_of_a_static_body_gives_a_warning() {
    let scene = parse(&with_body(&format!("{PLAIN}\ndensity = 300"))).expect("valid");
    let warnings = scene.warnings.iter().map(ToString::to_string).collect::<String>();
    assert!(warnings.contains("only on a dynamic body"), "{warnings}");
}

#[test]
fn tension_with_a_pressure_that_is_not_negative_gives_a_warning() {
    let warnings = |method: &str, model: &str| {
        let cube = CUBE.replace("method = \"wcsph\"", method);
        let scene = parse(&format!("{cube}surface_tension = \"{model}\"\n")).expect("valid");
        scene.warnings.iter().map(ToString::to_string).collect::<String>()
    };
    let warned = warnings("method = \"dfsph\"", "csf");
    assert!(warned.contains("never negative") && warned.contains("accuracy"), "{warned}");
    for (method, model) in [("accuracy = \"engineering\"", "csf"), ("method = \"dfsph\"", "akinci2013")] {
        assert!(!warnings(method, model).contains("never negative"), "{method}, {model}");
    }
    // Particles of the explicit form pair.
    let pairs = |method: &str, model: &str| warnings(method, model).contains("in pairs");
    assert!(pairs("method = \"wcsph\"", "csf"));
    assert!(!pairs("accuracy = \"engineering\"", "csf") && !pairs("method = \"wcsph\"", "akinci2013"));
}

#[test]
fn negative_pressures_with_a_summed_density_give_a_warning() {
    let warnings = |keys: &str| {
        let scene = parse(&CUBE.replace("method = \"wcsph\"", keys)).expect("valid");
        scene.warnings.iter().map(ToString::to_string).collect::<String>()
    };
    let keep = "negative_pressure = \"keep\"";
    for method in ["wcsph", "mueller2003"] {
        let warned = warnings(&format!("method = \"{method}\"\n{keep}"));
        assert!(warned.contains("pull a free surface together") && warned.contains("clamp"), "{warned}");
        assert!(!warnings(&format!("method = \"{method}\"")).contains("pull"));
    }
    assert!(!warnings(&format!("method = \"wcsph\"\ndensity = \"continuity\"\n{keep}")).contains("pull"));
    // Fluid that fills the closed domain has no free surface.
    let full = "[scene]\nname = \"full\"\nduration = 1\n[domain]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n[fluid]\nparticle_spacing = 0.05\n\
        [[fluid.block]]\nposition = [0, 0, 0]\nsize = [1, 1, 1]\n[solver]\nmethod = \"wcsph\"\nnegative_pressure = \"keep\"\n";
    let warned =
        |text: &str| parse(text).expect("valid").warnings.iter().any(|w| w.to_string().contains("pull"));
    assert!(!warned(full) && warned(&full.replace("size = [1, 1, 1]", "size = [1, 0.5, 1]")));
}

/// With the implicit pressure the surface is complete under `csf`, and the force is larger for it.
#[test]
fn the_surface_is_complete_with_an_implicit_pressure_and_tension() {
    let params = |method: &str, model: &str| {
        let cube = CUBE.replace("method = \"wcsph\"", method);
        let text = format!("{cube}surface_tension = \"{model}\"\nsupport_ratio = 3\n");
        splashdown::schemes::params(&parse(&text).expect("valid"), 0)
    };
    let [implicit, explicit] = ["dfsph", "wcsph"].map(|name| params(&format!("method = \"{name}\""), "csf"));
    assert!((implicit.tension_factor / explicit.tension_factor - 1.35).abs() < 1e-5);
    assert!(implicit.surface_completion > 0.1);
    assert_eq!(params("method = \"dfsph\"", "akinci2013").surface_completion, 0.0);
}

#[test]
fn bodies_that_surface_tension_does_not_wet_give_a_warning() {
    let warnings = |model: &str| {
        let text = format!("{CUBE}surface_tension = \"{model}\"\n[[body]]\n{PLAIN}\n");
        parse(&text).expect("valid").warnings.iter().map(ToString::to_string).collect::<String>()
    };
    assert!(warnings("csf").contains("not wetted"), "{}", warnings("csf"));
    assert!(!warnings("akinci2013").contains("not wetted"));
}

#[test]
fn paths_are_relative_to_the_folder_of_the_scene_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, with_body("name = \"a\"\nmesh = \"models/a.obj\"")).expect("written");
    let missing = Scene::load(&path).map(drop).expect_err("there is no such file").to_string();
    assert!(
        missing.contains("body[0].mesh: there is no file") && missing.contains("scene.toml:22"),
        "{missing}"
    );
    std::fs::create_dir(folder.path().join("models")).expect("a folder");
    std::fs::write(folder.path().join("models/a.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        .expect("written");
    let scene = Scene::load(&path).expect("valid");
    assert_eq!(scene.bodies[0].mesh.shape, MeshShape::File(folder.path().join("models/a.obj")));
}

/// The warnings of a scene in a file with this body, whose mesh may be a model.
fn warnings(domain: &str, body: &str) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.toml");
    let text = format!(
        "[scene]\nname = \"a\"\nduration = 2\nframe_rate = 10\n[domain]\nmin = [0, 0, 0]\nmax = [2, 1, 1]\n{domain}\n\
         [fluid]\nparticle_spacing = 0.05\n[[fluid.block]]\nposition = [0, 0, 0]\nsize = [1, 0.5, 1]\n\
         [[body]]\nname = \"b\"\nmesh = \"cube\"\n{body}\n"
    );
    std::fs::write(&path, text).unwrap();
    Scene::load(&path).unwrap().warnings.iter().map(ToString::to_string).collect()
}

#[test]
fn motion_that_jumps_or_is_too_fast_is_reported() {
    let scripted = |formula: &str| {
        let body = format!(
            "motion = \"scripted\"\nscale = 0.2\nposition = [1.5, 0.5, 0.5]\nmove = [{formula}, \"0\", \"0\"]"
        );
        warnings("", &body)
    };
    let jumps = scripted("\"0.2*floor(t)\"");
    assert!(
        jumps.iter().any(|text| text.contains("body \"b\" jumps by 0.2") && text.contains("at 1.0000 s")),
        "{jumps:?}"
    );
    // Control: a smooth motion.
    assert!(!scripted("\"0.2*sin(t)\"").iter().any(|text| text.contains("jumps")));
}

#[test]
fn keyframes_close_together_are_reported_as_a_fast_motion() {
    let keyframes = |later: f32| {
        let body = format!(
            "scale = 0.2\nposition = [1.5, 0.7, 0.5]\n[[body.keyframe]]\ntime = 0.3333\nposition = [1.5, 0.7, 0.5]\n\
             [[body.keyframe]]\ntime = {later}\nposition = [1.5, 0.3, 0.5]\n"
        );
        let fast = |text: &String| {
            text.contains("body \"b\" moves at up to") && text.contains("shortens the time step")
        };
        warnings("", &body).iter().any(fast)
    };
    // 0.4 m in a thousandth of a second, which is a part of the time between two of equally distributed samples.
    assert!(keyframes(0.3343));
    assert!(!keyframes(1.3));
}

#[test]
fn a_rotation_is_resolved_or_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    let load = |rate: u32| {
        let text = with_body(&format!(
            "{PLAIN}\nscale = 0.1\nposition = [0.5, 0.8, 0.5]\nturn = [\"0\", \"0\", \"360*50*t\"]"
        ));
        std::fs::write(&path, text.replace("frame_rate = 25", &format!("frame_rate = {rate}"))).unwrap();
        Scene::load(&path).map(drop).map_err(|errors| errors.to_string())
    };
    // 50 revolutions per second turn by 9.4 degrees in a 64th of a frame, or by 56.
    assert_eq!(load(30), Ok(()));
    let refused = load(5).unwrap_err();
    assert!(refused.contains("50.0 revolutions per second, 56 degrees"), "{refused}");
    assert!(refused.contains("frame_rate to at least 7"), "{refused}");
    assert_eq!(load(7), Ok(()));
}

#[test]
fn velocities_that_a_hinge_does_not_allow_are_reported() {
    let warned = |keys: &str| {
        let text = with_body(&format!(
            "{PLAIN}\nmotion = \"dynamic\"\nposition = [0.7, 0.6, 0.5]\nscale = 0.2\n{keys}"
        ));
        let scene = parse(&text).unwrap_or_else(|errors| panic!("{errors}"));
        scene.warnings.iter().map(|warning| format!("{warning}\n")).collect::<String>()
    };
    let both = warned("hinge = [0, 0, 2]\nvelocity = [0, 2, 0]\nangular_velocity = [3, 0, 1]");
    assert!(both.contains("velocity has no effect: the body has a hinge"), "{both}");
    assert!(both.contains("starts with 1.000 rad/s about it"), "{both}");
    // Controls: about the hinge, and without one.
    let about = warned("hinge = [0, 0, 2]\nangular_velocity = [0, 0, -1]");
    assert!(!about.contains("hinge"), "{about}");
    let free = warned("velocity = [0, 2, 0]\nangular_velocity = [3, 0, 1]");
    assert!(!free.contains("hinge"), "{free}");
}

#[test]
fn the_contact_of_solids_motors_and_scales_per_axis_are_read() {
    let full = body(&format!(
        "{PLAIN}\nmotion = \"dynamic\"\nscale = [1, \"cm\", 0.5]\ncontact_friction = 0.7\nrestitution = 0.9\n\
         hinge = [0, 0, 1]\nmotor_speed = -6\nmotor_torque = 40"
    ));
    assert_eq!(full.mesh.scale, Vec3::new(1.0, 0.01, 0.5));
    assert_eq!((full.contact.friction, full.contact.restitution), (0.7, 0.9));
    let Motion::Dynamic { hinge: Some(hinge), .. } = full.motion else { panic!("{full:?}") };
    assert_eq!(hinge.motor, Some(Motor { speed: -6.0, torque: Some(40.0) }));
    let dynamic = format!("{PLAIN}\nmotion = \"dynamic\"");
    for (keys, part) in [
        ("motor_speed = 3", "motor_speed is given without a hinge"),
        ("hinge = [0, 0, 1]\nmotor_torque = 3", "motor_torque is given without a speed"),
        ("scale = [1, 2]", "has 2 numbers"),
        ("scale = [1, 0, 2]", "scale[1]"),
        ("restitution = 1.5", "restitution"),
    ] {
        let refused = refusal(&format!("{dynamic}\n{keys}"));
        assert!(refused.contains(part), "{keys}: {refused}");
    }
}

#[test]
fn dynamic_bodies_that_do_not_fit_between_the_walls_are_reported() {
    let dynamic = |domain: &str, scale: f32, x: f32| {
        let body =
            format!("motion = \"dynamic\"\ndensity = 500\nscale = {scale}\nposition = [{x}, 0.6, 0.5]");
        warnings(domain, &body).into_iter().filter(|text| text.contains("wall")).collect::<Vec<_>>()
    };
    let large = dynamic("", 1.2, 1.0);
    assert!(large.iter().any(|text| text.contains("does not fit") && text.contains("along z")), "{large:?}");
    let beyond = dynamic("", 0.4, 1.9);
    assert!(beyond.iter().any(|text| text.contains("0.100 m into the wall x_max")), "{beyond:?}");
    assert_eq!(dynamic("", 0.4, 1.5), Vec::<String>::new());
    // There is no wall at an open side.
    assert_eq!(dynamic("open = [\"x_max\"]", 0.4, 1.9), Vec::<String>::new());
}

#[test]
fn a_piston_that_compresses_fluid_is_reported() {
    // The cube closes the cross-section of 1 m x 1 m and moves from x = 1 to x = `end`.
    let piston = |domain: &str, end: f32| {
        let stroke = 1.0 - end;
        let body = format!(
            "motion = \"scripted\"\nposition = [1.5, 0.5, 0.5]\nmove = [\"-{stroke}*min(t, 1)\", \"0\", \"0\"]"
        );
        warnings(domain, &body).into_iter().filter(|text| text.contains("closes")).collect::<Vec<_>>()
    };
    // Half of the volume is fluid.
    let closed = piston("", 0.4);
    assert!(
        closed.iter().any(|text| text.contains("at x_min") && text.contains("cannot escape")),
        "{closed:?}"
    );
    assert_eq!(piston("", 0.6), Vec::<String>::new());
    assert_eq!(piston("open = [\"y_max\"]", 0.4), Vec::<String>::new());
}

/// An open box that is filled in spite of its hole.
#[test]
fn an_open_fluid_mesh_can_be_filled() {
    let folder = tempfile::tempdir().unwrap();
    let mut cube = splashdown::models::build("cube").unwrap();
    // Without its top.
    cube.triangles.retain(|t| !t.iter().all(|&v| cube.vertices[v as usize][1] > 0.49));
    splashdown_io::write_mesh(&folder.path().join("open.obj"), &cube).unwrap();
    let load = |key: &str| {
        let text = format!(
            "[scene]\nname = \"a\"\nduration = 1\n[domain]\nmin = [-1, -1, -1]\nmax = [1, 1, 1]\n[fluid]\nparticle_spacing = 0.1\n\
             [[fluid.mesh]]\nmesh = \"open.obj\"\n{key}\n"
        );
        let path = folder.path().join("a.toml");
        std::fs::write(&path, text).unwrap();
        Scene::load(&path)
    };
    let refused = load("").unwrap_err().to_string();
    assert!(refused.contains("open edges") && refused.contains("shell = false"), "{refused}");
    assert_eq!(splashdown::check::count(&load("shell = false").unwrap()), 1000);
    let refused = load("shell = true").unwrap_err().to_string();
    assert!(refused.contains("encloses no volume"), "{refused}");
}

#[test]
fn dynamic_bodies_that_overlap_at_the_start_are_reported() {
    let second = |motion: &str, x: f32| {
        let body = format!(
            "motion = \"dynamic\"\ndensity = 500\nscale = 0.2\nposition = [1.5, 0.7, 0.5]\n\
             [[body]]\nname = \"c\"\nmesh = \"cube\"\nscale = 0.2\nposition = [{x}, 0.7, 0.5]\n{motion}"
        );
        warnings("", &body).into_iter().filter(|text| text.contains("overlaps body")).collect::<Vec<_>>()
    };
    let dynamic = "motion = \"dynamic\"\ndensity = 500";
    // Once, whatever the motion of the other one is.
    for motion in [dynamic, ""] {
        let found = second(motion, 1.6);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].contains("at the start"), "{found:?}");
    }
    // Control: cubes that touch, but for rounding.
    assert_eq!(second(dynamic, 1.6999), [""; 0]);
}

#[test]
fn bodies_in_shells_and_drums_and_on_axles_do_not_overlap() {
    let folder = tempfile::tempdir().unwrap();
    // A cube without its upper side.
    let open = "v -.5 -.5 -.5\nv .5 -.5 -.5\nv .5 -.5 .5\nv -.5 -.5 .5\nv -.5 .5 -.5\nv .5 .5 -.5\nv .5 .5 .5\nv -.5 .5 .5\n\
                f 1 2 3 4\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n";
    std::fs::write(folder.path().join("tank.obj"), open).unwrap();
    let overlaps = |ball: &str, other: &str| {
        let text = with_body(&format!(
            "name = \"ball\"\nmesh = \"sphere\"\nmotion = \"dynamic\"\ndensity = 500\nscale = 0.5\n{ball}\n[[body]]\nname = \"other\"\n{other}"
        ));
        let path = folder.path().join("scene.toml");
        std::fs::write(&path, text).unwrap();
        let scene = Scene::load(&path).unwrap_or_else(|errors| panic!("{errors}"));
        scene.warnings.iter().any(|warning| warning.to_string().contains("overlaps body"))
    };
    let at = |x: f32, y: f32| format!("position = [{x}, {y}, 0.5]");
    let tank = format!("mesh = \"tank.obj\"\nscale = 0.4\n{}", at(0.5, 0.7));
    assert!(!overlaps(&at(0.5, 0.6), &tank));
    let drum = format!("mesh = \"drum\"\nscale = 0.8\n{}", at(0.5, 0.7));
    assert!(!overlaps(&at(0.5, 0.7), &drum));
    let axle = format!("mesh = \"cube\"\nscale = 0.02\n{}", at(0.5, 0.7));
    let hinged = format!("{}\nhinge = [0, 0, 1]", at(0.5, 0.7));
    assert!(!overlaps(&hinged, &axle));
    // Controls: the same places with a solid, and without the hinge.
    assert!(overlaps(&at(0.5, 0.6), &tank.replace("tank.obj", "cube")));
    assert!(overlaps(&at(0.5, 0.7), &axle));
}

#[test]
fn gauges_deep_in_a_body_are_reported() {
    let gauge = |y: f32| {
        let body = format!(
            "scale = 0.4\nposition = [1, 0.3, 0.5]\n\
             [[probe]]\nname = \"p\"\nquantity = \"pressure\"\nposition = [1, {y}, 0.5]"
        );
        warnings("", &body).iter().any(|text| text.contains("probe \"p\" lies in body \"b\""))
    };
    assert!(gauge(0.3));
    // Control: at the surface, within a support radius below it, and above it.
    assert!(!gauge(0.5) && !gauge(0.42) && !gauge(0.6));
}
