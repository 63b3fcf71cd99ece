//! Counters of expensive work, for the test that no work is done twice.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// The number of times that each kind of work was done.
pub(crate) type Counts = BTreeMap<&'static str, u32>;

thread_local! {
    /// The counters to which this thread adds; `None` outside of [`counted`].
    static COUNTS: RefCell<Option<Arc<Mutex<Counts>>>> = const { RefCell::new(None) };
}

/// Counts a piece of work.
pub(crate) fn count(kind: &'static str) {
    COUNTS.with_borrow(|counts| {
        if let Some(counts) = counts {
            *counts.lock().unwrap_or_else(PoisonError::into_inner).entry(kind).or_default() += 1;
        }
    });
}

/// Runs a function in a pool of its own threads, and returns the work of all of them. Tests run in parallel in one
/// process, so a global counter would include the work of others, and a counter per thread misses that of rayon.
pub(crate) fn counted<T: Send>(run: impl FnOnce() -> T + Send) -> (T, Counts) {
    let counts = Arc::<Mutex<Counts>>::default();
    let shared = Arc::clone(&counts);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(2)
        .thread_name(|index| format!("counted-{index}"))
        .start_handler(move |_| COUNTS.set(Some(Arc::clone(&shared))))
        .build()
        .expect("two threads start");
    let value = pool.install(run);
    let counts = std::mem::take(&mut *counts.lock().unwrap_or_else(PoisonError::into_inner));
    (value, counts)
}

#[test]
fn work_on_all_threads_is_counted_and_that_of_others_is_not() {
    use rayon::prelude::*;
    use std::sync::Barrier;
    // Two pieces that wait for each other: both threads do one.
    let barrier = Barrier::new(2);
    let ((), counts) = counted(|| {
        (0..2).into_par_iter().with_max_len(1).for_each(|_| {
            barrier.wait();
            count("piece");
        });
        std::thread::scope(|scope| {
            scope.spawn(|| counted(|| count("piece")));
        });
    });
    count("piece");
    assert_eq!(counts, Counts::from([("piece", 2)]));
}
