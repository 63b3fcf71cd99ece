//! The parts of Markdown that a link checker needs: links, headings, includes.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result};

/// The links and headings of one document.
#[derive(Debug, Default, PartialEq)]
pub struct Document {
    /// Targets of links and pictures with their line numbers.
    pub links: Vec<(usize, String)>,
    /// Identifiers of headings, as GitHub and mdBook form them.
    pub anchors: BTreeSet<String>,
}

/// Reads a document and replaces mdBook's includes with the included text.
///
/// # Errors
/// If the file or an included file or part does not exist.
pub fn read(path: &Path) -> Result<Document> {
    Ok(parse(&expand(path)?))
}

fn expand(path: &Path) -> Result<String> {
    let text = fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
    let mut out = String::new();
    for line in text.lines() {
        match line.trim().strip_prefix("{{#include ").and_then(|rest| rest.strip_suffix("}}")) {
            None => out += line,
            Some(target) => {
                let (file, part) = target.trim().split_once(':').unwrap_or((target.trim(), ""));
                let file = path.with_file_name("").join(file);
                let included = expand(&file).with_context(|| format!("included by {}", path.display()))?;
                let included =
                    if part.is_empty() { Some(included.as_str()) } else { section(&included, part) };
                let context = || format!("{} has no part {part:?}", file.display());
                out += included.with_context(context)?;
            }
        }
        out.push('\n');
    }
    Ok(out)
}

/// The text between the markers `ANCHOR: name` and `ANCHOR_END: name`.
fn section<'a>(text: &'a str, name: &str) -> Option<&'a str> {
    let mark = |word: &str| format!("<!-- {word}: {name} -->");
    let (_, rest) = text.split_once(&mark("ANCHOR"))?;
    Some(rest.split_once(&mark("ANCHOR_END"))?.0)
}

/// Finds links and headings outside code.
pub fn parse(text: &str) -> Document {
    let mut document = Document::default();
    let mut fence: Option<&str> = None;
    for (index, line) in text.lines().enumerate() {
        let trimmed = line.trim_start();
        if let Some(mark) = ["```", "~~~"].into_iter().find(|mark| trimmed.starts_with(mark)) {
            match fence {
                None => fence = Some(mark),
                Some(open) if open == mark => fence = None,
                Some(_) => {}
            }
            continue;
        }
        if fence.is_some() {
            continue;
        }
        if let Some(title) = heading(line) {
            let base = identifier(title);
            let mut name = base.clone();
            let mut number = 1;
            while !document.anchors.insert(name) {
                name = format!("{base}-{number}");
                number += 1;
            }
        }
        document.links.extend(targets(&without_code(line)).into_iter().map(|target| (index + 1, target)));
    }
    document
}

/// The title of a heading of the form `## Title`.
fn heading(line: &str) -> Option<&str> {
    let title = line.trim_start_matches('#');
    let level = line.len() - title.len();
    ((1..=6).contains(&level) && title.starts_with(' '))
        .then(|| title.trim().trim_end_matches('#').trim_end())
}

/// Lower-case letters, digits, `_` and `-`; spaces become `-`; the text of links without their targets.
fn identifier(title: &str) -> String {
    let mut text = String::new();
    let mut rest = title;
    while let Some((before, after)) = rest.split_once("](") {
        text += before;
        rest = after.split_once(')').map_or("", |(_, after)| after);
    }
    text += rest;
    let kept = text.trim().chars().filter_map(|letter| match letter {
        letter if letter.is_whitespace() => Some('-'),
        letter if letter.is_alphanumeric() || matches!(letter, '_' | '-') => Some(letter),
        _ => None,
    });
    kept.flat_map(char::to_lowercase).collect()
}

/// The line with the contents of `code` replaced by spaces.
fn without_code(line: &str) -> String {
    let mut out = String::new();
    for (index, part) in line.split('`').enumerate() {
        if index % 2 == 0 { out += part } else { out.push(' ') }
    }
    out
}

/// Targets of `[text](target)`, `![text](target)` and `[name]: target`.
fn targets(line: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut rest = line;
    while let Some((_, after)) = rest.split_once("](") {
        let Some((target, after)) = after.split_once(')') else { break };
        found.push(target.split_whitespace().next().unwrap_or_default().to_owned());
        rest = after;
    }
    if let Some((name, target)) = line.split_once("]: ")
        && name.starts_with('[')
        && !name.contains(']')
    {
        found.push(target.trim().to_owned());
    }
    found
}

#[cfg(test)]
mod tests {
    use super::{identifier, parse, section};

    #[test]
    fn links_and_headings_are_found_outside_code() {
        let text = "# A [title](x.md) of `code`!\n\nSee [a](b.md#c), ![d](e.png) and `[no](f.md)`.\n\n```sh\n# no heading\n[no](g.md)\n```\n\n## Same\n## Same\n\n[name]: h.md\n";
        let document = parse(text);
        let links: Vec<_> = document.links.iter().map(|(line, target)| (*line, target.as_str())).collect();
        assert_eq!(links, [(1, "x.md"), (3, "b.md#c"), (3, "e.png"), (13, "h.md")]);
        let anchors: Vec<_> = document.anchors.iter().map(String::as_str).collect();
        assert_eq!(anchors, ["a-title-of-code", "same", "same-1"]);
    }

    #[test]
    fn identifiers_match_those_of_github() {
        assert_eq!(identifier("`[[fluid.block]]`"), "fluidblock");
        assert_eq!(identifier("Density: summation or continuity"), "density-summation-or-continuity");
        assert_eq!(identifier("0.1.0 - 2026"), "010---2026");
    }

    #[test]
    fn a_section_is_the_text_between_its_markers() {
        let text = "x\n<!-- ANCHOR: a -->\ny\n<!-- ANCHOR_END: a -->\nz";
        assert_eq!(section(text, "a"), Some("\ny\n"));
        assert_eq!(section(text, "b"), None);
    }
}
