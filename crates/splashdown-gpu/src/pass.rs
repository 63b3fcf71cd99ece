//! One declaration per compute pass, read by the executors, the gate and the tests.

use crate::{Field, GpuElement, GpuStruct, Slot, WgslModule};

/// How a pass uses a binding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// `var<uniform>`
    Uniform,
    /// `var<storage, read>`
    Read,
    /// `var<storage, read_write>`
    ReadWrite,
}

/// One binding of a pass: its place is its index in [`PassDesc::bindings`], in bind group 0.
#[derive(Clone, Copy, Debug)]
pub struct Binding {
    /// The variable's name in WGSL.
    pub name: &'static str,
    /// How the pass uses it.
    pub access: Access,
    /// The element's type as WGSL spells it, without `atomic<>`.
    pub element: &'static str,
    /// The element's size in bytes.
    pub size: usize,
    /// Members and offsets if the element is a struct.
    pub fields: &'static [Field],
}

const fn binding<T: GpuElement>(name: &'static str, access: Access) -> Binding {
    Binding { name, access, element: T::WGSL, size: size_of::<T>(), fields: T::FIELDS }
}

/// Declares a uniform struct.
pub const fn uniform<T: GpuStruct>(name: &'static str) -> Binding {
    binding::<T>(name, Access::Uniform)
}

/// Declares a uniform array of vectors of four.
pub const fn uniform_array(name: &'static str) -> Binding {
    binding::<glam::Vec4>(name, Access::Uniform)
}

/// Declares a storage array, or a storage struct, that the pass reads.
pub const fn read<T: GpuElement>(name: &'static str) -> Binding {
    binding::<T>(name, Access::Read)
}

/// Declares a storage array, or a storage struct, that the pass reads and writes.
pub const fn write<T: GpuElement>(name: &'static str) -> Binding {
    binding::<T>(name, Access::ReadWrite)
}

/// What a pass's CPU side is asked to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CpuWork {
    /// Number of invocations: the exact number of a [`Grid::Items`](crate::Grid::Items), else workgroups times the
    /// workgroup's size.
    pub items: u32,
    /// Number of workgroups.
    pub groups: u32,
}

/// A compute pass declared as data.
///
/// The WGSL file has one entry point, named by `entry`; its bindings are those of group 0 in the order given here.
pub struct PassDesc {
    /// Name in timings, errors and tests, e.g. `"cells.count"`. Unique.
    pub label: &'static str,
    /// The text of the WGSL file.
    pub wgsl: &'static str,
    /// The modules that `#import` lines in the text may name.
    pub imports: &'static [WgslModule],
    /// The entry point.
    pub entry: &'static str,
    /// Invocations per workgroup; at most 256 in all, which every browser grants.
    pub workgroup_size: [u32; 3],
    /// Values for the WGSL's `override` constants.
    pub constants: &'static [(&'static str, f64)],
    /// The bindings; at most 8 storage buffers, which every browser grants.
    pub bindings: &'static [Binding],
    /// The same work in Rust; receives one slot per binding, in order.
    pub cpu: fn(CpuWork, &mut [Slot<'_>]),
}

impl std::fmt::Debug for PassDesc {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "PassDesc({})", self.label)
    }
}

impl PassDesc {
    /// Invocations per workgroup.
    pub const fn invocations(&self) -> u32 {
        self.workgroup_size[0] * self.workgroup_size[1] * self.workgroup_size[2]
    }
}
