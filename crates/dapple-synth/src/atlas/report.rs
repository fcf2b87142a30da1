//! Measures the quality of a layout.
//!
//! Reference: Pedro V. Sander, John Snyder, Steven J. Gortler and Hugues Hoppe, "Texture Mapping Progressive Meshes",
//! SIGGRAPH 2001, doi 10.1145/383259.383307, section 3: the stretch of a parameterization.

use super::{Atlas, NONE, tangents, weights};
use dapple_mesh::{FaceEdge, FaceIdx, Surface};
use glam::DVec2;

/// Quality of a layout for a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct AtlasReport {
    /// Number of pieces. A piece is a set of faces that are connected both in the map and on the surface.
    pub pieces: usize,
    /// Fraction of texels whose centers lie on their faces, padding excluded; from 0 to 1.
    pub used: f64,
    /// L2 stretch of Sander et al. This is the root mean square length of a texel on the surface, over all directions,
    /// divided by the length it would have if all texels were squares of equal size. It is at least 1.
    pub stretch: f64,
}

impl AtlasReport {
    pub(super) fn new(atlas: &Atlas, surface: &Surface) -> Self {
        Self {
            pieces: pieces(atlas, surface)
                .into_iter()
                .filter(|&piece| piece != NONE)
                .max()
                .map_or(0, |last| last as usize + 1),
            used: used(atlas),
            stretch: stretch(atlas, surface),
        }
    }
}

/// Returns the index of each face's piece, from 0; [`NONE`] for a face that is not in the map.
pub(super) fn pieces(atlas: &Atlas, surface: &Surface) -> Vec<u32> {
    let corners = &atlas.corners;
    let mut pieces = vec![NONE; corners.len()];
    let (mut count, mut open) = (0, Vec::new());
    for first in (0..corners.len() as u32).map(FaceIdx) {
        if pieces[first.index()] != NONE || !corners[first.index()][0].is_finite() {
            continue;
        }
        pieces[first.index()] = count;
        open.push(first);
        // Add the faces across edges that have the same ends in the map.
        while let Some(face) = open.pop() {
            let edges = [0, 1, 2].map(|edge| FaceEdge { face, edge });
            for (from, to) in edges.map(|from| (from, surface.adjacency().across(from))) {
                let Some(to) = to.filter(|to| pieces[to.face.index()] == NONE) else {
                    continue;
                };
                let ([a, b], [c, d]) = (ends(corners, from), ends(corners, to));
                if a == d && b == c {
                    pieces[to.face.index()] = count;
                    open.push(to.face);
                }
            }
        }
        count += 1;
    }
    pieces
}

/// Returns the positions of the two ends of an edge in the map, in texels.
fn ends(corners: &[[DVec2; 3]], at: FaceEdge) -> [DVec2; 2] {
    let start = usize::from(at.edge);
    [start, (start + 1) % 3].map(|corner| corners[at.face.index()][corner])
}

/// Returns the fraction of the texels whose centers are on their faces.
fn used(atlas: &Atlas) -> f64 {
    let [width, height] = atlas.size();
    let is_on = |texel: [u32; 2]| {
        atlas.face(texel).is_some_and(|face| {
            let weights = weights(atlas.corners[face.index()], tangents::center(texel));
            weights.iter().all(|&weight| weight >= 0.0)
        })
    };
    let texels = (0..height).flat_map(|row| (0..width).map(move |column| [column, row]));
    let count = texels.filter(|&texel| is_on(texel)).count();
    count as f64 / (f64::from(width) * f64::from(height))
}

/// Returns the L2 stretch over all faces in the map, weighted by their areas.
fn stretch(atlas: &Atlas, surface: &Surface) -> f64 {
    let (mut sum, mut area) = (0.0, 0.0);
    for (face, stretch) in (0..).map(FaceIdx).zip(stretches(atlas, surface)) {
        if stretch.is_finite() {
            // The stretch of a mesh is the root mean square over its area.
            sum += stretch * stretch * surface.face_area(face);
            area += surface.face_area(face);
        }
    }
    if area > 0.0 { (sum / area).sqrt() } else { 1.0 }
}

/// Returns the L2 stretch of every face; NaN for a face that is not in the map.
pub(super) fn stretches(atlas: &Atlas, surface: &Surface) -> Vec<f64> {
    let (mut on_surface, mut in_map) = (0.0, 0.0);
    let faces = (0..).map(FaceIdx).zip(&atlas.corners);
    let reaches: Vec<f64> = faces
        .map(|(face, corners)| {
            let reach = reach(surface, face, *corners);
            if reach.is_finite() {
                let [a, b, c] = *corners;
                on_surface += surface.face_area(face);
                in_map += 0.5 * (b - a).perp_dot(c - a).abs();
            }
            reach
        })
        .collect();
    // Normalize by the mean density of texels.
    let density = if on_surface > 0.0 {
        (in_map / on_surface).sqrt()
    } else {
        1.0
    };
    reaches.into_iter().map(|reach| reach * density).collect()
}

/// Returns the root mean square length, over all directions, of a texel on the surface; NaN for a face that is not in
/// the map.
fn reach(surface: &Surface, face: FaceIdx, [a, b, c]: [DVec2; 3]) -> f64 {
    let [pa, pb, pc] = surface.mesh().corners(face);
    let (b, c, pb, pc) = (b - a, c - a, pb - pa, pc - pa);
    // The derivatives of the position along u and v.
    let area = b.perp_dot(c);
    let [along_u, along_v] = [pb * c.y - pc * b.y, pc * b.x - pb * c.x].map(|along| along / area);
    // L2 stretch of a triangle: sqrt((|∂p/∂u|² + |∂p/∂v|²) / 2).
    (0.5 * (along_u.length_squared() + along_v.length_squared())).sqrt()
}
