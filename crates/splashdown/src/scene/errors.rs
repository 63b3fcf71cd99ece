//! Problems of scene files. All problems are reported at once, each with its line, the given value and the
//! allowed values.

use std::fmt;

use serde::Serialize;

/// Maximum number of problems that are displayed.
const MAX_SHOWN: usize = 40;

/// One problem of a scene file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct SceneProblem {
    /// The file, as given to [`crate::scene::Scene::load`] or [`crate::scene::Scene::parse`].
    pub file: String,
    /// Line, from 1; `None` for a problem of the whole file.
    pub line: Option<usize>,
    /// Column in characters, from 1.
    pub column: Option<usize>,
    /// The key with its path, for example `fluid.block[1].size`; empty if the problem concerns no single key.
    pub key: String,
    /// A description of the problem.
    pub message: String,
    /// The value as written, shortened.
    pub given: Option<String>,
    /// The allowed values.
    pub allowed: Option<String>,
    /// A suggested correction.
    pub hint: Option<String>,
    /// The line of the file, shortened.
    pub text: Option<String>,
    /// The start of the marker in `text` and its length, in characters.
    #[serde(skip)]
    pub(crate) mark: (usize, usize),
}

/// A value that was corrected, or that is valid but probably unintended.
pub type SceneWarning = SceneProblem;

impl SceneProblem {
    /// A problem of the file as a whole.
    pub(crate) fn of_file(file: &str, message: impl Into<String>, hint: &str) -> Self {
        Self {
            file: file.to_owned(),
            line: None,
            column: None,
            key: String::new(),
            message: message.into(),
            given: None,
            allowed: None,
            hint: (!hint.is_empty()).then(|| hint.to_owned()),
            text: None,
            mark: (0, 0),
        }
    }

    fn write(&self, f: &mut fmt::Formatter<'_>, severity: &str) -> fmt::Result {
        write!(f, "{severity}: {}", self.message)?;
        let (Some(line), Some(column), Some(text)) = (self.line, self.column, &self.text) else {
            write!(f, "\n --> {}", self.file)?;
            return self.write_advice(f, 1);
        };
        let gutter = line.to_string().len();
        write!(f, "\n{:gutter$}--> {}:{line}:{column}", "", self.file)?;
        write!(f, "\n{line} | {text}")?;
        let (start, marked) = self.mark;
        let rest = text.chars().count().saturating_sub(start);
        write!(f, "\n{:gutter$} | {:start$}{}", "", "", "^".repeat(marked.clamp(1, rest.max(1))))?;
        self.write_advice(f, gutter)
    }

    fn write_advice(&self, f: &mut fmt::Formatter<'_>, gutter: usize) -> fmt::Result {
        if let Some(allowed) = &self.allowed {
            write!(f, "\n{:gutter$} = allowed: {allowed}", "")?;
        }
        if let Some(hint) = &self.hint {
            write!(f, "\n{:gutter$} = help: {hint}", "")?;
        }
        Ok(())
    }
}

/// Displays the problem as a warning. [`SceneErrors`] displays problems as errors.
impl fmt::Display for SceneProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.write(f, "warning")
    }
}

/// All problems of a scene file in the order of its lines; never empty.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct SceneErrors {
    /// The file, as given.
    pub file: String,
    /// The problems.
    pub errors: Vec<SceneProblem>,
}

impl SceneErrors {
    pub(crate) fn one(problem: SceneProblem) -> Self {
        Self { file: problem.file.clone(), errors: vec![problem] }
    }
}

impl fmt::Display for SceneErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for problem in self.errors.iter().take(MAX_SHOWN) {
            problem.write(f, "error")?;
            f.write_str("\n\n")?;
        }
        let count = self.errors.len();
        if count > MAX_SHOWN {
            writeln!(f, "... and {} more", count - MAX_SHOWN)?;
        }
        let word = if count == 1 { "error" } else { "errors" };
        write!(f, "{count} {word} in {}", self.file)
    }
}

impl std::error::Error for SceneErrors {}
