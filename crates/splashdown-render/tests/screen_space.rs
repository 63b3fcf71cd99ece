//! The liquid drawn straight from its particles, where pixels can be worked out by hand.

mod common;

use common::{Picture, Studio, sample};
use splashdown_render::*;

const SIZE: [u32; 2] = [200, 160];
const RADIUS: f32 = 0.04;
const DISTANCE: f32 = 4.0;

fn frame() -> Frame<'static> {
    let camera = Camera::orbit([0.0; 3], DISTANCE, 0.0, 0.0, 40.0);
    Frame::new(camera, Domain::closed([-50.0; 3], [50.0; 3]))
}

/// Nearly opaque and green, so that what lies behind does not show and it can be told from everything else.
fn ink() -> Liquid {
    Liquid { absorption: [400.0; 3], scattering: 400.0, colour: [0.0, 0.4, 0.0], ..Liquid::water(1.0) }
}

/// A lattice around a point, `counts` particles along each axis.
fn block(centre: [f32; 3], counts: [usize; 3], spacing: f32) -> Vec<[f32; 3]> {
    let mut places = Vec::new();
    for k in 0..counts[2] {
        for j in 0..counts[1] {
            for i in 0..counts[0] {
                let index = [i, j, k];
                places.push(std::array::from_fn(|axis| {
                    centre[axis] + spacing * (index[axis] as f32 - 0.5 * (counts[axis] - 1) as f32)
                }));
            }
        }
    }
    places
}

fn liquid(studio: &mut Studio, places: &[[f32; 3]], liquid: Liquid, frame: Frame<'_>) -> Picture {
    let particles = UploadedParticles::new(&studio.device, places, &[], &[], &[]).unwrap();
    let drawn = DrawnLiquidParticles { buffers: particles.buffers(), radius: RADIUS, liquid };
    studio.draw(SIZE, &Frame { liquid_particles: Some(drawn), ..frame })
}

fn is_green([r, g, b]: [u8; 3]) -> bool {
    i32::from(g) > i32::from(r) + 20 && i32::from(g) > i32::from(b) + 20
}

/// Pixels that differ.
fn changed(picture: &Picture, empty: &Picture) -> usize {
    let pairs = picture.rgba.chunks_exact(4).zip(empty.rgba.chunks_exact(4));
    pairs.filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 40)).count()
}

#[test]
fn a_block_covers_its_square() {
    let Some(mut studio) = common::studio() else { return };
    let empty = studio.draw(SIZE, &frame());
    let picture = liquid(&mut studio, &block([0.0; 3], [12, 12, 3], 2.0 * RADIUS), ink(), frame());
    // Spheres of 1.7 radii on a lattice reach 1.597 radii on average beyond the outermost centres, and the
    // outline where 0.66 of the surroundings are liquid lies 0.412 deviations of 0.6 * 1.7 radii further in.
    let half_side = (11.0 + 1.597 - 0.412 * 0.6 * 1.7) * RADIUS;
    let front = DISTANCE - 2.0 * RADIUS;
    let pixels = 2.0 * half_side / front / 20f32.to_radians().tan() * 80.0;
    let (covered, expected) = (changed(&picture, &empty) as f32, pixels * pixels);
    assert!((covered - expected).abs() < 0.04 * expected, "{covered} pixels, expected {expected}");
    // Negative control: one particle less on each side.
    let smaller = liquid(&mut studio, &block([0.0; 3], [10, 10, 3], 2.0 * RADIUS), ink(), frame());
    assert!((changed(&smaller, &empty) as f32) < 0.8 * expected);
}

#[test]
fn a_face_of_many_spheres_looks_flat() {
    let Some(mut studio) = common::studio() else { return };
    // The mean over rows and columns in the middle, and the largest step between neighbours.
    let roughness = |picture: &Picture| {
        let middle = || (60..100).flat_map(|y| (80..120).map(move |x| [x, y]));
        let step = |[x, y]: [u32; 2]| picture.pixel([x, y])[1].abs_diff(picture.pixel([x + 1, y])[1]);
        middle().map(step).max().unwrap()
    };
    let face = liquid(&mut studio, &block([0.0; 3], [14, 14, 3], 2.0 * RADIUS), ink(), frame());
    assert!(is_green(face.pixel([100, 80])));
    assert!(roughness(&face) <= 4, "{}", roughness(&face));
    // Negative control: spheres too far apart to merge.
    let apart = liquid(&mut studio, &block([0.0; 3], [7, 7, 3], 4.0 * RADIUS), ink(), frame());
    assert!(roughness(&apart) > 20, "{}", roughness(&apart));
}

#[test]
fn near_liquid_leaves_no_halo_on_far_liquid() {
    let Some(mut studio) = common::studio() else { return };
    let far = block([0.0, 0.0, -1.0], [30, 24, 3], 2.0 * RADIUS);
    let both: Vec<[f32; 3]> =
        far.iter().copied().chain(block([0.0, 0.0, 0.6], [6, 6, 3], 2.0 * RADIUS)).collect();
    let far = liquid(&mut studio, &far, ink(), frame());
    let both = liquid(&mut studio, &both, ink(), frame());
    // The near block's outermost centres are 5 radii from the middle, its spheres reach 1.7 further; two pixels more.
    let outline = 6.7 * RADIUS / (DISTANCE - 0.6 - 2.0 * RADIUS) / 20f32.to_radians().tan() * 80.0;
    let beside = 100 + (outline + 2.0) as u32;
    for x in beside..beside + 12 {
        let (with, without) = (both.pixel([x, 80]), far.pixel([x, 80]));
        let apart = with.iter().zip(without).map(|(a, b)| a.abs_diff(b)).max().unwrap();
        assert!(apart <= 3, "column {x}: {with:?}, without the near block {without:?}");
    }
    // Negative control: on the outline itself there is something to see.
    let on = (beside - 8..beside)
        .any(|x| both.pixel([x, 80]).iter().zip(far.pixel([x, 80])).any(|(a, b)| a.abs_diff(b) > 12));
    assert!(on);
}

#[test]
fn it_hides_and_is_hidden() {
    let Some(mut studio) = common::studio() else { return };
    let colouring = Colouring {
        quantity: Quantity::Speed,
        range: [0.0, 1.0],
        map: ColourMap::BlueRed,
        colour_bar: false,
    };
    let places = block([0.0; 3], [8, 8, 4], 2.0 * RADIUS);
    let mut with_a_sphere_at = |z: f32, look: Liquid| {
        let sphere =
            UploadedParticles::new(&studio.device, &[[0.0, 0.0, z]], &[[9.0, 0.0, 0.0]], &[], &[]).unwrap();
        let drawn = DrawnParticles { buffers: sphere.buffers(), radius: 0.15, colouring };
        let frame = Frame { particles: Some(drawn), ..frame() };
        liquid(&mut studio, &places, look, frame).pixel([100, 80])
    };
    let is_red = |[r, _, b]: [u8; 3]| i32::from(r) - i32::from(b) > 40;
    assert!(is_red(with_a_sphere_at(1.0, ink())));
    assert!(is_green(with_a_sphere_at(-1.0, ink())));
    let clear = Liquid { absorption: [0.0; 3], scattering: 0.0, film: 0.0, ..Liquid::water(1.0) };
    assert!(is_red(with_a_sphere_at(-1.0, clear)), "clear liquid lets it through");
}

#[test]
fn liquid_behind_a_solid_does_not_tint() {
    let Some(mut studio) = common::studio() else { return };
    let ball = sample::ball([0.0; 3], 0.3, 24);
    let body = PlacedBody::new(&ball.vertices, &ball.triangles, [0.8, 0.1, 0.1]).unwrap();
    let bodies = UploadedBodies::new(&studio.device, [(&body, [0.0; 3], [0.0, 0.0, 0.0, 1.0])]);
    let with_bodies = Frame { bodies: Some(bodies.buffers()), ..frame() };
    let alone = studio.draw(SIZE, &with_bodies).pixel([100, 80]);
    let far = |[r, g, b]: [u8; 3]| r.abs_diff(alone[0]).max(g.abs_diff(alone[1])).max(b.abs_diff(alone[2]));
    let behind = block([0.0, 0.0, -1.0], [8, 8, 4], 2.0 * RADIUS);
    assert!(far(liquid(&mut studio, &behind, ink(), with_bodies).pixel([100, 80])) <= 1);
    // Negative control: in front of it.
    let before = block([0.0, 0.0, 1.0], [8, 8, 4], 2.0 * RADIUS);
    assert!(far(liquid(&mut studio, &before, ink(), with_bodies).pixel([100, 80])) > 40);
}

#[test]
fn particles_out_of_play_are_left_out_of_every_way_of_drawing() {
    use wgpu::util::DeviceExt;
    let Some(mut studio) = common::studio() else { return };
    let empty = studio.draw(SIZE, &frame());
    let others = UploadedParticles::new(&studio.device, &[[0.0; 3]; 2], &[], &[], &[]).unwrap();
    let mut covered = |positions: [[f32; 4]; 2]| {
        let positions = studio.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: None,
            contents: bytemuck::cast_slice(&positions),
            usage: wgpu::BufferUsages::STORAGE,
        });
        let buffers = ParticleBuffers { positions: &positions, ..others.buffers() };
        let colouring = Colouring {
            quantity: Quantity::Speed,
            range: [0.0, 1.0],
            map: ColourMap::Inferno,
            colour_bar: false,
        };
        let spheres = DrawnParticles { buffers, radius: 0.2, colouring };
        let merged = DrawnLiquidParticles { buffers, radius: 0.2, liquid: ink() };
        let pictures = [
            Frame { particles: Some(spheres), ..frame() },
            Frame { liquid_particles: Some(merged), ..frame() },
        ];
        pictures.map(|frame| changed(&studio.draw(SIZE, &frame), &empty))
    };
    assert_eq!(covered([[0.0, 0.0, 0.0, 1.0], [f32::NAN, 0.0, 0.0, 0.0]]), [0, 0]);
    let sound = covered([[0.0, 0.0, 0.0, 0.0], [f32::NAN, 0.0, 0.0, 0.0]]);
    assert!(sound.iter().all(|&pixels| pixels > 100), "negative control: one in play is drawn, {sound:?}");
}

#[test]
fn one_sample_and_any_size_will_do() {
    let Some(mut studio) = common::studio() else { return };
    let places = block([0.0; 3], [12, 8, 6], 2.0 * RADIUS);
    let view = Frame { camera: Camera::orbit([0.0; 3], 3.0, 30.0, 25.0, 40.0), ..frame() };
    let four = liquid(&mut studio, &places, Liquid::water(1.0), view);
    let particles = UploadedParticles::new(&studio.device, &places, &[], &[], &[]).unwrap();
    let drawn =
        DrawnLiquidParticles { buffers: particles.buffers(), radius: RADIUS, liquid: Liquid::water(1.0) };
    let view = Frame { liquid_particles: Some(drawn), ..view };
    // Sizes back and forth, odd ones too: the textures follow.
    for size in [[1, 1], [33, 17], SIZE, [2, 90]] {
        studio.draw(size, &view);
    }
    let again = studio.draw(SIZE, &view);
    assert_eq!(again.rgba, four.rgba);
    studio.renderer = Renderer::new(&studio.device, &studio.queue, Offscreen::FORMAT, 1).unwrap();
    let difference = studio.draw(SIZE, &view).difference(&four);
    assert!(difference.mean < 1.5 && difference.share < 0.06, "{difference:?}");
}

#[test]
fn the_same_liquid_twice_is_refused() {
    let Some(studio) = common::studio() else { return };
    let Studio { device, queue, mut renderer } = studio;
    let mesh = sample::ball([0.0; 3], 0.5, 8);
    let ball = UploadedSurface::new(&device, &mesh.vertices, &mesh.normals, &mesh.triangles).unwrap();
    let particles = UploadedParticles::new(&device, &[[0.0; 3]], &[], &[], &[]).unwrap();
    let merged = DrawnLiquidParticles { buffers: particles.buffers(), radius: RADIUS, liquid: ink() };
    let twice = Frame {
        surface: Some(DrawnSurface { buffers: ball.buffers(), liquid: ink(), style: SurfaceStyle::Liquid }),
        liquid_particles: Some(merged),
        ..frame()
    };
    let mut target = Offscreen::new(&device, &queue, SIZE).unwrap();
    let error = target.submit(&mut renderer, &twice).unwrap_err();
    assert!(matches!(error, RenderError::TwoLiquids), "{error}");
    let flat = DrawnLiquidParticles { radius: f32::NAN, ..merged };
    let error = target.submit(&mut renderer, &Frame { liquid_particles: Some(flat), ..frame() }).unwrap_err();
    assert!(error.to_string().contains("radius"), "{error}");
}

#[test]
fn the_surface_does_not_bend_at_the_picture_s_border() {
    let Some(mut studio) = common::studio() else { return };
    // A slab that tilts away from the eye and reaches far beyond the picture.
    let tilted: Vec<[f32; 3]> = block([0.0; 3], [70, 60, 3], 2.0 * RADIUS)
        .into_iter()
        .map(|[x, y, z]| [x, 0.8 * y - 0.6 * z, 0.8 * z - 0.6 * y])
        .collect();
    let wide_size = [280, 224];
    let wide_angle = 2.0 * (1.4 * 20f32.to_radians().tan()).atan().to_degrees();
    let wide = Frame { camera: Camera { field_of_view_deg: wide_angle, ..frame().camera }, ..frame() };
    let particles = UploadedParticles::new(&studio.device, &tilted, &[], &[], &[]).unwrap();
    let drawn = DrawnLiquidParticles { buffers: particles.buffers(), radius: RADIUS, liquid: ink() };
    let wide = studio.draw(wide_size, &Frame { liquid_particles: Some(drawn), ..wide });
    // The outermost columns of the picture against the same pixels of the wide one.
    let largest = |picture: &Picture| {
        let rows = (0..SIZE[1]).flat_map(|y| [[0, y], [1, y], [SIZE[0] - 2, y], [SIZE[0] - 1, y]]);
        let apart = |[x, y]: [u32; 2]| {
            let pairs = picture.pixel([x, y]).into_iter().zip(wide.pixel([x + 40, y + 32]));
            pairs.map(|(a, b)| a.abs_diff(b)).max().unwrap()
        };
        rows.map(apart).max().unwrap()
    };
    let whole = liquid(&mut studio, &tilted, ink(), frame());
    assert!(largest(&whole) <= 3, "{}", largest(&whole));
    // Negative control: a slab that ends at the border.
    let [left, right] = [0, SIZE[0]].map(|x| (x as f32 - 100.0) / 80.0 * 20f32.to_radians().tan());
    let inside = |p: &&[f32; 3]| (left..right).contains(&(p[0] / (DISTANCE - p[2])));
    let cut: Vec<[f32; 3]> = tilted.iter().filter(inside).copied().collect();
    let cut = liquid(&mut studio, &cut, ink(), frame());
    assert!(largest(&cut) > 12, "{}", largest(&cut));
}
