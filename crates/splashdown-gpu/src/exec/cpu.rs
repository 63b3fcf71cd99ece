//! Runs recordings in host memory on the cores.

use std::cell::Ref;
use web_time::Instant;

use bytemuck::Pod;

use super::table::{Meta, Table};
use super::{Readback, readback};
use crate::host::HostBuffer;
use crate::{
    Access, BufferId, Command, CpuWork, GpuElement, GpuError, Grid, PassDesc, Recording, Slot, Timings,
};

/// Buffers in host memory; passes run by their Rust functions, parallel over rayon's threads.
///
/// The threads are those of the rayon pool that the caller is in (`pool.install(..)`), else all cores.
#[derive(Default)]
pub struct CpuExecutor {
    buffers: Vec<HostBuffer>,
    table: Table,
    timings: Option<Timings>,
}

impl CpuExecutor {
    /// An executor without buffers.
    pub fn new() -> Self {
        Self::default()
    }

    pub(super) fn table(&mut self) -> &mut Table {
        &mut self.table
    }

    pub(super) fn table_ref(&self) -> &Table {
        &self.table
    }

    pub(super) fn create(&mut self, meta: Meta) -> Result<BufferId, GpuError> {
        self.buffers.push(self.allocate(&meta)?);
        Ok(self.table.add(meta))
    }

    pub(super) fn resize(&mut self, id: BufferId, len: usize) -> Result<(), GpuError> {
        let meta = Meta { len, ..self.table.get(id).clone() };
        self.buffers[id.0 as usize] = self.allocate(&meta)?;
        *self.table.get_mut(id) = meta;
        Ok(())
    }

    fn allocate(&self, meta: &Meta) -> Result<HostBuffer, GpuError> {
        meta.check_len()?;
        HostBuffer::new(meta.size as u64 * meta.len as u64, self.table.fill())
            .ok_or_else(|| GpuError::OutOfMemory { label: meta.label.clone(), bytes: meta.bytes() })
    }

    pub(super) fn write(&mut self, id: BufferId, bytes: &[u8]) -> Result<(), GpuError> {
        self.buffers[id.0 as usize].write::<u8>()[..bytes.len()].copy_from_slice(bytes);
        Ok(())
    }

    pub(super) fn view<T: Pod>(&self, id: BufferId) -> Ref<'_, [T]> {
        self.buffers[id.0 as usize].read()
    }

    pub(super) fn request<T: GpuElement>(
        &mut self,
        id: BufferId,
        len: usize,
    ) -> Result<Readback<T>, GpuError> {
        Ok(readback::ready(self.view::<T>(id)[..len].to_vec()))
    }

    pub(super) fn enable_timing(&mut self) -> bool {
        self.timings.get_or_insert_default();
        true
    }

    pub(super) fn disable_timing(&mut self) {
        self.timings = None;
    }

    pub(super) fn take_timings(&mut self) -> Timings {
        self.timings.as_mut().map(std::mem::take).unwrap_or_default()
    }

    pub(super) fn run(&mut self, recording: &Recording) -> Result<(), GpuError> {
        self.table.check(recording)?;
        self.commands(&recording.commands);
        Ok(())
    }

    fn commands(&mut self, commands: &[Command]) {
        for command in commands {
            match command {
                Command::Dispatch { pass, grid, buffers } => self.dispatch(pass, *grid, buffers),
                Command::Copy { from, to } => {
                    let from = self.buffers[from.0 as usize].read::<u8>();
                    self.buffers[to.0 as usize].write::<u8>()[..from.len()].copy_from_slice(&from);
                }
                Command::Clear { buffer } => self.buffers[buffer.0 as usize].write::<u8>().fill(0),
                Command::Repeat { body, most, until } => {
                    for _ in 0..*most {
                        if self.word(until.buffer, until.word) != 0 {
                            break;
                        }
                        self.commands(body);
                    }
                }
            }
        }
    }

    fn word(&self, buffer: BufferId, word: u32) -> u32 {
        self.buffers[buffer.0 as usize].read::<u32>()[word as usize]
    }

    fn dispatch(&mut self, pass: &'static PassDesc, grid: Grid, ids: &[BufferId]) {
        let work = match grid {
            Grid::Items(items) => CpuWork { items, groups: items.div_ceil(pass.invocations()) },
            Grid::Groups(groups) => CpuWork { items: groups.saturating_mul(pass.invocations()), groups },
            Grid::Indirect { buffer, word } => {
                let groups = (0..3).map(|i| self.word(buffer, word + i)).fold(1, u32::saturating_mul);
                CpuWork { items: groups.saturating_mul(pass.invocations()), groups }
            }
        };
        if work.groups == 0 {
            return;
        }
        let started = Instant::now();
        let mut slots: Vec<Slot<'_>> = ids
            .iter()
            .zip(pass.bindings)
            .map(|(id, binding)| {
                self.buffers[id.0 as usize]
                    .slot(binding.access == Access::ReadWrite)
                    .expect("the table has refused a buffer bound twice and written")
            })
            .collect();
        (pass.cpu)(work, &mut slots);
        drop(slots);
        if let Some(timings) = &mut self.timings {
            timings.add(pass.label, started.elapsed());
        }
    }
}
