//! Reads the meshes and files of the initial fluid.

use glam::Vec3;
use splashdown_io::{Mesh, Particles};

use super::SampleError;
use crate::bodies::mesh_of;
use crate::scene::{Fluid, FluidFile, FluidMesh, MeshShape, Reach};

/// The meshes and files of a fluid, in the order of the scene. Each is read once.
#[derive(Debug)]
pub(crate) struct Sources {
    /// Meshes in m, in their own frames.
    pub meshes: Vec<Result<Mesh, SampleError>>,
    /// Particles in the frames of the files.
    pub files: Vec<Result<Particles, SampleError>>,
}

impl Sources {
    /// Reads all meshes and files.
    pub fn read(fluid: &Fluid) -> Self {
        let meshes = fluid.meshes.iter().enumerate();
        let files = fluid.files.iter().enumerate();
        Self {
            meshes: meshes
                .map(|(index, filled)| Ok(mesh_of(&mesh_title(index, filled), &filled.mesh)?))
                .collect(),
            files: files.map(|(index, file)| read_file(&file_title(index, file), file)).collect(),
        }
    }

    /// The extents and speeds of the sources; those that could not be read are left out.
    pub fn reaches(&self, fluid: &Fluid) -> Vec<Reach> {
        let meshes = fluid.meshes.iter().zip(&self.meshes).filter_map(|(filled, mesh)| {
            let place = |v: &[f32; 3]| filled.mesh.position + filled.mesh.rotation * Vec3::from(*v);
            let (low, high) = bounds(mesh.as_ref().ok()?.vertices.iter().map(place));
            Some(Reach { low, high, speed: filled.velocity.length() })
        });
        let files = fluid.files.iter().zip(&self.files).filter_map(|(file, read)| {
            let read = read.as_ref().ok()?;
            let (low, high) = bounds(positions_in_scene(read, file).into_iter().map(Vec3::from));
            let speeds = velocities_in_scene(read, file).into_iter().map(|v| Vec3::from(v).length());
            Some(Reach { low, high, speed: speeds.fold(0.0, f32::max) })
        });
        meshes.chain(files).collect()
    }
}

fn read_file(what: &str, file: &FluidFile) -> Result<Particles, SampleError> {
    #[cfg(test)]
    crate::work::count("particle file read");
    splashdown_io::read_particles(&file.path)
        .map_err(|source| SampleError::File { what: what.to_owned(), source: Box::new(source) })
}

/// The positions of a file's particles in the scene, in m.
pub(super) fn positions_in_scene(read: &Particles, file: &FluidFile) -> Vec<[f32; 3]> {
    read.positions.iter().map(|x| file.place(Vec3::from(*x)).to_array()).collect()
}

/// The velocities of a file's particles in the scene, in m/s.
pub(super) fn velocities_in_scene(read: &Particles, file: &FluidFile) -> Vec<[f32; 3]> {
    if read.velocities.is_empty() {
        return vec![file.velocity.to_array(); read.positions.len()];
    }
    let turned = |v: &[f32; 3]| (file.rotation * (file.scale * Vec3::from(*v)) + file.velocity).to_array();
    read.velocities.iter().map(turned).collect()
}

pub(super) fn bounds(points: impl Iterator<Item = Vec3>) -> (Vec3, Vec3) {
    points.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
}

/// How messages name a mesh of the fluid.
pub(crate) fn mesh_title(index: usize, filled: &FluidMesh) -> String {
    match &filled.mesh.shape {
        MeshShape::Model(name) => format!("fluid.mesh[{index}] ({name:?})"),
        MeshShape::File(path) => format!("fluid.mesh[{index}] ({:?})", path.file_name().unwrap_or_default()),
    }
}

/// How messages name a particle file.
pub(crate) fn file_title(index: usize, file: &FluidFile) -> String {
    format!("fluid.file[{index}] ({:?})", file.path.file_name().unwrap_or_default())
}
