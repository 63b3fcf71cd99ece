//! Pictures with traced rays, compared with Snell's law, Beer-Lambert, and a reference picture.

#[path = "../common/mod.rs"]
mod common;

mod absorption;
mod inside;
mod refraction;
mod samples;
mod sunlight;

use common::{Harness, Picture, sample, with};
use splashdown_render::*;

const SIZE: [u32; 2] = [320, 240];

/// The level of the water in a tank of 2 x 1 x 1 m.
const LEVEL: f32 = 0.6;

const RED: [f32; 3] = [0.8, 0.03, 0.03];

fn domain() -> Domain {
    Domain::closed([0.0; 3], [2.0, 1.0, 1.0])
}

/// A box with flat faces, counterclockwise as seen from outside.
fn slab(low: [f32; 3], high: [f32; 3]) -> sample::Mesh {
    let mut mesh = sample::Mesh { vertices: vec![], normals: vec![], triangles: vec![] };
    for face in 0..6 {
        let (axis, upper) = (face / 2, face % 2 == 1);
        let (u, v) = if upper { ((axis + 1) % 3, (axis + 2) % 3) } else { ((axis + 2) % 3, (axis + 1) % 3) };
        let first = mesh.vertices.len() as u32;
        for (a, b) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
            let mut corner = [0.0; 3];
            corner[axis] = if upper { high[axis] } else { low[axis] };
            corner[u] = if a == 0 { low[u] } else { high[u] };
            corner[v] = if b == 0 { low[v] } else { high[v] };
            let mut normal = [0.0; 3];
            normal[axis] = if upper { 1.0 } else { -1.0 };
            mesh.vertices.push(corner);
            mesh.normals.push(normal);
        }
        mesh.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    }
    mesh
}

/// Draws a liquid and a body with traced rays.
fn draw(
    harness: &mut Harness,
    water: &sample::Mesh,
    liquid: Liquid,
    body: Option<&PlacedBody>,
    camera: Camera,
    quality: Quality,
) -> Picture {
    let device = &harness.device;
    let surface = UploadedSurface::new(device, &water.vertices, &water.normals, &water.triangles).unwrap();
    let place = ([0.0; 3], [0.0, 0.0, 0.0, 1.0]);
    let placed = || body.map(|body| (body, place.0, place.1));
    let meshes =
        TracedMeshes::new(device, &water.vertices, &water.normals, &water.triangles, placed()).unwrap();
    let bodies = UploadedBodies::new(device, placed());
    let mut frame = Frame::new(camera, domain())
        .with_surface(DrawnSurface::new(surface.buffers(), liquid))
        .with_tracing(&meshes, quality);
    frame.bodies = body.map(|_| bodies.buffers());
    harness.draw(SIZE, &frame)
}

fn one_sample() -> Quality {
    with(Quality::STANDARD, |q| q.samples = 1)
}

fn tank() -> sample::Mesh {
    slab([0.0; 3], [2.0, LEVEL, 1.0])
}

fn ball(centre: [f32; 3], radius: f32, colour: [f32; 3]) -> PlacedBody {
    let mesh = sample::ball(centre, radius, 32);
    PlacedBody::new(&mesh.vertices, &mesh.triangles, colour).unwrap()
}

fn pixel_of(camera: Camera, point: [f32; 3]) -> [u32; 2] {
    camera.project(point, SIZE).unwrap().unwrap().map(|x| x as u32)
}

fn is_red([r, g, b]: [u8; 3]) -> bool {
    i32::from(r) - i32::from(g.max(b)) > 40
}

/// The light that a stored byte stands for: the inverse of the sRGB encoding and of the tone curve.
fn light(byte: u8) -> f64 {
    let stored = f64::from(byte) / 255.0;
    let y = if stored <= 0.04045 { stored / 12.92 } else { ((stored + 0.055) / 1.055).powf(2.4) };
    let (a, b) = (2.51 - 2.43 * y, 0.03 - 0.59 * y);
    ((b * b + 0.56 * a * y).sqrt() - b) / (2.0 * a)
}

/// The vertical component of the unit vector to the sun.
fn height_of_sun() -> f64 {
    let [x, y, z] = Frame::SUN.map(f64::from);
    y / (x * x + y * y + z * z).sqrt()
}
