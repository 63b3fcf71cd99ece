//! The panels, without a device: clicks, keys and drags request the right actions.

mod editing;
mod layout;
mod playback;
mod requests;
mod words;

use egui::accesskit::Role;
use egui::vec2;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use splashdown::scene::{Scene, presets};
use splashdown_viewer::panels;
use splashdown_viewer::state::{Action, State};
use splashdown_viewer::timeline::Timeline;

/// The state, the actions requested, and the place of the picture.
type Both = (State, Vec<Action>, egui::Rect);

fn show(ui: &mut egui::Ui, (state, all, picture): &mut Both) {
    let (viewport, actions) = panels::show(ui, state, None);
    all.extend(actions);
    *picture = viewport.rect;
}

fn window(size: [f32; 2]) -> Harness<'static, Both> {
    let (name, text) = presets()[1];
    let state = State::new(Scene::parse(text, name).unwrap());
    let mut window = Harness::builder()
        .with_size(vec2(size[0], size[1]))
        .build_ui_state(show, (state, Vec::new(), egui::Rect::NOTHING));
    window.run_steps(3);
    window
}

fn wide() -> Harness<'static, Both> {
    window([1280.0, 800.0])
}

fn actions(window: &mut Harness<'_, Both>) -> Vec<Action> {
    window.run_steps(3);
    std::mem::take(&mut window.state_mut().1)
}

/// Clicks the button with this name, also in a menu that is named first.
fn click(window: &mut Harness<'_, Both>, path: &[&str]) {
    for label in path {
        window.get_by_role_and_label(Role::Button, label).click();
        window.run_steps(3);
    }
}

/// A window in which all settings are visible without scrolling.
fn with_settings() -> Harness<'static, Both> {
    let mut window = window([1280.0, 1600.0]);
    click(&mut window, &["Settings"]);
    assert!(window.state().0.shown.settings);
    window
}

/// The sizes at which the window must be usable: a usual one, a small screen, a phone, a narrow window, and phones that are
/// held across.
const SIZES: [[f32; 2]; 6] =
    [[1280.0, 800.0], [1024.0, 640.0], [390.0, 844.0], [520.0, 700.0], [844.0, 390.0], [667.0, 375.0]];

/// The sizes at which controls are large enough for fingers.
const TOUCH: [[f32; 2]; 4] = [SIZES[2], SIZES[3], SIZES[4], SIZES[5]];

/// The same window with a run that is played.
fn played(size: [f32; 2]) -> Harness<'static, Both> {
    let mut window = window(size);
    let mut timeline = Timeline::new((0..=100).collect(), 50.0).unwrap();
    (timeline.can_continue, timeline.playing, timeline.has_particles) = (true, false, false);
    window.state_mut().0.timeline = Some(timeline);
    window.run_steps(3);
    window
}

/// Every text that the window shows, except tooltips.
fn texts(window: &Harness<'_, Both>) -> Vec<String> {
    let nodes = window.root().children_recursive();
    nodes.filter_map(|node| node.accesskit_node().label()).collect()
}

/// The place of the area with this name.
fn area(window: &Harness<'_, Both>, name: &str) -> egui::Rect {
    window.ctx.memory(|memory| memory.area_rect(egui::Id::unique(name))).unwrap()
}
