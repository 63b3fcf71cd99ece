//! Series of files: the files that match a pattern or are in a folder, and the names of the files made from them.

mod list;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::RunError;
use list::{folder, list, matches, parent};

/// An input file and the output file made from it.
#[derive(Debug, PartialEq, Eq)]
pub struct Step {
    /// Read from here.
    pub input: PathBuf,
    /// Written there.
    pub output: PathBuf,
}

/// The files that `given` names, each once. The files of a pattern or folder are in the order of their numbers.
///
/// # Errors
/// [`RunError::Input`] if there is none, or a folder contains files with several of the `endings` (given with dots).
pub fn expand(given: &[PathBuf], endings: &[&str]) -> Result<Vec<PathBuf>, RunError> {
    let mut files = Vec::new();
    for path in given {
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        if path.is_dir() {
            files.extend(folder(path, endings)?);
        } else if name.contains(['*', '?']) && !path.exists() {
            let found = list(parent(path), |file| matches(name.as_bytes(), file.as_bytes()))?;
            if found.is_empty() {
                return Err(RunError::Input(format!(
                    "no file matches `{}`; `*` and `?` stand for parts of a file name, not of a folder",
                    path.display()
                )));
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

/// Names the output of each file. One file gives `out` itself. Several give `out` with each file's number in place of
/// its star, or before its ending. A folder gets files `surface_NUMBER.ply`; for several files a name without star and
/// ending is a folder.
///
/// # Errors
/// [`RunError::Output`] if a file would be read and written, or the name of a folder contains a star.
pub fn steps(inputs: Vec<PathBuf>, out: &Path) -> Result<Vec<Step>, RunError> {
    let single = inputs.len() == 1;
    let is_name =
        out.extension().is_some() || out.file_name().is_some_and(|name| name.to_string_lossy().contains('*'));
    let is_folder =
        out.is_dir() || out.as_os_str().to_string_lossy().ends_with(['/', '\\']) || !(single || is_name);
    let folder = if is_folder { Some(out) } else { out.parent() };
    if folder.is_some_and(|folder| folder.to_string_lossy().contains('*') && !folder.is_dir()) {
        return Err(RunError::Output(format!(
            "`{}` has a star in the name of a folder; a star stands for the number in the name of a file",
            out.display()
        )));
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
            Err(RunError::Output(format!("`{file}` would be read and written: choose another output")))
        }
        None => Ok(steps),
    }
}

/// Whether two paths name the same file or folder.
pub fn is_same(a: &Path, b: &Path) -> bool {
    match (a.canonicalize(), b.canonicalize()) {
        (Ok(a), Ok(b)) => a == b,
        _ => a == b,
    }
}

/// The numbers in the files' names if they are all different, else consecutive numbers.
fn numbers(inputs: &[PathBuf]) -> Vec<String> {
    let own: Vec<String> = inputs.iter().filter_map(|input| last_number(&stem(input))).collect();
    let distinct: BTreeSet<&String> = own.iter().collect();
    if distinct.len() == inputs.len() {
        // Numbers are padded to the longest, so that the output files sort by number.
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

/// The last group of digits in a name.
fn last_number(name: &str) -> Option<String> {
    let end = name.rfind(|c: char| c.is_ascii_digit())? + 1;
    let start = name[..end]
        .rfind(|c: char| !c.is_ascii_digit())
        .map_or(0, |at| at + name[at..].chars().next().map_or(1, char::len_utf8));
    Some(name[start..end].to_owned())
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
    fn output_files_have_the_numbers_of_their_input_files() {
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
                    .is_err_and(|error| error.to_string().contains("star"))
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
            expand(&[folder.path().to_owned()], &[".ply", ".vtk"]).map_err(|error| error.to_string());
        assert!(message.is_err_and(|message| message.contains(".ply, .vtk")));
        Ok(())
    }
}
