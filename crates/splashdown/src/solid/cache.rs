//! A cache of solids on disk. The file name is a hash of the inputs.

use std::fs;
use std::path::{Path, PathBuf};

use glam::{Vec2, Vec3};
use splashdown_io::Mesh;

use super::field::DistanceField;
use super::{RepairReport, SolidSettings, Surroundings};
use crate::boundary::PlaneFraction;

/// Version of the file contents. Increase it when the same inputs give a different solid.
const VERSION: u32 = 5;
const MAGIC: &[u8; 8] = b"SDSOLID3";

/// The default cache folder of solids: `splashdown/solids` in the user's cache folder, if there is one.
pub fn default_cache_folder() -> Option<PathBuf> {
    let from = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    let base = from("XDG_CACHE_HOME")
        .or_else(|| from("LOCALAPPDATA"))
        .or_else(|| from("HOME").map(|home| home.join(".cache")))?;
    Some(base.join("splashdown").join("solids"))
}

/// The file for a mesh and settings.
pub(super) fn file(
    folder: &Path,
    mesh: &Mesh,
    settings: &SolidSettings,
    surroundings: Option<&Surroundings<'_>>,
) -> PathBuf {
    let mut hash = Fnv::default();
    hash.add(&VERSION.to_le_bytes());
    hash.add(bytemuck::cast_slice(&mesh.vertices));
    hash.add(bytemuck::cast_slice(&mesh.triangles));
    for number in [settings.cell_size, settings.support_radius, settings.half_thickness] {
        hash.add(&number.to_le_bytes());
    }
    if let Some((low, high)) = settings.region {
        hash.add(bytemuck::cast_slice(&[low, high]));
    }
    let PlaneFraction { kernels, stretch, offset } = settings.fraction;
    hash.add(&kernels.id().to_le_bytes());
    hash.add(bytemuck::cast_slice(&[stretch, offset]));
    hash.add(&[match settings.shell {
        None => 0,
        Some(false) => 1,
        Some(true) => 2,
    }]);
    if let Some(surroundings) = surroundings {
        hash.add(bytemuck::cast_slice(&surroundings.words()));
    }
    folder.join(format!("{:032x}.solid", hash.0))
}

/// The 128-bit FNV-1a hash. It names files and detects damage; it need not be cryptographic.
struct Fnv(u128);

impl Default for Fnv {
    fn default() -> Self {
        Self(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d)
    }
}

impl Fnv {
    fn add(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = (self.0 ^ u128::from(byte)).wrapping_mul(0x0000_0000_0100_0000_0000_0000_0000_013b);
        }
    }
}

fn hash_of(bytes: &[u8]) -> u128 {
    let mut hash = Fnv::default();
    hash.add(bytes);
    hash.0
}

/// The header of a cache file.
#[derive(serde::Serialize, serde::Deserialize)]
struct Header {
    report: RepairReport,
    vertices: usize,
    triangles: usize,
    min: [f32; 3],
    cell_size: f32,
    nodes: [u32; 3],
}

/// Reads a solid; `None` if the file is missing or damaged.
pub(super) fn load(path: &Path) -> Option<(Mesh, RepairReport, DistanceField)> {
    // Anything else in the folder of the cache could be endless.
    let bytes = path.metadata().is_ok_and(|data| data.is_file()).then(|| fs::read(path).ok())??;
    let (content, sum) = bytes.split_last_chunk::<16>()?;
    if *sum != hash_of(content).to_le_bytes() {
        return None;
    }
    let rest = content.strip_prefix(MAGIC)?;
    let (length, rest) = rest.split_first_chunk::<4>()?;
    let (header, rest) = rest.split_at_checked(u32::from_le_bytes(*length) as usize)?;
    let header: Header = serde_json::from_slice(header).ok()?;
    let count = header.nodes.iter().try_fold(1usize, |n, &axis| n.checked_mul(axis as usize))?;
    let (vertices, rest) = rest.split_at_checked(header.vertices.checked_mul(12)?)?;
    let (triangles, rest) = rest.split_at_checked(header.triangles.checked_mul(12)?)?;
    if rest.len() != count.checked_mul(8)? {
        return None;
    }
    let mesh = Mesh::new(bytemuck::pod_collect_to_vec(vertices), bytemuck::pod_collect_to_vec(triangles));
    let field = DistanceField {
        min: Vec3::from(header.min),
        cell_size: header.cell_size,
        nodes: header.nodes,
        values: bytemuck::pod_collect_to_vec::<u8, Vec2>(rest),
    };
    Some((mesh, header.report, field))
}

/// Writes a solid. A failure is only logged: the next run then builds the solid again.
pub(super) fn save(path: &Path, mesh: &Mesh, report: RepairReport, field: &DistanceField) {
    let write = || -> std::io::Result<()> {
        let folder = path.parent().unwrap_or(Path::new("."));
        fs::create_dir_all(folder)?;
        let header = Header {
            report,
            vertices: mesh.vertices.len(),
            triangles: mesh.triangles.len(),
            min: field.min.to_array(),
            cell_size: field.cell_size,
            nodes: field.nodes,
        };
        let header = serde_json::to_vec(&header)?;
        let mut content = MAGIC.to_vec();
        content.extend((header.len() as u32).to_le_bytes());
        content.extend(header);
        content.extend_from_slice(bytemuck::cast_slice(&mesh.vertices));
        content.extend_from_slice(bytemuck::cast_slice(&mesh.triangles));
        content.extend_from_slice(bytemuck::cast_slice(&field.values));
        content.extend(hash_of(&content).to_le_bytes());
        let partial = path.with_extension(format!("{}.partial", std::process::id()));
        fs::write(&partial, content).inspect_err(|_| drop(fs::remove_file(&partial)))?;
        fs::rename(&partial, path).inspect_err(|_| drop(fs::remove_file(&partial)))
    };
    if let Err(error) = write() {
        tracing::warn!("{}: the solid could not be cached: {error}", path.display());
    }
}
