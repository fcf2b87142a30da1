//! A layout that the caller brings along.

use super::tangents::center;
use super::{Atlas, NONE, check_side, weights};
use crate::{SynthError, SynthErrorKind};
use dapple_mesh::Surface;
use dapple_raster::Raster;
use glam::DVec2;

/// How far outside of a face a texel's center still counts as inside, in weights: rounding leaves no gap between faces.
const ROUNDING: f64 = 1e-9;

pub(super) fn from_uvs(
    surface: &Surface,
    uvs: &[[DVec2; 3]],
    size: [u32; 2],
    padding: u32,
) -> Result<Atlas, SynthError> {
    check_side(size[0])?;
    check_side(size[1])?;
    if uvs.len() != surface.mesh().faces().len() {
        return Err(SynthError::new(SynthErrorKind::Count {
            what: "faces with uv",
            count: uvs.len(),
            needed: "as many as the mesh has",
        }));
    }
    let mut faces = Raster::filled(size, NONE)?;
    let scale = DVec2::new(f64::from(size[0]), f64::from(size[1]));
    let corners: Vec<[DVec2; 3]> = uvs.iter().map(|face| place(*face, scale)).collect();
    for (face, corners) in (0..).zip(&corners) {
        cover(&mut faces, face, corners);
    }
    for _ in 0..padding {
        let wider = spread(&faces);
        if wider == faces {
            break;
        }
        faces = wider;
    }
    Ok(Atlas { faces, corners })
}

/// The corners in texels, brought into the unit square; NaN for a face without an area or far outside of it.
fn place(uvs: [DVec2; 3], scale: DVec2) -> [DVec2; 3] {
    let turns = ((uvs[0] + uvs[1] + uvs[2]) / 3.0).floor();
    let corners = uvs.map(|uv| (uv - turns) * scale);
    let area = (corners[1] - corners[0]).perp_dot(corners[2] - corners[0]);
    if area.is_finite() && area != 0.0 {
        corners
    } else {
        [DVec2::NAN; 3]
    }
}

/// Gives a face the texels whose centers it covers and that no face has yet.
fn cover(faces: &mut Raster<u32>, face: u32, corners: &[DVec2; 3]) {
    let [a, b, c] = *corners;
    if !a.is_finite() {
        return;
    }
    let size = faces.size();
    let texels = |low: f64, high: f64, length: u32| {
        let last = f64::from(length);
        let [from, until] = [(low - 0.5).ceil(), (high - 0.5).floor() + 1.0];
        from.clamp(0.0, last) as u32..until.clamp(0.0, last) as u32
    };
    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
    for row in texels(low.y, high.y, size[1]) {
        for column in texels(low.x, high.x, size[0]) {
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

/// Gives every free texel beside a face that face; beside several the one with the lowest index.
fn spread(faces: &Raster<u32>) -> Raster<u32> {
    let [width, height] = faces.size();
    let mut wider = faces.clone();
    for row in 0..height {
        for column in 0..width {
            let texel = &mut wider.pixels_mut()[(row * width + column) as usize];
            if *texel != NONE {
                continue;
            }
            let rows = row.saturating_sub(1)..=(row + 1).min(height - 1);
            let columns = column.saturating_sub(1) as usize..=(column + 1).min(width - 1) as usize;
            let near = rows.flat_map(|row| faces.row(row)[columns.clone()].iter().copied());
            *texel = near.min().unwrap_or(NONE);
        }
    }
    wider
}
