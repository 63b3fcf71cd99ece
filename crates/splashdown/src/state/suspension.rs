//! What a suspended step needs to continue.

use splashdown_gpu::{WgslModule, gpu_struct};

/// The WGSL side of [`Suspension`].
pub const WGSL: WgslModule = WgslModule { name: "sph/suspension", source: include_str!("suspension.wgsl") };

gpu_struct! {
    /// What a step loses when it is suspended, until it continues ([`passes::suspension`](crate::passes::suspension)).
    pub struct Suspension {
        /// Number of particles that are in cells.
        cell_particles: u32,
        /// Number of particles that are in cells or removed.
        all_particles: u32,
        /// Counts that the prefix sum of the cells adds up.
        scan_len: u32,
        /// Blocks of these counts.
        scan_blocks: u32,
        /// Number of suspensions since the simulation was created.
        count: u32,
    }
}
