//! Series of files on the command line: which files a pattern or a folder stands for, and how what is made of
//! them is named.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::exit::{Exit, Failure};

/// A file that is read and the one that is made of it.
#[derive(Debug, PartialEq, Eq)]
pub struct Step {
    /// Read from here.
    pub input: PathBuf,
    /// Written there.
    pub output: PathBuf,
}

/// The files that `given` stands for, each once, those of a pattern or folder in the order of their numbers.
///
/// # Errors
/// If there is none, or a folder holds files of several endings out of `endings` (with their dots).
pub fn expand(given: &[PathBuf], endings: &[&str]) -> Result<Vec<PathBuf>, Failure> {
    let mut files = Vec::new();
    for path in given {
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        if path.is_dir() {
            files.extend(folder(path, endings)?);
        } else if name.contains(['*', '?']) && !path.exists() {
            let found = list(parent(path), |file| matches(name.as_bytes(), file.as_bytes()))?;
            if found.is_empty() {
                return Err(wrong(format!("no file is named like `{}`", path.display())));
            }
            files.extend(found);
        } else {
            files.push(path.clone());
        }
    }
    let mut known = BTreeSet::new();
    files.retain(|file| known.insert(file.clone()));
    Ok(files)
}

/// Names what is made of each of the files: `out` itself for one file; for several `out` with each file's
/// number at the place of its star or before its ending. A folder, which for several files any name without
/// star and ending is, gets files `surface_NUMBER.ply`.
///
/// # Errors
/// If a file would be read and written, or a star is in the name of a folder.
pub fn steps(inputs: Vec<PathBuf>, out: &Path) -> Result<Vec<Step>, Failure> {
    let single = inputs.len() == 1;
    let is_name =
        out.extension().is_some() || out.file_name().is_some_and(|name| name.to_string_lossy().contains('*'));
    let is_folder =
        out.is_dir() || out.as_os_str().to_string_lossy().ends_with(['/', '\\']) || !(single || is_name);
    let folder = if is_folder { Some(out) } else { out.parent() };
    if folder.is_some_and(|folder| folder.to_string_lossy().contains('*') && !folder.is_dir()) {
        let message = format!(
            "--out: `{}` has a star in the name of a folder; it stands for the number in the name of a file",
            out.display()
        );
        return Err(Failure::new(Exit::Usage, message));
    }
    let pattern = if is_folder { out.join("surface_*.ply") } else { out.to_owned() };
    let name = pattern.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let numbers = numbers(&inputs);
    let output = |number: &str| {
        let file = match (name.split_once('*'), name.rsplit_once('.')) {
            (Some((before, after)), _) => format!("{before}{number}{after}"),
            (None, _) if single => name.clone(),
            (None, Some((stem, ending))) => format!("{stem}_{number}.{ending}"),
            (None, None) => format!("{name}_{number}"),
        };
        pattern.with_file_name(file)
    };
    let steps: Vec<Step> = inputs
        .into_iter()
        .zip(&numbers)
        .map(|(input, number)| Step { input, output: output(number) })
        .collect();
    match steps.iter().find(|step| steps.iter().any(|other| is_same(&other.input, &step.output))) {
        Some(step) => {
            let file = step.output.display();
            Err(Failure::new(
                Exit::Usage,
                format!("`{file}` would be read and written: choose another --out"),
            ))
        }
        None => Ok(steps),
    }
}

/// Whether two paths name one file or folder, however they are spelled.
pub fn is_same(a: &Path, b: &Path) -> bool {
    match (a.canonicalize(), b.canonicalize()) {
        (Ok(a), Ok(b)) => a == b,
        _ => a == b,
    }
}

/// The files' own numbers, if each has one that no other has; else they are counted.
fn numbers(inputs: &[PathBuf]) -> Vec<String> {
    let own: Vec<String> = inputs.iter().filter_map(|input| last_number(&stem(input))).collect();
    let distinct: BTreeSet<&String> = own.iter().collect();
    if distinct.len() == inputs.len() {
        // As wide as the widest, so that the made files sort as their numbers do.
        let width = own.iter().map(String::len).max().unwrap_or(0).max(4);
        return own.iter().map(|number| format!("{number:0>width$}")).collect();
    }
    let width = inputs.len().to_string().len().max(4);
    (0..inputs.len()).map(|number| format!("{number:0width$}")).collect()
}

/// A file's name without its endings.
fn stem(path: &Path) -> String {
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    name.split('.').next().unwrap_or_default().to_owned()
}

/// The last run of digits of a name.
fn last_number(name: &str) -> Option<String> {
    let end = name.rfind(|c: char| c.is_ascii_digit())? + 1;
    let start = name[..end]
        .rfind(|c: char| !c.is_ascii_digit())
        .map_or(0, |at| at + name[at..].chars().next().map_or(1, char::len_utf8));
    Some(name[start..end].to_owned())
}

/// The files of the one series in a folder.
fn folder(path: &Path, endings: &[&str]) -> Result<Vec<PathBuf>, Failure> {
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
        0 => Err(wrong(format!("`{place}` holds no file that ends in one of {}", endings.join(", ")))),
        1 => Ok(files),
        _ => {
            let kinds: Vec<&str> = kinds.into_iter().collect();
            let pattern = path.join(format!("*{}", kinds[0]));
            Err(wrong(format!(
                "`{place}` holds files of {} kinds ({}): name one, as in '{}'",
                kinds.len(),
                kinds.join(", "),
                pattern.display()
            )))
        }
    }
}

/// The files of a folder whose names are wanted, in the order of the numbers in their names.
fn list(folder: &Path, wanted: impl Fn(&str) -> bool) -> Result<Vec<PathBuf>, Failure> {
    let entries = std::fs::read_dir(folder)
        .map_err(|error| wrong(format!("cannot list the folder `{}`: {error}", folder.display())))?;
    let mut files: Vec<PathBuf> = entries
        .flatten()
        .filter(|entry| wanted(&entry.file_name().to_string_lossy()))
        .map(|entry| entry.path())
        .filter(|path| path.is_file())
        // As the user wrote it: without a dot before it.
        .map(|path| path.strip_prefix(".").map(Path::to_owned).unwrap_or(path))
        .collect();
    files.sort_by_cached_key(|file| natural(&file.to_string_lossy()));
    Ok(files)
}

fn parent(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// A key that sorts frame_9 before frame_10: text and numbers by turns.
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

/// Whether a name is like a pattern, whose `*` stands for any bytes and whose `?` for one.
fn matches(pattern: &[u8], name: &[u8]) -> bool {
    match (pattern, name) {
        ([], []) => true,
        ([b'*', rest @ ..], _) => (0..=name.len()).any(|skipped| matches(rest, &name[skipped..])),
        ([b'?', rest @ ..], [_, others @ ..]) => matches(rest, others),
        ([byte, rest @ ..], [other, others @ ..]) if byte == other => matches(rest, others),
        _ => false,
    }
}

fn wrong(message: String) -> Failure {
    Failure::new(Exit::Scene, message)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paths(names: &[&str]) -> Vec<PathBuf> {
        names.iter().map(PathBuf::from).collect()
    }

    fn outputs(inputs: &[&str], out: &str) -> Vec<String> {
        let steps = steps(paths(inputs), out.as_ref()).unwrap_or_default();
        steps.iter().map(|step| step.output.display().to_string().replace('\\', "/")).collect()
    }

    #[test]
    fn made_files_have_the_numbers_of_their_files() {
        assert_eq!(outputs(&["a.ply"], "b.obj"), ["b.obj"]);
        assert_eq!(outputs(&["a_7.ply", "a_12.ply"], "m/b.obj"), ["m/b_0007.obj", "m/b_0012.obj"]);
        assert_eq!(outputs(&["a_7.ply", "a_12.ply"], "m/x*y.glb"), ["m/x0007y.glb", "m/x0012y.glb"]);
        assert_eq!(outputs(&["a.ply", "b3.ply"], "c.ply"), ["c_0000.ply", "c_0001.ply"]);
        assert_eq!(outputs(&["x1/a3.ply", "x2/a3.ply"], "c.ply"), ["c_0000.ply", "c_0001.ply"]);
        assert_eq!(
            outputs(&["é12é.bgeo.gz", "é9é.bgeo.gz"], "out/"),
            ["out/surface_0012.ply", "out/surface_0009.ply"]
        );
        assert_eq!(outputs(&["a1.ply", "a2.ply"], "m3"), ["m3/surface_0001.ply", "m3/surface_0002.ply"]);
        assert!(steps(paths(&["a.ply"]), "a.ply".as_ref()).is_err());
        for out in ["m2*/", "m2*/x.ply", "m*/x*.ply"] {
            assert!(
                steps(paths(&["a1.ply", "a2.ply"]), out.as_ref())
                    .is_err_and(|error| error.message.contains("star"))
            );
        }
    }

    #[test]
    fn patterns_and_folders_give_one_series_in_order() -> Result<(), Box<dyn std::error::Error>> {
        let folder = tempfile::tempdir()?;
        for name in ["f_10.ply", "f_9.ply", "f_x.ply", "other.txt", "g_1.ply", ".f_3.ply.partial"] {
            std::fs::write(folder.path().join(name), "")?;
        }
        let names = |given: &str| -> Vec<String> {
            let files = expand(&[folder.path().join(given)], &[".ply", ".vtk"]).unwrap_or_default();
            files.iter().filter_map(|file| Some(file.file_name()?.to_string_lossy().into_owned())).collect()
        };
        assert_eq!(names("f_*.ply"), ["f_9.ply", "f_10.ply", "f_x.ply"]);
        assert_eq!(names("f_?.ply"), ["f_9.ply", "f_x.ply"]);
        assert_eq!(names(""), ["f_9.ply", "f_10.ply", "f_x.ply", "g_1.ply"]);
        assert!(names("h*").is_empty());
        std::fs::write(folder.path().join("z.vtk"), "")?;
        let message =
            expand(&[folder.path().to_owned()], &[".ply", ".vtk"]).map_err(|failure| failure.message);
        assert!(message.is_err_and(|message| message.contains(".ply, .vtk")));
        Ok(())
    }
}
