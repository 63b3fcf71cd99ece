//! Options of `view`.

use std::path::PathBuf;

use clap::Args;

use super::DeviceArgument;

/// Options of `view`.
#[derive(Debug, Args)]
pub struct ViewArguments {
    /// Scene file (TOML), the name of a built-in scene, the output folder of a run to play, or a checkpoint to resume
    /// from
    #[arg(value_name = "SCENE", default_value = "dam-break")]
    pub path: PathBuf,
    /// Scene of the run to play, if its folder does not name one: a file or the name of a built-in scene
    #[arg(long, value_name = "FILE")]
    pub scene: Option<PathBuf>,
    #[command(flatten)]
    pub device: DeviceArgument,
    /// Width and height of the window in points
    #[arg(long, value_name = "WxH", default_value = "1280x800", value_parser = window_size)]
    pub size: [f32; 2],
}

/// Two numbers with an x between them.
fn window_size(text: &str) -> Result<[f32; 2], String> {
    let side = |side: &str| side.parse().ok().filter(|side| (200.0..=16_384.0).contains(side));
    match text.split_once('x').map(|(width, height)| (side(width), side(height))) {
        Some((Some(width), Some(height))) => Ok([width, height]),
        _ => {
            Err("a size is two numbers from 200 to 16384 with an x between them, such as 1280x800".to_owned())
        }
    }
}
