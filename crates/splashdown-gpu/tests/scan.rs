//! Prefix sums at critical lengths: zero, one, and around the sizes of subgroups, workgroups and blocks.

use splashdown_gpu::scan::Scan;
use splashdown_gpu::{Executor, GpuError, Recording, testing};

const SIZES: [u32; 24] = [
    0,
    1,
    2,
    63,
    64,
    65,
    255,
    256,
    257,
    2047,
    2048,
    2049,
    4095,
    4096,
    4097,
    16_384,
    16_385,
    18_431,
    18_432,
    18_433,
    65_535,
    65_536,
    1 << 20,
    2_000_003,
];

/// The oracle: a running sum in 64 bits, truncated to 32.
fn expected(counts: &[u32]) -> Vec<u32> {
    let mut sum = 0_u64;
    let mut starts = vec![0];
    for count in counts {
        sum += u64::from(*count);
        starts.push(sum as u32);
    }
    starts
}

/// Small counts with empty ranges, as in cells; deterministic for each length.
fn counts(len: u32) -> Vec<u32> {
    (0..len).map(|i| if i % 1000 < 300 { 0 } else { (i.wrapping_mul(2_654_435_761) >> 16) % 23 }).collect()
}

fn scan(executor: &mut Executor, counts: &[u32]) -> Result<Vec<u32>, GpuError> {
    let len = counts.len() as u32;
    let input = executor.create_from("counts", counts)?;
    let starts = executor.create::<u32>("starts", counts.len() + 1)?;
    let scan = Scan::new(executor, len)?;
    assert_eq!(scan.len(), len);
    let mut recording = Recording::new("scan");
    scan.record(&mut recording, input, starts);
    executor.run(&recording)?;
    executor.read(starts)
}

#[test]
fn the_oracle_adds() {
    assert_eq!(expected(&[]), [0]);
    assert_eq!(expected(&[3, 0, 5, 2]), [0, 3, 3, 8, 10]);
    assert_eq!(expected(&[u32::MAX, 2, 1]), [0, u32::MAX, 1, 2]);
    assert_ne!(expected(&[3, 0, 5, 2]), expected(&[3, 5, 0, 2]), "the order counts");
}

#[test]
fn every_size_is_correct_on_both_executors() {
    for (name, mut executor) in testing::executors("every_size_is_correct_on_both_executors") {
        for len in SIZES {
            let counts = counts(len);
            let starts = scan(&mut executor, &counts).unwrap();
            let expected = expected(&counts);
            let wrong = starts.iter().zip(&expected).position(|(a, b)| a != b);
            assert_eq!(starts.len(), expected.len());
            assert_eq!(wrong, None, "{name}, {len} counts");
        }
    }
}

#[test]
fn fourteen_million_counts_are_correct_on_the_cpu() {
    let counts = counts(14_000_000);
    let starts = scan(&mut splashdown_gpu::CpuExecutor::new().into(), &counts).unwrap();
    assert!(starts == expected(&counts));
}

#[test]
fn sums_wrap_equally_on_both_executors() {
    for (name, mut executor) in testing::executors("sums_wrap_equally_on_both_executors") {
        let counts = vec![0xc000_0001; 20_000];
        assert!(scan(&mut executor, &counts).unwrap() == expected(&counts), "{name}");
    }
}
