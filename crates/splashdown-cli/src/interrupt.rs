//! Ctrl-C: the first stops the run after the current frame, the second at once.

use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

use splashdown_run::Stop;

/// Counts the requests to stop.
#[derive(Clone, Debug)]
pub struct Interrupt(Arc<AtomicU8>);

impl Interrupt {
    /// Listens for Ctrl-C and, on Unix, for SIGTERM and SIGHUP.
    pub fn listen() -> Self {
        let count = Arc::new(AtomicU8::new(0));
        let counter = Arc::clone(&count);
        let handler = move || {
            let before = counter.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |n| n.checked_add(1));
            if before == Ok(0) {
                crate::console::note(
                    "\nStopping after the current frame; press Ctrl-C again to stop at once.",
                );
            }
        };
        // Without a handler Ctrl-C ends the program at once. Every file on the disk is complete in that case as well.
        if let Err(error) = ctrlc::set_handler(handler) {
            crate::console::note(format!("warning: Ctrl-C will stop without a summary: {error}"));
        }
        Self(count)
    }

    /// What the user has requested so far.
    pub fn stop(&self) -> Stop {
        match self.0.load(Ordering::Relaxed) {
            0 => Stop::No,
            1 => Stop::AfterFrame,
            _ => Stop::Now,
        }
    }
}
