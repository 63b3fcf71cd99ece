//! How much of the domain the fluid fills at the start.

use super::{Scene, lattice};

/// The part of the volume of a closed domain from which it counts as full.
const FULL: f64 = 0.99;

impl Scene {
    /// True if all sides of the domain are closed.
    pub(crate) fn is_closed(&self) -> bool {
        self.domain.closed.as_flattened().iter().all(|&closed| closed)
    }

    /// The numbers of initial particles and of particles for which the domain has room. Only the particles of blocks are
    /// counted, with those that bodies displace: filling meshes takes time.
    pub(crate) fn filling(&self) -> [f64; 2] {
        let particle = f64::from(self.fluid.particle_spacing).powi(3);
        let room = (self.domain.max - self.domain.min).as_dvec3().element_product() / particle;
        [lattice::count(&self.domain, &self.fluid) as f64, room]
    }

    /// True if blocks of fluid fill at least 99 % of the closed domain at the start, and nothing adds or removes fluid. Such
    /// fluid has no free surface. Fluid from meshes and files is not counted.
    pub(crate) fn is_full(&self) -> bool {
        if !self.is_closed() || !self.emitters.is_empty() || !self.sinks.is_empty() {
            return false;
        }
        let [initial, room] = self.filling();
        initial >= FULL * room
    }
}

#[cfg(test)]
mod tests {
    use crate::Scene;

    #[test]
    fn a_closed_domain_without_air_emitters_and_sinks_is_full() {
        let is_full = |height: f32, more: &str| {
            let text = format!(
                "[scene]\nname = \"full\"\nduration = 1\n[domain]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n{more}\n[fluid]\n\
                 particle_spacing = 0.05\n[[fluid.block]]\nposition = [0, 0, 0]\nsize = [1, {height}, 1]\n"
            );
            Scene::parse(&text, "full.toml").unwrap_or_else(|errors| panic!("{errors}")).is_full()
        };
        assert!(is_full(1.0, ""));
        assert!(!is_full(0.95, ""), "a layer of air");
        assert!(!is_full(1.0, "open = [\"y_max\"]"), "an open side");
        let sink = "[[sink]]\nname = \"drain\"\nmin = [0, 0, 0]\nmax = [0.1, 0.1, 0.1]\n";
        assert!(!is_full(1.0, sink), "a sink");
    }
}
