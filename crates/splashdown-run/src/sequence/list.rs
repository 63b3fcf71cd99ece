//! Listing the files of a series.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::RunError;

/// The files of the only series in a folder.
pub fn folder(path: &Path, endings: &[&str]) -> Result<Vec<PathBuf>, RunError> {
    let ending = |name: &str| {
        let name = name.to_ascii_lowercase();
        endings
            .iter()
            .find(|ending| name.ends_with(**ending) || name.ends_with(&format!("{ending}.gz")))
            .copied()
    };
    let files = list(path, |name| !name.starts_with('.') && ending(name).is_some())?;
    let kinds: BTreeSet<&str> =
        files.iter().filter_map(|file| ending(&file.file_name()?.to_string_lossy())).collect();
    let place = path.display();
    match kinds.len() {
        0 => Err(RunError::Input(format!(
            "`{place}` contains no file that ends in one of {}",
            endings.join(", ")
        ))),
        1 => Ok(files),
        _ => {
            let kinds: Vec<&str> = kinds.into_iter().collect();
            let pattern = path.join(format!("*{}", kinds[0]));
            Err(RunError::Input(format!(
                "`{place}` contains files of {} kinds ({}): name one, as in '{}'",
                kinds.len(),
                kinds.join(", "),
                pattern.display()
            )))
        }
    }
}

/// The files of a folder with accepted names, in the order of the numbers in their names.
pub fn list(folder: &Path, accepts: impl Fn(&str) -> bool) -> Result<Vec<PathBuf>, RunError> {
    let entries = std::fs::read_dir(folder).map_err(|error| {
        RunError::Input(format!("cannot list the folder `{}`: {error}", folder.display()))
    })?;
    let mut files: Vec<PathBuf> = entries
        .flatten()
        .filter(|entry| accepts(&entry.file_name().to_string_lossy()))
        .map(|entry| entry.path())
        .filter(|path| path.is_file())
        // Without the leading `./` of the current folder, which the user has not given.
        .map(|path| path.strip_prefix(".").map(Path::to_owned).unwrap_or(path))
        .collect();
    files.sort_by_cached_key(|file| natural(&file.to_string_lossy()));
    Ok(files)
}

pub fn parent(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// A key that sorts frame_9 before frame_10: alternating text and numbers.
fn natural(name: &str) -> Vec<(String, u64)> {
    let mut parts = vec![(String::new(), 0_u64)];
    let mut in_number = false;
    for c in name.chars() {
        let digit = c.to_digit(10).map(u64::from);
        if in_number && digit.is_none() {
            parts.push((String::new(), 0));
        }
        in_number = digit.is_some();
        if let Some((text, number)) = parts.last_mut() {
            match digit {
                Some(digit) => *number = number.saturating_mul(10).saturating_add(digit),
                None => text.push(c),
            }
        }
    }
    parts
}

/// Whether a name matches a pattern, where `*` stands for any bytes and `?` for one. The time is at most proportional
/// to the product of the lengths: a mismatch extends the last star only, because an earlier star has no need to be
/// longer if the part up to the last one has matched.
pub fn matches(pattern: &[u8], name: &[u8]) -> bool {
    let (mut at, mut read) = (0, 0);
    // The position after the last star, and where the bytes that it stands for end.
    let mut star: Option<(usize, usize)> = None;
    while read < name.len() {
        match (pattern.get(at), &mut star) {
            (Some(b'*'), _) => {
                at += 1;
                star = Some((at, read));
            }
            (Some(byte), _) if *byte == b'?' || *byte == name[read] => {
                at += 1;
                read += 1;
            }
            (_, Some((after, end))) => {
                *end += 1;
                (at, read) = (*after, *end);
            }
            (_, None) => return false,
        }
    }
    pattern[at..].iter().all(|byte| *byte == b'*')
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use super::matches;

    /// The definition of a pattern, in exponential time.
    fn reference(pattern: &[u8], name: &[u8]) -> bool {
        match (pattern, name) {
            ([], _) => name.is_empty(),
            ([b'*', rest @ ..], _) => (0..=name.len()).any(|skipped| reference(rest, &name[skipped..])),
            ([byte, rest @ ..], [other, others @ ..]) => {
                (*byte == b'?' || byte == other) && reference(rest, others)
            }
            _ => false,
        }
    }

    /// All texts of up to `length` of these bytes.
    fn texts(bytes: &[u8], length: usize) -> Vec<Vec<u8>> {
        let mut all = vec![Vec::new()];
        let mut longest = 0;
        for _ in 0..length {
            let next = all.len();
            for i in longest..next {
                all.extend(bytes.iter().map(|byte| [&all[i][..], &[*byte]].concat()).collect::<Vec<_>>());
            }
            longest = next;
        }
        all
    }

    #[test]
    fn short_patterns_match_as_defined() {
        let names = texts(b"ab", 6);
        let mut matching = 0;
        for pattern in texts(b"ab*?", 5) {
            for name in &names {
                let expected = reference(&pattern, name);
                matching += usize::from(expected);
                assert_eq!(matches(&pattern, name), expected, "{pattern:?} {name:?}");
            }
        }
        assert!(matching > 10_000, "{matching}");
    }

    #[test]
    fn many_stars_take_no_exponential_time() {
        let begun = Instant::now();
        let pattern = [b"*a".repeat(9), b"*b".to_vec()].concat();
        assert!(!matches(&pattern, &b"a".repeat(44)));
        assert!(begun.elapsed() < Duration::from_millis(500), "{:?}", begun.elapsed());
    }
}
