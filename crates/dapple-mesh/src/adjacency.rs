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

    /// Neighbors across edges, where two faces are also neighbors if they go through their edge in the same direction.
    pub(crate) fn of_any_winding(n_faces: usize, edges: &[SortedEdge]) -> Self {
        let mut across = Self::alone(n_faces);
        for group in edges.chunk_by(|a, b| a.ends == b.ends) {
            if let [a, b] = group {
                across.join(a.of, b.of);
            }
        }
        across
    }

    /// Neighbors across edges of any winding, where as many faces as possible are neighbors at every edge, two by two,
    /// first those that go through it in opposite directions.
    pub(crate) fn paired(n_faces: usize, edges: &[SortedEdge]) -> Self {
        let mut across = Self::alone(n_faces);
        for group in edges.chunk_by(|a, b| a.ends == b.ends) {
            let (ahead, back): (Vec<&SortedEdge>, Vec<&SortedEdge>) =
                group.iter().partition(|edge| edge.forward);
            for (a, b) in ahead.iter().zip(&back) {
                across.join(a.of, b.of);
            }
            let n_opposite = ahead.len().min(back.len());
            // One of the two is empty.
            for rest in [&ahead[n_opposite..], &back[n_opposite..]] {
                for pair in rest.chunks_exact(2) {
                    across.join(pair[0].of, pair[1].of);
                }
            }
        }
        across
    }

    /// Faces without neighbors.
    fn alone(n_faces: usize) -> Self {
        let across = vec![[None; 3]; n_faces];
        Self { across }
    }

    fn join(&mut self, a: FaceEdge, b: FaceEdge) {
        self.set(a, Some(b));
        self.set(b, Some(a));
    }

    /// The edge as the face on its other side sees it; `None` at a border.
    ///
    /// # Panics
    ///
    /// If there is no such face or edge.
    #[inline]
    #[must_use]
    pub fn across(&self, from: FaceEdge) -> Option<FaceEdge> {
        self.across[from.face.index()][usize::from(from.edge)]
    }

    /// Says what is across an edge, seen from one side.
    pub(crate) fn set(&mut self, from: FaceEdge, to: Option<FaceEdge>) {
        self.across[from.face.index()][usize::from(from.edge)] = to;
    }

    /// The edges across the three edges of a face, as the faces there have them.
    pub(crate) fn around(&self, face: FaceIdx) -> [Option<FaceEdge>; 3] {
        self.across[face.index()]
    }

    /// For each face the number of its component, the set of faces that can be reached over neighbors.
    ///
    /// Components are numbered from 0 in the order of their lowest faces.
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

    /// For each corner, `3 * face + corner`, the lowest corner of its fan.
    ///
    /// A fan is a set of corners at one vertex whose faces follow each other around it as neighbors.
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
                // Faces of the same winding go through their edge in opposite directions.
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

/// Whether a face names a vertex twice.
pub(crate) fn names_twice([a, b, c]: [VertexIdx; 3]) -> bool {
    a == b || b == c || c == a
}

/// Makes one set of two: in `parents` every element names a lower one of its set, and the lowest itself.
pub(crate) fn unite(parents: &mut [usize], a: usize, b: usize) {
    let (a, b) = (root(parents, a), root(parents, b));
    parents[a.max(b)] = a.min(b);
}

/// The lowest element of a set.
pub(crate) fn root(parents: &mut [usize], mut element: usize) -> usize {
    while parents[element] != element {
        // Halves the path for the next time.
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
