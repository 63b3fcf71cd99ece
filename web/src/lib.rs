//! What the page calls; all else is the viewer's.

#[cfg(target_arch = "wasm32")]
mod entry {
    use wasm_bindgen::prelude::{JsValue, wasm_bindgen};

    /// Starts the program on a canvas. `scene` is the name of a scene that comes with the program, or the text of a scene file.
    #[wasm_bindgen]
    pub async fn start(canvas: web_sys::HtmlCanvasElement, scene: String) -> Result<(), JsValue> {
        splashdown_viewer::start_on_page(canvas, &scene).await
    }

    /// Compiles every pass on this browser's device: for the page's tests.
    #[wasm_bindgen]
    pub async fn try_passes(broken: bool) -> Result<String, JsValue> {
        splashdown_viewer::try_passes(broken).await
    }

    /// Numbers about the running program, as JSON: for the page's tests.
    #[wasm_bindgen]
    pub fn figures() -> String {
        splashdown_viewer::figures()
    }
}
