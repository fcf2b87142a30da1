//! Input files: images, meshes and text, with errors that suggest a remedy.

#![expect(
    clippy::disallowed_methods,
    reason = "this module is where the command reads files"
)]

use crate::args::{Alpha, ReadArgs, Region};
use crate::encode::map_raster;
use crate::error::{Hint, cause, usage};
use crate::finite::Faults;
use crate::output::read_back;
use anyhow::{Context, Error, Result, anyhow};
use dapple::color::{Code, LinearRgb, LinearRgba};
use dapple::image::{
    Channels, ExrImage, Image, ImageError, ImageErrorKind, Limits, PngPixels, decode_image,
    decode_npy, decode_png_region, decode_r16, read_image,
};
use dapple::mesh::{EncodedImage, Model};
use dapple::mesh_io::{MeshIoErrorKind, read_model, readable_endings};
use dapple::raster::Raster;
use dapple::recipe::{ImageAlpha, similar_words};
use dapple::tile::Map;
use serde::Deserialize;
use std::fs;
use std::io::{self, Read};
use std::path::Path;
use std::sync::OnceLock;

/// The largest number of bytes of a text.
const TEXT_MAX: u64 = 1 << 28;
/// The character that some editors put before a text.
const BYTE_ORDER_MARK: char = '\u{feff}';
/// The number of bytes by which formats of images are told apart.
const SIGNATURE_MAX: u64 = 16;
/// The largest number of similar names in an error message.
const NAMES_MAX: usize = 3;

/// The kind of quantity in an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Values if the image is gray, else color.
    ByChannels,
    /// Color, even if the image is gray.
    Colors,
    /// Normals: `2 code / max - 1`.
    Normals,
}

/// The largest number of pixels of an image that is read, if `--max-pixels` was given.
static MAX_PIXELS: OnceLock<u64> = OnceLock::new();

/// Sets the largest number of pixels of images that are read, for the whole process.
pub(crate) fn set_max_pixels(pixels: u64) {
    // Only the first call has an effect, and there is only one.
    let _ = MAX_PIXELS.set(pixels);
}

/// The limits of images that are read.
fn limits() -> Limits {
    let default = Limits::default();
    let pixels = MAX_PIXELS.get().copied().unwrap_or(default.pixels);
    // Four channels of 32 bits.
    let bytes = default.bytes.max(pixels.saturating_mul(16));
    Limits { pixels, bytes }
}

/// An image that was read, with its properties.
#[derive(Clone, Debug)]
pub(crate) struct Loaded {
    /// The pixels of the image.
    pub(crate) map: Map,
    /// The alpha of the pixels, if some are transparent and it is kept.
    pub(crate) alpha: Option<Raster<f32>>,
    /// Whether alpha is multiplied into the colors, as in OpenEXR, where light may cover nothing.
    pub(crate) is_associated: bool,
    /// The numbers of the file that are not finite, and were replaced.
    pub(crate) faults: Faults,
    /// Whether the file has more than 8 bits per channel.
    pub(crate) is_deep: bool,
    /// Whether the numbers are linear light, as in OpenEXR; in other formats they are sRGB codes.
    is_linear: bool,
}

impl Loaded {
    /// Colors that are from no image.
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

    /// Fails for numbers of the file that are not finite.
    ///
    /// # Errors
    ///
    /// The first of them, with its channel and its pixel.
    pub(crate) fn check_finite(&self, path: &Path) -> Result<()> {
        self.faults.check(&name(path), |_, _| true)
    }

    /// Multiplies alpha into the colors.
    ///
    /// # Errors
    ///
    /// If alpha has another size than the colors.
    pub(crate) fn associate(&mut self) -> Result<()> {
        if let (Map::Color(colors), Some(alpha), false) =
            (&mut self.map, &self.alpha, self.is_associated)
        {
            *colors = colors.zip_map(alpha, |&color, &alpha| color * alpha)?;
            self.is_associated = true;
        }
        Ok(())
    }

    /// Divides the colors by alpha, for what has no light without cover. Where alpha is 0, they are as they are.
    ///
    /// # Errors
    ///
    /// If alpha has another size than the colors.
    pub(crate) fn divide(&mut self) -> Result<()> {
        if let (Map::Color(colors), Some(alpha), true) =
            (&mut self.map, &self.alpha, self.is_associated)
        {
            *colors = colors.zip_map(alpha, divided)?;
            self.is_associated = false;
        }
        Ok(())
    }

    /// Another map of this image, such as one of its channels, without alpha.
    pub(crate) fn with_map(&self, map: Map) -> Self {
        Self {
            map,
            alpha: None,
            is_associated: false,
            faults: self.faults.clone(),
            ..*self
        }
    }

    /// The color of a gray value of a picture.
    pub(crate) fn color_of(&self, value: f32) -> LinearRgb {
        if self.is_linear {
            LinearRgb::gray(value)
        } else {
            LinearRgb::from_srgb([u16::from_unit(value); 3])
        }
    }

    /// The numbers of a map that was made of this image, which has one at each pixel; a picture in color says them by how
    /// light it is, in the codes of the file.
    ///
    /// # Errors
    ///
    /// If the map holds normals.
    pub(crate) fn numbers(&self, map: &Map) -> Result<Raster<f32>> {
        match map {
            Map::Value(values) => Ok(values.clone()),
            Map::Color(colors) => Ok(colors.map(|&color| self.value_of(color))),
            Map::Normal(_) => Err(anyhow!("normals are no numbers")),
        }
    }

    /// How light a color of a picture is, as a gray value of it.
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
        // A pipe, such as `<(…)` of a shell.
        let opened = fs::File::open(path).map_err(Error::new);
        let decoded = opened.and_then(|mut pipe| of_stream(&mut pipe, &limits));
        return decoded.with_context(|| name(path));
    }
    read_image(path, &limits).map_err(advise)
}

/// What `dapple info` reads: an image, or an array or heights as the command writes them.
#[derive(Debug)]
pub(crate) enum Content {
    /// An image.
    Image(Image),
    /// The channels of a NumPy array.
    Array(Vec<Raster<f32>>),
    /// Raw heights.
    Raw(Raster<u16>),
}

/// Numbers that were read, as they are in their file.
#[derive(Debug)]
pub(crate) struct Numbers {
    pub(crate) content: Content,
    /// Whether only the pixels of the region were read.
    pub(crate) is_part: bool,
}

/// Reads an image, a NumPy array, or raw heights with the JSON file beside them. Of an image with too many pixels the
/// region alone is read, where the format allows it.
///
/// # Errors
///
/// The errors of [`image`], and raw heights without a size.
pub(crate) fn numbers(path: &Path, region: Option<Region>) -> Result<Numbers> {
    let ending = path.extension().unwrap_or_default().to_string_lossy();
    let content = match ending.to_ascii_lowercase().as_str() {
        "npy" => {
            let bytes = whole(path, "an array")?;
            let channels = decode_npy(&bytes, &limits()).map_err(advise);
            Content::Array(channels.with_context(|| name(path))?)
        }
        "r16" => {
            let size = raw_size(path)?;
            let bytes = whole(path, "raw heights")?;
            let codes = decode_r16(&bytes, size, &limits()).map_err(advise);
            Content::Raw(codes.with_context(|| name(path))?)
        }
        _ => {
            let (image, is_part) = image_or_region(path, region)?;
            let content = Content::Image(image);
            return Ok(Numbers { content, is_part });
        }
    };
    let is_part = false;
    Ok(Numbers { content, is_part })
}

/// Reads an image; or only a region of it, if it has too many pixels and is a PNG. The second value says which.
fn image_or_region(path: &Path, region: Option<Region>) -> Result<(Image, bool)> {
    let error = match (image(path), region) {
        (Ok(image), _) => return Ok((image, false)),
        (Err(error), Some(region)) if exceeded_limit(&error).is_some() && path.is_file() => {
            let bytes = whole(path, "an image")?;
            let part = decode_png_region(&bytes, region.first, region.size, &limits());
            match part {
                Ok(part) => return Ok((Image::Png(part), true)),
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

/// The limit of pixels that an image exceeds, if this is the reason of the error.
pub(crate) fn exceeded_limit(error: &Error) -> Option<u64> {
    match cause::<ImageError>(error)?.kind() {
        ImageErrorKind::TooManyPixels { limit, .. } => Some(*limit),
        _ => None,
    }
}

/// All bytes of a regular file.
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

/// The size of raw heights, from the JSON file beside them.
fn raw_size(path: &Path) -> Result<[u32; 2]> {
    #[derive(Deserialize)]
    struct Size {
        width: u32,
        height: u32,
    }
    check_file(path, "raw heights")?;
    let beside = path.with_extension("json");
    let size = text(&beside).and_then(|text| Ok(serde_json::from_str::<Size>(&text)?));
    let Size { width, height } = size
        .with_context(|| format!("the size of {} is not known", path.display()))
        .hint(format!(
            "{} beside it says it: {{\"width\": …, \"height\": …}}",
            beside.display()
        ))?;
    Ok([width, height])
}

/// Decodes the image in a stream, which is read on only if it begins like an image: it may never end.
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

/// The hint for an image with alpha where an option handles it.
pub(crate) const ALPHA_HINT: &str = "add --alpha drop or --alpha over:COLOR";

/// Reads an image, or a part of it, as a map without alpha.
///
/// # Errors
///
/// The errors of [`image`]; channels that do not fit the kind; a part outside of the image; and, with the hint,
/// transparent pixels where `alpha` is `None`.
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

/// Reads an image, or a part of it, as a map, and keeps, drops or composites its alpha. Normals have no alpha.
///
/// # Errors
///
/// The errors of [`image`]; channels that do not fit the kind; a part outside of the image; numbers in it that are not
/// finite.
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

/// Reads an image like [`map_with_alpha`], also if numbers that are not finite had to be replaced: the caller checks
/// whether it uses these pixels.
///
/// # Errors
///
/// The errors of [`map_with_alpha`], but for numbers that are not finite.
pub(crate) fn map_with_faults(
    path: &Path,
    kind: Kind,
    region: Option<Region>,
    alpha: Alpha,
    read: &ReadArgs,
) -> Result<Loaded> {
    let (image, faults, is_part) = picture(path, region, read)?;
    let region = region.filter(|_| !is_part);
    let mut loaded = of_image(&image, path, kind, region, alpha)?;
    loaded.faults = match region {
        Some(region) => faults.crop(region.first, region.size)?,
        None => faults,
    };
    Ok(loaded)
}

/// Reads an image: of the layers of an OpenEXR file only the one that is used, with finite numbers. The last value says
/// whether the image is the region alone, as in [`image_or_region`].
fn picture(path: &Path, region: Option<Region>, read: &ReadArgs) -> Result<(Image, Faults, bool)> {
    let (mut image, is_part) = image_or_region(path, region)?;
    let mut faults = Faults::default();
    if let Image::Exr(exr) = &mut image {
        let of_file = |error| advise(error).context(name(path));
        let has_layers = exr.planes.iter().any(|plane| plane.name.contains('.'));
        if let Some(layer) = &read.layer {
            match exr.layer(layer) {
                Ok(layer) => *exr = layer,
                // A file of one layer is read as it is, beside one of several.
                Err(_) if !has_layers => {}
                Err(error) => return Err(of_file(error)),
            }
        }
        *exr = exr.to_picture().map_err(of_file)?;
        faults = Faults::replace(&mut exr.planes, read.nonfinite);
    }
    Ok((image, faults, is_part))
}

/// An image in a mesh file, as [`map_with_alpha`] gives one in a file of its own.
///
/// # Errors
///
/// If it is damaged, or has channels that do not fit the kind.
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

/// An image as a map.
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
        // Light that covers nothing has no color that could be divided out.
        (Image::Exr(exr), Alpha::Keep | Alpha::Without(ImageAlpha::Over(_))) => {
            Some(exr.associated().map_err(advise)?.0)
        }
        _ => None,
    };
    let is_associated = associated.is_some() && alpha == Alpha::Keep;
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

/// The uncoded values of a gray image with alpha.
fn values_beside_alpha(image: &Image, pixels: &Raster<LinearRgba>) -> Option<Raster<f32>> {
    let png = match image {
        Image::Png(png) => png,
        Image::Exr(_) if image.channels() == Channels::GrayAlpha => {
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

/// The map of an image whose pixels are all opaque.
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

/// A part of an image that was read, or all of it.
fn part(
    path: &Path,
    image: &Image,
    region: Option<Region>,
    map: Map,
    alpha: Option<Raster<f32>>,
) -> Result<Loaded> {
    let is_deep = image.bits() > 8;
    let is_linear = matches!(image, Image::Exr(_));
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

/// Checks that an image has the size of another.
///
/// # Errors
///
/// If the sizes differ, with both names and sizes.
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

/// The name of an input in messages.
pub(crate) fn name(path: &Path) -> String {
    if path == Path::new("-") {
        "standard input".to_owned()
    } else {
        path.display().to_string()
    }
}

/// Reads a mesh.
///
/// # Errors
///
/// If the file does not exist, has another format, or is empty or damaged.
pub(crate) fn model(path: &Path) -> Result<Model> {
    check_file(path, "a mesh")?;
    read_model(path).map_err(|error| {
        let hint = match error.kind() {
            MeshIoErrorKind::Format { .. } => {
                Some(format!("a mesh is a file in {}", mesh_endings()))
            }
            MeshIoErrorKind::Unsupported { .. } => {
                Some("export it without this feature, or as .obj or .ply".to_owned())
            }
            _ => None,
        };
        let error =
            Error::new(error).context(format!("{} cannot be read as a mesh", path.display()));
        match hint {
            Some(hint) => error.hint(hint),
            None => error,
        }
    })
}

/// What a mesh is not used for, as a line for people: what its reader left out, and unit squares that share a texture.
pub(crate) fn not_used(path: &Path, model: &Model) -> Option<String> {
    let mut parts = model.left_out.clone();
    parts.extend(unit_squares(model));
    let parts = parts.join("; ");
    (!parts.is_empty()).then(|| format!("{}: not used: {parts}", name(path)))
}

/// The unit squares of texture coordinates, if there are several.
pub(crate) fn unit_squares(model: &Model) -> Option<String> {
    let squares = model.unit_squares();
    if squares.len() < 2 {
        return None;
    }
    let mut names: Vec<_> = squares.iter().take(NAMES_MAX).map(u32::to_string).collect();
    if squares.len() > names.len() {
        names.push("…".to_owned());
    }
    Some(format!(
        "that texture coordinates lie in {} unit squares ({}), since all share one texture",
        squares.len(),
        names.join(", ")
    ))
}

/// The endings of mesh files, as help texts list them.
pub(crate) fn mesh_endings() -> String {
    let endings: Vec<_> = readable_endings()
        .map(|ending| format!(".{ending}"))
        .collect();
    endings.join(", ")
}

/// Reads a text; `-` is standard input.
///
/// # Errors
///
/// If there is no such file, it is too long, or it is not UTF-8.
pub(crate) fn text(path: &Path) -> Result<String> {
    let mut bytes = Vec::new();
    let read = if path == Path::new("-") {
        io::stdin()
            .lock()
            .take(TEXT_MAX + 1)
            .read_to_end(&mut bytes)
    } else {
        check_file(path, "a text")?;
        fs::File::open(path).and_then(|file| file.take(TEXT_MAX + 1).read_to_end(&mut bytes))
    };
    read.with_context(|| format!("{} cannot be read", path.display()))?;
    if bytes.len() as u64 > TEXT_MAX {
        return Err(anyhow!("{} has more than {TEXT_MAX} bytes", path.display()));
    }
    decoded(bytes).with_context(|| name(path))
}

/// The text in some bytes in UTF-8, without a byte order mark.
fn decoded(bytes: Vec<u8>) -> Result<String> {
    let found = match bytes.as_slice() {
        // The mark of UTF-32 in little endian begins like that of UTF-16.
        [0xff, 0xfe, 0, 0, ..] | [0, 0, 0xfe, 0xff, ..] => Some("UTF-32"),
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => Some("UTF-16"),
        _ => None,
    };
    if let Some(found) = found {
        return Err(anyhow!("the text is in {found}, and not in UTF-8").hint("save it as UTF-8"));
    }
    let text = String::from_utf8(bytes).map_err(|_| anyhow!("it is not a text in UTF-8"))?;
    Ok(text.trim_start_matches(BYTE_ORDER_MARK).to_owned())
}

/// Reads the planes of an EXR image of this size.
///
/// # Errors
///
/// If there is no such file, or it is damaged, too large, or of another size.
pub(crate) fn exr(path: &Path, size: [u32; 2]) -> Result<ExrImage> {
    check_file(path, "an image")?;
    let pixels = u64::from(size[0]) * u64::from(size[1]);
    // Four planes, and the rest of the file: its header and the places of its tiles.
    let bytes = pixels.saturating_mul(20).saturating_add(1 << 20);
    match read_image(path, &Limits { pixels, bytes }).map_err(advise)? {
        Image::Exr(image) => Ok(image),
        _ => Err(anyhow!("{} is no EXR image", path.display())),
    }
}

/// The SHA-256 of a file, in hexadecimal.
///
/// # Errors
///
/// If there is no such file, or it cannot be read.
pub(crate) fn sha256(path: &Path) -> Result<String> {
    check_file(path, "an image")?;
    let content = dapple::image::open_regular(path).and_then(read_back);
    let content = content.with_context(|| format!("{} cannot be read", path.display()))?;
    Ok(content.sha256)
}

/// Crops a map.
fn crop(map: &Map, region: Region) -> Result<Map> {
    let Region { first, size } = region;
    Ok(map_raster!(map, raster => raster.crop(first, size)?))
}

/// A color with its alpha divided out, if there is any.
pub(crate) fn divided(&color: &LinearRgb, &alpha: &f32) -> LinearRgb {
    if alpha == 0.0 {
        color
    } else {
        LinearRgb::from(color.to_array().map(|part| part / alpha))
    }
}

/// Adds a hint to frequent errors.
fn advise(error: ImageError) -> Error {
    let hint = match error.kind() {
        ImageErrorKind::UnknownFormat => {
            Some("PNG, JPEG and OpenEXR images are read; convert it first")
        }
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
            "add --max-pixels N to read larger images, or --region X,Y,W,H for a part of a PNG",
        ),
        _ => None,
    };
    match hint {
        Some(hint) => Error::new(error).hint(hint),
        None => error.into(),
    }
}

/// Fails for a path that does not exist, a folder, and an empty file.
fn check_file(path: &Path, what: &str) -> Result<()> {
    let found = match fs::metadata(path) {
        Ok(found) => found,
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            let error = anyhow!("{}: there is no such file", path.display());
            return Err(match similar_names(path).as_slice() {
                [] => error,
                names => error.hint(format!("there is {}", names.join(", "))),
            });
        }
        Err(error) => {
            return Err(error).with_context(|| format!("{} cannot be read", path.display()));
        }
    };
    if found.is_dir() {
        return Err(anyhow!("{} is a folder, and not {what}", path.display()));
    }
    if is_device(&found) {
        return Err(anyhow!("{} is a device, and not {what}", path.display()));
    }
    if found.is_file() && found.len() == 0 {
        return Err(anyhow!("{} is empty, and not {what}", path.display()));
    }
    Ok(())
}

/// Whether a file is a device or a socket, from which reading may never end. A pipe is none: the user has made it.
#[cfg(unix)]
fn is_device(found: &fs::Metadata) -> bool {
    use std::os::unix::fs::FileTypeExt;
    let kind = found.file_type();
    kind.is_char_device() || kind.is_block_device() || kind.is_socket()
}

#[cfg(not(unix))]
fn is_device(_: &fs::Metadata) -> bool {
    false
}

/// Checks that a path that a file names, and not the command line, is a regular file. Pipes and devices of others could
/// let the command wait for ever.
///
/// # Errors
///
/// If it exists and is no regular file.
pub(crate) fn check_regular(path: &Path, what: &str) -> Result<()> {
    check_file(path, what)?;
    dapple::image::open_regular(path)
        .map(drop)
        .with_context(|| format!("{} cannot be read as {what}", path.display()))
}

/// Similar names in the folder of a path, the most similar first.
fn similar_names(path: &Path) -> Vec<String> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let folder = path.parent().unwrap_or(Path::new(""));
    let listed = if folder.as_os_str().is_empty() {
        fs::read_dir(".")
    } else {
        fs::read_dir(folder)
    };
    let entries = listed.into_iter().flatten().flatten();
    let others: Vec<_> = entries
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    let names = similar_words(&name, others.iter().map(String::as_str)).into_iter();
    names
        .take(NAMES_MAX)
        .map(|name| folder.join(name).display().to_string())
        .collect()
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

    /// The bytes of a PNG image of one color, with the chunk `cICP` for Display P3.
    fn display_p3(color: [u8; 3]) -> Vec<u8> {
        let raster = Raster::filled([4, 4], color).unwrap();
        let mut bytes = encode_png(raster.view(), Transfer::Data).unwrap();
        // The chunk follows the header, which ends at 33. Its checksum is the CRC-32 of its name and data.
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
