//! One spot of a giraffe: pairs of points around a center, and polygons that contain the supports of its points.
//!
//! Positions are relative to the center, in units of the domain.

use super::{SpaceGiraffeOptions, Spots};
use core::f64::consts::TAU;
use dapple_graph::Axis;
use dapple_hash::{CellHash, Seed, unit_f64};
use dapple_points::PointIdx;
use glam::DVec2;

/// Minimum distance of a point from the center, from the rim, and from the other point of its pair, as a fraction of
/// the spot's radius.
const GAP: f64 = 1.0 / 256.0;

/// Scale of a spot relative to the maximum scale that fits, as a margin for rounding.
const SLACK: f64 = 1.0 - 1e-6;

/// A giraffe's spot: the pairs of points around a center.
#[derive(Clone, Debug)]
pub(super) struct Spot {
    /// Half the distance to the nearest other center.
    pub(super) radius: f64,
    /// Inner and outer point of each pair, relative to the center.
    pub(super) pairs: Vec<[DVec2; 2]>,
}

impl Spot {
    /// Draws the pairs of points around a center at random. The spot is not yet fitted into the center's Voronoi cell.
    pub(super) fn random(
        radius: f64,
        options: &SpaceGiraffeOptions,
        seed: Seed,
        center: PointIdx,
    ) -> Self {
        let random = CellHash::new(seed, [i64::from(center.0)]);
        let [least, most] = options.pairs;
        // Draw the number of pairs, uniformly from the range.
        let more = (random.at(0) >> 32) * u64::from(most - least + 1);
        let n_pairs = least + (more >> 32) as u32;
        // Draw the first angle, as a fraction of the interval between two pairs.
        let first = unit_f64(random.at(1));
        // Draw two radii for each pair, as fractions of the spot's radius.
        let draw = |index: u32| [2, 3].map(|lane| unit_f64(random.at(2 * index + lane)));
        let radii: Vec<[f64; 2]> = match options.spots {
            Spots::Literal => (0..n_pairs).map(|index| sorted(draw(index))).collect(),
            Spots::Separated => {
                // The square root makes points uniform over the area of the disk.
                let even = (0..n_pairs).map(|index| sorted(draw(index).map(f64::sqrt)));
                filled(&smoothed(&even.collect::<Vec<_>>()))
            }
        };
        // Place the pairs around the center, at equal angular intervals.
        let place = |(index, pair): (u32, &[f64; 2])| {
            let angle = TAU * (f64::from(index) + first) / f64::from(n_pairs);
            let direction = DVec2::new(libm::cos(angle), libm::sin(angle)) * radius;
            pair.map(|part| direction * part)
        };
        Self {
            radius,
            pairs: (0..).zip(&radii).map(place).collect(),
        }
    }

    /// Scales the spot down, if needed, until the supports of its points are inside the center's Voronoi cell. `axes`
    /// are the center's Delaunay axes.
    pub(super) fn fitted(mut self, axes: &[Axis], axis_scale: f64) -> Self {
        let room = self.room(axes, axis_scale);
        if room < 1.0 {
            let scale = room * SLACK;
            for pair in &mut self.pairs {
                *pair = pair.map(|point| point * scale);
            }
        }
        self
    }

    /// Returns the maximum scale at which the spot fits, at most 1.
    pub(super) fn room(&self, axes: &[Axis], axis_scale: f64) -> f64 {
        // The center's Voronoi cell is d·v ≤ ½ |v|² for every axis v. Find the largest scale that fits a corner in it.
        let room_for = |corner: DVec2| {
            let along = |axis: &Axis| {
                let reach = corner.dot(axis.vector);
                let half = 0.5 * axis.vector.length_squared();
                if reach > half { half / reach } else { 1.0 }
            };
            axes.iter().map(along).fold(1.0, f64::min)
        };
        // Apply this to all corners of the supports of the center and the inner points.
        let inner = self.pairs.iter().map(|&[inner, _]| inner);
        core::iter::once(DVec2::ZERO)
            .chain(inner)
            .flat_map(|point| self.support(point, axis_scale))
            .map(room_for)
            .fold(1.0, f64::min)
    }

    /// Returns the corners of the polygon that would be a point's support if only the points of this spot existed.
    fn support(&self, point: DVec2, axis_scale: f64) -> Vec<DVec2> {
        // Outer points are on all sides, so the support ends long before this square.
        let far = self.radius * 1e12;
        let mut corners = [(-far, -far), (far, -far), (far, far), (-far, far)]
            .map(DVec2::from)
            .to_vec();
        // Clip by the border of each axis v from the point: (x − point)·v ≤ s |v|².
        let others = core::iter::once(&DVec2::ZERO).chain(self.pairs.as_flattened());
        for axis in others.map(|&other| other - point) {
            if axis != DVec2::ZERO {
                let limit = (point.dot(axis)) + axis_scale * axis.length_squared();
                corners = clipped(&corners, axis, limit);
            }
        }
        corners
    }
}

/// Converts two random numbers from 0 to 1 to the inner and the outer radius of a pair, as fractions of the spot's
/// radius. Both have a gap to the center, to the rim and to each other.
fn sorted(parts: [f64; 2]) -> [f64; 2] {
    // Leave a gap to the center and to the rim.
    let [a, b] = parts.map(|part| GAP + (1.0 - 2.0 * GAP) * part);
    // Leave a gap between both radii.
    let outer = a.max(b).max(2.0 * GAP);
    let inner = a.min(b).min(outer - GAP);
    [inner, outer]
}

/// Smooths radii around a spot. Each becomes the weighted mean of its neighbors within a fifth of a turn on either
/// side. Weights decrease linearly. Inner points remain inside of outer ones.
fn smoothed(radii: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let n_pairs = radii.len();
    // Half-width of the window. Its weights rise and fall linearly, and their sum is the square of the half-width.
    let reach = (n_pairs / 5).max(3);
    let total = (reach * reach) as f64;
    let mean = |at: usize| {
        let mut sum = [0.0; 2];
        // Sum the neighbors on the circle, from one side to the other.
        for tap in 1..2 * reach {
            let weight = tap.min(2 * reach - tap) as f64;
            let [inner, outer] = radii[(at + reach * n_pairs + tap - reach) % n_pairs];
            sum = [sum[0] + weight * inner, sum[1] + weight * outer];
        }
        sum.map(|sum| sum / total)
    };
    (0..n_pairs).map(mean).collect()
}

/// Scales the radii so that the outermost point is at the rim.
fn filled(radii: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let outermost = radii.iter().map(|&[_, outer]| outer).fold(0.0, f64::max);
    let scale = (1.0 - GAP) / outermost;
    radii
        .iter()
        .map(|pair| pair.map(|part| part * scale))
        .collect()
}

/// Clips a convex polygon to the half-plane `normal · position ≤ limit`.
fn clipped(corners: &[DVec2], normal: DVec2, limit: f64) -> Vec<DVec2> {
    let mut kept = Vec::with_capacity(corners.len() + 1);
    for (index, &from) in corners.iter().enumerate() {
        let to = corners[(index + 1) % corners.len()];
        // Signed distances beyond the border, multiplied by the normal's length.
        let [over_from, over_to] = [from, to].map(|corner| normal.dot(corner) - limit);
        if over_from <= 0.0 {
            kept.push(from);
        }
        if (over_from <= 0.0) != (over_to <= 0.0) {
            kept.push(from + (to - from) * (over_from / (over_from - over_to)));
        }
    }
    kept
}
