//! Finds the sites within reach of texels, for all texels of a face at once.

use crate::bake::Group;
use crate::mesh_domain::{NeighborhoodView, Record};
use crate::sites::weights;
use dapple_raster::simd::dispatch;
use fearless_simd::{Level, f32x8, prelude::*};
use glam::Vec3;

/// Number of sites per SIMD register.
const LANES: usize = 8;

/// Maximum number of sites per point; those with the largest weights are retained. About ten sites of one sheet are
/// within reach of a point. Where many sheets cross there can be thousands, and ranking takes time proportional to the
/// square of their number.
const MOST: usize = 64;

/// A site within reach of a point.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Reaching {
    pub(super) site: u32,
    /// Offset from the site to the point.
    pub(super) way: Vec3,
    pub(super) weight: f32,
}

/// For each point of a group, the sites within reach on the same sheet, in order of decreasing weight; sites of equal
/// weight are in the order of the group. If there are none, the nearest site, on the same sheet if possible.
#[derive(Debug, Default)]
pub(super) struct Reach {
    /// Points and their smooth normals. Points are relative to the center of the group.
    points: Vec<[Vec3; 2]>,
    sites: Vec<u32>,
    /// Coordinates of the sites' positions and normals, padded to a multiple of [`LANES`].
    columns: [Vec<f32>; 6],
    found: Found,
    /// Sites within reach of all points, point by point.
    reaching: Vec<Reaching>,
    /// For each point, the end of its range in `reaching`.
    ends: Vec<usize>,
}

/// Sites within reach of one point, in the order of the group, padded to a multiple of [`LANES`].
#[derive(Debug, Default)]
struct Found {
    numbers: Vec<u32>,
    weights: Vec<f32>,
}

/// A slab that contains all positions within reach of the points of a face: the space between two planes parallel to
/// the face.
///
/// Sites are collected from a ball around the points. Where sheets cross, most of those sites are above or below the
/// slab.
#[derive(Clone, Copy, Debug)]
struct Slab {
    normal: Vec3,
    low: f32,
    high: f32,
}

impl Slab {
    fn around(points: &[[Vec3; 2]], normal: Vec3, radius: f32) -> Self {
        let heights = || points.iter().map(|[at, _]| at.dot(normal));
        let far = points
            .iter()
            .map(|[at, _]| at.length())
            .fold(radius, f32::max);
        // Margin for the rounding of coordinates, of the normal and of products: a few times 2^-24 of the largest
        // coordinate.
        let reach = radius + 1e-5 * far;
        Self {
            normal,
            low: heights().fold(f32::INFINITY, f32::min) - reach,
            high: heights().fold(f32::NEG_INFINITY, f32::max) + reach,
        }
    }

    fn holds(&self, position: [f32; 3]) -> bool {
        let height = Vec3::from(position).dot(self.normal);
        // The negation makes a NaN normal contain everything.
        !(height < self.low || height > self.high)
    }
}

impl Reach {
    /// Finds the sites of a group within `radius` of each of its points.
    pub(super) fn find(&mut self, level: Level, group: &Group<'_>, radius: f32) {
        self.points.clear();
        self.points.extend(group.points.iter().map(|&point| {
            let at = group.surface.position(point) - group.center;
            [at, group.surface.normal(point)].map(|vector| vector.as_vec3())
        }));
        self.sites.clear();
        self.columns.iter_mut().for_each(Vec::clear);
        // Collect the sites in the slab as columns of coordinates.
        let face_normal = group.surface.face_normal(group.face).as_vec3();
        let slab = Slab::around(&self.points, face_normal, radius);
        for record in group.sites.sites() {
            if !slab.holds(record.position) {
                continue;
            }
            self.sites.push(record.site);
            let parts = record.position.into_iter().chain(record.normal);
            for (column, part) in self.columns.iter_mut().zip(parts) {
                column.push(part);
            }
        }
        let n_slots = self.sites.len().next_multiple_of(LANES);
        for column in &mut self.columns {
            // Pad with positions out of reach.
            column.resize(n_slots, f32::MAX);
        }
        self.found.numbers.resize(n_slots, 0);
        self.found.weights.resize(n_slots, 0.0);
        self.reaching.clear();
        self.ends.clear();
        dispatch!(level, simd => self.list(simd, radius, group.sites));
    }

    /// Returns the sites within reach of each point, in the order of the points.
    pub(super) fn of_points(&self) -> impl Iterator<Item = &[Reaching]> {
        let starts = core::iter::once(0).chain(self.ends.iter().copied());
        starts
            .zip(&self.ends)
            .map(|(start, &end)| &self.reaching[start..end])
    }

    #[inline(always)]
    fn list<S: Simd>(&mut self, simd: S, radius: f32, around: NeighborhoodView<'_>) {
        for &[at, normal] in &self.points {
            let n_found = self.found.search(simd, &self.columns, [at, normal], radius);
            let n_found = self.found.keep_largest(n_found);
            let reaching = |number: usize, weight| {
                let position = [0, 1, 2].map(|part| self.columns[part][number]);
                Reaching {
                    site: self.sites[number],
                    way: at - Vec3::from(position),
                    weight,
                }
            };
            let start = self.reaching.len();
            self.reaching.resize(start + n_found, Reaching::default());
            // Write the sites in order of decreasing weight.
            for found in 0..n_found {
                let rank = self.found.rank(simd, found, n_found);
                let number = self.found.numbers[found] as usize;
                self.reaching[start + rank] = reaching(number, self.found.weights[found]);
            }
            if n_found == 0 {
                self.reaching.extend(nearest([at, normal], around));
            }
            self.ends.push(self.reaching.len());
        }
    }
}

impl Found {
    /// Finds the sites within a radius of a point, and returns their number.
    #[inline(always)]
    fn search<S: Simd>(
        &mut self,
        simd: S,
        columns: &[Vec<f32>; 6],
        [at, normal]: [Vec3; 2],
        radius: f32,
    ) -> usize {
        let inverse_sq = 1.0 / (radius * radius);
        let mut n_found = 0;
        for first in (0..columns[0].len()).step_by(LANES) {
            let [x, y, z, nx, ny, nz] = columns
                .each_ref()
                .map(|column| f32x8::from_slice(simd, &column[first..first + LANES]));
            let [x, y, z] = [x - at.x, y - at.y, z - at.z];
            let weight = weights(simd, (x * x + y * y + z * z) * inverse_sq);
            let along = nx * normal.x + ny * normal.y + nz * normal.z;
            // A site is within reach if its weight is positive and its normal is not opposed (the same sheet).
            let reaches = (weight.simd_gt(0.0) & along.simd_ge(0.0)).to_bitmask();
            let weight: [f32; LANES] = weight.into();
            // Compact without branches, because the lanes within reach are unpredictable.
            for (lane, weight) in weight.into_iter().enumerate() {
                self.numbers[n_found] = (first + lane) as u32;
                self.weights[n_found] = weight;
                n_found += (reaches >> lane & 1) as usize;
            }
        }
        // Clear the padding, for `rank`.
        self.weights[n_found..n_found.next_multiple_of(LANES)].fill(0.0);
        n_found
    }

    /// Retains the [`MOST`] sites with the largest weights, in their order; of equal weights, the first. Returns the
    /// number of sites.
    fn keep_largest(&mut self, n_found: usize) -> usize {
        if n_found <= MOST {
            return n_found;
        }
        let weight = |found: usize| self.weights[found];
        // Select the largest weights, then restore the order of the group.
        let mut largest: Vec<usize> = (0..n_found).collect();
        largest.select_nth_unstable_by(MOST, |&a, &b| {
            weight(b).total_cmp(&weight(a)).then(a.cmp(&b))
        });
        largest.truncate(MOST);
        largest.sort_unstable();
        for (to, from) in largest.into_iter().enumerate() {
            self.numbers[to] = self.numbers[from];
            self.weights[to] = self.weights[from];
        }
        MOST
    }

    /// Returns the rank of a site: the number of sites with a larger weight, or with an equal weight and an earlier
    /// position.
    #[inline(always)]
    fn rank<S: Simd>(&self, simd: S, found: usize, n_found: usize) -> usize {
        let weight = f32x8::splat(simd, self.weights[found]);
        let mut rank = 0;
        for first in (0..n_found).step_by(LANES) {
            let others = f32x8::from_slice(simd, &self.weights[first..first + LANES]);
            // Of equal weights, count only those before this one.
            let earlier = (1_u32 << found.saturating_sub(first).min(LANES)) - 1;
            let before = u32::from(others.simd_gt(weight).to_bitmask() as u8)
                | u32::from(others.simd_eq(weight).to_bitmask() as u8) & earlier;
            rank += before.count_ones() as usize;
        }
        rank
    }
}

/// Returns the site nearest to a point, the first of equally near ones. Sites on the same sheet take precedence.
#[cold]
fn nearest([at, normal]: [Vec3; 2], around: NeighborhoodView<'_>) -> Option<Reaching> {
    let far = |record: &Record| {
        let is_opposed = Vec3::from(record.normal).dot(normal) < 0.0;
        (is_opposed, at.distance_squared(Vec3::from(record.position)))
    };
    let nearest = around.sites().min_by(|a, b| {
        let (a, b) = (far(a), far(b));
        a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
    })?;
    Some(Reaching {
        site: nearest.site,
        way: at - Vec3::from(nearest.position),
        weight: 1.0,
    })
}

#[cfg(test)]
mod tests {
    use super::{Found, LANES, MOST, Reach};
    use crate::bake::Group;
    use crate::mesh_domain::NeighborScratch;
    use crate::shapes::{cap, synthesizer, tangle};
    use crate::sites::weights;
    use dapple_mesh::FaceIdx;
    use dapple_raster::simd::{self, dispatch, for_every_level};
    use fearless_simd::{Level, f32x8, prelude::*};
    use glam::{DVec3, Vec3};

    /// Returns the weight of one site, computed with SIMD arithmetic.
    fn weight(level: Level, x_sq: f32) -> f32 {
        dispatch!(level, simd => {
            let all: [f32; LANES] = weights(simd, f32x8::splat(simd, x_sq)).into();
            all[0]
        })
    }

    #[test]
    fn ranks_are_those_of_a_stable_sort() {
        for n_found in 1..30_usize {
            // Some weights are equal.
            let weights: Vec<f32> = (0..n_found).map(|at| (at * 7 % 5 + 1) as f32).collect();
            let mut sorted: Vec<usize> = (0..n_found).collect();
            sorted.sort_by(|&a, &b| weights[b].total_cmp(&weights[a]));
            let mut padded = weights.clone();
            padded.resize(n_found.next_multiple_of(LANES), 0.0);
            let found = Found {
                numbers: Vec::new(),
                weights: padded,
            };
            for_every_level(|level| {
                for (rank, &at) in sorted.iter().enumerate() {
                    let own = dispatch!(level, simd => found.rank(simd, at, n_found));
                    assert_eq!(own, rank, "{at} of {n_found} at {level:?}");
                }
            });
        }
    }

    #[test]
    fn sites_of_the_largest_weights_are_kept() {
        for n_found in [1, MOST - 1, MOST, MOST + 1, 5 * MOST + 3] {
            // Some weights are equal.
            let weights: Vec<f32> = (0..n_found).map(|at| (at * 7 % 61 + 1) as f32).collect();
            let mut order: Vec<usize> = (0..n_found).collect();
            order.sort_by(|&a, &b| weights[b].total_cmp(&weights[a]));
            order.truncate(MOST);
            order.sort_unstable();
            let mut found = Found {
                numbers: (0..n_found as u32).collect(),
                weights: weights.clone(),
            };
            let n_kept = found.keep_largest(n_found);
            let kept = found.numbers[..n_kept]
                .iter()
                .map(|&number| number as usize);
            assert_eq!(kept.collect::<Vec<_>>(), order, "of {n_found}");
            let expected: Vec<f32> = order.iter().map(|&at| weights[at]).collect();
            assert_eq!(found.weights[..n_kept], expected, "of {n_found}");
        }
    }

    #[test]
    fn sites_far_from_the_plane_of_a_face_are_not_searched() {
        let tangle = synthesizer(tangle(60), 4000, |_, _| DVec3::NEG_Y);
        let (surface, hierarchy) = (tangle.surface(), tangle.hierarchy());
        let spacing = hierarchy.levels()[0].spacing();
        let radius = (1.5 * spacing) as f32;
        for face in (0..60).map(FaceIdx) {
            let point = surface.point(face, [0.4, 0.3, 0.3]);
            let center = surface.position(point);
            let mut nearby = NeighborScratch::default();
            let sites = nearby.collect_ball(hierarchy, 0, center, 6.0 * spacing);
            let group = Group {
                surface,
                face,
                points: &[point],
                center,
                sites,
            };
            let mut reach = Reach::default();
            reach.find(simd::level(), &group, radius);
            let normal = surface.face_normal(face).as_vec3();
            let height = |position| Vec3::from(position).dot(normal).abs();
            let n_near = sites
                .sites()
                .filter(|site| height(site.position) < radius)
                .count();
            assert_eq!(reach.sites.len(), n_near, "of {} at {face:?}", sites.len());
        }
    }

    #[test]
    fn sites_in_reach_are_those_of_a_plain_loop_at_every_level() {
        let cap = synthesizer(cap(), 1500, |_, _| DVec3::NEG_Y);
        let (surface, hierarchy) = (cap.surface(), cap.hierarchy());
        let spacing = hierarchy.levels()[0].spacing();
        let points = &hierarchy.sites().points()[..40];
        let center = surface.position(points[0]);
        // The ball is so large that some points have many sites in reach, and others none.
        let mut nearby = NeighborScratch::default();
        let sites = nearby.collect_ball(hierarchy, 0, center, 6.0 * spacing);
        let group = Group {
            surface,
            face: FaceIdx(0),
            points,
            center,
            sites,
        };
        let radius = (1.5 * spacing) as f32;
        let inverse_sq = 1.0 / (radius * radius);
        for_every_level(|level| {
            let mut reach = Reach::default();
            reach.find(level, &group, radius);
            let (mut n_near, mut n_far) = (0, 0);
            for (&point, found) in points.iter().zip(reach.of_points()) {
                let at = (surface.position(point) - center).as_vec3();
                let normal = surface.normal(point).as_vec3();
                let mut expected: Vec<(u32, f32)> = sites
                    .sites()
                    .filter(|record| Vec3::from(record.normal).dot(normal) >= 0.0)
                    .map(|record| {
                        let [x, y, z] = (Vec3::from(record.position) - at).to_array();
                        let x_sq = (x * x + y * y + z * z) * inverse_sq;
                        (record.site, weight(level, x_sq))
                    })
                    .filter(|(_, weight)| *weight > 0.0)
                    .collect();
                expected.sort_by(|a, b| b.1.total_cmp(&a.1));
                let found: Vec<_> = found.iter().map(|own| (own.site, own.weight)).collect();
                if expected.is_empty() {
                    n_far += 1;
                    assert_eq!(found.len(), 1, "the nearest one at {level:?}");
                } else {
                    n_near += 1;
                    assert_eq!(found, expected, "{level:?}");
                }
            }
            assert!(n_near > 0 && n_far > 0, "{n_near} near and {n_far} far");
        });
    }
}
