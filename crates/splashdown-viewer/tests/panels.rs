//! The panels, without a device: clicks, keys and drags request the right actions.

use egui::accesskit::Role;
use egui::{Key, Modifiers, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use glam::Vec3;
use splashdown::scene::{ColourBy, Method, Scene, presets};
use splashdown_viewer::items::Item;
use splashdown_viewer::look::DisplayMode;
use splashdown_viewer::panels;
use splashdown_viewer::state::{Action, State, Tool};
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

/// The sizes at which the window must be usable: a usual one, a small screen, a phone, a narrow window, and phones that are
/// held across.
const SIZES: [[f32; 2]; 6] =
    [[1280.0, 800.0], [1024.0, 640.0], [390.0, 844.0], [520.0, 700.0], [844.0, 390.0], [667.0, 375.0]];
/// The sizes at which controls are large enough for fingers.
const TOUCH: [[f32; 2]; 4] = [SIZES[2], SIZES[3], SIZES[4], SIZES[5]];

#[test]
fn dialogs_do_not_cover_the_toolbar_or_the_status_line() {
    for size in SIZES {
        for title in ["Scenes", "Settings", "Help", "Statistics", "Edit"] {
            let mut window = window(size);
            let shown = &mut window.state_mut().0.shown;
            match title {
                "Scenes" => shown.gallery = true,
                "Settings" => shown.settings = true,
                "Help" => shown.help = true,
                "Edit" => window.state_mut().0.tool = Tool::Edit,
                _ => (shown.statistics, shown.timings) = (true, true),
            }
            window.run_steps(6);
            let area = window.ctx.memory(|memory| memory.area_rect(egui::Id::unique(title))).unwrap();
            let picture = window.state().2;
            assert!(
                picture.contains_rect(area),
                "{title} at {size:?}: {area:?} outside the picture {picture:?}"
            );
            assert!(area.area() > 1000.0, "{title} at {size:?}: {area:?}");
        }
    }
}

#[test]
fn the_toolbar_and_the_status_line_have_one_row_at_every_size() {
    for size in SIZES {
        let mut window = window(size);
        window.state_mut().0.scene.name = "a-scene-with-quite-a-long-name".to_owned();
        let figures = &mut window.state_mut().0.figures;
        // The longest texts.
        (figures.particles, figures.triangles, figures.time) = (123_456_789, Some(123_456_789), 1234.567);
        (figures.steps_per_second, figures.frames_per_second) = (99_999.0, 999.0);
        figures.device =
            "a device with a name that is longer than the line, and then some more words".to_owned();
        window.run_steps(6);
        let picture = window.state().2;
        // The harness has a margin of eight points.
        let (toolbar, status) = (picture.top() - 8.0, size[1] - 8.0 - picture.bottom());
        let is_touch = TOUCH.contains(&size);
        assert!(toolbar < if is_touch { 44.0 } else { 32.0 } && status < 30.0, "{size:?}: {picture:?}");
        assert_eq!(picture.width(), size[0] - 16.0);
        // Every button of the toolbar is inside the window, and none covers another.
        let names = ["Scenes", "Pause", "Step", "Restart", "Tool", "View", "Settings", "More"];
        let rects = names.map(|name| window.get_by_role_and_label(Role::Button, name).rect());
        for pair in rects.windows(2) {
            assert!(pair[0].right() <= pair[1].left(), "{size:?}: {rects:?}");
        }
        assert!(rects[7].right() <= size[0], "{size:?}: {rects:?}");
        let height = rects.iter().map(|rect| rect.height()).fold(f32::INFINITY, f32::min);
        assert_eq!(height >= 32.0, is_touch, "{size:?}: {height}");
        // The picture stays where it is when the numbers change.
        window.state_mut().0.figures = splashdown_viewer::state::Figures::default();
        window.run_steps(3);
        assert_eq!(window.state().2, picture);
    }
}

/// The same window with a run that is played.
fn played(size: [f32; 2]) -> Harness<'static, Both> {
    let mut window = window(size);
    let mut timeline = Timeline::new((0..=100).collect(), 50.0).unwrap();
    (timeline.can_continue, timeline.playing, timeline.has_particles) = (true, false, false);
    window.state_mut().0.timeline = Some(timeline);
    window.run_steps(3);
    window
}

#[test]
fn a_played_run_has_a_timeline() {
    for size in SIZES {
        let mut window = played(size);
        let frame = |window: &Harness<'_, Both>| window.state().0.timeline.as_ref().unwrap().current();
        for (label, expected) in [
            ("Next frame", 1),
            ("Next frame", 2),
            ("Previous frame", 1),
            ("Last frame", 100),
            ("First frame", 0),
        ] {
            click(&mut window, &[label]);
            assert_eq!(frame(&window), expected, "{label} at {size:?}");
        }
        for (key, expected) in [(Key::ArrowRight, 1), (Key::End, 100), (Key::ArrowLeft, 99), (Key::Home, 0)] {
            window.key_press(key);
            window.run_steps(3);
            assert_eq!(frame(&window), expected, "{key:?} at {size:?}");
        }
        let slider = window.get_by_role(Role::Slider).rect();
        window.drag_at(slider.left_center() + vec2(4.0, 0.0));
        window.hover_at(slider.center());
        window.run_steps(1);
        window.drop_at(slider.center());
        window.run_steps(2);
        assert!((45..=55).contains(&frame(&window)), "{} at {size:?}", frame(&window));
        // The slider does not take the keys.
        window.key_press(Key::Space);
        window.run_steps(2);
        assert!(window.state().0.timeline.as_ref().unwrap().playing);
        click(&mut window, &["Loop"]);
        assert!(!window.state().0.timeline.as_ref().unwrap().looping);
        assert_eq!(actions(&mut window), []);
        click(&mut window, &["Continue"]);
        assert_eq!(actions(&mut window), [Action::Continue]);
        let continues = window.get_by_role_and_label(Role::Button, "Continue").rect();
        assert!(continues.right() <= size[0], "{continues:?} at {size:?}");
    }
}

#[test]
fn a_played_run_cannot_be_changed() {
    let mut window = played([1280.0, 800.0]);
    for key in [Key::R, Key::B, Key::P, Key::M, Key::K] {
        window.key_press(key);
        assert_eq!(actions(&mut window), [], "{key:?}");
    }
    window.key_press_modifiers(Modifiers::COMMAND, Key::S);
    assert_eq!(actions(&mut window), []);
    assert!(window.query_by_label("Restart").is_none() && window.query_by_label("Tool").is_none());
    // A view for which the run has no files.
    let mode = window.state().0.look.mode;
    click(&mut window, &["View", "Particles"]);
    assert_eq!(window.state().0.look.mode, mode);
    // Control: in the same window without a run.
    window.state_mut().0.timeline = None;
    window.run_steps(3);
    window.key_press(Key::R);
    assert_eq!(actions(&mut window), [Action::Restart]);
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

#[test]
fn settings_open_over_the_picture_and_do_not_move_it() {
    for size in SIZES {
        let mut window = window(size);
        assert!(window.query_by_label("Add ball").is_none());
        let before = window.state().2;
        click(&mut window, &["Settings"]);
        assert!(window.query_by_label("Add ball").is_some(), "{size:?}");
        assert_eq!(window.state().2, before);
    }
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

/// Every text that the window shows, except tooltips.
fn texts(window: &Harness<'_, Both>) -> Vec<String> {
    let nodes = window.root().children_recursive();
    nodes.filter_map(|node| node.accesskit_node().label()).collect()
}

/// Words that the guide replaces by others, of `texts`.
fn replaced_words(texts: &[String]) -> Vec<&str> {
    let has = |text: &&String, wanted: &str| {
        text.split(|c: char| !c.is_alphabetic()).any(|word| word.eq_ignore_ascii_case(wanted))
    };
    let replaced = ["liquid", "tap", "resume", "advance", "reset", "delete"];
    let is_wrong = |text: &&String| replaced.iter().any(|word| has(text, word));
    // The camera is reset, and Delete is a key.
    let is_exempt = |text: &&String| has(text, "camera") || text.as_str() == "Delete";
    texts.iter().filter(is_wrong).filter(|text| !is_exempt(text)).map(String::as_str).collect()
}

#[test]
fn the_window_has_one_word_for_each_concept() {
    let mut window = window([1280.0, 1600.0]);
    let mut shown = Vec::new();
    click(&mut window, &["Tool", "Edit"]);
    click(&mut window, &["Settings"]);
    window.key_press(Key::H);
    window.run_steps(3);
    shown.extend(texts(&window));
    for menu in ["More", "View", "Tool"] {
        click(&mut window, &[menu]);
        shown.extend(texts(&window));
        click(&mut window, &[menu]);
    }
    for text in ["Add emitter", "Save scene", "Export surface", "Reset camera", "Smooth", "Display"] {
        assert!(shown.iter().any(|shown| shown.contains(text)), "{text} in {shown:?}");
    }
    assert_eq!(replaced_words(&shown), [""; 0]);
    // Control.
    let wrong = ["Open the tap", "R: reset", "tapestry", "Reset camera"].map(str::to_owned);
    assert_eq!(replaced_words(&wrong), ["Open the tap", "R: reset"]);
}

/// The place of the area with this name.
fn area(window: &Harness<'_, Both>, name: &str) -> egui::Rect {
    window.ctx.memory(|memory| memory.area_rect(egui::Id::unique(name))).unwrap()
}

#[test]
fn notes_cover_neither_dialogs_nor_the_toolbar() {
    for size in SIZES {
        for title in ["Scenes", "Settings", "Help", "Edit"] {
            let mut window = window(size);
            let state = &mut window.state_mut().0;
            match title {
                "Scenes" => state.shown.gallery = true,
                "Settings" => state.shown.settings = true,
                "Help" => state.shown.help = true,
                _ => (state.tool, state.playing) = (Tool::Edit, false),
            }
            window.run_steps(6);
            let before = (area(&window, title), window.state().2);
            // Control: a dialog without a note may reach to where notes are.
            let long = "the scene cannot be used, for a reason of many words. ".repeat(20);
            for text in ["the scene was saved to a.toml", long.as_str(), "another error"] {
                window.state_mut().0.notify(text, text != "the scene was saved to a.toml", 0.0);
            }
            window.run_steps(6);
            let [notes, dialog] = ["notes", title].map(|name| area(&window, name));
            let picture = window.state().2;
            assert_eq!(picture, before.1, "{title} at {size:?}");
            assert!(picture.contains_rect(notes), "{title} at {size:?}: {notes:?} outside {picture:?}");
            assert!(notes.height() <= 0.5 * picture.height(), "{title} at {size:?}: {notes:?}");
            assert!(!notes.intersects(dialog), "{title} at {size:?}: {notes:?} covers {dialog:?}");
            assert!(picture.contains_rect(dialog), "{title} at {size:?}: {dialog:?} outside {picture:?}");
        }
    }
}

#[test]
fn a_refused_change_is_one_sentence_and_leaves_the_dialog_usable() {
    let mut window = wide();
    let (name, text) = presets().iter().find(|(name, _)| *name == "dam-break-small").unwrap();
    window.state_mut().0.open(Scene::parse(text, name).unwrap());
    click(&mut window, &["Tool", "Edit"]);
    assert_eq!(actions(&mut window), [Action::Restart]);
    window.state_mut().0.selected = Some(Item::Block(0));
    window.run_steps(2);
    click(&mut window, &["Remove"]);
    assert_eq!(actions(&mut window), []);
    let state = &window.state().0;
    assert_eq!((state.scene.fluid.blocks.len(), state.notes.len()), (1, 1));
    let text = state.notes[0].text.clone();
    assert!(text.contains("needs fluid") && !text.contains(['\n', '^', '|']), "{text}");
    // The dialog takes clicks as before.
    click(&mut window, &["Add emitter"]);
    assert_eq!(actions(&mut window), [Action::Restart]);
    // Control: with the emitter, the block can be removed.
    window.state_mut().0.selected = Some(Item::Block(0));
    window.run_steps(2);
    click(&mut window, &["Remove"]);
    assert_eq!(actions(&mut window), [Action::Restart]);
    assert!(window.state().0.scene.fluid.blocks.is_empty());
}

#[test]
fn the_scenes_of_the_gallery_are_inside_their_dialog() {
    for size in SIZES {
        let mut window = window(size);
        window.state_mut().0.shown.gallery = true;
        window.run_steps(6);
        let dialog = area(&window, "Scenes");
        for (name, _) in presets() {
            for tile in window.query_all_by_label(name).map(|node| node.rect()) {
                assert!(
                    tile.left() >= dialog.left() && tile.right() <= dialog.right(),
                    "{name} at {size:?}: {tile:?} outside {dialog:?}"
                );
            }
        }
        let close = dialog.right_top() + vec2(-14.0, 14.0);
        window.drag_at(close);
        window.run_steps(1);
        window.drop_at(close);
        window.run_steps(3);
        assert!(!window.state().0.shown.gallery, "the title bar at {size:?} ends before {dialog:?}");
    }
}

#[test]
fn the_timeline_fits_with_frames_that_are_left_out() {
    for size in SIZES {
        let mut window = played(size);
        let timeline = window.state_mut().0.timeline.as_mut().unwrap();
        for number in [3, 7, 8, 9] {
            assert!(timeline.leave_out(number));
        }
        window.run_steps(3);
        for label in ["4 left out", "Continue", "Loop", "Last frame"] {
            let rect = window.get_by_label(label).rect();
            assert!(rect.right() <= size[0] - 8.0, "{label} at {size:?}: {rect:?}");
        }
    }
}

#[test]
fn a_run_without_a_checkpoint_cannot_be_continued() {
    let mut window = played([1280.0, 800.0]);
    window.state_mut().0.timeline.as_mut().unwrap().can_continue = false;
    window.run_steps(2);
    click(&mut window, &["Continue"]);
    assert_eq!(actions(&mut window), []);
    let button = window.get_by_role_and_label(Role::Button, "Continue").rect();
    window.hover_at(button.center());
    // A tooltip appears when the pointer rests.
    window.run_steps(60);
    assert!(window.query_by_label_contains("--checkpoint-every").is_some());
}

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
