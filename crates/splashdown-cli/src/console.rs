//! Where words go: results to stdout, everything else to stderr. A reader that closes the pipe early (`| head`)
//! ends the words, not the work: the files are what a run is for.

use std::fmt::Display;
use std::io::{self, ErrorKind, Write};
use std::sync::OnceLock;

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

/// Why results are missing on stdout: the first failure that is not a reader who left.
static LOST: OnceLock<io::Error> = OnceLock::new();

/// Why results are missing on stdout, if they are: a full disk, say. A closed pipe is no failure.
pub fn lost() -> Option<&'static io::Error> {
    LOST.get()
}

/// Prints text to stdout, with a line end.
pub fn print(text: impl Display) {
    print_raw(format!("{text}\n").as_bytes());
}

/// Prints text to stdout as it is. Everything is flushed: programs read along, and failures show now or never.
pub fn print_raw(text: &[u8]) {
    let mut out = io::stdout().lock();
    if let Err(error) = out.write_all(text).and_then(|()| out.flush())
        && error.kind() != ErrorKind::BrokenPipe
    {
        // Only the first one counts.
        let _ = LOST.set(error);
    }
}

/// Prints one JSON object in one line.
pub fn print_json(value: &impl Serialize) {
    let Ok(mut line) = serde_json::to_vec(value) else {
        // Plain structs of numbers and text always serialise; a NaN becomes null.
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
