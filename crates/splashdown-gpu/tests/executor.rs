//! What both executors promise: order, bounds, refusals, resizing, read-back and times.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use splashdown_gpu::{
    Buffer, CpuExecutor, Executor, Flag, GpuError, GpuExecutor, Grid, PassDesc, Recording, gpu_struct,
    testing, uniform, wgsl, write,
};

gpu_struct! {
    /// Mirrors `Params` in the passes' WGSL.
    struct Params {
        len: u32,
        amount: u32,
    }
}

/// Adds `amount` to every element.
static ADD: PassDesc = PassDesc {
    label: "test.add",
    wgsl: "\
#import gpu/index
struct Params { len: u32, amount: u32 }
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read_write> numbers: array<u32>;
@compute @workgroup_size(64)
fn add(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (i < params.len) {
        numbers[i] += params.amount;
    }
}",
    imports: &[wgsl::INDEX],
    entry: "add",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: &[uniform::<Params>("params"), write::<u32>("numbers")],
    cpu: |work, slots| {
        let [params, numbers] = slots else { unreachable!() };
        let Params { len, amount } = params.get();
        numbers.write::<u32>()[..len.min(work.items) as usize]
            .iter_mut()
            .for_each(|number| *number += amount);
    },
};

/// `state` is a number of rounds left, a flag set when there are none, and a number of rounds that did something.
static COUNT_DOWN: PassDesc = PassDesc {
    label: "test.count_down",
    wgsl: "\
@group(0) @binding(0) var<storage, read_write> state: array<u32>;
@compute @workgroup_size(1)
fn count_down() {
    if (state[1] != 0u) {
        return;
    }
    state[0] -= 1u;
    state[1] = select(0u, 1u, state[0] == 0u);
    state[2] += 1u;
}",
    imports: &[],
    entry: "count_down",
    workgroup_size: [1, 1, 1],
    constants: &[],
    bindings: &[write::<u32>("state")],
    cpu: |_, slots| {
        ROUNDS.fetch_add(1, Ordering::Relaxed);
        let state = slots[0].write::<u32>();
        if state[1] == 0 {
            state[0] -= 1;
            state[1] = u32::from(state[0] == 0);
            state[2] += 1;
        }
    },
};

/// How often the CPU side of [`COUNT_DOWN`] ran.
static ROUNDS: AtomicU32 = AtomicU32::new(0);

/// A recording that adds `amount` to all numbers, with its uniform.
fn adding(executor: &mut Executor, numbers: Buffer<u32>, amount: u32) -> (Recording, Buffer<Params>) {
    let params = executor.create_uniform("params", &Params { len: numbers.len(), amount }).unwrap();
    let mut recording = Recording::new("adding");
    recording.dispatch(&ADD, Grid::Items(numbers.len()), &[params.id(), numbers.id()]);
    (recording, params)
}

#[test]
fn commands_run_in_order() {
    for (name, mut executor) in testing::executors("commands_run_in_order") {
        let numbers = executor.create_from("numbers", &[1_u32, 2, 3]).unwrap();
        let copied = executor.create_from("copied", &[9_u32; 5]).unwrap();
        let empty = executor.create::<u32>("empty", 0).unwrap();
        let (add, params) = adding(&mut executor, numbers, 10);
        let mut recording = Recording::new("in order");
        recording.append(&add);
        recording.copy(numbers, copied);
        recording.copy(empty, copied);
        recording.append(&add);
        executor.run(&recording).unwrap();
        assert_eq!(executor.read(numbers).unwrap(), [21, 22, 23], "{name}");
        assert_eq!(executor.read(copied).unwrap(), [11, 12, 13, 9, 9], "{name}");
        // Uniforms are read when the recording runs, not when it is written.
        executor.write(params, &[Params { len: 1, amount: 5 }]).unwrap();
        recording.clear(copied);
        executor.run(&recording).unwrap();
        assert_eq!(executor.read(numbers).unwrap(), [31, 22, 23], "{name}");
        assert_eq!(executor.read(copied).unwrap(), [0; 5], "{name}");
    }
}

#[test]
fn repetition_stops_at_the_flag_and_at_the_bound() {
    for (name, mut executor) in testing::executors("repetition_stops_at_the_flag_and_at_the_bound") {
        let state = executor.create_from("state", &[5_u32, 0, 0]).unwrap();
        let mut round = Recording::new("round");
        round.dispatch(&COUNT_DOWN, Grid::Groups(1), &[state.id()]);
        let mut recording = Recording::new("repeat");
        recording.repeat(&round, 20, Flag::new(state, 4));
        ROUNDS.store(0, Ordering::Relaxed);
        executor.run(&recording).unwrap();
        assert_eq!(executor.read(state).unwrap(), [0, 1, 5], "{name}: the flag");
        if name == "CPU" {
            assert_eq!(ROUNDS.load(Ordering::Relaxed), 5, "rounds after the flag must not run at all");
        }
        executor.write(state, &[50, 0, 0]).unwrap();
        executor.run(&recording).unwrap();
        assert_eq!(executor.read(state).unwrap(), [30, 0, 20], "{name}: the bound");
    }
}

#[test]
fn indirect_dispatches_take_their_size_from_a_buffer() {
    for (name, mut executor) in testing::executors("indirect_dispatches_take_their_size_from_a_buffer") {
        let numbers = executor.create_from("numbers", &vec![0_u32; 1000]).unwrap();
        let arguments = executor.create_from("arguments", &[7_u32, 2, 1, 1]).unwrap();
        let params = executor.create_uniform("params", &Params { len: 1000, amount: 1 }).unwrap();
        let mut recording = Recording::new("indirect");
        let grid = Grid::Indirect { buffer: arguments.id(), word: 1 };
        recording.dispatch(&ADD, grid, &[params.id(), numbers.id()]);
        executor.run(&recording).unwrap();
        let ones = |count: usize| [vec![1; count], vec![0; 1000 - count]].concat();
        assert_eq!(executor.read(numbers).unwrap(), ones(128), "{name}: two workgroups");
        for (words, total) in [([0, 1, 1], 128), ([3, 2, 1], 384 + 128)] {
            executor.write(arguments, &[7, words[0], words[1], words[2]]).unwrap();
            executor.run(&recording).unwrap();
            let sum: u32 = executor.read(numbers).unwrap().iter().sum();
            assert_eq!(sum, total, "{name}: {words:?} workgroups");
        }
    }
}

#[test]
fn two_dimensions_reach_the_last_element() {
    let len = 65_536 * 64 + 1;
    for (name, mut executor) in testing::executors("two_dimensions_reach_the_last_element") {
        let numbers = executor.create_from("numbers", &vec![3_u32; len]).unwrap();
        let (recording, _) = adding(&mut executor, numbers, 1);
        executor.run(&recording).unwrap();
        assert!(executor.read(numbers).unwrap().iter().all(|number| *number == 4), "{name}");
    }
}

#[test]
fn commands_that_do_not_fit_are_refused_before_anything_runs() {
    for (name, mut executor) in
        testing::executors("commands_that_do_not_fit_are_refused_before_anything_runs")
    {
        let numbers = executor.create_from("numbers", &[1_u32, 2, 3]).unwrap();
        let short = executor.create::<u32>("short", 2).unwrap();
        let floats = executor.create::<f32>("floats", 3).unwrap();
        let storage_params = executor.create::<Params>("storage params", 1).unwrap();
        let (add, params) = adding(&mut executor, numbers, 10);
        let foreign = {
            let mut other = Executor::from(CpuExecutor::new());
            (0..20).map(|_| other.create::<u32>("foreign", 3).unwrap()).last().unwrap()
        };
        let (p, n) = (params.id(), numbers.id());
        let items = Grid::Items(3);
        let indirect = |buffer, word| Grid::Indirect { buffer, word };
        type Record<'a> = Box<dyn Fn(&mut Recording) + 'a>;
        let cases: [(&str, Record<'_>); 14] = [
            ("wrong type", Box::new(|r| r.dispatch(&ADD, items, &[p, floats.id()]))),
            ("too few", Box::new(|r| r.dispatch(&ADD, items, &[p]))),
            ("too many", Box::new(|r| r.dispatch(&ADD, items, &[p, n, n]))),
            ("swapped", Box::new(|r| r.dispatch(&ADD, items, &[n, p]))),
            ("storage as uniform", Box::new(|r| r.dispatch(&ADD, items, &[storage_params.id(), n]))),
            ("bound twice", Box::new(|r| r.dispatch(&TWICE, items, &[n, n]))),
            ("of another executor", Box::new(|r| r.dispatch(&ADD, items, &[p, foreign.id()]))),
            ("arguments too short", Box::new(|r| r.dispatch(&ADD, indirect(short.id(), 0), &[p, n]))),
            ("arguments past the end", Box::new(|r| r.dispatch(&ADD, indirect(n, 1), &[p, n]))),
            ("arguments written", Box::new(|r| r.dispatch(&ADD, indirect(n, 0), &[p, n]))),
            ("copy to a shorter one", Box::new(|r| r.copy(numbers, short))),
            ("copy to itself", Box::new(|r| r.copy(numbers, numbers))),
            ("clear of another executor's", Box::new(|r| r.clear(foreign))),
            ("flag past the end", Box::new(|r| r.repeat(&add, 2, Flag::new(numbers, 12)))),
        ];
        for (what, record) in cases {
            let mut recording = add.clone();
            record(&mut recording);
            let error = executor.run(&recording).expect_err(what);
            assert!(
                matches!(error, GpuError::BadBinding { .. } | GpuError::BadCommand { .. }),
                "{name}, {what}: {error}"
            );
            assert_eq!(executor.read(numbers).unwrap(), [1, 2, 3], "{name}, {what}: something ran");
        }
        executor.run(&add).unwrap();
        assert_eq!(executor.read(numbers).unwrap(), [11, 12, 13], "{name}: the control");
    }
}

/// Would write one buffer through two bindings.
static TWICE: PassDesc = PassDesc {
    label: "test.twice",
    wgsl: "",
    imports: &[],
    entry: "twice",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: &[write::<u32>("a"), write::<u32>("b")],
    cpu: |_, _| panic!("refused before"),
};

#[test]
fn a_shader_that_does_not_compile_is_an_error_with_its_name() {
    let Some(gpu) = testing::gpu_or_skip("a_shader_that_does_not_compile_is_an_error_with_its_name") else {
        return;
    };
    let mut executor = Executor::from(GpuExecutor::new(gpu));
    let [a, b] = [1, 2].map(|len| executor.create::<u32>("buffer", len).unwrap().id());
    let mut recording = Recording::new("bad");
    recording.dispatch(&TWICE, Grid::Items(1), &[a, b]);
    let error = executor.run(&recording).unwrap_err();
    assert!(matches!(error, GpuError::BadShader { pass: "test.twice", .. }), "{error}");
}

#[test]
fn resizing_keeps_recordings_valid() {
    for (name, mut executor) in testing::executors("resizing_keeps_recordings_valid") {
        let mut numbers = executor.create_from("numbers", &[1_u32; 3]).unwrap();
        let old_handle = numbers;
        let (recording, params) = adding(&mut executor, numbers, 1);
        executor.run(&recording).unwrap();
        let before = executor.bytes();
        executor.resize(&mut numbers, 60).unwrap();
        assert_eq!(numbers.len(), 60);
        assert_eq!(executor.bytes() - before, 57 * 4);
        executor.write(numbers, &[7; 60]).unwrap();
        executor.write(params, &[Params { len: 60, amount: 1 }]).unwrap();
        executor.run(&recording).unwrap();
        let after = executor.read(numbers).unwrap();
        assert_eq!(after[..3], [8; 3], "{name}: the recording has three items");
        assert_eq!(after.len(), 60, "{name}");
        assert_eq!(executor.read(old_handle).unwrap(), after, "{name}: a handle copied before");
        executor.resize(&mut numbers, 0).unwrap();
        assert_eq!(executor.read(numbers).unwrap(), [], "{name}");
    }
}

#[test]
fn a_buffer_that_is_too_large_is_refused_with_what_fits() {
    for (name, mut executor) in testing::executors("a_buffer_that_is_too_large_is_refused_with_what_fits") {
        let most = executor.largest_buffer() / 4;
        let len = usize::try_from(most.max(u64::from(u32::MAX)) + 1).unwrap();
        let error = executor.create::<u32>("positions", len).unwrap_err();
        let GpuError::TooLarge { label, len: asked, fits, .. } = &error else { panic!("{name}: {error}") };
        assert_eq!((label.as_str(), *asked), ("positions", len as u64), "{name}");
        assert!(*fits < *asked && error.to_string().contains(&fits.to_string()), "{name}: {error}");
        let mut small = executor.create_from("small", &[1_u32]).unwrap();
        assert!(executor.resize(&mut small, len).is_err(), "{name}");
        assert_eq!(executor.read(small).unwrap(), [1], "{name}: a refused resize leaves the buffer");
    }
    if let Some(gpu) = testing::gpu_or_skip("a_buffer_that_is_too_large_is_refused_with_what_fits") {
        let most = gpu.largest_buffer() / 4;
        let mut executor = Executor::from(GpuExecutor::new(gpu));
        if let Ok(len) = u32::try_from(most + 1) {
            let error = executor.create::<u32>("positions", len as usize).unwrap_err();
            assert!(matches!(error, GpuError::TooLarge { fits, .. } if fits == most), "{error}");
        }
    }
}

#[test]
fn new_buffers_are_zero_or_poisoned() {
    for (name, mut executor) in testing::executors("new_buffers_are_zero_or_poisoned") {
        let poisoned = executor.create::<f32>("poisoned", 3).unwrap();
        assert!(executor.read(poisoned).unwrap().iter().all(|value| value.is_nan()), "{name}");
        let mut executor = match executor.gpu().cloned() {
            None => Executor::from(CpuExecutor::new()),
            Some(gpu) => Executor::from(GpuExecutor::new(gpu)),
        };
        let zero = executor.create::<f32>("zero", 3).unwrap();
        assert_eq!(executor.read(zero).unwrap(), [0.0; 3], "{name}");
    }
}

#[test]
fn a_read_back_sees_what_was_before_it_and_waits_for_nobody() {
    for (name, mut executor) in testing::executors("a_read_back_sees_what_was_before_it_and_waits_for_nobody")
    {
        let numbers = executor.create_from("numbers", &[1_u32, 2, 3]).unwrap();
        let (recording, _) = adding(&mut executor, numbers, 1);
        let before = executor.request(numbers, 3).unwrap();
        executor.run(&recording).unwrap();
        let first = executor.request(numbers, 1).unwrap();
        executor.run(&recording).unwrap();
        let after = executor.request(numbers, 3).unwrap();
        assert_eq!(after.wait().unwrap(), [3, 4, 5], "{name}");
        assert_eq!(first.wait().unwrap(), [2], "{name}");
        let started = std::time::Instant::now();
        while !before.is_ready().unwrap() {
            assert!(started.elapsed().as_secs() < 20, "{name}: it never becomes ready");
        }
        assert_eq!(before.wait().unwrap(), [1, 2, 3], "{name}");
    }
}

#[test]
fn every_dispatch_is_timed_once_asked_for() {
    for (name, mut executor) in testing::executors("every_dispatch_is_timed_once_asked_for") {
        let numbers = executor.create_from("numbers", &vec![0_u32; 100_000]).unwrap();
        let (mut recording, _) = adding(&mut executor, numbers, 1);
        executor.run(&recording).unwrap();
        assert!(executor.take_timings().passes.is_empty(), "{name}: nobody asked");
        if !executor.enable_timing() {
            eprintln!("{name}: this device has no timestamps");
            continue;
        }
        let copied = executor.create::<u32>("copied", 100_000).unwrap();
        recording.copy(numbers, copied);
        recording.append(&recording.clone());
        executor.run(&recording).unwrap();
        executor.run(&recording).unwrap();
        let timings = executor.take_timings();
        assert_eq!(timings.passes["test.add"].count, 4, "{name}");
        assert!(timings.total() > std::time::Duration::ZERO, "{name}");
        assert!(executor.take_timings().passes.is_empty(), "{name}: taken");
        assert!(executor.read(numbers).unwrap().iter().all(|number| *number == 5), "{name}");
    }
}

#[test]
fn more_dispatches_than_can_be_timed_still_run() {
    for (name, mut executor) in testing::executors("more_dispatches_than_can_be_timed_still_run") {
        let numbers = executor.create_from("numbers", &[0_u32]).unwrap();
        let (add, _) = adding(&mut executor, numbers, 1);
        let mut recording = Recording::new("many");
        (0..2100).for_each(|_| recording.append(&add));
        if executor.enable_timing() {
            executor.run(&recording).unwrap();
            assert_eq!(executor.read(numbers).unwrap(), [2100], "{name}");
            let count = executor.take_timings().passes["test.add"].count;
            assert_eq!(count, if name == "CPU" { 2100 } else { 2048 }, "{name}");
        }
    }
}

#[test]
fn two_threads_read_back_from_one_device() {
    let Some(gpu) = testing::gpu_or_skip("two_threads_read_back_from_one_device") else { return };
    std::thread::scope(|scope| {
        for first in [1_u32, 1000] {
            let gpu = Arc::clone(&gpu);
            scope.spawn(move || {
                let mut executor = Executor::from(GpuExecutor::new(gpu));
                for i in first..first + 300 {
                    let buffer = executor.create_from("numbers", &[i, i + 1]).unwrap();
                    assert_eq!(executor.read(buffer).unwrap(), [i, i + 1]);
                }
            });
        }
    });
}
