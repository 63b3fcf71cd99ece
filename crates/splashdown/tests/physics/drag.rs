//! Drag of a cylinder and of a sphere that are towed through a fluid at rest, without gravity.
//!
//! *References.* The drag of a cylinder that starts to move is not steady yet: `docs/validation/cylinder_drag.py` solves the
//! Navier-Stokes equations for the same motion without bound. It has 1.34 at a Reynolds number of 100 as the mean
//! over the time of the comparison, where the steady symmetric flow has 1.06 (S. Dennis and G.-Z. Chang, J. Fluid Mech. 42
//! (1970) 471-489). The drag of a sphere is that of L. Schiller and A. Naumann (1933), 24 / Re (1 + 0.15 Re^0.687).
//!
//! *Motion.* The speed grows as sin^2(pi t / 2) until t = 1, in diameters over the speed, and is then constant. The drag is
//! the mean from 3.5 to 6.5, in which the body moves from 3 to 6 diameters.
//!
//! *Tank.* The sides have no friction. Walls are planes of symmetry, so that half of a cylinder is simulated and a quarter of a
//! sphere. A slab four spacings thick represents the two dimensions of the cylinder. The whole tank is 12 diameters wide for
//! the cylinder, and 6 for the sphere.
//!
//! *Blockage.* Cylinder: Cd (1 - Cd / 2 (D / W) - 2.5 (D / W)^2) (A. Roshko, J. Fluid Mech. 10 (1961) 345-356, after H. Allen
//! and W. Vincenti, NACA Report 782 (1944)). Sphere: Cd / (1 + 2.5 Cd S / C) with its section S and that of the tank C
//! (E. Maskell, ARC R&M 3400 (1963)). Both hold for a developed wake.

use std::f64::consts::PI;

use glam::Vec3;
use splashdown::Simulation;
use splashdown_io::Mesh;

use super::cases::{CONTROL, Case, Variant, is_validation};
use super::figures::{Figures, Series};
use super::shapes::file;
use super::{executor, scene};

/// Lengths in diameters of 1 m; the speed is 1 m/s.
const LENGTH: f64 = 13.5;
/// First place of the body.
const FIRST: f64 = 3.5;
/// First and last time of the mean in s.
const MEAN: [f64; 2] = [3.5, 6.5];

/// The Mach number is 0.1.
const ENGINEERING: Variant = Variant::extra("engineering", "accuracy = \"engineering\"\nsound_speed = 10");

static CYLINDER: Case = Case {
    name: "drag of a cylinder",
    across: "diameter",
    sizes: &[8, 12, 16],
    variants: &[ENGINEERING, CONTROL],
};
static SPHERE: Case =
    Case { name: "drag of a sphere", across: "diameter", sizes: &[8, 12], variants: &[ENGINEERING, CONTROL] };
pub const CASES: &[&Case] = &[&CYLINDER, &SPHERE];

/// Means of `cylinder_drag.py`, by the Reynolds number.
const CYLINDER_DRAG: [(f64, f64); 3] = [(100.0, 1.341), (50.0, 1.637), (1000.0, 0.904)];

/// The Reynolds numbers at a resolution: all but at the coarsest.
fn numbers(across: u32) -> &'static [f64] {
    if across > 8 { &[100.0, 50.0, 1000.0] } else { &[100.0] }
}

fn schiller_naumann(reynolds: f64) -> f64 {
    24.0 / reynolds * (1.0 + 0.15 * reynolds.powf(0.687))
}

#[derive(Clone, Copy, PartialEq)]
enum Shape {
    Cylinder,
    Sphere,
}

/// A body that is towed.
struct Towed {
    shape: Shape,
    across: u32,
    solver: &'static str,
    reynolds: f64,
    /// 1: the fluid sticks to the body.
    friction: f64,
}

/// A cylinder along z with a diameter of 1 m about the origin.
fn cylinder(thick: f64) -> Mesh {
    let sides = 96;
    // The section has the area of the circle.
    let turn = 2.0 * PI / f64::from(sides);
    let radius = 0.5 * (turn / turn.sin()).sqrt();
    let mut points = vec![[0.0, 0.0, -0.5], [0.0, 0.0, thick as f32 + 0.5]];
    for k in 0..sides {
        let angle = turn * f64::from(k);
        let [x, y] = [(radius * angle.cos()) as f32, (radius * angle.sin()) as f32];
        points.extend([[x, y, -0.5], [x, y, thick as f32 + 0.5]]);
    }
    let triangles = (0..sides).flat_map(|k| {
        let (low, high) = (2 + 2 * k, 3 + 2 * k);
        let next = 2 + 2 * ((k + 1) % sides);
        [[0, next, low], [1, high, next + 1], [low, next, next + 1], [low, next + 1, high]]
    });
    Mesh::new(points, triangles.collect())
}

impl Towed {
    /// Sizes of the simulated part of the tank along y and z in m.
    fn section(&self) -> [f64; 2] {
        match self.shape {
            Shape::Cylinder => [6.0, 4.0 / f64::from(self.across)],
            Shape::Sphere => [3.0, 3.0],
        }
    }

    /// Half of rho U^2 times the simulated part of the frontal area.
    fn scale(&self) -> f64 {
        match self.shape {
            Shape::Cylinder => 500.0 * 0.5 * self.section()[1],
            Shape::Sphere => 500.0 * PI / 16.0,
        }
    }

    /// The drag coefficient over time. The model of a sphere is 0.2 m across.
    fn tow(&self) -> Series {
        let spacing = 1.0 / f64::from(self.across);
        let [high, thick] = self.section();
        let folder = tempfile::tempdir().unwrap();
        let mut scene = scene(&format!(
            "[scene]\nname = \"drag\"\nduration = 20\ngravity = [0, 0, 0]\n[domain]\nmin = [0, 0, 0]\n\
             max = [{LENGTH}, {high}, {thick}]\n[fluid]\nparticle_spacing = {spacing}\nviscosity = {}\n\
             [[fluid.block]]\nposition = [0, 0, 0]\nsize = [{LENGTH}, {high}, {thick}]\n\
             [[body]]\nname = \"body\"\nmesh = \"sphere\"\nscale = 5\nposition = [{FIRST}, 0, 0]\nfriction = {}\n\
             move = [\"min(t,1)/2 - sin(pi*min(t,1))/(2*pi) + max(t-1,0)\", \"0\", \"0\"]\n\
             [[probe]]\nname = \"force\"\nquantity = \"force\"\nbody = \"body\"\ninterval = 0.05\n[solver]\n{}\n",
            1.0 / self.reynolds,
            self.friction,
            self.solver,
        ));
        if self.shape == Shape::Cylinder {
            scene.bodies[0].mesh.shape = file(folder.path(), "cylinder.obj", &cylinder(thick));
            scene.bodies[0].mesh.scale = Vec3::ONE;
        }
        let mut simulation = Simulation::with_executor(&scene, executor()).unwrap();
        let mut drag = Series::new();
        while simulation.stats().time < MEAN[1] {
            let stats = simulation.advance(0.1).unwrap();
            assert_eq!((stats.non_finite, stats.escaped), (0, 0), "{stats:?}");
            let rows = simulation.take_probe_rows();
            drag.extend(rows[0].iter().map(|row| (row[0], -row[1] / self.scale())));
        }
        drag
    }

    /// The coefficient without bound.
    fn corrected(&self, drag: f64) -> f64 {
        match self.shape {
            Shape::Cylinder => {
                let blockage = 0.5 / self.section()[0];
                drag * (1.0 - 0.5 * drag * blockage - 2.5 * blockage.powi(2))
            }
            Shape::Sphere => drag / (1.0 + 2.5 * drag * PI / 16.0 / self.section().iter().product::<f64>()),
        }
    }

    /// Measures the drag over a reference.
    fn compare(&self, figures: &mut Figures, reference: f64) {
        let mut drag = self.tow();
        let raw = mean(&drag);
        let number = self.reynolds;
        figures.report(format!("coefficient without the correction for blockage, Re {number}"), raw);
        let found = self.corrected(raw) / reference - 1.0;
        figures.error(format!("drag over the reference, minus one, Re {number}"), found);
        drag.retain(|p| p.0 > 1.0);
        let line = vec![(MEAN[0], reference), (MEAN[1], reference)];
        let title = format!("Drag at Re {number} (dots: reference without bound)");
        figures.plot(&title, ["time, diameters over speed", "coefficient"], &line, &drag);
    }
}

fn mean(drag: &Series) -> f64 {
    let late: Vec<f64> = drag.iter().filter(|p| (MEAN[0]..MEAN[1]).contains(&p.0)).map(|p| p.1).collect();
    assert!(late.len() > 30, "{}", late.len());
    late.iter().sum::<f64>() / late.len() as f64
}

#[test]
fn a_towed_cylinder_has_the_drag_of_the_exact_flow() {
    if !is_validation() {
        eprintln!("SKIPPED: the drag of a cylinder takes minutes; run `cargo xtask validate`");
        return;
    }
    CYLINDER.run(|variant, across, figures| {
        let in_use = |(reynolds, _): &(f64, f64)| numbers(across).contains(reynolds);
        for (reynolds, reference) in CYLINDER_DRAG.into_iter().filter(in_use) {
            let towed =
                Towed { shape: Shape::Cylinder, across, solver: variant.keys, reynolds, friction: 1.0 };
            towed.compare(figures, reference);
        }
    });
}

#[test]
fn a_towed_sphere_has_the_drag_of_measurements() {
    if !is_validation() {
        eprintln!("SKIPPED: the drag of a sphere takes minutes; run `cargo xtask validate`");
        return;
    }
    SPHERE.run(|variant, across, figures| {
        for &reynolds in numbers(across) {
            let towed = Towed { shape: Shape::Sphere, across, solver: variant.keys, reynolds, friction: 1.0 };
            towed.compare(figures, schiller_naumann(reynolds));
        }
    });
}

/// Control: without friction, only the pressure acts on a body.
#[test]
fn a_body_without_friction_is_detected() {
    if !is_validation() {
        eprintln!(
            "SKIPPED: the drag of a cylinder and of a sphere takes minutes; run `cargo xtask validate`"
        );
        return;
    }
    let references =
        [(&CYLINDER, Shape::Cylinder, CYLINDER_DRAG[0].1), (&SPHERE, Shape::Sphere, schiller_naumann(100.0))];
    for (case, shape, reference) in references {
        let mut figures = Figures::new(case, CONTROL.name, 8);
        let towed = Towed { shape, across: 8, solver: ENGINEERING.keys, reynolds: 100.0, friction: 0.0 };
        let wrong = towed.corrected(mean(&towed.tow())) / reference - 1.0;
        figures.measure("difference without friction, Re 100", wrong.abs());
        figures.close();
    }
}
