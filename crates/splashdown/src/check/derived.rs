//! Constructors of [`Derived`] that need the scene's files.

use super::Built;
use crate::sample::Inventory;
use crate::scene::{Derived, Scene};

impl Derived {
    /// From a checked scene. Invalid values of a scene built in code (zero spacing, no blocks) give
    /// meaningless numbers but never panic.
    pub fn new(scene: &Scene) -> Self {
        let built = Built::of(scene);
        built.derived(scene, built.count(scene))
    }

    /// From a checked scene whose particles have been counted by [`inventory`](crate::inventory).
    pub fn with_inventory(scene: &Scene, inventory: &Inventory) -> Self {
        Built::of(scene).derived(scene, inventory.particles)
    }

    /// All quantities except the numbers of particles, which are zero: counting the particles of meshes takes
    /// time.
    pub(crate) fn without_particles(scene: &Scene) -> Self {
        Self::of(scene, &Built::of(scene).reaches(scene))
    }
}
