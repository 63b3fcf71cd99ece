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
    print_raw(format!("{}\n", harmless(&text.to_string())).as_bytes());
}

/// A text without the characters by which a name in a file could control the terminal.
fn harmless(text: &str) -> String {
    let is_control = |c: char| c.is_control() && !matches!(c, '\n' | '\t');
    text.chars().map(|c| if is_control(c) { '\u{fffd}' } else { c }).collect()
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
    let _ = writeln!(io::stderr().lock(), "{}", harmless(&text.to_string()));
}

/// A table of names and values, the values in one column.
pub fn table(rows: &[(&str, String)]) -> String {
    let width = rows.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    let line = |(name, value): &(&str, String)| format!("  {name:width$}  {value}");
    rows.iter().map(line).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::harmless;

    #[test]
    fn names_cannot_control_the_terminal() {
        assert_eq!(harmless("a\u{1b}[2Jb\r\u{7}\u{9b}é\n\tc"), "a\u{fffd}[2Jb\u{fffd}\u{fffd}\u{fffd}é\n\tc");
    }
}
