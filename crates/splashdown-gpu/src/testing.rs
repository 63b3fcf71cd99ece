//! What the tests of this and other crates share: the executors there are, and skipping that is loud.
//!
//! Not for use outside of tests: it panics.

use std::sync::{Arc, OnceLock};

use crate::{CpuExecutor, DeviceRequest, Executor, Gpu, GpuExecutor};

/// The device that all tests of a process share, opened once: software Vulkan where there is one, so that all
/// machines test alike, else any GPU.
///
/// Where there is none it prints `SKIPPED` with the test's name and the reason.
///
/// # Panics
/// Where there is none and the environment has `CI=true`: there nothing may be skipped for want of a driver.
pub fn gpu_or_skip(test_name: &str) -> Option<Arc<Gpu>> {
    static GPU: OnceLock<Result<Arc<Gpu>, String>> = OnceLock::new();
    let gpu = GPU.get_or_init(|| {
        Gpu::open(&DeviceRequest::Software)
            .or_else(|_| Gpu::open(&DeviceRequest::Auto))
            .map(Arc::new)
            .map_err(|error| error.to_string())
    });
    match gpu {
        Ok(gpu) => Some(Arc::clone(gpu)),
        Err(reason) => {
            assert!(
                std::env::var("CI").as_deref() != Ok("true"),
                "{test_name}: CI=true forbids skipping, and {reason}"
            );
            eprintln!("SKIPPED: {test_name}: {reason}");
            None
        }
    }
}

/// The CPU executor and, where there is a device, a GPU executor: fresh, with names for messages. New buffers are
/// poisoned.
///
/// # Panics
/// As [`gpu_or_skip`].
pub fn executors(test_name: &str) -> Vec<(&'static str, Executor)> {
    let mut executors = vec![("CPU", Executor::from(CpuExecutor::new()))];
    if let Some(gpu) = gpu_or_skip(test_name) {
        executors.push(("GPU", Executor::from(GpuExecutor::new(gpu))));
    }
    for (_, executor) in &mut executors {
        executor.poison();
    }
    executors
}
