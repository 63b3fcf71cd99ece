//! Foam, spray and bubbles, in cases where the expected pixels are known.

mod common;

use common::{Harness, Picture, sample, with};
use splashdown_render::*;

const SIZE: [u32; 2] = [200, 160];
const MIDDLE: [u32; 2] = [100, 80];
const SPRAY: u32 = 0;
const FOAM: u32 = 1;
const BUBBLE: u32 = 2;
/// Half the particle spacing.
const RADIUS: f32 = 0.25;

fn frame() -> Frame<'static> {
    let camera = Camera::orbit([0.0; 3], 4.0, 0.0, 0.0, 40.0);
    Frame::new(camera, Domain::closed([-50.0; 3], [50.0; 3]))
}

fn draw(harness: &mut Harness, places: &[[f32; 3]], lifetime: f32, kind: u32, frame: Frame<'_>) -> Picture {
    let n = places.len();
    let foam = UploadedFoam::new(&harness.device, places, &vec![lifetime; n], &[], &vec![kind; n]).unwrap();
    harness.draw(SIZE, &frame.with_foam(DrawnFoam::new(foam.buffers(), RADIUS)))
}

/// The difference in brightness of a pixel in two pictures, summed over its channels.
fn brighter(a: &Picture, b: &Picture, pixel: [u32; 2]) -> i32 {
    a.pixel(pixel).iter().zip(b.pixel(pixel)).map(|(a, b)| i32::from(*a) - i32::from(b)).sum()
}

/// A ball of black or clear liquid in the middle, as a mesh.
fn liquid_ball(harness: &Harness, radius: f32, clear: bool) -> (UploadedSurface, Liquid) {
    let ball = sample::ball([0.0; 3], radius, 48);
    let ball = UploadedSurface::new(&harness.device, &ball.vertices, &ball.normals, &ball.triangles).unwrap();
    let per_metre = if clear { 0.0 } else { 400.0 };
    let black = with(Liquid::water(), |l| {
        l.absorption = [per_metre; 3];
        l.scattering = per_metre;
        l.colour = [0.0; 3];
    });
    (ball, black)
}

/// A particle far behind the middle, to be drawn as a large dark ball: white foam has little
/// contrast against the horizon.
fn backdrop(harness: &Harness) -> UploadedParticles {
    UploadedParticles::new(&harness.device, &[[0.0, 0.0, -8.0]], &[], &[], &[]).unwrap()
}

fn dark(ball: &UploadedParticles, radius: f32) -> DrawnParticles<'_> {
    let colouring =
        Colouring::new(Quantity::Speed, [0.0, 1.0]).with_map(ColourMap::Inferno).with_colour_bar(false);
    DrawnParticles::new(ball.buffers(), radius, colouring)
}

#[test]
fn each_kind_is_white_and_fades() {
    let Some(mut harness) = common::harness() else { return };
    let behind = backdrop(&harness);
    let frame = frame().with_particles(dark(&behind, 4.0));
    let empty = harness.draw(SIZE, &frame);
    for kind in [SPRAY, FOAM, BUBBLE] {
        let picture = draw(&mut harness, &[[0.0; 3]], 3.0, kind, frame);
        let here = brighter(&picture, &empty, MIDDLE);
        assert!(here > 40, "kind {kind}: {here}");
        let [r, g, b] = picture.pixel(MIDDLE);
        assert!(r.abs_diff(b) < 60 && g > empty.pixel(MIDDLE)[1], "kind {kind}: {r} {g} {b}");
        // A particle is faint shortly before the end of its lifetime, and does not change other pixels.
        let fading = draw(&mut harness, &[[0.0; 3]], 0.01, kind, frame);
        assert!(brighter(&fading, &empty, MIDDLE) < here / 3);
        assert!(brighter(&picture, &empty, [160, 80]).abs() < 6);
    }
}

/// Width and height of the box of brighter pixels, and their number.
fn extent(a: &Picture, b: &Picture) -> ([u32; 2], u32) {
    let pixels = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| [x, y]));
    let changed: Vec<_> = pixels.filter(|&pixel| brighter(a, b, pixel) > 12).collect();
    let side = |axis: usize| {
        let places = changed.iter().map(|pixel| pixel[axis]);
        places.clone().max().unwrap_or(0) + 1 - places.min().unwrap_or(0)
    };
    ([side(0), side(1)], changed.len() as u32)
}

#[test]
fn spray_is_a_round_group_of_drops_and_foam_lies_flat() {
    let Some(mut harness) = common::harness() else { return };
    let behind = backdrop(&harness);
    let frame = frame().with_particles(dark(&behind, 4.0));
    let empty = harness.draw(SIZE, &frame);
    let mut drawn =
        |count: usize, kind| extent(&draw(&mut harness, &vec![[0.0; 3]; count], 3.0, kind, frame), &empty);
    // Seen from the side. Each group is another one; together they fill a circle or an ellipse.
    let ([width, height], _) = drawn(60, SPRAY);
    assert!(width > 10 && height.abs_diff(width) < width / 3, "{width} x {height}");
    let ([width, height], _) = drawn(60, FOAM);
    assert!(width > 10 && 2 * height < width, "{width} x {height}");
    // Control: a bubble is a disc.
    let ([width, height], count) = drawn(1, BUBBLE);
    assert!(height.abs_diff(width) < 2 && 2 * count > width * height, "{count} of {width} x {height}");
}

/// Light per pixel, row by row, that a picture has more than another. Blending is linear in it.
fn added_light(a: &Picture, b: &Picture) -> Vec<f32> {
    let linear = |byte: u8| {
        let c = f32::from(byte) / 255.0;
        if c <= 0.040_45 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
    };
    let green = |picture: &Picture| -> Vec<f32> {
        picture.rgba.chunks_exact(4).map(|pixel| linear(pixel[1])).collect()
    };
    green(a).into_iter().zip(green(b)).map(|(a, b)| a - b).collect()
}

/// The groups of connected pixels with more light than `limit`: their numbers of pixels, the largest first.
fn spots(light: &[f32], limit: f32) -> Vec<usize> {
    let width = SIZE[0] as usize;
    let mut is_bright: Vec<bool> = light.iter().map(|&light| light > limit).collect();
    let mut found = Vec::new();
    for start in 0..is_bright.len() {
        let (mut waiting, mut count) = (vec![start], 0);
        while let Some(at) = waiting.pop() {
            if !std::mem::take(&mut is_bright[at]) {
                continue;
            }
            count += 1;
            // Groups are not at the border of the picture.
            waiting.extend([at - 1, at + 1, at - width, at + width]);
        }
        found.extend((count > 0).then_some(count));
    }
    found.sort_unstable_by(|a, b| b.cmp(a));
    found
}

#[test]
fn the_groups_of_spray_and_foam_differ_and_have_few_large_members() {
    let Some(mut harness) = common::harness() else { return };
    let behind = backdrop(&harness);
    let frame = frame().with_particles(dark(&behind, 4.0));
    let empty = harness.draw(SIZE, &frame);
    let ids: Vec<u32> = (0..16).collect();
    for kind in [SPRAY, FOAM] {
        let mut numbers = std::collections::BTreeMap::new();
        let (mut largest, mut next) = (0, 0);
        for &id in &ids {
            let foam = UploadedFoam::new(&harness.device, &[[0.0; 3]], &[3.0], &[id], &[kind]).unwrap();
            let picture = harness.draw(SIZE, &frame.with_foam(DrawnFoam::new(foam.buffers(), 0.7)));
            let spots = spots(&added_light(&picture, &empty), 0.15);
            *numbers.entry(spots.len()).or_insert(0) += 1;
            largest += spots[0];
            next += spots.get(1).copied().unwrap_or(0);
        }
        // Equal members have areas that differ by a few pixels, and are equally many in each group.
        assert!(2 * largest > 3 * next, "kind {kind}: {largest} and {next} pixels");
        assert!(numbers.len() >= 3, "kind {kind}: groups by the number of spots: {numbers:?}");
    }
}

#[test]
fn moving_particles_are_streaks_along_their_way() {
    let Some(mut harness) = common::harness() else { return };
    let behind = backdrop(&harness);
    let frame = frame().with_particles(dark(&behind, 4.0));
    let empty = harness.draw(SIZE, &frame);
    let pixels_per_metre = 80.0 / (20.0_f32.to_radians().tan() * 4.0);
    for kind in [SPRAY, FOAM, BUBBLE] {
        let mut drawn = |velocity: [f32; 3]| {
            // Many, so that little light is rounded away.
            let n = 12;
            let (places, lifetimes) = (vec![[0.0; 3]; n], vec![3.0; n]);
            let device = &harness.device;
            let ids = vec![5; n];
            let foam =
                UploadedFoam::moving(device, &places, &vec![velocity; n], &lifetimes, &ids, &vec![kind; n]);
            let foam = foam.unwrap();
            let foam = DrawnFoam::new(foam.buffers(), RADIUS).with_shutter(0.05);
            let picture = harness.draw(SIZE, &frame.with_foam(foam));
            extent(&picture, &empty).0
        };
        let [width, height] = drawn([0.0; 3]);
        // 0.6 m in 0.05 s.
        let [longer, as_high] = drawn([12.0, 0.0, 0.0]);
        let way = 0.6 * pixels_per_metre;
        assert!((longer as f32 - width as f32 - way).abs() < 0.35 * way, "kind {kind}: {width}, {longer}");
        assert!(as_high.abs_diff(height) <= 4, "kind {kind}: {height}, {as_high}");
        // Control: motion along the view is not visible.
        let [same, _] = drawn([0.0, 0.0, 12.0]);
        assert!(same.abs_diff(width) <= 1, "kind {kind}: {width}, {same}");
    }
}

#[test]
fn a_streak_has_the_light_of_the_particle_at_rest() {
    let Some(mut harness) = common::harness() else { return };
    let behind = backdrop(&harness);
    let frame = frame().with_particles(dark(&behind, 4.0));
    let empty = harness.draw(SIZE, &frame);
    // Single particles: the opacities of several do not add.
    let mut light = |kind: u32, speed: f32| -> f32 {
        (0..8)
            .map(|id| {
                let velocities = [[0.8 * speed, 0.6 * speed, 0.0]];
                let device = &harness.device;
                let foam = UploadedFoam::moving(device, &[[0.0; 3]], &velocities, &[3.0], &[id], &[kind]);
                let foam = foam.unwrap();
                let foam = DrawnFoam::new(foam.buffers(), 0.4).with_shutter(0.05);
                let picture = harness.draw(SIZE, &frame.with_foam(foam));
                added_light(&picture, &empty).into_iter().filter(|light| *light > 0.0).sum::<f32>()
            })
            .sum()
    };
    for kind in [SPRAY, FOAM] {
        let rest = light(kind, 0.0);
        let slow = light(kind, 2.0) / rest;
        let fast = light(kind, 8.0) / rest;
        // Members of a group hide one another less where they are thinner; faint parts are rounded away.
        assert!((slow - 1.0).abs() < 0.15 && (fast - 1.0).abs() < 0.25, "kind {kind}: {slow}, {fast}");
    }
}

#[test]
fn particles_below_a_pixel_do_not_vanish_or_flicker() {
    let Some(mut harness) = common::harness() else { return };
    let behind = backdrop(&harness);
    let frame = frame().with_particles(dark(&behind, 4.0));
    let empty = harness.draw(SIZE, &frame);
    // A pixel at the place of the particles is about 18 mm wide.
    let pixel = 4.0 * 2.0 * 20.0_f32.to_radians().tan() / SIZE[1] as f32;
    for (kind, smallest) in [(SPRAY, 0.7), (FOAM, 0.7), (BUBBLE, 1.5)] {
        // The brightness per area and particle of some particles at one place.
        let mut brightness = |count: usize, radius: f32, shift: f32| {
            let places = vec![[shift * pixel, 0.6 * shift * pixel, 0.0]; count];
            let (lifetimes, kinds) = (vec![3.0; count], vec![kind; count]);
            let foam =
                UploadedFoam::new(&harness.device, &places, &lifetimes, &vec![3; count], &kinds).unwrap();
            let picture = harness.draw(SIZE, &frame.with_foam(DrawnFoam::new(foam.buffers(), radius)));
            let pixels = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| [x, y]));
            let sum: i32 = pixels.map(|place| brighter(&picture, &empty, place).max(0)).sum();
            sum as f32 / (count as f32 * radius * radius)
        };
        let large = brightness(1, 20.0 * pixel, 0.0);
        // Several, so that the light is not rounded away; rounding makes it more.
        let ratios = [0.0, 0.2, 0.45, 0.7].map(|shift| brightness(8, smallest * pixel, shift) / large);
        let (least, most) =
            (ratios.into_iter().fold(f32::MAX, f32::min), ratios.into_iter().fold(0.0, f32::max));
        assert!(least > 0.6 && most < 1.5 * least, "kind {kind}: {ratios:?} of the light of large ones");
    }
}

#[test]
fn spheres_hide_foam() {
    let Some(mut harness) = common::harness() else { return };
    let ball = UploadedParticles::new(&harness.device, &[[0.0; 3]], &[], &[], &[]).unwrap();
    let with_ball = frame().with_particles(dark(&ball, 0.6));
    let alone = harness.draw(SIZE, &with_ball);
    for kind in [SPRAY, FOAM, BUBBLE] {
        let behind = draw(&mut harness, &[[0.0, 0.0, -1.5]], 3.0, kind, with_ball);
        assert!(brighter(&behind, &alone, MIDDLE).abs() < 6, "kind {kind} is visible");
        let before = draw(&mut harness, &[[0.0, 0.0, 1.5]], 3.0, kind, with_ball);
        assert!(brighter(&before, &alone, MIDDLE) > 20, "kind {kind} is hidden");
    }
}

#[test]
fn bubbles_are_visible_through_clear_liquid_and_hidden_by_opaque_liquid() {
    let Some(mut harness) = common::harness() else { return };
    let behind = backdrop(&harness);
    for (clear, seen) in [(true, true), (false, false)] {
        let (ball, liquid) = liquid_ball(&harness, 0.8, clear);
        let surface = DrawnSurface::new(ball.buffers(), liquid);
        let with_liquid = frame().with_surface(surface).with_particles(dark(&behind, 4.0));
        let alone = harness.draw(SIZE, &with_liquid);
        let inside = draw(&mut harness, &[[0.0; 3]], 3.0, BUBBLE, with_liquid);
        let here = brighter(&inside, &alone, MIDDLE);
        assert_eq!(here > 15, seen, "through {liquid:?}, the pixel of a bubble is brighter by {here}");
        // The surface hides spray and foam at that depth.
        for kind in [SPRAY, FOAM] {
            let inside = draw(&mut harness, &[[0.0, 0.0, -0.3]], 3.0, kind, with_liquid);
            assert!(brighter(&inside, &alone, MIDDLE).abs() < 6);
        }
    }
}

#[test]
fn the_surface_does_not_cut_foam() {
    let Some(mut harness) = common::harness() else { return };
    let (ball, liquid) = liquid_ball(&harness, 0.8, false);
    let surface = DrawnSurface::new(ball.buffers(), liquid);
    let with_liquid = frame().with_surface(surface);
    let alone = harness.draw(SIZE, &with_liquid);
    // Half a particle spacing below the surface, foam is visible and spray is not.
    let sunk = [[0.0, 0.0, 0.8 - RADIUS]];
    let foam = draw(&mut harness, &sunk, 3.0, FOAM, with_liquid);
    assert!(brighter(&foam, &alone, MIDDLE) > 100);
    let spray = draw(&mut harness, &sunk, 3.0, SPRAY, with_liquid);
    assert!(brighter(&spray, &alone, MIDDLE).abs() < 6);
}

#[test]
fn a_droplet_does_not_hide_spray_behind_it() {
    let Some(mut harness) = common::harness() else { return };
    let droplet = UploadedDroplets::new(&harness.device, &[[0.0; 3]], &[]).unwrap();
    let drawn = DrawnDroplets::new(droplet.buffers(), 0.5, Liquid::water());
    let with_droplet = frame().with_droplets(drawn);
    let alone = harness.draw(SIZE, &with_droplet);
    let both = draw(&mut harness, &[[0.0, 0.0, -1.5]; 4], 3.0, SPRAY, with_droplet);
    let (_, changed) = extent(&both, &alone);
    assert!(changed > 20, "{changed} pixels");
}

#[test]
fn invalid_exposures_are_refused() {
    let Some(mut harness) = common::harness() else { return };
    let foam = UploadedFoam::new(&harness.device, &[[0.0; 3]], &[], &[], &[SPRAY]).unwrap();
    let mut target = Offscreen::new(&harness.device, &harness.queue, SIZE).unwrap();
    for (shutter, valid) in
        [(0.0, true), (0.1, true), (-1.0, false), (f32::NAN, false), (f32::INFINITY, false)]
    {
        let drawn = DrawnFoam::new(foam.buffers(), RADIUS).with_shutter(shutter);
        let result = target.render_to_rgba(&mut harness.renderer, &frame().with_foam(drawn));
        assert_eq!(result.is_ok(), valid, "a shutter of {shutter} s");
    }
}

#[test]
fn lists_of_different_lengths_are_refused() {
    let Some(harness) = common::harness() else { return };
    let error = UploadedFoam::new(&harness.device, &[[0.0; 3]; 2], &[], &[], &[0]).unwrap_err();
    assert!(error.to_string().contains("kinds"), "{error}");
    assert!(UploadedFoam::new(&harness.device, &[[0.0; 3]; 2], &[1.0], &[], &[0, 1]).is_err());
    assert!(UploadedFoam::new(&harness.device, &[], &[], &[], &[]).is_ok());
}
