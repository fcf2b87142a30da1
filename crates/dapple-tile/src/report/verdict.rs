//! The verdict on a tile: its faults, derived from the measurements of its report.
//!
//! The limits were set on 2 × 2 copies of tiles that several methods made from photographs. Three judges had labeled
//! the copies first. The README states how far the verdict agrees with these judges on other photographs.

use super::{DetailKept, SeamReport};
use core::fmt;

/// Maximum of [`Seam::stands_out`](super::Seam::stands_out), in standard deviations.
const STANDS_OUT: f64 = 2.5;

/// Minimum detail of the softest band, as a fraction of the detail of the source's softest band.
const SOFTEST: f64 = 0.9;

/// Minimum power in the third octave, as a fraction of the source's. The mean of two images has half of it.
const THIRD_OCTAVE: f64 = 0.65;

/// Minimum contrast of a tile whose third octave is weak. The mean of two images loses both contrast and octave,
/// whereas a part of a pattern may lack only the octave.
const CONTRAST: f64 = 0.9;

/// Maximum [`strangeness`](DetailKept::strangeness) of a tile that passes.
const STRANGEST: f64 = 0.6;

/// Maximum [`coarse_strangeness`](DetailKept::coarse_strangeness) of a tile that passes.
const COARSE_STRANGEST: f64 = 0.9;

/// Maximum share of clipped samples of a tile that passes.
const CLIPPED: f64 = 0.04;

/// Minimum [`Seam::width`](super::Seam::width) at which a seam must have been measured, in pixels.
const LEAST_WIDTH: u32 = 4;

/// A fault of a tile.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Fault {
    /// The tile is too small to compare a seam with the inside.
    TooSmall,
    /// The step across the wrap is more visible than any boundary inside, by
    /// [`Seam::stands_out`](super::Seam::stands_out).
    Step {
        /// Width of the averaged pixel ranges, in pixels, at which the step is most visible.
        width: u32,
    },
    /// A band has lost its detail, typically in a crossfade.
    Soft,
    /// Contrast is lost at all scales, as in a blend of two images.
    Ghosts,
    /// Pixels at the seam are unlike any pixels of the source.
    Strange,
    /// Samples were clipped to 0 or 1.
    Clipped {
        /// Share of clipped samples, from 0 to 1.
        share: f64,
    },
    /// The two sides of the wrap are mirror images, while the source's sides are not.
    Mirrored,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooSmall => f.write_str("it is too small to be judged"),
            Self::Step { width } => write!(f, "the seam shows, most at {width} px"),
            Self::Soft => f.write_str("a band has lost its detail"),
            Self::Ghosts => f.write_str("contrast is lost, as in a double exposure"),
            Self::Strange => f.write_str("the seam is unlike anything in the source"),
            Self::Clipped { share } => {
                write!(f, "{:.1} % of the samples are clipped", 100.0 * share)
            }
            Self::Mirrored => f.write_str("the copies mirror each other"),
        }
    }
}

impl SeamReport {
    /// Returns the faults of the tile; empty if it [passes](Self::passes).
    ///
    /// Without a source, only steps are tested. A wrap that is less visible than the boundaries inside is not a fault.
    #[must_use]
    pub fn faults(&self) -> Vec<Fault> {
        let mut faults = Vec::new();
        let is_measured = |width| {
            self.seams
                .iter()
                .any(|seam| seam.width == width && seam.stands_out.is_some())
        };
        if !is_measured(LEAST_WIDTH) {
            faults.push(Fault::TooSmall);
        }
        let (width, stands_out) = self.most_visible();
        if stands_out > STANDS_OUT {
            faults.push(Fault::Step { width });
        }
        // With a source, compare the other measures with their limits.
        if let Some(kept) = &self.kept {
            let of_kept = kept.measures(self.lowest_local_detail);
            faults.extend(
                of_kept
                    .into_iter()
                    .filter(|(measure, _)| *measure > 1.0)
                    .map(|(_, fault)| fault),
            );
        }
        faults
    }

    /// Returns whether the tile has no [fault](Self::faults).
    #[must_use]
    pub fn passes(&self) -> bool {
        self.faults().is_empty()
    }

    /// Returns the worst measure of the tile, as a multiple of its limit. It is at most 1 for tiles that pass.
    ///
    /// It ranks tiles with the same source. It is [`MOST`](Self::MOST) for a tile that is too small to be judged.
    #[must_use]
    pub fn badness(&self) -> f64 {
        if self.faults().contains(&Fault::TooSmall) {
            return Self::MOST;
        }
        let of_kept = self
            .kept
            .as_ref()
            .map(|kept| kept.measures(self.lowest_local_detail));
        let measures = of_kept.into_iter().flatten().map(|(measure, _)| measure);
        measures
            .fold(self.most_visible().1 / STANDS_OUT, f64::max)
            .min(Self::MOST)
    }

    /// Returns the width at which the wrap stands out most, and the excess of its visibility there.
    fn most_visible(&self) -> (u32, f64) {
        let measured = self
            .seams
            .iter()
            .filter_map(|seam| Some((seam.width, seam.stands_out?)));
        measured.fold(
            (1, 0.0),
            |most, seam| if seam.1 > most.1 { seam } else { most },
        )
    }
}

impl DetailKept {
    /// Returns each measure as a multiple of its limit, with the fault that it indicates if it is above 1.
    fn measures(&self, lowest_local_detail: f64) -> [(f64, Fault); 5] {
        // Measure of a quantity with a lower limit.
        let over = |limit: f64, kept: f64| super::quotient(limit, kept);
        // Power of the third octave as a multiple of the source's; without a third octave, the variance.
        let power = self
            .octaves
            .get(2)
            .copied()
            .unwrap_or(self.contrast * self.contrast);
        let share = self.clipped;
        // Measure of a quantity with an upper limit.
        let strange = |of: Option<f64>, limit: f64| of.unwrap_or(0.0) / limit;
        let strangeness = strange(self.strangeness, STRANGEST)
            .max(strange(self.coarse_strangeness, COARSE_STRANGEST));
        [
            (
                over(
                    SOFTEST * self.source_lowest_local_detail,
                    lowest_local_detail,
                ),
                Fault::Soft,
            ),
            (
                over(THIRD_OCTAVE, power).min(over(CONTRAST, self.contrast)),
                Fault::Ghosts,
            ),
            (strangeness, Fault::Strange),
            (share / CLIPPED, Fault::Clipped { share }),
            (if self.is_mirrored { 2.0 } else { 0.0 }, Fault::Mirrored),
        ]
    }
}
