//! The quantities that a particle carries from step to step, as one table.
//!
//! Buffers, upload, reordering, checkpoints, memory accounting, read-back and output follow from the table. A new
//! quantity is one row, and the passes that use it; ARCHITECTURE.md has an example.

use glam::{Vec2, Vec3, Vec4};
use splashdown_gpu::{Buffer, BufferSet, Executor, GpuError, Readback};
use splashdown_io::{Attribute, Particles};

use super::{DEAD_UNBORN, Params};

/// The type of a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// One `f32`.
    F32,
    /// One `u32`.
    U32,
    /// Two `f32`.
    Vec2,
    /// Four `f32`.
    Vec4,
}

impl Kind {
    /// Numbers of 32 bits per particle.
    pub const fn components(self) -> usize {
        match self {
            Self::F32 | Self::U32 => 1,
            Self::Vec2 => 2,
            Self::Vec4 => 4,
        }
    }
}

/// What a step does with a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Update {
    /// The particle's motion: the passes `cells.reorder` and those that integrate move it.
    Motion,
    /// Computed in every step from the other quantities, in sorted order. It has no sorted array.
    Derived,
    /// Unchanged: passes of its own reorder it and store it. [`Kind::F32`] or [`Kind::Vec4`].
    Constant,
    /// Changed by a pass of a scheme, which reads the sorted array and writes the persistent one. Reordered by a pass
    /// of its own. [`Kind::F32`] or [`Kind::Vec4`].
    Evolved,
}

impl Update {
    /// True if `cells.reorder_carried` has to move it.
    pub const fn needs_reordering(self) -> bool {
        matches!(self, Self::Constant | Self::Evolved)
    }
}

/// One row of the table.
pub struct Carried {
    /// Label of the persistent array, and the name of its entry in a checkpoint.
    pub name: &'static str,
    /// Label of the array in the order of the cells; `None` for [`Update::Derived`].
    pub sorted: Option<&'static str>,
    /// Its type.
    pub kind: Kind,
    /// What a step does with it.
    pub update: Update,
    /// The value of an emitted particle, if passes of their own reorder the quantity; not used otherwise.
    pub emitted: [f32; 4],
    /// The value of a particle at the start, as bits; `None` if the first density pass computes it.
    pub initial: Option<fn(&Initial<'_>, usize) -> [u32; 4]>,
    /// Puts the values of the active particles into what the simulation hands out.
    pub output: fn(Particles, &Ordered<'_>) -> Particles,
}

impl Carried {
    /// Panics if there is no pass for a row. Called in a constant, it is an error of the compiler.
    pub const fn check(table: &[Self]) {
        let mut row = 0;
        while row < table.len() {
            let Self { sorted, kind, update, .. } = &table[row];
            let has_sorted = !matches!(update, Update::Derived);
            assert!(
                sorted.is_some() == has_sorted,
                "all rows but those of Update::Derived have a sorted array"
            );
            let has_pass = matches!(kind, Kind::F32 | Kind::Vec4);
            assert!(has_pass || !update.needs_reordering(), "there is no pass that reorders this type");
            row += 1;
        }
    }
}

/// The particles at the start of a simulation.
pub struct Initial<'a> {
    /// Those that exist at the start.
    pub particles: &'a Particles,
    /// The constants.
    pub params: &'a Params,
}

impl Initial<'_> {
    /// The value of an attribute of a particle, or `otherwise` if it has none: for the rows of the table whose
    /// quantity is an attribute in [`Particles`]. Particles that a scene places have no attributes.
    pub fn attribute(&self, name: &str, i: usize, otherwise: f32) -> f32 {
        let found = self.particles.attributes.iter().find(|attribute| attribute.name == name);
        found.and_then(|attribute| attribute.values.get(i)).copied().unwrap_or(otherwise)
    }
}

/// The values of a quantity, in the order in which particles are handed out.
pub struct Ordered<'a> {
    words: &'a [u32],
    components: usize,
    order: &'a [u32],
}

impl Ordered<'_> {
    fn floats(&self, i: u32, component: usize) -> f32 {
        f32::from_bits(self.words[i as usize * self.components + component])
    }

    /// The first three components.
    pub fn vectors(&self) -> Vec<[f32; 3]> {
        self.order.iter().map(|&i| [0, 1, 2].map(|component| self.floats(i, component))).collect()
    }

    /// One component.
    pub fn scalars(&self, component: usize) -> Vec<f32> {
        self.order.iter().map(|&i| self.floats(i, component)).collect()
    }

    /// The values as integers.
    pub fn integers(&self) -> Vec<u32> {
        self.order.iter().map(|&i| self.words[i as usize * self.components]).collect()
    }

    /// The first component as an attribute of this name, which files of formats with attributes hold.
    pub fn attribute(&self, name: &str) -> Attribute {
        Attribute { name: name.to_owned(), components: 1, values: self.scalars(0) }
    }
}

/// Position in m, and 0 or the mark of a removed particle.
pub(crate) const POSITIONS: Carried = Carried {
    name: "positions",
    sorted: Some("sorted_positions"),
    kind: Kind::Vec4,
    update: Update::Motion,
    emitted: [0.0; 4],
    initial: Some(|start, i| match start.particles.positions.get(i) {
        Some(&x) => bits(Vec3::from(x).extend(0.0)),
        None => bits(start.params.domain_min.extend(DEAD_UNBORN)),
    }),
    output: |mut particles, values| {
        particles.positions = values.vectors();
        particles
    },
};

/// Velocity in m/s, and density in kg/m^3.
pub(crate) const VELOCITIES: Carried = Carried {
    name: "velocities",
    sorted: Some("sorted_velocities"),
    kind: Kind::Vec4,
    update: Update::Motion,
    emitted: [0.0; 4],
    initial: Some(|start, i| {
        let velocity = start.particles.velocities.get(i).map_or(Vec3::ZERO, |&v| v.into());
        // Passes divide by densities. A density that is not positive becomes NaN, so that the particle is removed
        // as not finite.
        let positive = |rho: f32| if rho > 0.0 { rho } else { f32::NAN };
        let density =
            start.particles.densities.get(i).map_or(start.params.rest_density, |&rho| positive(rho));
        bits(velocity.extend(density))
    }),
    output: |particles, values| particles.with_velocities(values.vectors()),
};

/// Density in kg/m^3 and pressure in Pa at the beginning of the last step.
pub(crate) const DENSITIES: Carried = Carried {
    name: "densities",
    sorted: None,
    kind: Kind::Vec2,
    update: Update::Derived,
    emitted: [0.0; 4],
    initial: None,
    output: |particles, values| particles.with_densities(values.scalars(0)).with_pressures(values.scalars(1)),
};

/// Id: the same particle has the same id in every frame.
pub(crate) const IDS: Carried = Carried {
    name: "ids",
    sorted: Some("sorted_ids"),
    kind: Kind::U32,
    update: Update::Motion,
    emitted: [0.0; 4],
    initial: Some(|start, i| {
        // Particles of higher index are not emitted yet.
        let n = start.particles.len();
        let id = match start.particles.ids.get(i) {
            Some(&id) if start.particles.ids.len() == n => id,
            _ if i < n => i as u32,
            // Ids of particles not yet emitted must differ from all others: they count down from the largest number.
            _ => u32::MAX - (i - n) as u32,
        };
        [id, 0, 0, 0]
    }),
    output: |particles, values| particles.with_ids(values.integers()),
};

/// The implicit pressure with which the next step starts, as the unknown of `passes::implicit` in m^2/s^2.
pub(crate) const PRESSURES: Carried = Carried {
    name: "pressures",
    sorted: Some("sorted_pressures"),
    kind: Kind::F32,
    update: Update::Evolved,
    emitted: [0.0; 4],
    initial: Some(|start, i| {
        let unit = start.params.rest_density * start.params.pressure_factor;
        let given = start.particles.pressures.get(i).map_or(0.0, |p| p / unit);
        let pressure = if given.is_finite() { given.max(0.0) } else { 0.0 };
        [pressure.to_bits(), 0, 0, 0]
    }),
    output: |particles, _| particles,
};

/// The quantities of every simulation. The order is that of the entries in a checkpoint.
pub static CARRIED: &[Carried] = &[POSITIONS, VELOCITIES, DENSITIES, IDS];
/// The quantities of a simulation with implicit pressure.
pub static CARRIED_IMPLICIT: &[Carried] = &[POSITIONS, VELOCITIES, DENSITIES, IDS, PRESSURES];

const _: () = Carried::check(CARRIED);
const _: () = Carried::check(CARRIED_IMPLICIT);

/// The bits of a vector.
pub fn bits(v: Vec4) -> [u32; 4] {
    v.to_array().map(f32::to_bits)
}

/// Bytes per particle in the arrays of these quantities.
pub const fn bytes_per_particle(table: &[Carried]) -> u64 {
    let (mut bytes, mut row) = (0, 0);
    while row < table.len() {
        let arrays = if table[row].sorted.is_some() { 2 } else { 1 };
        bytes += 4 * arrays * table[row].kind.components() as u64;
        row += 1;
    }
    bytes
}

/// An array with one entry per particle.
#[derive(Clone, Copy, Debug)]
pub enum Array {
    /// Of [`Kind::F32`].
    F32(Buffer<f32>),
    /// Of [`Kind::U32`].
    U32(Buffer<u32>),
    /// Of [`Kind::Vec2`].
    Vec2(Buffer<Vec2>),
    /// Of [`Kind::Vec4`].
    Vec4(Buffer<Vec4>),
}

/// Runs code for the typed buffer of an array.
macro_rules! with_buffer {
    ($array:expr, $buffer:ident => $body:expr) => {
        match $array {
            Array::F32($buffer) => $body,
            Array::U32($buffer) => $body,
            Array::Vec2($buffer) => $body,
            Array::Vec4($buffer) => $body,
        }
    };
}

impl Array {
    fn create(executor: &mut Executor, label: &'static str, kind: Kind, n: usize) -> Result<Self, GpuError> {
        Ok(match kind {
            Kind::F32 => Self::F32(executor.create(label, n)?),
            Kind::U32 => Self::U32(executor.create(label, n)?),
            Kind::Vec2 => Self::Vec2(executor.create(label, n)?),
            Kind::Vec4 => Self::Vec4(executor.create(label, n)?),
        })
    }

    fn add_to(self, set: &mut BufferSet) {
        with_buffer!(self, buffer => set.add(buffer.label(), buffer));
    }

    /// Writes all entries, given as bits.
    ///
    /// # Errors
    /// As [`Executor::write`].
    pub fn write(self, executor: &mut Executor, words: &[u32]) -> Result<(), GpuError> {
        with_buffer!(self, buffer => executor.write(buffer, &bytemuck::pod_collect_to_vec::<u32, _>(words)))
    }

    /// Requests a copy of the first `n` entries.
    ///
    /// # Errors
    /// As [`Executor::request`].
    pub fn request(self, executor: &mut Executor, n: usize) -> Result<Pending, GpuError> {
        Ok(match self {
            Self::F32(buffer) => Pending::F32(executor.request(buffer, n)?),
            Self::U32(buffer) => Pending::U32(executor.request(buffer, n)?),
            Self::Vec2(buffer) => Pending::Vec2(executor.request(buffer, n)?),
            Self::Vec4(buffer) => Pending::Vec4(executor.request(buffer, n)?),
        })
    }
}

/// A requested copy of an array.
pub enum Pending {
    /// Of [`Kind::F32`].
    F32(Readback<f32>),
    /// Of [`Kind::U32`].
    U32(Readback<u32>),
    /// Of [`Kind::Vec2`].
    Vec2(Readback<Vec2>),
    /// Of [`Kind::Vec4`].
    Vec4(Readback<Vec4>),
}

impl Pending {
    /// Waits for the copy.
    ///
    /// # Errors
    /// If the device was lost.
    pub async fn take(self) -> Result<Values, GpuError> {
        Ok(match self {
            Self::F32(copy) => Values::F32(copy.take().await?),
            Self::U32(copy) => Values::U32(copy.take().await?),
            Self::Vec2(copy) => Values::Vec2(copy.take().await?),
            Self::Vec4(copy) => Values::Vec4(copy.take().await?),
        })
    }
}

/// The content of an array on the host.
pub enum Values {
    /// Of [`Kind::F32`].
    F32(Vec<f32>),
    /// Of [`Kind::U32`].
    U32(Vec<u32>),
    /// Of [`Kind::Vec2`].
    Vec2(Vec<Vec2>),
    /// Of [`Kind::Vec4`].
    Vec4(Vec<Vec4>),
}

impl Values {
    /// The bits.
    pub fn words(&self) -> &[u32] {
        match self {
            Self::F32(values) => bytemuck::cast_slice(values),
            Self::U32(values) => values,
            Self::Vec2(values) => bytemuck::cast_slice(values),
            Self::Vec4(values) => bytemuck::cast_slice(values),
        }
    }

    /// The values of the particles in `order`.
    pub fn ordered<'a>(&'a self, kind: Kind, order: &'a [u32]) -> Ordered<'a> {
        Ordered { words: self.words(), components: kind.components(), order }
    }
}

/// A quantity with its arrays on a device.
#[derive(Clone, Copy)]
pub struct CarriedArrays {
    /// The row of the table.
    pub quantity: &'static Carried,
    /// Between steps.
    pub persistent: Array,
    /// In the order of the cells.
    pub sorted: Option<Array>,
    /// The value of an emitted particle, in one entry; `None` if no pass of its own reorders the quantity.
    emitted: Option<Array>,
}

/// Persistent and sorted array of a quantity that passes of their own reorder.
#[derive(Clone, Copy)]
pub enum Reordered {
    /// Of [`Kind::F32`].
    Scalar {
        /// Between steps.
        persistent: Buffer<f32>,
        /// In the order of the cells.
        sorted: Buffer<f32>,
        /// The value of an emitted particle.
        emitted: Buffer<f32>,
    },
    /// Of [`Kind::Vec4`].
    Vector {
        /// Between steps.
        persistent: Buffer<Vec4>,
        /// In the order of the cells.
        sorted: Buffer<Vec4>,
        /// The value of an emitted particle.
        emitted: Buffer<Vec4>,
    },
}

impl CarriedArrays {
    /// Creates the arrays of every row for `n` particles.
    ///
    /// # Errors
    /// As [`Executor::create`].
    pub fn create(
        executor: &mut Executor,
        table: &'static [Carried],
        n: usize,
    ) -> Result<Vec<Self>, GpuError> {
        let create = |quantity: &'static Carried| {
            let mut array = |label, n| Array::create(executor, label, quantity.kind, n);
            let persistent = array(quantity.name, n)?;
            let sorted = quantity.sorted.map(|label| array(label, n)).transpose()?;
            let mut emitted = None;
            if quantity.update.needs_reordering() {
                let one = array("emitted", 1)?;
                one.write(executor, &quantity.emitted.map(f32::to_bits)[..quantity.kind.components()])?;
                emitted = Some(one);
            }
            Ok(Self { quantity, persistent, sorted, emitted })
        };
        table.iter().map(create).collect()
    }

    /// The arrays if passes of their own reorder the quantity.
    pub fn reordered(&self) -> Option<Reordered> {
        match (self.persistent, self.sorted, self.emitted) {
            (Array::F32(persistent), Some(Array::F32(sorted)), Some(Array::F32(emitted))) => {
                Some(Reordered::Scalar { persistent, sorted, emitted })
            }
            (Array::Vec4(persistent), Some(Array::Vec4(sorted)), Some(Array::Vec4(emitted))) => {
                Some(Reordered::Vector { persistent, sorted, emitted })
            }
            _ => None,
        }
    }

    /// Adds the arrays to a set, under their labels.
    pub fn add_to(&self, set: &mut BufferSet) {
        self.persistent.add_to(set);
        if let Some(sorted) = self.sorted {
            sorted.add_to(set);
        }
    }

    /// The initial values of `total` particles, as bits; `None` if a pass computes them.
    pub fn initial(&self, start: &Initial<'_>, total: usize) -> Option<Vec<u32>> {
        let (initial, components) = (self.quantity.initial?, self.quantity.kind.components());
        let mut words = Vec::with_capacity(total * components);
        for i in 0..total {
            words.extend_from_slice(&initial(start, i)[..components]);
        }
        Some(words)
    }
}
