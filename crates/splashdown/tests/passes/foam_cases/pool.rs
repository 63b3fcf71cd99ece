//! Diffuse particles, and what they find round themselves.

use glam::{DVec3, Vec3};
use splashdown::foam::Diffuse;
use splashdown_gpu::bytemuck;

use super::super::harness::exact;
use super::super::world::World;
use super::{W, masked, near, place, speed, unit};

/// The part of a ball of this radius whose centre is inside of the closed sides, by each side's cap.
fn part_inside(world: &World, x: DVec3) -> f64 {
    let p = &world.params;
    let (low, high) = (p.domain_min.as_dvec3(), p.domain_max.as_dvec3());
    let mut part = 1.0;
    for axis in 0..3 {
        for (side, gap) in [(0, x[axis] - low[axis]), (1, high[axis] - x[axis])] {
            if p.closed >> (2 * axis + side) & 1 == 1 {
                // A cap of height 1 - t of the unit ball has the volume pi (1 - t)^2 (2 + t) / 3.
                let t = (gap / f64::from(p.support_radius)).clamp(0.0, 1.0);
                part *= 1.0 - (1.0 - t).powi(2) * (2.0 + t) / 4.0;
            }
        }
    }
    part
}

/// Mean velocity, neighbours, and whether a neighbour is on the edge of the support.
pub(super) fn around(world: &World, x: DVec3) -> (DVec3, f64, bool) {
    let support = f64::from(world.params.support_radius);
    let (mut sum, mut weight, mut number) = (DVec3::ZERO, 0.0, 0.0);
    near(world, x, |j, _, r| {
        sum += W.w(r / support) * speed(world, j);
        weight += W.w(r / support);
        number += 1.0;
    });
    let edge = (0..world.living()).any(|j| ((x - place(world, j)).length() - support).abs() < 1e-6);
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

/// Particles of foam everywhere in the box of the world, some on their way out, some about to dissolve.
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

/// Equal particles: numbers and kinds to the bit, all else nearly.
pub(super) fn alike(a: &[f32], b: &[f64], edge: &[bool]) -> Result<(), String> {
    // A tag read as a float is a tiny number or NaN; as a whole number it is compared apart.
    let tags = |k: usize| k % 8 == 7;
    let certain = |k: &usize| tags(*k) && !edge[k / 8];
    let a_tags: Vec<u32> = (0..a.len()).filter(certain).map(|k| a[k].to_bits()).collect();
    let b_tags: Vec<u32> = (0..a.len()).filter(certain).map(|k| b[k] as u32).collect();
    exact("tags", &a_tags, &b_tags)?;
    let a: Vec<f32> = (0..a.len()).map(|k| if tags(k) { 0.0 } else { a[k] }).collect();
    let b: Vec<f64> = (0..a.len()).map(|k| if tags(k) { 0.0 } else { b[k] }).collect();
    // The GPU's cosine is good to 2^-11 of a particle's radius.
    let tolerance: Vec<f64> = b.iter().map(|b| 2e-5 + 2e-5 * b.abs()).collect();
    masked("particles", &a, &b, &tolerance, edge)
}

/// Particles as numbers, the tag as a whole one.
pub(super) fn numbers(words: &[f32]) -> Vec<f64> {
    let number = |(k, word): (usize, &f32)| {
        if k % 8 == 7 { f64::from(word.to_bits()) } else { f64::from(*word) }
    };
    words.iter().enumerate().map(number).collect()
}
