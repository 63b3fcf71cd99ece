//! Opens every format with other software: VTK, meshio, trimesh, numpy, splashsurf, Pixar's USD and Blender, by Python.
//!
//! `read.py` prints the sums of the arrays it reads. They are compared with the sums of the written data. Each comparison
//! has a control with one number changed. `cargo xtask test` installs the packages into `target/python`; without them
//! these tests are skipped with a message.

#[path = "../common/mod.rs"]
mod common;
mod meshes;
mod particles;
mod python;
mod series;
