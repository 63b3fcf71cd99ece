//! How a scene is drawn: camera, domain, liquid and colours, for the pictures of a run and for the window.

use splashdown::scene::{ColourBy, Derived, PictureQuality, Scene};
use splashdown_render::{Camera, Colouring, Domain, Liquid, Quality, Quantity};

/// The scene's camera at a simulated time in s.
pub fn camera(scene: &Scene, time: f64) -> Camera {
    let camera = &scene.camera;
    let azimuth = f64::from(camera.azimuth) + f64::from(camera.orbit_speed) * time;
    Camera::orbit(
        camera.target.into(),
        camera.distance,
        azimuth as f32,
        camera.elevation,
        camera.field_of_view,
    )
}

/// The scene's domain.
pub fn domain(scene: &Scene) -> Domain {
    let [[x0, x1], [y0, y1], [z0, z1]] = scene.domain.closed;
    Domain { min: scene.domain.min.into(), max: scene.domain.max.into(), closed: [x0, x1, y0, y1, z0, z1] }
}

/// The optical properties of the scene's fluid; those of water for an unknown material.
pub fn liquid(scene: &Scene) -> Liquid {
    Liquid::from_name(&scene.fluid.material.name).unwrap_or_else(Liquid::water)
}

/// How rays are traced for pictures of this quality; `None` without rays.
pub fn quality(scene: &Scene, quality: PictureQuality) -> Option<Quality> {
    match quality {
        PictureQuality::Interactive => None,
        PictureQuality::Standard => Some(Quality::STANDARD),
        PictureQuality::Final => {
            let mut best = Quality::FINAL;
            // A lens that leaves the domain nearly sharp.
            best.aperture = 0.006 * scene.camera.distance;
            // The shutter is open for half a frame (of the scene, which may be shown in slow motion).
            best.shutter = 0.5 / scene.frame_rate;
            Some(best)
        }
    }
}

/// Colours by this quantity. The range is the scene's if it sets one for this quantity, else the expected one. It is
/// the same in every frame, so that a film does not flicker.
pub fn colouring(scene: &Scene, colour_by: ColourBy) -> Colouring {
    let derived = Derived::new(scene);
    let density = scene.fluid.material.rest_density;
    let (quantity, expected) = match colour_by {
        ColourBy::Speed => (Quantity::Speed, [0.0, 0.7 * derived.reference_speed]),
        ColourBy::Density => (Quantity::Density, [0.97 * density, 1.03 * density]),
        ColourBy::Pressure => (Quantity::Pressure, [0.0, density * scene.gravity.length() * derived.head]),
    };
    let own = scene.output.colour_range.filter(|_| scene.output.colour_by == colour_by);
    Colouring::new(quantity, own.unwrap_or(expected))
}
