//! The wireframe of a mesh, and the times of passes.

mod common;

use common::{Harness, Picture, sample};
use splashdown_render::*;

const SIZE: [u32; 2] = [400, 320];

fn frame() -> Frame<'static> {
    let camera = Camera::orbit([0.0; 3], 4.0, 0.0, 10.0, 40.0);
    Frame::new(camera, Domain::closed([-50.0; 3], [50.0; 3]))
}

fn brightness(picture: &Picture, [x, y]: [u32; 2]) -> i32 {
    picture.pixel([x, y]).iter().map(|&channel| i32::from(channel)).sum()
}

/// The largest decrease in brightness from `base` to `picture` among the pixels around a position.
fn darkest(picture: &Picture, base: &Picture, [x, y]: [f32; 2]) -> i32 {
    let around = (0..9).map(|n| [x as u32 + n % 3 - 1, y as u32 + n / 3 - 1]);
    around.map(|pixel| brightness(base, pixel) - brightness(picture, pixel)).max().unwrap()
}

#[test]
fn lines_lie_on_the_edges_of_front_faces() {
    let Some(mut harness) = common::harness() else { return };
    let mesh = sample::ball([0.0; 3], 1.0, 8);
    let ball = UploadedSurface::new(&harness.device, &mesh.vertices, &mesh.normals, &mesh.triangles).unwrap();
    let drawn =
        |style| frame().with_surface(DrawnSurface::new(ball.buffers(), Liquid::water()).with_style(style));
    let plain = harness.draw(SIZE, &drawn(SurfaceStyle::Liquid));
    let lined = harness.draw(SIZE, &drawn(SurfaceStyle::LiquidWithLines));
    let alone = harness.draw(SIZE, &drawn(SurfaceStyle::Lines));
    let empty = harness.draw(SIZE, &frame());
    let view = frame();
    let project = |p: [f32; 3]| view.camera.project(p, SIZE).unwrap().unwrap();
    let mean = |points: &[[f32; 3]]| -> [f32; 3] {
        std::array::from_fn(|axis| points.iter().map(|p| p[axis]).sum::<f32>() / points.len() as f32)
    };
    let mut counted = 0;
    for corners in &mesh.triangles {
        let corners = corners.map(|corner| mesh.vertices[corner as usize]);
        let centre = mean(&corners);
        // Only large triangles that face the camera: at others, edges of neighbours are too close.
        if centre[2] < 0.55 || centre[1].abs() > 0.7 {
            continue;
        }
        counted += 1;
        for [a, b] in [[0, 1], [1, 2], [2, 0]] {
            let at = project(mean(&[corners[a], corners[b]]));
            let (over, alone) = (darkest(&lined, &plain, at), darkest(&alone, &empty, at));
            // A tenth of the light of the floor behind a line alone.
            let floor = brightness(&empty, at.map(|x| x as u32));
            assert!(
                over > 20 && 10 * alone > floor,
                "an edge at {at:?} is darker by only {over} and {alone}"
            );
        }
        let at = project(centre);
        let apart = darkest(&lined, &plain, at);
        assert!(apart <= 6, "the middle of a triangle at {at:?} is darker by {apart}");
    }
    assert!(counted > 20, "{counted} triangles");
    // Edges of back faces are visible only in the style without the liquid.
    let darker = |picture: &Picture, base: &Picture| {
        let pairs = picture.rgba.chunks_exact(4).zip(base.rgba.chunks_exact(4));
        pairs.filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| b.saturating_sub(*a) > 12)).count()
    };
    let (over, alone) = (darker(&lined, &plain), darker(&alone, &empty));
    assert!(alone > over + over / 4, "{alone} pixels of lines alone, {over} on the surface");
}

#[test]
fn lines_can_be_drawn_from_indirect_arguments() {
    use wgpu::util::DeviceExt;
    let Some(mut harness) = common::harness() else { return };
    let mesh = sample::ball([0.0; 3], 1.0, 8);
    let ball = UploadedSurface::new(&harness.device, &mesh.vertices, &mesh.normals, &mesh.triangles).unwrap();
    let mut draw = |count: Option<u32>| {
        let arguments = harness.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: None,
            contents: bytemuck::cast_slice(&[7, count.unwrap_or(0), 1, 0, 0, 0]),
            usage: wgpu::BufferUsages::INDIRECT,
        });
        let buffers = match count {
            Some(_) => SurfaceBuffers { draw: Draw::Indirect(&arguments, 4), ..ball.buffers() },
            None => ball.buffers(),
        };
        let drawn = DrawnSurface::new(buffers, Liquid::water()).with_style(SurfaceStyle::Lines);
        harness.draw(SIZE, &frame().with_surface(drawn)).rgba
    };
    let direct = draw(None);
    let all = 3 * mesh.triangles.len() as u32;
    assert_eq!(draw(Some(all)), direct);
    assert_ne!(draw(Some(all / 2)), direct, "negative control: half of the triangles");
}

#[test]
fn lines_need_storage_buffers() {
    let Some(Harness { device, queue, mut renderer }) = common::harness() else { return };
    let mesh = sample::ball([0.0; 3], 1.0, 8);
    let ball = UploadedSurface::new(&device, &mesh.vertices, &mesh.normals, &mesh.triangles).unwrap();
    let vertices = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: 16 * mesh.vertices.len() as u64,
        usage: wgpu::BufferUsages::VERTEX,
        mapped_at_creation: false,
    });
    let buffers = SurfaceBuffers { vertices: &vertices, ..ball.buffers() };
    let mut target = Offscreen::new(&device, &queue, [30, 20]).unwrap();
    let mut draw = |style| {
        let drawn = DrawnSurface::new(buffers, Liquid::water()).with_style(style);
        target.render_to_rgba(&mut renderer, &frame().with_surface(drawn))
    };
    let error = draw(SurfaceStyle::Lines).unwrap_err();
    assert!(error.to_string().contains("vertices lacks the usage"), "{error}");
    assert!(draw(SurfaceStyle::Liquid).is_ok());
}

#[test]
fn times_of_passes_are_read_back() {
    let Some(Harness { device, queue, mut renderer }) = common::harness() else { return };
    let mut target = Offscreen::new(&device, &queue, SIZE).unwrap();
    let particles = UploadedParticles::new(&device, &[[0.0; 3]; 64], &[], &[], &[]).unwrap();
    let drawn = DrawnLiquidParticles::new(particles.buffers(), 0.1, Liquid::water());
    let view = frame().with_liquid_particles(drawn);
    target.render_to_rgba(&mut renderer, &view).unwrap();
    assert!(renderer.pass_times().is_empty(), "timing is off");
    if !renderer.set_timing(true) {
        eprintln!("SKIPPED: the adapter has no timestamp queries");
        return;
    }
    let start = std::time::Instant::now();
    for _ in 0..6 {
        target.render_to_rgba(&mut renderer, &view).unwrap();
    }
    let wall = 1e3 * start.elapsed().as_secs_f32();
    let times = renderer.pass_times().to_vec();
    let labels: Vec<&str> = times.iter().map(|time| time.label).collect();
    let expected = [
        "shadow",
        "shadow absorption",
        "shadow blur",
        "scene",
        "distance of bodies",
        "particle thickness",
        "splat",
        "smooth",
        "cleanup",
        "picture",
    ];
    assert_eq!(labels, expected);
    let sum: f32 = times.iter().map(|time| time.milliseconds).sum();
    assert!(sum > 0.0 && sum < wall, "{sum} ms in one of six pictures with a total of {wall} ms");
    // The passes of another picture replace them.
    let ball = sample::ball([0.0; 3], 1.0, 8);
    let ball = UploadedSurface::new(&device, &ball.vertices, &ball.normals, &ball.triangles).unwrap();
    let mesh = frame().with_surface(DrawnSurface::new(ball.buffers(), Liquid::water()));
    for _ in 0..6 {
        target.render_to_rgba(&mut renderer, &mesh).unwrap();
    }
    let labels: Vec<&str> = renderer.pass_times().iter().map(|time| time.label).collect();
    let of_mesh = ["thickness", "normals", "cover", "shade", "over samples", "picture"];
    assert!(labels.ends_with(&of_mesh), "{labels:?}");
    for _ in 0..6 {
        target.render_to_rgba(&mut renderer, &frame()).unwrap();
    }
    let labels: Vec<&str> = renderer.pass_times().iter().map(|time| time.label).collect();
    assert_eq!(labels, ["shadow", "shadow absorption", "picture"]);
    // Encoders that are never submitted do not stop the timing.
    let view = device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: 8, height: 8, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: Offscreen::FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    });
    let view = view.create_view(&wgpu::TextureViewDescriptor::default());
    for _ in 0..64 {
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        renderer.draw(&mut encoder, &view, [8, 8], &frame()).unwrap();
    }
    let lit = frame().with_caption("t = 1 s");
    for _ in 0..6 {
        target.render_to_rgba(&mut renderer, &lit).unwrap();
    }
    assert!(renderer.pass_times().iter().any(|time| time.label == "overlay"));
    renderer.set_timing(false);
    assert!(renderer.pass_times().is_empty());
}
