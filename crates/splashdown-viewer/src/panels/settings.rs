//! The settings of the simulation and of its display.

use egui::{CollapsingHeader, ComboBox, Context, Rect, ScrollArea, Slider, SliderClamping, Ui, vec2};
use splashdown::scene::{Choice, ColourBy, MATERIALS, Method, Solver, SurfaceTension};
use splashdown::surface::MAX_BLOB;
use splashdown_render::{Axis, ColourMap};

use super::{change, dialog, gravity};
use crate::edit;
use crate::items::decimal;
use crate::look::{DisplayMode, Look};
use crate::state::{Action, State};

/// Width of the panel, in points.
const WIDTH: f32 = 290.0;
/// The number of particles cannot be changed in scenes that start with fewer particles than this.
const MIN_PARTICLES: u64 = 20;

/// The panel lies over the right side of the picture, `over`.
pub(super) fn show(ctx: &Context, state: &mut State, actions: &mut Vec<Action>, over: Rect) {
    let mut is_open = state.shown.settings;
    dialog::new("Settings", over)
        .open(&mut is_open)
        .default_pos(over.right_top() + vec2(-WIDTH, 0.0))
        .default_size([WIDTH, over.height()])
        .resizable([true, false])
        .show(ctx, |ui| {
            ScrollArea::vertical().max_height(dialog::inner_height(over)).show(ui, |ui| {
                if state.timeline.is_some() {
                    // A finished run cannot be changed.
                    display(ui, state, actions);
                    return;
                }
                section(ui, "Fluid", |ui| fluid(ui, state, actions));
                section(ui, "Gravity", |ui| gravity::show(ui, state, actions));
                section(ui, "Add", |ui| add(ui, state, actions));
                section(ui, "Solver", |ui| solver(ui, state, actions));
                section(ui, "Display", |ui| display(ui, state, actions));
            });
        });
    state.shown.settings = is_open;
}

fn section(ui: &mut Ui, title: &str, contents: impl FnOnce(&mut Ui)) {
    CollapsingHeader::new(title).default_open(true).show(ui, contents);
}

fn fluid(ui: &mut Ui, state: &mut State, actions: &mut Vec<Action>) {
    let wanted = Slider::new(&mut state.particles_wanted, 500.0..=2_000_000.0)
        .clamping(SliderClamping::Edits)
        .logarithmic(true)
        .max_decimals(0)
        .text("particles");
    // If all fluid comes from emitters, the initial number does not determine the particle spacing.
    let counted = state.counted;
    let wanted = ui
        .add_enabled(counted >= MIN_PARTICLES, wanted)
        .on_hover_text(
            "Approximate initial number of particles. More particles are finer and slower. A change restarts the scene",
        )
        .on_disabled_hover_text("This scene starts without fluid; emitters add it");
    if wanted.drag_stopped() || (wanted.changed() && !wanted.dragged()) {
        let factor = (counted as f32 / state.particles_wanted).cbrt();
        for length in [&mut state.scene.fluid.particle_spacing, &mut state.scene.surface.cell_size] {
            *length = decimal(factor * *length, *length);
        }
        state.counted = splashdown::check::count(&state.scene);
        actions.push(Action::Restart);
    }
    ui.weak(format!("{:.2} mm apart", 1000.0 * state.scene.fluid.particle_spacing));
    let material = &mut state.scene.fluid.material;
    let mut changed = false;
    ComboBox::from_label("material").selected_text(material.name.clone()).show_ui(ui, |ui| {
        for known in MATERIALS {
            if ui.selectable_label(material.name == known.name, known.name).clicked() {
                *material = known.material();
                changed = true;
            }
        }
    });
    let viscosity = Slider::new(&mut material.viscosity, 0.0..=0.1)
        .clamping(SliderClamping::Edits)
        .logarithmic(true)
        .smallest_positive(1e-7)
        .suffix(" m²/s")
        .text("viscosity");
    let viscosity = ui
        .add(viscosity)
        .on_hover_text("Kinematic viscosity: water has 0.000001, olive oil 0.00009, honey 0.007 m²/s");
    changed |= viscosity.changed();
    let tension = Slider::new(&mut material.surface_tension, 0.0..=0.5)
        .clamping(SliderClamping::Edits)
        .suffix(" N/m")
        .text("surface tension");
    let tension = ui
        .add_enabled(state.scene.solver.surface_tension != SurfaceTension::None, tension)
        .on_hover_text("Water against air has 0.073 N/m")
        .on_disabled_hover_text("Disabled: enable it under Solver");
    changed |= tension.changed();
    if changed {
        actions.push(Action::Change);
    }
}

fn add(ui: &mut Ui, state: &mut State, actions: &mut Vec<Action>) {
    ui.horizontal_wrapped(|ui| {
        let now = ui.input(|input| input.time);
        if ui.button("Add ball").on_hover_text("A ball with half the density of the fluid (B)").clicked() {
            change::apply(state, actions, now, edit::add_ball);
        }
        let (text, hint) = match edit::added_emitter(&state.scene) {
            Some(_) => ("Remove emitter", "The one that was added last (P)"),
            None => ("Add emitter", "A stream from above (P)"),
        };
        if ui.button(text).on_hover_text(hint).clicked() {
            change::apply(state, actions, now, edit::toggle_emitter);
        }
        super::add_mesh(ui, actions);
    });
    ui.weak("A mesh is also added by dropping its file (OBJ, STL, PLY or glTF) onto the window.");
}

fn solver(ui: &mut Ui, state: &mut State, actions: &mut Vec<Action>) {
    let solver = &mut state.scene.solver;
    let mut changed = false;
    ComboBox::from_label("method").selected_text(name(solver.method)).show_ui(ui, |ui| {
        // The default first.
        for &(method, _, about) in Method::ALL.iter().rev() {
            let label =
                ui.selectable_label(solver.method == method, name(method)).on_hover_text(about.trim());
            if label.clicked() && solver.method != method {
                solver.select_method(method);
                changed = true;
            }
        }
    });
    let mut tension = solver.surface_tension != SurfaceTension::None;
    let checkbox = ui.checkbox(&mut tension, "with surface tension").on_hover_text(
        "Akinci, Akinci and Teschner 2013, or Müller, Charypar and Gross 2003: forms drops and films",
    );
    if checkbox.changed() {
        solver.surface_tension = if tension { tension_of(solver.method) } else { SurfaceTension::None };
        solver.contact_angle = Solver::NEUTRAL_ANGLE;
        changed = true;
    }
    let mut slider = |value: &mut f32, range, text: &str, hint: &str| {
        changed |= ui
            .add(Slider::new(value, range).clamping(SliderClamping::Edits).text(text))
            .on_hover_text(hint)
            .changed();
    };
    slider(
        &mut solver.artificial_viscosity,
        0.0..=0.5,
        "damping",
        "Factor alpha of Monaghan's artificial viscosity: 0.1 damps strongly. Noise needs some with summed densities, and \
         none with the continuity equation",
    );
    slider(&mut solver.wall_friction, 0.0..=1.0, "wall friction", "0: free slip, 1: no slip");
    if changed {
        actions.push(Action::Change);
    }
}

fn tension_of(method: Method) -> SurfaceTension {
    match method {
        Method::Wcsph | Method::Dfsph => SurfaceTension::Akinci2013,
        Method::Mueller2003 => SurfaceTension::ColourField,
    }
}

fn name(method: Method) -> &'static str {
    match method {
        Method::Wcsph => "wcsph (weakly compressible)",
        Method::Dfsph => "dfsph (implicit pressure)",
        Method::Mueller2003 => "mueller2003 (the original thesis)",
    }
}

fn display(ui: &mut Ui, state: &mut State, actions: &mut Vec<Action>) {
    let is_simulated = state.timeline.is_none();
    if is_simulated {
        foam(ui, state, actions);
    }
    let look = &mut state.look;
    if look.mode.has_colours() {
        colours(ui, look);
    } else if look.mode.needs_surface() && is_simulated {
        surface(ui, state, actions);
    } else if !is_simulated {
        ui.label("A run that is played has settings in the views Particles and Slice only.");
    }
}

fn foam(ui: &mut Ui, state: &mut State, actions: &mut Vec<Action>) {
    let foam = ui
        .checkbox(&mut state.scene.foam.enabled, "Foam and spray")
        .on_hover_text("Spray in the air, foam on the surface, bubbles in the fluid (Ihmsen et al. 2012)");
    if foam.changed() {
        actions.push(Action::Change);
    }
}

fn colours(ui: &mut Ui, look: &mut Look) {
    ui.horizontal(|ui| {
        ui.label("colour by");
        for (quantity, text) in
            [(ColourBy::Speed, "speed"), (ColourBy::Density, "density"), (ColourBy::Pressure, "pressure")]
        {
            ui.selectable_value(&mut look.colour_by, quantity, text);
        }
    });
    ComboBox::from_label("colours").selected_text(look.map.name()).show_ui(ui, |ui| {
        for map in [ColourMap::Water, ColourMap::Viridis, ColourMap::Inferno, ColourMap::BlueRed] {
            ui.selectable_value(&mut look.map, map, map.name());
        }
    });
    if look.mode == DisplayMode::Slice {
        ui.horizontal(|ui| {
            for (axis, name) in [(Axis::X, "x"), (Axis::Y, "y"), (Axis::Z, "z")] {
                ui.selectable_value(&mut look.slice_axis, axis, name);
            }
            ui.add(
                Slider::new(&mut look.slice_at, 0.0..=1.0).clamping(SliderClamping::Edits).text("position"),
            );
        });
    }
}

fn surface(ui: &mut Ui, state: &mut State, actions: &mut Vec<Action>) {
    let surface = &mut state.scene.surface;
    let iterations = Slider::new(&mut surface.smoothing_iterations, 0..=25)
        .clamping(SliderClamping::Edits)
        .text("smoothing");
    let iterations = ui.add(iterations).on_hover_text("Smoothing iterations of the surface");
    let spacing = state.scene.fluid.particle_spacing;
    let mut cell = surface.cell_size / spacing;
    let size = ui
        .add(Slider::new(&mut cell, 0.3..=1.5).clamping(SliderClamping::Edits).text("cell size"))
        .on_hover_text("Size of a marching-cubes cell in particle spacings: smaller is finer and slower");
    if size.changed() {
        surface.cell_size = decimal(cell * spacing, spacing);
    }
    let blob = Slider::new(&mut surface.min_blob, 0..=MAX_BLOB).clamping(SliderClamping::Edits);
    let blob = ui
        .add(blob.text("smallest blob"))
        .on_hover_text("Blobs of fewer particles are drawn as droplets and are not part of the surface");
    if size.changed() || iterations.changed() || blob.changed() {
        actions.push(Action::Change);
    }
}
