//! Which faces share which edges.

use crate::{FaceIdx, Mesh, VertexIdx};

/// An edge seen from one of its faces: the edge from corner `edge` of `face` to the next corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FaceEdge {
    /// The face.
    pub face: FaceIdx,
    /// The corner that the edge starts at: 0, 1 or 2.
    pub edge: u8,
}

/// The neighbors of every face of a mesh across its three edges.
///
/// Two faces are neighbors if they are the only two at an edge and go through it in opposite directions. An edge of one
/// face, of three or more, or of two that go through it in the same direction is a border.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Adjacency {
    across: Vec<[Option<FaceEdge>; 3]>,
}

impl Adjacency {
    /// Finds the neighbors of all faces.
    ///
    /// A face that names a vertex twice has no neighbors.
    #[must_use]
    pub fn new(mesh: &Mesh) -> Self {
        let mut across = vec![[None; 3]; mesh.faces().len()];
        let edges = sorted_edges(mesh);
        for group in edges.chunk_by(|a, b| a.ends == b.ends) {
            if let [a, b] = group
                && a.forward != b.forward
            {
                across[a.of.face.index()][usize::from(a.of.edge)] = Some(b.of);
                across[b.of.face.index()][usize::from(b.of.edge)] = Some(a.of);
            }
        }
        Self { across }
    }

    /// The same edge seen from the face on its other side, or nothing at a border.
    ///
    /// # Panics
    ///
    /// If there is no such face or edge.
    #[inline]
    #[must_use]
    pub fn across(&self, from: FaceEdge) -> Option<FaceEdge> {
        self.across[from.face.index()][usize::from(from.edge)]
    }
}

/// An edge of a face, ready to be sorted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct SortedEdge {
    /// The lower and the higher vertex.
    pub(crate) ends: [VertexIdx; 2],
    pub(crate) of: FaceEdge,
    /// Whether the face goes from the lower to the higher vertex.
    pub(crate) forward: bool,
}

/// The edges of all faces that name three different vertices, those with the same ends together.
pub(crate) fn sorted_edges(mesh: &Mesh) -> Vec<SortedEdge> {
    let mut edges = Vec::with_capacity(mesh.faces().len() * 3);
    for (face, corners) in (0..).map(FaceIdx).zip(mesh.faces()) {
        let [a, b, c] = *corners;
        if a == b || b == c || c == a {
            continue;
        }
        for (edge, [from, to]) in (0..).zip([[a, b], [b, c], [c, a]]) {
            edges.push(SortedEdge {
                ends: [from.min(to), from.max(to)],
                of: FaceEdge { face, edge },
                forward: from < to,
            });
        }
    }
    edges.sort_unstable();
    edges
}
