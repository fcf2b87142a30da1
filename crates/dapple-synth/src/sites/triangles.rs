//! Triangles of the sites of a level, for export.
//!
//! The paper's `M_k` is a graph: stars that disagree about an edge do not fit together, and forcing the edge makes no
//! triangles. (Reference: Greg Turk, "Texture Synthesis on Surfaces", SIGGRAPH 2001, doi 10.1145/383259.383297, section
//! 3.1.) This is a repair of it that synthesis does not need:
//!
//! * only edges that are in the stars of both of their sites are kept; where four sites have both diagonals, only the
//!   shorter one;
//! * the faces between them are found by going around: from site to site, always taking the edge next to the one just
//!   come by, in the order of the star;
//! * a triangle in the stars of all its three sites is such a face. A larger face without a gap in the stars is a hole,
//!   left where stars disagree or where sites lie on one circle, and is filled by cutting off its corners, first the
//!   one with the shortest diagonal;
//! * so is a small face with a gap, which sharp edges leave, and real holes of a few spacings. The others are borders.
//!
//! Each edge is then in at most two triangles, which go around it in opposite directions.

use super::connect::Stars;
use super::oriented::Oriented;
use crate::{SiteIdx, SynthError};
use dapple_mesh::Mesh;
use glam::DVec3;
use std::collections::BTreeSet;

/// Larger holes are left open: the sites around them say little of what is inside.
const HOLE_MAX: usize = 32;
/// Faces with gaps in their stars are borders of the surface if they have more edges than this.
const GAP_MAX: usize = 8;

/// The triangles of the sites of a level, and how they came about.
#[derive(Clone, Debug, PartialEq)]
pub struct SiteTriangles {
    /// The triangles; the vertices are the sites of the level, in their order.
    pub mesh: Mesh,
    /// The number of triangles that are in the stars of all of their three sites.
    pub agreed: usize,
    /// The number of triangles that fill holes.
    pub filled: usize,
    /// The number of holes that could not be filled.
    pub holes: usize,
    /// The number of loops of edges along borders of the surface, and where stars found nothing on a side.
    pub borders: usize,
}

impl SiteTriangles {
    /// The triangles of sites.
    pub(crate) fn new(sites: &Oriented<'_>) -> Result<Self, SynthError> {
        let stars = Stars::new(sites);
        let crossed = Edges::new(&stars, &BTreeSet::new()).crossed(sites.positions);
        let edges = Edges::new(&stars, &crossed);
        let mut filler = Filler {
            sites,
            edges: &edges,
            diagonals: BTreeSet::new(),
        };
        let (mut triangles, mut agreed, mut holes, mut borders) = (Vec::new(), 0, 0, 0);
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

/// The edges that both stars have, seen from either end: compressed rows, counterclockwise.
struct Edges {
    offsets: Vec<usize>,
    rows: Vec<Edge>,
}

/// An edge, and the corner between it and the next one, counterclockwise.
#[derive(Clone, Copy)]
struct Edge {
    to: u32,
    /// Whether the star of the site has triangles all over the corner.
    is_closed: bool,
    /// Whether it has one triangle there, and no edge between.
    is_agreed: bool,
}

impl Edges {
    /// The edges that both stars have, except those to leave out, which have the lower site first.
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
                // How many spokes on the next one that is kept is, perhaps once around.
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

    fn row(&self, site: u32) -> &[Edge] {
        &self.rows[self.offsets[site as usize]..self.offsets[site as usize + 1]]
    }

    fn contains(&self, a: u32, b: u32) -> bool {
        self.row(a).iter().any(|edge| edge.to == b)
    }

    /// The longer diagonal of each four sites that have both.
    fn crossed(&self, positions: &[DVec3]) -> BTreeSet<[u32; 2]> {
        let mut crossed = BTreeSet::new();
        for site in 0..self.offsets.len() as u32 - 1 {
            let row = self.row(site);
            for at in 0..row.len() {
                // The sites of a quadrangle, counterclockwise, with the diagonal that is an edge of this site.
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

    /// Whether a site has these neighbors one after the other.
    fn are_in_a_row(&self, site: u32, neighbors: [u32; 3]) -> bool {
        let row = self.row(site);
        let begins =
            |at: usize| (0..3).all(|part| row[(at + part) % row.len()].to == neighbors[part]);
        (0..row.len()).any(begins)
    }

    /// Calls `visit` with the sites around each face, counterclockwise, and whether all of its corners are closed, and
    /// are agreed on.
    fn visit_faces(&self, mut visit: impl FnMut(&[u32], bool, bool)) {
        let mut is_done = vec![false; self.rows.len()];
        let mut face = Vec::new();
        for site in 0..self.offsets.len() as u32 - 1 {
            for first in self.offsets[site as usize]..self.offsets[site as usize + 1] {
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

    /// The edge that follows the one from a site around the face to its left: at the other end, the next one clockwise.
    fn next_around(&self, from: u32, edge: usize) -> usize {
        let there = self.rows[edge].to;
        let row = self.row(there);
        let back = row.iter().position(|edge| edge.to == from).unwrap_or(0);
        let next = back.checked_sub(1).unwrap_or(row.len() - 1);
        self.offsets[there as usize] + next
    }
}

/// Fills holes.
struct Filler<'a> {
    sites: &'a Oriented<'a>,
    edges: &'a Edges,
    /// The edges that were cut so far, the lower site first.
    diagonals: BTreeSet<[u32; 2]>,
}

impl Filler<'_> {
    /// Cuts a face into triangles that face outward; nothing if that is not possible or the face meets itself.
    fn fill(&mut self, face: &[u32]) -> Option<Vec<[u32; 3]>> {
        let is_simple = || (1..face.len()).all(|at| !face[..at].contains(&face[at]));
        if !(3..=HOLE_MAX).contains(&face.len()) || !is_simple() {
            return None;
        }
        let mut ring = face.to_vec();
        let mut triangles = Vec::new();
        while ring.len() > 3 {
            let at = self.best_corner(&ring)?;
            triangles.push(corner(&ring, at));
            ring.remove(at);
        }
        triangles.push([ring[0], ring[1], ring[2]]);
        if !self.is_outward([ring[0], ring[1], ring[2]]) {
            return None;
        }
        // All but the last triangle were cut off along a diagonal.
        let cuts = &triangles[..triangles.len() - 1];
        let diagonals = cuts.iter().map(|&[a, _, b]| lower_first(a, b));
        self.diagonals.extend(diagonals);
        Some(triangles)
    }

    /// The corner with the shortest diagonal of those that point outward and whose diagonal is not an edge yet.
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

    /// Whether a triangle faces to where the normal of its second site points.
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

/// A site of a ring between the ones before and after it.
fn corner(ring: &[u32], at: usize) -> [u32; 3] {
    let n = ring.len();
    [ring[(at + n - 1) % n], ring[at], ring[(at + 1) % n]]
}

#[cfg(test)]
mod tests;
