//! Objects with state that one thread at a time may use, and that can be closed.

use std::sync::{Mutex, MutexGuard, TryLockError};

use pyo3::PyErr;
use pyo3::exceptions::PyRuntimeError;

use crate::errors::{ClosedError, Result};

/// A value that is used by one thread at a time, until it is closed.
pub struct Guarded<T> {
    what: &'static str,
    value: Mutex<Option<T>>,
}

impl<T> Guarded<T> {
    /// Holds a value. `what` names it in messages.
    pub fn new(what: &'static str, value: T) -> Self {
        Self { what, value: Mutex::new(Some(value)) }
    }

    /// Takes the value for the duration of a call, which may release the interpreter lock and run callbacks. A second call
    /// at the same time is an error; it does not wait.
    ///
    /// # Errors
    /// `ClosedError` after `close`; `RuntimeError` during another call.
    pub fn take(&self) -> Result<Taken<'_, T>> {
        let guard = self.lock()?;
        match *guard {
            Some(_) => Ok(Taken { guard }),
            None => {
                let what = self.what;
                Err(ClosedError::new_err(format!("this {what} is closed: create another one")).into())
            }
        }
    }

    /// Frees the value. Closing twice has no effect.
    ///
    /// # Errors
    /// `RuntimeError` during another call.
    pub fn close(&self) -> Result<()> {
        self.lock()?.take();
        Ok(())
    }

    /// Whether it is closed. True as well during a call that will close it.
    pub fn is_closed(&self) -> bool {
        self.lock().is_ok_and(|guard| guard.is_none())
    }

    fn lock(&self) -> Result<MutexGuard<'_, Option<T>>> {
        match self.value.try_lock() {
            Ok(guard) => Ok(guard),
            // A panic in another call: the state is unknown.
            Err(TryLockError::Poisoned(_)) => {
                Err(self.error("has failed with an internal error: create another one"))
            }
            Err(TryLockError::WouldBlock) => Err(self.error(
                "is in use, by another thread or by the callback that calls it: wait for that call to end",
            )),
        }
    }

    fn error(&self, state: &str) -> crate::errors::Failure {
        let error: PyErr = PyRuntimeError::new_err(format!("this {} {state}", self.what));
        error.into()
    }
}

/// A value during a call.
pub struct Taken<'a, T> {
    guard: MutexGuard<'a, Option<T>>,
}

impl<T> Taken<'_, T> {
    /// The value.
    pub fn get(&mut self) -> &mut T {
        match &mut *self.guard {
            Some(value) => value,
            None => unreachable!("`take` has checked it, and the lock is held"),
        }
    }
}
