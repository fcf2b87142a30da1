//! Reads option objects, which are dataclasses of the package, such as `Net`.

use crate::error::Result;
use pyo3::conversion::FromPyObjectOwned;
use pyo3::prelude::*;

/// Reads the option object given for the parameter `name`, an instance of the class `kind` or a dictionary of its
/// fields. `None` stands for the defaults, which only the class declares.
pub(crate) fn read<'py, T: FromPyObjectOwned<'py>>(
    py: Python<'py>,
    kind: &str,
    name: &str,
    given: Option<&Bound<'py, PyAny>>,
) -> Result<T> {
    let module = py.import("dapple_textures._options")?;
    let options = module.call_method1("read", (module.getattr(kind)?, name, given))?;
    Ok(options.extract::<T>().map_err(Into::<PyErr>::into)?)
}
