//! Checked input.

use std::ops::Range;

use numpy::{Element, PyArrayDescrMethods, PyArrayMethods, PyUntypedArray, PyUntypedArrayMethods, dtype};
use pyo3::prelude::*;

use super::fail;
use crate::errors::Result;

/// An array that Python has given, and where it lies in memory.
pub struct Input<T> {
    /// A copy of the values.
    pub values: Vec<T>,
    name: &'static str,
    memory: Range<usize>,
}

impl<T> Input<T> {
    /// Two arrays that share memory are a mistake: one of them has the values of the other.
    ///
    /// # Errors
    /// `ArrayError` if they do.
    pub fn is_apart_from(&self, other: &str, memory: &Range<usize>) -> Result<()> {
        if self.memory.start < memory.end && memory.start < self.memory.end {
            let name = self.name;
            return Err(fail(format!(
                "{name} and {other} share memory: give arrays of their own, for example {name}.copy()"
            )));
        }
        Ok(())
    }
}

/// The arrays of one call, which must not share memory. An array that is absent has no values.
#[derive(Default)]
pub struct Inputs(Vec<(&'static str, Range<usize>)>);

impl Inputs {
    /// The next array, as [`vectors`].
    ///
    /// # Errors
    /// As [`vectors`]; `ArrayError` if it shares memory with an earlier one.
    pub fn vectors(&mut self, name: &'static str, value: Option<&Bound<'_, PyAny>>) -> Result<Vec<[f32; 3]>> {
        self.add(value.map(|value| vectors(name, value)))
    }

    /// The next array: one number per particle, of shape (N,), otherwise as [`vectors`].
    ///
    /// # Errors
    /// As [`Self::vectors`].
    pub fn scalars(&mut self, name: &'static str, value: Option<&Bound<'_, PyAny>>) -> Result<Vec<f32>> {
        self.add(value.map(|value| floats(name, value, None)))
    }

    /// The next array: integers from 0, of shape (N,) or (N, 3), C-contiguous, of uint32, int32 or int64.
    ///
    /// # Errors
    /// As [`Self::vectors`].
    pub fn integers(
        &mut self,
        name: &'static str,
        value: Option<&Bound<'_, PyAny>>,
        columns: Option<usize>,
    ) -> Result<Vec<u32>> {
        self.add(value.map(|value| integers(name, value, columns)))
    }

    fn add<T>(&mut self, input: Option<Result<Input<T>>>) -> Result<Vec<T>> {
        let Some(input) = input.transpose()? else { return Ok(Vec::new()) };
        for (other, memory) in &self.0 {
            input.is_apart_from(other, memory)?;
        }
        self.0.push((input.name, input.memory));
        Ok(input.values)
    }
}

/// The addresses of a slice.
pub fn memory_of<T>(values: &[T]) -> Range<usize> {
    let range = values.as_ptr_range();
    range.start as usize..range.end as usize
}

/// Points or vectors: an array of shape (N, 3), C-contiguous, of float32 or float64, with finite numbers.
///
/// # Errors
/// `ArrayError` that says what was given and how to convert it.
pub fn vectors(name: &'static str, value: &Bound<'_, PyAny>) -> Result<Input<[f32; 3]>> {
    let Input { values, memory, .. } = floats(name, value, Some(3))?;
    Ok(Input { values: bytemuck::pod_collect_to_vec(&values), name, memory })
}

fn integers(name: &'static str, value: &Bound<'_, PyAny>, columns: Option<usize>) -> Result<Input<u32>> {
    let array = checked(name, value, columns)?;
    let py = value.py();
    let memory = memory(&array)?;
    if array.dtype().is_equiv_to(&dtype::<u32>(py)) {
        return Ok(Input { values: copy::<u32>(&array)?, name, memory });
    }
    for (is_equal, read) in [
        (array.dtype().is_equiv_to(&dtype::<i64>(py)), copy::<i64> as fn(&_) -> _),
        (array.dtype().is_equiv_to(&dtype::<i32>(py)), |array: &_| {
            Ok(copy::<i32>(array)?.into_iter().map(i64::from).collect())
        }),
    ] {
        if is_equal {
            let wide: Vec<i64> = read(&array)?;
            let narrow = |(index, &value): (usize, &i64)| {
                u32::try_from(value).map_err(|_| {
                    fail(format!("{name}.flat[{index}] is {value}: give integers from 0 to {}", u32::MAX))
                })
            };
            let values = wide.iter().enumerate().map(narrow).collect::<Result<_>>()?;
            return Ok(Input { values, name, memory });
        }
    }
    let given = array.dtype().str()?.to_string();
    Err(fail(format!("{name} has dtype {given}; integers are needed: use {name}.astype(numpy.uint32)")))
}

fn floats(name: &'static str, value: &Bound<'_, PyAny>, columns: Option<usize>) -> Result<Input<f32>> {
    let array = checked(name, value, columns)?;
    let py = value.py();
    let values = if array.dtype().is_equiv_to(&dtype::<f32>(py)) {
        copy::<f32>(&array)?
    } else if array.dtype().is_equiv_to(&dtype::<f64>(py)) {
        copy::<f64>(&array)?.into_iter().map(|value| value as f32).collect()
    } else {
        let given = array.dtype().str()?.to_string();
        return Err(fail(format!(
            "{name} has dtype {given}; float32 (or float64) is needed: use {name}.astype(numpy.float32)"
        )));
    };
    if let Some(index) = values.iter().position(|value| !value.is_finite()) {
        let place = match columns {
            Some(columns) => format!("{name}[{}, {}]", index / columns, index % columns),
            None => format!("{name}[{index}]"),
        };
        return Err(fail(format!(
            "{place} is not a finite 32-bit number: remove or replace such values, for example with \
             {name}[numpy.isfinite({name}){}]",
            if columns.is_some() { ".all(axis=1)" } else { "" }
        )));
    }
    Ok(Input { values, name, memory: memory(&array)? })
}

/// Checks shape and order.
fn checked<'py>(
    name: &str,
    value: &Bound<'py, PyAny>,
    columns: Option<usize>,
) -> Result<Bound<'py, PyUntypedArray>> {
    let shape = columns.map_or("(N,)".to_owned(), |columns| format!("(N, {columns})"));
    let Ok(array) = value.cast::<PyUntypedArray>() else {
        let given = value.get_type().name()?;
        return Err(fail(format!(
            "{name} is a {given}; a NumPy array of shape {shape} is needed: use numpy.array({name}, dtype=...)"
        )));
    };
    let is_right = match (columns, array.shape()) {
        (Some(columns), [_, last]) => *last == columns,
        (None, [_]) => true,
        _ => false,
    };
    if !is_right {
        let given = array.getattr("shape")?.str()?.to_string();
        let hint = match (columns, array.shape()) {
            (Some(columns), [first, _]) if *first == columns => {
                format!(": use numpy.ascontiguousarray({name}.T)")
            }
            (Some(columns), [n]) if n % columns == 0 => format!(": use {name}.reshape(-1, {columns})"),
            (None, [_, 1]) => format!(": use {name}.ravel()"),
            _ => String::new(),
        };
        return Err(fail(format!("{name} has shape {given}; {shape} is needed{hint}")));
    }
    if !array.is_c_contiguous() {
        let what = if array.strides().contains(&0) {
            "its elements share memory"
        } else {
            "it is not C-contiguous (rows one after the other)"
        };
        return Err(fail(format!("{name}: {what}: use numpy.ascontiguousarray({name})")));
    }
    Ok(array.clone())
}

fn copy<T: Element + Clone>(array: &Bound<'_, PyUntypedArray>) -> Result<Vec<T>> {
    let array = array.cast::<numpy::PyArrayDyn<T>>().map_err(|error| fail(error.to_string()))?;
    let borrowed = array.try_readonly().map_err(|error| fail(error.to_string()))?;
    borrowed.as_slice().map(<[T]>::to_vec).map_err(|_| {
        fail("the array is not aligned in memory: use numpy.require(array, requirements=\"CA\")".into())
    })
}

/// The addresses of the elements of a contiguous array.
fn memory(array: &Bound<'_, PyUntypedArray>) -> Result<Range<usize>> {
    let (start, _): (usize, bool) = array.getattr("__array_interface__")?.get_item("data")?.extract()?;
    Ok(start..start + array.len() * array.dtype().itemsize())
}
