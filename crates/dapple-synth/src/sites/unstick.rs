//! Moves points that are stuck between earlier points to an emptier position.
//!
//! If earlier points leave space for one new point but two are there, repulsion cannot push the second one out. This
//! happens at a few positions on any curved surface, on which no regular lattice fits. Stuck points are found by the
//! distance to their nearest neighbor, and are moved to the emptiest of several random positions. This is Mitchell's
//! best-candidate method (Don P. Mitchell, "Spectrally Optimal Sampling for Distribution Ray Tracing", SIGGRAPH 1991,
//! doi 10.1145/122718.122736).

use super::evenness::hexagonal_spacing;
use super::near::{CHUNK, Places};
use super::scatter::Scatter;
use super::share::Pieces;
use crate::SiteGrid;
use dapple_hash::Seed;
use dapple_mesh::{Surface, SurfacePoint};
use dapple_raster::parallel;
use glam::DVec3;

/// A point counts as stuck if its nearest neighbor is closer than this, in multiples of the point spacing.
const STUCK: f64 = 0.72;
/// Number of random candidate positions per stuck point.
const N_PLACES: u64 = 256;
/// Maximum number of points that are moved: the first in Morton order. It bounds the time on surfaces that are crowded
/// everywhere, such as a thin double wall, where moving points does not help.
const MOVED_MOST: usize = 512;

/// Moves each stuck point with index `n_fixed` or more to an emptier position on the same piece, if there is one.
pub(crate) fn unstick(
    surface: &Surface,
    pieces: &Pieces,
    points: &mut [SurfacePoint],
    n_fixed: usize,
    seed: Seed,
) {
    let spacing = hexagonal_spacing(surface.area(), points.len());
    // Find the stuck points.
    let mut crowd = Crowd::new(Places::new(surface, points), spacing);
    let mut stuck = crowd.stuck_from(n_fixed);
    stuck.truncate(MOVED_MOST);
    // Consecutive points are mostly on the same piece and share a sampler.
    let piece_of = |site: &usize| pieces.of_face[points[*site].face.index()];
    let mut moves = Vec::new();
    for group in stuck.chunk_by(|a, b| piece_of(a) == piece_of(b)) {
        let scatter = Scatter::new(surface, pieces.faces[piece_of(&group[0]) as usize].clone());
        for &site in group {
            moves.extend(crowd.find_room(surface, &scatter, site, seed));
        }
    }
    for &(site, point) in &moves {
        points[site] = point;
    }
}

/// Positions of points, with an index of neighbors that stays valid while points are moved.
struct Crowd {
    places: Places,
    spacing: f64,
    grid: SiteGrid,
    /// Points that were moved since the grid was built.
    moved: Vec<usize>,
}

impl Crowd {
    fn new(places: Places, spacing: f64) -> Self {
        Self {
            grid: SiteGrid::new(&places.positions, spacing),
            places,
            spacing,
            moved: Vec::new(),
        }
    }

    /// Returns the stuck points with index `first` or more. Of two free points that are too close to each other, only
    /// the later one counts as stuck.
    fn stuck_from(&self, first: usize) -> Vec<usize> {
        let n_sites = self.places.positions.len();
        let chunks = parallel::map(n_sites.saturating_sub(first).div_ceil(CHUNK), |chunk| {
            let from = first + chunk * CHUNK;
            (from..n_sites.min(from + CHUNK))
                .filter(|&site| {
                    let (position, normal) =
                        (self.places.positions[site], self.places.normals[site]);
                    let reach = STUCK * self.spacing;
                    self.nearest(position, normal, reach, |other| other < site) < reach
                })
                .collect::<Vec<usize>>()
        });
        chunks.concat()
    }

    /// Returns the distance to the nearest point on the same sheet for which `counts` holds, clamped to `reach`.
    #[inline]
    fn nearest(
        &self,
        position: DVec3,
        normal: DVec3,
        reach: f64,
        counts: impl Fn(usize) -> bool,
    ) -> f64 {
        let mut least_sq = reach * reach;
        let mut look_at = |other: usize| {
            let distance_sq = position.distance_squared(self.places.positions[other]);
            if distance_sq < least_sq
                && counts(other)
                && normal.dot(self.places.normals[other]) >= 0.0
            {
                least_sq = distance_sq;
            }
        };
        self.grid
            .visit(position, reach, |other| look_at(other.index()));
        // The grid has moved points in the cells of their old positions, so check them all.
        for &other in &self.moved {
            look_at(other);
        }
        least_sq.sqrt()
    }

    /// Finds the emptiest of several random positions for the point `site`, and moves the point there if it is emptier
    /// than the current position.
    fn find_room(
        &mut self,
        surface: &Surface,
        scatter: &Scatter,
        site: usize,
        seed: Seed,
    ) -> Option<(usize, SurfacePoint)> {
        let room = |crowd: &Self, position, normal| {
            let within = |reach| crowd.nearest(position, normal, reach, |other| other != site);
            // Most positions have a point nearby, so a small radius is searched first.
            let close = 0.5 * crowd.spacing;
            let distance = within(close);
            if distance < close {
                return distance;
            }
            within(2.0 * crowd.spacing)
        };
        let mut most = room(self, self.places.positions[site], self.places.normals[site]);
        let mut best = None;
        // Try random candidates, and keep the one farthest from its nearest neighbor.
        for number in 0..N_PLACES {
            let number = site as u64 * N_PLACES + number;
            let Some(point) = scatter.point(surface, seed, number) else {
                continue;
            };
            let (position, normal) = (surface.position(point), surface.normal(point));
            let distance = room(self, position, normal);
            if distance > most {
                (most, best) = (distance, Some((point, position, normal)));
            }
        }
        let (point, position, normal) = best?;
        // Record the move, so that later points see it.
        self.places.positions[site] = position;
        self.places.normals[site] = normal;
        self.moved.push(site);
        Some((site, point))
    }
}

#[cfg(test)]
mod tests;
