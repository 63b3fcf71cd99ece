//! Runs `wasm-bindgen` as a library, because its command line takes four minutes to build:
//! `splashdown-bindgen IN.wasm FOLDER`.

use anyhow::{Result, bail};
use wasm_bindgen_cli_support::Bindgen;

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [module, folder] = arguments.as_slice() else { bail!("usage: splashdown-bindgen IN.wasm FOLDER") };
    Bindgen::new()
        .input_path(module)
        .web(true)?
        .omit_default_module_path(false)
        .typescript(false)
        .generate(folder)
}
