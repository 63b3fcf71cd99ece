//! The section `[picture]`.

use super::Part;
use crate::scene::picture::{FloorKind, LiquidKind, PictureSettings};
use crate::scene::reader::Section;

pub(super) fn read_picture(section: &Section<'_>) -> Part<PictureSettings> {
    let sky = section.choice("sky");
    let zenith_colour = section.numbers("zenith_colour");
    let horizon_colour = section.numbers("horizon_colour");
    let sun = section.boolean("sun");
    let sun_elevation = section.number("sun_elevation");
    let sun_azimuth = section.number("sun_azimuth");
    let floor = section.choice("floor");
    let floor_colour = section.numbers("floor_colour");
    let tank = section.choice("tank");
    let liquid = section.choice("liquid");
    let absorption = section.numbers("absorption");
    let scattering = section.number("scattering");
    let liquid_colour = section.numbers("liquid_colour");
    let caption = section.line("caption");
    let standard = PictureSettings::default();
    let picture = PictureSettings {
        sky: sky?.unwrap_or(standard.sky),
        zenith_colour: zenith_colour?,
        horizon_colour: horizon_colour?,
        sun: sun?,
        sun_elevation: sun_elevation?,
        sun_azimuth: sun_azimuth?,
        floor: floor?.unwrap_or(standard.floor),
        floor_colour: floor_colour?,
        tank: tank?.unwrap_or(standard.tank),
        liquid: liquid?,
        absorption: absorption?,
        scattering: scattering?,
        liquid_colour: liquid_colour?,
        caption: caption?,
    };
    warn_of_keys_without_effect(section, &picture);
    Ok(picture)
}

fn warn_of_keys_without_effect(section: &Section<'_>, picture: &PictureSettings) {
    let ignored = |name: &str, reason: &str, hint: &str| {
        if section.has(name) {
            section.warn(name, format!("picture.{name} has no effect {reason}"), hint);
        }
    };
    if !picture.has_sun() {
        for name in ["sun_elevation", "sun_azimuth"] {
            ignored(name, "without a sun", "set sun = true, or remove the key");
        }
    }
    if picture.floor == FloorKind::None {
        ignored("floor_colour", "without a floor", "choose another floor, or remove the key");
    }
    let scatters = match picture.scattering {
        Some(scattering) => scattering > 0.0,
        None => picture.liquid.is_some_and(LiquidKind::is_turbid),
    };
    if !scatters {
        ignored(
            "liquid_colour",
            "in a clear liquid",
            "set scattering above 0, or use absorption for its colour",
        );
    }
}
