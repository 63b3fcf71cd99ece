//! Where files of the program go: on a desktop into the current folder, without writing over anything; on a web
//! page to the downloads.

use splashdown_io::{Mesh, Picture, picture, ply};

/// Keeps a picture as PNG; says where.
///
/// # Errors
/// A sentence with the file's name.
pub fn png(name: &str, [width, height]: [u32; 2], rgba: Vec<u8>) -> Result<String, String> {
    let mut bytes = Vec::new();
    picture::write_png_to(&mut bytes, &Picture { width, height, rgba }).map_err(|error| error.to_string())?;
    file(name, "image/png", &bytes)
}

/// Keeps a mesh as PLY; says where.
///
/// # Errors
/// A sentence with the file's name.
pub fn mesh(name: &str, mesh: &Mesh) -> Result<String, String> {
    let mut bytes = Vec::new();
    ply::write_mesh_to(&mut bytes, mesh).map_err(|error| error.to_string())?;
    file(name, "application/octet-stream", &bytes)
}

/// Keeps a text; says where.
///
/// # Errors
/// A sentence with the file's name.
pub fn text(name: &str, text: &str) -> Result<String, String> {
    file(name, "text/plain", text.as_bytes())
}

/// Keeps bytes; says where.
///
/// # Errors
/// A sentence with the file's name.
pub fn bytes(name: &str, bytes: &[u8]) -> Result<String, String> {
    file(name, "application/octet-stream", bytes)
}

#[cfg(not(target_arch = "wasm32"))]
fn file(name: &str, _: &str, bytes: &[u8]) -> Result<String, String> {
    use std::path::{Path, PathBuf};
    let wanted = PathBuf::from(name);
    let stem = wanted.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let extension = wanted.extension().unwrap_or_default().to_string_lossy().into_owned();
    // This name, or with the first number that no file has yet.
    let numbered = (2..).map(|number| PathBuf::from(format!("{stem}-{number}.{extension}")));
    let path =
        std::iter::once(wanted).chain(numbered).find(|path| !Path::new(path).exists()).unwrap_or_default();
    splashdown_io::atomic::write(&path, |out| out.write_all(bytes)).map_err(|error| error.to_string())?;
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
        // The browser fetches it after this; it is freed with the page.
        Ok(())
    };
    download().map_err(|error| format!("{error:?}"))?;
    Ok(format!("your downloads, as {name}"))
}
