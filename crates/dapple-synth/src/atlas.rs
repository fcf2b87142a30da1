//! Where the faces of a mesh are in a texture map (section 6).
//!
//! Reference: Marc Soucy, Guy Godin and Marc Rioux, "A texture-mapping approach for the compression of colored 3D
//! triangulations", The Visual Computer 12(10), 1996: every face is mapped to a right triangle of its own, two of which
//! share a square tile. Here tiles are all of one size, or of sizes that follow the areas of the faces; or the map is one
//! of [charts](Atlas::charts), large pieces of the surface, or the caller's. No piece that is made here is mirrored: what
//! is counterclockwise from outside is so in the picture.
//!
//! Texel (x, y) has its center at `(x + 0.5, y + 0.5)`; row 0 is the top, and uv go from 0 to 1, v down.

mod charts;
mod own_uvs;
mod report;
mod tangents;
mod tiles;

pub use report::AtlasReport;
pub(crate) use tangents::{Tangents, mixed, sum};

use crate::{SynthError, SynthErrorKind};
use core::ops::ControlFlow;
use dapple_mesh::{FaceIdx, Surface, SurfacePoint};
use dapple_raster::Raster;
use glam::DVec2;

/// A texture map's layout: which face each texel shows, and where the corners of faces are.
#[derive(Clone, Debug, PartialEq)]
pub struct Atlas {
    faces: Raster<u32>,
    /// The corners of every face, in texels; NaN for a face without a place.
    corners: Vec<[DVec2; 3]>,
    /// Whether every level of a mipmap can be shown: in a layout of tiles, the coarse ones mix them.
    mipmaps: bool,
}

/// The most padding of pieces.
const PADDING_MAX: u32 = 1 << 10;

/// No face.
const NONE: u32 = u32::MAX;

impl Atlas {
    /// Charts: pieces of the surface that are flattened as a whole, with borders along creases where there are some, and
    /// packed by their shapes into a square map. `side` is that of the map in texels.
    ///
    /// Texels are of about one size on the surface ([`AtlasReport::stretch`]). More than 512 charts are packed in rows, which
    /// is faster by far and leaves more of the map free. The padding is 1 texel below a side of 512,
    /// then 2, and from 4096 on a 1024th of the side: pieces are twice as far apart. All texels between them continue
    /// them, so that every level of a mipmap can be shown.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Range`] if the pieces with their padding have no room, or if the map is larger than 2^14.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_synth::mesh::{Mesh, Surface, glam::DVec3};
    /// use dapple_synth::Atlas;
    ///
    /// let ridge = DVec3::new(1.0, 1.0, 0.3);
    /// let roof = Mesh::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y, ridge], &[[0, 1, 2], [2, 1, 3]])?;
    /// let surface = Surface::new(roof)?;
    /// let report = Atlas::charts(&surface, 64)?.report(&surface);
    /// assert_eq!(report.pieces, 1);
    /// assert!(report.stretch < 1.001);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn charts(surface: &Surface, side: u32) -> Result<Self, SynthError> {
        Self::charts_with(surface, side, None, |_| ControlFlow::Continue(()))
    }

    /// Charts with a padding of the caller's, from 1 to 1024 texels.
    ///
    /// With `3 * 2^k` texels, bilinear reading of a mipmap's first `k + 2` levels mixes in no other piece.
    ///
    /// # Errors
    ///
    /// Those of [`charts`](Self::charts), and [`SynthErrorKind::Range`] for another padding.
    pub fn charts_padded(surface: &Surface, side: u32, padding: u32) -> Result<Self, SynthError> {
        Self::charts_with(surface, side, Some(padding), |_| ControlFlow::Continue(()))
    }

    /// Charts with a callback, which is called with the part of the work that is done, from 0 to 1, and can stop it. `padding`
    /// is that of [`charts_padded`](Self::charts_padded), or by default that of [`charts`](Self::charts).
    ///
    /// The callback is called for each chart that was flattened and for each trial to pack all of them, but not while the
    /// surface is cut.
    ///
    /// # Errors
    ///
    /// Those of [`charts_padded`](Self::charts_padded), and [`SynthErrorKind::Cancelled`] if the callback stops the work.
    pub fn charts_with(
        surface: &Surface,
        side: u32,
        padding: Option<u32>,
        mut callback: impl FnMut(f64) -> ControlFlow<()> + Send,
    ) -> Result<Self, SynthError> {
        let padding = padding.unwrap_or_else(|| charts::padding(side));
        charts::charts(surface, side, padding, &mut callback)
    }

    /// Right triangles of one size, two in a square tile, as in the paper. `side` is that of the square map in texels.
    ///
    /// Texels around a triangle continue it, so that reading between texels mixes in no other face. This padding is the
    /// largest power of two that is at most a 16th of a tile's side, and at least 1.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Range`] if a tile would have fewer texels than padding needs, saying the side that is needed, or
    /// if the map is larger than 2^14.
    pub fn uniform(surface: &Surface, side: u32) -> Result<Self, SynthError> {
        tiles::uniform(surface, side, tiles::padding(surface, side))
    }

    /// Right triangles of one size with a padding of the caller's, from 1 to 1024 texels.
    ///
    /// With a padding of `2^k` texels and a side that is a multiple of it, bilinear reading of a mipmap's first `k + 1`
    /// levels, each the mean of 2 x 2 texels of the one before, mixes in no other face: tiles begin at multiples of
    /// `2^k`.
    ///
    /// # Errors
    ///
    /// Those of [`uniform`](Self::uniform), and [`SynthErrorKind::Range`] for another padding.
    pub fn uniform_padded(surface: &Surface, side: u32, padding: u32) -> Result<Self, SynthError> {
        tiles::uniform(surface, side, padding)
    }

    /// Right triangles in tiles whose sides are powers of two and follow the areas of the faces, so that texels are of
    /// about one size on the surface. The padding is that of [`uniform`](Self::uniform).
    ///
    /// # Errors
    ///
    /// Those of [`uniform`](Self::uniform).
    pub fn by_area(surface: &Surface, side: u32) -> Result<Self, SynthError> {
        tiles::by_area(surface, side, tiles::padding(surface, side))
    }

    /// Right triangles by area with a padding of the caller's, as in [`uniform_padded`](Self::uniform_padded).
    ///
    /// # Errors
    ///
    /// Those of [`uniform_padded`](Self::uniform_padded).
    pub fn by_area_padded(surface: &Surface, side: u32, padding: u32) -> Result<Self, SynthError> {
        tiles::by_area(surface, side, padding)
    }

    /// The caller's own layout: uv of the three corners of every face, v down. Whole turns are taken off, so that a face
    /// may lie in any unit square, but not across two of them; what lies outside is not shown.
    ///
    /// Where faces overlap, the one with the lower index is shown. `padding` texels around what is covered are filled,
    /// too; with as many as the map has, all are, and no level of a mipmap mixes in texels without a face.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Count`] for another number of faces, and as [`uniform`](Self::uniform).
    pub fn from_uvs(
        surface: &Surface,
        uvs: &[[DVec2; 3]],
        size: [u32; 2],
        padding: u32,
    ) -> Result<Self, SynthError> {
        own_uvs::from_uvs(surface, uvs, size, padding)
    }

    /// Columns and rows.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.faces.size()
    }

    /// The uv of the corners of every face, from 0 to 1, v down; NaN for a face without a place.
    #[must_use]
    pub fn uvs(&self) -> Vec<[DVec2; 3]> {
        let size = self.faces.size().map(f64::from);
        let uv = |corner: DVec2| corner / DVec2::from(size);
        self.corners.iter().map(|face| face.map(uv)).collect()
    }

    /// Whether every level of a mipmap can be shown. Not in a layout of tiles: past a level that the padding allows,
    /// texels mix faces that are far apart on the surface, and no padding is wide enough for the coarsest levels.
    pub(crate) fn mipmaps(&self) -> bool {
        self.mipmaps
    }

    /// The part of the texels that show a face, padding included: 0 to 1.
    #[must_use]
    pub fn coverage(&self) -> f64 {
        let covered = self.faces.pixels().iter().filter(|face| **face != NONE);
        covered.count() as f64 / self.faces.pixels().len() as f64
    }

    /// How good the layout is for the surface that it was made for.
    #[must_use]
    pub fn report(&self, surface: &Surface) -> AtlasReport {
        AtlasReport::new(self, surface)
    }

    /// The L2 stretch of every face of the surface that the layout was made for, as [`AtlasReport::stretch`] sums it up:
    /// above 1 where texels are larger than elsewhere. NaN for a face without a place.
    #[must_use]
    pub fn stretches(&self, surface: &Surface) -> Vec<f64> {
        report::stretches(self, surface)
    }

    /// The face of a texel.
    ///
    /// # Panics
    ///
    /// If there is no such texel.
    #[must_use]
    pub fn face(&self, [column, row]: [u32; 2]) -> Option<FaceIdx> {
        let face = self.faces.row(row)[column as usize];
        (face != NONE).then_some(FaceIdx(face))
    }

    /// Where the center of a texel is on the surface: on its face, or, in the padding, on the face that continues it.
    /// Past a border of the mesh, it is where the border was met.
    ///
    /// # Panics
    ///
    /// If there is no such texel.
    #[must_use]
    pub fn point(&self, surface: &Surface, texel: [u32; 2]) -> Option<SurfacePoint> {
        let face = self.face(texel)?;
        let corners = self.corners[face.index()];
        let weights = weights(corners, tangents::center(texel));
        let point = surface.point(face, weights);
        if weights.iter().all(|&weight| weight >= 0.0) {
            return Some(point);
        }
        // The path from the middle of the face unfolds what is across its edges.
        let middle = surface.point(face, [1.0 / 3.0; 3]);
        let path = point.flat - middle.flat;
        let length = path.length();
        // Where a caller's layout makes a sliver of a face, a texel beside it is far away.
        let distance = length.min(surface.area().sqrt());
        Some(surface.walk(middle, path / length, distance).point)
    }
}

/// The weights of three corners that give a position.
fn weights([a, b, c]: [DVec2; 3], at: DVec2) -> [f64; 3] {
    let area = (b - a).perp_dot(c - a);
    let of_b = (at - a).perp_dot(c - a) / area;
    let of_c = (b - a).perp_dot(at - a) / area;
    [1.0 - of_b - of_c, of_b, of_c]
}

/// Refuses padding that pieces cannot have.
fn check_padding(padding: u32) -> Result<(), SynthError> {
    let holds = (1..=PADDING_MAX).contains(&padding);
    SynthError::check(holds, "padding", padding.into(), "from 1 to 1024")
}

/// Refuses sides that a map cannot have.
fn check_side(side: u32) -> Result<(), SynthError> {
    if (1..=MAP_MAX).contains(&side) {
        return Ok(());
    }
    Err(SynthError::new(SynthErrorKind::Range {
        what: "side of the texture map",
        value: side.into(),
        range: "from 1 to 16384",
    }))
}

/// The largest side of a map.
const MAP_MAX: u32 = 1 << 14;

#[cfg(test)]
mod tests;
