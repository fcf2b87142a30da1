//! Node transforms for positions and normals.

use super::document::Node;
use glam::{DMat3, DMat4, DQuat, DVec3};

/// Returns the transform from a node to its parent.
pub(super) fn local(node: &Node) -> DMat4 {
    if let Some(matrix) = &node.matrix {
        return DMat4::from_cols_array(matrix);
    }
    trs(
        node.translation.as_deref().copied(),
        node.rotation.as_deref().copied(),
        node.scale.as_deref().copied(),
    )
}

/// Composes a scale, a rotation by a quaternion, and a translation; missing parts are the identity.
pub(super) fn trs(
    translation: Option<[f64; 3]>,
    rotation: Option<[f64; 4]>,
    scale: Option<[f64; 3]>,
) -> DMat4 {
    let scale = scale.map_or(DVec3::ONE, DVec3::from_array);
    let rotation = rotation.map_or(DQuat::IDENTITY, DQuat::from_array);
    let [x, y, z] = axes(rotation);
    let translation = translation.map_or(DVec3::ZERO, DVec3::from_array);
    DMat4::from_cols(
        (x * scale.x).extend(0.0),
        (y * scale.y).extend(0.0),
        (z * scale.z).extend(0.0),
        translation.extend(1.0),
    )
}

/// Returns the matrix that transforms normals up to their lengths. It exists even if the transform has no inverse.
pub(super) fn cofactors(transform: DMat4) -> DMat3 {
    let matrix = DMat3::from_mat4(transform);
    let (x, y, z) = (matrix.x_axis, matrix.y_axis, matrix.z_axis);
    let cofactors = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
    // A mirrored transform reverses the orientation.
    if matrix.determinant() < 0.0 {
        -cofactors
    } else {
        cofactors
    }
}

/// Returns the three axes after a rotation. The quaternion need not have unit length.
fn axes(rotation: DQuat) -> [DVec3; 3] {
    let [x, y, z, w] = rotation.to_array();
    let square = x * x + y * y + z * z + w * w;
    let s = if square > 0.0 { 2.0 / square } else { 0.0 };
    [
        DVec3::new(
            1.0 - s * (y * y + z * z),
            s * (x * y + z * w),
            s * (x * z - y * w),
        ),
        DVec3::new(
            s * (x * y - z * w),
            1.0 - s * (x * x + z * z),
            s * (y * z + x * w),
        ),
        DVec3::new(
            s * (x * z + y * w),
            s * (y * z - x * w),
            1.0 - s * (x * x + y * y),
        ),
    ]
}
