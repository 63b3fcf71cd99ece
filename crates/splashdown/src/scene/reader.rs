//! Reads a TOML file according to the table of keys and collects all problems.
//!
//! Why not serde: it stops at the first error. Here each key is read separately. A key with a problem reports
//! it and has the value `Err(Reported)`, and reading continues.

use std::cell::RefCell;
use std::ops::Range as Span;
use std::path::{Path, PathBuf};

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::choice::Choice;
use super::errors::SceneProblem;
use super::source::Source;
use super::spec::{Key, Kind, LONGEST_LINE, Table};
use super::suggest;
use super::values::{
    Wrong, Wrongs, describe, kind_of, list_words, one_integer, one_number, one_scale, one_word, several,
    three_scales, wrong_type,
};

/// Maximum number of problems that are collected. It bounds time and memory for files that are no scenes.
const MAX_PROBLEMS: usize = 200;

/// Marks a value whose problem has already been reported.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reported;

/// A value, `None` for an absent key, or a problem that has already been reported.
pub(crate) type Read<T> = Result<Option<T>, Reported>;

/// Collects the problems of one file.
pub(crate) struct Reader<'a> {
    pub source: Source<'a>,
    /// The folder to which file names are relative; `None` for a text without a file.
    folder: Option<&'a Path>,
    problems: RefCell<Vec<SceneProblem>>,
    warnings: RefCell<Vec<SceneProblem>>,
}

impl<'a> Reader<'a> {
    pub fn new(source: Source<'a>, folder: Option<&'a Path>) -> Self {
        Self { source, folder, problems: RefCell::default(), warnings: RefCell::default() }
    }

    pub fn report(&self, problem: SceneProblem) -> Reported {
        let mut problems = self.problems.borrow_mut();
        // A section that is read twice reports its unknown keys twice.
        if problems.len() < MAX_PROBLEMS && !problems.contains(&problem) {
            problems.push(problem);
        }
        Reported
    }

    /// Problems and warnings in the order of the file's lines.
    pub fn finish(self) -> (Vec<SceneProblem>, Vec<SceneProblem>) {
        let sorted = |list: RefCell<Vec<SceneProblem>>| {
            let mut list = list.into_inner();
            list.sort_by_key(|problem| (problem.line, problem.column));
            list
        };
        (sorted(self.problems), sorted(self.warnings))
    }
}

/// One table of the file, with its declaration.
pub(crate) struct Section<'r> {
    reader: &'r Reader<'r>,
    /// `None` if the file does not have this section.
    table: Option<&'r DeTable<'r>>,
    spec: &'static Table,
    /// For messages: `fluid.block[1]`; empty for the root.
    path: String,
    /// For suggestions: `fluid.block`.
    spec_path: String,
    span: Span<usize>,
}

impl<'r> Section<'r> {
    /// The root of the file. Reports its unknown and missing keys.
    pub fn root(reader: &'r Reader<'r>, table: &'r DeTable<'r>, spec: &'static Table) -> Self {
        let root = Self {
            reader,
            table: Some(table),
            spec,
            path: String::new(),
            spec_path: String::new(),
            span: 0..0,
        };
        root.check_keys();
        root
    }

    fn check_keys(&self) {
        let Some(table) = self.table else { return };
        for name in table.keys().filter(|name| self.spec.key(name.get_ref()).is_none()) {
            match self.spec.key_formerly(name.get_ref()) {
                Some(key) => self.report_former(name, key),
                None => self.report_unknown(name),
            }
        }
        for key in self.spec.keys.iter().filter(|key| key.required && !self.has(key.name)) {
            let (what, hint) = match key.kind {
                Kind::Table(inner) => (format!("the section [{}] is missing", key.name), Some(list_required(inner))),
                Kind::Tables(..) => (
                    format!("there is no [[{}]]", self.key_path(key.name)),
                    Some("a scene needs at least one, for example position = [0, 0, 0] and size = [0.2, 0.2, 0.2]".to_owned()),
                ),
                _ => (format!("the key {} is missing", self.key_path(key.name)), None),
            };
            let mut problem = if self.path.is_empty() {
                SceneProblem::of_file(self.reader.source.file, what, "")
            } else {
                self.reader.source.problem(self.span.clone(), String::new(), what)
            };
            problem.key = self.key_path(key.name);
            problem.allowed = (!matches!(key.kind, Kind::Table(_))).then(|| describe(key));
            problem.hint = hint;
            self.reader.report(problem);
        }
    }

    /// Warns of a key's former name. Reports an error if the present name is given as well.
    fn report_former(&self, name: &Spanned<std::borrow::Cow<'r, str>>, key: &Key) {
        let (former, present) = (self.key_path(name.get_ref()), self.key_path(key.name));
        let is_twice = self.table.is_some_and(|table| table.contains_key(key.name));
        let message = if is_twice {
            format!("{former} is the former name of {present}, which is also given")
        } else {
            format!("{former} is deprecated: the key is now called {present}")
        };
        let mut problem = self.reader.source.problem(name.span(), former, message);
        problem.hint = Some(format!("write {present}"));
        if is_twice {
            self.reader.report(problem);
        } else {
            self.reader.warnings.borrow_mut().push(problem);
        }
    }

    fn report_unknown(&self, name: &Spanned<std::borrow::Cow<'r, str>>) {
        let path = self.key_path(&self.reader.source.excerpt(name.span()));
        let is_section = self.path.is_empty()
            && self.value(name.get_ref()).is_some_and(|value| value.get_ref().is_table());
        let message =
            if is_section { format!("unknown section [{path}]") } else { format!("unknown key {path}") };
        let mut problem = self.reader.source.problem(name.span(), path, message);
        problem.hint = suggest::for_key(name.get_ref(), self.spec, &self.spec_path);
        let known: Vec<_> = self.spec.keys.iter().map(|key| key.name).collect();
        problem.allowed = Some(known.join(", "));
        self.reader.report(problem);
    }

    /// The path of a file that this key names. It is relative to the scene file's folder if that is known;
    /// then the file must exist.
    pub fn file(&self, name: &str, file: &str) -> Result<PathBuf, Reported> {
        let Some(folder) = self.reader.folder else { return Ok(file.into()) };
        let path = folder.join(file);
        if path.exists() {
            return Ok(path);
        }
        let message = format!("{}: there is no file {:?}", self.key_path(name), path.display().to_string());
        let hint = "file names are relative to the folder of the scene file";
        Err(self.complain(name, message, "", hint))
    }

    /// Whether the folder of the scene file is known, so that the files named in it can be opened.
    pub fn has_folder(&self) -> bool {
        self.reader.folder.is_some()
    }

    /// The section's own path, for example `fluid.block[1]`.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// The key with its path.
    pub fn key_path(&self, name: &str) -> String {
        if self.path.is_empty() { name.to_owned() } else { format!("{}.{name}", self.path) }
    }

    /// Whether the file has this key.
    pub fn has(&self, name: &str) -> bool {
        self.value(name).is_some()
    }

    fn value(&self, name: &str) -> Option<&'r Spanned<DeValue<'r>>> {
        let table = self.table?;
        table.get(name).or_else(|| {
            let key = self.spec.key(name)?;
            key.formerly.iter().find_map(|former| table.get(*former))
        })
    }

    /// The location of a key's value, or of the section if the key is absent.
    fn span_of(&self, name: &str) -> Span<usize> {
        self.value(name).map_or_else(|| self.span.clone(), Spanned::span)
    }

    fn problem(&self, name: &str, message: String, allowed: &str, hint: &str) -> SceneProblem {
        let mut problem = self.reader.source.problem(self.span_of(name), self.key_path(name), message);
        problem.given = self.value(name).map(|value| self.reader.source.excerpt(value.span()));
        problem.allowed = (!allowed.is_empty()).then(|| allowed.to_owned());
        problem.hint = (!hint.is_empty()).then(|| hint.to_owned());
        problem
    }

    /// Reports a problem at this key.
    pub fn complain(&self, name: &str, message: String, allowed: &str, hint: &str) -> Reported {
        self.reader.report(self.problem(name, message, allowed, hint))
    }

    /// Adds a warning at this key.
    pub fn warn(&self, name: &str, message: String, hint: &str) {
        let warning = self.problem(name, message, "", hint);
        self.reader.warnings.borrow_mut().push(warning);
    }

    /// Reads a key. `convert` must expect the kind that the table of keys declares.
    fn read<T, E: Into<Wrongs>>(
        &self,
        name: &str,
        convert: impl FnOnce(&DeValue<'r>, Kind) -> Result<T, E>,
    ) -> Read<T> {
        let Some(key) = self.spec.key(name) else {
            unreachable!("{name} is read but not declared in keys/");
        };
        let Some(value) = self.value(name) else {
            return if key.required { Err(Reported) } else { Ok(None) };
        };
        convert(value.get_ref(), key.kind).map(Some).map_err(|wrongs| {
            for wrong in wrongs.into().0 {
                self.report_wrong(name, value.span(), wrong);
            }
            Reported
        })
    }

    fn report_wrong(&self, name: &str, span: Span<usize>, wrong: Wrong) {
        let (index, span) =
            wrong.item.map_or((String::new(), span), |(index, span)| (format!("[{index}]"), span));
        let key = format!("{}{index}", self.key_path(name));
        let message = format!("{key} {}", wrong.message);
        self.reader.report(SceneProblem {
            given: Some(self.reader.source.excerpt(span.clone())),
            allowed: (!wrong.allowed.is_empty()).then_some(wrong.allowed),
            hint: wrong.hint,
            ..self.reader.source.problem(span, key, message)
        });
    }

    pub fn number(&self, name: &str) -> Read<f32> {
        self.read(name, |value, kind| match kind {
            Kind::Number(range) => one_number(value, range).map(|x| x as f32),
            _ => Err(undeclared(kind)),
        })
    }

    /// A number, or the name of a unit of length, converted to metres.
    pub fn scale(&self, name: &str) -> Read<f32> {
        self.read(name, |value, kind| match kind {
            Kind::Scale(range) => one_scale(value, range).map(|x| x as f32),
            _ => Err(undeclared(kind)),
        })
    }

    /// Such a scale for each axis of a file.
    pub fn scales(&self, name: &str) -> Read<[f32; 3]> {
        self.read(name, |value, kind| match kind {
            Kind::Scales(range) => {
                three_scales(value, range).map(|list| std::array::from_fn(|i| list[i] as f32))
            }
            _ => Err(undeclared(kind).into()),
        })
    }

    pub fn numbers<const N: usize>(&self, name: &str) -> Read<[f32; N]> {
        self.read(name, |value, kind| match kind {
            Kind::Numbers(count, range) if count == N => {
                several(value, N, range, one_number).map(|list| std::array::from_fn(|i| list[i] as f32))
            }
            _ => Err(undeclared(kind).into()),
        })
    }

    pub fn integer(&self, name: &str) -> Read<u32> {
        self.read(name, |value, kind| match kind {
            Kind::Integer(range) => one_integer(value, range).map(|x| x as u32),
            _ => Err(undeclared(kind)),
        })
    }

    pub fn integers<const N: usize>(&self, name: &str) -> Read<[u32; N]> {
        self.read(name, |value, kind| match kind {
            Kind::Integers(count, range) if count == N => {
                several(value, N, range, one_integer).map(|list| std::array::from_fn(|i| list[i] as u32))
            }
            _ => Err(undeclared(kind).into()),
        })
    }

    pub fn boolean(&self, name: &str) -> Read<bool> {
        self.read(name, |value, _| match value {
            DeValue::Boolean(value) => Ok(*value),
            other => Err(wrong_type(other, "true or false", "true, false".into())),
        })
    }

    /// A name that can be used as a folder name.
    pub fn name(&self, name: &str) -> Read<String> {
        self.read(name, |value, _| {
            let allowed = "1 to 64 letters, digits, `-` and `_`, a letter or digit first";
            let DeValue::String(text) = value else {
                return Err(wrong_type(value, "a text", allowed.into()));
            };
            let legal = text.len() <= 64
                && text.starts_with(|c: char| c.is_ascii_alphanumeric())
                && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '-' || c == '_');
            let hint = Some("it also names the output folder".to_owned());
            if legal {
                Ok(text.to_string())
            } else {
                Err(Wrong {
                    message: "is not a usable name".into(),
                    allowed: allowed.into(),
                    hint,
                    item: None,
                })
            }
        })
    }

    /// A text that is not empty.
    pub fn text(&self, name: &str) -> Read<String> {
        self.read(name, |value, kind| match kind {
            Kind::Text(what) => one_text(value, what),
            _ => Err(undeclared(kind)),
        })
    }

    /// A text that may be empty, of one line.
    pub fn line(&self, name: &str) -> Read<String> {
        self.read(name, |value, kind| match (kind, value) {
            (Kind::Line(_), DeValue::String(text)) if is_line(text) => Ok(text.to_string()),
            (Kind::Line(what), DeValue::String(_)) => Err(Wrong {
                message: format!("must be one line of at most {LONGEST_LINE} characters"),
                allowed: what.to_owned(),
                hint: None,
                item: None,
            }),
            (Kind::Line(what), other) => Err(wrong_type(other, "a text in quotes", what.to_owned())),
            _ => Err(undeclared(kind)),
        })
    }

    /// A list of texts.
    pub fn texts<const N: usize>(&self, name: &str) -> Read<[String; N]> {
        self.read(name, |value, kind| match kind {
            Kind::Texts(count, what) if count == N => {
                let list =
                    value.as_array().ok_or_else(|| wrong_type(value, "a list", describe_texts(N, what)))?;
                if list.len() != N {
                    return Err(Wrong {
                        message: format!("must be a list of {N} texts, not of {}", list.len()),
                        allowed: describe_texts(N, what),
                        hint: None,
                        item: None,
                    });
                }
                let mut texts = std::array::from_fn(|_| String::new());
                for (text, item) in texts.iter_mut().zip(list) {
                    *text = one_text(item.get_ref(), what)?;
                }
                Ok(texts)
            }
            _ => Err(undeclared(kind)),
        })
    }

    /// One of the words that the table of keys declares.
    pub fn word(&self, name: &str) -> Read<String> {
        self.read(name, |value, kind| match kind {
            Kind::Word(words) => one_word(value, &words()).map(str::to_owned),
            _ => Err(undeclared(kind)),
        })
    }

    pub fn choice<C: Choice>(&self, name: &str) -> Read<C> {
        Ok(self.word(name)?.and_then(|word| C::from_name(&word)))
    }

    pub fn choices<C: Choice>(&self, name: &str) -> Read<Vec<C>> {
        self.read(name, |value, kind| {
            let Kind::Words(words) = kind else { return Err(undeclared(kind).into()) };
            let words = words();
            let DeValue::Array(list) = value else {
                let mut wrong = wrong_type(value, "a list", list_words(&words));
                wrong.hint = value.as_str().map(|text| format!("write it in brackets: [{text:?}]"));
                return Err(wrong.into());
            };
            let (mut found, mut wrongs): (Vec<&'static str>, _) = (Vec::new(), Vec::new());
            for (index, item) in list.iter().enumerate() {
                let wrong = match one_word(item.get_ref(), &words) {
                    Ok(word) if found.contains(&word) => Wrong {
                        message: format!("names {word:?} twice"),
                        allowed: list_words(&words),
                        hint: None,
                        item: None,
                    },
                    Ok(word) => {
                        found.push(word);
                        continue;
                    }
                    Err(wrong) => wrong,
                };
                wrongs.push(Wrong { item: Some((index, item.span())), ..wrong });
            }
            if !wrongs.is_empty() {
                return Err(Wrongs(wrongs));
            }
            Ok(found.into_iter().filter_map(C::from_name).collect())
        })
    }

    /// A section. If the file does not have it, all its keys are absent.
    pub fn section(&self, name: &str) -> Result<Section<'r>, Reported> {
        let spec = match self.spec.key(name).map(|key| key.kind) {
            Some(Kind::Table(spec)) => spec,
            _ => unreachable!("{name} is read as a section but not declared as one in keys/"),
        };
        let table = match self.value(name) {
            None => None,
            Some(value) => Some(self.as_table(name, value)?),
        };
        Ok(self.child(name, None, table, spec, self.span_of(name)))
    }

    /// A list of sections. Items that are not tables are reported and left out.
    pub fn sections(&self, name: &str) -> Result<Vec<Section<'r>>, Reported> {
        let Some(Kind::Tables(spec, most)) = self.spec.key(name).map(|key| key.kind) else {
            unreachable!("{name} is read as a list of sections but not declared as one in keys/");
        };
        let Some(value) = self.value(name) else { return Err(Reported) };
        let DeValue::Array(list) = value.get_ref() else {
            let path = self.key_path(name);
            let message = format!("{path} must be a list of tables, not {}", kind_of(value.get_ref()));
            return Err(self.complain(name, message, "", &format!("write [[{path}]] with two brackets")));
        };
        if list.is_empty() || list.len() > most {
            let message = format!("{} has {} entries", self.key_path(name), list.len());
            return Err(self.complain(name, message, &format!("1 to {most}"), ""));
        }
        let mut found = Vec::new();
        for (index, item) in list.iter().enumerate() {
            match item.get_ref() {
                DeValue::Table(table) => {
                    found.push(self.child(name, Some(index), Some(table), spec, item.span()))
                }
                other => {
                    let path = format!("{}[{index}]", self.key_path(name));
                    let message = format!("{path} must be a table, not {}", kind_of(other));
                    self.reader.report(self.reader.source.problem(item.span(), path, message));
                }
            }
        }
        Ok(found)
    }

    /// A list of sections that may be absent.
    pub fn sections_if_any(&self, name: &str) -> Result<Vec<Section<'r>>, Reported> {
        if self.has(name) { self.sections(name) } else { Ok(Vec::new()) }
    }

    fn as_table(&self, name: &str, value: &'r Spanned<DeValue<'r>>) -> Result<&'r DeTable<'r>, Reported> {
        match value.get_ref() {
            DeValue::Table(table) => Ok(table),
            other => {
                let path = self.key_path(name);
                let message = format!("{path} must be a section, not {}", kind_of(other));
                Err(self.complain(name, message, "", &format!("write [{path}] on a line of its own")))
            }
        }
    }

    fn child(
        &self,
        name: &str,
        index: Option<usize>,
        table: Option<&'r DeTable<'r>>,
        spec: &'static Table,
        span: Span<usize>,
    ) -> Section<'r> {
        let base = self.key_path(name);
        let path = index.map_or_else(|| base.clone(), |index| format!("{base}[{index}]"));
        let spec_path =
            if self.spec_path.is_empty() { name.to_owned() } else { format!("{}.{name}", self.spec_path) };
        let child = Section { reader: self.reader, table, spec, path, spec_path, span };
        child.check_keys();
        child
    }

    /// Whether the file has this section.
    pub fn exists(&self) -> bool {
        self.table.is_some()
    }
}

fn one_text(value: &DeValue<'_>, what: &str) -> Result<String, Wrong> {
    match value {
        DeValue::String(text) if !text.trim().is_empty() => Ok(text.to_string()),
        DeValue::String(_) => Err(Wrong {
            message: "must not be empty".to_owned(),
            allowed: what.to_owned(),
            hint: None,
            item: None,
        }),
        other => Err(wrong_type(other, "a text in quotes", what.to_owned())),
    }
}

fn is_line(text: &str) -> bool {
    text.chars().count() <= LONGEST_LINE && !text.contains(['\r', '\n'])
}

fn describe_texts(count: usize, what: &str) -> String {
    format!("{count} texts of {what}")
}

/// The error of a key that is declared and read as different kinds. This is a bug in this crate, reported as
/// an error rather than a panic.
fn undeclared(kind: Kind) -> Wrong {
    Wrong {
        message: format!("is declared as {kind:?} but read as something else"),
        allowed: String::new(),
        hint: None,
        item: None,
    }
}

fn list_required(table: &Table) -> String {
    let names: Vec<_> = table.keys.iter().filter(|key| key.required).map(|key| key.name).collect();
    format!("it needs {}", names.join(", "))
}
