//! Buttons, keys and drags request their actions.

use super::{Both, actions, click, wide, with_settings};
use egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use glam::Vec3;
use splashdown::scene::{ColourBy, Method, Scene};
use splashdown_viewer::look::DisplayMode;
use splashdown_viewer::state::{Action, Tool};

#[test]
fn buttons_request_their_actions() {
    let mut window = wide();
    assert_eq!(actions(&mut window), []);
    for (path, action) in [
        (&["Pause"][..], Action::Play(false)),
        (&["Step"], Action::Step),
        (&["Restart"], Action::Restart),
        (&["Scenes"], Action::ShowFiles),
        (&["More", "Discard changes"], Action::DiscardChanges),
        (&["More", "Save scene"], Action::SaveScene),
        (&["More", "Export picture"], Action::ExportPicture),
        (&["More", "Export surface"], Action::ExportSurface),
        (&["More", "Export checkpoint"], Action::ExportCheckpoint),
        (&["More", "Export film"], Action::Record),
        (&["More", "Light or dark"], Action::SwapTheme),
        (&["Settings", "Add ball"], Action::Change),
        (&["Add emitter"], Action::Change),
        (&["Remove emitter"], Action::Change),
    ] {
        click(&mut window, path);
        assert_eq!(actions(&mut window), [action], "{path:?}");
    }
    let mut window = with_settings();
    click(&mut window, &["Tool", "Drag"]);
    click(&mut window, &["View", "Particles"]);
    assert_eq!((window.state().0.tool, window.state().0.look.mode), (Tool::Drag, DisplayMode::Particles));
    window.get_by_label("density").click();
    window.run_steps(2);
    assert_eq!(window.state().0.look.colour_by, ColourBy::Density);
}

#[test]
fn the_ring_of_the_mouse_force_follows_the_pointer() {
    let circles = |tool: Tool| {
        let mut window = wide();
        window.state_mut().0.tool = tool;
        window.hover_at(egui::pos2(400.0, 400.0));
        window.run_steps(2);
        let shapes = &window.output().shapes;
        let at = |shape: &egui::epaint::ClippedShape| match &shape.shape {
            egui::Shape::Circle(circle) if circle.center == egui::pos2(400.0, 400.0) => Some(circle.radius),
            _ => None,
        };
        shapes.iter().filter_map(at).collect::<Vec<_>>()
    };
    let drawn = circles(Tool::Drag);
    assert!(drawn.len() == 2 && drawn[0] > 10.0, "{drawn:?}");
    assert_eq!(circles(Tool::Orbit), [0.0; 0]);
}

#[test]
fn foam_belongs_to_the_scene_and_is_exported_with_it() {
    let mut window = with_settings();
    window.state_mut().0.scene.foam.enabled = false;
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
        (Key::B, Action::Change),
        (Key::P, Action::Change),
        (Key::T, Action::ExportPicture),
        (Key::M, Action::ExportSurface),
        (Key::K, Action::ExportCheckpoint),
    ] {
        window.key_press(key);
        assert_eq!(actions(&mut window), [action], "{key:?}");
    }
    window.key_press_modifiers(Modifiers::COMMAND, Key::S);
    assert_eq!(actions(&mut window), [Action::SaveScene]);
    // The help opens and closes, and lists the keys above.
    assert!(window.query_by_label("add a ball").is_none());
    window.key_press(Key::H);
    window.run_steps(3);
    assert!(window.query_by_label("add a ball").is_some());
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
    let mut window = with_settings();
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
fn dragging_orbits_the_camera_or_moves_the_fluid() {
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
    assert_eq!(window.state().0.orbit, after, "dragging the fluid moved the camera");
}
