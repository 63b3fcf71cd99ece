//! Options of `plot`.

use std::path::PathBuf;

use clap::Args;

const PLOT_EXAMPLES: &str = "\
Examples:
  splashdown plot out/dam-break/probes/*.csv -o probes.svg
  splashdown plot left.csv right.csv -o heights.png --title 'Height of the water' --size 1200x500

A table has a line of names, the first of which is that of the time, and rows of numbers. Columns of
one unit share a panel. Tables can be drawn while the run that writes them goes on.";

/// Options of `plot`.
#[derive(Debug, Args)]
#[command(after_help = PLOT_EXAMPLES)]
pub struct PlotArguments {
    /// Tables as probes write them (CSV)
    #[arg(value_name = "TABLE", required = true)]
    pub tables: Vec<PathBuf>,
    /// Picture to write: .svg or .png
    #[arg(short, long, value_name = "FILE")]
    pub out: PathBuf,
    /// Words above the plot
    #[arg(long, value_name = "TEXT")]
    pub title: Option<String>,
    /// Width and height in pixels [default: 900, and 260 for each unit]
    #[arg(long, value_name = "WxH", value_parser = picture_size)]
    pub size: Option<(u32, u32)>,
}

/// Two whole numbers with an x between them.
fn picture_size(text: &str) -> Result<(u32, u32), String> {
    let side = |side: &str| side.parse().ok().filter(|side| (100..=16_384).contains(side));
    match text.split_once('x').map(|(width, height)| (side(width), side(height))) {
        Some((Some(width), Some(height))) => Ok((width, height)),
        _ => Err("a size is two whole numbers between 100 and 16384 with an x between them, such as 900x600"
            .to_owned()),
    }
}
