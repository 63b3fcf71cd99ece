//! A cache inside a scene for the data that higher modules build from it.

use std::any::Any;
use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

/// Caches data built from a scene and its files, so that it is not built twice. Its type is defined by the
/// module that builds it. Clones of a scene share the cache; comparisons ignore it.
#[derive(Clone, Default)]
pub(crate) struct BuiltSlot(Arc<Mutex<Option<Arc<dyn Any + Send + Sync>>>>);

impl BuiltSlot {
    /// The value, if it is of this type.
    pub fn get<T: Any + Send + Sync>(&self) -> Option<Arc<T>> {
        let value = self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()?;
        value.downcast().ok()
    }

    /// Replaces the value.
    pub fn set<T: Any + Send + Sync>(&self, value: Arc<T>) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some(value);
    }
}

impl PartialEq for BuiltSlot {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl fmt::Debug for BuiltSlot {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("BuiltSlot")
    }
}
