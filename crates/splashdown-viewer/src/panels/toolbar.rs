//! The toolbar: scene, clock, tool, view, settings and more, in one row at every width.

use egui::containers::menu::MenuButton;
use egui::{Button, DragValue, Popup, Ui, vec2};

use super::{change, icons, more, touch};
use crate::look::DisplayMode;
use crate::state::{Action, State, Tool};

/// Below this width, in points, buttons show icons without words, and the time scale is in the menu.
const WORDS: f32 = 700.0;
/// Length of the longest name of a scene in the toolbar, in characters.
const NAME: usize = 22;
/// The same in a narrow window.
const SHORT_NAME: usize = 9;

pub(super) fn show(ui: &mut Ui, state: &mut State, actions: &mut Vec<Action>) {
    touch::enlarge(ui);
    let has_words = ui.available_width() >= WORDS;
    ui.horizontal(|ui| {
        if !has_words {
            ui.spacing_mut().item_spacing.x = 4.0;
        }
        let name = shortened(&state.scene.name, if has_words { NAME } else { SHORT_NAME });
        let scene = Button::new(format!("{} {name}", icons::SCENE)).selected(state.shown.gallery);
        let scene = ui.add(scene).on_hover_text("Scenes: choose a scene (G)");
        icons::named(&scene, "Scenes", state.shown.gallery);
        if scene.clicked() {
            state.shown.gallery = !state.shown.gallery;
            actions.push(Action::ShowFiles);
        }
        ui.separator();
        // A run that is played has these below the picture.
        if state.timeline.is_none() {
            clock(ui, state, actions, has_words);
            ui.separator();
            tools(ui, state, actions, has_words);
        }
        views(ui, state, has_words);
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            more::show(ui, state, actions, has_words);
            let hint = "Fluid, gravity, solver and display (C)";
            if icons::toggle(ui, icons::SETTINGS, "Settings", hint, state.shown.settings).clicked() {
                state.shown.settings = !state.shown.settings;
            }
        });
    });
}

/// What controls a simulation.
fn clock(ui: &mut Ui, state: &mut State, actions: &mut Vec<Action>, has_words: bool) {
    let (icon, name) = if state.playing { (icons::PAUSE, "Pause") } else { (icons::PLAY, "Play") };
    if icons::button(ui, icon, name, "Space").clicked() {
        actions.push(Action::Play(!state.playing));
    }
    if icons::button(ui, icons::STEP, "Step", "Simulate one frame of the scene (.)").clicked() {
        actions.push(Action::Step);
    }
    if icons::button(ui, icons::RESTART, "Restart", "At time 0, with the changes (R)").clicked() {
        actions.push(Action::Restart);
    }
    if has_words {
        time_scale(ui, state, actions);
    }
}

/// The time scale of a simulation.
pub(super) fn time_scale(ui: &mut Ui, state: &mut State, actions: &mut Vec<Action>) {
    let scale = DragValue::new(&mut state.time_scale)
        .range(0.05..=4.0)
        .clamp_existing_to_range(true)
        .speed(0.02)
        .max_decimals(2)
        .prefix("time scale ")
        .suffix(" x");
    let scale = ui.add(scale).on_hover_text(
        "Simulated seconds per second: drag, or click to type. If the machine is too slow, the simulation runs slower; the \
         window stays responsive",
    );
    if scale.changed() {
        actions.push(Action::TimeScale);
    }
}

fn tools(ui: &mut Ui, state: &mut State, actions: &mut Vec<Action>, has_words: bool) {
    let tool = state.tool;
    let text = if has_words { format!("{} {}", icon(tool), tool.name()) } else { icon(tool).to_owned() };
    let (response, _) =
        MenuButton::from_button(Button::new(text).min_size(vec2(icons::WIDTH, 0.0))).ui(ui, |ui| {
            for tool in Tool::ALL {
                let button =
                    Button::selectable(state.tool == tool, format!("{} {}", icon(tool), tool.name()));
                let response = ui.add(button).on_hover_text(tool.hint());
                icons::named(&response, tool.name(), state.tool == tool);
                if response.clicked() {
                    let before = std::mem::replace(&mut state.tool, tool);
                    if tool == Tool::Edit && before != tool {
                        change::start_again(state, actions);
                    }
                }
            }
        });
    described(&response, "Tool", &format!("{}. {}", tool.name(), tool.hint()));
}

fn views(ui: &mut Ui, state: &mut State, has_words: bool) {
    let mode = state.look.mode;
    let text = if has_words { format!("{} {}", icons::VIEW, mode.name()) } else { icons::VIEW.to_owned() };
    let (response, _) =
        MenuButton::from_button(Button::new(text).min_size(vec2(icons::WIDTH, 0.0))).ui(ui, |ui| {
            for (number, mode) in DisplayMode::ALL.into_iter().enumerate() {
                let is_possible = state.timeline.as_ref().is_none_or(|timeline| {
                    if mode.needs_surface() { timeline.has_meshes } else { timeline.has_particles }
                });
                let text = format!("{}  {}", number + 1, mode.name());
                let button = Button::selectable(state.look.mode == mode, text);
                let response = ui
                    .add_enabled(is_possible, button)
                    .on_hover_text(mode.hint())
                    .on_disabled_hover_text("The run has no files for this view");
                icons::named(&response, mode.name(), state.look.mode == mode);
                if response.clicked() {
                    state.look.mode = mode;
                }
            }
        });
    described(&response, "View", &format!("{}. {}", mode.name(), mode.hint()));
}

/// The name and the hint of a button with a menu. The hint would cover the open menu.
pub(super) fn described(response: &egui::Response, name: &str, hint: &str) {
    icons::named(response, name, false);
    if !Popup::is_id_open(&response.ctx, Popup::default_response_id(response)) {
        response.clone().on_hover_text(format!("{name}: {hint}"));
    }
}

fn icon(tool: Tool) -> &'static str {
    match tool {
        Tool::Orbit => icons::ORBIT,
        Tool::Drag => icons::DRAG,
        Tool::Tilt => icons::TILT,
        Tool::Shake => icons::SHAKE,
        Tool::Edit => icons::EDIT,
    }
}

/// A name of at most this many characters.
fn shortened(name: &str, limit: usize) -> String {
    if name.chars().count() <= limit {
        return name.to_owned();
    }
    name.chars().take(limit - 1).chain(['…']).collect()
}
