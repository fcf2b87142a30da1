//! Seam reports: how well a tile repeats, in numbers.
//!
//! A report answers questions, each with a number that an eye may check. Is the wrap visible? [`Seam`] compares the
//! step across it with the steps inside of the tile. Has the method lost detail? [`DetailKept`] compares the tile with
//! its source, octave by octave, and in contrast. Has it lost detail in one place, where a band of the tile has gone
//! soft? [`lowest_local_detail`](SeamReport::lowest_local_detail) measures the softest. Is there content at the seam
//! that the source lacks? [`DetailKept::strangeness`] measures it. [`SeamReport::faults`] is the verdict over all of
//! them, and [`SeamReports`] that over all channels of an image.
//!
//! The measures are ours, and each is defined where its field is. One of them needs care: a spline tile changes more
//! across some pixel boundaries than across others, and a wrap that cannot be told from the boundaries of its own kind
//! scores 1.19 beside all of them. [`SeamOptions::lattice`] selects the boundaries of its kind.
//!
//! Sums are in `f64` and in a fixed order, so that a report is the same on every machine. No number of it is NaN or
//! infinite: a quotient is 1 where both of its parts are zero, and at most [`MOST`](SeamReport::MOST).

mod channels;
mod clipped;
mod local;
mod mirrored;
mod octaves;
mod seam;
mod strange;
mod table;
mod verdict;
mod visible;

pub use channels::{ChannelReport, SeamReports};
pub use seam::{Seam, SeamRatio};
pub use verdict::Fault;

use crate::map::check_finite;
use crate::{TileError, TileErrorKind};
use clipped::{Ends, PLAIN_SLOPES};
use dapple_raster::{Raster, Wrap};

/// Options of a report: the measured seams, and the boundaries they are compared with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct SeamOptions {
    /// The axes along which the tile repeats, x first; only these are measured. By default both.
    pub axes: [bool; 2],
    /// The distance in pixels, along each axis, of the boundaries that are like the wrap: divisors of the sides. By
    /// default 1, which is every boundary.
    ///
    /// A tile that is made on a lattice differs more across some boundaries than across others. Give `2^levels` for a tile of
    /// splines, and the pixels per cell for cellular noise.
    pub lattice: [u32; 2],
}

impl Default for SeamOptions {
    fn default() -> Self {
        Self {
            axes: [true; 2],
            lattice: [1; 2],
        }
    }
}

/// Measurements of how well a tile repeats.
///
/// `Display` writes it as a table of at most 80 columns.
///
/// # Examples
///
/// ```
/// use dapple_tile::{SeamOptions, SeamReport, raster::Raster};
///
/// let ramp = Raster::from_fn([64, 64], |x, _| x as f32)?;
/// let report = SeamReport::of(&ramp, &SeamOptions { axes: [true, false], ..Default::default() })?;
/// let one_pixel = report.seams[0].x.expect("64 pixels are enough");
/// assert_eq!(one_pixel.ratio, 63.0);
/// assert!(!report.passes());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SeamReport {
    /// Columns and rows of the tile.
    pub size: [u32; 2],
    /// The options of the measurement.
    pub options: SeamOptions,
    /// The steps across the wrap, for means of 1, 2, 4 and 8 pixels.
    pub seams: [Seam; 4],
    /// The detail of the softest band of the tile as a fraction of that of the whole tile, from 0 to 1.
    ///
    /// Detail is the difference of the image from the mean of 3 × 3 pixels, with weights 1 2 1 along each axis. A band
    /// is 8 columns or 8 rows wide (all of them, if there are fewer) and reaches from side to side; along axes that
    /// repeat it may lie across the wrap. The number is the root mean square of the detail in the band that has the
    /// least, divided by that of the whole tile. It is about 0.7 for photographs, less where they vary, and 0 if a band
    /// is flat and another is not. It is 1 for a tile that is flat everywhere and, within rounding, for one of at most
    /// 8 columns and 8 rows, which is a single band.
    pub lowest_local_detail: f64,
    /// The comparison of the tile with its source, if one was passed.
    pub kept: Option<DetailKept>,
}

/// The contrast and detail that a tile has kept of its source. Their sizes may differ.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct DetailKept {
    /// Columns and rows of the source.
    pub source_size: [u32; 2],
    /// The power of the tile in each octave as a multiple of that of the source, finest first.
    ///
    /// The first octave holds the frequencies above ¼ up to ½ cycles per pixel along x or y, whichever is higher: the
    /// detail that an image of half the size cannot show. The next holds those above ⅛ up to ¼, and so on for as long
    /// as an octave begins at 4 cycles per side or more, in the smaller of the two images; below 16 pixels there is
    /// none. Powers are per pixel, under a Hann window, so that the wrap of neither image matters.
    pub octaves: Vec<f64>,
    /// The standard deviation of the tile as a multiple of that of the source.
    pub contrast: f64,
    /// [`SeamReport::lowest_local_detail`] of the source, whose borders are mirrored.
    pub source_lowest_local_detail: f64,
    /// The strangeness: how unlike the source the tile is near its seams.
    ///
    /// The mean distance of squares of 8 × 8 pixels, across and beside the wrap, from the nearest in the source, as a
    /// multiple of the mean distance of squares of the source from the nearest elsewhere in it; the largest of all
    /// zones. It is about 1 where a seam was moved and not mended, more for stains and double exposures of pictures
    /// with clear shapes, and less for copied parts. `None` for images of less than 24 pixels along a side, and for a
    /// flat source.
    pub strangeness: Option<f64>,
    /// The strangeness of both images at half of their size, where a square covers 16 × 16 pixels.
    ///
    /// Pieces that end at a seam, as the courses of a wall, are found at this size. `None` for images of less than 48
    /// pixels along a side, and for a flat source.
    pub coarse_strangeness: Option<f64>,
    /// The share of the samples that the method clipped, from 0 to 1.
    ///
    /// These are samples that lie past 0 or 1 by more than half a code of 8 bits; at either end at most as many as the
    /// tile has there beyond the share of the source. Samples that are exactly 0 or 1, as in a tile that was read from a
    /// file, were not clipped by the method as far as can be known. It is 0 for a source that exceeds 0 or 1 itself;
    /// any other tile is cut off at 0 and 1 before its seams are measured, as in an image file.
    pub clipped: f64,
    /// Whether both sides of the wrap are mirror images along an axis that repeats, and those of the source are not.
    pub is_mirrored: bool,
}

impl SeamReport {
    /// The largest ratio in a report: larger and infinite ratios are replaced by it.
    pub const MOST: f64 = 1e9;

    /// Measures how well a tile repeats.
    ///
    /// # Errors
    ///
    /// [`NotFinite`](TileErrorKind::NotFinite) for a pixel that is NaN or infinite, [`Count`](TileErrorKind::Count) if no
    /// axis repeats, [`Range`](TileErrorKind::Range) for a lattice that does not divide the side of an axis that does.
    pub fn of(tile: &Raster<f32>, options: &SeamOptions) -> Result<Self, TileError> {
        options.check(tile.size())?;
        check_finite(tile)?;
        Ok(Self {
            size: tile.size(),
            options: *options,
            seams: seam::seams(tile, options)?,
            lowest_local_detail: local::lowest_detail(tile, options.wrap()),
            kept: None,
        })
    }

    /// Measures how well a tile repeats, and how much it has kept of the image from which it was made.
    ///
    /// # Errors
    ///
    /// The errors of [`of`](Self::of), and [`NotFinite`](TileErrorKind::NotFinite) for pixels of the source.
    pub fn beside(
        source: &Raster<f32>,
        tile: &Raster<f32>,
        options: &SeamOptions,
    ) -> Result<Self, TileError> {
        check_finite(source)?;
        check_finite(tile)?;
        let [source_ends, tile_ends] =
            [source, tile].map(|image| Ends::of(image.pixels().iter().copied(), PLAIN_SLOPES));
        let range = source.statistics();
        let is_within = range.min >= 0.0 && range.max <= 1.0;
        let shown = is_within.then(|| tile.map(|value| value.clamp(0.0, 1.0)));
        let report = Self::of(shown.as_ref().unwrap_or(tile), options)?;
        let strangeness = |scale| {
            strange::strangeness(source, shown.as_ref().unwrap_or(tile), options.axes, scale)
        };
        let (fine, coarse) = (strangeness(1)?, strangeness(2)?);
        let [kept, all] = [tile, source].map(|image| image.statistics().deviation);
        Ok(Self {
            kept: Some(DetailKept {
                source_size: source.size(),
                octaves: octaves::kept(source, tile),
                contrast: quotient(kept, all),
                source_lowest_local_detail: local::lowest_detail(source, [Wrap::Mirror; 2]),
                strangeness: fine,
                coarse_strangeness: coarse,
                clipped: Ends::clipped(&source_ends, &tile_ends),
                is_mirrored: mirrored::is_mirrored(tile, options.axes)?
                    && !mirrored::is_mirrored(source, options.axes)?,
            }),
            ..report
        })
    }

    /// The report as JSON.
    ///
    /// # Errors
    ///
    /// None for any report; the type is that of `serde_json`.
    #[cfg(feature = "json")]
    pub fn to_json(&self) -> Result<String, serde_json::Error> {
        serde_json::to_string_pretty(self)
    }
}

impl SeamOptions {
    fn check(&self, size: [u32; 2]) -> Result<(), TileError> {
        if self.axes == [false; 2] {
            return Err(TileError::new(TileErrorKind::Count {
                what: "axes that repeat",
                count: 0,
                needed: "at least 1",
            }));
        }
        for axis in (0..2).filter(|&axis| self.axes[axis]) {
            let lattice = self.lattice[axis];
            TileError::check(
                size[axis].checked_rem(lattice) == Some(0),
                "lattice of the report",
                f64::from(lattice),
                "a divisor of the side",
            )?;
        }
        Ok(())
    }

    /// The wrapping past the borders of the tile: periodic along axes that repeat, mirrored along others.
    fn wrap(&self) -> [Wrap; 2] {
        self.axes
            .map(|repeats| if repeats { Wrap::Repeat } else { Wrap::Mirror })
    }
}

/// The quotient `part / whole` of two numbers that are not negative: 1 if both are zero, and at most
/// [`SeamReport::MOST`].
fn quotient(part: f64, whole: f64) -> f64 {
    if part == whole {
        1.0
    } else {
        (part / whole).min(SeamReport::MOST)
    }
}

#[cfg(test)]
mod tests;
