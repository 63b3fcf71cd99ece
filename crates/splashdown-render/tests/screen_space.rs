//! The screen-space surface, in cases where the expected pixels are known.

mod common;

use common::{Harness, Picture, sample, with};
use splashdown_render::*;

const SIZE: [u32; 2] = [200, 160];
const RADIUS: f32 = 0.04;
const DISTANCE: f32 = 4.0;

fn frame() -> Frame<'static> {
    let camera = Camera::orbit([0.0; 3], DISTANCE, 0.0, 0.0, 40.0);
    Frame::new(camera, Domain::closed([-50.0; 3], [50.0; 3]))
}

/// Nearly opaque and green, so that it hides everything behind it and is easy to detect.
fn opaque_green() -> Liquid {
    with(Liquid::water(), |l| {
        l.absorption = [400.0; 3];
        l.scattering = 400.0;
        l.colour = [0.0, 0.4, 0.0];
    })
}

/// A lattice around a point, `counts` particles along each axis.
fn block(centre: [f32; 3], counts: [usize; 3], spacing: f32) -> Vec<[f32; 3]> {
    let mut places = Vec::new();
    for k in 0..counts[2] {
        for j in 0..counts[1] {
            for i in 0..counts[0] {
                let index = [i, j, k];
                places.push(std::array::from_fn(|axis| {
                    centre[axis] + spacing * (index[axis] as f32 - 0.5 * (counts[axis] - 1) as f32)
                }));
            }
        }
    }
    places
}

fn liquid(harness: &mut Harness, places: &[[f32; 3]], liquid: Liquid, frame: Frame<'_>) -> Picture {
    let particles = UploadedParticles::new(&harness.device, places, &[], &[], &[]).unwrap();
    let drawn = DrawnLiquidParticles::new(particles.buffers(), RADIUS, liquid);
    harness.draw(SIZE, &frame.with_liquid_particles(drawn))
}

fn is_green([r, g, b]: [u8; 3]) -> bool {
    i32::from(g) > i32::from(r) + 20 && i32::from(g) > i32::from(b) + 20
}

/// Number of pixels that differ.
fn changed(picture: &Picture, empty: &Picture) -> usize {
    let pairs = picture.rgba.chunks_exact(4).zip(empty.rgba.chunks_exact(4));
    pairs.filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 40)).count()
}

#[test]
fn a_block_covers_its_square() {
    let Some(mut harness) = common::harness() else { return };
    let empty = harness.draw(SIZE, &frame());
    let picture = liquid(&mut harness, &block([0.0; 3], [12, 12, 3], 2.0 * RADIUS), opaque_green(), frame());
    // Spheres of 1.7 radii on a lattice extend 1.597 radii on average beyond the outermost centres.
    // The outline, at a liquid fraction of 0.66, lies 0.412 standard deviations of 0.6 * 1.7 radii
    // further inside.
    let half_side = (11.0 + 1.597 - 0.412 * 0.6 * 1.7) * RADIUS;
    let front = DISTANCE - 2.0 * RADIUS;
    let pixels = 2.0 * half_side / front / 20f32.to_radians().tan() * 80.0;
    let (covered, expected) = (changed(&picture, &empty) as f32, pixels * pixels);
    assert!((covered - expected).abs() < 0.04 * expected, "{covered} pixels, expected {expected}");
    // Negative control: one particle fewer on each side.
    let smaller = liquid(&mut harness, &block([0.0; 3], [10, 10, 3], 2.0 * RADIUS), opaque_green(), frame());
    assert!((changed(&smaller, &empty) as f32) < 0.8 * expected);
}

#[test]
fn a_face_of_many_spheres_looks_flat() {
    let Some(mut harness) = common::harness() else { return };
    // The largest step between neighbouring pixels in the middle.
    let roughness = |picture: &Picture| {
        let middle = || (60..100).flat_map(|y| (80..120).map(move |x| [x, y]));
        let step = |[x, y]: [u32; 2]| picture.pixel([x, y])[1].abs_diff(picture.pixel([x + 1, y])[1]);
        middle().map(step).max().unwrap()
    };
    let face = liquid(&mut harness, &block([0.0; 3], [14, 14, 3], 2.0 * RADIUS), opaque_green(), frame());
    assert!(is_green(face.pixel([100, 80])));
    assert!(roughness(&face) <= 4, "{}", roughness(&face));
    // Negative control: spheres that are too far apart to overlap.
    let apart = liquid(&mut harness, &block([0.0; 3], [7, 7, 3], 4.0 * RADIUS), opaque_green(), frame());
    assert!(roughness(&apart) > 20, "{}", roughness(&apart));
}

#[test]
fn near_liquid_leaves_no_halo_on_far_liquid() {
    let Some(mut harness) = common::harness() else { return };
    let far = block([0.0, 0.0, -1.0], [30, 24, 3], 2.0 * RADIUS);
    let both: Vec<[f32; 3]> =
        far.iter().copied().chain(block([0.0, 0.0, 0.6], [6, 6, 3], 2.0 * RADIUS)).collect();
    let far = liquid(&mut harness, &far, opaque_green(), frame());
    let both = liquid(&mut harness, &both, opaque_green(), frame());
    // The outermost centres of the near block are 5 radii from the middle and its spheres extend
    // 1.7 radii further; plus two pixels.
    let outline = 6.7 * RADIUS / (DISTANCE - 0.6 - 2.0 * RADIUS) / 20f32.to_radians().tan() * 80.0;
    let beside = 100 + (outline + 2.0) as u32;
    for x in beside..beside + 12 {
        let (with, without) = (both.pixel([x, 80]), far.pixel([x, 80]));
        let apart = with.iter().zip(without).map(|(a, b)| a.abs_diff(b)).max().unwrap();
        assert!(apart <= 3, "column {x}: {with:?}, without the near block {without:?}");
    }
    // Negative control: the pictures differ at the outline itself.
    let on = (beside - 8..beside)
        .any(|x| both.pixel([x, 80]).iter().zip(far.pixel([x, 80])).any(|(a, b)| a.abs_diff(b) > 12));
    assert!(on);
}

#[test]
fn the_surface_and_particles_hide_each_other() {
    let Some(mut harness) = common::harness() else { return };
    let colouring =
        Colouring::new(Quantity::Speed, [0.0, 1.0]).with_map(ColourMap::BlueRed).with_colour_bar(false);
    let places = block([0.0; 3], [8, 8, 4], 2.0 * RADIUS);
    let mut with_a_sphere_at = |z: f32, optics: Liquid| {
        let sphere =
            UploadedParticles::new(&harness.device, &[[0.0, 0.0, z]], &[[9.0, 0.0, 0.0]], &[], &[]).unwrap();
        let drawn = DrawnParticles::new(sphere.buffers(), 0.15, colouring);
        let frame = frame().with_particles(drawn);
        liquid(&mut harness, &places, optics, frame).pixel([100, 80])
    };
    let is_red = |[r, _, b]: [u8; 3]| i32::from(r) - i32::from(b) > 40;
    assert!(is_red(with_a_sphere_at(1.0, opaque_green())));
    assert!(is_green(with_a_sphere_at(-1.0, opaque_green())));
    let clear = with(Liquid::water(), |l| {
        l.absorption = [0.0; 3];
        l.scattering = 0.0;
    });
    assert!(is_red(with_a_sphere_at(-1.0, clear)), "visible through clear liquid");
}

#[test]
fn liquid_behind_a_body_does_not_tint_it() {
    let Some(mut harness) = common::harness() else { return };
    let ball = sample::ball([0.0; 3], 0.3, 24);
    let body = PlacedBody::new(&ball.vertices, &ball.triangles, [0.8, 0.1, 0.1]).unwrap();
    let bodies = UploadedBodies::new(&harness.device, [(&body, [0.0; 3], [0.0, 0.0, 0.0, 1.0])]);
    let with_bodies = frame().with_bodies(bodies.buffers());
    let alone = harness.draw(SIZE, &with_bodies).pixel([100, 80]);
    let far = |[r, g, b]: [u8; 3]| r.abs_diff(alone[0]).max(g.abs_diff(alone[1])).max(b.abs_diff(alone[2]));
    let behind = block([0.0, 0.0, -1.0], [8, 8, 4], 2.0 * RADIUS);
    assert!(far(liquid(&mut harness, &behind, opaque_green(), with_bodies).pixel([100, 80])) <= 1);
    // Negative control: liquid in front of the body.
    let before = block([0.0, 0.0, 1.0], [8, 8, 4], 2.0 * RADIUS);
    assert!(far(liquid(&mut harness, &before, opaque_green(), with_bodies).pixel([100, 80])) > 40);
}

#[test]
fn inactive_particles_are_not_drawn_in_any_mode() {
    use wgpu::util::DeviceExt;
    let Some(mut harness) = common::harness() else { return };
    let empty = harness.draw(SIZE, &frame());
    let others = UploadedParticles::new(&harness.device, &[[0.0; 3]; 2], &[], &[], &[]).unwrap();
    let mut covered = |positions: [[f32; 4]; 2]| {
        let positions = harness.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: None,
            contents: bytemuck::cast_slice(&positions),
            usage: wgpu::BufferUsages::STORAGE,
        });
        let buffers = ParticleBuffers { positions: &positions, ..others.buffers() };
        let colouring =
            Colouring::new(Quantity::Speed, [0.0, 1.0]).with_map(ColourMap::Inferno).with_colour_bar(false);
        let spheres = DrawnParticles::new(buffers, 0.2, colouring);
        let merged = DrawnLiquidParticles::new(buffers, 0.2, opaque_green());
        let pictures = [frame().with_particles(spheres), frame().with_liquid_particles(merged)];
        pictures.map(|frame| changed(&harness.draw(SIZE, &frame), &empty))
    };
    assert_eq!(covered([[0.0, 0.0, 0.0, 1.0], [f32::NAN, 0.0, 0.0, 0.0]]), [0, 0]);
    let active = covered([[0.0, 0.0, 0.0, 0.0], [f32::NAN, 0.0, 0.0, 0.0]]);
    assert!(
        active.iter().all(|&pixels| pixels > 100),
        "negative control: an active particle is drawn, {active:?}"
    );
}

#[test]
fn one_sample_and_any_size_are_supported() {
    let Some(mut harness) = common::harness() else { return };
    let places = block([0.0; 3], [12, 8, 6], 2.0 * RADIUS);
    let view = with(frame(), |f| f.camera = Camera::orbit([0.0; 3], 3.0, 30.0, 25.0, 40.0));
    let four = liquid(&mut harness, &places, Liquid::water(), view);
    let particles = UploadedParticles::new(&harness.device, &places, &[], &[], &[]).unwrap();
    let drawn = DrawnLiquidParticles::new(particles.buffers(), RADIUS, Liquid::water());
    let view = view.with_liquid_particles(drawn);
    // Changing sizes, including odd ones: the textures are reallocated.
    for size in [[1, 1], [33, 17], SIZE, [2, 90]] {
        harness.draw(size, &view);
    }
    let again = harness.draw(SIZE, &view);
    assert_eq!(again.rgba, four.rgba);
    harness.renderer = Renderer::new(&harness.device, &harness.queue, Offscreen::FORMAT, 1).unwrap();
    let difference = harness.draw(SIZE, &view).difference(&four);
    assert!(difference.mean < 1.5 && difference.fraction < 0.06, "{difference:?}");
}

#[test]
fn a_surface_and_liquid_particles_together_are_refused() {
    let Some(harness) = common::harness() else { return };
    let Harness { device, queue, mut renderer } = harness;
    let mesh = sample::ball([0.0; 3], 0.5, 8);
    let ball = UploadedSurface::new(&device, &mesh.vertices, &mesh.normals, &mesh.triangles).unwrap();
    let particles = UploadedParticles::new(&device, &[[0.0; 3]], &[], &[], &[]).unwrap();
    let merged = DrawnLiquidParticles::new(particles.buffers(), RADIUS, opaque_green());
    let twice =
        frame().with_surface(DrawnSurface::new(ball.buffers(), opaque_green())).with_liquid_particles(merged);
    let mut target = Offscreen::new(&device, &queue, SIZE).unwrap();
    let error = target.submit(&mut renderer, &twice).unwrap_err();
    assert!(matches!(error, RenderError::TwoLiquids), "{error}");
    let flat = with(merged, |m| m.radius = f32::NAN);
    let error = target.submit(&mut renderer, &frame().with_liquid_particles(flat)).unwrap_err();
    assert!(error.to_string().contains("radius"), "{error}");
}

#[test]
fn the_surface_does_not_bend_at_the_border_of_the_picture() {
    let Some(mut harness) = common::harness() else { return };
    // A tilted slab that extends far beyond the picture.
    let tilted: Vec<[f32; 3]> = block([0.0; 3], [70, 60, 3], 2.0 * RADIUS)
        .into_iter()
        .map(|[x, y, z]| [x, 0.8 * y - 0.6 * z, 0.8 * z - 0.6 * y])
        .collect();
    let wide_size = [280, 224];
    let wide_angle = 2.0 * (1.4 * 20f32.to_radians().tan()).atan().to_degrees();
    let wide = with(frame(), |f| f.camera.field_of_view_deg = wide_angle);
    let particles = UploadedParticles::new(&harness.device, &tilted, &[], &[], &[]).unwrap();
    let drawn = DrawnLiquidParticles::new(particles.buffers(), RADIUS, opaque_green());
    let wide = harness.draw(wide_size, &wide.with_liquid_particles(drawn));
    // The outermost columns of the picture, compared with the same pixels of a wider picture.
    let largest = |picture: &Picture| {
        let rows = (0..SIZE[1]).flat_map(|y| [[0, y], [1, y], [SIZE[0] - 2, y], [SIZE[0] - 1, y]]);
        let apart = |[x, y]: [u32; 2]| {
            let pairs = picture.pixel([x, y]).into_iter().zip(wide.pixel([x + 40, y + 32]));
            pairs.map(|(a, b)| a.abs_diff(b)).max().unwrap()
        };
        rows.map(apart).max().unwrap()
    };
    let whole = liquid(&mut harness, &tilted, opaque_green(), frame());
    assert!(largest(&whole) <= 3, "{}", largest(&whole));
    // Negative control: a slab that ends at the border.
    let [left, right] = [0, SIZE[0]].map(|x| (x as f32 - 100.0) / 80.0 * 20f32.to_radians().tan());
    let inside = |p: &&[f32; 3]| (left..right).contains(&(p[0] / (DISTANCE - p[2])));
    let cut: Vec<[f32; 3]> = tilted.iter().filter(inside).copied().collect();
    let cut = liquid(&mut harness, &cut, opaque_green(), frame());
    assert!(largest(&cut) > 12, "{}", largest(&cut));
}
