//! Converts images with one to four channels, single or in dictionaries, to the library's maps and back.
//!
//! An array (rows, columns) holds scalars, (rows, columns, 3) colors in linear light, and (rows, columns, 4) colors
//! with alpha, which becomes a separate map. In a dictionary, `normal` holds unit vectors, and `orm` three
//! independent values.

use crate::arrays;
use crate::error::{Error, Result};
use crate::recipe::content_of;
use dapple::color::{LinearRgb, Normal};
use dapple::raster::Raster;
use dapple::tile::Map;
use numpy::ndarray::ArrayViewD;
use numpy::{AllowTypeChange, PyArrayLikeDyn, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyMapping};
use std::borrow::Cow;

dapple::raster::named! {
    /// The content of a picture.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub(crate) enum Content {
        /// Heights, masks and similar numbers.
        Gray = "gray",
        /// Color in linear light, with or without alpha.
        Color = "color",
        /// Unit vectors.
        Normal = "normal",
        /// Independent numbers.
        Data = "data",
    }
}

/// The kind of an image: its content and its number of channels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Kind {
    pub(crate) content: Content,
    pub(crate) n_channels: usize,
}

/// Layout of an input, so that results have the same form: a single image, or a dictionary with the names and kinds of
/// its images.
#[derive(Clone)]
pub(crate) struct Layout {
    /// The names in the dictionary; `None` for a single image.
    pub(crate) names: Option<Vec<String>>,
    pub(crate) kinds: Vec<Kind>,
}

impl Kind {
    /// Returns the kind of an image with `n_channels` channels. By default, one channel is gray, and several are a
    /// color.
    pub(crate) fn new(what: &str, content: Option<Content>, n_channels: usize) -> Result<Self> {
        let content = content.unwrap_or(match n_channels {
            1 => Content::Gray,
            _ => Content::Color,
        });
        let fits = match content {
            Content::Gray => n_channels == 1,
            Content::Color => [3, 4].contains(&n_channels),
            Content::Normal => n_channels == 3,
            Content::Data => [1, 3, 4].contains(&n_channels),
        };
        if fits {
            return Ok(Self {
                content,
                n_channels,
            });
        }
        let message = format!(
            "the {what} has {n_channels} channels, but {content} is (rows, columns) for one number a pixel, or \
             (rows, columns, 3 or 4)"
        );
        Err(Error::new("channels", message))
    }

    /// Returns the number of maps of the image: colors with alpha have two, data has one per channel.
    pub(crate) fn n_maps(self) -> usize {
        match self.content {
            Content::Gray | Content::Normal => 1,
            Content::Color => self.n_channels - 2,
            Content::Data => self.n_channels,
        }
    }

    /// Builds the maps from the values of an image, in pixel order.
    fn maps(self, size: [u32; 2], values: Cow<'_, [f32]>) -> Result<Vec<Map>> {
        let n = self.n_channels;
        let channel = |channel| -> Result<Map> {
            let values = values.iter().skip(channel).step_by(n).copied();
            Ok(Map::Value(Raster::from_vec(size, values.collect())?))
        };
        Ok(match self.content {
            Content::Gray => vec![Map::Value(Raster::from_vec(size, values.into_owned())?)],
            Content::Data => (0..n).map(channel).collect::<Result<_>>()?,
            Content::Normal => {
                let pixels = values.chunks_exact(3).map(|at| Normal {
                    x: at[0],
                    y: at[1],
                    z: at[2],
                });
                vec![Map::Normal(Raster::from_vec(size, pixels.collect())?)]
            }
            Content::Color => {
                let pixels = values
                    .chunks_exact(n)
                    .map(|at| LinearRgb::new(at[0], at[1], at[2]));
                let color = Map::Color(Raster::from_vec(size, pixels.collect())?);
                let alpha = (3..n).map(channel);
                [Ok(color)]
                    .into_iter()
                    .chain(alpha)
                    .collect::<Result<_>>()?
            }
        })
    }

    /// Builds an array from the maps.
    pub(crate) fn array<'py>(self, py: Python<'py>, maps: Vec<Map>) -> Result<Bound<'py, PyAny>> {
        let Some(size) = maps.first().map(Map::size) else {
            return Err(Error::new("count", "a picture has at least one map"));
        };
        let [width, height] = size.map(|side| side as usize);
        let n = self.n_channels;
        let mut maps = maps.into_iter();
        let values = match (maps.next(), maps.len()) {
            (Some(Map::Value(values)), 0) => return arrays::numbers(py, values),
            (Some(Map::Color(colors)), 0) => flattened(colors, LinearRgb::to_array),
            (Some(Map::Normal(normals)), _) => flattened(normals, Normal::to_array),
            (Some(first), _) => {
                let mut values = vec![0.0; width * height * n];
                let mut channel = 0;
                for map in [first].into_iter().chain(maps) {
                    channel += interleave(&map, &mut values[channel..], n);
                }
                values
            }
            (None, _) => Vec::new(),
        };
        arrays::array(py, values, &[height, width, n])
    }
}

/// Converts pixels to a flat list of numbers, reusing the memory of the pixels.
fn flattened<T>(raster: Raster<T>, numbers: fn(T) -> [f32; 3]) -> Vec<f32> {
    let pixels: Vec<[f32; 3]> = raster.into_pixels().into_iter().map(numbers).collect();
    pixels.into_flattened()
}

/// Writes the channels of a map to the first values of each pixel. Pixels are `n` values apart. Returns the number of
/// channels.
fn interleave(map: &Map, values: &mut [f32], n: usize) -> usize {
    match map {
        Map::Value(raster) => {
            for (at, &value) in values.chunks_mut(n).zip(raster.pixels()) {
                at[0] = value;
            }
            1
        }
        Map::Color(raster) => {
            for (at, color) in values.chunks_mut(n).zip(raster.pixels()) {
                at[..3].copy_from_slice(&color.to_array());
            }
            3
        }
        Map::Normal(raster) => {
            for (at, normal) in values.chunks_mut(n).zip(raster.pixels()) {
                at[..3].copy_from_slice(&normal.to_array());
            }
            3
        }
    }
}

/// The array of an image argument.
pub(crate) struct Pixels<'py> {
    array: PyArrayLikeDyn<'py, f32, AllowTypeChange>,
    /// Columns and rows.
    pub(crate) size: [u32; 2],
    pub(crate) n_channels: usize,
}

impl<'py> Pixels<'py> {
    /// Reads an array. Fails for data that is not an image, and for integers, which are codes rather than linear
    /// light.
    pub(crate) fn read(what: &str, data: &Bound<'py, PyAny>) -> Result<Self> {
        if let Ok(array) = data.cast::<PyUntypedArray>() {
            let dtype = array.dtype();
            if matches!(dtype.getattr("kind")?.extract::<char>()?, 'u' | 'i' | 'c') {
                let message = format!(
                    "the {what} is an array of {dtype}, but pixels are floating point: divide data by its largest code, \
                     or take `linear_from_srgb` for colors"
                );
                return Err(Error::new("type", message));
            }
        }
        let array: PyArrayLikeDyn<'_, f32, AllowTypeChange> = data.extract()?;
        let shape = array.as_array().shape().to_vec();
        let n_channels = match shape.as_slice() {
            [_, _] => 1,
            &[_, _, n] if n > 1 => n,
            _ => {
                let message = format!(
                    "the {what} has the shape {shape:?}, but it must be (rows, columns), or (rows, columns, channels) with \
                     more than one channel"
                );
                return Err(Error::new("shape", message));
            }
        };
        let size = arrays::raster_size(what, &shape)?;
        Ok(Self {
            array,
            size,
            n_channels,
        })
    }

    /// Returns the values in pixel order, borrowed if possible, otherwise copied.
    pub(crate) fn values(&self) -> Cow<'_, [f32]> {
        let view: ArrayViewD<'_, f32> = self.array.as_array();
        match view.to_slice() {
            Some(values) => Cow::Borrowed(values),
            None => Cow::Owned(view.iter().copied().collect()),
        }
    }

    /// Returns each channel as a raster.
    pub(crate) fn planes(&self) -> Result<Vec<Raster<f32>>> {
        let values = self.values();
        let plane = |channel| {
            let values = values.iter().skip(channel).step_by(self.n_channels);
            Ok(Raster::from_vec(self.size, values.copied().collect())?)
        };
        (0..self.n_channels).map(plane).collect()
    }
}

/// Builds an array from channels: (rows, columns) for one, and (rows, columns, channels) for several.
pub(crate) fn array_of_planes(
    py: Python<'_>,
    planes: Vec<Raster<f32>>,
) -> Result<Bound<'_, PyAny>> {
    let kind = Kind {
        content: Content::Data,
        n_channels: planes.len(),
    };
    kind.array(py, planes.into_iter().map(Map::Value).collect())
}

/// Reads the maps of an image, or of all images in a dictionary, in order.
pub(crate) fn read(what: &str, data: &Bound<'_, PyAny>) -> Result<(Layout, Vec<Map>)> {
    let (mut maps, mut kinds) = (Vec::new(), Vec::new());
    let mut add = |what: &str, data: &Bound<'_, PyAny>, content| -> Result<()> {
        let pixels = Pixels::read(what, data)?;
        let kind = Kind::new(what, content, pixels.n_channels)?;
        maps.extend(kind.maps(pixels.size, pixels.values())?);
        kinds.push(kind);
        Ok(())
    };
    let names = match data.cast::<PyMapping>() {
        Err(_) => {
            add(what, data, None)?;
            None
        }
        Ok(pictures) => {
            let pictures: Vec<(String, Bound<'_, PyAny>)> = pictures.items()?.extract()?;
            for (name, picture) in &pictures {
                add(name, picture, content_of(name))?;
            }
            Some(pictures.into_iter().map(|(name, _)| name).collect())
        }
    };
    if kinds.is_empty() {
        return Err(Error::new(
            "count",
            format!("the {what} is a dictionary without maps"),
        ));
    }
    Ok((Layout { names, kinds }, maps))
}

/// Reads the maps of a list of images or dictionaries, which must all have the same names and kinds.
pub(crate) fn read_all(what: &str, data: &Bound<'_, PyAny>) -> Result<(Layout, Vec<Vec<Map>>)> {
    let mut all = Vec::new();
    let mut first: Option<Layout> = None;
    for (index, item) in data.try_iter()?.enumerate() {
        let (layout, maps) = read(what, &item?)?;
        let first = first.get_or_insert_with(|| layout.clone());
        if first.names != layout.names || first.kinds != layout.kinds {
            let message =
                format!("number {index} of the {what} has other maps or channels than the first");
            return Err(Error::new("channels", message));
        }
        all.push(maps);
    }
    let layout = first.ok_or_else(|| {
        let message = format!("there are 0 {what}, but at least 1 is needed");
        Error::new("count", message)
    })?;
    Ok((layout, all))
}

/// Reads an image with one channel: an array (rows, columns).
pub(crate) fn numbers(what: &str, data: &Bound<'_, PyAny>) -> Result<Raster<f32>> {
    let pixels = Pixels::read(what, data)?;
    if pixels.n_channels != 1 {
        let message = format!(
            "the {what} has {} channels, but 1 is needed",
            pixels.n_channels
        );
        return Err(Error::new("channels", message));
    }
    Ok(Raster::from_vec(pixels.size, pixels.values().into_owned())?)
}

impl Layout {
    /// Returns the name of each image; `alone` for a single image.
    pub(crate) fn names_or<'a>(&'a self, alone: &'a str) -> Vec<&'a str> {
        match &self.names {
            None => vec![alone],
            Some(names) => names.iter().map(String::as_str).collect(),
        }
    }

    /// Groups a flat list of maps into one list for each image.
    pub(crate) fn split<T>(&self, maps: impl IntoIterator<Item = T>) -> Vec<Vec<T>> {
        let mut maps = maps.into_iter();
        let kinds = self.kinds.iter();
        kinds
            .map(|kind| maps.by_ref().take(kind.n_maps()).collect())
            .collect()
    }

    /// Converts maps to the form of the input: an image, or a dictionary of images.
    pub(crate) fn python<'py>(&self, py: Python<'py>, maps: Vec<Map>) -> Result<Bound<'py, PyAny>> {
        let pictures = self.split(maps).into_iter().zip(&self.kinds);
        let mut arrays = pictures.map(|(maps, kind)| kind.array(py, maps));
        let Some(names) = &self.names else {
            return arrays
                .next()
                .unwrap_or_else(|| Ok(py.None().into_bound(py)));
        };
        let pictures = PyDict::new(py);
        for (name, array) in names.iter().zip(arrays) {
            pictures.set_item(name, array?)?;
        }
        Ok(pictures.into_any())
    }
}
