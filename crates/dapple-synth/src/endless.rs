//! Endless textures: any window of an unbounded texture, computed independently of all other windows.
//!
//! References: Sylvain Lefebvre and Hugues Hoppe, "Parallel Controllable Texture Synthesis", SIGGRAPH 2005, DOI
//! 10.1145/1186822.1073261, and, by the same authors, "Appearance-Space Texture Synthesis", SIGGRAPH 2006, DOI
//! 10.1145/1141911.1141921.
//!
//! Input: an exemplar, and [`EndlessOptions`] with the seed, number of levels and period. Output: for each pixel of a
//! window, its source pixel in the exemplar.
//!
//! Steps, from the coarsest level to the finest:
//!
//! - Upsampling: each pixel is split into four, whose sources are adjacent in the exemplar.
//! - Correction, repeated a few times: each pixel compares the source pixels that its neighbors predict, and the pixel
//!   most similar to each of these. It takes the one whose surroundings in the exemplar are most similar to its own in
//!   the texture. Features are compared, not colors: the principal components of windows ([`stage`]). A quarter of the
//!   pixels is corrected at a time, for example all pixels with even column and row, because they do not read each
//!   other.
//!
//! So a pixel depends on nearby pixels on each level, and ultimately on random pixels of the coarsest level, which are
//! hashes of their columns and rows. A window is computed with a margin on every level.
//!
//! Departures from the papers:
//!
//! - The coarsest level begins with random pixels of the exemplar instead of copies of it. An exception is an exemplar
//!   that wraps and repeats within itself, such as bricks: there random pixels would form courses that do not line up.
//!   Its coarsest level begins with copies, and each pixel is repeatedly replaced by its most similar pixel.
//! - There is no jitter on finer levels.
//! - For exemplars that are not regular, similar pixels have a penalty relative to predicted ones ([`COHERENCE`]).
//! - Levels are corrected three times, and the coarsest six times, instead of twice.
//! - The most similar pixel is found by searching a grid of the level. A pixel between grid pixels takes the result of
//!   its grid pixel, displaced by the same offset.
//! - Pixels near a cut edge are excluded if enough others remain ([`stage`]).
//! - Averages of texture features are not projected a second time.
//! - Parts of the exemplar that textures would use too often have higher costs ([`evenness`]).

pub(crate) mod evenness;
pub(crate) mod level;
mod window;

use crate::engine::{Progress, Wanted};
use crate::guides::Guides;
use crate::options::REGULAR;
use crate::{Edges, Exemplar, PlaneTexture, Symmetry, SynthError, SynthErrorKind};
use core::ops::ControlFlow;
use dapple_hash::Seed;
use evenness::REPETITION;
use level::AppearanceLevel;

/// Penalty on similar pixels relative to predicted ones, for exemplars that are not regular: squared distances are
/// multiplied by `1 + COHERENCE`. Continuing a piece of the exemplar preserves its detail.
///
/// Measured on photographs, with four textures from each: the distances of colors and patches from the exemplar
/// ([`Likeness`](crate::Likeness)) fall by half for grass, rock, sand and gravel, and by a tenth for leaves; they rise
/// by a seventh for a meadow and for wood. With a value of 2, leaves lose this gain. Weave, which is regular, is
/// already torn with a value of 1.
const COHERENCE: f32 = 1.0;

/// Maximum number of levels.
const MAX_LEVELS: u32 = 16;

/// Minimum number of pixels along the shorter side of the exemplar's coarsest level. Determines the default number of
/// levels.
const COARSEST: u32 = 4;

/// Maximum absolute value of the first column and row of a window.
const MAX_PLACE: i64 = 1 << 52;

/// Options for an [`Endless`] texture.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct EndlessOptions {
    /// Seed for the coarsest level; by default `Seed(0)`.
    pub seed: Seed,
    /// Number of levels, from 1 to 16. More levels preserve larger features of the exemplar. By default, as many levels
    /// as the exemplar's size allows: the coarsest one has from 4 to 7 pixels along the exemplar's shorter side.
    pub n_levels: Option<u32>,
    /// Period of the texture along columns and rows, in pixels. Each must be a multiple of 2 to the power of the number
    /// of levels; `None` means no period (default).
    pub period: [Option<u32>; 2],
}

/// An unbounded texture that looks like an exemplar. Any window of it can be computed.
///
/// Two windows have the same pixels where they overlap.
///
/// # Examples
///
/// ```
/// use core::ops::ControlFlow;
/// use dapple_raster::Raster;
/// use dapple_synth::{Edges, Endless, EndlessOptions, Exemplar};
///
/// let checker = Raster::from_fn([32, 32], |x, y| f32::from((x / 4 + y / 4) % 2 == 0))?;
/// let exemplar = Exemplar::from_planes(&[(&checker, 1.0)], Edges::Wrap)?;
/// let texture = Endless::new(&exemplar, &EndlessOptions::default())?;
/// let window = |first, size| texture.window(first, size, |_| ControlFlow::Continue(()));
/// let whole = window([0, 0], [48, 40])?;
/// let part = window([20, 10], [8, 5])?;
/// assert_eq!(part.sources().row(4)[7], whole.sources().row(14)[27]);
/// assert_eq!(whole.transfer(&checker)?.size(), [48, 40]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Endless {
    size: [u32; 2],
    edges: Edges,
    seed: Seed,
    period: [Option<u32>; 2],
    /// Levels of the exemplar, the finest first.
    stages: Vec<AppearanceLevel>,
    /// Usable pixels of the exemplar on the coarsest level, as row-major indices.
    coarsest: Vec<u32>,
    /// Whether the exemplar is a tile that repeats within itself.
    is_lattice: bool,
}

impl Endless {
    /// Prepares a texture. For small windows this dominates the total time: it takes about a microsecond per pixel of
    /// the exemplar and level. Trials that measure how often textures use each part of the exemplar add half a second
    /// on one core.
    ///
    /// The exemplar's [mask](Exemplar::with_mask) applies; its [guides](Exemplar::with_guides) are ignored.
    ///
    /// # Errors
    ///
    /// If the number of levels is not from 1 to 16, or leaves less than one pixel of the coarsest level along a side of
    /// the exemplar; if a period is not a multiple of 2 to the power of the number of levels; or if a mask allows no
    /// pixel.
    pub fn new(exemplar: &Exemplar, options: &EndlessOptions) -> Result<Self, SynthError> {
        Self::new_cancellable(exemplar, options, &|| false)
    }

    /// Prepares a texture like [`new`](Self::new), and stops when `is_cancelled` returns true. The callback is called
    /// from any thread, once every few milliseconds of work.
    ///
    /// # Errors
    ///
    /// Same as [`new`](Self::new), or [`SynthErrorKind::Cancelled`](crate::SynthErrorKind::Cancelled) if `is_cancelled`
    /// returns true.
    pub fn new_cancellable(
        exemplar: &Exemplar,
        options: &EndlessOptions,
        is_cancelled: &(dyn Fn() -> bool + Sync),
    ) -> Result<Self, SynthError> {
        let wanted = Wanted::new(is_cancelled);
        // Choose the number of levels.
        let side = exemplar.size[0].min(exemplar.size[1]);
        // The coarsest level needs at least one pixel along each side.
        let most = side
            .checked_ilog2()
            .map_or(0, |levels| (levels + 1).min(MAX_LEVELS));
        let n_levels = options.n_levels.unwrap_or_else(|| {
            let levels = (side / COARSEST).checked_ilog2();
            levels.map_or(1, |levels| (levels + 1).min(MAX_LEVELS))
        });
        // Check the number of levels and the periods.
        let range = "from 1 to 16, and none wider than the exemplar";
        let holds = (1..=most).contains(&n_levels);
        SynthError::check(holds, "number of levels", n_levels.into(), range)?;
        for period in options.period.into_iter().flatten() {
            // Periods must be even on all levels, because subpasses alternate between even and odd pixels.
            if period == 0 || period % (1 << n_levels) != 0 {
                return Err(SynthError::new(SynthErrorKind::Period { period, n_levels }));
            }
        }
        // Compute the features of the exemplar on each level.
        let mut stages = level::stages(
            exemplar,
            &Guides::default(),
            Symmetry::One,
            n_levels as usize,
            &wanted,
        )?;
        // Similar pixels have no penalty in regular exemplars.
        let is_tile = exemplar.edges == Edges::Wrap && exemplar.usable.is_none();
        let is_regular = exemplar.regularity() > REGULAR;
        for stage in &mut stages {
            stage.coherence = if is_regular { 0.0 } else { COHERENCE };
        }
        let mut texture = Self {
            is_lattice: is_tile && is_regular,
            size: exemplar.size,
            edges: exemplar.edges,
            seed: options.seed,
            period: options.period,
            coarsest: stages
                .last()
                .map_or(Vec::new(), AppearanceLevel::usable_pixels),
            stages,
        };
        // Copies of a repeating tile use all parts evenly, and costs would disturb the repetition.
        if !texture.is_lattice {
            let repetition = if is_regular { 0.0 } else { REPETITION };
            texture.even_out(repetition, &wanted)?;
        }
        Ok(texture)
    }

    /// Returns the number of levels.
    #[must_use]
    pub fn n_levels(&self) -> usize {
        self.stages.len()
    }

    /// Computes a window of `size` pixels, at most 2^26 in total, whose top left pixel is at column `first[0]` and row
    /// `first[1]`.
    ///
    /// The result wraps along an axis if its size along that axis equals the period.
    ///
    /// # Errors
    ///
    /// If the window has no pixels or too many, if its first column or row is beyond ±2^52, or if the callback breaks
    /// ([`SynthErrorKind::Cancelled`](crate::SynthErrorKind::Cancelled)).
    pub fn window(
        &self,
        first: [i64; 2],
        size: [u32; 2],
        mut callback: impl FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<PlaneTexture, SynthError> {
        crate::plane::check_pixels(size)?;
        for at in first {
            let holds = (-MAX_PLACE..=MAX_PLACE).contains(&at);
            let range = "from -2^52 to 2^52";
            SynthError::check(holds, "first column or row", at as f64, range)?;
        }
        let sources = self.sources(first, size, &mut callback)?;
        let edges = [0, 1].map(|axis| match self.period[axis] == Some(size[axis]) {
            true => Edges::Wrap,
            false => Edges::Cut,
        });
        PlaneTexture::from_sources(sources, edges, self.size, self.edges)
    }
}

#[cfg(test)]
mod tests;
