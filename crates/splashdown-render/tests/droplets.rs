//! Droplets, in cases where the expected pixels are known.

mod common;

use common::{Harness, Picture, sample, with};
use splashdown_render::*;

const SIZE: [u32; 2] = [200, 160];
/// A droplet of this radius in the middle has an outline of 22 pixels.
const RADIUS: f32 = 0.4;

fn frame() -> Frame<'static> {
    let camera = Camera::orbit([0.0; 3], 4.0, 0.0, 0.0, 40.0);
    Frame::new(camera, Domain::closed([-50.0; 3], [50.0; 3]))
}

/// A droplet at rest or in motion along x, blurred for 0.1 s.
fn draw(harness: &mut Harness, place: [f32; 3], speed: f32, frame: Frame<'_>) -> Picture {
    let droplet = UploadedDroplets::new(&harness.device, &[place], &[[speed, 0.0, 0.0]]).unwrap();
    let drawn = DrawnDroplets::new(droplet.buffers(), RADIUS, Liquid::water()).with_shutter(0.1);
    harness.draw(SIZE, &frame.with_droplets(drawn))
}

/// The pixels that differ between two pictures: columns and rows of their bounding box, and their number.
fn changed(a: &Picture, b: &Picture) -> ([u32; 2], [u32; 2], usize) {
    let differs = |x, y| (0..3).any(|c| a.pixel([x, y])[c].abs_diff(b.pixel([x, y])[c]) > 3);
    let pixels: Vec<[u32; 2]> = (0..SIZE[1])
        .flat_map(|y| (0..SIZE[0]).map(move |x| [x, y]))
        .filter(|&[x, y]| differs(x, y))
        .collect();
    let range = |axis: usize| {
        let values = || pixels.iter().map(|pixel| pixel[axis]);
        [values().min().unwrap_or(0), values().max().unwrap_or(0)]
    };
    (range(0), range(1), pixels.len())
}

#[test]
fn a_droplet_at_rest_covers_its_disc() {
    let Some(mut harness) = common::harness() else { return };
    let empty = harness.draw(SIZE, &frame());
    let picture = draw(&mut harness, [0.0; 3], 0.0, frame());
    let ([left, right], [top, bottom], count) = changed(&picture, &empty);
    let radius = 80.0 / (20.0_f32.to_radians().tan() * 4.0) * RADIUS;
    for (low, high, middle) in [(left, right, 99.5), (top, bottom, 79.5)] {
        assert!((low as f32 - middle + radius).abs() < 2.0, "{low} to {high}, radius {radius}");
        assert!((high as f32 - middle - radius).abs() < 2.0, "{low} to {high}, radius {radius}");
    }
    let disc = std::f32::consts::PI * radius * radius;
    assert!(count as f32 > 0.7 * disc && (count as f32) < 1.1 * disc, "{count} of {disc}");
    // The droplet shows the sky below and the floor above, opposite to what is behind it.
    let below = picture.pixel([100, 80 + radius as u32 / 2]);
    let above = picture.pixel([100, 80 - radius as u32 / 2]);
    assert!(below[2] > above[2] + 10, "{below:?} below, {above:?} above");
}

#[test]
fn a_moving_droplet_is_a_fainter_streak_of_the_length_of_its_way() {
    let Some(mut harness) = common::harness() else { return };
    let empty = harness.draw(SIZE, &frame());
    let rest = draw(&mut harness, [0.0; 3], 0.0, frame());
    // 1.6 m in 0.1 s.
    let moving = draw(&mut harness, [0.0; 3], 16.0, frame());
    let ([left, right], [top, bottom], _) = changed(&moving, &empty);
    let ([rest_left, rest_right], [rest_top, rest_bottom], _) = changed(&rest, &empty);
    let pixels_per_metre = 80.0 / (20.0_f32.to_radians().tan() * 4.0);
    let longer = (right - left) as f32 - (rest_right - rest_left) as f32;
    // The ends of a streak fade. Half of the time would give half of the length.
    let expected = 1.6 * pixels_per_metre;
    assert!(longer > 0.7 * expected && longer < 1.02 * expected, "{longer} of {expected}");
    // Droplets that move differ in size.
    assert!(top.abs_diff(rest_top) <= 7 && bottom.abs_diff(rest_bottom) <= 7);
    let contrast = |picture: &Picture, x: u32, y: u32| {
        (0..3).map(|c| i32::from(picture.pixel([x, y])[c].abs_diff(empty.pixel([x, y])[c]))).max()
    };
    assert!(contrast(&moving, 100, 95) < contrast(&rest, 100, 95));
    // Control: a droplet that moves away from the eye has no streak.
    let droplet = UploadedDroplets::new(&harness.device, &[[0.0; 3]], &[[0.0, 0.0, 16.0]]).unwrap();
    let drawn = DrawnDroplets::new(droplet.buffers(), RADIUS, Liquid::water()).with_shutter(0.1);
    let away = harness.draw(SIZE, &frame().with_droplets(drawn));
    let ([left, right], ..) = changed(&away, &empty);
    assert!((right - left).abs_diff(rest_right - rest_left) <= 14);
}

#[test]
fn the_ends_of_a_streak_fade_and_its_middle_is_even() {
    let Some(mut harness) = common::harness() else { return };
    let empty = harness.draw(SIZE, &frame());
    let moving = draw(&mut harness, [0.0; 3], 16.0, frame());
    let ([left, right], ..) = changed(&moving, &empty);
    // In the lower half, which shows the sky.
    let light = |x: u32| -> i32 {
        (0..3).map(|c| i32::from(moving.pixel([x, 90])[c]) - i32::from(empty.pixel([x, 90])[c])).sum()
    };
    let middle = light(100);
    assert!(middle > 30, "{middle}");
    for x in 90..110 {
        assert!((light(x) - middle).abs() < middle / 4, "{} at {x}, {middle} in the middle", light(x));
    }
    // Over a diameter at both ends.
    for (end, inwards) in [(left, 1), (right, -1)] {
        let at = |distance: i32| light(end.wrapping_add_signed(inwards * distance));
        let (outer, inner) = (at(6), at(30));
        assert!(2 * outer < middle && inner > outer + middle / 5, "{outer}, {inner}, {middle} from {end}");
    }
}

#[test]
fn moving_droplets_differ_in_size_and_have_the_volume_of_their_particles_on_average() {
    let Some(mut harness) = common::harness() else { return };
    let empty = harness.draw(SIZE, &frame());
    let expected = 2.0 * 80.0 / (20.0_f32.to_radians().tan() * 4.0) * RADIUS;
    // Without a shutter, so that the disc is seen.
    let mut diameter = |velocity: [f32; 3]| {
        let droplet = UploadedDroplets::new(&harness.device, &[[0.0; 3]], &[velocity]).unwrap();
        let drawn = DrawnDroplets::new(droplet.buffers(), RADIUS, Liquid::water());
        let ([left, right], [top, bottom], _) =
            changed(&harness.draw(SIZE, &frame().with_droplets(drawn)), &empty);
        // The mean of the axes.
        0.5 * ((right - left) + (bottom - top)) as f32 / expected
    };
    let ratios: Vec<f32> = (0..60).map(|i| diameter([5.0 + 0.9 * i as f32, 1.0, 0.7 * i as f32])).collect();
    let (least, most) =
        (ratios.iter().copied().fold(f32::MAX, f32::min), ratios.iter().copied().fold(0.0, f32::max));
    assert!(least > 0.5 && least < 0.75 && most > 1.1 && most < 1.4, "from {least} to {most}");
    let volume = ratios.iter().map(|ratio| ratio.powi(3)).sum::<f32>() / ratios.len() as f32;
    assert!((volume - 1.0).abs() < 0.2, "{volume}");
    // Gravity changes the vertical velocity of a droplet and not its size.
    let flight: Vec<f32> = [-4.0, -1.0, 1.0, 4.0].map(|up| diameter([8.0, up, 3.0])).into();
    let spread = flight.iter().copied().fold(0.0, f32::max) / flight.iter().copied().fold(f32::MAX, f32::min);
    assert!(spread < 1.1, "{flight:?}");
}

#[test]
fn a_surface_hides_droplets_behind_it() {
    let Some(mut harness) = common::harness() else { return };
    let ball = sample::ball([0.0; 3], 0.8, 48);
    let ball = UploadedSurface::new(&harness.device, &ball.vertices, &ball.normals, &ball.triangles).unwrap();
    let black = with(Liquid::water(), |l| {
        l.absorption = [400.0; 3];
        l.scattering = 400.0;
        l.colour = [0.0; 3];
    });
    let with_ball = frame().with_surface(DrawnSurface::new(ball.buffers(), black));
    let alone = harness.draw(SIZE, &with_ball);
    let behind = draw(&mut harness, [0.0, 0.0, -1.5], 0.0, with_ball);
    assert_eq!(changed(&behind, &alone).2, 0);
    let before = draw(&mut harness, [0.0, 0.0, 1.5], 0.0, with_ball);
    assert!(changed(&before, &alone).2 > 1000);
}

#[test]
fn the_samples_of_a_traced_picture_move_droplets_and_foam() {
    let Some(mut harness) = common::harness() else { return };
    // Liquid out of view: traced pictures need a surface.
    let mesh = sample::ball([0.0, 0.0, 30.0], 0.1, 8);
    let surface =
        UploadedSurface::new(&harness.device, &mesh.vertices, &mesh.normals, &mesh.triangles).unwrap();
    let meshes = TracedMeshes::new(
        &harness.device,
        &mesh.vertices,
        &mesh.normals,
        &mesh.triangles,
        std::iter::empty::<(&PlacedBody, [f32; 3], [f32; 4])>(),
    )
    .unwrap();
    let mut width = |speed: f32, shutter: f32, foam: bool| {
        let quality = with(Quality::FINAL, |quality| {
            quality.samples = 12;
            quality.shutter = shutter;
        });
        let base = frame().with_surface(DrawnSurface::new(surface.buffers(), Liquid::water()));
        let base = base.with_tracing(&meshes, quality);
        let empty = harness.draw(SIZE, &base);
        let velocity = [[speed, 0.0, 0.0]];
        let droplet = UploadedDroplets::new(&harness.device, &[[0.0; 3]], &velocity).unwrap();
        let spray = UploadedFoam::moving(&harness.device, &[[0.0; 3]], &velocity, &[], &[], &[0]).unwrap();
        let picture = match foam {
            true => harness.draw(SIZE, &base.with_foam(DrawnFoam::new(spray.buffers(), 1.0))),
            false => {
                let drawn = DrawnDroplets::new(droplet.buffers(), RADIUS, Liquid::water());
                harness.draw(SIZE, &base.with_droplets(drawn))
            }
        };
        let ([left, right], ..) = changed(&picture, &empty);
        right - left
    };
    for foam in [false, true] {
        let (rest, moving) = (width(0.0, 0.1, foam), width(16.0, 0.1, foam));
        assert!(moving > rest + 50, "{moving} pixels in motion, {rest} at rest, foam: {foam}");
        // Control: without a shutter the motion is not visible, but in the shape of droplets.
        let still = width(16.0, 0.0, foam);
        assert!(still.abs_diff(rest) <= if foam { 0 } else { 14 }, "{still} and {rest}, foam: {foam}");
    }
}

#[test]
fn a_droplet_shows_the_body_behind_it() {
    let Some(mut harness) = common::harness() else { return };
    let ball = sample::ball([0.0, 0.0, -3.0], 1.5, 24);
    let body = PlacedBody::new(&ball.vertices, &ball.triangles, [0.8, 0.05, 0.05]).unwrap();
    let bodies = UploadedBodies::new(&harness.device, [(&body, [0.0; 3], [0.0, 0.0, 0.0, 1.0])]);
    let alone = harness.draw(SIZE, &frame().with_bodies(bodies.buffers()));
    let picture = draw(&mut harness, [0.0; 3], 0.0, frame().with_bodies(bodies.buffers()));
    assert!(changed(&picture, &alone).2 > 500);
    // Off the middle, where the droplet reflects less and shows the other side of the ball.
    let is_red = |[r, g, b]: [u8; 3]| u32::from(r) > 2 * u32::from(g.max(b));
    for at in [[100, 80], [92, 80], [108, 80], [100, 86]] {
        assert!(is_red(picture.pixel(at)), "{at:?}: {:?}", picture.pixel(at));
    }
    // Control: the environment.
    let without = draw(&mut harness, [0.0; 3], 0.0, frame());
    assert!(!is_red(without.pixel([92, 80])) && !is_red(without.pixel([100, 86])));
    // Beside the ball as seen from the eye, there is no body behind the droplet.
    let beside = draw(&mut harness, [0.9, 0.9, 0.0], 0.0, frame().with_bodies(bodies.buffers()));
    let ([left, right], [top, bottom], _) = changed(&beside, &alone);
    assert!(!is_red(beside.pixel([(left + right) / 2, (top + bottom) / 2])));
}

#[test]
fn a_droplet_does_not_change_what_else_is_drawn() {
    let Some(mut harness) = common::harness() else { return };
    // Bubbles and the edges of the tank without a liquid, far from the droplet.
    let places: Vec<[f32; 3]> =
        (0..9).map(|k| [-1.2 + 0.1 * (k % 3) as f32, 0.1 * (k / 3) as f32, 0.0]).collect();
    let bubbles = UploadedFoam::moving(&harness.device, &places, &[[0.0; 3]; 9], &[], &[], &[2; 9]).unwrap();
    let camera = Camera::orbit([0.0; 3], 6.0, 0.0, 0.0, 40.0);
    let base = Frame::new(camera, Domain::closed([-1.5; 3], [1.5; 3]));
    let with_bubbles = base.with_foam(DrawnFoam::new(bubbles.buffers(), 0.2));
    let without = harness.draw(SIZE, &with_bubbles);
    let ([left, right], [top, bottom], count) =
        changed(&draw(&mut harness, [0.8, 0.0, 0.0], 0.0, with_bubbles), &without);
    assert!(
        count > 200 && left > 110 && right - left < 40 && bottom - top < 40,
        "{left}..{right}, {top}..{bottom}"
    );
    // Control: bubbles are visible.
    assert!(changed(&without, &harness.draw(SIZE, &base)).2 > 20);
}

#[test]
fn invalid_droplets_are_refused() {
    let Some(harness) = common::harness() else { return };
    let error = UploadedDroplets::new(&harness.device, &[[0.0; 3]; 2], &[[0.0; 3]]).unwrap_err();
    assert!(error.to_string().contains("velocities"), "{error}");
    let droplets = UploadedDroplets::new(&harness.device, &[[0.0; 3]; 2], &[]).unwrap();
    let mut target = Offscreen::new(&harness.device, &harness.queue, SIZE).unwrap();
    let mut renderer = Renderer::new(&harness.device, &harness.queue, Offscreen::FORMAT, 4).unwrap();
    for (radius, shutter) in [(0.0, 0.0), (0.1, -1.0), (0.1, f32::NAN)] {
        let drawn = DrawnDroplets::new(droplets.buffers(), radius, Liquid::water()).with_shutter(shutter);
        assert!(target.render_to_rgba(&mut renderer, &frame().with_droplets(drawn)).is_err());
    }
}
