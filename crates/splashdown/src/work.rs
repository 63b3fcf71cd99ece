//! Counters of expensive work, for the test that no work is done twice.

use std::cell::RefCell;
use std::collections::BTreeMap;

/// The number of times that each kind of work was done.
pub(crate) type Counts = BTreeMap<&'static str, u32>;

thread_local! {
    static COUNTS: RefCell<Counts> = RefCell::default();
}

/// Counts a piece of work of this thread.
pub(crate) fn count(kind: &'static str) {
    COUNTS.with_borrow_mut(|counts| *counts.entry(kind).or_default() += 1);
}

/// The counts of this thread since the last call.
pub(crate) fn take() -> Counts {
    COUNTS.take()
}
