//! The samples of a picture, and the picture that they make.

use super::{RED, SIZE, ball, domain, draw, is_red, pixel_of, slab, tank};
use crate::common::{self, Harness, Picture, sample, with};
use splashdown_render::*;

#[test]
fn more_samples_show_the_same_picture_and_a_lens_blurs_it() {
    let Some(mut harness) = common::harness() else { return };
    let water = sample::waves([0.0; 3], [2.0, 1.0, 1.0], 64);
    let body = ball([1.0, 0.75, 0.5], 0.12, RED);
    let camera = Camera::framing(&domain(), 28.0, 18.0, 35.0, 1.33);
    let mut drawn = |quality| draw(&mut harness, &water, Liquid::water(), Some(&body), camera, quality);
    let few = drawn(Quality::STANDARD);
    let many = drawn(with(Quality::FINAL, |q| q.samples = 17));
    let difference = many.difference(&few);
    assert!(difference.mean < 4.0, "{difference:?}");
    let lens = drawn(with(Quality::FINAL, |q| (q.samples, q.aperture, q.focus) = (17, 0.3, Some(1.0))));
    let centre = pixel_of(camera, [1.0, 0.75, 0.5]);
    assert!(is_red(few.pixel(centre)) && is_red(many.pixel(centre)));
    // The sharp outline of the body becomes wide.
    let reds = |picture: &Picture| {
        let all = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| [x, y]));
        all.filter(|at| is_red(picture.pixel(*at))).count()
    };
    assert!(many.difference(&lens).mean > 2.0 * difference.mean);
    assert!(reds(&lens) != reds(&many));
}

#[test]
fn waves_in_a_tank() {
    let Some(mut harness) = common::harness() else { return };
    let size = [160, 120];
    let mesh = sample::waves([0.0; 3], [2.0, 1.0, 1.0], 96);
    let Harness { device, .. } = &harness;
    let surface = UploadedSurface::new(device, &mesh.vertices, &mesh.normals, &mesh.triangles).unwrap();
    let meshes = TracedMeshes::new(device, &mesh.vertices, &mesh.normals, &mesh.triangles, []).unwrap();
    let frame = |azimuth: f32, liquid: Liquid| {
        let camera = Camera::framing(&domain(), azimuth, 18.0, 35.0, 1.4);
        let drawn = DrawnSurface::new(surface.buffers(), liquid);
        Frame::new(camera, domain()).with_surface(drawn).with_tracing(&meshes, Quality::STANDARD)
    };
    let picture = harness.draw(size, &frame(28.0, Liquid::water()));
    picture.expect("traced-water");
    assert!(!harness.draw(size, &frame(30.0, Liquid::water())).difference(&picture).is_small());
    assert!(!harness.draw(size, &frame(28.0, Liquid::oil())).difference(&picture).is_small());
    let mut rough = frame(28.0, Liquid::water());
    rough.traced = None;
    assert!(!harness.draw(size, &rough).difference(&picture).is_small(), "the interactive picture");
}

#[test]
fn invalid_meshes_and_qualities_are_refused() {
    let Some(mut harness) = common::harness() else { return };
    let tank = tank();
    let wrong = [[0, 1, 999]];
    let error = TracedMeshes::new(&harness.device, &tank.vertices, &tank.normals, &wrong, []).unwrap_err();
    assert!(matches!(error, RenderError::Index { .. }), "{error}");
    let error = TracedMeshes::new(&harness.device, &tank.vertices, &tank.normals[1..], &tank.triangles, [])
        .unwrap_err();
    assert!(matches!(error, RenderError::Length { .. }), "{error}");
    let Harness { device, queue, renderer } = &mut harness;
    let surface = UploadedSurface::new(device, &tank.vertices, &tank.normals, &tank.triangles).unwrap();
    let meshes = TracedMeshes::new(device, &tank.vertices, &[], &tank.triangles, []).unwrap();
    let camera = Camera::framing(&domain(), 28.0, 18.0, 35.0, 1.33);
    let frame = Frame::new(camera, domain())
        .with_surface(DrawnSurface::new(surface.buffers(), Liquid::water()))
        .with_tracing(&meshes, with(Quality::STANDARD, |q| q.samples = 0));
    let mut target = Offscreen::new(device, queue, SIZE).unwrap();
    let error = target.render_to_rgba(renderer, &frame).unwrap_err();
    assert!(error.to_string().contains("1 to 4096 samples"), "{error}");
}

#[test]
fn samples_of_several_frames_are_averaged() {
    let Some(mut harness) = common::harness() else { return };
    let camera = Camera::orbit([1.0, 0.5, 0.5], 3.0, 0.0, 20.0, 40.0);
    let quality = with(Quality::STANDARD, |q| q.samples = 4);
    let (water, place) = (tank(), [0.0, 0.0, 0.0, 1.0]);
    let body = ball([0.0; 3], 0.12, RED);
    let device = harness.device.clone();
    let surface = UploadedSurface::new(&device, &water.vertices, &water.normals, &water.triangles).unwrap();
    let moment = |x: f32| {
        let placed = || [(&body, [x, 0.85, 0.5], place)];
        let meshes = TracedMeshes::new(&device, &water.vertices, &water.normals, &water.triangles, placed());
        (meshes.unwrap(), UploadedBodies::new(&device, placed()))
    };
    let moments = [moment(0.6), moment(1.4)];
    let [left, right] = moments.each_ref().map(|(meshes, bodies)| {
        Frame::new(camera, domain())
            .with_surface(DrawnSurface::new(surface.buffers(), Liquid::water()))
            .with_bodies(bodies.buffers())
            .with_tracing(meshes, quality)
    });
    let mut draw = |first: &Frame<'_>, second: &Frame<'_>| {
        let Harness { device, queue, renderer } = &mut harness;
        let mut target = Offscreen::new(device, queue, SIZE).unwrap();
        target.submit_samples(renderer, first, 0..2).unwrap();
        let ticket = target.submit_from(renderer, second, 2).unwrap().expect("a picture of one tile");
        Picture { size: SIZE, rgba: target.collect(ticket).unwrap() }
    };
    let (blurred, at_left) = (draw(&left, &right), draw(&left, &left));
    let green = |picture: &Picture, x: f32| picture.pixel(pixel_of(camera, [x, 0.85, 0.5]))[1];
    let (ball, sky) = (green(&at_left, 0.6), green(&at_left, 1.4));
    assert!(sky > ball + 80, "{sky} {ball}");
    // Both places show the ball for half of the time.
    for x in [0.6, 1.4] {
        let both = green(&blurred, x);
        assert!(both > ball + 20 && both + 20 < sky, "{x}: {both} between {ball} and {sky}");
    }
    // From one frame, the parts give the picture of one call.
    assert_eq!(at_left.rgba, harness.draw(SIZE, &left).rgba);
}

/// Averages in half precision would lose the samples that are small beside them.
#[test]
fn many_samples_are_as_bright_as_a_few() {
    let Some(mut harness) = common::harness() else { return };
    let size = [12, 9];
    let mesh = slab([0.0; 3], [2.0, 0.2, 1.0]);
    let Harness { device, .. } = &harness;
    let surface = UploadedSurface::new(device, &mesh.vertices, &mesh.normals, &mesh.triangles).unwrap();
    let meshes = TracedMeshes::new(device, &mesh.vertices, &mesh.normals, &mesh.triangles, []).unwrap();
    let camera = Camera::framing(&domain(), 28.0, 4.0, 35.0, 1.33);
    let mut brightness = |samples: u32| {
        let quality = with(Quality::STANDARD, |q| q.samples = samples);
        let drawn = DrawnSurface::new(surface.buffers(), Liquid::water());
        let frame = Frame::new(camera, domain()).with_surface(drawn).with_tracing(&meshes, quality);
        let picture = harness.draw(size, &frame);
        let pixels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| [x, y]));
        let bytes: Vec<f64> = pixels.flat_map(|at| picture.pixel(at)).map(f64::from).collect();
        bytes.iter().sum::<f64>() / bytes.len() as f64
    };
    let (few, many) = (brightness(17), brightness(150));
    assert!((many - few).abs() < 1.0, "{few} and {many} of 255");
}
