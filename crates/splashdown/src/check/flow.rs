//! Checks the emitters and sinks of a scene together with the bodies and with one another.

use glam::Vec3;
use splashdown_io::Particles;

use super::obstacles;
use super::placed::Placed;
use crate::flow::{LoadedFlow, outlet};
use crate::scene::lattice::Sampler;
use crate::scene::{Emitter, Motion, Reported, Scene, Section, outlet_outside};

/// Maximum number of points of an outlet that are tested against bodies.
const MAX_POINTS: usize = 64;
/// Maximum number of places of particles that are tested against sinks.
const MOST_SITES: u64 = 5_000_000;

pub(super) fn check_emitters(
    scene: &Scene,
    flow: &mut LoadedFlow,
    sections: &[Section<'_>],
    bodies: &[Placed<'_>],
) -> Result<(), Reported> {
    let mut result = Ok(());
    for (emitter, section) in scene.emitters.iter().zip(sections) {
        result = result.and(check_emitter(scene, flow, emitter, section, bodies));
    }
    result
}

fn check_emitter(
    scene: &Scene,
    flow: &mut LoadedFlow,
    emitter: &Emitter,
    section: &Section<'_>,
    bodies: &[Placed<'_>],
) -> Result<(), Reported> {
    let layer = flow
        .add_emitter(emitter, scene)
        .map_err(|error| section.complain("mesh", error.to_string(), "", ""))?;
    let (across, up) = outlet::axes(emitter.direction);
    let every = layer.points.len().div_ceil(MAX_POINTS).max(1);
    let points: Vec<Vec3> =
        layer.points.iter().step_by(every).map(|q| emitter.position + q.x * across + q.y * up).collect();
    let domain = &scene.domain;
    let slack = 1e-3 * scene.fluid.particle_spacing;
    if points.iter().any(|x| x.cmplt(domain.min - slack).any() || x.cmpgt(domain.max + slack).any()) {
        return Err(outlet_outside(section, emitter, domain));
    }
    obstacles::warn_of_walls(scene, emitter, &points, section);
    for placed in bodies {
        let inside = points.iter().filter(|x| placed.contains(**x)).count();
        if 2 * inside <= points.len() {
            continue;
        }
        let message = format!(
            "the outlet of emitter {:?} lies inside body {:?}: no fluid can leave it",
            emitter.name, placed.body.name
        );
        let hint = "move the outlet or the body; an outlet may lie on a body's surface";
        if placed.body.motion == Motion::Static {
            return Err(section.complain("position", message, "", hint));
        }
        section.warn("position", format!("{message} until the body moves away"), hint);
    }
    Ok(())
}

pub(super) fn check_sinks(
    scene: &Scene,
    flow: &mut LoadedFlow,
    sections: &[Section<'_>],
) -> Result<(), Reported> {
    let mut result = Ok(());
    for (sink, section) in scene.sinks.iter().zip(sections) {
        if let Err(error) = flow.add_sink(sink, scene) {
            result = Err(section.complain("mesh", error.to_string(), "", ""));
        }
    }
    result
}

/// Warns of sinks that remove all fluid of the start. `particles` are those of fluid that is not only blocks.
pub(super) fn warn_of_drained_fluid(
    scene: &Scene,
    flow: &LoadedFlow,
    particles: Option<&Particles>,
    sections: &[Section<'_>],
) {
    let Some(section) = sections.first() else { return };
    let is_drained = match particles {
        Some(particles) => {
            let places = &particles.positions;
            !places.is_empty() && places.iter().all(|x| flow.removes(Vec3::from(*x)))
        }
        None => {
            let samplers = Sampler::all(&scene.domain, &scene.fluid);
            let sites_of = |sampler: &Sampler| sampler.layers().into_iter().fold(1, u64::saturating_mul);
            let sites = samplers.iter().map(sites_of).fold(0, u64::saturating_add);
            let mut is_drained = (1..=MOST_SITES).contains(&sites);
            if is_drained {
                let mut test = |x: [f64; 3], free: bool| {
                    is_drained &= !free || flow.removes(Vec3::from(x.map(|x| x as f32)));
                };
                samplers.iter().for_each(|sampler| sampler.for_each(&mut test));
            }
            is_drained
        }
    };
    if is_drained {
        let message = "the sinks contain all fluid, which is removed in the first step".to_owned();
        section.warn("min", message, "make the sink smaller, or move it");
    }
}

/// Warns of emitters whose fluid a sink removes before it leaves the outlet, and of outlets that cross.
pub(super) fn warn_of_conflicts(scene: &Scene, flow: &LoadedFlow, sections: &[Section<'_>]) {
    for [emitter, sink] in flow.swallowed() {
        let message = format!(
            "emitter {:?} lies in sink {:?}, which removes its particles before they leave the outlet",
            scene.emitters[emitter].name, scene.sinks[sink].name
        );
        let depth = flow.nozzle_length(emitter);
        let hint = format!("move the outlet, with {depth:.3} m behind it, out of the sink");
        sections[emitter].warn("position", message, &hint);
    }
    for [first, second] in flow.crossing() {
        let (a, b) = (&scene.emitters[first].name, &scene.emitters[second].name);
        let message =
            format!("the outlets of emitters {a:?} and {b:?} cross: each blocks a part of the other's flow");
        let depth = flow.nozzle_length(first).max(flow.nozzle_length(second));
        let hint = format!("move them apart; the fluid begins {depth:.3} m behind an outlet");
        sections[second].warn("position", message, &hint);
    }
}
