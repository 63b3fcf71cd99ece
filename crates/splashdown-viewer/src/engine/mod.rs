//! The simulation beside the window: commands go in, snapshots come out, and neither waits for the other.
//!
//! On a desktop the engine works on a thread of its own, on a web page as a task between two pictures. Both run
//! the same code (`work`); what differs is here and in `inbox.rs`.

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

/// What the engine has to show; the newest only.
#[derive(Default)]
struct Outbox {
    snapshot: Option<Arc<Snapshot>>,
    /// True if the window has drawn it.
    is_seen: bool,
    /// Apart from the rest: threads that prepare a body speak too.
    messages: Arc<Mutex<Vec<Message>>>,
}

/// The window's end of it. Dropping it stops the engine.
pub struct Engine {
    inbox: Arc<Inbox>,
    outbox: Arc<Mutex<Outbox>>,
    #[cfg(not(target_arch = "wasm32"))]
    thread: Option<std::thread::JoinHandle<()>>,
}

impl Engine {
    /// Starts the engine. `gpu` draws; it also simulates, unless `simulate` says that the CPU does. `repaint`
    /// is called when there is something new to show.
    pub fn start(gpu: Arc<Gpu>, simulate: Simulate, repaint: impl Fn() + Send + 'static) -> Self {
        let inbox = Arc::new(Inbox::default());
        let outbox = Arc::new(Mutex::new(Outbox::default()));
        let (its_inbox, its_outbox) = (Arc::clone(&inbox), Arc::clone(&outbox));
        #[cfg(not(target_arch = "wasm32"))]
        {
            let work = move || {
                let mut worker = Worker::new(gpu, simulate, its_inbox, its_outbox, Box::new(repaint));
                splashdown_gpu::block_on(worker.work());
            };
            let thread = std::thread::Builder::new().name("splashdown-engine".to_owned()).spawn(work);
            let engine = Self { inbox, outbox, thread: thread.ok() };
            if engine.thread.is_none() {
                engine.tell(Message::Failed("the system gives no thread to simulate on".to_owned()));
            }
            engine
        }
        #[cfg(target_arch = "wasm32")]
        {
            wasm_bindgen_futures::spawn_local(async move {
                Worker::new(gpu, simulate, its_inbox, its_outbox, Box::new(repaint)).work().await;
            });
            Self { inbox, outbox }
        }
    }

    /// Hands a command over, to be obeyed before the next step.
    pub fn send(&self, command: Command) {
        self.inbox.put(command);
    }

    /// Once per picture: the engine takes the next snapshot then, and on a web page works between two pictures.
    pub fn picture_drawn(&mut self) {
        lock(&self.outbox).is_seen = true;
        self.inbox.wake();
        #[cfg(not(target_arch = "wasm32"))]
        if self.thread.as_ref().is_some_and(std::thread::JoinHandle::is_finished) {
            self.thread = None;
            self.tell(Message::Stopped);
        }
    }

    /// The newest state of the fluid.
    pub fn snapshot(&self) -> Option<Arc<Snapshot>> {
        lock(&self.outbox).snapshot.clone()
    }

    /// What there was to tell since the last call.
    pub fn take_messages(&self) -> Vec<Message> {
        std::mem::take(&mut lock(&lock(&self.outbox).messages))
    }

    #[cfg(not(target_arch = "wasm32"))]
    fn tell(&self, message: Message) {
        lock(&lock(&self.outbox).messages).push(message);
    }
}

impl Drop for Engine {
    fn drop(&mut self) {
        self.send(Command::Quit);
        #[cfg(not(target_arch = "wasm32"))]
        if let Some(thread) = self.thread.take() {
            // Buffers must be gone before the device is. A panic has been told already.
            let _ = thread.join();
        }
    }
}

/// What one side has left half-done, the other can still use: every change is one assignment.
fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}
