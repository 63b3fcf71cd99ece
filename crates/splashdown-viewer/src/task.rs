//! Work on its own thread, so that the window does not wait for it: reading large files, dialogs of the system.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{Receiver, channel};

/// A piece of work in progress. Dropping it discards the result, and does not wait for the thread.
pub struct Task<T> {
    result: Receiver<Result<T, String>>,
}

impl<T: Send + 'static> Task<T> {
    /// Starts a thread. `repaint` is called when the result is there. A panic is a result too: an error that says so.
    ///
    /// # Errors
    /// If the system starts no thread.
    pub fn start(
        name: &str,
        work: impl FnOnce() -> Result<T, String> + Send + 'static,
        repaint: impl FnOnce() + Send + 'static,
    ) -> Result<Self, String> {
        let (sender, result) = channel();
        let body = move || {
            // Nobody receives the result of a task that was dropped.
            let _ = sender.send(caught(work).and_then(|result| result));
            repaint();
        };
        std::thread::Builder::new()
            .name(name.to_owned())
            .spawn(body)
            .map_err(|error| format!("no thread could be started: {error}"))?;
        Ok(Self { result })
    }

    /// The result, once, as soon as it is there.
    pub fn take(&self) -> Option<Result<T, String>> {
        self.result.try_recv().ok()
    }
}

/// The value of a function, or a message if it panics.
pub fn caught<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    // What the function has changed is discarded with its result.
    catch_unwind(AssertUnwindSafe(work))
        .map_err(|panic| format!("a bug in this program ended the work: {}", message(&*panic)))
}

fn message(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<&str>().copied();
    text.or_else(|| panic.downcast_ref::<String>().map(String::as_str)).unwrap_or("no message")
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::channel;
    use std::time::Duration;

    use super::Task;

    /// The result of a task whose repaint was called.
    fn result(work: impl FnOnce() -> Result<u32, String> + Send + 'static) -> Option<Result<u32, String>> {
        let (sender, repainted) = channel();
        let task = Task::start("test", work, move || sender.send(()).unwrap()).unwrap();
        repainted.recv_timeout(Duration::from_secs(30)).unwrap();
        let result = task.take();
        assert_eq!(task.take(), None);
        result
    }

    #[test]
    fn a_result_arrives_before_the_repaint() {
        assert_eq!(result(|| Ok(7)), Some(Ok(7)));
        assert_eq!(result(|| Err("no".to_owned())), Some(Err("no".to_owned())));
    }

    #[test]
    fn a_panic_is_an_error_with_its_message() {
        let index = std::hint::black_box(9);
        let error = result(move || Ok([1, 2][index])).unwrap().unwrap_err();
        assert!(error.contains("bug") && error.contains("index is 9"), "{error}");
    }
}
