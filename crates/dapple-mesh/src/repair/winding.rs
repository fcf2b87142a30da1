//! Which side the faces of a piece go around, and the cuts in pieces that have only one.

use super::Draft;
use crate::adjacency::{Adjacency, FaceEdge, sorted_edges};
use crate::triangle::area_vector;
use crate::{FaceIdx, VertexIdx};
use glam::DVec3;

impl Draft {
    /// Turns faces over so that the two faces of an edge go through it in opposite directions, and counts those turned.
    pub(super) fn turn_faces(&mut self) -> usize {
        let n_faces = self.mesh.faces.len();
        let adjacency = Adjacency::of_any_winding(n_faces, &sorted_edges(&self.mesh));
        let mut seen = vec![false; n_faces];
        let mut count = 0;
        for seed in (0..n_faces as u32).map(FaceIdx) {
            if !seen[seed.index()] {
                let piece = self.flood(seed, &adjacency, &mut seen);
                count += self.turn_piece(&piece);
            }
        }
        count
    }

    /// The faces of the piece of a seed, and whether each is to be turned over to agree with the seed.
    fn flood(&self, seed: FaceIdx, adjacency: &Adjacency, seen: &mut [bool]) -> Piece {
        seen[seed.index()] = true;
        let mut faces = vec![(seed, false)];
        let mut closed = true;
        let mut next = 0;
        while let Some(&(face, turned)) = faces.get(next) {
            next += 1;
            let around = adjacency.around(face);
            closed &= around.iter().all(Option::is_some);
            let mut ways: Vec<(FaceEdge, FaceEdge)> = (0..)
                .zip(around)
                .filter_map(|(edge, to)| to.map(|to| (to, FaceEdge { face, edge })))
                .collect();
            // The order of the corners must not matter, since turning a face over changes it.
            ways.sort_unstable_by_key(|(to, _)| to.face);
            for (to, from) in ways {
                if !seen[to.face.index()] {
                    seen[to.face.index()] = true;
                    faces.push((to.face, turned != (self.start(from) == self.start(to))));
                }
            }
        }
        Piece { faces, closed }
    }

    /// The vertex that an edge of a face starts at.
    fn start(&self, at: FaceEdge) -> VertexIdx {
        self.mesh.faces[at.face.index()][usize::from(at.edge)]
    }

    /// Turns the marked faces of a piece over, or the others; gives how many were turned.
    fn turn_piece(&mut self, piece: &Piece) -> usize {
        let origin = self.mesh.corners(piece.faces[0].0)[0];
        let (mut volume, mut balance) = (0.0, [0.0; 2]);
        for &(face, turned) in &piece.faces {
            let corners = self.mesh.corners(face);
            let [a, b, c] = corners.map(|corner| corner - origin);
            let part = a.dot(b.cross(c));
            volume += if turned { -part } else { part };
            balance[usize::from(turned)] += area_vector(corners).map_or(0.0, DVec3::length);
        }
        let others = if piece.closed && volume != 0.0 {
            volume < 0.0
        } else {
            balance[1] > balance[0]
        };
        let mut count = 0;
        for &(face, turned) in &piece.faces {
            if turned != others {
                // The first corner stays, so that sums over the corners keep their order.
                self.mesh.faces[face.index()].swap(1, 2);
                count += 1;
            }
        }
        count
    }

    /// Splits the vertices of edges whose two faces disagree, one for each fan, and counts these edges.
    ///
    /// That is enough: the two faces of such an edge are in different fans at both of its ends, since neighbors that agree
    /// all around a vertex lead from one to the other only if these agree. Afterwards a vertex that was split has one fan,
    /// so that an edge of three faces that becomes one of two by it has two that agree.
    pub(super) fn cut(&mut self) -> usize {
        let mut split = vec![false; self.mesh.positions.len()];
        let mut count = 0;
        for group in sorted_edges(&self.mesh).chunk_by(|a, b| a.ends == b.ends) {
            if let [a, b] = group
                && a.forward == b.forward
            {
                count += 1;
                for end in a.ends {
                    split[end.index()] = true;
                }
            }
        }
        if count > 0 {
            self.split(&split);
        }
        count
    }

    /// Gives every fan of a marked vertex but the first a vertex of its own, in the order of their lowest corners.
    fn split(&mut self, marked: &[bool]) {
        let fans = Adjacency::new(&self.mesh).fans(&self.mesh);
        let mut taken = vec![false; marked.len()];
        let mut names: Vec<VertexIdx> = Vec::with_capacity(fans.len());
        for (corner, &fan) in fans.iter().enumerate() {
            let vertex = self.mesh.faces.as_flattened()[corner];
            let first = fan == corner;
            names.push(if !first {
                names[fan]
            } else if marked[vertex.index()] && taken[vertex.index()] {
                self.mesh
                    .positions
                    .push(self.mesh.positions[vertex.index()]);
                self.vertex_before.push(self.vertex_before[vertex.index()]);
                VertexIdx(self.mesh.positions.len() as u32 - 1)
            } else {
                taken[vertex.index()] = true;
                vertex
            });
        }
        self.mesh.faces.as_flattened_mut().copy_from_slice(&names);
    }
}

/// Faces that hang together over edges of two faces.
struct Piece {
    /// The faces in the order of the flood, and whether they go around another side than the first.
    faces: Vec<(FaceIdx, bool)>,
    /// Whether all edges have two faces.
    closed: bool,
}
