//! No file contents make the reader panic, hang or run out of memory.

use proptest::prelude::*;
use splashdown::scene::{Derived, Scene};
use splashdown::{check, sample};

use crate::{CUBE, changed, parse};

/// Malicious and careless values.
fn value() -> impl Strategy<Value = String> {
    let plain = [
        "nan",
        "-nan",
        "inf",
        "-inf",
        "1e300",
        "-1e300",
        "1e-300",
        "0",
        "-0.0",
        "-1",
        "9223372036854775807",
        "0x7fffffffffffffff",
        "99999999999999999999999999",
        "true",
        "\"\"",
        "\"water\"",
        "\"\\u0000\"",
        "[]",
        "[[]]",
        "{}",
        "[0, 0, 0]",
        "[1, nan, 1]",
        "[1e9, 1e9, 1e9]",
        "[1e-5, 1e-5, 1e-5]",
        "[1, 2, 3, 4]",
        "{ a = 1 }",
        "1979-05-27",
        "[\"y_max\"]",
        "[\"y_max\", \"y_max\"]",
        "1e-5",
        "0.05",
        "10",
    ];
    prop_oneof![
        proptest::sample::select(plain.to_vec()).prop_map(str::to_owned),
        any::<f64>().prop_map(|x| format!("{x:?}")),
        any::<i64>().prop_map(|x| x.to_string()),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 512, ..ProptestConfig::default() })]

    #[test]
    fn any_text_is_a_scene_or_an_error(text in any::<String>()) {
        if let Err(errors) = parse(&text) {
            prop_assert!(!errors.errors.is_empty());
            prop_assert!(!errors.to_string().is_empty());
        }
    }

    #[test]
    fn any_bytes_in_a_scene_are_accepted_or_rejected(at in 0..CUBE.len(), junk in proptest::collection::vec(any::<u8>(), 0..8)) {
        let mut bytes = CUBE.as_bytes().to_vec();
        bytes.splice(at..(at + junk.len()).min(CUBE.len()), junk);
        if let Err(errors) = parse(&String::from_utf8_lossy(&bytes)) {
            prop_assert!(!errors.errors.is_empty());
            prop_assert!(!errors.to_string().is_empty());
        }
    }

    #[test]
    fn any_value_of_any_key_is_accepted_or_rejected(line in 0..CUBE.lines().count(), value in value()) {
        let text: String = CUBE
            .lines()
            .enumerate()
            .map(|(index, text)| match text.split_once('=') {
                Some((key, _)) if index == line => format!("{key}= {value}\n"),
                _ => format!("{text}\n"),
            })
            .collect();
        match parse(&text) {
            Err(errors) => prop_assert!(!errors.errors.is_empty()),
            // Every accepted scene can be sampled.
            Ok(scene) if check::count(&scene) <= 1_000_000 => {
                let particles = sample::particles(&scene);
                prop_assert!(particles.is_ok(), "{particles:?}");
                let derived = Derived::new(&scene);
                prop_assert!(derived.particle_mass > 0.0 && derived.dt_estimate > 0.0);
            }
            Ok(_) => {}
        }
    }
}

#[test]
fn deep_nesting_is_rejected() {
    let text = format!("a = {}{}", "[".repeat(100_000), "]".repeat(100_000));
    assert!(parse(&text).is_err());
}

#[test]
fn thousands_of_errors_are_truncated_quickly() {
    let keys: String = (0..200_000).map(|i| format!("k{i}=1\n")).collect();
    let errors = parse(&format!("{keys}{CUBE}")).expect_err("none of these keys exist");
    assert!(errors.errors.len() <= 200, "{}", errors.errors.len());
    assert!(errors.to_string().len() < 40_000);
    // The same on one line: columns are not counted from the start of the line for each error.
    let line: String = (0..200_000).map(|i| format!("k{i}=1,")).collect();
    assert!(parse(&format!("a={{{line}}}\n{CUBE}")).is_err());
}

#[test]
fn thousands_of_blocks_are_rejected() {
    let block = "[[fluid.block]]\nposition = [0, 0, 0]\nsize = [0.5, 0.5, 0.5]\n";
    let errors = parse(&changed(block, &block.repeat(300))).expect_err("too many blocks").to_string();
    assert!(errors.contains("300 entries") && errors.contains("1 to 256"), "{errors}");
}

#[test]
fn the_sampler_rejects_invalid_scenes_built_in_code() {
    let scene = parse(CUBE).expect("the cube is valid");
    for spacing in [0.0, -1.0, f32::NAN, f32::INFINITY, 1e-30, 1e30] {
        let mut scene = scene.clone();
        scene.fluid.particle_spacing = spacing;
        assert!(sample::particles(&scene).is_err(), "a spacing of {spacing} gave particles");
        let _ = (check::count(&scene), Derived::new(&scene));
    }
    let mut outside: Scene = scene;
    outside.domain.max.x = 0.2;
    let error = sample::particles(&outside).expect_err("half of the cube is outside").to_string();
    assert!(error.contains("block 0 reaches outside"), "{error}");
}
