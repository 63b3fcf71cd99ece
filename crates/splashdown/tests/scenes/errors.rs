//! The message of every kind of error, as snapshots. After an intended change, run `INSTA_UPDATE=always cargo test -p
//! splashdown --test scenes` and review the difference.

use std::fs;

use splashdown::scene::Scene;

use crate::{CUBE, changed, parse};

/// Errors of a text, as printed; with the warnings if it is valid.
fn words(text: &str) -> String {
    match parse(text) {
        Err(errors) => errors.to_string(),
        Ok(scene) => scene.warnings.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n\n"),
    }
}

macro_rules! snapshot {
    ($test:ident, $text:expr) => {
        #[test]
        fn $test() {
            insta::assert_snapshot!(words(&$text));
        }
    };
}

snapshot!(empty_file, " \n");
snapshot!(not_toml, changed("duration = 1.0", "duration = = 1.0\nname = \"again"));
snapshot!(duplicate_key, changed("duration = 1.0", "duration = 1.0\nduration = 2.0"));
snapshot!(missing_sections, "[scene]\nname = \"a\"\n");
snapshot!(
    unknown_keys,
    changed("frame_rate", "fps")
        .replace("method", "mehtod")
        .replace("[domain]", "[domain]\ngravity = [0, 0, 0]")
);
snapshot!(unknown_sections, format!("{CUBE}\n[solvr]\n[block]\n[weather]\n"));
snapshot!(
    wrong_types,
    changed("1.0", "\"1.0\"").replace("[1, 1, 1]", "1").replace("0.05", "true").replace("\"wcsph\"", "7")
);
snapshot!(text_with_a_unit, changed("0.05", "\"5 cm\""));
snapshot!(not_finite, changed("0.05", "nan").replace("1.0", "inf").replace("[1, 1, 1]", "[1, -inf, 1]"));
snapshot!(
    out_of_range,
    changed("0.05", "-0.05").replace("1.0", "1e300").replace("[1, 1, 1]", "[1, 1, 123456789]")
);
snapshot!(wrong_words, changed("\"wcsph\"", "\"WCSPH\"\nkernel = \"cubic-spline\"\nsort = \"quick\""));
snapshot!(
    wrong_lists,
    changed("[1, 1, 1]", "[1, 1]\nopen = \"y_max\"")
        + "[output]\nformats = [\"ply\", \"ply\"]\npictures = [\"film\"]\n"
);
snapshot!(
    several_wrong_items,
    changed("[1, 1, 1]", "[nan, \"1\", -1e9]\nopen = [\"y_max\", \"y-min\", \"y_max\", 3]")
);
snapshot!(outside_the_domain, changed("position = [0, 0, 0]", "position = [0.6, -0.1, 0]"));
snapshot!(far_too_many_particles, changed("0.05", "0.0005"));
snapshot!(too_fine_for_the_domain, changed("0.05", "0.0005").replace("0.5, 0.5, 0.5", "0.1, 0.1, 0.1"));
snapshot!(
    too_far_from_the_origin,
    changed("min = [0, 0, 0]\nmax = [1, 1, 1]", "min = [9000, 0, 0]\nmax = [9001, 1, 1]")
);
snapshot!(no_particles, changed("[0.5, 0.5, 0.5]", "[0.5, 0.02, 0.5]"));
snapshot!(inside_out_domain, changed("[1, 1, 1]", "[1, -1, 1]"));
snapshot!(thin_domain, changed("[1, 1, 1]", "[1, 1, 0.1]"));
snapshot!(no_blocks, changed("[[fluid.block]]\nposition = [0, 0, 0]\nsize = [0.5, 0.5, 0.5]\n", ""));
snapshot!(block_without_list, changed("[[fluid.block]]", "[fluid.block]"));
snapshot!(block_of_two_shapes, changed("position = [0, 0, 0]", "shape = \"sphere\"\nradius = 0.1"));
snapshot!(min_dt_above_max_dt, format!("{CUBE}min_dt = 0.01\n"));
snapshot!(min_dt_above_the_stable_step, format!("{CUBE}sound_speed = 10\nmin_dt = 4e-3\n"));
snapshot!(too_many_frames, changed("duration = 1.0", "duration = 3600").replace("25", "1000"));
snapshot!(
    contradictions,
    changed(
        "\"wcsph\"",
        "\"mueller2003\"\nsurface_tension = \"akinci2013\"\ndensity = \"continuity\"\nkernel = \"cubic_spline\"\nstiffness = 3\nsound_speed = 10"
    )
);
snapshot!(
    implicit_tolerances,
    changed("\"wcsph\"", "\"dfsph\"\ntolerance = 0\nmax_iterations = 1\ncfl_factor = 1.5\nsound_speed = 20")
);
snapshot!(implicit_keys, changed("\"wcsph\"", "\"dfsph\"\nsound_speed = 20\ndensity = \"continuity\""));
snapshot!(implicit_step, changed("\"wcsph\"", "\"dfsph\"\nmax_dt = 0.1"));
snapshot!(tolerance_without_iterations, format!("{CUBE}tolerance = 0.001\n"));
snapshot!(narrow_surface_force, format!("{CUBE}surface_tension = \"csf\"\nsupport_ratio = 2\n"));
snapshot!(contact_angle_out_of_range, format!("{CUBE}surface_tension = \"csf\"\ncontact_angle = 60\n"));
snapshot!(ignored_contact_angle, format!("{CUBE}contact_angle = 120\n"));
snapshot!(
    contact_angle_without_sides,
    changed(
        "[1, 1, 1]",
        "[1, 1, 1]\nopen = [\"x_min\", \"x_max\", \"y_min\", \"y_max\", \"z_min\", \"z_max\"]"
    ) + "surface_tension = \"csf\"\ncontact_angle = 120\n"
);
snapshot!(ignored_diffusion, format!("{CUBE}density_diffusion = 0.2\nsurface_tension = \"mueller2003\"\n"));
snapshot!(
    output_without_surface,
    format!(
        "{CUBE}[surface]\nenabled = false\n[output]\npictures = [\"surface\"]\nformats = [\"obj\"]\npicture_size = [101, 100]\ncolour_range = [2, 1]\n"
    )
);
snapshot!(film_of_large_pictures, format!("{CUBE}[output]\npicture_size = [12000, 8000]\n"));
snapshot!(too_many_pixels, format!("{CUBE}[output]\nfilm = false\npicture_size = [32768, 8193]\n"));
snapshot!(film_without_pictures, format!("{CUBE}[output]\npictures = []\nfilm = true\n"));
snapshot!(
    foam_the_wrong_way_round,
    format!(
        "{CUBE}[foam]\nenabled = true\ntrapped_air_limits = [0.3, 0.1]\nwave_crest_limits = [0.2, 0.2]\nspeed_limits = [1, 0]\nlifetime = [5, 2]\n"
    )
);
snapshot!(coarse_surface, format!("{CUBE}[surface]\ncell_size = 0.5\n"));
snapshot!(coarse_surface_warning, format!("{CUBE}[surface]\ncell_size = 0.08\n"));
snapshot!(
    picture_values,
    format!(
        "{CUBE}[picture]\nsky = \"sunrise\"\nsun = \"no\"\nsun_elevation = 2\nfloor_color = [1, 1, 1]\nfloor_colour = [255, 255, 255]\n\
         absorption = 0.3\nscattering = -1\ncaption = \"two\\nlines\"\n"
    )
);
snapshot!(
    picture_warnings,
    format!(
        "{CUBE}[picture]\nsky = \"overcast\"\nsun_azimuth = 90\nfloor = \"none\"\nfloor_colour = [0, 0, 0]\nliquid = \"oil\"\n\
         liquid_colour = [0, 1, 0]\n"
    )
);
snapshot!(unusable_name, changed("\"cube\"", "\"../cube\""));
snapshot!(
    overlap_warning,
    format!("{CUBE}[[fluid.block]]\nposition = [0.25, 0, 0]\nsize = [0.5, 0.5, 0.5]\n")
);
snapshot!(doubtful_values, changed("0.5, 0.5, 0.5", "0.52, 0.5, 0.5") + "sound_speed = 10\n");
snapshot!(long_line, changed("duration = 1.0", &format!("\"{}\" = 1{}", "k".repeat(300), " ".repeat(10))));
snapshot!(
    many_at_once,
    "\
[scene]
name = \"many\"
duration = -1
frame_rate = \"fast\"

[domain]
min = [0, 0, 0]
max = [1, 1, 1]
opn = [\"y_max\"]

[fluid]
particle_spacing = 0.05
material = \"watter\"
viscosity = -1.0

[[fluid.block]]
position = [0, 0, 0]
size = [0.5, 0.5, 0.5]
velocity = [0, nan, 0]

[[fluid.block]]
position = [0.5, 0, 0]
size = [2, 0.5, 0.5]

[solver]
cfl_factor = 5

[camera]
fov = 40
"
);

/// Errors of a file with these bytes, without the name of the folder.
fn words_of_file(name: &str, bytes: &[u8]) -> String {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join(name);
    fs::write(&path, bytes).expect("writing into a temporary folder");
    let errors = Scene::load(&path).expect_err("the file is not a scene").to_string();
    errors.replace(&folder.path().display().to_string(), "FOLDER").replace('\\', "/")
}

#[test]
fn files_that_are_no_scenes() {
    let all = [
        words_of_file("binary.toml", b"\x7fELF\0\0\0\x01"),
        words_of_file("latin1.toml", b"[scene]\nname = \"Stra\xdfe\"\n"),
        words_of_file("huge.toml", &vec![b'#'; (4 << 20) + 1]),
    ];
    insta::assert_snapshot!(all.join("\n\n"));
}

#[test]
fn a_missing_file_and_a_folder_have_different_messages() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let missing =
        Scene::load(folder.path().join("none.toml")).expect_err("the file does not exist").to_string();
    assert!(
        missing.contains("cannot open the scene file") && missing.contains("splashdown scenes"),
        "{missing}"
    );
    let not_a_file = Scene::load(folder.path()).expect_err("a folder is not a scene").to_string();
    assert!(not_a_file.contains("this is a folder"), "{not_a_file}");
}

#[test]
fn a_loaded_scene_stores_its_folder_and_text() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("cube.toml");
    fs::write(&path, format!("\u{feff}{}", CUBE.replace('\n', "\r\n")))
        .expect("writing into a temporary folder");
    let scene = Scene::load(&path).expect("a byte order mark and Windows line ends are accepted");
    assert_eq!(scene.source.as_deref(), Some(path.as_path()));
    // The text is stored unchanged.
    assert!(scene.text.contains("\r\n"));
    let plain = parse(CUBE).expect("the cube is valid");
    assert_eq!(
        {
            let mut changed = scene;
            changed.source = None;
            changed.text = plain.text.clone();
            changed
        },
        plain
    );
}

#[test]
fn errors_have_line_numbers_and_are_sorted_by_them() {
    let text = changed("0.05", "-1").replace("duration = 1.0", "duration = 0").replace("\"wcsph\"", "\"x\"");
    let errors = parse(&text).expect_err("three values are wrong").errors;
    let places: Vec<_> = errors.iter().map(|error| (error.line, error.column, error.key.as_str())).collect();
    let expected = [
        (Some(3), Some(12), "scene.duration"),
        (Some(11), Some(20), "fluid.particle_spacing"),
        (Some(18), Some(10), "solver.method"),
    ];
    assert_eq!(places, expected);
    let json = serde_json::to_value(&errors[0]).expect("errors are plain data");
    assert_eq!(json["line"], 3);
    assert_eq!(json["given"], "0");
    assert!(json["allowed"].as_str().is_some_and(|allowed| allowed.contains("3600")));
}

/// Files of earlier versions stay valid; the warning names the present key.
#[test]
fn a_former_key_is_accepted_with_a_warning() {
    let oscillation = "oscillation = { amplitude = [0.1, 0, 0], period = 2.0 }";
    let present = changed("[domain]", &format!("[domain]\n{oscillation}"));
    let former = present.replace("oscillation", "shake");
    let [present, former] = [present, former].map(|text| parse(&text).unwrap());
    assert_eq!(present.domain, former.domain);
    assert!(present.warnings.is_empty(), "{:?}", present.warnings);
    let warning = former.warnings[0].to_string();
    assert!(warning.contains("domain.shake is deprecated"), "{warning}");
    assert!(warning.contains("write domain.oscillation"), "{warning}");
    // Both at once are an error.
    let both = oscillation.replace("oscillation", "shake");
    let errors = words(&changed("[domain]", &format!("[domain]\n{oscillation}\n{both}")));
    assert!(errors.contains("former name of domain.oscillation"), "{errors}");
}
