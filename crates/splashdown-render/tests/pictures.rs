//! Small pictures against committed ones, each with a wrong picture that must be told from it.

mod common;

use common::sample;
use splashdown_render::*;

/// Small enough to commit.
const SIZE: [u32; 2] = [160, 120];
/// Large enough for the colour bar.
const WITH_BAR: [u32; 2] = [240, 160];

const ASPECT_RATIO: f32 = 1.4;

fn frame(domain: Domain) -> Frame<'static> {
    let camera = Camera::framing(&domain, 28.0, 18.0, 35.0, ASPECT_RATIO);
    Frame::new(camera, domain)
}

fn moved(frame: Frame<'_>) -> Frame<'_> {
    Frame { camera: Camera::framing(&frame.domain, 30.0, 18.0, 35.0, ASPECT_RATIO), ..frame }
}

#[test]
fn particles() {
    let Some(mut studio) = common::studio() else { return };
    let cloud = sample::slump([2.0, 1.0, 1.0], 0.05);
    let particles = UploadedParticles::new(
        &studio.device,
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
        let colouring = Colouring { quantity, range, map, colour_bar: size == WITH_BAR };
        let drawn = DrawnParticles { buffers: particles.buffers(), radius: 0.025, colouring };
        let good = Frame {
            particles: Some(drawn),
            caption: Some("t = 0.42 s"),
            ..frame(Domain::closed([0.0; 3], [2.0, 1.0, 1.0]))
        };
        let picture = studio.draw(size, &good);
        picture.expect(name);

        assert!(!studio.draw(size, &moved(good)).difference(&picture).is_small(), "a moved camera");
        let other_map = Colouring { map: ColourMap::BlueRed, ..colouring };
        let wrong = Frame { particles: Some(DrawnParticles { colouring: other_map, ..drawn }), ..good };
        assert!(!studio.draw(size, &wrong).difference(&picture).is_small(), "another colour map");
        let wrong = Frame { particles: Some(DrawnParticles { radius: 0.015, ..drawn }), ..good };
        assert!(!studio.draw(size, &wrong).difference(&picture).is_small(), "smaller particles");
    }
}

#[test]
fn surfaces() {
    let Some(mut studio) = common::studio() else { return };
    let mesh = sample::waves([0.0; 3], [2.0, 1.0, 1.0], 96);
    let waves = UploadedSurface::new(&studio.device, &mesh.vertices, &mesh.normals, &mesh.triangles).unwrap();
    for name in ["water", "honey"] {
        let liquid = Liquid::from_name(name, 1.0).unwrap();
        let drawn = DrawnSurface { buffers: waves.buffers(), liquid, style: SurfaceStyle::Liquid };
        let good = Frame { surface: Some(drawn), ..frame(Domain::closed([0.0; 3], [2.0, 1.0, 1.0])) };
        let picture = studio.draw(SIZE, &good);
        picture.expect(&format!("surface-{name}"));

        assert!(!studio.draw(SIZE, &moved(good)).difference(&picture).is_small(), "a moved camera");
        let wrong = Frame { surface: Some(DrawnSurface { liquid: Liquid::oil(1.0), ..drawn }), ..good };
        assert!(!studio.draw(SIZE, &wrong).difference(&picture).is_small(), "another liquid");
        let flat: Vec<[f32; 3]> = vec![[0.0, 1.0, 0.0]; mesh.vertices.len()];
        let flat = UploadedSurface::new(&studio.device, &mesh.vertices, &flat, &mesh.triangles).unwrap();
        let wrong = Frame {
            surface: Some(DrawnSurface { buffers: flat.buffers(), liquid, style: SurfaceStyle::Liquid }),
            ..good
        };
        assert!(!studio.draw(SIZE, &wrong).difference(&picture).is_small(), "wrong normals");
    }
}

#[test]
fn surface_and_particles_together_in_a_half_open_box() {
    let Some(mut studio) = common::studio() else { return };
    let mesh = sample::ball([0.5, 0.5, 0.5], 0.4, 48);
    let ball = UploadedSurface::new(&studio.device, &mesh.vertices, &[], &mesh.triangles).unwrap();
    let places = [[0.5, 0.5, 0.5], [0.9, 0.1, 0.9], [0.1, 0.1, 0.2]];
    let particles = UploadedParticles::new(&studio.device, &places, &[], &[], &[]).unwrap();
    let colouring = Colouring {
        quantity: Quantity::Speed,
        range: [0.0, 1.0],
        map: ColourMap::Inferno,
        colour_bar: false,
    };
    let domain =
        Domain { closed: [false, true, true, false, true, true], ..Domain::closed([0.0; 3], [1.0; 3]) };
    let good = Frame {
        particles: Some(DrawnParticles { buffers: particles.buffers(), radius: 0.1, colouring }),
        surface: Some(DrawnSurface {
            buffers: ball.buffers(),
            liquid: Liquid::water(1.0),
            style: SurfaceStyle::Liquid,
        }),
        ..frame(domain)
    };
    let picture = studio.draw(SIZE, &good);
    picture.expect("both");
    assert!(!studio.draw(SIZE, &moved(good)).difference(&picture).is_small(), "a moved camera");
    assert!(
        !studio.draw(SIZE, &Frame { particles: None, ..good }).difference(&picture).is_small(),
        "no particles"
    );
}

#[test]
fn liquid_from_particles() {
    let Some(mut studio) = common::studio() else { return };
    let cloud = sample::slump([2.0, 1.0, 1.0], 0.04);
    let particles = UploadedParticles::new(&studio.device, &cloud.positions, &[], &[], &[]).unwrap();
    let drawn =
        DrawnLiquidParticles { buffers: particles.buffers(), radius: 0.02, liquid: Liquid::water(1.0) };
    let empty = frame(Domain::closed([0.0; 3], [2.0, 1.0, 1.0]));
    let good = Frame { liquid_particles: Some(drawn), ..empty };
    let picture = studio.draw(WITH_BAR, &good);
    picture.expect("screen-space");

    assert!(!studio.draw(WITH_BAR, &moved(good)).difference(&picture).is_small(), "a moved camera");
    for wrong in [
        DrawnLiquidParticles { liquid: Liquid::oil(1.0), ..drawn },
        DrawnLiquidParticles { radius: 0.012, ..drawn },
    ] {
        let wrong = studio.draw(WITH_BAR, &Frame { liquid_particles: Some(wrong), ..empty });
        assert!(!wrong.difference(&picture).is_small(), "another liquid, or spheres that do not merge");
    }
}

#[test]
fn slices_and_lines() {
    let Some(mut studio) = common::studio() else { return };
    let empty = frame(Domain::closed([0.0; 3], [2.0, 1.0, 1.0]));
    let cloud = sample::slump([2.0, 1.0, 1.0], 0.05);
    let particles =
        UploadedParticles::new(&studio.device, &cloud.positions, &[], &cloud.densities, &cloud.pressures)
            .unwrap();
    let colouring = Colouring {
        quantity: Quantity::Pressure,
        range: [0.0, 9000.0],
        map: ColourMap::Viridis,
        colour_bar: true,
    };
    let buffers = particles.buffers();
    let slice =
        DrawnSlice { buffers, axis: Axis::Z, position: 0.5, support_radius: 0.1, radius: 0.025, colouring };
    let good = Frame { slice: Some(slice), ..empty };
    let picture = studio.draw(WITH_BAR, &good);
    picture.expect("slice");
    for wrong in [
        DrawnSlice { position: 0.6, ..slice },
        DrawnSlice { colouring: Colouring { quantity: Quantity::Density, ..colouring }, ..slice },
    ] {
        let wrong = studio.draw(WITH_BAR, &Frame { slice: Some(wrong), ..empty });
        assert!(!wrong.difference(&picture).is_small(), "another place, another quantity");
    }

    let mesh = sample::waves([0.0; 3], [2.0, 1.0, 1.0], 24);
    let waves = UploadedSurface::new(&studio.device, &mesh.vertices, &mesh.normals, &mesh.triangles).unwrap();
    let mut draw = |style| {
        let drawn = DrawnSurface { buffers: waves.buffers(), liquid: Liquid::water(1.0), style };
        studio.draw(SIZE, &Frame { surface: Some(drawn), ..empty })
    };
    let picture = draw(SurfaceStyle::LiquidWithLines);
    picture.expect("surface-lines");
    assert!(!draw(SurfaceStyle::Lines).difference(&picture).is_small(), "lines alone");
    assert!(!draw(SurfaceStyle::Liquid).difference(&picture).is_small(), "no lines");
}
