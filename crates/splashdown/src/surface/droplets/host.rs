//! Isolated particles in host memory.

use glam::{Vec3, Vec4};
use rayon::prelude::*;
use splashdown_io::{Attribute, Particles};

use super::classify::Links;
use super::{LINK, MAX_BLOB, droplet_radius};
use crate::cells::sort_order;
use crate::pairs::Sorted;
use crate::surface::components::{join, root};
use crate::surface::reconstruct::grid_over;
use crate::surface::{SurfaceError, SurfaceParams};

/// The name of the attribute of droplets in files: their diameter in m.
const WIDTH: &str = "width";

/// The indices of the isolated particles in increasing order: those in blobs of fewer than
/// [`min_blob`](SurfaceParams::min_blob) particles, of which there may be any number here, and those with fewer than
/// [`min_neighbours`](SurfaceParams::min_neighbours) others within 0.9 support radii. Positions that are not finite are
/// skipped. It runs on the CPU.
///
/// # Errors
/// [`SurfaceError`] if a parameter is invalid or the particles are too far apart.
///
/// ```
/// use splashdown::surface::{SurfaceParams, isolated};
/// let mut params = SurfaceParams::new(0.1);
/// params.min_blob = 2;
/// let pair_and_single = [[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.5, 0.0, 0.0]];
/// assert_eq!(isolated(&pair_and_single, &params)?, [2]);
/// # Ok::<(), splashdown::surface::SurfaceError>(())
/// ```
pub fn isolated(positions: &[[f32; 3]], params: &SurfaceParams) -> Result<Vec<u32>, SurfaceError> {
    let allowed = |limit: u32| limit.min(MAX_BLOB);
    SurfaceParams { min_blob: allowed(params.min_blob), ..*params }.check()?;
    let is_finite = |i: &u32| Vec3::from(positions[*i as usize]).is_finite();
    let finite: Vec<u32> = (0..positions.len() as u32).filter(is_finite).collect();
    if finite.is_empty() || !params.separates() {
        return Ok(Vec::new());
    }
    let places: Vec<Vec3> = finite.iter().map(|&i| positions[i as usize].into()).collect();
    let grid = grid_over(&places, params)?;
    let (order, cell_start) = sort_order(&grid, &places);
    let sorted: Vec<Vec4> = order.iter().map(|&i| places[i as usize].extend(0.0)).collect();
    let links = Links {
        sorted: Sorted::new(params.support_radius, &grid, &cell_start, &sorted),
        positions: &sorted,
        square: (LINK * params.support_radius).powi(2),
    };
    let (min_blob, min_neighbours) = (params.min_blob as usize, params.min_neighbours as usize);
    let sizes = if params.min_blob > MAX_BLOB { blob_sizes(&links) } else { Vec::new() };
    let is_isolated = |i: usize| match sizes.get(i) {
        Some(&size) => size < params.min_blob || links.of(i).count() - 1 < min_neighbours,
        None => links.is_isolated(i, min_blob, min_neighbours),
    };
    let of_rank = |rank: usize| is_isolated(rank).then(|| finite[order[rank] as usize]);
    let mut found: Vec<u32> = (0..order.len()).into_par_iter().filter_map(of_rank).collect();
    found.par_sort_unstable();
    Ok(found)
}

/// The number of particles in the blob of each particle (union-find).
fn blob_sizes(links: &Links<'_>) -> Vec<u32> {
    let n = links.positions.len();
    let mut parents: Vec<u32> = (0..n as u32).collect();
    for i in 0..n {
        for j in links.of(i).filter(|&j| j < i) {
            join(&mut parents, i as u32, j as u32);
        }
    }
    let roots: Vec<u32> = (0..n as u32).map(|i| root(&mut parents, i)).collect();
    let mut sizes = vec![0; n];
    roots.iter().for_each(|&root| sizes[root as usize] += 1);
    roots.into_iter().map(|root| sizes[root as usize]).collect()
}

/// The particles with these indices as droplets: ids, positions and velocities, and their diameter in m as the attribute
/// `width`. Without ids, the indices are the ids.
pub fn droplets_of(particles: &Particles, indices: &[u32], particle_spacing: f32) -> Particles {
    fn of<T: Copy>(values: &[T], indices: &[u32]) -> Vec<T> {
        indices.iter().filter_map(|&i| values.get(i as usize).copied()).collect()
    }
    let ids = if particles.ids.is_empty() { indices.to_vec() } else { of(&particles.ids, indices) };
    let values = vec![2.0 * droplet_radius(particle_spacing); indices.len()];
    let mut info = particles.info;
    info.particle_spacing = Some(particle_spacing);
    Particles::from_positions(of(&particles.positions, indices))
        .with_ids(ids)
        .with_velocities(of(&particles.velocities, indices))
        .with_attributes(vec![Attribute { name: WIDTH.to_owned(), components: 1, values }])
        .with_info(info)
}
