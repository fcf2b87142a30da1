//! Reads input files: images, meshes and text. Errors have hints.

#![expect(
    clippy::disallowed_methods,
    reason = "this module is where the command reads files"
)]

mod files;
mod meshes;
mod numbers;
mod text;

pub(crate) use files::{check_regular, name};
pub(crate) use meshes::{mesh_endings, model, not_used, unit_squares};
pub(crate) use numbers::{Content, numbers};
pub(crate) use text::text;

use crate::args::{Alpha, ReadArgs, Region};
use crate::encode::map_raster;
use crate::error::{Hint, cause, usage};
use crate::finite::Faults;
use crate::job::eprintln_if_possible;
use crate::output::read_back;
use anyhow::{Context, Error, Result, anyhow};
use dapple::color::{Code, LinearRgb, LinearRgba};
use dapple::image::{
    Channels, ExrImage, Format, Image, ImageError, ImageErrorKind, Limits, PngPixels,
    decode_exr_region, decode_image, decode_png_region, read_image,
};
use dapple::mesh::EncodedImage;
use dapple::raster::Raster;
use dapple::recipe::ImageAlpha;
use dapple::tile::Map;
use files::check_file;
use std::fs;
use std::io::{self, Read};
use std::path::Path;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

/// Number of bytes at the beginning of a file that identify its image format.
const SIGNATURE_MAX: u64 = 32;
/// Maximum number of file names in a message.
const NAMES_MAX: usize = 3;

/// The kind of map that an image is read as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Gray values if the image is gray, otherwise colors.
    ByChannels,
    /// Colors, even if the image is gray.
    Colors,
    /// Normals with the components `2 code / max - 1`.
    Normals,
}

/// Maximum number of pixels of images that are read; unset unless `--max-pixels` is given.
static MAX_PIXELS: OnceLock<u64> = OnceLock::new();

/// Sets the maximum number of pixels of images that are read, for the whole process.
pub(crate) fn set_max_pixels(pixels: u64) {
    // Only the first call has an effect, and it is called once.
    let _ = MAX_PIXELS.set(pixels);
}

/// Whether notes about input files are suppressed.
static IS_QUIET: AtomicBool = AtomicBool::new(false);

/// Sets whether notes about input files are suppressed, for the whole process.
pub(crate) fn set_quiet(is_quiet: bool) {
    IS_QUIET.store(is_quiet, Ordering::Relaxed);
}

/// Returns the limits for images that are read.
fn limits() -> Limits {
    let default = Limits::default();
    let pixels = MAX_PIXELS.get().copied().unwrap_or(default.pixels);
    // A pixel has up to four channels of 32 bits.
    let bytes = default.bytes.max(pixels.saturating_mul(16));
    Limits { pixels, bytes }
}

/// An image that was read, with its properties.
#[derive(Clone, Debug)]
pub(crate) struct Loaded {
    /// The pixels of the image.
    pub(crate) map: Map,
    /// The alpha of the pixels; `None` if it is not kept or all pixels are opaque.
    pub(crate) alpha: Option<Raster<f32>>,
    /// Whether the alpha is associated, that is, the colors are multiplied by it. This is so in OpenEXR, where a pixel
    /// with alpha 0 may emit light.
    pub(crate) is_associated: bool,
    /// The NaN and infinite values of the file, which were replaced in `map`.
    pub(crate) faults: Faults,
    /// Whether the file has more than 8 bits per channel.
    pub(crate) is_deep: bool,
    /// Whether the file stores linear light, as OpenEXR does; codes are sRGB.
    is_linear: bool,
}

impl Loaded {
    /// Wraps colors that were not read from a file.
    pub(crate) fn of_colors(colors: Raster<LinearRgb>) -> Self {
        Self {
            map: Map::Color(colors),
            alpha: None,
            is_associated: false,
            faults: Faults::default(),
            is_deep: false,
            is_linear: false,
        }
    }

    /// Returns an error if the file has NaN or infinite values.
    ///
    /// # Errors
    ///
    /// If there is such a value. The message has the first one, with its channel and its pixel.
    pub(crate) fn check_finite(&self, path: &Path) -> Result<()> {
        self.faults.check(&name(path), |_, _| true)
    }

    /// Multiplies the colors by alpha, unless they are associated already.
    ///
    /// # Errors
    ///
    /// If the alpha differs in size from the colors.
    pub(crate) fn associate(&mut self) -> Result<()> {
        if let (Map::Color(colors), Some(alpha), false) =
            (&mut self.map, &self.alpha, self.is_associated)
        {
            *colors = colors.zip_map(alpha, |&color, &alpha| color * alpha)?;
            self.is_associated = true;
        }
        Ok(())
    }

    /// Divides associated colors by alpha, for formats and operations that use straight colors. Where alpha is 0, the
    /// colors are unchanged.
    ///
    /// # Errors
    ///
    /// If the alpha differs in size from the colors.
    pub(crate) fn divide(&mut self) -> Result<()> {
        if let (Map::Color(colors), Some(alpha), true) =
            (&mut self.map, &self.alpha, self.is_associated)
        {
            *colors = colors.zip_map(alpha, divided)?;
            self.is_associated = false;
        }
        Ok(())
    }

    /// Returns an image with another map, such as one of the channels, and with the properties of this image. It has no
    /// alpha.
    pub(crate) fn with_map(&self, map: Map) -> Self {
        Self {
            map,
            alpha: None,
            is_associated: false,
            faults: self.faults.clone(),
            ..*self
        }
    }

    /// Converts a gray value of the image to a color.
    pub(crate) fn color_of(&self, value: f32) -> LinearRgb {
        if self.is_linear {
            LinearRgb::gray(value)
        } else {
            LinearRgb::from_srgb([u16::from_unit(value); 3])
        }
    }

    /// Converts `map`, which is derived from this image, to one number per pixel. Colors are converted to their
    /// luminance, encoded as in the file.
    ///
    /// # Errors
    ///
    /// If the map has normals.
    pub(crate) fn numbers(&self, map: &Map) -> Result<Raster<f32>> {
        match map {
            Map::Value(values) => Ok(values.clone()),
            Map::Color(colors) => Ok(colors.map(|&color| self.value_of(color))),
            Map::Normal(_) => Err(anyhow!("normals are no numbers")),
        }
    }

    /// Converts a color to a gray value of the image, which is its luminance encoded as in the file.
    fn value_of(&self, color: LinearRgb) -> f32 {
        let lightness = color.luminance();
        if self.is_linear {
            lightness
        } else {
            let [code, ..] = LinearRgb::gray(lightness).to_srgb::<u16>();
            code.to_unit()
        }
    }
}

/// Reads an image; `-` is standard input.
///
/// # Errors
///
/// If the file does not exist, has another format, or is empty or damaged.
pub(crate) fn image(path: &Path) -> Result<Image> {
    let limits = limits();
    if path == Path::new("-") {
        return of_stream(&mut io::stdin().lock(), &limits).context("standard input");
    }
    check_file(path, "an image")?;
    if !path.is_file() {
        // The path is a pipe, such as `<(…)` of a shell.
        let opened = fs::File::open(path).map_err(Error::new);
        let decoded = opened.and_then(|mut pipe| of_stream(&mut pipe, &limits));
        return decoded.with_context(|| name(path));
    }
    read_image(path, &limits).map_err(advise)
}

/// Reads an image. If it has too many pixels and is a PNG or OpenEXR image, reads only the region; the second value is
/// then true.
fn image_or_region(path: &Path, region: Option<Region>) -> Result<(Image, bool)> {
    let error = match (image(path), region) {
        (Ok(image), _) => return Ok((image, false)),
        (Err(error), Some(region)) if exceeded_limit(&error).is_some() && path.is_file() => {
            let bytes = whole(path, "an image")?;
            match region_of(&bytes, region) {
                Ok(part) => return Ok((part, true)),
                Err(other) if matches!(other.kind(), ImageErrorKind::UnknownFormat) => error,
                Err(other) => {
                    let is_outside = matches!(other.kind(), ImageErrorKind::Outside { .. });
                    let error = Error::new(other).context(name(path));
                    return Err(if is_outside {
                        error.wrong_value()
                    } else {
                        error
                    });
                }
            }
        }
        (Err(error), _) => error,
    };
    Err(error)
}

/// Decodes a region of a PNG or OpenEXR image, whose rows or blocks can be decoded separately.
fn region_of(bytes: &[u8], Region { first, size }: Region) -> Result<Image, ImageError> {
    match decode_png_region(bytes, first, size, &limits()) {
        Err(error) if matches!(error.kind(), ImageErrorKind::UnknownFormat) => {
            let part = decode_exr_region(bytes, first, size, &limits());
            part.map(|image| Image::Planes(Format::Exr, image))
        }
        part => part.map(|image| Image::Codes(Format::Png, image)),
    }
}

/// Returns the maximum number of pixels if the error is that an image exceeds it; otherwise `None`.
pub(crate) fn exceeded_limit(error: &Error) -> Option<u64> {
    match cause::<ImageError>(error)?.kind() {
        ImageErrorKind::TooManyPixels { limit, .. } => Some(*limit),
        _ => None,
    }
}

/// Reads all bytes of a regular file, up to the maximum number of bytes for an image.
fn whole(path: &Path, what: &str) -> Result<Vec<u8>> {
    check_file(path, what)?;
    let limit = limits().bytes;
    let mut bytes = Vec::new();
    dapple::image::open_regular(path)
        .and_then(|file| file.take(limit.saturating_add(1)).read_to_end(&mut bytes))
        .with_context(|| format!("{} cannot be read", path.display()))?;
    if bytes.len() as u64 > limit {
        return Err(anyhow!("{} has more than {limit} bytes", path.display()));
    }
    Ok(bytes)
}

/// Decodes the image in a stream. A stream may never end, so reading continues only if it begins like an image.
fn of_stream(stream: &mut dyn Read, limits: &Limits) -> Result<Image> {
    let mut bytes = Vec::new();
    stream.take(SIGNATURE_MAX).read_to_end(&mut bytes)?;
    if let Err(error) = decode_image(&bytes, limits)
        && matches!(error.kind(), ImageErrorKind::UnknownFormat)
    {
        return Err(advise(error));
    }
    let left = limits.bytes.saturating_sub(bytes.len() as u64);
    stream.take(left).read_to_end(&mut bytes)?;
    decode_image(&bytes, limits).map_err(advise)
}

/// The hint for an image with alpha, for subcommands with the option `--alpha`.
pub(crate) const ALPHA_HINT: &str = "add --alpha drop or --alpha over:COLOR";

/// Reads an image, or a region of it, as a map without alpha.
///
/// # Errors
///
/// Same as [`image`], or if the channels do not fit the kind, the region exceeds the image, or pixels are transparent
/// and `alpha` is `None`. In the last case, the error has the given `hint`.
pub(crate) fn map(
    path: &Path,
    kind: Kind,
    region: Option<Region>,
    alpha: Option<ImageAlpha>,
    read: &ReadArgs,
    hint: &str,
) -> Result<Loaded> {
    let loaded = map_with_alpha(
        path,
        kind,
        region,
        alpha.map_or(Alpha::Keep, Alpha::Without),
        read,
    )?;
    if loaded.alpha.is_some() {
        let message = format!(
            "{} is partly transparent, which is not possible here",
            name(path)
        );
        return Err(usage(message).hint(hint));
    }
    Ok(loaded)
}

/// Reads an image, or a region of it, as a map, and keeps, drops or composites its alpha. Normals have no alpha.
///
/// # Errors
///
/// Same as [`image`], or if the channels do not fit the kind, the region exceeds the image, or it has NaN or infinite
/// values.
pub(crate) fn map_with_alpha(
    path: &Path,
    kind: Kind,
    region: Option<Region>,
    alpha: Alpha,
    read: &ReadArgs,
) -> Result<Loaded> {
    let loaded = map_with_faults(path, kind, region, alpha, read)?;
    loaded.check_finite(path)?;
    Ok(loaded)
}

/// Reads an image like [`map_with_alpha`], but accepts NaN and infinite values, which are replaced. The caller must
/// check the [`faults`](Loaded::faults) at the pixels that it uses.
///
/// # Errors
///
/// Same as [`map_with_alpha`], except for NaN and infinite values.
pub(crate) fn map_with_faults(
    path: &Path,
    kind: Kind,
    region: Option<Region>,
    alpha: Alpha,
    read: &ReadArgs,
) -> Result<Loaded> {
    let (image, faults, is_part) = picture(path, region, read)?;
    let has_colors = matches!(image, Image::Planes(..)) && image.channels() != Channels::Vectors;
    if is_part && kind == Kind::Normals && has_colors {
        let name = name(path);
        let error = usage(format!(
            "the planes of {name} are normals or their codes, which follows from all pixels"
        ));
        return Err(
            error.hint("read the whole image with --max-pixels, or name the planes X, Y and Z")
        );
    }
    let region = region.filter(|_| !is_part);
    let mut loaded = of_image(&image, path, kind, region, alpha)?;
    loaded.faults = match region {
        Some(region) => faults.crop(region.first, region.size)?,
        None => faults,
    };
    Ok(loaded)
}

/// Reads an image, selects the layer of an OpenEXR file, and replaces NaN and infinite values. Returns the image, the
/// replaced values, and whether only the region was read.
fn picture(path: &Path, region: Option<Region>, read: &ReadArgs) -> Result<(Image, Faults, bool)> {
    let (mut image, is_part) = image_or_region(path, region)?;
    let mut faults = Faults::default();
    if let Image::Planes(_, exr) = &mut image {
        let of_file = |error| advise(error).context(name(path));
        let has_layers = exr.planes.iter().any(|plane| plane.name.contains('.'));
        if let Some(layer) = &read.layer {
            match exr.layer(layer) {
                Ok(layer) => *exr = layer,
                // Accept a file without layers, since `--layer` may be meant for another input.
                Err(_) if !has_layers && !read.needs_layer => note_no_layers(path, layer),
                Err(error) => return Err(of_file(error)),
            }
        }
        *exr = exr.to_picture().map_err(of_file)?;
        faults = Faults::replace(&mut exr.planes, read.finite.nonfinite);
    } else if let Some(layer) = &read.layer {
        match image.layer(layer) {
            Err(error) if read.needs_layer => return Err(advise(error).context(name(path))),
            _ => note_no_layers(path, layer),
        }
    }
    Ok((image, faults, is_part))
}

/// Prints a note that `--layer` has no effect on a file.
fn note_no_layers(path: &Path, layer: &str) {
    if !IS_QUIET.load(Ordering::Relaxed) {
        let name = name(path);
        eprintln_if_possible(&format!(
            "note: {name} has no layers, so that --layer {layer} has no effect on it"
        ));
    }
}

/// Decodes an image that is embedded in a mesh file, as [`map_with_alpha`] reads an image from a separate file.
///
/// # Errors
///
/// If the image is damaged, or has channels that do not fit the kind.
pub(crate) fn embedded(
    image: &EncodedImage,
    path: &Path,
    kind: Kind,
    alpha: Alpha,
) -> Result<Loaded> {
    let image = decode_image(image.bytes(), &limits()).map_err(advise);
    let mut image = image.with_context(|| format!("a texture of {}", name(path)))?;
    let ending = path.extension().unwrap_or_default();
    if ["glb", "gltf"]
        .iter()
        .any(|gltf| ending.eq_ignore_ascii_case(gltf))
    {
        // glTF 2.0, 3.8.3: color space information in images must be ignored.
        image = image.without_color_space();
    }
    of_image(&image, path, kind, None, alpha)
}

/// Converts an image, or a region of it, to a map.
fn of_image(
    image: &Image,
    path: &Path,
    kind: Kind,
    region: Option<Region>,
    alpha: Alpha,
) -> Result<Loaded> {
    if kind != Kind::Normals && image.channels() == Channels::Vectors {
        let message = format!("{} holds vectors, and not values or colors", name(path));
        return Err(
            usage(message).hint("give it as a normal map, or name one of its planes: --layer X")
        );
    }
    let pixels = if kind != Kind::Normals && image.channels().has_alpha() {
        Some(image.color_alpha().map_err(advise)?)
    } else {
        None
    };
    let is_transparent = |pixels: &Raster<LinearRgba>| {
        let mut alphas = pixels.pixels().iter().map(|pixel| pixel.alpha);
        alphas.any(|alpha| alpha != 1.0)
    };
    let Some(pixels) = pixels.filter(is_transparent) else {
        let map = opaque(image, kind).with_context(|| name(path))?;
        return part(path, image, region, map, None);
    };
    let associated = match (image, alpha) {
        // Keep OpenEXR colors associated: light at alpha 0 has no straight color.
        (Image::Planes(_, exr), Alpha::Keep | Alpha::Without(ImageAlpha::Over(_))) => {
            Some(exr.associated().map_err(advise)?.0)
        }
        _ => None,
    };
    let is_associated = associated.is_some() && alpha == Alpha::Keep;
    // Keep, drop or composite the alpha.
    let map = match (alpha, values_beside_alpha(image, &pixels)) {
        (Alpha::Without(ImageAlpha::Drop), Some(values)) if kind == Kind::ByChannels => {
            Map::Value(values)
        }
        (Alpha::Keep | Alpha::Without(ImageAlpha::Drop), _) => {
            Map::Color(associated.unwrap_or_else(|| pixels.map(|pixel| pixel.color)))
        }
        (Alpha::Without(ImageAlpha::Over(below)), _) => {
            let colors =
                associated.unwrap_or_else(|| pixels.map(|pixel| pixel.color * pixel.alpha));
            let over = |&color: &LinearRgb, pixel: &LinearRgba| color + below * (1.0 - pixel.alpha);
            Map::Color(colors.zip_map(&pixels, over)?)
        }
    };
    let alpha = (alpha == Alpha::Keep).then(|| pixels.map(|pixel| pixel.alpha));
    let mut loaded = part(path, image, region, map, alpha)?;
    loaded.is_associated = is_associated;
    Ok(loaded)
}

/// Returns the gray values of a gray image with alpha, from 0 to 1 and without sRGB decoding; `None` for an image in
/// color.
fn values_beside_alpha(image: &Image, pixels: &Raster<LinearRgba>) -> Option<Raster<f32>> {
    let png = match image {
        Image::Codes(_, png) => png,
        Image::Planes(..) if image.channels() == Channels::GrayAlpha => {
            return Some(pixels.map(|pixel| pixel.color.r));
        }
        _ => return None,
    };
    match &png.pixels {
        PngPixels::GrayAlpha8(raster) => Some(raster.map(|[code, _]| code.to_unit())),
        PngPixels::GrayAlpha16(raster) => Some(raster.map(|[code, _]| code.to_unit())),
        _ => None,
    }
}

/// Converts an image whose pixels are all opaque to a map.
fn opaque(image: &Image, kind: Kind) -> Result<Map> {
    match kind {
        Kind::Normals => image.normals().map(Map::Normal).map_err(advise),
        Kind::Colors => image.color().map(Map::Color).map_err(advise),
        Kind::ByChannels => match image.gray() {
            Ok(values) => Ok(Map::Value(values)),
            Err(_) => image.color().map(Map::Color).map_err(advise),
        },
    }
}

/// Returns a map with the properties of the image it was read from, cropped to a region if one is given.
fn part(
    path: &Path,
    image: &Image,
    region: Option<Region>,
    map: Map,
    alpha: Option<Raster<f32>>,
) -> Result<Loaded> {
    let is_deep = image.bits() > 8;
    let is_linear = matches!(image, Image::Planes(..));
    let Some(region) = region else {
        return Ok(Loaded {
            map,
            alpha,
            is_associated: false,
            faults: Faults::default(),
            is_deep,
            is_linear,
        });
    };
    let cropped = alpha.map(|alpha| alpha.crop(region.first, region.size));
    Ok(Loaded {
        map: crop(&map, region)
            .wrong_value()
            .with_context(|| name(path))?,
        alpha: cropped.transpose().with_context(|| name(path))?,
        is_associated: false,
        faults: Faults::default(),
        is_deep,
        is_linear,
    })
}

/// Checks that an image is the same size as the first one.
///
/// # Errors
///
/// If the sizes differ. The error has both names and sizes.
pub(crate) fn check_size(
    path: &Path,
    size: [u32; 2],
    first: &Path,
    first_size: [u32; 2],
) -> Result<()> {
    if size == first_size {
        return Ok(());
    }
    let ([w, h], [first_w, first_h]) = (size, first_size);
    Err(usage(format!(
        "{} has {w} × {h} pixels, but {} has {first_w} × {first_h}",
        name(path),
        name(first)
    )))
}

/// Reads the planes of an OpenEXR image that has at most as many pixels as an image of `size`.
///
/// # Errors
///
/// If the file does not exist, is damaged or too large, or is not an OpenEXR image.
pub(crate) fn exr(path: &Path, size: [u32; 2]) -> Result<ExrImage> {
    check_file(path, "an image")?;
    let pixels = u64::from(size[0]) * u64::from(size[1]);
    // Allow 20 bytes per pixel, more than four planes take, and 1 MiB for the header and the tile offsets.
    let bytes = pixels.saturating_mul(20).saturating_add(1 << 20);
    match read_image(path, &Limits { pixels, bytes }).map_err(advise)? {
        Image::Planes(Format::Exr, image) => Ok(image),
        _ => Err(anyhow!("{} is no EXR image", path.display())),
    }
}

/// Computes the SHA-256 of a file, in hexadecimal.
///
/// # Errors
///
/// If the file does not exist or cannot be read.
pub(crate) fn sha256(path: &Path) -> Result<String> {
    check_file(path, "an image")?;
    let content = dapple::image::open_regular(path).and_then(read_back);
    let content = content.with_context(|| format!("{} cannot be read", path.display()))?;
    Ok(content.sha256)
}

/// Crops a map to a region.
fn crop(map: &Map, region: Region) -> Result<Map> {
    let Region { first, size } = region;
    Ok(map_raster!(map, raster => raster.crop(first, size)?))
}

/// Divides an associated color by its alpha. At alpha 0, the color is unchanged.
pub(crate) fn divided(&color: &LinearRgb, &alpha: &f32) -> LinearRgb {
    if alpha == 0.0 {
        color
    } else {
        LinearRgb::from(color.to_array().map(|part| part / alpha))
    }
}

/// Adds a hint to common errors.
fn advise(error: ImageError) -> Error {
    let hint = match error.kind() {
        ImageErrorKind::UnknownFormat => Some(
            "PNG, JPEG, OpenEXR, TIFF, WebP, TGA and Radiance HDR images are read; convert it first",
        ),
        ImageErrorKind::MissingPlane { .. } => {
            Some("the planes of an EXR image are R, G and B, or a single one")
        }
        ImageErrorKind::ColorSpace { .. } => {
            Some("convert it to sRGB in an image editor, or remove what it says of its colors")
        }
        ImageErrorKind::MissingLayer { .. } | ImageErrorKind::AmbiguousLayer { .. } => {
            Some("name one of them with --layer, or in a recipe with layer")
        }
        ImageErrorKind::TooManyPixels { .. } => Some(
            "add --max-pixels N to read larger images, or --region X,Y,W,H for a part of a PNG or OpenEXR image; \
             other formats are decoded as a whole",
        ),
        _ => None,
    };
    match hint {
        Some(hint) => Error::new(error).hint(hint),
        None => error.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::{Kind, embedded};
    use crate::args::Alpha;
    use dapple::color::LinearRgb;
    use dapple::image::{Transfer, encode_png};
    use dapple::mesh::EncodedImage;
    use dapple::raster::Raster;
    use dapple::tile::Map;
    use std::path::Path;

    /// Returns the bytes of a PNG image of one color. Its `cICP` chunk declares Display P3.
    fn display_p3(color: [u8; 3]) -> Vec<u8> {
        let raster = Raster::filled([4, 4], color).unwrap();
        let mut bytes = encode_png(raster.view(), Transfer::Data).unwrap();
        // Insert the chunk after the header, which ends at byte 33. Its checksum is the CRC-32 of its name and data.
        let chunk = [
            b"\0\0\0\x04cICP\x0c\x0d\0\x01".as_slice(),
            &0x6e03_e3ef_u32.to_be_bytes(),
        ]
        .concat();
        bytes.splice(33..33, chunk);
        bytes
    }

    #[test]
    fn textures_of_gltf_are_srgb_whatever_they_say() {
        let image = EncodedImage::new(display_p3([0, 255, 0])).unwrap();
        let color = |path: &str| {
            let read = embedded(&image, Path::new(path), Kind::Colors, Alpha::Keep).unwrap();
            match read.map {
                Map::Color(colors) => colors.pixels()[0],
                other => panic!("{other:?}"),
            }
        };
        let green = LinearRgb::new(0.0, 1.0, 0.0);
        assert_eq!(color("a.glb"), green);
        assert_eq!(color("A.GLTF"), green);
        assert!(color("a.obj").r < -0.2, "P3 beside BT.709");
    }
}
