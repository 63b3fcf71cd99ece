use super::*;

/// The bits of the results of every operation on two blocks.
fn results(kind: Simd, a: &[f32; BLOCK], b: &[f32; BLOCK]) -> Vec<[u32; BLOCK]> {
    struct All<'a>(&'a [f32; BLOCK], &'a [f32; BLOCK], &'a mut Vec<[u32; BLOCK]>);
    impl Leaf for All<'_> {
        #[inline(always)]
        fn run<V: Register>(self) {
            let operations: [fn(V, V) -> V; 9] = [
                |a, b| a + b,
                |a, b| a - b,
                |a, b| a * b,
                |a, b| a / b,
                |a, _| (a * 3.0 - 2.0 + 7.0).sqrt(),
                |a, b| a.max(b),
                |a, b| b.max(a),
                |a, b| a.if_less(b, a + b, a - b),
                |_, _| V::splat(0.1),
            ];
            for operation in operations {
                let mut out = [0.0; BLOCK];
                for l in (0..BLOCK).step_by(V::WIDTH) {
                    // SAFETY: the width divides the block.
                    unsafe {
                        let values = (V::load(self.0.as_ptr().add(l)), V::load(self.1.as_ptr().add(l)));
                        operation(values.0, values.1).store(out.as_mut_ptr().add(l));
                    }
                }
                // A NaN has many bit patterns.
                self.2.push(out.map(|x| if x.is_nan() { f32::NAN.to_bits() } else { x.to_bits() }));
            }
        }
    }
    let mut out = Vec::new();
    run_with(kind, All(a, b, &mut out));
    out
}

fn available() -> impl Iterator<Item = Simd> {
    Simd::ALL.into_iter().filter(|kind| {
        kind.is_available() || {
            eprintln!("SKIPPED: this processor has no {} registers", kind.name());
            false
        }
    })
}

#[test]
fn all_registers_give_the_same_bits() {
    let a = std::array::from_fn(|l| (l as f32 - 7.3) * 1.7);
    let mut b = std::array::from_fn(|l| ((l * 5 % 16) as f32 - 6.1) * 0.9);
    (b[3], b[4], b[5]) = (f32::NAN, f32::INFINITY, a[5]);
    let expected = results(Simd::Portable, &a, &b);
    assert_ne!(expected[5], expected[6], "max is tested with a NaN in either operand");
    for kind in available() {
        for (n, (found, expected)) in results(kind, &a, &b).iter().zip(&expected).enumerate() {
            assert_eq!(found, expected, "operation {n} with {} registers", kind.name());
        }
    }
}

#[test]
fn compress_moves_the_selected_lanes_to_the_front() {
    struct Compress<'a>(&'a [f32; BLOCK], f32, &'a mut Vec<f32>);
    impl Leaf for Compress<'_> {
        #[inline(always)]
        fn run<V: Register>(self) {
            for l in (0..BLOCK).step_by(V::WIDTH) {
                let mut out = [0.0; BLOCK];
                // SAFETY: the width divides the block.
                let count = unsafe {
                    let values = V::load(self.0.as_ptr().add(l));
                    let bits = values.less_bits(V::splat(self.1));
                    values.compress(bits).store(out.as_mut_ptr());
                    bits.count_ones() as usize
                };
                self.2.extend_from_slice(&out[..count]);
            }
        }
    }
    for kind in available() {
        for pattern in 0..=255_u32 {
            let values = std::array::from_fn(|l| {
                let below = pattern >> (l % 8) & 1 == 1 || l >= 8 && pattern >> (l - 8) & 2 == 2;
                if below { -(l as f32) - 1.0 } else { l as f32 + 1.0 }
            });
            let mut found = Vec::new();
            run_with(kind, Compress(&values, 0.0, &mut found));
            let expected: Vec<f32> = values.into_iter().filter(|&x| x < 0.0).collect();
            assert_eq!(found, expected, "{} registers, pattern {pattern}", kind.name());
        }
    }
}

#[test]
fn the_limit_is_respected() {
    assert!(Simd::in_use().is_available());
    Simd::Portable.limit_to();
    assert_eq!(Simd::in_use(), Simd::Portable);
    Simd::Avx512.limit_to();
    assert!(Simd::ALL.into_iter().all(|kind| kind <= Simd::in_use() || !kind.is_available()));
}
