//! Foam, spray and bubbles, where pixels can be worked out by hand.

mod common;

use common::{Picture, Studio, sample};
use splashdown_render::*;

const SIZE: [u32; 2] = [200, 160];
const MIDDLE: [u32; 2] = [100, 80];
const SPRAY: u32 = 0;
const FOAM: u32 = 1;
const BUBBLE: u32 = 2;
/// Half the spacing of particles: discs are smaller, 0.1 to 0.2 m.
const RADIUS: f32 = 0.25;

fn frame() -> Frame<'static> {
    let camera = Camera::orbit([0.0; 3], 4.0, 0.0, 0.0, 40.0);
    Frame::new(camera, Domain::closed([-50.0; 3], [50.0; 3]))
}

fn draw(studio: &mut Studio, places: &[[f32; 3]], lifetime: f32, kind: u32, frame: Frame<'_>) -> Picture {
    let n = places.len();
    let foam = UploadedFoam::new(&studio.device, places, &vec![lifetime; n], &[], &vec![kind; n]).unwrap();
    studio.draw(SIZE, &Frame { foam: Some(DrawnFoam { buffers: foam.buffers(), radius: RADIUS }), ..frame })
}

/// How much brighter a pixel is than in another picture, summed over its channels.
fn brighter(a: &Picture, b: &Picture, pixel: [u32; 2]) -> i32 {
    a.pixel(pixel).iter().zip(b.pixel(pixel)).map(|(a, b)| i32::from(*a) - i32::from(b)).sum()
}

/// Black ink before the middle, as a mesh: a ball of this radius.
fn ink(studio: &Studio, radius: f32, clear: bool) -> (UploadedSurface, Liquid) {
    let ball = sample::ball([0.0; 3], radius, 48);
    let ball = UploadedSurface::new(&studio.device, &ball.vertices, &ball.normals, &ball.triangles).unwrap();
    let per_metre = if clear { 0.0 } else { 400.0 };
    let black = Liquid {
        absorption: [per_metre; 3],
        scattering: per_metre,
        film: 0.0,
        colour: [0.0; 3],
        ..Liquid::water(1.0)
    };
    (ball, black)
}

/// A large dark ball far behind the middle: against the horizon white is hardly seen.
fn backdrop(studio: &Studio) -> UploadedParticles {
    UploadedParticles::new(&studio.device, &[[0.0, 0.0, -8.0]], &[], &[], &[]).unwrap()
}

fn dark(ball: &UploadedParticles, radius: f32) -> Option<DrawnParticles<'_>> {
    let colouring = Colouring {
        quantity: Quantity::Speed,
        range: [0.0, 1.0],
        map: ColourMap::Inferno,
        colour_bar: false,
    };
    Some(DrawnParticles { buffers: ball.buffers(), radius, colouring })
}

#[test]
fn each_kind_is_a_white_disc_and_fades() {
    let Some(mut studio) = common::studio() else { return };
    let behind = backdrop(&studio);
    let frame = Frame { particles: dark(&behind, 4.0), ..frame() };
    let empty = studio.draw(SIZE, &frame);
    for kind in [SPRAY, FOAM, BUBBLE] {
        let picture = draw(&mut studio, &[[0.0; 3]], 3.0, kind, frame);
        let here = brighter(&picture, &empty, MIDDLE);
        assert!(here > 40, "kind {kind}: {here}");
        let [r, g, b] = picture.pixel(MIDDLE);
        assert!(r.abs_diff(b) < 60 && g > empty.pixel(MIDDLE)[1], "kind {kind}: {r} {g} {b}");
        // Its last hundredth of a second; and where none is.
        let fading = draw(&mut studio, &[[0.0; 3]], 0.01, kind, frame);
        assert!(brighter(&fading, &empty, MIDDLE) < here / 3);
        assert!(brighter(&picture, &empty, [160, 80]).abs() < 6);
    }
}

#[test]
fn solid_things_hide_it() {
    let Some(mut studio) = common::studio() else { return };
    let ball = UploadedParticles::new(&studio.device, &[[0.0; 3]], &[], &[], &[]).unwrap();
    let with_ball = Frame { particles: dark(&ball, 0.6), ..frame() };
    let alone = studio.draw(SIZE, &with_ball);
    for kind in [SPRAY, FOAM, BUBBLE] {
        let behind = draw(&mut studio, &[[0.0, 0.0, -1.5]], 3.0, kind, with_ball);
        assert!(brighter(&behind, &alone, MIDDLE).abs() < 6, "kind {kind} shines through");
        let before = draw(&mut studio, &[[0.0, 0.0, 1.5]], 3.0, kind, with_ball);
        assert!(brighter(&before, &alone, MIDDLE) > 20, "kind {kind} is hidden");
    }
}

#[test]
fn bubbles_are_seen_through_water_and_hidden_by_ink() {
    let Some(mut studio) = common::studio() else { return };
    let behind = backdrop(&studio);
    for (clear, seen) in [(true, true), (false, false)] {
        let (ball, liquid) = ink(&studio, 0.8, clear);
        let surface = DrawnSurface { buffers: ball.buffers(), liquid, style: SurfaceStyle::Liquid };
        let with_liquid = Frame { surface: Some(surface), particles: dark(&behind, 4.0), ..frame() };
        let alone = studio.draw(SIZE, &with_liquid);
        let inside = draw(&mut studio, &[[0.0; 3]], 3.0, BUBBLE, with_liquid);
        let here = brighter(&inside, &alone, MIDDLE);
        assert_eq!(here > 15, seen, "through {liquid:?} a bubble is {here} brighter");
        // Spray and foam that far inside are hidden by the surface.
        for kind in [SPRAY, FOAM] {
            let inside = draw(&mut studio, &[[0.0, 0.0, -0.3]], 3.0, kind, with_liquid);
            assert!(brighter(&inside, &alone, MIDDLE).abs() < 6);
        }
    }
}

#[test]
fn foam_in_the_surface_is_whole() {
    let Some(mut studio) = common::studio() else { return };
    let (ball, liquid) = ink(&studio, 0.8, false);
    let surface = DrawnSurface { buffers: ball.buffers(), liquid, style: SurfaceStyle::Liquid };
    let with_liquid = Frame { surface: Some(surface), ..frame() };
    let alone = studio.draw(SIZE, &with_liquid);
    // Half a spacing under the skin, where foam is and spray is not.
    let sunk = [[0.0, 0.0, 0.8 - RADIUS]];
    let foam = draw(&mut studio, &sunk, 3.0, FOAM, with_liquid);
    assert!(brighter(&foam, &alone, MIDDLE) > 100);
    let spray = draw(&mut studio, &sunk, 3.0, SPRAY, with_liquid);
    assert!(brighter(&spray, &alone, MIDDLE).abs() < 6);
}

#[test]
fn lists_of_different_lengths_are_refused() {
    let Some(studio) = common::studio() else { return };
    let error = UploadedFoam::new(&studio.device, &[[0.0; 3]; 2], &[], &[], &[0]).unwrap_err();
    assert!(error.to_string().contains("kinds"), "{error}");
    assert!(UploadedFoam::new(&studio.device, &[[0.0; 3]; 2], &[1.0], &[], &[0, 1]).is_err());
    assert!(UploadedFoam::new(&studio.device, &[], &[], &[], &[]).is_ok());
}
