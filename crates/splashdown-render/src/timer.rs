//! How long each pass of a picture took on the GPU.
//!
//! # How it works
//! Every pass writes a timestamp at its beginning and at its end. Behind the last pass they are
//! copied into a buffer that is mapped once the caller has submitted the picture; a later picture
//! finds it ready and reads it. Nobody ever waits, so times come some pictures late. While all
//! buffers are under way, pictures go without being measured.
//!
//! # Why not the other way
//! Waiting for each picture would be simpler and would let the device run dry between pictures,
//! which changes what is measured.

use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};
use wgpu::{
    Buffer, BufferUsages, CommandEncoder, Device, Features, MapMode, QuerySet, Queue,
    RenderPassTimestampWrites,
};

/// Most passes of a picture that are measured; a picture has less than half as many.
const MOST_PASSES: u32 = 32;
/// Buffers for pictures under way.
const SLOTS: usize = 4;
/// After this many pictures without a free buffer, those under way belong to encoders that were
/// never submitted.
const PATIENCE: u32 = 60;
const BYTES: u64 = 2 * 8 * MOST_PASSES as u64;

/// Time that a pass of a picture took on the GPU.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PassTime {
    /// The pass's label, as it also stands in the driver's tools.
    pub label: &'static str,
    /// Milliseconds, the sum over all passes of that label.
    pub milliseconds: f32,
}

#[derive(Debug)]
pub(crate) struct Timer {
    queries: QuerySet,
    resolved: Buffer,
    /// Nanoseconds per tick.
    period: f64,
    free: Vec<Buffer>,
    under_way: Vec<UnderWay>,
    skipped: u32,
    /// Of the picture being recorded; absent while no buffer is free.
    labels: Option<Vec<&'static str>>,
    latest: Vec<PassTime>,
}

#[derive(Debug)]
struct UnderWay {
    buffer: Buffer,
    labels: Vec<&'static str>,
    state: Arc<AtomicU8>,
}

const WAITING: u8 = 0;
const READY: u8 = 1;
const LOST: u8 = 2;

impl Timer {
    /// Nothing where the device has no timestamps.
    pub fn new(device: &Device, queue: &Queue) -> Option<Timer> {
        if !device.features().contains(Features::TIMESTAMP_QUERY) {
            return None;
        }
        let queries = device.create_query_set(&wgpu::QuerySetDescriptor {
            label: Some("times of passes"),
            ty: wgpu::QueryType::Timestamp,
            count: 2 * MOST_PASSES,
        });
        Some(Timer {
            queries,
            resolved: buffer(device, BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC),
            period: f64::from(queue.get_timestamp_period()),
            free: (0..SLOTS).map(|_| read_back(device)).collect(),
            under_way: Vec::new(),
            skipped: 0,
            labels: None,
            latest: Vec::new(),
        })
    }

    /// Times of the latest picture that has come back.
    pub fn latest(&mut self) -> &[PassTime] {
        self.collect();
        &self.latest
    }

    /// Starts a picture.
    pub fn begin(&mut self, device: &Device) {
        self.collect();
        if self.free.is_empty() {
            self.skipped += 1;
            if self.skipped > PATIENCE {
                self.under_way.clear();
                self.free = (0..SLOTS).map(|_| read_back(device)).collect();
            }
        }
        if !self.free.is_empty() {
            self.skipped = 0;
        }
        self.labels = (!self.free.is_empty()).then(Vec::new);
    }

    /// Where a pass is to write its times.
    pub fn pass(&mut self, label: &'static str) -> Option<RenderPassTimestampWrites<'_>> {
        let labels = self.labels.as_mut().filter(|labels| labels.len() < MOST_PASSES as usize)?;
        let first = 2 * labels.len() as u32;
        labels.push(label);
        Some(RenderPassTimestampWrites {
            query_set: &self.queries,
            beginning_of_pass_write_index: Some(first),
            end_of_pass_write_index: Some(first + 1),
        })
    }

    /// Ends the picture: its times come back after it is submitted.
    pub fn end(&mut self, encoder: &mut CommandEncoder) {
        let Some(labels) = self.labels.take().filter(|labels| !labels.is_empty()) else { return };
        let Some(buffer) = self.free.pop() else { return };
        let queries = 2 * labels.len() as u32;
        encoder.resolve_query_set(&self.queries, 0..queries, &self.resolved, 0);
        encoder.copy_buffer_to_buffer(&self.resolved, 0, &buffer, 0, BYTES);
        let state = Arc::new(AtomicU8::new(WAITING));
        let told = state.clone();
        encoder.map_buffer_on_submit(&buffer, MapMode::Read, .., move |result| {
            told.store(if result.is_ok() { READY } else { LOST }, Ordering::Release);
        });
        self.under_way.push(UnderWay { buffer, labels, state });
    }

    fn collect(&mut self) {
        // In the order of the pictures, so that the latest one wins.
        let (done, waiting) = std::mem::take(&mut self.under_way)
            .into_iter()
            .partition(|picture| picture.state.load(Ordering::Acquire) != WAITING);
        self.under_way = waiting;
        for UnderWay { buffer, labels, state } in done {
            if state.load(Ordering::Acquire) == READY {
                if let Ok(bytes) = buffer.get_mapped_range(..) {
                    self.latest = times(&bytes, &labels, self.period);
                }
                buffer.unmap();
            }
            self.free.push(buffer);
        }
    }
}

/// Sums pairs of ticks by label, in the order of the passes.
fn times(bytes: &[u8], labels: &[&'static str], period: f64) -> Vec<PassTime> {
    let tick = |index: usize| {
        let bytes = bytes.get(8 * index..).and_then(|rest| rest.first_chunk::<8>());
        bytes.map_or(0, |bytes| u64::from_le_bytes(*bytes))
    };
    let mut times: Vec<PassTime> = Vec::new();
    for (index, label) in labels.iter().enumerate() {
        let ticks = tick(2 * index + 1).saturating_sub(tick(2 * index));
        let milliseconds = (1e-6 * period * ticks as f64) as f32;
        match times.iter_mut().find(|time| time.label == *label) {
            Some(time) => time.milliseconds += milliseconds,
            None => times.push(PassTime { label, milliseconds }),
        }
    }
    times
}

fn read_back(device: &Device) -> Buffer {
    buffer(device, BufferUsages::COPY_DST | BufferUsages::MAP_READ)
}

fn buffer(device: &Device, usage: BufferUsages) -> Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("times of passes"),
        size: BYTES,
        usage,
        mapped_at_creation: false,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_summed_by_label() {
        let ticks: [u64; 6] = [100, 1_100, 2_000, 2_500, 9_000, 8_000];
        let bytes: Vec<u8> = ticks.iter().flat_map(|tick| tick.to_le_bytes()).collect();
        let sums = times(&bytes, &["smooth", "smooth", "clean"], 1000.0);
        let expected =
            [PassTime { label: "smooth", milliseconds: 1.5 }, PassTime { label: "clean", milliseconds: 0.0 }];
        assert_eq!(sums, expected, "a clock that runs backwards counts as nothing");
        // Negative control: another period.
        assert_ne!(times(&bytes, &["smooth", "smooth", "clean"], 1.0), expected);
    }
}
