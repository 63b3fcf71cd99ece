//! Estimates the spacing of the particles of a file.

use rayon::prelude::*;

/// Maximum number of distances to compute: particles times samples.
const MAX_DISTANCES: usize = 200_000_000;
/// Maximum number of particles whose neighbours are searched.
const MAX_SAMPLES: usize = 1000;
/// The rank of the neighbour whose distance is used. The corner of a box on a lattice has three neighbours at
/// one spacing. In simulated fluids the distance of the third neighbour is the nearest to the initial
/// spacing: 1.02 to 1.03 times as large in two DFSPH runs.
const NEIGHBOUR: usize = 3;

/// Estimates the particle spacing in m: the median distance to the third-nearest neighbour over a sample of
/// the particles. `None` for fewer than four particles.
pub fn typical_spacing(positions: &[[f32; 3]]) -> Option<f32> {
    let n = positions.len();
    if n <= NEIGHBOUR {
        return None;
    }
    let samples = (MAX_DISTANCES / n).clamp(16, MAX_SAMPLES).min(n);
    let mut distances: Vec<f32> = (0..samples)
        .into_par_iter()
        .map(|k| {
            let x = positions[(k as u64 * n as u64 / samples as u64) as usize];
            // Squared distances to the particle itself and its nearest neighbours, nearest first.
            let mut nearest = [f32::INFINITY; NEIGHBOUR + 1];
            for y in positions {
                let mut squared: f32 = (0..3).map(|a| (x[a] - y[a]) * (x[a] - y[a])).sum();
                for smallest in &mut nearest {
                    if squared < *smallest {
                        std::mem::swap(smallest, &mut squared);
                    }
                }
            }
            nearest[NEIGHBOUR].sqrt()
        })
        .collect();
    let middle = distances.len() / 2;
    Some(*distances.select_nth_unstable_by(middle, f32::total_cmp).1)
}

/// The radius, in typical spacings, of the neighbourhood in which [`fitted_spacing`] counts particles.
const REACH: f64 = 3.0;
/// A particle is inside the fluid if the centre of its neighbourhood is no farther from it than this, over the radius.
const CENTRED: f64 = 0.05;
/// Smallest number of particles inside the fluid.
const FEWEST: usize = 8;

/// The spacing in m of the lattice with the same number of particles per volume, measured inside the fluid with the
/// Wendland C2 kernel over a sample of the particles. `None` if too few particles are inside.
pub fn fitted_spacing(positions: &[[f32; 3]]) -> Option<f32> {
    let reach = REACH * f64::from(typical_spacing(positions).filter(|spacing| *spacing > 0.0)?);
    let n = positions.len();
    let samples = (MAX_DISTANCES / n).clamp(16, MAX_SAMPLES).min(n);
    let inside: Vec<f64> = (0..samples)
        .into_par_iter()
        .filter_map(|k| {
            let x = positions[(k as u64 * n as u64 / samples as u64) as usize];
            let (mut sum, mut centre) = (0.0, [0.0; 3]);
            for y in positions {
                let d: [f64; 3] = std::array::from_fn(|a| f64::from(y[a]) - f64::from(x[a]));
                let q = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt() / reach;
                if q < 1.0 {
                    let w = (1.0 - q).powi(4) * (1.0 + 4.0 * q);
                    sum += w;
                    (0..3).for_each(|a| centre[a] += w * d[a] / reach);
                }
            }
            let off = centre.iter().map(|c| c * c).sum::<f64>().sqrt() / sum;
            (off < CENTRED).then_some(sum)
        })
        .collect();
    if inside.len() < FEWEST {
        return None;
    }
    // The kernel's integral, and its sum over a lattice of this radius.
    let integral = 2.0 * std::f64::consts::PI / 21.0 * reach.powi(3);
    let density = inside.iter().sum::<f64>() / inside.len() as f64 / (1.0031 * integral);
    Some(density.cbrt().recip() as f32)
}

/// How many particles are in the cube of one spacing in which a particle is, on average: 1 on a lattice.
pub(crate) fn crowding(positions: &[[f32; 3]], spacing: f32) -> f32 {
    let cell = |x: &[f32; 3]| x.map(|c| (c / spacing).floor() as i32);
    let mut cells: Vec<[i32; 3]> = positions.iter().map(cell).collect();
    cells.par_sort_unstable();
    let squares: f64 = cells.chunk_by(|a, b| a == b).map(|same| (same.len() as f64).powi(2)).sum();
    (squares / positions.len().max(1) as f64) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fitted_spacing_is_that_of_equal_numbers_per_volume() {
        // Layers at 0.02 m with columns at 0.01 x 0.005 m have the density of a lattice of 0.01 m.
        let points = |steps: [f32; 3], n: [i32; 3]| -> Vec<[f32; 3]> {
            let index = (0..n[0] * n[1] * n[2]).map(|i| [i % n[0], i / n[0] % n[1], i / (n[0] * n[1])]);
            index.map(|p| std::array::from_fn(|a| p[a] as f32 * steps[a])).collect()
        };
        let cubic = fitted_spacing(&points([0.01; 3], [16; 3])).expect("particles inside");
        assert!((cubic / 0.01 - 1.0).abs() < 0.005, "{cubic}");
        let stretched = fitted_spacing(&points([0.0125, 0.01, 0.008], [16; 3])).expect("particles inside");
        assert!((stretched / 0.01 - 1.0).abs() < 0.01, "{stretched}");
        // Control: 1.35 times as many particles per volume.
        let dense = fitted_spacing(&points([0.01 / 1.35_f32.cbrt(); 3], [16; 3])).expect("particles inside");
        assert!((dense / 0.00905 - 1.0).abs() < 0.005, "{dense}");
        assert_eq!(fitted_spacing(&points([0.01; 3], [2, 2, 2])), None, "no particle is inside");
    }

    #[test]
    fn crowding_is_the_number_of_particles_in_a_cube() {
        let lattice: Vec<[f32; 3]> =
            (0..1000).map(|i| [i % 10, i / 10 % 10, i / 100].map(|c| (c as f32 + 0.5) * 0.01)).collect();
        assert!((crowding(&lattice, 0.01) - 1.0).abs() < 1e-6);
        assert!((crowding(&lattice, 0.02) - 8.0).abs() < 1e-6);
        assert_eq!(crowding(&[[0.5; 3]; 300], 0.01), 300.0);
        assert_eq!(crowding(&[], 0.01), 0.0);
    }

    #[test]
    fn the_spacing_of_a_lattice_is_found() {
        let lattice = |n: [i32; 3], spacing: f32| -> Vec<[f32; 3]> {
            let points = (0..n[0] * n[1] * n[2]).map(|i| [i % n[0], i / n[0] % n[1], i / (n[0] * n[1])]);
            points.map(|p| p.map(|c| c as f32 * spacing)).collect()
        };
        for n in [[10, 10, 10], [30, 30, 1], [2, 2, 2]] {
            let found = typical_spacing(&lattice(n, 0.013)).expect("enough particles");
            assert!((found / 0.013 - 1.0).abs() < 1e-4, "{n:?}: {found}");
        }
        assert_eq!(typical_spacing(&lattice([3, 1, 1], 0.1)), None);
        assert_eq!(typical_spacing(&[[0.5; 3]; 8]), Some(0.0), "all at one position");
    }
}
