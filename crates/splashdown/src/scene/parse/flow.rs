//! The sections `[[emitter]]` and `[[sink]]`.

use glam::Vec3;

use super::things::{self, read_unique};
use super::{Part, given, needed};
use crate::scene::choice::Choice;
use crate::scene::keys::{OutletWord, SinkWord};
use crate::scene::outlet;
use crate::scene::reader::{Reported, Section};
use crate::scene::things::{Emitter, Outlet, Sink, SinkRegion};
use crate::scene::types::Domain;

/// Reads all `[[emitter]]` sections.
pub(super) fn read_emitters(sections: &[Section<'_>], domain: Option<&Domain>) -> Vec<Part<Emitter>> {
    read_unique(sections, "emitters", |section| read_emitter(section, domain), |emitter| &emitter.name)
}

fn read_emitter(section: &Section<'_>, domain: Option<&Domain>) -> Part<Emitter> {
    let name = section.name("name");
    let outlet = read_outlet(section);
    let position = section.numbers("position");
    let direction = read_direction(section, "direction");
    let speed = section.number("speed");
    let start = section.number("start");
    let end = section.number("end");
    let max_particles = section.integer("max_particles");
    let emitter = Emitter {
        name: needed(name)?,
        outlet: outlet?,
        position: needed(position)?.into(),
        direction: direction?,
        speed: needed(speed)?,
        start: start?.unwrap_or(0.0),
        end: end?,
        max_particles: max_particles?,
    };
    if let Some(end) = emitter.end.filter(|end| *end <= emitter.start) {
        let message =
            format!("emitter {:?} ends at {end} s, but starts at {} s", emitter.name, emitter.start);
        return Err(section.complain("end", message, &format!("more than {} s", emitter.start), ""));
    }
    if let Some(domain) = domain {
        let position = emitter.position;
        if position.cmplt(domain.min).any() || position.cmpgt(domain.max).any() {
            let message = format!("emitter {:?} is at {position} m, outside the domain", emitter.name);
            let allowed = format!("{} to {} m", domain.min, domain.max);
            let hint = "move the outlet, or enlarge the domain";
            return Err(section.complain("position", message, &allowed, hint));
        }
        let reach = reach(&emitter);
        // The tolerance allows for rounding of an outlet that fills a whole side.
        let slack = 1e-3 * reach.max_element();
        if (position - reach).cmplt(domain.min - slack).any()
            || (position + reach).cmpgt(domain.max + slack).any()
        {
            return Err(outlet_outside(section, &emitter, domain));
        }
    }
    Ok(emitter)
}

/// Half the extent of an outlet along each axis in m; zero for a mesh, which has not been read yet.
fn reach(emitter: &Emitter) -> Vec3 {
    let (across, up) = outlet::axes(emitter.direction);
    match emitter.outlet {
        Outlet::Disc { radius } => {
            let d = emitter.direction;
            radius * (Vec3::ONE - d * d).max(Vec3::ZERO).map(f32::sqrt)
        }
        Outlet::Rectangle { size } => 0.5 * (size[0] * across.abs() + size[1] * up.abs()),
        Outlet::Mesh(_) => Vec3::ZERO,
    }
}

/// Reports an outlet that is partly outside the domain.
pub(crate) fn outlet_outside(section: &Section<'_>, emitter: &Emitter, domain: &Domain) -> Reported {
    let message = format!("the outlet of emitter {:?} reaches out of the domain", emitter.name);
    let allowed = format!("all of it from {} to {} m", domain.min, domain.max);
    section.complain("position", message, &allowed, "move or shrink the outlet, or enlarge the domain")
}

fn read_outlet(section: &Section<'_>) -> Part<Outlet> {
    let shape = section.choice::<OutletWord>("shape");
    let radius = section.number("radius");
    let size = section.numbers("size");
    let word = shape?.unwrap_or(OutletWord::Disc);
    let fitting: &[&str] = match word {
        OutletWord::Disc => &["radius"],
        OutletWord::Rectangle => &["size"],
        OutletWord::Mesh => &["mesh", "scale", "up", "rotation"],
    };
    refuse_others(section, word.name(), fitting, &["radius", "size", "mesh", "scale", "up", "rotation"])?;
    match word {
        OutletWord::Disc => Ok(Outlet::Disc { radius: given(section, "radius", radius?, "disc")? }),
        OutletWord::Rectangle => Ok(Outlet::Rectangle { size: given(section, "size", size?, "rectangle")? }),
        OutletWord::Mesh => things::read_mesh(section).map(Outlet::Mesh),
    }
}

/// Reads all `[[sink]]` sections.
pub(super) fn read_sinks(sections: &[Section<'_>]) -> Vec<Part<Sink>> {
    read_unique(sections, "sinks", read_sink, |sink| &sink.name)
}

fn read_sink(section: &Section<'_>) -> Part<Sink> {
    let name = section.name("name");
    let shape = section.choice::<SinkWord>("shape");
    let (min, max) = (section.numbers::<3>("min"), section.numbers::<3>("max"));
    let point = section.numbers::<3>("point");
    let word = shape?.unwrap_or(SinkWord::Box);
    let fitting: &[&str] = match word {
        SinkWord::Box => &["min", "max"],
        SinkWord::Below => &["point", "normal"],
        SinkWord::Mesh => &["mesh", "scale", "up", "position", "rotation"],
    };
    let all = ["min", "max", "point", "normal", "mesh", "scale", "up", "position", "rotation"];
    refuse_others(section, word.name(), fitting, &all)?;
    let region = match word {
        SinkWord::Box => {
            let min = Vec3::from(given(section, "min", min?, "box")?);
            let max = Vec3::from(given(section, "max", max?, "box")?);
            if max.cmple(min).any() {
                let message = format!("{} is not above min along every axis", section.key_path("max"));
                return Err(section.complain("max", message, "more than min", "max is a corner, not a size"));
            }
            SinkRegion::Box { min, max }
        }
        SinkWord::Below => SinkRegion::Below {
            point: given(section, "point", point?, "plane")?.into(),
            normal: read_direction(section, "normal")?,
        },
        SinkWord::Mesh => SinkRegion::Mesh(things::read_mesh(section)?),
    };
    Ok(Sink { name: needed(name)?, region })
}

/// Reports a key that belongs to another shape.
fn refuse_others(section: &Section<'_>, word: &str, fitting: &[&str], all: &[&str]) -> Part<()> {
    let Some(name) = all.iter().find(|name| section.has(name) && !fitting.contains(name)) else {
        return Ok(());
    };
    let message = format!("{} does not belong to shape = {word:?}", section.key_path(name));
    Err(section.complain(name, message, &fitting.join(", "), "remove it, or set the shape that uses it"))
}

/// Reads a non-zero vector and normalises it.
fn read_direction(section: &Section<'_>, name: &str) -> Part<Vec3> {
    let vector = Vec3::from(given(section, name, section.numbers::<3>(name)?, "direction")?);
    vector.try_normalize().ok_or_else(|| {
        let message = format!("{} is the zero vector", section.key_path(name));
        section.complain(name, message, "any vector except zero", "")
    })
}
