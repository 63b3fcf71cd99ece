//! Where bodies appear in and below liquid.

use super::{LEVEL, RED, ball, draw, is_red, one_sample, pixel_of, slab, tank};
use crate::common::{self, sample, with};
use splashdown_render::*;

/// The zero of a function that changes its sign once.
fn root(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    let sign = f(low).signum();
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if f(middle).signum() == sign { low = middle } else { high = middle }
    }
    low
}

fn sine(opposite: f64, adjacent: f64) -> f64 {
    opposite / opposite.hypot(adjacent)
}

#[test]
fn a_body_under_water_appears_where_snells_law_puts_it() {
    let Some(mut harness) = common::harness() else { return };
    let (eye, place) = ([1.0, 2.2, 2.4], [1.0, 0.15, 0.5]);
    let camera = Camera { eye, target: [1.0, 0.4, 0.5], up: [0.0, 1.0, 0.0], field_of_view_deg: 40.0 };
    let body = ball(place, 0.03, RED);
    // Where the ray crosses the level: n sin(angle in water) = sin(angle in air).
    let snell =
        |z: f64| sine(2.4 - z, 2.2 - f64::from(LEVEL)) - 1.333 * sine(z - 0.5, f64::from(LEVEL) - 0.15);
    let bent = pixel_of(camera, [1.0, LEVEL, root(0.5, 1.0, snell) as f32]);
    let straight = pixel_of(camera, place);
    assert!(bent[1].abs_diff(straight[1]) > 8, "{bent:?} {straight:?}");
    let picture = draw(&mut harness, &tank(), Liquid::water(), Some(&body), camera, one_sample());
    assert!(is_red(picture.pixel(bent)), "{:?} at {bent:?}", picture.pixel(bent));
    assert!(!is_red(picture.pixel(straight)));
    // Negative control: a liquid that does not refract.
    let air = with(Liquid::water(), |l| l.refractive_index = 1.0);
    let picture = draw(&mut harness, &tank(), air, Some(&body), camera, one_sample());
    assert!(!is_red(picture.pixel(bent)) && is_red(picture.pixel(straight)));
}

#[test]
fn the_surface_reflects_totally_from_below() {
    let Some(mut harness) = common::harness() else { return };
    let camera = Camera {
        eye: [1.0, 0.05, 1.6],
        target: [1.0, 0.5, 0.5],
        up: [0.0, 1.0, 0.0],
        field_of_view_deg: 60.0,
    };
    let body = ball([1.0, 0.3, 0.3], 0.05, RED);
    // The mirror image of the body above the level, seen through the front of the tank at z = 1.
    let image = 2.0 * f64::from(LEVEL) - 0.3;
    let snell = |y: f64| sine(y - 0.05, 0.6) - 1.333 * sine(image - y, 0.7);
    let height = root(0.05, f64::from(LEVEL), snell);
    assert!(height < f64::from(LEVEL) - 0.02, "{height}");
    let pixel = pixel_of(camera, [1.0, height as f32, 1.0]);
    let picture = draw(&mut harness, &tank(), Liquid::water(), Some(&body), camera, one_sample());
    assert!(is_red(picture.pixel(pixel)), "{:?} at {pixel:?}", picture.pixel(pixel));
    // Negative control: without refraction there is no reflection.
    let air = with(Liquid::water(), |l| l.refractive_index = 1.0);
    let picture = draw(&mut harness, &tank(), air, Some(&body), camera, one_sample());
    assert!(!is_red(picture.pixel(pixel)));
}

/// Water with a cavity that a box fills but for rounding, as the surface of a simulation ends at bodies.
fn tank_around(low: [f32; 3], high: [f32; 3]) -> sample::Mesh {
    let (mut water, cavity) = (tank(), slab(low.map(|x| x - 1e-5), high.map(|x| x + 1e-5)));
    let first = water.vertices.len() as u32;
    water.vertices.extend(cavity.vertices);
    water.normals.extend(cavity.normals.iter().map(|n| n.map(|x| -x)));
    water.triangles.extend(cavity.triangles.iter().map(|&[a, b, c]| [first + a, first + c, first + b]));
    water
}

#[test]
fn a_box_that_fills_a_cavity_looks_like_a_box_in_water() {
    let Some(mut harness) = common::harness() else { return };
    let (low, high) = ([0.613, 0.117, 0.271], [1.237, 0.383, 0.719]);
    let mesh = slab(low, high);
    let body = PlacedBody::new(&mesh.vertices, &mesh.triangles, RED).unwrap();
    let camera = Camera::orbit([0.925, 0.38, 0.495], 2.2, 20.0, 50.0, 30.0);
    let mut drawn =
        |water: &sample::Mesh| draw(&mut harness, water, Liquid::water(), Some(&body), camera, one_sample());
    let (cavity, solid) = (drawn(&tank_around(low, high)), drawn(&tank()));
    // The upper side of the box, well inside its outline.
    let mut pixels = (0..40).flat_map(|x| (0..40).map(move |z| [x as f32 / 39.0, z as f32 / 39.0]));
    assert!(pixels.all(|[x, z]| {
        let pixel = pixel_of(camera, [0.73 + 0.4 * x, 0.46, 0.38 + 0.22 * z]);
        cavity.pixel(pixel).iter().zip(solid.pixel(pixel)).all(|(a, b)| a.abs_diff(b) < 12)
    }));
}
