//! Measures of Voronoi cells: the distance to the edge, the radius of the inscribed sphere, and smooth F1.
//!
//! Blender's Voronoi texture has the distance to the edge and the radius of the sphere, too; here they are exact. The
//! definition of smooth F1 is new, since the usual ones depend on the order of the points.

use crate::dispatch::DimensionDispatch as _;
use crate::fixed::{Place, STEP, STEPS};
use crate::search::{Hit, PointId, order};
use crate::{Dimensions, Metric, Space, Worley, WorleyError};

impl<const N: usize> Worley<N>
where
    Dimensions: Space<N>,
{
    /// Returns the distance from `position` to the nearest edge of its Voronoi cell, in cells; at least zero.
    ///
    /// The distance is Euclidean whatever the metric of the basis. It is the smallest distance to a bisecting plane
    /// between the nearest feature point and another point. Unlike F2 − F1, it has the same scale in wide and in narrow
    /// cells. NaN if the position is out of range; see [`sample`](Self::sample).
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/edge-distance.md"))]
    #[must_use]
    pub fn edge_distance(&self, position: impl Into<[f64; N]>) -> f32 {
        let place = Place::new(position.into());
        place.map_or(f32::NAN, |place| self.edge_distance_at(&place))
    }

    /// Returns the distance from `place` to the nearest edge of its Voronoi cell.
    pub(crate) fn edge_distance_at(&self, place: &Place<N>) -> f32 {
        let (metric, lattice) = (Metric::Euclidean, &self.lattice);
        let mut pair = [Hit::NONE; 2];
        Dimensions::nearest(metric, lattice, place, &mut pair);
        if pair[1].name.is_none() {
            return f32::INFINITY;
        }
        let [first, second] = pair.map(|hit| hit.vector.map(f64::from));
        // A point at distance d has its bisecting plane at least (d − F1) / 2 away.
        let reach = length(first) + 2.0 * to_plane(first, second);
        // Take the nearest plane of all points within this distance.
        let hits = Dimensions::within(metric, lattice, place, (reach * 1.000_001) as f32);
        let mut all: Vec<_> = hits.iter().map(|hit| hit.vector.map(f64::from)).collect();
        if let Some(own) = all.iter().position(|&vector| vector == first) {
            all.swap_remove(own);
        }
        let planes = all.into_iter().map(|other| to_plane(first, other));
        planes.fold(to_plane(first, second), f64::min).max(0.0) as f32
    }

    /// Returns the radius, in cells, of the largest sphere around the nearest feature point that is inside its Voronoi
    /// cell. This is half of the distance from that point to its own nearest neighbor, in the metric of the basis.
    ///
    /// NaN if the position is out of range; see [`sample`](Self::sample).
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/sphere-radius.md"))]
    #[must_use]
    pub fn sphere_radius(&self, position: impl Into<[f64; N]>) -> f32 {
        let Some(place) = Place::new(position.into()) else {
            return f32::NAN;
        };
        let [hit] = self.hits::<1>(&place);
        if hit.name.is_none() {
            return f32::INFINITY;
        }
        // Search again from the feature point, whose nearest point is itself.
        let mut point = place;
        for axis in 0..N {
            let steps = i64::from(place.steps[axis]) - i64::from((hit.vector[axis] / STEP) as i32);
            point.cell[axis] += steps.div_euclid(i64::from(STEPS));
            point.steps[axis] = steps.rem_euclid(i64::from(STEPS)) as i32;
        }
        let [_, neighbor] = self.distances::<2>(&point);
        0.5 * neighbor
    }

    /// Returns F1 without creases, in cells. Neighboring cells are blended within the distance `radius`.
    ///
    /// The value is the solution `s` of `Σ max(0, 1 + (s − d) / radius)³ = 1`, summed over the distances `d` of all
    /// feature points. It is between F1 − `radius` and F1. It equals F1 where no second point has a distance below F1 +
    /// `radius`. It has two continuous derivatives wherever the distances have. Only points nearer than F1 + `radius`
    /// contribute; they are summed in the order of their distances and ids. NaN if the position is out of range; see
    /// [`sample`](Self::sample).
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/smooth-f1.md"))]
    ///
    /// # Errors
    ///
    /// [`Range`](crate::WorleyErrorKind::Range) if the radius is not above 0 and at most 4.
    pub fn smooth_f1(
        &self,
        position: impl Into<[f64; N]>,
        radius: f32,
    ) -> Result<f32, WorleyError> {
        let holds = radius > 0.0 && radius <= 4.0 && radius.recip().is_finite();
        WorleyError::check(
            holds,
            "radius of the smooth F1",
            f64::from(radius),
            "above 0, at most 4",
        )?;
        let Some(place) = Place::new(position.into()) else {
            return Ok(f32::NAN);
        };
        let [first] = self.distances::<1>(&place);
        if first == f32::INFINITY {
            return Ok(first);
        }
        // Points farther away contribute nothing; the margin covers the rounding of distances.
        let reach = (first + radius) * 1.000_01;
        let mut hits = Dimensions::within(self.metric, &self.lattice, &place, reach);
        hits.sort_by(|a, b| order(a, b, PointId::id));
        let distances = hits
            .iter()
            .map(|hit| f64::from(self.feature(*hit).distance));
        Ok(smooth_minimum(&distances.collect::<Vec<_>>(), f64::from(radius)) as f32)
    }
}

/// Solves the equation of [`Worley::smooth_f1`] by Newton's method.
///
/// The sum is convex, increases with `s`, and is at least 1 at the smallest distance. So Newton's steps from there
/// decrease `s` and never go beyond the solution.
fn smooth_minimum(distances: &[f64], radius: f64) -> f64 {
    let mut s = distances.first().copied().unwrap_or(f64::INFINITY);
    for _ in 0..64 {
        let [mut sum, mut slope] = [0.0; 2];
        for distance in distances {
            // Points farther away than s + radius contribute nothing to the sum and its derivative.
            let part = (1.0 + (s - distance) / radius).max(0.0);
            sum += part * part * part;
            slope += 3.0 * part * part / radius;
        }
        let next = s - (sum - 1.0) / slope;
        // The comparison is false for NaN, which ends the loop, too.
        if next < s {
            s = next;
        } else {
            break;
        }
    }
    s
}

/// Returns the signed distance of a position from the bisecting plane of two points, given the vectors from the points
/// to the position.
fn to_plane<const N: usize>(first: [f64; N], other: [f64; N]) -> f64 {
    let between: [f64; N] = core::array::from_fn(|axis| first[axis] - other[axis]);
    let [near, far] = [first, other].map(|way| dot(way, way));
    let apart = length(between);
    // Coinciding points have no plane; every position counts as on their edge.
    if apart > 0.0 {
        (far - near) / (2.0 * apart)
    } else {
        0.0
    }
}

fn length<const N: usize>(vector: [f64; N]) -> f64 {
    libm::sqrt(dot(vector, vector))
}

fn dot<const N: usize>(a: [f64; N], b: [f64; N]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
