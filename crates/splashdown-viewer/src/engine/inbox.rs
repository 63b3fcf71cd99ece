//! Commands on their way to the engine, and its sleep when there is nothing to do.

use std::sync::Mutex;
use std::time::Duration;

use super::{Command, lock};

#[derive(Default)]
pub(super) struct Inbox {
    commands: Mutex<Vec<Command>>,
    #[cfg(not(target_arch = "wasm32"))]
    arrived: std::sync::Condvar,
    #[cfg(target_arch = "wasm32")]
    waker: Mutex<Option<std::task::Waker>>,
}

impl Inbox {
    pub fn put(&self, command: Command) {
        lock(&self.commands).push(command);
        #[cfg(not(target_arch = "wasm32"))]
        self.arrived.notify_one();
        self.wake();
    }

    pub fn take(&self) -> Vec<Command> {
        std::mem::take(&mut lock(&self.commands))
    }

    /// Ends a sleep on a web page; a thread wakes up by itself.
    pub fn wake(&self) {
        #[cfg(target_arch = "wasm32")]
        if let Some(waker) = lock(&self.waker).take() {
            waker.wake();
        }
    }

    /// Sleeps until a command comes, but no longer than this; on a web page until the next picture.
    #[cfg(not(target_arch = "wasm32"))]
    pub async fn sleep(&self, at_most: Duration) {
        let commands = lock(&self.commands);
        if commands.is_empty() {
            drop(self.arrived.wait_timeout(commands, at_most));
        }
    }

    /// Sleeps until a command comes, but no longer than this; on a web page until the next picture.
    #[cfg(target_arch = "wasm32")]
    pub async fn sleep(&self, _: Duration) {
        let mut slept = false;
        std::future::poll_fn(|context| {
            if std::mem::replace(&mut slept, true) {
                return std::task::Poll::Ready(());
            }
            *lock(&self.waker) = Some(context.waker().clone());
            std::task::Poll::Pending
        })
        .await;
    }
}
