//! Where words go: results to stdout, everything else to stderr. A reader that closes the pipe early (`| head`) ends the
//! words, not the work: the files are what a run is for.

use std::fmt::Display;
use std::io::{self, Write};

use serde::Serialize;

/// How much to say.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verbosity {
    /// Errors only.
    Quiet,
    /// Progress, warnings, a summary.
    Normal,
    /// Also the library's own remarks.
    Verbose,
}

/// Prints text to stdout, with a line end.
pub fn print(text: impl Display) {
    // Nobody is left to tell if stdout is closed.
    let _ = writeln!(io::stdout().lock(), "{text}");
}

/// Prints text to stdout as it is.
pub fn print_raw(text: &[u8]) {
    let _ = io::stdout().lock().write_all(text);
}

/// Prints one JSON object in one line. Each line is flushed: programs read along.
pub fn print_json(value: &impl Serialize) {
    let mut out = io::stdout().lock();
    let Ok(mut line) = serde_json::to_vec(value) else {
        // Plain structs of numbers and text always serialise; a NaN becomes null.
        return;
    };
    line.push(b'\n');
    let _ = out.write_all(&line).and_then(|()| out.flush());
}

/// Prints a JSON value over several lines.
pub fn print_json_pretty(value: &impl Serialize) {
    if let Ok(text) = serde_json::to_string_pretty(value) {
        print(text);
    }
}

/// Prints to stderr.
pub fn note(text: impl Display) {
    let _ = writeln!(io::stderr().lock(), "{text}");
}

/// A table of names and values, the values in one column.
pub fn table(rows: &[(&str, String)]) -> String {
    let width = rows.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    let line = |(name, value): &(&str, String)| format!("  {name:width$}  {value}");
    rows.iter().map(line).collect::<Vec<_>>().join("\n")
}
