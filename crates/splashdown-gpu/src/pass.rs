//! One declaration per compute pass, read by the executors, the gate and the tests.

use std::any::{Any, TypeId};
use std::collections::HashMap;

use crate::{Binding, Slot, WgslModule, wgsl};

/// What the CPU code of passes keeps in an executor from one dispatch to the next: one value per type. A pass may not
/// rely on it: it has to know that a value belongs to the contents of its buffers, by comparing them, or from a
/// counter in them such as the iteration of a solve.
#[derive(Default)]
pub struct Scratch {
    values: HashMap<TypeId, Box<dyn Any + Send + Sync>>,
}

impl Scratch {
    /// The value of a type; the default one the first time.
    pub fn get<T: Any + Send + Sync + Default>(&mut self) -> &mut T {
        let value = self.values.entry(TypeId::of::<T>()).or_insert_with(|| Box::new(T::default()));
        value.downcast_mut().expect("the key is the type of the value")
    }
}

/// The amount of work of one dispatch, for the CPU code of a pass.
pub struct CpuWork<'a> {
    /// Number of invocations: the exact number of a [`DispatchSize::Items`](crate::DispatchSize::Items), otherwise
    /// workgroups times the size of a workgroup.
    pub items: u32,
    /// Number of workgroups.
    pub groups: u32,
    /// Values that outlive the dispatch.
    pub scratch: &'a mut Scratch,
}

/// A compute pass declared as data.
///
/// The WGSL file has one entry point, named by `entry`, and the line `#bindings` in place of its bindings.
pub struct PassDesc {
    /// Name in timings, errors and tests, e.g. `"cells.count"`. Unique.
    pub label: &'static str,
    /// The text of the WGSL file.
    pub wgsl: &'static str,
    /// The modules that `#import` lines in the text may name.
    pub imports: &'static [WgslModule],
    /// The entry point, which has the name of the file.
    pub entry: &'static str,
    /// Invocations per workgroup; at most 256 in all, the limit that every browser grants.
    pub workgroup_size: [u32; 3],
    /// Values for the WGSL's `override` constants.
    pub constants: &'static [(&'static str, f64)],
    /// The bindings: the `LIST` of a [`bindings!`](crate::bindings) struct. At most 8 storage buffers, the limit that
    /// every browser grants.
    pub bindings: &'static [Binding],
    /// The same work in Rust. The slots convert into the [`bindings!`](crate::bindings) struct.
    pub cpu: fn(CpuWork<'_>, &mut [Slot<'_>]),
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

    /// The complete WGSL: imports pasted, bindings declared.
    ///
    /// # Errors
    /// The name of an import that [`imports`](Self::imports) lacks.
    pub fn source(&self) -> Result<String, String> {
        wgsl::expand(self.wgsl, self.imports, self.bindings)
    }
}
