//! The times of passes by label.

use std::collections::BTreeMap;
use std::time::Duration;

/// The sum over the dispatches of one pass.
#[derive(Clone, Copy, Debug, Default)]
pub struct PassTime {
    /// Number of dispatches.
    pub count: u64,
    /// Their total time.
    pub total: Duration,
}

/// Time per pass label since the last [`Executor::take_timings`](crate::Executor::take_timings).
#[derive(Clone, Debug, Default)]
pub struct Timings {
    /// By label, in alphabetical order.
    pub passes: BTreeMap<&'static str, PassTime>,
}

impl Timings {
    /// Adds one dispatch.
    pub fn add(&mut self, label: &'static str, time: Duration) {
        let entry = self.passes.entry(label).or_default();
        entry.count += 1;
        entry.total += time;
    }

    /// The sum over all passes.
    pub fn total(&self) -> Duration {
        self.passes.values().map(|pass| pass.total).sum()
    }
}
