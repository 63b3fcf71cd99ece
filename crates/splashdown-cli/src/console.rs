//! Console output: results to stdout, everything else to stderr. A reader that closes the pipe early (`| head`) ends the
//! output, not the run.

use std::fmt::Display;
use std::io::{self, ErrorKind, Write};
use std::sync::OnceLock;

use serde::Serialize;

/// How much to print.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verbosity {
    /// Errors only.
    Quiet,
    /// Progress, warnings, a summary.
    Normal,
    /// Also the log of the library.
    Verbose,
}

/// The first failure to write to stdout, except a closed pipe.
static LOST: OnceLock<io::Error> = OnceLock::new();

/// Why results are missing on stdout, if they are; for example a full disk. A closed pipe is no failure.
pub fn lost() -> Option<&'static io::Error> {
    LOST.get()
}

/// Prints a line to stdout.
pub fn print(text: impl Display) {
    print_raw(format!("{text}\n").as_bytes());
}

/// Prints bytes to stdout. Every call flushes: other programs read along, and later failures would go unnoticed.
pub fn print_raw(text: &[u8]) {
    let mut out = io::stdout().lock();
    if let Err(error) = out.write_all(text).and_then(|()| out.flush())
        && error.kind() != ErrorKind::BrokenPipe
    {
        // Only the first failure is kept.
        let _ = LOST.set(error);
    }
}

/// Prints a JSON object on one line.
pub fn print_json(value: &impl Serialize) {
    let Ok(mut line) = serde_json::to_vec(value) else {
        // Structs of numbers and text always serialise; NaN becomes null.
        return;
    };
    line.push(b'\n');
    print_raw(&line);
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
