//! Seeds as Python arguments.

use crate::error::Error;
use dapple::hash::Seed;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;

/// A seed: a Python or NumPy integer from 0 to 2^64 - 1.
#[derive(Clone, Copy, Default)]
pub(crate) struct SeedArgument(pub(crate) Seed);

impl<'py> FromPyObject<'_, 'py> for SeedArgument {
    type Error = PyErr;

    fn extract(seed: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let number = seed.call_method0("__index__").map_err(|_| {
            let kind = seed.get_type();
            PyTypeError::new_err(format!("a seed is a whole number, not {kind}"))
        })?;
        let seed = number.extract().map_err(|_| {
            let message = format!("the seed is {number}, but it must be from 0 to 2^64 - 1");
            PyErr::from(Error::new("seed", message))
        })?;
        Ok(Self(Seed(seed)))
    }
}
