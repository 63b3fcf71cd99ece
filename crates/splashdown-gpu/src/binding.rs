//! The list of a pass's bindings: one declaration from which WGSL, executors and CPU code follow.

use crate::{Field, GpuElement, GpuStruct};

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

/// How many elements a binding holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// One struct.
    One,
    /// An array whose length is known when the pass runs.
    Array,
    /// An array of this many elements.
    Fixed(usize),
}

/// One binding of a pass. Its number is its index in [`PassDesc::bindings`](crate::PassDesc::bindings), in bind
/// group 0.
#[derive(Clone, Copy, Debug)]
pub struct Binding {
    /// The variable's name in WGSL, which is the label of the buffer.
    pub name: &'static str,
    /// How the pass uses it.
    pub access: Access,
    /// True if the elements are atomic in WGSL.
    pub atomic: bool,
    /// How many elements it holds.
    pub shape: Shape,
    /// The element's type as WGSL spells it, without `atomic<>`.
    pub element: &'static str,
    /// The element's size in bytes.
    pub size: usize,
    /// Members and offsets if the element is a struct.
    pub fields: &'static [Field],
}

impl Binding {
    /// A binding of this type; [`bindings!`](crate::bindings) calls it.
    pub const fn new<T: BindingType + ?Sized>(name: &'static str, access: Access, atomic: bool) -> Self {
        Self {
            name,
            access,
            atomic,
            shape: T::SHAPE,
            element: <T::Element as GpuElement>::WGSL,
            size: size_of::<T::Element>(),
            fields: <T::Element as GpuElement>::FIELDS,
        }
    }

    /// The declaration in WGSL, for the binding of this number.
    pub fn wgsl(&self, number: usize) -> String {
        let space = match self.access {
            Access::Uniform => "uniform",
            Access::Read => "storage, read",
            Access::ReadWrite => "storage, read_write",
        };
        let element = if self.atomic { format!("atomic<{}>", self.element) } else { self.element.to_owned() };
        let ty = match self.shape {
            Shape::One => element,
            Shape::Array => format!("array<{element}>"),
            Shape::Fixed(len) => format!("array<{element}, {len}>"),
        };
        format!("@group(0) @binding({number}) var<{space}> {}: {ty};", self.name)
    }
}

/// A type in a [`bindings!`](crate::bindings) list: a struct, `[T]` or `[T; N]`.
pub trait BindingType {
    /// One element.
    type Element: GpuElement;
    /// How many elements.
    const SHAPE: Shape;

    /// Views the content of a buffer.
    fn view(elements: &[Self::Element]) -> &Self;
    /// Views the content of a buffer, writable.
    fn view_mut(elements: &mut [Self::Element]) -> &mut Self;
}

impl<T: GpuElement> BindingType for [T] {
    type Element = T;
    const SHAPE: Shape = Shape::Array;

    fn view(elements: &[T]) -> &Self {
        elements
    }

    fn view_mut(elements: &mut [T]) -> &mut Self {
        elements
    }
}

impl<T: GpuElement, const N: usize> BindingType for [T; N] {
    type Element = T;
    const SHAPE: Shape = Shape::Fixed(N);

    fn view(elements: &[T]) -> &Self {
        elements.first_chunk().expect("the buffer is as long as the binding")
    }

    fn view_mut(elements: &mut [T]) -> &mut Self {
        elements.first_chunk_mut().expect("the buffer is as long as the binding")
    }
}

impl<T: GpuStruct> BindingType for T {
    type Element = T;
    const SHAPE: Shape = Shape::One;

    fn view(elements: &[T]) -> &Self {
        &elements[0]
    }

    fn view_mut(elements: &mut [T]) -> &mut Self {
        &mut elements[0]
    }
}

/// Declares the bindings of a pass, once for WGSL, executors and CPU code.
///
/// Each line is `name: access type`. The name is the WGSL variable, the label of the buffer and the field for the CPU
/// code. The access is one of:
///
/// | access    | WGSL                             | CPU code      |
/// |-----------|----------------------------------|---------------|
/// | `uniform` | `var<uniform>`                   | `&type`       |
/// | `read`    | `var<storage, read>`             | `&type`       |
/// | `write`   | `var<storage, read_write>`       | `&mut type`   |
/// | `atomic`  | the same, with `atomic` elements | `&mut type`   |
///
/// The type is `[T]` for an array, `[T; N]` for an array of fixed length (uniforms need one), and the name of a
/// [`gpu_struct!`](crate::gpu_struct) for one struct. CPU code that shares an atomic array between threads views it
/// with [`as_atomic`](crate::as_atomic).
///
/// The macro makes a struct with one field per binding, which converts from the slots that the executor passes, and
/// its constant `LIST` for [`PassDesc::bindings`](crate::PassDesc::bindings). In the WGSL the line `#bindings` stands
/// for the declarations of the list.
///
/// ```
/// use splashdown_gpu::{PassDesc, bindings, gpu_struct};
///
/// gpu_struct! {
///     /// Mirrors `Params` in the WGSL.
///     pub struct Params { factor: f32 }
/// }
/// bindings! {
///     /// The buffers of `scale`.
///     pub struct ScaleBindings {
///         params: uniform Params,
///         numbers: write [f32],
///     }
/// }
/// fn scale(ScaleBindings { params, numbers }: ScaleBindings<'_>) {
///     numbers.iter_mut().for_each(|number| *number *= params.factor);
/// }
/// pub static SCALE: PassDesc = PassDesc {
///     label: "scale",
///     wgsl: "
/// #bindings
/// struct Params { factor: f32 }
/// @compute @workgroup_size(64)
/// fn scale(@builtin(global_invocation_id) id: vec3<u32>) {
///     if (id.x < arrayLength(&numbers)) {
///         numbers[id.x] *= params.factor;
///     }
/// }",
///     entry: "scale",
///     imports: &[],
///     workgroup_size: [64, 1, 1],
///     constants: &[],
///     bindings: ScaleBindings::LIST,
///     cpu: |_, slots| scale(slots.into()),
/// };
/// splashdown_gpu::check::check(&SCALE).unwrap();
/// ```
#[macro_export]
macro_rules! bindings {
    ($(#[$meta:meta])* $vis:vis struct $name:ident {
        $($(#[$field_meta:meta])* $field:ident : $access:ident $ty:ty),* $(,)?
    }) => {
        $(#[$meta])*
        $vis struct $name<'a> {
            $(
                $(#[$field_meta])*
                #[doc = concat!("`", stringify!($access), " ", stringify!($ty), "`")]
                pub $field: $crate::bindings!(@view 'a $access $ty)
            ),*
        }

        impl $name<'_> {
            /// The bindings, in order.
            $vis const LIST: &'static [$crate::Binding] = &[$($crate::Binding::new::<$ty>(
                stringify!($field),
                $crate::bindings!(@access $access),
                $crate::bindings!(@atomic $access),
            )),*];
        }

        impl<'a> From<&'a mut [$crate::Slot<'_>]> for $name<'a> {
            fn from(slots: &'a mut [$crate::Slot<'_>]) -> Self {
                let mut slots = slots.iter_mut();
                let views = Self {
                    $($field: $crate::bindings!(@take slots, $field, $access $ty)),*
                };
                // Reads every field, so that CPU code need not use each binding that the WGSL needs.
                let Self { $($field),* } = &views;
                let _ = ($($field,)*);
                views
            }
        }
    };
    (@view $life:lifetime uniform $ty:ty) => { &$life $ty };
    (@view $life:lifetime read $ty:ty) => { &$life $ty };
    (@view $life:lifetime write $ty:ty) => { &$life mut $ty };
    (@view $life:lifetime atomic $ty:ty) => { &$life mut $ty };
    (@access uniform) => { $crate::Access::Uniform };
    (@access read) => { $crate::Access::Read };
    (@access write) => { $crate::Access::ReadWrite };
    (@access atomic) => { $crate::Access::ReadWrite };
    (@atomic atomic) => { true };
    (@atomic $access:ident) => { false };
    (@take $slots:ident, $field:ident, uniform $ty:ty) => {
        $crate::Slot::view::<$ty>($slots.next(), stringify!($field))
    };
    (@take $slots:ident, $field:ident, read $ty:ty) => {
        $crate::Slot::view::<$ty>($slots.next(), stringify!($field))
    };
    (@take $slots:ident, $field:ident, write $ty:ty) => {
        $crate::Slot::view_mut::<$ty>($slots.next(), stringify!($field))
    };
    (@take $slots:ident, $field:ident, atomic $ty:ty) => {
        $crate::Slot::view_mut::<$ty>($slots.next(), stringify!($field))
    };
}
