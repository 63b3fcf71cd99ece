//! Ctrl-C: the first asks the run to stop after the frame that is being computed, the second stops it at once.

use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

/// Counts how often the user asked to stop.
#[derive(Clone, Debug)]
pub struct Interrupt(Arc<AtomicU8>);

/// What the user wants.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wish {
    /// Go on.
    GoOn,
    /// Finish the frame, then stop.
    StopAfterFrame,
    /// Stop now; what is queued is still written.
    StopNow,
}

impl Interrupt {
    /// Listens for Ctrl-C and, on Unix, for SIGTERM and SIGHUP.
    pub fn listen() -> Self {
        let count = Arc::new(AtomicU8::new(0));
        let counter = Arc::clone(&count);
        let handler = move || {
            let before = counter.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |n| n.checked_add(1));
            if before == Ok(0) {
                crate::console::note("\nStopping after this frame; press Ctrl-C again to stop at once.");
            }
        };
        // Without a handler Ctrl-C just ends the program, and every file on the disk is complete all the same.
        if let Err(error) = ctrlc::set_handler(handler) {
            crate::console::note(format!("warning: Ctrl-C will stop without a summary: {error}"));
        }
        Self(count)
    }

    /// What the user wants now.
    pub fn wish(&self) -> Wish {
        match self.0.load(Ordering::Relaxed) {
            0 => Wish::GoOn,
            1 => Wish::StopAfterFrame,
            _ => Wish::StopNow,
        }
    }
}
