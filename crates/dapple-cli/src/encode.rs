//! Encodes maps as image files.

use crate::args::RampArg;
use crate::error::{Hint, usage};
use crate::input::divided;
use crate::output::Target;
use anyhow::Result;
use dapple::color::{Code, Interpolation, LinearRgb, LinearRgba, Outside, RampSpace, bleed_color};
use dapple::image::{Content, Depth, Encoding, RowWriter};
use dapple::raster::Raster;
use dapple::recipe::{Input, Node, Ramped};
use dapple::tile::Map;
use std::io::Cursor;

dapple::raster::named! {
    /// The formats of images.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub(crate) enum Format {
        /// PNG with 8 bits per channel.
        Png8 = "png8",
        /// PNG with 16 bits per channel; also png.
        Png16 = "png16" | "png",
        /// OpenEXR with 32-bit floating point.
        Exr = "exr",
        /// A NumPy array of 32-bit floating point.
        Npy = "npy",
        /// Raw heights of 16 bits, as terrain importers take them, with a JSON file that says their size.
        R16 = "r16",
    }
}

impl Format {
    /// Returns the format for a target: the requested one, or else the one of the file extension.
    ///
    /// # Errors
    ///
    /// If no image format has this extension, or the extension conflicts with the requested format.
    pub(crate) fn choose(asked: Option<Self>, target: &Target, default: Self) -> Result<Self> {
        let by_ending = match (target, target.ending().as_str()) {
            (Target::Stdout, _) => return Ok(asked.unwrap_or(default)),
            (_, "png") => [Self::Png8, Self::Png16]
                .contains(&default)
                .then_some(default),
            (_, "exr") => Some(Self::Exr),
            (_, "npy") => Some(Self::Npy),
            (_, "r16") => Some(Self::R16),
            // A device, such as /dev/null, has no extension.
            (Target::Path(path), "") if path.exists() && !path.is_file() => {
                return Ok(asked.unwrap_or(default));
            }
            (_, ending) => {
                let error = usage(format!("{target}: unknown image format {ending:?}"));
                return Err(error.hint("use a name that ends in .png, .exr, .npy or .r16"));
            }
        };
        let format = asked.or(by_ending).unwrap_or(Self::Png16);
        if target.ending() == format.ending() {
            return Ok(format);
        }
        let error = usage(format!(
            "{target} is not a name for {}",
            format.ending().to_ascii_uppercase()
        ));
        Err(error.hint(format!("let it end in .{}", format.ending())))
    }

    /// Returns how values are encoded in this format.
    pub(crate) fn encoding(self) -> Encoding {
        match self {
            Self::Png8 => Encoding::Png(Depth::Eight),
            Self::Png16 => Encoding::Png(Depth::Sixteen),
            Self::Exr => Encoding::Exr,
            Self::Npy => Encoding::Npy,
            Self::R16 => Encoding::R16,
        }
    }

    /// Returns whether numbers are stored unchanged, including those below 0 and above 1.
    pub(crate) fn keeps_numbers(self) -> bool {
        matches!(self, Self::Exr | Self::Npy)
    }

    /// Returns the number of bytes per value, and the bit depth as text.
    pub(crate) fn depth(self) -> (u64, &'static str) {
        match self {
            Self::Png8 => (1, "8 bits"),
            Self::Png16 | Self::R16 => (2, "16 bits"),
            Self::Exr | Self::Npy => (4, "32-bit floating point"),
        }
    }

    /// Checks that raw heights have a single channel.
    ///
    /// # Errors
    ///
    /// If the content has several channels.
    pub(crate) fn check(self, content: Content, target: &Target) -> Result<()> {
        if self != Self::R16 || content == Content::Gray {
            return Ok(());
        }
        let message =
            format!("{target}: raw heights are one number at each pixel, and this has several");
        Err(usage(message).hint("write a height as .r16, and this as .png, .exr or .npy"))
    }

    /// Returns the file extension of this format, without its dot.
    pub(crate) fn ending(self) -> &'static str {
        match self {
            Self::Png8 | Self::Png16 => "png",
            Self::Exr => "exr",
            Self::Npy => "npy",
            Self::R16 => "r16",
        }
    }
}

/// Returns a map's default format, which is 8-bit PNG for colors unless `is_deep`, and 16-bit PNG otherwise.
pub(crate) fn default_format(map: &Map, is_deep: bool) -> Format {
    match map {
        Map::Color(_) if !is_deep => Format::Png8,
        _ => Format::Png16,
    }
}

/// Applies a ramp to a map of values; other maps, and all maps without a ramp, are unchanged.
pub(crate) fn ramped(map: Map, ramp: Option<&RampArg>) -> Map {
    match (map, ramp) {
        (Map::Value(values), Some(ramp)) => Map::Color(ramp.ramp.apply(&values)),
        (map, _) => map,
    }
}

/// Creates a recipe node that colors an input by a ramp.
pub(crate) fn ramped_recipe(ramp: &RampArg, input: &Input) -> Node {
    Node::Ramp(Ramped {
        input: input.clone(),
        palette: None,
        colors: ramp.colors.clone(),
        positions: Vec::new(),
        space: RampSpace::default(),
        interpolation: Interpolation::Linear,
        outside: Outside::Clamp,
    })
}

/// Applies an expression to the raster of a map, and wraps the result in a map of the same kind.
macro_rules! map_raster {
    ($map:expr, $raster:ident => $make:expr) => {
        match $map {
            Map::Value($raster) => Map::Value($make),
            Map::Color($raster) => Map::Color($make),
            Map::Normal($raster) => Map::Normal($make),
        }
    };
}
pub(crate) use map_raster;

/// Encodes a map as the bytes of a file.
///
/// Values are `round(value * max)` in PNG and raw heights, and unchanged in EXR and NumPy arrays. Colors are sRGB in
/// PNG and linear in the other formats. Components of normals are stored as `(component + 1) / 2` in images, and
/// unchanged in arrays.
pub(crate) fn encode(map: &Map, format: Format) -> Result<Vec<u8>> {
    let (sink, encoding) = (Cursor::new(Vec::new()), format.encoding());
    let sink = match map {
        Map::Value(values) => {
            let mut rows = RowWriter::new(sink, values.size(), Content::Gray, encoding)?;
            rows.write_gray(values.view())?;
            rows.finish()?
        }
        Map::Color(colors) => {
            let mut rows = RowWriter::new(sink, colors.size(), Content::Color, encoding)?;
            rows.write_color(colors.view())?;
            rows.finish()?
        }
        Map::Normal(normals) => {
            let mut rows = RowWriter::new(sink, normals.size(), Content::Normal, encoding)?;
            rows.write_normals(normals.view())?;
            rows.finish()?
        }
    };
    Ok(sink.into_inner())
}

/// The alpha of an image, and whether the colors are multiplied by it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cover<'a> {
    alpha: &'a Raster<f32>,
    /// Whether the alpha is associated, that is, the colors are multiplied by it.
    is_associated: bool,
    clear: Clear,
}

impl<'a> Cover<'a> {
    /// Creates a cover from an image's alpha. Returns `None` if the image has no alpha.
    pub(crate) fn of(
        alpha: Option<&'a Raster<f32>>,
        is_associated: bool,
        clear: Clear,
    ) -> Option<Self> {
        let alpha = alpha?;
        Some(Self {
            alpha,
            is_associated,
            clear,
        })
    }

    /// Creates a cover for straight colors, which are not multiplied by alpha. `clear` selects the colors of pixels
    /// with alpha 0.
    pub(crate) fn straight(alpha: &'a Raster<f32>, clear: Clear) -> Self {
        Self {
            alpha,
            is_associated: false,
            clear,
        }
    }
}

/// How the colors of pixels with alpha 0 are written to PNG.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Clear {
    /// The colors are written unchanged.
    Keep,
    /// The color is copied from the nearest visible pixel, so that mip levels have no dark rims. `wraps` are the axes
    /// along which the image wraps.
    Bleed { wraps: [bool; 2] },
}

impl Clear {
    /// Bleeds colors without wrapping, for an image that is not known to repeat.
    pub(crate) const NOT_WRAPPED: Self = Self::Bleed { wraps: [false; 2] };
}

/// Encodes colors and their alpha as the bytes of a file, like [`encode`].
///
/// Associated colors and their alpha are unchanged in EXR. In all other cases, colors are straight, and alpha is
/// clamped to 0 to 1.
pub(crate) fn encode_with_alpha(
    colors: &Raster<LinearRgb>,
    cover: Cover<'_>,
    format: Format,
) -> Result<Vec<u8>> {
    let sink = Cursor::new(Vec::new());
    if cover.is_associated && format == Format::Exr {
        let four = |color: &LinearRgb, &alpha: &f32| [color.r, color.g, color.b, alpha];
        let pixels = colors.zip_map(cover.alpha, four)?;
        let content = Content::PackedFour;
        let mut rows = RowWriter::new(sink, pixels.size(), content, format.encoding())?;
        rows.write_packed_four(pixels.view())?;
        return Ok(rows.finish()?.into_inner());
    }
    // Convert to straight colors.
    let mut pixels = colors.zip_map(cover.alpha, |color, alpha| LinearRgba {
        color: match cover.is_associated {
            true => divided(color, alpha),
            false => *color,
        },
        alpha: alpha.clamp(0.0, 1.0),
    })?;
    if let (Clear::Bleed { wraps }, Encoding::Png(depth)) = (cover.clear, format.encoding()) {
        // Bleed colors into the pixels whose alpha rounds to the code 0.
        let is_clear = |alpha: f32| match depth {
            Depth::Eight => u8::from_unit(alpha) == 0,
            Depth::Sixteen => u16::from_unit(alpha) == 0,
        };
        for pixel in pixels.pixels_mut() {
            if is_clear(pixel.alpha) {
                pixel.alpha = 0.0;
            }
        }
        bleed_color(&mut pixels, wraps);
    }
    let mut rows = RowWriter::new(sink, pixels.size(), Content::ColorAlpha, format.encoding())?;
    rows.write_color_alpha(pixels.view())?;
    Ok(rows.finish()?.into_inner())
}

/// Encodes an image of three independent channels as the bytes of a file.
pub(crate) fn encode_packed(pixels: &Raster<[f32; 3]>, format: Format) -> Result<Vec<u8>> {
    let sink = Cursor::new(Vec::new());
    let mut rows = RowWriter::new(sink, pixels.size(), Content::Packed, format.encoding())?;
    rows.write_packed(pixels.view())?;
    Ok(rows.finish()?.into_inner())
}

/// Returns the content type of a map's image.
pub(crate) fn content(map: &Map) -> Content {
    match map {
        Map::Value(_) => Content::Gray,
        Map::Color(_) => Content::Color,
        Map::Normal(_) => Content::Normal,
    }
}

/// Returns the number of pixels with a component below 0 or above 1 by more than half a 16-bit code.
pub(crate) fn n_clipped<T: Sync, const N: usize>(
    raster: &Raster<T>,
    parts: impl Fn(&T) -> [f32; N],
) -> u64 {
    const HALF_CODE: f32 = 0.5 / 65_535.0;
    let is_outside = |part: &f32| *part < -HALF_CODE || *part > 1.0 + HALF_CODE;
    let pixels = raster.pixels().iter();
    pixels
        .filter(|pixel| parts(pixel).iter().any(is_outside))
        .count() as u64
}

/// Returns the number of pixels of a map that integer formats clip. Normals are never clipped.
pub(crate) fn n_clipped_of(map: &Map) -> u64 {
    match map {
        Map::Value(raster) => n_clipped(raster, |number| [*number]),
        Map::Color(raster) => n_clipped(raster, |color| color.to_array()),
        Map::Normal(_) => 0,
    }
}

/// Returns the minimum and maximum of the finite numbers of a map, over all channels. Components of normals are from -1
/// to 1.
pub(crate) fn range(map: &Map) -> [f32; 2] {
    let fold = |range: [f32; 2], value: f32| {
        if value.is_finite() {
            [range[0].min(value), range[1].max(value)]
        } else {
            range
        }
    };
    let none = [f32::INFINITY, f32::NEG_INFINITY];
    match map {
        Map::Value(raster) => raster.pixels().iter().copied().fold(none, fold),
        Map::Color(raster) => {
            let parts = raster.pixels().iter().flat_map(|color| color.to_array());
            parts.fold(none, fold)
        }
        Map::Normal(raster) => {
            let parts = raster.pixels().iter().flat_map(|normal| normal.to_array());
            parts.fold(none, fold)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Format, default_format, encode, range};
    use crate::output::Target;
    use dapple::color::{LinearRgb, Normal};
    use dapple::image::{Limits, decode_image};
    use dapple::raster::Raster;
    use dapple::tile::Map;
    use std::path::PathBuf;

    fn choose(asked: Option<Format>, name: &str) -> Option<Format> {
        let target = Target::Path(PathBuf::from(name));
        Format::choose(asked, &target, Format::Png8).ok()
    }

    #[test]
    fn the_ending_chooses_the_format_and_must_fit_what_was_asked() {
        assert_eq!(choose(None, "a.png"), Some(Format::Png8));
        assert_eq!(choose(None, "a.EXR"), Some(Format::Exr));
        assert_eq!(choose(Some(Format::Png16), "a.png"), Some(Format::Png16));
        assert_eq!(choose(Some(Format::Exr), "a.png"), None);
        assert_eq!(choose(None, "a.tiff"), None);
        assert_eq!(choose(None, "a"), None);
    }

    #[test]
    fn maps_come_back_from_every_format() {
        let maps = [
            Map::Value(Raster::filled([3, 2], 0.5).unwrap()),
            Map::Color(Raster::filled([3, 2], LinearRgb::WHITE).unwrap()),
            Map::Normal(Raster::filled([3, 2], Normal::FLAT).unwrap()),
        ];
        for map in &maps {
            for format in [Format::Png8, Format::Png16, Format::Exr] {
                let bytes = encode(map, format).unwrap();
                let image = decode_image(&bytes, &Limits::default()).unwrap();
                assert_eq!(image.size(), [3, 2], "{format:?} of {map:?}");
                let is_gray = matches!(map, Map::Value(_));
                assert_eq!(image.gray().is_ok(), is_gray, "{format:?} of {map:?}");
            }
        }
        assert_eq!(
            maps.map(|map| default_format(&map, false)),
            [Format::Png16, Format::Png8, Format::Png16]
        );
    }

    #[test]
    fn ranges_leave_out_what_is_not_finite() {
        let values = vec![0.25, f32::NAN, -3.0, f32::INFINITY];
        let map = Map::Value(Raster::from_vec([2, 2], values).unwrap());
        assert_eq!(range(&map), [-3.0, 0.25]);
    }
}
