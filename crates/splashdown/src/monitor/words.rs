//! The messages of the monitor: what is wrong, where, since when, why, and what to change.

use glam::Vec3;

use super::Watched;
use crate::scene::{DensityMode, Method, Motion, Scene};

/// What the monitor knows of the scene for its messages.
#[derive(Clone, Debug)]
pub(super) struct Context {
    spacing: f32,
    domain: crate::scene::Domain,
    /// Names, outlets in m and speeds of the emitters.
    emitters: Vec<(String, Vec3, f32)>,
    /// Names of the bodies that move by a script, and of those that the fluid moves.
    scripted: Vec<String>,
    dynamic: Vec<String>,
    cfl_factor: f32,
    is_integrated: bool,
    pulls_surfaces_together: bool,
    is_mueller: bool,
    is_implicit: bool,
    /// The time in s in which the initial arrangement of particles expands.
    early: f64,
    /// Whether particles overlap at the start; `None` if the first frame was not examined.
    pub starts_dense: Option<bool>,
    /// In m/s.
    sound_speed: f32,
    /// The largest acceleration of the shaken domain in m/s^2, if it is violent.
    shaking: Option<f32>,
}

/// Shaking is violent from this multiple of gravity, or of [`EARTH`] without gravity.
const VIOLENT: f32 = 20.0;
/// Gravity of the earth in m/s^2.
const EARTH: f32 = 9.81;

/// The sentence of particles that start faster than the others; `others` is the speed in m/s that those allow.
pub(super) fn outliers(count: usize, speed: f64, others: f64, place: Vec3) -> String {
    let (plural, verb) = if count == 1 { ("", "starts") } else { ("s", "start") };
    format!(
        "{count} particle{plural} {verb} at up to {speed:.3} m/s, at {}, {:.1} times the largest speed that the other fluid reaches by its \
         energy ({others:.3} m/s). Correct the velocities of imported particles, or give pieces of fluid at least eight \
         particles",
        point(place),
        speed / others
    )
}

impl Context {
    pub fn new(scene: &Scene, sound_speed: f32, reference_speed: f32) -> Self {
        let spacing = scene.fluid.particle_spacing;
        let names = |has_motion: fn(&Motion) -> bool| {
            let bodies = scene.bodies.iter().filter(|body| has_motion(&body.motion));
            bodies.map(|body| body.name.clone()).collect()
        };
        let emitters = scene.emitters.iter();
        Self {
            spacing,
            domain: scene.domain.clone(),
            emitters: emitters.map(|one| (one.name.clone(), one.position, one.speed)).collect(),
            scripted: names(|motion| matches!(motion, Motion::Scripted(_))),
            dynamic: names(|motion| matches!(motion, Motion::Dynamic { .. })),
            cfl_factor: scene.solver.cfl_factor,
            is_integrated: scene.solver.method == Method::Wcsph
                && scene.solver.density == DensityMode::Continuity,
            pulls_surfaces_together: scene.solver.pulls_surfaces_together(),
            is_mueller: scene.solver.method == Method::Mueller2003,
            is_implicit: scene.solver.method == Method::Dfsph,
            // A few tens of spacings at the speed of sound.
            early: f64::from(50.0 * spacing / sound_speed.max(10.0 * reference_speed)),
            starts_dense: None,
            sound_speed,
            shaking: scene.domain.oscillation.map(|oscillation| oscillation.max_acceleration()).filter(
                |&acceleration| {
                    let gravity = scene.gravity.length();
                    acceleration > VIOLENT * if gravity > 0.0 { gravity } else { EARTH }
                },
            ),
        }
    }

    /// Where a point is: next to a body, an emitter or a side, or inside the fluid.
    fn neighbour(&self, x: Vec3, body: Option<(f32, &str)>) -> Neighbour {
        let near = 3.0 * self.spacing;
        if let Some((_, name)) = body.filter(|(distance, _)| *distance < near) {
            return Neighbour::Body(name.to_owned());
        }
        let outlet = self.emitters.iter().find(|(_, outlet, _)| outlet.distance(x) < 4.0 * near);
        if let Some((name, ..)) = outlet {
            return Neighbour::Emitter(name.clone());
        }
        let sides = ["x", "y", "z"].into_iter().enumerate().flat_map(|(axis, letter)| {
            let planes = [self.domain.min[axis], self.domain.max[axis]];
            [0, 1].map(|side| (self.domain.closed[axis][side], (x[axis] - planes[side]).abs(), letter, side))
        });
        let closed = sides.filter(|&(closed, distance, ..)| closed && distance < near);
        if let Some((.., letter, side)) = closed.min_by(|a, b| a.1.total_cmp(&b.1)) {
            return Neighbour::Side(format!("{letter}_{}", ["min", "max"][side]));
        }
        Neighbour::Fluid
    }

    /// The sentence of a rise: the value, the place, the likely cause and the advice.
    pub fn message(&self, rise: &Rise<'_>) -> String {
        let Rise { watched, time, place, body, .. } = *rise;
        let neighbour = place.map_or(Neighbour::Fluid, |x| self.neighbour(x, body));
        let what = self.what(rise);
        let at = if watched == Watched::EnergyGain { "the fastest particle is at" } else { "at" };
        let at = match (place, &neighbour) {
            (None, _) => String::new(),
            (Some(x), Neighbour::Fluid) => format!(", {at} {}", point(x)),
            (Some(x), Neighbour::Body(name)) => format!(", {at} {} next to body {name:?}", point(x)),
            (Some(x), Neighbour::Emitter(name)) => format!(", {at} {} near emitter {name:?}", point(x)),
            (Some(x), Neighbour::Side(side)) => format!(", {at} {} at the side {side}", point(x)),
        };
        format!("at {time:.4} s: {what}{at}. {}", self.advice(rise, &neighbour))
    }

    fn what(&self, rise: &Rise<'_>) -> String {
        let Rise { watched, value, allowed_speed, .. } = *rise;
        let count = value as u64;
        let plural = if count == 1 { "" } else { "s" };
        match watched {
            Watched::Speed => format!(
                "a particle moves at {:.3} m/s, {value:.1} times the largest speed that the energy of the scene allows ({allowed_speed:.3} m/s)",
                value * allowed_speed
            ),
            Watched::FastPart => format!(
                "one particle in a hundred moves faster than {:.3} m/s, {value:.1} times the largest speed that the energy of \
                 the scene allows ({allowed_speed:.3} m/s)",
                value * allowed_speed
            ),
            Watched::EnergyGain => {
                format!("the fluid has gained {:.1} % energy from nowhere", 100.0 * value)
            }
            Watched::Compression => {
                format!("the density is up to {:.0} % above the rest density", 100.0 * value)
            }
            Watched::DensePart => {
                format!("one particle in a hundred is more than {:.0} % too dense", 100.0 * value)
            }
            Watched::ThinPart => {
                format!("one inner particle in a hundred is more than {:.0} % too thin", 100.0 * value)
            }
            Watched::WallCorrections => {
                format!(
                    "{count} time{plural} a particle was moved back through a closed wall or the surface of a body"
                )
            }
            Watched::InsideBodies => {
                format!("{count} particle{plural} {} inside a body", if count == 1 { "is" } else { "are" })
            }
            Watched::NonFinite => {
                format!(
                    "{count} particle{plural} became NaN or infinite and {} removed",
                    if count == 1 { "was" } else { "were" }
                )
            }
            Watched::SpeedLimits => {
                format!(
                    "{count} time{plural} a particle was limited to the largest motion per step: the time step is too long for its speed"
                )
            }
        }
    }

    /// The likely cause, and what to change.
    fn advice(&self, rise: &Rise<'_>, neighbour: &Neighbour) -> String {
        let Rise { watched, time, allowed_speed, .. } = *rise;
        let is_density = matches!(watched, Watched::Compression | Watched::DensePart);
        if watched == Watched::SpeedLimits {
            let sound = if self.is_implicit { "" } else { ", or raise solver.sound_speed" };
            return format!("Lower solver.cfl_factor{sound}");
        }
        if watched == Watched::ThinPart {
            return "Fluid is stretched, or pressures are too low to hold it together; results there are inaccurate".to_owned();
        }
        if let Some(acceleration) = self.shaking
            && !matches!(watched, Watched::InsideBodies)
        {
            return format!(
                "Likely cause: the domain is shaken at up to {acceleration:.0} m/s^2. Lower domain.oscillation.amplitude or \
                 raise its period; solver.cfl_factor (now {}) limits the step",
                self.cfl_factor
            );
        }
        let is_pressed =
            is_density || matches!(watched, Watched::Speed | Watched::FastPart | Watched::EnergyGain);
        if is_pressed && !self.is_implicit && allowed_speed > 0.3 * f64::from(self.sound_speed) {
            return format!(
                "Likely cause: the speed of sound, {} m/s, is too low for these speeds and depths. Raise solver.sound_speed or \
                 stiffness, or leave them out",
                self.sound_speed
            );
        }
        if self.starts_dense != Some(false) && time < self.early && !matches!(watched, Watched::InsideBodies)
        {
            return "Likely cause: the particles overlap at the start. Move pieces of fluid, bodies and emitters apart by a \
                    multiple of particle_spacing, and check imported particles with `splashdown check`"
                .to_owned();
        }
        if is_pressed && self.pulls_surfaces_together {
            let other = if self.is_mueller { "" } else { ", or density = \"continuity\"" };
            return format!(
                "Likely cause: with a summed density, negative pressures pull the surface together. Set \
                 solver.negative_pressure = \"clamp\"{other}"
            );
        }
        match neighbour {
            Neighbour::Body(name) if self.scripted.contains(name) => format!(
                "Likely cause: body {name:?} presses water against a wall or another body, or moves too fast for the \
                 resolution. Leave a gap of more than two spacings, slow it down, or lower particle_spacing"
            ),
            Neighbour::Body(name) if watched == Watched::WallCorrections && self.dynamic.contains(name) => format!(
                "Likely cause: body {name:?} meets water or another body fast for the time step, or has parts or gaps thinner than \
                 two spacings. Lower solver.cfl_factor (now {}), or particle_spacing",
                self.cfl_factor
            ),
            Neighbour::Body(name) => {
                // A long step carries a fast, thin stream into a curved surface before pressure acts on it.
                let shorter = if self.is_implicit {
                    format!("; for fast streams lower solver.cfl_factor (now {}), or use method = \"wcsph\"", self.cfl_factor)
                } else {
                    String::new()
                };
                format!(
                    "Likely cause: body {name:?} has parts or gaps thinner than two spacings, or overlaps a wall or another \
                     body. Lower particle_spacing, move it, or set its boundary to \"particles\"{shorter}"
                )
            }
            Neighbour::Emitter(name) => format!(
                "Likely cause: emitter {name:?} adds water where there is no room, under water or in a full place. Move it above \
                 the water, or open a side"
            ),
            _ if watched == Watched::WallCorrections => {
                "Likely cause: bodies or gaps thinner than two spacings, a body that moves too fast for the resolution, or fluid \
                 that is pressed against it. Lower particle_spacing, slow bodies down, or leave more room"
                    .to_owned()
            }
            _ if is_density => {
                let sound = if self.is_implicit {
                    ""
                } else {
                    "; raise solver.sound_speed if speeds exceed those expected"
                };
                format!(
                    "Likely cause: the fluid does not fit into the available space, or a fast jet hits a wall. Check emitters \
                     and moving bodies in closed places{sound}"
                )
            }
            _ if self.is_mueller => "Likely cause: the time step or the stiffness is too large. Lower solver.cfl_factor, or use method = \"wcsph\"".to_owned(),
            _ if self.is_integrated => format!(
                "Likely cause: the integrated density has drifted. Lower solver.cfl_factor (now {}), raise \
                 solver.density_diffusion, or use density = \"summation\"",
                self.cfl_factor
            ),
            _ => format!(
                "Likely cause: the time step is too long, or water is squeezed. Lower solver.cfl_factor (now {}), or raise \
                 solver.artificial_viscosity",
                self.cfl_factor
            ),
        }
    }
}

/// A value that has risen to a new level.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rise<'a> {
    pub watched: Watched,
    pub value: f64,
    pub time: f64,
    /// In m.
    pub place: Option<Vec3>,
    /// Distance in m and name of the body nearest to the place.
    pub body: Option<(f32, &'a str)>,
    /// In m/s.
    pub allowed_speed: f64,
}

enum Neighbour {
    Body(String),
    Emitter(String),
    Side(String),
    Fluid,
}

fn point(x: Vec3) -> String {
    format!("({:.4}, {:.4}, {:.4}) m", x.x, x.y, x.z)
}
