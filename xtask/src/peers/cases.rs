//! The cases in which simulated time is compared, as scenes of both programs.

use serde_json::{Value, json};

/// A block of fluid in a closed box, with or without a floating cube.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    pub name: &'static str,
    /// What the table's caption says about it.
    pub text: &'static str,
    /// Edges of the box in m; a corner is the origin and y is up.
    pub domain: [f64; 3],
    /// Lower corner and edges of the block in m.
    pub block: [[f64; 3]; 2],
    /// Particle spacing in m.
    pub spacing: f64,
    /// Simulated time in s.
    pub seconds: f64,
    /// Kinematic viscosity in m^2/s of a liquid that sticks to the walls; `None` for water.
    pub viscosity: Option<f64>,
    /// Edge in m, density in kg/m^3 and centre in m of a cube.
    pub cube: Option<(f64, f64, [f64; 3])>,
}

/// All cases. The first one has goals for the speed.
pub const CASES: [Case; 5] = [
    Case {
        name: "block",
        text: "a block of 2 m collapses in a box of 6.4 m x 4 m x 2 m",
        domain: [6.4, 4.0, 2.0],
        block: [[0.0; 3], [2.0; 3]],
        spacing: 0.05,
        seconds: 1.5,
        viscosity: None,
        cube: None,
    },
    Case {
        name: "dam break",
        text: "the block and the box of SPlisHSPlasH's `DamBreakModel.json`, 1 m in 4 m x 3 m x 1.5 m",
        domain: [4.0, 3.0, 1.5],
        block: [[0.05, 0.05, 0.25], [1.0; 3]],
        spacing: 0.05,
        seconds: 2.0,
        viscosity: None,
        cube: None,
    },
    Case {
        name: "calm tank",
        text: "water at rest, 0.5 m deep, in a box of 1 m",
        domain: [1.0; 3],
        block: [[0.0; 3], [1.0, 0.5, 1.0]],
        spacing: 0.025,
        seconds: 1.0,
        viscosity: None,
        cube: None,
    },
    Case {
        name: "honey",
        text: "a column of honey, 0.08 m x 0.16 m x 0.08 m, sags on the floor of a box",
        domain: [0.32, 0.24, 0.32],
        block: [[0.12, 0.0, 0.12], [0.08, 0.16, 0.08]],
        spacing: 0.004,
        seconds: 0.3,
        viscosity: Some(0.01335),
        cube: None,
    },
    Case {
        name: "floating cube",
        text: "a cube of 0.4 m and 500 kg/m^3 floats in water 0.8 m deep, after a fall of 0.1 m",
        domain: [2.0, 1.6, 1.2],
        block: [[0.0; 3], [2.0, 0.8, 1.2]],
        spacing: 0.04,
        seconds: 1.0,
        viscosity: None,
        cube: Some((0.4, 500.0, [1.0, 1.1, 0.6])),
    },
];

impl Case {
    /// The case at half the resolution and a fifth of the time, for a trial.
    pub fn quick(self) -> Self {
        Self { spacing: 2.0 * self.spacing, seconds: 0.2 * self.seconds, ..self }
    }

    /// The scene of Splashdown with these keys of `[solver]`.
    pub fn scene(&self, solver: &str) -> String {
        let Self { domain, block: [position, size], spacing, seconds, .. } = self;
        let mut text = format!(
            "[scene]\nname = {:?}\nduration = {seconds:?}\nframe_rate = 10\n[domain]\nmin = [0, 0, 0]\nmax = {domain:?}\n\
             [fluid]\nparticle_spacing = {spacing:?}\ndensity = 1000\n",
            self.name.replace(' ', "-")
        );
        if let Some(viscosity) = self.viscosity {
            text += &format!("viscosity = {viscosity:?}\n");
        }
        text += &format!("[[fluid.block]]\nposition = {position:?}\nsize = {size:?}\n");
        if let Some((edge, density, centre)) = self.cube {
            text += &format!(
                "[[body]]\nname = \"cube\"\nmesh = \"cube\"\nscale = {edge:?}\nposition = {centre:?}\nmotion = \"dynamic\"\n\
                 density = {density:?}\n"
            );
        }
        text += "[surface]\nenabled = false\n[solver]\n";
        if self.viscosity.is_some() {
            text += "wall_friction = 1.0\n";
        }
        format!("{text}{solver}\n")
    }

    /// What `xtask/peers/simulate.py` makes a scene of SPlisHSPlasH from.
    pub fn description(&self) -> Value {
        json!({
            "name": self.name.replace(' ', "-"),
            "domain": self.domain,
            "position": self.block[0],
            "size": self.block[1],
            "spacing": self.spacing,
            "seconds": self.seconds,
            "viscosity": self.viscosity,
            "cube": self.cube.map(|(edge, density, centre)| json!({"edge": edge, "density": density, "centre": centre})),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::CASES;

    #[test]
    fn both_programs_get_the_same_lengths() {
        for case in CASES.map(super::Case::quick) {
            let (ours, theirs) = (case.scene("method = \"dfsph\""), case.description());
            assert!(ours.ends_with("method = \"dfsph\"\n"));
            for (key, value) in [("particle_spacing", &theirs["spacing"]), ("duration", &theirs["seconds"])] {
                assert!(ours.contains(&format!("{key} = {value}\n")), "{key} {value}\n{ours}");
            }
            assert_eq!(ours.contains("viscosity"), theirs["viscosity"].is_number());
            assert_eq!(ours.contains("[[body]]"), theirs["cube"].is_object());
        }
    }
}
