//! Non-blocking transfers from the device to the host.

use std::marker::PhantomData;
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

use bytemuck::Pod;

use crate::{Gpu, GpuElement, GpuError, block_on};

/// A pending transfer: see [`Executor::request`](crate::Executor::request).
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

pub(super) fn mapping<T>(mapping: Mapping) -> Readback<T> {
    Readback { state: State::Mapping(mapping), element: PhantomData }
}

impl<T: GpuElement> Readback<T> {
    /// True if [`wait`](Self::wait) would return without waiting.
    ///
    /// # Errors
    /// If the device was lost.
    pub fn is_ready(&self) -> Result<bool, GpuError> {
        match &self.state {
            State::Mapping(mapping) => mapping.is_ready(),
            State::Ready(_) => Ok(true),
        }
    }

    /// Waits for the data, but not for work submitted after the request.
    ///
    /// # Errors
    /// If the device was lost.
    ///
    /// # Panics
    /// On a web page, which cannot wait, if the data has not arrived: use [`take`](Self::take).
    pub fn wait(self) -> Result<Vec<T>, GpuError> {
        block_on(self.take())
    }

    /// The data, once it has arrived. Outside a web page this future blocks when it is polled, and is then ready.
    ///
    /// # Errors
    /// If the device was lost.
    pub async fn take(self) -> Result<Vec<T>, GpuError> {
        match self.state {
            State::Ready(bytes) => Ok(bytemuck::pod_collect_to_vec(&bytes)),
            State::Mapping(mapping) => mapping.take().await,
        }
    }
}

impl Gpu {
    /// The content of a buffer with [`wgpu::BufferUsages::MAP_READ`] that a submission fills, once it is complete.
    ///
    /// # Errors
    /// [`GpuError::DeviceLost`].
    pub async fn read_back(
        self: &Arc<Self>,
        staging: wgpu::Buffer,
        submission: wgpu::SubmissionIndex,
    ) -> Result<Vec<u8>, GpuError> {
        Mapping::new(self, staging, submission).take().await
    }
}

const PENDING: u8 = 0;
const MAPPED: u8 = 1;
const FAILED: u8 = 2;

/// A staging buffer that is being mapped.
pub(super) struct Mapping {
    gpu: Arc<Gpu>,
    staging: wgpu::Buffer,
    #[cfg(not(target_arch = "wasm32"))]
    submission: wgpu::SubmissionIndex,
    report: Arc<Report>,
}

/// The state of a mapping.
#[derive(Default)]
struct Report {
    status: AtomicU8,
    /// The waiting task: on a web page the browser calls back, and the state cannot be polled.
    #[cfg(target_arch = "wasm32")]
    waker: std::sync::Mutex<Option<std::task::Waker>>,
}

impl Report {
    fn status(&self) -> u8 {
        self.status.load(Ordering::Acquire)
    }

    fn make(&self, status: u8) {
        self.status.store(status, Ordering::Release);
        #[cfg(target_arch = "wasm32")]
        if let Some(waker) = self.waker.lock().ok().and_then(|mut waker| waker.take()) {
            waker.wake();
        }
    }
}

impl Mapping {
    /// Starts to map a staging buffer that a submission fills.
    pub fn new(gpu: &Arc<Gpu>, staging: wgpu::Buffer, submission: wgpu::SubmissionIndex) -> Self {
        let report = Arc::new(Report::default());
        let reporter = Arc::clone(&report);
        staging.map_async(wgpu::MapMode::Read, .., move |result| {
            reporter.make(if result.is_ok() { MAPPED } else { FAILED });
        });
        #[cfg(target_arch = "wasm32")]
        let _ = submission;
        Self {
            gpu: Arc::clone(gpu),
            staging,
            #[cfg(not(target_arch = "wasm32"))]
            submission,
            report,
        }
    }

    /// True once the content can be taken without waiting.
    pub fn is_ready(&self) -> Result<bool, GpuError> {
        self.gpu.poll()?;
        Ok(self.report.status() != PENDING)
    }

    /// The content, once the submission is complete.
    pub async fn take<T: Pod>(self) -> Result<Vec<T>, GpuError> {
        self.finish().await?;
        if self.report.status() != MAPPED {
            self.gpu.health("a read-back")?;
            return Err(lost());
        }
        let view = self.staging.get_mapped_range(..).map_err(|_| lost())?;
        Ok(bytemuck::pod_collect_to_vec(&view))
    }

    #[cfg(not(target_arch = "wasm32"))]
    async fn finish(&self) -> Result<(), GpuError> {
        if self.report.status() == PENDING {
            self.gpu.wait_for(Some(self.submission.clone()))?;
        }
        // Another thread that uses the device may have dequeued the callback without having run it yet.
        while self.report.status() == PENDING {
            self.gpu.poll()?;
            std::thread::yield_now();
        }
        Ok(())
    }

    #[cfg(target_arch = "wasm32")]
    async fn finish(&self) -> Result<(), GpuError> {
        std::future::poll_fn(|context| {
            if let Ok(mut waker) = self.report.waker.lock() {
                *waker = Some(context.waker().clone());
            }
            match self.report.status() {
                PENDING => std::task::Poll::Pending,
                _ => std::task::Poll::Ready(()),
            }
        })
        .await;
        Ok(())
    }
}

fn lost() -> GpuError {
    GpuError::DeviceLost { reason: "a read-back failed".into() }
}
