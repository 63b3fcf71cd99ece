//! The sky: the light from above and its appearance.

use glam::Vec3;

use crate::RenderError;
use crate::globals::Globals;

/// Light of the sun and of the sky, and the colours of what is far away.
///
/// All colours are linear red, green and blue. A light of 1 gives a white diffuse surface the colour 1.
/// The direction to the sun is [`Frame::sun`](crate::Frame::sun).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Sky {
    /// Light from straight above.
    pub zenith: [f32; 3],
    /// Light from just above the horizon.
    pub horizon: [f32; 3],
    /// Light of the sun on a surface that faces it; zeros for a sky without a sun.
    pub sun_light: [f32; 3],
    /// Light of the whole sky on a horizontal surface.
    pub sky_light: [f32; 3],
    /// Light that is added near the horizon on the side of the sun.
    pub glow: [f32; 3],
    /// Light from the distant ground.
    pub haze: [f32; 3],
    /// Light from the distant hills.
    pub hills: [f32; 3],
    /// Height of the hills, as a factor on their usual height of a few degrees; 0: no hills.
    pub hill_height: f32,
    /// Light from the clouds.
    pub clouds: [f32; 3],
    /// Opacity of the clouds, from 0 to 1.
    pub cloud_opacity: f32,
    /// Added to the fraction of the sky that has clouds; 0: scattered clouds, 0.5: everywhere.
    pub cloud_cover: f32,
}

impl Sky {
    /// A blue sky with scattered clouds.
    pub fn day() -> Sky {
        Sky {
            zenith: [0.10, 0.27, 0.66],
            horizon: [0.86, 1.02, 1.20],
            sun_light: [2.50, 2.26, 1.88],
            sky_light: [0.42, 0.54, 0.74],
            glow: [0.0; 3],
            haze: [0.33, 0.41, 0.49],
            hills: [0.21, 0.29, 0.37],
            hill_height: 1.0,
            clouds: [1.30, 1.28, 1.25],
            cloud_opacity: 0.75,
            cloud_cover: 0.0,
        }
    }

    /// A grey sky, fully clouded and without a sun.
    pub fn overcast() -> Sky {
        Sky {
            zenith: [0.62, 0.66, 0.72],
            horizon: [1.02, 1.05, 1.08],
            sun_light: [0.0; 3],
            sky_light: [1.02, 1.08, 1.14],
            haze: [0.46, 0.49, 0.52],
            hills: [0.34, 0.37, 0.40],
            clouds: [1.02, 1.05, 1.09],
            cloud_opacity: 0.55,
            cloud_cover: 0.22,
            ..Sky::day()
        }
    }

    /// An orange horizon below a dark blue sky, for a low sun.
    pub fn sunset() -> Sky {
        Sky {
            zenith: [0.07, 0.13, 0.34],
            horizon: [0.78, 0.40, 0.26],
            sun_light: [2.60, 1.05, 0.34],
            // The integral of what is drawn, weighted by the cosine, with the glow around the sun.
            sky_light: [0.36, 0.24, 0.33],
            glow: [1.00, 0.34, 0.06],
            haze: [0.30, 0.20, 0.19],
            hills: [0.10, 0.075, 0.095],
            clouds: [1.00, 0.46, 0.30],
            ..Sky::day()
        }
    }

    /// An even white background without hills and clouds, for figures.
    pub fn studio() -> Sky {
        Sky {
            zenith: [0.80, 0.82, 0.84],
            horizon: [1.15, 1.15, 1.15],
            sun_light: [1.15, 1.13, 1.10],
            sky_light: [0.60, 0.60, 0.61],
            haze: [1.15, 1.15, 1.15],
            hills: [1.15, 1.15, 1.15],
            hill_height: 0.0,
            cloud_opacity: 0.0,
            ..Sky::day()
        }
    }

    /// The same sky with other colours at the zenith and at the horizon. Its light, its clouds, the
    /// distant ground and the hills change with them.
    #[must_use]
    pub fn with_gradient(self, zenith: [f32; 3], horizon: [f32; 3]) -> Sky {
        let changed = Sky { zenith, horizon, ..self };
        let (old, new) = (self.mean(), changed.mean());
        let ratio = |new: Vec3, old: Vec3| luminance(new) / luminance(old).max(1e-3);
        let far = ratio(horizon.into(), self.horizon.into());
        let near = ratio(new, old);
        let scaled = |colour: [f32; 3], factor: f32| colour.map(|part| part * factor);
        // What the gradient does not explain is light from the clouds.
        let from_clouds = Vec3::from(self.sky_light) - old;
        Sky {
            sky_light: (new + near * from_clouds).max(Vec3::ZERO).into(),
            clouds: scaled(self.clouds, near),
            haze: scaled(self.haze, far),
            hills: scaled(self.hills, far),
            ..changed
        }
    }

    /// The mean of the gradient, weighted by the cosine: `sky` in environment.wgsl, integrated.
    fn mean(&self) -> Vec3 {
        const HORIZON: f32 = 0.1045;
        HORIZON * Vec3::from(self.horizon) + (1.0 - HORIZON) * Vec3::from(self.zenith)
    }

    /// Light on the floor in this direction of the sun, without shadows.
    pub(crate) fn on_floor(&self, sun: Vec3) -> Vec3 {
        Vec3::from(self.sun_light) * sun.y + Vec3::from(self.sky_light)
    }

    /// Light from white foam that lies flat, whose bubbles take a part of the sunlight from each other.
    pub(crate) fn on_foam(&self, sun: Vec3) -> Vec3 {
        0.86 * Vec3::from(self.sky_light) + 0.62 * sun.y * Vec3::from(self.sun_light)
    }

    /// Checks the values and writes the uniforms.
    pub(crate) fn fill(&self, globals: &mut Globals) -> Result<(), RenderError> {
        let Sky { zenith, horizon, sun_light, sky_light, glow, haze, hills, clouds, .. } = *self;
        let colours = [zenith, horizon, sun_light, sky_light, glow, haze, hills, clouds];
        let mut numbers = colours.into_iter().flatten().chain([self.hill_height]);
        let is_valid = numbers.all(|x| x.is_finite() && x >= 0.0)
            && (0.0..=1.0).contains(&self.cloud_opacity)
            && (-1.0..=1.0).contains(&self.cloud_cover);
        if !is_valid {
            return Err(RenderError::Value {
                what: "the sky",
                given: format!("{self:?}"),
                allowed: "finite non-negative numbers, a cloud_opacity of 0 to 1, a cloud_cover of -1 to 1",
            });
        }
        globals.zenith = zenith;
        globals.horizon = horizon;
        globals.sun_light = sun_light;
        globals.sky_light = sky_light;
        globals.glow = glow;
        globals.haze = haze;
        globals.hills = hills;
        globals.hill_height = self.hill_height;
        globals.clouds = clouds;
        globals.cloud_opacity = self.cloud_opacity;
        globals.cloud_cover = self.cloud_cover;
        Ok(())
    }
}

/// The luminance of a linear colour (Rec. 709).
fn luminance(colour: Vec3) -> f32 {
    colour.dot(Vec3::new(0.2126, 0.7152, 0.0722))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_is_the_integral_of_the_gradient() {
        let sky = Sky::day();
        let steps = 100_000;
        let mut sum = Vec3::ZERO;
        for i in 0..steps {
            let y = (i as f32 + 0.5) / steps as f32;
            let towards_zenith = 1.0 - (-4.2 * y).exp();
            sum += Vec3::from(sky.horizon).lerp(sky.zenith.into(), towards_zenith) * 2.0 * y / steps as f32;
        }
        assert!(sum.abs_diff_eq(sky.mean(), 2e-3), "{sum} {}", sky.mean());
        assert!(!sum.abs_diff_eq(Sky::sunset().mean(), 2e-3), "negative control");
    }

    #[test]
    fn the_light_follows_the_gradient() {
        let day = Sky::day();
        let same = day.with_gradient(day.zenith, day.horizon);
        assert!(Vec3::from(same.sky_light).abs_diff_eq(day.sky_light.into(), 1e-6));
        let red = day.with_gradient([0.66, 0.05, 0.05], day.horizon);
        assert!(red.sky_light[0] > day.sky_light[0] && red.sky_light[2] < day.sky_light[2]);
        assert_eq!(red.haze, day.haze, "the horizon is the same");
        let night = day.with_gradient([0.02, 0.02, 0.06], [0.1, 0.12, 0.2]);
        let [r, g, b] = night.sky_light;
        assert!(b > r && b > g && b < 0.1, "{:?}", night.sky_light);
    }

    #[test]
    fn a_negative_light_is_refused() {
        let sky = Sky { sky_light: [0.1, -0.1, 0.1], ..Sky::day() };
        assert!(sky.fill(&mut Globals::default()).is_err());
        assert!(Sky::day().fill(&mut Globals::default()).is_ok());
    }
}
