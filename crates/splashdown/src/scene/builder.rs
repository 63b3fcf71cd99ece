//! Builds scenes in code, without a scene file.

use toml::{Table, Value};

use super::types::Scene;

/// Builds a [`Scene`] key by key. The keys, their ranges and their defaults are those of a scene file; `build` checks
/// them in the same way and gives the same messages.
///
/// ```
/// use splashdown::Scene;
/// let scene = Scene::builder("column", 0.5)
///     .domain([0.0, 0.0, 0.0], [1.6, 1.0, 0.5])
///     .particle_spacing(0.05)
///     .block([0.0, 0.0, 0.0], [0.4, 0.6, 0.5])
///     .set("domain.open", ["y_max"])
///     .set("solver.density", "continuity")
///     .section("probe", |probe| {
///         probe.set("name", "gauge").set("quantity", "pressure").set("position", [1.6, 0.05, 0.25])
///     })
///     .build()?;
/// assert_eq!(scene.probes.len(), 1);
/// # Ok::<(), splashdown::error::SceneErrors>(())
/// ```
#[derive(Clone, Debug)]
#[must_use = "a builder creates a scene only when `build` is called"]
pub struct SceneBuilder {
    root: Table,
}

/// Builds one section of a list, such as a body: see [`SceneBuilder::section`].
#[derive(Clone, Debug)]
pub struct SectionBuilder {
    table: Table,
}

/// A value of a key: a number, a text, a truth value, or an array of them.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneValue(Value);

macro_rules! value_from {
    ($($kind:ty => $variant:ident as $target:ty),+ $(,)?) => {
        $(impl From<$kind> for SceneValue {
            fn from(value: $kind) -> Self {
                Self(Value::$variant(<$target>::from(value)))
            }
        })+
    };
}

value_from!(f64 => Float as f64, i64 => Integer as i64, i32 => Integer as i64, u32 => Integer as i64,
    bool => Boolean as bool, &str => String as String, String => String as String);

impl From<f32> for SceneValue {
    /// The shortest decimal number that is read back as this `f32`.
    fn from(value: f32) -> Self {
        Self(Value::Float(value.to_string().parse().unwrap_or(f64::from(value))))
    }
}

impl<T: Into<SceneValue>, const N: usize> From<[T; N]> for SceneValue {
    fn from(values: [T; N]) -> Self {
        Self(Value::Array(values.into_iter().map(|value| value.into().0).collect()))
    }
}

impl<T: Into<SceneValue>> From<Vec<T>> for SceneValue {
    fn from(values: Vec<T>) -> Self {
        Self(Value::Array(values.into_iter().map(|value| value.into().0).collect()))
    }
}

impl Scene {
    /// Starts a scene with a name (letters, digits, `-` and `_`) and a duration in s.
    pub fn builder(name: &str, duration: f64) -> SceneBuilder {
        SceneBuilder { root: Table::new() }.set("scene.name", name).set("scene.duration", duration)
    }
}

impl SceneBuilder {
    /// The lower and the upper corner of the domain in m.
    pub fn domain(self, min: [f64; 3], max: [f64; 3]) -> Self {
        self.set("domain.min", min).set("domain.max", max)
    }

    /// The initial distance between neighbouring particles in m, which is the resolution.
    pub fn particle_spacing(self, spacing: f64) -> Self {
        self.set("fluid.particle_spacing", spacing)
    }

    /// Adds a block of fluid by its lower corner and its edge lengths in m.
    pub fn block(self, position: [f64; 3], size: [f64; 3]) -> Self {
        self.section("fluid.block", |block| block.set("position", position).set("size", size))
    }

    /// Sets a key of a scene file by its path, such as `solver.cfl_factor`.
    pub fn set(mut self, key: &str, value: impl Into<SceneValue>) -> Self {
        let (section, name) = key.rsplit_once('.').unwrap_or(("", key));
        if let Some(table) = self.table(section) {
            table.insert(name.to_owned(), value.into().0);
        }
        self
    }

    /// Adds a section to a list of a scene file, such as `body`, `emitter`, `sink`, `probe` or `fluid.mesh`.
    pub fn section(mut self, list: &str, build: impl FnOnce(SectionBuilder) -> SectionBuilder) -> Self {
        let section = Value::Table(build(SectionBuilder { table: Table::new() }).table);
        let (parent, name) = list.rsplit_once('.').unwrap_or(("", list));
        if let Some(table) = self.table(parent) {
            match table.entry(name).or_insert_with(|| Value::Array(Vec::new())) {
                Value::Array(sections) => sections.push(section),
                other => *other = Value::Array(vec![section]),
            }
        }
        self
    }

    /// The scene as the text of a scene file.
    pub fn to_toml(&self) -> String {
        self.root.to_string()
    }

    /// The table at this path. Missing tables are created; a value at the path is replaced by a table.
    fn table(&mut self, path: &str) -> Option<&mut Table> {
        let mut table = &mut self.root;
        for name in path.split('.').filter(|name| !name.is_empty()) {
            let entry = table.entry(name).or_insert_with(|| Value::Table(Table::new()));
            if !entry.is_table() {
                *entry = Value::Table(Table::new());
            }
            table = entry.as_table_mut()?;
        }
        Some(table)
    }
}

impl SectionBuilder {
    /// Sets a key of the section.
    #[must_use]
    pub fn set(mut self, key: &str, value: impl Into<SceneValue>) -> Self {
        self.table.insert(key.to_owned(), value.into().0);
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn column() -> SceneBuilder {
        Scene::builder("column", 0.5)
            .domain([0.0; 3], [1.6, 1.0, 0.5])
            .particle_spacing(0.05)
            .block([0.0; 3], [0.4, 0.6, 0.5])
    }

    #[test]
    fn a_built_scene_equals_the_scene_of_the_same_file() {
        let built = column()
            .set("domain.open", ["y_max"])
            .set("solver.cfl_factor", 0.25_f32)
            .section("body", |body| body.set("name", "raft").set("mesh", "block").set("motion", "dynamic"))
            .section("body", |body| body.set("name", "post").set("mesh", "cube"))
            .build()
            .unwrap();
        let text = "
            [scene]
            name = \"column\"
            duration = 0.5
            [domain]
            min = [0, 0, 0]
            max = [1.6, 1.0, 0.5]
            open = [\"y_max\"]
            [fluid]
            particle_spacing = 0.05
            [[fluid.block]]
            position = [0, 0, 0]
            size = [0.4, 0.6, 0.5]
            [solver]
            cfl_factor = 0.25
            [[body]]
            name = \"raft\"
            mesh = \"block\"
            motion = \"dynamic\"
            [[body]]
            name = \"post\"
            mesh = \"cube\"
        ";
        let mut file = Scene::parse(text, "column.toml").unwrap();
        file.text = built.text.clone();
        assert_eq!(built, file);
        // Negative control: an additional key gives a different scene.
        assert_ne!(column().set("solver.cfl_factor", 0.2).build().unwrap().solver, file.solver);
    }

    #[test]
    fn mistakes_are_reported_like_those_of_a_file() {
        let errors =
            column().particle_spacing(-1.0).set("solver.kernal", "cubic_spline").build().unwrap_err();
        let text = errors.to_string();
        assert!(text.contains("fluid.particle_spacing is -1") && text.contains("kernal"), "{text}");
        // A section in place of a value, and values in place of sections.
        assert!(column().section("scene.name", |section| section).build().is_err());
        assert!(column().set("fluid", 1.0).build().is_err());
        assert!(column().set("scene.name.first", "a").build().is_err());
    }

    #[test]
    fn the_text_of_a_builder_gives_the_same_scene() {
        let builder = column().set("solver.max_dt", 0.001_f32);
        assert!(builder.to_toml().contains("max_dt = 0.001"), "{}", builder.to_toml());
        assert_eq!(Scene::parse(&builder.to_toml(), "copy").unwrap(), builder.build().unwrap());
    }
}
