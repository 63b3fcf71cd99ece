//! The simulation, which runs concurrently with the window. It receives commands and publishes snapshots. Neither side
//! waits for the other.
//!
//! On a desktop the engine runs on its own thread, on a web page as a task between two frames. Both run the same code
//! (`work`); the differences are here and in `inbox.rs`.

mod command;
mod drawn;
mod inbox;
mod pace;
mod snapshot;
mod work;

use std::sync::{Arc, Mutex};

use splashdown_gpu::Gpu;

pub use command::{Command, Grip, Purpose, Simulate};
pub use drawn::{Drawn, DrawnMesh};
pub use snapshot::{Message, Opened, Snapshot};

use inbox::Inbox;
use work::Worker;

/// The newest output of the engine.
#[derive(Default)]
struct Outbox {
    snapshot: Option<Arc<Snapshot>>,
    /// Whether the window has drawn it.
    is_seen: bool,
    /// Shared with the threads that prepare bodies.
    messages: Arc<Mutex<Vec<Message>>>,
}

/// The handle by which the window controls the engine. Dropping it stops the engine.
pub struct Engine {
    inbox: Arc<Inbox>,
    outbox: Arc<Mutex<Outbox>>,
    #[cfg(not(target_arch = "wasm32"))]
    thread: Option<std::thread::JoinHandle<()>>,
}

impl Engine {
    /// Starts the engine. `gpu` draws, and also simulates unless `simulate` selects the CPU. `repaint` is called when
    /// there is something new to show.
    pub fn start(gpu: Arc<Gpu>, simulate: Simulate, repaint: impl Fn() + Send + 'static) -> Self {
        let inbox = Arc::new(Inbox::default());
        let outbox = Arc::new(Mutex::new(Outbox::default()));
        let (worker_inbox, worker_outbox) = (Arc::clone(&inbox), Arc::clone(&outbox));
        #[cfg(not(target_arch = "wasm32"))]
        {
            let work = move || {
                let mut worker = Worker::new(gpu, simulate, worker_inbox, worker_outbox, Box::new(repaint));
                splashdown_gpu::block_on(worker.work());
            };
            let thread = std::thread::Builder::new().name("splashdown-engine".to_owned()).spawn(work);
            let engine = Self { inbox, outbox, thread: thread.ok() };
            if engine.thread.is_none() {
                engine.report(Message::Failed("no thread could be started for the simulation".to_owned()));
            }
            engine
        }
        #[cfg(target_arch = "wasm32")]
        {
            wasm_bindgen_futures::spawn_local(async move {
                Worker::new(gpu, simulate, worker_inbox, worker_outbox, Box::new(repaint)).work().await;
            });
            Self { inbox, outbox }
        }
    }

    /// Queues a command, which is executed before the next step.
    pub fn send(&self, command: Command) {
        self.inbox.put(command);
    }

    /// Must be called once per frame. The engine then takes the next snapshot. On a web page it works between two frames.
    pub fn picture_drawn(&mut self) {
        lock(&self.outbox).is_seen = true;
        self.inbox.wake();
        #[cfg(not(target_arch = "wasm32"))]
        if self.thread.as_ref().is_some_and(std::thread::JoinHandle::is_finished) {
            self.thread = None;
            self.report(Message::Stopped);
        }
    }

    /// The newest snapshot.
    pub fn snapshot(&self) -> Option<Arc<Snapshot>> {
        lock(&self.outbox).snapshot.clone()
    }

    /// The messages since the last call.
    pub fn take_messages(&self) -> Vec<Message> {
        std::mem::take(&mut lock(&lock(&self.outbox).messages))
    }

    #[cfg(not(target_arch = "wasm32"))]
    fn report(&self, message: Message) {
        lock(&lock(&self.outbox).messages).push(message);
    }
}

impl Drop for Engine {
    fn drop(&mut self) {
        self.send(Command::Quit);
        #[cfg(not(target_arch = "wasm32"))]
        if let Some(thread) = self.thread.take() {
            // Buffers must be freed before the device. A panic is already reported.
            let _ = thread.join();
        }
    }
}

/// A poisoned lock is still usable: every change is one assignment.
fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}
