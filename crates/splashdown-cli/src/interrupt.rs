//! Ctrl-C: the first stops the run after the current frame, the second at once.

use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

use splashdown_run::Stop;

/// Counts the requests to stop.
#[derive(Clone, Debug)]
pub struct Interrupt(Arc<AtomicU8>);

impl Interrupt {
    /// Listens for Ctrl-C and, on Unix, for SIGTERM and SIGHUP. A signal that the parent process has chosen to ignore,
    /// as `nohup` does with SIGHUP, remains ignored.
    pub fn listen() -> Self {
        Self::listen_with("Stopping after the current frame; press Ctrl-C again to stop at once.")
    }

    /// As [`listen`](Self::listen), with this message at the first signal.
    pub fn listen_with(message: &'static str) -> Self {
        let count = Arc::new(AtomicU8::new(0));
        let counter = Arc::clone(&count);
        let handler = move || {
            let before = counter.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |n| n.checked_add(1));
            if before == Ok(0) {
                crate::console::note(format!("\n{message}"));
            }
        };
        let ignored = ignored::find();
        // Without a handler Ctrl-C ends the program at once. Every file on the disk is complete in that case as well.
        if let Err(error) = ctrlc::set_handler(handler) {
            crate::console::note(format!("warning: Ctrl-C will stop without a summary: {error}"));
        }
        ignored::restore(&ignored);
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

/// Makes a write beyond the file size limit of the process (`ulimit -f`) fail with an error, as on a full disk. Without this
/// the signal of the limit ends the program without a message.
pub fn report_file_size_limit() {
    #[cfg(unix)]
    ignored::restore(&[nix::sys::signal::Signal::SIGXFSZ]);
}

/// Signals that are ignored since the program was started.
#[cfg(unix)]
mod ignored {
    use nix::sys::signal::{SigHandler, Signal, signal};

    /// The ignored ones among the signals that stop a run.
    pub fn find() -> Vec<Signal> {
        let stopping = [Signal::SIGHUP, Signal::SIGINT, Signal::SIGTERM].into_iter();
        stopping.filter(|&number| is_ignored(number)).collect()
    }

    /// Ignores these signals.
    pub fn restore(signals: &[Signal]) {
        for &number in signals {
            // SAFETY: ignoring a signal installs no code. It fails for invalid signals only, and these are valid.
            let _ = unsafe { signal(number, SigHandler::SigIgn) };
        }
    }

    fn is_ignored(number: Signal) -> bool {
        // SAFETY: as in `restore`.
        let before = unsafe { signal(number, SigHandler::SigIgn) };
        match before {
            Ok(SigHandler::SigIgn) => true,
            Ok(handler) => {
                // SAFETY: this handler was installed until now.
                let _ = unsafe { signal(number, handler) };
                false
            }
            Err(_) => false,
        }
    }
}

/// Other systems have no such signals.
#[cfg(not(unix))]
mod ignored {
    pub fn find() {}

    pub fn restore((): &()) {}
}
