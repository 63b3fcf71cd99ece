//! What is tested: one target per reader.

use std::fs;
use std::io::{Cursor, Read as _, Write as _};
use std::path::Path;

use anyhow::Result;
use splashdown::scene::{CameraPath, Formula, Scene};
use splashdown::{Checkpoint, Device, Run, RunOptions};
use splashdown_io::{picture, read_mesh, read_particles, read_particles_with_attributes};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

use crate::seeds;

/// A reader with the inputs from which the search starts.
pub struct Target {
    /// The name, which is also that of its folder in `corpus`.
    pub name: &'static str,
    /// Valid inputs.
    pub seeds: fn() -> Result<Vec<Vec<u8>>>,
    /// Reads an input, which may be written into the folder; returns whether the input is valid.
    pub run: fn(&[u8], &Path) -> bool,
    /// The most memory that an input may use, in bytes.
    pub memory: usize,
}

/// Memory for an input of 64 KiB whose data may take 4 MiB: the data, its numbers as f64, and the result.
const MEMORY: usize = 64 << 20;

/// Memory for a simulation of a few particles.
const SIMULATION_MEMORY: usize = 512 << 20;

/// The limit for the data of one file in the tests, in bytes.
pub const INPUT_LIMIT: u64 = 4 << 20;

const fn of(
    name: &'static str,
    seeds: fn() -> Result<Vec<Vec<u8>>>,
    run: fn(&[u8], &Path) -> bool,
) -> Target {
    Target { name, seeds, run, memory: MEMORY }
}

/// All targets.
pub fn targets() -> Vec<Target> {
    vec![
        of("ply", || Ok(vec![seeds::particle_file(".ply")?]), |bytes, at| particles(bytes, at, ".ply")),
        of("vtk", || Ok(vec![seeds::particle_file(".vtk")?]), |bytes, at| particles(bytes, at, ".vtk")),
        of(
            "vtu",
            || Ok(vec![seeds::particle_file(".vtu")?, seeds::vtu_text()]),
            |bytes, at| particles(bytes, at, ".vtu"),
        ),
        of("vtp", || Ok(vec![seeds::particle_file(".vtp")?]), |bytes, at| particles(bytes, at, ".vtp")),
        of("bgeo", || Ok(vec![seeds::particle_file(".bgeo")?]), |bytes, at| particles(bytes, at, ".bgeo")),
        of(
            "bgeo-gz",
            || Ok(vec![seeds::particle_file(".bgeo")?]),
            |bytes, at| particles(&gzip(bytes), at, ".bgeo.gz"),
        ),
        of("npz", || Ok(vec![seeds::particle_file(".npz")?]), |bytes, at| particles(bytes, at, ".npz")),
        of("npz-array", npy_seeds, |bytes, at| particles(&npz(bytes), at, ".npz")),
        of("npy", npy_seeds, |bytes, at| particles(bytes, at, ".npy")),
        of(
            "xyz",
            || Ok(vec![b"# x y z\n0 0 0\n1, 2, 3\n".to_vec(), b"2\ntitle\nO 1 2 3\nO 4 5e-1 6\n".to_vec()]),
            |bytes, at| particles(bytes, at, ".xyz"),
        ),
        of("ply-mesh", || Ok(vec![seeds::mesh_file(".ply")?]), |bytes, at| mesh(bytes, at, ".ply")),
        of("vtk-mesh", || Ok(vec![seeds::mesh_file(".vtk")?]), |bytes, at| mesh(bytes, at, ".vtk")),
        of("vtp-mesh", || Ok(vec![seeds::mesh_file(".vtp")?]), |bytes, at| mesh(bytes, at, ".vtp")),
        of("obj", || Ok(vec![seeds::mesh_file(".obj")?]), |bytes, at| mesh(bytes, at, ".obj")),
        of(
            "stl",
            || Ok(vec![seeds::mesh_file(".stl")?, STL.as_bytes().to_vec()]),
            |bytes, at| mesh(bytes, at, ".stl"),
        ),
        of("glb", || Ok(vec![seeds::mesh_file(".glb")?]), |bytes, at| mesh(bytes, at, ".glb")),
        of("gltf", || Ok(vec![seeds::gltf()]), |bytes, at| mesh(bytes, at, ".gltf")),
        of("png", || Ok(vec![seeds::png()?]), |bytes, _| picture::decode_png(bytes).is_ok()),
        of(
            "scene",
            || Ok(seeds::scenes()),
            |bytes, _| std::str::from_utf8(bytes).is_ok_and(|text| Scene::parse(text, "fuzz.toml").is_ok()),
        ),
        of("camera-path", || Ok(vec![CAMERA_PATH.as_bytes().to_vec()]), |bytes, _| camera_path(bytes)),
        of("formula", formula_seeds, |bytes, _| {
            let formula = std::str::from_utf8(bytes).ok().and_then(|text| Formula::parse(text).ok());
            formula.is_some_and(|formula| !formula.at(0.5).to_string().is_empty())
        }),
        of(
            "checkpoint",
            || Ok(vec![seeds::checkpoint()?]),
            |bytes, _| Checkpoint::from_bytes(bytes).is_ok_and(|checkpoint| checkpoint.check().is_ok()),
        ),
        Target {
            name: "resume",
            seeds: || Ok(vec![seeds::checkpoint()?]),
            run: |bytes, _| resume(bytes),
            memory: SIMULATION_MEMORY,
        },
    ]
}

const STL: &str = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1e0 0\nendloop\n\
                   endfacet\nendsolid a\n";

const CAMERA_PATH: &str = "[[keyframe]]\ntime = 0\neye = [1, 0.5, 2]\ntarget = [0.1, 0, 0]\n[[keyframe]]\ntime = 0.5\n\
                           azimuth = 90\n[[keyframe]]\ntime = 2\ndistance = 0.3\nelevation = -5\nfield_of_view = 60\n";

/// Reads a camera path; the camera of a valid one has a place at all times.
fn camera_path(bytes: &[u8]) -> bool {
    let (Ok(text), Ok(mut scene)) = (std::str::from_utf8(bytes), Scene::parse(seeds::SMALL, "small.toml"))
    else {
        return false;
    };
    let Ok(path) = CameraPath::parse(text, "path.toml", &scene.camera) else { return false };
    scene.camera_path = path;
    for time in [0.0, 0.3, 0.5, 1.9, 1e4] {
        let camera = scene.camera_at(time);
        assert!(camera.eye(0.0).is_finite() && camera.distance > 0.0, "{camera:?} at {time} s");
    }
    true
}

fn particles(bytes: &[u8], folder: &Path, ending: &str) -> bool {
    let path = folder.join(format!("a{ending}"));
    write(&path, bytes);
    let known = read_particles(&path).is_ok();
    read_particles_with_attributes(&path).is_ok() && known
}

fn mesh(bytes: &[u8], folder: &Path, ending: &str) -> bool {
    let path = folder.join(format!("a{ending}"));
    write(&path, bytes);
    read_mesh(&path).is_ok()
}

fn write(path: &Path, bytes: &[u8]) {
    fs::write(path, bytes).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
}

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    encoder.write_all(bytes).and_then(|()| encoder.finish()).unwrap_or_default()
}

/// An archive with one compressed array, whose checksum is right.
fn npz(bytes: &[u8]) -> Vec<u8> {
    pack([("positions.npy".to_owned(), bytes.to_vec())], CompressionMethod::Deflated)
}

fn pack(entries: impl IntoIterator<Item = (String, Vec<u8>)>, method: CompressionMethod) -> Vec<u8> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in entries {
        let options = SimpleFileOptions::default().compression_method(method);
        if zip.start_file(name, options).is_ok() {
            // Writing into memory does not fail.
            let _ = zip.write_all(&bytes);
        }
    }
    zip.finish().map(Cursor::into_inner).unwrap_or_default()
}

/// Resumes a checkpoint whose checksums are made right, so that changes reach the code behind them, for one frame.
fn resume(bytes: &[u8]) -> bool {
    let Some(entries) = lenient_entries(bytes) else { return false };
    let Ok(checkpoint) = Checkpoint::from_bytes(&pack(entries, CompressionMethod::Stored)) else {
        return false;
    };
    let Ok(scene) = checkpoint.scene() else { return false };
    // A changed scene may be large; only the state is tested here.
    if scene.text.as_ref() != seeds::SMALL || checkpoint.check().is_err() {
        return false;
    }
    let mut options = RunOptions::new(&scene).with_frames(2);
    options.device = Device::Cpu;
    Run::resume(&checkpoint, &scene, options).is_ok()
}

/// The entries of an archive of stored files, whatever their checksums.
fn lenient_entries(bytes: &[u8]) -> Option<Vec<(String, Vec<u8>)>> {
    let mut zip = ZipArchive::new(Cursor::new(bytes)).ok()?;
    let mut entries = Vec::new();
    for index in 0..zip.len() {
        let mut entry = zip.by_index(index).ok()?;
        let name = entry.name().ok()?.into_owned();
        let mut content = Vec::new();
        // The checksum is compared at the end, when the content has been read.
        let _ = entry.by_ref().take(1 << 20).read_to_end(&mut content);
        entries.push((name, content));
    }
    Some(entries)
}

fn npy_seeds() -> Result<Vec<Vec<u8>>> {
    let floats: Vec<u8> = (0..6).flat_map(|n| (n as f32).to_le_bytes()).collect();
    let doubles: Vec<u8> = (0..6).flat_map(|n| f64::from(n).to_le_bytes()).collect();
    Ok(vec![seeds::npy("<f4", "(2, 3)", &floats), seeds::npy("<f8", "(2, 3)", &doubles)])
}

fn formula_seeds() -> Result<Vec<Vec<u8>>> {
    let texts = [
        "0.1 * sin(2 * pi * t)",
        "max(0, -t ^ 2) + floor(t / 3)",
        "-(1 - 2e-3) / (t + (0.5))",
        "min(t, 1) - abs(cos(t))",
    ];
    Ok(texts.map(|text| text.as_bytes().to_vec()).to_vec())
}
