//! Exported files: on a desktop they are written into the current folder and never overwrite a file, unless the user has
//! chosen it; on a web page they are downloads.

use splashdown::Checkpoint;
use splashdown_io::{Mesh, Picture};
use splashdown_run::export;

/// Exports a picture as PNG; returns a description of its location.
///
/// # Errors
/// A message with the file's name.
pub fn picture(name: &str, [width, height]: [u32; 2], rgba: Vec<u8>) -> Result<String, String> {
    let bytes = export::png(&Picture { width, height, rgba }).map_err(|error| error.to_string())?;
    file(name, "image/png", &bytes)
}

/// Exports a mesh as PLY; returns a description of its location.
///
/// # Errors
/// A message with the file's name.
pub fn mesh(name: &str, mesh: &Mesh) -> Result<String, String> {
    let bytes = export::ply(mesh).map_err(|error| error.to_string())?;
    file(name, "application/octet-stream", &bytes)
}

/// Exports a checkpoint; returns a description of its location.
///
/// # Errors
/// A message with the file's name.
pub fn checkpoint(name: &str, checkpoint: &Checkpoint) -> Result<String, String> {
    let bytes = checkpoint.to_bytes().map_err(|error| error.to_string())?;
    file(name, "application/octet-stream", &bytes)
}

/// Exports a text; returns a description of its location.
///
/// # Errors
/// A message with the file's name.
pub fn text(name: &str, text: &str) -> Result<String, String> {
    file(name, "text/plain", text.as_bytes())
}

/// Writes a file, also in place of an existing one; returns a description of its location.
///
/// # Errors
/// A message with the file's name.
#[cfg(not(target_arch = "wasm32"))]
pub fn replace(path: &std::path::Path, bytes: &[u8]) -> Result<String, String> {
    let written = splashdown_io::atomic::write(path, |out| out.write_all(bytes));
    written.map(|_| path.display().to_string()).map_err(|error| error.to_string())
}

#[cfg(not(target_arch = "wasm32"))]
fn file(name: &str, _: &str, bytes: &[u8]) -> Result<String, String> {
    let path = export::write(name.as_ref(), bytes).map_err(|error| error.to_string())?;
    Ok(path.display().to_string())
}

#[cfg(target_arch = "wasm32")]
fn file(name: &str, kind: &str, bytes: &[u8]) -> Result<String, String> {
    use wasm_bindgen::{JsCast, JsValue};
    let download = || -> Result<(), JsValue> {
        let parts = js_sys::Array::of1(&js_sys::Uint8Array::from(bytes));
        let options = web_sys::BlobPropertyBag::new();
        options.set_type(kind);
        let blob = web_sys::Blob::new_with_u8_array_sequence_and_options(&parts, &options)?;
        let url = web_sys::Url::create_object_url_with_blob(&blob)?;
        let document = web_sys::window().and_then(|window| window.document()).ok_or("no page")?;
        let link: web_sys::HtmlAnchorElement = document.create_element("a")?.dyn_into()?;
        link.set_href(&url);
        link.set_download(name);
        link.click();
        // The browser fetches the file later; it is freed with the page.
        Ok(())
    };
    download().map_err(|error| format!("{error:?}"))?;
    Ok(format!("your downloads, as {name}"))
}
