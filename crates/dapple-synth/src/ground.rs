//! What a texture grows on: sites on several levels, their order, and how neighborhoods are read.

use crate::groups::Groups;
use core::ops::RangeInclusive;

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
    /// The site of the level read that counts most at each sample.
    pub(crate) nearest: Vec<u32>,
}

/// Sites on several levels, 0 the finest.
pub(crate) trait Ground: Sync {
    /// What a pass needs to read squares.
    type Prepared: Sync;
    /// What `read` works in.
    type Memory: Default + Send;

    /// The number of sites of a level.
    fn n_sites(&self, level: usize) -> usize;

    /// The sites of a level in the order of the sweep.
    fn order(&self, level: usize) -> Vec<u32>;

    /// What a pass over a level needs that reads squares of these halves on the level itself and on the next coarser one.
    fn prepare(&self, level: usize, same: Option<i32>, coarser: Option<i32>) -> Self::Prepared;

    /// The sites of a level in groups, for a pass that reads squares on the level itself.
    fn groups(&self, level: usize, prepared: &Self::Prepared) -> Groups;

    /// Reads a square of samples of a column of the level `square.reads`: as many values for each sample as for a site.
    fn read(
        &self,
        square: Square,
        prepared: &Self::Prepared,
        column: &[f32],
        samples: &mut Samples,
        memory: &mut Self::Memory,
    );
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
