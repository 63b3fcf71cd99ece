//! Where panels, dialogs and notes lie at every size of the window.

use super::{SIZES, TOUCH, area, click, window};
use egui::accesskit::Role;
use egui::vec2;
use egui_kittest::kittest::Queryable;
use splashdown::scene::presets;
use splashdown_viewer::state::Tool;

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
