//! Options of `plot`.

use std::path::PathBuf;

use clap::Args;

const PLOT_EXAMPLES: &str = "\
Examples:
  splashdown plot out/dam-break/probes/*.csv -o probes.svg
  splashdown plot out/dam-break/probes/gate.csv -o gate.png --columns 'force x,force y'
  splashdown plot left.csv right.csv -o heights.png --title 'Height of the water' --size 1200x500

The first line of a table names its columns, the first of which is the time. Columns with the same
unit share a panel. Tables can be plotted while a run is still writing them.";

/// Options of `plot`.
#[derive(Debug, Args)]
#[command(after_help = PLOT_EXAMPLES)]
pub struct PlotArguments {
    /// Tables of probes (CSV)
    #[arg(value_name = "TABLE", required = true)]
    pub tables: Vec<PathBuf>,
    /// Output picture: .svg or .png
    #[arg(short, long, value_name = "FILE")]
    pub out: PathBuf,
    /// Columns to draw, by name without unit, separated by commas [default: all]
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub columns: Vec<String>,
    /// Title above the plot
    #[arg(long, value_name = "TEXT")]
    pub title: Option<String>,
    /// Width and height in pixels [default: 900 wide, 260 high per unit]
    #[arg(long, value_name = "WxH", value_parser = picture_size)]
    pub size: Option<(u32, u32)>,
}

/// Two integers with an x between them.
fn picture_size(text: &str) -> Result<(u32, u32), String> {
    let side = |side: &str| side.parse().ok().filter(|side| (100..=16_384).contains(side));
    match text.split_once('x').map(|(width, height)| (side(width), side(height))) {
        Some((Some(width), Some(height))) => Ok((width, height)),
        _ => {
            Err("a size is two integers from 100 to 16384 with an x between them, such as 900x600".to_owned())
        }
    }
}
