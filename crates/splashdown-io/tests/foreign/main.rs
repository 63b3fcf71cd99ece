//! Every format opened by software that is not ours: VTK, meshio, trimesh, numpy, splashsurf, Pixar's USD and
//! Blender, from Python.
//!
//! `read.py` prints sums of what it finds, which are compared with the sums of what was written; each
//! comparison has a control with one number changed. `cargo xtask test` installs the packages into
//! `target/python`; without them these tests are skipped, and say so.

#[path = "../common/mod.rs"]
mod common;
mod meshes;
mod particles;
mod python;
mod series;
