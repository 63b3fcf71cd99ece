//! Droplets in pictures of finished runs.
//!
//! The files of a run contain a mesh without isolated particles and these particles as droplets. Other runs, and other
//! limits, leave isolated particles in the mesh: they are found again among the particles of the frame, and the
//! components of the mesh that contain only isolated particles are removed.

use std::collections::{BTreeMap, HashSet};
use std::path::{Path, PathBuf};

use splashdown::glam::{IVec3, Vec3};
use splashdown::scene::Scene;
use splashdown::surface::{SurfaceParams, Walls, droplets_of, isolated, retain_components};
use splashdown_io::{Format, IoError, Mesh, Particles, read_particles};

use crate::RunError;
use crate::folder::DROPLETS;

/// The mesh without isolated particles, and these, of a frame of a finished run. Without particle files there are no
/// droplets.
///
/// # Errors
/// [`RunError::Io`] if a file cannot be read; [`RunError::Simulation`] if the particles are too far apart.
pub(super) fn separate(
    mesh: Mesh,
    path: &Path,
    scene: &Scene,
) -> Result<(Mesh, Option<Particles>), RunError> {
    let Some(file) = particles_beside(path) else { return Ok((mesh, None)) };
    let particles = read_particles(&file)?;
    let known = match beside(path, DROPLETS, DROPLETS).map(|path| read_particles(&path)) {
        Some(Ok(droplets)) => droplets.ids,
        None | Some(Err(IoError::NoParticles { .. })) => Vec::new(),
        Some(Err(error)) => return Err(error.into()),
    };
    Ok(with_droplets(mesh, &particles, &known, scene)?)
}

/// As [`separate`]; `known` are the ids of the particles that are not part of the mesh.
///
/// # Errors
/// If the particles are too far apart.
pub(super) fn with_droplets(
    mut mesh: Mesh,
    particles: &Particles,
    known: &[u32],
    scene: &Scene,
) -> Result<(Mesh, Option<Particles>), splashdown::SimulationError> {
    let spacing = scene.fluid.particle_spacing;
    let params = SurfaceParams::of_scene(&scene.surface, spacing, Walls::NONE);
    let mut indices = isolated(&particles.positions, &params)?;
    let known: HashSet<u32> = known.iter().copied().collect();
    let id = |i: u32| particles.ids.get(i as usize).copied().unwrap_or(i);
    let in_mesh: Vec<Vec3> = place(particles, indices.iter().copied().filter(|&i| !known.contains(&id(i))));
    if !in_mesh.is_empty() {
        let apart: HashSet<u32> = indices.iter().copied().collect();
        let all = 0..particles.positions.len() as u32;
        let kept = Places::new(place(particles, all.filter(|i| !apart.contains(i))), spacing);
        let in_mesh = Places::new(in_mesh, spacing);
        let limit = params.support_radius;
        retain_components(&mut mesh, |[low, high]| {
            // Larger components contain other particles too.
            let is_large = (high - low).max_element() > 64.0 * limit;
            is_large || !in_mesh.any_inside(low, high) || kept.any_inside(low, high)
        });
    }
    indices.extend((0..particles.positions.len() as u32).filter(|&i| known.contains(&id(i))));
    indices.sort_unstable();
    indices.dedup();
    Ok((mesh, Some(droplets_of(particles, &indices, spacing))))
}

fn place(particles: &Particles, indices: impl Iterator<Item = u32>) -> Vec<Vec3> {
    indices.map(|i| particles.positions[i as usize].into()).collect()
}

/// Points by cubic cells of four spacings.
struct Places {
    edge: f32,
    cells: BTreeMap<[i32; 3], Vec<Vec3>>,
}

impl Places {
    fn new(points: Vec<Vec3>, spacing: f32) -> Self {
        let mut places = Self { edge: 4.0 * spacing, cells: BTreeMap::new() };
        for x in points {
            places.cells.entry(places.cell(x).to_array()).or_default().push(x);
        }
        places
    }

    fn cell(&self, x: Vec3) -> IVec3 {
        (x / self.edge).floor().as_ivec3()
    }

    /// Whether a point lies inside a box.
    fn any_inside(&self, low: Vec3, high: Vec3) -> bool {
        let (first, last) = (self.cell(low), self.cell(high));
        let columns = (first.x..=last.x).flat_map(|x| (first.y..=last.y).map(move |y| (x, y)));
        columns.into_iter().any(|(x, y)| {
            let cells = self.cells.range([x, y, first.z]..=[x, y, last.z]);
            cells.flat_map(|(_, points)| points).any(|p| p.cmpge(low).all() && p.cmple(high).all())
        })
    }
}

/// The file of the particles of the frame of a mesh file.
pub(super) fn particles_beside(mesh: &Path) -> Option<PathBuf> {
    beside(mesh, "particles", "particles")
}

/// The file in a folder of the run with the particles of the frame of a mesh file, in any format that can be read.
fn beside(mesh: &Path, folder: &str, stem: &str) -> Option<PathBuf> {
    let name = mesh.file_stem()?.to_string_lossy().into_owned();
    let (_, digits) = name.rsplit_once('_')?;
    let folder = mesh.parent()?.parent()?.join(folder);
    let endings = Format::endings(Format::reads_particles);
    let file = |ending: &str| folder.join(format!("{stem}_{digits}.{}", ending.trim_start_matches('.')));
    endings.into_iter().map(file).find(|path| path.exists())
}

#[cfg(test)]
mod tests {
    use super::*;
    use splashdown::surface::reconstruct_with;
    use splashdown_gpu::{CpuExecutor, Executor};

    const SCENE: &str = "[scene]\nname = \"cube\"\nduration = 1\n[domain]\nmin = [0, 0, 0]\nmax = [4, 4, 4]\n\
        [fluid]\nparticle_spacing = 0.1\n[[fluid.block]]\nposition = [0, 0, 0]\nsize = [1, 1, 1]\n";

    /// A block, a block of 12 particles, a pair and a single particle.
    fn splash() -> Particles {
        let lattice = |size: [u32; 3], corner: Vec3| {
            let place = move |i: u32| [i % size[0], i / size[0] % size[1], i / size[0] / size[1]];
            (0..size.iter().product())
                .map(move |i| (corner + 0.1 * Vec3::from(place(i).map(|c| c as f32))).to_array())
        };
        let pieces = [
            lattice([8, 8, 8], Vec3::splat(0.5)),
            lattice([3, 2, 2], Vec3::new(2.5, 0.5, 0.5)),
            lattice([2, 1, 1], Vec3::new(0.5, 2.5, 0.5)),
            lattice([1, 1, 1], Vec3::new(0.5, 0.5, 2.5)),
        ];
        Particles::from_positions(pieces.into_iter().flatten().collect())
    }

    fn mesh_of(scene: &Scene, min_blob: u32, min_neighbours: u32) -> Mesh {
        let mut params = SurfaceParams::of_scene(&scene.surface, 0.1, Walls::NONE);
        (params.min_blob, params.min_neighbours) = (min_blob, min_neighbours);
        let mut executor = Executor::from(CpuExecutor::new());
        reconstruct_with(&splash().positions, &params, &mut executor).unwrap().0
    }

    #[test]
    fn a_mesh_with_and_without_isolated_particles_gives_the_same_picture() {
        let scene = Scene::parse(SCENE, "cube").unwrap_or_else(|errors| panic!("{errors}"));
        let (with, without) = (mesh_of(&scene, 0, 0), mesh_of(&scene, 9, 3));
        assert_eq!(with.topology().unwrap().components, 4);
        let separated = [(with, vec![]), (without.clone(), vec![524, 525, 526])];
        for (mesh, known) in separated {
            let (mesh, droplets) = with_droplets(mesh, &splash(), &known, &scene).unwrap();
            assert_eq!(mesh.topology().unwrap().components, 2);
            assert!((mesh.volume() / without.volume() - 1.0).abs() < 1e-6);
            assert_eq!(droplets.unwrap().ids, [524, 525, 526]);
        }
    }

    #[test]
    fn droplets_of_the_files_are_drawn_whatever_the_limits() {
        let mut scene = Scene::parse(SCENE, "cube").unwrap_or_else(|errors| panic!("{errors}"));
        let mesh = mesh_of(&scene, 9, 3);
        (scene.surface.min_blob, scene.surface.min_neighbours) = (0, 0);
        let (same, droplets) = with_droplets(mesh.clone(), &splash(), &[524, 525, 526], &scene).unwrap();
        assert_eq!((same.len(), droplets.unwrap().len()), (mesh.len(), 3));
    }
}
