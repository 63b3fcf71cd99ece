//! Read-only arrays over the memory of immutable Rust objects.

use numpy::ndarray::{ArrayView1, ArrayView2};
use numpy::{Element, PyArray1, PyArray2};
use pyo3::PyClass;
use pyo3::prelude::*;
use pyo3::pyclass::boolean_struct::True;
use pyo3::types::PyDict;
use splashdown_io::Attribute;

use super::fail;
use crate::errors::Result;

/// A class whose objects own arrays.
///
/// # Safety
/// A slice that is reached through a shared reference to an object must stay unchanged and in place as long as the object
/// lives, so the object has no interior mutability.
pub unsafe trait Owner: PyClass<Frozen = True> + Sync {}

/// An array (N, 3) over memory of `owner`, which it keeps alive.
///
/// # Errors
/// If Python is out of memory.
pub fn vectors_of<'py, O: Owner, T: Element + bytemuck::Pod>(
    owner: &Bound<'py, O>,
    rows: impl FnOnce(&O) -> &[[T; 3]],
) -> Result<Bound<'py, PyArray2<T>>> {
    let rows = rows(owner.get());
    let flat: &[T] = bytemuck::cast_slice(rows);
    let view = ArrayView2::from_shape((rows.len(), 3), flat).map_err(|error| fail(error.to_string()))?;
    // SAFETY: `Owner` guarantees that the slice stays unchanged and in place; the array holds a reference to the owner.
    let array = unsafe { PyArray2::borrow_from_array(&view, owner.clone().into_any()) };
    read_only(array.as_any())?;
    Ok(array)
}

/// An array (N,) over memory of `owner`, which it keeps alive.
///
/// # Errors
/// As [`vectors_of`].
pub fn scalars_of<'py, O: Owner, T: Element>(
    owner: &Bound<'py, O>,
    values: impl FnOnce(&O) -> &[T],
) -> Result<Bound<'py, PyArray1<T>>> {
    let view = ArrayView1::from(values(owner.get()));
    // SAFETY: as in `vectors_of`.
    let array = unsafe { PyArray1::borrow_from_array(&view, owner.clone().into_any()) };
    read_only(array.as_any())?;
    Ok(array)
}

/// Attributes by name: arrays (N,) or (N, 3) over memory of `owner`.
///
/// # Errors
/// As [`vectors_of`].
pub fn attributes_of<'py, O: Owner>(
    owner: &Bound<'py, O>,
    attributes: impl Fn(&O) -> &[Attribute],
) -> Result<Bound<'py, PyDict>> {
    let found = PyDict::new(owner.py());
    for (index, attribute) in attributes(owner.get()).iter().enumerate() {
        let array = if attribute.components == 3 {
            vectors_of(owner, |o| bytemuck::cast_slice::<f32, [f32; 3]>(&attributes(o)[index].values))?
                .into_any()
        } else {
            scalars_of(owner, |o| attributes(o)[index].values.as_slice())?.into_any()
        };
        found.set_item(&attribute.name, array)?;
    }
    Ok(found)
}

fn read_only(array: &Bound<'_, PyAny>) -> PyResult<()> {
    array.getattr("flags")?.setattr("writeable", false)
}
