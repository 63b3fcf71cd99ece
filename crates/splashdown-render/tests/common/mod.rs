//! Shared by the picture tests: a device or a reported skip, and the comparison with reference
//! pictures.

#![expect(dead_code, reason = "each test binary uses its own part of this module")]

pub mod sample;

use splashdown_gpu::{DeviceRequest, Gpu};
use splashdown_render::*;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A device and a renderer.
pub struct Harness {
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    pub renderer: Renderer,
}

/// Opens a device, or reports that the test is skipped. In CI a missing driver is a failure.
pub fn harness() -> Option<Harness> {
    match Gpu::open(&DeviceRequest::Auto) {
        Ok(Gpu { device, queue, .. }) => {
            // `Gpu` records errors; here they fail the test at once.
            device.on_uncaptured_error(Arc::new(|error| panic!("{error}")));
            let renderer = Renderer::new(&device, &queue, Offscreen::FORMAT, 4).unwrap();
            Some(Harness { device, queue, renderer })
        }
        Err(error) => {
            assert!(std::env::var("CI").is_err(), "CI must have a Vulkan driver: {error}");
            eprintln!("SKIPPED: {error}");
            None
        }
    }
}

impl Harness {
    pub fn draw(&mut self, size: [u32; 2], frame: &Frame<'_>) -> Picture {
        let mut target = Offscreen::new(&self.device, &self.queue, size).unwrap();
        Picture { size, rgba: target.render_to_rgba(&mut self.renderer, frame).unwrap() }
    }
}

/// A copy of a value with a change.
pub fn with<T>(mut value: T, change: impl FnOnce(&mut T)) -> T {
    change(&mut value);
    value
}

/// RGBA bytes and the size of the picture.
pub struct Picture {
    pub size: [u32; 2],
    pub rgba: Vec<u8>,
}

/// The difference of two pictures.
#[derive(Debug, Clone, Copy)]
pub struct Difference {
    /// Mean over pixels and channels, from 0 to 255.
    pub mean: f64,
    /// Fraction of the pixels that differ by more than 24 of 255 in some channel.
    pub fraction: f64,
}

impl Difference {
    /// Drivers round differently and may shift an outline by half a pixel, which is well below
    /// these bounds. A camera moved by two degrees is well above, as each test verifies.
    pub fn is_small(&self) -> bool {
        self.mean < 1.0 && self.fraction < 0.012
    }
}

impl Picture {
    pub fn pixel(&self, [x, y]: [u32; 2]) -> [u8; 3] {
        let at = 4 * (y * self.size[0] + x) as usize;
        [self.rgba[at], self.rgba[at + 1], self.rgba[at + 2]]
    }

    pub fn difference(&self, other: &Picture) -> Difference {
        assert_eq!(self.size, other.size);
        let pairs = || self.rgba.chunks_exact(4).zip(other.rgba.chunks_exact(4));
        let far = |(a, b): (&[u8], &[u8])| a.iter().zip(b).any(|(a, b)| a.abs_diff(*b) > 24);
        let sum: u64 = self.rgba.iter().zip(&other.rgba).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
        Difference {
            mean: sum as f64 / self.rgba.len() as f64,
            fraction: pairs().filter(|pair| far(*pair)).count() as f64 / pairs().count() as f64,
        }
    }

    fn load(path: &Path) -> Option<Picture> {
        let image = image::open(path).ok()?.into_rgba8();
        Some(Picture { size: [image.width(), image.height()], rgba: image.into_raw() })
    }

    fn save(&self, path: &Path) {
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        // Alpha is 255 everywhere; omitting it makes the files smaller.
        let rgb: Vec<u8> =
            self.rgba.chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
        image::save_buffer(path, &rgb, self.size[0], self.size[1], image::ExtendedColorType::Rgb8).unwrap();
    }

    /// Compares with the reference picture of a name; `UPDATE_EXPECT=1` replaces the reference.
    pub fn expect(&self, name: &str) {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let reference_path = root.join("tests/reference").join(format!("{name}.png"));
        if std::env::var_os("UPDATE_EXPECT").is_some_and(|value| value == "1") {
            self.save(&reference_path);
            return;
        }
        let actual_path: PathBuf = root.join("../../target/pictures").join(format!("{name}.png"));
        let advice = format!(
            "compare {} with {}; if the new picture is correct, run the test with UPDATE_EXPECT=1",
            actual_path.display(),
            reference_path.display()
        );
        let Some(reference) = Picture::load(&reference_path) else {
            self.save(&actual_path);
            panic!("the reference picture is missing; {advice}");
        };
        let difference = self.difference(&reference);
        if !difference.is_small() {
            self.save(&actual_path);
            panic!("{name} differs ({difference:?}); {advice}");
        }
    }
}
