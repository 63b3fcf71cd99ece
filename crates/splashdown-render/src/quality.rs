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
    /// Time in seconds for which the shutter is open, around the time of the frame: droplets, foam and spray move by
    /// their velocities. Liquid and bodies move if the samples are drawn from [several
    /// frames](crate::Offscreen::submit_samples). 0: nothing moves.
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

    /// The time of a sample in seconds, relative to that of the frame. It grows with the index, so that samples that follow
    /// one another show nearly the same moment.
    pub fn time(&self, index: u32) -> f32 {
        self.shutter * ((index as f32 + 0.5) / self.samples.max(1) as f32 - 0.5)
    }

    /// Where sample `index` lies in the pixel (from -0.5 to 0.5) and on the lens (from -1 to 1, inside the unit circle).
    pub(crate) fn place(index: u32) -> ([f32; 2], [f32; 2]) {
        // A sequence of low discrepancy in four dimensions (Roberts, "The unreasonable effectiveness
        // of quasirandom sequences", 2018): powers of the root of x^5 = x + 1.
        const ROOT: f64 = 1.167_303_978_261_418_7;
        let coordinate = |dimension: i32| (0.5 + f64::from(index) * ROOT.powi(-dimension)).fract() as f32;
        let pixel = [coordinate(1) - 0.5, coordinate(2) - 0.5];
        let (angle, radius) = (std::f32::consts::TAU * coordinate(3), coordinate(4).sqrt());
        (pixel, [radius * angle.cos(), radius * angle.sin()])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_cover_pixel_lens_and_shutter_evenly() {
        let count = 256;
        let places: Vec<_> = (0..count).map(Quality::place).collect();
        let quarter = |p: &&([f32; 2], [f32; 2])| p.0[0] < 0.0 && p.0[1] >= 0.0;
        let inside = places.iter().filter(quarter).count();
        assert!((56..=72).contains(&inside), "{inside} of {count} in a quarter of the pixel");
        let inner = places.iter().filter(|p| p.1[0].hypot(p.1[1]) < 0.5_f32.sqrt()).count();
        assert!((112..=144).contains(&inner), "{inner} of {count} in the inner half of the lens");
        // Also those of a part of the time.
        let inside = places[64..128].iter().filter(quarter).count();
        assert!((14..=18).contains(&inside), "{inside} of 64 in a quarter of the pixel");
        let quality = Quality { samples: count, shutter: 0.5, ..Quality::FINAL };
        let times: Vec<f32> = (0..count).map(|i| quality.time(i)).collect();
        let mean: f32 = times.iter().sum::<f32>() / count as f32;
        assert!(
            mean.abs() < 1e-4 && times.is_sorted() && times.iter().all(|time| time.abs() < 0.25),
            "{mean}"
        );
    }

    #[test]
    fn the_first_sample_is_in_the_middle_of_the_pixel() {
        assert_eq!(Quality::place(0).0, [0.0, 0.0]);
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
