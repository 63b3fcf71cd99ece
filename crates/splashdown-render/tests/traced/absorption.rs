//! How much light liquid and wet surfaces leave.

use super::{SIZE, draw, height_of_sun, light, one_sample, slab, tank};
use crate::common::{self, with};
use splashdown_render::*;

#[test]
fn light_is_absorbed_along_the_path() {
    let Some(mut harness) = common::harness() else { return };
    // Straight down on a plate, through 0.4 m of liquid.
    let camera = Camera {
        eye: [1.0, 2.5, 0.5],
        target: [1.0, 0.0, 0.5],
        up: [0.0, 0.0, -1.0],
        field_of_view_deg: 30.0,
    };
    let plate = slab([0.6, 0.1, 0.2], [1.4, 0.2, 0.8]);
    let plate = PlacedBody::new(&plate.vertices, &plate.triangles, [0.5; 3]).unwrap();
    let mut seen = |per_metre: f32| {
        let liquid = with(Liquid::water(), |l| l.absorption = [per_metre; 3]);
        let picture = draw(&mut harness, &tank(), liquid, Some(&plate), camera, one_sample());
        light(picture.pixel([SIZE[0] / 2, SIZE[1] / 2])[1])
    };
    // What the surface reflects does not pass the liquid.
    let reflected = seen(400.0);
    let clear = seen(0.0) - reflected;
    let measured = (seen(1.5) - reflected) / clear;
    // The light of the sun is also absorbed on its way to the plate, at the refracted angle. Of it 97.7 % / 1.333^2 leave
    // the liquid, and 52.5 % of that of the sky.
    let sky = Sky::day();
    let sun = f64::from(sky.sun_light[1]) * height_of_sun() * 0.977 / 1.777;
    let sky = f64::from(sky.sky_light[1]) * 0.525;
    let sine = (1.0 - height_of_sun().powi(2)).sqrt() / 1.333;
    let lit = (sun * (-1.5 * 0.4 / (1.0 - sine * sine).sqrt()).exp() + sky) / (sun + sky);
    // One step of a byte is two percent of this light.
    let expected = |path: f64| lit * (-1.5 * path).exp();
    assert!((measured - expected(0.4)).abs() < 0.03, "{measured}, expected {}", expected(0.4));
    // Negative control: another path length.
    assert!((measured - expected(0.5)).abs() > 0.03);
}

#[test]
fn matte_surfaces_are_darker_in_water() {
    let Some(mut harness) = common::harness() else { return };
    let camera = Camera {
        eye: [1.0, 2.5, 0.5],
        target: [1.0, 0.0, 0.5],
        up: [0.0, 0.0, -1.0],
        field_of_view_deg: 30.0,
    };
    let plate = slab([0.6, 0.1, 0.2], [1.4, 0.2, 0.8]);
    let mut measured = |albedo: f32| {
        let plate = PlacedBody::new(&plate.vertices, &plate.triangles, [albedo; 3]).unwrap();
        let mut seen = |index: f32, per_metre: f32| {
            let liquid =
                with(Liquid::water(), |l| (l.refractive_index, l.absorption) = (index, [per_metre; 3]));
            let picture = draw(&mut harness, &tank(), liquid, Some(&plate), camera, one_sample());
            light(picture.pixel([SIZE[0] / 2, SIZE[1] / 2])[1])
        };
        (seen(1.333, 0.0) - seen(1.333, 400.0)) / seen(1.0, 0.0)
    };
    // The surface reflects 2 % of light from above and 47.5 % of diffuse light from below. Of the latter the plate sends
    // its albedo back. The light of the sun, of which 97.7 % pass the surface, leaves with 1 / 1.333^2 of its radiance.
    let sky = Sky::day();
    let sun = f64::from(sky.sun_light[1]) * height_of_sun();
    let of_sun = sun / (sun + f64::from(sky.sky_light[1]));
    let passed = of_sun * 0.977 / 1.777 + (1.0 - of_sun) * (1.0 - 0.475);
    let expected = |albedo: f64| 0.98 * passed / (1.0 - 0.475 * albedo);
    let dark_and_light = [0.2, 0.7].map(|albedo| {
        let (measured, expected) = (measured(albedo), expected(f64::from(albedo)));
        assert!((measured - expected).abs() < 0.03, "{measured}, expected {expected} for {albedo}");
        measured
    });
    // Negative control: the same factor for all.
    assert!(dark_and_light[1] - dark_and_light[0] > 0.06, "{dark_and_light:?}");
}
