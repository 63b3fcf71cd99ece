//! Data on its way from the device to the host, without anybody waiting for it.

use std::marker::PhantomData;
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

use super::Executor;
use crate::{GpuElement, GpuError};

/// The answer to [`Executor::request`].
pub struct Readback<T> {
    state: State,
    element: PhantomData<fn() -> T>,
}

enum State {
    Ready(Vec<u8>),
    Mapping { staging: wgpu::Buffer, submission: wgpu::SubmissionIndex, status: Arc<AtomicU8> },
}

const PENDING: u8 = 0;
const MAPPED: u8 = 1;
const FAILED: u8 = 2;

pub(super) fn ready<T: GpuElement>(data: Vec<T>) -> Readback<T> {
    Readback { state: State::Ready(bytemuck::cast_slice(&data).to_vec()), element: PhantomData }
}

/// Starts to map a staging buffer that a submission fills.
pub(super) fn mapping<T>(staging: wgpu::Buffer, submission: wgpu::SubmissionIndex) -> Readback<T> {
    let status = Arc::new(AtomicU8::new(PENDING));
    let report = Arc::clone(&status);
    staging.map_async(wgpu::MapMode::Read, .., move |result| {
        report.store(if result.is_ok() { MAPPED } else { FAILED }, Ordering::Release);
    });
    Readback { state: State::Mapping { staging, submission, status }, element: PhantomData }
}

impl<T: GpuElement> Readback<T> {
    /// True once [`wait`](Self::wait) returns at once.
    ///
    /// # Errors
    /// If the device was lost.
    pub fn is_ready(&self, executor: &mut Executor) -> Result<bool, GpuError> {
        match (&self.state, executor) {
            (State::Mapping { status, .. }, Executor::Gpu(gpu)) => {
                gpu.poll()?;
                Ok(status.load(Ordering::Acquire) != PENDING)
            }
            _ => Ok(true),
        }
    }

    /// The data, waiting for it if need be, but not for work submitted after the request.
    ///
    /// # Errors
    /// If the device was lost.
    pub fn wait(self, executor: &mut Executor) -> Result<Vec<T>, GpuError> {
        match self.state {
            State::Ready(bytes) => Ok(bytemuck::pod_collect_to_vec(&bytes)),
            State::Mapping { staging, submission, status } => {
                if let (PENDING, Executor::Gpu(gpu)) = (status.load(Ordering::Acquire), executor) {
                    gpu.wait_for(Some(submission))?;
                }
                let lost = || GpuError::DeviceLost { reason: "a read-back failed".into() };
                if status.load(Ordering::Acquire) != MAPPED {
                    return Err(lost());
                }
                let view = staging.get_mapped_range(..).map_err(|_| lost())?;
                Ok(bytemuck::pod_collect_to_vec(&view))
            }
        }
    }
}
