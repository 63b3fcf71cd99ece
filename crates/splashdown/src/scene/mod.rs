//! The scene file: its types, its keys, its errors.

mod choice;
mod errors;
mod types;

pub use choice::Choice;
pub use errors::{SceneErrors, SceneProblem, SceneWarning};
pub use types::{
    Block, Camera, ColourBy, DensityMode, Domain, Fluid, Format, KernelKind, Material, Method,
    NegativePressure, Output, PictureKind, Scene, Shake, Shape, Solver, Sort, SurfaceSettings,
    SurfaceTension,
};
