//! Appearance features: vectors that describe the surroundings of each pixel of an exemplar, on every level.
//!
//! Reference: Sylvain Lefebvre and Hugues Hoppe, "Appearance-Space Texture Synthesis", SIGGRAPH 2006, DOI
//! 10.1145/1141911.1141921.
//!
//! Input: an exemplar, its guides and mask, and a number of levels. Output: a [`AppearanceLevel`] per level, with the features,
//! the usable pixels, and the most similar other pixel of each pixel.
//!
//! All levels have the full size of the exemplar, as in an à trous pyramid. Each level is computed by blurring the
//! previous one with the weights 1-4-6-4-1. The taps are as far apart as the texture's pixels on the previous level: 1,
//! 2, 4 and so on, in exemplar pixels. So a source can be any pixel of the exemplar, on coarse levels too.

use super::evenness::Costs;
use crate::engine::Wanted;
use crate::exemplar::blend;
use crate::guides::Guides;
use crate::matcher::{Basis, Matcher, MatcherMemory, Query};
use crate::orientation::offset_after;
use crate::{Edges, Exemplar, Symmetry, SynthError, SynthErrorKind};
use dapple_raster::simd::{self, dispatch};
use dapple_raster::{Wrap, parallel};

/// Number of features of a pixel.
pub(crate) const N_FEATURES: usize = 8;

/// Offsets of the pixels whose features are compared, in pixels of the level.
pub(crate) const DIAGONALS: [[i64; 2]; 4] = [[-1, -1], [1, -1], [-1, 1], [1, 1]];

/// Half-side length of the window that features describe, in pixels of the level.
const HALF: i64 = 2;

/// Squared weights of the columns and of the rows of a window.
const WEIGHTS: [f32; 2 * HALF as usize + 1] = [1.0, 4.0, 6.0, 4.0, 1.0];

/// Minimum distance between a pixel and its most similar pixel, as a fraction of the exemplar's shorter side.
const APART: f64 = 0.05;

/// Maximum number of pixels of the grid. A search among them takes a tenth of a millisecond.
const GRID: i64 = 1 << 14;

/// Number of grid pixels that a search task processes.
const PIXELS: usize = 512;

/// Number of searches between two polls for cancellation.
const ASKED: usize = 64;

/// Maximum number of windows from which the principal components are computed.
const SAMPLE: usize = 4096;

/// Marks a missing row or pixel.
const NONE: u32 = u32::MAX;

/// One level of an exemplar.
#[derive(Clone, Debug)]
pub(crate) struct AppearanceLevel {
    pub(crate) size: [u32; 2],
    wrap: Wrap,
    /// Distance between adjacent pixels of the level, in pixels of the exemplar.
    pub(crate) spacing: i64,
    /// Features of each pixel: principal components of the window around it. There is one list for each rotation of the
    /// exemplar, from 0 to 3 quarter turns; the list is empty for rotations that are not in the symmetry.
    features: [Vec<[f32; N_FEATURES]>; 4],
    /// Whether each pixel can be a source; `None` if all can.
    usable: Option<Vec<bool>>,
    /// Spacing of the grid on which similar pixels are searched, in pixels of the exemplar.
    pub(crate) step: i64,
    /// For each grid pixel, the index of the most similar grid pixel, or [`NONE`].
    similar: Vec<u32>,
    /// Guides of every pixel, each multiplied by the square root of its weight.
    guides: Vec<f32>,
    /// Usable grid pixels, for [`search`](Self::search); `None` if the exemplar has no guides.
    searched: Option<Grid>,
    /// Costs of the parts of the exemplar, added to squared distances.
    pub(crate) costs: Costs,
    /// Cost of a source that is repeated nearby, added to its squared distance.
    pub(super) repetition_cost: f32,
    /// Penalty on similar pixels: their squared distances are multiplied by `1 + coherence`.
    pub(crate) coherence: f32,
}

/// Usable pixels of a grid, with a matcher for their features and guides.
#[derive(Clone, Debug)]
struct Grid {
    /// Grid index of each usable pixel.
    pixels: Vec<usize>,
    matcher: Matcher,
}

/// Computes the levels of an exemplar, the finest first, with features for each rotation of `symmetry`.
pub(crate) fn stages(
    exemplar: &Exemplar,
    guides: &Guides,
    symmetry: Symmetry,
    n_levels: usize,
    wanted: &Wanted<'_>,
) -> Result<Vec<AppearanceLevel>, SynthError> {
    // Blur the pixels and the guides from level to level.
    let mut pixels = vec![exemplar.pixels.clone()];
    let mut guides_of = vec![guides.values.clone()];
    let n_guides = guides.roots.len();
    for level in 1..n_levels {
        wanted.check()?;
        let step = 1 << (level - 1);
        pixels.push(blurred(
            exemplar,
            &pixels[level - 1],
            exemplar.n_channels,
            step,
        ));
        guides_of.push(blurred(exemplar, &guides_of[level - 1], n_guides, step));
    }
    // The margin excluded on a level is at most as wide as on the next coarser one, so the coarser sources stay usable.
    let mut reach = i64::MAX;
    let mut masks = Vec::with_capacity(n_levels);
    for level in (0..n_levels).rev() {
        wanted.check()?;
        reach = reach.min(HALF << level);
        let (mask, left) = usable(exemplar, level, reach)?;
        masks.push(mask);
        reach = left;
    }
    masks.reverse();
    // Compute the features of all levels.
    let stage = |level: usize| {
        let features = features(exemplar, symmetry, &pixels[level], 1 << level, wanted)?;
        let (guides, mask) = (guides_of[level].clone(), masks[level].clone());
        AppearanceLevel::new(exemplar, level, features, guides, mask, wanted)
    };
    parallel::map(n_levels, stage).into_iter().collect()
}

/// Converts the coordinates of an exemplar pixel to `u32`; they are below 2^32.
pub(crate) fn narrow(place: [i64; 2]) -> [u32; 2] {
    place.map(|at| at as u32)
}

/// Blurs an image of `n` channels with the weights 1-4-6-4-1 along both axes, with taps `step` pixels apart.
fn blurred(exemplar: &Exemplar, pixels: &[f32], n: usize, step: i64) -> Vec<f32> {
    let [width, height] = exemplar.size;
    let wrap = exemplar.edges.wrap();
    let taps = |at: usize, side: u32| {
        [-2, -1, 0, 1, 2].map(|tap| wrap.index(at as i64 + tap * step, side) as usize)
    };
    let line = width as usize * n;
    let rows = parallel::map(height as usize, |row| {
        // Blur vertically, then horizontally.
        let mut mixed = Vec::with_capacity(line);
        blend(
            taps(row, height).map(|row| &pixels[row * line..][..line]),
            &mut mixed,
        );
        let mut across = Vec::with_capacity(line);
        for column in 0..width as usize {
            blend(
                taps(column, width).map(|column| &mixed[column * n..][..n]),
                &mut across,
            );
        }
        across
    });
    rows.concat()
}

/// Computes the features of all pixels for each rotation of a symmetry.
fn features(
    exemplar: &Exemplar,
    symmetry: Symmetry,
    pixels: &[f32],
    spacing: i64,
    wanted: &Wanted<'_>,
) -> Result<[Vec<[f32; N_FEATURES]>; 4], SynthError> {
    let n = exemplar.n_channels;
    let [width, height] = exemplar.size;
    let wrap = exemplar.edges.wrap();
    // Gather the weighted window around a pixel, for a rotated exemplar.
    let taps = |at: usize, side: u32| {
        let tap = |tap| wrap.index(at as i64 + tap * spacing, side) as usize;
        core::array::from_fn::<usize, { WEIGHTS.len() }, _>(|at| tap(at as i64 - HALF))
    };
    let window = |quarters: u8, column: usize, row: usize, window: &mut Vec<f32>| {
        window.clear();
        let (columns, rows) = (taps(column, width), taps(row, height));
        for (y, down) in (-HALF..).zip(WEIGHTS) {
            for (x, across) in (-HALF..).zip(WEIGHTS) {
                // The weights of the columns add up to 16, and the weights of the rows as well.
                let weight = (down * across).sqrt() / 16.0;
                let [x, y] = offset_after([x, y], quarters).map(|at| (at + HALF) as usize);
                let pixel = &pixels[(rows[y] * width as usize + columns[x]) * n..][..n];
                window.extend(pixel.iter().map(|value| value * weight));
            }
        }
    };
    // Find the principal components of a sample of the windows.
    let dims = WEIGHTS.len() * WEIGHTS.len() * n;
    let n_pixels = width as usize * height as usize;
    let step = n_pixels.div_ceil(SAMPLE);
    let sample = parallel::map_at_least(64, n_pixels / step, |at| {
        let mut values = Vec::with_capacity(dims);
        let [column, row] = [at * step % width as usize, at * step / width as usize];
        window(0, column, row, &mut values);
        values
    });
    let basis = Basis::with_most(N_FEATURES, dims, &sample.concat());
    let level = simd::level();
    // Project the windows of all pixels.
    // All rotations share one basis, so that their features can be compared.
    let turned = |quarters: u8| {
        let rows = parallel::map(height as usize, |row| {
            if wanted.is_over() {
                return Vec::new();
            }
            let (mut values, mut centered) = (Vec::new(), Vec::new());
            let mut rotated = basis.memory();
            let features = |column| {
                window(quarters, column, row, &mut values);
                basis.center(&values, &mut centered);
                dispatch!(level, simd => basis.rotate(simd, &centered, &mut rotated));
                core::array::from_fn(|i| rotated[0][i])
            };
            (0..width as usize).map(features).collect::<Vec<_>>()
        });
        rows.concat()
    };
    let mut features = [const { Vec::new() }; 4];
    for &quarters in symmetry.quarters() {
        features[usize::from(quarters)] = turned(quarters);
        wanted.check()?;
    }
    Ok(features)
}

/// Returns the usable pixels, and the width of the margin that was excluded around cut edges and masked pixels. The
/// margin is at most `reach` pixels wide; it is halved while it would exclude more than half of the allowed pixels.
fn usable(
    exemplar: &Exemplar,
    level: usize,
    mut reach: i64,
) -> Result<(Option<Vec<bool>>, i64), SynthError> {
    if exemplar.edges == Edges::Wrap && exemplar.usable.is_none() {
        return Ok((None, reach));
    }
    let [width, height] = exemplar.size.map(|side| side as usize);
    // Start from the mask; at least half of its pixels must remain.
    let all = match &exemplar.usable {
        Some(usable) => usable.clone(),
        None => vec![true; width * height],
    };
    let count = |usable: &[bool]| usable.iter().filter(|&&usable| usable).count();
    let enough = count(&all).div_ceil(2);
    if enough == 0 {
        return Err(SynthError::new(SynthErrorKind::Masked { level }));
    }
    // Halve the margin until enough pixels are usable.
    loop {
        // Erode along the rows, then along the columns.
        let rows = all.chunks_exact(width);
        let across: Vec<bool> = rows
            .flat_map(|row| inner(exemplar.edges, width, reach, |at| row[at]))
            .collect();
        let columns = parallel::map(width, |column| {
            inner(exemplar.edges, height, reach, |at| {
                across[at * width + column]
            })
        });
        let usable: Vec<bool> = (0..width * height)
            .map(|pixel| columns[pixel % width][pixel / width])
            .collect();
        if count(&usable) >= enough {
            return Ok((Some(usable), reach));
        }
        reach /= 2;
    }
}

/// Returns whether a condition holds everywhere within `reach` of each position of a line (binary erosion).
fn inner(edges: Edges, side: usize, reach: i64, holds: impl Fn(usize) -> bool) -> Vec<bool> {
    let side = side as i64;
    let reach = reach.min(side);
    let holds_at = |at: i64| match edges {
        Edges::Wrap => holds(at.rem_euclid(side) as usize),
        Edges::Cut => (0..side).contains(&at) && holds(at as usize),
    };
    // Count the consecutive positions up to `at + reach` at which the condition holds.
    let mut run = (-reach..reach).rev().take_while(|&at| holds_at(at)).count() as i64;
    let mut inner = Vec::with_capacity(side as usize);
    for at in 0..side {
        run = if holds_at(at + reach) { run + 1 } else { 0 };
        // The window from `at - reach` to `at + reach` has 2 · reach + 1 positions.
        inner.push(run > 2 * reach);
    }
    inner
}

impl AppearanceLevel {
    /// Creates a level of an exemplar from its features, guides and mask, and finds the most similar pixels.
    fn new(
        exemplar: &Exemplar,
        level: usize,
        features: [Vec<[f32; N_FEATURES]>; 4],
        guides: Vec<f32>,
        usable: Option<Vec<bool>>,
        wanted: &Wanted<'_>,
    ) -> Result<Self, SynthError> {
        let spacing = 1_i64 << level;
        let n_pixels = i64::from(exemplar.size[0]) * i64::from(exemplar.size[1]);
        // Double the step of the grid until it has at most `GRID` pixels.
        let mut step = spacing;
        while n_pixels > GRID * step * step {
            step *= 2;
        }
        let mut stage = Self {
            size: exemplar.size,
            wrap: exemplar.edges.wrap(),
            spacing,
            features,
            usable,
            step,
            similar: Vec::new(),
            guides,
            searched: None,
            costs: Costs::default(),
            repetition_cost: 0.0,
            coherence: 0.0,
        };
        stage.search_alike(wanted)?;
        Ok(stage)
    }

    /// Returns the features of a pixel. Coordinates past the edges are mirrored or wrapped.
    #[inline(always)]
    pub(crate) fn features(&self, place: [i64; 2]) -> &[f32; N_FEATURES] {
        self.turned_features(place, 0)
    }

    /// Returns the features of a pixel like [`features`](Self::features), with the exemplar rotated by `quarters`
    /// quarter turns.
    #[inline(always)]
    pub(crate) fn turned_features(&self, place: [i64; 2], quarters: u8) -> &[f32; N_FEATURES] {
        let (column, row) = (self.within(0, place[0]), self.within(1, place[1]));
        &self.features[usize::from(quarters)][row * self.size[0] as usize + column]
    }

    /// Maps a column or row to one within the exemplar, mirrored or wrapped past its edges.
    #[inline(always)]
    fn within(&self, axis: usize, at: i64) -> usize {
        // Avoid the remainder operation, the most expensive one here.
        if (0..i64::from(self.size[axis])).contains(&at) {
            at as usize
        } else {
            self.wrap.index(at, self.size[axis]) as usize
        }
    }

    /// Returns the squared distance between the features on the diagonals of a texture pixel and those on the diagonals
    /// of an exemplar pixel.
    #[inline(always)]
    pub(crate) fn distance_sq(&self, around: &[[f32; N_FEATURES]; 4], place: [i64; 2]) -> f32 {
        self.distance_sq_of(around.iter().zip(DIAGONALS), place)
    }

    /// Returns the squared distance between the features on some diagonals of a texture pixel and those on the same
    /// diagonals of an exemplar pixel.
    #[inline(always)]
    pub(crate) fn distance_sq_of<'a>(
        &self,
        around: impl Iterator<Item = (&'a [f32; N_FEATURES], [i64; 2])>,
        [column, row]: [i64; 2],
    ) -> f32 {
        // Sum each feature separately: the sums fill registers and do not depend on each other.
        let mut sums = [0.0; N_FEATURES];
        for (own, [x, y]) in around {
            let other = self.features([column + x * self.spacing, row + y * self.spacing]);
            for i in 0..N_FEATURES {
                sums[i] += (own[i] - other[i]) * (own[i] - other[i]);
            }
        }
        let [a, b, c, d, e, f, g, h] = sums;
        ((a + e) + (c + g)) + ((b + f) + (d + h))
    }

    /// Returns the squared distance between the guides `wanted` and the guides of an exemplar pixel, times the number
    /// of diagonals, because a guide counts as a channel that differs on every diagonal.
    #[inline]
    pub(crate) fn guides_distance_sq(&self, wanted: &[f32], [column, row]: [i64; 2]) -> f32 {
        if wanted.is_empty() {
            return 0.0;
        }
        let pixel = row as usize * self.size[0] as usize + column as usize;
        let own = &self.guides[pixel * wanted.len()..][..wanted.len()];
        let squares = own.iter().zip(wanted).map(|(a, b)| (a - b) * (a - b));
        // Count the guides once for each diagonal, as the features are.
        DIAGONALS.len() as f32 * squares.sum::<f32>()
    }

    /// Returns the grid pixel with the most similar features and guides; `None` if the exemplar has no guides.
    pub(crate) fn search(
        &self,
        around: &[[f32; N_FEATURES]; 4],
        wanted: &[f32],
        memory: &mut MatcherMemory,
    ) -> Option<[i64; 2]> {
        let grid = self.searched.as_ref()?;
        let values = compared(around, wanted);
        let found = grid.matcher.nearest(&values, f32::INFINITY, None, memory)?;
        Some(self.grid_place(grid.pixels[found.row as usize]))
    }

    /// Returns the initial source of the texture pixel `at`, given the source of its parent on the coarser level: the
    /// pixel half a spacing from the parent's source toward the child, or `parent` itself if that pixel is not usable.
    pub(crate) fn child(&self, parent: [i64; 2], at: [i64; 2]) -> [i64; 2] {
        // Offset by half a spacing in the child's direction, rounded down: 1 or 0 pixels on the finest level.
        let step = at.map(|at| ((2 * at.rem_euclid(2) - 1) * self.spacing).div_euclid(2));
        let beside = [parent[0] + step[0], parent[1] + step[1]];
        self.usable(beside).unwrap_or(parent)
    }

    /// Returns the pixel at `place`, wrapped if the exemplar wraps, or `None` if the pixel is not usable.
    #[inline(always)]
    pub(crate) fn usable(&self, mut place: [i64; 2]) -> Option<[i64; 2]> {
        for (at, side) in place.iter_mut().zip(self.size) {
            if !(0..i64::from(side)).contains(at) {
                if self.wrap != Wrap::Repeat {
                    return None;
                }
                *at = at.rem_euclid(side.into());
            }
        }
        let Some(usable) = &self.usable else {
            return Some(place);
        };
        let [column, row] = place;
        let pixel = row * i64::from(self.size[0]) + column;
        usable[pixel as usize].then_some(place)
    }

    /// Returns the indices of the usable pixels.
    pub(crate) fn usable_pixels(&self) -> Vec<u32> {
        let pixels = 0..self.size[0] * self.size[1];
        match &self.usable {
            Some(usable) => pixels.filter(|&pixel| usable[pixel as usize]).collect(),
            None => pixels.collect(),
        }
    }

    /// Returns the pixel most similar to `place`, if it is usable: the most similar grid pixel, plus the offset of
    /// `place` from its own grid pixel.
    #[inline(always)]
    pub(crate) fn similar(&self, place: [i64; 2]) -> Option<[i64; 2]> {
        let [column, row] = place.map(|at| at / self.step);
        let [width, _] = self.grid();
        let found = self.similar[(row * width + column) as usize];
        if found == NONE {
            return None;
        }
        let found = [i64::from(found) % width, i64::from(found) / width];
        self.usable([0, 1].map(|axis| found[axis] * self.step + place[axis] % self.step))
    }

    /// Returns the number of columns and rows of the grid.
    fn grid(&self) -> [i64; 2] {
        self.size.map(|side| (i64::from(side) - 1) / self.step + 1)
    }

    /// Converts the index of a grid pixel to its position in the exemplar.
    fn grid_place(&self, pixel: usize) -> [i64; 2] {
        let [width, _] = self.grid();
        [pixel as i64 % width, pixel as i64 / width].map(|at| at * self.step)
    }

    /// For each grid pixel, finds the most similar other grid pixel at least [`apart`](Self::apart) steps away.
    fn search_alike(&mut self, wanted: &Wanted<'_>) -> Result<(), SynthError> {
        let [width, height] = self.grid();
        let n_pixels = (width * height) as usize;
        // Gather the features and guides of the usable pixels of the grid.
        let is_usable = |pixel: &usize| self.usable(self.grid_place(*pixel)).is_some();
        let pixels: Vec<usize> = (0..n_pixels).filter(is_usable).collect();
        let mut row_of = vec![NONE; n_pixels];
        for (row, &pixel) in pixels.iter().enumerate() {
            row_of[pixel] = row as u32;
        }
        let n_guides = self.guides.len() / (self.size[0] as usize * self.size[1] as usize);
        let values = parallel::map_at_least(64, pixels.len(), |row| {
            let [column, line] = self.grid_place(pixels[row]);
            let around = |[x, y]: [i64; 2]| [column + x * self.spacing, line + y * self.spacing];
            let pixel = (line * i64::from(self.size[0]) + column) as usize;
            let guides = &self.guides[pixel * n_guides..][..n_guides];
            compared(&DIAGONALS.map(|step| *self.features(around(step))), guides)
        });
        let dims = DIAGONALS.len() * N_FEATURES + n_guides;
        // Search for each pixel. Infinite factors exclude nearby pixels.
        let matcher = Matcher::with_factors(dims, &values.concat());
        let apart = self.apart();
        let found = parallel::map(pixels.len().div_ceil(PIXELS), |block| {
            let mut memory = MatcherMemory::default();
            let mut factors = vec![1.0; pixels.len()];
            let mut hint = None;
            let rows = block * PIXELS..pixels.len().min((block + 1) * PIXELS);
            let search = |row: usize| {
                if row.is_multiple_of(ASKED) && wanted.is_over() {
                    return None;
                }
                self.mark(&row_of, pixels[row], apart, f32::INFINITY, &mut factors);
                let query = Query {
                    values: &values[row],
                    below: f32::INFINITY,
                    hint,
                    factors: Some(&factors),
                };
                let found = matcher.find(query, &mut memory).map(|found| found.row);
                self.mark(&row_of, pixels[row], apart, 1.0, &mut factors);
                // Hint for the next pixel: its most similar pixel is often next to this result.
                hint = found.map(|row| row + 1);
                Some(found.map_or(NONE, |row| pixels[row as usize] as u32))
            };
            rows.map_while(search).collect::<Vec<u32>>()
        });
        // Store the results.
        wanted.check()?;
        self.similar = vec![NONE; row_of.len()];
        for (&pixel, found) in pixels.iter().zip(found.concat()) {
            self.similar[pixel] = found;
        }
        self.searched = (n_guides > 0).then_some(Grid { pixels, matcher });
        Ok(())
    }

    /// Returns the minimum distance between a pixel and its most similar pixel, in grid steps, up to rounding.
    pub(crate) fn apart(&self) -> i64 {
        let side = f64::from(self.size[0].min(self.size[1]));
        ((APART * side) as i64 / self.step).max(1)
    }

    /// Sets the factors of the grid pixels within a disk around the grid pixel `at`. `apart` is the radius of the disk
    /// in grid steps.
    fn mark(&self, row_of: &[u32], at: usize, apart: i64, factor: f32, factors: &mut [f32]) {
        let [width, height] = self.grid();
        let [column, line] = [at as i64 % width, at as i64 / width];
        for y in -apart..=apart {
            let line = i64::from(self.wrap.index(line + y, height as u32));
            for x in -apart..=apart {
                let column = i64::from(self.wrap.index(column + x, width as u32));
                let row = row_of[(line * width + column) as usize];
                if x * x + y * y <= apart * apart && row != NONE {
                    factors[row as usize] = factor;
                }
            }
        }
    }
}

/// Returns the vector that the matcher compares: the features on the four diagonals of a pixel, followed by its guides,
/// which count four times.
fn compared(around: &[[f32; N_FEATURES]; 4], guides: &[f32]) -> Vec<f32> {
    let mut values = around.as_flattened().to_vec();
    let root = (DIAGONALS.len() as f32).sqrt();
    values.extend(guides.iter().map(|guide| guide * root));
    values
}
