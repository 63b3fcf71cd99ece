//! Probes of the whole fluid, or of the fluid in a box: volume, energies, momentum; and of the energy balance.
//!
//! The host computes these sums in double precision once per frame, when it has the particles anyway. A sum over all
//! particles in every step would cost the device more than all gauges together.

use glam::DVec3;
use splashdown_io::Particles;

use super::ProbeRows;
use crate::scene::{Quantity, Scene};

/// The columns of such a probe.
pub(super) const COLUMNS: &[&str] = &[
    "time (s)",
    "volume (m^3)",
    "kinetic energy (J)",
    "potential energy (J)",
    "momentum x (N s)",
    "momentum y (N s)",
    "momentum z (N s)",
];

/// The columns of a probe of the energy balance: the time, and the terms of
/// [`EnergyBalance`](crate::monitor::EnergyBalance).
pub(super) const BALANCE: &[&str] = &[
    "time (s)",
    "kinetic energy (J)",
    "potential energy (J)",
    "elastic energy (J)",
    "work of bodies (J)",
    "work of shaking (J)",
    "emitted energy (J)",
    "removed energy (J)",
    "dissipated energy (J)",
];

/// The probes of this kind of a scene.
#[derive(Clone, Debug)]
pub(crate) struct FluidProbes {
    /// Index among the probes of the scene, and the corners of the box in m.
    boxes: Vec<(usize, [DVec3; 2])>,
    /// Indices of the probes of the energy balance.
    balances: Vec<usize>,
    /// Volume of a particle in m^3, and its mass in kg.
    volume: f64,
    mass: f64,
    gravity: DVec3,
}

impl FluidProbes {
    pub(crate) fn of(scene: &Scene) -> Self {
        let boxes = scene.probes.iter().enumerate().filter_map(|(number, probe)| match probe.quantity {
            Quantity::Fluid { min, max } => Some((number, [min.as_dvec3(), max.as_dvec3()])),
            _ => None,
        });
        let volume = f64::from(scene.fluid.particle_spacing).powi(3);
        Self {
            boxes: boxes.collect(),
            balances: (0..scene.probes.len())
                .filter(|&k| scene.probes[k].quantity == Quantity::Energy)
                .collect(),
            volume,
            mass: scene.fluid.particle_mass(),
            gravity: scene.gravity.as_dvec3(),
        }
    }

    /// Appends a row for this time to each of the probes. `balance` are the terms of the energy balance.
    pub(crate) fn read(&self, rows: &mut [ProbeRows], time: f64, particles: &Particles, balance: &[f64]) {
        for &number in &self.balances {
            if let Some(rows) = rows.get_mut(number) {
                rows.push(std::iter::once(time).chain(balance.iter().copied()).collect());
            }
        }
        for &(number, corners) in &self.boxes {
            if let Some(rows) = rows.get_mut(number) {
                rows.push(self.row(corners, time, particles));
            }
        }
    }

    fn row(&self, [min, max]: [DVec3; 2], time: f64, particles: &Particles) -> Vec<f64> {
        let (mut count, mut squares, mut depth, mut velocities) = (0.0, 0.0, 0.0, DVec3::ZERO);
        for (&x, &v) in particles.positions.iter().zip(&particles.velocities) {
            let (x, v) = (DVec3::from(x.map(f64::from)), DVec3::from(v.map(f64::from)));
            if x.cmpge(min).all() && x.cmple(max).all() {
                count += 1.0;
                squares += v.length_squared();
                depth += self.gravity.dot(x);
                velocities += v;
            }
        }
        let momentum = self.mass * velocities;
        let energies = [0.5 * self.mass * squares, -self.mass * depth];
        vec![time, count * self.volume, energies[0], energies[1], momentum.x, momentum.y, momentum.z]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_particles_in_the_box_contribute_to_the_sums() {
        let probes = FluidProbes {
            boxes: Vec::new(),
            balances: Vec::new(),
            volume: 0.001,
            mass: 2.0,
            gravity: DVec3::new(0.0, -10.0, 0.0),
        };
        let particles = Particles::from_positions(vec![[0.0, 1.0, 0.0], [0.5, 3.0, 0.0], [9.0, 5.0, 0.0]])
            .with_velocities(vec![[1.0, 0.0, 0.0], [0.0, -2.0, 3.0], [100.0; 3]]);
        let all = [DVec3::NEG_INFINITY, DVec3::INFINITY];
        let row = probes.row([DVec3::ZERO, DVec3::ONE * 4.0], 0.5, &particles);
        assert_eq!(row, [0.5, 0.002, 14.0, 80.0, 2.0, -4.0, 6.0]);
        assert_eq!(row.len(), COLUMNS.len());
        assert_eq!(probes.row(all, 0.5, &particles)[3], 180.0);
    }
}
