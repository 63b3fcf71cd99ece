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
    check::<WendlandBlend>();
    check::<CubicSpline>();
    check::<Poly6>();
    check::<Spiky>();
}

/// The change of the sum of W over a cubic lattice with this support ratio when it is stretched by a thousandth along x
/// and compressed as much along y, over the square of a thousandth and over the sum.
fn resistance_to_extension<K: Kernel>(ratio: f64) -> f64 {
    const STRETCH: f64 = 1e-3;
    let sum = |stretch: f64| -> f64 {
        let scale = [(stretch).exp(), (-stretch).exp(), 1.0];
        let points = (-3..=3).flat_map(|i| (-3..=3).flat_map(move |j| (-3..=3).map(move |k| [i, j, k])));
        points
            .map(|point| {
                let r2: f64 = point.iter().zip(scale).map(|(&x, s)| (f64::from(x) * s).powi(2)).sum();
                weight::<K>(r2.sqrt() / ratio)
            })
            .sum()
    };
    (sum(STRETCH) / sum(0.0) - 1.0) / STRETCH.powi(2)
}

/// W by the integral of its gradient, in double precision: single precision does not resolve second differences.
fn weight<K: Kernel>(q: f64) -> f64 {
    const N: i32 = 4000;
    let step = (1.0 - q).max(0.0) / f64::from(N);
    (0..N).map(|i| q + (f64::from(i) + 0.5) * step).map(|s| -s * f64::from(K::g(s as f32)) * step).sum()
}

#[test]
fn a_lattice_with_the_blend_offers_little_resistance_to_a_stretch() {
    let [blend, c2] = [resistance_to_extension::<WendlandBlend>, resistance_to_extension::<WendlandC2>];
    assert!((0.0..0.05).contains(&blend(2.0)), "{}", blend(2.0));
    assert!(c2(2.0) > 0.3, "negative control: {}", c2(2.0));
}

/// A negative transform lets particles form pairs (Dehnen & Aly 2012). The largest k H belongs to a wavelength of a third of a
/// spacing; above 67 the transform changes its sign.
#[test]
fn the_fourier_transform_of_the_blend_is_positive_at_the_scale_of_the_particles() {
    let smallest = |w: &dyn Fn(f64) -> f64| {
        (1..400)
            .map(|i| f64::from(i) / 10.0)
            .map(|k| (1..2000).map(|i| f64::from(i) / 2000.0).map(|q| w(q) * q * (k * q).sin() / k).sum())
            .fold(f64::MAX, |least: f64, value: f64| least.min(value))
    };
    assert!(smallest(&|q| f64::from(WendlandBlend::w(q as f32))) > 0.0);
    let one_dimension = |q: f64| (1.0 - q).powi(3) * (1.0 + 3.0 * q);
    assert!(smallest(&one_dimension) < 0.0, "negative control");
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

/// The longest stable step of symplectic Euler for sound on a cubic lattice with summed densities, in half support radii
/// over the speed of sound. A wave of wave vector k has the frequency c |s|, where s is the sum of V grad W sin(k x)
/// over the neighbours (Violeau & Leroy 2014 have the limit of many neighbours).
fn longest_step<K: Kernel>(ratio: f64) -> f64 {
    const WAVES: i32 = 12;
    let reach = ratio.ceil() as i32;
    let coordinates = move || -reach..=reach;
    let neighbours: Vec<[f64; 4]> = coordinates()
        .flat_map(|i| coordinates().flat_map(move |j| coordinates().map(move |k| [i, j, k].map(f64::from))))
        .map(|x| {
            let q = x.iter().map(|x| x * x).sum::<f64>().sqrt() / ratio;
            [x[0], x[1], x[2], f64::from(K::g(q as f32)) / ratio.powi(5)]
        })
        .collect();
    let waves = || (0..=WAVES).map(|i| f64::from(i) * std::f64::consts::PI / f64::from(WAVES));
    let mut highest = 0.0_f64;
    for wave in waves().flat_map(|a| waves().flat_map(move |b| waves().map(move |c| [a, b, c]))) {
        let mut sum = [0.0; 3];
        for [x, y, z, g] in &neighbours {
            let sine = g * (wave[0] * x + wave[1] * y + wave[2] * z).sin();
            sum = [sum[0] + sine * x, sum[1] + sine * y, sum[2] + sine * z];
        }
        highest = highest.max(sum.iter().map(|s| s * s).sum::<f64>().sqrt());
    }
    2.0 / (highest * 0.5 * ratio)
}

#[test]
fn default_steps_are_at_most_half_of_the_longest_stable_one() {
    use crate::scene::{DensityMode, Method, Solver};
    let limits: Vec<f64> = [1.5, 2.0, 2.5, 3.0, 4.0]
        .into_iter()
        .flat_map(|ratio| {
            [
                longest_step::<WendlandC2>(ratio),
                longest_step::<WendlandBlend>(ratio),
                longest_step::<CubicSpline>(ratio),
            ]
        })
        .collect();
    let smallest = limits.iter().copied().fold(f64::INFINITY, f64::min);
    assert!((1.72..1.73).contains(&smallest), "{limits:.3?}");
    for density in [DensityMode::Summation, DensityMode::Continuity] {
        let factor = f64::from(Solver::with(Method::Wcsph, density).cfl_factor);
        assert!(factor <= 0.5 * smallest, "{density:?}: {factor} for {smallest}");
    }
}
