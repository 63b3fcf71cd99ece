//! Outlines of a liquid that is shaded once per pixel.

mod common;

use common::{Picture, sample};
use splashdown_render::*;

const SIZE: [u32; 2] = [160, 128];

/// The mean of every square of `side` pixels, as linear light.
fn reduced(picture: &Picture, side: u32) -> Vec<[f32; 3]> {
    let [width, height] = picture.size.map(|pixels| pixels / side);
    let linear = |value: u8| (f32::from(value) / 255.0).powf(2.2);
    let mean = |x: u32, y: u32| {
        let within = (0..side * side).map(|n| picture.pixel([x * side + n % side, y * side + n / side]));
        let sum = within.fold([0.0; 3], |sum, pixel| std::array::from_fn(|i| sum[i] + linear(pixel[i])));
        sum.map(|channel: f32| channel / (side * side) as f32)
    };
    (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| mean(x, y)).collect()
}

/// The largest difference of any channel of any pixel.
fn largest(a: &[[f32; 3]], b: &[[f32; 3]]) -> f32 {
    a.iter().zip(b).flat_map(|(a, b)| (0..3).map(|i| (a[i] - b[i]).abs())).fold(0.0, f32::max)
}

#[test]
fn outlines_before_liquid_bodies_and_sky_are_averages() {
    let Some(mut harness) = common::harness() else { return };
    // A turbid liquid depends on the normal, but not on what is behind. A ball of it in front of
    // another one, which a body hides in part.
    let (near, far) = (sample::ball([0.3, 0.0, 0.8], 0.5, 40), sample::ball([-0.3, 0.1, -0.8], 0.8, 40));
    let mut mesh = near;
    let first = mesh.vertices.len() as u32;
    mesh.vertices.extend(far.vertices);
    mesh.normals.extend(far.normals);
    mesh.triangles.extend(far.triangles.iter().map(|corners| corners.map(|corner| first + corner)));
    let surface =
        UploadedSurface::new(&harness.device, &mesh.vertices, &mesh.normals, &mesh.triangles).unwrap();
    let body = sample::ball([-0.5, 0.2, 0.3], 0.3, 40);
    let body = PlacedBody::new(&body.vertices, &body.triangles, [0.05, 0.05, 0.05]).unwrap();
    let bodies = UploadedBodies::new(&harness.device, [(&body, [0.0; 3], [0.0, 0.0, 0.0, 1.0])]);
    let camera = Camera::orbit([0.0; 3], 4.0, 0.0, 5.0, 40.0);
    let frame = Frame::new(camera, Domain::closed([-50.0; 3], [50.0; 3]))
        .with_surface(DrawnSurface::new(surface.buffers(), Liquid::milk()))
        .with_bodies(bodies.buffers());
    let fine = reduced(&harness.draw(SIZE.map(|pixels| 4 * pixels), &frame), 4);
    let smooth = reduced(&harness.draw(SIZE, &frame), 1);
    let difference = largest(&smooth, &fine);
    // With four samples the coverage of a pixel is wrong by less than one of them.
    assert!(difference < 0.25, "an outline differs by {difference}");
    // Negative control: with one sample per pixel it is wrong by up to a half.
    harness.renderer = Renderer::new(&harness.device, &harness.queue, Offscreen::FORMAT, 1).unwrap();
    let rough = largest(&reduced(&harness.draw(SIZE, &frame), 1), &fine);
    assert!(rough > 0.35, "an outline with one sample differs by only {rough}");
}

#[test]
fn normals_without_direction_face_the_eye() {
    let Some(mut harness) = common::harness() else { return };
    let mesh = sample::ball([0.0; 3], 0.8, 12);
    let camera = Camera::orbit([0.0; 3], 4.0, 0.0, 5.0, 40.0);
    let frame = Frame::new(camera, Domain::closed([-50.0; 3], [50.0; 3]));
    let mut draw = |normals: &[[f32; 3]]| {
        let surface =
            UploadedSurface::new(&harness.device, &mesh.vertices, normals, &mesh.triangles).unwrap();
        harness.draw(SIZE, &frame.with_surface(DrawnSurface::new(surface.buffers(), Liquid::milk())))
    };
    let zero = draw(&vec![[0.0; 3]; mesh.vertices.len()]);
    let towards_eye: Vec<[f32; 3]> =
        mesh.vertices.iter().map(|p| [0, 1, 2].map(|axis| camera.eye[axis] - p[axis])).collect();
    let faced = draw(&towards_eye);
    let round = draw(&mesh.normals);
    assert!(zero.difference(&faced).mean < 0.05, "{:?}", zero.difference(&faced));
    // Negative control: the normals of the ball give another picture.
    assert!(zero.difference(&round).mean > 0.5, "{:?}", zero.difference(&round));
}
