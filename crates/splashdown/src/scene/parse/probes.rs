//! The sections `[[probe]]`.

use glam::Vec3;

use super::things::read_unique;
use super::{Part, needed};
use crate::scene::keys::QuantityWord;
use crate::scene::outlet;
use crate::scene::reader::{Reported, Section};
use crate::scene::suggest;
use crate::scene::things::{Body, Probe, Quantity};
use crate::scene::types::Domain;

/// Maximum number of rows of a probe per frame.
const MAX_ROWS: f32 = 10_000.0;

/// The parts of the scene that probes are checked against; `None` if they could not be read.
pub(super) struct Context<'a> {
    pub domain: Option<&'a Domain>,
    pub bodies: Option<&'a [Body]>,
}

/// Reads all `[[probe]]` sections.
pub(super) fn read_probes(sections: &[Section<'_>], context: &Context<'_>) -> Part<Vec<Probe>> {
    let probes = read_unique(sections, "probes", |section| read_probe(section, context), |probe| &probe.name);
    probes.into_iter().collect()
}

fn read_probe(section: &Section<'_>, context: &Context<'_>) -> Part<Probe> {
    let name = section.name("name");
    let quantity = section.choice::<QuantityWord>("quantity");
    let position = section.numbers::<3>("position");
    let body = section.name("body");
    let normal = section.numbers::<3>("normal");
    let along = section.numbers::<3>("along");
    let size = section.numbers::<2>("size");
    let (min, max) = (section.numbers::<3>("min"), section.numbers::<3>("max"));
    let interval = section.number("interval");
    let quantity = needed(quantity)?;
    let word = match quantity {
        QuantityWord::Pressure => "pressure",
        QuantityWord::Height => "height",
        QuantityWord::Force => "force",
        QuantityWord::Body => "body",
        QuantityWord::Flow => "flow",
        QuantityWord::Fluid => "fluid",
        QuantityWord::Energy => "energy",
    };
    let fitting: &[&str] = match quantity {
        QuantityWord::Pressure | QuantityWord::Height => &["position", "interval"],
        QuantityWord::Force | QuantityWord::Body => &["body", "interval"],
        QuantityWord::Flow => &["position", "normal", "along", "size", "interval"],
        // It has one row per frame, so there is no interval.
        QuantityWord::Fluid => &["min", "max"],
        QuantityWord::Energy => &[],
    };
    for key in ["position", "body", "normal", "along", "size", "min", "max", "interval"] {
        if section.has(key) && !fitting.contains(&key) {
            let message = format!("{} does not apply to quantity = {word:?}", section.key_path(key));
            return Err(section.complain(key, message, &fitting.join(", "), "remove it"));
        }
    }
    let missing = |key: &str| {
        let message = format!("{} is missing: {word} needs it", section.key_path(key));
        section.complain(key, message, "", "")
    };
    let point = || -> Part<Vec3> {
        let point = Vec3::from(position?.ok_or_else(|| missing("position"))?);
        match context.domain {
            Some(domain) if point.cmplt(domain.min).any() || point.cmpgt(domain.max).any() => {
                let message = format!("{} lies outside the domain", section.key_path("position"));
                let allowed = format!("{} to {} m", domain.min, domain.max);
                Err(section.complain("position", message, &allowed, "there is no fluid to measure"))
            }
            _ => Ok(point),
        }
    };
    let quantity = match quantity {
        QuantityWord::Pressure => Quantity::Pressure(point()?),
        QuantityWord::Height => Quantity::Height(point()?),
        QuantityWord::Force => Quantity::Force(known_body(section, body?, context.bodies, missing)?),
        QuantityWord::Body => Quantity::Body(known_body(section, body?, context.bodies, missing)?),
        QuantityWord::Flow => {
            let center = point()?;
            let normal = unit(section, "normal", normal?.ok_or_else(|| missing("normal"))?)?;
            let along = match along? {
                None => outlet::axes(normal).0,
                Some(along) => {
                    let along = unit(section, "along", along)?;
                    if along.dot(normal).abs() > 1e-3 {
                        let message =
                            format!("{} is not perpendicular to the normal", section.key_path("along"));
                        let allowed = "a vector perpendicular to normal";
                        return Err(section.complain("along", message, allowed, ""));
                    }
                    along
                }
            };
            let size = size?.ok_or_else(|| missing("size"))?;
            Quantity::Flow { center, normal, along, size }
        }
        QuantityWord::Fluid => {
            let (min, max) =
                (min?.map_or(Vec3::NEG_INFINITY, Vec3::from), max?.map_or(Vec3::INFINITY, Vec3::from));
            if max.cmple(min).any() {
                let message = format!("{} is not above min", section.key_path("max"));
                return Err(section.complain("max", message, "larger than min along every axis", ""));
            }
            Quantity::Fluid { min, max }
        }
        QuantityWord::Energy => Quantity::Energy,
    };
    Ok(Probe { name: needed(name)?, quantity, interval: interval? })
}

fn known_body(
    section: &Section<'_>,
    name: Option<String>,
    bodies: Option<&[Body]>,
    missing: impl Fn(&str) -> Reported,
) -> Part<String> {
    let name = name.ok_or_else(|| missing("body"))?;
    // The names of the bodies are unknown if one of them could not be read.
    let Some(bodies) = bodies else { return Ok(name) };
    let names: Vec<&str> = bodies.iter().map(|body| body.name.as_str()).collect();
    if names.contains(&name.as_str()) {
        return Ok(name);
    }
    let message = format!("there is no body called {name:?}");
    let hint = suggest::closest(&name, &names).map(|meant| format!("did you mean {meant:?}?"));
    let allowed = if names.is_empty() { "the scene has no [[body]]".to_owned() } else { names.join(", ") };
    Err(section.complain("body", message, &allowed, &hint.unwrap_or_default()))
}

fn unit(section: &Section<'_>, key: &str, vector: [f32; 3]) -> Part<Vec3> {
    Vec3::from(vector).try_normalize().ok_or_else(|| {
        let message = format!("{} is the zero vector", section.key_path(key));
        section.complain(key, message, "any vector except zero", "")
    })
}

/// Checks the number of rows per frame, because the rows of a frame are stored on the device.
pub(super) fn check_intervals(root: &Section<'_>, probes: Vec<Probe>, frame: f32) -> Part<Vec<Probe>> {
    let short = probes.iter().find(|probe| probe.interval.is_some_and(|s| frame / s > MAX_ROWS));
    let Some(probe) = short else { return Ok(probes) };
    let message = format!("probe {:?} has more than {MAX_ROWS} rows per frame", probe.name);
    let allowed = format!("an interval of at least {} s", frame / MAX_ROWS);
    Err(root.complain("probe", message, &allowed, "make the interval longer or the frame_rate higher"))
}
