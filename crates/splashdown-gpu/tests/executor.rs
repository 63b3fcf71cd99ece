//! The guarantees of both executors: order, bounds, rejected commands, resizing, read-back and times.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use splashdown_gpu::{
    Buffer, BufferSet, CpuExecutor, DispatchSize, Executor, Flag, GpuError, GpuExecutor, PassDesc, Recording,
    Rounds, bindings, gpu_struct, testing, wgsl,
};

gpu_struct! {
    /// Mirrors `Params` in the passes' WGSL.
    struct Params {
        len: u32,
        amount: u32,
    }
}

bindings! {
    struct AddBindings {
        params: uniform Params,
        numbers: write [u32],
    }
}

bindings! {
    struct CountDownBindings {
        state: write [u32],
    }
}

bindings! {
    struct TwiceBindings {
        a: write [u32],
        b: write [u32],
    }
}

/// Adds `amount` to every element.
static ADD: PassDesc = PassDesc {
    label: "test.add",
    wgsl: "\
#import gpu/index
struct Params { len: u32, amount: u32 }
#bindings
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
    bindings: AddBindings::LIST,
    cpu: |work, slots| {
        let AddBindings { params: Params { len, amount }, numbers } = slots.into();
        numbers[..*len.min(&work.items) as usize].iter_mut().for_each(|number| *number += amount);
    },
};

/// `state` contains the remaining rounds, a flag that is set when none remain, and the number of effective rounds.
static COUNT_DOWN: PassDesc = PassDesc {
    label: "test.count_down",
    wgsl: "\
#bindings
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
    bindings: CountDownBindings::LIST,
    cpu: |_, slots| {
        ROUNDS.fetch_add(1, Ordering::Relaxed);
        let CountDownBindings { state } = slots.into();
        if state[1] == 0 {
            state[0] -= 1;
            state[1] = u32::from(state[0] == 0);
            state[2] += 1;
        }
    },
};

/// Number of runs of the CPU code of [`COUNT_DOWN`].
static ROUNDS: AtomicU32 = AtomicU32::new(0);

/// A recording that adds `amount` to all numbers, with its uniform.
fn adding(executor: &mut Executor, numbers: Buffer<u32>, amount: u32) -> (Recording, Buffer<Params>) {
    let params = executor.create_uniform("params", &Params { len: numbers.len(), amount }).unwrap();
    let mut recording = Recording::new("adding");
    recording.dispatch(&ADD, DispatchSize::Items(numbers.len()), &to_add(params, numbers));
    (recording, params)
}

fn to_add(params: Buffer<Params>, numbers: Buffer<u32>) -> BufferSet {
    BufferSet::new().with("params", params).with("numbers", numbers)
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
        // Uniforms are read when the recording runs, not when it is recorded.
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
        round.dispatch(&COUNT_DOWN, DispatchSize::Groups(1), &BufferSet::new().with("state", state));
        let mut recording = Recording::new("repeat");
        let rounds = Rounds::new(20);
        recording.repeat(&round, &rounds, Flag::new(state, 4));
        ROUNDS.store(0, Ordering::Relaxed);
        executor.run(&recording).unwrap();
        assert_eq!(executor.read(state).unwrap(), [0, 1, 5], "{name}: the flag");
        if name == "CPU" {
            assert_eq!(ROUNDS.load(Ordering::Relaxed), 5, "rounds after the flag must not run at all");
        }
        executor.write(state, &[50, 0, 0]).unwrap();
        executor.run(&recording).unwrap();
        assert_eq!(executor.read(state).unwrap(), [30, 0, 20], "{name}: the bound");
        for (chosen, done) in [(3, 3), (0, 0), (100, 20)] {
            rounds.set(chosen);
            assert_eq!((rounds.get(), rounds.most()), (done, 20));
            executor.write(state, &[50, 0, 0]).unwrap();
            executor.run(&recording).unwrap();
            let expected = [50 - done, 0, done];
            assert_eq!(executor.read(state).unwrap(), expected, "{name}: {chosen} rounds, same recording");
        }
    }
}

#[test]
fn indirect_dispatches_take_their_size_from_a_buffer() {
    for (name, mut executor) in testing::executors("indirect_dispatches_take_their_size_from_a_buffer") {
        let numbers = executor.create_from("numbers", &vec![0_u32; 1000]).unwrap();
        let arguments = executor.create_from("arguments", &[7_u32, 2, 1, 1]).unwrap();
        let params = executor.create_uniform("params", &Params { len: 1000, amount: 1 }).unwrap();
        let mut recording = Recording::new("indirect");
        let size = DispatchSize::Indirect { buffer: arguments.id(), word: 1 };
        recording.dispatch(&ADD, size, &to_add(params, numbers));
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
fn invalid_commands_are_rejected_before_anything_runs() {
    for (name, mut executor) in testing::executors("invalid_commands_are_rejected_before_anything_runs") {
        let numbers = executor.create_from("numbers", &[1_u32, 2, 3]).unwrap();
        let short = executor.create::<u32>("short", 2).unwrap();
        let floats = executor.create::<f32>("floats", 3).unwrap();
        let storage_params = executor.create::<Params>("storage params", 1).unwrap();
        let (add, params) = adding(&mut executor, numbers, 10);
        let freed = executor.create::<u32>("freed", 3).unwrap();
        executor.free([freed]).unwrap();
        let foreign = {
            let mut other = Executor::from(CpuExecutor::new());
            (0..20).map(|_| other.create::<u32>("foreign", 3).unwrap()).last().unwrap()
        };
        let items = DispatchSize::Items(3);
        let set = BufferSet::new;
        let fits = to_add(params, numbers);
        let indirect = |buffer: Buffer<u32>, word| DispatchSize::Indirect { buffer: buffer.id(), word };
        let twice = set().with("a", numbers).with("b", numbers);
        let state = executor.create::<u32>("state", 3).unwrap();
        let mut unflagged = Recording::new("round");
        unflagged.dispatch(&COUNT_DOWN, DispatchSize::Groups(1), &set().with("state", state));
        unflagged.append(&add);
        let mut clearing = Recording::new("round");
        clearing.dispatch(&COUNT_DOWN, DispatchSize::Groups(1), &set().with("state", state));
        clearing.clear(short);
        let mut inner = Recording::new("round");
        inner.repeat(&add, &Rounds::new(2), Flag::new(numbers, 0));
        type Record<'a> = Box<dyn Fn(&mut Recording) + 'a>;
        let cases: [(&str, &str, Record<'_>); 19] = [
            (
                "wrong type",
                "binding \"numbers\" has elements of type u32",
                Box::new(|r| r.dispatch(&ADD, items, &set().with("params", params).with("numbers", floats))),
            ),
            (
                "missing",
                "binding \"numbers\": the set has no buffer of this name, only [\"params\"]",
                Box::new(|r| r.dispatch(&ADD, items, &set().with("params", params))),
            ),
            (
                "swapped",
                "binding \"params\"",
                Box::new(|r| {
                    r.dispatch(&ADD, items, &set().with("params", numbers).with("numbers", params));
                }),
            ),
            (
                "two buffers of one name",
                "binding \"numbers\": the set has two buffers of this name",
                Box::new(|r| {
                    let mut buffers = set().with("params", params);
                    buffers.add("numbers", numbers);
                    buffers.add("numbers", short);
                    r.dispatch(&ADD, items, &buffers);
                }),
            ),
            (
                "a label that is not the name",
                "binding \"numbers\": the set holds buffer \"short\" under this name",
                Box::new(|r| {
                    let mut buffers = set().with("params", params);
                    buffers.add("numbers", short);
                    r.dispatch(&ADD, items, &buffers);
                }),
            ),
            (
                "storage as uniform",
                "only one is a uniform",
                Box::new(|r| {
                    r.dispatch(&ADD, items, &fits.clone().with("params", storage_params));
                }),
            ),
            ("bound twice", "bound twice and written", Box::new(|r| r.dispatch(&TWICE, items, &twice))),
            (
                "of another executor",
                "buffer \"foreign\" was freed, or belongs to another executor",
                Box::new(|r| r.dispatch(&ADD, items, &fits.clone().with("numbers", foreign))),
            ),
            (
                "freed",
                "buffer \"freed\" was freed",
                Box::new(|r| r.dispatch(&ADD, items, &fits.clone().with("numbers", freed))),
            ),
            (
                "arguments too short",
                "has no 3 words",
                Box::new(|r| r.dispatch(&ADD, indirect(short, 0), &fits)),
            ),
            (
                "arguments past the end",
                "has no 3 words from word 1 on",
                Box::new(|r| r.dispatch(&ADD, indirect(numbers, 1), &fits)),
            ),
            (
                "arguments written",
                "writes to its own indirect arguments",
                Box::new(|r| r.dispatch(&ADD, indirect(numbers, 0), &fits)),
            ),
            ("copy to a shorter one", "cannot be copied", Box::new(|r| r.copy(numbers, short))),
            ("copy to itself", "cannot be copied", Box::new(|r| r.copy(numbers, numbers))),
            ("clear of another executor's", "\"foreign\"", Box::new(|r| r.clear(foreign))),
            (
                "flag past the end",
                "has no 1 words from word 3 on",
                Box::new(|r| r.repeat(&add, &Rounds::new(2), Flag::new(numbers, 12))),
            ),
            (
                "a repeated pass without the flag",
                "pass test.add is repeated until a flag in buffer \"state\"",
                Box::new(|r| r.repeat(&unflagged, &Rounds::new(2), Flag::new(state, 4))),
            ),
            (
                "a repeated clear",
                "a copy or clear is repeated",
                Box::new(|r| r.repeat(&clearing, &Rounds::new(2), Flag::new(state, 4))),
            ),
            (
                "a pass without the flag of the outer repetition",
                "until a flag in buffer \"state\"",
                Box::new(|r| r.repeat(&inner, &Rounds::new(2), Flag::new(state, 4))),
            ),
        ];
        for (what, reason, record) in cases {
            let mut recording = add.clone();
            record(&mut recording);
            let error = executor.run(&recording).expect_err(what);
            assert!(
                matches!(error, GpuError::BadBinding { .. } | GpuError::BadCommand { .. }),
                "{name}, {what}: {error}"
            );
            assert!(error.to_string().contains(reason), "{name}, {what}: {error}");
            assert_eq!(executor.read(numbers).unwrap(), [1, 2, 3], "{name}, {what}: something ran");
        }
        executor.run(&add).unwrap();
        assert_eq!(executor.read(numbers).unwrap(), [11, 12, 13], "{name}: the control");
    }
}

/// A pass that would write one buffer through two bindings.
static TWICE: PassDesc = PassDesc {
    label: "test.twice",
    wgsl: "",
    imports: &[],
    entry: "twice",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: TwiceBindings::LIST,
    cpu: |_, _| panic!("the pass must be rejected before it runs"),
};

#[test]
fn a_shader_that_does_not_compile_is_an_error_with_the_pass_name() {
    let Some(gpu) = testing::gpu_or_skip("a_shader_that_does_not_compile_is_an_error_with_the_pass_name")
    else {
        return;
    };
    let mut executor = Executor::from(GpuExecutor::new(gpu));
    let [a, b] = [1, 2].map(|len| executor.create::<u32>("buffer", len).unwrap());
    let mut recording = Recording::new("bad");
    recording.dispatch(&TWICE, DispatchSize::Items(1), &BufferSet::new().with("a", a).with("b", b));
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
fn executors_are_send_and_sync() {
    fn shared<T: Send + Sync>() {}
    shared::<Executor>();
    shared::<Recording>();
    shared::<splashdown_gpu::Readback<f32>>();
}

#[test]
fn freed_buffers_cannot_be_used_and_release_their_memory() {
    for (name, mut executor) in testing::executors("freed_buffers_cannot_be_used_and_release_their_memory") {
        let numbers = executor.create_from("numbers", &[1_u32; 1000]).unwrap();
        let other = executor.create_from("other", &[5_u32; 10]).unwrap();
        let (recording, params) = adding(&mut executor, numbers, 1);
        executor.run(&recording).unwrap();
        let before = executor.bytes();
        executor.free([numbers]).unwrap();
        assert_eq!(before - executor.bytes(), 4000, "{name}");
        // The new buffer reuses the slot of the freed one; the old handle does not refer to it.
        let mut again = executor.create_from("again", &[7_u32; 3]).unwrap();
        let mut stale = numbers;
        let copy = |from, to| {
            let mut recording = Recording::new("copy");
            recording.copy(from, to);
            recording
        };
        let uses = [
            ("run", executor.run(&recording).unwrap_err()),
            ("read", executor.read(numbers).unwrap_err()),
            ("read_first", executor.read_first(numbers, 0).unwrap_err()),
            ("request", executor.request(numbers, 1).err().unwrap()),
            ("write", executor.write(numbers, &[1]).unwrap_err()),
            ("resize", executor.resize(&mut stale, 5).unwrap_err()),
            ("free", executor.free([numbers]).unwrap_err()),
            ("free with others", executor.free([again, numbers]).unwrap_err()),
            ("copy from", executor.run(&copy(numbers, other)).unwrap_err()),
            ("copy to", executor.run(&copy(other, numbers)).unwrap_err()),
        ];
        for (what, error) in uses {
            let message = "buffer \"numbers\" was freed, or belongs to another executor";
            assert!(error.to_string().contains(message), "{name}, {what}: {error}");
        }
        assert!(
            executor.wgpu_buffer(numbers.id()).is_none() && executor.with_host(numbers, |_| ()).is_none()
        );
        assert_eq!(executor.read(again).unwrap(), [7; 3], "{name}: the control");
        let (recording, other_params) = adding(&mut executor, again, 1);
        executor.run(&recording).unwrap();
        executor.resize(&mut again, 2).unwrap();
        executor.write(again, &[1, 2]).unwrap();
        assert_eq!(executor.read(again).unwrap(), [1, 2], "{name}");
        executor.free([params.id(), other_params.id(), again.id(), other.id(), other.id()]).unwrap();
        assert_eq!(executor.bytes(), 0, "{name}");
    }
}

#[test]
fn primitives_release_their_memory() {
    use splashdown_gpu::{compact::Compact, scan::Scan, sort::Sort};
    for (name, mut executor) in testing::executors("primitives_release_their_memory") {
        for len in [10, 100_000, 20_000_000] {
            Scan::new(&mut executor, len).unwrap().free(&mut executor).unwrap();
        }
        Compact::new(&mut executor, 100_000, 64).unwrap().free(&mut executor).unwrap();
        Sort::new(&mut executor, 10_000).unwrap().free(&mut executor).unwrap();
        assert_eq!(executor.bytes(), 0, "{name}");
    }
}

#[test]
fn a_too_large_buffer_is_rejected_with_the_possible_size() {
    for (name, mut executor) in testing::executors("a_too_large_buffer_is_rejected_with_the_possible_size") {
        let most = executor.largest_buffer() / 4;
        let len = usize::try_from(most.max(u64::from(u32::MAX)) + 1).unwrap();
        let error = executor.create::<u32>("positions", len).unwrap_err();
        let GpuError::TooLarge { label, len: asked, fits, .. } = &error else { panic!("{name}: {error}") };
        assert_eq!((label.as_str(), *asked), ("positions", len as u64), "{name}");
        assert!(*fits < *asked && error.to_string().contains(&fits.to_string()), "{name}: {error}");
        let mut small = executor.create_from("small", &[1_u32]).unwrap();
        assert!(executor.resize(&mut small, len).is_err(), "{name}");
        assert_eq!(
            executor.read(small).unwrap(),
            [1],
            "{name}: a rejected resize leaves the buffer unchanged"
        );
    }
    if let Some(gpu) = testing::gpu_or_skip("a_too_large_buffer_is_rejected_with_the_possible_size") {
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
fn a_read_back_contains_earlier_writes_and_does_not_block() {
    for (name, mut executor) in testing::executors("a_read_back_contains_earlier_writes_and_does_not_block") {
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
fn every_dispatch_is_timed_once_timing_is_enabled() {
    for (name, mut executor) in testing::executors("every_dispatch_is_timed_once_timing_is_enabled") {
        let numbers = executor.create_from("numbers", &vec![0_u32; 100_000]).unwrap();
        let (mut recording, _) = adding(&mut executor, numbers, 1);
        executor.run(&recording).unwrap();
        assert!(executor.take_timings().passes.is_empty(), "{name}: timing is disabled");
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
        assert!(executor.take_timings().passes.is_empty(), "{name}: already taken");
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
