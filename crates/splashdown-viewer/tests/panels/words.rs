//! Messages, and one word for each concept.

use super::{actions, click, texts, wide, window};
use egui::Key;
use egui_kittest::kittest::Queryable;
use splashdown::scene::{Scene, presets};
use splashdown_viewer::items::Item;
use splashdown_viewer::state::Action;

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
