//! Adjacency of faces across edges.

use crate::{FaceIdx, Mesh, VertexIdx};

/// A directed edge of a face: from corner `edge` of `face` to the face's next corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FaceEdge {
    /// Face that the edge belongs to.
    pub face: FaceIdx,
    /// Corner at the start of the edge: 0, 1 or 2.
    pub edge: u8,
}

/// Neighbors of every face of a mesh across its three edges.
///
/// Two faces are neighbors if they are the only two at an edge and traverse it in opposite directions. Every other
/// edge is a border: an edge of one face, of three or more faces, or of two faces that traverse it in the same
/// direction.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Adjacency {
    across: Vec<[Option<FaceEdge>; 3]>,
}

impl Adjacency {
    /// Finds the neighbors of all faces.
    ///
    /// A face that contains a vertex twice has no neighbors.
    #[must_use]
    pub fn new(mesh: &Mesh) -> Self {
        let mut across = Self::alone(mesh.faces().len());
        for group in sorted_edges(mesh).chunk_by(|a, b| a.ends == b.ends) {
            if let [a, b] = group
                && a.forward != b.forward
            {
                across.join(a.of, b.of);
            }
        }
        across
    }

    /// Returns the adjacency regardless of winding. Two faces at an edge are neighbors even if they traverse it in
    /// the same direction.
    pub(crate) fn of_any_winding(n_faces: usize, edges: &[SortedEdge]) -> Self {
        let mut across = Self::alone(n_faces);
        for group in edges.chunk_by(|a, b| a.ends == b.ends) {
            if let [a, b] = group {
                across.join(a.of, b.of);
            }
        }
        across
    }

    /// Returns an adjacency with as many neighbors as possible: at every edge, faces are paired until at most one is
    /// left. Faces that traverse the edge in opposite directions are paired first.
    pub(crate) fn paired(n_faces: usize, edges: &[SortedEdge]) -> Self {
        let mut across = Self::alone(n_faces);
        for group in edges.chunk_by(|a, b| a.ends == b.ends) {
            let (ahead, back): (Vec<&SortedEdge>, Vec<&SortedEdge>) =
                group.iter().partition(|edge| edge.forward);
            for (a, b) in ahead.iter().zip(&back) {
                across.join(a.of, b.of);
            }
            let n_opposite = ahead.len().min(back.len());
            // One of the two remainders is empty.
            for rest in [&ahead[n_opposite..], &back[n_opposite..]] {
                for pair in rest.chunks_exact(2) {
                    across.join(pair[0].of, pair[1].of);
                }
            }
        }
        across
    }

    /// Returns an adjacency in which no face has neighbors.
    fn alone(n_faces: usize) -> Self {
        let across = vec![[None; 3]; n_faces];
        Self { across }
    }

    fn join(&mut self, a: FaceEdge, b: FaceEdge) {
        self.set(a, Some(b));
        self.set(b, Some(a));
    }

    /// Returns the same edge as seen from the neighboring face; `None` at a border.
    ///
    /// # Panics
    ///
    /// If the face or the edge does not exist.
    #[inline]
    #[must_use]
    pub fn across(&self, from: FaceEdge) -> Option<FaceEdge> {
        self.across[from.face.index()][usize::from(from.edge)]
    }

    /// Sets the neighbor across an edge, on one side only.
    pub(crate) fn set(&mut self, from: FaceEdge, to: Option<FaceEdge>) {
        self.across[from.face.index()][usize::from(from.edge)] = to;
    }

    /// Returns, for each edge of a face, the same edge as seen from the neighboring face; `None` at a border.
    pub(crate) fn around(&self, face: FaceIdx) -> [Option<FaceEdge>; 3] {
        self.across[face.index()]
    }

    /// Returns the connected component of each face. A component is a set of faces that are connected through
    /// neighbors.
    ///
    /// Components are numbered from 0 in the order of their lowest face index.
    #[must_use]
    pub fn components(&self) -> Vec<u32> {
        const UNSEEN: u32 = u32::MAX;
        let mut labels = vec![UNSEEN; self.across.len()];
        let mut count = 0;
        let mut open = Vec::new();
        for seed in 0..labels.len() {
            if labels[seed] != UNSEEN {
                continue;
            }
            labels[seed] = count;
            open.push(seed);
            while let Some(face) = open.pop() {
                for to in self.across[face].iter().flatten() {
                    if labels[to.face.index()] == UNSEEN {
                        labels[to.face.index()] = count;
                        open.push(to.face.index());
                    }
                }
            }
            count += 1;
        }
        labels
    }

    /// Returns, for each corner, the lowest corner of its fan. Corner `c` of face `f` has the number `3 * f + c`.
    ///
    /// A fan is a set of corners at one vertex whose faces are connected around the vertex through neighbors.
    pub(crate) fn fans(&self, mesh: &Mesh) -> Vec<usize> {
        let mut fans: Vec<usize> = (0..3 * self.across.len()).collect();
        for (face, across) in self.across.iter().enumerate() {
            for (edge, to) in across.iter().enumerate() {
                let Some(to) = to.filter(|to| to.face.index() > face) else {
                    continue;
                };
                let [from, until] = [edge, (edge + 1) % 3];
                let other = to.face.index();
                let [there, next] = [usize::from(to.edge), (usize::from(to.edge) + 1) % 3];
                // Faces with equal winding traverse their edge in opposite directions.
                let opposite = mesh.faces()[face][from] != mesh.faces()[other][there];
                let ends = if opposite {
                    [next, there]
                } else {
                    [there, next]
                };
                unite(&mut fans, 3 * face + from, 3 * other + ends[0]);
                unite(&mut fans, 3 * face + until, 3 * other + ends[1]);
            }
        }
        (0..fans.len())
            .map(|corner| root(&mut fans, corner))
            .collect()
    }
}

/// An edge of a face, in a form that can be sorted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct SortedEdge {
    /// The lower and the higher vertex index.
    pub(crate) ends: [VertexIdx; 2],
    pub(crate) of: FaceEdge,
    /// Whether the face traverses the edge from the lower to the higher vertex.
    pub(crate) forward: bool,
}

/// Returns the edges of all faces with three different vertices, sorted so that edges with equal ends are adjacent.
pub(crate) fn sorted_edges(mesh: &Mesh) -> Vec<SortedEdge> {
    let mut edges = Vec::with_capacity(mesh.faces().len() * 3);
    for (face, corners) in (0..).map(FaceIdx).zip(mesh.faces()) {
        let [a, b, c] = *corners;
        if names_twice(*corners) {
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

/// Returns whether a face contains a vertex twice.
pub(crate) fn names_twice([a, b, c]: [VertexIdx; 3]) -> bool {
    a == b || b == c || c == a
}

/// Unites two sets of a disjoint-set forest. Every parent is lower than its child, and the lowest element of a set is
/// its root.
pub(crate) fn unite(parents: &mut [usize], a: usize, b: usize) {
    let (a, b) = (root(parents, a), root(parents, b));
    parents[a.max(b)] = a.min(b);
}

/// Returns the root of a set, which is its lowest element.
pub(crate) fn root(parents: &mut [usize], mut element: usize) -> usize {
    while parents[element] != element {
        // Halve the path for later searches.
        parents[element] = parents[parents[element]];
        element = parents[element];
    }
    element
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_meshes::{mesh, plane, ring, soup, tetrahedron};
    use proptest::prelude::*;

    fn edge(face: u32, edge: u8) -> FaceEdge {
        let face = FaceIdx(face);
        FaceEdge { face, edge }
    }

    #[test]
    fn adjacency_of_a_tetrahedron_joins_every_edge_to_its_twin() {
        let tetrahedron = tetrahedron();
        let adjacency = Adjacency::new(&tetrahedron);
        for face in 0..4 {
            for start in 0..3 {
                let to = adjacency.across(edge(face, start)).expect("closed");
                assert_eq!(adjacency.across(to), Some(edge(face, start)), "back");
                let ends = |at: FaceEdge| {
                    let corners = tetrahedron.faces()[at.face.index()];
                    [
                        corners[usize::from(at.edge)],
                        corners[(usize::from(at.edge) + 1) % 3],
                    ]
                };
                let [a, b] = ends(edge(face, start));
                assert_eq!(ends(to), [b, a], "the other way");
            }
        }
        assert_eq!(adjacency.components(), [0; 4], "in one piece");
    }

    #[test]
    fn adjacency_has_borders_where_faces_disagree_or_are_three() {
        let corners = [
            [0.0; 3],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
            [0.0, -1.0, 0.0],
        ];
        for faces in [
            &[[0, 1, 2], [0, 1, 3]][..],
            &[[0, 1, 2], [1, 0, 3], [1, 0, 4]],
            &[[0, 1, 2], [1, 0, 0]],
            &[[0, 1, 2]],
        ] {
            let adjacency = Adjacency::new(&mesh(&corners, faces));
            assert_eq!(adjacency.across(edge(0, 0)), None, "{faces:?}");
        }
    }

    #[test]
    fn components_are_numbered_by_their_lowest_faces() {
        let corners = [
            [0.0; 3],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
            [0.0, -1.0, 0.0],
        ];
        let apart = mesh(&corners, &[[0, 1, 2], [0, 3, 4], [2, 1, 3], [4, 3, 2]]);
        assert_eq!(Adjacency::new(&apart).components(), [0, 1, 0, 1]);
    }

    #[test]
    fn fans_of_a_plane_are_its_vertices() {
        for mesh in [plane(3, 2), ring(5, false), tetrahedron()] {
            let fans = Adjacency::new(&mesh).fans(&mesh);
            let vertices = mesh.faces().as_flattened();
            for (corner, &fan) in fans.iter().enumerate() {
                let first = vertices
                    .iter()
                    .position(|&vertex| vertex == vertices[corner]);
                assert_eq!(Some(fan), first, "corner {corner}");
            }
        }
    }

    proptest! {
        #[test]
        fn adjacency_on_any_soup_is_its_own_inverse(mesh in soup()) {
            let adjacency = Adjacency::new(&mesh);
            let labels = adjacency.components();
            for face in 0..mesh.faces().len() as u32 {
                for start in 0..3 {
                    if let Some(to) = adjacency.across(edge(face, start)) {
                        prop_assert_eq!(adjacency.across(to), Some(edge(face, start)));
                        prop_assert_eq!(labels[face as usize], labels[to.face.index()]);
                    }
                }
            }
        }
    }
}
