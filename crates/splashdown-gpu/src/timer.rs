//! Measures the time of passes on a GPU.
//!
//! *How it works.* Every pass writes a timestamp at its beginning and at its end. At the end of a group of passes (a
//! submission, a picture) the timestamps are copied into a buffer that is mapped once the group is submitted; a later
//! call reads it when it is ready. No call waits.
//!
//! Waiting for each group would leave the device without work in between and change the measurement.

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};
use std::time::Duration;

/// After this many groups without a free buffer, the pending groups belong to encoders that were never submitted.
const PATIENCE: u32 = 60;

/// Measures groups of compute and render passes.
#[derive(Debug)]
pub struct PassTimer {
    device: wgpu::Device,
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    /// Nanoseconds per tick.
    period: f64,
    most_passes: u32,
    most_pending: usize,
    free: Vec<wgpu::Buffer>,
    pending: VecDeque<Pending>,
    /// Number of consecutive groups without a free buffer.
    skipped: u32,
    /// The labels of the group being recorded; `None` if it is not measured.
    labels: Option<Vec<&'static str>>,
}

/// A group whose times have not been read.
#[derive(Debug)]
struct Pending {
    buffer: wgpu::Buffer,
    labels: Vec<&'static str>,
    state: Arc<AtomicU8>,
}

const WAITING: u8 = 0;
const READY: u8 = 1;
const FAILED: u8 = 2;

impl PassTimer {
    /// Measures the first `most_passes` passes of each group. Groups are not measured while the times of `most_pending`
    /// earlier ones have not arrived. `None` if the device has no timestamps.
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        most_passes: u32,
        most_pending: usize,
    ) -> Option<Self> {
        if !device.features().contains(wgpu::Features::TIMESTAMP_QUERY) {
            return None;
        }
        let queries = device.create_query_set(&wgpu::QuerySetDescriptor {
            label: Some("pass times"),
            ty: wgpu::QueryType::Timestamp,
            count: 2 * most_passes,
        });
        let usage = wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC;
        Some(Self {
            device: device.clone(),
            queries,
            resolved: buffer(device, most_passes, usage),
            period: f64::from(queue.get_timestamp_period()),
            most_passes,
            most_pending,
            free: Vec::new(),
            pending: VecDeque::new(),
            skipped: 0,
            labels: None,
        })
    }

    /// Begins a group. Returns false if it is not measured.
    pub fn begin(&mut self) -> bool {
        if self.pending.len() < self.most_pending {
            self.skipped = 0;
        } else {
            self.skipped += 1;
            if self.skipped > PATIENCE {
                self.pending.clear();
            }
        }
        self.labels = (self.pending.len() < self.most_pending).then(Vec::new);
        self.labels.is_some()
    }

    /// The timestamp writes of a compute pass with this label.
    pub fn compute_pass(&mut self, label: &'static str) -> Option<wgpu::ComputePassTimestampWrites<'_>> {
        let (query_set, first) = self.pass(label)?;
        Some(wgpu::ComputePassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: Some(first),
            end_of_pass_write_index: Some(first + 1),
        })
    }

    /// The timestamp writes of a render pass with this label.
    pub fn render_pass(&mut self, label: &'static str) -> Option<wgpu::RenderPassTimestampWrites<'_>> {
        let (query_set, first) = self.pass(label)?;
        Some(wgpu::RenderPassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: Some(first),
            end_of_pass_write_index: Some(first + 1),
        })
    }

    fn pass(&mut self, label: &'static str) -> Option<(&wgpu::QuerySet, u32)> {
        let most = self.most_passes as usize;
        let labels = self.labels.as_mut().filter(|labels| labels.len() < most)?;
        labels.push(label);
        Some((&self.queries, 2 * (labels.len() as u32 - 1)))
    }

    /// Ends the group: its times arrive after `encoder` has been submitted.
    pub fn end(&mut self, encoder: &mut wgpu::CommandEncoder) {
        let Some(labels) = self.labels.take().filter(|labels| !labels.is_empty()) else { return };
        let usage = wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ;
        let buffer = self.free.pop().unwrap_or_else(|| buffer(&self.device, self.most_passes, usage));
        let stamps = 2 * labels.len() as u32;
        encoder.resolve_query_set(&self.queries, 0..stamps, &self.resolved, 0);
        encoder.copy_buffer_to_buffer(&self.resolved, 0, &buffer, 0, u64::from(stamps) * 8);
        let state = Arc::new(AtomicU8::new(WAITING));
        let reporter = Arc::clone(&state);
        encoder.map_buffer_on_submit(&buffer, wgpu::MapMode::Read, .., move |result| {
            reporter.store(if result.is_ok() { READY } else { FAILED }, Ordering::Release);
        });
        self.pending.push_back(Pending { buffer, labels, state });
    }

    /// True while the times of a group have not arrived.
    pub fn is_pending(&self) -> bool {
        !self.pending.is_empty()
    }

    /// The times of the groups that have arrived since the last call, oldest first: label and time of each pass.
    pub fn collect(&mut self) -> Vec<Vec<(&'static str, Duration)>> {
        let mut groups = Vec::new();
        for Pending { buffer, labels, state } in std::mem::take(&mut self.pending) {
            match state.load(Ordering::Acquire) {
                WAITING => self.pending.push_back(Pending { buffer, labels, state }),
                READY => {
                    if let Ok(bytes) = buffer.get_mapped_range(..) {
                        groups.push(times(&bytes, &labels, self.period));
                    }
                    buffer.unmap();
                    self.free.push(buffer);
                }
                _ => {}
            }
        }
        groups
    }
}

fn buffer(device: &wgpu::Device, most_passes: u32, usage: wgpu::BufferUsages) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("pass times"),
        size: u64::from(2 * most_passes) * 8,
        usage,
        mapped_at_creation: false,
    })
}

/// The times from pairs of ticks; a decreasing clock gives a time of zero.
fn times(bytes: &[u8], labels: &[&'static str], period: f64) -> Vec<(&'static str, Duration)> {
    let ticks = |pair: &[u8; 16]| {
        let (begin, end) = pair.split_at(8);
        let tick = |bytes: &[u8]| bytes.first_chunk().map_or(0, |bytes| u64::from_le_bytes(*bytes));
        tick(end).saturating_sub(tick(begin)) as f64
    };
    let pairs = bytes.as_chunks::<16>().0;
    labels
        .iter()
        .zip(pairs)
        .map(|(label, pair)| (*label, Duration::from_nanos((ticks(pair) * period) as u64)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_converted_to_times() {
        let ticks: [u64; 6] = [100, 1_100, 2_000, 2_500, 9_000, 8_000];
        let bytes: Vec<u8> = ticks.iter().flat_map(|tick| tick.to_le_bytes()).collect();
        let labels = ["smooth", "smooth", "clean"];
        let expected = [("smooth", 1_000_000), ("smooth", 500_000), ("clean", 0)]
            .map(|(label, nanoseconds)| (label, Duration::from_nanos(nanoseconds)));
        assert_eq!(times(&bytes, &labels, 1000.0), expected, "a decreasing clock gives zero");
        // Negative control: another period.
        assert_ne!(times(&bytes, &labels, 1.0), expected);
    }
}
