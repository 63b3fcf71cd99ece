//! Planes through the fluid, where pixels can be worked out by hand.

mod common;

use common::{Picture, Studio, sample};
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

/// A cube of particles around the origin whose pressure rises by 1000 Pa per metre upwards, at a density of
/// 1000 kg/m^3.
fn block(studio: &Studio) -> UploadedParticles {
    let along = |index: usize| SPACING * (index as f32 - 0.5 * (COUNT - 1) as f32);
    let positions: Vec<[f32; 3]> =
        (0..COUNT.pow(3)).map(|n| [n % COUNT, n / COUNT % COUNT, n / COUNT / COUNT].map(along)).collect();
    let pressures: Vec<f32> = positions.iter().map(|p| 1000.0 * p[1]).collect();
    let densities = vec![1000.0; positions.len()];
    UploadedParticles::new(&studio.device, &positions, &[], &densities, &pressures).unwrap()
}

fn slice(buffers: ParticleBuffers<'_>, quantity: Quantity, range: [f32; 2]) -> DrawnSlice<'_> {
    DrawnSlice {
        buffers,
        axis: Axis::Z,
        position: 0.03,
        support_radius: 2.0 * SPACING,
        radius: 0.5 * SPACING,
        colouring: Colouring { quantity, range, map: ColourMap::Viridis, colour_bar: false },
    }
}

fn changed(picture: &Picture, empty: &Picture) -> usize {
    let pairs = picture.rgba.chunks_exact(4).zip(empty.rgba.chunks_exact(4));
    pairs.filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 24)).count()
}

fn near(a: [u8; 3], b: [u8; 3]) -> bool {
    a.iter().zip(b).all(|(a, b)| a.abs_diff(b) <= 4)
}

#[test]
fn a_slice_shows_the_fluid_s_outline_and_its_values() {
    let Some(mut studio) = common::studio() else { return };
    let particles = block(&studio);
    let empty = studio.draw(SIZE, &frame());
    let drawn = slice(particles.buffers(), Quantity::Pressure, [-1000.0, 1000.0]);
    let picture = studio.draw(SIZE, &Frame { slice: Some(drawn), ..frame() });
    // A square whose sides lie half a spacing beyond the outermost particles; corners are a little rounder.
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
    // Negative control: another quantity has other colours.
    let drawn = slice(particles.buffers(), Quantity::Density, [990.0, 1010.0]);
    let density = studio.draw(SIZE, &Frame { slice: Some(drawn), ..frame() });
    assert!(near(density.pixel([100, 45]), ColourMap::Viridis.sample(0.5)));
    assert!(!near(density.pixel([100, 45]), picture.pixel([100, 45])));
    // Where the plane misses the fluid there is nothing.
    let beside = DrawnSlice { position: 1.2, ..drawn };
    assert_eq!(changed(&studio.draw(SIZE, &Frame { slice: Some(beside), ..frame() }), &empty), 0);
}

#[test]
fn planes_across_each_axis_are_seen_from_their_side() {
    let Some(mut studio) = common::studio() else { return };
    let particles = block(&studio);
    let cameras = [
        (Axis::X, Camera::orbit([0.0; 3], DISTANCE, 90.0, 0.0, 40.0)),
        (Axis::Y, Camera::orbit([0.0; 3], DISTANCE, 0.0, 90.0, 40.0)),
        (Axis::Z, Camera::orbit([0.0; 3], DISTANCE, 0.0, 0.0, 40.0)),
    ];
    for (seen_along, camera) in cameras {
        let empty = studio.draw(SIZE, &Frame { camera, ..frame() });
        for (axis, _) in cameras {
            let drawn = slice(particles.buffers(), Quantity::Density, [990.0, 1010.0]);
            let drawn = DrawnSlice { axis, position: 0.0, ..drawn };
            let covered =
                changed(&studio.draw(SIZE, &Frame { camera, slice: Some(drawn), ..frame() }), &empty);
            // A plane that is seen edge on is a line at most.
            let full = (COUNT as f32 * SPACING * scale()).powi(2) as usize;
            match axis == seen_along {
                true => assert!(covered > full * 9 / 10, "{axis:?}: {covered} of {full} pixels"),
                false => assert!(covered < full / 20, "{axis:?} along {seen_along:?}: {covered} pixels"),
            }
        }
    }
}

#[test]
fn one_sample_shows_the_same_slice_and_a_solid_hides_it() {
    let Some(mut studio) = common::studio() else { return };
    let particles = block(&studio);
    let drawn = slice(particles.buffers(), Quantity::Pressure, [-1000.0, 1000.0]);
    let ball = sample::ball([0.0, 0.0, 1.0], 0.2, 24);
    let body = PlacedBody::new(&ball.vertices, &ball.triangles, [0.8, 0.1, 0.1]).unwrap();
    let bodies = UploadedBodies::new(&studio.device, [(&body, [0.0; 3], [0.0, 0.0, 0.0, 1.0])]);
    let view = Frame { slice: Some(drawn), bodies: Some(bodies.buffers()), ..frame() };
    let four = studio.draw(SIZE, &view);
    let [r, g, b] = four.pixel([100, 80]);
    assert!(r > g && r > b, "the ball is in front: {:?}", [r, g, b]);
    studio.renderer = Renderer::new(&studio.device, &studio.queue, Offscreen::FORMAT, 1).unwrap();
    let difference = studio.draw(SIZE, &view).difference(&four);
    assert!(difference.mean < 1.5 && difference.share < 0.03, "{difference:?}");
}

#[test]
fn unsound_slices_are_refused() {
    let Some(mut studio) = common::studio() else { return };
    let particles = block(&studio);
    let good = slice(particles.buffers(), Quantity::Pressure, [0.0, 1.0]);
    let mut target = Offscreen::new(&studio.device, &studio.queue, SIZE).unwrap();
    let mut told = |slice| {
        let view = Frame { slice: Some(slice), ..frame() };
        target.submit(&mut studio.renderer, &view).unwrap_err().to_string()
    };
    assert!(told(DrawnSlice { support_radius: 0.05, ..good }).contains("at least a particle spacing"));
    assert!(told(DrawnSlice { position: f32::NAN, ..good }).contains("position is NaN"));
    assert!(told(DrawnSlice { radius: -1.0, ..good }).contains("radius is -1"));
}
