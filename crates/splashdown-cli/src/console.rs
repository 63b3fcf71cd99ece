//! Console output: results to stdout, everything else to stderr. If the reader closes the pipe early (`| head`), the
//! output ends and the run continues.

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

static OUTPUT_FAILURE: OnceLock<io::Error> = OnceLock::new();

/// The first failure to write to stdout, for example a full disk. A closed pipe is not a failure.
pub fn output_failure() -> Option<&'static io::Error> {
    OUTPUT_FAILURE.get()
}

/// Prints a line to stdout.
pub fn print(text: impl Display) {
    print_raw(format!("{text}\n").as_bytes());
}

/// Prints bytes to stdout. Every call flushes, so that a reading program receives the text at once and a failure is
/// detected here.
pub fn print_raw(text: &[u8]) {
    let mut out = io::stdout().lock();
    if let Err(error) = out.write_all(text).and_then(|()| out.flush())
        && error.kind() != ErrorKind::BrokenPipe
    {
        // Only the first failure is stored.
        let _ = OUTPUT_FAILURE.set(error);
    }
}

/// Prints a JSON object on one line.
pub fn print_json(value: &impl Serialize) {
    let Ok(mut line) = serde_json::to_vec(value) else {
        // Serialisation of structs of numbers and text cannot fail; NaN becomes null.
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
