//! The built-in scenes.

use std::path::{Path, PathBuf};

use splashdown::scene::{Derived, Method, Scene, presets};
use splashdown::{check, sample};

/// The folder of the scenes.
pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes")
}

#[test]
fn every_file_in_the_folder_is_a_preset_and_loads_without_a_warning() {
    let mut files: Vec<_> = std::fs::read_dir(folder())
        .expect("the folder of scenes")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|end| end == "toml"))
        .collect();
    files.sort();
    let mut known: Vec<_> = presets().iter().map(|(name, _)| folder().join(format!("{name}.toml"))).collect();
    known.sort();
    assert_eq!(files, known, "presets.rs lists the files of the folder");
    for (name, text) in presets() {
        let scene =
            Scene::load(folder().join(format!("{name}.toml"))).unwrap_or_else(|errors| panic!("{errors}"));
        assert_eq!(&scene.name, name, "a scene has the name of its file");
        assert!(scene.warnings.is_empty(), "{}", scene.warnings[0]);
        assert!(text.starts_with("# "), "{name} starts with a description");
        assert_eq!(
            {
                let mut changed = scene;
                changed.source = None;
                changed
            },
            Scene::parse(text, name).expect("the embedded text is valid")
        );
    }
}

#[test]
fn presets_have_the_promised_sizes() {
    let count = |name: &str| {
        let (_, text) = presets().iter().find(|(known, _)| *known == name).expect("a preset");
        let scene = Scene::parse(text, name).expect("a preset is valid");
        let particles = sample::particles(&scene).expect("a preset can be sampled");
        assert_eq!(check::count(&scene), particles.positions.len() as u64, "{name}");
        (particles.positions.len(), scene.solver.method)
    };
    assert_eq!(count("thesis-8k"), (8_192, Method::Mueller2003));
    assert_eq!(count("thesis-16k"), (16_384, Method::Mueller2003));
    assert_eq!(count("thesis-32k"), (32_768, Method::Mueller2003));
    assert_eq!(count("thesis-64k"), (65_536, Method::Mueller2003));
    assert_eq!(count("dam-break"), (66_560, Method::Dfsph));
    assert_eq!(count("dam-break-small"), (8_320, Method::Wcsph));
    assert_eq!(count("double-dam-break"), (42_500, Method::Wcsph));
    assert_eq!(count("falling-drop"), (25_000 + 2_176, Method::Wcsph));
    assert_eq!(count("sloshing-tank"), (15_600, Method::Wcsph));
    assert_eq!(count("lighthouse"), (63_000, Method::Dfsph));
    assert_eq!(count("floating"), (54_400, Method::Dfsph));
    assert_eq!(count("honey"), (7_168 + 2_176, Method::Dfsph));
}

#[test]
fn presets_run_in_reasonable_time() {
    for (name, text) in presets() {
        let derived = Derived::new(&Scene::parse(text, name).expect("a preset is valid"));
        let work = derived.steps_estimate * derived.particles;
        // 12 ms per step of 64K particles are 5.5 million particle-steps per second: 1.4e9 take four and a half minutes.
        assert!(work < 1_400_000_000, "{name}: {work} particle-steps");
    }
}
