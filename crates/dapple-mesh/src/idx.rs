//! Indices of vertices and faces.

/// Index of a vertex of a mesh, starting at 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct VertexIdx(pub u32);

/// Index of a face of a mesh, starting at 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FaceIdx(pub u32);

impl VertexIdx {
    /// Returns the index as `usize`, for use with slices.
    #[inline]
    #[must_use]
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}

impl FaceIdx {
    /// Returns the index as `usize`, for use with slices.
    #[inline]
    #[must_use]
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}
