//! One way to mend what can be mended.

use crate::{Mesh, MeshReport};

/// What [`Mesh::repair`] did.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Repair {
    /// What the mesh was like before.
    pub before: MeshReport,
    /// What it is like now.
    pub after: MeshReport,
}

impl Mesh {
    /// The mesh without duplicate vertices, unused vertices, degenerate and duplicate faces, and with consistent winding.
    #[must_use]
    pub fn repair(&self) -> (Self, Repair) {
        // SKELETON: to be written.
        let report = self.report();
        let repair = Repair {
            before: report.clone(),
            after: report,
        };
        (self.clone(), repair)
    }
}
