//! Sky, sun, floor, tank and turbid liquids change pictures as intended, in both ways of drawing a liquid.

mod common;

use common::{Harness, Picture, sample, with};
use splashdown_render::*;

const SIZE: [u32; 2] = [240, 160];
const BALL: [f32; 3] = [1.0, 0.5, 0.5];

fn domain() -> Domain {
    Domain::closed([0.0; 3], [2.0, 1.0, 1.0])
}

/// From the +z side, slightly above the horizon.
fn camera() -> Camera {
    Camera::framing(&domain(), 0.0, 12.0, 40.0, 1.5)
}

/// A ball of liquid above the floor, drawn without and with traced rays.
fn both(harness: &mut Harness, liquid: Liquid, change: impl Fn(&mut Frame<'_>)) -> [Picture; 2] {
    let mesh = sample::ball(BALL, 0.35, 32);
    let device = &harness.device;
    let surface = UploadedSurface::new(device, &mesh.vertices, &mesh.normals, &mesh.triangles).unwrap();
    let meshes = TracedMeshes::new(device, &mesh.vertices, &mesh.normals, &mesh.triangles, []).unwrap();
    let mut frame = Frame::new(camera(), domain()).with_surface(DrawnSurface::new(surface.buffers(), liquid));
    change(&mut frame);
    let one_sample = with(Quality::STANDARD, |q| q.samples = 1);
    [harness.draw(SIZE, &frame), harness.draw(SIZE, &frame.with_tracing(&meshes, one_sample))]
}

fn pixel_of(point: [f32; 3]) -> [u32; 2] {
    camera().project(point, SIZE).unwrap().unwrap().map(|x| x as u32)
}

fn brightness(pixel: [u8; 3]) -> u32 {
    pixel.into_iter().map(u32::from).sum()
}

/// The upper left corner shows the sky.
const IN_THE_SKY: [u32; 2] = [4, 2];

#[test]
fn a_day_is_blue_and_a_sunset_is_red() {
    let Some(mut harness) = common::harness() else { return };
    for picture in both(&mut harness, Liquid::water(), |_| {}) {
        let [r, _, b] = picture.pixel(IN_THE_SKY);
        assert!(b > r, "a day: {r} {b}");
    }
    for picture in both(&mut harness, Liquid::water(), |frame| frame.sky = Sky::sunset()) {
        let [r, _, b] = picture.pixel(IN_THE_SKY);
        assert!(r > b.saturating_add(30), "a sunset: {r} {b}");
    }
    let green = Sky::day().with_gradient([0.0, 0.5, 0.0], [0.0, 1.0, 0.0]);
    for picture in both(&mut harness, Liquid::water(), |frame| frame.sky = green) {
        let [r, g, b] = picture.pixel(IN_THE_SKY);
        assert!(g > r.max(b).saturating_add(30), "a green sky: {r} {g} {b}");
    }
}

#[test]
fn without_a_sun_there_are_no_shadows() {
    let Some(mut harness) = common::harness() else { return };
    // Opaque, so that its shadow is dark. The sun is above the ball.
    let ink = with(Liquid::water(), |l| l.absorption = [1000.0; 3]);
    let [below, beside] = [[1.0, 0.0, 0.5], [0.1, 0.0, 0.5]].map(pixel_of);
    let plain = Floor { pattern: FloorPattern::Plain, ..Floor::default() };
    let overhead = |frame: &mut Frame<'_>| {
        (frame.sun, frame.floor, frame.tank) = ([0.0, 1.0, 0.0], Some(plain), Tank::Hidden);
    };
    for picture in both(&mut harness, ink, overhead) {
        let [below, beside] = [below, beside].map(|at| brightness(picture.pixel(at)));
        assert!(beside > below + 150, "with a sun: {below} {beside}");
    }
    let dark = |frame: &mut Frame<'_>| {
        overhead(frame);
        frame.sky.sun_light = [0.0; 3];
    };
    for picture in both(&mut harness, ink, dark) {
        let [below, beside] = [below, beside].map(|at| brightness(picture.pixel(at)));
        assert!(beside.abs_diff(below) < 15, "without a sun: {below} {beside}");
    }
}

#[test]
fn the_floor_has_its_colour_and_its_squares() {
    let Some(mut harness) = common::harness() else { return };
    // Tiles are 0.2 m wide here. Two neighbours in front of the tank.
    let squares = [[0.5, 0.0, 1.1], [0.7, 0.0, 1.1]].map(pixel_of);
    let of = |pattern, colour| move |frame: &mut Frame<'_>| frame.floor = Some(Floor { pattern, colour });
    for picture in both(&mut harness, Liquid::water(), of(FloorPattern::Plain, [0.5, 0.0, 0.0])) {
        let [[r, g, b], other] = squares.map(|at| picture.pixel(at));
        assert!(r > 100 && g < 30 && b < 30, "red: {r} {g} {b}");
        assert!(brightness(other).abs_diff(brightness([r, g, b])) < 10, "one colour");
    }
    for picture in both(&mut harness, Liquid::water(), of(FloorPattern::Checkerboard, [0.3; 3])) {
        let [a, b] = squares.map(|at| brightness(picture.pixel(at)));
        assert!(a.abs_diff(b) > 100, "squares: {a} {b}");
    }
    for picture in both(&mut harness, Liquid::water(), |frame| frame.floor = None) {
        // The haze below the horizon is even.
        let [a, b] = squares.map(|at| picture.pixel(at));
        assert_eq!(a, b);
        assert_eq!(a, picture.pixel([SIZE[0] - 4, SIZE[1] - 4]));
    }
}

#[test]
fn a_turbid_liquid_hides_what_is_behind_it() {
    let Some(mut harness) = common::harness() else { return };
    let turbid = with(Liquid::water(), |l| {
        l.scattering = 1000.0;
        l.colour = [0.6, 0.02, 0.02];
    });
    let middle = pixel_of(BALL);
    for picture in both(&mut harness, turbid, |_| {}) {
        let [r, g, b] = picture.pixel(middle);
        assert!(r > g.max(b).saturating_add(80), "turbid: {r} {g} {b}");
    }
    // Negative control: the same colour without scattering.
    let clear = with(turbid, |l| l.scattering = 0.0);
    for picture in both(&mut harness, clear, |_| {}) {
        let [r, g, b] = picture.pixel(middle);
        assert!(r < g.max(b).saturating_add(20), "clear: {r} {g} {b}");
    }
    // Both ways of drawing agree for an opaque liquid.
    let [drawn, traced] = both(&mut harness, turbid, |_| {}).map(|picture| picture.pixel(middle));
    assert!(drawn.iter().zip(traced).all(|(a, b)| a.abs_diff(b) < 6), "{drawn:?} {traced:?}");
}

#[test]
fn the_tank_is_glass_lines_or_hidden() {
    let Some(mut harness) = common::harness() else { return };
    let mut with_tank = |tank| both(&mut harness, Liquid::water(), |frame| frame.tank = tank);
    let (glass, edges, hidden) = (with_tank(Tank::Glass), with_tank(Tank::Edges), with_tank(Tank::Hidden));
    // On the front edge at the top, in front of the haze.
    let at = pixel_of([0.5, 1.0, 1.0]);
    for i in 0..2 {
        let [line, none] = [&edges, &hidden].map(|pictures| brightness(pictures[i].pixel(at)));
        assert!(line + 60 < none, "{line} {none}");
        assert!(!glass[i].rgba.eq(&hidden[i].rgba) && !glass[i].rgba.eq(&edges[i].rgba));
    }
    // Negative control: the same tank gives the same picture.
    assert!(with_tank(Tank::Hidden)[0].rgba == hidden[0].rgba);
}

#[test]
fn invalid_surroundings_are_refused() {
    let Some(mut harness) = common::harness() else { return };
    let mut target = Offscreen::new(&harness.device, &harness.queue, SIZE).unwrap();
    let good = Frame::new(camera(), domain());
    let mut draw = |frame: &Frame<'_>| target.render_to_rgba(&mut harness.renderer, frame).map(|_| ());
    assert!(draw(&good).is_ok());
    let sky = with(good, |f| f.sky.cloud_opacity = 1.5);
    let floor = with(good, |f| f.floor = Some(Floor { colour: [2.0; 3], ..Floor::default() }));
    for (wrong, part) in [(sky, "the sky"), (floor, "the colour of the floor")] {
        let error = draw(&wrong).unwrap_err().to_string();
        assert!(error.contains(part), "{error}");
    }
}
