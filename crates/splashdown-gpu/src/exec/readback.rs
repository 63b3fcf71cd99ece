//! Data on its way from the device to the host, without anybody waiting for it.

use std::marker::PhantomData;
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

use bytemuck::Pod;

use super::{Executor, GpuExecutor};
use crate::{GpuElement, GpuError};

/// The answer to [`Executor::request`].
pub struct Readback<T> {
    state: State,
    element: PhantomData<fn() -> T>,
}

enum State {
    Ready(Vec<u8>),
    Mapping(Mapping),
}

pub(super) fn ready<T: GpuElement>(data: Vec<T>) -> Readback<T> {
    Readback { state: State::Ready(bytemuck::cast_slice(&data).to_vec()), element: PhantomData }
}

pub(super) fn mapping<T>(staging: wgpu::Buffer, submission: wgpu::SubmissionIndex) -> Readback<T> {
    Readback { state: State::Mapping(Mapping::new(staging, submission)), element: PhantomData }
}

impl<T: GpuElement> Readback<T> {
    /// True once [`wait`](Self::wait) returns at once.
    ///
    /// # Errors
    /// If the device was lost.
    pub fn is_ready(&self, executor: &mut Executor) -> Result<bool, GpuError> {
        match (&self.state, executor) {
            (State::Mapping(mapping), Executor::Gpu(gpu)) => {
                gpu.poll()?;
                Ok(mapping.status() != PENDING)
            }
            _ => Ok(true),
        }
    }

    /// The data, waiting for it if need be, but not for work submitted after the request.
    ///
    /// # Errors
    /// If the device was lost.
    pub fn wait(self, executor: &mut Executor) -> Result<Vec<T>, GpuError> {
        match (self.state, executor) {
            (State::Ready(bytes), _) => Ok(bytemuck::pod_collect_to_vec(&bytes)),
            (State::Mapping(mapping), Executor::Gpu(gpu)) => mapping.wait(gpu),
            (State::Mapping(_), Executor::Cpu(_)) => Err(lost()),
        }
    }
}

const PENDING: u8 = 0;
const MAPPED: u8 = 1;
const FAILED: u8 = 2;

/// A staging buffer on its way to the host.
pub(super) struct Mapping {
    staging: wgpu::Buffer,
    submission: wgpu::SubmissionIndex,
    status: Arc<AtomicU8>,
}

impl Mapping {
    /// Starts to map a staging buffer that a submission fills.
    pub fn new(staging: wgpu::Buffer, submission: wgpu::SubmissionIndex) -> Self {
        let status = Arc::new(AtomicU8::new(PENDING));
        let report = Arc::clone(&status);
        staging.map_async(wgpu::MapMode::Read, .., move |result| {
            report.store(if result.is_ok() { MAPPED } else { FAILED }, Ordering::Release);
        });
        Self { staging, submission, status }
    }

    fn status(&self) -> u8 {
        self.status.load(Ordering::Acquire)
    }

    /// The content, as soon as the submission is done.
    pub fn wait<T: Pod>(self, gpu: &mut GpuExecutor) -> Result<Vec<T>, GpuError> {
        if self.status() == PENDING {
            gpu.wait_for(Some(self.submission.clone()))?;
        }
        // Another thread that uses the device may have taken the report off its queue without having made it yet.
        while self.status() == PENDING {
            gpu.poll()?;
            std::thread::yield_now();
        }
        if self.status() != MAPPED {
            return Err(lost());
        }
        let view = self.staging.get_mapped_range(..).map_err(|_| lost())?;
        Ok(bytemuck::pod_collect_to_vec(&view))
    }
}

fn lost() -> GpuError {
    GpuError::DeviceLost { reason: "a read-back failed".into() }
}
