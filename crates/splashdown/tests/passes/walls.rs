//! The closed sides of the domain, from their definitions.

use std::f64::consts::PI;

use glam::DVec3;
use splashdown::state::Params;

use super::oracle::Kernel;

/// The reflections at all combinations of closed sides, at most one side per axis, and the identity first.
pub fn reflections(params: &Params) -> Vec<Reflection> {
    let mut all = vec![Reflection { sign: DVec3::ONE, shift: DVec3::ZERO }];
    for axis in 0..3 {
        let planes = [(params.domain_min, 0), (params.domain_max, 1)];
        let closed: Vec<f64> = planes
            .into_iter()
            .filter(|(_, side)| params.closed >> (2 * axis + side) & 1 == 1)
            .map(|(corner, _)| f64::from(corner[axis]))
            .collect();
        for k in 0..all.len() {
            for plane in &closed {
                let mut more = all[k];
                more.sign[axis] = -1.0;
                more.shift[axis] = 2.0 * plane;
                all.push(more);
            }
        }
    }
    all
}

#[derive(Clone, Copy, Debug)]
pub struct Reflection {
    pub sign: DVec3,
    pub shift: DVec3,
}

/// The sides near one particle.
#[derive(Clone, Debug)]
pub struct Wall {
    /// The distance to the nearest closed side of each axis, if it is less than the support.
    pub distance: [Option<f64>; 3],
    /// The gradient of the kernel fraction of each of these sides in 1/m.
    pub gradient: [f64; 3],
}

/// The sides near a point.
pub fn at(params: &Params, kernel: Kernel, x: DVec3) -> Wall {
    let support = f64::from(params.support_radius);
    let mut wall = Wall { distance: [None; 3], gradient: [0.0; 3] };
    for axis in 0..3 {
        let is_closed = |side: usize| params.closed >> (2 * axis + side) & 1 == 1;
        let low = x[axis] - f64::from(params.domain_min[axis]);
        let high = f64::from(params.domain_max[axis]) - x[axis];
        let nearest = [(low, 0), (high, 1)]
            .into_iter()
            .filter(|&(_, side)| is_closed(side))
            .map(|(distance, _)| distance.max(0.0))
            .fold(f64::INFINITY, f64::min);
        if nearest < support {
            wall.distance[axis] = Some(nearest);
            // Moving the plane adds a slice: the integral of the kernel over the plane.
            wall.gradient[axis] = plane_integral(kernel, nearest / support) / support;
        }
    }
    wall
}

/// H times the integral of the kernel over a plane at distance q H, by the midpoint rule.
fn plane_integral(kernel: Kernel, q: f64) -> f64 {
    const STEPS: u32 = 2000;
    let step = (1.0 - q) / f64::from(STEPS);
    (0..STEPS).map(|k| q + step * (f64::from(k) + 0.5)).map(|r| 2.0 * PI * r * kernel.w(r) * step).sum()
}
