//! "Did you mean": the right key for a wrong one.

use super::keys::ROOT;
use super::spec::{Kind, Table};

/// Longer words are not compared: their distance costs time, and nobody means a key by them.
const LONGEST: usize = 40;

/// A sentence that leads from an unknown key to a known one; `path` is the table's path, empty for the root.
pub(crate) fn for_key(unknown: &str, table: &'static Table, path: &str) -> Option<String> {
    let word = unknown.to_ascii_lowercase().replace('-', "_");
    if word.len() > LONGEST {
        return None;
    }
    if let Some(key) = table.keys.iter().find(|key| key.also.contains(&word.as_str())) {
        return Some(format!("this is called `{}` here: {}", key.name, key.about));
    }
    let names: Vec<&str> = table.keys.iter().map(|key| key.name).collect();
    if let Some(name) = closest(&word, &names) {
        return Some(format!("did you mean `{name}`?"));
    }
    let elsewhere = sections(&ROOT, "").into_iter().find(|(_, other)| other.key(&word).is_some());
    elsewhere.filter(|(section, _)| *section != path).map(|(section, _)| {
        if section.is_empty() {
            format!("the section `[{word}]` belongs at the top")
        } else {
            format!("`{word}` belongs to [{section}]")
        }
    })
}

/// The nearest of some words, if it is near enough to be a slip.
pub(crate) fn closest<'a>(word: &str, known: &[&'a str]) -> Option<&'a str> {
    if word.len() > LONGEST {
        return None;
    }
    let allowed = (word.chars().count() / 3).clamp(1, 3);
    known
        .iter()
        .map(|name| (distance(word, name), *name))
        .min()
        .filter(|(d, _)| *d <= allowed)
        .map(|(_, n)| n)
}

/// Every table below this one with its path, itself first.
fn sections(table: &'static Table, path: &str) -> Vec<(String, &'static Table)> {
    let mut found = vec![(path.to_owned(), table)];
    for key in table.keys {
        if let Kind::Table(inner) | Kind::Tables(inner, _) = key.kind {
            let inner_path =
                if path.is_empty() { key.name.to_owned() } else { format!("{path}.{}", key.name) };
            found.extend(sections(inner, &inner_path));
        }
    }
    found
}

/// Insertions, deletions, replacements and swaps of neighbours between two words (restricted Damerau-Levenshtein).
fn distance(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    let mut rows = vec![vec![0; b.len() + 1]; a.len() + 1];
    for i in 0..=a.len() {
        for j in 0..=b.len() {
            rows[i][j] = if i == 0 || j == 0 {
                i + j
            } else {
                let replaced = rows[i - 1][j - 1] + usize::from(a[i - 1] != b[j - 1]);
                let mut best = replaced.min(rows[i - 1][j] + 1).min(rows[i][j - 1] + 1);
                if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                    best = best.min(rows[i - 2][j - 2] + 1);
                }
                best
            };
        }
    }
    rows[a.len()][b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slip_is_recognised_and_another_word_is_not() {
        assert_eq!(closest("gravitty", &["gravity", "name"]), Some("gravity"));
        assert_eq!(closest("color_by", &["colour_by", "film"]), Some("colour_by"));
        assert_eq!(closest("mthod", &["method"]), Some("method"));
        assert_eq!(closest("temperature", &["gravity", "name", "duration"]), None);
    }

    #[test]
    fn distance_counts_single_edits() {
        assert_eq!(distance("", "abc"), 3);
        assert_eq!(distance("kitten", "sitting"), 3);
        assert_eq!(distance("ab", "ba"), 1);
    }
}
