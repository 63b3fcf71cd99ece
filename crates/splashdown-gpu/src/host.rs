//! Buffers in host memory, and how a pass's CPU side sees them.

use std::cell::{Ref, RefCell, RefMut};
use std::sync::atomic::AtomicU32;

use bytemuck::{Pod, Zeroable};

use crate::GpuElement;

/// Sixteen bytes on a sixteen-byte border, so that every element type may be viewed in place.
#[repr(C, align(16))]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Chunk([u8; 16]);

/// A buffer in host memory.
pub(crate) struct HostBuffer {
    chunks: RefCell<Vec<Chunk>>,
    bytes: usize,
}

impl HostBuffer {
    /// `None` if the memory cannot be had. Zeros come from the system, which gives real memory on first use.
    pub(crate) fn new(bytes: u64, fill: u8) -> Option<Self> {
        let bytes = usize::try_from(bytes).ok()?;
        let mut chunks: Vec<Chunk> = bytemuck::try_zeroed_vec(bytes.div_ceil(16)).ok()?;
        if fill != 0 {
            chunks.fill(Chunk([fill; 16]));
        }
        Some(Self { chunks: RefCell::new(chunks), bytes })
    }

    pub(crate) fn read<T: Pod>(&self) -> Ref<'_, [T]> {
        Ref::map(self.chunks.borrow(), |chunks| {
            bytemuck::cast_slice(&bytemuck::cast_slice::<_, u8>(chunks)[..self.bytes])
        })
    }

    pub(crate) fn write<T: Pod>(&self) -> RefMut<'_, [T]> {
        RefMut::map(self.chunks.borrow_mut(), |chunks| {
            bytemuck::cast_slice_mut(&mut bytemuck::cast_slice_mut::<_, u8>(chunks)[..self.bytes])
        })
    }

    /// Borrowed for one dispatch; `None` if another binding of the same dispatch already holds it.
    pub(crate) fn slot(&self, writable: bool) -> Option<Slot<'_>> {
        Some(Slot {
            bytes: self.bytes,
            held: if writable {
                Held::Write(self.chunks.try_borrow_mut().ok()?)
            } else {
                Held::Read(self.chunks.try_borrow().ok()?)
            },
        })
    }
}

enum Held<'a> {
    Read(Ref<'a, Vec<Chunk>>),
    Write(RefMut<'a, Vec<Chunk>>),
}

/// One binding as the CPU side of a pass sees it.
///
/// The executor has already compared the element type with the declaration; asking for another type, or writing to a
/// binding declared as read, is a bug in the pass and panics.
pub struct Slot<'a> {
    held: Held<'a>,
    bytes: usize,
}

impl Slot<'_> {
    /// The elements.
    pub fn read<T: GpuElement>(&self) -> &[T] {
        let chunks: &[Chunk] = match &self.held {
            Held::Read(chunks) => chunks,
            Held::Write(chunks) => chunks,
        };
        bytemuck::cast_slice(&bytemuck::cast_slice::<_, u8>(chunks)[..self.bytes])
    }

    /// The elements, writable.
    ///
    /// # Panics
    /// If the binding is declared as read or uniform.
    pub fn write<T: GpuElement>(&mut self) -> &mut [T] {
        match &mut self.held {
            Held::Read(_) => panic!("the pass writes to a binding that it declares as read"),
            Held::Write(chunks) => {
                bytemuck::cast_slice_mut(&mut bytemuck::cast_slice_mut::<_, u8>(chunks)[..self.bytes])
            }
        }
    }

    /// The one element of a uniform or of a storage struct.
    pub fn get<T: GpuElement>(&self) -> T {
        self.read::<T>()[0]
    }

    /// The elements as atomics, for passes whose invocations write to the same places.
    pub fn atomics(&mut self) -> &[AtomicU32] {
        as_atomic(self.write::<u32>())
    }
}

/// Views exclusively borrowed integers as atomics.
pub fn as_atomic(values: &mut [u32]) -> &[AtomicU32] {
    // SAFETY: `AtomicU32` has the size, alignment and bit validity of `u32`, and the exclusive borrow guarantees that
    // for its lifetime nobody accesses the values except through these atomics.
    unsafe { &*(std::ptr::from_mut(values) as *const [AtomicU32]) }
}
