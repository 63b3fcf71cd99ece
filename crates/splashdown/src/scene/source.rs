//! The text of a scene file, and lines, columns and excerpts for messages.

use std::ops::Range;

use super::errors::SceneProblem;

/// Maximum length of a line in a message, in characters.
const MAX_LINE: usize = 100;
/// Maximum length of a value in a message, in characters.
const MAX_VALUE: usize = 48;

/// The text of a file with its line starts.
pub(crate) struct Source<'a> {
    pub file: &'a str,
    pub text: &'a str,
    starts: Vec<usize>,
}

impl<'a> Source<'a> {
    pub fn new(file: &'a str, text: &'a str) -> Self {
        let starts = std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at + 1)).collect();
        Self { file, text, starts }
    }

    /// A problem at a byte range of the text, with line, column and the line itself.
    pub fn problem(&self, span: Range<usize>, key: String, message: String) -> SceneProblem {
        let at = self.boundary(span.start);
        let line = self.starts.partition_point(|start| *start <= at).max(1) - 1;
        let start = self.starts[line];
        let before = self.text[start..at].chars().count();
        let whole = self.text[start..].lines().next().unwrap_or_default();
        // A very long line is shown from slightly before the marked part.
        let skipped = if before >= MAX_LINE { before - MAX_LINE / 4 } else { 0 };
        let text: String = whole.chars().skip(skipped).take(MAX_LINE).map(printable).collect();
        let marked = self.text[at..self.boundary(span.end.max(at))].lines().next().unwrap_or_default();
        let marked = marked.chars().take(MAX_LINE).count().max(1);
        SceneProblem {
            file: self.file.to_owned(),
            line: Some(line + 1),
            column: Some(before + 1),
            key,
            message,
            given: None,
            allowed: None,
            hint: None,
            text: Some(text),
            mark: (before - skipped, marked),
        }
    }

    /// The text of a byte range on one line, shortened.
    pub fn excerpt(&self, span: Range<usize>) -> String {
        let text = &self.text[self.boundary(span.start)..self.boundary(span.end.max(span.start))];
        let line = text.lines().next().unwrap_or_default();
        let mut short: String = line.chars().take(MAX_VALUE).map(printable).collect();
        if short.len() < text.trim_end().len() {
            short.push_str(" ...");
        }
        short
    }

    /// The nearest character boundary at or before a byte.
    fn boundary(&self, byte: usize) -> usize {
        (0..=byte.min(self.text.len())).rev().find(|at| self.text.is_char_boundary(*at)).unwrap_or(0)
    }
}

/// Replaces tabs and control characters, which would move the terminal's cursor or change its colours.
fn printable(c: char) -> char {
    match c {
        '\t' => ' ',
        c if c.is_control() => '\u{fffd}',
        c => c,
    }
}
