//! Smoothed-particle hydrodynamics on any GPU: scenes, solvers and the surface of the fluid.

pub mod sample;
pub mod scene;
