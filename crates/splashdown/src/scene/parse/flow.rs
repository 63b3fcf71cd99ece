//! The sections `[[emitter]]` and `[[sink]]`.

use glam::Vec3;

use super::{Part, needed};
use crate::scene::keys::{OutletWord, SinkWord};
use crate::scene::reader::Section;
use crate::scene::things::{Emitter, Outlet, Sink, SinkRegion};
use crate::scene::types::Domain;

/// Everything that `[[emitter]]` says.
pub(super) fn read_emitters(sections: &[Section<'_>], domain: Option<&Domain>) -> Part<Vec<Emitter>> {
    let emitters: Vec<Part<Emitter>> = sections.iter().map(|section| read_emitter(section, domain)).collect();
    emitters.into_iter().collect()
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
            format!("emitter {:?} ends at {end} s, but begins at {} s", emitter.name, emitter.start);
        return Err(section.complain("end", message, &format!("more than {} s", emitter.start), ""));
    }
    if let Some(domain) = domain
        && (emitter.position.cmplt(domain.min).any() || emitter.position.cmpgt(domain.max).any())
    {
        let message = format!("emitter {:?} is at {} m, outside the domain", emitter.name, emitter.position);
        let allowed = format!("{} to {} m", domain.min, domain.max);
        return Err(section.complain(
            "position",
            message,
            &allowed,
            "move the outlet, or enlarge the domain",
        ));
    }
    Ok(emitter)
}

fn read_outlet(section: &Section<'_>) -> Part<Outlet> {
    let shape = section.choice::<OutletWord>("shape");
    let radius = section.number("radius");
    let size = section.numbers("size");
    match shape?.unwrap_or(OutletWord::Disc) {
        OutletWord::Disc => Ok(Outlet::Disc { radius: given(section, "radius", radius?, "disc")? }),
        OutletWord::Rectangle => Ok(Outlet::Rectangle { size: given(section, "size", size?, "rectangle")? }),
    }
}

/// Everything that `[[sink]]` says.
pub(super) fn read_sinks(sections: &[Section<'_>]) -> Part<Vec<Sink>> {
    let sinks: Vec<Part<Sink>> = sections.iter().map(read_sink).collect();
    sinks.into_iter().collect()
}

fn read_sink(section: &Section<'_>) -> Part<Sink> {
    let name = section.name("name");
    let shape = section.choice::<SinkWord>("shape");
    let (min, max) = (section.numbers::<3>("min"), section.numbers::<3>("max"));
    let point = section.numbers::<3>("point");
    let region = match shape?.unwrap_or(SinkWord::Box) {
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
    };
    Ok(Sink { name: needed(name)?, region })
}

/// A vector of any length but zero, as a unit vector.
fn read_direction(section: &Section<'_>, name: &str) -> Part<Vec3> {
    let vector = Vec3::from(given(section, name, section.numbers::<3>(name)?, "direction")?);
    vector.try_normalize().ok_or_else(|| {
        let message = format!("{} has no length", section.key_path(name));
        section.complain(name, message, "any vector but zero", "")
    })
}

fn given<T>(section: &Section<'_>, name: &str, value: Option<T>, what: &str) -> Part<T> {
    value.ok_or_else(|| {
        let message = format!("{} is missing: a {what} needs it", section.key_path(name));
        section.complain(name, message, "", "")
    })
}
