//! Assigns maps to the channels of an image: one map, or several packed ones.

use crate::encode::Format;
use crate::encode::n_clipped;
use anyhow::{Result, anyhow};
use dapple::color::LinearRgba;
use dapple::image::{Content, ImageError, RowWriter};
use dapple::raster::Raster;
use dapple::recipe::{Band, MapKind, MapRows, Material};
use std::borrow::Cow;
use std::fmt;
use std::io::{Seek, Write};

/// An output image of a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Image {
    pub(crate) layers: Layers,
    pub(crate) format: Format,
}

/// The content of the channels of an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Layers {
    /// The channels of one map.
    Map(MapKind),
    /// The base color with the opacity as alpha.
    AlbedoOpacity,
    /// A single channel.
    Gray(Channel),
    /// Four independent channels: red, green, blue and alpha.
    Rgba([Channel; 4]),
}

/// The content of a channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Channel {
    /// A map of numbers.
    Of(MapKind),
    /// One minus a map of numbers.
    OneLess(MapKind),
    /// Half of a map of numbers.
    Half(MapKind),
    /// A constant number.
    Always(f32),
}

/// Consecutive rows of an image.
pub(crate) enum LayerRows<'a> {
    Map(Cow<'a, MapRows>),
    ColorAlpha(Raster<LinearRgba>),
    Rgba(Raster<[f32; 4]>),
}

impl Layers {
    /// Returns the layers of an image for a material: without opacity if the material is opaque; `None` if the material
    /// lacks a map of the image.
    pub(crate) fn of(self, material: &Material) -> Option<Self> {
        match self {
            Self::AlbedoOpacity if !material.has(MapKind::Opacity) => {
                Some(Self::Map(MapKind::Albedo))
            }
            layers => layers
                .kinds()
                .into_iter()
                .all(|kind| material.has(kind))
                .then_some(layers),
        }
    }

    /// Returns the kinds of the maps that the channels read.
    pub(crate) fn kinds(&self) -> Vec<MapKind> {
        match self {
            Self::Map(kind) => vec![*kind],
            Self::AlbedoOpacity => vec![MapKind::Albedo, MapKind::Opacity],
            Self::Gray(channel) => channel.kind().into_iter().collect(),
            Self::Rgba(channels) => channels.iter().filter_map(Channel::kind).collect(),
        }
    }

    /// Returns the content type of the image, which determines its encoding.
    pub(crate) fn content(&self) -> Content {
        match self {
            Self::Map(kind) => kind.content(),
            Self::AlbedoOpacity => Content::ColorAlpha,
            Self::Gray(_) => Content::Gray,
            Self::Rgba(_) => Content::PackedFour,
        }
    }

    /// Returns whether the image has colors, which are in sRGB in PNG.
    pub(crate) fn is_color(&self) -> bool {
        matches!(self.content(), Content::Color | Content::ColorAlpha)
    }

    /// Returns the number of channels.
    pub(crate) fn n_channels(&self) -> u64 {
        match self.content() {
            Content::Gray => 1,
            Content::Color | Content::Normal | Content::Packed => 3,
            Content::ColorAlpha | Content::PackedFour => 4,
        }
    }

    /// Assembles the rows of the image from a band, which must have all of its maps.
    pub(crate) fn rows<'a>(&self, band: &'a Band) -> Result<LayerRows<'a>> {
        match self {
            Self::Map(kind) => Ok(LayerRows::Map(Cow::Borrowed(map_of(*kind, band)?))),
            Self::AlbedoOpacity => {
                let opacity = numbers_of(MapKind::Opacity, band)?;
                let MapRows::Color(albedo) = map_of(MapKind::Albedo, band)? else {
                    return Err(anyhow!("the map albedo has no colors"));
                };
                let pixels = albedo.zip_map(opacity, |&color, &alpha| LinearRgba { color, alpha });
                Ok(LayerRows::ColorAlpha(pixels?))
            }
            Self::Gray(channel) => {
                let kind = channel.kind().unwrap_or(MapKind::Height);
                let pixels = numbers_of(kind, band)?.map(|&number| channel.value(Some(number)));
                Ok(LayerRows::Map(Cow::Owned(MapRows::Gray(pixels))))
            }
            Self::Rgba(channels) => {
                let size = band.maps.first().map_or([0; 2], |(_, rows)| rows.size());
                let mut pixels = vec![[0.0; 4]; size[0] as usize * size[1] as usize];
                for (index, channel) in channels.iter().enumerate() {
                    let numbers = channel.kind().map(|kind| numbers_of(kind, band));
                    let numbers = numbers.transpose()?.map(Raster::pixels);
                    for (at, pixel) in pixels.iter_mut().enumerate() {
                        pixel[index] = channel.value(numbers.map(|numbers| numbers[at]));
                    }
                }
                Ok(LayerRows::Rgba(Raster::from_vec(size, pixels)?))
            }
        }
    }
}

impl Channel {
    fn kind(&self) -> Option<MapKind> {
        match self {
            Self::Of(kind) | Self::OneLess(kind) | Self::Half(kind) => Some(*kind),
            Self::Always(_) => None,
        }
    }

    /// Returns the channel's value. `number` is the value of its map; it is ignored by a constant channel.
    fn value(self, number: Option<f32>) -> f32 {
        match self {
            Self::Of(_) => number.unwrap_or_default(),
            Self::OneLess(_) => 1.0 - number.unwrap_or_default(),
            Self::Half(_) => 0.5 * number.unwrap_or_default(),
            Self::Always(value) => value,
        }
    }
}

/// Describes the channels for help texts: `albedo in sRGB`, or `R metallic, G ao, B 1, A 1 - roughness`.
impl fmt::Display for Layers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Map(MapKind::Albedo) => f.write_str("albedo in sRGB"),
            Self::Map(MapKind::Emission) => f.write_str("emission in sRGB"),
            Self::AlbedoOpacity => f.write_str("albedo in sRGB, with opacity in A if there is any"),
            Self::Gray(channel) => channel.fmt(f),
            Self::Map(MapKind::Orm) => f.write_str("R ao, G roughness, B metallic"),
            Self::Map(kind) => f.write_str(kind.name()),
            Self::Rgba(channels) => {
                let [r, g, b, a] = channels;
                write!(f, "R {r}, G {g}, B {b}, A {a}")
            }
        }
    }
}

impl fmt::Display for Channel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Of(kind) => f.write_str(kind.name()),
            Self::OneLess(kind) => write!(f, "1 - {}", kind.name()),
            Self::Half(kind) => write!(f, "0.5 {}", kind.name()),
            Self::Always(value) => write!(f, "{value}"),
        }
    }
}

impl LayerRows<'_> {
    /// Writes the rows as the next rows of an image. The writer must have the content type of the layers.
    pub(crate) fn write<W: Write + Seek>(
        &self,
        writer: &mut RowWriter<W>,
    ) -> Result<(), ImageError> {
        match self {
            Self::Rgba(rows) => writer.write_packed_four(rows.view()),
            Self::ColorAlpha(rows) => writer.write_color_alpha(rows.view()),
            Self::Map(rows) => rows.write(writer),
        }
    }

    /// Returns `range`, a minimum and a maximum, extended to include the finite values of these rows.
    pub(crate) fn range(&self, range: [f32; 2]) -> [f32; 2] {
        match self {
            Self::Map(rows) => rows.range(range),
            Self::ColorAlpha(rows) => widened(range, rows.pixels().iter().flat_map(four)),
            Self::Rgba(rows) => widened(range, rows.pixels().iter().copied().flatten()),
        }
    }

    /// Returns the number of pixels with a value below 0 or above 1, which integer formats clip.
    pub(crate) fn n_clipped(&self) -> u64 {
        match self {
            Self::Map(rows) => match rows.as_ref() {
                MapRows::Gray(rows) => n_clipped(rows, |number| [*number]),
                MapRows::Color(rows) => n_clipped(rows, |color| color.to_array()),
                // The components of unit vectors are in range.
                MapRows::Normal(_) => 0,
                MapRows::Packed(rows) => n_clipped(rows, |parts| *parts),
            },
            Self::ColorAlpha(rows) => n_clipped(rows, four),
            Self::Rgba(rows) => n_clipped(rows, |parts| *parts),
        }
    }

    /// Returns rows that contain these rows twice, side by side.
    pub(crate) fn beside_themselves(&self) -> Result<LayerRows<'static>> {
        Self::side_by_side(&[self, self])
    }

    /// Joins rows of the same content type and height from left to right. There must be at least one element in
    /// `parts`.
    pub(crate) fn side_by_side(parts: &[&LayerRows<'_>]) -> Result<LayerRows<'static>> {
        /// Joins the rasters of all elements, which must be of the given variant.
        macro_rules! joined {
            ($variant:path) => {
                beside(parts.iter().filter_map(|part| match part.map()? {
                    $variant(rows) => Some(rows),
                    _ => None,
                }))
            };
        }
        let rows = match parts[0] {
            LayerRows::Rgba(_) => {
                let rows = parts.iter().filter_map(|part| match part {
                    LayerRows::Rgba(rows) => Some(rows),
                    _ => None,
                });
                return Ok(LayerRows::Rgba(beside(rows)?));
            }
            LayerRows::ColorAlpha(_) => {
                let rows = parts.iter().filter_map(|part| match part {
                    LayerRows::ColorAlpha(rows) => Some(rows),
                    _ => None,
                });
                return Ok(LayerRows::ColorAlpha(beside(rows)?));
            }
            LayerRows::Map(rows) => match rows.as_ref() {
                MapRows::Gray(_) => MapRows::Gray(joined!(MapRows::Gray)?),
                MapRows::Color(_) => MapRows::Color(joined!(MapRows::Color)?),
                MapRows::Normal(_) => MapRows::Normal(joined!(MapRows::Normal)?),
                MapRows::Packed(_) => MapRows::Packed(joined!(MapRows::Packed)?),
            },
        };
        Ok(LayerRows::Map(Cow::Owned(rows)))
    }

    /// Returns the rows of a single map.
    fn map(&self) -> Option<&MapRows> {
        match self {
            Self::Map(rows) => Some(rows.as_ref()),
            _ => None,
        }
    }
}

/// Joins rasters of the same height from left to right.
fn beside<'a, T: Copy + 'a>(rasters: impl Iterator<Item = &'a Raster<T>>) -> Result<Raster<T>> {
    let rasters: Vec<_> = rasters.collect();
    let width = rasters.iter().map(|raster| raster.size()[0]).sum();
    let height = rasters.first().map_or(0, |raster| raster.size()[1]);
    let mut pixels = Vec::with_capacity(width as usize * height as usize);
    for y in 0..height {
        for raster in &rasters {
            pixels.extend_from_slice(raster.row(y));
        }
    }
    Ok(Raster::from_vec([width, height], pixels)?)
}

/// Returns the channels of a color with alpha.
fn four(pixel: &LinearRgba) -> [f32; 4] {
    let [r, g, b] = pixel.color.to_array();
    [r, g, b, pixel.alpha]
}

/// Returns `range`, a minimum and a maximum, extended to include the finite values of `numbers`.
fn widened(range: [f32; 2], numbers: impl Iterator<Item = f32>) -> [f32; 2] {
    let numbers = numbers.filter(|number| number.is_finite());
    numbers.fold(range, |[min, max], number| {
        [min.min(number), max.max(number)]
    })
}

/// Returns the rows of a map in a band.
fn map_of(kind: MapKind, band: &Band) -> Result<&MapRows> {
    let found = band.maps.iter().find(|(other, _)| *other == kind);
    let (_, rows) = found.ok_or_else(|| anyhow!("the map {} was not baked", kind.name()))?;
    Ok(rows)
}

/// Returns the rows of a map in a band, which must have a single channel.
fn numbers_of(kind: MapKind, band: &Band) -> Result<&Raster<f32>> {
    match map_of(kind, band)? {
        MapRows::Gray(rows) => Ok(rows),
        _ => Err(anyhow!("the map {} has several channels", kind.name())),
    }
}
