//! `splashdown plot`: plots of the tables of probes.

use splashdown_io::picture::write_png;
use splashdown_io::{IoError, Picture, atomic};

use crate::args::PlotArguments;
use crate::exit::{Exit, Failure};
use crate::plot::{draw, table};

/// Height of the title and of the labels below the last panel, in pixels.
const FRAME: u32 = 60;

/// Default height of a panel, in pixels.
const PANEL: u32 = 260;

/// Draws the plot.
pub fn run(arguments: &PlotArguments) -> Result<(), Failure> {
    let path = &arguments.out;
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
    let is_svg = match ending.as_deref() {
        Some("svg") => true,
        Some("png") => false,
        _ => {
            let error = IoError::UnknownFormat { path: path.clone(), allowed: vec![".svg", ".png"] };
            return Err(Failure::new(Exit::Usage, error.to_string()));
        }
    };
    let mut curves = Vec::new();
    for file in &arguments.tables {
        curves.extend(table::read(file)?);
    }
    let panels = draw::panels(curves);
    let size = arguments.size.unwrap_or((900, FRAME + PANEL * panels.len() as u32));
    let title = arguments.title.as_deref();
    let failed = |reason: String| Failure::new(Exit::Failed, reason);
    if is_svg {
        let text = draw::svg(&panels, title, size).map_err(failed)?;
        atomic::write(path, |out| out.write_all(text.as_bytes()))?;
    } else {
        let rgba = draw::pixels(&panels, title, size).map_err(failed)?;
        write_png(path, &Picture { width: size.0, height: size.1, rgba })?;
    }
    Ok(())
}
