//! Makes the winding of faces consistent within each piece, and cuts non-orientable pieces.

use super::Draft;
use crate::adjacency::{Adjacency, FaceEdge, sorted_edges};
use crate::triangle::area_vector;
use crate::{FaceIdx, VertexIdx};
use glam::DVec3;

impl Draft {
    /// Flips faces so that the two faces of an edge traverse it in opposite directions, and returns the number of
    /// flipped faces.
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

    /// Returns the piece that contains a seed face. Each of its faces is marked if it must be flipped to agree with the
    /// seed.
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
            // The order must not depend on the order of corners, which flipping changes.
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

    /// Returns the vertex at the start of an edge of a face.
    fn start(&self, at: FaceEdge) -> VertexIdx {
        self.mesh.faces[at.face.index()][usize::from(at.edge)]
    }

    /// Flips either the marked or the unmarked faces of a piece: in a closed piece so that normals point outward, in
    /// others so that less area is flipped. Returns the number of flipped faces.
    fn turn_piece(&mut self, piece: &Piece) -> usize {
        // Sum the signed volume, and the areas of marked and unmarked faces.
        let origin = self.mesh.corners(piece.faces[0].0)[0];
        let (mut volume, mut balance) = (0.0, [0.0; 2]);
        for &(face, turned) in &piece.faces {
            let corners = self.mesh.corners(face);
            let [a, b, c] = corners.map(|corner| corner - origin);
            let part = a.dot(b.cross(c));
            volume += if turned { -part } else { part };
            balance[usize::from(turned)] += area_vector(corners).map_or(0.0, DVec3::length);
        }
        // Decide whether to flip the unmarked faces instead.
        let others = if piece.closed && volume != 0.0 {
            volume < 0.0
        } else {
            balance[1] > balance[0]
        };
        let mut count = 0;
        for &(face, turned) in &piece.faces {
            if turned != others {
                // Keep the first corner, so that sums over the corners keep their order.
                self.mesh.faces[face.index()].swap(1, 2);
                count += 1;
            }
        }
        count
    }

    /// Splits the vertices of edges whose two faces disagree into one vertex per fan, and returns the number of such
    /// edges.
    ///
    /// One pass is enough. The two faces of such an edge are in different fans at both ends, because faces connected
    /// by agreeing neighbors around a vertex agree with each other. After the split each of these vertices has one
    /// fan. An edge of three faces that becomes an edge of two therefore has two faces that agree.
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

    /// Splits the marked vertices: each fan at the vertex, except the first one, gets a new vertex. Fans are ordered by
    /// their lowest corners.
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

/// A piece: faces that are connected across edges with exactly two faces.
struct Piece {
    /// Faces in the order in which they were found, each with whether its winding is opposite to that of the first
    /// face.
    faces: Vec<(FaceIdx, bool)>,
    /// Whether every edge has two faces.
    closed: bool,
}
