//! Interpolates the colors of all samples of a square, vectorized (equation 1 of Turk's paper).
//!
//! Input: positions and normals of the samples, and the sites within reach. Output: for each sample, the weighted mean
//! of the colors of the sites around it, and the site with the largest weight.
//!
//! The lanes of a register are samples of a row. For each row, sites are added in the order of [`NeighborhoodView`], so the order
//! of additions is the same at every SIMD level. Sites out of reach would only add zeros, and are skipped.

use super::lattice::{Lattice, Row};
use super::nearby::{NeighborhoodView, Record};
use crate::domain::{Colors, Samples};
use crate::sites::weights;
use core::array;
use core::ops::Range;
use dapple_raster::simd::dispatch;
use fearless_simd::{Level, f32x8, prelude::*, u32x8};

/// Minimum sum of weights; below it, only the nearest site is used.
const WEIGHT_MIN: f32 = 1e-4;
/// Minimum dot product for the same sheet: two unit vectors whose dot products with a third are at least this value are
/// at most a right angle apart. It is cos 45° plus a margin for rounding.
const SAME_SHEET: f32 = 0.7072;
/// Relative margin added to the reach of a site when rows are excluded; much larger than the rounding error.
const MARGIN: f32 = 1e-3;
/// Number of channels that are accumulated at once.
const CHANNELS: usize = 4;
/// Number of samples in a register.
const LANES: usize = 8;
/// Number of rows that most sites reach at most: rows are a spacing apart, and a site reaches 1.1 spacings in both
/// directions.
const USUAL_ROWS: usize = 3;

/// Scratch memory for interpolation, reusable for any number of squares.
#[derive(Debug, Default)]
pub(crate) struct Interpolation {
    /// Sites that reach at least one row, and their colors.
    reaching: Vec<Record>,
    colors: Vec<[f32; CHANNELS]>,
    bounds: Vec<Bounds>,
    /// For each row, the indices in `reaching` of the sites that reach it (`lists`), and the number of these sites
    /// (`lengths`).
    lists: Vec<u32>,
    lengths: Vec<[usize; LANES]>,
}

/// Bounds of eight rows: the range of positions down (index 0) and right (index 1) of the center within which a site
/// reaches each row.
#[derive(Clone, Copy, Debug)]
struct Bounds {
    least: [[f32; LANES]; 2],
    most: [[f32; LANES]; 2],
}

/// Input for the sums over a square.
struct Terms<'a> {
    lattice: &'a Lattice,
    around: NeighborhoodView<'a>,
    radius: f32,
}

/// Fills samples with the weighted means of the colors of the nearby sites.
pub(crate) fn interpolate(
    level: Level,
    lattice: &Lattice,
    around: NeighborhoodView<'_>,
    radius: f32,
    (colors, samples): (impl Colors, &mut Samples),
    memory: &mut Interpolation,
) {
    let terms = Terms {
        lattice,
        around,
        radius,
    };
    // Assign sites to rows.
    let n_channels = colors.n_channels();
    dispatch!(level, simd => list(simd, &terms, memory));
    // Compare normals only if a site may be on another sheet.
    let check = !is_one_sheet(lattice, &memory.reaching);
    // Accumulate four channels at a time.
    for first in (0..n_channels).step_by(CHANNELS) {
        let here = CHANNELS.min(n_channels - first);
        memory.colors.clear();
        memory.colors.extend(memory.reaching.iter().map(|record| {
            let values = &colors.of(record.site as usize)[first..first + here];
            array::from_fn(|channel| if channel < here { values[channel] } else { 0.0 })
        }));
        let channels = first..first + here;
        dispatch!(level, simd => add_up(simd, &terms, (memory, check), channels, colors, samples));
    }
}

/// Lists the sites that reach each row.
#[inline(always)]
fn list<S: Simd>(simd: S, terms: &Terms<'_>, memory: &mut Interpolation) {
    // Reset the lists.
    let axes = [terms.lattice.down, terms.lattice.right].map(|axis| axis.as_vec3().to_array());
    bound(simd, terms, axes, &mut memory.bounds);
    let n = terms.around.len();
    memory
        .lists
        .resize(memory.bounds.len() * LANES * (n + 1), 0);
    memory.lengths.clear();
    memory.lengths.resize(memory.bounds.len(), [0; LANES]);
    memory.reaching.resize(n + 1, Record::default());
    // Test each site against the bounds of eight rows at a time.
    let mut n_reaching = 0;
    for record in terms.around.sites() {
        let place = axes.map(|axis| f32x8::splat(simd, dot(record.position, axis)));
        memory.reaching[n_reaching] = record;
        let mut reaches = false;
        let lists = memory.lists.chunks_exact_mut(LANES * (n + 1));
        for ((bounds, lengths), lists) in memory.bounds.iter().zip(&mut memory.lengths).zip(lists) {
            let within = |axis: usize| {
                let [least, most] =
                    [bounds.least, bounds.most].map(|bound| f32x8::from_slice(simd, &bound[axis]));
                place[axis].simd_ge(least) & place[axis].simd_le(most)
            };
            let mut rows = (within(0) & within(1)).to_bitmask();
            reaches |= rows != 0;
            // Most sites reach two or three rows. Branches on their number would be mispredicted, so avoid them.
            for _ in 0..USUAL_ROWS {
                let row = rows.trailing_zeros() as usize % LANES;
                lists[row * (n + 1) + lengths[row]] = n_reaching as u32;
                lengths[row] += usize::from(rows != 0);
                rows &= rows.wrapping_sub(1);
            }
            while rows != 0 {
                let row = rows.trailing_zeros() as usize;
                lists[row * (n + 1) + lengths[row]] = n_reaching as u32;
                lengths[row] += 1;
                rows &= rows - 1;
            }
        }
        n_reaching += usize::from(reaches);
    }
    memory.reaching.truncate(n_reaching);
}

/// Computes, along two axes, the range of positions within which a site reaches each row.
#[inline(always)]
fn bound<S: Simd>(simd: S, terms: &Terms<'_>, axes: [[f32; 3]; 2], bounds: &mut Vec<Bounds>) {
    let reach = terms.radius * (1.0 + MARGIN);
    bounds.clear();
    for rows in terms.lattice.rows.chunks(LANES) {
        let (never, always) = (f32::INFINITY, f32::NEG_INFINITY);
        let mut here = Bounds {
            least: [[never; LANES]; 2],
            most: [[always; LANES]; 2],
        };
        for (at, row) in rows.iter().enumerate() {
            let [x, y, z] = [0, 1, 2].map(|part| f32x8::from_slice(simd, &row.lanes[part]));
            for (axis, [ax, ay, az]) in axes.into_iter().enumerate() {
                // Range of the samples of the row along the axis, extended by the reach of a site.
                let places: [f32; LANES] = (x * ax + y * ay + z * az).into();
                let (mut least, mut most) = (f32::INFINITY, f32::NEG_INFINITY);
                for &place in &places[..row.n_lanes] {
                    least = if place < least { place } else { least };
                    most = if place > most { place } else { most };
                }
                here.least[axis][at] = least - reach;
                here.most[axis][at] = most + reach;
            }
        }
        bounds.push(here);
    }
}

/// Interpolates up to [`CHANNELS`] channels of all samples.
#[inline(always)]
fn add_up<S: Simd>(
    simd: S,
    terms: &Terms<'_>,
    (memory, check): (&Interpolation, bool),
    channels: Range<usize>,
    colors: impl Colors,
    samples: &mut Samples,
) {
    let n_channels = colors.n_channels();
    let n = terms.around.len();
    let side = terms.lattice.side;
    let lengths = memory.lengths.as_flattened();
    for (at, row) in terms.lattice.rows.iter().enumerate() {
        let list = &memory.lists[at * (n + 1)..][..lengths[at]];
        let sites = (memory.reaching.as_slice(), memory.colors.as_slice());
        let sums = add_up_row(simd, row, (terms.radius, check), list, sites);
        for lane in 0..row.n_lanes {
            let sample = row.at * side + row.first_column + lane;
            let to = &mut samples.values[sample * n_channels..][channels.clone()];
            // Divide by the sum of weights. If there is almost none, take the nearest site.
            if sums.weights[lane] > WEIGHT_MIN {
                samples.nearest[sample] = memory.reaching[sums.nearest[lane] as usize].site;
                for (channel, value) in to.iter_mut().enumerate() {
                    *value = sums.values[channel][lane] / sums.weights[lane];
                }
            } else {
                let site = nearest(row, terms.around, lane);
                samples.nearest[sample] = site;
                to.copy_from_slice(&colors.of(site as usize)[channels.clone()]);
            }
        }
    }
}

/// Weights, weighted colors and nearest sites of a row.
struct Sums {
    weights: [f32; LANES],
    /// Index of the site with the largest weight; of equal weights, the first.
    nearest: [u32; LANES],
    values: [[f32; LANES]; CHANNELS],
}

/// Accumulates weights, weighted colors and the nearest sites over the sites that reach a row.
#[inline(always)]
fn add_up_row<S: Simd>(
    simd: S,
    row: &Row,
    (radius, check): (f32, bool),
    list: &[u32],
    (reaching, colors): (&[Record], &[[f32; CHANNELS]]),
) -> Sums {
    // Load positions and normals of the samples.
    let zero = f32x8::splat(simd, 0.0);
    let load = |part: usize| f32x8::from_slice(simd, &row.lanes[part]);
    let (x, y, z) = (load(0), load(1), load(2));
    let (nx, ny, nz) = (load(3), load(4), load(5));
    let inverse_sq = 1.0 / (radius * radius);
    let (mut sum, mut largest) = (zero, zero);
    let mut nearest = u32x8::splat(simd, 0);
    let [mut a, mut b, mut c, mut d] = [zero; CHANNELS];
    for &at in list {
        let record = &reaching[at as usize];
        let [px, py, pz] = record.position;
        let (dx, dy, dz) = (x - px, y - py, z - pz);
        // Weigh the site at all samples; a site on another sheet has weight 0.
        let mut weight = weights(simd, (dx * dx + dy * dy + dz * dz) * inverse_sq);
        if check {
            let [mx, my, mz] = record.normal;
            let opposed = (nx * mx + ny * my + nz * mz).simd_lt(0.0);
            weight = opposed.select(zero, weight);
        }
        // Accumulate.
        sum += weight;
        let is_larger = weight.simd_gt(largest);
        nearest = is_larger.select(u32x8::splat(simd, at), nearest);
        largest = is_larger.select(weight, largest);
        let [ca, cb, cc, cd] = colors[at as usize];
        a += weight * ca;
        b += weight * cb;
        c += weight * cc;
        d += weight * cd;
    }
    // Store the sums.
    let mut sums = Sums {
        weights: [0.0; LANES],
        nearest: [0; LANES],
        values: [[0.0; LANES]; CHANNELS],
    };
    sum.store_slice(&mut sums.weights);
    nearest.store_slice(&mut sums.nearest);
    for (value, values) in [a, b, c, d].into_iter().zip(&mut sums.values) {
        value.store_slice(values);
    }
    sums
}

/// Returns true if the normals of all sites and samples are guaranteed to be at most a right angle apart.
fn is_one_sheet(lattice: &Lattice, reaching: &[Record]) -> bool {
    let Some(middle) = reaching.first().map(|record| record.normal) else {
        return true;
    };
    let near = |normal: [f32; 3]| dot(normal, middle) >= SAME_SHEET;
    reaching.iter().all(|record| near(record.normal))
        && lattice.rows.iter().all(|row| {
            (0..row.n_lanes).all(|lane| near(array::from_fn(|part| row.lanes[3 + part][lane])))
        })
}

/// Returns the site nearest to a sample among those whose normals are not opposed to the sample's. If there are none,
/// returns the nearest of all sites.
#[cold]
fn nearest(row: &Row, around: NeighborhoodView<'_>, lane: usize) -> u32 {
    let sample: [f32; 3] = array::from_fn(|part| row.lanes[part][lane]);
    let normal: [f32; 3] = array::from_fn(|part| row.lanes[3 + part][lane]);
    let mut best = (true, f32::INFINITY, u32::MAX);
    for record in around.sites() {
        let from: [f32; 3] = array::from_fn(|part| record.position[part] - sample[part]);
        let found = (
            dot(record.normal, normal) < 0.0,
            dot(from, from),
            record.site,
        );
        if found < best {
            best = found;
        }
    }
    best.2
}

#[inline(always)]
fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
