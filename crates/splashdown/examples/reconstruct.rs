//! Reconstructs a closed triangle mesh from particles of any source.
//!
//! `cargo run --release -p splashdown --example reconstruct`

#![expect(clippy::print_stdout, reason = "an example prints its results")]

use splashdown::{Device, SurfaceParams, reconstruct};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Your particles: here a ball of radius 0.2 m.
    let spacing = 0.02_f32;
    let points: Vec<[f32; 3]> = (0..20_u32.pow(3))
        .map(|k| [k % 20, k / 20 % 20, k / 400].map(|index| (index as f32 - 9.5) * spacing))
        .filter(|x| x.iter().map(|c| c * c).sum::<f32>() < 0.2 * 0.2)
        .collect();
    let mut params = SurfaceParams::new(spacing);
    params.smoothing_iterations = 15;
    let (mesh, _) = reconstruct(&points, &params, &Device::Auto)?;
    let vertices: &[[f32; 3]] = &mesh.vertices; // m
    let triangles: &[[u32; 3]] = &mesh.triangles; // indices of vertices
    println!("{} vertices, {} triangles, {:.4} m^3", vertices.len(), triangles.len(), mesh.volume());
    Ok(())
}
