//! The shared particle files: read, written, and read again.

mod common;

use splashdown_io::{Particles, npy, ply, write_particles};

#[test]
fn the_shared_particles_round_trip() {
    for name in ["particles/mid64k.npy", "particles/settled64k_t6.npy"] {
        let Some(path) = common::shared_data(name) else { continue };
        let positions = npy::read_positions(&path).unwrap();
        assert_eq!(positions.len(), 64_000);
        assert!(positions.iter().flatten().all(|value| value.is_finite()));

        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("particles.ply");
        let particles = Particles::from_positions(positions);
        write_particles(&file, &particles).unwrap();
        assert_eq!(ply::read_particles(&file).unwrap(), particles);
    }
}
