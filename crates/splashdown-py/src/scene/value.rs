//! Converts Python values to those of scene files, and back.

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyMapping, PyString};
use toml::{Table, Value};

use crate::errors::{Result, SceneError};

/// A dictionary as a table; `place` is its path in the scene.
///
/// # Errors
/// `SceneError` or `TypeError` that names the path.
pub fn table(mapping: &Bound<'_, PyAny>, place: &str) -> Result<Table> {
    match value(mapping, place)? {
        Value::Table(table) => Ok(table),
        _ => Err(PyTypeError::new_err("a scene is a dictionary of sections").into()),
    }
}

/// A value of a key.
///
/// # Errors
/// As [`table`].
pub fn value(given: &Bound<'_, PyAny>, place: &str) -> Result<Value> {
    // NumPy arrays and numbers become lists and numbers.
    let plain;
    let given = if given.hasattr("tolist")? {
        plain = given.call_method0("tolist")?;
        &plain
    } else {
        given
    };
    // A truth value is also an integer in Python.
    if given.cast::<PyBool>().is_ok() {
        return Ok(Value::Boolean(given.extract()?));
    }
    if given.cast::<PyInt>().is_ok() {
        return given.extract().map(Value::Integer).map_err(|_| fail(place, "is an integer beyond 64 bits"));
    }
    if given.cast::<PyFloat>().is_ok() {
        return Ok(Value::Float(given.extract()?));
    }
    if given.cast::<PyString>().is_ok() {
        return Ok(Value::String(given.extract()?));
    }
    if given.hasattr("__fspath__")? {
        return Ok(Value::String(given.call_method0("__fspath__")?.extract()?));
    }
    if let Ok(mapping) = given.cast::<PyMapping>() {
        let mut table = Table::new();
        for pair in mapping.items()? {
            let (key, inner): (Bound<'_, PyAny>, Bound<'_, PyAny>) = pair.extract()?;
            let Ok(key) = key.extract::<String>() else {
                return Err(fail(place, &format!("has the key {}; keys are texts", key.repr()?)));
            };
            let path = if place.is_empty() { key.clone() } else { format!("{place}.{key}") };
            table.insert(key, value(&inner, &path)?);
        }
        return Ok(Value::Table(table));
    }
    if given.is_none() {
        return Err(fail(place, "is None: leave the key out, so that it has its default"));
    }
    match given.try_iter() {
        Ok(items) => {
            let items = items.enumerate().map(|(i, item)| value(&item?, &format!("{place}[{i}]")));
            Ok(Value::Array(items.collect::<Result<_>>()?))
        }
        Err(_) => {
            let kind = given.get_type().name()?;
            Err(fail(
                place,
                &format!("is a {kind}; a number, text, truth value, list or dictionary is needed"),
            ))
        }
    }
}

/// A table as a dictionary.
///
/// # Errors
/// If Python is out of memory.
pub fn dict<'py>(py: Python<'py>, table: &Table) -> Result<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (key, value) in table {
        dict.set_item(key, object(py, value)?)?;
    }
    Ok(dict)
}

fn object<'py>(py: Python<'py>, value: &Value) -> Result<Bound<'py, PyAny>> {
    Ok(match value {
        Value::String(text) => text.into_pyobject(py).map_err(PyErr::from)?.into_any(),
        Value::Integer(number) => number.into_pyobject(py).map_err(PyErr::from)?.into_any(),
        Value::Float(number) => number.into_pyobject(py).map_err(PyErr::from)?.into_any(),
        Value::Boolean(truth) => PyBool::new(py, *truth).to_owned().into_any(),
        // No key of a scene is a date.
        Value::Datetime(date) => date.to_string().into_pyobject(py).map_err(PyErr::from)?.into_any(),
        Value::Array(items) => {
            let items = items.iter().map(|item| object(py, item)).collect::<Result<Vec<_>>>()?;
            PyList::new(py, items)?.into_any()
        }
        Value::Table(table) => dict(py, table)?.into_any(),
    })
}

fn fail(place: &str, what: &str) -> crate::errors::Failure {
    let message = format!("{} {what}", if place.is_empty() { "the scene" } else { place });
    SceneError::new_err((message.clone(), vec![message])).into()
}
