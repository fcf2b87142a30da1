//! Reads numbers that may depend on the position: a number, a ramp, an array over a domain, or a field.

use crate::error::Result;
use crate::field::Field;
use crate::{arrays, data};
use dapple::points::Domain;
use dapple::raster::{Field as _, Varying, Wrap};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// Reads a number that may vary with the position: a number, `{"ramp": …}` or `{"geometric_ramp": …}`, a 2-D field,
/// or an array (rows, columns) that covers the domain. `what` names it in error messages.
pub(crate) fn varying(what: &str, data: &Bound<'_, PyAny>, domain: &Domain) -> Result<Varying> {
    if let Ok(number) = data.extract::<f64>() {
        return Ok(Varying::Constant(number));
    }
    if data.is_instance_of::<PyDict>() {
        return data::options(what, data);
    }
    if let Ok(field) = data.cast::<Field>() {
        let field = field.get().plane()?;
        return Ok(Varying::function(move |position| {
            field.value(position.into()).into()
        }));
    }
    let wrap = domain.wrap.map(|wraps| match wraps {
        true => Wrap::Repeat,
        false => Wrap::Clamp,
    });
    Ok(Varying::Raster {
        raster: Arc::new(arrays::raster(what, data)?),
        origin: domain.origin,
        extent: domain.size,
        wrap,
    })
}
