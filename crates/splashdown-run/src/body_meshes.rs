//! The meshes of the bodies: a PLY file each, next to its table, so that other programs can draw a run with its bodies.

use splashdown::bodies::BodyMesh;
use splashdown_io::{IoError, WrittenFile, write_mesh};

use crate::RunFolder;

/// Writes the repaired triangles of each body in m, in the frame of the mesh. The rows of the body's table place them.
///
/// # Errors
/// [`IoError::Write`].
pub(crate) fn write(bodies: &[BodyMesh], folder: &RunFolder) -> Result<Vec<WrittenFile>, IoError> {
    let write = |body: &BodyMesh| {
        let path = folder.body_mesh(&body.name);
        let bytes = write_mesh(&path, &body.mesh)?;
        Ok(WrittenFile { path, bytes })
    };
    bodies.iter().map(write).collect()
}
