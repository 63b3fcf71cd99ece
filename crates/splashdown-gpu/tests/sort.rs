//! Compares the bitonic sort with that of the standard library.

use glam::{UVec2, uvec2};
use splashdown_gpu::sort::Sort;
use splashdown_gpu::{Executor, Recording, testing};

const SIZES: [u32; 20] =
    [0, 1, 2, 3, 63, 64, 65, 255, 256, 257, 511, 512, 513, 1023, 1024, 1025, 1537, 65_535, 65_537, 300_007];

fn sort(executor: &mut Executor, pairs: &[UVec2], len: u32) -> Vec<UVec2> {
    let buffer = executor.create_from("pairs", pairs).unwrap();
    let sort = Sort::new(executor, len).unwrap();
    let mut recording = Recording::new("sort");
    sort.record(&mut recording, buffer);
    executor.run(&recording).unwrap();
    executor.read(buffer).unwrap()
}

fn expected(pairs: &[UVec2]) -> Vec<UVec2> {
    let mut sorted: Vec<(u32, u32)> = pairs.iter().map(|p| (p.x, p.y)).collect();
    sorted.sort();
    sorted.into_iter().map(|(key, value)| uvec2(key, value)).collect()
}

#[test]
fn the_oracle_sorts_by_key_then_value() {
    let pairs = [uvec2(2, 0), uvec2(1, 9), uvec2(1, 3), uvec2(u32::MAX, 0)];
    assert_eq!(expected(&pairs), [uvec2(1, 3), uvec2(1, 9), uvec2(2, 0), uvec2(u32::MAX, 0)]);
}

#[test]
fn every_size_and_kind_of_key_is_sorted() {
    type Key = fn(u32, u32) -> u32;
    let kinds: [(&str, Key); 5] = [
        ("random", |i, _| testing::noise(i)),
        ("few", |i, _| testing::noise(i) % 7),
        ("equal", |_, _| 5),
        ("descending", |i, len| len - i),
        ("largest", |i, _| if i % 2 == 0 { u32::MAX } else { i }),
    ];
    for (name, mut executor) in testing::executors("every_size_and_kind_of_key_is_sorted") {
        for len in SIZES {
            for (kind, key) in kinds {
                // Values descend, so that equal keys start in the wrong order.
                let pairs: Vec<UVec2> = (0..len).map(|i| uvec2(key(i, len), len - i)).collect();
                assert!(sort(&mut executor, &pairs, len) == expected(&pairs), "{name}, {len} {kind} keys");
            }
        }
    }
}

#[test]
fn pairs_beyond_the_length_are_unchanged() {
    for (name, mut executor) in testing::executors("pairs_beyond_the_length_are_unchanged") {
        let pairs: Vec<UVec2> = (0..2000).map(|i| uvec2(2000 - i, i)).collect();
        let sorted = sort(&mut executor, &pairs, 1300);
        assert_eq!(sorted[..1300], expected(&pairs[..1300]), "{name}");
        assert_eq!(sorted[1300..], pairs[1300..], "{name}");
    }
}
