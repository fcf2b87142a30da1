//! Builds a triangle mesh from the sites of a level, for export.
//!
//! The paper's `M_k` is a graph and not a triangulation, because stars that disagree about an edge do not fit together.
//! Adding the edge to both stars does not create triangles. (Reference: Greg Turk, "Texture Synthesis on Surfaces",
//! SIGGRAPH 2001, doi 10.1145/383259.383297, section 3.1.) Synthesis needs only the graph. For a mesh, the graph is
//! repaired:
//!
//! * only edges that are in the stars of both of their sites are kept. Where four sites have both diagonals, the longer
//!   one is dropped;
//! * faces are found by walking from site to site: at each site the walk continues along the edge next to the one it
//!   came by, in the order of the star;
//! * a triangle in the stars of all of its three sites is such a face. A larger face without a gap in the stars is a
//!   hole in the triangulation. Holes form where stars disagree or where sites lie on one circle. They are filled by
//!   cutting off corners, shortest diagonal first;
//! * a small face with a gap, as left by sharp edges, is filled, too. So are real holes a few site spacings wide. Other
//!   faces with a gap are borders.
//!
//! Each edge is then in at most two triangles, which traverse it in opposite directions.

use super::connect::Stars;
use super::oriented::Oriented;
use crate::{SiteIdx, SynthError};
use dapple_mesh::Mesh;
use glam::DVec3;
use std::collections::BTreeSet;

/// Maximum number of edges of a hole that is filled. The sites around a larger hole say little about the surface
/// inside.
const HOLE_MAX: usize = 32;
/// Maximum number of edges of a face with gaps that is filled. Larger ones are borders of the surface.
const GAP_MAX: usize = 8;

/// Triangle mesh of the sites of a level, with counts of its triangles by origin.
#[derive(Clone, Debug, PartialEq)]
pub struct SiteTriangles {
    /// Mesh whose vertices are the sites of the level, in the same order.
    pub mesh: Mesh,
    /// Number of triangles that are in the stars of all of their three sites.
    pub agreed: usize,
    /// Number of triangles that fill holes.
    pub filled: usize,
    /// Number of holes that could not be filled.
    pub holes: usize,
    /// Number of edge loops along borders of the surface, and around positions where stars found no neighbor on one
    /// side.
    pub borders: usize,
}

impl SiteTriangles {
    /// Triangulates the sites of a level.
    pub(crate) fn new(sites: &Oriented<'_>) -> Result<Self, SynthError> {
        let stars = Stars::new(sites);
        // Drop the longer one of two crossing diagonals.
        let crossed = Edges::new(&stars, &BTreeSet::new()).crossed(sites.positions);
        let edges = Edges::new(&stars, &crossed);
        let mut filler = Filler {
            sites,
            edges: &edges,
            diagonals: BTreeSet::new(),
        };
        let (mut triangles, mut agreed, mut holes, mut borders) = (Vec::new(), 0, 0, 0);
        // Keep the triangles that all stars agree on, and fill the holes between them.
        edges.visit_faces(|face, is_closed, is_agreed| {
            let is_hole = is_closed || face.len() <= GAP_MAX;
            if let (&[a, b, c], true) = (face, is_agreed) {
                triangles.push([a, b, c]);
                agreed += 1;
            } else if let Some(filling) = is_hole.then(|| filler.fill(face)).flatten() {
                triangles.extend(filling);
            } else if is_closed {
                holes += 1;
            } else {
                borders += 1;
            }
        });
        Ok(Self {
            filled: triangles.len() - agreed,
            mesh: Mesh::new(sites.positions.to_vec(), &triangles)?,
            agreed,
            holes,
            borders,
        })
    }
}

/// Edges that are in the stars of both of their sites, stored at both ends, in compressed rows. Rows are
/// counterclockwise.
struct Edges {
    offsets: Vec<usize>,
    rows: Vec<Edge>,
}

/// An edge of a site, and the corner between it and the next edge counterclockwise.
#[derive(Clone, Copy)]
struct Edge {
    to: u32,
    /// Whether triangles of the site's star cover the whole corner.
    is_closed: bool,
    /// Whether the corner is a single triangle of the site's star, without a dropped edge in between.
    is_agreed: bool,
}

impl Edges {
    /// Collects the edges that are in the stars of both ends, except the edges in `left_out` (pairs with the lower site
    /// first).
    fn new(stars: &Stars, left_out: &BTreeSet<[u32; 2]>) -> Self {
        let mut edges = Self {
            offsets: vec![0],
            rows: Vec::new(),
        };
        for site in (0..stars.len() as u32).map(SiteIdx) {
            let star = stars.star(site);
            let is_kept = |to: SiteIdx| {
                stars.star(to).iter().any(|spoke| spoke.to == site)
                    && !left_out.contains(&lower_first(site.0, to.0))
            };
            let kept: Vec<usize> = (0..star.len()).filter(|&at| is_kept(star[at].to)).collect();
            for (index, &at) in kept.iter().enumerate() {
                // Index of the next kept spoke; past the end of the star where it wraps around.
                let next = kept.get(index + 1).copied().unwrap_or(star.len() + kept[0]);
                let is_closed = (at..next).all(|spoke| star[spoke % star.len()].joined);
                edges.rows.push(Edge {
                    to: star[at].to.0,
                    is_closed,
                    is_agreed: is_closed && next == at + 1,
                });
            }
            edges.offsets.push(edges.rows.len());
        }
        edges
    }

    /// Returns the edges of `site`, counterclockwise.
    fn row(&self, site: u32) -> &[Edge] {
        &self.rows[self.offsets[site as usize]..self.offsets[site as usize + 1]]
    }

    fn contains(&self, a: u32, b: u32) -> bool {
        self.row(a).iter().any(|edge| edge.to == b)
    }

    /// Returns the longer diagonal of each quadrangle of sites with both diagonals.
    fn crossed(&self, positions: &[DVec3]) -> BTreeSet<[u32; 2]> {
        let mut crossed = BTreeSet::new();
        for site in 0..self.offsets.len() as u32 - 1 {
            let row = self.row(site);
            for at in 0..row.len() {
                // Three consecutive neighbors, which form a quadrangle with this site: the edge to the middle one is a
                // diagonal.
                let [left, across, right] = [at, at + 1, at + 2].map(|at| row[at % row.len()].to);
                if self.are_in_a_row(left, [across, right, site]) {
                    let length = |[a, b]: [u32; 2]| {
                        positions[a as usize].distance_squared(positions[b as usize])
                    };
                    let ours = lower_first(site, across);
                    let other = lower_first(left, right);
                    let order = length(ours)
                        .total_cmp(&length(other))
                        .then(ours.cmp(&other));
                    crossed.insert(if order.is_gt() { ours } else { other });
                }
            }
        }
        crossed
    }

    /// Returns whether `neighbors` are consecutive in the row of `site`.
    fn are_in_a_row(&self, site: u32, neighbors: [u32; 3]) -> bool {
        let row = self.row(site);
        let begins =
            |at: usize| (0..3).all(|part| row[(at + part) % row.len()].to == neighbors[part]);
        (0..row.len()).any(begins)
    }

    /// Calls `visit` with the sites around each face, counterclockwise, and two flags: whether all of its corners are
    /// closed, and whether all are agreed on.
    fn visit_faces(&self, mut visit: impl FnMut(&[u32], bool, bool)) {
        let mut is_done = vec![false; self.rows.len()];
        let mut face = Vec::new();
        for site in 0..self.offsets.len() as u32 - 1 {
            for first in self.offsets[site as usize]..self.offsets[site as usize + 1] {
                // Walk around the face to the left of each edge that no face has used yet.
                let (mut from, mut edge) = (site, first);
                let (mut is_closed, mut is_agreed) = (true, true);
                face.clear();
                while !is_done[edge] {
                    is_done[edge] = true;
                    face.push(from);
                    let corner = self.next_around(from, edge);
                    is_closed &= self.rows[corner].is_closed;
                    is_agreed &= self.rows[corner].is_agreed;
                    (from, edge) = (self.rows[edge].to, corner);
                }
                if !face.is_empty() {
                    visit(&face, is_closed, is_agreed);
                }
            }
        }
    }

    /// Returns the next edge around the face to the left of an edge, which is the next edge clockwise at its far end.
    fn next_around(&self, from: u32, edge: usize) -> usize {
        let there = self.rows[edge].to;
        let row = self.row(there);
        let back = row.iter().position(|edge| edge.to == from).unwrap_or(0);
        let next = back.checked_sub(1).unwrap_or(row.len() - 1);
        self.offsets[there as usize] + next
    }
}

/// Fills holes with triangles.
struct Filler<'a> {
    sites: &'a Oriented<'a>,
    edges: &'a Edges,
    /// Diagonals added so far, as pairs with the lower site first.
    diagonals: BTreeSet<[u32; 2]>,
}

impl Filler<'_> {
    /// Divides `face` into triangles that face outward. `None` if that is not possible, if the face meets itself, or if
    /// it has more than [`HOLE_MAX`] edges.
    fn fill(&mut self, face: &[u32]) -> Option<Vec<[u32; 3]>> {
        let is_simple = || (1..face.len()).all(|at| !face[..at].contains(&face[at]));
        if !(3..=HOLE_MAX).contains(&face.len()) || !is_simple() {
            return None;
        }
        let mut ring = face.to_vec();
        let mut triangles = Vec::new();
        // Cut off corners until a triangle is left.
        while ring.len() > 3 {
            let at = self.best_corner(&ring)?;
            triangles.push(corner(&ring, at));
            ring.remove(at);
        }
        triangles.push([ring[0], ring[1], ring[2]]);
        if !self.is_outward([ring[0], ring[1], ring[2]]) {
            return None;
        }
        // Record the diagonals: every triangle but the last was cut off along one.
        let cuts = &triangles[..triangles.len() - 1];
        let diagonals = cuts.iter().map(|&[a, _, b]| lower_first(a, b));
        self.diagonals.extend(diagonals);
        Some(triangles)
    }

    /// Returns the index of the corner with the shortest diagonal, among corners that face outward and whose diagonal
    /// is not an edge yet.
    fn best_corner(&self, ring: &[u32]) -> Option<usize> {
        let length = |at: usize| {
            let [a, _, b] = corner(ring, at);
            self.at(a).distance_squared(self.at(b))
        };
        let is_free = |&at: &usize| {
            let [a, middle, b] = corner(ring, at);
            self.is_outward([a, middle, b])
                && !self.edges.contains(a, b)
                && !self.diagonals.contains(&lower_first(a, b))
        };
        let corners = (0..ring.len()).filter(is_free);
        corners.min_by(|&a, &b| length(a).total_cmp(&length(b)))
    }

    /// Returns whether a triangle faces the same way as the normal of its second site.
    fn is_outward(&self, [a, middle, b]: [u32; 3]) -> bool {
        let up = (self.at(middle) - self.at(a)).cross(self.at(b) - self.at(middle));
        up.dot(self.sites.normals[middle as usize]) > 0.0
    }

    fn at(&self, site: u32) -> DVec3 {
        self.sites.positions[site as usize]
    }
}

fn lower_first(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// Returns the site at index `at` of `ring`, between the sites before and after it.
fn corner(ring: &[u32], at: usize) -> [u32; 3] {
    let n = ring.len();
    [ring[(at + n - 1) % n], ring[at], ring[(at + 1) % n]]
}

#[cfg(test)]
mod tests;
