//! Sites within reach of a site, stored in arrays of coordinates that are read sequentially.
//!
//! Input: the sites of a level. Output: for any site, the sites in a ball around it, in a fixed order.
//!
//! Sites are sorted by cell. Positions are `f32`, relative to the center of the bounding box. A surface of 2^28 sites,
//! the maximum, extends a few thousand spacings from there; rounding is then below 3e-4 of a spacing.

use crate::cells::Cells;
use crate::{Hierarchy, Sites};
use dapple_raster::Groups;
use dapple_raster::simd::dispatch;
use fearless_simd::{Level, f32x8, prelude::*};
use glam::{DVec3, Vec3};

/// Side of a cell, in multiples of the spacing.
const CELL: f64 = 3.0;
/// Number of sites in a register.
const LANES: usize = 8;

/// For each site of a level, the sites near it.
#[derive(Clone, Debug)]
pub(crate) struct Neighborhoods {
    cells: Cells,
    /// Index of the first record of each cell.
    first: Vec<u32>,
    /// Sites that may be neighbors, sorted by cell.
    records: Vec<Record>,
    /// Positions of the records, one array per coordinate, with one register of padding at the end.
    columns: [Vec<f32>; 3],
    /// Positions of the sites at the centers of neighborhoods.
    centers: Vec<Vec3>,
    reach_sq: f32,
}

/// A site that may be a neighbor.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Record {
    pub(crate) position: [f32; 3],
    pub(crate) normal: [f32; 3],
    pub(crate) site: u32,
}

/// Scratch memory: the sites near a position, in the order in which a caller sums their colors.
#[derive(Debug, Default)]
pub(crate) struct NeighborScratch {
    numbers: Vec<u32>,
    /// Sites found by [`Self::collect_ball`], which are not part of a [`Neighborhoods`].
    records: Vec<Record>,
}

/// Sites near a position, as a selection of records.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NeighborhoodView<'a> {
    records: &'a [Record],
    /// Indices of the selected records.
    numbers: &'a [u32],
    /// Center; the positions of the sites are relative to it.
    center: [f32; 3],
}

impl Neighborhoods {
    /// Builds the neighborhoods of the first `n_sites` sites. Their neighbors are taken from the first `n_reads` sites,
    /// which are those of the same level or of the next coarser one (`n_reads ≤ n_sites`), `spacing` apart.
    pub(crate) fn new(
        sites: &Sites,
        [n_sites, n_reads]: [usize; 2],
        spacing: f64,
        reach: f64,
    ) -> Self {
        let positions = &sites.positions()[..n_sites];
        let cells = Cells::new(positions, CELL * spacing, reach);
        // Find the center of the bounding box.
        let [low, high] = [
            (DVec3::INFINITY, DVec3::min as fn(DVec3, DVec3) -> DVec3),
            (DVec3::NEG_INFINITY, DVec3::max),
        ]
        .map(|(start, pick)| positions.iter().copied().fold(start, pick));
        let middle = low * 0.5 + high * 0.5;
        let centers: Vec<Vec3> = positions
            .iter()
            .map(|&at| (at - middle).as_vec3())
            .collect();
        // Sort the sites by cell.
        let of_sites: Vec<u32> = (0..n_reads as u32)
            .map(|site| cells.of_site(site) as u32)
            .collect();
        let sorted = Groups::sort(cells.n_cells(), &of_sites);
        let records: Vec<Record> = sorted
            .items
            .iter()
            .map(|&site| Record {
                position: centers[site as usize].to_array(),
                normal: sites.normals()[site as usize].as_vec3().to_array(),
                site,
            })
            .collect();
        // Copy the coordinates into arrays.
        let column = |part: usize| {
            let column = records.iter().map(|record| record.position[part]);
            column.chain([f32::MAX; LANES]).collect()
        };
        Self {
            columns: [0, 1, 2].map(column),
            cells,
            first: sorted.starts,
            records,
            centers,
            reach_sq: (reach * reach) as f32,
        }
    }

    /// Returns the cells. The parallel schedule of a pass processes the sites of a cell together (`WavefrontSchedule`).
    pub(crate) fn cells(&self) -> &Cells {
        &self.cells
    }

    /// Selects the sites in the ball around a site. If the ball is empty, selects the nearest of all sites, because a
    /// small piece of the surface may have no site on a coarse level.
    #[inline]
    pub(crate) fn collect<'a>(
        &'a self,
        level: Level,
        site: u32,
        nearby: &'a mut NeighborScratch,
    ) -> NeighborhoodView<'a> {
        let center = self.centers[site as usize].to_array();
        let cell = self.cells.of_site(site);
        let numbers = &mut nearby.numbers;
        dispatch!(level, simd => self.collect_ball(simd, cell, center, numbers));
        // Every sample needs a color: if no site is in reach, the nearest one stands in.
        if numbers.is_empty() {
            numbers.extend(self.nearest(center));
        }
        NeighborhoodView {
            records: &self.records,
            numbers,
            center,
        }
    }

    /// Lists the sites in a ball around `center`, which is in the given cell.
    #[inline(always)]
    fn collect_ball<S: Simd>(
        &self,
        simd: S,
        cell: usize,
        center: [f32; 3],
        numbers: &mut Vec<u32>,
    ) {
        let [x, y, z] = &self.columns;
        let mut length = 0;
        for cells in self.cells.near(cell) {
            let [from, until] =
                [cells.start, cells.end].map(|cell| self.first[cell as usize] as usize);
            // Reserve memory for all sites, plus a full last register.
            if numbers.len() < length + until - from + LANES {
                numbers.resize(length + until - from + LANES, 0);
            }
            for first in (from..until).step_by(LANES) {
                let load = |column: &[f32]| f32x8::from_slice(simd, &column[first..first + LANES]);
                let [x, y, z] = [
                    load(x) - center[0],
                    load(y) - center[1],
                    load(z) - center[2],
                ];
                let near = (x * x + y * y + z * z).simd_lt(self.reach_sq).to_bitmask();
                // The last register of a run of cells also holds sites of the cells stored after it, or padding.
                let near = near & ((1 << (until - first).min(LANES)) - 1);
                // Compact without branches, because the lanes that are near are unpredictable. `n_near` is at most
                // `lane`, so `% LANES` only saves a bounds check.
                let room: &mut [u32] = &mut numbers[length..length + LANES];
                let mut n_near = 0;
                for lane in 0..LANES {
                    room[n_near % LANES] = (first + lane) as u32;
                    n_near += (near >> lane & 1) as usize;
                }
                length += n_near;
            }
        }
        numbers.truncate(length);
    }

    /// Returns the index of the record nearest to a position; of equally near ones, the site with the lowest index.
    #[cold]
    fn nearest(&self, center: [f32; 3]) -> Option<u32> {
        let far = |record: &Record| length_sq(difference(record.position, center));
        let numbers = (0..).zip(&self.records);
        let nearest =
            numbers.min_by(|(_, a), (_, b)| far(a).total_cmp(&far(b)).then(a.site.cmp(&b.site)));
        nearest.map(|(number, _)| number)
    }
}

#[inline(always)]
fn length_sq([x, y, z]: [f32; 3]) -> f32 {
    x * x + y * y + z * z
}

#[inline(always)]
fn difference(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    core::array::from_fn(|part| a[part] - b[part])
}

impl<'a> NeighborhoodView<'a> {
    /// Returns the number of sites.
    #[inline(always)]
    pub(crate) fn len(&self) -> usize {
        self.numbers.len()
    }

    /// Returns the selected sites, with positions relative to the center.
    #[inline(always)]
    pub(crate) fn sites(self) -> impl Iterator<Item = Record> + 'a {
        self.numbers.iter().map(move |&number| {
            let record = &self.records[number as usize];
            Record {
                position: difference(record.position, self.center),
                ..*record
            }
        })
    }
}

impl NeighborScratch {
    /// Selects the sites of a level within a ball. If there are none, doubles the radius of the ball until there are.
    pub(crate) fn collect_ball(
        &mut self,
        hierarchy: &Hierarchy,
        level: usize,
        center: DVec3,
        reach: f64,
    ) -> NeighborhoodView<'_> {
        let sites = hierarchy.sites();
        let mut reach = reach;
        self.records.clear();
        // Double the reach until a site is found; on a level without sites it ends at infinity.
        while self.records.is_empty() && reach.is_finite() {
            let reach_sq = reach * reach;
            hierarchy.levels()[level]
                .grid()
                .visit(center, reach, |site| {
                    let from = sites.positions()[site.index()] - center;
                    if from.length_squared() < reach_sq {
                        self.records.push(Record {
                            position: from.as_vec3().to_array(),
                            normal: sites.normals()[site.index()].as_vec3().to_array(),
                            site: site.0,
                        });
                    }
                });
            reach *= 2.0;
        }
        self.numbers.clear();
        self.numbers.extend(0..self.records.len() as u32);
        NeighborhoodView {
            records: &self.records,
            numbers: &self.numbers,
            center: [0.0; 3],
        }
    }
}
