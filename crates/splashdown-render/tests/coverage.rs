//! Pictures whose expected pixels are known.

mod common;

use common::{Harness, Picture, sample, with};
use splashdown_render::*;

const SIZE: [u32; 2] = [200, 160];

/// Speed in the blue-red map.
fn red() -> Colouring {
    Colouring::new(Quantity::Speed, [0.0, 1.0]).with_map(ColourMap::BlueRed).with_colour_bar(false)
}

/// A frame of a very large box seen from +z, so that its edges and floor are outside the picture.
fn level_frame(distance: f32) -> Frame<'static> {
    let camera = Camera::orbit([0.0; 3], distance, 0.0, 0.0, 40.0);
    Frame::new(camera, Domain::closed([-50.0; 3], [50.0; 3]))
}

/// Particles at rest are blue, particles with a speed of 1 m/s are red.
fn spheres(harness: &mut Harness, places: &[([f32; 3], f32)], radius: f32, frame: Frame<'_>) -> Picture {
    let positions: Vec<[f32; 3]> = places.iter().map(|(place, _)| *place).collect();
    let velocities: Vec<[f32; 3]> = places.iter().map(|(_, speed)| [0.0, *speed, 0.0]).collect();
    let particles = UploadedParticles::new(&harness.device, &positions, &velocities, &[], &[]).unwrap();
    let drawn = DrawnParticles::new(particles.buffers(), radius, red());
    harness.draw(SIZE, &frame.with_particles(drawn))
}

fn changed(picture: &Picture, empty: &Picture) -> Vec<[u32; 2]> {
    let all = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| [x, y]));
    let off = |pixel: &[u32; 2]| {
        let (a, b) = (picture.pixel(*pixel), empty.pixel(*pixel));
        a.iter().zip(b).any(|(a, b)| a.abs_diff(b) > 12)
    };
    all.filter(off).collect()
}

fn is_red([r, _, b]: [u8; 3]) -> bool {
    i32::from(r) - i32::from(b) > 40
}

fn is_blue([r, _, b]: [u8; 3]) -> bool {
    i32::from(b) - i32::from(r) > 40
}

#[test]
fn a_sphere_covers_its_disc() {
    let Some(mut harness) = common::harness() else { return };
    let (distance, radius) = (4.0f32, 0.5f32);
    let empty = harness.draw(SIZE, &level_frame(distance));
    let picture = spheres(&mut harness, &[([0.0; 3], 1.0)], radius, level_frame(distance));
    // The tangent cone of the sphere; the half height of the picture is tan 20 degrees at unit
    // distance.
    let outline = radius / (distance * distance - radius * radius).sqrt() / 20f32.to_radians().tan() * 80.0;
    let covered = changed(&picture, &empty);
    let area = std::f32::consts::PI * outline * outline;
    assert!((covered.len() as f32 - area).abs() < 0.06 * area, "{} pixels, expected {area}", covered.len());
    for [x, y] in covered {
        let away = (x as f32 + 0.5 - 100.0).hypot(y as f32 + 0.5 - 80.0);
        assert!(away < outline + 1.2, "pixel {x} {y} is {away} from the middle, the outline {outline}");
    }
    assert!(is_red(picture.pixel([100, 80])));

    // The outline is smooth: many pixels are neither background nor sphere.
    let row: Vec<[u8; 3]> = (0..SIZE[1]).map(|y| picture.pixel([100 - (0.7 * outline) as u32, y])).collect();
    assert!(row.iter().any(|pixel| is_red(*pixel)));
    let hard = {
        let mut renderer = Renderer::new(&harness.device, &harness.queue, Offscreen::FORMAT, 1).unwrap();
        std::mem::swap(&mut renderer, &mut harness.renderer);
        let hard = spheres(&mut harness, &[([0.0; 3], 1.0)], radius, level_frame(distance));
        std::mem::swap(&mut renderer, &mut harness.renderer);
        hard
    };
    let between = |picture: &Picture| {
        let shades = |pixel: &[u32; 2]| {
            let [r, _, b] = picture.pixel(*pixel);
            let [empty_r, _, empty_b] = empty.pixel(*pixel);
            let (redness, background) =
                (i32::from(r) - i32::from(b), i32::from(empty_r) - i32::from(empty_b));
            redness > background + 12 && redness < 25
        };
        changed(picture, &empty).iter().filter(|pixel| shades(pixel)).count()
    };
    assert!(between(&picture) > 40, "{} pixels in between", between(&picture));
    assert!(between(&hard) < 10, "negative control: one sample gives hard outlines, {}", between(&hard));
}

#[test]
fn nearer_spheres_hide_farther_ones_in_either_order() {
    let Some(mut harness) = common::harness() else { return };
    let (near, far) = (([0.0, 0.0, 1.0], 1.0), ([0.0, 0.0, -1.0], 0.0));
    for places in [[near, far], [far, near]] {
        let picture = spheres(&mut harness, &places, 0.5, level_frame(5.0));
        assert!(is_red(picture.pixel([100, 80])));
    }
    // Negative control: from behind, the other sphere is in front.
    let behind = with(level_frame(5.0), |f| f.camera = Camera::orbit([0.0; 3], 5.0, 180.0, 0.0, 40.0));
    assert!(is_blue(spheres(&mut harness, &[near, far], 0.5, behind).pixel([100, 80])));
}

#[test]
fn overlapping_spheres_intersect_at_the_right_place() {
    let Some(mut harness) = common::harness() else { return };
    // Two overlapping spheres side by side: the seam is the plane between the centres, seen
    // edge-on.
    let picture =
        spheres(&mut harness, &[([-0.3, 0.0, 0.0], 1.0), ([0.3, 0.0, 0.0], 0.0)], 0.6, level_frame(5.0));
    for y in [70, 80, 90] {
        assert!(is_red(picture.pixel([97, y])) && is_blue(picture.pixel([103, y])), "row {y}");
    }
}

#[test]
fn non_finite_particles_are_not_drawn() {
    let Some(mut harness) = common::harness() else { return };
    let empty = harness.draw(SIZE, &level_frame(5.0));
    let nan = ([f32::NAN, 0.0, 0.0], 1.0);
    let far = ([f32::INFINITY, 0.0, 0.0], 1.0);
    let around_the_eye = ([0.0, 0.0, 5.1], 1.0);
    let picture = spheres(&mut harness, &[nan, far, around_the_eye], 0.5, level_frame(5.0));
    assert_eq!(changed(&picture, &empty).len(), 0);
    let picture = spheres(&mut harness, &[nan, ([0.0; 3], 1.0)], 0.5, level_frame(5.0));
    assert!(changed(&picture, &empty).len() > 500, "negative control: a valid particle is drawn");
}

#[test]
fn a_surface_and_particles_hide_each_other() {
    let Some(mut harness) = common::harness() else { return };
    let mesh = sample::ball([0.0; 3], 0.5, 32);
    let ball = UploadedSurface::new(&harness.device, &mesh.vertices, &mesh.normals, &mesh.triangles).unwrap();
    // Nearly opaque, so that nothing behind it is visible.
    let opaque = with(Liquid::water(), |l| {
        l.absorption = [40.0; 3];
        l.scattering = 40.0;
        l.colour = [0.0, 0.4, 0.0];
    });
    let surface = DrawnSurface::new(ball.buffers(), opaque);
    let frame = level_frame(5.0).with_surface(surface);
    let centre = [100, 80];
    let front = spheres(&mut harness, &[([0.0, 0.0, 1.0], 1.0)], 0.2, frame);
    assert!(is_red(front.pixel(centre)));
    let behind = spheres(&mut harness, &[([0.0, 0.0, -1.0], 1.0)], 0.2, frame);
    let [r, g, b] = behind.pixel(centre);
    assert!(g > r && g > b, "{:?}", behind.pixel(centre));
    // The same particle is visible through clear liquid.
    let clear = with(Liquid::water(), |l| {
        l.absorption = [0.0; 3];
        l.scattering = 0.0;
    });
    let frame = frame.with_surface(DrawnSurface::new(ball.buffers(), clear));
    assert!(is_red(spheres(&mut harness, &[([0.0, 0.0, -1.0], 1.0)], 0.2, frame).pixel(centre)));
}

#[test]
fn indirect_draws_equal_direct_ones() {
    use wgpu::util::DeviceExt;
    let Some(mut harness) = common::harness() else { return };
    let mesh = sample::ball([0.0; 3], 0.5, 32);
    let ball = UploadedSurface::new(&harness.device, &mesh.vertices, &mesh.normals, &mesh.triangles).unwrap();
    let arguments = |index_count: u32| {
        harness.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: None,
            contents: bytemuck::cast_slice(&[7, 7, index_count, 1, 0, 0, 0]),
            usage: wgpu::BufferUsages::INDIRECT,
        })
    };
    let (all, half) =
        (arguments(3 * mesh.triangles.len() as u32), arguments(3 * mesh.triangles.len() as u32 / 2));
    let mut draw = |draw| {
        let buffers = SurfaceBuffers { draw, ..ball.buffers() };
        let surface = DrawnSurface::new(buffers, Liquid::water());
        harness.draw(SIZE, &level_frame(5.0).with_surface(surface))
    };
    let direct = draw(ball.buffers().draw);
    assert_eq!(draw(Draw::Indirect(&all, 8)).rgba, direct.rgba);
    assert_ne!(draw(Draw::Indirect(&half, 8)).rgba, direct.rgba, "negative control: half of the triangles");
}

#[test]
fn the_colour_bar_shows_the_colours_of_the_map() {
    let Some(mut harness) = common::harness() else { return };
    let size = [640, 360];
    let particles = UploadedParticles::new(&harness.device, &[[0.0; 3]], &[], &[], &[]).unwrap();
    for map in ColourMap::ALL {
        let colouring = Colouring::new(Quantity::Density, [990.0, 1010.0]).with_map(map);
        let drawn = DrawnParticles::new(particles.buffers(), 0.1, colouring);
        let picture = harness.draw(size, &level_frame(5.0).with_particles(drawn));
        // Searches for a column of pixels that follows the map from its upper to its lower end.
        let near = |pixel: [u8; 3], t: f32| pixel.iter().zip(map.sample(t)).all(|(a, b)| a.abs_diff(b) <= 1);
        let found = (size[0] / 2..size[0]).any(|x| {
            let Some(top) = (0..size[1] - 140).find(|&y| {
                (0..140).step_by(20).all(|row| near(picture.pixel([x, y + row]), 1.0 - row as f32 / 139.0))
            }) else {
                return false;
            };
            near(picture.pixel([x, top + 139]), 0.0)
        });
        assert!(found, "{map:?}");
    }
}

#[test]
fn one_sample_and_unencoded_targets_show_the_same_picture() {
    let Some(mut harness) = common::harness() else { return };
    let mesh = sample::ball([0.0, 0.0, 0.0], 0.8, 48);
    let ball = UploadedSurface::new(&harness.device, &mesh.vertices, &mesh.normals, &mesh.triangles).unwrap();
    let surface = DrawnSurface::new(ball.buffers(), Liquid::water());
    let domain = Domain::closed([-1.0; 3], [1.0; 3]);
    let frame = with(level_frame(6.0), |f| f.domain = domain).with_surface(surface);
    let four = harness.draw(SIZE, &frame);
    harness.renderer = Renderer::new(&harness.device, &harness.queue, Offscreen::FORMAT, 1).unwrap();
    let one = harness.draw(SIZE, &frame);
    let difference = one.difference(&four);
    assert!(difference.mean < 1.5 && difference.fraction < 0.06, "{difference:?}");

    // A target without sRGB encoding: the shaders encode.
    let plain = draw_into(&harness, wgpu::TextureFormat::Rgba8Unorm, &frame);
    let difference = plain.difference(&four);
    assert!(difference.mean < 1.5 && difference.fraction < 0.03, "{difference:?}");
}

#[test]
fn one_sample_and_unencoded_targets_show_the_same_foam() {
    let Some(mut harness) = common::harness() else { return };
    // Spray before the liquid, foam beside it, a bubble in it, and spray behind it; each many times, which fills its disc.
    let places = [[-0.3, 0.3, 1.2], [-1.4, 0.0, 0.0], [0.3, 0.1, 0.5], [0.0, 0.0, -1.5]].repeat(40);
    let foam =
        UploadedFoam::new(&harness.device, &places, &[3.0; 160], &[], &[0, 1, 2, 0].repeat(40)).unwrap();
    let foam = DrawnFoam::new(foam.buffers(), 0.3);
    let mesh = sample::ball([0.0; 3], 0.8, 48);
    let ball = UploadedSurface::new(&harness.device, &mesh.vertices, &mesh.normals, &mesh.triangles).unwrap();
    let cloud: Vec<[f32; 3]> = mesh.vertices.iter().step_by(2).map(|p| p.map(|x| 0.9 * x)).collect();
    let cloud = UploadedParticles::new(&harness.device, &cloud, &[], &[], &[]).unwrap();
    // White foam has little contrast against the horizon.
    let behind = UploadedParticles::new(&harness.device, &[[0.0, 0.0, -8.0]], &[], &[], &[]).unwrap();
    let without = level_frame(6.0).with_particles(DrawnParticles::new(behind.buffers(), 4.0, red()));
    let surface = without.with_surface(DrawnSurface::new(ball.buffers(), Liquid::water()));
    let particles = DrawnLiquidParticles::new(cloud.buffers(), 0.1, Liquid::water());
    for without in [without, surface, without.with_liquid_particles(particles)] {
        harness.renderer = Renderer::new(&harness.device, &harness.queue, Offscreen::FORMAT, 4).unwrap();
        let frame = without.with_foam(foam);
        // The textures of another size are not used again.
        harness.draw([SIZE[0] / 2, SIZE[1] / 2], &frame);
        let four = harness.draw(SIZE, &frame);
        let foamless = four.difference(&harness.draw(SIZE, &without));
        assert!(foamless.mean > 2.0, "control: foam changes the picture: {foamless:?}");
        let plain = draw_into(&harness, wgpu::TextureFormat::Rgba8Unorm, &frame).difference(&four);
        harness.renderer = Renderer::new(&harness.device, &harness.queue, Offscreen::FORMAT, 1).unwrap();
        let one = harness.draw(SIZE, &frame).difference(&four);
        assert!(one.mean < 1.5 && one.fraction < 0.06, "{one:?}");
        assert!(plain.mean < 1.5 && plain.fraction < 0.06, "{plain:?}");
    }
}

/// Draws into a texture of any 8-bit format and returns its bytes unchanged.
fn draw_into(harness: &Harness, format: wgpu::TextureFormat, frame: &Frame<'_>) -> Picture {
    let Harness { device, queue, .. } = harness;
    let mut renderer = Renderer::new(device, queue, format, 4).unwrap();
    let size = wgpu::Extent3d { width: SIZE[0], height: SIZE[1], depth_or_array_layers: 1 };
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let row = 1024;
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(row * SIZE[1]),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
    renderer.draw(&mut encoder, &view, SIZE, frame).unwrap();
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
    let destination = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
    encoder.copy_texture_to_buffer(texture.as_image_copy(), destination, size);
    queue.submit([encoder.finish()]);
    buffer.map_async(wgpu::MapMode::Read, .., |result| result.unwrap());
    device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    let bytes = buffer.get_mapped_range(..).unwrap();
    let rgba =
        bytes.chunks_exact(row as usize).flat_map(|line| line[..4 * SIZE[0] as usize].to_vec()).collect();
    Picture { size: SIZE, rgba }
}

#[test]
fn a_body_leaves_the_shadow_of_particles_as_it_is() {
    let Some(mut harness) = common::harness() else { return };
    let domain = Domain::closed([0.0; 3], [2.0, 1.0, 1.0]);
    let empty = Frame::new(Camera::framing(&domain, 28.0, 18.0, 35.0, 1.25), domain);
    let cloud = sample::collapsing_column([0.8, 1.0, 0.8], 0.05);
    let particles = UploadedParticles::new(&harness.device, &cloud.positions, &[], &[], &[]).unwrap();
    let colouring = Colouring::new(Quantity::Speed, [0.0, 1.0]).with_colour_bar(false);
    let drawn = DrawnParticles::new(particles.buffers(), 0.025, colouring);
    let ball = sample::ball([1.7, 0.5, 0.6], 0.15, 24);
    let body = PlacedBody::new(&ball.vertices, &ball.triangles, [0.8, 0.1, 0.1]).unwrap();
    let bodies = UploadedBodies::new(&harness.device, [(&body, [0.0; 3], [0.0, 0.0, 0.0, 1.0])]);
    let with_body = harness.draw(SIZE, &empty.with_bodies(bodies.buffers()));
    let both = harness.draw(SIZE, &empty.with_particles(drawn).with_bodies(bodies.buffers()));
    let particles = harness.draw(SIZE, &empty.with_particles(drawn));
    let empty = harness.draw(SIZE, &empty);
    let differ_by = |least: u8, a: &Picture, b: &Picture, at| {
        a.pixel(at).iter().zip(b.pixel(at)).any(|(a, b)| a.abs_diff(b) >= least)
    };
    let differ = |a: &Picture, b: &Picture, at| differ_by(8, a, b, at);
    let (mut of_particles, mut of_body, mut changed) = (0, 0, 0);
    for at in (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| [x, y])) {
        // Where the body and its shadow are invisible.
        if differ_by(1, &with_body, &empty, at) {
            of_body += usize::from(!differ(&particles, &empty, at) && differ(&both, &empty, at));
        } else {
            of_particles += usize::from(differ(&particles, &empty, at));
            changed += usize::from(differ(&both, &particles, at));
        }
    }
    assert!(of_particles > 1000 && of_body > 300, "{of_particles} and {of_body} pixels");
    // The blurred outline of the shadow of the body is darker together with particles.
    assert!(changed < 100, "{changed} pixels");
}

#[test]
fn the_shadow_of_a_body_does_not_depend_on_the_liquid() {
    let Some(mut harness) = common::harness() else { return };
    let domain = Domain::closed([0.0; 3], [2.0, 1.0, 1.0]);
    let empty = Frame::new(Camera::framing(&domain, 28.0, 18.0, 35.0, 1.25), domain);
    let ball = sample::ball([1.5, 0.5, 0.6], 0.2, 24);
    let body = PlacedBody::new(&ball.vertices, &ball.triangles, [0.8, 0.1, 0.1]).unwrap();
    let bodies = UploadedBodies::new(&harness.device, [(&body, [0.0; 3], [0.0, 0.0, 0.0, 1.0])]);
    // The drop is far from the ball and its shadow.
    let drop = sample::ball([0.3, 0.1, 0.3], 0.08, 16);
    let drop = UploadedSurface::new(&harness.device, &drop.vertices, &drop.normals, &drop.triangles).unwrap();
    let mut draw = |absorption: [f32; 3], has_body: bool| {
        let liquid = with(Liquid::water(), |liquid| liquid.absorption = absorption);
        let frame = empty.with_surface(DrawnSurface::new(drop.buffers(), liquid));
        harness.draw(SIZE, &if has_body { frame.with_bodies(bodies.buffers()) } else { frame })
    };
    // The first liquid lets most of the blue light through a path of many metres.
    let (blue, ink) = ([0.3, 0.05, 0.001], [40.0; 3]);
    let (in_blue, in_ink) = (draw(blue, true), draw(ink, true));
    let (blue, ink) = (draw(blue, false), draw(ink, false));
    let differ =
        |a: &Picture, b: &Picture, at| a.pixel(at).iter().zip(b.pixel(at)).any(|(a, b)| a.abs_diff(b) > 4);
    let (mut of_body, mut changed, mut of_liquid) = (0, 0, 0);
    for at in (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| [x, y])) {
        if differ(&blue, &ink, at) {
            of_liquid += 1;
        } else if differ(&in_blue, &blue, at) {
            of_body += 1;
            changed += usize::from(differ(&in_blue, &in_ink, at));
        }
    }
    assert!(of_body > 1000 && of_liquid > 20, "{of_body} and {of_liquid} pixels");
    assert_eq!(changed, 0);
}
