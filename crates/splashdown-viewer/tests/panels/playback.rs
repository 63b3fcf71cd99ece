//! The timeline of a played run.

use super::{Both, SIZES, actions, click, played};
use egui::accesskit::Role;
use egui::{Key, Modifiers, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use splashdown_viewer::state::Action;

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
