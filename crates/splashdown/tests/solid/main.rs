//! Solids from meshes: mending, distances, shares of the kernel, masses, the cache.

mod fields;
mod shared_meshes;
