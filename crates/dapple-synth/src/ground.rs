//! The ground of a texture: sites on several levels, their order, and how neighborhoods are read.

use crate::Symmetry;
use crate::guides::Targets;
use crate::turns::Turns;
use core::ops::RangeInclusive;
use core::sync::atomic::{AtomicU8, AtomicU32, Ordering};

/// In place of a site, or of the pixel of one that begins with a random one.
pub(crate) const UNKNOWN: u32 = u32::MAX;

/// What the sites of a level begin with.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Start {
    /// The pixel of each site, or [`UNKNOWN`].
    pub(crate) pixels: Vec<u32>,
    /// Whether each site keeps its pixel.
    pub(crate) is_kept: Vec<bool>,
}

/// The colors of sites, or of the pixels of a grid.
pub(crate) trait Colors: Copy + Sync {
    /// The number of values of each.
    fn n_channels(&self) -> usize;

    /// The values of one.
    fn of(&self, at: usize) -> &[f32];
}

/// Values side by side, `n_channels` for each site or pixel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plain<'a> {
    pub(crate) values: &'a [f32],
    pub(crate) n_channels: usize,
}

/// Sites that have the colors of pixels; other threads may give them others in the meantime.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Painted<'a> {
    pub(crate) pixels: Plain<'a>,
    /// What each site is from.
    pub(crate) sources: &'a Sources,
}

/// What the sites of a level are from.
#[derive(Debug, Default)]
pub(crate) struct Sources {
    /// The pixel of each site; nothing if no pass visited the level.
    pub(crate) pixels: Vec<AtomicU32>,
    /// By how many quarter turns the exemplar lies turned at each site; nothing where directions have no symmetry.
    pub(crate) quarters: Vec<AtomicU8>,
}

/// Where a square of samples is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Square {
    /// The site in its middle.
    pub(crate) site: u32,
    /// The level of the site.
    pub(crate) level: usize,
    /// The level whose sites are read, and whose spacing is that of the samples: `level` or the next coarser one.
    pub(crate) reads: usize,
    /// The samples go from `-half` to `half` in both directions.
    pub(crate) half: i32,
    /// Whether only the rows above the middle are needed, with that of the middle or without, or all.
    pub(crate) rows: Rows,
}

/// Which rows of a square are needed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Rows {
    Above,
    AboveAndMiddle,
    All,
}

/// Samples of a square, row by row from the top; rows that are not needed hold anything.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Samples {
    /// `n_channels` values for each sample.
    pub(crate) values: Vec<f32>,
    /// The site of the level read that counts most at each sample; [`UNKNOWN`] past an edge of a texture that is repaired.
    pub(crate) nearest: Vec<u32>,
}

/// Sites on several levels, 0 the finest.
pub(crate) trait Ground: Sync {
    /// Tables that a pass needs to read squares.
    type Prepared: Sync;
    /// Memory of `read`, kept from square to square.
    type Memory: Default + Send;

    /// The number of sites of a level.
    fn n_sites(&self, level: usize) -> usize;

    /// How much what [`read`](Self::read) gives is blurred: the part of a pixel that each of the two beside it along an axis
    /// has.
    fn blur(&self) -> f32 {
        0.0
    }

    /// What the sites of a level begin with; where there is nothing, random pixels, and all sites are visited.
    fn start(&self, _level: usize) -> Option<&Start> {
        None
    }

    /// The guides of the texture, if it has any.
    fn targets(&self) -> Option<&Targets> {
        None
    }

    /// The site of the coarser level that a site is over, and which of the four over it: whether its column and its row are
    /// odd. Nothing where sites do not lie so.
    fn parent(&self, _level: usize, _site: u32) -> Option<(u32, [i64; 2])> {
        None
    }

    /// The symmetry of the directions in which squares are laid.
    fn symmetry(&self) -> Symmetry {
        Symmetry::One
    }

    /// How many quarter turns take the directions of a site nearest to those of another one after some quarter turns.
    fn quarters_toward(&self, _site: u32, _other: u32, _quarters: u8) -> u8 {
        0
    }

    /// The sites of a level that are visited, in the order of the sweep.
    fn order(&self, level: usize) -> Vec<u32>;

    /// The tables of a pass over a level that reads squares of these halves on the level itself and on the next coarser
    /// one.
    fn prepare(&self, level: usize, same: Option<i32>, coarser: Option<i32>) -> Self::Prepared;

    /// The order in which threads share the sites of a level, in a pass that reads squares on the level itself.
    fn turns(&self, level: usize, prepared: &Self::Prepared) -> Turns;

    /// Reads a square of samples on the level `square.reads`, which has these colors.
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

impl Colors for Painted<'_> {
    #[inline(always)]
    fn n_channels(&self) -> usize {
        self.pixels.n_channels
    }

    #[inline(always)]
    fn of(&self, at: usize) -> &[f32] {
        self.pixels.of(self.source(at) as usize)
    }
}

impl Painted<'_> {
    /// The pixel of a site.
    #[inline(always)]
    pub(crate) fn source(&self, site: usize) -> u32 {
        // A thread that reads a site that another one writes waits for its turn to be over, which makes an order of both.
        self.sources.pixels[site].load(Ordering::Relaxed)
    }

    /// By how many quarter turns the exemplar lies turned at a site.
    #[inline]
    pub(crate) fn quarters(&self, site: usize) -> u8 {
        let quarters = self.sources.quarters.get(site);
        quarters.map_or(0, |quarters| quarters.load(Ordering::Relaxed))
    }
}

impl Square {
    /// The number of samples along a side.
    pub(crate) fn side(&self) -> usize {
        2 * self.half as usize + 1
    }

    /// The rows that are needed.
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
    /// Makes room for the samples of a square.
    pub(crate) fn make_room(&mut self, side: usize, n_channels: usize) {
        self.values.resize(side * side * n_channels, 0.0);
        self.nearest.resize(side * side, 0);
    }
}
