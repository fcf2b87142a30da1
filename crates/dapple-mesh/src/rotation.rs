//! Rotations whose results have the same bits on every platform.

use glam::{DQuat, DVec3};

/// Returns the rotation by `angle` radians about a unit `axis`, counterclockwise when looking from the tip of the
/// axis.
///
/// The result has the same bits on every platform, unlike the constructors of `glam`.
///
/// # Examples
///
/// ```
/// use dapple_mesh::{glam::DVec3, rotation};
/// use std::f64::consts::FRAC_PI_2;
///
/// let turned = rotation(DVec3::Z, FRAC_PI_2) * DVec3::X;
/// assert!((turned - DVec3::Y).length() < 1e-15);
/// ```
pub fn rotation(axis: DVec3, angle: f64) -> DQuat {
    let (sin, cos) = libm::sincos(0.5 * angle);
    DQuat::from_vec4((sin * axis).extend(cos))
}
