//! Planes through the fluid, in cases where the expected pixels are known.

mod common;

use common::{Harness, Picture, sample, with};
use splashdown_render::*;

const SIZE: [u32; 2] = [200, 160];
const DISTANCE: f32 = 4.0;
const SPACING: f32 = 0.1;
/// Particles along each side of the block.
const COUNT: usize = 16;
/// Pixels per metre in the plane through the origin.
fn scale() -> f32 {
    80.0 / (DISTANCE * 20f32.to_radians().tan())
}

fn frame() -> Frame<'static> {
    let camera = Camera::orbit([0.0; 3], DISTANCE, 0.0, 0.0, 40.0);
    Frame::new(camera, Domain::closed([-50.0; 3], [50.0; 3]))
}

/// A cube of particles around the origin with a density of 1000 kg/m^3 and a pressure that
/// increases upwards by 1000 Pa per metre.
fn block(harness: &Harness) -> UploadedParticles {
    let along = |index: usize| SPACING * (index as f32 - 0.5 * (COUNT - 1) as f32);
    let positions: Vec<[f32; 3]> =
        (0..COUNT.pow(3)).map(|n| [n % COUNT, n / COUNT % COUNT, n / COUNT / COUNT].map(along)).collect();
    let pressures: Vec<f32> = positions.iter().map(|p| 1000.0 * p[1]).collect();
    let densities = vec![1000.0; positions.len()];
    UploadedParticles::new(&harness.device, &positions, &[], &densities, &pressures).unwrap()
}

fn slice(buffers: ParticleBuffers<'_>, quantity: Quantity, range: [f32; 2]) -> DrawnSlice<'_> {
    let colouring = Colouring::new(quantity, range).with_map(ColourMap::Viridis).with_colour_bar(false);
    DrawnSlice::new(buffers, Axis::Z, 0.03, 0.5 * SPACING, colouring)
}

fn changed(picture: &Picture, empty: &Picture) -> usize {
    let pairs = picture.rgba.chunks_exact(4).zip(empty.rgba.chunks_exact(4));
    pairs.filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 24)).count()
}

fn near(a: [u8; 3], b: [u8; 3]) -> bool {
    a.iter().zip(b).all(|(a, b)| a.abs_diff(b) <= 4)
}

#[test]
fn a_slice_shows_the_outline_and_the_values_of_the_fluid() {
    let Some(mut harness) = common::harness() else { return };
    let particles = block(&harness);
    let empty = harness.draw(SIZE, &frame());
    let drawn = slice(particles.buffers(), Quantity::Pressure, [-1000.0, 1000.0]);
    let picture = harness.draw(SIZE, &frame().with_slice(drawn));
    // A square whose sides lie half a spacing outside the outermost particles, with slightly
    // rounded corners.
    let expected = (COUNT as f32 * SPACING * scale() * DISTANCE / (DISTANCE - 0.03)).powi(2);
    let covered = changed(&picture, &empty) as f32;
    assert!((covered - expected).abs() < 0.03 * expected, "{covered} pixels, expected {expected}");
    for y in [45, 60, 80, 100, 115] {
        let height = (80.0 - (y as f32 + 0.5)) / scale();
        let colour = ColourMap::Viridis.sample(0.5 + 0.5 * height);
        assert!(
            near(picture.pixel([100, y]), colour),
            "row {y}: {:?}, not {colour:?}",
            picture.pixel([100, y])
        );
    }
    // Negative control: another quantity.
    let drawn = slice(particles.buffers(), Quantity::Density, [990.0, 1010.0]);
    let density = harness.draw(SIZE, &frame().with_slice(drawn));
    assert!(near(density.pixel([100, 45]), ColourMap::Viridis.sample(0.5)));
    assert!(!near(density.pixel([100, 45]), picture.pixel([100, 45])));
    // A plane outside the fluid is invisible.
    let beside = with(drawn, |s| s.position = 1.2);
    assert_eq!(changed(&harness.draw(SIZE, &frame().with_slice(beside)), &empty), 0);
}

#[test]
fn planes_across_each_axis_face_the_right_side() {
    let Some(mut harness) = common::harness() else { return };
    let particles = block(&harness);
    let cameras = [
        (Axis::X, Camera::orbit([0.0; 3], DISTANCE, 90.0, 0.0, 40.0)),
        (Axis::Y, Camera::orbit([0.0; 3], DISTANCE, 0.0, 90.0, 40.0)),
        (Axis::Z, Camera::orbit([0.0; 3], DISTANCE, 0.0, 0.0, 40.0)),
    ];
    for (seen_along, camera) in cameras {
        let empty = harness.draw(SIZE, &with(frame(), |f| f.camera = camera));
        for (axis, _) in cameras {
            let drawn = slice(particles.buffers(), Quantity::Density, [990.0, 1010.0]);
            let drawn = with(drawn, |s| {
                s.axis = axis;
                s.position = 0.0;
            });
            let covered =
                changed(&harness.draw(SIZE, &with(frame(), |f| f.camera = camera).with_slice(drawn)), &empty);
            // A plane seen edge-on is at most a line.
            let full = (COUNT as f32 * SPACING * scale()).powi(2) as usize;
            match axis == seen_along {
                true => assert!(covered > full * 9 / 10, "{axis:?}: {covered} of {full} pixels"),
                false => assert!(covered < full / 20, "{axis:?} along {seen_along:?}: {covered} pixels"),
            }
        }
    }
}

#[test]
fn one_sample_shows_the_same_slice_and_a_body_hides_it() {
    let Some(mut harness) = common::harness() else { return };
    let particles = block(&harness);
    let drawn = slice(particles.buffers(), Quantity::Pressure, [-1000.0, 1000.0]);
    let ball = sample::ball([0.0, 0.0, 1.0], 0.2, 24);
    let body = PlacedBody::new(&ball.vertices, &ball.triangles, [0.8, 0.1, 0.1]).unwrap();
    let bodies = UploadedBodies::new(&harness.device, [(&body, [0.0; 3], [0.0, 0.0, 0.0, 1.0])]);
    let view = frame().with_slice(drawn).with_bodies(bodies.buffers());
    let four = harness.draw(SIZE, &view);
    let [r, g, b] = four.pixel([100, 80]);
    assert!(r > g && r > b, "the ball is in front: {:?}", [r, g, b]);
    harness.renderer = Renderer::new(&harness.device, &harness.queue, Offscreen::FORMAT, 1).unwrap();
    let difference = harness.draw(SIZE, &view).difference(&four);
    assert!(difference.mean < 1.5 && difference.fraction < 0.03, "{difference:?}");
}

#[test]
fn invalid_slices_are_refused() {
    let Some(mut harness) = common::harness() else { return };
    let particles = block(&harness);
    let good = slice(particles.buffers(), Quantity::Pressure, [0.0, 1.0]);
    let mut target = Offscreen::new(&harness.device, &harness.queue, SIZE).unwrap();
    let mut message = |slice| {
        let view = frame().with_slice(slice);
        target.submit(&mut harness.renderer, &view).unwrap_err().to_string()
    };
    assert!(message(with(good, |s| s.support_radius = 0.05)).contains("at least one particle spacing"));
    assert!(message(with(good, |s| s.position = f32::NAN)).contains("position is NaN"));
    assert!(message(with(good, |s| s.radius = -1.0)).contains("radius is -1"));
}
