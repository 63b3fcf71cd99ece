//! Sums over a workgroup on the device. The CPU passes add the same groups of 64 particles.

use splashdown_gpu::WgslModule;

/// `sum_of_group`.
pub const WGSL: WgslModule = WgslModule { name: "sph/group_sum", source: include_str!("group_sum.wgsl") };
