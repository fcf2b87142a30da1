//! Computes blend maps, and blends materials.

use crate::arrays;
use crate::data;
use crate::error::{Error, Result};
use crate::maps::per_axis;
use crate::pictures::{self, Content, Layout, numbers};
use crate::watch;
use dapple::color::LinearRgb;
use dapple::raster::{Raster, Wrap};
use dapple::tile::{Blend, BlendMap, Layer, Map, TileError, blend_cancellable};
use pyo3::prelude::*;

/// Computes a blend tile from a texture, (rows, columns): low in cracks, high on raised or bright parts (after Du,
/// Wang and Meng).
///
/// `rank_equalize` distributes its values evenly, so that weights equal area fractions in `blend`.
///
/// Parameters
/// ----------
/// texture : array_like
///     (rows, columns), or (rows, columns, 3) in linear light.
/// feature_size : float, default 32.0
///     The feature size, such as the diameter of stones, in pixels, from 1 to 4096.
/// contrast : float, default 1.0
///     The steepness of the map around its median, at least 0.
/// wrap : {"repeat", "clamp", "mirror"} or a pair of them, default "repeat"
///     The wrapping past the edges: `"repeat"`, `"clamp"` or `"mirror"`, or one for each axis, x first.
///
/// Returns
/// -------
/// numpy.ndarray of float32
///     The blend tile, (rows, columns), with values from 0 to 1.
///
/// Raises
/// ------
/// DappleError
///     If the image's shape is wrong, or an option is out of range.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> stones = dp.worley(seed=7, period=4).render(64)
/// >>> dp.blend_map(stones, feature_size=16).shape
/// (64, 64)
#[pyfunction]
#[pyo3(signature = (texture, *, feature_size = 32.0, contrast = 1.0, wrap = None),
    text_signature = "(texture, *, feature_size=32.0, contrast=1.0, wrap=\"repeat\")")]
pub(crate) fn blend_map<'py>(
    py: Python<'py>,
    texture: &Bound<'py, PyAny>,
    feature_size: f64,
    contrast: f64,
    wrap: Option<&Bound<'py, PyAny>>,
) -> Result<Bound<'py, PyAny>> {
    let options = BlendMap {
        feature_size,
        contrast,
        wrap: per_axis("wrap", wrap, Wrap::Repeat)?,
    };
    let (_, maps) = pictures::read("texture", texture)?;
    let map = watch::run(py, None, move |_, stop| {
        let apply = |values| Ok(options.apply_cancellable(values, &|| stop.is_set())?);
        match maps.as_slice() {
            [Map::Value(values)] => apply(values),
            [Map::Color(colors)] => apply(&colors.map(|color| color.luminance())),
            _ => {
                let message = "the texture of a blend map is numbers, or colors without alpha";
                Err(Error::new("channels", message))
            }
        }
    })??;
    arrays::numbers(py, map)
}

/// Blends layers by weights, by heights, or along the features of a blend tile.
///
/// Parameters
/// ----------
/// layers : iterable of dict of array_like or iterable of array_like
///     Images of the same size, or dictionaries of maps with the same names. Where only one layer has a nonzero
///     weight, the result is that layer.
/// weights : iterable of array_like or None, default None
///     For each layer, a number or an array (rows, columns), at least 0; 1 by default.
/// heights : iterable of array_like or None, default None
///     For each layer, an array (rows, columns) or None.
/// tile : array_like or None, default None
///     A blend tile, (rows, columns), from 0 to 1; see `blend_map`.
/// weighting : str or dict, default "given"
///     `"given"` uses the weights unchanged; `{"height": {"depth": 0.1}}` shows the higher layer; `{"mask": {"gain":
///     8}}` cuts the tile at thresholds, with the first layer where the tile is lowest.
/// mixing : str or dict, default "linear"
///     `"linear"`, `"keep_variance"`, or `{"pyramid": {"levels": 4}}`, which mixes each frequency band separately.
///
/// Returns
/// -------
/// dict or numpy.ndarray of float32
///     The blended layer, in the form of the layers: an array, or a dictionary of arrays.
///
/// Raises
/// ------
/// DappleError
///     If the layers differ in size or channels, there are no layers, or an option is out of range or does not apply
///     to the chosen mixing.
///
/// Examples
/// --------
/// >>> import numpy as np, dapple_textures as dp
/// >>> sand, rock = np.full((4, 4), 0.75), np.full((4, 4), 0.25)
/// >>> float(dp.blend([sand, rock])[0, 0])
/// 0.5
/// >>> float(dp.blend([sand, rock], weights=[0, 2])[0, 0])
/// 0.25
#[pyfunction]
#[pyo3(signature = (layers, *, weights = None, heights = None, tile = None, weighting = None, mixing = None),
    text_signature = "(layers, *, weights=None, heights=None, tile=None, weighting=\"given\", mixing=\"linear\")")]
pub(crate) fn blend<'py>(
    py: Python<'py>,
    layers: &Bound<'py, PyAny>,
    weights: Option<&Bound<'py, PyAny>>,
    heights: Option<&Bound<'py, PyAny>>,
    tile: Option<&Bound<'py, PyAny>>,
    weighting: Option<&Bound<'py, PyAny>>,
    mixing: Option<&Bound<'py, PyAny>>,
) -> Result<Bound<'py, PyAny>> {
    let (layout, mut layers) = pictures::read_all("layers", layers)?;
    let count = layers.len();
    let size = layers[0][0].size();
    let weights = column("weights", weights, count, |weight| {
        match weight.extract::<f32>() {
            Ok(weight) => Ok(Raster::filled(size, weight)?),
            Err(_) => numbers("weights", weight),
        }
    })?;
    let full = Raster::filled(size, 1.0)?;
    let heights = column("heights", heights, count, |height| {
        numbers("heights", height)
    })?;
    let tile = tile.map(|tile| numbers("tile", tile)).transpose()?;
    let how = Blend {
        weighting: data::options_or("weighting", weighting, Default::default())?,
        mixing: data::options_or("mixing", mixing, Default::default())?,
    };
    let kinds = layout.clone();
    let maps = watch::run(
        py,
        None,
        move |_, stop| -> core::result::Result<Vec<Map>, TileError> {
            for maps in &mut layers {
                multiply(&kinds, maps, |color, alpha| color * alpha)?;
            }
            let layers = layers.iter().zip(&weights).zip(&heights);
            let layers = layers.map(|((maps, weight), height)| Layer {
                maps,
                weight: weight.as_ref().unwrap_or(&full),
                height: height.as_ref(),
            });
            let layers: Vec<_> = layers.collect();
            let mut maps = blend_cancellable(&layers, tile.as_ref(), &how, &|| stop.is_set())?;
            multiply(&kinds, &mut maps, |color, alpha| match alpha > 0.0 {
                true => LinearRgb::from(color.to_array().map(|part| part / alpha)),
                false => LinearRgb::BLACK,
            })?;
            Ok(maps)
        },
    )??;
    layout.python(py, maps)
}

/// Reads one optional item per layer, such as a weight; `None` for a layer without the item. Fails unless there is
/// exactly one entry per layer.
fn column<'py, T>(
    what: &str,
    data: Option<&Bound<'py, PyAny>>,
    count: usize,
    read: impl Fn(&Bound<'py, PyAny>) -> Result<T>,
) -> Result<Vec<Option<T>>> {
    let mut column = Vec::new();
    match data {
        None => column.resize_with(count, || None),
        Some(data) => {
            for item in data.try_iter()? {
                let item = item?;
                column.push(if item.is_none() {
                    None
                } else {
                    Some(read(&item)?)
                });
            }
        }
    }
    if column.len() == count {
        return Ok(column);
    }
    let message = format!("there are {} {what}, but {count} layers", column.len());
    Err(Error::new("count", message))
}

/// Replaces the colors of images with alpha by `by(color, alpha)`, such as by premultiplied colors. Blending
/// premultiplied colors keeps transparent pixels from contributing color.
fn multiply(
    layout: &Layout,
    maps: &mut [Map],
    by: impl Fn(LinearRgb, f32) -> LinearRgb + Sync,
) -> core::result::Result<(), TileError> {
    let mut at = 0;
    for kind in &layout.kinds {
        if kind.content == Content::Color
            && let [Map::Color(colors), Map::Value(alpha)] = &mut maps[at..at + kind.n_maps()]
        {
            *colors = colors.zip_map(alpha, |&color, &alpha| by(color, alpha))?;
        }
        at += kind.n_maps();
    }
    Ok(())
}
