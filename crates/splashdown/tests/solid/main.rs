//! Solids from meshes: repair, distances, kernel integrals, masses, cache.

mod fields;
mod hostile;
mod shared_meshes;
