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

#[cfg(test)]
mod tests {
    use super::*;

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
