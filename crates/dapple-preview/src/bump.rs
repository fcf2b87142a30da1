//! Bump mapping with solid textures.
//!
//! Reference: James F. Blinn, "Simulation of Wrinkled Surfaces", SIGGRAPH 1978, doi 10.1145/800248.507101. A surface
//! that is moved along its unit normal `n` by a small height `h` has the normal `n - (g - (g·n) n)`, with `g` the
//! gradient of `h` in space. No parametrization of the surface is needed, so the method fits solid textures.
//!
//! A bumped surface lit at a grazing angle turns dark abruptly where the smooth surface faces away from the light.
//! This boundary is softened by the probability that bumps of this slope see the light: Alejandro Conty Estevez,
//! Pascal Lecocq and Clifford Stein, "A Microfacet-Based Shadowing Function to Solve the Bump Terminator Problem",
//! Ray Tracing Gems, chapter 12, 2019.

use glam::DVec3;

/// Minimum cosine between a bumped normal and the direction to the eye. Below it, the back of the bump would be
/// visible.
const FACING_MIN: f64 = 1e-3;

/// Returns the unit normal of a bumped surface. It faces the eye.
///
/// `normal` is the unit normal of the smooth surface, `gradient` the gradient of the height, and `to_eye` the unit
/// vector to the eye, all in the same space. A gradient that overflows has no effect.
pub(crate) fn bumped(normal: DVec3, gradient: DVec3, to_eye: DVec3) -> DVec3 {
    let along_surface = gradient - normal * gradient.dot(normal);
    let bumped = (normal - along_surface).try_normalize().unwrap_or(normal);
    facing(bumped, to_eye)
}

/// Returns the unit vector nearest to `normal` that faces the eye.
pub(crate) fn facing(normal: DVec3, to_eye: DVec3) -> DVec3 {
    let cosine = normal.dot(to_eye);
    if cosine >= FACING_MIN {
        return normal;
    }
    let lifted = normal + to_eye * (FACING_MIN - cosine);
    lifted.try_normalize().unwrap_or(to_eye)
}

/// Returns the fraction of the light, from 0 to 1, that is not blocked by neighboring bumps.
///
/// `cosine` is the cosine between the smooth normal and the light, `slope` the cosine between the smooth and the
/// bumped normal.
pub(crate) fn bump_shadow(cosine: f64, slope: f64) -> f64 {
    if cosine <= 0.0 {
        return 0.0;
    }
    let tangent_sq = |cosine: f64| (1.0 - cosine * cosine).max(0.0) / (cosine * cosine).max(1e-12);
    // Evaluate the GGX masking function with the roughness that matches the slope of the bump.
    let roughness_sq = (0.125 * tangent_sq(slope)).clamp(0.0, 1.0);
    2.0 / (1.0 + (1.0 + roughness_sq * tangent_sq(cosine)).sqrt())
}

#[cfg(test)]
mod tests {
    use super::{FACING_MIN, bump_shadow, bumped, facing};
    use glam::DVec3;

    #[test]
    fn bump_of_a_slope_tilts_the_normal_against_it() {
        // A height that rises by 3/4 along x over the plane y = 0 has the normal (-3, 4, 0) / 5.
        let normal = bumped(DVec3::Y, DVec3::new(0.75, 0.0, 0.0), DVec3::Y);
        let expected = DVec3::new(-0.6, 0.8, 0.0);
        // One division and one product.
        assert!((normal - expected).length() < 1e-15, "{normal}");
    }

    #[test]
    fn bump_along_the_normal_has_no_effect() {
        let normal = bumped(DVec3::Z, DVec3::new(0.0, 0.0, 9.0), DVec3::Z);
        assert_eq!(normal, DVec3::Z);
    }

    #[test]
    fn bump_stays_on_the_side_of_the_eye_when_steep() {
        let to_eye = DVec3::new(0.995, 0.1, 0.0).normalize();
        let normal = bumped(DVec3::Y, DVec3::new(50.0, 0.0, 0.0), to_eye);
        assert!(normal.dot(to_eye) > 0.0, "{normal}");
        assert!((normal.length() - 1.0).abs() < 1e-14, "{normal}");
        let away = facing(-to_eye, to_eye);
        assert!(away.dot(to_eye) > 0.5 * FACING_MIN, "{away}");
    }

    #[test]
    fn bump_that_overflows_leaves_the_normal() {
        let normal = bumped(DVec3::Y, DVec3::new(1e300, 0.0, 1e300), DVec3::Y);
        assert_eq!(normal, DVec3::Y);
    }

    #[test]
    fn bump_shadow_is_one_without_bumps_and_falls_to_zero_at_the_horizon() {
        assert_eq!(bump_shadow(0.3, 1.0), 1.0, "smooth");
        assert_eq!(bump_shadow(-0.1, 0.9), 0.0, "behind the horizon");
        let parts: Vec<f64> = [1.0, 0.5, 0.1, 0.001]
            .iter()
            .map(|&cosine| bump_shadow(cosine, 0.8))
            .collect();
        assert!(parts.is_sorted_by(|a, b| a > b), "{parts:?}");
        assert!(parts[3] < 0.01, "{parts:?}");
    }
}
