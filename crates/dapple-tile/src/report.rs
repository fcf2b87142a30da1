//! Seam reports, which measure how well a tile repeats.
//!
//! A report answers these questions, each with a number that can be checked visually:
//!
//! * Is the wrap visible? [`Seam`] compares the step across it with the steps inside the tile.
//! * Has the method lost detail or contrast? [`DetailKept`] compares the tile with its source, octave by octave.
//! * Has it lost detail in one band of the tile? [`lowest_local_detail`](SeamReport::lowest_local_detail) measures the
//!   softest band.
//! * Does the seam have content that the source lacks? [`DetailKept::strangeness`] measures it.
//!
//! [`SeamReport::faults`] is the verdict over all measures, and [`SeamReports`] is the verdict over all channels of an
//! image.
//!
//! The measures are our own, and each is defined at its field. One of them needs care: a spline tile changes more
//! across some pixel boundaries than across others. A wrap that is like the other boundaries of the spline lattice has
//! a ratio of 1.19 relative to all boundaries. [`SeamOptions::lattice`] selects the boundaries to compare with.
//!
//! Sums are in `f64` and in a fixed order, so a report is the same on every machine. None of its numbers is NaN or
//! infinite: a quotient is 1 if both of its parts are zero, and is at most [`MOST`](SeamReport::MOST).

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

/// Options for a report: the axes to measure, and the boundaries to compare the wrap with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct SeamOptions {
    /// Axes along which the tile repeats, x first. Only these are measured. The default is both.
    pub axes: [bool; 2],
    /// Distance in pixels, along each axis, between the boundaries that are comparable with the wrap. It must divide
    /// the side. The default is 1, which selects every boundary.
    ///
    /// A tile that is generated on a lattice differs more across some boundaries than across others. Use `2^levels` for
    /// a spline tile, and the number of pixels per cell for cellular noise.
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
/// `Display` formats it as a table of at most 80 columns.
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
    /// Number of columns and rows of the tile.
    pub size: [u32; 2],
    /// Options of the measurement.
    pub options: SeamOptions,
    /// Steps across the wrap, for means over 1, 2, 4 and 8 pixels.
    pub seams: [Seam; 4],
    /// Detail of the tile's softest band as a fraction of the detail of the whole tile, from 0 to 1.
    ///
    /// Detail is the difference of the image from the mean of 3 × 3 pixels, with weights 1 2 1 along each axis. A band
    /// is 8 columns or 8 rows wide (all of them, if there are fewer), and extends from side to side. Along axes that
    /// repeat, it may cross the wrap. The number is the root mean square of the detail in the band with the least
    /// detail, divided by that of the whole tile. It is about 0.7 for photographs, less where they vary, and 0 if one
    /// band is flat and another is not. It is 1 for a tile that is flat everywhere. Up to rounding, it is also 1 for a
    /// tile of at most 8 columns and 8 rows, which is a single band.
    pub lowest_local_detail: f64,
    /// Comparison of the tile with its source; `None` without a source.
    pub kept: Option<DetailKept>,
}

/// The contrast and detail of its source that a tile has retained. The two images may differ in size.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct DetailKept {
    /// Number of columns and rows of the source.
    pub source_size: [u32; 2],
    /// Power of the tile in each octave, as a multiple of the power of the source, finest octave first.
    ///
    /// The first octave has the frequencies above ¼ up to ½ cycles per pixel along x or y, whichever is higher. This is
    /// the detail that an image of half the size cannot show. The next octave has the frequencies above ⅛ up to ¼, and
    /// so on. The last octave is the last one that begins at 4 cycles per side or more, in the smaller of the two
    /// images. Below 16 pixels there is no octave. Powers are per pixel, under a Hann window, so the wrap of neither
    /// image affects them.
    pub octaves: Vec<f64>,
    /// Standard deviation of the tile as a multiple of the source's standard deviation.
    pub contrast: f64,
    /// [`SeamReport::lowest_local_detail`] of the source, with mirrored borders.
    pub source_lowest_local_detail: f64,
    /// Strangeness: how much the tile near its seams differs from the source.
    ///
    /// Squares of 8 × 8 pixels of the reduced images across and next to the wrap are compared with all squares of the source. The strangeness
    /// is their mean distance to the nearest square of the source, divided by the mean distance of the source's own
    /// squares to the nearest other square in it, copies excepted. The largest value of all zones is used. It is about 1
    /// where a seam was moved and not repaired, more for stains and double exposures of images with clear shapes, and
    /// less for copied parts.
    ///
    /// Images are reduced by the smallest whole number that leaves at most 65,536 pixels of the source. `None` if a side
    /// of a reduced image is below 24 pixels, or the source is flat.
    pub strangeness: Option<f64>,
    /// Strangeness of both images at half of that size, where a square covers 16 × 16 pixels of the reduced images.
    ///
    /// Elements that end at a seam, such as courses of a wall, are detected at this size. `None` if a side of a reduced
    /// image is below 48 pixels, or the source is flat.
    pub coarse_strangeness: Option<f64>,
    /// Share of the samples that the method clipped, from 0 to 1.
    ///
    /// A sample counts as clipped if it is outside of 0 to 1 by more than half an 8-bit code. At either end, the share
    /// is limited to the surplus of the tile's samples at or beyond that end over the source's. Samples that are
    /// exactly 0 or 1, as in a tile read from a file, do not count, since their original values are unknown. The share
    /// is 0 for a source that is outside of 0 to 1 itself. For any other source, the tile is clamped to 0 and 1 before
    /// its seams are measured, as in an image file.
    pub clipped: f64,
    /// Whether the two sides of the wrap are mirror images along an axis that repeats, while the source's sides are
    /// not.
    pub is_mirrored: bool,
}

impl SeamReport {
    /// Maximum ratio in a report. Larger and infinite ratios are replaced by it.
    pub const MOST: f64 = 1e9;

    /// Measures how well a tile repeats.
    ///
    /// # Errors
    ///
    /// [`NotFinite`](TileErrorKind::NotFinite) if a pixel is NaN or infinite, [`Count`](TileErrorKind::Count) if no
    /// axis repeats, [`Range`](TileErrorKind::Range) if the lattice does not divide the side of an axis that repeats.
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

    /// Measures how well a tile repeats, and how much contrast and detail of its source image it retains.
    ///
    /// # Errors
    ///
    /// Same as [`of`](Self::of), and [`NotFinite`](TileErrorKind::NotFinite) if a pixel of the source is NaN or
    /// infinite.
    pub fn beside(
        source: &Raster<f32>,
        tile: &Raster<f32>,
        options: &SeamOptions,
    ) -> Result<Self, TileError> {
        check_finite(source)?;
        check_finite(tile)?;
        // Count samples beyond 0 and 1, before they are clamped.
        let [source_ends, tile_ends] =
            [source, tile].map(|image| Ends::of(image.pixels().iter().copied(), PLAIN_SLOPES));
        // Clamp the tile to the range of an image file if the source is in that range.
        let range = source.statistics();
        let is_within = range.min >= 0.0 && range.max <= 1.0;
        let shown = is_within.then(|| tile.map(|value| value.clamp(0.0, 1.0)));
        let report = Self::of(shown.as_ref().unwrap_or(tile), options)?;
        // Measure strangeness in squares of 8 × 8 and of 16 × 16 pixels, which are larger for large sources.
        let finest = strange::finest_scale(source.size());
        let strangeness = |scale| {
            strange::strangeness(source, shown.as_ref().unwrap_or(tile), options.axes, scale)
        };
        let (fine, coarse) = (strangeness(finest)?, strangeness(2 * finest)?);
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
                // Symmetry that the source has itself is not a fault of the method.
                is_mirrored: mirrored::is_mirrored(tile, options.axes)?
                    && !mirrored::is_mirrored(source, options.axes)?,
            }),
            ..report
        })
    }

    /// Converts the report to JSON.
    ///
    /// # Errors
    ///
    /// Never fails. The error type is the one of `serde_json`.
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

    /// Returns the wrapping beyond the tile's borders: periodic along axes that repeat, mirrored along the others.
    fn wrap(&self) -> [Wrap; 2] {
        self.axes
            .map(|repeats| if repeats { Wrap::Repeat } else { Wrap::Mirror })
    }
}

/// Returns the quotient `part / whole` of two numbers that are at least zero. It is 1 if both are zero, and at most
/// [`SeamReport::MOST`].
fn quotient(part: f64, whole: f64) -> f64 {
    if part == whole {
        1.0
    } else {
        // Equal parts are handled above, so 0 / 0 does not occur.
        (part / whole).min(SeamReport::MOST)
    }
}

#[cfg(test)]
mod tests;
