//! Computes maps from heights, color ramps, and the sRGB curve.

use crate::arrays;
use crate::data;
use crate::error::{Error, Result};
use crate::grid::pair;
use crate::pictures::{Content, Kind, numbers};
use crate::threads;
use crate::watch;
use dapple::color::{
    Code, ColorRamp, ColorStop, CurvatureOptions, HeightPlane, Interpolation, LinearRgb,
    NormalOptions, NormalY, OcclusionOptions, Outside, Palette, RampSpace,
};
use dapple::raster::glam::DVec2;
use dapple::raster::{Named, Wrap};
use dapple::tile::Map;
use numpy::{Element, PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};
use rayon::prelude::*;
use serde_json::Value;

/// Reads a named option per axis, such as the wrap: one name for both axes, or one for each axis, x first.
pub(crate) fn per_axis<T: Named>(
    what: &str,
    data: Option<&Bound<'_, PyAny>>,
    default: T,
) -> Result<[T; 2]> {
    let Some(data) = data else {
        return Ok([default; 2]);
    };
    if let Ok(name) = data.cast::<PyString>() {
        return Ok([data::named(what, name.to_str()?)?; 2]);
    }
    let [x, y]: [String; 2] = data.extract()?;
    Ok([data::named(what, &x)?, data::named(what, &y)?])
}

/// Reads the scale of a height map: relief, extent and wrap.
fn plane(
    relief: f64,
    extent: Option<&Bound<'_, PyAny>>,
    wrap: Option<&Bound<'_, PyAny>>,
) -> Result<HeightPlane> {
    Ok(HeightPlane {
        strength: relief,
        extent: extent.map_or(Ok(DVec2::ONE), |extent| pair("extent", extent))?,
        wrap: per_axis("wrap", wrap, Wrap::Repeat)?,
    })
}

/// Computes the normal map of heights, (rows, columns, 3): unit vectors with x to the right and z out of the image.
///
/// A height `h` has the normal `normalize(-relief ∂h/∂x, ±relief ∂h/∂y, 1)` (Blinn 1978). Slopes are per unit of the
/// plane, not per pixel, so the resolution does not change the normals.
///
/// Parameters
/// ----------
/// height : array_like
///     The heights, (rows, columns).
/// relief : float, default 1.0
///     The height of the value 1, in units of the plane; negative values turn hills into dents.
/// extent : float or tuple of float or None, default None
///     (x, y), or a number for both: the size of the array in the plane, as in `Field.render`; 1 by default.
/// wrap : {"repeat", "clamp", "mirror"} or a pair of them, default "repeat"
///     How heights continue past the edges: `"repeat"`, `"clamp"` or `"mirror"`, or one for each axis, x first.
///     Without `"repeat"`, heights continue past an edge with the slope that they have there, so that a tilted plane
///     has the same normals up to its last row.
/// y : {"up", "down"}, default "up"
///     `"up"` (OpenGL, Blender, glTF) or `"down"` (DirectX).
///
/// Returns
/// -------
/// numpy.ndarray of float32
///     The normals, (rows, columns, 3), of length 1.
///
/// Raises
/// ------
/// DappleError
///     If the heights are not (rows, columns), or an option is out of range.
///
/// Examples
/// --------
/// >>> import numpy as np, dapple_textures as dp
/// >>> slope = np.linspace(0, 1, 8, endpoint=False)[None].repeat(8, 0)
/// >>> normal = dp.normal_map(slope, wrap="clamp")
/// >>> normal.shape, bool(np.allclose(normal[4, 4], np.array([-1, 0, 1]) / 2**0.5))
/// ((8, 8, 3), True)
#[pyfunction]
#[pyo3(signature = (height, *, relief = 1.0, extent = None, wrap = None, y = "up"),
    text_signature = "(height, *, relief=1.0, extent=None, wrap=\"repeat\", y=\"up\")")]
pub(crate) fn normal_map<'py>(
    py: Python<'py>,
    height: &Bound<'py, PyAny>,
    relief: f64,
    extent: Option<&Bound<'py, PyAny>>,
    wrap: Option<&Bound<'py, PyAny>>,
    y: &str,
) -> Result<Bound<'py, PyAny>> {
    let y = match y {
        "up" => NormalY::OpenGl,
        "down" => NormalY::DirectX,
        y => {
            let message = format!("y is `{y}`, but it must be up or down");
            return Err(Error::new("name", message));
        }
    };
    let plane = plane(relief, extent, wrap)?;
    let height = numbers("height", height)?;
    let options = NormalOptions { plane, y };
    let normals = threads::run(py, move || dapple::color::normal_map(&height, &options))??;
    let kind = Kind {
        content: Content::Normal,
        n_channels: 3,
    };
    kind.array(py, vec![Map::Normal(normals)])
}

/// Computes the ambient occlusion of heights, (rows, columns): the visible fraction of the sky at each pixel, from 0
/// to 1.
///
/// Horizons are searched in 16 directions, without random rotations (after Bavoil, Sainz and Dimitrov 2008; Jimenez
/// and others 2016). A plane with any slope has exactly the value 1.
///
/// Parameters
/// ----------
/// height : array_like
///     As for `normal_map`.
/// relief : float, default 1.0
///     As for `normal_map`.
/// extent : float or tuple of float or None, default None
///     As for `normal_map`.
/// wrap : {"repeat", "clamp", "mirror"} or a pair of them, default "repeat"
///     As for `normal_map`.
/// radius : float, default 0.0625
///     The distance within which heights occlude the sky, in units of the plane.
/// fade : float, default 0.5
///     The outer fraction of the radius over which occlusion fades, from 0 to 1.
///
/// Returns
/// -------
/// numpy.ndarray of float32
///     The visible fractions of the sky, (rows, columns), from 0 to 1.
///
/// Raises
/// ------
/// DappleError
///     If the heights are not (rows, columns), or an option is out of range.
///
/// Examples
/// --------
/// >>> import numpy as np, dapple_textures as dp
/// >>> groove = np.abs(np.linspace(-0.5, 0.5, 64))[None].repeat(64, 0)
/// >>> seen = dp.ambient_occlusion(groove, radius=0.5)
/// >>> bool(seen[32, 32] < 0.7), bool(seen[32, 60] > 0.9)
/// (True, True)
#[pyfunction]
#[pyo3(signature = (height, *, relief = 1.0, extent = None, wrap = None, radius = 0.0625, fade = 0.5),
    text_signature = "(height, *, relief=1.0, extent=None, wrap=\"repeat\", radius=0.0625, fade=0.5)")]
pub(crate) fn ambient_occlusion<'py>(
    py: Python<'py>,
    height: &Bound<'py, PyAny>,
    relief: f64,
    extent: Option<&Bound<'py, PyAny>>,
    wrap: Option<&Bound<'py, PyAny>>,
    radius: f64,
    fade: f64,
) -> Result<Bound<'py, PyAny>> {
    let plane = plane(relief, extent, wrap)?;
    let options = OcclusionOptions {
        plane,
        radius,
        fade,
    };
    let height = numbers("height", height)?;
    let seen = watch::run(py, None, move |_, stop| {
        dapple::color::ambient_occlusion_cancellable(&height, &options, &|| stop.is_set())
    })??;
    arrays::numbers(py, seen)
}

/// Computes the mean curvature of heights, (rows, columns), in 1 / units of the plane: positive on ridges and hills,
/// negative in grooves.
///
/// On a hill shaped like part of a sphere, it is 1 / radius everywhere (do Carmo 1976, section 3.3).
///
/// Parameters
/// ----------
/// height : array_like
///     As for `normal_map`.
/// relief : float, default 1.0
///     As for `normal_map`.
/// extent : float or tuple of float or None, default None
///     As for `normal_map`.
/// wrap : {"repeat", "clamp", "mirror"} or a pair of them, default "repeat"
///     As for `normal_map`.
/// radius : float, default 0.0078125
///     The distance over which differences are taken, in units of the plane; at least one pixel.
///
/// Returns
/// -------
/// numpy.ndarray of float32
///     The curvature, (rows, columns), in 1 / units of the plane.
///
/// Raises
/// ------
/// DappleError
///     If the heights are not (rows, columns), or an option is out of range.
///
/// Examples
/// --------
/// >>> import numpy as np, dapple_textures as dp
/// >>> x = np.linspace(-0.5, 0.5, 64)
/// >>> bowl = 0.5 * (x[:, None] ** 2 + x ** 2)  # second derivatives of 1
/// >>> bent = dp.curvature(bowl, wrap="clamp")
/// >>> bool(abs(bent[32, 32] + 1) < 0.05)
/// True
#[pyfunction]
#[pyo3(signature = (height, *, relief = 1.0, extent = None, wrap = None, radius = 0.007_812_5),
    text_signature = "(height, *, relief=1.0, extent=None, wrap=\"repeat\", radius=0.0078125)")]
pub(crate) fn curvature<'py>(
    py: Python<'py>,
    height: &Bound<'py, PyAny>,
    relief: f64,
    extent: Option<&Bound<'py, PyAny>>,
    wrap: Option<&Bound<'py, PyAny>>,
    radius: f64,
) -> Result<Bound<'py, PyAny>> {
    let plane = plane(relief, extent, wrap)?;
    let options = CurvatureOptions { plane, radius };
    let height = numbers("height", height)?;
    let bent = threads::run(py, move || dapple::color::curvature(&height, &options))??;
    arrays::numbers(py, bent)
}

/// Maps values to colors with a color ramp, (rows, columns, 3), in linear light.
///
/// Parameters
/// ----------
/// values : array_like
///     The values, (rows, columns).
/// colors : str, sequence of object or numpy.ndarray, default "gray"
///     The name of a palette (see `palettes`), a list of colors spaced evenly from 0 to 1, or a list of (position,
///     color). A color is `"#rrggbb"` in sRGB, or three numbers in linear light.
/// space : {"oklab", "srgb", "linear"}, default "oklab"
///     The color space for interpolation: `"oklab"`, `"srgb"` or `"linear"`.
/// interpolation : {"linear", "smooth", "stepped"}, default "linear"
///     How colors change between two stops: `"linear"`, `"smooth"` or `"stepped"`.
/// outside : {"clamp", "repeat"}, default "clamp"
///     The colors before the first and after the last stop: `"clamp"` or `"repeat"`.
///
/// Returns
/// -------
/// numpy.ndarray of float32
///     The colors, (rows, columns, 3), in linear light.
///
/// Raises
/// ------
/// DappleError
///     If a palette or a color is unknown, there are no stops, stops are out of order, or a name is not one of those
///     above.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> dp.ramp([[0.0, 0.5, 1.0]], ["#000000", "#ffffff"], space="linear")[0, :, 0].tolist()
/// [0.0, 0.5, 1.0]
/// >>> dp.ramp([[0.2]], "lagoon").shape
/// (1, 1, 3)
#[pyfunction]
#[pyo3(signature = (values, colors = None, *, space = "oklab", interpolation = "linear", outside = "clamp"),
    text_signature = "(values, colors=\"gray\", *, space=\"oklab\", interpolation=\"linear\", outside=\"clamp\")")]
pub(crate) fn ramp<'py>(
    py: Python<'py>,
    values: &Bound<'py, PyAny>,
    colors: Option<&Bound<'py, PyAny>>,
    space: &str,
    interpolation: &str,
    outside: &str,
) -> Result<Bound<'py, PyAny>> {
    let ramp = match colors {
        None => Palette::Gray.ramp(),
        Some(colors) => match colors.cast::<PyString>() {
            Ok(name) => data::named::<Palette>("palette", name.to_str()?)?.ramp(),
            Err(_) => stops(&data::value(colors)?)?,
        },
    };
    let ramp = ramp
        .with_space(data::named::<RampSpace>("space", space)?)
        .with_interpolation(data::named::<Interpolation>(
            "interpolation",
            interpolation,
        )?)
        .with_outside(data::named::<Outside>("outside", outside)?);
    let values = numbers("values", values)?;
    let colors = threads::run(py, move || ramp.apply(&values))?;
    let kind = Kind::new("ramp", Some(Content::Color), 3)?;
    kind.array(py, vec![Map::Color(colors)])
}

/// Reads a ramp from a list of colors, or from a list of (position, color) pairs.
fn stops(colors: &Value) -> Result<ColorRamp> {
    let refused = || {
        Error::new(
            "options",
            "the colors are a palette's name, or a list of colors or of (position, color)",
        )
    };
    let items = colors.as_array().ok_or_else(refused)?;
    let pair = |item: &Value| -> Option<(f32, Value)> {
        let [position, color] = item.as_array()?.as_slice() else {
            return None;
        };
        Some((position.as_f64()? as f32, color.clone()))
    };
    let pairs: Vec<_> = items.iter().filter_map(pair).collect();
    if pairs.is_empty() {
        let colors: Vec<LinearRgb> = items.iter().map(color).collect::<Result<_>>()?;
        return Ok(ColorRamp::even(&colors)?);
    }
    if pairs.len() != items.len() {
        return Err(refused());
    }
    let stop = |(position, of): &(f32, Value)| -> Result<ColorStop> {
        let position = *position;
        Ok(ColorStop {
            position,
            color: color(of)?,
        })
    };
    let stops: Vec<ColorStop> = pairs.iter().map(stop).collect::<Result<_>>()?;
    Ok(ColorRamp::new(stops)?)
}

/// Reads a color: `#rrggbb`, or three numbers in linear light.
fn color(color: &Value) -> Result<LinearRgb> {
    match color {
        Value::String(text) => Ok(LinearRgb::from_hex(text)?),
        numbers => Ok(data::read::<[f32; 3]>("color", numbers.clone())?.into()),
    }
}

/// Returns the palettes of `ramp`: an array of colors for each name, (n, 3) in linear light, from low values to high
/// ones.
///
/// Returns
/// -------
/// dict
///     The colors of each palette by name, float32 arrays (n, 3).
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> list(dp.palettes())
/// ['gray', 'lagoon', 'ember', 'terrain', 'cow', 'giraffe', 'labels']
#[pyfunction]
pub(crate) fn palettes(py: Python<'_>) -> Result<Bound<'_, PyDict>> {
    let palettes = PyDict::new(py);
    for palette in Palette::ALL {
        let colors = palette.colors();
        let n_colors = colors.len();
        let colors: Vec<[f32; 3]> = colors.into_iter().map(LinearRgb::to_array).collect();
        let colors = arrays::array(py, colors.into_flattened(), &[n_colors, 3])?;
        palettes.set_item(palette.name(), colors)?;
    }
    Ok(palettes)
}

/// Converts linear light to sRGB codes, for arrays of any shape; each value becomes exactly the nearest code (IEC
/// 61966-2-1).
///
/// Values below 0 and NaN become 0, and values above 1 become the largest code. Alpha does not use this curve, so
/// leave it out.
///
/// Parameters
/// ----------
/// linear : array_like
///     Linear light from 0 to 1.
/// depth : {8} or {16}, default 8
///     8 for uint8, 16 for uint16.
///
/// Returns
/// -------
/// numpy.ndarray of uint8 or numpy.ndarray of uint16
///     The codes, with the shape of the argument.
///
/// Raises
/// ------
/// DappleError
///     If `depth` is not 8 or 16.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> dp.srgb_from_linear([0.0, 0.2159, 1.0])
/// array([  0, 128, 255], dtype=uint8)
#[pyfunction]
#[pyo3(signature = (linear, *, depth = 8))]
pub(crate) fn srgb_from_linear<'py>(
    py: Python<'py>,
    linear: numpy::PyArrayLikeDyn<'py, f32, numpy::AllowTypeChange>,
    depth: u32,
) -> Result<Bound<'py, PyAny>> {
    match depth {
        8 => codes(py, &linear, u8::srgb_from_linear),
        16 => codes(py, &linear, u16::srgb_from_linear),
        _ => {
            let message = format!("the depth is {depth}, but it must be 8 or 16");
            Err(Error::new("depth", message))
        }
    }
}

/// Converts sRGB codes to linear light, for arrays of any shape, float32. Codes are uint8 from 0 to 255, or uint16
/// from 0 to 65535 (IEC 61966-2-1).
///
/// `srgb_from_linear` restores every code. Alpha does not use this curve: divide it by the largest code.
///
/// Parameters
/// ----------
/// codes : numpy.ndarray of uint8 or numpy.ndarray of uint16
///     sRGB codes, uint8 or uint16.
///
/// Returns
/// -------
/// numpy.ndarray of float32
///     The linear light, with the shape of `codes`, from 0 to 1.
///
/// Raises
/// ------
/// TypeError
///     If the codes are neither uint8 nor uint16.
///
/// Examples
/// --------
/// >>> import numpy as np, dapple_textures as dp
/// >>> dp.linear_from_srgb(np.array([0, 255], "u1")).tolist()
/// [0.0, 1.0]
#[pyfunction]
pub(crate) fn linear_from_srgb<'py>(
    py: Python<'py>,
    codes: &Bound<'py, PyAny>,
) -> Result<Bound<'py, PyAny>> {
    if let Ok(codes) = codes.cast::<PyArrayDyn<u8>>() {
        return self::codes(py, &codes.readonly(), u8::linear_from_srgb);
    }
    if let Ok(codes) = codes.cast::<PyArrayDyn<u16>>() {
        return self::codes(py, &codes.readonly(), u16::linear_from_srgb);
    }
    let message = "sRGB codes are an array of uint8 or of uint16";
    Err(PyTypeError::new_err(message).into())
}

/// Applies `code`, an sRGB encoding or decoding, to each element of an array.
fn codes<'py, T: Element + Copy + Sync, U: Element + Send>(
    py: Python<'py>,
    array: &numpy::PyReadonlyArrayDyn<'py, T>,
    code: fn(T) -> U,
) -> Result<Bound<'py, PyAny>> {
    let view = array.as_array();
    // Do not divide the work into parts, since it is a single fast pass over memory.
    let made: Vec<U> = watch::within(py, |_| {
        Ok(match view.to_slice() {
            Some(values) => values.par_iter().map(|&value| code(value)).collect(),
            None => view.iter().map(|&value| code(value)).collect(),
        })
    })?;
    arrays::array(py, made, array.shape())
}
