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

/// The largest numbers of curves and panels that a picture can show. More panels would make it too high for viewers.
const MAX_CURVES: usize = 200;
const MAX_PANELS: usize = 40;

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
    if !arguments.columns.is_empty() {
        curves = select(curves, &arguments.columns)?;
    }
    let panels = draw::panels(curves);
    let curves: usize = panels.iter().map(draw::Panel::len).sum();
    if curves > MAX_CURVES || panels.len() > MAX_PANELS {
        let message = format!(
            "there are {curves} columns with {} unit{}, but a plot shows at most {MAX_CURVES} columns with {MAX_PANELS} \
             units; select some with --columns",
            panels.len(),
            if panels.len() == 1 { "" } else { "s" }
        );
        return Err(Failure::new(Exit::Usage, message));
    }
    let size = arguments.size.unwrap_or((900, FRAME + PANEL * panels.len() as u32));
    let title = arguments.title.as_deref().map(table::printable);
    let title = title.as_deref();
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

/// The curves of these columns.
///
/// # Errors
/// If a column does not exist.
fn select(curves: Vec<table::Curve>, columns: &[String]) -> Result<Vec<table::Curve>, Failure> {
    let is = |curve: &table::Curve, column: &str| {
        curve.quantity == column || table::without_unit(&curve.quantity) == column
    };
    if let Some(absent) = columns.iter().find(|column| !curves.iter().any(|curve| is(curve, column.trim()))) {
        let names: Vec<&str> =
            curves.iter().map(|curve| table::without_unit(&curve.quantity)).take(20).collect();
        let message =
            format!("--columns: no column is named `{}`; the columns are {}", absent, names.join(", "));
        return Err(Failure::new(Exit::Usage, message));
    }
    let wanted = |curve: &table::Curve| columns.iter().any(|column| is(curve, column.trim()));
    Ok(curves.into_iter().filter(wanted).collect())
}
