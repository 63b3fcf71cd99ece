use splashdown_gpu::{Command, CpuExecutor, Executor};

use super::*;
use crate::cells::Grid;
use crate::cells::Sort;
use crate::mouse_force::MouseForceCoupling;

const WCSPH: &str = "method = \"wcsph\"";

/// A block of 64 particles in a cubic domain with edges of `size` metres, and cells of 0.2 m.
fn scene(size: f32, solver: &str) -> Scene {
    let text = format!(
        r#"
        [scene]
        name = "block"
        duration = 1.0
        [domain]
        min = [0, 0, 0]
        max = [{size}, {size}, {size}]
        [fluid]
        particle_spacing = 0.1
        [[fluid.block]]
        position = [0, 0, 0]
        size = [0.4, 0.4, 0.4]
        [solver]
        {solver}
        "#
    );
    Scene::parse(&text, "block.toml").unwrap_or_else(|errors| panic!("{errors}"))
}

/// The number of cells, and the commands of a step: labels of its dispatches, clears and copies.
fn step(size: f32, solver: &str, with_mouse_force: bool) -> (u32, Vec<&'static str>) {
    let scene = scene(size, solver);
    let (solver, params) = (Scheme::new(&scene), params(&scene, 64));
    let mut executor = Executor::from(CpuExecutor::new());
    let fields = Fields::new(&mut executor, &params, solver.extras(true)).unwrap();
    let grid = Grid::new(scene.domain.min, scene.domain.max, params.support_radius).unwrap();
    let cells = Cells::new(&mut executor, grid, 64, Sort::Counting).unwrap();
    let mouse_force = with_mouse_force.then(|| MouseForceCoupling::new(&mut executor).unwrap());
    let couplings = Couplings { mouse_force: mouse_force.as_ref(), ..Couplings::default() };
    let label = |command: &Command| match command {
        Command::Dispatch { pass, .. } => pass.label,
        Command::Clear { .. } => "clear",
        Command::Copy { .. } => "copy",
        Command::Repeat { .. } => "repeat",
    };
    let step = solver.step(&cells, &fields, &couplings, 64, &solver.solver_rounds());
    (grid.cell_count, step.commands.iter().map(label).collect())
}

#[test]
fn a_plain_step_has_five_dispatches_or_six_with_many_cells() {
    let (cells, small) = step(2.0, WCSPH, false);
    assert!(cells < 16_384);
    let passes = [
        "scan.single",
        "cells.scatter",
        "cells.reorder",
        "density.wendland_c2",
        "force_integrate.wendland_c2",
    ];
    assert_eq!(small, passes);
    let (cells, large) = step(10.0, WCSPH, false);
    assert!(cells > 16_384);
    assert_eq!(large[..2], ["scan.reduce", "scan.spread"]);
    assert_eq!(large[2..], passes[1..]);
    // Controls: a coupling between forces and integration prevents the fused pass, as does surface tension.
    assert_eq!(step(2.0, WCSPH, true).1.len(), 7);
    assert_eq!(step(2.0, "method = \"wcsph\"\nsurface_tension = \"akinci2013\"", false).1.len(), 7);
}

/// Adding them made the drag of a sphere 30 % too large.
#[test]
fn the_numerical_viscosity_at_bodies_is_a_lower_limit_and_not_added() {
    let friction = |viscosity: f32| {
        let mut scene = scene(2.0, "accuracy = \"engineering\"\nsound_speed = 10");
        scene.fluid.material.viscosity = viscosity;
        let params = params(&scene, 64);
        params.viscosity + params.boundary_viscosity
    };
    // alpha c0 H / 20 with alpha = 0.05 and H = 0.3 m.
    for (viscosity, expected) in [(0.0, 0.0075), (0.005, 0.0075), (0.01, 0.01)] {
        assert!((friction(viscosity) - expected).abs() < 1e-6, "{viscosity}: {}", friction(viscosity));
    }
}
