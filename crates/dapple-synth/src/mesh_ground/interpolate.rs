//! Equation 1 for all samples of a square at once.
//!
//! Sites are taken one after the other, in the order in which the grid gives them, and add to the samples of the rows that
//! they can reach; the lanes of a register are the samples of a row.

use super::lattice::Lattice;
use crate::ground::Samples;
use core::array;
use dapple_mesh::{Level, SiteIdx, Sites};
use fearless_simd::dispatch;
use glam::DVec3;

/// Below this sum of weights the nearest site counts alone.
const WEIGHT_MIN: f32 = 1e-4;
/// Two unit vectors that have at least this product with a third one have a product of at least zero; with a margin for
/// rounding.
const SAME_SHEET: f32 = 0.7072;
/// What is added to the reach of a site before rows are left out, as a part of the radius: far more than rounding, and
/// a weight is zero there.
const MARGIN: f32 = 1e-3;

/// The sites near a square, relative to the site in its middle.
#[derive(Debug, Default)]
pub(crate) struct Nearby {
    sites: Vec<u32>,
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
}

impl Nearby {
    /// Takes the sites of a level in a ball; if there are none, in the next larger one of twice the radius that has some.
    pub(crate) fn collect(&mut self, sites: &Sites, level: &Level, center: DVec3, radius: f64) {
        self.sites.clear();
        self.positions.clear();
        self.normals.clear();
        let mut radius = radius;
        // A small piece of the surface may have no site of a coarse level, and then takes those of its neighbors.
        while self.sites.is_empty() && radius.is_finite() {
            self.collect_ball(sites, level, center, radius);
            radius *= 2.0;
        }
    }

    #[inline(always)]
    fn collect_ball(&mut self, sites: &Sites, level: &Level, center: DVec3, radius: f64) {
        let radius_sq = radius * radius;
        level.grid().visit(center, radius, |SiteIdx(site)| {
            let from = sites.positions()[site as usize] - center;
            if from.length_squared() < radius_sq {
                self.sites.push(site);
                self.positions.push(from.as_vec3().to_array());
                self.normals
                    .push(sites.normals()[site as usize].as_vec3().to_array());
            }
        });
    }
}

/// What is added up for the samples of a row: weights, the largest one and whose it was.
#[derive(Clone, Copy, Debug)]
struct Sums<const N: usize> {
    weights: [f32; N],
    largest: [f32; N],
    nearest: [u32; N],
}

/// The most channels that are added up at once.
const CHANNELS: usize = 4;

/// Fills samples; `column` has as many values for a site as `samples.values` has room for at a sample.
pub(crate) fn interpolate<const N: usize>(
    level: fearless_simd::Level,
    lattice: &Lattice<N>,
    nearby: &Nearby,
    radius: f32,
    column: &[f32],
    samples: &mut Samples,
) {
    let n_channels = samples.values.len() / (lattice.side * lattice.side);
    for first in (0..n_channels).step_by(CHANNELS) {
        let channels = [first, n_channels];
        dispatch!(level, simd => {
            let _ = simd;
            add_up(lattice, nearby, radius, column, channels, samples);
        });
    }
}

#[inline(always)]
fn add_up<const N: usize>(
    lattice: &Lattice<N>,
    nearby: &Nearby,
    radius: f32,
    column: &[f32],
    [first, n_channels]: [usize; 2],
    samples: &mut Samples,
) {
    let down = lattice.down.as_vec3().to_array();
    let bands = bands(lattice, down, radius);
    let check = !is_one_sheet(lattice, nearby);
    let here = CHANNELS.min(n_channels - first);
    let inverse_sq = 1.0 / (radius * radius);
    let mut sums = [Sums {
        weights: [0.0; N],
        largest: [0.0; N],
        nearest: [u32::MAX; N],
    }; N];
    let mut values = [[[0.0_f32; N]; CHANNELS]; N];
    for (at, &site) in nearby.sites.iter().enumerate() {
        let position = nearby.positions[at];
        let depth = dot(position, down);
        let mut color = [0.0_f32; CHANNELS];
        let from = site as usize * n_channels + first;
        color[..here].copy_from_slice(&column[from..from + here]);
        for row in 0..lattice.n_rows {
            if depth < bands[row][0] || depth > bands[row][1] {
                continue;
            }
            let lanes = &lattice.rows[row];
            let mut weights = weights(lanes, position, inverse_sq);
            if check {
                let normal = nearby.normals[at];
                for lane in 0..N {
                    let normals = [lanes[3][lane], lanes[4][lane], lanes[5][lane]];
                    let opposed = dot(normal, normals) < 0.0;
                    weights[lane] = if opposed { 0.0 } else { weights[lane] };
                }
            }
            let sum = &mut sums[row];
            for lane in 0..N {
                let weight = weights[lane];
                sum.weights[lane] += weight;
                let larger = weight > sum.largest[lane];
                sum.nearest[lane] = if larger { site } else { sum.nearest[lane] };
                sum.largest[lane] = if larger { weight } else { sum.largest[lane] };
            }
            for (channel, color) in values[row].iter_mut().zip(color) {
                for lane in 0..N {
                    channel[lane] += weights[lane] * color;
                }
            }
        }
    }
    for row in 0..lattice.n_rows {
        for lane in 0..lattice.side {
            let sample = row * lattice.side + lane;
            let to = sample * n_channels + first;
            let sum = sums[row].weights[lane];
            if sum > WEIGHT_MIN {
                samples.nearest[sample] = sums[row].nearest[lane];
                for channel in 0..here {
                    samples.values[to + channel] = values[row][channel][lane] / sum;
                }
            } else {
                let site = nearest(lattice, nearby, row, lane);
                samples.nearest[sample] = site;
                let from = site as usize * n_channels + first;
                samples.values[to..to + here].copy_from_slice(&column[from..from + here]);
            }
        }
    }
}

/// `w(x) = 2x³ − 3x² + 1` of the distances of a position to the samples of a row in radii; 0 beyond.
#[inline(always)]
fn weights<const N: usize>(lanes: &[[f32; N]; 6], position: [f32; 3], inverse_sq: f32) -> [f32; N] {
    let mut weights = [0.0; N];
    for lane in 0..N {
        let x = lanes[0][lane] - position[0];
        let y = lanes[1][lane] - position[1];
        let z = lanes[2][lane] - position[2];
        let part_sq = (x * x + y * y + z * z) * inverse_sq;
        let weight = (2.0 * part_sq.sqrt() - 3.0) * part_sq + 1.0;
        weights[lane] = if part_sq < 1.0 { weight } else { 0.0 };
    }
    weights
}

/// Between which depths sites reach a row, along the direction that rows follow each other in.
#[inline(always)]
fn bands<const N: usize>(lattice: &Lattice<N>, down: [f32; 3], radius: f32) -> [[f32; 2]; N] {
    let reach = radius * (1.0 + MARGIN);
    let mut bands = [[f32::INFINITY, f32::NEG_INFINITY]; N];
    for (band, lanes) in bands.iter_mut().zip(&lattice.rows).take(lattice.n_rows) {
        for lane in 0..lattice.side {
            let depth = dot([lanes[0][lane], lanes[1][lane], lanes[2][lane]], down);
            band[0] = if depth - reach < band[0] {
                depth - reach
            } else {
                band[0]
            };
            band[1] = if depth + reach > band[1] {
                depth + reach
            } else {
                band[1]
            };
        }
    }
    bands
}

/// Whether no site can have a normal that is more than a right angle from a sample's.
#[inline(always)]
fn is_one_sheet<const N: usize>(lattice: &Lattice<N>, nearby: &Nearby) -> bool {
    let Some(&middle) = nearby.normals.first() else {
        return true;
    };
    let near = |normal: &[f32; 3]| dot(*normal, middle) >= SAME_SHEET;
    nearby.normals.iter().all(near)
        && lattice.rows[..lattice.n_rows].iter().all(|lanes| {
            (0..lattice.side).all(|lane| near(&[lanes[3][lane], lanes[4][lane], lanes[5][lane]]))
        })
}

/// The site nearest to a sample among those whose normals are not opposed; without any, the nearest of all.
#[cold]
fn nearest<const N: usize>(lattice: &Lattice<N>, nearby: &Nearby, row: usize, lane: usize) -> u32 {
    let lanes = &lattice.rows[row];
    let sample: [f32; 3] = array::from_fn(|part| lanes[part][lane]);
    let normal: [f32; 3] = array::from_fn(|part| lanes[3 + part][lane]);
    let mut best = (true, f32::INFINITY, u32::MAX);
    for (at, &site) in nearby.sites.iter().enumerate() {
        let from: [f32; 3] = array::from_fn(|part| nearby.positions[at][part] - sample[part]);
        let found = (dot(nearby.normals[at], normal) < 0.0, dot(from, from), site);
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
