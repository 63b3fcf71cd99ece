//! Random scenes: every key of the scene language that can make the fluid burst.

use std::fmt::Write;

use super::judge::{dot, length};
use super::rng::Rng;

/// What the judge knows about a scene, without the program.
#[derive(Clone, Debug)]
pub struct Facts {
    /// Particle spacing in m.
    pub spacing: f64,
    /// Mass of a particle in kg.
    pub mass: f64,
    /// Corners of the domain in m.
    pub min: [f64; 3],
    pub max: [f64; 3],
    /// The closed sides, by axis.
    pub closed: [[bool; 2]; 3],
    /// In m/s^2.
    pub gravity: [f64; 3],
    /// The largest speed in m/s that initial speeds, a fall through the whole domain, bodies, emitters, shaking and
    /// surface forces can give to a particle.
    pub speed: f64,
    /// The largest potential per mass at the lowest corner of the domain: gravity times its position, in m^2/s^2.
    pub lowest: f64,
    /// Energy in J per particle that bodies, shaking and surface forces can bring in.
    pub brought: f64,
    pub has_sinks: bool,
    pub has_emitters: bool,
    /// Static balls: centre and radius in m.
    pub balls: Vec<([f64; 3], f64)>,
}

/// A random scene.
#[derive(Clone, Debug)]
pub struct Storm {
    pub name: String,
    pub text: String,
    pub facts: Facts,
    /// What it contains, for the statistics of the report.
    pub traits: Vec<&'static str>,
}

/// Restrictions of the generator.
#[derive(Clone, Copy, Debug, Default)]
pub struct Only {
    /// All scenes use `density = "continuity"`.
    pub continuity: bool,
}

/// The models, with their largest extent in m at a scale of 1, and half their height where the origin is the centre.
const MODELS: [(&str, f64); 15] = [
    ("sphere", 0.2),
    ("block", 0.2),
    ("cube", 1.0),
    ("lighthouse", 1.0),
    ("figure", 1.0),
    ("hull", 0.6),
    ("buoy", 0.66),
    ("cup", 0.1),
    ("thin-cup", 0.1),
    ("gear", 0.44),
    ("paddle-wheel", 0.5),
    ("drum", 0.5),
    ("torus-knot", 0.6),
    ("ramp", 1.0),
    ("steps", 1.0),
];

const SIDES: [&str; 6] = ["x_min", "x_max", "y_min", "y_max", "z_min", "z_max"];

/// The scene with this number.
pub fn storm(seed: u64, number: u64, only: Only) -> Storm {
    let mut maker = Maker::new(Rng::new(seed, number));
    maker.solver(only);
    maker.gravity();
    maker.fluid();
    maker.bodies();
    maker.flow();
    maker.finish(format!("storm-{number:04}"))
}

struct Maker {
    rng: Rng,
    spacing: f64,
    /// Edge lengths of the domain in m; its lower corner is the origin.
    size: [f64; 3],
    gravity: [f64; 3],
    ratio: f64,
    /// The `cfl_factor` for which the duration is chosen. Where the scene has the default, it is the smallest one, 0.3, which
    /// keeps the scenes of earlier reports.
    cfl: f64,
    density: f64,
    /// The fastest fluid at the start, the fastest body, nozzle and shaking, in m/s.
    speeds: [f64; 4],
    /// Specific energy of surface forces in m^2/s^2.
    surface: f64,
    /// Energy in J of dynamic bodies.
    body_energy: f64,
    particles: f64,
    closed: [[bool; 2]; 3],
    has_sinks: bool,
    balls: Vec<([f64; 3], f64)>,
    fluid: String,
    solver: String,
    things: String,
    domain: String,
    traits: Vec<&'static str>,
}

impl Maker {
    fn new(mut rng: Rng) -> Self {
        let spacing = rng.pick(&[0.01, 0.02, 0.025, 0.05, 0.1]);
        let edge = |rng: &mut Rng| rng.whole(8, 26) as f64 + rng.pick(&[0.0, 0.0, 0.3, 0.5]);
        let size = [edge(&mut rng), edge(&mut rng), edge(&mut rng)].map(|cells| cells * spacing);
        Self {
            rng,
            spacing,
            size,
            gravity: [0.0, -9.81, 0.0],
            ratio: 2.0,
            cfl: 0.3,
            density: 1000.0,
            speeds: [0.0; 4],
            surface: 0.0,
            body_energy: 0.0,
            particles: 0.0,
            closed: [[true; 2]; 3],
            has_sinks: false,
            balls: Vec::new(),
            fluid: String::new(),
            solver: String::new(),
            things: String::new(),
            domain: String::new(),
            traits: Vec::new(),
        }
    }

    fn solver(&mut self, only: Only) {
        let rng = &mut self.rng;
        let mut text = String::from("[solver]\n");
        let is_thesis = !only.continuity && rng.chance(0.12);
        let is_continuity = !is_thesis && (only.continuity || rng.chance(0.42));
        let is_implicit = !is_thesis && !is_continuity && rng.chance(0.6);
        if is_thesis {
            text += "method = \"mueller2003\"\n";
            self.traits.push("mueller2003");
        } else if is_continuity {
            self.traits.push("continuity");
            if rng.chance(0.3) {
                text += "accuracy = \"engineering\"\n";
                self.ratio = 3.0;
            } else {
                text += "density = \"continuity\"\n";
            }
            if rng.chance(0.2) {
                let _ = writeln!(text, "density_diffusion = {:.3}", rng.between(0.0, 0.5));
            }
        } else if is_implicit {
            text += "method = \"dfsph\"\n";
            self.traits.push("dfsph");
        } else {
            text += "method = \"wcsph\"\n";
            self.traits.push("summation");
        }
        if rng.chance(0.35) {
            self.ratio = rng.pick(&[1.7, 2.0, 2.2, 2.4, 2.6, 3.0]);
            let _ = writeln!(text, "support_ratio = {}", self.ratio);
        }
        if !is_thesis {
            if rng.chance(0.2) {
                text += "kernel = \"cubic_spline\"\n";
            }
            if rng.chance(0.25) {
                let _ =
                    writeln!(text, "artificial_viscosity = {:.3}", rng.pick(&[0.0, 0.01, 0.05, 0.1, 0.3]));
            }
            if !is_implicit && rng.chance(0.15) {
                let _ = writeln!(text, "exponent = {:?}", rng.pick(&[1.0, 4.0, 7.0]));
            }
        }
        if !is_implicit && rng.chance(0.2) {
            let _ = writeln!(text, "negative_pressure = {:?}", rng.pick(&["clamp", "keep"]));
        }
        if rng.chance(0.2) {
            let _ = writeln!(text, "wall_friction = {:.2}", rng.unit());
        }
        if rng.chance(0.3) {
            self.cfl = rng.pick(&[0.15, 0.4, 0.6, 0.8, 1.0]);
            let _ = writeln!(text, "cfl_factor = {}", self.cfl);
        }
        if rng.chance(0.1) {
            text += "sort = \"bitonic\"\n";
        }
        if rng.chance(0.12) {
            let model = match self.ratio {
                _ if is_thesis => "mueller2003",
                3.0.. => "csf",
                _ => "akinci2013",
            };
            let _ = writeln!(text, "surface_tension = {model:?}");
            self.surface = 2.0 * 0.0728 / (800.0 * self.spacing);
            self.traits.push("surface tension");
        }
        self.solver = text;
        let mut text = String::new();
        if rng.chance(0.25) {
            let _ = writeln!(text, "material = {:?}", rng.pick(&["oil", "glycerin", "honey"]));
            self.traits.push("viscous");
            // The lowest density of the materials.
            self.density = 900.0;
        }
        if rng.chance(0.1) {
            self.density = rng.pick(&[200.0, 700.0, 1000.0, 3000.0, 13_500.0]);
            let _ = writeln!(text, "density = {}", self.density);
        }
        if rng.chance(0.1) {
            let _ = writeln!(text, "viscosity = {:.2e}", 10f64.powf(rng.between(-6.0, -1.5)));
        }
        if rng.chance(0.2) {
            text += "initial_pressure = \"zero\"\n";
        }
        self.fluid = text;
    }

    fn gravity(&mut self) {
        let rng = &mut self.rng;
        let strength = if rng.chance(0.15) { rng.pick(&[0.5, 1.62, 30.0, 100.0]) } else { 9.81 };
        if rng.chance(0.08) {
            self.gravity = [0.0; 3];
        } else if rng.chance(0.2) {
            self.gravity = rng.direction().map(|part| part * strength);
        } else {
            self.gravity = [0.0, -strength, 0.0];
        }
        if rng.chance(0.25) {
            for _ in 0..rng.whole(1, 3) {
                let side = if rng.chance(0.5) { 3 } else { rng.whole(0, 5) as usize };
                self.closed[side / 2][side % 2] = false;
            }
            self.traits.push("open sides");
        }
        let open: Vec<&str> =
            (0..6).filter(|side| !self.closed[side / 2][side % 2]).map(|side| SIDES[side]).collect();
        let _ = writeln!(self.domain, "open = {open:?}");
        if rng.chance(0.12) {
            let period = rng.between(0.2, 1.0);
            let amplitude =
                [0, 1, 2].map(|axis| if rng.chance(0.5) { 0.1 * rng.unit() * self.size[axis] } else { 0.0 });
            let _ = writeln!(
                self.domain,
                "[domain.oscillation]\namplitude = {amplitude:.4?}\nperiod = {period:.3}"
            );
            self.speeds[3] = length(amplitude) * std::f64::consts::TAU / period;
            self.traits.push("shaking");
        }
    }

    /// A velocity, at rest in most cases, with speeds up to 20 m/s.
    fn velocity(&mut self, moving: f64) -> [f64; 3] {
        if !self.rng.chance(moving) {
            return [0.0; 3];
        }
        let top = if self.rng.chance(0.3) { 20.0 } else { 4.0 };
        let speed = self.rng.between(0.1, top);
        self.rng.direction().map(|part| (part * speed * 1000.0).round() / 1000.0)
    }

    fn fluid(&mut self) {
        let dx = self.spacing;
        let count = self.rng.pick(&[1, 1, 1, 2, 2, 3]);
        if count > 1 {
            self.traits.push("several blocks");
        }
        let mut previous: Option<([f64; 3], [f64; 3])> = None;
        for _ in 0..count {
            let rng = &mut self.rng;
            let mut edge = [0, 1, 2].map(|axis| {
                let cells = (self.size[axis] / dx).floor();
                let wanted = if rng.chance(0.35) { cells } else { rng.between(4.0, cells).floor() };
                wanted * dx
            });
            // At most 2,500 particles per scene.
            while edge.iter().product::<f64>() / dx.powi(3) > 2500.0 / f64::from(count) {
                let longest = (0..3).max_by(|&a, &b| edge[a].total_cmp(&edge[b])).unwrap_or(0);
                edge[longest] = (edge[longest] / dx * 0.8).floor() * dx;
            }
            // Snapped to the lattice, anywhere, or touching the block before with a gap of a fraction of a spacing.
            let mut low = [0, 1, 2].map(|axis| {
                let free = (self.size[axis] - edge[axis]).max(0.0);
                match rng.whole(0, 3) {
                    0 | 1 => 0.0,
                    2 => (free * rng.unit() / dx).floor() * dx,
                    _ => free * rng.unit(),
                }
            });
            if let (Some((start, length)), true) = (previous, rng.chance(0.6)) {
                let axis = rng.whole(0, 2) as usize;
                let beyond = start[axis] + length[axis] + rng.pick(&[-0.5, 0.0, 0.0, 0.25, 0.5]) * dx;
                low[axis] = beyond.min(self.size[axis] - edge[axis]).max(0.0);
            }
            self.particles += edge.iter().product::<f64>() / dx.powi(3);
            previous = Some((low, edge));
            let velocity = self.velocity(0.3);
            self.speeds[0] = self.speeds[0].max(length(velocity));
            let ball = self.rng.chance(0.15);
            let text = if ball {
                let radius = 0.5 * edge.into_iter().fold(f64::INFINITY, f64::min);
                let center = [0, 1, 2].map(|axis| low[axis] + 0.5 * edge[axis]);
                format!("shape = \"sphere\"\ncenter = {center:.5?}\nradius = {radius:.5}")
            } else {
                format!("position = {low:.5?}\nsize = {edge:.5?}")
            };
            let _ = writeln!(self.fluid, "[[fluid.block]]\n{text}\nvelocity = {velocity:?}");
        }
        if self.rng.chance(0.1) {
            let (mesh, extent) = self.rng.pick(&[
                ("sphere", 0.2),
                ("torus-knot", 0.6),
                ("block", 0.2),
                ("thin-cup-filling", 0.1),
            ]);
            let (scale, _) = self.placed(extent, 0.3, 0.6);
            // The mesh must lie inside the domain; a cup stands on its origin.
            let shortest = self.size.into_iter().fold(f64::INFINITY, f64::min);
            let lift = if mesh == "thin-cup-filling" { 0.5 * extent * scale } else { 0.0 };
            let rng = &mut self.rng;
            let mut position = self.size.map(|edge| 0.5 * edge + 0.15 * rng.between(-1.0, 1.0) * shortest);
            position[1] -= lift;
            let velocity = self.velocity(0.3);
            self.speeds[0] = self.speeds[0].max(length(velocity));
            let _ = writeln!(
                self.fluid,
                "[[fluid.mesh]]\nmesh = {mesh:?}\nscale = {scale:.4}\nposition = {position:.4?}\nvelocity = {velocity:?}"
            );
            self.traits.push("fluid mesh");
        }
    }

    /// A scale at which a model has between these fractions of the domain's shortest edge, and a position.
    fn placed(&mut self, extent: f64, low: f64, high: f64) -> (f64, [f64; 3]) {
        let shortest = self.size.into_iter().fold(f64::INFINITY, f64::min);
        let scale = self.rng.between(low, high) * shortest / extent;
        let rng = &mut self.rng;
        let position = self.size.map(|edge| edge * rng.between(0.2, 0.8));
        (scale, position)
    }

    fn bodies(&mut self) {
        if !self.rng.chance(0.6) {
            return;
        }
        for number in 0..self.rng.pick(&[1, 1, 1, 2, 2, 3]) {
            let (model, extent) = self.rng.pick(&MODELS);
            let (scale, mut position) = self.placed(extent, 0.25, 0.7);
            let stretch =
                if self.rng.chance(0.2) { [0; 3].map(|_| self.rng.between(0.4, 1.0)) } else { [1.0; 3] };
            let is_flush = self.rng.chance(0.35);
            if is_flush {
                // The centred models stand on the floor or touch a wall.
                let axis = if self.rng.chance(0.6) { 1 } else { self.rng.whole(0, 2) as usize };
                let gap = self.rng.pick(&[0.0, 0.0, 0.25, 0.5, 1.0]) * self.spacing;
                let edge = extent * scale * stretch[axis];
                let half = if matches!(model, "sphere" | "block" | "cube") { 0.5 * edge } else { 0.0 };
                position[axis] = half + gap;
                self.traits.push("flush body");
            }
            let is_stretched = stretch != [1.0; 3];
            let scales = if is_stretched {
                self.traits.push("stretched body");
                format!("{:.4?}", stretch.map(|part| part * scale))
            } else {
                format!("{scale:.4}")
            };
            let mut text = format!(
                "[[body]]\nname = \"body{number}\"\nmesh = {model:?}\nscale = {scales}\nposition = {position:.4?}\n"
            );
            let turned = self.rng.chance(0.4) && !is_flush;
            if turned {
                let rng = &mut self.rng;
                let _ = writeln!(text, "rotation = {:.1?}", [0; 3].map(|_| rng.between(-180.0, 180.0)));
            }
            let size = extent * scale;
            match self.rng.whole(0, 9) {
                0..4 => {
                    self.traits.push("static body");
                    if model == "sphere" && !is_stretched {
                        self.balls.push((position, 0.5 * size));
                    }
                }
                4..7 => self.dynamic(&mut text, size),
                _ => self.scripted(&mut text, size),
            }
            if self.rng.chance(0.3) {
                let _ = writeln!(text, "friction = {:.2}", self.rng.unit());
            }
            if self.rng.chance(0.1) {
                let adhesion = self.rng.between(0.5, 20.0);
                let _ = writeln!(text, "adhesion = {adhesion:.2}");
                self.surface += 2.0 * adhesion * 2.0 * self.spacing;
            }
            if self.rng.chance(0.4) {
                text += "boundary = \"particles\"\n";
            }
            self.things += &text;
        }
    }

    fn dynamic(&mut self, text: &mut String, size: f64) {
        self.traits.push("dynamic body");
        let density = 10f64.powf(self.rng.between(2.0, 3.9)).round();
        let velocity = self.velocity(0.4);
        let _ = writeln!(text, "motion = \"dynamic\"\ndensity = {density}\nvelocity = {velocity:?}");
        let mut spin = 0.0;
        if self.rng.chance(0.25) {
            spin = self.rng.between(0.0, 30.0);
            let vector = self.rng.direction().map(|part| part * spin);
            let _ = writeln!(text, "angular_velocity = {vector:.2?}");
        }
        if self.rng.chance(0.15) {
            let _ = writeln!(text, "hinge = {:?}", self.rng.pick(&[[0, 0, 1], [0, 1, 0], [1, 0, 0]]));
            if self.rng.chance(0.5) {
                self.traits.push("motor");
                let rate = self.rng.between(-20.0, 20.0);
                let _ = writeln!(text, "motor_speed = {rate:.2}");
                if self.rng.chance(0.5) {
                    let weight = density * size.powi(3) * 9.81;
                    let torque = self.rng.between(0.05, 2.0) * weight * size;
                    let _ = writeln!(text, "motor_torque = {torque:.5}");
                }
                spin += rate.abs();
            }
        }
        if self.rng.chance(0.25) {
            let _ = writeln!(text, "restitution = {:.2}", self.rng.unit());
        }
        if self.rng.chance(0.25) {
            let _ = writeln!(text, "contact_friction = {:.2}", self.rng.between(0.0, 1.5));
        }
        let speed = length(velocity) + 0.9 * spin * size;
        self.speeds[1] = self.speeds[1].max(speed);
        let fall = length(self.gravity) * length(self.size);
        self.body_energy += density * size.powi(3) * (0.5 * speed * speed + fall);
    }

    fn scripted(&mut self, text: &mut String, size: f64) {
        self.traits.push("moving body");
        let mut speed = 0.0;
        if self.rng.chance(0.6) {
            let (axis, rate) = (self.rng.whole(0, 2) as usize, self.rng.between(1.0, 12.0));
            let far = self.rng.between(0.02, 0.3) * self.size[axis];
            let mut parts = ["0".to_owned(), "0".to_owned(), "0".to_owned()];
            parts[axis] = if self.rng.chance(0.7) {
                speed += far * rate;
                format!("{far:.4}*sin({rate:.3}*t)")
            } else {
                speed += far * rate;
                format!("{:.4}*min(t, {:.3})", far * rate, 1.0 / rate)
            };
            let _ = writeln!(text, "move = {parts:?}");
        } else {
            let rate = self.rng.between(30.0, 1200.0);
            let _ = writeln!(text, "turn = [\"0\", \"0\", \"{rate:.1}*t\"]");
            speed += rate.to_radians() * 0.9 * size;
        }
        self.speeds[1] = self.speeds[1].max(speed);
    }

    fn flow(&mut self) {
        if self.rng.chance(0.22) {
            self.traits.push("emitter");
            let rng = &mut self.rng;
            let position = self.size.map(|edge| edge * rng.between(0.35, 0.65));
            // The outlet must lie inside the domain.
            let room = 0.3 * self.size.into_iter().fold(f64::INFINITY, f64::min);
            let speed = if rng.chance(0.2) { rng.between(5.0, 20.0) } else { rng.between(0.2, 4.0) };
            let shape = if rng.chance(0.5) {
                format!("shape = \"disc\"\nradius = {:.4}", (rng.between(1.5, 4.0) * self.spacing).min(room))
            } else {
                let edges = [0; 2].map(|_| (rng.between(3.0, 8.0) * self.spacing).min(1.2 * room));
                format!("shape = \"rectangle\"\nsize = {edges:.4?}")
            };
            let direction = if rng.chance(0.5) { [0.0, -1.0, 0.0] } else { rng.direction() };
            let most = rng.whole(100, 1500);
            let _ = writeln!(
                self.things,
                "[[emitter]]\nname = \"jet\"\nposition = {position:.4?}\ndirection = {direction:.3?}\nspeed = {speed:.3}\n{shape}\nmax_particles = {most}"
            );
            self.speeds[2] = speed;
        }
        if self.rng.chance(0.12) {
            self.traits.push("sink");
            self.has_sinks = true;
            let rng = &mut self.rng;
            let low = self.size.map(|edge| edge * rng.between(0.0, 0.7));
            let high = [0, 1, 2].map(|axis| low[axis] + self.size[axis] * rng.between(0.1, 0.3));
            let _ = writeln!(self.things, "[[sink]]\nname = \"drain\"\nmin = {low:.4?}\nmax = {high:.4?}");
        }
        if self.rng.chance(0.1) {
            self.things += "[[probe]]\nname = \"all\"\nquantity = \"fluid\"\n";
        }
    }

    fn finish(mut self, name: String) -> Storm {
        let [fluid, body, nozzle, shaking] = self.speeds;
        let fall: f64 = (0..3).map(|axis| (self.gravity[axis] * self.size[axis]).abs()).sum();
        let energy = fluid * fluid + 2.0 * fall + 4.0 * body * body + nozzle * nozzle + 2.0 * self.surface;
        let speed = (energy.sqrt() + 2.0 * shaking).max(0.02);
        // About this many explicit steps of that factor.
        let sound = 10.0 * ((4.0 * fall + fluid.max(body).max(nozzle).powi(2)).sqrt() + shaking).max(0.01);
        let steps = self.rng.between(900.0, 2600.0);
        let duration = (steps * self.cfl * 0.5 * self.ratio * self.spacing / sound).clamp(0.01, 1.5);
        let rate = 16.0 / duration;
        let gravity = self.gravity;
        let text = format!(
            "[scene]\nname = {name:?}\nduration = {duration:.5}\nframe_rate = {rate:.4}\ngravity = {gravity:.4?}\n[domain]\nmin = [0.0, 0.0, 0.0]\n\
             max = {:.5?}\n{}[fluid]\nparticle_spacing = {}\n{}{}{}",
            self.size, self.domain, self.spacing, self.fluid, self.things, self.solver
        );
        let mass = self.density * self.spacing.powi(3);
        let corner = [0, 1, 2].map(|axis| if gravity[axis] > 0.0 { self.size[axis] } else { 0.0 });
        let specific = 2.0 * body * body + 2.0 * shaking * shaking + self.surface + 2e-3 * speed * speed;
        let brought = mass * specific + self.body_energy / self.particles.max(1.0);
        self.traits.sort_unstable();
        self.traits.dedup();
        let facts = Facts {
            spacing: self.spacing,
            mass,
            min: [0.0; 3],
            max: self.size,
            closed: self.closed,
            gravity,
            speed,
            lowest: dot(gravity, corner),
            brought,
            has_sinks: self.has_sinks,
            has_emitters: self.traits.contains(&"emitter"),
            balls: self.balls,
        };
        Storm { name, text, facts, traits: self.traits }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seed_gives_the_same_scenes_and_another_gives_others() {
        let text = |seed, number| storm(seed, number, Only::default()).text;
        assert_eq!(text(1, 7), text(1, 7));
        assert_ne!(text(1, 7), text(2, 7));
        assert_ne!(text(1, 7), text(1, 8));
    }
}
