//! The two executors of recordings: GPU and CPU.

mod cpu;
mod gpu;
mod pipeline;
mod readback;
mod table;

pub use cpu::CpuExecutor;
pub use gpu::GpuExecutor;
pub use readback::Readback;

use std::marker::PhantomData;

use self::table::{Kind, Meta};
use crate::{Buffer, BufferId, GpuElement, GpuError, GpuStruct, Recording, Timings};

/// Owns buffers and runs [`Recording`]s over them, on a GPU or on the CPU.
///
/// The same recording runs on both; see the crate's page for an example.
pub enum Executor {
    /// In host memory, on the CPU cores.
    Cpu(CpuExecutor),
    /// On a device.
    Gpu(GpuExecutor),
}

impl From<CpuExecutor> for Executor {
    fn from(executor: CpuExecutor) -> Self {
        Self::Cpu(executor)
    }
}

impl From<GpuExecutor> for Executor {
    fn from(executor: GpuExecutor) -> Self {
        Self::Gpu(executor)
    }
}

macro_rules! either {
    ($self:expr, $executor:ident => $body:expr) => {
        match $self {
            Executor::Cpu($executor) => $body,
            Executor::Gpu($executor) => $body,
        }
    };
}

/// Compiles passes on a device and returns the error of each that it refuses: drivers differ.
pub async fn refused_passes(gpu: &crate::Gpu, passes: &[&'static crate::PassDesc]) -> Vec<GpuError> {
    let mut refused = Vec::new();
    for pass in passes {
        refused.extend(pipeline::Pipeline::try_out(gpu, pass).await.err());
    }
    refused
}

impl Executor {
    /// An executor without buffers on the same device. It takes over the compiled passes; this executor compiles
    /// again the passes that it still runs.
    pub fn successor(&mut self) -> Self {
        match self {
            Self::Cpu(_) => Self::Cpu(CpuExecutor::new()),
            Self::Gpu(e) => Self::Gpu(e.successor()),
        }
    }

    /// Creates a storage buffer of `len` elements, all bytes zero (all bits one after [`poison`](Self::poison)).
    ///
    /// # Errors
    /// [`GpuError::TooLarge`], [`GpuError::OutOfMemory`].
    pub fn create<T: GpuElement>(&mut self, label: &'static str, len: usize) -> Result<Buffer<T>, GpuError> {
        let id = either!(self, e => e.create(Meta::new::<T>(label, len, Kind::Storage))?);
        Ok(Buffer { id, len: len as u32, element: PhantomData })
    }

    /// Creates a storage buffer with this content.
    ///
    /// # Errors
    /// As [`create`](Self::create).
    pub fn create_from<T: GpuElement>(
        &mut self,
        label: &'static str,
        data: &[T],
    ) -> Result<Buffer<T>, GpuError> {
        let buffer = self.create(label, data.len())?;
        self.write(buffer, data)?;
        Ok(buffer)
    }

    /// Creates a storage buffer with this content that passes may also bind as a uniform; at most 64 KiB.
    ///
    /// # Errors
    /// As [`create`](Self::create).
    pub fn create_small<T: GpuElement>(
        &mut self,
        label: &'static str,
        data: &[T],
    ) -> Result<Buffer<T>, GpuError> {
        let id = either!(self, e => e.create(Meta::new::<T>(label, data.len(), Kind::Either))?);
        let buffer = Buffer { id, len: data.len() as u32, element: PhantomData };
        self.write(buffer, data)?;
        Ok(buffer)
    }

    /// Creates a uniform buffer with this content.
    ///
    /// # Errors
    /// As [`create`](Self::create).
    pub fn create_uniform<T: GpuStruct>(
        &mut self,
        label: &'static str,
        value: &T,
    ) -> Result<Buffer<T>, GpuError> {
        let id = either!(self, e => e.create(Meta::new::<T>(label, 1, Kind::Uniform))?);
        let buffer = Buffer { id, len: 1, element: PhantomData };
        self.write(buffer, std::slice::from_ref(value))?;
        Ok(buffer)
    }

    /// Changes the length of a buffer. The content is lost; handles and recordings of the buffer stay valid.
    ///
    /// # Errors
    /// As [`create`](Self::create), and [`GpuError::NoSuchBuffer`].
    pub fn resize<T: GpuElement>(&mut self, buffer: &mut Buffer<T>, len: usize) -> Result<(), GpuError> {
        let meta = Meta { len, ..*self.table().get(buffer.id)? };
        either!(self, e => e.resize(buffer.id, meta)?);
        buffer.len = len as u32;
        Ok(())
    }

    /// Frees buffers: one handle in an array, or the [ids](crate::BufferSet::ids) of a set. Later uses of their handles,
    /// including those in recordings, are errors that name the buffer.
    ///
    /// # Errors
    /// [`GpuError::NoSuchBuffer`] if one of them was freed before or belongs to another executor; then none is freed.
    pub fn free<I: Into<BufferId>>(&mut self, buffers: impl IntoIterator<Item = I>) -> Result<(), GpuError> {
        let mut ids: Vec<BufferId> = Vec::new();
        for id in buffers.into_iter().map(Into::into) {
            self.table().get(id)?;
            if !ids.contains(&id) {
                ids.push(id);
            }
        }
        either!(self, e => e.free(&ids));
        Ok(())
    }

    fn table(&self) -> &table::Table {
        either!(self, e => e.table_ref())
    }

    /// The current number of elements; a handle copied before a [`resize`](Self::resize) has the former one.
    fn len<T>(&self, buffer: Buffer<T>) -> Result<usize, GpuError> {
        Ok(self.table().get(buffer.id)?.len)
    }

    /// Overwrites the beginning of a buffer.
    ///
    /// # Errors
    /// [`GpuError::NoSuchBuffer`], or if the device was lost.
    ///
    /// # Panics
    /// If `data` is longer than the buffer.
    pub fn write<T: GpuElement>(&mut self, buffer: Buffer<T>, data: &[T]) -> Result<(), GpuError> {
        let len = self.len(buffer)?;
        assert!(data.len() <= len, "{} elements do not fit into the {len} of {buffer:?}", data.len());
        either!(self, e => e.write(buffer.id, bytemuck::cast_slice(data)))
    }

    /// Reads a whole buffer after waiting for all earlier work. For set-up, tests and the end of a frame.
    ///
    /// # Errors
    /// [`GpuError::NoSuchBuffer`], or if the device was lost or refused earlier work.
    pub fn read<T: GpuElement>(&mut self, buffer: Buffer<T>) -> Result<Vec<T>, GpuError> {
        self.read_first(buffer, self.len(buffer)?)
    }

    /// Reads the first `len` elements after waiting for all earlier work.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn read_first<T: GpuElement>(&mut self, buffer: Buffer<T>, len: usize) -> Result<Vec<T>, GpuError> {
        self.request(buffer, len)?.wait()
    }

    /// [`read`](Self::read) where blocking is not possible, as on a web page.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub async fn fetch<T: GpuElement>(&mut self, buffer: Buffer<T>) -> Result<Vec<T>, GpuError> {
        self.fetch_first(buffer, self.len(buffer)?).await
    }

    /// [`read_first`](Self::read_first) where blocking is not possible, as on a web page.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub async fn fetch_first<T: GpuElement>(
        &mut self,
        buffer: Buffer<T>,
        len: usize,
    ) -> Result<Vec<T>, GpuError> {
        self.request(buffer, len)?.take().await
    }

    /// Requests the first `len` elements after all work submitted so far, without waiting.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    ///
    /// # Panics
    /// If the buffer has fewer elements.
    pub fn request<T: GpuElement>(&mut self, buffer: Buffer<T>, len: usize) -> Result<Readback<T>, GpuError> {
        let has = self.len(buffer)?;
        assert!(len <= has, "{len} elements are more than the {has} of {buffer:?}");
        either!(self, e => e.request(buffer.id, len))
    }

    /// Runs a recording: immediately on the CPU, as one submission on a GPU.
    ///
    /// # Errors
    /// [`GpuError::BadBinding`] and [`GpuError::BadCommand`] if a command and its buffers do not fit: then nothing has
    /// run. [`GpuError::BadShader`] if the device does not compile a pass. [`GpuError::DeviceLost`].
    pub fn run(&mut self, recording: &Recording) -> Result<(), GpuError> {
        either!(self, e => e.run(recording))
    }

    /// Waits until all submitted work is complete.
    ///
    /// # Errors
    /// If the device was lost or refused earlier work.
    pub fn wait(&mut self) -> Result<(), GpuError> {
        match self {
            Self::Cpu(_) => Ok(()),
            Self::Gpu(e) => e.wait(),
        }
    }

    /// From now on every bit of new buffers is one (NaN, or 4,294,967,295) instead of zero. For tests: it exposes
    /// passes that rely on memory that was never written.
    pub fn poison(&mut self) {
        either!(self, e => e.table().poison = true);
    }

    /// From now on dispatches are timed: all of them on the CPU, the first 2,048 of each recording on a GPU, where each
    /// dispatch then has a separate compute pass.
    ///
    /// Returns false if the device has no timestamps.
    pub fn enable_timing(&mut self) -> bool {
        either!(self, e => e.enable_timing())
    }

    /// From now on dispatches are not timed.
    pub fn disable_timing(&mut self) {
        either!(self, e => e.disable_timing());
    }

    /// The times since the last call.
    pub fn take_timings(&mut self) -> Timings {
        either!(self, e => e.take_timings())
    }

    /// Bytes in buffers that have not been freed.
    pub fn bytes(&self) -> u64 {
        self.table().bytes()
    }

    /// The largest number of bytes one buffer may have.
    pub fn largest_buffer(&self) -> u64 {
        match self {
            Self::Cpu(_) => u64::from(u32::MAX),
            Self::Gpu(e) => e.gpu().largest_buffer(),
        }
    }

    /// The device, if this is not the CPU.
    pub fn gpu(&self) -> Option<&std::sync::Arc<crate::Gpu>> {
        match self {
            Self::Cpu(_) => None,
            Self::Gpu(e) => Some(e.gpu()),
        }
    }

    /// The wgpu buffer of an identifier, for drawing without a copy; `None` on the CPU and for a freed buffer.
    pub fn wgpu_buffer(&self, id: BufferId) -> Option<&wgpu::Buffer> {
        match self {
            Self::Cpu(_) => None,
            Self::Gpu(e) => e.wgpu_buffer(id),
        }
    }

    /// Runs a closure over a buffer in host memory without copying it; `None` on a GPU and for a freed buffer.
    pub fn with_host<T: GpuElement, R>(&self, buffer: Buffer<T>, f: impl FnOnce(&[T]) -> R) -> Option<R> {
        match self {
            Self::Cpu(e) => e.table_ref().find(buffer.id).map(|_| f(e.view(buffer.id))),
            Self::Gpu(_) => None,
        }
    }
}
