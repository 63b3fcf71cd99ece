//! Keys that everything with a mesh has.

use super::FAR;
use crate::scene::spec::{Key, Kind, a_vector, key, range, words};
use crate::scene::things::UpAxis;

/// The mesh of anything that has one.
pub(super) const MESH: Key = key(
    "mesh",
    Kind::Text("a file (.obj, .stl, .ply, .gltf, .glb) beside the scene file, or a model's name"),
    "Its triangles: a file, or one of the models that come with the program, such as lighthouse; a name that is none is answered with the list.",
)
.also(&["file", "model", "geometry_file"]);
pub(super) const SCALE: Key = key(
    "scale",
    Kind::Scale(range(1e-6, 1e6, "")),
    "Metres per unit of the file, or the file's unit: \"mm\" is 0.001.",
)
.default("1.0")
.also(&["units", "unit"]);
pub(super) const UP: Key =
    key("up", Kind::Word(words::<UpAxis>), "Which axis of the file points up.").default("\"y\"");
pub(super) const POSITION: Key = key("position", a_vector(FAR, "m"), "Where the mesh's origin lies.")
    .default("[0.0, 0.0, 0.0]")
    .also(&["translation", "center"]);
pub(super) const ROTATION: Key =
    key("rotation", a_vector(36_000.0, "degrees"), "Turned about x, then y, then z.")
        .default("[0.0, 0.0, 0.0]");
