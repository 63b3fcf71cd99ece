//! The disorder of particles: distances of nearest neighbours, and the sum of the kernel.

use std::collections::HashMap;

use glam::DVec3;

use super::vec;

/// The disorder of the particles that are at least three spacings inside the box.
pub struct Disorder {
    /// The smallest distance of two particles over the spacing.
    pub nearest: f64,
    /// The standard deviation of the kernel's sum over its mean, with a support of three spacings.
    pub spread: f64,
}

/// Measures particles in a box.
pub fn measure(positions: &[[f32; 3]], spacing: f64, min: DVec3, max: DVec3) -> Disorder {
    let reach = 3.0 * spacing;
    let cell = |x: DVec3| (x / reach).floor().as_ivec3();
    let mut cells: HashMap<glam::IVec3, Vec<(usize, DVec3)>> = HashMap::new();
    for (i, x) in positions.iter().map(|&x| vec(x)).enumerate() {
        cells.entry(cell(x)).or_default().push((i, x));
    }
    let (mut nearest, mut sums) = (f64::MAX, Vec::new());
    for (i, x) in positions.iter().map(|&x| vec(x)).enumerate() {
        // The slab is thin: all of its thickness counts, and only its sides are left out.
        let inside = |k: usize| x[k] - min[k] > reach && max[k] - x[k] > reach;
        let mut sum = 0.0;
        for shift in 0..27 {
            let other = cell(x) + glam::IVec3::new(shift % 3 - 1, shift / 3 % 3 - 1, shift / 9 - 1);
            for &(j, y) in cells.get(&other).into_iter().flatten() {
                // Mirror images complete the support at the walls of the slab.
                for z in [y.z, 2.0 * min.z - y.z, 2.0 * max.z - y.z] {
                    let q = x.distance(DVec3::new(y.x, y.y, z)) / reach;
                    if q < 1.0 {
                        sum += (1.0 - q).powi(4) * (4.0 * q + 1.0);
                    }
                }
                if i != j {
                    nearest = nearest.min(x.distance(y) / spacing);
                }
            }
        }
        if inside(0) && inside(1) {
            sums.push(sum);
        }
    }
    let mean = sums.iter().sum::<f64>() / sums.len() as f64;
    let variance = sums.iter().map(|s| (s - mean).powi(2)).sum::<f64>() / sums.len() as f64;
    Disorder { nearest, spread: variance.sqrt() / mean }
}

#[test]
fn a_lattice_has_no_disorder_and_a_displaced_particle_has() {
    let node = |k: i32| [k % 20, k / 20 % 20, k / 400].map(|n| 0.1 * (n as f32 + 0.5));
    let mut lattice: Vec<[f32; 3]> = (0..2400).map(node).collect();
    let (min, max) = (DVec3::ZERO, DVec3::new(2.0, 2.0, 0.6));
    let found = measure(&lattice, 0.1, min, max);
    assert!((found.nearest - 1.0).abs() < 1e-5 && found.spread < 1e-5, "{} {}", found.nearest, found.spread);
    lattice[1010][0] += 0.04;
    let found = measure(&lattice, 0.1, min, max);
    assert!((found.nearest - 0.6).abs() < 1e-5 && found.spread > 1e-3, "{} {}", found.nearest, found.spread);
    lattice[1010] = lattice[1011];
    assert_eq!(measure(&lattice, 0.1, min, max).nearest, 0.0);
}
