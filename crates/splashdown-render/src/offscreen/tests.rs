//! Pictures of tiles equal those in one piece.

use super::*;
use crate::*;
use sample::{Mesh, ball, collapsing_column, waves};
use splashdown_gpu::{DeviceRequest, Gpu};
use std::sync::Arc;

#[path = "../../tests/common/sample.rs"]
mod sample;

const SIZE: [u32; 2] = [200, 120];
/// Twenty tiles or more.
const TEXTURE: [u32; 2] = [52, 36];

struct Harness {
    gpu: Gpu,
    renderer: Renderer,
}

fn harness() -> Option<Harness> {
    match Gpu::open(&DeviceRequest::Auto) {
        Ok(gpu) => {
            gpu.device.on_uncaptured_error(Arc::new(|error| panic!("{error}")));
            let renderer = Renderer::new(&gpu.device, &gpu.queue, Offscreen::FORMAT, 4).unwrap();
            Some(Harness { gpu, renderer })
        }
        Err(error) => {
            assert!(std::env::var("CI").is_err(), "CI must have a Vulkan driver: {error}");
            eprintln!("SKIPPED: {error}");
            None
        }
    }
}

/// How two pictures differ.
#[derive(Debug)]
struct Difference {
    /// Fraction of the pixels that differ by more than 1 of 255 in a channel.
    fraction: f64,
}

impl Difference {
    /// Rounding moves corners of triangles by up to 1/256 of a pixel, which changes a few pixels at outlines. A missing
    /// border or another seed changes many more: see the negative controls.
    fn is_rounding(&self) -> bool {
        self.fraction <= 0.001
    }
}

fn difference(a: &[u8], b: &[u8]) -> Difference {
    assert_eq!(a.len(), b.len());
    let differs = |(a, b): (&[u8], &[u8])| a.iter().zip(b).any(|(a, b)| a.abs_diff(*b) > 1);
    let count = a.chunks_exact(4).zip(b.chunks_exact(4)).filter(|pair| differs(*pair)).count();
    Difference { fraction: 4.0 * count as f64 / a.len() as f64 }
}

impl Harness {
    fn target(&self, size: [u32; 2], texture: [u32; 2]) -> Offscreen {
        Offscreen::with_texture(&self.gpu.device, &self.gpu.queue, size, texture).unwrap()
    }

    fn whole(&mut self, size: [u32; 2], frame: &Frame<'_>) -> Vec<u8> {
        self.target(size, size).render_to_rgba(&mut self.renderer, frame).unwrap()
    }

    /// The difference between the picture in one piece and in tiles, with their own or another border.
    fn tiled(&mut self, frame: &Frame<'_>, border: Option<u32>) -> Difference {
        self.tiled_in(TEXTURE, frame, border)
    }

    fn tiled_in(&mut self, texture: [u32; 2], frame: &Frame<'_>, border: Option<u32>) -> Difference {
        let whole = self.whole(SIZE, frame);
        let mut target = self.target(SIZE, texture);
        target.border = border;
        let tiled = target.render_to_rgba(&mut self.renderer, frame).unwrap();
        difference(&whole, &tiled)
    }

    fn surface(&self, mesh: &Mesh) -> UploadedSurface {
        UploadedSurface::new(&self.gpu.device, &mesh.vertices, &mesh.normals, &mesh.triangles).unwrap()
    }
}

fn domain() -> Domain {
    Domain::closed([0.0; 3], [2.0, 1.0, 1.0])
}

fn frame() -> Frame<'static> {
    Frame::new(Camera::framing(&domain(), 28.0, 18.0, 35.0, 5.0 / 3.0), domain())
}

/// Foam, spray and bubbles in and over the waves, and droplets.
struct Spray {
    foam: UploadedFoam,
    droplets: UploadedDroplets,
}

impl Spray {
    fn new(device: &Device) -> Spray {
        let places: Vec<[f32; 3]> = (0..60)
            .map(|i| [0.033 * i as f32, 0.3 + 0.6 * (0.37 * i as f32).fract(), (0.61 * i as f32).fract()])
            .collect();
        let velocities = vec![[1.0, 0.5, -0.3]; places.len()];
        let kinds: Vec<u32> = (0..60).map(|i| i % 3).collect();
        Spray {
            foam: UploadedFoam::moving(device, &places, &velocities, &[], &[], &kinds).unwrap(),
            droplets: UploadedDroplets::new(device, &places[..20], &velocities[..20]).unwrap(),
        }
    }

    fn add_to<'a>(&'a self, frame: Frame<'a>) -> Frame<'a> {
        let droplets = DrawnDroplets::new(self.droplets.buffers(), 0.03, Liquid::water()).with_shutter(0.03);
        frame.with_foam(DrawnFoam::new(self.foam.buffers(), 0.04).with_shutter(0.03)).with_droplets(droplets)
    }
}

fn red_ball() -> PlacedBody {
    let mesh = ball([0.0; 3], 0.25, 24);
    PlacedBody::new(&mesh.vertices, &mesh.triangles, [0.6, 0.05, 0.05]).unwrap()
}

const PLACE: ([f32; 3], [f32; 4]) = ([1.4, 0.3, 0.6], [0.0, 0.0, 0.0, 1.0]);

#[test]
fn a_mesh_with_everything_is_the_same_in_tiles() {
    let Some(mut harness) = harness() else { return };
    let device = harness.gpu.device.clone();
    let surface = harness.surface(&waves([0.0; 3], [2.0, 1.0, 1.0], 64));
    let body = red_ball();
    let bodies = UploadedBodies::new(&device, [(&body, PLACE.0, PLACE.1)]);
    let spray = Spray::new(&device);
    for style in [SurfaceStyle::Liquid, SurfaceStyle::LiquidWithLines] {
        let drawn = DrawnSurface::new(surface.buffers(), Liquid::water()).with_style(style);
        let frame =
            spray.add_to(frame()).with_surface(drawn).with_bodies(bodies.buffers()).with_caption("t = 1 s");
        let difference = harness.tiled(&frame, None);
        assert!(difference.is_rounding(), "{style:?}: {difference:?}");
        // Negative control: without the border, in which the thickness is read.
        let without = harness.tiled(&frame, Some(0));
        assert!(!without.is_rounding(), "{without:?}");
    }
}

#[test]
fn a_drop_and_a_body_behind_it_are_the_same_in_tiles() {
    let Some(mut harness) = harness() else { return };
    let drop = harness.surface(&ball([1.0, 0.5, 0.7], 0.25, 64));
    let body = red_ball();
    let bodies = UploadedBodies::new(&harness.gpu.device, [(&body, [1.0, 0.35, 0.2], PLACE.1)]);
    let drawn = DrawnSurface::new(drop.buffers(), Liquid::water());
    let frame = frame().with_surface(drawn).with_bodies(bodies.buffers());
    let difference = harness.tiled(&frame, None);
    assert!(difference.is_rounding(), "{difference:?}");
    // Negative control: only the texel of the thickness, from which no normal follows.
    let without = harness.tiled(&frame, Some(2));
    assert!(!without.is_rounding(), "{without:?}");
}

#[test]
fn particles_and_slices_are_the_same_in_tiles() {
    let Some(mut harness) = harness() else { return };
    let cloud = collapsing_column([2.0, 1.0, 1.0], 0.05);
    let particles = UploadedParticles::new(
        &harness.gpu.device,
        &cloud.positions,
        &cloud.velocities,
        &cloud.densities,
        &cloud.pressures,
    )
    .unwrap();
    let colouring = Colouring::new(Quantity::Speed, [0.0, 3.0]);
    let mut edges = frame().with_caption("t = 1 s");
    edges.tank = Tank::Edges;
    let spheres = edges.with_particles(DrawnParticles::new(particles.buffers(), 0.025, colouring));
    let slice = edges.with_slice(DrawnSlice::new(particles.buffers(), Axis::Z, 0.5, 0.025, colouring));
    for frame in [spheres, slice] {
        let difference = harness.tiled(&frame, None);
        assert!(difference.is_rounding(), "{difference:?}");
    }
    // Negative control: tiles at odd places have other blocks of pixels, and another camera shows something else.
    let other = Frame { camera: Camera::framing(&domain(), 28.2, 18.0, 35.0, 5.0 / 3.0), ..spheres };
    let difference = difference(&harness.whole(SIZE, &spheres), &harness.whole(SIZE, &other));
    assert!(!difference.is_rounding(), "{difference:?}");
}

#[test]
fn a_liquid_of_particles_is_the_same_in_tiles() {
    let Some(mut harness) = harness() else { return };
    // Large spheres, so that the filters reach far beyond the margin that all pictures have.
    let cloud = collapsing_column([2.0, 1.0, 1.0], 0.2);
    let particles = UploadedParticles::new(&harness.gpu.device, &cloud.positions, &[], &[], &[]).unwrap();
    let drawn = DrawnLiquidParticles::new(particles.buffers(), 0.1, Liquid::water());
    let frame = frame().with_liquid_particles(drawn);
    // The tiles have to be larger than the borders, which are smaller otherwise.
    let texture = [224, 160];
    let border = frame.border([400, 240]).unwrap();
    assert!((40..70).contains(&border), "{border}");
    let whole = harness.whole([400, 240], &frame);
    let mut tiled = |border: u32| {
        let mut target = harness.target([400, 240], texture);
        target.border = Some(border.next_multiple_of(2));
        difference(&whole, &target.render_to_rgba(&mut harness.renderer, &frame).unwrap())
    };
    let difference = tiled(border);
    assert!(difference.is_rounding(), "{difference:?}");
    // Negative control: the margin alone.
    let narrow = tiled(2);
    assert!(!narrow.is_rounding(), "{narrow:?}");
}

#[test]
fn traced_rays_are_the_same_in_tiles() {
    let Some(mut harness) = harness() else { return };
    let device = harness.gpu.device.clone();
    let mesh = waves([0.0; 3], [2.0, 1.0, 1.0], 24);
    let surface = harness.surface(&mesh);
    let body = red_ball();
    let bodies = UploadedBodies::new(&device, [(&body, PLACE.0, PLACE.1)]);
    let placed = [(&body, PLACE.0, PLACE.1)];
    let traced = TracedMeshes::new(&device, &mesh.vertices, &mesh.normals, &mesh.triangles, placed).unwrap();
    let spray = Spray::new(&device);
    let drawn = DrawnSurface::new(surface.buffers(), Liquid::water());
    let scene =
        spray.add_to(frame()).with_surface(drawn).with_bodies(bodies.buffers()).with_caption("t = 1 s");
    // Few samples, and many, which choose at random between reflection and refraction.
    let lens = Quality { samples: 17, aperture: 0.02, shutter: 0.02, ..Quality::FINAL };
    // The rays of the sun are followed for every tile, which takes the most time here.
    for (quality, texture) in [(Quality::STANDARD, [104, 64]), (lens, [104, 124])] {
        let difference = harness.tiled_in(texture, &scene.with_tracing(&traced, quality), None);
        assert!(difference.is_rounding(), "{quality:?}: {difference:?}");
    }
    // An eye in the liquid.
    let inside = Camera::orbit([1.0, 0.3, 0.5], 0.4, 20.0, 5.0, 60.0);
    let frame = Frame { camera: inside, ..scene }.with_tracing(&traced, Quality::STANDARD);
    let difference_inside = harness.tiled_in([104, 64], &frame, None);
    assert!(difference_inside.is_rounding(), "{difference_inside:?}");

    // Negative control: the same rays with the random numbers of other pixels. A larger picture of a wider view shows
    // the picture in its middle.
    let camera = scene.camera;
    let tangent = (0.5 * camera.field_of_view_deg).to_radians().tan();
    let wide = [SIZE[0] + 40, SIZE[1] + 24];
    let field_of_view_deg = 2.0 * (tangent * wide[1] as f32 / SIZE[1] as f32).atan().to_degrees();
    let bare = Frame { foam: None, droplets: None, caption: None, ..scene }.with_tracing(&traced, lens);
    let whole = harness.whole(SIZE, &bare);
    let around = harness.whole(wide, &Frame { camera: Camera { field_of_view_deg, ..camera }, ..bare });
    let row = |y: usize| 4 * ((y + 12) * wide[0] as usize + 20);
    let middle: Vec<u8> =
        (0..SIZE[1] as usize).flat_map(|y| around[row(y)..row(y) + 4 * SIZE[0] as usize].to_vec()).collect();
    let other_seeds = difference(&whole, &middle);
    assert!(other_seeds.fraction > 0.01, "{other_seeds:?}");
}

#[test]
fn parts_of_a_picture_are_submitted_for_each_tile() {
    let Some(mut harness) = harness() else { return };
    let device = harness.gpu.device.clone();
    let mesh = waves([0.0; 3], [2.0, 1.0, 1.0], 24);
    let surface = harness.surface(&mesh);
    let traced = TracedMeshes::new(&device, &mesh.vertices, &mesh.normals, &mesh.triangles, []).unwrap();
    let moved: Vec<[f32; 3]> = mesh.vertices.iter().map(|[x, y, z]| [*x, 0.9 * y, *z]).collect();
    let other = Mesh { vertices: moved, ..mesh };
    let other_surface = harness.surface(&other);
    let other_traced =
        TracedMeshes::new(&device, &other.vertices, &other.normals, &other.triangles, []).unwrap();
    let first = frame()
        .with_surface(DrawnSurface::new(surface.buffers(), Liquid::water()))
        .with_tracing(&traced, Quality::STANDARD);
    let second = frame()
        .with_surface(DrawnSurface::new(other_surface.buffers(), Liquid::water()))
        .with_tracing(&other_traced, Quality::STANDARD);
    let mut drawn = |texture: [u32; 2], begin: &Frame<'_>| {
        let mut target = harness.target(SIZE, texture);
        let mut tiles = 0;
        loop {
            tiles += 1;
            target.submit_samples(&mut harness.renderer, begin, 0..2).unwrap();
            if let Some(ticket) = target.submit_from(&mut harness.renderer, &second, 2).unwrap() {
                return (tiles, target.collect(ticket).unwrap());
            }
        }
    };
    let ((one, whole), (many, tiled)) = (drawn(SIZE, &first), drawn(TEXTURE, &first));
    assert_eq!(one, 1);
    assert!(many >= 20, "{many}");
    assert!(difference(&whole, &tiled).is_rounding());
    // Negative control: both parts of the second frame.
    assert!(!difference(&whole, &drawn(SIZE, &second).1).is_rounding());
}

#[test]
fn the_passes_of_all_tiles_are_measured() {
    let Some(mut harness) = harness() else { return };
    let surface = harness.surface(&waves([0.0; 3], [2.0, 1.0, 1.0], 24));
    let frame = frame().with_surface(DrawnSurface::new(surface.buffers(), Liquid::water()));
    if !harness.renderer.set_timing(true) {
        eprintln!("SKIPPED: the device has no timestamps");
        return;
    }
    let mut counts = |texture: [u32; 2]| {
        let mut target = harness.target(SIZE, texture);
        target.render_to_rgba(&mut harness.renderer, &frame).unwrap();
        let timings = harness.renderer.take_timings();
        ["scene", "shade", "picture"].map(|label| timings.passes.get(label).map_or(0, |pass| pass.count))
    };
    assert_eq!(counts(SIZE), [1, 1, 1]);
    // The scenes of all tiles are drawn before those of each.
    assert_eq!(counts([112, 72]), [8, 4, 4]);
    harness.renderer.set_timing(false);
    let mut target = harness.target(SIZE, SIZE);
    target.render_to_rgba(&mut harness.renderer, &frame).unwrap();
    assert!(harness.renderer.take_timings().passes.is_empty(), "negative control: nothing is measured");
}

#[test]
fn an_error_within_a_picture_of_tiles_leaves_the_target_usable() {
    let Some(mut harness) = harness() else { return };
    let mut target = harness.target(SIZE, TEXTURE);
    let good = frame().with_caption("t = 1 s");
    assert!(target.submit_from(&mut harness.renderer, &good, 0).unwrap().is_none());
    let bad = Frame { sun: [0.0; 3], ..good };
    assert!(target.submit_from(&mut harness.renderer, &bad, 0).is_err());
    let tiled = target.render_to_rgba(&mut harness.renderer, &good).unwrap();
    assert!(difference(&harness.whole(SIZE, &good), &tiled).is_rounding());
}
