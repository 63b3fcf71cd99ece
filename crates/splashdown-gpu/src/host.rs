//! Buffers in host memory, and how the CPU code of a pass views them.

use std::sync::atomic::AtomicU32;

use bytemuck::{Pod, Zeroable};

use crate::{BindingType, GpuElement};

/// Sixteen bytes aligned to sixteen, so that every element type may be viewed in place.
#[repr(C, align(16))]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Chunk([u8; 16]);

/// A buffer in host memory.
#[derive(Default)]
pub(crate) struct HostBuffer {
    chunks: Vec<Chunk>,
    bytes: usize,
}

impl HostBuffer {
    /// `None` if the memory cannot be allocated. Zeroed memory comes from the system, which provides pages on first use.
    pub(crate) fn new(bytes: u64, fill: u8) -> Option<Self> {
        let bytes = usize::try_from(bytes).ok()?;
        let mut chunks: Vec<Chunk> = bytemuck::try_zeroed_vec(bytes.div_ceil(16)).ok()?;
        if fill != 0 {
            chunks.fill(Chunk([fill; 16]));
        }
        Some(Self { chunks, bytes })
    }

    pub(crate) fn read<T: Pod>(&self) -> &[T] {
        bytemuck::cast_slice(&bytemuck::cast_slice::<_, u8>(&self.chunks)[..self.bytes])
    }

    pub(crate) fn write<T: Pod>(&mut self) -> &mut [T] {
        bytemuck::cast_slice_mut(&mut bytemuck::cast_slice_mut::<_, u8>(&mut self.chunks)[..self.bytes])
    }
}

pub(crate) enum Bytes<'a> {
    Read(&'a [u8]),
    Write(&'a mut [u8]),
}

/// One binding of a dispatch on the CPU; a [`bindings!`](crate::bindings) struct converts from the slots of a pass.
///
/// The executor has already compared the element type with the declaration. A pass whose CPU code views other bindings
/// than it declares panics.
pub struct Slot<'a> {
    name: &'static str,
    bytes: Bytes<'a>,
}

impl<'a> Slot<'a> {
    pub(crate) fn new(name: &'static str, bytes: Bytes<'a>) -> Self {
        Self { name, bytes }
    }

    /// The content of the binding `name`, which must be the next one. [`bindings!`](crate::bindings) calls it.
    #[doc(hidden)]
    pub fn view<'b, T: BindingType + ?Sized>(slot: Option<&'b mut Self>, name: &str) -> &'b T {
        T::view(bytemuck::cast_slice(match &Self::named(slot, name).bytes {
            Bytes::Read(bytes) => bytes,
            Bytes::Write(bytes) => bytes,
        }))
    }

    /// The writable content of the binding `name`, which must be the next one. [`bindings!`](crate::bindings) calls it.
    #[doc(hidden)]
    pub fn view_mut<'b, T: BindingType + ?Sized>(slot: Option<&'b mut Self>, name: &str) -> &'b mut T {
        match &mut Self::named(slot, name).bytes {
            Bytes::Read(_) => {
                panic!("the CPU code writes to binding {name:?}, which the pass declares as read")
            }
            Bytes::Write(bytes) => T::view_mut(bytemuck::cast_slice_mut(bytes)),
        }
    }

    fn named<'b>(slot: Option<&'b mut Self>, name: &str) -> &'b mut Self {
        let found = slot.as_ref().map(|slot| slot.name);
        assert!(found == Some(name), "the CPU code views binding {name:?}, but the pass declares {found:?}");
        slot.expect("it has a name")
    }
}

/// Views exclusively borrowed elements as atomic 32-bit words.
pub fn as_atomic<T: GpuElement>(elements: &mut [T]) -> &[AtomicU32] {
    let words: &mut [u32] = bytemuck::cast_slice_mut(elements);
    // SAFETY: `AtomicU32` has the size, alignment and bit validity of `u32`, and the exclusive borrow guarantees that
    // for its lifetime all accesses to the values use these atomics.
    unsafe { &*(std::ptr::from_mut(words) as *const [AtomicU32]) }
}
