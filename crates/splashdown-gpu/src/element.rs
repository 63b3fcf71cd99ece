//! The Rust types that buffers may hold, and how WGSL spells them.

/// A type that may be the element of a storage buffer.
///
/// The spelling matters because size alone cannot tell `array<vec3<f32>>` from `array<vec4<f32>>`.
pub trait GpuElement: bytemuck::Pod + Send + Sync {
    /// The WGSL spelling of one element, as `naga` reports it: `f32`, `vec4<f32>`, or a struct's name.
    const WGSL: &'static str;
    /// The members and byte offsets, for structs.
    const FIELDS: &'static [Field] = &[];
}

/// One member of a struct.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Field {
    /// Its name.
    pub name: &'static str,
    /// Its offset in bytes.
    pub offset: usize,
    /// Its size in bytes.
    pub size: usize,
    /// The scalar: `f32` for `f32`, `vec3<f32>`, `mat4x4<f32>` and arrays of them; a struct's name.
    pub scalar: &'static str,
}

/// A type that may be a member of a [`gpu_struct!`](crate::gpu_struct).
///
/// The scalar distinguishes `count: u32` from `count: f32`, which have the same name, offset and size.
pub trait GpuMember: bytemuck::Pod {
    /// See [`Field::scalar`].
    const SCALAR: &'static str;
}

macro_rules! members {
    ($scalar:literal: $($ty:ty),*) => { $(impl GpuMember for $ty { const SCALAR: &'static str = $scalar; })* };
}
members!("f32": f32, glam::Vec2, glam::Vec3, glam::Vec4, glam::Mat4);
members!("u32": u32, glam::UVec2, glam::UVec3, glam::UVec4);
members!("i32": i32, glam::IVec2, glam::IVec3, glam::IVec4);
impl<T: GpuMember, const N: usize> GpuMember for [T; N] {
    const SCALAR: &'static str = T::SCALAR;
}

/// A Rust struct that mirrors a WGSL struct; declared by [`gpu_struct!`](crate::gpu_struct).
pub trait GpuStruct: GpuElement {}

impl GpuElement for f32 {
    const WGSL: &'static str = "f32";
}
impl GpuElement for u32 {
    const WGSL: &'static str = "u32";
}
impl GpuElement for i32 {
    const WGSL: &'static str = "i32";
}
impl GpuElement for glam::Vec2 {
    const WGSL: &'static str = "vec2<f32>";
}
impl GpuElement for glam::Vec4 {
    const WGSL: &'static str = "vec4<f32>";
}
impl GpuElement for glam::UVec2 {
    const WGSL: &'static str = "vec2<u32>";
}
impl GpuElement for glam::UVec4 {
    const WGSL: &'static str = "vec4<u32>";
}

/// Declares a struct with the same layout in Rust and in WGSL, with the table that the gate compares.
///
/// Give the fields in the order of the WGSL, and fill the padding that WGSL inserts with explicit fields: the gate
/// reports any difference in names, order, offsets, sizes and scalars.
///
/// ```
/// splashdown_gpu::gpu_struct! {
///     /// Mirrors `Params` in some `.wgsl`.
///     pub struct Params { origin: glam::Vec3, cell_size: f32 }
/// }
/// ```
#[macro_export]
macro_rules! gpu_struct {
    ($(#[$meta:meta])* $vis:vis struct $name:ident { $($(#[$field_meta:meta])* $field:ident : $ty:ty),* $(,)? }) => {
        $(#[$meta])*
        #[repr(C)]
        #[derive(Clone, Copy, Debug, PartialEq, $crate::bytemuck::Pod, $crate::bytemuck::Zeroable)]
        #[bytemuck(crate = "splashdown_gpu::bytemuck")]
        $vis struct $name { $($(#[$field_meta])* pub $field: $ty),* }
        impl $crate::GpuElement for $name {
            const WGSL: &'static str = stringify!($name);
            const FIELDS: &'static [$crate::Field] =
                &[$($crate::Field {
                    name: stringify!($field),
                    offset: core::mem::offset_of!($name, $field),
                    size: size_of::<$ty>(),
                    scalar: <$ty as $crate::GpuMember>::SCALAR,
                }),*];
        }
        impl $crate::GpuMember for $name {
            const SCALAR: &'static str = stringify!($name);
        }
        impl $crate::GpuStruct for $name {}
    };
}
