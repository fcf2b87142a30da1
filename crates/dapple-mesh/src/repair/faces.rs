//! Faces that are no use: duplicates, and those without an area.

use super::Draft;
use crate::adjacency::{Adjacency, FaceEdge, names_twice, root, sorted_edges, unite};
use crate::triangle::{Shape, edge_lengths_sq, shape};
use crate::{FaceIdx, Mesh};
use std::collections::BinaryHeap;

/// How often faces without an area are mended before the rest is dropped.
const TURNS_MAX: usize = 64;
/// The most flips in one turn, for each face of the mesh. Flips make edges shorter as a rule, but not always.
const FLIPS_MAX: usize = 4;

impl Draft {
    /// Drops duplicate faces, and mends or drops faces without an area.
    pub(super) fn mend_faces(&mut self) {
        for _ in 0..TURNS_MAX {
            self.drop_useless();
            let caps: Vec<FaceIdx> = match self.weld_needles() {
                Turn::Welded => continue,
                Turn::Caps(caps) => caps,
            };
            if caps.is_empty() {
                return;
            }
            self.flip_caps(&caps);
        }
        self.drop_useless();
        let faces = 0..self.mesh.faces.len() as u32;
        let keep: Vec<bool> = faces
            .map(|face| !self.mesh.is_degenerate(FaceIdx(face)))
            .collect();
        self.keep_faces(&keep);
    }

    /// Drops duplicates, and faces that name a vertex twice.
    fn drop_useless(&mut self) {
        let faces = self.mesh.faces.iter();
        let mut keep: Vec<bool> = faces.map(|&corners| !names_twice(corners)).collect();
        for face in self.mesh.duplicate_faces() {
            keep[face.index()] = false;
        }
        self.keep_faces(&keep);
    }

    /// Makes one vertex of the shortest edge of every needle, or finds that there are only caps.
    fn weld_needles(&mut self) -> Turn {
        let mut parents: Vec<usize> = (0..self.mesh.positions.len()).collect();
        let (mut welded, mut caps) = (false, Vec::new());
        for (face, corners) in (0..).map(FaceIdx).zip(&self.mesh.faces) {
            match shape(self.mesh.corners(face)) {
                Shape::Fair => {}
                Shape::Cap { .. } => caps.push(face),
                Shape::Needle { shortest } => {
                    let ends = [corners[shortest], corners[(shortest + 1) % 3]];
                    unite(&mut parents, ends[0].index(), ends[1].index());
                    welded = true;
                }
            }
        }
        if !welded {
            return Turn::Caps(caps);
        }
        let names: Vec<u32> = (0..parents.len())
            .map(|vertex| root(&mut parents, vertex) as u32)
            .collect();
        self.rename(&names);
        Turn::Welded
    }

    /// Flips the longest edges of caps, the longest of all first, and drops caps that have no neighbor there.
    fn flip_caps(&mut self, caps: &[FaceIdx]) {
        let edges = sorted_edges(&self.mesh);
        let mut across = Adjacency::of_any_winding(self.mesh.faces.len(), &edges);
        let mut keep = vec![true; self.mesh.faces.len()];
        let mut open: BinaryHeap<Cap> = caps
            .iter()
            .filter_map(|&face| Cap::new(&self.mesh, face))
            .collect();
        for _ in 0..FLIPS_MAX * self.mesh.faces.len() {
            let Some(cap) = open.pop() else {
                break;
            };
            // A flip may have changed the face since.
            if !keep[cap.of.face.index()] || Cap::new(&self.mesh, cap.of.face) != Some(cap) {
                continue;
            }
            let neighbor = across
                .across(cap.of)
                .filter(|to| self.third(*to) != self.third(cap.of));
            if let Some(to) = neighbor {
                self.flip(cap.of, to, &mut across);
                open.extend(
                    [cap.of.face, to.face]
                        .into_iter()
                        .filter_map(|face| Cap::new(&self.mesh, face)),
                );
            } else {
                keep[cap.of.face.index()] = false;
                for (edge, to) in (0..).zip(across.around(cap.of.face)) {
                    link(&mut across, FaceEdge { edge, ..cap.of }, None);
                    if let Some(to) = to {
                        across.set(to, None);
                    }
                }
            }
        }
        self.keep_faces(&keep);
    }

    /// The vertex of the face that is not on the edge.
    fn third(&self, at: FaceEdge) -> crate::VertexIdx {
        self.mesh.faces[at.face.index()][(usize::from(at.edge) + 2) % 3]
    }

    /// Splits the neighbor of a cap at the corner of the cap that lies on their edge; the cap becomes one of the parts.
    ///
    /// The parts go around the same side as the neighbor.
    fn flip(&mut self, cap: FaceEdge, to: FaceEdge, across: &mut Adjacency) {
        let after = |at: FaceEdge, steps: u8| FaceEdge {
            edge: (at.edge + steps) % 3,
            ..at
        };
        let vertex = |at: FaceEdge| self.mesh.faces[at.face.index()][usize::from(at.edge)];
        let tip = self.third(cap);
        let [start, end, third] = [0, 1, 2].map(|steps| vertex(after(to, steps)));
        let [past_end, past_start] = [1, 2].map(|steps| across.across(after(to, steps)));
        let [next, last] = [1, 2].map(|steps| across.across(after(cap, steps)));
        let (tip_start, tip_end) = if vertex(cap) == start {
            (last, next)
        } else {
            (next, last)
        };
        let of = |face: FaceIdx, edge: u8| FaceEdge { face, edge };
        let (one, two) = (cap.face, to.face);
        self.mesh.faces[one.index()] = [start, tip, third];
        self.mesh.faces[two.index()] = [tip, end, third];
        self.face_before[one.index()] = self.face_before[two.index()];
        link(across, of(one, 0), tip_start);
        link(across, of(one, 2), past_start);
        link(across, of(two, 0), tip_end);
        link(across, of(two, 1), past_end);
        link(across, of(one, 1), Some(of(two, 2)));
    }
}

/// What a look at the faces without an area gave.
enum Turn {
    /// Vertices of needles became one; the mesh is to be looked at again.
    Welded,
    /// There are no needles, and these caps.
    Caps(Vec<FaceIdx>),
}

/// A cap and its longest edge; longer ones are greater, and of equal ones the lower face.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cap {
    length_sq: f64,
    of: FaceEdge,
}

impl Cap {
    fn new(mesh: &Mesh, face: FaceIdx) -> Option<Self> {
        let corners = mesh.corners(face);
        match shape(corners) {
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

/// Says what is across an edge, to both sides.
fn link(across: &mut Adjacency, from: FaceEdge, to: Option<FaceEdge>) {
    across.set(from, to);
    if let Some(to) = to {
        across.set(to, Some(from));
    }
}
