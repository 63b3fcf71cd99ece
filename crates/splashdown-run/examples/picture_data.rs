//! Writes what the picture of a frame shows as JSON, from which another renderer can draw the same picture.
//!
//! `cargo run --release -p splashdown-run --example picture_data -- SCENE.toml RUN FRAME OUT.json`
//!
//! RUN is the output folder of a run with PLY files. Lengths are in metres, colours are linear red, green and blue.
//! `cargo xtask cycles` reads the file.

use std::error::Error;
use std::path::Path;

use serde_json::{Value, json};
use splashdown::bodies::body_meshes;
use splashdown::scene::Scene;
use splashdown::surface::droplet_radius;
use splashdown_io::{IoError, Particles, read_particles};
use splashdown_render::{FloorPattern, PlacedBody, Tank};
use splashdown_run::{Beside, appearance};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [scene, run, frame, out] = &arguments[..] else {
        return Err("give SCENE.toml RUN FRAME OUT.json".into());
    };
    let scene = Scene::load(scene)?;
    let data = data(&scene, Path::new(run), frame.parse()?)?;
    std::fs::write(out, serde_json::to_vec(&data)?)?;
    Ok(())
}

fn data(scene: &Scene, run: &Path, frame: u32) -> Result<Value, Box<dyn Error>> {
    let droplets = droplets(&run.join("droplets").join(format!("droplets_{frame:04}.ply")))?;
    let mesh = run.join("mesh").join(format!("surface_{frame:04}.ply")).canonicalize()?;
    let camera = appearance::camera(scene, f64::from(frame) / f64::from(scene.frame_rate));
    let empty = appearance::empty_frame(scene, camera);
    let around = empty.domain.surroundings();
    let liquid = appearance::liquid(scene);
    let sky = empty.sky;
    let pattern = |pattern| match pattern {
        FloorPattern::Checkerboard => "checkerboard",
        FloorPattern::Plain => "plain",
        _ => "tiles",
    };
    Ok(json!({
        "mesh": mesh,
        "camera": {
            "eye": camera.eye,
            "target": camera.target,
            "up": camera.up,
            "field_of_view": camera.field_of_view_deg,
            // As droplets of a picture with `--quality standard`; everything is in focus there.
            "shutter": appearance::shutter(scene),
        },
        "domain": { "min": empty.domain.min, "max": empty.domain.max, "closed": empty.domain.closed },
        "has_glass": empty.tank == Tank::Glass,
        "floor": empty.floor.map(|floor| json!({
            "pattern": pattern(floor.pattern),
            "colour": floor.colour,
            "height": around.floor_height,
            "tile_size": around.tile_size,
            "fade_distance": around.fade_distance,
        })),
        "glass_thickness": around.glass_thickness,
        "sun": empty.sun,
        "sky": {
            "zenith": sky.zenith,
            "horizon": sky.horizon,
            "sun_light": sky.sun_light,
            "glow": sky.glow,
            "haze": sky.haze,
            "hills": sky.hills,
            "hill_height": sky.hill_height,
            "clouds": sky.clouds,
            "cloud_opacity": sky.cloud_opacity,
            "cloud_cover": sky.cloud_cover,
            "sky_light": sky.sky_light,
        },
        "liquid": { "absorption": liquid.absorption, "refractive_index": liquid.refractive_index },
        "droplets": {
            "radius": droplet_radius(scene.fluid.particle_spacing),
            "positions": droplets.positions,
            "velocities": droplets.velocities,
        },
        "bodies": bodies(scene, &mesh)?,
    }))
}

/// The droplets of the frame; none before the first splash.
fn droplets(path: &Path) -> Result<Particles, IoError> {
    match read_particles(path) {
        Err(IoError::NoParticles { .. }) => Ok(Particles::default()),
        read => read,
    }
}

/// The bodies with their vertices in the places of the frame.
fn bodies(scene: &Scene, mesh: &Path) -> Result<Vec<Value>, Box<dyn Error>> {
    let states = Beside::of_file(mesh, scene)?.bodies;
    let body = |(body, state): (&splashdown::BodyMesh, &splashdown::BodyState)| {
        let place = |vertex: &[f32; 3]| {
            (state.position + state.orientation * splashdown::glam::Vec3::from(*vertex)).to_array()
        };
        json!({
            "vertices": body.mesh.vertices.iter().map(place).collect::<Vec<_>>(),
            "triangles": body.mesh.triangles,
            "colour": body.colour.unwrap_or(PlacedBody::COLOUR),
        })
    };
    Ok(body_meshes(scene)?.iter().zip(&*states).map(body).collect())
}
