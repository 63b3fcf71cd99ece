//! The validated cases nearest to a scene, with their errors from `docs/validation.md`.

use serde::Serialize;

use crate::scene::{DensityMode, Method, Motion, Quantity, Scene, SurfaceTension};

/// A support ratio from which a scene counts as one of the wider support.
const WIDE: f32 = 2.5;
/// A kinematic viscosity in m^2/s from which the flow of a scene counts as viscous: that of oil.
const VISCOUS: f32 = 1e-5;

/// A validated case and its error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Validated {
    /// The case.
    pub case: &'static str,
    /// Its length of reference.
    pub across: &'static str,
    /// That length in spacings.
    pub spacings: u32,
    /// Its error.
    pub error: &'static str,
    /// The same length of the scene in spacings, if it has one.
    pub here: Option<f32>,
}

/// The solvers that the report distinguishes.
#[derive(Clone, Copy, PartialEq)]
enum Solver {
    Continuity,
    Engineering,
    Summation,
    Dfsph,
}

impl Solver {
    fn of(scene: &Scene) -> Option<Self> {
        let solver = &scene.solver;
        match (solver.method, solver.density) {
            (Method::Mueller2003, _) => None,
            (Method::Dfsph, _) => Some(Self::Dfsph),
            (_, DensityMode::Summation) => Some(Self::Summation),
            (_, DensityMode::Continuity) if solver.support_ratio >= WIDE => Some(Self::Engineering),
            (_, DensityMode::Continuity) => Some(Self::Continuity),
        }
    }
}

/// The cases nearest to a scene; none for `mueller2003`, which is not made for measurements.
pub(super) fn validated(scene: &Scene, depth: Option<f32>) -> Vec<Validated> {
    let Some(solver) = Solver::of(scene) else { return Vec::new() };
    let mut cases = Vec::new();
    let has_gravity = depth.is_some();
    if has_gravity && scene.fluid.material.viscosity < VISCOUS {
        cases.push(Validated {
            case: "collapsing column",
            across: "width",
            spacings: 20,
            error: match solver {
                Solver::Continuity => "front 2.8 %, height 1.3 %",
                Solver::Engineering => "front 2.7 %, height 1.3 %",
                Solver::Summation => "front 3.0 %, height 2.0 %",
                Solver::Dfsph => "front 2.7 %, height 2.1 %",
            },
            here: None,
        });
        cases.push(Validated {
            case: "standing wave without bodies",
            across: "depth",
            spacings: 20,
            error: match solver {
                Solver::Continuity => "period -0.81 %, 0.57 % of the height lost per period",
                Solver::Engineering => "period 0.13 %, 0.95 % of the height lost per period",
                Solver::Summation => "period -12 %, 9.6 % of the height lost per period",
                Solver::Dfsph => "period -2.7 %, 1.9 % of the height lost per period",
            },
            here: depth,
        });
    }
    let floats = scene.bodies.iter().any(|body| matches!(body.motion, Motion::Dynamic { hinge: None, .. }));
    if has_gravity && floats {
        cases.extend(match solver {
            Solver::Continuity => Some(Validated {
                case: "floating ball",
                across: "diameter",
                spacings: 12,
                error: "height -1.4 % of the diameter, period of heave 1.03 times that of theory",
                here: None,
            }),
            Solver::Dfsph => Some(Validated {
                case: "floating ball",
                across: "diameter",
                spacings: 12,
                error: "height -0.92 % of the diameter, period of heave 0.968 times that of theory",
                here: None,
            }),
            Solver::Summation => Some(Validated {
                case: "floating cube",
                across: "edge",
                spacings: 10,
                error: "height within 8 % of the edge",
                here: None,
            }),
            // Floating balls have not been measured with the wider support.
            Solver::Engineering => None,
        });
    }
    let measures_pressure = scene.probes.iter().any(|probe| matches!(probe.quantity, Quantity::Pressure(_)));
    if measures_pressure {
        let error = match solver {
            Solver::Continuity => {
                Some(("impulses of four gauges 1.02, 1.02, 0.717 and 0.172 times the measured ones", 9))
            }
            Solver::Dfsph => {
                Some(("impulses of four gauges 1.13, 1.01, 0.744 and 0.301 times the measured ones", 9))
            }
            Solver::Engineering => {
                Some(("impulses of four gauges 1.39, 1.11, 0.777 and 0.149 times the measured ones", 9))
            }
            // The program warns that summation measures a fifth of an impact.
            Solver::Summation => None,
        };
        cases.extend(error.map(|(error, spacings)| Validated {
            case: "impact on a box (SPHERIC test 2)",
            across: "height of the box",
            spacings,
            error,
            here: None,
        }));
    }
    if measures_pressure && solver == Solver::Engineering {
        cases.push(Validated {
            case: "tank at rest",
            across: "depth",
            spacings: 20,
            error: "pressure 0.27 % of rho g depth",
            here: depth,
        });
    }
    if scene.solver.surface_tension == SurfaceTension::Csf {
        let error = match solver {
            Solver::Engineering => Some("period 3.5 %"),
            Solver::Dfsph => Some("the wave does not come back"),
            // Not measured.
            Solver::Summation | Solver::Continuity => None,
        };
        cases.extend(error.map(|error| Validated {
            case: "capillary wave",
            across: "wave length",
            spacings: 20,
            error,
            here: None,
        }));
    }
    if scene.fluid.material.viscosity >= VISCOUS && solver == Solver::Dfsph {
        cases.push(Validated {
            case: "viscous flow in a duct",
            across: "width",
            spacings: 20,
            error: "velocity 3.5 %",
            here: None,
        });
    }
    cases
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The words of the report with digits, by the section whose heading begins like the name of the case. Where a table of
    /// the section has a column whose name begins like this, only those of such columns.
    fn figures_of(report: &str, case: &str, column: &str) -> Vec<String> {
        let headings = [
            ("floating ", "Floating bodies"),
            ("impact on a box", "SPHERIC test 2"),
            ("viscous flow", "Viscous flows"),
            ("standing wave", "Standing wave"),
        ];
        let known = headings.iter().find(|(start, _)| case.starts_with(start));
        let heading = known.map_or(case, |(_, heading)| heading).to_lowercase();
        let mut sections = report.split("\n## ");
        let section = sections.find(|section| section.to_lowercase().starts_with(&heading));
        let section = section.unwrap_or_else(|| panic!("no section {heading}"));
        let cells =
            |line: &str| -> Vec<String> { line.split('|').map(|cell| cell.trim().to_owned()).collect() };
        let (mut index, mut figures) = (None, Vec::new());
        for line in section.lines() {
            let cells = cells(line);
            if !line.starts_with('|') {
                index = None;
            } else if let Some(index) = index {
                figures.extend(cells.get::<usize>(index).cloned());
            } else {
                index = cells.iter().position(|cell| cell.starts_with(column));
            }
        }
        let text = if figures.is_empty() { section.to_owned() } else { figures.join(" ") };
        words_of(&text)
    }

    fn words_of(text: &str) -> Vec<String> {
        let words = text.split(|c: char| !(c.is_ascii_digit() || c == '.' || c == '-'));
        words.map(|word| word.trim_end_matches('.').to_owned()).filter(|word| word.contains('.')).collect()
    }

    /// The figures of the cases are those of the report.
    #[test]
    fn the_report_contains_the_figures() {
        let page = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/validation.md");
        let report = std::fs::read_to_string(page).unwrap();
        for (method, more) in [
            ("method = \"dfsph\"", ""),
            ("method = \"wcsph\"", ""),
            ("accuracy = \"engineering\"", ""),
            ("density = \"continuity\"", ""),
            ("method = \"dfsph\"", "material = \"honey\""),
            ("accuracy = \"engineering\"\nsurface_tension = \"csf\"", ""),
        ] {
            let text = format!(
                "[scene]\nname = \"x\"\nduration = 1\n[domain]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n[fluid]\nparticle_spacing = 0.02\n{more}\n\
                 [[fluid.block]]\nposition = [0, 0, 0]\nsize = [1, 0.5, 1]\n[solver]\n{method}\n\
                 [[body]]\nname = \"ball\"\nmesh = \"sphere\"\nmotion = \"dynamic\"\ndensity = 500\nposition = [0.5, 0.8, 0.5]\n\
                 [[probe]]\nname = \"gauge\"\nquantity = \"pressure\"\nposition = [0.0, 0.1, 0.5]\n"
            );
            let scene = Scene::parse(&text, "validated").unwrap();
            let cases = validated(&scene, Some(25.0));
            assert!(cases.len() > 1, "{cases:?}");
            for case in cases {
                let column = match Solver::of(&scene).unwrap() {
                    Solver::Continuity => "`continuity`",
                    Solver::Engineering => "`engineering`",
                    Solver::Summation => "`summation`",
                    Solver::Dfsph => "`dfsph`",
                };
                let known = figures_of(&report, case.case, column);
                for figure in words_of(case.error) {
                    assert!(known.contains(&figure), "{figure} of {case:?}, not among {known:?}");
                }
            }
        }
    }
}
