//! Solids from meshes: mending, distances, shares of the kernel, masses, the cache.

mod fields;
mod hostile;
mod shared_meshes;
