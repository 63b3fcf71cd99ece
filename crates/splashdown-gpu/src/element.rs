//! Which Rust types may lie in a buffer, and how WGSL spells them.

/// A type that may be the element of a storage buffer.
///
/// The spelling matters because size alone cannot tell `array<vec3<f32>>` from `array<vec4<f32>>`.
pub trait GpuElement: bytemuck::Pod + Send + Sync {
    /// The WGSL spelling of one element, as `naga` reports it: `f32`, `vec4<f32>`, or a struct's name.
    const WGSL: &'static str;
    /// The members and byte offsets, for structs.
    const FIELDS: &'static [Field] = &[];
}

/// One member of a struct: its name and its offset in bytes.
pub type Field = (&'static str, usize);

/// A Rust struct that mirrors a WGSL struct; made by [`gpu_struct!`](crate::gpu_struct).
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

/// Declares a struct that is laid out equally in Rust and in WGSL, with the table that the gate compares.
///
/// Give fields in WGSL's order and fill the padding that WGSL inserts with fields of your own: the gate reports any
/// difference in names, order and offsets.
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
                &[$((stringify!($field), core::mem::offset_of!($name, $field))),*];
        }
        impl $crate::GpuStruct for $name {}
    };
}
