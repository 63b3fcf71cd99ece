//! Draws sample input into PNGs, to be looked at, and says how long each took.
//!
//! `cargo run --release -p splashdown-render --example look -- [FOLDER] [POINTS.npy]`

#[path = "../tests/common/sample.rs"]
mod sample;

use splashdown_render::*;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::time::Instant;

const SIZE: [u32; 2] = [1280, 720];

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = PathBuf::from(arguments.next().unwrap_or_else(|| "out/look".to_owned()));
    std::fs::create_dir_all(&folder)?;
    let (device, queue, info) = open_device()?;
    let start = Instant::now();
    let renderer = Renderer::new(&device, &queue, Offscreen::FORMAT, 4)?;
    eprintln!("{}: pipelines in {:.0} ms", info.name, 1e3 * start.elapsed().as_secs_f64());
    let target = Offscreen::new(&device, &queue, SIZE)?;
    let mut studio = Studio { renderer, target, folder };

    let domain = Domain::closed([0.0; 3], [2.0, 1.0, 1.0]);
    let cloud = sample::slump([2.0, 1.0, 1.0], 0.0185);
    let particles = UploadedParticles::new(
        &device,
        &cloud.positions,
        &cloud.velocities,
        &cloud.densities,
        &cloud.pressures,
    )?;
    let aspect = SIZE[0] as f32 / SIZE[1] as f32;
    let camera = Camera::framing(&domain, 28.0, 18.0, 35.0, aspect);
    let empty = Frame::new(camera, domain);
    let colourings = [
        ("speed", Quantity::Speed, [0.0, 3.0], ColourMap::Water),
        ("density", Quantity::Density, [1000.0, 1009.0], ColourMap::Viridis),
        ("pressure", Quantity::Pressure, [0.0, 9000.0], ColourMap::Inferno),
    ];
    for (name, quantity, range, map) in colourings {
        let colouring = Colouring { quantity, range, map, colour_bar: true };
        let drawn = DrawnParticles { buffers: particles.buffers(), radius: 0.00925, colouring };
        let caption = format!("t = 0.42 s  ·  {} particles", cloud.positions.len());
        studio.draw(name, &Frame { particles: Some(drawn), caption: Some(&caption), ..empty })?;
    }

    let mesh = sample::waves([0.0; 3], [2.0, 1.0, 1.0], 384);
    let waves = UploadedSurface::new(&device, &mesh.vertices, &mesh.normals, &mesh.triangles)?;
    eprintln!("{} triangles", mesh.triangles.len());
    for name in ["water", "honey", "oil", "glycerin"] {
        let liquid = Liquid::from_name(name, 1.0).unwrap_or(Liquid::water(1.0));
        let surface = Some(DrawnSurface { buffers: waves.buffers(), liquid, style: SurfaceStyle::Liquid });
        studio.draw(name, &Frame { surface, caption: Some(name), ..empty })?;
    }
    let ball = sample::ball([1.0, 0.5, 0.5], 0.35, 64);
    let ball = UploadedSurface::new(&device, &ball.vertices, &ball.normals, &ball.triangles)?;
    let surface = Some(DrawnSurface {
        buffers: ball.buffers(),
        liquid: Liquid::water(1.0),
        style: SurfaceStyle::Liquid,
    });
    studio.draw("ball", &Frame { surface, ..empty })?;
    studio.draw("empty", &empty)?;

    if let Some(points) = arguments.next() {
        let positions = read_points(Path::new(&points))?;
        let low = |axis: usize| positions.iter().map(|p| p[axis]).fold(f32::INFINITY, f32::min);
        let high = |axis: usize| positions.iter().map(|p| p[axis]).fold(f32::NEG_INFINITY, f32::max);
        let domain = Domain::closed([low(0), low(1), low(2)], [high(0), 1.2 * high(1), high(2)]);
        let pressures: Vec<f32> = positions.iter().map(|p| p[1] - low(1)).collect();
        let points = UploadedParticles::new(&device, &positions, &[], &[], &pressures)?;
        let colouring = Colouring {
            quantity: Quantity::Pressure,
            range: [0.0, high(1) - low(1)],
            map: ColourMap::Water,
            colour_bar: true,
        };
        let drawn = DrawnParticles { buffers: points.buffers(), radius: 0.025, colouring };
        let camera = Camera::framing(&domain, 28.0, 18.0, 35.0, aspect);
        studio.draw("points", &Frame { camera, domain, particles: Some(drawn), ..empty })?;
    }
    Ok(())
}

struct Studio {
    renderer: Renderer,
    target: Offscreen,
    folder: PathBuf,
}

impl Studio {
    fn draw(&mut self, name: &str, frame: &Frame<'_>) -> Result<(), Box<dyn Error>> {
        let rgba = self.target.render_to_rgba(&mut self.renderer, frame)?;
        // The first picture of a kind compiles its shaders; the second one is timed.
        let start = Instant::now();
        self.target.render_to_rgba(&mut self.renderer, frame)?;
        eprintln!("{name}: {:.0} ms", 1e3 * start.elapsed().as_secs_f64());
        let path = self.folder.join(format!("{name}.png"));
        image::save_buffer(path, &rgba, SIZE[0], SIZE[1], image::ExtendedColorType::Rgba8)?;
        Ok(())
    }
}

/// The points of an .npy file of little-endian 32-bit floats, three to a row.
fn read_points(path: &Path) -> Result<Vec<[f32; 3]>, Box<dyn Error>> {
    let bytes = std::fs::read(path)?;
    let length = bytes.get(8..10).ok_or("too short for an .npy file")?;
    let header = 10 + usize::from(u16::from_le_bytes([length[0], length[1]]));
    let floats: Vec<f32> =
        bytes[header..].chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect();
    Ok(floats.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect())
}
