//! The hull of a space ship, as a mesh: wedges on top of each other, and a bridge at the stern.

use dapple_preview::{Mesh, PreviewError};
use glam::DVec3;

/// A slab between two wedges: for the lower and the upper one the height, half the width at the nose and at the stern,
/// and where nose and stern are along z.
type Slab = [[f64; 5]; 2];

const SLABS: [Slab; 7] = [
    // The hull below and above its rim.
    [[-0.7, 0.05, 0.9, -2.2, 3.0], [-0.06, 0.08, 2.2, -4.5, 3.2]],
    [[-0.06, 0.05, 2.1, -4.4, 3.1], [0.06, 0.05, 2.1, -4.4, 3.1]],
    [[0.06, 0.08, 2.2, -4.5, 3.2], [0.55, 0.05, 1.0, -2.4, 3.0]],
    // Decks.
    [[0.5, 0.1, 0.85, -1.2, 2.9], [0.8, 0.08, 0.75, -0.9, 2.8]],
    [[0.75, 0.3, 0.55, 0.9, 2.7], [1.1, 0.25, 0.45, 1.1, 2.6]],
    // The neck and the bridge.
    [[1.05, 0.18, 0.22, 1.9, 2.5], [1.4, 0.14, 0.18, 2.0, 2.45]],
    [[1.4, 0.6, 0.6, 1.95, 2.5], [1.68, 0.5, 0.5, 2.05, 2.4]],
];

/// The hull, about 8 units long with its nose at -z, with flat faces.
pub(super) fn hull() -> Result<Mesh, PreviewError> {
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for slab in SLABS {
        let first = positions.len() as u32;
        for [y, nose, stern, front, back] in slab {
            let corners = [(-nose, front), (nose, front), (stern, back), (-stern, back)];
            positions.extend(corners.map(|(x, z)| DVec3::new(x, y, z)));
        }
        let quads = [
            [0, 1, 2, 3],
            [4, 7, 6, 5],
            [0, 4, 5, 1],
            [1, 5, 6, 2],
            [2, 6, 7, 3],
            [3, 7, 4, 0],
        ];
        for [a, b, c, d] in quads.map(|quad| quad.map(|corner| first + corner)) {
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    Mesh::flat(&positions, &triangles)
}

/// Two directions along a face and the one out of it, for a slice of a solid texture: along the length of the ship if
/// the face is more level than upright, and along its height if not.
pub(super) fn axes(normal: DVec3) -> [DVec3; 3] {
    let along = if normal.y.abs() > 0.5 {
        DVec3::Z
    } else {
        DVec3::Y
    };
    let across = normal.cross(along).normalize_or(DVec3::X);
    [across, normal.cross(across), normal]
}
