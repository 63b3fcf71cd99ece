//! Runs recordings on a device, each as one submission; bind groups and pipelines are created once.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::sync::Arc;

use super::pipeline::Pipeline;
use super::readback::Mapping;
use super::table::{Kind, Meta, Table};
use super::{Readback, readback};
use crate::{
    BufferId, Command, DispatchSize, Gpu, GpuElement, GpuError, PassDesc, PassTimer, Recording, Timings,
    dispatch_groups,
};

/// Largest number of timed dispatches per submission; further ones are not timed.
const TIMED_DISPATCHES: u32 = 2048;

/// Buffers on a device; runs the WGSL of the passes.
pub struct GpuExecutor {
    gpu: Arc<Gpu>,
    /// By slot; `None` for a freed buffer.
    buffers: Vec<Option<wgpu::Buffer>>,
    table: Table,
    pipelines: HashMap<usize, Pipeline>,
    timer: Option<Timer>,
}

struct Timer {
    passes: PassTimer,
    timings: Timings,
}

/// The address of a declaration identifies its pipeline: declarations are statics.
fn key(pass: &'static PassDesc) -> usize {
    std::ptr::from_ref(pass) as usize
}

/// A buffer that exists according to the table.
fn live(buffers: &[Option<wgpu::Buffer>], id: BufferId) -> &wgpu::Buffer {
    buffers[id.slot as usize].as_ref().expect("the table has checked the buffers")
}

impl GpuExecutor {
    /// An executor without buffers.
    pub fn new(gpu: Arc<Gpu>) -> Self {
        Self { gpu, buffers: Vec::new(), table: Table::default(), pipelines: HashMap::new(), timer: None }
    }

    pub(super) fn successor(&mut self) -> Self {
        let mut pipelines = std::mem::take(&mut self.pipelines);
        pipelines.values_mut().for_each(|pipeline| pipeline.bind_groups.clear());
        Self { pipelines, ..Self::new(Arc::clone(&self.gpu)) }
    }

    pub(super) fn gpu(&self) -> &Arc<Gpu> {
        &self.gpu
    }

    pub(super) fn wgpu_buffer(&self, id: BufferId) -> Option<&wgpu::Buffer> {
        self.table.find(id)?;
        self.buffers[id.slot as usize].as_ref()
    }

    fn buffer(&self, id: BufferId) -> &wgpu::Buffer {
        live(&self.buffers, id)
    }

    pub(super) fn table(&mut self) -> &mut Table {
        &mut self.table
    }

    pub(super) fn table_ref(&self) -> &Table {
        &self.table
    }

    pub(super) fn create(&mut self, meta: Meta) -> Result<BufferId, GpuError> {
        let buffer = self.allocate(&meta)?;
        let id = self.table.add(meta);
        self.buffers.resize(self.buffers.len().max(id.slot as usize + 1), None);
        self.buffers[id.slot as usize] = Some(buffer);
        Ok(id)
    }

    /// The device releases the memory when submitted work no longer uses it.
    pub(super) fn free(&mut self, ids: &[BufferId]) {
        for id in ids {
            self.table.remove(*id);
            self.buffers[id.slot as usize] = None;
        }
        self.drop_bind_groups(ids);
    }

    pub(super) fn resize(&mut self, id: BufferId, meta: Meta) -> Result<(), GpuError> {
        self.buffers[id.slot as usize] = Some(self.allocate(&meta)?);
        self.table.replace(id, meta);
        self.drop_bind_groups(&[id]);
        Ok(())
    }

    fn drop_bind_groups(&mut self, ids: &[BufferId]) {
        for pipeline in self.pipelines.values_mut() {
            pipeline.bind_groups.retain(|bound, _| !bound.iter().any(|id| ids.contains(id)));
        }
    }

    fn allocate(&self, meta: &Meta) -> Result<wgpu::Buffer, GpuError> {
        use wgpu::BufferUsages as Use;
        meta.check_len()?;
        let bytes = meta.bytes();
        let limit = self.gpu.largest_buffer();
        if bytes > limit {
            return Err(GpuError::TooLarge {
                label: meta.label.into(),
                len: meta.len as u64,
                bytes,
                limit,
                fits: limit / meta.size as u64,
            });
        }
        let kind = match meta.kind {
            Kind::Uniform => Use::UNIFORM,
            Kind::Storage => Use::STORAGE | Use::INDIRECT | Use::VERTEX | Use::INDEX,
            Kind::Either => Use::STORAGE | Use::UNIFORM,
        };
        let (buffer, error) = self.gpu.scoped(wgpu::ErrorFilter::OutOfMemory, |device| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(meta.label),
                size: bytes.next_multiple_of(4),
                usage: kind | Use::COPY_SRC | Use::COPY_DST,
                mapped_at_creation: false,
            })
        });
        if error.is_some() {
            return Err(GpuError::OutOfMemory { label: meta.label.into(), bytes });
        }
        if self.table.poison && meta.kind != Kind::Uniform {
            self.gpu.queue.write_buffer(
                &buffer,
                0,
                &vec![self.table.fill(); bytes.next_multiple_of(4) as usize],
            );
        }
        Ok(buffer)
    }

    pub(super) fn write(&mut self, id: BufferId, bytes: &[u8]) -> Result<(), GpuError> {
        self.gpu.queue.write_buffer(self.buffer(id), 0, bytes);
        self.gpu.health("an upload")
    }

    pub(super) fn request<T: GpuElement>(
        &mut self,
        id: BufferId,
        len: usize,
    ) -> Result<Readback<T>, GpuError> {
        if len == 0 {
            return Ok(readback::ready(Vec::new()));
        }
        let bytes = (len * size_of::<T>()) as u64;
        let staging = self.gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("read-back"),
            size: bytes,
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(self.buffer(id), 0, &staging, 0, bytes);
        let submission = self.gpu.queue.submit([encoder.finish()]);
        self.gpu.health("a read-back")?;
        Ok(readback::mapping(Mapping::new(&self.gpu, staging, submission)))
    }

    pub(super) fn wait(&mut self) -> Result<(), GpuError> {
        self.gpu.wait_for(None)
    }

    pub(super) fn enable_timing(&mut self) -> bool {
        if self.timer.is_none() {
            let passes = PassTimer::new(&self.gpu.device, &self.gpu.queue, TIMED_DISPATCHES, usize::MAX);
            self.timer = passes.map(|passes| Timer { passes, timings: Timings::default() });
        }
        self.timer.is_some()
    }

    pub(super) fn disable_timing(&mut self) {
        self.timer = None;
    }

    /// On a web page, which cannot block, only the times that have arrived.
    pub(super) fn take_timings(&mut self) -> Timings {
        let Some(timer) = &mut self.timer else { return Timings::default() };
        timer.collect();
        if cfg!(not(target_arch = "wasm32")) && timer.passes.is_pending() {
            // The next call to a lost device reports the error.
            let mut healthy = self.gpu.wait_for(None);
            timer.collect();
            // Another thread that uses the device may have to finish the mapping.
            while timer.passes.is_pending() && healthy.is_ok() {
                std::thread::yield_now();
                healthy = self.gpu.poll();
                timer.collect();
            }
        }
        std::mem::take(&mut timer.timings)
    }

    pub(super) fn run(&mut self, recording: &Recording) -> Result<(), GpuError> {
        self.table.check(recording)?;
        self.prepare(&recording.commands)?;
        let mut encoder = self
            .gpu
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some(&recording.label) });
        let mut timer = self.timer.take();
        if let Some(timer) = &mut timer {
            timer.collect();
            timer.passes.begin();
        }
        let mut target = Target {
            encoder: &mut encoder,
            pass: None,
            timer: timer.as_mut().map(|timer| &mut timer.passes),
        };
        self.encode(&recording.commands, &mut target);
        drop(target);
        if let Some(timer) = &mut timer {
            timer.passes.end(&mut encoder);
        }
        self.timer = timer;
        self.gpu.queue.submit([encoder.finish()]);
        self.gpu.health(&recording.label)
    }

    /// Creates missing pipelines and bind groups.
    fn prepare(&mut self, commands: &[Command]) -> Result<(), GpuError> {
        for command in commands {
            match command {
                Command::Dispatch { pass, buffers, .. } => {
                    let pipeline = match self.pipelines.entry(key(pass)) {
                        Entry::Occupied(entry) => entry.into_mut(),
                        Entry::Vacant(entry) => entry.insert(Pipeline::build(&self.gpu, pass)?),
                    };
                    if pipeline.bind_groups.contains_key(buffers.as_slice()) {
                        continue;
                    }
                    let entries: Vec<_> = buffers
                        .iter()
                        .enumerate()
                        .map(|(i, id)| wgpu::BindGroupEntry {
                            binding: i as u32,
                            resource: live(&self.buffers, *id).as_entire_binding(),
                        })
                        .collect();
                    let group = self.gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                        label: Some(pass.label),
                        layout: &pipeline.layout,
                        entries: &entries,
                    });
                    pipeline.bind_groups.insert(buffers.clone(), group);
                }
                Command::Repeat { body, .. } => self.prepare(body)?,
                Command::Copy { .. } | Command::Clear { .. } => {}
            }
        }
        Ok(())
    }

    fn encode(&self, commands: &[Command], target: &mut Target<'_>) {
        for command in commands {
            match command {
                Command::Dispatch { pass, size, buffers } => {
                    let groups = match *size {
                        DispatchSize::Items(items) => items.div_ceil(pass.invocations()),
                        DispatchSize::Groups(groups) => groups,
                        DispatchSize::Indirect { .. } => 1,
                    };
                    if groups == 0 {
                        continue;
                    }
                    let compute = target.compute(pass.label);
                    let pipeline = &self.pipelines[&key(pass)];
                    compute.set_pipeline(&pipeline.pipeline);
                    compute.set_bind_group(0, &pipeline.bind_groups[buffers.as_slice()], &[]);
                    if let DispatchSize::Indirect { buffer, word } = *size {
                        compute.dispatch_workgroups_indirect(self.buffer(buffer), u64::from(word) * 4);
                    } else {
                        let [x, y, z] = dispatch_groups(groups);
                        compute.dispatch_workgroups(x, y, z);
                    }
                }
                Command::Copy { from, to } => {
                    let bytes = self.table.find(*from).filter(|meta| meta.len > 0).map_or(0, Meta::bytes);
                    let (from, to) = (self.buffer(*from), self.buffer(*to));
                    target.encoder().copy_buffer_to_buffer(from, 0, to, 0, bytes);
                }
                Command::Clear { buffer } => {
                    target.encoder().clear_buffer(self.buffer(*buffer), 0, None);
                }
                Command::Repeat { body, rounds, .. } => {
                    for _ in 0..rounds.get() {
                        self.encode(body, target);
                    }
                }
            }
        }
    }
}

impl Timer {
    fn collect(&mut self) {
        for (label, time) in self.passes.collect().into_iter().flatten() {
            self.timings.add(label, time);
        }
    }
}

/// The encoder and the compute pass that consecutive dispatches share.
struct Target<'a> {
    encoder: &'a mut wgpu::CommandEncoder,
    pass: Option<wgpu::ComputePass<'static>>,
    timer: Option<&'a mut PassTimer>,
}

impl Target<'_> {
    /// The open compute pass; while timing, each dispatch has its own.
    fn compute(&mut self, label: &'static str) -> &mut wgpu::ComputePass<'static> {
        if self.timer.is_some() {
            self.pass = None;
        }
        let Self { encoder, pass, timer } = self;
        pass.get_or_insert_with(|| {
            let timestamp_writes = timer.as_mut().and_then(|timer| timer.compute_pass(label));
            encoder
                .begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some(label), timestamp_writes })
                .forget_lifetime()
        })
    }

    fn encoder(&mut self) -> &mut wgpu::CommandEncoder {
        self.pass = None;
        self.encoder
    }
}
