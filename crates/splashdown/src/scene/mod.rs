//! The scene file: from TOML to checked values.
//!
//! `keys/` declares every key once: kind, range, unit, default, meaning. `reader.rs` walks a file along this table and
//! collects every problem with its line. `parse/` builds the scene from the values, and `geometry.rs` compares blocks
//! and domain. `schema.rs` writes the same table as a JSON schema and as a page of documentation, so that parser, schema
//! and documentation agree. This module opens no files: the module `check` above it compares a scene with the files that
//! it names.
//!
//! ```
//! let text = r#"
//!     [scene]
//!     name = "cube"
//!     duration = 1.0
//!     [domain]
//!     min = [0, 0, 0]
//!     max = [1, 1, 1]
//!     [fluid]
//!     particle_spacing = 0.05
//!     [[fluid.block]]
//!     position = [0, 0, 0]
//!     size = [0.5, 0.5, 0.5]
//! "#;
//! let scene = splashdown::scene::Scene::parse(text, "cube.toml")?;
//! assert_eq!(splashdown::scene::Derived::new(&scene).particles, 1000);
//!
//! let errors = splashdown::scene::Scene::parse(&text.replace("0.05", "-1"), "cube.toml").unwrap_err();
//! assert!(errors.to_string().contains("fluid.particle_spacing is -1"));
//! # Ok::<(), splashdown::scene::SceneErrors>(())
//! ```

mod builder;
mod camera_path;
mod choice;
mod curve;
mod derived;
mod errors;
mod formula;
mod framing;
mod geometry;
mod keys;
pub(crate) mod lattice;
mod materials;
pub(crate) mod outlet;
mod parse;
mod picture;
mod presets;
mod reader;
mod room;
mod schema;
mod script;
mod slot;
mod solver;
mod source;
mod spec;
mod suggest;
mod things;
mod types;
mod values;

pub(crate) use derived::{MIN_SPEED, Reach};
pub(crate) use geometry::grouped;
pub(crate) use parse::{outlet_outside, parse};
pub(crate) use reader::{Reported, Section};
pub(crate) use schema::keys_reference;
pub(crate) use spec::{place, rounded};
pub(crate) use suggest::closest;

pub use builder::{SceneBuilder, SceneValue, SectionBuilder};
pub use camera_path::{CameraKeyframe, CameraPath};
pub use choice::Choice;
pub use curve::hermite_weights;
pub use derived::{Derived, lattice_sum};
pub use errors::{SceneErrors, SceneProblem, SceneWarning};
pub use formula::Formula;
pub use materials::{KnownMaterial, MATERIALS};
pub use picture::{FloorKind, LiquidKind, PictureSettings, SkyKind, TankKind};
pub use presets::presets;
pub use schema::schema;
pub use script::{Keyframe, Pose, Script};
pub use solver::{DensityMode, KernelKind, Method, NegativePressure, Solver, Sort, SurfaceTension};
pub use things::{
    Body, BoundaryKind, Emitter, Hinge, MeshShape, MeshSource, Motion, Motor, Outlet, Probe, Quantity, Sink,
    SinkRegion, SolidContact, UpAxis,
};
pub use types::{
    Block, Camera, ColourBy, Domain, Fluid, FluidFile, FluidMesh, FoamSettings, Format, InitialPressure,
    Material, OnBurst, Oscillation, Output, PictureKind, PictureQuality, Scene, Shape, SurfaceKernels,
    SurfaceSettings,
};
