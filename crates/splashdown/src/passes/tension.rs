//! Surface tension between two particles (Akinci, Akinci & Teschner 2013), for the passes that sum it.

use std::f32::consts::PI;

use splashdown_gpu::WgslModule;

use crate::kernel::SMALLEST_Q;
use crate::simd::Lanes;
use crate::state::Params;

/// The WGSL side.
pub const WGSL: WgslModule = WgslModule { name: "sph/tension", source: include_str!("tension.wgsl") };

/// The constants of the formula.
#[derive(Clone, Copy)]
pub(crate) struct Tension {
    /// One over the support radius.
    scale: f32,
    strength: f32,
    pull: f32,
}

impl Tension {
    pub fn new(params: &Params) -> Self {
        let scale = 1.0 / params.support_radius;
        Self {
            scale,
            strength: -2.0 * params.surface_tension * params.rest_density,
            pull: params.summed_mass * (scale * scale) * (scale * scale),
        }
    }

    /// The acceleration by particle j, for d = x_i - x_j, its length r, n = n_i - n_j and the sum of their densities. Zero
    /// beyond the support.
    #[inline(always)]
    pub fn acceleration<V: Lanes>(&self, d: [V; 3], r: V, n: [V; 3], densities: V) -> [V; 3] {
        let (zero, one) = (V::splat(0.0), V::splat(1.0));
        let q = r * self.scale;
        let weight = q.if_less(one, V::splat(self.strength), zero) / densities;
        let pull = cohesion(q) * self.pull / q.max(V::splat(SMALLEST_Q));
        std::array::from_fn(|axis| weight * (pull * d[axis] + n[axis]))
    }
}

/// Akinci's cohesion kernel times H^3 for q in [0, 1]; both branches agree at q = 1/2.
#[inline(always)]
fn cohesion<V: Lanes>(q: V) -> V {
    let t = (V::splat(1.0) - q).max(V::splat(0.0)) * q;
    let t3 = t * t * t;
    q.if_less(V::splat(0.5), t3 * 2.0 - 1.0 / 64.0, t3) * (32.0 / PI)
}
