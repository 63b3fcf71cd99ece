//! A thread that reads the frames that are wanted next.

use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

use splashdown::BodyMesh;
use splashdown_run::PlayedFrame;

use crate::task::caught;

/// Frames that are read ahead of [`Loader::take`]. A window that is not drawn takes none.
const AHEAD: usize = 2;

/// Something that the thread has read.
pub enum Loaded {
    /// The meshes of the bodies, before the first frame.
    Bodies(Result<Vec<BodyMesh>, String>),
    /// A frame by its number, or why it cannot be read.
    Frame(u32, Result<Arc<PlayedFrame>, String>),
    /// Nothing: the thread has ended by a panic, with this message.
    Stopped(String),
}

/// What the thread reads. Errors are messages.
pub trait Source: Send + 'static {
    /// The meshes of the bodies.
    fn bodies(&self) -> Result<Vec<BodyMesh>, String>;

    /// A frame.
    fn frame(&self, number: u32) -> Result<PlayedFrame, String>;
}

/// The two sides of the thread.
#[derive(Default)]
struct Exchange {
    /// In the order in which they are read.
    wanted: Vec<u32>,
    reading: Option<u32>,
    loaded: Vec<Loaded>,
    ends: bool,
}

#[derive(Default)]
struct Shared {
    exchange: Mutex<Exchange>,
    changed: Condvar,
}

/// Reads frames. Dropping it ends the thread after the file that it is reading, without waiting for it.
pub struct Loader {
    shared: Arc<Shared>,
}

impl Loader {
    /// Starts the thread. `repaint` is called whenever something is loaded.
    ///
    /// # Errors
    /// If the system starts no thread.
    pub fn start(source: impl Source, repaint: impl Fn() + Send + 'static) -> std::io::Result<Self> {
        let shared = Arc::new(Shared::default());
        let its = Arc::clone(&shared);
        let body = move || {
            if let Err(reason) = caught(|| read_all(&source, &its, &repaint)) {
                lock(&its.exchange).loaded.push(Loaded::Stopped(reason));
                repaint();
            }
        };
        std::thread::Builder::new().name("splashdown-frames".to_owned()).spawn(body)?;
        Ok(Self { shared })
    }

    /// Replaces the frames that are wanted. One that is being read, or was read since the last call of
    /// [`take`](Self::take), is not read again.
    pub fn want(&self, mut wanted: Vec<u32>) {
        let mut exchange = lock(&self.shared.exchange);
        wanted.retain(|&number| {
            let is_loaded = |loaded: &Loaded| matches!(loaded, Loaded::Frame(other, _) if *other == number);
            exchange.reading != Some(number) && !exchange.loaded.iter().any(is_loaded)
        });
        exchange.wanted = wanted;
        self.shared.changed.notify_one();
    }

    /// What was loaded since the last call.
    pub fn take(&self) -> Vec<Loaded> {
        let loaded = std::mem::take(&mut lock(&self.shared.exchange).loaded);
        self.shared.changed.notify_one();
        loaded
    }
}

impl Drop for Loader {
    fn drop(&mut self) {
        lock(&self.shared.exchange).ends = true;
        self.shared.changed.notify_one();
    }
}

fn read_all(source: &impl Source, shared: &Shared, repaint: &impl Fn()) {
    let bodies = source.bodies();
    lock(&shared.exchange).loaded.push(Loaded::Bodies(bodies));
    repaint();
    loop {
        let mut exchange = lock(&shared.exchange);
        while (exchange.wanted.is_empty() || exchange.loaded.len() >= AHEAD) && !exchange.ends {
            exchange = shared.changed.wait(exchange).unwrap_or_else(PoisonError::into_inner);
        }
        if exchange.ends {
            return;
        }
        let number = exchange.wanted.remove(0);
        exchange.reading = Some(number);
        drop(exchange);
        let frame = source.frame(number).map(Arc::new);
        let mut exchange = lock(&shared.exchange);
        exchange.reading = None;
        exchange.loaded.push(Loaded::Frame(number, frame));
        drop(exchange);
        repaint();
    }
}

/// A poisoned lock is still usable: every change is one assignment.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
