//! Rays, and orthonormal frames.

pub(crate) use dapple_mesh::Ray;

use glam::DVec3;

/// Returns two unit vectors perpendicular to a unit vector and to each other.
///
/// Reference: Tom Duff et al., "Building an Orthonormal Basis, Revisited", Journal of Computer Graphics Techniques 6(1),
/// 2017.
pub(crate) fn frame(normal: DVec3) -> [DVec3; 2] {
    let sign = if normal.z < 0.0 { -1.0 } else { 1.0 };
    let a = -1.0 / (sign + normal.z);
    let b = normal.x * normal.y * a;
    [
        DVec3::new(
            1.0 + sign * normal.x * normal.x * a,
            sign * b,
            -sign * normal.x,
        ),
        DVec3::new(b, sign + normal.y * normal.y * a, -normal.y),
    ]
}

#[cfg(test)]
mod tests {
    use super::frame;
    use glam::DVec3;

    #[test]
    fn frame_is_orthonormal_for_directions_all_around() {
        for (x, y, z) in [
            (0.0, 0.0, 1.0),
            (0.0, 0.0, -1.0),
            (1.0, 0.0, 0.0),
            (0.3, -2.0, -0.4),
            (-5.0, 1.0, 1e-9),
        ] {
            let normal = DVec3::new(x, y, z).normalize();
            let [a, b] = frame(normal);
            // A dozen roundings of numbers of size 1.
            let zero = [a.dot(b), a.dot(normal), b.dot(normal)];
            let one = [a.length() - 1.0, b.length() - 1.0];
            for error in zero.into_iter().chain(one) {
                assert!(error.abs() < 1e-14, "{normal}: {error}");
            }
        }
    }
}
