//! Scenes.

mod change;
mod value;

use std::path::{Path, PathBuf};

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyMapping};
use splashdown::probes;
use splashdown::scene::presets;
use toml::Table;

use crate::errors::{Result, SceneError};

/// The name of scenes without a file in messages.
const UNNAMED: &str = "scene in Python";

/// The function that restores a pickled scene, and its arguments: text, name, and file.
type Pickled<'py> = (Bound<'py, PyAny>, (String, String, Option<PathBuf>));

/// A checked scene: what to simulate. Immutable.
///
/// From keyword arguments, one per section of a scene file, or from one dictionary of sections; `folder` is where the files
/// that it names are searched (by default the current folder, when a simulation starts). Keys, units, ranges and messages are
/// those of scene files.
///
/// >>> scene = splashdown.Scene(
/// ...     scene={"name": "column", "duration": 0.5},  # s
/// ...     domain={"min": [0, 0, 0], "max": [1.6, 1.0, 0.5]},  # m
/// ...     fluid={"particle_spacing": 0.1, "block": [{"position": [0, 0, 0], "size": [0.4, 0.6, 0.5]}]},
/// ... )
/// >>> scene.duration, scene.frame_count
/// (0.5, 25)
#[pyclass(frozen, module = "splashdown")]
pub struct Scene(pub splashdown::Scene);

impl Scene {
    /// Checks a text; the files that it names are searched in the folder of `source`.
    fn check(text: &str, name: &str, source: Option<&Path>) -> Result<Self> {
        Ok(Self(match source {
            Some(path) => splashdown::Scene::parse_beside(text, path)?,
            None => splashdown::Scene::parse(text, name)?,
        }))
    }

    fn source(&self) -> Option<&Path> {
        self.0.source.as_deref()
    }
}

#[pymethods]
impl Scene {
    #[new]
    #[pyo3(signature = (sections = None, /, *, folder = None, **more))]
    fn new(
        py: Python<'_>,
        sections: Option<&Bound<'_, PyMapping>>,
        folder: Option<PathBuf>,
        more: Option<&Bound<'_, PyDict>>,
    ) -> Result<Self> {
        let mut table = match sections {
            Some(sections) => value::table(sections.as_any(), "")?,
            None => Table::new(),
        };
        for (name, section) in more.into_iter().flatten() {
            let name: String = name.extract()?;
            if table.contains_key(&name) {
                let message =
                    format!("the section {name:?} is given twice, in the dictionary and as a keyword");
                return Err(PyTypeError::new_err(message).into());
            }
            table.insert(name.clone(), value::value(&section, &name)?);
        }
        let text = table.to_string();
        py.detach(|| Self::check(&text, UNNAMED, folder.map(|folder| folder.join(UNNAMED)).as_deref()))
    }

    /// Reads and checks a scene file.
    ///
    /// >>> path = folder / "column.toml"
    /// >>> size = path.write_text(scene.text)
    /// >>> splashdown.Scene.load(path).name
    /// 'column'
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> Result<Self> {
        Ok(Self(py.detach(|| splashdown::Scene::load(path))?))
    }

    /// Checks the text of a scene file. `name` stands for the file in messages; the files that the scene names are searched in
    /// `folder`.
    ///
    /// >>> splashdown.Scene.parse(scene.text).name
    /// 'column'
    #[staticmethod]
    #[pyo3(signature = (text, *, name = "scene in Python", folder = None))]
    fn parse(py: Python<'_>, text: &str, name: &str, folder: Option<PathBuf>) -> Result<Self> {
        py.detach(|| Self::check(text, name, folder.map(|folder| folder.join(name)).as_deref()))
    }

    /// A built-in scene by its name.
    ///
    /// >>> splashdown.Scene.preset("dam-break-small").particle_spacing < 0.1  # m
    /// True
    #[staticmethod]
    fn preset(name: &str) -> Result<Self> {
        match presets().iter().find(|(known, _)| *known == name) {
            Some((name, text)) => Ok(Self(splashdown::Scene::parse(text, &format!("{name}.toml"))?)),
            None => {
                let known: Vec<_> = presets().iter().map(|(name, _)| *name).collect();
                let message = format!("there is no built-in scene {name:?}; there are {}", known.join(", "));
                Err(SceneError::new_err((message.clone(), vec![message])).into())
            }
        }
    }

    /// The names of the built-in scenes.
    ///
    /// >>> splashdown.Scene.presets()[:2]
    /// ['dam-break', 'dam-break-small']
    #[staticmethod]
    fn presets() -> Vec<&'static str> {
        presets().iter().map(|(name, _)| *name).collect()
    }

    /// Restores a pickled scene.
    #[staticmethod]
    fn _restore(py: Python<'_>, text: &str, name: &str, source: Option<PathBuf>) -> Result<Self> {
        py.detach(|| Self::check(text, name, source.as_deref()))
    }

    fn __reduce__<'py>(this: &Bound<'py, Self>) -> PyResult<Pickled<'py>> {
        let scene = this.get();
        // Relative paths have another meaning in another process.
        let source = scene.source().map(|path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned()));
        let arguments = (scene.0.text.to_string(), scene.0.name.clone(), source);
        Ok((this.py().get_type::<Self>().getattr("_restore")?, arguments))
    }

    /// A changed copy. `changes` has paths of keys, such as "fluid.viscosity" or "fluid.block[0].size" (counted from 0); keyword
    /// arguments have sections, whose keys are merged into those of the scene, while lists are replaced.
    ///
    /// >>> finer = scene.replace({"fluid.particle_spacing": 0.05}, solver={"cfl_factor": 0.2})
    /// >>> round(finer.particle_spacing, 3)  # m
    /// 0.05
    #[pyo3(signature = (changes = None, /, **sections))]
    fn replace(
        &self,
        py: Python<'_>,
        changes: Option<&Bound<'_, PyMapping>>,
        sections: Option<&Bound<'_, PyDict>>,
    ) -> Result<Self> {
        let mut table = self.table()?;
        if let Some(changes) = changes {
            for pair in changes.items()? {
                let (path, new): (String, Bound<'_, PyAny>) = pair.extract()?;
                change::apply(&mut table, &path, value::value(&new, &path)?)?;
            }
        }
        for (name, new) in sections.into_iter().flatten() {
            let name: String = name.extract()?;
            change::merge(&mut table, &name, value::value(&new, &name)?);
        }
        let text = table.to_string();
        py.detach(|| Self::check(&text, UNNAMED, self.source()))
    }

    /// The scene as a dictionary of sections, from which an equal scene can be created.
    ///
    /// >>> splashdown.Scene(scene.to_dict()) == scene
    /// True
    fn to_dict<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyDict>> {
        value::dict(py, &self.table()?)
    }

    /// The text of the scene file (TOML).
    ///
    /// >>> size = (folder / "column.toml").write_text(scene.text)
    /// >>> splashdown.Scene.load(folder / "column.toml").duration  # s
    /// 0.5
    #[getter]
    fn text(&self) -> &str {
        &self.0.text
    }

    /// Its name.
    ///
    /// >>> scene.name
    /// 'column'
    #[getter]
    fn name(&self) -> &str {
        &self.0.name
    }

    /// The file that it was read from, or `None`.
    ///
    /// >>> scene.path is None
    /// True
    #[getter]
    fn path(&self) -> Option<&Path> {
        self.source()
    }

    /// The simulated time in s.
    ///
    /// >>> scene.duration  # s
    /// 0.5
    #[getter]
    fn duration(&self) -> f32 {
        self.0.duration
    }

    /// Frames per simulated second, in 1/s.
    ///
    /// >>> scene.frame_rate  # 1/s
    /// 50.0
    #[getter]
    fn frame_rate(&self) -> f32 {
        self.0.frame_rate
    }

    /// The number of frames after the initial one.
    ///
    /// >>> scene.frame_count
    /// 25
    #[getter]
    fn frame_count(&self) -> u32 {
        self.0.frame_count()
    }

    /// The initial distance of particles in m, which is the resolution.
    ///
    /// >>> round(scene.particle_spacing, 4)  # m
    /// 0.1
    #[getter]
    fn particle_spacing(&self) -> f32 {
        self.0.fluid.particle_spacing
    }

    /// The mass of a particle in kg.
    ///
    /// >>> round(scene.particle_mass, 6)  # kg: water of 998.2 kg/m^3 in a cube of 0.1 m
    /// 0.9982
    /// >>> kinetic_energy = 0.5 * scene.particle_mass * (simulation.velocities**2).sum()  # J
    #[getter]
    fn particle_mass(&self) -> f64 {
        self.0.fluid.particle_mass()
    }

    /// The density of the fluid at rest in kg/m^3.
    ///
    /// >>> round(scene.rest_density, 1)  # kg/m^3; the default is water at 20 °C
    /// 998.2
    #[getter]
    fn rest_density(&self) -> f32 {
        self.0.fluid.material.rest_density
    }

    /// Values that are valid but probably unintended, one text each.
    ///
    /// >>> scene.warnings
    /// []
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.0.warnings.iter().map(ToString::to_string).collect()
    }

    /// The columns of each probe, with units, by the name of the probe; the first is the time.
    ///
    /// >>> scene.probe_columns
    /// {'gauge': ['time (s)', 'height (m)']}
    #[getter]
    fn probe_columns<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let columns = PyDict::new(py);
        for probe in &self.0.probes {
            columns.set_item(&probe.name, probes::columns(probe))?;
        }
        Ok(columns)
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other.cast::<Self>().is_ok_and(|other| {
            let other = &other.get().0;
            self.0.text == other.text && self.0.source == other.source
        })
    }

    fn __hash__(&self) -> u64 {
        use std::hash::{DefaultHasher, Hash, Hasher};
        let mut hasher = DefaultHasher::new();
        self.0.text.hash(&mut hasher);
        hasher.finish()
    }

    fn __repr__(&self) -> String {
        format!(
            "Scene({:?}, {} s, spacing {} m)",
            self.0.name, self.0.duration, self.0.fluid.particle_spacing
        )
    }
}

impl Scene {
    fn table(&self) -> Result<Table> {
        self.0.text.parse().map_err(|error: toml::de::Error| {
            let message = error.to_string();
            SceneError::new_err((message.clone(), vec![message])).into()
        })
    }
}
