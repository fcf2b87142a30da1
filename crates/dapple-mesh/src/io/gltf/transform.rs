//! Where the nodes of glTF take positions and normals.

use super::document::Node;
use glam::{DMat3, DMat4, DQuat, DVec3};

/// The transform of a node to its parent.
pub(super) fn local(node: &Node) -> DMat4 {
    if let Some(matrix) = &node.matrix {
        return DMat4::from_cols_array(matrix);
    }
    let vector = |parts: &Option<Box<[f64; 3]>>, default| {
        parts
            .as_deref()
            .map_or(default, |&parts| DVec3::from_array(parts))
    };
    let scale = vector(&node.scale, DVec3::ONE);
    let rotation = node
        .rotation
        .as_deref()
        .map_or(DQuat::IDENTITY, |&parts| DQuat::from_array(parts));
    let [x, y, z] = axes(rotation);
    let translation = vector(&node.translation, DVec3::ZERO);
    DMat4::from_cols(
        (x * scale.x).extend(0.0),
        (y * scale.y).extend(0.0),
        (z * scale.z).extend(0.0),
        translation.extend(1.0),
    )
}

/// What takes normals along with a transform, but for their lengths; also where that has no inverse.
pub(super) fn cofactors(transform: DMat4) -> DMat3 {
    let matrix = DMat3::from_mat4(transform);
    let (x, y, z) = (matrix.x_axis, matrix.y_axis, matrix.z_axis);
    let cofactors = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
    // A mirror image has its outside where the cofactors say inside.
    if matrix.determinant() < 0.0 {
        -cofactors
    } else {
        cofactors
    }
}

/// Where a rotation takes the axes. The quaternion need not be of unit length.
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
