//! Pictures of frames.

use std::path::PathBuf;
use std::sync::Arc;

use numpy::{PyArray3, PyArrayMethods};
use pyo3::prelude::*;
use splashdown::BodyState;
use splashdown::scene::PictureKind;
use splashdown_io::Picture;
use splashdown_run::Beside;

use crate::argument::word;
use crate::bodies::Body;
use crate::busy::Guarded;
use crate::errors::{ArrayError, ParameterError, Result};
use crate::foam::Foam;
use crate::mesh::Mesh;
use crate::particles::Particles;
use crate::run::Frame;
use crate::scene::Scene;

/// Draws particles or surfaces with the camera, size and colours of a scene, as a run draws them. `kind` is "surface" or
/// "particles". It needs a Vulkan, Direct3D 12 or Metal driver; a software driver is enough.
///
/// Pictures are arrays (height, width, 4) uint8 in sRGB with alpha, rows from top to bottom.
///
/// >>> painter = splashdown.Painter(scene, "surface")
/// >>> painter.draw(frame).shape
/// (180, 320, 4)
#[pyclass(frozen, module = "splashdown")]
pub struct Painter {
    painter: Guarded<splashdown_run::Painter>,
    kind: PictureKind,
    /// The names of the scene's bodies.
    bodies: Vec<String>,
}

#[pymethods]
impl Painter {
    #[new]
    #[pyo3(signature = (scene, kind = "surface"))]
    fn new(py: Python<'_>, scene: &Bound<'_, Scene>, kind: &str) -> Result<Self> {
        let (scene, kind) = (&scene.get().0, word::<PictureKind>("kind", kind)?);
        let painter = py.detach(|| splashdown_run::Painter::new(scene, kind))?;
        let bodies = scene.bodies.iter().map(|body| body.name.clone()).collect();
        Ok(Self { painter: Guarded::new("painter", painter), kind, bodies })
    }

    /// Draws a frame of a `Run`, the path of a file of a finished run, a `Mesh` or `Particles`.
    ///
    /// A frame has its time, bodies, droplets and foam. Those of a file are read from the output folder to which it belongs; the number
    /// at the end of its name is the frame. For a mesh or particles, give `time` (s, for the caption and a moving camera),
    /// `bodies` and `foam`, if they are to be drawn. A mesh without normals is shaded with those of its triangles.
    ///
    /// >>> painter = splashdown.Painter(scene, "particles")
    /// >>> options = {"time": simulation.time, "bodies": simulation.bodies, "foam": simulation.foam}
    /// >>> picture = painter.draw(simulation.particles, **options)
    /// >>> numpy.array_equal(picture, painter.draw(frame))
    /// True
    #[pyo3(signature = (what, *, time = None, bodies = None, foam = None))]
    fn draw<'py>(
        &self,
        what: &Bound<'py, PyAny>,
        time: Option<f64>,
        bodies: Option<Vec<Py<Body>>>,
        foam: Option<&Bound<'py, Foam>>,
    ) -> Result<Bound<'py, PyAny>> {
        let picture = self.picture(what, time, bodies, foam)?;
        let Picture { width, height, ref rgba } = *picture;
        let shape = [height as usize, width as usize, 4];
        let array = numpy::PyArray1::from_slice(what.py(), rgba);
        let array: Bound<'_, PyArray3<u8>> = array.reshape(shape)?;
        Ok(array.into_any())
    }

    /// As `draw`, into a PNG file. Returns its size in bytes.
    ///
    /// >>> splashdown.Painter(scene).write(folder / "surface.png", frame) > 1000
    /// True
    #[pyo3(signature = (path, what, *, time = None, bodies = None, foam = None))]
    fn write(
        &self,
        path: PathBuf,
        what: &Bound<'_, PyAny>,
        time: Option<f64>,
        bodies: Option<Vec<Py<Body>>>,
        foam: Option<&Bound<'_, Foam>>,
    ) -> Result<u64> {
        let picture = self.picture(what, time, bodies, foam)?;
        Ok(what.py().detach(|| splashdown_io::picture::write_png(&path, &picture))?)
    }
}

/// What is drawn.
enum Drawn {
    Surface(Arc<splashdown::Mesh>),
    Particles(Arc<splashdown::Particles>),
}

impl Painter {
    fn picture(
        &self,
        what: &Bound<'_, PyAny>,
        time: Option<f64>,
        bodies: Option<Vec<Py<Body>>>,
        foam: Option<&Bound<'_, Foam>>,
    ) -> Result<Arc<Picture>> {
        let py = what.py();
        let has_beside = bodies.is_some() || foam.is_some();
        let mut beside = Beside {
            bodies: self.states(bodies.as_deref().unwrap_or_default())?,
            foam: foam.map(|foam| Arc::clone(&foam.get().particles)),
        };
        let (mut time, mut droplets) = (time, None);
        let drawn = if let Ok(mesh) = what.cast::<Mesh>() {
            Drawn::Surface(Arc::clone(&mesh.get().0))
        } else if let Ok(particles) = what.cast::<Particles>() {
            Drawn::Particles(Arc::clone(&particles.get().0))
        } else if has_beside {
            let message = "bodies and foam are those of the frame: give them with a Mesh or Particles only";
            return Err(ParameterError::new_err(message).into());
        } else if let Ok(frame) = what.cast::<Frame>() {
            let frame = frame.get();
            time = time.or(Some(frame.time));
            beside.bodies = self.states(&frame.bodies)?;
            droplets = frame.droplets.as_ref().map(|droplets| Arc::clone(&droplets.get().0));
            beside.foam = frame.foam.as_ref().map(|foam| Arc::clone(&foam.get().particles));
            self.of_frame(frame)?
        } else if let Ok(path) = what.extract::<PathBuf>() {
            let mut taken = self.painter.take()?;
            let painter = taken.get();
            return Ok(py.detach(|| painter.file(&path, time))?);
        } else {
            let given = what.get_type().name()?;
            let message =
                format!("a painter draws a Frame, a Mesh, Particles or the path of a file, not a {given}");
            return Err(ArrayError::new_err(message).into());
        };
        let mut taken = self.painter.take()?;
        let (painter, time) = (taken.get(), time.unwrap_or(0.0));
        Ok(py.detach(|| match drawn {
            Drawn::Surface(mesh) => painter.surface_with_droplets(mesh, droplets, &beside, time),
            Drawn::Particles(particles) => painter.particles(particles, &beside, time),
        })?)
    }

    fn of_frame(&self, frame: &Frame) -> Result<Drawn> {
        match (self.kind, &frame.mesh) {
            (PictureKind::Particles, _) => Ok(Drawn::Particles(Arc::clone(&frame.particles.get().0))),
            (PictureKind::Surface, Some(mesh)) => Ok(Drawn::Surface(Arc::clone(&mesh.get().0))),
            (PictureKind::Surface, None) => {
                let message = "this frame has no surface: use Run(scene, surface=True), or Painter(scene, \"particles\")";
                Err(ParameterError::new_err(message).into())
            }
        }
    }

    /// The states of bodies, which must be those of the scene, or none.
    fn states(&self, bodies: &[Py<Body>]) -> Result<Arc<[BodyState]>> {
        let names: Vec<_> = bodies.iter().map(|body| body.get().name.as_str()).collect();
        if !bodies.is_empty() && names != self.bodies {
            let message = format!(
                "bodies are {names:?}, and those of the painter's scene are {:?}: give all in this order, as \
                 simulation.bodies and frame.bodies are",
                self.bodies
            );
            return Err(ParameterError::new_err(message).into());
        }
        Ok(bodies.iter().map(|body| body.get().state()).collect())
    }
}
