//! Runs recordings on a device: one submission each, bind groups and pipelines made once.

use std::collections::hash_map::Entry;
use std::collections::{HashMap, VecDeque};
use std::sync::Arc;
use std::time::Duration;

use super::pipeline::Pipeline;
use super::readback::Mapping;
use super::table::{Kind, Meta, Table};
use super::{Readback, readback};
use crate::{
    BufferId, Command, Gpu, GpuElement, GpuError, Grid, PassDesc, Recording, Timings, block_on,
    dispatch_groups,
};

/// Dispatches timed per submission; those beyond go untimed.
const TIMED_DISPATCHES: u32 = 2048;

/// Buffers on a device; passes run by their WGSL.
pub struct GpuExecutor {
    gpu: Arc<Gpu>,
    buffers: Vec<wgpu::Buffer>,
    table: Table,
    pipelines: HashMap<usize, Pipeline>,
    timer: Option<Timer>,
}

struct Timer {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    /// The passes of each submission, and their times on the way.
    underway: VecDeque<(Vec<&'static str>, Mapping)>,
    timings: Timings,
}

/// The address of a declaration names its pipeline: declarations are statics.
fn key(pass: &'static PassDesc) -> usize {
    std::ptr::from_ref(pass) as usize
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

    pub(super) fn wgpu_buffer(&self, id: BufferId) -> &wgpu::Buffer {
        &self.buffers[id.0 as usize]
    }

    pub(super) fn table(&mut self) -> &mut Table {
        &mut self.table
    }

    pub(super) fn table_ref(&self) -> &Table {
        &self.table
    }

    pub(super) fn create(&mut self, meta: Meta) -> Result<BufferId, GpuError> {
        let buffer = self.allocate(&meta)?;
        self.buffers.push(buffer);
        Ok(self.table.add(meta))
    }

    pub(super) fn resize(&mut self, id: BufferId, len: usize) -> Result<(), GpuError> {
        let meta = Meta { len, ..self.table.get(id).clone() };
        self.buffers[id.0 as usize] = self.allocate(&meta)?;
        *self.table.get_mut(id) = meta;
        for pipeline in self.pipelines.values_mut() {
            pipeline.bind_groups.retain(|ids, _| !ids.contains(&id));
        }
        Ok(())
    }

    fn allocate(&self, meta: &Meta) -> Result<wgpu::Buffer, GpuError> {
        use wgpu::BufferUsages as Use;
        meta.check_len()?;
        let bytes = meta.bytes();
        let limit = self.gpu.largest_buffer();
        if bytes > limit {
            return Err(GpuError::TooLarge {
                label: meta.label.clone(),
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
                label: Some(&meta.label),
                size: bytes.next_multiple_of(4),
                usage: kind | Use::COPY_SRC | Use::COPY_DST,
                mapped_at_creation: false,
            })
        });
        if error.is_some() {
            return Err(GpuError::OutOfMemory { label: meta.label.clone(), bytes });
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
        self.gpu.queue.write_buffer(&self.buffers[id.0 as usize], 0, bytes);
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
        encoder.copy_buffer_to_buffer(&self.buffers[id.0 as usize], 0, &staging, 0, bytes);
        let submission = self.gpu.queue.submit([encoder.finish()]);
        self.gpu.health("a read-back")?;
        Ok(readback::mapping(Mapping::new(&self.gpu, staging, submission)))
    }

    pub(super) fn wait(&mut self) -> Result<(), GpuError> {
        self.gpu.wait_for(None)
    }

    pub(super) fn enable_timing(&mut self) -> bool {
        if !self.gpu.device.features().contains(wgpu::Features::TIMESTAMP_QUERY) {
            return false;
        }
        let device = &self.gpu.device;
        self.timer.get_or_insert_with(|| Timer {
            queries: device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("pass times"),
                ty: wgpu::QueryType::Timestamp,
                count: 2 * TIMED_DISPATCHES,
            }),
            resolved: device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("pass times"),
                size: u64::from(2 * TIMED_DISPATCHES) * 8,
                usage: wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            }),
            underway: VecDeque::new(),
            timings: Timings::default(),
        });
        true
    }

    pub(super) fn disable_timing(&mut self) {
        self.timer = None;
    }

    /// On a web page, where nobody can wait, only the times that have arrived.
    pub(super) fn take_timings(&mut self) -> Timings {
        self.collect_timings(!cfg!(target_arch = "wasm32"));
        self.timer.as_mut().map(|timer| std::mem::take(&mut timer.timings)).unwrap_or_default()
    }

    /// Adds up the times that have arrived; with `all`, waits for those that have not. Times that a lost device
    /// keeps are not missed: the next call to it fails.
    fn collect_timings(&mut self, all: bool) {
        let Some(timer) = &mut self.timer else { return };
        let period = f64::from(self.gpu.queue.get_timestamp_period());
        while let Some((labels, mapping)) = timer.underway.pop_front() {
            if !all && !mapping.is_ready().unwrap_or(true) {
                timer.underway.push_front((labels, mapping));
                return;
            }
            let stamps: Vec<u64> = block_on(mapping.take()).unwrap_or_default();
            for (label, pair) in labels.iter().zip(stamps.chunks_exact(2)) {
                let nanoseconds = pair[1].saturating_sub(pair[0]) as f64 * period;
                timer.timings.add(label, Duration::from_nanos(nanoseconds as u64));
            }
        }
    }

    pub(super) fn run(&mut self, recording: &Recording) -> Result<(), GpuError> {
        self.table.check(recording)?;
        self.prepare(&recording.commands)?;
        let mut encoder = self
            .gpu
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some(&recording.label) });
        let mut timed = Vec::new();
        {
            let mut target = Target { encoder: &mut encoder, pass: None };
            self.encode(&recording.commands, &mut target, &mut timed);
        }
        self.finish_timing(encoder, timed);
        self.gpu.health(&recording.label)
    }

    /// Makes the pipelines and bind groups that are missing.
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
                            resource: self.buffers[id.0 as usize].as_entire_binding(),
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

    fn encode(&self, commands: &[Command], target: &mut Target<'_>, timed: &mut Vec<&'static str>) {
        for command in commands {
            match command {
                Command::Dispatch { pass, grid, buffers } => {
                    let groups = match *grid {
                        Grid::Items(items) => items.div_ceil(pass.invocations()),
                        Grid::Groups(groups) => groups,
                        Grid::Indirect { .. } => 1,
                    };
                    if groups == 0 {
                        continue;
                    }
                    let compute = target.compute(pass.label, self.timer.as_ref(), timed);
                    let pipeline = &self.pipelines[&key(pass)];
                    compute.set_pipeline(&pipeline.pipeline);
                    compute.set_bind_group(0, &pipeline.bind_groups[buffers.as_slice()], &[]);
                    if let Grid::Indirect { buffer, word } = *grid {
                        compute.dispatch_workgroups_indirect(
                            &self.buffers[buffer.0 as usize],
                            u64::from(word) * 4,
                        );
                    } else {
                        let [x, y, z] = dispatch_groups(groups);
                        compute.dispatch_workgroups(x, y, z);
                    }
                }
                Command::Copy { from, to } => {
                    let meta = self.table.get(*from);
                    let bytes = if meta.len == 0 { 0 } else { meta.bytes() };
                    let (from, to) = (&self.buffers[from.0 as usize], &self.buffers[to.0 as usize]);
                    target.encoder().copy_buffer_to_buffer(from, 0, to, 0, bytes);
                }
                Command::Clear { buffer } => {
                    target.encoder().clear_buffer(&self.buffers[buffer.0 as usize], 0, None);
                }
                Command::Repeat { body, most, .. } => {
                    for _ in 0..*most {
                        self.encode(body, target, timed);
                    }
                }
            }
        }
    }

    /// Submits, and sends for the times if there are any.
    fn finish_timing(&mut self, mut encoder: wgpu::CommandEncoder, timed: Vec<&'static str>) {
        let Some(timer) = self.timer.as_mut().filter(|_| !timed.is_empty()) else {
            self.gpu.queue.submit([encoder.finish()]);
            return;
        };
        let stamps = 2 * timed.len() as u32;
        encoder.resolve_query_set(&timer.queries, 0..stamps, &timer.resolved, 0);
        let staging = self.gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("pass times"),
            size: u64::from(stamps) * 8,
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        encoder.copy_buffer_to_buffer(&timer.resolved, 0, &staging, 0, staging.size());
        let submission = self.gpu.queue.submit([encoder.finish()]);
        timer.underway.push_back((timed, Mapping::new(&self.gpu, staging, submission)));
        self.collect_timings(false);
    }
}

/// The encoder and, while dispatches follow one another, the compute pass they share.
struct Target<'a> {
    encoder: &'a mut wgpu::CommandEncoder,
    pass: Option<wgpu::ComputePass<'static>>,
}

impl Target<'_> {
    /// The open compute pass; one of its own per dispatch while timing.
    fn compute(
        &mut self,
        label: &'static str,
        timer: Option<&Timer>,
        timed: &mut Vec<&'static str>,
    ) -> &mut wgpu::ComputePass<'static> {
        if timer.is_some() {
            self.pass = None;
        }
        let timer = timer.filter(|_| timed.len() < TIMED_DISPATCHES as usize);
        let encoder = &mut *self.encoder;
        self.pass.get_or_insert_with(|| {
            let timestamp_writes = timer.map(|timer| {
                let first = 2 * timed.len() as u32;
                timed.push(label);
                wgpu::ComputePassTimestampWrites {
                    query_set: &timer.queries,
                    beginning_of_pass_write_index: Some(first),
                    end_of_pass_write_index: Some(first + 1),
                }
            });
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
