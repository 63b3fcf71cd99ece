//! Data exchanged with the web page: the address, dropped files, figures, and a checkpoint.

use std::cell::RefCell;
use std::path::PathBuf;

use splashdown::Checkpoint;
use wasm_bindgen::JsValue;

thread_local! {
    /// The result of [`figures`], updated with every picture.
    static FIGURES: RefCell<String> = const { RefCell::new(String::new()) };
    /// The checkpoint saved when the device was lost.
    static RESCUE: RefCell<Option<Checkpoint>> = const { RefCell::new(None) };
    /// Dropped files that the browser has read.
    static ARRIVED: RefCell<Vec<Arrived>> = const { RefCell::new(Vec::new()) };
}

/// A file's name, and its content or the reason why it cannot be read.
type Arrived = (PathBuf, Result<Vec<u8>, String>);

/// Adds a file that has been read.
pub(crate) fn arrived(path: PathBuf, read: Result<Vec<u8>, String>) {
    ARRIVED.with_borrow_mut(|files| files.push((path, read)));
}

/// The files that have been read since the last call.
pub(crate) fn take_arrived() -> Vec<Arrived> {
    ARRIVED.take()
}

/// Stores a checkpoint for the next start.
pub(crate) fn set_rescue(checkpoint: Checkpoint) {
    RESCUE.set(Some(checkpoint));
}

/// The stored checkpoint, which is removed.
pub(crate) fn take_rescue() -> Option<Checkpoint> {
    RESCUE.take()
}

/// Sets the part of the address after the page's path without loading it; returns the whole address.
pub(crate) fn set_address(rest: &str) -> String {
    let Some(window) = web_sys::window() else { return String::new() };
    let path = window.location().pathname().unwrap_or_default();
    // In a frame without access to the history the address remains unchanged.
    let _ = window.history().and_then(|history| {
        history.replace_state_with_url(&JsValue::NULL, "", Some(&format!("{path}{rest}")))
    });
    window.location().href().unwrap_or_default()
}

/// Sets the title of the page.
pub(crate) fn set_title(title: &str) {
    if let Some(document) = web_sys::window().and_then(|window| window.document()) {
        document.set_title(title);
    }
}

/// Puts a scene's text into the address, and the address into the clipboard.
pub(crate) fn share(text: &str) -> String {
    let address = set_address(&format!("#toml={}", String::from(js_sys::encode_uri_component(text))));
    if let Some(window) = web_sys::window() {
        // Without access to the clipboard, only the address bar contains the address.
        let copied = window.navigator().clipboard().write_text(&address);
        wasm_bindgen_futures::spawn_local(async move {
            let _ = wasm_bindgen_futures::JsFuture::from(copied).await;
        });
    }
    address
}

/// Numbers about the running program, as JSON; empty before the first picture.
pub fn figures() -> String {
    FIGURES.with_borrow(Clone::clone)
}

/// Sets the result of [`figures`].
pub(crate) fn set_figures(figures: String) {
    FIGURES.with_borrow_mut(|current| *current = figures);
}
