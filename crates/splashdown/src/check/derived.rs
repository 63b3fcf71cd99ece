//! The numbers that follow from a scene and its files.

use super::Built;
use crate::sample::Inventory;
use crate::scene::{Derived, Scene};

impl Derived {
    /// From a checked scene. Values that a hand-made scene may break (zero spacing, no blocks) give numbers
    /// that make no sense, but no panic.
    pub fn new(scene: &Scene) -> Self {
        let built = Built::of(scene);
        built.derived(scene, built.count(scene))
    }

    /// From a checked scene whose particles have been counted by [`inventory`](crate::inventory).
    pub fn with_inventory(scene: &Scene, inventory: &Inventory) -> Self {
        Built::of(scene).derived(scene, inventory.particles)
    }

    /// Everything but the numbers of particles, which are zero: those of meshes take time to count.
    pub(crate) fn without_particles(scene: &Scene) -> Self {
        Self::of(scene, &Built::of(scene).reaches(scene))
    }
}
