//! Shaders as data: which WGSL files make up each of them.

/// A shader of this crate: its files in the order in which they are put together.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shader {
    pub label: &'static str,
    pub parts: &'static [&'static str],
}

pub(crate) const GLOBALS: &str = include_str!("shared/globals.wgsl");
pub(crate) const ENVIRONMENT: &str = include_str!("shared/environment.wgsl");
pub(crate) const LIQUID: &str = include_str!("shared/liquid.wgsl");
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

    const ALL: [Shader; 20] = [
        crate::background::SHADER,
        crate::bodies::SHADER,
        crate::bodies::DISTANCE,
        crate::edges::SHADER,
        crate::particles::SHADER,
        crate::surface::THICKNESS,
        crate::surface::SHADER,
        crate::screen_space::SPLAT,
        crate::screen_space::AMOUNT,
        crate::screen_space::SMOOTH,
        crate::screen_space::CLEAN,
        crate::screen_space::COMPOSE,
        crate::surface::LINES,
        crate::slice::GATHER,
        crate::slice::SHADER,
        crate::shadow::FROM_SURFACE,
        crate::shadow::FROM_PARTICLES,
        crate::shadow::BLUR,
        crate::overlay::SHADER,
        crate::foam::SHADER,
    ];

    /// What is wrong with a shader, by naga, under the capabilities of a browser.
    fn fault(source: &str) -> Option<String> {
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
            if let Some(fault) = fault(&shader.source()) {
                panic!("{}: {fault}", shader.label);
            }
        }
        // Negative control: a type error is found.
        let broken =
            crate::background::SHADER.source().replace("let stretch = length(ray);", "let stretch = ray;");
        assert!(fault(&broken).is_some());
    }

    #[test]
    fn every_wgsl_on_disk_is_in_the_table() {
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
            ALL.len() + 6,
            "each shader has a file of its own, and six are shared: {files:?}"
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
