//! The built-in scenes.

macro_rules! presets {
    ($($name:literal),+ $(,)?) => {
        /// Name and text of every built-in scene. The first one is the demo.
        pub fn presets() -> &'static [(&'static str, &'static str)] {
            &[$(($name, include_str!(concat!("../../scenes/", $name, ".toml")))),+]
        }
    };
}

presets![
    "dam-break",
    "dam-break-small",
    "double-dam-break",
    "falling-drop",
    "sloshing-tank",
    "honey",
    "honey-coil",
    "lighthouse",
    "knot",
    "floating",
    "boat",
    "cup",
    "thin-cup",
    "drum",
    "paddle-wheel",
    "spheric2",
    "thesis-8k",
    "thesis-16k",
    "thesis-32k",
    "thesis-64k",
];
