//! A thin layer on [`wgpu`] that knows nothing of fluids.
//!
//! Work is written down once and executed in two ways:
//!
//! 1. A [`PassDesc`] declares one compute pass as data: its WGSL, its bindings with their types, and the Rust
//!    function that does the same work on a machine without a GPU. The [gate](check::check) parses the WGSL with
//!    `naga` and compares it with the declaration, so that the two cannot drift apart unnoticed.
//! 2. A [`Recording`] is a list of commands (dispatches, copies, clears, bounded repeats) over buffers.
//! 3. An [`Executor`] owns the buffers and runs recordings: on the GPU ([`GpuExecutor`]) or on the CPU
//!    ([`CpuExecutor`]), from equal input to comparable output.
//! 4. On these stand four primitives, each a folder that shows how a pass is written: [`scan`], [`reduce`],
//!    [`compact`] and [`sort`].
//!
//! ```
//! use splashdown_gpu::{CpuExecutor, Executor, Recording, scan};
//! let mut executor = Executor::from(CpuExecutor::new());
//! let counts = executor.create_from("counts", &[3_u32, 0, 5, 2])?;
//! let starts = executor.create::<u32>("starts", 5)?;
//! let scan = scan::Scan::new(&mut executor, 4)?;
//! let mut recording = Recording::new("example");
//! scan.record(&mut recording, counts, starts);
//! executor.run(&recording)?;
//! assert_eq!(executor.read(starts)?, [0, 3, 3, 8, 10]);
//! # Ok::<(), splashdown_gpu::GpuError>(())
//! ```

// `gpu_struct!` names this crate by its own name, here as everywhere.
extern crate self as splashdown_gpu;

pub mod check;
pub mod compact;
mod device;
mod element;
mod error;
mod exec;
pub mod floors;
mod host;
mod pass;
mod record;
pub mod reduce;
pub mod scan;
pub mod sort;
#[cfg(not(target_arch = "wasm32"))]
pub mod testing;
mod timing;
mod wait;
pub mod wgsl;

pub use device::{AdapterReport, DeviceRequest, Gpu, MISSING_DRIVER_HINT, list_adapters};
pub use element::{Field, GpuElement, GpuMember, GpuStruct};
pub use error::GpuError;
pub use exec::{CpuExecutor, Executor, GpuExecutor, Readback, refused_passes};
pub use host::{Slot, as_atomic};
pub use pass::{Access, Binding, CpuWork, PassDesc, read, uniform, uniform_array, write};
pub use record::{Buffer, BufferId, Command, Flag, Grid, Recording, dispatch_groups};
pub use timing::{PassTime, Timings};
pub use wait::block_on;
pub use wgsl::WgslModule;

/// Every pass of this crate, for the gate and the tests.
pub fn passes() -> Vec<&'static PassDesc> {
    [&scan::PASSES[..], &reduce::PASSES, &compact::PASSES, &sort::PASSES, &floors::PASSES].concat()
}

#[doc(hidden)]
pub use {bytemuck, glam};
