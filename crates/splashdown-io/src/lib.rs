//! Reads and writes the files of Splashdown: particles, meshes, pictures, films and tables.
//!
//! The crate depends neither on the simulation nor on a GPU. [`Particles`] and [`Mesh`] are plain arrays in SI units with
//! y up. [`ParticleInfo`] is the time and the particle spacing, which all particle files contain if they are known.
//! [`Format::ALL`] is the table of their file formats:
//!
//! | data | read and written by | formats | opens in |
//! |---|---|---|---|
//! | [`Particles`] | [`read_particles`], [`write_particles`] | PLY, VTK, VTU, VTP, BGEO, NPZ; read only: NPY, XYZ | ParaView, Blender, MeshLab, numpy |
//! | [`Mesh`] | [`read_mesh`], [`write_mesh`] | PLY, OBJ, STL, glTF, VTK, VTP | every 3-D program |
//! | all frames of a run, with bodies, camera and materials | [`StageFile`] | USD, GLB | Blender, Houdini, Maya |
//! | index of the VTU or VTP files of a run | [`pvd::write_index`] | PVD | ParaView |
//! | [`Picture`] | `picture::read_png`, `picture::write_png` (feature `png`) | PNG | every program |
//! | film | [`Film`] | MP4, encoded by the `ffmpeg` that the user has installed | every player |
//! | named arrays and texts | [`Archive`] | ZIP of NPY | `numpy.load` |
//! | growing table | [`CsvLog`] | CSV | every spreadsheet, `pandas` |
//!
//! ```
//! # fn main() -> Result<(), splashdown_io::IoError> {
//! use splashdown_io::{Mesh, read_mesh, write_mesh};
//!
//! let vertices = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
//! let tetrahedron = Mesh::new(vertices, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]);
//! assert!(tetrahedron.topology()?.is_watertight());
//! assert!((tetrahedron.volume() - 1.0 / 6.0).abs() < 1e-12);
//!
//! let path = std::env::temp_dir().join(format!("tetrahedron-{}.ply", std::process::id()));
//! write_mesh(&path, &tetrahedron)?;
//! assert_eq!(read_mesh(&path)?, tetrahedron);
//! # std::fs::remove_file(&path).ok();
//! # Ok(())
//! # }
//! ```
//!
//! # A series of frames
//!
//! [`prepare_folder`] checks before the first step that the output folder is writable. [`FrameWriter`] writes frames on
//! a separate thread while the simulation continues.
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
//!     let particles = Arc::new(Particles::from_positions(vec![[0.0; 3]; 10]));
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
//! # Guarantees
//!
//! * A file is complete or absent ([`atomic`]): it is renamed to its name after its last byte is written. A later failure
//!   leaves earlier files intact. ([`CsvLog`] is the exception: its rows are complete or absent.)
//! * An error contains the file, the cause and the remedy ([`IoError`]). No file content causes a panic.
//! * Readers refuse a file that declares more data than it contains before they allocate memory for it. Decompressed data
//!   has a limit ([`set_input_limit`]). Pipes and devices are refused.

#[cfg(target_endian = "big")]
compile_error!("the binary writers copy memory to the file, which requires a little-endian machine");

mod archive;
pub mod atomic;
pub mod bgeo;
mod data;
mod error;
mod film;
mod format;
pub mod gltf;
mod input;
mod limit;
mod mesh;
pub mod npy;
mod npz;
mod number;
pub mod obj;
mod particles;
pub mod picture;
pub mod ply;
pub mod pvd;
mod read;
pub mod stage;
mod stage_file;
pub mod stl;
mod table;
mod topology;
mod usd;
pub mod vtk;
pub mod vtu;
mod writer;
mod xyz;

pub use archive::{Archive, NpyElement};
pub use atomic::prepare_folder;
pub use data::{Attribute, Mesh, ParticleInfo, Particles};
pub use error::{FilmError, IoError, WriteCause};
pub use film::{Film, FilmOptions};
pub use format::Format;
pub use limit::set_input_limit;
pub use mesh::write_mesh;
pub use particles::write_particles;
pub use picture::Picture;
pub use read::{read_mesh, read_particles, read_particles_with_attributes};
pub use stage_file::{PART_ENDING, StageFile};
pub use table::CsvLog;
pub use topology::Topology;
pub use writer::{FrameWriter, Job, WriteFailure, WrittenFile};
