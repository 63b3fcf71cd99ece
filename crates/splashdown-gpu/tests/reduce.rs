//! Sums and extremes against 64-bit arithmetic, and bit for bit between executors, threads and runs.

use glam::Vec4;
use splashdown_gpu::reduce::{Operation, Reduce, Reducible};
use splashdown_gpu::{CpuExecutor, Executor, Recording, testing};

const SIZES: [u32; 14] = [0, 1, 63, 64, 65, 255, 256, 257, 4095, 4096, 4097, 65_537, 1 << 20, 2_000_003];

/// Between -1 and 3, with no order to it.
fn values(len: u32) -> Vec<f32> {
    (0..len).map(|i| testing::noise(i) as f32 / u32::MAX as f32 * 4.0 - 1.0).collect()
}

fn reduce<T: Reducible>(executor: &mut Executor, values: &[T], operation: Operation) -> T {
    let input = executor.create_from("values", values).unwrap();
    let result = executor.create::<T>("result", 1).unwrap();
    let reduce = Reduce::new(executor, values.len() as u32, operation).unwrap();
    let mut recording = Recording::new("reduce");
    reduce.record(&mut recording, input, result);
    executor.run(&recording).unwrap();
    executor.read(result).unwrap()[0]
}

#[test]
fn sums_are_those_of_double_precision_and_extremes_are_exact() {
    for (name, mut executor) in
        testing::executors("sums_are_those_of_double_precision_and_extremes_are_exact")
    {
        for len in SIZES {
            let values = values(len);
            let sum = f64::from(reduce(&mut executor, &values, Operation::Sum));
            let exact: f64 = values.iter().map(|v| f64::from(*v)).sum();
            // No value takes part in more than run + 16 + 16 roundings per level, each of at most half an ulp of a
            // partial sum, and all partial sums together are at most the sum of the magnitudes.
            let magnitude: f64 = values.iter().map(|v| f64::from(v.abs())).sum();
            let tolerance = magnitude * 96.0 * f64::from(f32::EPSILON) / 2.0;
            assert!(
                (sum - exact).abs() <= tolerance,
                "{name}, {len}: {sum} is not {exact} within {tolerance}"
            );
            let smallest = values.iter().copied().fold(f32::MAX, f32::min);
            let largest = values.iter().copied().fold(f32::MIN, f32::max);
            assert_eq!(reduce(&mut executor, &values, Operation::Min), smallest, "{name}, {len}");
            assert_eq!(reduce(&mut executor, &values, Operation::Max), largest, "{name}, {len}");
        }
    }
}

#[test]
fn the_tolerance_notices_one_missing_value() {
    let mut values = values(4097);
    values[4096] = 3.0;
    let mut executor = CpuExecutor::new().into();
    let without = f64::from(reduce(&mut executor, &values[..4096], Operation::Sum));
    let exact: f64 = values.iter().map(|v| f64::from(*v)).sum();
    let magnitude: f64 = values.iter().map(|v| f64::from(v.abs())).sum();
    assert!((without - exact).abs() > magnitude * 96.0 * f64::from(f32::EPSILON) / 2.0);
}

#[test]
fn vectors_reduce_by_component() {
    for (name, mut executor) in testing::executors("vectors_reduce_by_component") {
        for len in [0, 1, 257, 4097, 70_001] {
            let flat = values(4 * len);
            let vectors: Vec<Vec4> = flat.chunks(4).map(Vec4::from_slice).collect();
            for operation in [Operation::Sum, Operation::Min, Operation::Max] {
                let all = reduce(&mut executor, &vectors, operation).to_array();
                for (component, value) in all.into_iter().enumerate() {
                    let one: Vec<f32> = vectors.iter().map(|v| v[component]).collect();
                    assert_eq!(reduce(&mut executor, &one, operation), value, "{name}, {len}, {operation:?}");
                }
            }
        }
    }
}

#[test]
fn sums_have_the_same_bits_everywhere() {
    let values = values(1_000_003);
    let bits = |executor: &mut Executor| reduce(executor, &values, Operation::Sum).to_bits();
    let reference = bits(&mut CpuExecutor::new().into());
    for threads in [1, 2, 8] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        assert_eq!(pool.install(|| bits(&mut CpuExecutor::new().into())), reference, "{threads} threads");
    }
    for (name, mut executor) in testing::executors("sums_have_the_same_bits_everywhere") {
        assert_eq!(bits(&mut executor), reference, "{name}");
        assert_eq!(bits(&mut executor), reference, "{name}, again");
    }
    // The control: another order gives other bits.
    let mut reversed = values.clone();
    reversed.reverse();
    assert_ne!(reduce(&mut CpuExecutor::new().into(), &reversed, Operation::Sum).to_bits(), reference);
}
