//! A thin layer on [`wgpu`], independent of fluid simulation.
//!
//! Work is recorded once and executed in two ways:
//!
//! 1. A [`PassDesc`] declares one compute pass as data: its WGSL, its bindings with their types, and the Rust
//!    function that does the same work on a machine without a GPU. [`bindings!`] lists the bindings once; the WGSL, the
//!    CPU code and the recordings refer to them by name. The [gate](check::check) parses the WGSL with `naga` and
//!    compares it with the declaration, so that the two agree.
//! 2. A [`Recording`] is a list of commands (dispatches, copies, clears, bounded repetitions) over buffers, which a
//!    [`BufferSet`] finds by name.
//! 3. An [`Executor`] owns the buffers and runs recordings: on the GPU ([`GpuExecutor`]) or on the CPU
//!    ([`CpuExecutor`]), from equal input to comparable output.
//! 4. Three primitives are built on these and show how a pass is written: [`scan`], [`compact`] and [`sort`].
//!
//! The feature `roofline` adds measurements of the limits of a device.
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

// The macros refer to this crate by its name, in this crate as in others.
extern crate self as splashdown_gpu;

mod binding;
mod buffer;
pub mod check;
pub mod compact;
mod device;
mod element;
mod error;
mod exec;
mod host;
mod pass;
mod record;
#[cfg(feature = "roofline")]
pub mod roofline;
pub mod scan;
pub mod sort;
#[cfg(not(target_arch = "wasm32"))]
pub mod testing;
mod timer;
mod timing;
mod wait;
pub mod wgsl;

pub use binding::{Access, Binding, BindingType, Shape};
pub use buffer::{Buffer, BufferId, BufferSet};
pub use device::{AdapterReport, DeviceRequest, Gpu, MISSING_DRIVER_HINT, instance_flags, list_adapters};
pub use element::{Field, GpuElement, GpuMember, GpuStruct};
pub use error::GpuError;
pub use exec::{CpuExecutor, Executor, GpuExecutor, Readback, refused_passes};
pub use host::{Slot, as_atomic};
pub use pass::{CpuWork, PassDesc, Scratch};
pub use record::{Command, DispatchSize, Flag, Recording, Rounds, dispatch_groups};
pub use timer::PassTimer;
pub use timing::{PassTime, Timings};
pub use wait::block_on;
pub use wgsl::WgslModule;

/// Every pass of this crate, for the gate and the tests.
pub fn passes() -> Vec<&'static PassDesc> {
    let primitives = [&scan::PASSES[..], &compact::PASSES, &sort::PASSES];
    #[cfg(feature = "roofline")]
    let primitives = [&primitives[..], &[&roofline::PASSES]].concat();
    primitives.concat()
}

#[doc(hidden)]
pub use {bytemuck, glam};
