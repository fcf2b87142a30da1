//! Assigns maps to the channels of an image, which has one map or several packed ones.

use crate::encode::Format;
use crate::encode::n_clipped;
use anyhow::{Result, anyhow};
use dapple::image::{Content, ImageError, RowWriter};
use dapple::raster::Raster;
use dapple::recipe::{Band, MapKind, MapRows};
use dapple::tile::repeat;
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
    /// A constant number.
    Always(f32),
}

/// Consecutive rows of an image.
pub(crate) enum LayerRows<'a> {
    Map(Cow<'a, MapRows>),
    Rgba(Raster<[f32; 4]>),
}

impl Layers {
    /// Returns the maps that the channels need.
    pub(crate) fn kinds(&self) -> Vec<MapKind> {
        match self {
            Self::Map(kind) => vec![*kind],
            Self::Rgba(channels) => channels.iter().filter_map(Channel::kind).collect(),
        }
    }

    /// Returns the content type of the image, which determines its encoding.
    pub(crate) fn content(&self) -> Content {
        match self {
            Self::Map(kind) => kind.content(),
            Self::Rgba(_) => Content::PackedFour,
        }
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
            Self::Of(kind) | Self::OneLess(kind) => Some(*kind),
            Self::Always(_) => None,
        }
    }

    /// Returns the channel's value for `number`, a number of its map; `None` for a constant channel.
    fn value(self, number: Option<f32>) -> f32 {
        match self {
            Self::Of(_) => number.unwrap_or_default(),
            Self::OneLess(_) => 1.0 - number.unwrap_or_default(),
            Self::Always(value) => value,
        }
    }
}

/// Describes the channels for help texts: `albedo in sRGB`, or `R metallic, G ao, B 1, A 1 - roughness`.
impl fmt::Display for Layers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Map(MapKind::Albedo) => f.write_str("albedo in sRGB"),
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
            Self::Map(rows) => rows.write(writer),
        }
    }

    /// Extends `range`, a minimum and a maximum, to include the finite numbers of these rows.
    pub(crate) fn range(&self, range: [f32; 2]) -> [f32; 2] {
        match self {
            Self::Map(rows) => rows.range(range),
            Self::Rgba(rows) => {
                let numbers = rows
                    .pixels()
                    .iter()
                    .flatten()
                    .filter(|number| number.is_finite());
                numbers.fold(range, |[min, max], &number| {
                    [min.min(number), max.max(number)]
                })
            }
        }
    }

    /// Counts the pixels that have a number below 0 or above 1, which integer formats clip.
    pub(crate) fn n_clipped(&self) -> u64 {
        match self {
            Self::Map(rows) => match rows.as_ref() {
                MapRows::Gray(rows) => n_clipped(rows, |number| [*number]),
                MapRows::Color(rows) => n_clipped(rows, |color| color.to_array()),
                // The components of unit vectors are in range.
                MapRows::Normal(_) => 0,
                MapRows::Packed(rows) => n_clipped(rows, |parts| *parts),
            },
            Self::Rgba(rows) => n_clipped(rows, |parts| *parts),
        }
    }

    /// Returns the rows twice, side by side.
    pub(crate) fn beside_themselves(&self) -> Result<LayerRows<'static>> {
        fn twice<T: Copy + Send + Sync>(raster: &Raster<T>) -> Result<Raster<T>> {
            let [width, height] = raster.size();
            Ok(repeat(raster, [width.saturating_mul(2), height])?)
        }
        let rows = match self {
            Self::Rgba(rows) => return Ok(LayerRows::Rgba(twice(rows)?)),
            Self::Map(rows) => match rows.as_ref() {
                MapRows::Gray(rows) => MapRows::Gray(twice(rows)?),
                MapRows::Color(rows) => MapRows::Color(twice(rows)?),
                MapRows::Normal(rows) => MapRows::Normal(twice(rows)?),
                MapRows::Packed(rows) => MapRows::Packed(twice(rows)?),
            },
        };
        Ok(LayerRows::Map(Cow::Owned(rows)))
    }
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
