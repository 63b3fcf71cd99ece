//! How far from each other the particles of a file are.

use rayon::prelude::*;

/// Distances that are looked at, particles times samples.
const WORK: usize = 200_000_000;
/// Most particles whose neighbours are looked for.
const MOST_SAMPLES: usize = 1000;
/// The neighbour whose distance is taken: on a lattice the corner of a box has three at one spacing. Of
/// simulated fluids it is the one whose distance is nearest to the spacing that they were made with (1.02 to
/// 1.03 times that of two runs of DFSPH).
const NEIGHBOUR: usize = 3;

/// The spacing of a lattice with neighbours as far as these particles have theirs, in m: the median distance of
/// the third neighbour over some particles. `None` for fewer than four.
pub fn typical_spacing(positions: &[[f32; 3]]) -> Option<f32> {
    let n = positions.len();
    if n <= NEIGHBOUR {
        return None;
    }
    let samples = (WORK / n).clamp(16, MOST_SAMPLES).min(n);
    let mut distances: Vec<f32> = (0..samples)
        .into_par_iter()
        .map(|k| {
            let x = positions[(k as u64 * n as u64 / samples as u64) as usize];
            // Of the particle itself and its nearest neighbours, nearest first.
            let mut nearest = [f32::INFINITY; NEIGHBOUR + 1];
            for y in positions {
                let mut squared: f32 = (0..3).map(|a| (x[a] - y[a]) * (x[a] - y[a])).sum();
                for place in &mut nearest {
                    if squared < *place {
                        std::mem::swap(place, &mut squared);
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
    fn a_lattice_has_its_own_spacing_be_it_full_flat_or_shifted() {
        let lattice = |n: [i32; 3], spacing: f32| -> Vec<[f32; 3]> {
            let points = (0..n[0] * n[1] * n[2]).map(|i| [i % n[0], i / n[0] % n[1], i / (n[0] * n[1])]);
            points.map(|p| p.map(|c| c as f32 * spacing)).collect()
        };
        for n in [[10, 10, 10], [30, 30, 1], [2, 2, 2]] {
            let found = typical_spacing(&lattice(n, 0.013)).expect("enough particles");
            assert!((found / 0.013 - 1.0).abs() < 1e-4, "{n:?}: {found}");
        }
        assert_eq!(typical_spacing(&lattice([3, 1, 1], 0.1)), None);
        assert_eq!(typical_spacing(&[[0.5; 3]; 8]), Some(0.0), "all at one place");
    }
}
