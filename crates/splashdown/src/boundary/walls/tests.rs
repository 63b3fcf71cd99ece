use super::*;
use crate::boundary::NearWalls;

const ALL: [KernelPair; 3] = [KernelPair::WendlandC2, KernelPair::CubicSpline, KernelPair::Mueller];

/// The integral of the kernels over the part of the ball behind the planes at `q`, by the midpoint rule.
fn solid_integral(kernels: KernelPair, q: [f64; 3]) -> [f64; 2] {
    const N: i32 = 80;
    let mut sum = [0.0; 2];
    let at = |i: i32| (f64::from(i) + 0.5) / f64::from(N);
    for i in -N..N {
        for j in -N..N {
            for k in -N..N {
                let y = [at(i), at(j), at(k)];
                let r = (y[0] * y[0] + y[1] * y[1] + y[2] * y[2]).sqrt();
                if r < 1.0 && (0..3).any(|a| y[a] < -q[a]) {
                    let w = kernels.both(r);
                    sum[0] += w[0];
                    sum[1] += w[1];
                }
            }
        }
    }
    sum.map(|s| s / f64::from(N).powi(3))
}

fn corner_box(kernels: KernelPair) -> Walls {
    Walls {
        min: Vec3::ZERO,
        max: Vec3::splat(4.0),
        closed: 0b111111,
        offset: 0.0,
        support_radius: 1.0,
        kernels,
    }
}

#[test]
fn the_density_of_planes_edges_and_corners_is_the_integral_over_the_solid() {
    for kernels in ALL {
        let table = wall_table(kernels);
        for x in [[0.3, 2.0, 2.0], [0.3, 0.4, 2.0], [0.1, 2.0, 0.2], [0.25, 0.25, 0.25], [0.05, 0.4, 0.15]] {
            let terms = corner_box(kernels).terms(&table, Vec3::from_array(x.map(|v| v as f32)));
            let exact = solid_integral(kernels, x)[0];
            // The midpoint rule is accurate to 3e-3 (steps of 1/80 across a surface), the product in corners to 5e-3.
            assert!(
                (f64::from(terms.density) - exact).abs() < 6e-3,
                "{kernels:?} {x:?}: {} {exact}",
                terms.density
            );
            // Control: without the overlaps the error at an edge exceeds the tolerance.
            if x.iter().filter(|&&v| v < 0.5).count() >= 2 {
                let bare: f32 =
                    x.iter().map(|&v| if v < 1.0 { kernels.density(v as f32).0 } else { 0.0 }).sum();
                assert!(
                    (f64::from(bare) - exact).abs() > 6e-3,
                    "{kernels:?} {x:?}: the overlap does not matter"
                );
            }
        }
    }
}

#[test]
fn slopes_are_the_derivatives_of_the_density() {
    for kernels in [KernelPair::WendlandC2, KernelPair::CubicSpline] {
        let (walls, table) = (corner_box(kernels), wall_table(kernels));
        for x in [Vec3::new(0.3, 2.0, 2.0), Vec3::new(0.33, 0.41, 2.0), Vec3::new(0.22, 0.27, 0.31)] {
            let terms = walls.terms(&table, x);
            for axis in 0..3 {
                let step = 0.02 * Vec3::AXES[axis];
                let numerical =
                    (walls.terms(&table, x + step).density - walls.terms(&table, x - step).density) / 0.04;
                // G = -c n / H, and n = +axis here; the slopes of a bilinear table are accurate to about 0.01.
                assert!(
                    (numerical + terms.slope[axis]).abs() < 0.02,
                    "{kernels:?} {x} {axis}: {numerical} {}",
                    terms.slope
                );
            }
        }
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
fn open_sides_contribute_nothing_and_the_upper_side_mirrors_the_lower() {
    let kernels = KernelPair::WendlandC2;
    let table = wall_table(kernels);
    let mut walls = corner_box(kernels);
    let low = walls.terms(&table, Vec3::new(0.2, 2.0, 2.0));
    let high = walls.terms(&table, Vec3::new(3.8, 2.0, 2.0));
    assert!((low.density - high.density).abs() < 1e-6);
    assert_eq!((low.normal.x, high.normal.x), (1.0, -1.0));
    walls.closed = 0b111101;
    assert_eq!(walls.terms(&table, Vec3::new(3.8, 2.0, 2.0)).density, 0.0);
    let (low_point, high_point) = (Vec3::new(0.2, 2.0, 2.0), Vec3::new(3.8, 2.0, 2.0));
    let near = NearWalls::new(walls.clone(), &table);
    assert_eq!(near.terms(low_point), Some(walls.terms(&table, low_point)));
    assert_eq!(near.density(low_point), walls.terms(&table, low_point).density);
    assert_eq!((near.terms(high_point), near.density(high_point)), (None, 0.0));
    let closed = NearWalls::new(corner_box(kernels), &table);
    assert!(closed.terms(high_point).is_some() && closed.terms(Vec3::splat(2.0)).is_none());
}

#[test]
fn a_lattice_half_a_spacing_from_the_sides_has_the_rest_density() {
    for (kernels, ratio) in ALL.into_iter().zip([2.0, 2.0, 2.0]).chain([(KernelPair::WendlandC2, 3.0)]) {
        let offset = wall_offset(kernels, ratio);
        let walls = Walls { support_radius: ratio, offset, max: Vec3::splat(40.0), ..corner_box(kernels) };
        let table = wall_table(kernels);
        let lattice = |x: Vec3, inside: bool| -> f64 {
            cube(ratio.ceil() as i32)
                .map(|(i, j, k)| (x + Vec3::new(i as f32, j as f32, k as f32), i * i + j * j + k * k))
                .filter(|(y, _)| !inside || y.min_element() > 0.0)
                .map(|(_, r2)| kernels.both(f64::from(r2).sqrt() / f64::from(ratio))[0])
                .sum()
        };
        for x in [
            Vec3::new(0.5, 20.5, 20.5),
            Vec3::new(0.5, 0.5, 20.5),
            Vec3::splat(0.5),
            Vec3::new(1.5, 0.5, 20.5),
        ] {
            let fluid = lattice(x, true) / lattice(x, false);
            let error = |walls: &Walls| (fluid + f64::from(walls.terms(&table, x).density) - 1.0).abs();
            assert!(error(&walls) < 1e-2, "{kernels:?} {ratio} {x}: off by {}", error(&walls));
            // Control: without the offset the error is larger.
            assert!(
                error(&Walls { offset: 0.0, ..walls.clone() }) > error(&walls),
                "{kernels:?} {ratio} {x}"
            );
        }
    }
}

#[test]
fn terms_stay_small_if_a_third_side_is_just_within_the_support() {
    for kernels in ALL {
        let (walls, table) = (Walls { offset: 0.05, ..corner_box(kernels) }, wall_table(kernels));
        for near in [1e-3, 0.14, 0.3] {
            let beside = walls.terms(&table, Vec3::new(near, near, 2.0));
            for far in (0..4000).map(|i| 0.9 + 3e-5 * i as f32) {
                let terms = walls.terms(&table, Vec3::new(near, near, far));
                // The kernel fraction of the third side is below 1e-3 here.
                let change = (terms.density - beside.density)
                    .abs()
                    .max((terms.slope - beside.slope).truncate().length());
                assert!(change < 0.01, "{kernels:?} {near} {far}: {terms:?}");
                assert!((-1e-3..0.02).contains(&terms.slope.z), "{kernels:?} {near} {far}: {terms:?}");
            }
        }
    }
}
