//! Builds atlases from a layout that the caller supplies.

use super::tangents::center;
use super::{Atlas, NONE, check_side, weights};
use crate::{SynthError, SynthErrorKind};
use dapple_mesh::Surface;
use dapple_raster::Raster;
use glam::DVec2;

/// Tolerance of the inside test for texel centers, in barycentric weights, so that rounding leaves no gap between
/// faces.
const ROUNDING: f64 = 1e-9;

pub(super) fn from_uvs(
    surface: &Surface,
    uvs: &[[DVec2; 3]],
    size: [u32; 2],
    padding: u32,
) -> Result<Atlas, SynthError> {
    if uvs.len() != surface.mesh().faces().len() {
        return Err(SynthError::new(SynthErrorKind::Count {
            what: "faces with uv",
            count: uvs.len(),
            needed: "as many as the mesh has",
        }));
    }
    let scale = DVec2::new(f64::from(size[0]), f64::from(size[1]));
    covered(
        uvs.iter().map(|face| place(*face, scale)).collect(),
        size,
        padding,
    )
}

/// Builds the atlas in which each face covers the texels between its corners, plus a border of `padding` texels.
pub(super) fn covered(
    corners: Vec<[DVec2; 3]>,
    size: [u32; 2],
    padding: u32,
) -> Result<Atlas, SynthError> {
    check_side(size[0])?;
    check_side(size[1])?;
    let mut faces = Raster::filled(size, NONE)?;
    for (face, corners) in (0..).zip(&corners) {
        cover(&mut faces, face, corners);
    }
    spread(&mut faces, padding);
    Ok(Atlas {
        faces,
        corners,
        mipmaps: true,
    })
}

/// Converts the texture coordinates of a face to texels, and translates them by whole units so that the centroid is in
/// the unit square. NaN for a face that has no area or is too far away.
fn place(uvs: [DVec2; 3], scale: DVec2) -> [DVec2; 3] {
    // Move the face to the unit square of its centroid.
    let turns = ((uvs[0] + uvs[1] + uvs[2]) / 3.0).floor();
    let corners = uvs.map(|uv| (uv - turns) * scale);
    let area = (corners[1] - corners[0]).perp_dot(corners[2] - corners[0]);
    if area.is_finite() && area != 0.0 {
        corners
    } else {
        [DVec2::NAN; 3]
    }
}

/// Assigns `face` to the texels whose centers it covers, unless they already show another face.
fn cover(faces: &mut Raster<u32>, face: u32, corners: &[DVec2; 3]) {
    let [a, b, c] = *corners;
    if !a.is_finite() {
        return;
    }
    let size = faces.size();
    // Range of texels whose centers are between two positions along an axis.
    let texels = |low: f64, high: f64, length: u32| {
        let last = f64::from(length);
        // The center of texel i is at i + 0.5.
        let [from, until] = [(low - 0.5).ceil(), (high - 0.5).floor() + 1.0];
        from.clamp(0.0, last) as u32..until.clamp(0.0, last) as u32
    };
    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
    for row in texels(low.y, high.y, size[1]) {
        for column in texels(low.x, high.x, size[0]) {
            // The first face to cover a texel keeps it.
            let inside = weights(*corners, center([column, row]))
                .iter()
                .all(|&weight| weight >= -ROUNDING);
            let texel = &mut faces.pixels_mut()[(row * size[0] + column) as usize];
            if inside && *texel == NONE {
                *texel = face;
            }
        }
    }
}

/// Dilates the covered texels `padding` times: each new texel shows the face of an adjacent texel, the one with the
/// lowest index if there are several.
fn spread(faces: &mut Raster<u32>, padding: u32) {
    let covered = faces.pixels().iter().enumerate();
    let mut ring: Vec<usize> = covered
        .filter_map(|(texel, &face)| (face != NONE).then_some(texel))
        .collect();
    let mut next: Vec<(usize, u32)> = Vec::new();
    for _ in 0..padding {
        // Collect the free neighbors of the last ring.
        next.clear();
        for &texel in &ring {
            let face = faces.pixels()[texel];
            for near in neighbors(texel, faces.size()) {
                if faces.pixels()[near] == NONE {
                    next.push((near, face));
                }
            }
        }
        if next.is_empty() {
            return;
        }
        // Keep the lowest face of each texel.
        next.sort_unstable();
        next.dedup_by_key(|(texel, _)| *texel);
        for &(texel, face) in &next {
            faces.pixels_mut()[texel] = face;
        }
        ring.clear();
        ring.extend(next.iter().map(|(texel, _)| texel));
    }
}

/// Returns the indices of `texel` itself and its neighbors, diagonal ones included.
fn neighbors(texel: usize, size: [u32; 2]) -> impl Iterator<Item = usize> {
    let [width, height] = size.map(|length| length as usize);
    let (row, column) = (texel / width, texel % width);
    let rows = row.saturating_sub(1)..=(row + 1).min(height - 1);
    rows.flat_map(move |row| {
        let columns = column.saturating_sub(1)..=(column + 1).min(width - 1);
        columns.map(move |column| row * width + column)
    })
}
