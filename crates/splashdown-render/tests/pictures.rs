//! Small pictures compared with reference pictures, each with negative controls.

mod common;

use common::{sample, with};
use splashdown_render::*;

/// Small, because the references are committed.
const SIZE: [u32; 2] = [160, 120];
/// Large enough for the colour bar.
const WITH_BAR: [u32; 2] = [240, 160];

const ASPECT_RATIO: f32 = 1.4;

fn frame(domain: Domain) -> Frame<'static> {
    let camera = Camera::framing(&domain, 28.0, 18.0, 35.0, ASPECT_RATIO);
    Frame::new(camera, domain)
}

fn moved(frame: Frame<'_>) -> Frame<'_> {
    with(frame, |f| f.camera = Camera::framing(&f.domain, 30.0, 18.0, 35.0, ASPECT_RATIO))
}

#[test]
fn particles() {
    let Some(mut harness) = common::harness() else { return };
    let cloud = sample::collapsing_column([2.0, 1.0, 1.0], 0.05);
    let particles = UploadedParticles::new(
        &harness.device,
        &cloud.positions,
        &cloud.velocities,
        &cloud.densities,
        &cloud.pressures,
    )
    .unwrap();
    let quantities = [
        (Quantity::Speed, [0.0, 3.0], ColourMap::Water, "particles-speed", WITH_BAR),
        (Quantity::Density, [1000.0, 1009.0], ColourMap::Viridis, "particles-density", SIZE),
        (Quantity::Pressure, [0.0, 9000.0], ColourMap::Inferno, "particles-pressure", SIZE),
    ];
    for (quantity, range, map, name, size) in quantities {
        let colouring = Colouring::new(quantity, range).with_map(map).with_colour_bar(size == WITH_BAR);
        let drawn = DrawnParticles::new(particles.buffers(), 0.025, colouring);
        let good =
            frame(Domain::closed([0.0; 3], [2.0, 1.0, 1.0])).with_particles(drawn).with_caption("t = 0.42 s");
        let picture = harness.draw(size, &good);
        picture.expect(name);

        assert!(!harness.draw(size, &moved(good)).difference(&picture).is_small(), "a moved camera");
        let wrong = good.with_particles(with(drawn, |d| d.colouring.map = ColourMap::BlueRed));
        assert!(!harness.draw(size, &wrong).difference(&picture).is_small(), "another colour map");
        let wrong = good.with_particles(with(drawn, |d| d.radius = 0.015));
        assert!(!harness.draw(size, &wrong).difference(&picture).is_small(), "smaller particles");
    }
}

#[test]
fn surfaces() {
    let Some(mut harness) = common::harness() else { return };
    let mesh = sample::waves([0.0; 3], [2.0, 1.0, 1.0], 96);
    let waves =
        UploadedSurface::new(&harness.device, &mesh.vertices, &mesh.normals, &mesh.triangles).unwrap();
    for name in ["water", "honey"] {
        let liquid = Liquid::from_name(name).unwrap();
        let drawn = DrawnSurface::new(waves.buffers(), liquid);
        let good = frame(Domain::closed([0.0; 3], [2.0, 1.0, 1.0])).with_surface(drawn);
        let picture = harness.draw(SIZE, &good);
        picture.expect(&format!("surface-{name}"));

        assert!(!harness.draw(SIZE, &moved(good)).difference(&picture).is_small(), "a moved camera");
        let wrong = good.with_surface(with(drawn, |d| d.liquid = Liquid::oil()));
        assert!(!harness.draw(SIZE, &wrong).difference(&picture).is_small(), "another liquid");
        let flat: Vec<[f32; 3]> = vec![[0.0, 1.0, 0.0]; mesh.vertices.len()];
        let flat = UploadedSurface::new(&harness.device, &mesh.vertices, &flat, &mesh.triangles).unwrap();
        let wrong = good.with_surface(DrawnSurface::new(flat.buffers(), liquid));
        assert!(!harness.draw(SIZE, &wrong).difference(&picture).is_small(), "wrong normals");
    }
}

#[test]
fn surface_and_particles_together_in_a_half_open_box() {
    let Some(mut harness) = common::harness() else { return };
    let mesh = sample::ball([0.5, 0.5, 0.5], 0.4, 48);
    let ball = UploadedSurface::new(&harness.device, &mesh.vertices, &[], &mesh.triangles).unwrap();
    let places = [[0.5, 0.5, 0.5], [0.9, 0.1, 0.9], [0.1, 0.1, 0.2]];
    let particles = UploadedParticles::new(&harness.device, &places, &[], &[], &[]).unwrap();
    let colouring =
        Colouring::new(Quantity::Speed, [0.0, 1.0]).with_map(ColourMap::Inferno).with_colour_bar(false);
    let domain =
        Domain { closed: [false, true, true, false, true, true], ..Domain::closed([0.0; 3], [1.0; 3]) };
    let good = frame(domain)
        .with_particles(DrawnParticles::new(particles.buffers(), 0.1, colouring))
        .with_surface(DrawnSurface::new(ball.buffers(), Liquid::water()));
    let picture = harness.draw(SIZE, &good);
    picture.expect("both");
    assert!(!harness.draw(SIZE, &moved(good)).difference(&picture).is_small(), "a moved camera");
    assert!(
        !harness.draw(SIZE, &with(good, |f| f.particles = None)).difference(&picture).is_small(),
        "no particles"
    );
}

#[test]
fn liquid_from_particles() {
    let Some(mut harness) = common::harness() else { return };
    let cloud = sample::collapsing_column([2.0, 1.0, 1.0], 0.04);
    let particles = UploadedParticles::new(&harness.device, &cloud.positions, &[], &[], &[]).unwrap();
    let drawn = DrawnLiquidParticles::new(particles.buffers(), 0.02, Liquid::water());
    let empty = frame(Domain::closed([0.0; 3], [2.0, 1.0, 1.0]));
    let good = empty.with_liquid_particles(drawn);
    let picture = harness.draw(WITH_BAR, &good);
    picture.expect("screen-space");

    assert!(!harness.draw(WITH_BAR, &moved(good)).difference(&picture).is_small(), "a moved camera");
    let milk = with(drawn, |d| d.liquid = Liquid::milk());
    let of_milk = harness.draw(WITH_BAR, &empty.with_liquid_particles(milk));
    let difference = of_milk.difference(&picture);
    assert!(!difference.is_small(), "another liquid: {difference:?}");
    // Water is so clear that the shape of its surface hardly shows.
    let apart = with(milk, |d| d.radius = 0.012);
    let difference = harness.draw(WITH_BAR, &empty.with_liquid_particles(apart)).difference(&of_milk);
    assert!(!difference.is_small(), "spheres that do not merge: {difference:?}");
}

#[test]
fn slices_and_lines() {
    let Some(mut harness) = common::harness() else { return };
    let empty = frame(Domain::closed([0.0; 3], [2.0, 1.0, 1.0]));
    let cloud = sample::collapsing_column([2.0, 1.0, 1.0], 0.05);
    let particles =
        UploadedParticles::new(&harness.device, &cloud.positions, &[], &cloud.densities, &cloud.pressures)
            .unwrap();
    let colouring = Colouring::new(Quantity::Pressure, [0.0, 9000.0]).with_map(ColourMap::Viridis);
    let buffers = particles.buffers();
    let slice = DrawnSlice::new(buffers, Axis::Z, 0.5, 0.025, colouring);
    let good = empty.with_slice(slice);
    let picture = harness.draw(WITH_BAR, &good);
    picture.expect("slice");
    for wrong in
        [with(slice, |s| s.position = 0.6), with(slice, |s| s.colouring.quantity = Quantity::Density)]
    {
        let wrong = harness.draw(WITH_BAR, &empty.with_slice(wrong));
        assert!(!wrong.difference(&picture).is_small(), "another place, another quantity");
    }

    let mesh = sample::waves([0.0; 3], [2.0, 1.0, 1.0], 24);
    let waves =
        UploadedSurface::new(&harness.device, &mesh.vertices, &mesh.normals, &mesh.triangles).unwrap();
    let mut draw = |style| {
        let drawn = DrawnSurface::new(waves.buffers(), Liquid::water()).with_style(style);
        harness.draw(SIZE, &empty.with_surface(drawn))
    };
    let picture = draw(SurfaceStyle::LiquidWithLines);
    picture.expect("surface-lines");
    assert!(!draw(SurfaceStyle::Lines).difference(&picture).is_small(), "lines alone");
    assert!(!draw(SurfaceStyle::Liquid).difference(&picture).is_small(), "no lines");
}
