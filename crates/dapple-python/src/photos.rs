//! Prepares photographs, and estimates materials from them.

use crate::data;
use crate::error::{Error, Result};
use crate::grid::size;
use crate::maps::per_axis;
use crate::pictures::{self, Content, Kind};
use crate::threads;
use dapple::raster::Wrap;
use dapple::tile::{EstimateOptions, Map, TileError, resample_with_alpha};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Applies a resampling function to all maps of an image. Colors are weighted by their alpha.
fn resampled<'py>(
    py: Python<'py>,
    image: &Bound<'py, PyAny>,
    resample: impl Fn(&Map) -> core::result::Result<Map, TileError> + Send + 'static,
) -> Result<Bound<'py, PyAny>> {
    let (layout, maps) = pictures::read("image", image)?;
    let pictures = layout.split(maps);
    let new = threads::run(py, move || {
        let mut new = Vec::new();
        for maps in &pictures {
            match maps.as_slice() {
                [Map::Color(colors), Map::Value(alpha)] => {
                    let (colors, alpha) = resample_with_alpha(colors, alpha, &resample)?;
                    new.extend([Map::Color(colors), Map::Value(alpha)]);
                }
                maps => {
                    for map in maps {
                        new.push(resample(map)?);
                    }
                }
            }
        }
        Ok::<_, TileError>(new)
    })??;
    layout.python(py, new)
}

/// Removes changes of light and tone over distances of more than `radius` pixels, such as vignettes and shadows.
///
/// Colors are divided by their slow part, each channel on its own; the slow part of data is subtracted. Normals are
/// unchanged, and so is alpha.
///
/// Parameters
/// ----------
/// image : dict of array_like or array_like
///     As for `make_tile`.
/// radius : float
///     The standard deviation of the Gaussian weights in pixels, from 1 to 65536.
///
/// Returns
/// -------
/// dict or numpy.ndarray of float32
///     The even image, in the form of the image: an array, or a dictionary of arrays.
///
/// Raises
/// ------
/// DappleError
///     If the radius is out of range.
///
/// Examples
/// --------
/// >>> import numpy as np, dapple_textures as dp
/// >>> ramp = np.linspace(0, 1, 64)[None].repeat(48, 0)
/// >>> bool(np.allclose(dp.even_out(ramp, 16), 0.5, atol=1e-3))
/// True
#[pyfunction]
pub(crate) fn even_out<'py>(
    py: Python<'py>,
    image: &Bound<'py, PyAny>,
    radius: f64,
) -> Result<Bound<'py, PyAny>> {
    let (layout, maps) = pictures::read("image", image)?;
    let pictures = layout.split(maps);
    let even = threads::run(py, move || {
        let mut even = Vec::new();
        for maps in &pictures {
            for map in maps {
                even.push(match (&maps[0], map) {
                    // Alpha is not light.
                    (Map::Color(_), Map::Value(_)) => map.clone(),
                    _ => dapple::tile::even_out(map, radius)?,
                });
            }
        }
        Ok::<_, TileError>(even)
    })??;
    layout.python(py, even)
}

/// Resamples an image: each pixel of a smaller image is the mean of its area, and pixels of a larger one are
/// interpolated.
///
/// Parameters
/// ----------
/// image : dict of array_like or array_like
///     As for `make_tile`; colors are in linear light, and normals are resampled as slopes.
/// size : int or tuple of int
///     (rows, columns), or one number for both.
/// wrap : {"repeat", "clamp", "mirror"} or a pair of them, default "repeat"
///     How the image continues past its edges, or one for each axis, x first: `"repeat"` for tiles.
///
/// Returns
/// -------
/// dict or numpy.ndarray of float32
///     The resampled image, in the form of the image: an array, or a dictionary of arrays.
///
/// Raises
/// ------
/// DappleError
///     If the size is out of range.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> dp.resize([[0.0, 1.0, 2.0, 3.0]], (1, 2)).tolist()
/// [[0.5, 2.5]]
#[pyfunction]
#[pyo3(signature = (image, size, *, wrap = None), text_signature = "(image, size, *, wrap=\"repeat\")")]
pub(crate) fn resize<'py>(
    py: Python<'py>,
    image: &Bound<'py, PyAny>,
    size: &Bound<'py, PyAny>,
    wrap: Option<&Bound<'py, PyAny>>,
) -> Result<Bound<'py, PyAny>> {
    let size = self::size(size)?;
    let wrap = per_axis("wrap", wrap, Wrap::Repeat)?;
    resampled(py, image, move |map| dapple::tile::resize(map, size, wrap))
}

/// Straightens a flat surface that is seen at an angle: maps a quadrilateral of an image to a rectangle.
///
/// Parameters
/// ----------
/// image : dict of array_like or array_like
///     As for `make_tile`, without normals.
/// corners : sequence of tuple of float
///     (x, y) of the top left, top right, bottom right and bottom left corner of the surface, in pixels; (0, 0) is the
///     top left corner of the image.
/// size : int or tuple of int or None, default None
///     (rows, columns), or one number for both; by default the mean lengths of opposite sides.
///
/// Returns
/// -------
/// dict or numpy.ndarray of float32
///     The surface, in the form of the image: an array, or a dictionary of arrays.
///
/// Raises
/// ------
/// DappleError
///     If the corners are outside of the image, or not in clockwise order around a convex shape, or for normals.
///
/// Examples
/// --------
/// >>> import numpy as np, dapple_textures as dp
/// >>> wall = np.random.default_rng(1).random((48, 64, 3))
/// >>> dp.rectify(wall, [(10, 5), (60, 0), (60, 48), (10, 40)]).shape
/// (42, 50, 3)
#[pyfunction]
#[pyo3(signature = (image, corners, *, size = None))]
pub(crate) fn rectify<'py>(
    py: Python<'py>,
    image: &Bound<'py, PyAny>,
    corners: [[f64; 2]; 4],
    size: Option<&Bound<'py, PyAny>>,
) -> Result<Bound<'py, PyAny>> {
    let size = size.map(self::size).transpose()?;
    resampled(py, image, move |map| {
        dapple::tile::rectify(map, corners, size)
    })
}

/// Estimates the material of a flat surface from one photograph: albedo, height and roughness.
///
/// The height is a multi-scale shape from shading (Langer and Zucker 1994; Glencross and others 2008); no model is
/// learned. Stains become dents, and the scale of slopes and roughness is a guess. Pass all maps to `make_tile`
/// together, then compute normals and occlusion from the height of the tile.
///
/// Parameters
/// ----------
/// photo : array_like
///     (rows, columns, 3), in linear light.
/// **options : object
///     * `radius`: pixels beyond which changes of light are removed; a sixth of the shorter side by default.
///     * `coarseness`: depth of wide forms, from 0 to 2; 0.8 by default, and 1 for equal slopes at all scales.
///     * `light`: direction of the light in degrees, 0 from the right and 90 from the top; diffuse by default.
///     * `invert`: whether bright is deep.
///     * `slope`: root mean square slope of the surface, from 0 to 10; 0.5 by default.
///     * `delight`: share of the shading that is removed from the albedo, from 0 to 1; 0.5 by default.
///     * `roughness` and `variation`: mean roughness and maximum deviation, from 0 to 1; 0.75 and 0.25 by default.
///
/// Returns
/// -------
/// tuple of (dict, float)
///     The maps `albedo`, `height` and `roughness`, and the relief: the height of the value 1, in pixels.
///
/// Raises
/// ------
/// DappleError
///     If the photograph has no three channels, or an option is unknown or out of range.
///
/// Examples
/// --------
/// >>> import numpy as np, dapple_textures as dp
/// >>> photo = np.random.default_rng(1).random((96, 128, 3))
/// >>> maps, relief = dp.estimate_material(photo, slope=0.3)
/// >>> tile = dp.make_tile(maps)
/// >>> rows, columns = tile["height"].shape
/// >>> dp.normal_map(tile["height"], relief=relief, extent=(columns, rows)).shape
/// (72, 104, 3)
#[pyfunction]
#[pyo3(signature = (photo, **options))]
pub(crate) fn estimate_material<'py>(
    py: Python<'py>,
    photo: &Bound<'py, PyAny>,
    options: Option<&Bound<'py, PyDict>>,
) -> Result<(Bound<'py, PyDict>, f64)> {
    let options: EstimateOptions = match options {
        Some(options) => data::options("options", options.as_any())?,
        None => EstimateOptions::default(),
    };
    let (_, maps) = pictures::read("photo", photo)?;
    let Some(Map::Color(photo)) = maps.into_iter().next() else {
        let message = "a photograph has three channels, in linear light";
        return Err(Error::new("channels", message));
    };
    let estimate = threads::run(py, move || {
        dapple::tile::estimate_material(&photo, &options)
    })??;
    let named = PyDict::new(py);
    for (name, map, content, n_channels) in [
        ("albedo", Map::Color(estimate.albedo), Content::Color, 3),
        ("height", Map::Value(estimate.height), Content::Data, 1),
        (
            "roughness",
            Map::Value(estimate.roughness),
            Content::Data,
            1,
        ),
    ] {
        let kind = Kind {
            content,
            n_channels,
        };
        named.set_item(name, kind.array(py, vec![map])?)?;
    }
    Ok((named, estimate.relief))
}
