//! Reports for all channels of a map, with a common verdict.

use super::clipped::{Ends, SRGB_SLOPES};
use super::{SeamOptions, SeamReport};
use crate::{Map, TileError};
use core::fmt;
use dapple_color::LinearRgb;
use dapple_raster::Raster;

/// Seam reports for all channels of an image.
///
/// A seam in a single channel is a change of hue, and may be absent from the luminance. `Display` lists the faults of
/// each channel, and then the table of the worst channel.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SeamReports {
    /// The reports, one for each channel.
    channels: Vec<ChannelReport>,
}

/// The seam report for one channel.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ChannelReport {
    /// Name of the channel; empty if it is the only one.
    pub channel: String,
    /// The channel's report.
    pub report: SeamReport,
}

impl SeamReports {
    /// Measures how well an image repeats, given its channels with their names. An image without channels does not
    /// pass.
    ///
    /// # Errors
    ///
    /// Same as [`SeamReport::of`].
    pub fn of<'a>(
        channels: impl IntoIterator<Item = (&'a str, &'a Raster<f32>)>,
        options: &SeamOptions,
    ) -> Result<Self, TileError> {
        let reports = channels.into_iter().map(|(name, values)| {
            Ok(ChannelReport {
                channel: name.to_owned(),
                report: SeamReport::of(values, options)?,
            })
        });
        Ok(Self {
            channels: reports.collect::<Result<_, TileError>>()?,
        })
    }

    /// Measures how well a map repeats. Values are measured as they are, normals by x and y, and colors as displayed,
    /// in sRGB.
    ///
    /// # Errors
    ///
    /// Same as [`SeamReport::of`].
    pub fn of_map(tile: &Map, options: &SeamOptions) -> Result<Self, TileError> {
        let channels = channels(tile)?;
        Self::of(
            channels.iter().map(|(name, values)| (*name, values)),
            options,
        )
    }

    /// Measures how well a map repeats, and how much contrast and detail of its source (a map of the same kind) it
    /// retains.
    ///
    /// # Errors
    ///
    /// Same as [`SeamReport::beside`].
    pub fn beside(source: &Map, tile: &Map, options: &SeamOptions) -> Result<Self, TileError> {
        let pairs = channels(source)?.into_iter().zip(channels(tile)?);
        let reports = pairs.map(|((name, source), (_, tile))| {
            Ok(ChannelReport {
                channel: name.to_owned(),
                report: SeamReport::beside(&source, &tile, options)?,
            })
        });
        let mut reports = Self {
            channels: reports.collect::<Result<_, TileError>>()?,
        };
        if let (Map::Color(source), Map::Color(tile)) = (source, tile) {
            // Displayed colors are limited to 0 to 1, so clipping is measured in linear light.
            for ((of, source), tile) in reports
                .channels
                .iter_mut()
                .zip(color_ends(source))
                .zip(color_ends(tile))
            {
                if let Some(kept) = &mut of.report.kept {
                    kept.clipped = Ends::clipped(&source, &tile);
                }
            }
        }
        Ok(reports)
    }

    /// Returns the reports, one for each channel.
    #[must_use]
    pub fn channels(&self) -> &[ChannelReport] {
        &self.channels
    }

    /// Returns whether there is at least one channel, and all channels pass.
    #[must_use]
    pub fn passes(&self) -> bool {
        !self.channels.is_empty() && self.channels.iter().all(|of| of.report.passes())
    }

    /// Returns the largest [`badness`](SeamReport::badness) of all channels.
    #[must_use]
    pub fn badness(&self) -> f64 {
        self.worst()
            .map_or(SeamReport::MOST, |of| of.report.badness())
    }

    /// Returns the channel with the largest badness. If several are equal, returns the first.
    #[must_use]
    pub fn worst(&self) -> Option<&ChannelReport> {
        let worse =
            |a: &'_ ChannelReport, b: &'_ ChannelReport| b.report.badness() > a.report.badness();
        // Of equally bad channels, the first is the worst.
        self.channels
            .iter()
            .reduce(|worst, of| if worse(worst, of) { of } else { worst })
    }
}

impl fmt::Display for SeamReports {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Some(worst) = self.worst() else {
            return f.write_str("no channel");
        };
        if self.channels.len() > 1 {
            let [width, height] = worst.report.size;
            let verdict = if self.passes() {
                "passes"
            } else {
                "does not pass"
            };
            writeln!(f, "a tile of {width} × {height} pixels: {verdict}")?;
            for of in &self.channels {
                for fault in of.report.faults() {
                    writeln!(f, "  ({}: {fault})", of.channel)?;
                }
            }
            writeln!(
                f,
                "the worst of {} channels, {}:",
                self.channels.len(),
                worst.channel
            )?;
            return worst.report.write_table(f);
        }
        worst.report.fmt(f)
    }
}

/// Returns the channels of a map as displayed.
fn channels(map: &Map) -> Result<Vec<(&'static str, Raster<f32>)>, TileError> {
    Ok(match map {
        Map::Value(values) => vec![("", values.clone())],
        Map::Normal(normals) => vec![
            ("x", normals.map(|normal| normal.x)),
            ("y", normals.map(|normal| normal.y)),
        ],
        Map::Color(colors) => {
            // Check the pixels first, since integers cannot represent NaN.
            crate::map::check_planes(&crate::map::color_planes(colors))?;
            // Colors are measured as displayed, by their sRGB codes.
            let shown = colors.map(|color: &LinearRgb| color.to_srgb::<u16>());
            let channel =
                |index: usize| shown.map(|codes| f32::from(codes[index]) / f32::from(u16::MAX));
            vec![
                ("red", channel(0)),
                ("green", channel(1)),
                ("blue", channel(2)),
            ]
        }
    })
}

/// Counts the shares of the red, green and blue samples at the ends of the range.
fn color_ends(colors: &Raster<LinearRgb>) -> [Ends; 3] {
    let channels: [fn(&LinearRgb) -> f32; 3] = [|color| color.r, |color| color.g, |color| color.b];
    channels.map(|channel| Ends::of(colors.pixels().iter().map(channel), SRGB_SLOPES))
}

#[cfg(test)]
mod tests {
    use super::super::Fault;
    use super::{SeamOptions, SeamReports};
    use crate::Map;
    use crate::test_fields::fbm;
    use dapple_color::LinearRgb;
    use dapple_raster::Raster;

    fn colored(red: &Raster<f32>, blue: &Raster<f32>) -> Map {
        let color = red.zip_map(blue, |r, b| {
            LinearRgb::new(0.4 + 0.3 * r, 0.4, 0.4 + 0.3 * b)
        });
        Map::Color(color.unwrap())
    }

    #[test]
    fn a_seam_in_one_channel_fails_and_is_named() {
        let [even, torn] = [true, false].map(|repeats| fbm(1, [96; 2], repeats));
        let options = SeamOptions::default();
        let good = SeamReports::of_map(&colored(&even, &even), &options).unwrap();
        assert!(good.passes(), "{good}");
        let bad = SeamReports::of_map(&colored(&even, &torn), &options).unwrap();
        assert!(!bad.passes(), "{bad}");
        let failed: Vec<_> = bad
            .channels()
            .iter()
            .filter(|of| !of.report.passes())
            .map(|of| of.channel.as_str())
            .collect();
        assert_eq!(failed, ["blue"]);
        assert!(bad.to_string().contains("(blue: the seam shows"), "{bad}");
    }

    #[test]
    fn what_is_clipped_is_counted_and_fails() {
        let even = fbm(1, [96; 2], true);
        let pale = Map::Value(even.map(|value| 0.5 + 0.3 * value));
        let dark = Map::Value(even.map(|value| 0.1 + 0.3 * value));
        let report = SeamReports::beside(&pale, &dark, &SeamOptions::default()).unwrap();
        let faults = report.channels()[0].report.faults();
        let share = faults.iter().find_map(|fault| match fault {
            Fault::Clipped { share } => Some(*share),
            _ => None,
        });
        assert!(share.is_some_and(|share| share > 0.05), "{report}");
    }
}
