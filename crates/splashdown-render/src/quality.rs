//! How carefully rays are traced.

use crate::RenderError;

/// How carefully a picture with [traced rays](crate::Frame::with_tracing) is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Quality {
    /// Samples per pixel, 1 to 4096. The time is proportional to it.
    pub samples: u32,
    /// Diameter of the lens in metres. 0: everything is in focus.
    pub aperture: f32,
    /// Distance in metres along the view at which the picture is in focus. `None`: the target of
    /// the camera.
    pub focus: Option<f32>,
    /// Time in seconds for which the shutter is open, around the time of the frame: foam and spray
    /// move by their velocities. 0: nothing moves.
    pub shutter: f32,
}

impl Quality {
    /// Four samples.
    pub const STANDARD: Quality = Quality { samples: 4, aperture: 0.0, focus: None, shutter: 0.0 };

    /// 64 samples. Set a lens and a shutter for depth of field and motion blur.
    pub const FINAL: Quality = Quality { samples: 64, ..Quality::STANDARD };

    pub(crate) fn check(&self) -> Result<(), RenderError> {
        let positive = |x: f32| x.is_finite() && x >= 0.0;
        let valid = (1..=4096).contains(&self.samples)
            && positive(self.aperture)
            && self.focus.is_none_or(|focus| positive(focus) && focus > 0.0)
            && positive(self.shutter);
        if valid {
            return Ok(());
        }
        Err(RenderError::Value {
            what: "the quality of the picture",
            given: format!("{self:?}"),
            allowed: "1 to 4096 samples, a positive focus, and a finite aperture and shutter of at least 0",
        })
    }

    /// Where sample `index` lies in the pixel (from -0.5 to 0.5), on the lens (from -1 to 1, inside
    /// the unit circle) and in the time of the shutter (from -0.5 to 0.5).
    pub(crate) fn place(&self, index: u32) -> ([f32; 2], [f32; 2], f32) {
        // A sequence of low discrepancy in five dimensions (Roberts, "The unreasonable effectiveness
        // of quasirandom sequences", 2018): powers of the root of x^6 = x + 1.
        const ROOT: f64 = 1.134_724_138_401_519_4;
        let coordinate = |dimension: i32| (0.5 + f64::from(index) * ROOT.powi(-dimension)).fract() as f32;
        let pixel = [coordinate(1) - 0.5, coordinate(2) - 0.5];
        let (angle, radius) = (std::f32::consts::TAU * coordinate(3), coordinate(4).sqrt());
        (pixel, [radius * angle.cos(), radius * angle.sin()], coordinate(5) - 0.5)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_cover_pixel_lens_and_shutter_evenly() {
        let count = 256;
        let places: Vec<_> = (0..count).map(|i| Quality::FINAL.place(i)).collect();
        let quarter = |p: &&([f32; 2], [f32; 2], f32)| p.0[0] < 0.0 && p.0[1] >= 0.0;
        let inside = places.iter().filter(quarter).count();
        assert!((56..=72).contains(&inside), "{inside} of {count} in a quarter of the pixel");
        let inner = places.iter().filter(|p| p.1[0].hypot(p.1[1]) < 0.5_f32.sqrt()).count();
        assert!((112..=144).contains(&inner), "{inner} of {count} in the inner half of the lens");
        let mean: f32 = places.iter().map(|p| p.2).sum::<f32>() / count as f32;
        assert!(mean.abs() < 0.02 && places.iter().all(|p| p.2.abs() <= 0.5), "{mean}");
    }

    #[test]
    fn the_first_sample_is_in_the_middle_of_the_pixel() {
        assert_eq!(Quality::STANDARD.place(0).0, [0.0, 0.0]);
    }

    #[test]
    fn invalid_values_are_refused() {
        assert!(Quality::STANDARD.check().is_ok());
        for wrong in [
            Quality { samples: 0, ..Quality::STANDARD },
            Quality { aperture: -1.0, ..Quality::STANDARD },
            Quality { focus: Some(0.0), ..Quality::STANDARD },
            Quality { shutter: f32::NAN, ..Quality::STANDARD },
        ] {
            assert!(wrong.check().is_err(), "{wrong:?}");
        }
    }
}
