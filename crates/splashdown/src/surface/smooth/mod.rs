//! Weighted Laplacian smoothing of the mesh (Löschner et al., "Weighted Laplacian smoothing for surface
//! reconstruction of particle-based fluids", VMV 2023).
//!
//! Each round moves a vertex towards the mean of its neighbours: `v <- (1 - w) v + w mean`. The weight w is
//! near 1 where the fluid is dense, so the bumps of particles vanish, and near 0 at lone particles and thin
//! sheets, which would shrink to nothing: with n the crowding interpolated to the vertex and `s = min(n / 13,
//! 1)`, `w = 6 s^5 - 15 s^4 + 10 s^3`.
//!
//! splashsurf 0.14 mixes the mean with the vertex's place of one round before (`v''` in `v <- (1 - w) v'' + w
//! mean`), and so smooths more slowly where w is below 1: of the splash of 64,000 particles 20 rounds at cells
//! of half a spacing take 0.9 % of the volume here and 0.7 % there, and the meshes are 0.33 cells apart at
//! most.
//!
//! # How it works
//!
//! On a closed mesh the triangles round a vertex form one ring, and each neighbour comes after the vertex in
//! exactly one of them. So the ring of a vertex is stored as one pair per triangle: the vertex that comes
//! next and the one after it. Triangles are counted per vertex, the counts scanned, the pairs put into place
//! in any order and then sorted, so that sums run in a fixed order. The mean is over the first of each pair;
//! both together give the area-weighted normals of the smoothed mesh at the end.

mod order;
mod relax;
mod ring;
mod shade;
mod valence;
mod weigh;

pub(crate) use order::ORDER;
pub(crate) use relax::RELAX;
pub(crate) use ring::RING;
pub(crate) use shade::SHADE;
pub(crate) use valence::VALENCE;
pub(crate) use weigh::WEIGH;
