//! An eye in the liquid.

use super::{LEVEL, RED, SIZE, draw, is_red, light, one_sample, pixel_of, slab, tank};
use crate::common::{self, with};
use splashdown_render::*;

/// A camera in the tank at this height, which looks up or down. Light that enters through the sides of the tank does not
/// reach what is below it.
fn under_water(height: f32, up: bool) -> Camera {
    let target = [0.8, height + if up { 1.0 } else { -1.0 }, 0.65];
    Camera { eye: [0.8, height, 0.65], target, up: [0.0, 0.0, 1.0], field_of_view_deg: 130.0 }
}

#[test]
fn an_eye_in_the_liquid_sees_snells_window() {
    let Some(mut harness) = common::harness() else { return };
    // Outside the window the surface mirrors this plate on the bottom, which fills the tank.
    let plate = slab([0.01, 0.01, 0.01], [1.99, 0.05, 0.99]);
    let plate = PlacedBody::new(&plate.vertices, &plate.triangles, RED).unwrap();
    let camera = under_water(0.3, true);
    let mut seen = |liquid: Liquid, angle_deg: f32| {
        let picture = draw(&mut harness, &tank(), liquid, Some(&plate), camera, one_sample());
        let reach = 0.3 * angle_deg.to_radians().tan();
        is_red(picture.pixel(pixel_of(camera, [0.8 + reach, LEVEL, 0.65])))
    };
    // The critical angle is 48.6 degrees.
    assert!(!seen(Liquid::water(), 44.0));
    assert!(seen(Liquid::water(), 53.0));
    // Negative control: a liquid of another refractive index, with a window of 70 degrees.
    assert!(!seen(with(Liquid::water(), |l| l.refractive_index = 1.06), 53.0));
}

#[test]
fn an_eye_in_the_liquid_sees_absorption() {
    let Some(mut harness) = common::harness() else { return };
    let plate = slab([0.3, 0.05, 0.1], [1.7, 0.1, 0.9]);
    let plate = PlacedBody::new(&plate.vertices, &plate.triangles, [0.5; 3]).unwrap();
    let mut seen = |height: f32, per_metre: f32| {
        let liquid = with(Liquid::water(), |l| l.absorption = [per_metre; 3]);
        let camera = under_water(height, false);
        let picture = draw(&mut harness, &tank(), liquid, Some(&plate), camera, one_sample());
        light(picture.pixel([SIZE[0] / 2, SIZE[1] / 2])[1])
    };
    // The light on the plate is the same in both pictures; 0.3 m of liquid lie between the eyes.
    let measured = seen(0.5, 1.5) / seen(0.2, 1.5);
    let expected = (-1.5_f64 * 0.3).exp();
    assert!((measured - expected).abs() < 0.03, "{measured}, expected {expected}");
    // Negative control: a liquid without absorption.
    assert!((seen(0.5, 0.0) / seen(0.2, 0.0) - 1.0).abs() < 0.03);
}

#[test]
fn an_eye_at_the_surface_sees_liquid_below_it() {
    let Some(mut harness) = common::harness() else { return };
    let plate = slab([0.3, 0.05, 0.1], [1.7, 0.1, 0.9]);
    let plate = PlacedBody::new(&plate.vertices, &plate.triangles, [0.5; 3]).unwrap();
    let ink = with(Liquid::water(), |l| l.absorption = [0.0, 400.0, 400.0]);
    // Slightly above, in the surface, and slightly below it.
    for height in [LEVEL + 2e-4, LEVEL, LEVEL - 2e-4] {
        let picture =
            draw(&mut harness, &tank(), ink, Some(&plate), under_water(height, false), one_sample());
        let [r, g, b] = picture.pixel([SIZE[0] / 2, SIZE[1] / 2]);
        assert!(r > 60 && u32::from(g.max(b)) < u32::from(r) - 20, "{r} {g} {b} at {height}");
    }
}
