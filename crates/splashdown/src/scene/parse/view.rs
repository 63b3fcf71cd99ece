//! The sections `[surface]`, `[foam]` and `[output]`.

use super::Part;
use crate::scene::reader::Section;
use crate::scene::spec::rounded;
use crate::scene::types::{Fluid, FoamSettings, Format, Output, PictureKind, SurfaceSettings};

pub(super) fn read_surface(section: &Section<'_>, fluid: Option<&Fluid>) -> Part<SurfaceSettings> {
    let enabled = section.boolean("enabled");
    let kernels = section.choice("kernels");
    let cell_size = section.number("cell_size");
    let iso_level = section.number("iso_level");
    let smoothing_iterations = section.integer("smoothing_iterations");
    let min_blob = section.integer("min_blob");
    let min_neighbours = section.integer("min_neighbours");
    let support_ratio = section.number("support_ratio");
    let caps = section.boolean("caps");
    let spacing = fluid.map(|fluid| fluid.particle_spacing);
    let standard = SurfaceSettings::for_spacing(spacing.unwrap_or(1.0));
    let surface = SurfaceSettings {
        enabled: enabled?.unwrap_or(standard.enabled),
        kernels: kernels?.unwrap_or(standard.kernels),
        cell_size: cell_size?.unwrap_or(standard.cell_size),
        iso_level: iso_level?.unwrap_or(standard.iso_level),
        smoothing_iterations: smoothing_iterations?.unwrap_or(standard.smoothing_iterations),
        min_blob: min_blob?.unwrap_or(standard.min_blob),
        min_neighbours: min_neighbours?.unwrap_or(standard.min_neighbours),
        support_ratio: support_ratio?.unwrap_or(standard.support_ratio),
        caps: caps?.unwrap_or(standard.caps),
    };
    let Some(spacing) = spacing else { return Ok(surface) };
    // Finer cells only resolve the shape of single particles; coarser cells miss gaps between them.
    let (least, most) = (0.1 * spacing, 2.0 * spacing);
    if !(least * 0.999..=most * 1.001).contains(&surface.cell_size) {
        let message = format!(
            "surface.cell_size = {} m does not suit a particle spacing of {spacing} m",
            surface.cell_size
        );
        let hint = format!("half the spacing is a good choice: {}", rounded(spacing * 0.5));
        return Err(section.complain(
            "cell_size",
            message,
            &format!("{} to {} m", rounded(least), rounded(most)),
            &hint,
        ));
    }
    if surface.enabled && surface.cell_size > 1.001 * spacing {
        let message = format!(
            "surface.cell_size = {} m is coarser than the particles, {spacing} m apart: thin sheets and corners are lost, and \
             the surface encloses less than the fluid's volume",
            surface.cell_size
        );
        section.warn(
            "cell_size",
            message,
            &format!("half the spacing is a good choice: {}", rounded(spacing * 0.5)),
        );
    }
    Ok(surface)
}

pub(super) fn read_foam(section: &Section<'_>) -> Part<FoamSettings> {
    let enabled = section.boolean("enabled");
    let trapped_air = section.number("trapped_air");
    let wave_crest = section.number("wave_crest");
    let trapped_air_limits = section.numbers("trapped_air_limits");
    let wave_crest_limits = section.numbers("wave_crest_limits");
    let speed_limits = section.numbers("speed_limits");
    let lifetime = section.numbers("lifetime");
    let buoyancy = section.number("buoyancy");
    let drag = section.number("drag");
    let max_particles = section.integer("max_particles");
    let standard = FoamSettings::default();
    let foam = FoamSettings {
        enabled: enabled?.unwrap_or(standard.enabled),
        trapped_air: trapped_air?.unwrap_or(standard.trapped_air),
        wave_crest: wave_crest?.unwrap_or(standard.wave_crest),
        trapped_air_limits: trapped_air_limits?.unwrap_or(standard.trapped_air_limits),
        wave_crest_limits: wave_crest_limits?.unwrap_or(standard.wave_crest_limits),
        speed_limits: speed_limits?.unwrap_or(standard.speed_limits),
        lifetime: lifetime?.unwrap_or(standard.lifetime),
        buoyancy: buoyancy?.unwrap_or(standard.buoyancy),
        drag: drag?.unwrap_or(standard.drag),
        max_particles: max_particles?,
    };
    let rising = [
        ("trapped_air_limits", foam.trapped_air_limits),
        ("wave_crest_limits", foam.wave_crest_limits),
        ("speed_limits", foam.speed_limits),
    ];
    let mut result = Ok(foam);
    for (name, [least, most]) in rising {
        if most <= least {
            let message =
                format!("the second value of foam.{name} is not above the first: {most} <= {least}");
            result = Err(section.complain(
                name,
                message,
                &format!("above {least}"),
                "no particles are created below the first value, and all above the second",
            ));
        }
    }
    let [shortest, longest] = foam.lifetime;
    if longest < shortest {
        let message =
            format!("the maximum of foam.lifetime is below the minimum: {longest} s < {shortest} s");
        result = Err(section.complain(
            "lifetime",
            message,
            &format!("{shortest} s or more"),
            "give the minimum first",
        ));
    }
    result
}

pub(super) fn read_output(section: &Section<'_>, surface: Option<&SurfaceSettings>) -> Part<Output> {
    let standard = Output::default();
    let formats = section.choices("formats");
    let pictures = section.choices("pictures");
    let picture_size = section.integers("picture_size");
    let quality = section.choice("quality");
    let colour_by = section.choice("colour_by");
    let film = section.boolean("film");
    let colour_range = section.numbers::<2>("colour_range");
    let with_surface = surface.is_none_or(|surface| surface.enabled);
    let pictures = pictures?.unwrap_or_else(|| {
        standard
            .pictures
            .iter()
            .copied()
            .filter(|kind| with_surface || *kind == PictureKind::Particles)
            .collect()
    });
    let film_wanted = film?;
    let output = Output {
        formats: formats?.unwrap_or(standard.formats),
        film: film_wanted.unwrap_or(standard.film && !pictures.is_empty()),
        pictures,
        picture_size: picture_size?.unwrap_or(standard.picture_size),
        quality: quality?.unwrap_or(standard.quality),
        colour_by: colour_by?.unwrap_or(standard.colour_by),
        colour_range: colour_range?,
    };
    let mut result = Ok(());
    if !with_surface && output.pictures.contains(&PictureKind::Surface) {
        let message = "output.pictures includes the surface, but surface.enabled is false".to_owned();
        result = Err(section.complain(
            "pictures",
            message,
            "\"particles\"",
            "enable the surface, or leave that picture out",
        ));
    }
    let surface_only = |format: &&Format| format.has_surface() && !format.has_particles();
    if !with_surface && let Some(format) = output.formats.iter().find(surface_only) {
        let message = format!(
            "output.formats includes \"{format}\", which stores the surface, but surface.enabled is false"
        );
        result = Err(section.complain(
            "formats",
            message,
            "\"ply\", \"vtu\"",
            "enable the surface, or leave that format out",
        ));
    }
    if film_wanted == Some(true) && output.pictures.is_empty() {
        let message = "output.film needs pictures, but output.pictures is empty".to_owned();
        result =
            Err(section.complain("film", message, "false", "add \"particles\" or \"surface\" to pictures"));
    }
    if !Output::can_have_size(output.picture_size) {
        let [width, height] = output.picture_size;
        let message = format!("a picture of {width} x {height} pixels is too large");
        let allowed = "at most 268 million pixels, such as [16384, 16384]";
        result = Err(section.complain("picture_size", message, allowed, "reduce a side"));
    } else if output.film && output.picture_size.iter().any(|&side| side > Output::MAX_FILM_SIDE) {
        let [width, height] = output.picture_size;
        let message = format!("a film cannot have pictures of {width} x {height} pixels");
        result = Err(section.complain("picture_size", message, "8192 pixels a side", "or set film = false"));
    }
    if output.film && output.picture_size.iter().any(|side| side % 2 == 1) {
        let message = "a film needs an even picture_size".to_owned();
        result = Err(section.complain("picture_size", message, "even numbers", "or set film = false"));
    }
    if output.colour_range.is_some_and(|[low, high]| low >= high) {
        let message = "output.colour_range must be increasing".to_owned();
        result = Err(section.complain("colour_range", message, "[low, high] with low < high", ""));
    }
    result.map(|()| output)
}
