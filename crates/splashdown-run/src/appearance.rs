//! How a scene is drawn: camera, domain, sky, floor, liquid and colours, for the pictures of a run and for the
//! window.

use splashdown::scene::{
    Choice, ColourBy, Derived, FloorKind, PictureQuality, PictureSettings, Scene, SkyKind, TankKind,
};
use splashdown::surface::droplet_radius;
use splashdown_render::{
    Camera, Colouring, Domain, DrawnDroplets, DrawnFoam, DropletBuffers, Floor, FloorPattern, FoamBuffers,
    Frame, Liquid, Quality, Quantity, Sky, Tank, missing_characters,
};

/// The empty picture of the scene: its domain, its sky and its floor.
pub fn empty_frame(scene: &Scene, camera: Camera) -> Frame<'static> {
    let mut frame = Frame::new(camera, domain(scene));
    frame.sky = sky(&scene.picture);
    frame.sun = sun(&scene.picture);
    frame.floor = floor(&scene.picture);
    frame.tank = match scene.picture.tank {
        TankKind::Glass => Tank::Glass,
        TankKind::Edges => Tank::Edges,
        TankKind::None => Tank::Hidden,
    };
    frame
}

/// The scene's camera at a simulated time in s.
pub fn camera(scene: &Scene, time: f64) -> Camera {
    placed_camera(&scene.camera_at(time))
}

/// The camera of the renderer at the place of that of a scene.
pub(crate) fn placed_camera(camera: &splashdown::scene::Camera) -> Camera {
    let target = camera.target.into();
    Camera::orbit(target, camera.distance, camera.azimuth, camera.elevation, camera.field_of_view)
}

/// The scene's domain.
pub fn domain(scene: &Scene) -> Domain {
    let [[x0, x1], [y0, y1], [z0, z1]] = scene.domain.closed;
    Domain { min: scene.domain.min.into(), max: scene.domain.max.into(), closed: [x0, x1, y0, y1, z0, z1] }
}

/// The optical properties of the scene's fluid; those of water for an unknown material.
pub fn liquid(scene: &Scene) -> Liquid {
    let picture = &scene.picture;
    let name = picture.liquid.map_or(scene.fluid.material.name.as_str(), |liquid| liquid.name());
    let mut liquid = Liquid::from_name(name).unwrap_or_else(Liquid::water);
    liquid.absorption = picture.absorption.unwrap_or(liquid.absorption);
    liquid.scattering = picture.scattering.unwrap_or(liquid.scattering);
    // A clear liquid has no colour of its own. Grey shows the scattering if no colour is given.
    let own = if liquid.colour == [0.0; 3] { GREY } else { liquid.colour };
    liquid.colour = picture.liquid_colour.unwrap_or(own);
    liquid
}

/// Reflectance of a liquid that scatters light and has no colour.
const GREY: [f32; 3] = [0.2; 3];

/// Light of a weak sun under a sky that usually has none.
const WEAK_SUN: [f32; 3] = [1.0, 0.92, 0.80];

fn sky(picture: &PictureSettings) -> Sky {
    let sky = match picture.sky {
        SkyKind::Day => Sky::day(),
        SkyKind::Overcast => Sky::overcast(),
        SkyKind::Sunset => Sky::sunset(),
        SkyKind::Studio => Sky::studio(),
    };
    let mut sky = match (picture.zenith_colour, picture.horizon_colour) {
        (None, None) => sky,
        (zenith, horizon) => sky.with_gradient(zenith.unwrap_or(sky.zenith), horizon.unwrap_or(sky.horizon)),
    };
    if !picture.has_sun() {
        (sky.sun_light, sky.glow) = ([0.0; 3], [0.0; 3]);
    } else if sky.sun_light == [0.0; 3] {
        sky.sun_light = WEAK_SUN;
    }
    sky
}

/// The direction to the sun.
fn sun(picture: &PictureSettings) -> [f32; 3] {
    let [x, y, z] = match picture.sky {
        SkyKind::Day | SkyKind::Overcast => Frame::SUN,
        SkyKind::Sunset => direction(8.0, -150.0),
        // The light is in front of the tank, as in a photograph.
        SkyKind::Studio => direction(55.0, -25.0),
    };
    if picture.sun_elevation.is_none() && picture.sun_azimuth.is_none() {
        return [x, y, z];
    }
    let elevation = picture.sun_elevation.unwrap_or_else(|| y.atan2(x.hypot(z)).to_degrees());
    let azimuth = picture.sun_azimuth.unwrap_or_else(|| x.atan2(z).to_degrees());
    direction(elevation, azimuth)
}

/// A unit vector, with the azimuth of a camera: 0 is +z, 90 is +x.
fn direction(elevation: f32, azimuth: f32) -> [f32; 3] {
    let (sin, cos) = elevation.to_radians().sin_cos();
    let (x, z) = azimuth.to_radians().sin_cos();
    [cos * x, sin, cos * z]
}

fn floor(picture: &PictureSettings) -> Option<Floor> {
    let pattern = match picture.floor {
        FloorKind::Tiles => FloorPattern::Tiles,
        FloorKind::Checkerboard => FloorPattern::Checkerboard,
        FloorKind::Plain => FloorPattern::Plain,
        FloorKind::None => return None,
    };
    let colour = picture.floor_colour.unwrap_or(Floor::default().colour);
    Some(Floor { pattern, colour })
}

/// The caption of the scene at a simulated time in s; `None` if it sets none.
pub fn own_caption(scene: &Scene, time: f64) -> Option<String> {
    let caption = scene.picture.caption.as_ref()?;
    Some(caption.replace("{name}", &scene.name).replace("{time}", &format!("{time:.3}")))
}

/// The caption of a picture at a simulated time in s; empty for none.
pub fn caption(scene: &Scene, time: f64) -> String {
    own_caption(scene, time).unwrap_or_else(|| format!("{}   t = {time:.3} s", scene.name))
}

/// What is wrong with the caption of the scene: characters that the font of pictures lacks; `None` if all are drawn.
pub fn caption_problem(scene: &Scene) -> Option<String> {
    let caption = scene.picture.caption.as_deref()?;
    let missing = missing_characters(caption);
    let list: Vec<String> = missing.iter().map(|character| format!("{character:?}")).collect();
    (!list.is_empty()).then(|| {
        format!(
            "picture.caption has characters that the font of pictures lacks and that appear as boxes: {}. The font has Latin, \
             Greek and Cyrillic letters",
            list.join(", ")
        )
    })
}

/// What pictures of the meshes that a run has written lack.
pub(crate) fn mesh_problem(scene: &Scene) -> Option<String> {
    (!scene.surface.caps).then(|| {
        "the meshes of this run have no surfaces at the walls (surface.caps = false): the liquid is drawn without them".into()
    })
}

/// How rays are traced for pictures of this quality; `None` without rays.
pub fn quality(scene: &Scene, quality: PictureQuality) -> Option<Quality> {
    match quality {
        PictureQuality::Interactive => None,
        PictureQuality::Standard => Some(Quality::STANDARD),
        PictureQuality::Final => {
            let mut best = Quality::FINAL;
            // A lens that leaves the domain nearly sharp.
            best.aperture = 0.006 * scene.camera.distance;
            best.shutter = shutter(scene);
            Some(best)
        }
    }
}

/// Time in seconds for which the shutter is open: half a frame of the scene, but no longer than water at the largest
/// expected speed takes for half a particle spacing. Splashes are photographed with short exposures, because drops that
/// move by several diameters look like rods; a droplet has a diameter of 1.24 spacings.
pub fn shutter(scene: &Scene) -> f32 {
    let passing = 0.5 * scene.fluid.particle_spacing / Derived::new(scene).reference_speed;
    passing.min(0.5 / scene.frame_rate)
}

/// Droplets with the volume of a particle each, blurred by their motion.
pub fn droplets<'a>(scene: &Scene, buffers: DropletBuffers<'a>, liquid: Liquid) -> DrawnDroplets<'a> {
    DrawnDroplets::new(buffers, droplet_radius(scene.fluid.particle_spacing), liquid)
        .with_shutter(shutter(scene))
}

/// Foam, spray and bubbles, blurred by their motion.
pub fn foam<'a>(scene: &Scene, buffers: FoamBuffers<'a>) -> DrawnFoam<'a> {
    DrawnFoam::new(buffers, scene.fluid.particle_radius()).with_shutter(shutter(scene))
}

/// Colours by this quantity. The range is the scene's if it sets one for this quantity, else the expected one. It is
/// the same in every frame, so that a film does not flicker.
pub fn colouring(scene: &Scene, colour_by: ColourBy) -> Colouring {
    let derived = Derived::new(scene);
    let density = scene.fluid.material.rest_density;
    let (quantity, expected) = match colour_by {
        ColourBy::Speed => (Quantity::Speed, [0.0, 0.7 * derived.reference_speed]),
        ColourBy::Density => (Quantity::Density, [0.97 * density, 1.03 * density]),
        ColourBy::Pressure => (Quantity::Pressure, [0.0, density * scene.gravity.length() * derived.head]),
    };
    let own = scene.output.colour_range.filter(|_| scene.output.colour_by == colour_by);
    Colouring::new(quantity, own.unwrap_or(expected))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(picture: &str) -> Scene {
        let text = format!(
            "[scene]\nname = \"cube\"\nduration = 1\n[domain]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n\
             [fluid]\nparticle_spacing = 0.1\nmaterial = \"honey\"\n\
             [[fluid.block]]\nposition = [0, 0, 0]\nsize = [0.5, 0.5, 0.5]\n[picture]\n{picture}\n"
        );
        Scene::parse(&text, "cube.toml").unwrap_or_else(|errors| panic!("{errors}"))
    }

    #[test]
    fn the_exposure_is_short_for_fast_drops_and_at_most_half_a_frame() {
        let mut scene = scene("");
        let speed = Derived::new(&scene).reference_speed;
        scene.frame_rate = 30.0;
        let fast = shutter(&scene);
        assert!((fast * speed / scene.fluid.particle_spacing - 0.5).abs() < 1e-4, "{fast} s at {speed} m/s");
        // Control: with a film's half frame, drops of this scene move by more than a spacing.
        assert!(0.5 / scene.frame_rate * speed > scene.fluid.particle_spacing / 2.0);
        // A finer resolution has a shorter exposure, and many frames a second limit it.
        scene.fluid.particle_spacing *= 0.5;
        assert!(shutter(&scene) < 0.6 * fast);
        scene.frame_rate = 5000.0;
        assert_eq!(shutter(&scene), 1e-4);
    }

    #[test]
    fn a_scene_without_settings_looks_as_an_empty_frame() {
        let scene = scene("");
        let camera = camera(&scene, 0.0);
        let frame = empty_frame(&scene, camera);
        let plain = Frame::new(camera, domain(&scene));
        assert_eq!((frame.sky, frame.sun, frame.floor), (plain.sky, plain.sun, plain.floor));
        assert_eq!((frame.tank, frame.caption), (plain.tank, plain.caption));
        assert_eq!(liquid(&scene).absorption, Liquid::honey().absorption);
        assert_eq!(caption(&scene, 0.5), "cube   t = 0.500 s");
        assert_eq!(own_caption(&scene, 0.5), None);
    }

    #[test]
    fn the_sun_has_the_azimuth_of_a_camera() {
        let at = |keys: &str| sun(&scene(keys).picture);
        let [x, y, z] = at("sun_elevation = 30\nsun_azimuth = 90");
        assert!(
            (x - 0.75_f32.sqrt()).abs() < 1e-6 && (y - 0.5).abs() < 1e-6 && z.abs() < 1e-6,
            "{x} {y} {z}"
        );
        // The other angle is that of the default sun.
        let [dx, _, dz] = Frame::SUN;
        let [x, _, z] = at("sun_elevation = 30");
        assert!((x * dz - z * dx).abs() < 1e-6 && x * dx > 0.0, "{x} {z}");
    }

    #[test]
    fn single_values_override_those_of_the_liquid() {
        let sea = liquid(&scene("liquid = \"sea\"\nabsorption = [3, 2, 1]"));
        assert_eq!((sea.absorption, sea.scattering), ([3.0, 2.0, 1.0], Liquid::sea().scattering));
        let turbid = liquid(&scene("scattering = 5"));
        assert!(turbid.scattering == 5.0 && turbid.colour == GREY);
        for (kind, name, _) in splashdown::scene::LiquidKind::ALL {
            assert!(Liquid::from_name(name).is_some(), "{kind}");
        }
    }

    #[test]
    fn a_sky_without_a_sun_gets_a_weak_one() {
        let light = |keys: &str| sky(&scene(keys).picture).sun_light;
        assert_eq!(light("sky = \"overcast\""), [0.0; 3]);
        assert_eq!(light("sky = \"overcast\"\nsun = true"), WEAK_SUN);
        assert_eq!(light("sun = false"), [0.0; 3]);
    }

    #[test]
    fn captions_contain_name_and_time() {
        assert_eq!(caption(&scene("caption = \"{name} at {time} s\""), 0.25), "cube at 0.250 s");
        assert_eq!(caption(&scene("caption = \"\""), 0.25), "");
    }

    #[test]
    fn characters_that_captions_cannot_show_are_named_once() {
        assert_eq!(caption_problem(&scene("")), None);
        assert_eq!(caption_problem(&scene("caption = \"Überlauf α ≤ 3 m³/s – {time}\"")), None);
        let problem = caption_problem(&scene("caption = \"水 and 水 ☂\"")).unwrap();
        assert!(problem.contains("'水', '☂'."), "{problem}");
    }
}
