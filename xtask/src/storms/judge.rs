//! The independent judge: whether the particles of a run are physically plausible. It knows the scene and the files of
//! the run, and nothing of the program's own monitor.

use super::ply::Cloud;
use super::scene::Facts;

/// The limits, fixed before the first run. Speeds are divided by the largest that energy allows: see [`Facts::speed`].
pub mod limits {
    /// One particle may be this fast: jets of colliding water exceed the speed of their sources.
    pub const FASTEST: f64 = 3.0;
    /// One particle in a hundred may be this fast.
    pub const FAST: f64 = 1.8;
    /// Gain of mechanical energy over that of the scene.
    pub const GAIN: f64 = 0.15;
    /// One particle may be this dense, relative to the lattice of the rest density.
    pub const DENSEST: f64 = 2.2;
    /// One particle in a hundred may be this dense.
    pub const DENSE: f64 = 1.4;
    /// Depth inside a body in spacings.
    pub const INSIDE: f64 = 0.5;
    /// Depth behind a closed wall in spacings.
    pub const BEHIND: f64 = 0.01;
}

/// What the judge measures in a frame.
#[derive(Clone, Copy, Debug, Default)]
pub struct Measures {
    /// Particles.
    pub count: usize,
    /// Particles that are NaN or infinite.
    pub not_finite: usize,
    /// Particles behind closed walls, and inside bodies whose shape the judge knows.
    pub misplaced: usize,
    /// The largest speed, and that of one in a hundred, over the largest that energy allows.
    pub fastest: f64,
    pub fast: f64,
    /// Kinetic and potential energy in J.
    pub energy: f64,
    /// The largest density, and that of one in a hundred, over the rest density.
    pub densest: f64,
    pub dense: f64,
}

/// Measures a frame.
pub fn measure(facts: &Facts, cloud: &Cloud) -> Measures {
    let is_finite =
        |k: &usize| cloud.positions[*k].iter().chain(&cloud.velocities[*k]).all(|number| number.is_finite());
    let sound: Vec<usize> = (0..cloud.positions.len()).filter(is_finite).collect();
    let positions: Vec<[f64; 3]> = sound.iter().map(|&k| cloud.positions[k]).collect();
    let mut speeds: Vec<f64> = sound.iter().map(|&k| length(cloud.velocities[k]) / facts.speed).collect();
    let kinetic: f64 = speeds.iter().map(|v| 0.5 * (v * facts.speed).powi(2)).sum();
    let potential: f64 = positions.iter().map(|&x| -dot(facts.gravity, x)).sum();
    let mut densities = densities(&positions, facts.spacing);
    Measures {
        count: cloud.positions.len(),
        not_finite: cloud.positions.len() - sound.len(),
        misplaced: positions.iter().filter(|&&x| is_misplaced(facts, x)).count(),
        fastest: quantile(&mut speeds, 0.0),
        fast: quantile(&mut speeds, 0.01),
        energy: facts.mass * (kinetic + potential),
        densest: quantile(&mut densities, 0.0),
        dense: quantile(&mut densities, 0.01),
    }
}

/// The reasons why a frame is implausible. `start` is the first frame.
pub fn verdict(facts: &Facts, start: &Measures, now: &Measures) -> Vec<String> {
    use limits::*;
    let mut reasons = Vec::new();
    let mut complain = |is_bad: bool, text: String| {
        if is_bad {
            reasons.push(text);
        }
    };
    complain(now.not_finite > 0, format!("{} particles are not finite", now.not_finite));
    complain(now.misplaced > 0, format!("{} particles are behind walls or inside bodies", now.misplaced));
    complain(now.fastest > FASTEST, format!("a particle has {:.2} times the largest speed", now.fastest));
    complain(now.fast > FAST, format!("one per cent has {:.2} times the largest speed", now.fast));
    if let Some(gain) = gain(facts, start, now) {
        complain(gain > GAIN, format!("the energy has grown by {:.0} %", 100.0 * gain));
    }
    complain(now.densest > DENSEST, format!("a particle has {:.2} times the rest density", now.densest));
    complain(now.dense > DENSE, format!("one per cent has {:.2} times the rest density", now.dense));
    let is_closed = facts.closed.iter().flatten().all(|&closed| closed) && !facts.has_sinks;
    complain(
        is_closed && now.count < start.count,
        format!("{} particles are lost from a closed domain", start.count.saturating_sub(now.count)),
    );
    reasons
}

/// The gain of mechanical energy over what was there and what the scene can bring in, relative to it; `None` where
/// particles come and go, so that their energy has no reference.
pub fn gain(facts: &Facts, start: &Measures, now: &Measures) -> Option<f64> {
    // With an emitter the count can be that of the start by chance.
    if now.count != start.count || start.count == 0 || facts.has_emitters {
        return None;
    }
    let floor = -facts.mass * facts.lowest * now.count as f64;
    let available = start.energy - floor + facts.brought * now.count as f64;
    Some((now.energy - floor) / available.max(f64::MIN_POSITIVE) - 1.0)
}

fn is_misplaced(facts: &Facts, x: [f64; 3]) -> bool {
    let behind = (0..3).any(|axis| {
        let depth = limits::BEHIND * facts.spacing;
        (facts.closed[axis][0] && x[axis] < facts.min[axis] - depth)
            || (facts.closed[axis][1] && x[axis] > facts.max[axis] + depth)
    });
    behind
        || facts
            .balls
            .iter()
            .any(|&(center, radius)| length(sub(x, center)) < radius - limits::INSIDE * facts.spacing)
}

/// Densities over the rest density by a sum over all pairs, without walls and bodies, so never too large: the cubic
/// spline with a support of 2.6 spacings.
fn densities(positions: &[[f64; 3]], spacing: f64) -> Vec<f64> {
    let support = 2.6 * spacing;
    let weight = |q: f64| if q <= 0.5 { 6.0 * q * q * (q - 1.0) + 1.0 } else { 2.0 * (1.0 - q).powi(3) };
    let mut lattice = 0.0;
    for k in 0..343 {
        let offset = [k % 7, k / 7 % 7, k / 49].map(|n: i32| f64::from(n - 3) / 2.6);
        let q = length(offset);
        lattice += if q < 1.0 { weight(q) } else { 0.0 };
    }
    let mut order: Vec<usize> = (0..positions.len()).collect();
    order.sort_unstable_by(|&a, &b| positions[a][0].total_cmp(&positions[b][0]));
    let mut sums = vec![1.0; positions.len()];
    for (place, &i) in order.iter().enumerate() {
        for &j in &order[place + 1..] {
            let d = sub(positions[j], positions[i]);
            if d[0] >= support {
                break;
            }
            let r2 = dot(d, d);
            if r2 < support * support {
                let w = weight(r2.sqrt() / support);
                sums[i] += w;
                sums[j] += w;
            }
        }
    }
    sums.iter().map(|sum| sum / lattice).collect()
}

/// The value that a fraction of the values exceeds: 0 gives the largest.
fn quantile(values: &mut [f64], fraction: f64) -> f64 {
    values.sort_unstable_by(|a, b| b.total_cmp(a));
    values.get((fraction * values.len() as f64) as usize).copied().unwrap_or_default()
}

pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn length(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

pub fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}
