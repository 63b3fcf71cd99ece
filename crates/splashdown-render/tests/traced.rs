//! Pictures with traced rays, compared with Snell's law, Beer-Lambert, and a reference picture.

mod common;

use common::{Harness, Picture, sample, with};
use splashdown_render::*;

const SIZE: [u32; 2] = [320, 240];
/// The level of the water in a tank of 2 x 1 x 1 m.
const LEVEL: f32 = 0.6;
const RED: [f32; 3] = [0.8, 0.03, 0.03];

fn domain() -> Domain {
    Domain::closed([0.0; 3], [2.0, 1.0, 1.0])
}

/// A box with flat faces, counterclockwise as seen from outside.
fn slab(low: [f32; 3], high: [f32; 3]) -> sample::Mesh {
    let mut mesh = sample::Mesh { vertices: vec![], normals: vec![], triangles: vec![] };
    for face in 0..6 {
        let (axis, upper) = (face / 2, face % 2 == 1);
        let (u, v) = if upper { ((axis + 1) % 3, (axis + 2) % 3) } else { ((axis + 2) % 3, (axis + 1) % 3) };
        let first = mesh.vertices.len() as u32;
        for (a, b) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
            let mut corner = [0.0; 3];
            corner[axis] = if upper { high[axis] } else { low[axis] };
            corner[u] = if a == 0 { low[u] } else { high[u] };
            corner[v] = if b == 0 { low[v] } else { high[v] };
            let mut normal = [0.0; 3];
            normal[axis] = if upper { 1.0 } else { -1.0 };
            mesh.vertices.push(corner);
            mesh.normals.push(normal);
        }
        mesh.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    }
    mesh
}

/// Draws a liquid and a body with traced rays.
fn draw(
    harness: &mut Harness,
    water: &sample::Mesh,
    liquid: Liquid,
    body: Option<&PlacedBody>,
    camera: Camera,
    quality: Quality,
) -> Picture {
    let device = &harness.device;
    let surface = UploadedSurface::new(device, &water.vertices, &water.normals, &water.triangles).unwrap();
    let place = ([0.0; 3], [0.0, 0.0, 0.0, 1.0]);
    let placed = || body.map(|body| (body, place.0, place.1));
    let meshes =
        TracedMeshes::new(device, &water.vertices, &water.normals, &water.triangles, placed()).unwrap();
    let bodies = UploadedBodies::new(device, placed());
    let mut frame = Frame::new(camera, domain())
        .with_surface(DrawnSurface::new(surface.buffers(), liquid))
        .with_tracing(&meshes, quality);
    frame.bodies = body.map(|_| bodies.buffers());
    harness.draw(SIZE, &frame)
}

fn one_sample() -> Quality {
    with(Quality::STANDARD, |q| q.samples = 1)
}

fn tank() -> sample::Mesh {
    slab([0.0; 3], [2.0, LEVEL, 1.0])
}

fn ball(centre: [f32; 3], radius: f32, colour: [f32; 3]) -> PlacedBody {
    let mesh = sample::ball(centre, radius, 32);
    PlacedBody::new(&mesh.vertices, &mesh.triangles, colour).unwrap()
}

fn pixel_of(camera: Camera, point: [f32; 3]) -> [u32; 2] {
    camera.project(point, SIZE).unwrap().unwrap().map(|x| x as u32)
}

fn is_red([r, g, b]: [u8; 3]) -> bool {
    i32::from(r) - i32::from(g.max(b)) > 40
}

/// The zero of a function that changes its sign once.
fn root(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    let sign = f(low).signum();
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if f(middle).signum() == sign { low = middle } else { high = middle }
    }
    low
}

fn sine(opposite: f64, adjacent: f64) -> f64 {
    opposite / opposite.hypot(adjacent)
}

#[test]
fn a_body_under_water_appears_where_snells_law_puts_it() {
    let Some(mut harness) = common::harness() else { return };
    let (eye, place) = ([1.0, 2.2, 2.4], [1.0, 0.15, 0.5]);
    let camera = Camera { eye, target: [1.0, 0.4, 0.5], up: [0.0, 1.0, 0.0], field_of_view_deg: 40.0 };
    let body = ball(place, 0.03, RED);
    // Where the ray crosses the level: n sin(angle in water) = sin(angle in air).
    let snell =
        |z: f64| sine(2.4 - z, 2.2 - f64::from(LEVEL)) - 1.333 * sine(z - 0.5, f64::from(LEVEL) - 0.15);
    let bent = pixel_of(camera, [1.0, LEVEL, root(0.5, 1.0, snell) as f32]);
    let straight = pixel_of(camera, place);
    assert!(bent[1].abs_diff(straight[1]) > 8, "{bent:?} {straight:?}");
    let picture = draw(&mut harness, &tank(), Liquid::water(), Some(&body), camera, one_sample());
    assert!(is_red(picture.pixel(bent)), "{:?} at {bent:?}", picture.pixel(bent));
    assert!(!is_red(picture.pixel(straight)));
    // Negative control: a liquid that does not refract.
    let air = with(Liquid::water(), |l| l.refractive_index = 1.0);
    let picture = draw(&mut harness, &tank(), air, Some(&body), camera, one_sample());
    assert!(!is_red(picture.pixel(bent)) && is_red(picture.pixel(straight)));
}

#[test]
fn the_surface_reflects_totally_from_below() {
    let Some(mut harness) = common::harness() else { return };
    let camera = Camera {
        eye: [1.0, 0.05, 1.6],
        target: [1.0, 0.5, 0.5],
        up: [0.0, 1.0, 0.0],
        field_of_view_deg: 60.0,
    };
    let body = ball([1.0, 0.3, 0.3], 0.05, RED);
    // The mirror image of the body above the level, seen through the front of the tank at z = 1.
    let image = 2.0 * f64::from(LEVEL) - 0.3;
    let snell = |y: f64| sine(y - 0.05, 0.6) - 1.333 * sine(image - y, 0.7);
    let height = root(0.05, f64::from(LEVEL), snell);
    assert!(height < f64::from(LEVEL) - 0.02, "{height}");
    let pixel = pixel_of(camera, [1.0, height as f32, 1.0]);
    let picture = draw(&mut harness, &tank(), Liquid::water(), Some(&body), camera, one_sample());
    assert!(is_red(picture.pixel(pixel)), "{:?} at {pixel:?}", picture.pixel(pixel));
    // Negative control: without refraction there is no reflection.
    let air = with(Liquid::water(), |l| l.refractive_index = 1.0);
    let picture = draw(&mut harness, &tank(), air, Some(&body), camera, one_sample());
    assert!(!is_red(picture.pixel(pixel)));
}

/// A camera in the tank at this height, which looks up or down. Light that enters through the sides of the tank does not
/// reach what is below it.
fn under_water(height: f32, up: bool) -> Camera {
    let target = [0.8, height + if up { 1.0 } else { -1.0 }, 0.65];
    Camera { eye: [0.8, height, 0.65], target, up: [0.0, 0.0, 1.0], field_of_view_deg: 130.0 }
}

#[test]
fn an_eye_in_the_liquid_sees_snells_window() {
    let Some(mut harness) = common::harness() else { return };
    // Outside the window the surface mirrors this plate on the bottom, which fills the tank.
    let plate = slab([0.01, 0.01, 0.01], [1.99, 0.05, 0.99]);
    let plate = PlacedBody::new(&plate.vertices, &plate.triangles, RED).unwrap();
    let camera = under_water(0.3, true);
    let mut seen = |liquid: Liquid, angle_deg: f32| {
        let picture = draw(&mut harness, &tank(), liquid, Some(&plate), camera, one_sample());
        let reach = 0.3 * angle_deg.to_radians().tan();
        is_red(picture.pixel(pixel_of(camera, [0.8 + reach, LEVEL, 0.65])))
    };
    // The critical angle is 48.6 degrees.
    assert!(!seen(Liquid::water(), 44.0));
    assert!(seen(Liquid::water(), 53.0));
    // Negative control: a liquid of another refractive index, with a window of 70 degrees.
    assert!(!seen(with(Liquid::water(), |l| l.refractive_index = 1.06), 53.0));
}

#[test]
fn an_eye_in_the_liquid_sees_absorption() {
    let Some(mut harness) = common::harness() else { return };
    let plate = slab([0.3, 0.05, 0.1], [1.7, 0.1, 0.9]);
    let plate = PlacedBody::new(&plate.vertices, &plate.triangles, [0.5; 3]).unwrap();
    let mut seen = |height: f32, per_metre: f32| {
        let liquid = with(Liquid::water(), |l| l.absorption = [per_metre; 3]);
        let camera = under_water(height, false);
        let picture = draw(&mut harness, &tank(), liquid, Some(&plate), camera, one_sample());
        light(picture.pixel([SIZE[0] / 2, SIZE[1] / 2])[1])
    };
    // The light on the plate is the same in both pictures; 0.3 m of liquid lie between the eyes.
    let measured = seen(0.5, 1.5) / seen(0.2, 1.5);
    let expected = (-1.5_f64 * 0.3).exp();
    assert!((measured - expected).abs() < 0.03, "{measured}, expected {expected}");
    // Negative control: a liquid without absorption.
    assert!((seen(0.5, 0.0) / seen(0.2, 0.0) - 1.0).abs() < 0.03);
}

#[test]
fn an_eye_at_the_surface_sees_liquid_below_it() {
    let Some(mut harness) = common::harness() else { return };
    let plate = slab([0.3, 0.05, 0.1], [1.7, 0.1, 0.9]);
    let plate = PlacedBody::new(&plate.vertices, &plate.triangles, [0.5; 3]).unwrap();
    let ink = with(Liquid::water(), |l| l.absorption = [0.0, 400.0, 400.0]);
    // Slightly above, in the surface, and slightly below it.
    for height in [LEVEL + 2e-4, LEVEL, LEVEL - 2e-4] {
        let picture =
            draw(&mut harness, &tank(), ink, Some(&plate), under_water(height, false), one_sample());
        let [r, g, b] = picture.pixel([SIZE[0] / 2, SIZE[1] / 2]);
        assert!(r > 60 && u32::from(g.max(b)) < u32::from(r) - 20, "{r} {g} {b} at {height}");
    }
}

/// The light that a stored byte stands for: the inverse of the sRGB encoding and of the tone curve.
fn light(byte: u8) -> f64 {
    let stored = f64::from(byte) / 255.0;
    let y = if stored <= 0.04045 { stored / 12.92 } else { ((stored + 0.055) / 1.055).powf(2.4) };
    let (a, b) = (2.51 - 2.43 * y, 0.03 - 0.59 * y);
    ((b * b + 0.56 * a * y).sqrt() - b) / (2.0 * a)
}

#[test]
fn light_is_absorbed_along_the_path() {
    let Some(mut harness) = common::harness() else { return };
    // Straight down on a plate, through 0.4 m of liquid.
    let camera = Camera {
        eye: [1.0, 2.5, 0.5],
        target: [1.0, 0.0, 0.5],
        up: [0.0, 0.0, -1.0],
        field_of_view_deg: 30.0,
    };
    let plate = slab([0.6, 0.1, 0.2], [1.4, 0.2, 0.8]);
    let plate = PlacedBody::new(&plate.vertices, &plate.triangles, [0.5; 3]).unwrap();
    let mut seen = |per_metre: f32| {
        let liquid = with(Liquid::water(), |l| l.absorption = [per_metre; 3]);
        let picture = draw(&mut harness, &tank(), liquid, Some(&plate), camera, one_sample());
        light(picture.pixel([SIZE[0] / 2, SIZE[1] / 2])[1])
    };
    // What the surface reflects does not pass the liquid.
    let reflected = seen(400.0);
    let clear = seen(0.0) - reflected;
    let measured = (seen(1.5) - reflected) / clear;
    // The light of the sun is also absorbed on its way to the plate, at the refracted angle. Of it 97.7 % / 1.333^2 leave
    // the liquid, and 52.5 % of that of the sky.
    let sky = Sky::day();
    let sun = f64::from(sky.sun_light[1]) * height_of_sun() * 0.977 / 1.777;
    let sky = f64::from(sky.sky_light[1]) * 0.525;
    let sine = (1.0 - height_of_sun().powi(2)).sqrt() / 1.333;
    let lit = (sun * (-1.5 * 0.4 / (1.0 - sine * sine).sqrt()).exp() + sky) / (sun + sky);
    // One step of a byte is two percent of this light.
    let expected = |path: f64| lit * (-1.5 * path).exp();
    assert!((measured - expected(0.4)).abs() < 0.03, "{measured}, expected {}", expected(0.4));
    // Negative control: another path length.
    assert!((measured - expected(0.5)).abs() > 0.03);
}

#[test]
fn matte_surfaces_are_darker_in_water() {
    let Some(mut harness) = common::harness() else { return };
    let camera = Camera {
        eye: [1.0, 2.5, 0.5],
        target: [1.0, 0.0, 0.5],
        up: [0.0, 0.0, -1.0],
        field_of_view_deg: 30.0,
    };
    let plate = slab([0.6, 0.1, 0.2], [1.4, 0.2, 0.8]);
    let mut measured = |albedo: f32| {
        let plate = PlacedBody::new(&plate.vertices, &plate.triangles, [albedo; 3]).unwrap();
        let mut seen = |index: f32, per_metre: f32| {
            let liquid =
                with(Liquid::water(), |l| (l.refractive_index, l.absorption) = (index, [per_metre; 3]));
            let picture = draw(&mut harness, &tank(), liquid, Some(&plate), camera, one_sample());
            light(picture.pixel([SIZE[0] / 2, SIZE[1] / 2])[1])
        };
        (seen(1.333, 0.0) - seen(1.333, 400.0)) / seen(1.0, 0.0)
    };
    // The surface reflects 2 % of light from above and 47.5 % of diffuse light from below. Of the latter the plate sends
    // its albedo back. The light of the sun, of which 97.7 % pass the surface, leaves with 1 / 1.333^2 of its radiance.
    let sky = Sky::day();
    let sun = f64::from(sky.sun_light[1]) * height_of_sun();
    let of_sun = sun / (sun + f64::from(sky.sky_light[1]));
    let passed = of_sun * 0.977 / 1.777 + (1.0 - of_sun) * (1.0 - 0.475);
    let expected = |albedo: f64| 0.98 * passed / (1.0 - 0.475 * albedo);
    let dark_and_light = [0.2, 0.7].map(|albedo| {
        let (measured, expected) = (measured(albedo), expected(f64::from(albedo)));
        assert!((measured - expected).abs() < 0.03, "{measured}, expected {expected} for {albedo}");
        measured
    });
    // Negative control: the same factor for all.
    assert!(dark_and_light[1] - dark_and_light[0] > 0.06, "{dark_and_light:?}");
}

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

/// The vertical component of the unit vector to the sun.
fn height_of_sun() -> f64 {
    let [x, y, z] = Frame::SUN.map(f64::from);
    y / (x * x + y * y + z * z).sqrt()
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

#[test]
fn more_samples_show_the_same_picture_and_a_lens_blurs_it() {
    let Some(mut harness) = common::harness() else { return };
    let water = sample::waves([0.0; 3], [2.0, 1.0, 1.0], 64);
    let body = ball([1.0, 0.75, 0.5], 0.12, RED);
    let camera = Camera::framing(&domain(), 28.0, 18.0, 35.0, 1.33);
    let mut drawn = |quality| draw(&mut harness, &water, Liquid::water(), Some(&body), camera, quality);
    let few = drawn(Quality::STANDARD);
    let many = drawn(with(Quality::FINAL, |q| q.samples = 17));
    let difference = many.difference(&few);
    assert!(difference.mean < 4.0, "{difference:?}");
    let lens = drawn(with(Quality::FINAL, |q| (q.samples, q.aperture, q.focus) = (17, 0.3, Some(1.0))));
    let centre = pixel_of(camera, [1.0, 0.75, 0.5]);
    assert!(is_red(few.pixel(centre)) && is_red(many.pixel(centre)));
    // The sharp outline of the body becomes wide.
    let reds = |picture: &Picture| {
        let all = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| [x, y]));
        all.filter(|at| is_red(picture.pixel(*at))).count()
    };
    assert!(many.difference(&lens).mean > 2.0 * difference.mean);
    assert!(reds(&lens) != reds(&many));
}

#[test]
fn waves_in_a_tank() {
    let Some(mut harness) = common::harness() else { return };
    let size = [160, 120];
    let mesh = sample::waves([0.0; 3], [2.0, 1.0, 1.0], 96);
    let Harness { device, .. } = &harness;
    let surface = UploadedSurface::new(device, &mesh.vertices, &mesh.normals, &mesh.triangles).unwrap();
    let meshes = TracedMeshes::new(device, &mesh.vertices, &mesh.normals, &mesh.triangles, []).unwrap();
    let frame = |azimuth: f32, liquid: Liquid| {
        let camera = Camera::framing(&domain(), azimuth, 18.0, 35.0, 1.4);
        let drawn = DrawnSurface::new(surface.buffers(), liquid);
        Frame::new(camera, domain()).with_surface(drawn).with_tracing(&meshes, Quality::STANDARD)
    };
    let picture = harness.draw(size, &frame(28.0, Liquid::water()));
    picture.expect("traced-water");
    assert!(!harness.draw(size, &frame(30.0, Liquid::water())).difference(&picture).is_small());
    assert!(!harness.draw(size, &frame(28.0, Liquid::oil())).difference(&picture).is_small());
    let mut rough = frame(28.0, Liquid::water());
    rough.traced = None;
    assert!(!harness.draw(size, &rough).difference(&picture).is_small(), "the interactive picture");
}

#[test]
fn invalid_meshes_and_qualities_are_refused() {
    let Some(mut harness) = common::harness() else { return };
    let tank = tank();
    let wrong = [[0, 1, 999]];
    let error = TracedMeshes::new(&harness.device, &tank.vertices, &tank.normals, &wrong, []).unwrap_err();
    assert!(matches!(error, RenderError::Index { .. }), "{error}");
    let error = TracedMeshes::new(&harness.device, &tank.vertices, &tank.normals[1..], &tank.triangles, [])
        .unwrap_err();
    assert!(matches!(error, RenderError::Length { .. }), "{error}");
    let Harness { device, queue, renderer } = &mut harness;
    let surface = UploadedSurface::new(device, &tank.vertices, &tank.normals, &tank.triangles).unwrap();
    let meshes = TracedMeshes::new(device, &tank.vertices, &[], &tank.triangles, []).unwrap();
    let camera = Camera::framing(&domain(), 28.0, 18.0, 35.0, 1.33);
    let frame = Frame::new(camera, domain())
        .with_surface(DrawnSurface::new(surface.buffers(), Liquid::water()))
        .with_tracing(&meshes, with(Quality::STANDARD, |q| q.samples = 0));
    let mut target = Offscreen::new(device, queue, SIZE).unwrap();
    let error = target.render_to_rgba(renderer, &frame).unwrap_err();
    assert!(error.to_string().contains("1 to 4096 samples"), "{error}");
}

#[test]
fn samples_of_several_frames_are_averaged() {
    let Some(mut harness) = common::harness() else { return };
    let camera = Camera::orbit([1.0, 0.5, 0.5], 3.0, 0.0, 20.0, 40.0);
    let quality = with(Quality::STANDARD, |q| q.samples = 4);
    let (water, place) = (tank(), [0.0, 0.0, 0.0, 1.0]);
    let body = ball([0.0; 3], 0.12, RED);
    let device = harness.device.clone();
    let surface = UploadedSurface::new(&device, &water.vertices, &water.normals, &water.triangles).unwrap();
    let moment = |x: f32| {
        let placed = || [(&body, [x, 0.85, 0.5], place)];
        let meshes = TracedMeshes::new(&device, &water.vertices, &water.normals, &water.triangles, placed());
        (meshes.unwrap(), UploadedBodies::new(&device, placed()))
    };
    let moments = [moment(0.6), moment(1.4)];
    let [left, right] = moments.each_ref().map(|(meshes, bodies)| {
        Frame::new(camera, domain())
            .with_surface(DrawnSurface::new(surface.buffers(), Liquid::water()))
            .with_bodies(bodies.buffers())
            .with_tracing(meshes, quality)
    });
    let mut draw = |first: &Frame<'_>, second: &Frame<'_>| {
        let Harness { device, queue, renderer } = &mut harness;
        let mut target = Offscreen::new(device, queue, SIZE).unwrap();
        target.submit_samples(renderer, first, 0..2).unwrap();
        let ticket = target.submit_from(renderer, second, 2).unwrap().expect("a picture of one tile");
        Picture { size: SIZE, rgba: target.collect(ticket).unwrap() }
    };
    let (blurred, at_left) = (draw(&left, &right), draw(&left, &left));
    let green = |picture: &Picture, x: f32| picture.pixel(pixel_of(camera, [x, 0.85, 0.5]))[1];
    let (ball, sky) = (green(&at_left, 0.6), green(&at_left, 1.4));
    assert!(sky > ball + 80, "{sky} {ball}");
    // Both places show the ball for half of the time.
    for x in [0.6, 1.4] {
        let both = green(&blurred, x);
        assert!(both > ball + 20 && both + 20 < sky, "{x}: {both} between {ball} and {sky}");
    }
    // From one frame, the parts give the picture of one call.
    assert_eq!(at_left.rgba, harness.draw(SIZE, &left).rgba);
}

/// Water with a cavity that a box fills but for rounding, as the surface of a simulation ends at bodies.
fn tank_around(low: [f32; 3], high: [f32; 3]) -> sample::Mesh {
    let (mut water, cavity) = (tank(), slab(low.map(|x| x - 1e-5), high.map(|x| x + 1e-5)));
    let first = water.vertices.len() as u32;
    water.vertices.extend(cavity.vertices);
    water.normals.extend(cavity.normals.iter().map(|n| n.map(|x| -x)));
    water.triangles.extend(cavity.triangles.iter().map(|&[a, b, c]| [first + a, first + c, first + b]));
    water
}

#[test]
fn a_box_that_fills_a_cavity_looks_like_a_box_in_water() {
    let Some(mut harness) = common::harness() else { return };
    let (low, high) = ([0.613, 0.117, 0.271], [1.237, 0.383, 0.719]);
    let mesh = slab(low, high);
    let body = PlacedBody::new(&mesh.vertices, &mesh.triangles, RED).unwrap();
    let camera = Camera::orbit([0.925, 0.38, 0.495], 2.2, 20.0, 50.0, 30.0);
    let mut drawn =
        |water: &sample::Mesh| draw(&mut harness, water, Liquid::water(), Some(&body), camera, one_sample());
    let (cavity, solid) = (drawn(&tank_around(low, high)), drawn(&tank()));
    // The upper side of the box, well inside its outline.
    let mut pixels = (0..40).flat_map(|x| (0..40).map(move |z| [x as f32 / 39.0, z as f32 / 39.0]));
    assert!(pixels.all(|[x, z]| {
        let pixel = pixel_of(camera, [0.73 + 0.4 * x, 0.46, 0.38 + 0.22 * z]);
        cavity.pixel(pixel).iter().zip(solid.pixel(pixel)).all(|(a, b)| a.abs_diff(b) < 12)
    }));
}

/// Averages in half precision would lose the samples that are small beside them.
#[test]
fn many_samples_are_as_bright_as_a_few() {
    let Some(mut harness) = common::harness() else { return };
    let size = [12, 9];
    let mesh = slab([0.0; 3], [2.0, 0.2, 1.0]);
    let Harness { device, .. } = &harness;
    let surface = UploadedSurface::new(device, &mesh.vertices, &mesh.normals, &mesh.triangles).unwrap();
    let meshes = TracedMeshes::new(device, &mesh.vertices, &mesh.normals, &mesh.triangles, []).unwrap();
    let camera = Camera::framing(&domain(), 28.0, 4.0, 35.0, 1.33);
    let mut brightness = |samples: u32| {
        let quality = with(Quality::STANDARD, |q| q.samples = samples);
        let drawn = DrawnSurface::new(surface.buffers(), Liquid::water());
        let frame = Frame::new(camera, domain()).with_surface(drawn).with_tracing(&meshes, quality);
        let picture = harness.draw(size, &frame);
        let pixels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| [x, y]));
        let bytes: Vec<f64> = pixels.flat_map(|at| picture.pixel(at)).map(f64::from).collect();
        bytes.iter().sum::<f64>() / bytes.len() as f64
    };
    let (few, many) = (brightness(17), brightness(150));
    assert!((many - few).abs() < 1.0, "{few} and {many} of 255");
}
