//! Read-back, several pictures in flight, and invalid input.

mod common;

use common::{Harness, with};
use splashdown_render::*;

fn frame(azimuth: f32) -> Frame<'static> {
    let domain = Domain::closed([0.0; 3], [1.0; 3]);
    let camera = Camera::framing(&domain, azimuth, 20.0, 40.0, 1.5);
    Frame::new(camera, domain)
}

#[test]
fn pictures_in_flight_keep_their_own_content() {
    let Some(Harness { device, queue, mut renderer }) = common::harness() else { return };
    // A width whose rows are padded in the copy.
    let mut target = Offscreen::new(&device, &queue, [99, 66]).unwrap();
    let angles = [10.0, 40.0, 70.0];
    let caption = |angle: f32| format!("{angle}");
    let alone: Vec<Vec<u8>> = angles
        .iter()
        .map(|&angle| {
            target.render_to_rgba(&mut renderer, &frame(angle).with_caption(&caption(angle))).unwrap()
        })
        .collect();
    assert_eq!(alone[0].len(), 4 * 99 * 66);
    assert_ne!(alone[0], alone[1]);
    let tickets: Vec<Ticket> = angles
        .iter()
        .map(|&angle| target.submit(&mut renderer, &frame(angle).with_caption(&caption(angle))).unwrap())
        .collect();
    let error = target.submit(&mut renderer, &frame(0.0)).unwrap_err();
    assert!(matches!(error, RenderError::FramesInFlight { limit: 3 }), "{error}");
    // Collected in reverse order.
    for (ticket, expected) in tickets.into_iter().zip(&alone).rev() {
        assert_eq!(&target.collect(ticket).unwrap(), expected);
    }
    assert!(target.submit(&mut renderer, &frame(0.0)).is_ok(), "no picture is in flight");
}

#[test]
fn a_ticket_is_valid_for_its_own_target_only() {
    let Some(Harness { device, queue, mut renderer }) = common::harness() else { return };
    let mut first = Offscreen::new(&device, &queue, [30, 20]).unwrap();
    let mut second = Offscreen::new(&device, &queue, [30, 20]).unwrap();
    let ticket = first.submit(&mut renderer, &frame(0.0)).unwrap();
    let _other = second.submit(&mut renderer, &frame(0.0)).unwrap();
    let error = second.collect(ticket).unwrap_err();
    let RenderError::UnknownTicket { ticket } = error else { panic!("{error}") };
    assert!(first.collect(ticket).is_ok(), "the error returns the ticket");
}

#[test]
fn unsupported_sizes_are_refused_with_the_limit() {
    let Some(Harness { device, queue, mut renderer }) = common::harness() else { return };
    for size in [[0, 20], [20, 0], [Offscreen::MAX_SIDE + 1, 20]] {
        let error = Offscreen::new(&device, &queue, size).unwrap_err();
        assert!(error.to_string().contains("between 1 and 32768"), "{error}");
    }
    let error = Offscreen::new(&device, &queue, [Offscreen::MAX_SIDE; 2]).unwrap_err();
    assert!(error.to_string().contains("at most 268 million pixels"), "{error}");
    // A texture of the caller is limited by the device.
    let limit = device.limits().max_texture_dimension_2d;
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let view = colour_texture(&device, [30, 20]);
    let error = renderer.draw(&mut encoder, &view, [limit + 1, 20], &frame(0.0)).unwrap_err();
    assert!(error.to_string().contains(&format!("between 1 and {limit}")), "{error}");
    let error = Renderer::new(&device, &queue, Offscreen::FORMAT, 3).unwrap_err();
    assert!(matches!(error, RenderError::SampleCount { given: 3 }));
    let mut target = Offscreen::new(&device, &queue, [1, 1]).unwrap();
    assert_eq!(target.render_to_rgba(&mut renderer, &frame(0.0)).unwrap().len(), 4);
    let mut other = Renderer::new(&device, &queue, wgpu::TextureFormat::Bgra8Unorm, 4).unwrap();
    assert!(matches!(target.submit(&mut other, &frame(0.0)), Err(RenderError::Format { .. })));
}

fn colour_texture(device: &wgpu::Device, [width, height]: [u32; 2]) -> wgpu::TextureView {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: Offscreen::FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    });
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

#[test]
fn pictures_larger_than_a_texture_of_the_device_are_drawn() {
    let Some(Harness { device, queue, mut renderer }) = common::harness() else { return };
    let width = device.limits().max_texture_dimension_2d + 1000;
    if width > Offscreen::MAX_SIDE {
        eprintln!("SKIPPED: the device has textures of {width} pixels");
        return;
    }
    let mut target = Offscreen::new(&device, &queue, [width, 20]).unwrap();
    let rgba = target.render_to_rgba(&mut renderer, &frame(0.0)).unwrap();
    assert_eq!(rgba.len(), 4 * width as usize * 20);
    // Nothing is left out: the picture is opaque.
    assert!(rgba.chunks_exact(4).all(|pixel| pixel[3] == 255));
}

#[test]
fn invalid_frames_are_refused_and_leave_the_target_usable() {
    let Some(Harness { device, queue, mut renderer }) = common::harness() else { return };
    let mut target = Offscreen::new(&device, &queue, [30, 20]).unwrap();
    let particles = UploadedParticles::new(&device, &[[0.5; 3]; 4], &[], &[], &[]).unwrap();
    let colouring = Colouring::new(Quantity::Speed, [0.0, 1.0]).with_colour_bar(false);
    let good = DrawnParticles::new(particles.buffers(), 0.1, colouring);
    let buffer = |usage, size| {
        device.create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false })
    };
    let (short, wrong) = (buffer(wgpu::BufferUsages::STORAGE, 48), buffer(wgpu::BufferUsages::VERTEX, 64));
    let message = |renderer: &mut Renderer, target: &mut Offscreen, particles| {
        target.submit(renderer, &frame(0.0).with_particles(particles)).unwrap_err().to_string()
    };
    let with_positions = |positions| with(good, |drawn| drawn.buffers.positions = positions);
    let text = message(&mut renderer, &mut target, with_positions(&short));
    assert!(text.contains("positions has 48 bytes, but 64 are required"), "{text}");
    let text = message(&mut renderer, &mut target, with_positions(&wrong));
    assert!(text.contains("lacks the usage"), "{text}");
    let text = message(&mut renderer, &mut target, with(good, |drawn| drawn.radius = 0.0));
    assert!(text.contains("radius is 0 m"), "{text}");
    let camera = Camera { eye: [0.0; 3], target: [0.0; 3], ..frame(0.0).camera };
    assert!(matches!(
        target.submit(&mut renderer, &with(frame(0.0), |f| f.camera = camera)),
        Err(RenderError::Camera { .. })
    ));
    for _ in 0..4 {
        target.render_to_rgba(&mut renderer, &frame(0.0).with_particles(good)).unwrap();
    }
}

#[test]
fn empty_input_gives_a_picture_of_the_empty_box() {
    let Some(Harness { device, queue, mut renderer }) = common::harness() else { return };
    let mut target = Offscreen::new(&device, &queue, [60, 40]).unwrap();
    let particles = UploadedParticles::new(&device, &[], &[], &[], &[]).unwrap();
    // A frame with a liquid shows a tank of glass.
    let none = DrawnLiquidParticles::new(particles.buffers(), 0.1, Liquid::water());
    let empty = target.render_to_rgba(&mut renderer, &frame(0.0).with_liquid_particles(none)).unwrap();
    let mesh = UploadedSurface::new(&device, &[], &[], &[]).unwrap();
    let colouring = Colouring::new(Quantity::Speed, [0.0, 0.0]).with_colour_bar(false);
    let both = frame(0.0)
        .with_particles(DrawnParticles::new(particles.buffers(), 0.1, colouring))
        .with_surface(DrawnSurface::new(mesh.buffers(), Liquid::water()));
    let drawn = target.render_to_rgba(&mut renderer, &both).unwrap();
    assert!(empty.iter().zip(&drawn).all(|(a, b)| a.abs_diff(*b) <= 1));
}

#[test]
fn invalid_meshes_are_refused() {
    let Some(Harness { device, .. }) = common::harness() else { return };
    let error = UploadedSurface::new(&device, &[[0.0; 3]; 3], &[], &[[0, 1, 3]]).unwrap_err();
    assert!(error.to_string().contains("triangle 0 refers to vertex 3, but the mesh has only 3"), "{error}");
    assert!(matches!(
        UploadedParticles::new(&device, &[[0.0; 3]; 3], &[[0.0; 3]; 2], &[], &[]),
        Err(RenderError::Length { what: "velocities", given: 2, needed: 3 })
    ));
}

#[test]
fn a_lost_device_is_an_error() {
    let Some(Harness { device, queue, mut renderer }) = common::harness() else { return };
    let mut target = Offscreen::new(&device, &queue, [30, 20]).unwrap();
    let before = target.submit(&mut renderer, &frame(0.0)).unwrap();
    device.destroy();
    let after = target.submit(&mut renderer, &frame(0.0)).and_then(|ticket| target.collect(ticket));
    assert!(matches!(after, Err(RenderError::DeviceLost { .. })), "{after:?}");
    // The earlier picture may be complete or not. In neither case is there a panic.
    let _ = target.collect(before);
}
