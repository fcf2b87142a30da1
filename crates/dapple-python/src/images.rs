//! Reads and writes image files: PNG and OpenEXR, NumPy arrays and raw heights; other formats are only read.

use crate::data;
use crate::error::{DappleWarning, Error, Result};
use crate::pictures::{Content, Kind, Pixels};
use crate::recipe::content_of;
use crate::threads;
use crate::watch::{self, Stop};
use dapple::color::{LinearRgb, LinearRgba, Normal};
use dapple::image::{self, Depth, Encoding, Image, Limits, RowWriter};
use dapple::raster::{Raster, RasterView};
use dapple::recipe::ImageAlpha;
use dapple::tile::Map;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyMapping};
use std::ffi::CString;
use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};

/// Options for reading an image: its content, the handling of alpha, and the layer.
struct Reading {
    content: Option<Content>,
    alpha: Alpha,
    layer: Option<String>,
}

/// How the alpha of an image is handled.
#[derive(PartialEq)]
enum Alpha {
    /// Alpha is included if any pixel is not opaque.
    Needed,
    /// Alpha is always included, and added if missing.
    Always,
    /// Alpha is removed.
    Without(ImageAlpha),
}

impl Reading {
    fn new(content: Option<&str>, alpha: Option<&str>, layer: Option<String>) -> Result<Self> {
        let content = content.map(|name| data::named("content", name));
        let alpha = match alpha {
            None => Alpha::Needed,
            Some("keep") => Alpha::Always,
            Some(text) => Alpha::Without(data::read("alpha", text.into())?),
        };
        Ok(Self {
            content: content.transpose()?,
            alpha,
            layer,
        })
    }

    /// Converts an image to maps. Returns the kind of the image, and its maps.
    fn maps(&self, image: &Image) -> Result<(Kind, Vec<Map>)> {
        let layer = self.layer.as_ref().map(|name| image.layer(name));
        let layer = layer.transpose()?;
        let image = layer.as_ref().unwrap_or(image);
        let of = |content, maps: Vec<Map>, n_channels| {
            (
                Kind {
                    content,
                    n_channels,
                },
                maps,
            )
        };
        match self.content {
            Some(Content::Gray) => {
                return Ok(of(Content::Gray, vec![Map::Value(image.gray()?)], 1));
            }
            Some(Content::Normal) => {
                return Ok(of(Content::Normal, vec![Map::Normal(image.normals()?)], 3));
            }
            Some(Content::Data) => {
                let maps: Vec<_> = channels(image)?.into_iter().map(Map::Value).collect();
                let n_channels = maps.len();
                return Ok(of(Content::Data, maps, n_channels));
            }
            Some(Content::Color) | None => {}
        }
        if self.content.is_none()
            && self.alpha != Alpha::Always
            && let Ok(values) = image.gray()
        {
            return Ok(of(Content::Gray, vec![Map::Value(values)], 1));
        }
        let pixels = image.color_alpha()?;
        let is_opaque = || pixels.pixels().iter().all(|pixel| pixel.alpha == 1.0);
        let plain = match self.alpha {
            Alpha::Needed if is_opaque() => ImageAlpha::Drop,
            Alpha::Needed | Alpha::Always => {
                let color = Map::Color(pixels.map(|pixel| pixel.color));
                let alpha = Map::Value(pixels.map(|pixel| pixel.alpha));
                return Ok(of(Content::Color, vec![color, alpha], 4));
            }
            Alpha::Without(how) => how,
        };
        let color = match plain {
            ImageAlpha::Drop => pixels.map(|pixel| pixel.color),
            // Composite as the command does: OpenEXR colors are premultiplied, so that light at alpha 0 is added to
            // the color below.
            ImageAlpha::Over(below) => {
                let covered = match image {
                    Image::Planes(_, exr) => exr.associated()?.0,
                    _ => pixels.map(|pixel| pixel.color * pixel.alpha),
                };
                let over =
                    |&color: &LinearRgb, pixel: &LinearRgba| color + below * (1.0 - pixel.alpha);
                covered.zip_map(&pixels, over)?
            }
        };
        Ok(of(Content::Color, vec![Map::Color(color)], 3))
    }
}

/// Reads each channel of an image as a raster of its codes, scaled to 0 to 1 without sRGB decoding.
fn channels(image: &Image) -> Result<Vec<Raster<f32>>> {
    match image {
        Image::Codes(_, png) => Ok(png.pixels.planes()),
        Image::Planes(_, exr) => {
            let planes = exr.to_picture()?.planes.into_iter();
            Ok(planes.map(|plane| plane.values).collect())
        }
        _ => Err(Error::new(
            "unsupported",
            "the format has no channels of data",
        )),
    }
}

/// Reads an image file as a float32 array: PNG, JPEG, OpenEXR, TIFF, WebP, TGA or Radiance HDR, recognized by its content.
///
/// Gray images are read without sRGB decoding, (rows, columns); values of 8 and 16 bits are from 0 to 1. Colors are
/// linear BT.709 light, converted from the color space that the file declares, (rows, columns, 3), or (rows, columns,
/// 4) if any pixel is not opaque; alpha is not multiplied into them. For OpenEXR, the array has the pixels of the
/// display window.
///
/// Parameters
/// ----------
/// path : str or os.PathLike
///     The path of the file.
/// content : {"gray", "color", "normal", "data"} or None, default None
///     The content, if it does not follow from the channels: `"gray"`, `"color"` (also for a gray image), `"normal"`
///     (unit vectors of a normal map), or `"data"` (all channels without decoding, such as occlusion, roughness and
///     metallic).
/// alpha : str or None, default None
///     None includes alpha if any pixel is not opaque; `"keep"` always includes it; `"drop"` removes it;
///     `"over:#808080"` composites the image over a color.
/// layer : str or None, default None
///     The layer of an OpenEXR file with several layers, such as `"ViewLayer.DiffCol"`. By default the layer without
///     a name, `Combined`, `rgba` or `beauty`, and the first of several views; the error message lists all layers.
///     Other formats have no layers.
/// max_pixels : int, default 268435456
///     Maximum number of pixels; a larger image is an error before memory is allocated for it.
/// max_bytes : int, default 4294967296
///     Maximum number of bytes; a larger image is an error before memory is allocated for it.
///
/// Returns
/// -------
/// numpy.ndarray of float32
///     The array, (rows, columns), (rows, columns, 3) or (rows, columns, 4).
///
/// Raises
/// ------
/// DappleError
///     If the file is not a readable image, exceeds the limits, or lacks the `layer`, or if the `content` does not
///     match its channels.
/// OSError
///     If the system cannot read or write the file: `FileNotFoundError` if it does not exist.
///
/// Examples
/// --------
/// >>> import os, tempfile, dapple_textures as dp
/// >>> path = os.path.join(tempfile.mkdtemp(), "cells.png")
/// >>> dp.write_image(path, dp.worley(seed=7).render((64, 96), extent=(6, 4)))
/// >>> dp.read_image(path).shape
/// (64, 96)
#[pyfunction]
#[pyo3(signature = (path, *, content = None, alpha = None, layer = None, max_pixels = 268_435_456, max_bytes = 4_294_967_296),
    text_signature = "(path, *, content=None, alpha=None, layer=None, max_pixels=268435456, max_bytes=4294967296)")]
pub(crate) fn read_image<'py>(
    py: Python<'py>,
    path: PathBuf,
    content: Option<&str>,
    alpha: Option<&str>,
    layer: Option<String>,
    max_pixels: u64,
    max_bytes: u64,
) -> Result<Bound<'py, PyAny>> {
    let limits = Limits {
        pixels: max_pixels,
        bytes: max_bytes,
    };
    let reading = Reading::new(content, alpha, layer)?;
    let (kind, maps) = threads::run(py, move || reading.maps(&image::read_image(path, &limits)?))??;
    kind.array(py, maps)
}

/// Decodes an image file in memory to an array; see `read_image`.
///
/// Parameters
/// ----------
/// data : bytes
///     The contents of the file.
/// content : {"gray", "color", "normal", "data"} or None, default None
///     The content of the image, as in `read_image`.
/// alpha : str or None, default None
///     How alpha is handled, as in `read_image`.
/// layer : str or None, default None
///     The layer of an OpenEXR file with several layers, as in `read_image`.
/// max_pixels : int, default 268435456
///     The maximum number of pixels.
/// max_bytes : int, default 4294967296
///     The maximum number of bytes in the file and in its decoded pixels.
///
/// Returns
/// -------
/// numpy.ndarray of float32
///     The array, as returned by `read_image`.
///
/// Raises
/// ------
/// DappleError
///     If the bytes are not a readable image, exceed the limits, or lack the `layer`, or if the `content` does not
///     match their channels.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> dp.decode_image(dp.encode_image([[0.0, 1.0]])).tolist()
/// [[0.0, 1.0]]
#[pyfunction]
#[pyo3(signature = (data, *, content = None, alpha = None, layer = None, max_pixels = 268_435_456, max_bytes = 4_294_967_296),
    text_signature = "(data, *, content=None, alpha=None, layer=None, max_pixels=268435456, max_bytes=4294967296)")]
pub(crate) fn decode_image<'py>(
    py: Python<'py>,
    data: &[u8],
    content: Option<&str>,
    alpha: Option<&str>,
    layer: Option<String>,
    max_pixels: u64,
    max_bytes: u64,
) -> Result<Bound<'py, PyAny>> {
    let limits = Limits {
        pixels: max_pixels,
        bytes: max_bytes,
    };
    let reading = Reading::new(content, alpha, layer)?;
    let data = data.to_vec();
    let (kind, maps) = threads::run(py, move || {
        reading.maps(&image::decode_image(&data, &limits)?)
    })??;
    kind.array(py, maps)
}

/// Writes an array as an image file, in the format of its extension: `.png`, `.exr`, `.npy` or `.r16`.
///
/// The file is written under a temporary name and then renamed, so that other programs see either the old file or the
/// complete new one. The bytes are the same as those that the command `dapple` writes.
///
/// Parameters
/// ----------
/// path : str or os.PathLike
///     The path of the file.
/// image : array_like
///     (rows, columns), or (rows, columns, 3 or 4), floating point.
/// content : {"gray", "color", "normal", "data"} or None, default None
///     `"gray"`, `"color"`, `"normal"` or `"data"`; by default gray for one channel and color for more. Color is
///     linear in the array and in EXR and NPY, and sRGB in PNG. Normals are stored as `(component + 1) / 2` in PNG
///     and EXR. Data is unchanged.
/// depth : {8, 16} or None, default None
///     Bits per channel of a PNG file, 8 or 16; by default 8 for color and 16 for all other content.
///
/// Raises
/// ------
/// DappleError
///     If the extension is not a known format, the array is not floating point or its channels do not match `content`
///     or the format, or `depth` is not supported by the format.
/// OSError
///     If the system cannot read or write the file: `FileNotFoundError` if it does not exist.
///
/// Warns
/// -----
/// DappleWarning
///     If an integer format, `png` or `r16`, clips at least 1 % of the pixels (values below 0 or above 1).
///
/// Examples
/// --------
/// >>> import os, tempfile, dapple_textures as dp
/// >>> path = os.path.join(tempfile.mkdtemp(), "stones.png")
/// >>> dp.write_image(path, dp.ramp(dp.worley(seed=7).render(64, extent=4), "terrain"))
/// >>> dp.read_image(path).shape
/// (64, 64, 3)
#[pyfunction]
#[pyo3(signature = (path, image, *, content = None, depth = None))]
pub(crate) fn write_image(
    py: Python<'_>,
    path: PathBuf,
    image: &Bound<'_, PyAny>,
    content: Option<&str>,
    depth: Option<u32>,
) -> Result<()> {
    let ending = path.extension().unwrap_or_default().to_string_lossy();
    let name = path.display().to_string();
    let bytes = encoded(py, &name, image, &ending.to_lowercase(), content, depth)?;
    Ok(py.detach(|| image::replace(&path, &bytes))?)
}

/// Writes a material's maps as image files into a folder, which is created if necessary, and returns their paths.
///
/// The name of a map determines its encoding: `normal` is written as unit vectors, `orm` as data, `albedo` as color,
/// and every other map according to its channels, as in `write_image`.
///
/// Parameters
/// ----------
/// folder : str or os.PathLike
///     The folder for the files.
/// maps : dict of array_like
///     A dictionary of maps, as returned by `Plan.bake`.
/// name : str or None, default None
///     The prefix of the file names: `rock` for `rock_normal.png`; by default the files are named after the maps.
/// format : {"png", "exr", "npy"}, default "png"
///     `"png"`, `"exr"` or `"npy"`.
/// depth : {8, 16} or None, default None
///     Bits per channel of a PNG file, 8 or 16; by default 8 for color and 16 for all other content.
///
/// Returns
/// -------
/// list of Path
///     The paths of the files, in the order of `maps`.
///
/// Raises
/// ------
/// DappleError
///     If the format is unknown, a name is not a valid file name, an array does not match its map, or `depth` is not
///     supported by the format.
/// OSError
///     If the system cannot read or write the file: `FileNotFoundError` if it does not exist.
///
/// Warns
/// -----
/// DappleWarning
///     If an integer format, `png` or `r16`, clips at least 1 % of the pixels (values below 0 or above 1).
///
/// Examples
/// --------
/// >>> import tempfile, dapple_textures as dp
/// >>> maps = dp.Recipe.builtin("rock").plan().bake(64, ["normal", "orm", "albedo"])
/// >>> paths = dp.write_maps(tempfile.mkdtemp(), maps, name="rock")
/// >>> [path.name for path in paths]
/// ['rock_normal.png', 'rock_orm.png', 'rock_albedo.png']
#[pyfunction]
#[pyo3(signature = (folder, maps, *, name = None, format = "png", depth = None))]
#[expect(
    clippy::disallowed_methods,
    reason = "the library writes files, but makes no folders"
)]
pub(crate) fn write_maps(
    py: Python<'_>,
    folder: PathBuf,
    maps: &Bound<'_, PyMapping>,
    name: Option<&str>,
    format: &str,
    depth: Option<u32>,
) -> Result<Vec<PathBuf>> {
    let maps: Vec<(String, Bound<'_, PyAny>)> = maps.items()?.extract()?;
    let begin = name.map(|name| format!("{name}_")).unwrap_or_default();
    let files = maps.iter().map(|(map, _)| {
        let file = format!("{begin}{map}.{format}");
        if Path::new(&file)
            .file_name()
            .is_some_and(|name| name == &*file)
        {
            return Ok(folder.join(file));
        }
        let message = format!("`{file}` is no name of a file");
        Err(Error::new("name", message))
    });
    let files = files.collect::<Result<Vec<_>>>()?;
    fs::create_dir_all(&folder).map_err(|error| match error.raw_os_error() {
        Some(code) => Error::of_system(code, Some(&folder)),
        None => Error::new(
            "io",
            format!("{} cannot be made: {error}", folder.display()),
        ),
    })?;
    for (file, (map, image)) in files.iter().zip(&maps) {
        let content = content_of(map).map(|content| content.to_string());
        write_image(py, file.clone(), image, content.as_deref(), depth)?;
    }
    Ok(files)
}

/// Encodes an array as an image file in memory; see `write_image`.
///
/// Parameters
/// ----------
/// image : array_like
///     The image, as for `write_image`.
/// format : {"png", "exr", "npy", "r16"}, default "png"
///     The format of the bytes.
/// content : {"gray", "color", "normal", "data"} or None, default None
///     The content of the image, as in `write_image`.
/// depth : {8, 16} or None, default None
///     Bits per channel, as in `write_image`.
///
/// Returns
/// -------
/// bytes
///     The contents of the file.
///
/// Raises
/// ------
/// DappleError
///     If the format is unknown, the array is not floating point or its channels do not match `content` or the
///     format, or `depth` is not supported by the format.
///
/// Warns
/// -----
/// DappleWarning
///     If an integer format, `png` or `r16`, clips at least 1 % of the pixels (values below 0 or above 1).
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> dp.encode_image([[0.0, 1.0]], "png", depth=8)[:4]
/// b'\x89PNG'
#[pyfunction]
#[pyo3(signature = (image, format = "png", *, content = None, depth = None))]
pub(crate) fn encode_image<'py>(
    py: Python<'py>,
    image: &Bound<'py, PyAny>,
    format: &str,
    content: Option<&str>,
    depth: Option<u32>,
) -> Result<Bound<'py, PyBytes>> {
    let bytes = encoded(py, "the image", image, format, content, depth)?;
    Ok(PyBytes::new(py, &bytes))
}

/// Encodes an array, and warns if at least [`CLIPPED_MIN`] of the pixels are clipped. `name` is the name of the image
/// in the warning.
fn encoded(
    py: Python<'_>,
    name: &str,
    image: &Bound<'_, PyAny>,
    format: &str,
    content: Option<&str>,
    depth: Option<u32>,
) -> Result<Vec<u8>> {
    let pixels = Pixels::read("image", image)?;
    let content = content.map(|name| data::named("content", name));
    let kind = Kind::new("image", content.transpose()?, pixels.n_channels)?;
    let encoding = encoding(format, kind, depth)?;
    let (size, values) = (pixels.size, pixels.values());
    let (bytes, share) = watch::within(py, |stop| {
        let share = clipped_share(kind, &values, encoding, stop)?;
        Ok((encode(kind, size, &values, encoding, stop)?, share))
    })?;
    if share >= CLIPPED_MIN {
        let message = format!(
            "{:.1} % of the pixels of {name} are below 0 or above 1 and are clipped, which exr and npy keep",
            100.0 * share
        );
        let category = py.get_type::<DappleWarning>();
        PyErr::warn(
            py,
            &category,
            &CString::new(message).map_err(PyErr::from)?,
            1,
        )?;
    }
    Ok(bytes)
}

/// Minimum fraction of clipped pixels for a warning, equal to the threshold of the command.
const CLIPPED_MIN: f64 = 0.01;

/// Returns the fraction of pixels that an integer format clips, that is, pixels with a value below 0 or above 1 by
/// more than half a 16-bit code. Normals are never clipped.
fn clipped_share(kind: Kind, values: &[f32], encoding: Encoding, stop: &Stop) -> Result<f64> {
    const HALF_CODE: f32 = 0.5 / 65_535.0;
    if kind.content == Content::Normal || matches!(encoding, Encoding::Exr | Encoding::Npy) {
        return Ok(0.0);
    }
    let is_outside = |number: &f32| *number < -HALF_CODE || *number > 1.0 + HALF_CODE;
    let mut n_clipped = 0;
    for band in values.chunks(BAND * kind.n_channels) {
        stop.check()?;
        let pixels = band.chunks_exact(kind.n_channels);
        n_clipped += pixels.filter(|pixel| pixel.iter().any(is_outside)).count();
    }
    let n_pixels = (values.len() / kind.n_channels).max(1);
    Ok(n_clipped as f64 / n_pixels as f64)
}

/// Returns how a format encodes values.
fn encoding(format: &str, kind: Kind, depth: Option<u32>) -> Result<Encoding> {
    let default = if kind.content == Content::Color {
        8
    } else {
        16
    };
    match (format, depth) {
        ("png", depth) => match depth.unwrap_or(default) {
            8 => Ok(Encoding::Png(Depth::Eight)),
            16 => Ok(Encoding::Png(Depth::Sixteen)),
            depth => {
                let message = format!("the depth is {depth}, but PNG has 8 or 16 bits");
                Err(Error::new("depth", message))
            }
        },
        ("exr", None) => Ok(Encoding::Exr),
        ("npy", None) => Ok(Encoding::Npy),
        ("r16", None) => Ok(Encoding::R16),
        ("exr" | "npy" | "r16", Some(_)) => Err(Error::new(
            "depth",
            format!("the depth of {format} is fixed"),
        )),
        _ => {
            let message =
                format!("images are written as png, exr, npy or r16, and not as {format:?}");
            Err(Error::new("format", message))
        }
    }
}

/// Encodes values, in the order of pixels and channels, as the bytes of an image file.
pub(crate) fn encode(
    kind: Kind,
    size: [u32; 2],
    values: &[f32],
    encoding: Encoding,
    stop: &Stop,
) -> Result<Vec<u8>> {
    let sink = Cursor::new(Vec::new());
    let content = match (kind.content, kind.n_channels) {
        (Content::Gray, _) | (Content::Data, 1) => image::Content::Gray,
        (Content::Color, 3) => image::Content::Color,
        (Content::Color, _) => image::Content::ColorAlpha,
        (Content::Normal, _) => image::Content::Normal,
        (Content::Data, 3) => image::Content::Packed,
        (Content::Data, _) => image::Content::PackedFour,
    };
    let mut rows = RowWriter::new(sink, size, content, encoding)?;
    let color = |at: &[f32]| LinearRgb::new(at[0], at[1], at[2]);
    let color_alpha = |at: &[f32]| LinearRgba {
        color: color(at),
        alpha: at[3].clamp(0.0, 1.0),
    };
    let normal = |at: &[f32]| Normal {
        x: at[0],
        y: at[1],
        z: at[2],
    };
    let width = size[0] as usize;
    let n_rows = (BAND / width.max(1)).max(1);
    for band in values.chunks((width * kind.n_channels).max(1) * n_rows) {
        stop.check()?;
        let height = band.len() / (width * kind.n_channels).max(1);
        let size = [size[0], height as u32];
        match content {
            image::Content::Gray => rows.write_gray(RasterView::new(band, width, size)?)?,
            image::Content::Color => {
                let pixels: Vec<_> = band.chunks_exact(3).map(color).collect();
                rows.write_color(RasterView::new(&pixels, width, size)?)?;
            }
            image::Content::ColorAlpha => {
                let pixels: Vec<_> = band.chunks_exact(4).map(color_alpha).collect();
                rows.write_color_alpha(RasterView::new(&pixels, width, size)?)?;
            }
            image::Content::Normal => {
                let pixels: Vec<_> = band.chunks_exact(3).map(normal).collect();
                rows.write_normals(RasterView::new(&pixels, width, size)?)?;
            }
            image::Content::Packed => {
                rows.write_packed(RasterView::new(band.as_chunks().0, width, size)?)?;
            }
            image::Content::PackedFour => {
                rows.write_packed_four(RasterView::new(band.as_chunks().0, width, size)?)?;
            }
        }
    }
    Ok(rows.finish()?.into_inner())
}

/// Number of pixels converted and encoded at a time.
const BAND: usize = 1 << 18;
