//! Keys of all sections with a mesh.

use super::FAR;
use crate::scene::spec::{Key, Kind, Range, a_vector, key, range, words};
use crate::scene::things::UpAxis;

/// The mesh itself.
pub(super) const MESH: Key = key(
    "mesh",
    Kind::Text("a file (.obj, .stl, .ply, .gltf, .glb, .vtk, .vtp) beside the scene file, or a model's name"),
    "Mesh file, or the name of a built-in model, for example lighthouse.",
)
.also(&["file", "model", "geometry_file"]);
/// The largest and the smallest scale.
const SCALES: Range = range(1e-6, 1e6, "");
/// The scale of a mesh.
pub(super) const SCALE: Key = key(
    "scale",
    Kind::Scales(SCALES),
    "Metres per unit of the file, or the unit itself: \"mm\" is 0.001. Three values scale the axes of the file separately.",
)
.default("1.0")
.also(&["units", "unit", "size"]);
/// The scale of a file of particles, which have one spacing.
pub(super) const UNIFORM_SCALE: Key =
    key("scale", Kind::Scale(SCALES), "Metres per unit of the file, or the unit itself: \"mm\" is 0.001.")
        .default("1.0")
        .also(&["units", "unit"]);
pub(super) const UP: Key =
    key("up", Kind::Word(words::<UpAxis>), "Axis of the file that points up.").default("\"y\"");
pub(super) const POSITION: Key = key("position", a_vector(FAR, "m"), "Position of the mesh's origin.")
    .default("[0.0, 0.0, 0.0]")
    .also(&["translation", "center"]);
pub(super) const ROTATION: Key =
    key("rotation", a_vector(36_000.0, "degrees"), "Rotation about x, then y, then z.")
        .default("[0.0, 0.0, 0.0]");
