//! The kernels of the anisotropic field: an ellipsoid for each particle, after Yu and Turk ("Reconstructing surfaces of
//! particle-based fluids using anisotropic kernels", 2013).
//!
//! # How it works
//!
//! Three visits of the neighbours, in units of the support radius H, with w = 1 - (r / H)^3:
//!
//! 1. `moments`: the number n = sum w of the neighbours, the offset m = sum w (x_j - x_i) / n of their mean, and their
//!    covariance C.
//! 2. `shapes`: means of n, m and C over the neighbours with similar offsets, and from them the centre of the kernel and
//!    its matrix A: the kernel of the particle is P(q), q^2 = (x - c).A (x - c).
//! 3. `weights`: 1 / sum_j P_j(c_i), so that the field is about 1 at every centre.
//!
//! *Matrix.* With M = C / (covariance in the bulk), the squares of the half-axes are `s^2 f(M)`,
//! f(M) = a + (1 - a)(1 + k) M^2 / (M^2 + k). f is 1 in the bulk, a where the neighbours have no extent, and bounded, so
//! that a kernel is between 0.59 and 1.51 support radii long. s = sqrt(n_bulk / n), between 1 and 1.4, enlarges the kernels
//! where the particles are sparse.
//!
//! *Centre.* c = x + 0.9 (m - mean of m). The paper moves a particle to the mean of its neighbours. This shifts the surface of
//! still water by a third of a spacing, and a film of two layers becomes one layer. Here the particle keeps the offset that
//! its neighbours in the same layer have as well; only the deviation from them is removed. Neighbours count as in the same
//! layer if their offsets differ by less than a quarter of H.
//!
//! With fewer than about four neighbours a kernel gradually becomes a ball. A lone particle is a ball whose mesh has the
//! particle's volume at an iso level of 0.6 (`bulk`).
//!
//! A particle inside the fluid, with nearly as many neighbours as in the bulk, nearly no offset, and a covariance that is not
//! flat, has the ball and the weight of the isotropic field. Passes 2 and 3 visit the neighbours of the others only, and the
//! field is not evaluated in blocks that only particles inside the fluid can reach.
//!
//! # Why not the other way
//!
//! * Eigenvalues, clamped, as in the paper: f is a rational function of the matrix, which needs one inverse and no eigenvectors.
//!   Both executors compute it with the same formula, it is smooth where eigenvalues meet, and it has the same effect.
//! * Covariances in a radius of 2 H: four times as many neighbours, in cells that are not adjacent. The mean of the covariances
//!   over the neighbours has a similar range.
//! * The volumes of the field of balls as weights: the sums of stretched kernels at their centres vary by a fifth, which roughens
//!   the surface as much as the noise of the positions that smoothing removes.
//! * Kernels of constant size: a jet that falls stretches, and the field falls below the iso level between its layers.

mod bulk;
mod matrix;
mod moments;
mod shapes;
#[cfg(test)]
mod tests;
mod weights;

pub(crate) use bulk::{bulk_number, lone_size};
pub(crate) use moments::MOMENTS;
pub(crate) use shapes::SHAPES;
pub(crate) use weights::WEIGHTS;

/// Largest factor on the size of a kernel, s.
const MAX_SIZE: f32 = 1.4;
/// Largest half-axis of a kernel, in support radii: s sqrt(f) for sparse particles with a wide covariance.
pub(crate) const MAX_STRETCH: f32 = 1.51;
/// Largest distance in support radii between a particle and the centre of its kernel.
pub(crate) const MAX_SHIFT: f32 = 0.125;
