//! The convex hull of the sites of a domain that does not wrap.
//!
//! Without wrapping, each tile also triangulates the hull's corners, so that the border of its triangulation is the
//! hull of all sites. Reference: A. M. Andrew, "Another efficient algorithm for convex hulls in two dimensions",
//! Information Processing Letters 9 (1979), after dropping the sites inside of an octagon: S. G. Akl and G. T.
//! Toussaint, "A fast convex hull algorithm", Information Processing Letters 7 (1978).

use super::Refusal;
use super::images::key;
use super::order::sort;
use crate::IsCancelled;
use glam::DVec2;
use robust::{Coord, orient2d};
use std::collections::BTreeMap;

/// The convex hull of at least three sites that are not collinear.
#[derive(Debug)]
pub(super) struct Hull {
    /// Sites on the hull's border, counterclockwise, including sites on the line between two corners.
    border: Vec<u32>,
    /// Sites at the corners.
    pub(super) corners: Vec<u32>,
    /// Index into `border` of the site at each position.
    places: BTreeMap<(i64, i64), usize>,
}

impl Hull {
    /// Computes the hull in a domain of the given size; `None` if all sites are collinear, or if there are more than `most`
    /// corners.
    pub(super) fn new(
        sites: &[DVec2],
        size: DVec2,
        most: usize,
        is_cancelled: &IsCancelled,
    ) -> Result<Option<Self>, Refusal> {
        let mut candidates = outside_of_octagon(sites, size);
        let place = |&index: &u32| key(sites[index as usize]);
        sort(&mut candidates, &place, is_cancelled)?;
        let turn = |corners: [u32; 3]| {
            let [a, b, c] = corners.map(|index| {
                let at = sites[index as usize];
                Coord { x: at.x, y: at.y }
            });
            orient2d(a, b, c)
        };
        let lower = chain(candidates.iter().copied(), turn);
        let upper = chain(candidates.iter().rev().copied(), turn);
        let border: Vec<u32> = [lower, upper]
            .iter()
            .flat_map(|chain| &chain[..chain.len().saturating_sub(1)])
            .copied()
            .collect();
        let n = border.len();
        let is_corner =
            |&at: &usize| turn([(at + n - 1) % n, at, (at + 1) % n].map(|i| border[i])) > 0.0;
        let corners: Vec<u32> = (0..n).filter(is_corner).map(|at| border[at]).collect();
        if !(3..=most).contains(&corners.len()) {
            return Ok(None);
        }
        let places = (0..n).map(|at| (key(sites[border[at] as usize]), at));
        Ok(Some(Self {
            places: places.collect(),
            corners,
            border,
        }))
    }

    /// Returns the previous and the next site on the border; `None` for a site inside the hull.
    pub(super) fn beside(&self, site: DVec2) -> Option<[u32; 2]> {
        let (n, at) = (self.border.len(), *self.places.get(&key(site))?);
        Some([self.border[(at + n - 1) % n], self.border[(at + 1) % n]])
    }
}

/// Returns the longest chain of sites in order that never turns clockwise.
fn chain(order: impl Iterator<Item = u32>, turn: impl Fn([u32; 3]) -> f64) -> Vec<u32> {
    let mut chain: Vec<u32> = Vec::new();
    for site in order {
        while let [.., a, b] = chain[..] {
            if turn([a, b, site]) >= 0.0 {
                break;
            }
            chain.pop();
        }
        chain.push(site);
    }
    chain
}

/// Returns the candidates for the hull: sites that are not clearly inside the octagon of the sites that are extreme
/// along the axes and diagonals.
fn outside_of_octagon(sites: &[DVec2], size: DVec2) -> Vec<u32> {
    const DIRECTIONS: [[f64; 2]; 8] = [
        [1.0, 0.0],
        [1.0, 1.0],
        [0.0, 1.0],
        [-1.0, 1.0],
        [-1.0, 0.0],
        [-1.0, -1.0],
        [0.0, -1.0],
        [1.0, -1.0],
    ];
    let mut extremes = [(f64::NEG_INFINITY, DVec2::ZERO); 8];
    for &site in sites {
        for (direction, extreme) in DIRECTIONS.into_iter().zip(&mut extremes) {
            let along = site.dot(direction.into());
            if along > extreme.0 {
                *extreme = (along, site);
            }
        }
    }
    // Keep sites within the rounding error of an edge.
    let least = 1e-14 * size.x * size.y;
    let edges: Vec<[DVec2; 2]> = (0..8)
        .map(|i| [extremes[i].1, extremes[(i + 1) % 8].1])
        .filter(|[from, to]| from != to)
        .collect();
    let is_inside = |site: DVec2| {
        edges
            .iter()
            .all(|&[from, to]| (to - from).perp_dot(site - from) > least)
    };
    let indexed = (0..).zip(sites);
    indexed
        .filter(|&(_, &site)| edges.len() < 3 || !is_inside(site))
        .map(|(index, _)| index)
        .collect()
}
