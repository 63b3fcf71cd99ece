//! The functions that the web page calls. The viewer implements them.

#[cfg(target_arch = "wasm32")]
mod entry {
    use wasm_bindgen::prelude::{JsValue, wasm_bindgen};

    /// Starts the program on a canvas. `scene` is the name of a built-in scene, or the text of a scene file.
    /// `largest_buffer` and `memory` are those of the device in bytes; a memory of 0 is unknown.
    #[wasm_bindgen]
    pub async fn start(
        canvas: web_sys::HtmlCanvasElement,
        scene: String,
        largest_buffer: f64,
        memory: f64,
    ) -> Result<(), JsValue> {
        splashdown_viewer::start_on_page(canvas, &scene, [largest_buffer as u64, memory as u64]).await
    }

    /// Compiles every pass on the browser's device, for the tests of the page.
    #[wasm_bindgen]
    pub async fn try_passes(broken: bool) -> Result<String, JsValue> {
        splashdown_viewer::try_passes(broken).await
    }

    /// The state of the running program as JSON, for the tests of the page.
    #[wasm_bindgen]
    pub fn figures() -> String {
        splashdown_viewer::figures()
    }
}
