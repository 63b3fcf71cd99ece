//! The functions that the web page calls. The viewer implements them.

#[cfg(target_arch = "wasm32")]
mod entry {
    use wasm_bindgen::prelude::{JsValue, wasm_bindgen};

    /// Starts the program on a canvas. `scene` is the name of a built-in scene, or the text of a scene file.
    #[wasm_bindgen]
    pub async fn start(canvas: web_sys::HtmlCanvasElement, scene: String) -> Result<(), JsValue> {
        splashdown_viewer::start_on_page(canvas, &scene).await
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
