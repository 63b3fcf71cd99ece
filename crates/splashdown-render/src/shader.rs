//! The WGSL files of each shader.

/// A shader of this crate: its files in the order of their concatenation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shader {
    pub label: &'static str,
    pub parts: &'static [&'static str],
}

pub(crate) const EYE_DISTANCE: &str = include_str!("shared/eye_distance.wgsl");
pub(crate) const FULLSCREEN: &str = include_str!("shared/fullscreen.wgsl");
pub(crate) const GLOBALS: &str = include_str!("shared/globals.wgsl");
pub(crate) const ENVIRONMENT: &str = include_str!("shared/environment.wgsl");
pub(crate) const OPTICS: &str = include_str!("shared/optics.wgsl");
pub(crate) const MATTE: &str = include_str!("shared/matte.wgsl");
/// Stands in for [`SUNLIT`] without trees of triangles.
pub(crate) const LIT: &str = include_str!("shared/lit.wgsl");
pub(crate) const TRACE: &str = include_str!("tree/trace.wgsl");
/// Where bodies lie in the maps of the sunlight on them.
pub(crate) const SUN_LAYERS: &str = include_str!("trace/sun_layers.wgsl");
/// Sunlight on bodies, with [`TRACE`] and [`SUN_LAYERS`].
pub(crate) const SUNLIT: &str = include_str!("trace/sunlit.wgsl");
/// The path of light through liquid, with [`TRACE`].
pub(crate) const REFRACTED: &str = include_str!("trace/refracted.wgsl");
pub(crate) const LIQUID: &str = include_str!("shared/liquid.wgsl");
pub(crate) const PICTURE_BEHIND: &str = include_str!("shared/picture_behind.wgsl");
pub(crate) const QUANTITY: &str = include_str!("shared/quantity.wgsl");
pub(crate) const SPHERE: &str = include_str!("shared/sphere.wgsl");

impl Shader {
    pub fn source(&self) -> String {
        self.parts.concat()
    }

    pub fn module(&self, device: &wgpu::Device) -> wgpu::ShaderModule {
        device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(self.label),
            source: wgpu::ShaderSource::Wgsl(self.source().into()),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use naga::valid::{Capabilities, ValidationFlags, Validator};
    use std::path::{Path, PathBuf};

    const ALL: [Shader; 41] = [
        crate::background::SHADER,
        crate::bodies::SHADER,
        crate::bodies::DISTANCE,
        crate::edges::SHADER,
        crate::particles::SHADER,
        crate::surface::THICKNESS,
        crate::surface::deferred::NORMALS,
        crate::surface::deferred::COVER_ONE,
        crate::surface::deferred::COVER_FOUR,
        crate::surface::deferred::SHADE_ONE,
        crate::surface::deferred::SHADE_FOUR,
        crate::surface::deferred::OVER_SAMPLES,
        crate::scene_copy::SHADER,
        crate::screen_space::SPLAT,
        crate::screen_space::PARTICLE_THICKNESS,
        crate::screen_space::SMOOTH,
        crate::screen_space::CLEANUP,
        crate::screen_space::COMPOSE,
        crate::surface::LINES,
        crate::slice::GATHER,
        crate::slice::SHADER,
        crate::shadow::FROM_SURFACE,
        crate::shadow::FROM_PARTICLES,
        crate::shadow::BLUR,
        crate::overlay::SHADER,
        crate::shadow::ABSORB,
        crate::foam::SHADER,
        crate::foam::DEPTHS,
        crate::foam::OVER,
        crate::droplets::SHADER,
        crate::droplets::TRACED,
        crate::glass::SHADER,
        crate::bodies::TRACED,
        crate::trace::DEPTH,
        crate::trace::LIQUID,
        crate::trace::INSIDE,
        crate::trace::PHOTONS,
        crate::trace::SPLAT,
        crate::trace::FLOOR_SKY,
        crate::trace::ACCUMULATE,
        crate::trace::RESOLVE,
    ];

    /// The error that naga reports for a shader without optional capabilities, as in a browser.
    fn validation_error(source: &str) -> Option<String> {
        let module = match naga::front::wgsl::parse_str(source) {
            Ok(module) => module,
            Err(error) => return Some(error.emit_to_string(source)),
        };
        if module.entry_points.len() != 2 {
            return Some(format!("{} entry points", module.entry_points.len()));
        }
        let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
        validator.validate(&module).err().map(|error| error.emit_to_string(source))
    }

    #[test]
    fn naga_accepts_every_shader() {
        for shader in ALL {
            if let Some(error) = validation_error(&shader.source()) {
                panic!("{}: {error}", shader.label);
            }
        }
        // Negative control: a type error is reported.
        let broken = crate::background::SHADER
            .source()
            .replace("let ray_length = length(ray);", "let ray_length = ray;");
        assert!(validation_error(&broken).is_some());
    }

    #[test]
    fn every_wgsl_file_is_used() {
        fn wgsl_below(folder: &Path, found: &mut Vec<PathBuf>) {
            for entry in std::fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                if path.is_dir() {
                    wgsl_below(&path, found);
                } else if path.extension().is_some_and(|extension| extension == "wgsl") {
                    found.push(path);
                }
            }
        }
        let mut files = Vec::new();
        wgsl_below(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"), &mut files);
        assert_eq!(
            files.len(),
            ALL.len() + 18,
            "each shader has its own file, and eighteen more are shared: {files:?}"
        );
        for path in files {
            let text = std::fs::read_to_string(&path).unwrap();
            assert!(
                ALL.iter().any(|shader| shader.parts.contains(&text.as_str())),
                "{} is not used",
                path.display()
            );
        }
    }
}
