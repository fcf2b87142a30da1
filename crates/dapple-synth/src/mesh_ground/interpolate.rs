//! Equation 1 for all samples of a square at once.
//!
//! The lanes of a register are samples of a row. A row takes the sites that can reach it, one after the other in the order of
//! [`Nearby`], so that sums have one order at every SIMD level.

use super::lattice::{Lattice, Row};
use super::nearby::{Nearby, Record};
use crate::ground::{Colors, Samples};
use core::array;
use core::ops::Range;
use fearless_simd::{Level, dispatch, f32x8, prelude::*, u32x8};

/// Below this sum of weights the nearest site counts alone.
const WEIGHT_MIN: f32 = 1e-4;
/// Two unit vectors that have at least this product with a third one are at most a right angle apart; with a margin for
/// rounding.
const SAME_SHEET: f32 = 0.7072;
/// What is added to the reach of a site before rows are left out, as a part of the radius: far more than rounding.
const MARGIN: f32 = 1e-3;
/// The channels that are added up at once.
const CHANNELS: usize = 4;
/// The samples in a register.
const LANES: usize = 8;

/// What interpolation works in.
#[derive(Debug, Default)]
pub(crate) struct Interpolation {
    /// The values of the nearby sites.
    colors: Vec<[f32; CHANNELS]>,
    /// For each row the sites that can reach it, and their number.
    lists: Vec<u32>,
    lengths: Vec<usize>,
}

/// Everything that the sums of a square are made of.
struct Terms<'a> {
    lattice: &'a Lattice,
    nearby: &'a [Record],
    radius: f32,
    /// Whether normals have to be compared.
    check: bool,
}

/// Fills samples with means of the colors of the nearby sites.
pub(crate) fn interpolate(
    level: Level,
    lattice: &Lattice,
    nearby: &Nearby,
    radius: f32,
    (colors, samples): (impl Colors, &mut Samples),
    memory: &mut Interpolation,
) {
    let terms = Terms {
        lattice,
        nearby: &nearby.records,
        radius,
        check: !is_one_sheet(lattice, &nearby.records),
    };
    let n_channels = colors.n_channels();
    dispatch!(level, simd => list(simd, &terms, memory));
    for first in (0..n_channels).step_by(CHANNELS) {
        let here = CHANNELS.min(n_channels - first);
        memory.colors.clear();
        memory.colors.extend(terms.nearby.iter().map(|record| {
            let values = &colors.of(record.site as usize)[first..first + here];
            array::from_fn(|channel| if channel < here { values[channel] } else { 0.0 })
        }));
        let channels = first..first + here;
        dispatch!(level, simd => add_up(simd, &terms, memory, channels, colors, samples));
    }
}

/// Lists the sites that can reach each row.
#[inline(always)]
fn list<S: Simd>(simd: S, terms: &Terms<'_>, memory: &mut Interpolation) {
    let _ = simd;
    let down = terms.lattice.down.as_vec3().to_array();
    let n = terms.nearby.len();
    memory.lists.resize(terms.lattice.rows.len() * n, 0);
    memory.lengths.clear();
    let reach = terms.radius * (1.0 + MARGIN);
    for (row, list) in terms
        .lattice
        .rows
        .iter()
        .zip(memory.lists.chunks_exact_mut(n))
    {
        let (mut least, mut most) = (f32::INFINITY, f32::NEG_INFINITY);
        for lane in 0..row.n_lanes {
            let depth = dot(array::from_fn(|part| row.lanes[part][lane]), down);
            least = if depth < least { depth } else { least };
            most = if depth > most { depth } else { most };
        }
        let (least, most) = (least - reach, most + reach);
        let mut length = 0;
        for (record, at) in terms.nearby.iter().zip(0..) {
            let depth = dot(record.position, down);
            list[length] = at;
            length += usize::from(depth >= least && depth <= most);
        }
        memory.lengths.push(length);
    }
}

/// Adds up weights and weighted values of some channels.
#[inline(always)]
fn add_up<S: Simd>(
    simd: S,
    terms: &Terms<'_>,
    memory: &Interpolation,
    channels: Range<usize>,
    colors: impl Colors,
    samples: &mut Samples,
) {
    let n_channels = colors.n_channels();
    let n = terms.nearby.len();
    let side = terms.lattice.side;
    for (at, row) in terms.lattice.rows.iter().enumerate() {
        let list = &memory.lists[at * n..][..memory.lengths[at]];
        let sums = add_up_row(simd, terms, row, list, &memory.colors);
        for lane in 0..row.n_lanes {
            let sample = row.at * side + row.first_column + lane;
            let to = &mut samples.values[sample * n_channels..][channels.clone()];
            if sums.weights[lane] > WEIGHT_MIN {
                samples.nearest[sample] = terms.nearby[sums.nearest[lane] as usize].site;
                for (channel, value) in to.iter_mut().enumerate() {
                    *value = sums.values[channel][lane] / sums.weights[lane];
                }
            } else {
                let site = nearest(row, terms.nearby, lane);
                samples.nearest[sample] = site;
                to.copy_from_slice(&colors.of(site as usize)[channels.clone()]);
            }
        }
    }
}

/// The sums of a row.
struct Sums {
    weights: [f32; LANES],
    /// Which site has the largest weight, the first of several.
    nearest: [u32; LANES],
    values: [[f32; LANES]; CHANNELS],
}

#[inline(always)]
fn add_up_row<S: Simd>(
    simd: S,
    terms: &Terms<'_>,
    row: &Row,
    list: &[u32],
    colors: &[[f32; CHANNELS]],
) -> Sums {
    let zero = f32x8::splat(simd, 0.0);
    let load = |part: usize| f32x8::from_slice(simd, &row.lanes[part]);
    let (x, y, z) = (load(0), load(1), load(2));
    let (nx, ny, nz) = (load(3), load(4), load(5));
    let inverse_sq = 1.0 / (terms.radius * terms.radius);
    let (mut sum, mut largest) = (zero, zero);
    let mut nearest = u32x8::splat(simd, 0);
    let [mut a, mut b, mut c, mut d] = [zero; CHANNELS];
    for &at in list {
        let record = &terms.nearby[at as usize];
        let [px, py, pz] = record.position;
        let (dx, dy, dz) = (x - px, y - py, z - pz);
        // w(x) = 2x³ − 3x² + 1, of distances in radii.
        let part_sq = (dx * dx + dy * dy + dz * dz) * inverse_sq;
        let weight = (part_sq.sqrt() * 2.0 - 3.0) * part_sq + 1.0;
        let mut weight = part_sq.simd_lt(1.0).select(weight, zero);
        if terms.check {
            let [mx, my, mz] = record.normal;
            let opposed = (nx * mx + ny * my + nz * mz).simd_lt(0.0);
            weight = opposed.select(zero, weight);
        }
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

/// Whether no site can have a normal that is more than a right angle from a sample's.
fn is_one_sheet(lattice: &Lattice, nearby: &[Record]) -> bool {
    let Some(middle) = nearby.first().map(|record| record.normal) else {
        return true;
    };
    let near = |normal: [f32; 3]| dot(normal, middle) >= SAME_SHEET;
    nearby.iter().all(|record| near(record.normal))
        && lattice.rows.iter().all(|row| {
            (0..row.n_lanes).all(|lane| near(array::from_fn(|part| row.lanes[3 + part][lane])))
        })
}

/// The site nearest to a sample among those whose normals are not opposed; without any, the nearest of all.
#[cold]
fn nearest(row: &Row, nearby: &[Record], lane: usize) -> u32 {
    let sample: [f32; 3] = array::from_fn(|part| row.lanes[part][lane]);
    let normal: [f32; 3] = array::from_fn(|part| row.lanes[3 + part][lane]);
    let mut best = (true, f32::INFINITY, u32::MAX);
    for record in nearby {
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
