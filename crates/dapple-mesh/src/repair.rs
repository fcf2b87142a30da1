//! One way to mend what can be mended.
//!
//! The steps, in their order:
//!
//! 1. Vertices at the same position become one, the first. Two sides of a sheet become one thereby.
//! 2. Faces that name a vertex twice are dropped, and of faces with the same vertices all but the first; where twice
//!    their area is at most 2^-40 times the square of the longest edge, they cancel in pairs.
//! 3. Other faces without an area are mended so that their neighbors stay neighbors. In a *needle* the shortest edge
//!    is at most 2^-40 times the longest: its two vertices become one, the first. In a *cap* a corner lies on the opposite,
//!    longest edge. Another face there, if there is one, is split at that corner, and the cap is dropped, which together
//!    is the flip of the edge; without another face the cap is only dropped, and leaves the same border. A flip
//!    that gives a longer edge and yet a face without an area is not made; where only such are left, caps whose shortest
//!    edge is at most 2^-20 times the longest are taken for needles. Steps 2 and 3 take turns until nothing is left; when
//!    they change nothing more, and after 64 turns, the faces without an area that are left are dropped.
//! 4. Faces are turned over so that all of a piece go around the same side, by a breadth-first flood over edges of two
//!    faces from the lowest face, the lower of the next faces first. A piece that is closed keeps the side that makes its
//!    volume positive; any other, the one that turns over the smaller area, and in doubt that of its lowest face.
//! 5. Where that leaves edges whose faces disagree, because there is only one side, as on a Möbius strip, the piece is
//!    cut along them: every vertex there is split into one for each fan of its faces.
//! 6. Vertices that no face names are dropped.
//!
//! Step 3 leaves no crack in a closed mesh with a few such faces, as tests show; where many lie on top of each other, it
//! may.
//!
//! The result has no face or is a [`Surface`](crate::Surface), and repairing it again changes nothing. Non-manifold
//! edges and vertices stay (but for the cuts): an edge of three faces is a border, and at a vertex of two fans nothing
//! needs to know.

mod faces;
mod winding;

use crate::{FaceIdx, Mesh, MeshReport, VertexIdx};

/// The changes that [`Mesh::repair`] made.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Repair {
    /// The report of the mesh before the repair.
    pub before: MeshReport,
    /// The report of the repaired mesh.
    pub after: MeshReport,
    /// For each vertex now the vertex before that it was.
    pub vertex_before: Vec<VertexIdx>,
    /// For each face now the face before that it was, or that it is a part of.
    pub face_before: Vec<FaceIdx>,
    /// How many faces were turned over.
    pub turned_faces: usize,
    /// Along how many edges a piece with only one side was cut.
    pub cut_edges: usize,
}

impl Mesh {
    /// The mesh without duplicate vertices, unused vertices, degenerate and duplicate faces, and with consistent winding.
    ///
    /// The result has no face, or [`Surface::new`](crate::Surface::new) takes it. Vertices and faces keep their order. A
    /// mesh that needs nothing stays as it is, and so does one that was repaired. Only cuts in a piece with one side
    /// leave duplicate vertices.
    ///
    /// Two vertices at one position become one, which closes seams, and makes one sheet of two that coincide.
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

/// A mesh under repair, and where its parts come from.
struct Draft {
    mesh: Mesh,
    vertex_before: Vec<VertexIdx>,
    face_before: Vec<FaceIdx>,
}

impl Draft {
    /// The mesh with one vertex at each position; the others are still there, but unused.
    fn new(mesh: &Mesh) -> Self {
        let mut draft = Self {
            vertex_before: (0..mesh.positions().len() as u32).map(VertexIdx).collect(),
            face_before: (0..mesh.faces().len() as u32).map(FaceIdx).collect(),
            mesh: mesh.clone(),
        };
        draft.rename(&mesh.first_at_position());
        draft
    }

    /// Gives the corners of all faces other vertices.
    fn rename(&mut self, vertices: &[u32]) {
        for corner in self.mesh.faces.as_flattened_mut() {
            *corner = VertexIdx(vertices[corner.index()]);
        }
    }

    /// Keeps the marked faces, in their order.
    fn keep_faces(&mut self, keep: &[bool]) {
        let mut marks = keep.iter().copied();
        self.mesh.faces.retain(|_| marks.next() == Some(true));
        let mut marks = keep.iter().copied();
        self.face_before.retain(|_| marks.next() == Some(true));
    }

    /// Drops the vertices that no face names.
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
