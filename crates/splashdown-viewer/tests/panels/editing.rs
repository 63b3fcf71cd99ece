//! Changing the scene: emitters, bodies and blocks of fluid.

use super::{Both, actions, area, click, show, wide, with_settings};
use egui::accesskit::Role;
use egui::{Key, Modifiers, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use glam::Vec3;
use splashdown::scene::{Scene, presets};
use splashdown_viewer::items::Item;
use splashdown_viewer::state::{Action, State, Tool};

#[test]
fn each_added_thing_is_one_step_of_undo() {
    let mut window = wide();
    click(&mut window, &["Tool", "Edit"]);
    window.key_press(Key::B);
    assert_eq!(actions(&mut window), [Action::Restart, Action::Restart]);
    let bodies = |window: &Harness<'_, Both>| window.state().0.scene.bodies.clone();
    let emitters = |window: &Harness<'_, Both>| window.state().0.scene.emitters.len();
    let first = bodies(&window);
    window.key_press(Key::P);
    window.run_steps(2);
    window.key_press(Key::B);
    window.run_steps(2);
    assert_eq!((bodies(&window).len(), emitters(&window)), (2, 1));
    for (count, emitter_count) in [(1, 1), (1, 0), (0, 0)] {
        window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
        window.run_steps(2);
        assert_eq!((bodies(&window).len(), emitters(&window)), (count, emitter_count));
    }
    window.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    window.run_steps(2);
    assert_eq!(bodies(&window), first);
    // With another tool the simulation goes on, and the step is there later.
    actions(&mut window);
    window.state_mut().0.tool = Tool::Orbit;
    window.key_press(Key::B);
    assert_eq!(actions(&mut window), [Action::Change]);
    click(&mut window, &["Tool", "Edit"]);
    click(&mut window, &["Undo"]);
    assert_eq!(bodies(&window), first);
}

/// The number of lines that the picture shows over the fluid: boxes and handles.
fn lines(window: &Harness<'_, Both>) -> usize {
    let picture = window.state().2;
    let is_line = |shape: &&egui::epaint::ClippedShape| {
        shape.clip_rect == picture && matches!(shape.shape, egui::Shape::LineSegment { .. })
    };
    window.output().shapes.iter().filter(is_line).count()
}

#[test]
fn boxes_and_handles_are_shown_at_time_0_only() {
    let mut window = wide();
    click(&mut window, &["Tool", "Edit"]);
    window.state_mut().0.selected = Some(Item::Block(0));
    window.run_steps(2);
    actions(&mut window);
    assert!(lines(&window) >= 12, "{}", lines(&window));
    window.key_press(Key::Space);
    assert_eq!(actions(&mut window), [Action::Play(true)]);
    // As the app does then.
    (window.state_mut().0.playing, window.state_mut().0.figures.time) = (true, 0.25);
    window.run_steps(2);
    assert_eq!(lines(&window), 0);
    // A handle cannot be grabbed, also while paused later.
    window.state_mut().0.playing = false;
    let (middle, offset, from) = handle(&window);
    let (before, orbit) = (window.state().0.scene.clone(), window.state().0.orbit);
    window.drag_at(from);
    window.run_steps(1);
    let to = seen(&window, middle + Vec3::X * (offset + 0.1));
    for part in [0.5, 1.0] {
        window.hover_at(from + part * (to - from));
        window.run_steps(1);
    }
    window.drop_at(to);
    window.run_steps(2);
    assert_eq!(window.state().0.scene, before);
    assert_ne!(window.state().0.orbit, orbit);
    // The dialog leads back to time 0.
    let dialog = area(&window, "Edit");
    let back = window.query_all_by_label("Restart").find(|node| dialog.contains_rect(node.rect()));
    back.unwrap().click();
    assert_eq!(actions(&mut window), [Action::Restart]);
    window.state_mut().0.figures.time = 0.0;
    window.run_steps(2);
    assert!(lines(&window) >= 12);
}

#[test]
fn an_emitter_has_fields_for_direction_and_size() {
    let mut window = wide();
    click(&mut window, &["Tool", "Edit"]);
    click(&mut window, &["Add emitter"]);
    click(&mut window, &["Add emitter"]);
    assert_eq!(window.state().0.scene.emitters.len(), 2);
    assert_eq!(window.state().0.selected, Some(Item::Emitter(1)));
    for label in ["position", "radius", "direction", "speed"] {
        assert!(window.query_by_role_and_label(Role::Label, label).is_some(), "{label}");
    }
    // A drag of the first number of the direction turns the outflow, and its length remains 1.
    actions(&mut window);
    let row = window.get_by_role_and_label(Role::Label, "direction").rect();
    let field = row.right_center() + vec2(24.0, 0.0);
    window.drag_at(field);
    for step in 1..=4 {
        window.hover_at(field + vec2(10.0 * step as f32, 0.0));
        window.run_steps(1);
    }
    window.drop_at(field + vec2(40.0, 0.0));
    assert_eq!(actions(&mut window), [Action::Restart]);
    let direction = window.state().0.scene.emitters[1].direction;
    assert!(direction.x > 0.1 && direction.is_normalized(), "{direction}");
    // Control: a block has none of them.
    window.state_mut().0.selected = Some(Item::Block(0));
    window.run_steps(2);
    let has = |label: &str| window.query_by_role_and_label(Role::Label, label).is_some();
    assert!(!has("direction") && (has("size") || has("radius")));
}

#[test]
fn a_scene_without_fluid_at_the_start_keeps_its_spacing() {
    let text = presets().iter().find(|(name, _)| *name == "knot").unwrap().1;
    let state = State::new(Scene::parse(text, "knot").unwrap());
    let spacing = state.scene.fluid.particle_spacing;
    let mut window = Harness::builder()
        .with_size(vec2(1280.0, 800.0))
        .build_ui_state(show, (state, Vec::new(), egui::Rect::NOTHING));
    click(&mut window, &["Settings"]);
    drag_count(&mut window);
    assert_eq!(actions(&mut window), []);
    assert_eq!(window.state().0.scene.fluid.particle_spacing, spacing);
    // Control: the slider works in a scene that starts with fluid.
    let mut other = with_settings();
    drag_count(&mut other);
    assert!(actions(&mut other).contains(&Action::Restart));
}

#[test]
fn the_button_of_the_emitter_follows_the_scene() {
    let (name, text) = presets()[1];
    let emitter = |name: &str| {
        format!(
            "{text}\n[[emitter]]\nname = \"{name}\"\nradius = 0.1\nposition = [0.5, 0.5, 0.5]\ndirection = [0, -1, 0]\nspeed = 1\n"
        )
    };
    let mut window = with_settings();
    for (emitter_name, is_added) in [("emitter-1", true), ("inlet", false)] {
        for (text, is_removed) in [(emitter(emitter_name), is_added), (text.to_owned(), false)] {
            // A scene opened later, as from a checkpoint.
            window.state_mut().0.open(Scene::parse(&text, name).unwrap());
            window.run_steps(3);
            let found = ["Remove emitter", "Add emitter"].map(|label| window.query_by_label(label).is_some());
            assert_eq!(found, [is_removed, !is_removed], "{emitter_name}");
        }
    }
}

/// The place of a point of the scene in the window.
fn seen(window: &Harness<'_, Both>, point: Vec3) -> egui::Pos2 {
    let (state, _, picture) = window.state();
    let camera = state.orbit.camera(picture.width() / picture.height());
    let size = [picture.width() as u32, picture.height() as u32];
    let [x, y] = camera.project(point.into(), size).unwrap().unwrap();
    picture.min + vec2(x, y)
}

/// The middle of the first block, the offset of a place on its handle of the x axis in m, and the place in the window.
fn handle(window: &Harness<'_, Both>) -> (Vec3, f32, egui::Pos2) {
    let (state, _, picture) = window.state();
    let (low, high) = state.scene.fluid.blocks[0].shape.bounds();
    let middle = 0.5 * (low + high);
    let offset = 50.0 * state.orbit.metres_per_point(glam::Vec2::new(picture.width(), picture.height()));
    (middle, offset, seen(window, middle + Vec3::X * offset))
}

/// Clicks a place in the picture.
fn click_at(window: &mut Harness<'_, Both>, at: egui::Pos2) {
    window.drag_at(at);
    window.run_steps(1);
    window.drop_at(at);
    window.run_steps(2);
}

#[test]
fn things_are_selected_moved_removed_and_restored() {
    let mut window = wide();
    click(&mut window, &["Tool", "Edit"]);
    assert_eq!(actions(&mut window), [Action::Restart]);
    assert!(!window.state().0.playing);
    let shape = |window: &Harness<'_, Both>| window.state().0.scene.fluid.blocks[0].shape;
    let (before, orbit) = (shape(&window), window.state().0.orbit);
    let (middle, offset, from) = handle(&window);
    click_at(&mut window, egui::pos2(1200.0, 100.0));
    assert_eq!(window.state().0.selected, None);
    let at = seen(&window, middle);
    click_at(&mut window, at);
    assert_eq!(window.state().0.selected, Some(Item::Block(0)));
    let to = seen(&window, middle + Vec3::X * (offset + 0.1));
    window.drag_at(from);
    window.run_steps(1);
    for part in [0.25, 0.5, 0.75, 1.0] {
        window.hover_at(from + part * (to - from));
        window.run_steps(1);
    }
    let moved = shape(&window).bounds().0 - before.bounds().0;
    assert!((moved - Vec3::X * 0.1).length() < 0.01, "{moved}");
    assert_eq!(window.state().1, [], "the simulation starts again during the move");
    window.drop_at(to);
    assert_eq!(actions(&mut window), [Action::Restart]);
    assert_eq!(window.state().0.orbit, orbit, "moving a block moved the camera");
    let after = shape(&window);
    click(&mut window, &["Undo"]);
    assert_eq!((actions(&mut window), shape(&window)), (vec![Action::Restart], before));
    window.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert_eq!((actions(&mut window), shape(&window)), (vec![Action::Restart], after));
    window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    assert_eq!((actions(&mut window), shape(&window)), (vec![Action::Restart], before));
    // Added, removed by the key, and restored.
    click(&mut window, &["Add block"]);
    assert_eq!(actions(&mut window), [Action::Restart]);
    assert_eq!(window.state().0.selected, Some(Item::Block(1)));
    window.key_press(Key::Delete);
    assert_eq!(actions(&mut window), [Action::Restart]);
    assert_eq!((window.state().0.scene.fluid.blocks.len(), window.state().0.selected), (1, None));
    click(&mut window, &["Undo"]);
    assert_eq!(window.state().0.scene.fluid.blocks.len(), 2);
    let state = &window.state().0;
    let text = splashdown_viewer::save::scene(&state.scene, &state.orbit).unwrap();
    assert_eq!(Scene::parse(&text, "edited.toml").unwrap().fluid.blocks, state.scene.fluid.blocks);
}

#[test]
fn a_block_cannot_be_moved_out_of_the_domain() {
    let mut window = wide();
    click(&mut window, &["Tool", "Edit"]);
    window.state_mut().0.selected = Some(Item::Block(0));
    window.run_steps(1);
    let (middle, offset, from) = handle(&window);
    let domain = window.state().0.scene.domain.clone();
    let to = seen(&window, middle + Vec3::X * (offset + 2.0 * domain.size().x));
    window.drag_at(from);
    window.run_steps(1);
    for part in [0.1, 0.5, 1.0] {
        window.hover_at(from + part * (to - from));
        window.run_steps(1);
    }
    window.drop_at(to);
    window.run_steps(2);
    let right = window.state().0.scene.fluid.blocks[0].shape.bounds().1.x;
    assert!((right - domain.max.x).abs() < 1e-4, "{right}");
}

/// Drags the slider of the number of particles.
fn drag_count(window: &mut Harness<'_, Both>) {
    let slider = window.get_all_by_role(Role::Slider).next().unwrap().rect();
    let at = |part: f32| egui::pos2(slider.left() + part * slider.width(), slider.center().y);
    window.drag_at(at(0.2));
    for part in [0.3, 0.4, 0.5] {
        window.hover_at(at(part));
        window.run_steps(1);
    }
    window.drop_at(at(0.5));
}
