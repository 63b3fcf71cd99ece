use super::*;

/// The integral of W over the ball, by the midpoint rule in double precision.
fn integral<K: Kernel>() -> f64 {
    let n = 20_000;
    (0..n)
        .map(|i| (f64::from(i) + 0.5) / f64::from(n))
        .map(|q| 4.0 * std::f64::consts::PI * q * q * f64::from(K::w(q as f32)) / f64::from(n))
        .sum()
}

/// The largest difference between g * q and the numerical derivative of W.
fn gradient_error<K: Kernel>() -> f32 {
    (2..198)
        .map(|i| i as f32 / 200.0)
        .map(|q| {
            let step = 2e-3;
            let slope = (K::w(q + step) - K::w(q - step)) / (2.0 * step);
            (slope - K::g(q) * q).abs() / K::w(0.0)
        })
        .fold(0.0, f32::max)
}

fn check<K: Kernel>() {
    assert!((integral::<K>() - 1.0).abs() < 1e-5, "W integrates to {}", integral::<K>());
    // Where the third derivative is discontinuous, central differences are accurate to about the step.
    assert!(gradient_error::<K>() < 2e-3, "gradient off by {}", gradient_error::<K>());
    for q in [1.0, 1.5, 1e9] {
        assert_eq!((K::w(q), K::g(q)), (0.0, -0.0), "outside the support, q = {q}");
    }
    assert!(K::w(0.0).is_finite() && K::g(0.0).is_finite());
}

#[test]
fn kernels_are_normalised_and_their_gradients_match() {
    check::<WendlandC2>();
    check::<CubicSpline>();
    check::<Poly6>();
    check::<Spiky>();
}

#[test]
fn wrong_kernels_fail_the_checks() {
    #[derive(Clone, Copy)]
    struct Wrong;
    impl Kernel for Wrong {
        const ID: u32 = 9;
        fn w<V: Lanes>(q: V) -> V {
            WendlandC2::w(q) * 1.01
        }
        fn g<V: Lanes>(q: V) -> V {
            WendlandC2::g(q) * 1.05
        }
    }
    assert!((integral::<Wrong>() - 1.0).abs() > 1e-3);
    assert!(gradient_error::<Wrong>() > 2e-3);
}

#[test]
fn laplacians_match_the_divergence_of_the_gradient() {
    // In three dimensions the Laplacian of W(q) is W'' + 2 W' / q, here with W' = g q.
    for i in 4..190 {
        let (q, step) = (i as f32 / 200.0, 1e-2);
        let slope = |q: f32| Poly6::g(q) * q;
        let numerical = (slope(q + step) - slope(q - step)) / (2.0 * step) + 2.0 * slope(q) / q;
        assert!((numerical - Poly6::laplacian(q)).abs() < 0.05, "q = {q}: {numerical}");
    }
    assert!(viscosity_laplacian(0.3) > 0.0 && viscosity_laplacian(1.0) == 0.0);
}
