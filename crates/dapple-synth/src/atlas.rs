//! Atlases: the layout of a mesh's faces in a texture map (section 6).
//!
//! Reference: Marc Soucy, Guy Godin and Marc Rioux, "A texture-mapping approach for the compression of colored 3D
//! triangulations", The Visual Computer 12(10), 1996: every face is mapped to a separate right triangle, and two
//! triangles share a square tile.
//!
//! All tiles have the same size, or larger faces get larger tiles. Other layouts consist of [charts](Atlas::charts),
//! which are large pieces of the surface, or are supplied by the caller. Layouts computed here never mirror a piece:
//! faces that are counterclockwise from outside are counterclockwise in the map.
//!
//! Texel (x, y) has its center at `(x + 0.5, y + 0.5)`. Row 0 is the top. Texture coordinates go from 0 to 1, with v
//! down.

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

/// Layout of a texture map. Stores the face that each texel shows, and the corners of each face.
#[derive(Clone, Debug, PartialEq)]
pub struct Atlas {
    faces: Raster<u32>,
    /// Corners of every face, in texels; NaN for a face that is not in the map.
    corners: Vec<[DVec2; 3]>,
    /// Whether every mipmap level is usable. In a layout of tiles, coarse levels mix unrelated faces.
    mipmaps: bool,
}

/// Maximum padding around charts and tiles, in texels.
const PADDING_MAX: u32 = 1 << 10;

/// Marks a texel without a face.
const NONE: u32 = u32::MAX;

impl Atlas {
    /// Lays out charts: pieces of the surface, each flattened as a whole. Their borders follow creases where possible.
    /// They are packed by shape into a square map with a side of `side` texels.
    ///
    /// All texels cover about the same area of the surface ([`AtlasReport::stretch`]). More than 512 charts are packed
    /// in rows, which is much faster but leaves more of the map empty.
    ///
    /// The padding is 1 texel for sides below 512; otherwise it is a 1024th of the side, rounded down, but at least 2.
    /// Charts are twice the padding apart. All texels between charts extend the nearest chart, so every mipmap level is
    /// usable.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Range`] if the charts with their padding do not fit, or if `side` is above 2^14.
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

    /// Lays out charts like [`charts`](Self::charts), with the given padding, from 1 to 1024 texels.
    ///
    /// With `3 * 2^k` texels, bilinear sampling of a mipmap's first `k + 2` levels mixes in no other chart.
    ///
    /// # Errors
    ///
    /// Same as [`charts`](Self::charts), and [`SynthErrorKind::Range`] if `padding` is out of range.
    pub fn charts_padded(surface: &Surface, side: u32, padding: u32) -> Result<Self, SynthError> {
        Self::charts_with(surface, side, Some(padding), |_| ControlFlow::Continue(()))
    }

    /// Lays out charts like [`charts`](Self::charts), with a callback that receives the completed fraction of the work,
    /// from 0 to 1, and can cancel. `padding` is as in [`charts_padded`](Self::charts_padded); `None` means the padding
    /// of [`charts`](Self::charts).
    ///
    /// The callback is called after each flattened chart and for each attempt to pack all of them, but not while the
    /// surface is cut into charts.
    ///
    /// # Errors
    ///
    /// Same as [`charts_padded`](Self::charts_padded), and [`SynthErrorKind::Cancelled`] if the callback cancels.
    pub fn charts_with(
        surface: &Surface,
        side: u32,
        padding: Option<u32>,
        mut callback: impl FnMut(f64) -> ControlFlow<()> + Send,
    ) -> Result<Self, SynthError> {
        let padding = padding.unwrap_or_else(|| charts::padding(side));
        charts::charts(surface, side, padding, &mut callback)
    }

    /// Lays out all faces as right triangles of the same size, two per square tile, as in the paper. The map is a
    /// square of `side` texels.
    ///
    /// Texels around a triangle extend it, so that interpolation between texels mixes in no other face. This padding is
    /// the largest power of two up to a 16th of a tile's side, but at least 1 texel.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Range`] if a tile would have fewer texels than its padding needs, or if `side` is above 2^14.
    /// The message states the side that is needed.
    pub fn uniform(surface: &Surface, side: u32) -> Result<Self, SynthError> {
        tiles::uniform(surface, side, tiles::padding(surface, side))
    }

    /// Lays out triangles like [`uniform`](Self::uniform), with the given padding, from 1 to 1024 texels.
    ///
    /// A mipmap level averages 2 × 2 texels of the level before. With a padding of `2^k` texels and a side that is a
    /// multiple of it, tiles begin at multiples of `2^k`. Bilinear sampling of the first `k + 1` levels then mixes in
    /// no other face.
    ///
    /// # Errors
    ///
    /// Same as [`uniform`](Self::uniform), and [`SynthErrorKind::Range`] if `padding` is out of range.
    pub fn uniform_padded(surface: &Surface, side: u32, padding: u32) -> Result<Self, SynthError> {
        tiles::uniform(surface, side, padding)
    }

    /// Lays out right triangles in tiles whose sides are powers of two. Larger faces get larger tiles, so that texels
    /// have about the same size on the surface. The padding is the same as in [`uniform`](Self::uniform).
    ///
    /// # Errors
    ///
    /// Same as [`uniform`](Self::uniform).
    pub fn by_area(surface: &Surface, side: u32) -> Result<Self, SynthError> {
        tiles::by_area(surface, side, tiles::padding(surface, side))
    }

    /// Lays out triangles like [`by_area`](Self::by_area), with the given padding as in
    /// [`uniform_padded`](Self::uniform_padded).
    ///
    /// # Errors
    ///
    /// Same as [`uniform_padded`](Self::uniform_padded).
    pub fn by_area_padded(surface: &Surface, side: u32, padding: u32) -> Result<Self, SynthError> {
        tiles::by_area(surface, side, padding)
    }

    /// Builds an atlas from the caller's layout. `uvs` has the texture coordinates of the three corners of every face,
    /// with v down. A face may be in any unit square, since integer offsets are removed. Parts of a face outside the
    /// unit square of its center are not shown.
    ///
    /// Where faces overlap, the one with the lowest index is shown. A border of `padding` texels around covered texels
    /// is filled, too. If `padding` equals the side of the map, all texels are filled, and no mipmap level mixes in
    /// texels without a face.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Count`] unless `uvs` has an entry for each face, and [`SynthErrorKind::Range`] if a side is 0
    /// or above 2^14.
    pub fn from_uvs(
        surface: &Surface,
        uvs: &[[DVec2; 3]],
        size: [u32; 2],
        padding: u32,
    ) -> Result<Self, SynthError> {
        own_uvs::from_uvs(surface, uvs, size, padding)
    }

    /// Returns the size of the map in texels: columns and rows.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.faces.size()
    }

    /// Returns the texture coordinates of the corners of every face, from 0 to 1, with v down; NaN for a face that is
    /// not in the map.
    #[must_use]
    pub fn uvs(&self) -> Vec<[DVec2; 3]> {
        let size = self.faces.size().map(f64::from);
        let uv = |corner: DVec2| corner / DVec2::from(size);
        self.corners.iter().map(|face| face.map(uv)).collect()
    }

    /// Returns whether every mipmap level is usable. In a layout of tiles it is not: past the level that the padding
    /// allows, texels mix faces that are far apart on the surface, and no padding is wide enough for the coarsest
    /// levels.
    pub(crate) fn mipmaps(&self) -> bool {
        self.mipmaps
    }

    /// Returns the fraction of texels that show a face, padding included, from 0 to 1.
    #[must_use]
    pub fn coverage(&self) -> f64 {
        let covered = self.faces.pixels().iter().filter(|face| **face != NONE);
        covered.count() as f64 / self.faces.pixels().len() as f64
    }

    /// Measures the quality of the layout on `surface`, for which it was built.
    #[must_use]
    pub fn report(&self, surface: &Surface) -> AtlasReport {
        AtlasReport::new(self, surface)
    }

    /// Returns the L2 stretch of every face. [`AtlasReport::stretch`] is the root mean square of these values. The
    /// stretch is above 1 where texels are larger on the surface than on average, and NaN for a face that is not in the
    /// map.
    #[must_use]
    pub fn stretches(&self, surface: &Surface) -> Vec<f64> {
        report::stretches(self, surface)
    }

    /// Returns the face that a texel shows; `None` if it shows no face.
    ///
    /// # Panics
    ///
    /// If the texel is outside the map.
    #[must_use]
    pub fn face(&self, [column, row]: [u32; 2]) -> Option<FaceIdx> {
        let face = self.faces.row(row)[column as usize];
        (face != NONE).then_some(FaceIdx(face))
    }

    /// Returns the surface point at the center of `texel`. It is on the texel's face or, in the padding, on the face
    /// adjacent to it. Past a border of the mesh, it is the point where the path meets the border. `None` if the texel
    /// shows no face.
    ///
    /// # Panics
    ///
    /// If the texel is outside the map.
    #[must_use]
    pub fn point(&self, surface: &Surface, texel: [u32; 2]) -> Option<SurfacePoint> {
        let face = self.face(texel)?;
        let corners = self.corners[face.index()];
        let weights = weights(corners, tangents::center(texel));
        let point = surface.point(face, weights);
        if weights.iter().all(|&weight| weight >= 0.0) {
            return Some(point);
        }
        // Walk from the centroid of the face, which unfolds the faces across its edges.
        let middle = surface.point(face, [1.0 / 3.0; 3]);
        let path = point.flat - middle.flat;
        let length = path.length();
        // Limit the distance: in a caller's layout, texels next to a sliver are far from its centroid.
        let distance = length.min(surface.area().sqrt());
        Some(surface.walk(middle, path / length, distance).point)
    }
}

/// Returns the barycentric weights of the position `at` in the triangle `a`, `b`, `c`.
fn weights([a, b, c]: [DVec2; 3], at: DVec2) -> [f64; 3] {
    // A weight is the area of the triangle opposite to the corner, relative to the whole triangle.
    let area = (b - a).perp_dot(c - a);
    let of_b = (at - a).perp_dot(c - a) / area;
    let of_c = (b - a).perp_dot(at - a) / area;
    [1.0 - of_b - of_c, of_b, of_c]
}

/// Returns an error if `padding` is not from 1 to [`PADDING_MAX`].
fn check_padding(padding: u32) -> Result<(), SynthError> {
    let holds = (1..=PADDING_MAX).contains(&padding);
    SynthError::check(holds, "padding", padding.into(), "from 1 to 1024")
}

/// Returns an error if `side` is not from 1 to [`MAP_MAX`].
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

/// Maximum side of a texture map, in texels.
const MAP_MAX: u32 = 1 << 14;

#[cfg(test)]
mod tests;
