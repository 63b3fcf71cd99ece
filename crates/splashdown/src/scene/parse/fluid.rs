//! The sections `[fluid]`, `[[fluid.block]]`, `[[fluid.mesh]]` and `[[fluid.file]]`.

use glam::Vec3;

use super::things::{read_mesh, read_rotation};
use super::{Part, needed};
use crate::scene::keys::ShapeWord;
use crate::scene::reader::Section;
use crate::scene::types::{Block, FluidFile, FluidMesh, Material, Shape};

pub(super) fn read_material(section: &Section<'_>) -> Part<Material> {
    let name = section.word("material");
    let density = section.number("density");
    let viscosity = section.number("viscosity");
    let surface_tension = section.number("surface_tension");
    let known = name?.and_then(|name| Material::named(&name)).unwrap_or_else(Material::water);
    Ok(Material {
        name: known.name,
        rest_density: density?.unwrap_or(known.rest_density),
        viscosity: viscosity?.unwrap_or(known.viscosity),
        surface_tension: surface_tension?.unwrap_or(known.surface_tension),
    })
}

pub(super) fn read_block(section: &Section<'_>) -> Part<Block> {
    let shape = section.choice::<ShapeWord>("shape");
    let velocity = section.numbers("velocity");
    let position = section.numbers::<3>("position");
    let size = section.numbers::<3>("size");
    let center = section.numbers::<3>("center");
    let radius = section.number("radius");
    let word = shape?.unwrap_or(ShapeWord::Box);
    let (needs, refuses) = match word {
        ShapeWord::Box => (["position", "size"], ["center", "radius"]),
        ShapeWord::Sphere => (["center", "radius"], ["position", "size"]),
    };
    let mut fits = Ok(());
    for name in needs.into_iter().filter(|name| !section.has(name)) {
        let message =
            format!("{} is missing: a {word} needs {} and {}", section.key_path(name), needs[0], needs[1]);
        fits = Err(section.complain(name, message, "", ""));
    }
    for name in refuses.into_iter().filter(|name| section.has(name)) {
        let message = format!("{} does not belong to a {word}", section.key_path(name));
        let hint = format!("a {word} needs {} and {}", needs[0], needs[1]);
        fits = Err(section.complain(name, message, "", &hint));
    }
    fits?;
    let shape = match word {
        ShapeWord::Box => Shape::Box { min: needed(position)?.into(), size: needed(size)?.into() },
        ShapeWord::Sphere => Shape::Sphere { center: needed(center)?.into(), radius: needed(radius)? },
    };
    Ok(Block { shape, velocity: velocity?.map_or(Vec3::ZERO, Vec3::from) })
}

pub(super) fn read_fluid_mesh(section: &Section<'_>) -> Part<FluidMesh> {
    let mesh = read_mesh(section);
    let velocity = section.numbers("velocity");
    let shell = section.boolean("shell");
    if shell.as_ref().is_ok_and(|shell| *shell == Some(true)) {
        let message =
            format!("{} = true: a shell encloses no volume that could be filled", section.key_path("shell"));
        return Err(section.complain(
            "shell",
            message,
            "false",
            "leave it out, or make the shell a [[body]]",
        ));
    }
    Ok(FluidMesh { mesh: mesh?, velocity: velocity?.map_or(Vec3::ZERO, Vec3::from), shell: shell? })
}

pub(super) fn read_fluid_file(section: &Section<'_>) -> Part<FluidFile> {
    let path = section.text("file").and_then(|file| section.file("file", &needed(Ok(file))?));
    let scale = section.scale("scale");
    let position = section.numbers("position");
    let rotation = read_rotation(section);
    let velocity = section.numbers("velocity");
    Ok(FluidFile {
        path: path?,
        scale: scale?.unwrap_or(1.0),
        rotation: rotation?,
        position: position?.map_or(Vec3::ZERO, Vec3::from),
        velocity: velocity?.map_or(Vec3::ZERO, Vec3::from),
    })
}
