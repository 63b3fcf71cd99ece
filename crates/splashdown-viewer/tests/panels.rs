//! The panels, without a device: clicks, keys and drags request the right actions.

use egui::{Key, Modifiers, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use glam::Vec3;
use splashdown::scene::{ColourBy, Method, Scene, presets};
use splashdown_viewer::look::DisplayMode;
use splashdown_viewer::panels;
use splashdown_viewer::state::{Action, State, Tool};

type Both = (State, Vec<Action>);

fn window(size: [f32; 2]) -> Harness<'static, Both> {
    let (name, text) = presets()[1];
    let state = State::new(Scene::parse(text, name).unwrap());
    let show = |ui: &mut egui::Ui, (state, all): &mut Both| {
        let (_, actions) = panels::show(ui, state, None);
        all.extend(actions);
    };
    let mut window =
        Harness::builder().with_size(vec2(size[0], size[1])).build_ui_state(show, (state, Vec::new()));
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

#[test]
fn buttons_request_their_actions() {
    let mut window = wide();
    assert_eq!(actions(&mut window), []);
    for (label, action) in [
        ("Pause", Action::Play(false)),
        ("Step", Action::Step),
        ("Restart", Action::Restart),
        ("Reset", Action::Reset),
        ("Drop a ball", Action::DropBall),
        ("Open the tap", Action::Pour),
        ("Picture", Action::Screenshot),
        ("Scene", Action::SaveScene),
        ("Film", Action::Record),
        ("Theme", Action::SwapTheme),
    ] {
        window.get_by_label(label).click();
        assert_eq!(actions(&mut window), [action], "{label}");
    }
    window.get_by_label("Drag").click();
    window.get_by_label("Particles").click();
    window.run_steps(2);
    assert_eq!((window.state().0.tool, window.state().0.look.mode), (Tool::Drag, DisplayMode::Particles));
    window.get_by_label("density").click();
    window.run_steps(2);
    assert_eq!(window.state().0.look.colour_by, ColourBy::Density);
}

#[test]
fn foam_belongs_to_the_scene_and_is_exported_with_it() {
    let mut window = wide();
    assert!(!window.state().0.scene.foam.enabled);
    window.get_by_label("Foam and spray").click();
    assert_eq!(actions(&mut window), [Action::Change]);
    let state = &window.state().0;
    assert!(state.scene.foam.enabled);
    let text = splashdown_viewer::save::scene(&state.scene, &state.orbit).unwrap();
    assert!(Scene::parse(&text, "exported.toml").unwrap().foam.enabled, "{text}");
}

#[test]
fn keys_request_the_actions_in_the_help() {
    let mut window = wide();
    for (key, action) in [
        (Key::Space, Action::Play(false)),
        (Key::Period, Action::Step),
        (Key::R, Action::Restart),
        (Key::B, Action::DropBall),
        (Key::P, Action::Pour),
        (Key::T, Action::Screenshot),
        (Key::M, Action::SaveMesh),
    ] {
        window.key_press(key);
        assert_eq!(actions(&mut window), [action], "{key:?}");
    }
    window.key_press_modifiers(Modifiers::COMMAND, Key::S);
    assert_eq!(actions(&mut window), [Action::SaveScene]);
    // The help opens and closes, and lists the keys above.
    assert!(window.query_by_label("drop a ball").is_none());
    window.key_press(Key::H);
    window.run_steps(3);
    assert!(window.query_by_label("drop a ball").is_some());
    window.key_press(Key::Escape);
    window.run_steps(3);
    assert!(!window.state().0.shown.help);
    for (number, mode) in
        [Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::Num5].into_iter().zip(DisplayMode::ALL)
    {
        window.key_press(number);
        window.run_steps(2);
        assert_eq!(window.state().0.look.mode, mode);
    }
}

#[test]
fn changing_the_solver_changes_its_models() {
    let mut window = wide();
    window.get_by_label("with surface tension").click();
    assert_eq!(actions(&mut window), [Action::Change]);
    let before = window.state().0.scene.solver.clone();
    window.get_by_label("method").click();
    window.run_steps(3);
    window.get_by_label("mueller2003 (the original thesis)").click();
    assert_eq!(actions(&mut window), [Action::Change]);
    let after = &window.state().0.scene.solver;
    assert_eq!(after.method, Method::Mueller2003);
    assert_ne!(after.surface_tension, before.surface_tension);
    assert_eq!(after.exponent, 1.0);
}

#[test]
fn dragging_orbits_the_camera_or_moves_the_water() {
    let mut window = wide();
    let drag = |window: &mut Harness<'_, Both>| {
        window.drag_at(egui::pos2(300.0, 300.0));
        window.run_steps(2);
        for step in 1..=4 {
            window.hover_at(egui::pos2(300.0 + 15.0 * step as f32, 300.0 + 5.0 * step as f32));
            window.run_steps(1);
        }
    };
    let before = window.state().0.orbit;
    drag(&mut window);
    window.drop_at(egui::pos2(360.0, 320.0));
    assert_eq!(actions(&mut window), []);
    let after = window.state().0.orbit;
    assert!(after.azimuth != before.azimuth && after.elevation > before.elevation, "{after:?}");

    window.state_mut().0.tool = Tool::Drag;
    drag(&mut window);
    let dragged = actions(&mut window);
    let Some(Action::Drag { velocity, .. }) = dragged
        .iter()
        .find(|action| matches!(action, Action::Drag { velocity, .. } if *velocity != Vec3::ZERO))
    else {
        panic!("{dragged:?}")
    };
    // The velocity points to the right of the picture.
    assert!(velocity.dot(after.axes()[0]) > 0.0, "{velocity}");
    window.drop_at(egui::pos2(360.0, 320.0));
    assert!(actions(&mut window).contains(&Action::Release));
    assert_eq!(window.state().0.orbit, after, "dragging water moved the camera");
}

#[test]
fn a_narrow_window_starts_with_hidden_controls() {
    let mut window = window([400.0, 700.0]);
    assert!(window.state().0.shown.bare);
    assert!(window.query_by_label("Drop a ball").is_none());
    window.get_by_label("Controls").click();
    window.run_steps(3);
    assert!(window.query_by_label("Drop a ball").is_some());
}

#[test]
fn errors_remain_and_messages_disappear() {
    let mut window = wide();
    window.state_mut().0.notify("nothing is left", true, 0.0);
    window.state_mut().0.notify("the picture is in a.png", false, -100.0);
    window.run_steps(3);
    assert!(window.query_by_label("nothing is left").is_some());
    assert!(window.query_by_label("the picture is in a.png").is_none());
    window.get_by_label("close").click();
    window.run_steps(3);
    assert!(window.query_by_label("nothing is left").is_none());
}

#[test]
fn a_scene_without_water_at_the_start_keeps_its_spacing() {
    let text = presets().iter().find(|(name, _)| *name == "knot").unwrap().1;
    let state = State::new(Scene::parse(text, "knot").unwrap());
    let spacing = state.scene.fluid.particle_spacing;
    let show = |ui: &mut egui::Ui, (state, all): &mut Both| all.extend(panels::show(ui, state, None).1);
    let mut window =
        Harness::builder().with_size(vec2(1280.0, 800.0)).build_ui_state(show, (state, Vec::new()));
    drag_count(&mut window);
    assert_eq!(actions(&mut window), []);
    assert_eq!(window.state().0.scene.fluid.particle_spacing, spacing);
    // Control: the slider works in a scene that starts with water.
    let mut other = wide();
    drag_count(&mut other);
    assert!(actions(&mut other).contains(&Action::Restart));
}

#[test]
fn the_button_of_the_tap_follows_the_scene() {
    let (name, text) = presets()[1];
    let emitter = |name: &str| {
        format!(
            "{text}\n[[emitter]]\nname = \"{name}\"\nradius = 0.1\nposition = [0.5, 0.5, 0.5]\ndirection = [0, -1, 0]\nspeed = 1\n"
        )
    };
    for (emitter_name, is_open) in [("tap", true), ("inlet", false)] {
        let mut state = State::new(Scene::parse(&emitter(emitter_name), name).unwrap());
        assert_eq!(state.pouring, is_open, "{emitter_name}");
        // A scene opened later, as from a checkpoint.
        state.open(Scene::parse(text, name).unwrap());
        assert!(!state.pouring);
        state.open(Scene::parse(&emitter(emitter_name), name).unwrap());
        assert_eq!(state.pouring, is_open, "{emitter_name}");
    }
}

/// Drags the slider of the number of particles.
fn drag_count(window: &mut Harness<'_, Both>) {
    let y = window.get_all_by_label("Fluid").last().unwrap().rect().center().y + 23.0;
    window.drag_at(egui::pos2(1000.0, y));
    for x in [1020.0, 1040.0, 1060.0] {
        window.hover_at(egui::pos2(x, y));
        window.run_steps(1);
    }
    window.drop_at(egui::pos2(1060.0, y));
}
