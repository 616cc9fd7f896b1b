//! Arrays of numpy that show memory owned by Rust: the only unsafe code of the package.
//!
//! A view must not outlive the memory it shows, and that memory must neither move nor change. Both follow
//! from the signature of [`view`]: the memory is borrowed from what an `Arc` holds, through a shared
//! reference, and a clone of that `Arc` is the base object of the array.

#![allow(unsafe_code)]

use numpy::ndarray::ArrayViewD;
use numpy::{Element, PyArray1, PyArrayDyn, PyArrayMethods};
use percute_core::ids::NodeId;
use percute_workflow::report::Named;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::any::Any;
use std::sync::Arc;

/// Keeps the memory of a view alive: the base object of an array.
#[pyclass(frozen, module = "percute._percute")]
struct Owner {
    _memory: Arc<dyn Any + Send + Sync>,
}

/// Shows numbers that `owner` holds as a read-only array of this shape, without a copy.
///
/// # Errors
/// A shape that does not fit the numbers.
pub(crate) fn view<'py, T, O, S>(
    py: Python<'py>,
    owner: &Arc<O>,
    numbers: S,
    shape: &[usize],
) -> PyResult<Bound<'py, PyArrayDyn<T>>>
where
    T: Element,
    O: Any + Send + Sync,
    S: for<'a> FnOnce(&'a O) -> &'a [T],
{
    let memory = numbers(owner.as_ref());
    let shown = ArrayViewD::from_shape(shape, memory).map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
    let base = Bound::new(py, Owner { _memory: owner.clone() })?.into_any();
    // SAFETY: `base` keeps a clone of `owner`, and `memory` is borrowed from what that holds: it stays where it is, as
    // it has shared references only. The array is made read-only before it is returned.
    let array = unsafe { PyArrayDyn::borrow_from_array(&shown, base) };
    array.readwrite().make_nonwriteable();
    Ok(array)
}

/// An array for each of these numbers of the records, by name.
pub(crate) fn columns<'py, R>(py: Python<'py>, records: &[R], numbers: &[Named<R>]) -> PyResult<Bound<'py, PyDict>> {
    let columns = PyDict::new(py);
    for (name, number) in numbers {
        columns.set_item(name, column(py, records, *number))?;
    }
    Ok(columns)
}

/// One number of each record as a read-only array of its own.
pub(crate) fn column<'py, R, T: Element>(
    py: Python<'py>,
    records: &[R],
    number: fn(&R) -> T,
) -> Bound<'py, PyArray1<T>> {
    let array = PyArray1::from_iter(py, records.iter().map(number));
    array.readwrite().make_nonwriteable();
    array
}

/// Node numbers as what they are stored as.
pub(crate) fn numbers(nodes: &[NodeId]) -> &[u32] {
    const { assert!(size_of::<NodeId>() == size_of::<u32>() && align_of::<NodeId>() == align_of::<u32>()) };
    // SAFETY: `NodeId` is a transparent `u32`: same size, same alignment, every bit pattern is one.
    unsafe { std::slice::from_raw_parts(nodes.as_ptr().cast::<u32>(), nodes.len()) }
}
