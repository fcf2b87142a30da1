//! Removes duplicate faces and faces with zero area.

use super::Draft;
use crate::adjacency::{Adjacency, FaceEdge, names_twice, root, sorted_edges, unite};
use crate::triangle::{Shape, THIN_MAX, area_vector, edge_lengths_sq, is_thin, shape};
use crate::{FaceIdx, Mesh, VertexIdx};
use std::collections::BinaryHeap;

/// Maximum number of repair rounds before the remaining faces with zero area are dropped.
const TURNS_MAX: usize = 64;
/// Maximum number of flips per round, per face of the mesh. Flips usually shorten edges, but not always.
const FLIPS_MAX: usize = 4;
/// Maximum ratio of the shortest to the longest edge at which a cap that cannot be flipped counts as a needle: 2^-20.
const STUCK_MAX: f64 = 1.0 / 1_048_576.0;

impl Draft {
    /// Drops duplicate faces, and repairs or drops faces with zero area.
    pub(super) fn mend_faces(&mut self) {
        for _ in 0..TURNS_MAX {
            self.drop_useless();
            if self.weld_needles(THIN_MAX) {
                continue;
            }
            let caps: Vec<Cap> = (0..self.mesh.faces.len() as u32)
                .filter_map(|face| Cap::new(&self.mesh, FaceIdx(face)))
                .collect();
            if caps.is_empty() {
                return;
            }
            if !self.flip_caps(caps) && !self.weld_needles(STUCK_MAX) {
                break;
            }
        }
        self.drop_useless();
        let faces = 0..self.mesh.faces.len() as u32;
        let keep: Vec<bool> = faces
            .map(|face| !self.mesh.is_degenerate(FaceIdx(face)))
            .collect();
        self.keep_faces(&keep);
    }

    /// Drops faces that contain a vertex twice, and duplicates.
    ///
    /// Two thin duplicates cancel each other, so that the faces around them become neighbors. Of other duplicates,
    /// one is retained, since both may be all that is left of a sheet.
    fn drop_useless(&mut self) {
        let faces = self.mesh.faces.iter();
        let mut keep: Vec<bool> = faces.map(|&corners| !names_twice(corners)).collect();
        for same in self.mesh.faces_by_vertices().chunk_by(|a, b| a.0 == b.0) {
            let cancel = same.len().is_multiple_of(2) && is_thin(self.mesh.corners(same[0].1));
            for (_, face) in &same[usize::from(!cancel)..] {
                keep[face.index()] = false;
            }
        }
        self.keep_faces(&keep);
    }

    /// Merges the vertices of the shortest edge of every needle, and returns whether there was any.
    ///
    /// In a needle, this edge is at most `thin` times the longest one.
    fn weld_needles(&mut self, thin: f64) -> bool {
        let mut parents: Vec<usize> = (0..self.mesh.positions.len()).collect();
        let mut welded = false;
        for (face, corners) in (0..).map(FaceIdx).zip(&self.mesh.faces) {
            if let Shape::Needle { shortest } = shape(self.mesh.corners(face), thin) {
                let [a, b] = [shortest, (shortest + 1) % 3].map(|corner| corners[corner].index());
                unite(&mut parents, a, b);
                welded = true;
            }
        }
        if welded {
            let names: Vec<u32> = (0..parents.len())
                .map(|vertex| root(&mut parents, vertex) as u32)
                .collect();
            self.rename(&names);
        }
        welded
    }

    /// Flips the longest edges of caps, longest first, and drops caps that have no neighbor across that edge. Returns
    /// whether the mesh changed.
    fn flip_caps(&mut self, caps: Vec<Cap>) -> bool {
        let edges = sorted_edges(&self.mesh);
        let mut across = Adjacency::paired(self.mesh.faces.len(), &edges);
        let mut keep = vec![true; self.mesh.faces.len()];
        let mut open = BinaryHeap::from(caps);
        let mut changed = false;
        for _ in 0..FLIPS_MAX * self.mesh.faces.len() {
            let Some(cap) = open.pop() else {
                break;
            };
            // An earlier flip may have changed or removed the face.
            if !keep[cap.of.face.index()] || Cap::new(&self.mesh, cap.of.face) != Some(cap) {
                continue;
            }
            // Without a neighbor, only drop the cap.
            let Some(to) = across.across(cap.of) else {
                keep[cap.of.face.index()] = false;
                detach(&mut across, cap.of.face);
                changed = true;
                continue;
            };
            // If both faces have the same vertices, drop both and connect their neighbors.
            if self.third(to) == self.third(cap.of) {
                keep[cap.of.face.index()] = false;
                keep[to.face.index()] = false;
                let [[cap_start, cap_end], [past_start, past_end]] =
                    self.sides(cap.of, to, &across);
                join(&mut across, cap_start, past_start);
                join(&mut across, cap_end, past_end);
                changed = true;
            } else if self.gains(&cap, to) {
                self.flip(cap.of, to, &mut across);
                let faces = [cap.of.face, to.face].into_iter();
                open.extend(faces.filter_map(|face| Cap::new(&self.mesh, face)));
                changed = true;
            }
        }
        self.keep_faces(&keep);
        changed
    }

    /// Returns whether flipping the cap's longest edge gives a shorter edge, or only faces with nonzero area. Flips
    /// without such a gain could repeat forever.
    fn gains(&self, cap: &Cap, to: FaceEdge) -> bool {
        let corner = |vertex: VertexIdx| self.mesh.positions[vertex.index()];
        let [tip, third] = [self.third(cap.of), self.third(to)].map(corner);
        let [start, end] = [0, 1].map(|steps| corner(self.vertex(step(to, steps))));
        (third - tip).length_squared() < cap.length_sq
            || [[start, tip, third], [tip, end, third]]
                .into_iter()
                .all(|corners| area_vector(corners).is_some())
    }

    /// Returns the edges across the two free sides of a cap, and across the two free sides of its neighbor. Of each
    /// pair, the first side is at the start of the shared edge, as the neighbor traverses it, and the second is at its
    /// end.
    fn sides(&self, cap: FaceEdge, to: FaceEdge, across: &Adjacency) -> [[Option<FaceEdge>; 2]; 2] {
        let after = |at: FaceEdge, steps| across.across(step(at, steps));
        let [past_end, past_start] = [1, 2].map(|steps| after(to, steps));
        let [next, last] = [1, 2].map(|steps| after(cap, steps));
        let same = self.vertex(cap) == self.vertex(to);
        let cap_sides = if same { [last, next] } else { [next, last] };
        [cap_sides, [past_start, past_end]]
    }

    /// Flips the longest edge of a cap: splits the neighbor at the cap's corner on that edge. The cap becomes one of
    /// the two parts.
    ///
    /// Both parts have the winding of the neighbor.
    fn flip(&mut self, cap: FaceEdge, to: FaceEdge, across: &mut Adjacency) {
        let tip = self.third(cap);
        let [start, end, third] = [0, 1, 2].map(|steps| self.vertex(step(to, steps)));
        let [[cap_start, cap_end], [past_start, past_end]] = self.sides(cap, to, across);
        let of = |face: FaceIdx, edge: u8| FaceEdge { face, edge };
        let (one, two) = (cap.face, to.face);
        self.mesh.faces[one.index()] = [start, tip, third];
        self.mesh.faces[two.index()] = [tip, end, third];
        self.face_before[one.index()] = self.face_before[two.index()];
        join(across, Some(of(one, 0)), cap_start);
        join(across, Some(of(one, 2)), past_start);
        join(across, Some(of(two, 0)), cap_end);
        join(across, Some(of(two, 1)), past_end);
        join(across, Some(of(one, 1)), Some(of(two, 2)));
    }

    /// Returns the vertex at the start of an edge of a face.
    fn vertex(&self, at: FaceEdge) -> VertexIdx {
        self.mesh.faces[at.face.index()][usize::from(at.edge)]
    }

    /// Returns the vertex of the face opposite to the edge.
    fn third(&self, at: FaceEdge) -> VertexIdx {
        self.vertex(step(at, 2))
    }
}

/// A cap and its longest edge. Caps are ordered by the length of this edge. On a tie, the face with the lower index is
/// greater.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cap {
    length_sq: f64,
    of: FaceEdge,
}

impl Cap {
    fn new(mesh: &Mesh, face: FaceIdx) -> Option<Self> {
        let corners = mesh.corners(face);
        match shape(corners, THIN_MAX) {
            Shape::Cap { longest } => Some(Self {
                length_sq: edge_lengths_sq(corners)[longest],
                of: FaceEdge {
                    face,
                    edge: longest as u8,
                },
            }),
            Shape::Fair | Shape::Needle { .. } => None,
        }
    }
}

impl Eq for Cap {}

impl Ord for Cap {
    fn cmp(&self, other: &Self) -> core::cmp::Ordering {
        self.length_sq
            .total_cmp(&other.length_sq)
            .then(other.of.cmp(&self.of))
    }
}

impl PartialOrd for Cap {
    fn partial_cmp(&self, other: &Self) -> Option<core::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

/// Returns the edge `steps` after `at` in the same face.
fn step(at: FaceEdge, steps: u8) -> FaceEdge {
    FaceEdge {
        edge: (at.edge + steps) % 3,
        ..at
    }
}

/// Makes two edges neighbors. If one of them is `None`, the other becomes a border.
fn join(across: &mut Adjacency, a: Option<FaceEdge>, b: Option<FaceEdge>) {
    for (from, to) in [(a, b), (b, a)] {
        if let Some(from) = from {
            across.set(from, to);
        }
    }
}

/// Turns all edges of a face into borders, on both sides.
fn detach(across: &mut Adjacency, face: FaceIdx) {
    for (edge, to) in (0..).zip(across.around(face)) {
        across.set(FaceEdge { face, edge }, None);
        if let Some(to) = to {
            across.set(to, None);
        }
    }
}
