//! The section `[picture]`.

use splashdown::scene::{FloorKind, LiquidKind, PictureSettings, SkyKind, TankKind};

use crate::{CUBE, parse};

fn picture(keys: &str) -> PictureSettings {
    parse(&format!("{CUBE}[picture]\n{keys}")).unwrap_or_else(|errors| panic!("{errors}")).picture
}

#[test]
fn without_the_section_pictures_have_the_default_appearance() {
    let scene = parse(CUBE).unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!(scene.picture, PictureSettings::default());
    assert_eq!(picture(""), PictureSettings::default());
    assert!(scene.picture.has_sun());
}

#[test]
fn every_key_is_read() {
    let read = picture(
        "sky = \"sunset\"\nzenith_colour = [0.1, 0.2, 0.3]\nhorizon_colour = [1, 2, 3]\nsun = true\n\
         sun_elevation = 10\nsun_azimuth = -90\nfloor = \"checkerboard\"\nfloor_colour = [0.4, 0.5, 0.6]\n\
         tank = \"edges\"\nliquid = \"sea\"\nabsorption = [3, 2, 1]\nscattering = 4\n\
         liquid_colour = [0.7, 0.8, 0.9]\ncaption = \"\"\n",
    );
    let mut expected = PictureSettings::default();
    expected.sky = SkyKind::Sunset;
    expected.zenith_colour = Some([0.1, 0.2, 0.3]);
    expected.horizon_colour = Some([1.0, 2.0, 3.0]);
    expected.sun = Some(true);
    expected.sun_elevation = Some(10.0);
    expected.sun_azimuth = Some(-90.0);
    expected.floor = FloorKind::Checkerboard;
    expected.floor_colour = Some([0.4, 0.5, 0.6]);
    expected.tank = TankKind::Edges;
    expected.liquid = Some(LiquidKind::Sea);
    expected.absorption = Some([3.0, 2.0, 1.0]);
    expected.scattering = Some(4.0);
    expected.liquid_colour = Some([0.7, 0.8, 0.9]);
    expected.caption = Some(String::new());
    assert_eq!(read, expected);
}

#[test]
fn an_overcast_sky_has_a_sun_only_if_the_scene_says_so() {
    assert!(!picture("sky = \"overcast\"").has_sun());
    assert!(picture("sky = \"overcast\"\nsun = true").has_sun());
    assert!(!picture("sun = false").has_sun());
}
