//! The domain of a synthesis, as an interface for [`engine`](crate::engine): sites on several levels, their order, and
//! how their neighborhoods are sampled.
//!
//! [`SynthesisDomain`] is implemented for surfaces (`mesh_domain.rs`) and for planes (`plane.rs`).

use crate::Symmetry;
use crate::guides::Targets;
use crate::wavefront::WavefrontSchedule;
use core::ops::RangeInclusive;
use core::sync::atomic::{AtomicU8, AtomicU32, Ordering};

/// Marks a missing site, or an unknown pixel. Unknown pixels are initialized at random.
pub(crate) const UNKNOWN: u32 = u32::MAX;

/// Initial state of a level in a repair.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Start {
    /// Initial pixel of each site, or [`UNKNOWN`].
    pub(crate) pixels: Vec<u32>,
    /// Whether each site keeps its pixel.
    pub(crate) is_kept: Vec<bool>,
}

/// Colors of sites, or of the pixels of a grid.
pub(crate) trait Colors: Copy + Sync {
    /// Returns the number of channels.
    fn n_channels(&self) -> usize;

    /// Returns the channels of the site or pixel `at`.
    fn of(&self, at: usize) -> &[f32];
}

/// Colors stored contiguously, `n_channels` values for each site or pixel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plain<'a> {
    pub(crate) values: &'a [f32],
    pub(crate) n_channels: usize,
}

/// Colors of sites, stored as references to exemplar pixels. Other threads may change the references at the same time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LevelState<'a> {
    pub(crate) pixels: Plain<'a>,
    /// Source pixel and rotation of each site.
    pub(crate) sources: &'a Sources,
}

/// Sources of the sites of a level: their pixels and the rotations of the exemplar.
#[derive(Debug, Default)]
pub(crate) struct Sources {
    /// Exemplar pixel of each site; empty if no pass visited the level.
    pub(crate) pixels: Vec<AtomicU32>,
    /// Rotation of the exemplar at each site, in quarter turns; empty if the orientation field has no symmetry.
    pub(crate) quarters: Vec<AtomicU8>,
}

/// Position and extent of a square of samples around a site.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Square {
    /// Site at the center.
    pub(crate) site: u32,
    /// Level of the site.
    pub(crate) level: usize,
    /// Level whose sites are read: `level` or the next coarser one. Samples have the spacing of this level.
    pub(crate) reads: usize,
    /// Half-side length, in samples: samples go from `-half` to `half` along both axes.
    pub(crate) half: i32,
    /// Rows of the square that are needed.
    pub(crate) rows: Rows,
}

/// Which rows of a square are needed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Rows {
    Above,
    AboveAndMiddle,
    All,
}

/// Samples of a square, row by row from the top. The content of rows that are not needed is arbitrary.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Samples {
    /// Channel values of all samples, `n_channels` per sample.
    pub(crate) values: Vec<f32>,
    /// Site with the largest weight at each sample; [`UNKNOWN`] past an edge of a texture under repair.
    pub(crate) nearest: Vec<u32>,
}

/// Domain of a synthesis: sites on several levels. Level 0 is the finest.
pub(crate) trait SynthesisDomain: Sync {
    /// Tables that a pass needs to sample squares.
    type Prepared: Sync;
    /// Scratch memory for [`read`](Self::read).
    type Memory: Default + Send;

    /// Returns the number of sites of a level.
    fn n_sites(&self, level: usize) -> usize;

    /// Returns the blur of the samples from [`read`](Self::read), as the weight of each of the two adjacent pixels
    /// along an axis. 0 by default.
    fn blur(&self) -> f32 {
        0.0
    }

    /// Returns the initial state of a level in a repair. The default, `None`, means that pixels start at random and all
    /// sites are visited.
    fn start(&self, _level: usize) -> Option<&Start> {
        None
    }

    /// Returns the guides of the texture, if any.
    fn targets(&self) -> Option<&Targets> {
        None
    }

    /// Returns the parent of a site on the coarser level, and the site's quadrant in it (1 for an odd column or row,
    /// otherwise 0). `None` if sites are not arranged in a grid.
    fn parent(&self, _level: usize, _site: u32) -> Option<(u32, [i64; 2])> {
        None
    }

    /// Returns the symmetry of the orientation field.
    fn symmetry(&self) -> Symmetry {
        Symmetry::One
    }

    /// Returns the rotation, in quarter turns, for which the direction at `site` is nearest to the direction at `other`
    /// rotated by `quarters`.
    fn quarters_toward(&self, _site: u32, _other: u32, _quarters: u8) -> u8 {
        0
    }

    /// Returns the sites of a level to visit, in sweep order.
    fn order(&self, level: usize) -> Vec<u32>;

    /// Prepares a pass over a level. `same` and `coarser` are the half-side lengths of the squares on the level itself
    /// and on the next coarser level; `None` if the pass does not read that level.
    fn prepare(&self, level: usize, same: Option<i32>, coarser: Option<i32>) -> Self::Prepared;

    /// Returns the wavefront schedule of the sites of a level, for a pass that reads squares on the level itself.
    fn turns(&self, level: usize, prepared: &Self::Prepared) -> WavefrontSchedule;

    /// Samples a square on the level `square.reads`, whose sites have the given `colors`.
    fn read(
        &self,
        square: Square,
        prepared: &Self::Prepared,
        colors: impl Colors,
        samples: &mut Samples,
        memory: &mut Self::Memory,
    );
}

impl Colors for Plain<'_> {
    #[inline(always)]
    fn n_channels(&self) -> usize {
        self.n_channels
    }

    #[inline(always)]
    fn of(&self, at: usize) -> &[f32] {
        &self.values[at * self.n_channels..][..self.n_channels]
    }
}

impl Colors for LevelState<'_> {
    #[inline(always)]
    fn n_channels(&self) -> usize {
        self.pixels.n_channels
    }

    #[inline(always)]
    fn of(&self, at: usize) -> &[f32] {
        self.pixels.of(self.source(at) as usize)
    }
}

impl LevelState<'_> {
    /// Returns the exemplar pixel of `site`.
    #[inline(always)]
    pub(crate) fn source(&self, site: usize) -> u32 {
        // Relaxed is enough: the schedule orders this read after writes of other threads.
        self.sources.pixels[site].load(Ordering::Relaxed)
    }

    /// Returns the rotation of the exemplar at `site`, in quarter turns.
    #[inline]
    pub(crate) fn quarters(&self, site: usize) -> u8 {
        let quarters = self.sources.quarters.get(site);
        quarters.map_or(0, |quarters| quarters.load(Ordering::Relaxed))
    }
}

impl Square {
    /// Returns the number of samples along a side of the square.
    pub(crate) fn side(&self) -> usize {
        2 * self.half as usize + 1
    }

    /// Returns the range of the rows that are needed, relative to the center.
    pub(crate) fn range(&self) -> RangeInclusive<i32> {
        let last = match self.rows {
            Rows::Above => -1,
            Rows::AboveAndMiddle => 0,
            Rows::All => self.half,
        };
        -self.half..=last
    }
}

impl Samples {
    /// Resizes the buffers for a square of `side` × `side` samples.
    pub(crate) fn make_room(&mut self, side: usize, n_channels: usize) {
        self.values.resize(side * side * n_channels, 0.0);
        self.nearest.resize(side * side, 0);
    }
}
