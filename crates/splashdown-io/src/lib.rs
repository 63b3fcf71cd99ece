//! Splashdown's files: particles and meshes in, frames out.
//!
//! The crate knows nothing of fluids or GPUs. [`Particles`] and [`Mesh`] are plain arrays in SI units with y
//! up; the modules write and read them:
//!
//! | data | formats | opens in |
//! |---|---|---|
//! | [`Particles`] | PLY ([`ply`]), VTK ([`vtk`]), VTU ([`vtu`]) with an index of the series ([`pvd`]), BGEO ([`bgeo`]), NPZ ([`npz`]); all also read by [`read_particles`], and NPY ([`npy`]) and XYZ ([`xyz`]) | ParaView, Blender, Houdini, MeshLab, numpy |
//! | [`Mesh`] | PLY ([`ply`]), OBJ ([`obj`]), STL ([`stl`]), glTF ([`gltf`]), all also read by [`read_mesh`]; VTK ([`vtk`]) | every 3-D program |
//! | a whole run of either | USD ([`usd`]) | Blender, Houdini, Maya |
//! | [`Picture`] | PNG ([`picture`]), film ([`film`], by the user's `ffmpeg`) | everything |
//! | named arrays and texts | ZIP of NPY ([`Archive`]) | `numpy.load` |
//! | a growing table | CSV ([`CsvLog`]) | every spreadsheet, `pandas` |
//!
//! ```
//! # fn main() -> Result<(), splashdown_io::IoError> {
//! use splashdown_io::{Mesh, mesh};
//!
//! let tetrahedron = Mesh {
//!     vertices: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
//!     triangles: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]],
//!     ..Mesh::default()
//! };
//! assert!(tetrahedron.topology()?.is_watertight());
//! assert!((tetrahedron.volume() - 1.0 / 6.0).abs() < 1e-12);
//!
//! let path = std::env::temp_dir().join(format!("tetrahedron-{}.ply", std::process::id()));
//! mesh::write(&path, &tetrahedron)?;
//! assert_eq!(splashdown_io::ply::read_mesh(&path)?, tetrahedron);
//! # std::fs::remove_file(&path).ok();
//! # Ok(())
//! # }
//! ```
//!
//! # A series of frames
//!
//! [`prepare_folder`] finds out before the first step whether the output folder can be written.
//! [`FrameWriter`] then writes frames on a thread of its own, beside the simulation, and [`film::Film`] makes
//! the film:
//!
//! ```
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! use splashdown_io::{FrameWriter, Job, Particles, prepare_folder};
//! use std::sync::Arc;
//!
//! let folder = std::env::temp_dir().join(format!("splashdown-frames-{}", std::process::id()));
//! prepare_folder(&folder)?;
//! let writer = FrameWriter::start()?;
//! for frame in 0..3 {
//!     let particles = Arc::new(Particles { positions: vec![[0.0; 3]; 10], ..Particles::default() });
//!     writer.submit(vec![
//!         Job::Particles(folder.join(format!("particles_{frame:04}.ply")), Arc::clone(&particles)),
//!         Job::Particles(folder.join(format!("particles_{frame:04}.vtu")), particles),
//!     ])?;
//! }
//! let files = writer.finish()?;
//! assert_eq!(files.len(), 6);
//! # std::fs::remove_dir_all(&folder).ok();
//! # Ok(())
//! # }
//! ```
//!
//! # What is promised
//!
//! * A file is complete or absent ([`atomic`]): it gets its name when everything is in it. Whatever goes
//!   wrong later, files written before stay valid.
//! * An error names the file, the cause and what to do ([`IoError`]). Nothing panics on what a file or user
//!   contains.
//! * Readers refuse a file that promises more than it holds before they ask for memory.

#[cfg(target_endian = "big")]
compile_error!(
    "the binary writers hand memory to the file as it is, which is right on little-endian machines only"
);

pub mod archive;
pub mod atomic;
pub mod bgeo;
mod columns;
pub mod error;
pub mod film;
pub mod gltf;
mod input;
pub mod mesh;
pub mod npy;
pub mod npz;
mod number;
pub mod obj;
pub mod particles;
pub mod picture;
pub mod ply;
pub mod pvd;
pub mod read;
pub mod stl;
mod table;
pub mod topology;
pub mod usd;
pub mod vtk;
pub mod vtu;
pub mod writer;
pub mod xyz;

pub use archive::{Archive, NpyElement};
pub use atomic::prepare_folder;
pub use attribute::Attribute;
pub use error::{IoError, WriteCause};
pub use film::{Film, FilmError, FilmOptions};
pub use picture::Picture;
pub use read::{MESH_FORMATS_READ, PARTICLE_FORMATS_READ, read_all, read_mesh, read_particles};
pub use table::CsvLog;
pub use topology::Topology;
pub use writer::{FrameWriter, Job, WriteFailure, WrittenFile};
