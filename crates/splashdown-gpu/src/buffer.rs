//! Handles of buffers, and sets of them by name.

use std::fmt;
use std::hash::{Hash, Hasher};
use std::marker::PhantomData;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::GpuElement;

/// Identifies a buffer of one [`Executor`](crate::Executor).
///
/// Identifiers are never reused, so an executor recognises one whose buffer was freed or belongs to another executor.
#[derive(Clone, Copy)]
pub struct BufferId {
    /// The index in the executor's tables; reused after a buffer is freed.
    pub(crate) slot: u32,
    /// Unique in this process.
    serial: u64,
    label: &'static str,
}

impl BufferId {
    /// A new identifier for the buffer in this slot.
    pub(crate) fn new(slot: u32, label: &'static str) -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(0);
        Self { slot, serial: NEXT.fetch_add(1, Ordering::Relaxed), label }
    }

    /// The label given when the buffer was created.
    pub fn label(&self) -> &'static str {
        self.label
    }
}

impl PartialEq for BufferId {
    fn eq(&self, other: &Self) -> bool {
        self.serial == other.serial
    }
}

impl Eq for BufferId {}

impl Hash for BufferId {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.serial.hash(state);
    }
}

impl fmt::Debug for BufferId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "buffer {:?}", self.label)
    }
}

/// A buffer of `T` in one [`Executor`](crate::Executor). A plain handle: copying it copies no data.
pub struct Buffer<T> {
    pub(crate) id: BufferId,
    pub(crate) len: u32,
    pub(crate) element: PhantomData<fn() -> T>,
}

impl<T> Clone for Buffer<T> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<T> Copy for Buffer<T> {}

impl<T> fmt::Debug for Buffer<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?} of {} elements", self.id, self.len)
    }
}

impl<T> Buffer<T> {
    /// The identifier that commands use.
    pub fn id(&self) -> BufferId {
        self.id
    }

    /// The label given when the buffer was created.
    pub fn label(&self) -> &'static str {
        self.id.label
    }

    /// Number of elements.
    pub fn len(&self) -> u32 {
        self.len
    }

    /// True if it has no elements.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }
}

impl<T> From<Buffer<T>> for BufferId {
    fn from(buffer: Buffer<T>) -> Self {
        buffer.id
    }
}

/// Buffers by name: a [`Recording`](crate::Recording) looks up the bindings of a pass here, so that no recording site
/// lists buffers in an order.
///
/// ```
/// use splashdown_gpu::{Buffer, BufferSet, CpuExecutor, Executor, buffer_set};
/// struct Fields {
///     positions: Buffer<f32>,
///     ids: Buffer<u32>,
/// }
/// let mut executor = Executor::from(CpuExecutor::new());
/// let fields =
///     Fields { positions: executor.create("positions", 10)?, ids: executor.create("ids", 10)? };
/// let buffers: BufferSet = buffer_set!(fields => positions, ids);
/// # Ok::<(), splashdown_gpu::GpuError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct BufferSet {
    entries: Vec<Entry>,
}

#[derive(Clone, Copy, Debug)]
struct Entry {
    name: &'static str,
    id: BufferId,
    /// Chosen by [`BufferSet::with`]: takes precedence, and may have any label.
    explicit: bool,
}

impl BufferSet {
    /// An empty set.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a buffer under its label. `name` must equal the label: [`buffer_set!`](crate::buffer_set) passes the name
    /// of the field that holds the buffer, so that a field that holds another field's buffer is found. A pass that
    /// binds a name whose label differs is refused.
    pub fn add<T: GpuElement>(&mut self, name: &'static str, buffer: Buffer<T>) {
        self.entries.push(Entry { name, id: buffer.id, explicit: false });
    }

    /// Adds all buffers of another set.
    pub fn extend(&mut self, other: &Self) {
        self.entries.extend_from_slice(&other.entries);
    }

    /// This set and the buffers of another one.
    #[must_use]
    pub fn and(mut self, other: &Self) -> Self {
        self.extend(other);
        self
    }

    /// Binds this buffer to `name`, whatever its label is and whatever else the set holds. For passes that serve many
    /// buffers, such as a scan.
    #[must_use]
    pub fn with<T: GpuElement>(mut self, name: &'static str, buffer: Buffer<T>) -> Self {
        self.entries.retain(|entry| !(entry.explicit && entry.name == name));
        self.entries.push(Entry { name, id: buffer.id, explicit: true });
        self
    }

    /// The buffers, for [`Executor::free`](crate::Executor::free).
    pub fn ids(&self) -> impl Iterator<Item = BufferId> {
        self.entries.iter().map(|entry| entry.id)
    }

    /// The buffer of this name, or what is wrong with it.
    pub(crate) fn find(&self, name: &str) -> Result<BufferId, String> {
        let mut found = self.entries.iter().filter(|entry| entry.name == name);
        if let Some(entry) = found.clone().find(|entry| entry.explicit) {
            return Ok(entry.id);
        }
        let Some(first) = found.next() else {
            let mut names: Vec<_> = self.entries.iter().map(|entry| entry.name).collect();
            names.sort_unstable();
            names.dedup();
            return Err(format!("binding {name:?}: the set has no buffer of this name, only {names:?}"));
        };
        if found.any(|other| other.id != first.id) {
            return Err(format!("binding {name:?}: the set has two buffers of this name"));
        }
        if first.id.label != name {
            return Err(format!("binding {name:?}: the set holds {:?} under this name", first.id));
        }
        Ok(first.id)
    }
}

/// A [`BufferSet`] of some fields of a value; each buffer's label must be the name of its field.
#[macro_export]
macro_rules! buffer_set {
    ($owner:expr => $($field:ident),* $(,)?) => {{
        let mut set = $crate::BufferSet::new();
        $(set.add(stringify!($field), $owner.$field);)*
        set
    }};
}
