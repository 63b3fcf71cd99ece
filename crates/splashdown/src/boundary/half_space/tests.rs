use super::*;

const ALL: [KernelPair; 4] =
    [KernelPair::WendlandC2, KernelPair::WendlandBlend, KernelPair::CubicSpline, KernelPair::Mueller];

/// The integral of the kernels over the part of the ball behind a plane at `q`, by the midpoint rule.
fn solid_integral(kernels: KernelPair, q: f64) -> [f64; 2] {
    const N: i32 = 80;
    let mut sum = [0.0; 2];
    let at = |i: i32| (f64::from(i) + 0.5) / f64::from(N);
    for (i, j, k) in cube(N) {
        let y = [at(i), at(j), at(k)];
        let r = (y[0] * y[0] + y[1] * y[1] + y[2] * y[2]).sqrt();
        if r < 1.0 && y[0] < -q {
            let w = kernels.both(r);
            sum[0] += w[0];
            sum[1] += w[1];
        }
    }
    sum.map(|s| s / f64::from(N).powi(3))
}

#[test]
fn the_kernel_fraction_of_a_plane_is_the_integral_over_the_solid() {
    for kernels in ALL {
        for q in [0.05, 0.3, 0.7] {
            let [density, gradient] = solid_integral(kernels, q);
            // The midpoint rule is accurate to 3e-3 (steps of 1/80 across a surface).
            assert!((f64::from(kernels.density(q as f32).0) - density).abs() < 4e-3, "{kernels:?} {q}");
            assert!((f64::from(kernels.gradient(q as f32).0) - gradient).abs() < 4e-3, "{kernels:?} {q}");
        }
        // Control: a distance off by a twentieth of the support exceeds the tolerance.
        assert!((f64::from(kernels.density(0.35).0) - solid_integral(kernels, 0.3)[0]).abs() > 4e-3);
    }
}

#[test]
fn closed_forms_are_continuous_and_start_at_one_half() {
    for kernels in ALL {
        for f in [KernelPair::density, KernelPair::gradient] {
            assert!((f(kernels, 0.0).0 - 0.5).abs() < 1e-6);
            assert!(f(kernels, 1.0).0.abs() < 1e-6 && f(kernels, 1.0).1.abs() < 1e-6);
            for i in 1..100 {
                let q = i as f32 / 100.0;
                let slope = (f(kernels, q + 1e-2).0 - f(kernels, q - 1e-2).0) / 2e-2;
                assert!((slope + f(kernels, q).1).abs() < 5e-3, "{kernels:?} q = {q}");
            }
        }
    }
}

#[test]
fn a_lattice_half_a_spacing_from_a_plane_has_the_rest_density() {
    for (kernels, ratio) in ALL.into_iter().map(|k| (k, 2.0)).chain([(KernelPair::WendlandC2, 3.0)]) {
        let lattice = |inside: bool| -> f64 {
            cube(ratio as i32)
                .filter(|&(x, _, _)| !inside || x >= 0)
                .map(|(x, y, z)| kernels.both(f64::from(x * x + y * y + z * z).sqrt() / ratio)[0])
                .sum()
        };
        let fluid = lattice(true) / lattice(false);
        let error =
            |offset: f32| (fluid + f64::from(kernels.density((0.5 + offset) / ratio as f32).0) - 1.0).abs();
        let offset = SolidDistance::of_density(kernels, ratio as f32).offset;
        assert!(error(offset) < 1e-3, "{kernels:?} {ratio}: off by {}", error(offset));
        // Control: without the offset the error is larger.
        assert!(error(0.0) > error(offset), "{kernels:?} {ratio}");
    }
}

#[test]
fn the_consistent_distance_has_the_value_and_the_slope_of_a_lattice() {
    for (kernels, ratio) in [
        (KernelPair::WendlandBlend, 1.5_f32),
        (KernelPair::WendlandC2, 2.0),
        (KernelPair::WendlandBlend, 2.0),
        (KernelPair::CubicSpline, 2.0),
        (KernelPair::WendlandC2, 3.0),
    ] {
        let [missing, gradient] = half_lattice_sums(kernels, ratio, 0.5);
        let solid = SolidDistance::of_lattice(kernels, ratio);
        let (density, slope) = kernels.density((0.5 * solid.stretch + solid.offset) / ratio);
        assert!(
            (density / missing - 1.0 + SolidDistance::MARGIN).abs() < 0.01,
            "{kernels:?} {ratio}: {density}"
        );
        assert!((solid.stretch * slope / gradient - 1.0).abs() < 0.06, "{kernels:?} {ratio}: {slope}");
    }
    // Control: the offset alone makes the gradient of the narrow supports too small.
    for kernels in [KernelPair::WendlandC2, KernelPair::WendlandBlend] {
        let [_, gradient] = half_lattice_sums(kernels, 2.0, 0.5);
        let plain = SolidDistance::of_density(kernels, 2.0);
        let slope = kernels.density((0.5 + plain.offset) / 2.0).1;
        assert!(slope / gradient < 0.9, "{kernels:?}: {slope}");
    }
}

#[test]
fn the_distance_for_two_layers_has_their_gradients() {
    for (kernels, ratio) in [
        (KernelPair::WendlandC2, 2.0_f32),
        (KernelPair::WendlandBlend, 2.0),
        (KernelPair::CubicSpline, 2.0),
        (KernelPair::WendlandC2, 2.5),
        (KernelPair::WendlandC2, 3.0),
        (KernelPair::CubicSpline, 4.0),
    ] {
        let error = |solid: SolidDistance, distance: f32| {
            let [_, gradient] = half_lattice_sums(kernels, ratio, distance.into());
            let stretched = distance + (solid.stretch - 1.0) * (distance - Params::STRETCHED_FROM);
            let q = (stretched + solid.slope_offset) / ratio;
            let slope = if q < 1.0 { solid.stretch * kernels.density(q).1 } else { 0.0 };
            (slope - gradient).abs()
        };
        let solid = SolidDistance::of_layers(kernels, ratio, 1.0);
        let errors = [error(solid, 0.5), error(solid, 1.5)];
        assert!(errors.iter().all(|error| *error < 2e-3), "{kernels:?} {ratio}: {errors:?} {solid:?}");
        let [missing, _] = half_lattice_sums(kernels, ratio, 0.5);
        let q = (0.25 + 0.25 * solid.stretch + solid.offset) / ratio;
        assert!((kernels.density(q).0 - missing).abs() < 1e-3, "{kernels:?} {ratio}");
        // Control: with the density alone the gradient is off at one of the layers.
        let plain = SolidDistance::of_density(kernels, ratio);
        let errors = [error(plain, 0.5), error(plain, 1.5)];
        assert!(errors.iter().any(|error| *error > 0.02), "{kernels:?} {ratio}: {errors:?}");
    }
}

/// Values computed independently.
#[test]
fn the_lattice_behind_a_plane_matches_independent_values() {
    for (kernels, ratio, missing, gradient) in [
        (KernelPair::WendlandC2, 2.0, 0.1236, 0.9501),
        (KernelPair::WendlandBlend, 2.0, 0.1397, 0.9767),
        (KernelPair::WendlandC2, 3.0, 0.2495, 1.2847),
    ] {
        let [part, slope] = half_lattice_sums(kernels, ratio, 0.5);
        assert!(
            (part - missing).abs() < 1e-4 && (slope - gradient).abs() < 1e-3,
            "{kernels:?}: {part} {slope}"
        );
    }
}

#[test]
fn the_kernel_of_a_stretched_plane_fills_its_fraction() {
    let support = 0.1;
    let stretched = PlaneFraction { kernels: KernelPair::WendlandBlend, stretch: 1.2, offset: 0.006 };
    // The part of a radial kernel beyond a plane at d is 2 pi times the integral of W r (r - d).
    let beyond = |fraction: PlaneFraction, d: f32| {
        const STEPS: usize = 20_000;
        let step = (support - d) / STEPS as f32;
        let r = |k: usize| d + (k as f32 + 0.5) * step;
        let sum: f64 =
            (0..STEPS).map(|k| f64::from(fraction.weight(r(k), support) * r(k) * (r(k) - d) * step)).sum();
        sum as f32
    };
    let own = PlaneFraction::of(KernelPair::WendlandBlend);
    for fraction in [own, stretched] {
        for [near, far] in [[0.01, 0.03], [0.025, 0.05]] {
            let ratio = beyond(fraction, near) / beyond(fraction, far);
            let expected = fraction.at(near, support) / fraction.at(far, support);
            assert!((ratio / expected - 1.0).abs() < 1e-3, "{fraction:?} {near} {far}: {ratio} {expected}");
        }
        for part in [0.02, 0.3, 0.7] {
            assert!((fraction.at(fraction.distance(part, support), support) - part).abs() < 1e-4);
        }
    }
    // Control: the fluid's own kernel does not fill the stretched fraction.
    let ratio = beyond(own, 0.01) / beyond(own, 0.03);
    assert!((ratio * stretched.at(0.03, support) / stretched.at(0.01, support) - 1.0).abs() > 0.1);
}
