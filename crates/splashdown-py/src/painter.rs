//! Pictures of frames.

use std::path::PathBuf;
use std::sync::Arc;

use numpy::{PyArray3, PyArrayMethods};
use pyo3::prelude::*;
use splashdown::scene::PictureKind;
use splashdown_io::Picture;

use crate::busy::Guarded;
use crate::errors::{ArrayError, Result};
use crate::mesh::Mesh;
use crate::particles::Particles;
use crate::recording::word_of;
use crate::scene::Scene;

/// Draws particles or surfaces with the camera, size and colours of a scene: the pictures that a run draws, without bodies
/// and foam. `kind` is "surface" or "particles". It needs a Vulkan, Direct3D 12 or Metal driver; a software driver is
/// enough.
///
/// Pictures are arrays (height, width, 4) uint8 in sRGB with alpha, rows from top to bottom.
///
/// >>> painter = splashdown.Painter(scene.replace({"output.picture_size": [320, 180]}), "surface")
/// >>> painter.draw(simulation.surface(), time=simulation.time).shape  # s
/// (180, 320, 4)
#[pyclass(frozen, module = "splashdown")]
pub struct Painter(Guarded<splashdown_run::Painter>);

#[pymethods]
impl Painter {
    #[new]
    #[pyo3(signature = (scene, kind = "surface"))]
    fn new(py: Python<'_>, scene: &Bound<'_, Scene>, kind: &str) -> Result<Self> {
        let (scene, kind) = (&scene.get().0, word_of::<PictureKind>("kind", kind)?);
        let painter = py.detach(|| splashdown_run::Painter::new(scene, kind))?;
        Ok(Self(Guarded::new("painter", painter)))
    }

    /// Draws a mesh or particles. A mesh without normals is shaded with those of its triangles. The caption has the time in s.
    ///
    /// >>> painter = splashdown.Painter(scene.replace({"output.picture_size": [320, 180]}), "particles")
    /// >>> picture = painter.draw(simulation.particles)
    /// >>> bool(picture[..., :3].std() > 1)
    /// True
    #[pyo3(signature = (what, *, time = 0.0))]
    fn draw<'py>(&self, what: &Bound<'py, PyAny>, time: f64) -> Result<Bound<'py, PyAny>> {
        let picture = self.picture(what, time)?;
        let Picture { width, height, ref rgba } = *picture;
        let shape = [height as usize, width as usize, 4];
        let array = numpy::PyArray1::from_slice(what.py(), rgba);
        let array: Bound<'_, PyArray3<u8>> = array.reshape(shape)?;
        Ok(array.into_any())
    }

    /// As `draw`, into a PNG file. Returns its size in bytes.
    ///
    /// >>> painter = splashdown.Painter(scene.replace({"output.picture_size": [320, 180]}))
    /// >>> painter.write(folder / "surface.png", simulation.surface()) > 1000
    /// True
    #[pyo3(signature = (path, what, *, time = 0.0))]
    fn write(&self, path: PathBuf, what: &Bound<'_, PyAny>, time: f64) -> Result<u64> {
        let picture = self.picture(what, time)?;
        Ok(what.py().detach(|| splashdown_io::picture::write_png(&path, &picture))?)
    }
}

impl Painter {
    fn picture(&self, what: &Bound<'_, PyAny>, time: f64) -> Result<Arc<Picture>> {
        let (mut taken, py) = (self.0.take()?, what.py());
        let painter = taken.get();
        if let Ok(mesh) = what.cast::<Mesh>() {
            let mesh = Arc::clone(&mesh.get().0);
            return Ok(py.detach(|| painter.surface(mesh, time))?);
        }
        if let Ok(particles) = what.cast::<Particles>() {
            let particles = Arc::clone(&particles.get().0);
            return Ok(py.detach(|| painter.particles(particles, time))?);
        }
        let given = what.get_type().name()?;
        Err(ArrayError::new_err(format!("a painter draws a Mesh or Particles, not a {given}")).into())
    }
}
