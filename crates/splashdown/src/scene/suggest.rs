//! Suggests corrections for unknown keys and words.

use super::keys::ROOT;
use super::spec::{Kind, Table};

/// Maximum length of words that are compared. All keys are shorter, and computing the distance takes
/// quadratic time.
const MAX_LENGTH: usize = 40;

/// A hint for an unknown key; `path` is the table's path, empty for the root.
pub(crate) fn for_key(unknown: &str, table: &'static Table, path: &str) -> Option<String> {
    let word = unknown.to_ascii_lowercase().replace('-', "_");
    if word.len() > MAX_LENGTH {
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

/// The known word with the smallest edit distance (insertions, deletions, replacements and swaps of
/// neighbours), if that distance is small enough for a typing error.
pub(crate) fn closest<'a>(word: &str, known: &[&'a str]) -> Option<&'a str> {
    if word.len() > MAX_LENGTH {
        return None;
    }
    let allowed = (word.chars().count() / 3).clamp(1, 3);
    known
        .iter()
        .map(|name| (strsim::osa_distance(word, name), *name))
        .min()
        .filter(|(d, _)| *d <= allowed)
        .map(|(_, n)| n)
}

/// This table and all tables below it, with their paths.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_small_typing_errors_are_corrected() {
        assert_eq!(closest("gravitty", &["gravity", "name"]), Some("gravity"));
        assert_eq!(closest("color_by", &["colour_by", "film"]), Some("colour_by"));
        assert_eq!(closest("mthod", &["method"]), Some("method"));
        assert_eq!(closest("naem", &["name"]), Some("name"));
        assert_eq!(closest("temperature", &["gravity", "name", "duration"]), None);
    }
}
