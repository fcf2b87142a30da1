//! Points that are stuck between fixed ones are moved to where there is room.
//!
//! Where the fixed points leave room for one new point and there are two, no push gets the second one out. There are a
//! few such places on any curved surface. They are found by the distance to the nearest neighbor, and the point goes to
//! the emptiest of some random places: Mitchell's best candidate (Don P. Mitchell, "Spectrally Optimal Sampling for
//! Distribution Ray Tracing", SIGGRAPH 1991, doi 10.1145/122718.122736).

use super::evenness::hexagonal_spacing;
use super::near::{CHUNK, Places};
use super::scatter::Scatter;
use super::share::Pieces;
use crate::SiteGrid;
use dapple_hash::Seed;
use dapple_mesh::{Surface, SurfacePoint};
use dapple_raster::parallel;
use glam::DVec3;

/// The distance to the nearest neighbor, in spacings, below which a point is stuck.
const STUCK: f64 = 0.72;
/// The random places that are tried.
const N_PLACES: u64 = 256;
/// The most points that are moved; where there are more, the surface itself is crowded.
const MOVED_MOST: usize = 512;

/// Moves those of the points from `n_fixed` on that are stuck to an emptier place of the same piece, if there is one.
pub(crate) fn unstick(
    surface: &Surface,
    pieces: &Pieces,
    points: &mut [SurfacePoint],
    n_fixed: usize,
    seed: Seed,
) {
    let spacing = hexagonal_spacing(surface.area(), points.len());
    let mut crowd = Crowd::new(Places::new(surface, points), spacing);
    let mut stuck = crowd.stuck_from(n_fixed);
    stuck.truncate(MOVED_MOST);
    // Points that follow each other are mostly on the same piece.
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

/// Positions of points while some of them are moved.
struct Crowd {
    places: Places,
    spacing: f64,
    grid: SiteGrid,
    /// The points that were moved since the grid was made.
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

    /// The points from `first` on that are stuck; of two free ones, the later.
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

    /// The distance to the nearest point on the same sheet among those that count, at most `reach`.
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
        // The grid has these at their old places, where they are no more.
        for &other in &self.moved {
            look_at(other);
        }
        least_sq.sqrt()
    }

    /// Moves a point to the emptiest of some random places, if that is emptier than its own.
    fn find_room(
        &mut self,
        surface: &Surface,
        scatter: &Scatter,
        site: usize,
        seed: Seed,
    ) -> Option<(usize, SurfacePoint)> {
        let room = |crowd: &Self, position, normal| {
            let within = |reach| crowd.nearest(position, normal, reach, |other| other != site);
            // Most places have a point close by, which makes it unnecessary to look at all others around.
            let close = 0.5 * crowd.spacing;
            let distance = within(close);
            if distance < close {
                return distance;
            }
            within(2.0 * crowd.spacing)
        };
        let mut most = room(self, self.places.positions[site], self.places.normals[site]);
        let mut best = None;
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
        self.places.positions[site] = position;
        self.places.normals[site] = normal;
        self.moved.push(site);
        Some((site, point))
    }
}

#[cfg(test)]
mod tests;
