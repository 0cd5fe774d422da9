//! Conversion of points and vectors between numpy and the engine.

use geometry::{Point3, Vector3};
use numpy::ndarray::{ArrayView2, ArrayViewD};
use numpy::{AllowTypeChange, Element, PyArray1, PyArray2, PyArrayLike2, PyArrayLikeDyn, PyArrayMethods};
use pyo3::prelude::*;

use crate::error::input;

/// A two-dimensional array of numbers, or an object that numpy converts to such an array.
pub(crate) type Floats2<'py> = PyArrayLike2<'py, f64, AllowTypeChange>;
/// An array of numbers of any dimension, or an object that numpy converts to such an array.
pub(crate) type Floats<'py> = PyArrayLikeDyn<'py, f64, AllowTypeChange>;

/// Returns rows of three numbers as an (n, 3) array.
pub(crate) fn rows_of<'py>(
    py: Python<'py>,
    rows: impl Iterator<Item = [f64; 3]>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    matrix(py, rows.flatten().collect(), 3)
}

/// Returns a list of numbers, row by row, as an array with the given number of columns, which owns the data.
pub(crate) fn matrix<T: Element>(
    py: Python<'_>,
    all: Vec<T>,
    columns: usize,
) -> PyResult<Bound<'_, PyArray2<T>>> {
    let rows = all.len() / columns.max(1);
    PyArray1::from_vec(py, all).reshape([rows, columns])
}

/// Converts an (n, 3) array to vectors.
pub(crate) fn vectors(py: Python<'_>, what: &str, array: ArrayView2<'_, f64>) -> PyResult<Vec<Vector3>> {
    if array.ncols() != 3 {
        let problem = format!("{what}: has the shape ({}, {}); give (n, 3)", array.nrows(), array.ncols());
        return Err(input(py, &problem));
    }
    Ok(array.rows().into_iter().map(|row| Vector3::new(row[0], row[1], row[2])).collect())
}

/// Converts an (n, 3) array to points, and refuses numbers that are not finite.
pub(crate) fn points(py: Python<'_>, what: &str, array: ArrayView2<'_, f64>) -> PyResult<Vec<Point3>> {
    let all = vectors(py, what, array)?;
    match all.iter().position(|x| !x.iter().all(|c| c.is_finite())) {
        Some(bad) => Err(input(py, &format!("{what}: row {bad} has a number that is not finite"))),
        None => Ok(all.into_iter().map(Point3::from).collect()),
    }
}

/// Converts an (m, k) array of non-negative integers to node numbers.
pub(crate) fn numbers(py: Python<'_>, what: &str, array: ArrayView2<'_, f64>) -> PyResult<Vec<u32>> {
    let largest = f64::from(u32::MAX);
    match array.iter().position(|n| !(n.fract() == 0.0 && (0.0..=largest).contains(n))) {
        Some(bad) => {
            let row = bad / array.ncols();
            let n = array.iter().nth(bad).copied().unwrap_or(f64::NAN);
            Err(input(py, &format!("{what}: row {row} names node {n}; give whole numbers from 0 on")))
        }
        None => Ok(array.iter().map(|&n| n as u32).collect()),
    }
}

/// Returns the fields of an (n, 3) or (steps, n, 3) array.
pub(crate) fn fields(py: Python<'_>, what: &str, array: ArrayViewD<'_, f64>) -> PyResult<Vec<Vec<Vector3>>> {
    let shape = array.shape().to_vec();
    let wrong = || input(py, &format!("{what}: has the shape {shape:?}; give (n, 3) or (steps, n, 3)"));
    match array.ndim() {
        2 => Ok(vec![vectors(py, what, array.into_dimensionality().map_err(|_| wrong())?)?]),
        3 => array
            .outer_iter()
            .map(|one| vectors(py, what, one.into_dimensionality().map_err(|_| wrong())?))
            .collect(),
        _ => Err(wrong()),
    }
}
