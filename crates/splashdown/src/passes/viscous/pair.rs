//! The viscous force of a pair of particles, and of a particle and an image behind a wall.

use splashdown_gpu::WgslModule;

use crate::pairs::{Radial, difference, dot, scaled};
use crate::simd::Lanes;

/// The WGSL side.
pub const WGSL: WgslModule = WgslModule { name: "sph/viscous_pair", source: include_str!("pair.wgsl") };

/// What is added to the square of a distance in support radii before a division.
const SOFT: f32 = 1e-6;

/// The weight of a pair in the operator at a distance q in support radii: (1 - q)(1 - 4/5 q), zero beyond the support.
///
/// The operator weighs a pair by the fourth power of its components. With the weight -dW/dr/r of Wendland C2 and a support of
/// two spacings the viscosity of a cubic lattice is 0.59 times that of a continuum in a shear along an axis, up to 0.89 times
/// while the lattice is sheared, and 1.57 times in an extension along an axis. This one gives 0.93 to 0.95, and 1.12 in
/// the extension; 0.94 for disordered particles. [`lattice_factor`] removes the mean.
#[inline(always)]
fn weight<V: Lanes>(q: V) -> V {
    let one = V::splat(1.0);
    let t = (one - q).max(V::splat(0.0));
    t * (one - q * 0.8)
}

/// The square root of the weight over the distance in support radii, for lists of neighbours: with the vectors s = d times
/// this, the force of a pair is s (s.(v - u)) over the square of the support radius.
pub(super) struct Root;

impl Radial for Root {
    #[inline(always)]
    fn factor<V: Lanes>(q: V) -> V {
        (weight(q) / (q * q + SOFT)).sqrt()
    }
}

/// The factor of the sums in 1/s, per m^2/s of viscosity and m^3 of volume, at a support radius in m: the continuum then
/// has this viscosity.
pub fn factor(support_radius: f32) -> f32 {
    525.0 / std::f32::consts::PI / support_radius.powi(5)
}

/// The viscosity of a lattice that is sheared along an axis, over that of a continuum: the mean over the states of the lattice.
/// `ratio` is the support radius in spacings.
pub fn lattice_factor(ratio: f64) -> f64 {
    const STATES: i32 = 20;
    let reach = ratio.ceil() as i32 + 1;
    let steps = || -reach..=reach;
    let mut sum = 0.0;
    for state in 0..STATES {
        let shear = f64::from(state) / f64::from(STATES);
        // A sheared layer has the points of the layer that is moved by the part of a spacing.
        for (y, z) in steps().flat_map(|y| steps().map(move |z| (f64::from(y), f64::from(z)))) {
            for x in steps().map(|x| f64::from(x) + (shear * y).rem_euclid(1.0)) {
                let r2 = x * x + y * y + z * z;
                let q = r2.sqrt() / ratio;
                if r2 > 0.0 && q < 1.0 {
                    sum += (1.0 - q) * (1.0 - 0.8 * q) / r2 * x * x * y * y;
                }
            }
        }
    }
    // Half the factor of the sums.
    0.5 * 525.0 / std::f64::consts::PI / ratio.powi(5) * sum / f64::from(STATES)
}

/// The constants of the operator.
#[derive(Clone, Copy, Debug)]
pub(super) struct Law<V> {
    scale: V,
    soft: V,
    friction: V,
}

impl<V: Lanes> Law<V> {
    /// For a support radius in m, and the friction of walls.
    #[inline(always)]
    pub fn new(support_radius: f32, friction: f32) -> Self {
        Self {
            scale: V::splat(1.0 / support_radius),
            soft: V::splat(SOFT * support_radius * support_radius),
            friction: V::splat(friction),
        }
    }

    /// The weight over the square of the distance, for a square of a distance in m^2.
    #[inline(always)]
    pub fn weight(&self, r2: V) -> V {
        weight(r2.sqrt() * self.scale) / (r2 + self.soft)
    }

    /// The force of a pair: the weight times d (d.(v - u)), for the velocity `v` of a particle and `u` of the other one at the
    /// distance `d`. Of an image, `sign` are the signs of its reflection, and `u` is the velocity of the particle itself. Without friction the image has the reflected velocity R u. With friction 1 it has the velocity -u behind one wall,
    /// u behind an edge, -u behind a corner. The matrix is then the mean of d d' and of that for the reflected distance:
    /// products of components of which R changes one vanish. This makes the operator symmetric, which d d' alone would not
    /// be, and changes nothing for a flow along the wall.
    #[inline(always)]
    pub fn with_friction(&self, v: [V; 3], u: [V; 3], d: [V; 3], sign: [V; 3]) -> [V; 3] {
        scaled(self.weight(dot(d, d)), self.unweighted(v, u, d, sign))
    }

    /// The same without the weight.
    #[inline(always)]
    pub fn unweighted(&self, v: [V; 3], u: [V; 3], d: [V; 3], sign: [V; 3]) -> [V; 3] {
        let image = [sign[0] * u[0], sign[1] * u[1], sign[2] * u[2]];
        let slipping = scaled(dot(d, difference(v, image)), d);
        let w = difference(v, scaled(sign[0] * sign[1] * sign[2], u));
        let mixed = |a: usize, b: usize| sign[a] * sign[b] * 0.5 + 0.5;
        let (xy, xz, yz) = (mixed(0, 1), mixed(0, 2), mixed(1, 2));
        let a = [d[0] * w[0], d[1] * w[1], d[2] * w[2]];
        let sticking = [
            d[0] * (a[0] + xy * a[1] + xz * a[2]),
            d[1] * (a[1] + xy * a[0] + yz * a[2]),
            d[2] * (a[2] + xz * a[0] + yz * a[1]),
        ];
        std::array::from_fn(|k| slipping[k] + self.friction * (sticking[k] - slipping[k]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values computed independently.
    #[test]
    fn the_lattice_factor_matches_independent_values() {
        for (ratio, expected) in [(2.0, 0.940_58), (3.0, 0.991_07)] {
            let factor = lattice_factor(ratio);
            assert!((factor - expected).abs() < 1e-4, "{ratio}: {factor}");
        }
    }
}
