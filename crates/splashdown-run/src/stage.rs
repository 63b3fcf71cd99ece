//! Camera, box, liquid and colouring of a scene, as the pictures of a run and the window draw them.

use splashdown::scene::{ColourBy, Derived, Scene};
use splashdown_render::{Camera, Colouring, Domain, Liquid, Quantity};

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

/// The scene's box.
pub fn domain(scene: &Scene) -> Domain {
    let [[x0, x1], [y0, y1], [z0, z1]] = scene.domain.closed;
    Domain { min: scene.domain.min.into(), max: scene.domain.max.into(), closed: [x0, x1, y0, y1, z0, z1] }
}

/// How the scene's fluid looks; one that is not known looks like water.
pub fn liquid(scene: &Scene) -> Liquid {
    let size = scene.domain.size();
    let tint = size.y.min(0.5 * size.x.max(size.z));
    Liquid::from_name(&scene.fluid.material.name, tint).unwrap_or_else(|| Liquid::water(tint))
}

/// Colours by this quantity over the range of the scene, if it is the scene's own quantity and has one, or over
/// the one to expect: the same in every frame, so that a film does not flicker.
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
