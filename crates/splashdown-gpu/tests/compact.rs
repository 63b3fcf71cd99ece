//! Compares lists of set flags with a filter, with full and insufficient capacity, and tests the dispatch over them.

use splashdown_gpu::compact::Compact;
use splashdown_gpu::{Executor, Recording, testing};

const SIZES: [u32; 12] = [0, 1, 63, 64, 65, 255, 256, 257, 16_384, 16_385, 65_536, 1_000_003];

/// The list and the four words of `counted`.
fn compact(executor: &mut Executor, flags: &[u32], capacity: usize, workgroup: u32) -> (Vec<u32>, Vec<u32>) {
    let len = flags.len() as u32;
    let input = executor.create_from("flags", flags).unwrap();
    let indices = executor.create::<u32>("indices", capacity).unwrap();
    let counted = executor.create::<u32>("counted", 4).unwrap();
    let compact = Compact::new(executor, len, workgroup).unwrap();
    let mut recording = Recording::new("compact");
    compact.record(&mut recording, input, indices, counted);
    executor.run(&recording).unwrap();
    let places = executor.read(compact.places()).unwrap();
    let counted = executor.read(counted).unwrap();
    assert_eq!(places.last(), counted.get(Compact::COUNT_WORD as usize));
    (executor.read(indices).unwrap(), counted)
}

/// About one flag in `sparsity` is set, to an arbitrary value.
fn flags(len: u32, sparsity: u32) -> Vec<u32> {
    (0..len)
        .map(|i| if testing::noise(i).is_multiple_of(sparsity) { testing::noise(!i) | 1 } else { 0 })
        .collect()
}

fn expected(flags: &[u32]) -> Vec<u32> {
    (0..flags.len() as u32).filter(|&i| flags[i as usize] != 0).collect()
}

#[test]
fn the_oracle_filters() {
    assert_eq!(expected(&[0, 9, 0, 1, u32::MAX]), [1, 3, 4]);
}

#[test]
fn lists_are_complete_and_in_order() {
    for (name, mut executor) in testing::executors("lists_are_complete_and_in_order") {
        for len in SIZES {
            for sparsity in [1, 3, 1000] {
                let flags = flags(len, sparsity);
                let (indices, counted) = compact(&mut executor, &flags, len.max(1) as usize, 64);
                let expected = expected(&flags);
                let count = expected.len() as u32;
                assert_eq!(counted, [count.div_ceil(64), 1, 1, count], "{name}, {len}, 1 in {sparsity}");
                assert!(indices[..expected.len()] == expected, "{name}, {len}, 1 in {sparsity}");
                // Intact poison shows that nothing was written after the list.
                assert!(indices[expected.len()..].iter().all(|i| *i == u32::MAX), "{name}, {len}");
            }
        }
    }
}

#[test]
fn elements_beyond_the_capacity_are_counted_but_not_written() {
    for (name, mut executor) in testing::executors("elements_beyond_the_capacity_are_counted_but_not_written")
    {
        let flags = flags(100_000, 2);
        let expected = expected(&flags);
        for capacity in [1, 1000, expected.len() - 1, expected.len()] {
            let (indices, counted) = compact(&mut executor, &flags, capacity, 64);
            assert!(indices == expected[..capacity], "{name}, capacity {capacity}");
            assert_eq!(counted, [(capacity as u32).div_ceil(64), 1, 1, expected.len() as u32], "{name}");
        }
    }
}

#[test]
fn arguments_beyond_65_535_workgroups_have_two_dimensions() {
    for (name, mut executor) in testing::executors("arguments_beyond_65_535_workgroups_have_two_dimensions") {
        let flags = vec![1; 70_001];
        let (_, counted) = compact(&mut executor, &flags, 70_001, 1);
        assert_eq!(counted, [35_001, 2, 1, 70_001], "{name}");
    }
}
