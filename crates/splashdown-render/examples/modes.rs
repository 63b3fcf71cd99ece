//! Draws the same fluid in every rendering mode and compares the times.
//!
//! `cargo run --release -p splashdown-render --example modes -- [FOLDER] [PARTICLES.ply SURFACE.ply
//! PARTICLE_SPACING]`
//!
//! The files are those that `splashdown run` writes. Without files, the example draws a synthetic
//! collapsing column of 63,000 particles, and an unrelated mesh of 298,000 triangles.

#[path = "../tests/common/sample.rs"]
#[expect(dead_code, reason = "only the tests draw the ball")]
mod sample;

use splashdown_gpu::{DeviceRequest, Gpu};
use splashdown_render::*;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::time::Instant;

const SIZE: [u32; 2] = [1280, 720];
const REPETITIONS: u32 = 5;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let folder = PathBuf::from(arguments.first().map_or("out/modes", String::as_str));
    std::fs::create_dir_all(&folder)?;
    let Gpu { device, queue, info, .. } = Gpu::open(&DeviceRequest::Auto)?;
    let (cloud, mesh, spacing) = match &arguments[..] {
        [_, particles, surface, spacing] => {
            (read_particles(Path::new(particles))?, read_mesh(Path::new(surface))?, spacing.parse()?)
        }
        _ => {
            let size = [2.0, 1.0, 1.0];
            (sample::collapsing_column(size, 0.0218), sample::waves([0.0; 3], size, 384), 0.0218)
        }
    };
    eprintln!(
        "{}: {} particles, {} triangles, {} x {}",
        info.name,
        cloud.positions.len(),
        mesh.triangles.len(),
        SIZE[0],
        SIZE[1]
    );
    let particles = UploadedParticles::new(
        &device,
        &cloud.positions,
        &cloud.velocities,
        &cloud.densities,
        &cloud.pressures,
    )?;
    let surface = UploadedSurface::new(&device, &mesh.vertices, &mesh.normals, &mesh.triangles)?;
    let start = Instant::now();
    let traced = TracedMeshes::new(&device, &mesh.vertices, &mesh.normals, &mesh.triangles, [])?;
    eprintln!("tree of the triangles: {:.0} ms", 1e3 * start.elapsed().as_secs_f64());
    let mut one_sample = Quality::STANDARD;
    one_sample.samples = 1;
    let domain = domain_of(&cloud.positions, 0.5 * spacing);
    let aspect = SIZE[0] as f32 / SIZE[1] as f32;
    let far = Camera::framing(&domain, 25.0, 16.0, 35.0, aspect);
    let middle: [f32; 3] = std::array::from_fn(|axis| 0.5 * (domain.min[axis] + domain.max[axis]));
    let distance = (0..3).map(|axis| (far.eye[axis] - middle[axis]).powi(2)).sum::<f32>().sqrt();
    let views = [
        ("far", far),
        ("near", Camera::orbit(middle, 0.4 * distance, 25.0, 12.0, 35.0)),
        ("above", Camera::orbit(middle, 0.7 * distance, -30.0, 50.0, 35.0)),
    ];

    let liquid = Liquid::water();
    let radius = 0.5 * spacing;
    let buffers = particles.buffers();
    let colouring = Colouring::new(Quantity::Speed, [0.0, 3.0]);
    let empty = Frame::new(far, domain);
    let density = Colouring::new(Quantity::Density, [990.0, 1010.0]).with_map(ColourMap::Viridis);
    let slice = DrawnSlice::new(buffers, Axis::Z, middle[2], radius, density);
    let meshed = |style| empty.with_surface(DrawnSurface::new(surface.buffers(), liquid).with_style(style));
    let modes = [
        ("particles", empty.with_particles(DrawnParticles::new(buffers, radius, colouring))),
        ("empty", empty),
        ("surface", meshed(SurfaceStyle::Liquid)),
        ("traced", meshed(SurfaceStyle::Liquid).with_tracing(&traced, one_sample)),
        ("traced-standard", meshed(SurfaceStyle::Liquid).with_tracing(&traced, Quality::STANDARD)),
        ("surface-lines", meshed(SurfaceStyle::LiquidWithLines)),
        ("lines", meshed(SurfaceStyle::Lines)),
        ("slice", empty.with_slice(slice)),
        ("screen-space", empty.with_liquid_particles(DrawnLiquidParticles::new(buffers, radius, liquid))),
    ];
    for samples in [4, 1] {
        let mut renderer = Renderer::new(&device, &queue, Offscreen::FORMAT, samples)?;
        renderer.set_timing(true);
        let mut target = Offscreen::new(&device, &queue, SIZE)?;
        let mut particles_milliseconds = f64::NAN;
        for (name, frame) in &modes {
            let rgba = target.render_to_rgba(&mut renderer, frame)?;
            if samples == 4 {
                save(&folder.join(format!("{name}-far.png")), &rgba)?;
                for (view, camera) in &views[1..] {
                    let rgba = target.render_to_rgba(&mut renderer, &seen_from(*camera, *frame))?;
                    save(&folder.join(format!("{name}-{view}.png")), &rgba)?;
                }
            }
            let start = Instant::now();
            for _ in 0..REPETITIONS {
                target.render_to_rgba(&mut renderer, frame)?;
            }
            let milliseconds = 1e3 * start.elapsed().as_secs_f64() / f64::from(REPETITIONS);
            if *name == "particles" {
                particles_milliseconds = milliseconds;
            }
            let passes: Vec<String> = renderer
                .pass_times()
                .iter()
                .map(|PassTime { label, milliseconds }| format!("{label} {milliseconds:.0}"))
                .collect();
            let ratio = milliseconds / particles_milliseconds;
            eprintln!(
                "{samples} samples, {name}: {milliseconds:.0} ms ({ratio:.2} times the particles): {}",
                passes.join(", ")
            );
        }
    }
    Ok(())
}

fn seen_from(camera: Camera, mut frame: Frame<'_>) -> Frame<'_> {
    frame.camera = camera;
    frame
}

fn save(path: &Path, rgba: &[u8]) -> Result<(), image::ImageError> {
    image::save_buffer(path, rgba, SIZE[0], SIZE[1], image::ExtendedColorType::Rgba8)
}

/// The bounding box of all particles.
fn domain_of(positions: &[[f32; 3]], margin: f32) -> Domain {
    let bound = |start: f32, choose: fn(f32, f32) -> f32| -> [f32; 3] {
        std::array::from_fn(|axis| positions.iter().map(|p| p[axis]).fold(start, choose))
    };
    let (low, high) = (bound(f32::INFINITY, f32::min), bound(f32::NEG_INFINITY, f32::max));
    Domain::closed(low.map(|x| x - margin), high.map(|x| x + margin))
}

/// A binary .ply file.
struct Ply {
    /// The element counts in the header.
    counts: Vec<usize>,
    /// Numbers per vertex.
    numbers: usize,
    /// The data after the header.
    data: Vec<u8>,
}

fn open_ply(path: &Path) -> Result<Ply, Box<dyn Error>> {
    let bytes = std::fs::read(path)?;
    let end = b"end_header\n";
    let header = bytes.windows(end.len()).position(|window| window == end).ok_or("the header has no end")?;
    let text = String::from_utf8_lossy(&bytes[..header]);
    let numbers = text.lines().filter(|line| line.starts_with("property float")).count();
    let counts = text
        .lines()
        .filter(|line| line.starts_with("element"))
        .filter_map(|line| line.split(' ').next_back()?.parse().ok())
        .collect();
    Ok(Ply { counts, numbers, data: bytes[header + end.len()..].to_vec() })
}

fn float(bytes: &[u8], index: usize) -> f32 {
    f32::from_le_bytes([0, 1, 2, 3].map(|byte| bytes[4 * index + byte]))
}

fn read_particles(path: &Path) -> Result<sample::Cloud, Box<dyn Error>> {
    let Ply { data, .. } = open_ply(path)?;
    let mut cloud = sample::Cloud::default();
    // Position, velocity, density, pressure and id.
    for particle in data.chunks_exact(36) {
        cloud.positions.push([0, 1, 2].map(|axis| float(particle, axis)));
        cloud.velocities.push([3, 4, 5].map(|axis| float(particle, axis)));
        cloud.densities.push(float(particle, 6));
        cloud.pressures.push(float(particle, 7));
    }
    Ok(cloud)
}

fn read_mesh(path: &Path) -> Result<sample::Mesh, Box<dyn Error>> {
    let Ply { counts, numbers, data } = open_ply(path)?;
    let vertices = counts.first().copied().ok_or("the header has no vertices")?;
    let (points, faces) = data.split_at(4 * numbers * vertices);
    let points = || points.chunks_exact(4 * numbers);
    // One byte with the number of corners, then three indices.
    let corner = |face: &[u8], index: usize| float(&face[1..], index).to_bits();
    Ok(sample::Mesh {
        vertices: points().map(|point| [0, 1, 2].map(|axis| float(point, axis))).collect(),
        normals: points().map(|point| [3, 4, 5].map(|axis| float(point, axis))).collect(),
        triangles: faces.chunks_exact(13).map(|face| [0, 1, 2].map(|index| corner(face, index))).collect(),
    })
}
