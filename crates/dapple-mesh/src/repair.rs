//! Repairs mesh defects.
//!
//! The steps, in order:
//!
//! 1. Vertices at the same position are merged into the first one. This also merges the two sides of a sheet.
//! 2. Faces that contain a vertex twice are dropped. Of faces with the same vertices, all except the first are
//!    dropped; if twice their area is at most 2^-40 times the square of the longest edge, they cancel in pairs.
//! 3. Other faces with zero area are removed so that their neighbors stay connected. In a *needle* the shortest edge
//!    is at most 2^-40 times the longest: its two vertices are merged into the first one. In a *cap*, a corner is on
//!    the opposite, longest edge. If another face shares this edge, it is split at that corner and the cap is
//!    dropped, which together is an edge flip. Without another face the cap is only dropped, which leaves the same
//!    border. A flip is skipped if it gives a longer edge and still leaves a face with zero area. Where only such
//!    flips remain, caps whose shortest edge is at most 2^-20 times the longest are treated as needles. Steps 2 and 3
//!    alternate until no such face is left. When they change nothing more, or after 64 rounds, the remaining faces
//!    with zero area are dropped.
//! 4. Faces are flipped so that the winding of each piece is consistent, by a breadth-first flood across edges of two
//!    faces. It starts at the lowest face and visits lower faces first. A closed piece gets the winding with a
//!    positive volume. An open piece gets the winding that flips the smaller area. On a tie, its lowest face keeps
//!    its winding.
//! 5. Edges whose faces still disagree exist only on non-orientable pieces, such as a Möbius strip. The piece is cut
//!    along them: every vertex there is split into one vertex per fan of its faces.
//! 6. Unused vertices are dropped.
//!
//! Step 3 leaves no crack in a closed mesh with a few such faces, as tests show. Where many of them overlap, it may.
//!
//! The result has no face or is a valid [`Surface`](crate::Surface), and repairing it again changes nothing.
//! Non-manifold edges and vertices stay, except for the cuts: an edge of three faces is a border, and a vertex of two
//! fans needs no special treatment.

mod faces;
mod winding;

use crate::{FaceIdx, Mesh, MeshReport, VertexIdx};

/// Changes made by [`Mesh::repair`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Repair {
    /// Report of the mesh before the repair.
    pub before: MeshReport,
    /// Report of the repaired mesh.
    pub after: MeshReport,
    /// Original vertex of each vertex of the result.
    pub vertex_before: Vec<VertexIdx>,
    /// Original face of each face of the result. Each part of a split face refers to the whole original face.
    pub face_before: Vec<FaceIdx>,
    /// Number of flipped faces.
    pub turned_faces: usize,
    /// Number of edges along which non-orientable pieces were cut.
    pub cut_edges: usize,
}

impl Repair {
    /// Returns, for each face of the repaired mesh `after`, the values that its corners had in the mesh `before`; `None`
    /// for a corner that the repair has moved. `values` has the values of all corners before the repair.
    ///
    /// # Panics
    ///
    /// If `before` and `after` are not the meshes of this repair, or `values` has fewer faces than `before`.
    pub fn corners_before<T: Copy>(
        &self,
        before: &Mesh,
        after: &Mesh,
        values: &[[T; 3]],
    ) -> impl Iterator<Item = [Option<T>; 3]> {
        let faces = after.faces().iter().zip(&self.face_before);
        faces.map(move |(face, &at)| {
            let corners = before.corners(at);
            // Match corners by position: repair may have reversed the face, or merged vertices at equal positions.
            face.map(|vertex| {
                let here = after.positions()[vertex.index()];
                let corner = corners.iter().position(|&other| other == here);
                corner.map(|corner| values[at.index()][corner])
            })
        })
    }
}

impl Mesh {
    /// Returns the mesh without duplicate vertices, unused vertices, degenerate faces and duplicate faces, and with
    /// consistent winding.
    ///
    /// The result has no face, or [`Surface::new`](crate::Surface::new) accepts it. Vertices and faces keep their
    /// order. A mesh without defects and a repaired mesh stay unchanged. Only cuts in a non-orientable piece leave
    /// duplicate vertices.
    ///
    /// Vertices at the same position are merged. This closes seams, and turns two coinciding sheets into one.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_mesh::{Mesh, Surface, glam::DVec3};
    ///
    /// let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    /// let twisted = Mesh::new(corners, &[[0, 1, 2], [0, 1, 3], [0, 0, 3]])?;
    /// let (mesh, repair) = twisted.repair();
    /// assert_eq!((mesh.faces().len(), repair.turned_faces), (2, 1));
    /// assert!(Surface::new(mesh).is_ok());
    /// # Ok::<(), dapple_mesh::MeshError>(())
    /// ```
    #[must_use]
    pub fn repair(&self) -> (Self, Repair) {
        let mut draft = Draft::new(self);
        draft.mend_faces();
        let turned_faces = draft.turn_faces();
        let cut_edges = draft.cut();
        draft.drop_unused();
        let repair = Repair {
            before: self.report(),
            after: draft.mesh.report(),
            vertex_before: draft.vertex_before,
            face_before: draft.face_before,
            turned_faces,
            cut_edges,
        };
        (draft.mesh, repair)
    }
}

/// A mesh during its repair, with the original index of each vertex and face.
struct Draft {
    mesh: Mesh,
    vertex_before: Vec<VertexIdx>,
    face_before: Vec<FaceIdx>,
}

impl Draft {
    /// Creates a draft in which all faces use the first vertex at each position. The other vertices are unused.
    fn new(mesh: &Mesh) -> Self {
        let mut draft = Self {
            vertex_before: (0..mesh.positions().len() as u32).map(VertexIdx).collect(),
            face_before: (0..mesh.faces().len() as u32).map(FaceIdx).collect(),
            mesh: mesh.clone(),
        };
        draft.rename(&mesh.first_at_position());
        draft
    }

    /// Replaces each vertex of all faces by its entry in `vertices`.
    fn rename(&mut self, vertices: &[u32]) {
        for corner in self.mesh.faces.as_flattened_mut() {
            *corner = VertexIdx(vertices[corner.index()]);
        }
    }

    /// Keeps only the marked faces, in order.
    fn keep_faces(&mut self, keep: &[bool]) {
        let mut marks = keep.iter().copied();
        self.mesh.faces.retain(|_| marks.next() == Some(true));
        let mut marks = keep.iter().copied();
        self.face_before.retain(|_| marks.next() == Some(true));
    }

    /// Drops the vertices that no face uses.
    fn drop_unused(&mut self) {
        let mut names = vec![None; self.mesh.positions.len()];
        for corner in self.mesh.faces.as_flattened() {
            names[corner.index()] = Some(0);
        }
        for (name, new) in names.iter_mut().flatten().zip(0..) {
            *name = new;
        }
        let mut used = names.iter().map(Option::is_some);
        self.mesh.positions.retain(|_| used.next() == Some(true));
        let mut used = names.iter().map(Option::is_some);
        self.vertex_before.retain(|_| used.next() == Some(true));
        let names: Vec<u32> = names.into_iter().map(Option::unwrap_or_default).collect();
        self.rename(&names);
    }
}

#[cfg(test)]
mod tests;
