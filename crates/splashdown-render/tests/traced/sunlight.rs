//! Sunlight behind panes, liquid and bodies.

use super::{LEVEL, SIZE, ball, domain, draw, height_of_sun, light, one_sample, pixel_of, slab, tank};
use crate::common::{self, Harness, sample, with};
use splashdown_render::*;

#[test]
fn a_pane_takes_sunlight() {
    let Some(mut harness) = common::harness() else { return };
    let mesh = sample::ball([0.5, 0.2, 0.5], 0.1, 16);
    // Straight down on a point whose ray of the sun passes the pane at the upper end of x.
    let camera = Camera {
        eye: [2.3, 2.5, 0.5],
        target: [2.3, 0.0, 0.5],
        up: [0.0, 0.0, -1.0],
        field_of_view_deg: 30.0,
    };
    let Harness { device, .. } = &harness;
    let surface = UploadedSurface::new(device, &mesh.vertices, &mesh.normals, &mesh.triangles).unwrap();
    let meshes = TracedMeshes::new(device, &mesh.vertices, &mesh.normals, &mesh.triangles, []).unwrap();
    let mut brightness = |tank: Tank| {
        let drawn = DrawnSurface::new(surface.buffers(), Liquid::water());
        let mut frame = Frame::new(camera, domain()).with_surface(drawn).with_tracing(&meshes, one_sample());
        frame.tank = tank;
        light(harness.draw(SIZE, &frame).pixel([SIZE[0] / 2, SIZE[1] / 2])[1])
    };
    // Of the sun 84.3 % pass glass at 59 degrees; the light of the sky remains.
    let sky = Sky::day();
    let [x, y, z] = Frame::SUN;
    let sun = f64::from(sky.sun_light[1] * y / (x * x + y * y + z * z).sqrt());
    let sky = f64::from(sky.sky_light[1]);
    let expected = (0.843 * sun + sky) / (sun + sky);
    let measured = brightness(Tank::Glass) / brightness(Tank::Hidden);
    // One step of a byte is two percent of this light.
    assert!((measured - expected).abs() < 0.03, "{measured}, expected {expected}");
    // Negative control: a pane without effect.
    assert!(measured < 0.95, "{measured}");
}

#[test]
fn a_ball_of_water_focuses_sunlight_on_the_floor() {
    let Some(mut harness) = common::harness() else { return };
    let mesh = sample::ball([1.0, 0.5, 0.5], 0.25, 48);
    let camera = Camera::orbit([1.3, 0.0, 0.7], 3.0, 100.0, 55.0, 40.0);
    // The centre of the ball, projected along the rays of the sun.
    let [x, y, z] = Frame::SUN;
    let spot = pixel_of(camera, [1.0 - 0.5 * x / y, 0.0, 0.5 - 0.5 * z / y]);
    let mut brightness = |index: f32| {
        let liquid = with(Liquid::water(), |l| l.refractive_index = index);
        light(draw(&mut harness, &mesh, liquid, None, camera, one_sample()).pixel(spot)[1])
    };
    let (focused, straight) = (brightness(1.333), brightness(1.0));
    assert!(focused > 2.0 * straight, "{focused} and {straight}");
}

/// The tank with waves of this height on its surface.
fn wavy_tank(amplitude: f32) -> sample::Mesh {
    let mut mesh = tank();
    // Without the upper face, the fourth.
    mesh.triangles.drain(6..8);
    let (side, wave_number) = (161, std::f32::consts::TAU / 0.25);
    let first = mesh.vertices.len() as u32;
    for k in 0..side {
        for i in 0..side {
            let (x, z) = (2.0 * i as f32 / (side - 1) as f32, k as f32 / (side - 1) as f32);
            let (sin_x, cos_x) = (wave_number * x).sin_cos();
            let (sin_z, cos_z) = (wave_number * z).sin_cos();
            mesh.vertices.push([x, LEVEL + amplitude * sin_x * sin_z, z]);
            let steepness = amplitude * wave_number;
            mesh.normals.push([-steepness * cos_x * sin_z, 1.0, -steepness * sin_x * cos_z]);
        }
    }
    for k in 0..side - 1 {
        for i in 0..side - 1 {
            let a = first + k * side + i;
            mesh.triangles.extend([[a, a + side, a + 1], [a + 1, a + side, a + side + 1]]);
        }
    }
    mesh
}

/// Straight down on the middle of the tank.
fn from_above() -> Camera {
    Camera { eye: [1.0, 2.5, 0.5], target: [1.0, 0.0, 0.5], up: [0.0, 0.0, -1.0], field_of_view_deg: 30.0 }
}

/// Light of a sun of strength 1 from bodies, at points of the height 0.2 m around the middle: `[x, z]` in m.
fn sunlight(
    harness: &mut Harness,
    water: &sample::Mesh,
    liquid: Liquid,
    bodies: &[PlacedBody],
    points: &[[f32; 2]],
) -> Vec<f64> {
    let device = &harness.device;
    let surface = UploadedSurface::new(device, &water.vertices, &water.normals, &water.triangles).unwrap();
    let placed = || bodies.iter().map(|body| (body, [0.0; 3], [0.0, 0.0, 0.0, 1.0]));
    let meshes =
        TracedMeshes::new(device, &water.vertices, &water.normals, &water.triangles, placed()).unwrap();
    let uploaded = UploadedBodies::new(device, placed());
    let mut frame = Frame::new(from_above(), domain())
        .with_surface(DrawnSurface::new(surface.buffers(), liquid))
        .with_tracing(&meshes, one_sample());
    frame.bodies = Some(uploaded.buffers());
    frame.tank = Tank::Hidden;
    let [with_sun, without] = [1.0, 0.0].map(|strength| {
        frame.sky.sun_light = [strength; 3];
        harness.draw(SIZE, &frame)
    });
    let pixels = points.iter().map(|&[x, z]| pixel_of(from_above(), [x, 0.2, z]));
    // Pictures show 0.8 of the light.
    pixels.map(|at| (light(with_sun.pixel(at)[1]) - light(without.pixel(at)[1])) / 0.8).collect()
}

fn mean_and_deviation(values: &[f64]) -> (f64, f64) {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let variance = values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / values.len() as f64;
    (mean, variance.sqrt())
}

#[test]
fn waves_focus_sunlight_on_a_body_and_keep_its_mean() {
    let Some(mut harness) = common::harness() else { return };
    let plate = slab([0.3, 0.1, 0.1], [1.7, 0.2, 0.9]);
    let plate = [PlacedBody::new(&plate.vertices, &plate.triangles, [0.5; 3]).unwrap()];
    // Light that enters through the sides of the tank does not reach this part of the plate.
    let grid = (0..40)
        .flat_map(|i| (0..24).map(move |k| [0.75 + 0.5 * i as f32 / 40.0, 0.55 + 0.25 * k as f32 / 24.0]));
    let grid: Vec<[f32; 2]> = grid.collect();
    let clear = with(Liquid::water(), |l| l.absorption = [0.0; 3]);
    let mut seen =
        |water: &sample::Mesh| mean_and_deviation(&sunlight(&mut harness, water, clear, &plate, &grid));
    // The surface lets pass 97.7 % of the sun and 98 % of the view; what leaves the water spreads, and 47.5 % of it
    // return to the plate.
    let expected = 0.5 * height_of_sun() * 0.977 * 0.98 / (1.333 * 1.333) / (1.0 - 0.475 * 0.5);
    let (still, even) = seen(&tank());
    assert!((still / expected - 1.0).abs() < 0.03, "{still}, expected {expected}");
    assert!(even < 0.02 * still, "an even light: {even} of {still}");
    let (wavy, uneven) = seen(&wavy_tank(0.005));
    assert!((wavy / expected - 1.0).abs() < 0.04, "{wavy}, expected {expected}");
    assert!(uneven > 0.1 * wavy, "caustics: {uneven} of {wavy}");
    // Negative control: a factor that ignores the spread.
    assert!((still / (expected * 1.777) - 1.0).abs() > 0.3);
}

#[test]
fn absorption_dims_the_sunlight_on_a_body_along_the_refracted_way() {
    let Some(mut harness) = common::harness() else { return };
    let plate = slab([0.3, 0.1, 0.1], [1.7, 0.2, 0.9]);
    let plate = [PlacedBody::new(&plate.vertices, &plate.triangles, [0.5; 3]).unwrap()];
    let mut seen = |per_metre: f32| {
        let liquid = with(Liquid::water(), |l| l.absorption = [per_metre; 3]);
        sunlight(&mut harness, &tank(), liquid, &plate, &[[1.0, 0.5]])[0]
    };
    let measured = seen(1.0) / seen(0.0);
    // 0.4 m down to the plate at the refracted angle, and straight up to the eye.
    let sine = (1.0 - height_of_sun().powi(2)).sqrt() / 1.333;
    let expected = (-0.4 / (1.0 - sine * sine).sqrt() - 0.4).exp();
    assert!((measured - expected).abs() < 0.02, "{measured}, expected {expected}");
    // Negative control: only the way to the eye.
    assert!((measured - (-0.4_f64).exp()).abs() > 0.1);
}

#[test]
fn shadows_of_bodies_on_bodies_are_refracted() {
    let Some(mut harness) = common::harness() else { return };
    let plate = slab([0.3, 0.1, 0.1], [1.7, 0.2, 0.9]);
    let plate = PlacedBody::new(&plate.vertices, &plate.triangles, [0.5; 3]).unwrap();
    let centre = [0.85, 0.55, 0.4];
    let bodies = [plate, ball(centre, 0.04, [0.5; 3])];
    // Where the ray of the sun through the centre of the ball meets the plate.
    let below = |index: f32| {
        let length = Frame::SUN.iter().map(|x| x * x).sum::<f32>().sqrt();
        let [x, _, z] = Frame::SUN.map(|part| part / length / index);
        let down = 0.35 / (1.0 - x * x - z * z).sqrt();
        [centre[0] - x * down, centre[2] - z * down]
    };
    let points = [below(1.333), below(1.0), [1.2, 0.7]];
    let mut seen = |index: f32| {
        let liquid = with(Liquid::water(), |l| (l.refractive_index, l.absorption) = (index, [0.0; 3]));
        let light = sunlight(&mut harness, &tank(), liquid, &bodies, &points);
        [light[0] / light[2], light[1] / light[2]]
    };
    let [refracted, straight] = seen(1.333);
    assert!(refracted < 0.15 && straight > 0.9, "{refracted} {straight}");
    // Negative control: a liquid that does not refract.
    let [refracted, straight] = seen(1.0);
    assert!(refracted > 0.9 && straight < 0.15, "{refracted} {straight}");
}
