//! The sum, the smallest or the largest of many values, in a fixed order.
//!
//! # How it works
//!
//! A workgroup joins each block of 4,096 values, and one workgroup joins what the blocks gave: two dispatches, one for
//! at most 4,096 values. Both are the same pass with different numbers. Inside a workgroup each invocation joins every
//! 256th value, sixteen invocations join sixteen of those each, and one joins the sixteen: two barriers.
//!
//! The order depends on nothing but the number of values, and it is the same in the pass's CPU side, so that a
//! sum has the same bits on every run, on every number of threads and, where the device rounds as IEEE 754
//! says, on both executors.
//!
//! # Why not the other way
//!
//! Atomic sums of floats do not exist in WGSL, and would come in whatever order the device likes.
//!
//! # Not a number
//!
//! WGSL does not say whether the larger of a number and NaN is NaN, so the smallest and the largest of values with NaN
//! among them are unspecified; whoever reduces states counts what is not finite besides. The smallest and the
//! largest of no values are `f32::MAX` and `f32::MIN`.

mod cpu;

use glam::Vec4;

use crate::{Buffer, Executor, GpuElement, GpuError, Grid, PassDesc, Recording, WgslModule};
use crate::{gpu_struct, read, uniform, wgsl, write};

/// Values per invocation of the first dispatch.
const RUN: u32 = 16;

gpu_struct! {
    /// Mirrors `ReduceParams` in `reduce.wgsl`.
    struct ReduceParams {
        /// Number of values.
        len: u32,
        /// Values per invocation.
        run: u32,
        /// Number of blocks.
        blocks: u32,
    }
}

const SUM: u32 = 0;
const SMALLEST: u32 = 1;
const LARGEST: u32 = 2;

/// What to make of the values; of vectors, component by component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operation {
    /// Their sum.
    Sum,
    /// The smallest of them.
    Min,
    /// The largest of them.
    Max,
}

/// A type that can be reduced: `f32` and [`Vec4`].
pub trait Reducible: Element {
    /// The pass that does it.
    #[doc(hidden)]
    fn pass(operation: Operation) -> &'static PassDesc;
}

/// The arithmetic of [`Reducible`] types.
#[doc(hidden)]
pub trait Element: GpuElement {
    fn splat(value: f32) -> Self;
    fn plus(self, other: Self) -> Self;
    fn least(self, other: Self) -> Self;
    fn most(self, other: Self) -> Self;
}

impl Element for f32 {
    fn splat(value: f32) -> Self {
        value
    }
    fn plus(self, other: Self) -> Self {
        self + other
    }
    fn least(self, other: Self) -> Self {
        self.min(other)
    }
    fn most(self, other: Self) -> Self {
        self.max(other)
    }
}

impl Element for Vec4 {
    fn splat(value: f32) -> Self {
        Self::splat(value)
    }
    fn plus(self, other: Self) -> Self {
        self + other
    }
    fn least(self, other: Self) -> Self {
        self.min(other)
    }
    fn most(self, other: Self) -> Self {
        self.max(other)
    }
}

macro_rules! passes {
    ($element:ty, $module:literal: $($name:ident $operation:ident $label:literal),*) => { $(
        static $name: PassDesc = PassDesc {
            label: $label,
            wgsl: include_str!("reduce.wgsl"),
            imports: &[
                wgsl::INDEX,
                WgslModule { name: "reduce/element", source: include_str!($module) },
            ],
            entry: "reduce",
            workgroup_size: [256, 1, 1],
            constants: &[("OPERATION", $operation as f64)],
            bindings: &[
                uniform::<ReduceParams>("params"),
                read::<$element>("values"),
                write::<$element>("results"),
            ],
            cpu: cpu::reduce::<$element, $operation>,
        };
    )* };
}

passes!(f32, "reduce_f32.wgsl": SUM_F32 SUM "reduce.sum.f32", MIN_F32 SMALLEST "reduce.min.f32", MAX_F32 LARGEST "reduce.max.f32");
passes!(Vec4, "reduce_vec4.wgsl": SUM_VEC4 SUM "reduce.sum.vec4", MIN_VEC4 SMALLEST "reduce.min.vec4", MAX_VEC4 LARGEST "reduce.max.vec4");

pub(crate) static PASSES: [&PassDesc; 6] = [&SUM_F32, &MIN_F32, &MAX_F32, &SUM_VEC4, &MIN_VEC4, &MAX_VEC4];

impl Reducible for f32 {
    fn pass(operation: Operation) -> &'static PassDesc {
        match operation {
            Operation::Sum => &SUM_F32,
            Operation::Min => &MIN_F32,
            Operation::Max => &MAX_F32,
        }
    }
}

impl Reducible for Vec4 {
    fn pass(operation: Operation) -> &'static PassDesc {
        match operation {
            Operation::Sum => &SUM_VEC4,
            Operation::Min => &MIN_VEC4,
            Operation::Max => &MAX_VEC4,
        }
    }
}

/// A reduction of a fixed number of values to one, with the buffers that takes.
///
/// ```
/// use splashdown_gpu::{CpuExecutor, Executor, Recording, reduce::{Operation, Reduce}};
/// let mut executor = Executor::from(CpuExecutor::new());
/// let speeds = executor.create_from("speeds", &[1.0_f32, 4.0, 2.5])?;
/// let largest = executor.create::<f32>("largest", 1)?;
/// let reduce = Reduce::new(&mut executor, 3, Operation::Max)?;
/// let mut recording = Recording::new("example");
/// reduce.record(&mut recording, speeds, largest);
/// executor.run(&recording)?;
/// assert_eq!(executor.read(largest)?, [4.0]);
/// # Ok::<(), splashdown_gpu::GpuError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Reduce<T> {
    len: u32,
    pass: &'static PassDesc,
    params: Buffer<ReduceParams>,
    second: Option<Second<T>>,
}

/// What joins the blocks where there are several.
#[derive(Clone, Copy, Debug)]
struct Second<T> {
    blocks: u32,
    params: Buffer<ReduceParams>,
    partial: Buffer<T>,
}

impl<T: Reducible> Reduce<T> {
    /// Prepares reductions of `len` values.
    ///
    /// # Errors
    /// As [`Executor::create`].
    pub fn new(executor: &mut Executor, len: u32, operation: Operation) -> Result<Self, GpuError> {
        let blocks = len.div_ceil(256 * RUN).max(1);
        let params = executor.create_uniform("reduce params", &ReduceParams { len, run: RUN, blocks })?;
        let mut reduce = Self { len, pass: T::pass(operation), params, second: None };
        if blocks > 1 {
            let joined = ReduceParams { len: blocks, run: blocks.div_ceil(256), blocks: 1 };
            reduce.second = Some(Second {
                blocks,
                params: executor.create_uniform("reduce block params", &joined)?,
                partial: executor.create("reduce partial", blocks as usize)?,
            });
        }
        Ok(reduce)
    }

    /// Appends: `result[0]` becomes what the first values of `values` reduce to.
    ///
    /// # Panics
    /// If `values` has fewer elements than this reduction was made for, or `result` none.
    pub fn record(&self, recording: &mut Recording, values: Buffer<T>, result: Buffer<T>) {
        assert!(values.len() >= self.len, "a reduction of {} values was given {values:?}", self.len);
        assert!(!result.is_empty(), "a reduction cannot write {result:?}");
        let (params, values, result) = (self.params.id(), values.id(), result.id());
        match &self.second {
            None => recording.dispatch(self.pass, Grid::Groups(1), &[params, values, result]),
            Some(second) => {
                let partial = second.partial.id();
                recording.dispatch(self.pass, Grid::Groups(second.blocks), &[params, values, partial]);
                recording.dispatch(self.pass, Grid::Groups(1), &[second.params.id(), partial, result]);
            }
        }
    }
}
