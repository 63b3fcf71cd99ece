//! Blocks to particles.

use splashdown::scene::{Scene, Shape};
use splashdown::{check, sample};

use crate::{CUBE, changed, parse};

fn positions(scene: &Scene) -> Vec<[f32; 3]> {
    sample::particles(scene).expect("the scene can be sampled").positions
}

/// Smallest distance between any two points, over all pairs.
fn smallest_distance(points: &[[f32; 3]]) -> f64 {
    let squared = |a: &[f32; 3], b: &[f32; 3]| (0..3).map(|k| f64::from(a[k] - b[k]).powi(2)).sum::<f64>();
    let pairs = points.iter().enumerate().flat_map(|(i, a)| points[..i].iter().map(move |b| squared(a, b)));
    pairs.fold(f64::INFINITY, f64::min).sqrt()
}

#[test]
fn a_box_is_a_lattice_half_a_spacing_inside_its_faces() {
    let scene = parse(&changed("size = [0.5, 0.5, 0.5]", "size = [0.5, 0.25, 0.1]")).expect("valid");
    let points = positions(&scene);
    assert_eq!(points.len(), 10 * 5 * 2);
    for axis in 0..3 {
        let low = points.iter().map(|p| p[axis]).fold(f32::INFINITY, f32::min);
        let high = points.iter().map(|p| p[axis]).fold(f32::NEG_INFINITY, f32::max);
        assert!((low - 0.025).abs() < 1e-6, "{low}");
        assert!((high - ([0.5, 0.25, 0.1][axis] - 0.025)).abs() < 1e-6, "{high}");
    }
    assert!((smallest_distance(&points) - 0.05).abs() < 1e-6);
    // x fastest, then y, then z.
    assert!((points[1][0] - points[0][0] - 0.05).abs() < 1e-6);
    assert!((points[10][1] - points[0][1] - 0.05).abs() < 1e-6);
    assert!((points[50][2] - points[0][2] - 0.05).abs() < 1e-6);
}

#[test]
fn particles_have_ids_in_order_and_their_blocks_velocity() {
    let second =
        "[[fluid.block]]\nposition = [0.6, 0.6, 0.6]\nsize = [0.1, 0.1, 0.1]\nvelocity = [1, -2, 3]\n";
    let scene = parse(&format!("{CUBE}{second}")).expect("valid");
    let particles = sample::particles(&scene).expect("the scene can be sampled");
    let count = 1000 + 8;
    assert_eq!(particles.ids, (0..count).collect::<Vec<u32>>());
    assert!(particles.velocities[..1000].iter().all(|v| *v == [0.0; 3]));
    assert!(particles.velocities[1000..].iter().all(|v| *v == [1.0, -2.0, 3.0]));
    assert!(particles.densities.is_empty() && particles.pressures.is_empty());
    assert_eq!(
        particles,
        sample::particles(&scene).expect("again"),
        "the same scene gives the same particles"
    );
}

#[test]
fn a_ball_has_the_volume_of_a_ball() {
    for (radius, spacing) in [(0.2, 0.025), (0.2, 0.02), (0.4, 0.021), (0.35, 0.03)] {
        let text = changed(
            "position = [0, 0, 0]\nsize = [0.5, 0.5, 0.5]",
            &format!("shape = \"sphere\"\ncenter = [0.5, 0.5, 0.5]\nradius = {radius}"),
        );
        let scene = parse(&text.replace("0.05", &spacing.to_string())).expect("valid");
        let points = positions(&scene);
        let volume = points.len() as f64 * f64::powi(spacing, 3);
        let exact = 4.0 / 3.0 * std::f64::consts::PI * f64::powi(radius, 3);
        let error = (volume / exact - 1.0).abs();
        assert!(error < 0.02, "radius {radius}, spacing {spacing}: {error}");
        // Control: a radius larger by 3 % is detected.
        assert!((volume / (exact * 1.03f64.powi(3)) - 1.0).abs() > 0.02);
        let inside = |p: &[f32; 3]| {
            p.iter().map(|x| (f64::from(*x) - 0.5).powi(2)).sum::<f64>().sqrt() <= radius + 1e-6
        };
        assert!(points.iter().all(inside));
    }
}

#[test]
fn a_ball_on_the_floor_keeps_half_a_spacing_from_it() {
    let text = changed(
        "position = [0, 0, 0]\nsize = [0.5, 0.5, 0.5]",
        "shape = \"sphere\"\ncenter = [0.5, 0.23, 0.5]\nradius = 0.23",
    );
    let lowest = |text: &str| {
        positions(&parse(text).expect("valid")).iter().map(|p| p[1]).fold(f32::INFINITY, f32::min)
    };
    assert!(lowest(&text) >= 0.02);
    let open = text.replace("[fluid]", "open = [\"y_min\"]\n[fluid]");
    assert!(lowest(&open) < 0.02, "control: without a floor the ball is complete");
}

#[test]
fn overlapping_blocks_are_sampled_once() {
    let overlapping = format!("{CUBE}[[fluid.block]]\nposition = [0.26, 0, 0]\nsize = [0.5, 0.5, 0.5]\n");
    let scene = parse(&overlapping).expect("overlap is repaired");
    assert_eq!(scene.warnings.len(), 1);
    let points = positions(&scene);
    assert_eq!(points.len() as u64, check::count(&scene));
    // 0.76 m of the tank contain fluid: 15 layers of 0.05 m.
    assert_eq!(points.len(), 15 * 100);
    assert!(smallest_distance(&points) > 0.7 * 0.05);
    // Control: sampled twice, the same two lattices come much closer.
    let alone =
        parse(&overlapping.replace("position = [0, 0, 0]", "position = [0, 0.5, 0.5]")).expect("apart");
    assert!(alone.warnings.is_empty());
    let mut twice = positions(&parse(CUBE).expect("valid"));
    twice.extend(&positions(&alone)[1000..]);
    assert!(smallest_distance(&twice) < 0.7 * 0.05);
}

#[test]
fn touching_blocks_keep_all_particles() {
    let scene = parse(&format!("{CUBE}[[fluid.block]]\nposition = [0.5, 0, 0]\nsize = [0.5, 0.5, 0.5]\n"))
        .expect("valid");
    assert!(scene.warnings.is_empty(), "{}", scene.warnings[0]);
    let points = positions(&scene);
    assert_eq!(points.len(), 2000);
    assert!((smallest_distance(&points) - 0.05).abs() < 1e-6);
}

#[test]
fn a_block_of_fractional_spacings_touches_its_wall() {
    let low = |text: &str, axis: usize| {
        positions(&parse(text).expect("valid")).iter().map(|p| p[axis]).fold(f32::INFINITY, f32::min)
    };
    let high = |text: &str, axis: usize| {
        positions(&parse(text).expect("valid")).iter().map(|p| p[axis]).fold(0.0, f32::max)
    };
    // 2.4 spacings high: two layers on the floor.
    let floor = changed("size = [0.5, 0.5, 0.5]", "size = [0.5, 0.12, 0.5]");
    assert!((low(&floor, 1) - 0.025).abs() < 1e-6);
    // At the lid: below it.
    let lid = floor.replace("position = [0, 0, 0]", "position = [0, 0.88, 0]");
    assert!((high(&lid, 1) - 0.975).abs() < 1e-6);
    // Away from walls: in the middle.
    let free = floor.replace("position = [0, 0, 0]", "position = [0, 0.4, 0]");
    assert!((low(&free, 1) - 0.435).abs() < 1e-6);
    // From wall to wall: 21 layers in 20.8 spacings, half their distance from the walls.
    let full = changed("max = [1, 1, 1]", "max = [1, 1, 1.04]")
        .replace("size = [0.5, 0.5, 0.5]", "size = [0.5, 0.5, 1.04]");
    let half = 0.5 * 1.04 / 21.0;
    assert!((low(&full, 2) - half).abs() < 1e-6 && (high(&full, 2) - (1.04 - half)).abs() < 1e-6);
    assert_eq!(check::count(&parse(&full).expect("valid")), 10 * 10 * 21);
}

#[test]
fn counting_does_not_create_particles() {
    let mut scene = parse(CUBE).expect("valid");
    scene.fluid.particle_spacing = 0.5e-4;
    assert_eq!(check::count(&scene), 1_000_000_000_000);
    let error = sample::particles(&scene).expect_err("10^12 particles").to_string();
    let fitting: f32 = error
        .split("particle_spacing of ")
        .nth(1)
        .and_then(|rest| rest.split(' ').next()?.parse().ok())
        .expect("a spacing");
    scene.fluid.particle_spacing = fitting;
    assert!(check::count(&scene) <= sample::MAX_PARTICLES);
    scene.fluid.particle_spacing = fitting * 0.9;
    assert!(
        check::count(&scene) > sample::MAX_PARTICLES,
        "control: the suggested spacing is not coarser than necessary"
    );
}

/// A box between the four upright walls of a tank, 10.5 by `height` by 20.4 spacings.
fn between_walls(height: f32) -> Scene {
    let text = format!(
        "[scene]\nname = \"between\"\nduration = 1\n[domain]\nmin = [0, 0, 0]\nmax = [0.525, 1, 1.02]\n[fluid]\n\
         particle_spacing = 0.05\n[[fluid.block]]\nposition = [0, 0, 0]\nsize = [0.525, {height}, 1.02]\n"
    );
    parse(&text).expect("valid")
}

#[test]
fn a_box_between_walls_touches_both_and_has_its_volume() {
    let scene = between_walls(0.6);
    let points = positions(&scene);
    let ends = |axis: usize| {
        let low = points.iter().map(|p| p[axis]).fold(f32::INFINITY, f32::min);
        let high = points.iter().map(|p| p[axis]).fold(f32::NEG_INFINITY, f32::max);
        (low, high)
    };
    // Half of the distance of the layers from each wall.
    for (axis, length, layers) in [(0, 0.525, 11.0), (2, 1.02, 20.0)] {
        let (low, high) = ends(axis);
        let half = 0.5 * length / layers;
        assert!((low - half).abs() < 1e-5 && (length - high - half).abs() < 1e-5, "{axis}: {low} {high}");
    }
    let volume = points.len() as f32 * 0.05_f32.powi(3);
    // To half a layer of twelve. With layers a spacing apart 6.6 % are missing.
    assert!((volume / (0.525 * 0.6 * 1.02) - 1.0).abs() < 0.042, "{volume}");
    // The layers above one another are as far apart as keeps the volume of a particle.
    let pitch = points[points.len() - 1][1] - points[0][1];
    let layers = points.len() as f32 / 220.0;
    let stretch = 0.525 / 11.0 / 0.05 * (1.02 / 20.0 / 0.05);
    assert!((pitch / (layers - 1.0) * stretch / 0.05 - 1.0).abs() < 1e-4, "{pitch}");
}

#[test]
fn a_box_on_a_box_between_walls_continues_its_lattice() {
    let mut scene = between_walls(0.5);
    let below = positions(&scene);
    let pitch = 0.525 / 11.0;
    let mut upper = scene.fluid.blocks[0].clone();
    upper.shape = Shape::Box { min: [0.1, 0.5, 0.2].into(), size: [0.2, 0.2, 0.3].into() };
    scene.fluid.blocks.push(upper);
    let points = positions(&scene);
    assert!(points.len() > below.len());
    for p in &points[below.len()..] {
        let place = (p[0] - 0.5 * pitch) / pitch;
        assert!((place - place.round()).abs() < 1e-3, "{p:?}");
    }
    assert!(smallest_distance(&points) > 0.94 * 0.05);
}

#[test]
fn a_box_on_all_walls_is_not_compressed() {
    let text = "[scene]\nname = \"full\"\nduration = 1\n[domain]\nmin = [0, 0, 0]\nmax = [0.52, 0.53, 0.47]\n[fluid]\n\
                particle_spacing = 0.05\n[[fluid.block]]\nposition = [0, 0, 0]\nsize = [0.52, 0.53, 0.47]\n";
    let points = positions(&parse(text).expect("valid"));
    let volume = points.len() as f64 * 0.05_f64.powi(3) / (0.52 * 0.53 * 0.47);
    // Rounding all lengths down gives 0.869.
    assert!((0.95..=1.0).contains(&volume), "{volume}");
}
