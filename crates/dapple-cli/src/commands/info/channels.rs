//! Computes statistics of an image's channels, as stored in its file.

use crate::input::Content;
use anyhow::{Result, bail};
use dapple::color::Code;
use dapple::image::{ColorSpace, Image};
use dapple::raster::Raster;
use serde::Serialize;
use serde_json::{Value, json};
use std::fmt;

/// Number of bins of a histogram.
const BINS: u32 = 24;
/// Characters of a histogram's bars, from an empty bin to the fullest one.
const BARS: [char; 9] = [' ', '▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];

/// Minimum width of the name column, in characters.
const NAME_MIN: usize = 9;

/// A channel of an image, with its name.
pub(super) struct Channel {
    pub(super) name: String,
    pub(super) values: Raster<f32>,
}

impl Channel {
    /// Returns the number of pixels that are NaN or infinite.
    pub(super) fn n_not_finite(&self) -> usize {
        self.values.statistics().n_not_finite
    }

    /// Converts the statistics to JSON. NaN and infinite numbers become null.
    pub(super) fn to_json(&self) -> Value {
        let statistics = self.values.statistics();
        json!({
            "name": self.name, "min": statistics.min, "max": statistics.max, "mean": statistics.mean,
            "deviation": statistics.deviation, "nan": self.n_nan(),
            "infinite": statistics.n_not_finite - self.n_nan(), "histogram": self.histogram(),
        })
    }

    fn n_nan(&self) -> usize {
        self.values
            .pixels()
            .iter()
            .filter(|value| value.is_nan())
            .count()
    }

    /// Returns the number of pixels in each bin of the histogram, which spans the minimum to the maximum.
    fn histogram(&self) -> Vec<usize> {
        let statistics = self.values.statistics();
        let finite = self.values.pixels().iter().copied();
        let finite: Vec<_> = finite.filter(|value| value.is_finite()).collect();
        let length = u32::try_from(finite.len()).unwrap_or(u32::MAX);
        // Without a finite pixel, no raster can be made, and all bins are 0.
        Raster::from_vec([length, 1], finite).map_or_else(
            |_| vec![0; BINS as usize],
            |values| values.histogram(statistics.min, statistics.max, BINS),
        )
    }

    /// Formats the histogram as a line of bars.
    fn bars(&self) -> String {
        let counts = self.histogram();
        let most = counts.iter().copied().max().unwrap_or(0).max(1);
        let bar = |&count: &usize| {
            // Round up, so that a count above 0 has a visible bar.
            let height = (count * (BARS.len() - 1)).div_ceil(most);
            BARS[height]
        };
        counts.iter().map(bar).collect()
    }

    /// Formats the channel as a line of the table. `width` is the width of the name column, in characters.
    fn line(&self, width: usize) -> String {
        let statistics = self.values.statistics();
        let [min, max] = [statistics.min, statistics.max].map(f64::from);
        let numbers = [min, max, statistics.mean, statistics.deviation].map(number);
        let mut line = format!("\n  {:<width$}", self.name);
        for number in numbers {
            line += &format!(" {number:>11}");
        }
        line += &format!("  |{}|", self.bars());
        let n_nan = self.n_nan();
        for (count, what) in [
            (n_nan, "NaN"),
            (statistics.n_not_finite - n_nan, "infinite"),
        ] {
            if count > 0 {
                line += &format!("  {count} {what}");
            }
        }
        line
    }
}

/// Returns the channels of an image. Codes are scaled to the range 0 to 1, without color space conversion.
///
/// # Errors
///
/// If an image of neither codes nor floating-point planes cannot be converted to colors.
pub(super) fn channels(content: &Content) -> Result<Vec<Channel>> {
    Ok(match content {
        Content::Raw(codes) => named(vec![codes.map(|code| code.to_unit())]),
        Content::Array(rasters) => named(rasters.clone()),
        Content::Image(Image::Codes(_, png)) => named(png.pixels.planes()),
        Content::Image(Image::Planes(_, exr)) => {
            let channel = |plane: &dapple::image::ExrPlane| Channel {
                name: plane.name.clone(),
                values: plane.values.clone(),
            };
            exr.planes.iter().map(channel).collect()
        }
        Content::Image(other) => bail!("{} images have no channels", other.format()),
    })
}

/// Names channels by their number, from gray alone to red, green, blue and alpha.
fn named(rasters: Vec<Raster<f32>>) -> Vec<Channel> {
    let names: &[&str] = match rasters.len() {
        1 => &["gray"],
        2 => &["gray", "alpha"],
        3 => &["red", "green", "blue"],
        _ => &["red", "green", "blue", "alpha"],
    };
    let channel = |(name, values): (&&str, Raster<f32>)| Channel {
        name: (*name).to_owned(),
        values,
    };
    names.iter().zip(rasters).map(channel).collect()
}

/// Describes the format of an image as text.
pub(super) fn format(content: &Content) -> String {
    let image = match content {
        Content::Raw(_) => return "raw heights of 16 bits".to_owned(),
        Content::Array(_) => return "NumPy array".to_owned(),
        Content::Image(image) => image,
    };
    let (name, bits) = (image.format(), image.bits());
    match image {
        Image::Codes(_, png) if png.space != ColorSpace::default() => {
            format!("{name}, {bits} bits per channel, {}", png.space)
        }
        Image::Planes(_, exr) => {
            let mut text = format!("{name}, read as 32-bit floating point");
            if exr.planes.iter().any(|plane| plane.name.contains('.')) {
                text += &format!(", layers {}", exr.layers().join(", "));
            }
            if let Some([r, g, b, white]) = exr.chromaticities {
                text += &format!(", chromaticities {r:?}, {g:?}, {b:?}, white {white:?}");
            }
            text
        }
        _ => format!("{name}, {bits} bits per channel"),
    }
}

/// How transparent an image is, as fractions of its pixels.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(super) struct Transparency {
    /// The fraction of pixels with alpha 0 or less.
    fully: f64,
    /// The fraction of pixels with an alpha between 0 and 1.
    partly: f64,
}

impl fmt::Display for Transparency {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.fully == 0.0 && self.partly == 0.0 {
            return f.write_str("alpha: opaque everywhere");
        }
        let [fully, partly] = [self.fully, self.partly].map(|part| 100.0 * part);
        write!(
            f,
            "alpha: {fully:.1} % of the pixels are transparent, {partly:.1} % partly so"
        )
    }
}

/// Returns the transparency of an image; `None` without an alpha channel.
pub(super) fn transparency(channels: &[Channel]) -> Option<Transparency> {
    let alpha = channels
        .iter()
        .find(|channel| ["alpha", "A"].contains(&channel.name.as_str()))?;
    let alphas = alpha.values.pixels();
    let part = |is_counted: fn(&&f32) -> bool| {
        alphas.iter().filter(is_counted).count() as f64 / alphas.len() as f64
    };
    Some(Transparency {
        fully: part(|alpha| **alpha <= 0.0),
        partly: part(|alpha| **alpha > 0.0 && **alpha < 1.0),
    })
}

/// Formats a table of the channels, with a header. Each line begins with a line feed.
pub(super) fn table(channels: &[Channel]) -> String {
    let names = channels.iter().map(|channel| channel.name.chars().count());
    let width = names.max().unwrap_or(0).max(NAME_MIN);
    let mut table = format!("\n  {:<width$}", "");
    for heading in ["min", "max", "mean", "deviation"] {
        table += &format!(" {heading:>11}");
    }
    table += "  histogram from min to max";
    for channel in channels {
        table += &channel.line(width);
    }
    table
}

/// Formats a number in at most 11 characters: with four decimals if its magnitude is from 0.001 to 10,000, otherwise in
/// exponential form.
fn number(number: f64) -> String {
    let size = number.abs();
    if size != 0.0 && size.is_finite() && !(1e-3..1e4).contains(&size) {
        format!("{number:.4e}")
    } else {
        format!("{number:.4}")
    }
}

#[cfg(test)]
mod tests {
    use super::{BARS, BINS, Channel, Transparency, number, table, transparency};
    use dapple::raster::Raster;

    fn channel(values: Vec<f32>) -> Channel {
        let size = [values.len() as u32, 1];
        Channel {
            name: "R".to_owned(),
            values: Raster::from_vec(size, values).unwrap(),
        }
    }

    #[test]
    fn histograms_count_what_is_finite() {
        let channel = channel(vec![0.0, 0.5, 1.0, f32::NAN, f32::INFINITY]);
        assert_eq!(channel.histogram().iter().sum::<usize>(), 3);
        assert_eq!((channel.n_nan(), channel.n_not_finite()), (1, 2));
        let bars = channel.bars();
        assert_eq!(bars.chars().count(), BINS as usize, "{bars:?}");
        assert_eq!(
            bars.chars().filter(|&bar| bar == BARS[8]).count(),
            3,
            "{bars:?}"
        );
    }

    #[test]
    fn transparent_pixels_are_counted_where_there_is_alpha() {
        let alpha = Channel {
            name: "alpha".to_owned(),
            ..channel(vec![0.0, 0.0, 0.0, 0.5, 1.0])
        };
        let red = channel(vec![0.0; 5]);
        assert_eq!(transparency(&[red]), None);
        let found = transparency(&[alpha]).unwrap();
        let (fully, partly) = (0.6, 0.2);
        assert_eq!(found, Transparency { fully, partly });
        assert_eq!(
            found.to_string(),
            "alpha: 60.0 % of the pixels are transparent, 20.0 % partly so"
        );
    }

    #[test]
    fn numbers_neither_collide_nor_vanish() {
        for (of, expected) in [
            (0.0, "0.0000"),
            (0.5, "0.5000"),
            (-0.001, "-0.0010"),
            (1e-5, "1.0000e-5"),
            (9999.0, "9999.0000"),
            (65504.0, "6.5504e4"),
            (f64::from(f32::MIN), "-3.4028e38"),
            (-f64::from(f32::MIN_POSITIVE), "-1.1755e-38"),
            (f64::NAN, "NaN"),
        ] {
            assert_eq!(number(of), expected);
            assert!(number(of).len() <= 11, "{of}");
        }
        let name = "ViewLayer.Combined.R".to_owned();
        let wide = Channel {
            name,
            ..channel(vec![0.0, 65504.0])
        };
        let text = table(&[wide]);
        let line = text.lines().last().unwrap();
        let words: Vec<_> = line.split_whitespace().take(5).collect();
        assert_eq!(
            words,
            [
                "ViewLayer.Combined.R",
                "0.0000",
                "6.5504e4",
                "3.2752e4",
                "3.2752e4"
            ]
        );
    }

    #[test]
    fn nothing_finite_makes_an_empty_histogram() {
        let channel = channel(vec![f32::NAN; 4]);
        assert_eq!(channel.histogram(), [0; BINS as usize]);
        assert!(channel.to_json()["mean"].is_null(), "a mean of nothing");
    }
}
