//! Converts TOML values to checked Rust values, or to descriptions of what is wrong with them.

use toml::de::DeValue;

use super::spec::{Key, Kind, Range, UNITS, Word, number};
use super::suggest;

/// A problem of a value, without the path of its key.
pub(crate) struct Wrong {
    pub message: String,
    pub allowed: String,
    pub hint: Option<String>,
    /// The index and the location of the item in question, if the value is a list.
    pub item: Option<(usize, std::ops::Range<usize>)>,
}

/// All problems of one key's value. Each item of a list can have one.
pub(crate) struct Wrongs(pub Vec<Wrong>);

impl From<Wrong> for Wrongs {
    fn from(wrong: Wrong) -> Self {
        Self(vec![wrong])
    }
}

pub(crate) fn kind_of(value: &DeValue<'_>) -> &'static str {
    match value {
        DeValue::String(_) => "a text",
        DeValue::Integer(_) | DeValue::Float(_) => "a number",
        DeValue::Boolean(_) => "true or false",
        DeValue::Datetime(_) => "a date",
        DeValue::Array(_) => "a list",
        DeValue::Table(_) => "a table",
    }
}

pub(crate) fn wrong_type(value: &DeValue<'_>, wanted: &str, allowed: String) -> Wrong {
    Wrong { message: format!("must be {wanted}, not {}", kind_of(value)), allowed, hint: None, item: None }
}

pub(crate) fn one_number(value: &DeValue<'_>, range: Range) -> Result<f64, Wrong> {
    let given = match value {
        DeValue::Integer(whole) => {
            i128::from_str_radix(whole.as_str(), whole.radix()).ok().map(|whole| whole as f64)
        }
        DeValue::Float(float) => float.as_str().parse().ok(),
        other => {
            let mut wrong = wrong_type(other, "a number", range.to_string());
            wrong.hint = match other {
                DeValue::String(text) if text.trim().parse::<f64>().is_ok() => {
                    Some("write it without quotes".into())
                }
                DeValue::String(text) if text.trim_start().starts_with(|c: char| c.is_ascii_digit()) => {
                    Some(number_alone(range.unit))
                }
                _ => None,
            };
            return Err(wrong);
        }
    };
    let given = given.unwrap_or(f64::INFINITY);
    if !given.is_finite() {
        return Err(Wrong {
            message: "is not a finite number".into(),
            allowed: range.to_string(),
            hint: None,
            item: None,
        });
    }
    in_range(given, range)
}

/// A number, or the name of a unit of length.
pub(crate) fn one_scale(value: &DeValue<'_>, range: Range) -> Result<f64, Wrong> {
    let DeValue::String(given) = value else {
        return one_number(value, range).map_err(|wrong| Wrong { allowed: scales(range), ..wrong });
    };
    if let Some((_, metres)) = UNITS.iter().find(|(word, _)| word == given) {
        return Ok(*metres);
    }
    let names: Vec<&str> = UNITS.iter().map(|(word, _)| *word).collect();
    let long = [
        ("millimet", "mm"),
        ("centimet", "cm"),
        ("met", "m"),
        ("inch", "in"),
        ("foot", "ft"),
        ("feet", "ft"),
        ("\"", "in"),
        ("'", "ft"),
    ];
    let lower = given.trim().to_ascii_lowercase();
    let meant = names
        .iter()
        .copied()
        .find(|name| *name == lower)
        .or_else(|| long.iter().find(|(start, _)| lower.starts_with(start)).map(|(_, word)| *word));
    let hint = if lower.parse::<f64>().is_ok() {
        Some("write the number without quotes".to_owned())
    } else {
        meant.map(|word| format!("did you mean {word:?}?"))
    };
    let shown: String = given.chars().filter(|c| !c.is_control()).take(40).collect();
    Err(Wrong { message: format!("cannot be {shown:?}"), allowed: scales(range), hint, item: None })
}

/// The scale of each axis: a list of three, or one for all.
pub(crate) fn three_scales(value: &DeValue<'_>, range: Range) -> Result<Vec<f64>, Wrongs> {
    match value {
        DeValue::Array(_) => several(value, 3, range, one_scale),
        _ => Ok(vec![one_scale(value, range)?; 3]),
    }
}

fn scales(range: Range) -> String {
    let words: Vec<_> = UNITS.iter().map(|(word, _)| format!("{word:?}")).collect();
    format!("{range}, or the file's unit: {}", words.join(", "))
}

fn number_alone(unit: &str) -> String {
    if unit.is_empty() {
        "write the number alone".to_owned()
    } else {
        format!("write the number alone, in {unit}")
    }
}

pub(crate) fn one_integer(value: &DeValue<'_>, range: Range) -> Result<f64, Wrong> {
    match value {
        DeValue::Integer(_) => one_number(value, range),
        other => Err(wrong_type(other, "a whole number", range.to_string()).float_is(other)),
    }
}

impl Wrong {
    /// Replaces "must be a whole number, not a number" for a value with a fraction.
    fn float_is(mut self, value: &DeValue<'_>) -> Self {
        if let DeValue::Float(_) = value {
            self.message = "must be a whole number".into();
        }
        self
    }
}

fn in_range(given: f64, range: Range) -> Result<f64, Wrong> {
    if range.contains(given) {
        return Ok(given);
    }
    let message = format!("is {}, which is out of range", number(given));
    Err(Wrong { message, allowed: range.to_string(), hint: None, item: None })
}

pub(crate) fn several(
    value: &DeValue<'_>,
    count: usize,
    range: Range,
    one: fn(&DeValue<'_>, Range) -> Result<f64, Wrong>,
) -> Result<Vec<f64>, Wrongs> {
    let allowed = format!("{count} numbers, each {range}");
    let DeValue::Array(list) = value else {
        return Err(wrong_type(value, &format!("a list of {count} numbers"), allowed).into());
    };
    if list.len() != count {
        let message = format!("has {} numbers", list.len());
        return Err(Wrong { message, allowed, hint: None, item: None }.into());
    }
    let (mut numbers, mut wrongs) = (Vec::with_capacity(count), Vec::new());
    for (index, item) in list.iter().enumerate() {
        match one(item.get_ref(), range) {
            Ok(number) => numbers.push(number),
            Err(wrong) => {
                wrongs.push(Wrong { allowed: allowed.clone(), item: Some((index, item.span())), ..wrong })
            }
        }
    }
    if wrongs.is_empty() { Ok(numbers) } else { Err(Wrongs(wrongs)) }
}

pub(crate) fn one_word(value: &DeValue<'_>, words: &[Word]) -> Result<&'static str, Wrong> {
    let DeValue::String(given) = value else { return Err(wrong_type(value, "a text", list_words(words))) };
    if let Some((word, _)) = words.iter().find(|(word, _)| word == given) {
        return Ok(word);
    }
    let names: Vec<_> = words.iter().map(|(word, _)| *word).collect();
    let spelled = given.to_ascii_lowercase().replace(['-', ' '], "_");
    let hint = suggest::closest(&spelled, &names).map(|word| format!("did you mean {word:?}?"));
    let shown: String = given.chars().filter(|c| !c.is_control()).take(40).collect();
    Err(Wrong { message: format!("cannot be {shown:?}"), allowed: list_words(words), hint, item: None })
}

pub(crate) fn list_words(words: &[Word]) -> String {
    words.iter().map(|(word, _)| format!("{word:?}")).collect::<Vec<_>>().join(", ")
}

/// A description of the values that a key accepts.
pub(crate) fn describe(key: &Key) -> String {
    match key.kind {
        Kind::Number(range) => range.to_string(),
        Kind::Numbers(count, range) => format!("{count} numbers, each {range}"),
        Kind::Scale(range) => scales(range),
        Kind::Scales(range) => format!("{}; or three of them, one for each axis of the file", scales(range)),
        Kind::Integer(range) => format!("whole, {range}"),
        Kind::Integers(count, range) => format!("{count} whole numbers, each {range}"),
        Kind::Boolean => "true, false".to_owned(),
        Kind::Name => "1 to 64 letters, digits, `-` and `_`".to_owned(),
        Kind::Text(what) | Kind::Line(what) => what.to_owned(),
        Kind::Texts(count, what) => format!("{count} texts of {what}"),
        Kind::Word(words) => list_words(&words()),
        Kind::Words(words) => format!("a list of {}", list_words(&words())),
        Kind::Table(_) => "a section".to_owned(),
        Kind::Tables(_, most) => format!("1 to {most} sections"),
    }
}
