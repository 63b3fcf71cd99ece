//! Runs recordings in host memory on the CPU cores.

use web_time::Instant;

use bytemuck::Pod;

use super::table::{Meta, Table};
use super::{Readback, readback};
use crate::host::{Bytes, HostBuffer};
use crate::{
    Access, BufferId, Command, CpuWork, DispatchSize, GpuElement, GpuError, PassDesc, Recording, Scratch,
    Slot, Timings,
};

/// Buffers in host memory; passes run by their Rust functions, parallel over rayon's threads.
///
/// The threads are those of the rayon pool that the caller is in (`pool.install(..)`), otherwise all cores.
#[derive(Default)]
pub struct CpuExecutor {
    /// By slot; empty for a freed buffer.
    buffers: Vec<HostBuffer>,
    table: Table,
    timings: Option<Timings>,
    scratch: Scratch,
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
        let buffer = self.allocate(&meta)?;
        let id = self.table.add(meta);
        self.buffers.resize_with(self.buffers.len().max(id.slot as usize + 1), HostBuffer::default);
        self.buffers[id.slot as usize] = buffer;
        Ok(id)
    }

    pub(super) fn free(&mut self, ids: &[BufferId]) {
        for id in ids {
            self.table.remove(*id);
            self.buffers[id.slot as usize] = HostBuffer::default();
        }
    }

    pub(super) fn resize(&mut self, id: BufferId, meta: Meta) -> Result<(), GpuError> {
        self.buffers[id.slot as usize] = self.allocate(&meta)?;
        self.table.replace(id, meta);
        Ok(())
    }

    fn allocate(&self, meta: &Meta) -> Result<HostBuffer, GpuError> {
        meta.check_len()?;
        HostBuffer::new(meta.size as u64 * meta.len as u64, self.table.fill())
            .ok_or_else(|| GpuError::OutOfMemory { label: meta.label.into(), bytes: meta.bytes() })
    }

    pub(super) fn write(&mut self, id: BufferId, bytes: &[u8]) -> Result<(), GpuError> {
        self.buffers[id.slot as usize].write::<u8>()[..bytes.len()].copy_from_slice(bytes);
        Ok(())
    }

    pub(super) fn view<T: Pod>(&self, id: BufferId) -> &[T] {
        self.buffers[id.slot as usize].read()
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
                Command::Dispatch { pass, size, buffers } => self.dispatch(pass, *size, buffers),
                Command::Copy { from, to } => {
                    let slots = [from.slot as usize, to.slot as usize];
                    let [from, to] =
                        self.buffers.get_disjoint_mut(slots).expect("the table has checked the buffers");
                    let from = from.read::<u8>();
                    to.write::<u8>()[..from.len()].copy_from_slice(from);
                }
                Command::Clear { buffer } => self.buffers[buffer.slot as usize].write::<u8>().fill(0),
                Command::Repeat { body, rounds, until } => {
                    for _ in 0..rounds.get() {
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
        self.view::<u32>(buffer)[word as usize]
    }

    fn dispatch(&mut self, pass: &'static PassDesc, size: DispatchSize, ids: &[BufferId]) {
        let per_group = pass.invocations();
        let [items, groups] = match size {
            DispatchSize::Items(items) => [items, items.div_ceil(per_group)],
            DispatchSize::Groups(groups) => [groups.saturating_mul(per_group), groups],
            DispatchSize::Indirect { buffer, word } => {
                let groups = (0..3).map(|i| self.word(buffer, word + i)).fold(1, u32::saturating_mul);
                [groups.saturating_mul(per_group), groups]
            }
        };
        if groups == 0 {
            return;
        }
        let work = CpuWork { items, groups, scratch: &mut self.scratch };
        let started = Instant::now();
        (pass.cpu)(work, &mut slots(&mut self.buffers, pass, ids));
        if let Some(timings) = &mut self.timings {
            timings.add(pass.label, started.elapsed());
        }
    }
}

/// Borrows the buffers of a dispatch, in the order of its bindings. A buffer that is bound twice is only read, which
/// the table has checked.
fn slots<'a>(buffers: &'a mut [HostBuffer], pass: &'static PassDesc, ids: &[BufferId]) -> Vec<Slot<'a>> {
    let mut by_buffer: Vec<usize> = (0..ids.len()).collect();
    by_buffer.sort_unstable_by_key(|&k| ids[k].slot);
    let mut slots: Vec<Option<Slot<'a>>> = ids.iter().map(|_| None).collect();
    let (mut rest, mut first) = (buffers, 0);
    for same in by_buffer.chunk_by(|&a, &b| ids[a].slot == ids[b].slot) {
        let index = ids[same[0]].slot as usize;
        let (head, tail) = rest.split_at_mut(index + 1 - first);
        (rest, first) = (tail, index + 1);
        let buffer = &mut head[head.len() - 1];
        if let &[k] = same
            && pass.bindings[k].access == Access::ReadWrite
        {
            slots[k] = Some(Slot::new(pass.bindings[k].name, Bytes::Write(buffer.write())));
        } else {
            let bytes: &[u8] = buffer.read();
            for &k in same {
                slots[k] = Some(Slot::new(pass.bindings[k].name, Bytes::Read(bytes)));
            }
        }
    }
    slots.into_iter().flatten().collect()
}
