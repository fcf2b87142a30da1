//! The domain of a point set: a rectangle that may wrap along each axis.

use crate::error::Result;
use crate::grid::pair;
use dapple::raster::glam::DVec2;
use pyo3::prelude::*;
use pyo3::types::PyBool;

/// A rectangle whose opposite sides may be joined along each axis: a torus, a cylinder or a plain rectangle.
///
/// Along an axis that wraps, points and textures in the domain repeat after the length of that side.
///
/// Parameters
/// ----------
/// size : float or tuple of float
///     Width and height, above 0 and at most 1e300: one number for both, or (x, y).
/// origin : float or tuple of float, default (0.0, 0.0)
///     The corner with the smallest coordinates, (x, y).
/// wrap : bool, tuple of bool or sequence of bool, default True
///     Whether the axes wrap: a bool for both, or (x, y).
///
/// Raises
/// ------
/// DappleError
///     If a side is not above 0, or a number is not finite.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> dp.Domain((2, 1), wrap=(True, False))
/// Domain((2.0, 1.0), origin=(0.0, 0.0), wrap=(True, False))
#[pyclass(frozen, eq, module = "dapple_textures")]
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct Domain(pub(crate) dapple::points::Domain);

/// Constructor arguments of a domain: size, origin and wrap.
type Arguments = ((f64, f64), (f64, f64), (bool, bool));

impl Domain {
    fn arguments(&self) -> Arguments {
        let [x, y] = self.0.wrap;
        (self.0.size.into(), self.0.origin.into(), (x, y))
    }
}

#[pymethods]
impl Domain {
    #[new]
    #[pyo3(signature = (size, origin = None, wrap = None), text_signature = "(size, origin=(0.0, 0.0), wrap=True)")]
    fn new(
        size: &Bound<'_, PyAny>,
        origin: Option<&Bound<'_, PyAny>>,
        wrap: Option<&Bound<'_, PyAny>>,
    ) -> Result<Self> {
        let wrap = match wrap {
            None => [true; 2],
            Some(wrap) if wrap.is_instance_of::<PyBool>() => [wrap.extract()?; 2],
            Some(wrap) => wrap.extract()?,
        };
        let domain = dapple::points::Domain {
            origin: origin.map_or(Ok(DVec2::ZERO), |origin| pair("origin", origin))?,
            size: pair("size", size)?,
            wrap,
        };
        Ok(Self(domain.checked()?))
    }

    /// Width and height.
    #[getter]
    fn size(&self) -> (f64, f64) {
        self.0.size.into()
    }

    /// The corner with the smallest coordinates.
    #[getter]
    fn origin(&self) -> (f64, f64) {
        self.0.origin.into()
    }

    /// Whether x and y wrap.
    #[getter]
    fn wrap(&self) -> (bool, bool) {
        self.0.wrap.into()
    }

    /// Width times height.
    #[getter]
    fn area(&self) -> f64 {
        self.0.area()
    }

    fn __getnewargs__(&self) -> Arguments {
        self.arguments()
    }

    fn __hash__(&self) -> u64 {
        let [x, y] = self.0.wrap.map(u64::from);
        let numbers = [self.0.size, self.0.origin].map(|v| (v + 0.0).to_array());
        let bits = numbers.as_flattened().iter().map(|number| number.to_bits());
        // FNV-1a, one word at a time.
        bits.chain([x, y])
            .fold(0xcbf2_9ce4_8422_2325, |hash, word| {
                (hash ^ word).wrapping_mul(0x0100_0000_01b3)
            })
    }

    pub(crate) fn __repr__(&self) -> String {
        let ((width, height), (x, y), wrap) = self.arguments();
        let wrap = [wrap.0, wrap.1].map(|wraps| if wraps { "True" } else { "False" });
        format!(
            "Domain(({width:?}, {height:?}), origin=({x:?}, {y:?}), wrap=({}, {}))",
            wrap[0], wrap[1]
        )
    }
}
