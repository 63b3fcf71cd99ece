//! Arguments of functions: whole numbers, and words of scene files.

use pyo3::prelude::*;
use splashdown::scene::Choice;

use crate::errors::{ParameterError, Result};

/// A whole number of at least `least`, if given.
///
/// # Errors
/// `ParameterError` for another number.
pub fn whole(name: &str, value: Option<i64>, least: u32) -> Result<Option<u32>> {
    let Some(value) = value else { return Ok(None) };
    match u32::try_from(value) {
        Ok(number) if number >= least => Ok(Some(number)),
        _ => {
            let most = u32::MAX;
            let message = format!("{name} is {value}; it must be a whole number from {least} to {most}");
            Err(ParameterError::new_err(message).into())
        }
    }
}

/// One word, several with commas as on the command line, or a list.
#[derive(FromPyObject)]
pub enum Words {
    /// `"ply,usd"`.
    One(String),
    /// `["ply", "usd"]`.
    List(Vec<String>),
}

impl Words {
    /// The words of a scene file.
    ///
    /// # Errors
    /// As [`word`].
    pub fn choices<C: Choice>(&self, name: &str) -> Result<Vec<C>> {
        match self {
            Self::One(words) => words.split(',').map(|given| word(name, given.trim())).collect(),
            Self::List(words) => words.iter().map(|given| word(name, given)).collect(),
        }
    }
}

/// A word of a scene file.
///
/// # Errors
/// `ParameterError` that lists the allowed words.
pub fn word<C: Choice>(name: &str, given: &str) -> Result<C> {
    C::from_name(given).ok_or_else(|| {
        let known: Vec<_> = C::ALL.iter().map(|&(_, known, _)| known).collect();
        ParameterError::new_err(format!("{name} has {given:?}; allowed are {}", known.join(", "))).into()
    })
}
