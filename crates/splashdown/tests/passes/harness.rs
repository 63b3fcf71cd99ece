//! Runs one pass with given buffers on an executor, and compares its output.

use glam::{UVec2, UVec4, Vec2, Vec4};
use splashdown::MouseForce;
use splashdown::bodies::Body;
use splashdown::cells::Grid;
use splashdown::flow::{Nozzle, SinkShape};
use splashdown::foam::{Diffuse, FoamParams, FoamState};
use splashdown::probes::ProbePoint;
use splashdown::state::{Params, SolveState, StepState, Suspension, ViscousState};
use splashdown_gpu::scan::ScanParams;
use splashdown_gpu::{
    Access, Buffer, BufferSet, DispatchSize, Executor, GpuElement, GpuStruct, PassDesc, Recording, bytemuck,
};

/// The content of one binding.
#[derive(Clone, Debug)]
pub enum Data {
    U32(Vec<u32>),
    F32(Vec<f32>),
    Vec2(Vec<Vec2>),
    Vec4(Vec<Vec4>),
    UVec2(Vec<UVec2>),
    UVec4(Vec<UVec4>),
    Params(Params),
    Grid(Grid),
    State(StepState),
    Solve(SolveState),
    Viscous(ViscousState),
    Suspension(Suspension),
    Scan(ScanParams),
    Nozzles(Vec<Nozzle>),
    Drains(Vec<SinkShape>),
    Probes(Vec<ProbePoint>),
    Bodies(Vec<Body>),
    MouseForce(MouseForce),
    Foam(FoamParams),
    FoamState(FoamState),
    Diffuse(Vec<Diffuse>),
}

impl Data {
    /// The words of the content.
    pub fn words(&self) -> &[u32] {
        match self {
            Self::U32(v) => v,
            Self::F32(v) => bytemuck::cast_slice(v),
            Self::Vec2(v) => bytemuck::cast_slice(v),
            Self::Vec4(v) => bytemuck::cast_slice(v),
            Self::UVec2(v) => bytemuck::cast_slice(v),
            Self::UVec4(v) => bytemuck::cast_slice(v),
            Self::MouseForce(v) => bytemuck::cast_slice(std::slice::from_ref(v)),
            Self::Foam(v) => bytemuck::cast_slice(std::slice::from_ref(v)),
            Self::FoamState(v) => bytemuck::cast_slice(std::slice::from_ref(v)),
            Self::Diffuse(v) => bytemuck::cast_slice(v),
            Self::Nozzles(v) => bytemuck::cast_slice(v),
            Self::Drains(v) => bytemuck::cast_slice(v),
            Self::Probes(v) => bytemuck::cast_slice(v),
            Self::Bodies(v) => bytemuck::cast_slice(v),
            Self::Params(v) => bytemuck::cast_slice(std::slice::from_ref(v)),
            Self::Grid(v) => bytemuck::cast_slice(std::slice::from_ref(v)),
            Self::State(v) => bytemuck::cast_slice(std::slice::from_ref(v)),
            Self::Solve(v) => bytemuck::cast_slice(std::slice::from_ref(v)),
            Self::Viscous(v) => bytemuck::cast_slice(std::slice::from_ref(v)),
            Self::Suspension(v) => bytemuck::cast_slice(std::slice::from_ref(v)),
            Self::Scan(v) => bytemuck::cast_slice(std::slice::from_ref(v)),
        }
    }

    /// The words as floats.
    pub fn floats(&self) -> &[f32] {
        bytemuck::cast_slice(self.words())
    }

    /// As many words of all ones (NaN), as a poisoned buffer has them.
    pub fn poison(&self) -> Self {
        let mut poisoned = self.clone();
        poisoned.words_mut().fill(u32::MAX);
        poisoned
    }

    pub fn words_mut(&mut self) -> &mut [u32] {
        match self {
            Self::U32(v) => v,
            Self::F32(v) => bytemuck::cast_slice_mut(v),
            Self::Vec2(v) => bytemuck::cast_slice_mut(v),
            Self::Vec4(v) => bytemuck::cast_slice_mut(v),
            Self::UVec2(v) => bytemuck::cast_slice_mut(v),
            Self::UVec4(v) => bytemuck::cast_slice_mut(v),
            Self::MouseForce(v) => bytemuck::cast_slice_mut(std::slice::from_mut(v)),
            Self::Foam(v) => bytemuck::cast_slice_mut(std::slice::from_mut(v)),
            Self::FoamState(v) => bytemuck::cast_slice_mut(std::slice::from_mut(v)),
            Self::Diffuse(v) => bytemuck::cast_slice_mut(v),
            Self::Nozzles(v) => bytemuck::cast_slice_mut(v),
            Self::Drains(v) => bytemuck::cast_slice_mut(v),
            Self::Probes(v) => bytemuck::cast_slice_mut(v),
            Self::Bodies(v) => bytemuck::cast_slice_mut(v),
            Self::Params(v) => bytemuck::cast_slice_mut(std::slice::from_mut(v)),
            Self::Grid(v) => bytemuck::cast_slice_mut(std::slice::from_mut(v)),
            Self::State(v) => bytemuck::cast_slice_mut(std::slice::from_mut(v)),
            Self::Solve(v) => bytemuck::cast_slice_mut(std::slice::from_mut(v)),
            Self::Viscous(v) => bytemuck::cast_slice_mut(std::slice::from_mut(v)),
            Self::Suspension(v) => bytemuck::cast_slice_mut(std::slice::from_mut(v)),
            Self::Scan(v) => bytemuck::cast_slice_mut(std::slice::from_mut(v)),
        }
    }

    pub fn params(&mut self) -> &mut Params {
        let Self::Params(params) = self else { panic!("no params") };
        params
    }
}

/// Compares the output of the pass, one entry per written binding in order.
pub type Check = Box<dyn Fn(&[Data]) -> Result<(), String>>;

/// Compares the outputs of two executors.
pub type Compare = Box<dyn Fn(&[Data], &[Data]) -> Result<(), String>>;

/// One pass with its input and the expected output.
pub struct Case {
    pub pass: &'static PassDesc,
    /// What is special about the input.
    pub name: String,
    pub size: DispatchSize,
    /// One entry per binding.
    pub input: Vec<Data>,
    /// GPU against CPU.
    pub compare: Compare,
    /// Against brute force in f64.
    pub oracle: Check,
    /// The smallest wrong change to the input that both comparisons must detect.
    pub control: fn(&mut [Data]),
}

impl Case {
    pub fn title(&self) -> String {
        format!("{}, {}", self.pass.label, self.name)
    }

    /// The contents of the written bindings after the pass.
    pub fn run(&self, executor: &mut Executor) -> Vec<Data> {
        self.run_with(executor, &self.input)
    }

    /// The same after the input has been changed by the negative control.
    pub fn run_control(&self, executor: &mut Executor) -> Vec<Data> {
        let mut input = self.input.clone();
        (self.control)(&mut input);
        self.run_with(executor, &input)
    }

    fn run_with(&self, executor: &mut Executor, input: &[Data]) -> Vec<Data> {
        assert_eq!(input.len(), self.pass.bindings.len(), "{}", self.title());
        let mut buffers = BufferSet::new();
        let mut readers: Vec<Reader> = Vec::new();
        for (data, binding) in input.iter().zip(self.pass.bindings) {
            let uniform = binding.access == Access::Uniform;
            let reader = upload(executor, &mut buffers, binding.name, data, uniform);
            if binding.access == Access::ReadWrite {
                readers.push(reader);
            }
        }
        let mut recording = Recording::new(self.title());
        recording.dispatch(self.pass, self.size, &buffers);
        executor.run(&recording).unwrap_or_else(|error| panic!("{}: {error}", self.title()));
        readers.iter().map(|read| read(executor)).collect()
    }
}

type Reader = Box<dyn Fn(&mut Executor) -> Data>;

fn upload(
    executor: &mut Executor,
    buffers: &mut BufferSet,
    name: &'static str,
    data: &Data,
    uniform: bool,
) -> Reader {
    let mut target = Target { executor, buffers, name, uniform };
    match data {
        Data::U32(v) => target.array(v, Data::U32),
        Data::F32(v) => target.array(v, Data::F32),
        Data::Vec2(v) => target.array(v, Data::Vec2),
        Data::Vec4(v) => target.array(v, Data::Vec4),
        Data::UVec2(v) => target.array(v, Data::UVec2),
        Data::UVec4(v) => target.array(v, Data::UVec4),
        Data::Nozzles(v) => target.array(v, Data::Nozzles),
        Data::Drains(v) => target.array(v, Data::Drains),
        Data::Probes(v) => target.array(v, Data::Probes),
        Data::Bodies(v) => target.array(v, Data::Bodies),
        Data::MouseForce(v) => target.array(&[*v], |v| Data::MouseForce(v[0])),
        Data::FoamState(v) => target.array(&[*v], |v| Data::FoamState(v[0])),
        Data::Diffuse(v) => target.array(v, Data::Diffuse),
        Data::State(v) => target.array(&[*v], |v| Data::State(v[0])),
        Data::Solve(v) => target.array(&[*v], |v| Data::Solve(v[0])),
        Data::Viscous(v) => target.array(&[*v], |v| Data::Viscous(v[0])),
        Data::Suspension(v) => target.array(&[*v], |v| Data::Suspension(v[0])),
        Data::Scan(v) => target.array(&[*v], |v| Data::Scan(v[0])),
        Data::Params(v) => target.uniform(v),
        Data::Foam(v) => target.uniform(v),
        Data::Grid(v) => target.uniform(v),
    }
}

/// The binding that receives the data.
struct Target<'a> {
    executor: &'a mut Executor,
    buffers: &'a mut BufferSet,
    name: &'static str,
    uniform: bool,
}

impl Target<'_> {
    fn array<T: GpuElement>(&mut self, values: &[T], wrap: fn(Vec<T>) -> Data) -> Reader {
        let buffer: Buffer<T> = if self.uniform {
            self.executor.create_small(self.name, values).unwrap()
        } else {
            self.executor.create_from(self.name, values).unwrap()
        };
        self.buffers.add(self.name, buffer);
        Box::new(move |executor| wrap(executor.read(buffer).unwrap()))
    }

    fn uniform<T: GpuStruct>(&mut self, value: &T) -> Reader {
        assert!(self.uniform, "{} is not a uniform", self.name);
        let buffer = self.executor.create_uniform(self.name, value).unwrap();
        self.buffers.add(self.name, buffer);
        Box::new(|_| unreachable!("uniforms are not written"))
    }
}

/// Bit-identical.
pub fn exact(what: &str, a: &[u32], b: &[u32]) -> Result<(), String> {
    match a.iter().zip(b).position(|(a, b)| a != b) {
        Some(k) => Err(format!("{what}: word {k} is {:#x} and {:#x}", a[k], b[k])),
        None if a.len() != b.len() => Err(format!("{what}: {} and {} words", a.len(), b.len())),
        None => Ok(()),
    }
}

/// |a - b| <= tolerance for each entry; poison (the same NaN) equals itself.
pub fn close(what: &str, a: &[f32], b: &[f64], tolerance: &[f64]) -> Result<(), String> {
    assert!(
        a.len() == b.len() && a.len() == tolerance.len(),
        "{what}: {} {} {}",
        a.len(),
        b.len(),
        tolerance.len()
    );
    let far = |k: &usize| {
        let (a, b) = (f64::from(a[*k]), b[*k]);
        !((a - b).abs() <= tolerance[*k] || (a.is_nan() && b.is_nan()) || a == b)
    };
    let wrong: Vec<usize> = (0..a.len()).filter(far).collect();
    let Some(&worst) = wrong.iter().max_by(|&&i, &&j| {
        let excess = |k: usize| (f64::from(a[k]) - b[k]).abs() / tolerance[k];
        excess(i).total_cmp(&excess(j))
    }) else {
        return Ok(());
    };
    Err(format!(
        "{what}: {} of {} differ by more than allowed; the worst, {worst}, is {} and {} (allowed {:e})",
        wrong.len(),
        a.len(),
        a[worst],
        b[worst],
        tolerance[worst]
    ))
}

/// Floats as f64.
pub fn wide(values: &[f32]) -> Vec<f64> {
    values.iter().map(|&v| f64::from(v)).collect()
}
