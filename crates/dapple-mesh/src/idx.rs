//! The numbers of vertices and faces.

/// The number of a vertex of a mesh, from 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct VertexIdx(pub u32);

/// The number of a face of a mesh, from 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FaceIdx(pub u32);

impl VertexIdx {
    /// The number as an index into a column.
    #[inline]
    #[must_use]
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}

impl FaceIdx {
    /// The number as an index into a column.
    #[inline]
    #[must_use]
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}
