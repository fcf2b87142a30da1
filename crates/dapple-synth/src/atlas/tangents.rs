//! Computes tangent frames from texture coordinates, in the same way as other programs do for files without tangents.
//!
//! Reference: Morten S. Mikkelsen, "Simulation of Wrinkled Surfaces Revisited", master's thesis, University of
//! Copenhagen, 2008. The tangent at a corner is the mean of the tangents of all faces with the same vertex, texture
//! coordinates and handedness. Each is projected to the plane perpendicular to the vertex normal, and weighted by the
//! angle of its face. Between corners, tangents are interpolated linearly. Angles are measured on the faces, not on
//! their projections.

use super::{Atlas, weights};
use dapple_mesh::{FaceIdx, Surface};
use glam::{DVec2, DVec3};

/// Tangents along +u at the corners of all faces.
#[derive(Clone, Debug)]
pub(crate) struct Tangents {
    corners: Vec<[DVec3; 3]>,
    /// Whether each face is mirrored in the map.
    is_mirrored: Vec<bool>,
}

/// Key of the corners that share a tangent: the vertex, the bits of its position in the map, the bits of its normal,
/// and the handedness.
type Key = (u32, [u64; 2], [u64; 3], bool);

impl Tangents {
    /// Computes the tangents of a mesh. `shading` has the normal of each corner of each face.
    pub(crate) fn new(surface: &Surface, atlas: &Atlas, shading: &[[DVec3; 3]]) -> Self {
        let mesh = surface.mesh();
        let mut tangents = Self {
            corners: Vec::with_capacity(mesh.faces().len()),
            is_mirrored: Vec::with_capacity(mesh.faces().len()),
        };
        let mut shares: Vec<(Key, FaceIdx, usize, DVec3)> = Vec::new();
        for ((face, vertices), &places) in (0..).map(FaceIdx).zip(mesh.faces()).zip(&atlas.corners)
        {
            let corners = mesh.corners(face);
            let (tangent, is_mirrored) = face_tangent(corners, places);
            tangents.corners.push([tangent; 3]);
            tangents.is_mirrored.push(is_mirrored);
            for corner in 0..3 {
                let normal = shading[face.index()][corner];
                let flat = flat_part(tangent, normal).normalize_or_zero();
                // Adding zero turns -0 into 0.
                let place = (places[corner] + 0.0).to_array().map(f64::to_bits);
                let normal = (normal + 0.0).to_array().map(f64::to_bits);
                // Mikkelsen: weight the projected tangent by the angle of the face at the corner.
                let share = flat * angle(corners, corner);
                let key = (vertices[corner].0, place, normal, is_mirrored);
                shares.push((key, face, corner, share));
            }
        }
        // The sort is stable, so that sums run in the order of the faces.
        shares.sort_by_key(|share| share.0);
        for group in shares.chunk_by(|a, b| a.0 == b.0) {
            let sum: DVec3 = group.iter().map(|share| share.3).sum();
            for &(_, face, corner, _) in group {
                let tangent = &mut tangents.corners[face.index()][corner];
                *tangent = sum.normalize_or(*tangent);
            }
        }
        tangents
    }

    /// Returns the tangent and the bitangent at `texel`, perpendicular to the unit normal there. The bitangent points
    /// to the top of the map.
    pub(crate) fn frame(&self, atlas: &Atlas, texel: [u32; 2], normal: DVec3) -> [DVec3; 2] {
        let Some(face) = atlas.face(texel) else {
            let tangent = normal.any_orthonormal_vector();
            return [tangent, normal.cross(tangent)];
        };
        self.frame_of(face, weights_within(atlas, face, texel), normal)
    }

    /// Returns the tangent and the bitangent at the point of `face` with the given barycentric weights.
    pub(crate) fn frame_of(&self, face: FaceIdx, weights: [f64; 3], normal: DVec3) -> [DVec3; 2] {
        let mixed = sum(self.corners[face.index()], weights);
        let tangent = flat_part(mixed, normal).normalize_or(normal.any_orthonormal_vector());
        let up = normal.cross(tangent);
        let is_mirrored = self.is_mirrored[face.index()];
        // A mirrored face has the opposite handedness.
        [tangent, if is_mirrored { -up } else { up }]
    }
}

/// Interpolates vectors at the corners of `face` at `texel`. In the padding, returns the value at the border of the
/// face.
pub(crate) fn mixed(atlas: &Atlas, face: FaceIdx, texel: [u32; 2], corners: [DVec3; 3]) -> DVec3 {
    sum(corners, weights_within(atlas, face, texel))
}

/// Returns the barycentric weights of the center of `texel` in `face`, each clamped to the range from 0 to 1.
fn weights_within(atlas: &Atlas, face: FaceIdx, texel: [u32; 2]) -> [f64; 3] {
    let weights = weights(atlas.corners[face.index()], center(texel));
    weights.map(|weight| weight.clamp(0.0, 1.0))
}

/// Returns the weighted sum of the vectors at the corners of a face.
pub(crate) fn sum(corners: [DVec3; 3], weights: [f64; 3]) -> DVec3 {
    let parts = corners.iter().zip(weights);
    parts.map(|(&corner, weight)| corner * weight).sum()
}

/// Returns the position of a texel's center, in texels.
pub(super) fn center([column, row]: [u32; 2]) -> DVec2 {
    DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5)
}

/// Returns the direction of +u on a face, and whether the face is mirrored in the map; an arbitrary direction for a
/// face that is not in the map.
fn face_tangent([a, b, c]: [DVec3; 3], [ua, ub, uc]: [DVec2; 3]) -> (DVec3, bool) {
    let (b, c, ub, uc) = (b - a, c - a, ub - ua, uc - ua);
    // Rows go down: a face that is counterclockwise from outside and not mirrored has a negative product.
    let is_mirrored = ub.perp_dot(uc) > 0.0;
    // The derivative of the position along u, times the determinant `ub × uc`, whose sign is removed below.
    let along = b * uc.y - c * ub.y;
    let tangent = if is_mirrored { along } else { -along };
    (tangent.normalize_or_zero(), is_mirrored)
}

/// Returns the component of `vector` perpendicular to the unit vector `normal`.
fn flat_part(vector: DVec3, normal: DVec3) -> DVec3 {
    vector - normal * vector.dot(normal)
}

/// Returns the angle of a triangle at the given corner, in radians.
fn angle(corners: [DVec3; 3], corner: usize) -> f64 {
    let at = corners[corner];
    let [to, from] = [1, 2].map(|step| (corners[(corner + step) % 3] - at).normalize_or_zero());
    libm::acos(to.dot(from).clamp(-1.0, 1.0))
}
