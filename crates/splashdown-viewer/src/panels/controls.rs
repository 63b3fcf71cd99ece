//! The panel on the right: what the water is, what moves it, how it is computed and shown.

use egui::{CollapsingHeader, ComboBox, ScrollArea, Slider, SliderClamping, Ui};
use splashdown::scene::{ColourBy, MATERIALS, Method, SurfaceTension};
use splashdown_render::{Axis, ColourMap};

use super::gravity;
use crate::look::Way;
use crate::state::{Action, State};

/// Scenes that start with fewer particles do not get others by number.
const FEWEST: u64 = 20;

pub(super) fn show(ui: &mut Ui, state: &mut State, actions: &mut Vec<Action>) {
    ScrollArea::vertical().show(ui, |ui| {
        section(ui, "Fluid", |ui| fluid(ui, state, actions));
        section(ui, "Gravity", |ui| gravity::show(ui, state, actions));
        section(ui, "Play", |ui| play(ui, state, actions));
        section(ui, "Solver", |ui| solver(ui, state, actions));
        section(ui, "Look", |ui| look(ui, state, actions));
        section(ui, "Keep", |ui| keep(ui, state, actions));
    });
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
    // Where all water comes from emitters, the number at the start says nothing of the size of particles.
    let counted = state.counted;
    let wanted = ui
        .add_enabled(counted >= FEWEST, wanted)
        .on_hover_text(
            "About how many particles the scene starts with. More are finer and slower; the scene begins anew",
        )
        .on_disabled_hover_text("This scene begins without water: its emitters bring it");
    if wanted.drag_stopped() || (wanted.changed() && !wanted.dragged()) {
        let factor = (counted as f32 / state.particles_wanted).cbrt();
        state.scene.fluid.particle_spacing *= factor;
        state.scene.surface.cell_size *= factor;
        state.counted = splashdown::sample::count(&state.scene);
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
        .on_disabled_hover_text("Switched off: choose a model under Solver");
    changed |= tension.changed();
    if changed {
        actions.push(Action::Change);
    }
}

fn play(ui: &mut Ui, state: &mut State, actions: &mut Vec<Action>) {
    ui.horizontal_wrapped(|ui| {
        if ui.button("Drop a ball").on_hover_text("A ball of half the water's density (B)").clicked() {
            actions.push(Action::DropBall);
        }
        let tap = if state.pouring { "Close the tap" } else { "Open the tap" };
        if ui.button(tap).on_hover_text("A stream from above (P)").clicked() {
            actions.push(Action::Pour);
        }
    });
    ui.weak("Drop an OBJ, STL, PLY or glTF onto the window: it falls in.");
}

fn solver(ui: &mut Ui, state: &mut State, actions: &mut Vec<Action>) {
    let solver = &mut state.scene.solver;
    let mut changed = false;
    ComboBox::from_label("method").selected_text(name(solver.method)).show_ui(ui, |ui| {
        for method in [Method::Wcsph, Method::Mueller2003] {
            if ui.selectable_label(solver.method == method, name(method)).clicked() && solver.method != method
            {
                solver.method = method;
                solver.exponent = match method {
                    Method::Wcsph => 7.0,
                    Method::Mueller2003 => 1.0,
                };
                // Each method has a model of its own.
                if solver.surface_tension != SurfaceTension::None {
                    solver.surface_tension = tension_of(method);
                }
                changed = true;
            }
        }
    });
    let mut tension = solver.surface_tension != SurfaceTension::None;
    let box_of_tension = ui.checkbox(&mut tension, "with surface tension").on_hover_text(
        "Akinci, Akinci and Teschner 2013, or Müller, Charypar and Gross 2003: makes drops and films",
    );
    if box_of_tension.changed() {
        solver.surface_tension = if tension { tension_of(solver.method) } else { SurfaceTension::None };
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
        "Factor alpha of Monaghan's artificial viscosity: 0 splashes and rattles, 0.1 is calm",
    );
    slider(
        &mut solver.wall_friction,
        0.0..=1.0,
        "wall friction",
        "0: water slips along walls, 1: it sticks to them",
    );
    if changed {
        actions.push(Action::Change);
    }
}

fn tension_of(method: Method) -> SurfaceTension {
    match method {
        Method::Wcsph => SurfaceTension::Akinci2013,
        Method::Mueller2003 => SurfaceTension::ColourField,
    }
}

fn name(method: Method) -> &'static str {
    match method {
        Method::Wcsph => "wcsph (weakly compressible)",
        Method::Mueller2003 => "mueller2003 (the thesis's)",
    }
}

fn look(ui: &mut Ui, state: &mut State, actions: &mut Vec<Action>) {
    let foam = ui.checkbox(&mut state.scene.foam.enabled, "Foam and spray").on_hover_text(
        "What a splash makes beside water: spray in the air, foam on it, bubbles in it (Ihmsen et al. 2012)",
    );
    if foam.changed() {
        actions.push(Action::Change);
    }
    let look = &mut state.look;
    if look.way.has_colours() {
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
        if look.way == Way::Slice {
            ui.horizontal(|ui| {
                for (axis, name) in [(Axis::X, "x"), (Axis::Y, "y"), (Axis::Z, "z")] {
                    ui.selectable_value(&mut look.slice_axis, axis, name);
                }
                ui.add(
                    Slider::new(&mut look.slice_at, 0.0..=1.0).clamping(SliderClamping::Edits).text("where"),
                );
            });
        }
    } else if look.way.needs_surface() {
        let surface = &mut state.scene.surface;
        let rounds = Slider::new(&mut surface.smoothing_iterations, 0..=25)
            .clamping(SliderClamping::Edits)
            .text("smoothing");
        let rounds = ui.add(rounds).on_hover_text("Rounds of smoothing of the mesh");
        let spacing = state.scene.fluid.particle_spacing;
        let mut cell = surface.cell_size / spacing;
        let size = ui
            .add(Slider::new(&mut cell, 0.3..=1.5).clamping(SliderClamping::Edits).text("cell"))
            .on_hover_text(
                "Size of a cell of marching cubes, in particle spacings: smaller is finer and slower",
            );
        if size.changed() {
            surface.cell_size = cell * spacing;
        }
        if size.changed() || rounds.changed() {
            actions.push(Action::Change);
        }
    }
}

fn keep(ui: &mut Ui, state: &State, actions: &mut Vec<Action>) {
    ui.horizontal_wrapped(|ui| {
        for (text, hint, action) in [
            ("Picture", "Write the picture as PNG (T)", Action::Screenshot),
            ("Scene", "Write the scene as it is set now, for the command line (Ctrl + S)", Action::SaveScene),
            (
                "Checkpoint",
                "Keep the fluid as it is, to go on with it here or by the command line (K); drop the file here to go on",
                Action::SaveCheckpoint,
            ),
            ("Mesh", "Write the surface as a closed mesh, PLY (M)", Action::SaveMesh),
        ] {
            if ui.button(text).on_hover_text(hint).clicked() {
                actions.push(action);
            }
        }
        // Only a page has an address.
        if cfg!(target_arch = "wasm32")
            && ui.button("Link").on_hover_text("A link that opens the scene as it is set now").clicked()
        {
            actions.push(Action::Share);
        }
    });
    if cfg!(target_arch = "wasm32") {
        return;
    }
    let text = match state.recorded {
        Some(frames) => format!("End the film ({frames} pictures)"),
        None => "Film".to_owned(),
    };
    let hint = "A picture of every frame of the scene, and a film if ffmpeg is installed. The water moves frame by frame then, \
                however long each takes";
    if ui.button(text).on_hover_text(hint).clicked() {
        actions.push(Action::Record);
    }
}
