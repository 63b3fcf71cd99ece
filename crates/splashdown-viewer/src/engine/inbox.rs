//! The queue of commands. The engine sleeps while it is empty.

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

    /// Removes and returns all commands, without those that the next one supersedes: a slider sends many.
    pub fn take(&self) -> Vec<Command> {
        let mut commands = std::mem::take(&mut *lock(&self.commands));
        let superseded: Vec<bool> = (0..commands.len())
            .map(|i| commands.get(i + 1).is_some_and(|next| is_superseded(&commands[i], next)))
            .collect();
        let mut superseded = superseded.into_iter();
        commands.retain(|_| superseded.next() == Some(false));
        commands
    }

    /// Wakes the engine on a web page; a thread is woken by its condition variable.
    pub fn wake(&self) {
        #[cfg(target_arch = "wasm32")]
        if let Some(waker) = lock(&self.waker).take() {
            waker.wake();
        }
    }

    /// Sleeps until a command arrives, at most this long; on a web page until the next frame.
    #[cfg(not(target_arch = "wasm32"))]
    pub async fn sleep(&self, at_most: Duration) {
        let commands = lock(&self.commands);
        if commands.is_empty() {
            drop(self.arrived.wait_timeout(commands, at_most));
        }
    }

    /// Sleeps until a command arrives, at most this long; on a web page until the next frame.
    #[cfg(target_arch = "wasm32")]
    pub async fn sleep(&self, _: Duration) {
        // Commands that arrived while the engine was busy did not wake it.
        let mut slept = !lock(&self.commands).is_empty();
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

/// Whether the first command has no effect if the second follows.
fn is_superseded(command: &Command, next: &Command) -> bool {
    use Command as C;
    matches!(
        (command, next),
        (C::Change(_), C::Change(_) | C::Open(_) | C::Resume(_))
            | (C::Open(_) | C::Resume(_), C::Open(_) | C::Resume(_))
            | (C::MouseForce(_), C::MouseForce(_))
            | (C::Grip(_), C::Grip(_))
            | (C::TimeScale(_), C::TimeScale(_))
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_last_of_several_similar_commands_is_executed() {
        let inbox = Inbox::default();
        for scale in [0.1, 0.2, 0.3] {
            inbox.put(Command::TimeScale(scale));
        }
        inbox.put(Command::Play(true));
        inbox.put(Command::TimeScale(0.4));
        let taken = inbox.take();
        assert_eq!(taken.len(), 3);
        assert!(matches!(taken[0], Command::TimeScale(0.3)));
        assert!(matches!(taken[2], Command::TimeScale(0.4)));
        assert!(inbox.take().is_empty());
    }
}
