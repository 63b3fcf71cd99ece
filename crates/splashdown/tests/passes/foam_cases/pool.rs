//! Diffuse particles, and the fluid around them.

use glam::{DVec3, Vec3};
use splashdown::foam::Diffuse;
use splashdown_gpu::bytemuck;

use super::super::harness::exact;
use super::super::world::World;
use super::{W, masked, near, place, speed, unit};

/// The fraction of a ball of this radius that is inside the closed sides, from the spherical cap of
/// each side.
fn part_inside(world: &World, x: DVec3) -> f64 {
    let p = &world.params;
    let (low, high) = (p.domain_min.as_dvec3(), p.domain_max.as_dvec3());
    let mut part = 1.0;
    for axis in 0..3 {
        for (side, gap) in [(0, x[axis] - low[axis]), (1, high[axis] - x[axis])] {
            if p.closed >> (2 * axis + side) & 1 == 1 {
                // A spherical cap of height 1 - t of the unit ball has the volume pi (1 - t)^2 (2 +
                // t) / 3.
                let t = (gap / f64::from(p.support_radius)).clamp(0.0, 1.0);
                part *= 1.0 - (1.0 - t).powi(2) * (2.0 + t) / 4.0;
            }
        }
    }
    part
}

/// Mean velocity, number of neighbours, and whether a neighbour is at the edge of the support.
pub(super) fn around(world: &World, x: DVec3) -> (DVec3, f64, bool) {
    let support = f64::from(world.params.support_radius);
    let (mut sum, mut weight, mut number) = (DVec3::ZERO, 0.0, 0.0);
    near(world, x, |j, _, r| {
        sum += W.w(r / support) * speed(world, j);
        weight += W.w(r / support);
        number += 1.0;
    });
    let edge = (0..world.active()).any(|j| ((x - place(world, j)).length() - support).abs() < 1e-6);
    (if weight > 0.0 { sum / weight } else { sum }, number / part_inside(world, x), edge)
}

pub(super) fn kind(neighbours: f64, was: u32) -> u32 {
    match neighbours {
        few if few < 12.5 => 0,
        many if many > if was == 1 { 21.5 } else { 18.5 } => 2,
        _ => 1,
    }
}

pub(super) fn words(particles: &[Diffuse]) -> Vec<f32> {
    bytemuck::cast_slice(particles).to_vec()
}

/// Diffuse particles everywhere in the domain, some about to leave, some about to dissolve.
pub(super) fn diffuse(world: &World, n: u32) -> Vec<Diffuse> {
    let p = &world.params;
    let random = |i: u32, k: u32| unit(100_000 + 11 * i + k) as f32;
    (0..n)
        .map(|i| {
            let at = Vec3::new(random(i, 0), random(i, 1), random(i, 2));
            let v = Vec3::new(random(i, 3), random(i, 4), random(i, 5)) * 6.0 - 3.0;
            Diffuse {
                position: p.domain_min + at * (p.domain_max - p.domain_min),
                lifetime: if i.is_multiple_of(5) { 0.01 * random(i, 6) } else { 1.0 + random(i, 6) },
                velocity: v,
                tag: ((1000 + i) << 2) | (i % 3),
            }
        })
        .collect()
}

/// Compares particles: ids and kinds exactly, all other values with a tolerance.
pub(super) fn alike(a: &[f32], b: &[f64], edge: &[bool]) -> Result<(), String> {
    // A tag read as a float is a denormal or NaN; it is compared separately as an integer.
    let tags = |k: usize| k % 8 == 7;
    let certain = |k: &usize| tags(*k) && !edge[k / 8];
    let a_tags: Vec<u32> = (0..a.len()).filter(certain).map(|k| a[k].to_bits()).collect();
    let b_tags: Vec<u32> = (0..a.len()).filter(certain).map(|k| b[k] as u32).collect();
    exact("tags", &a_tags, &b_tags)?;
    let a: Vec<f32> = (0..a.len()).map(|k| if tags(k) { 0.0 } else { a[k] }).collect();
    let b: Vec<f64> = (0..a.len()).map(|k| if tags(k) { 0.0 } else { b[k] }).collect();
    // The absolute error of the cosine on a GPU is up to 2^-11.
    let tolerance: Vec<f64> = b.iter().map(|b| 2e-5 + 2e-5 * b.abs()).collect();
    masked("particles", &a, &b, &tolerance, edge)
}

/// Particles as floats, and the tag as an integer.
pub(super) fn numbers(words: &[f32]) -> Vec<f64> {
    let number = |(k, word): (usize, &f32)| {
        if k % 8 == 7 { f64::from(word.to_bits()) } else { f64::from(*word) }
    };
    words.iter().enumerate().map(number).collect()
}
