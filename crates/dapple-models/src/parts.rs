//! Shorthand constructors for the shapes of the models.

use crate::solid::{Ball, Ellipsoid, Placed, RoundCone};
use dapple_mesh::rotation;
use glam::DVec3;

pub(crate) fn ball([x, y, z]: [f64; 3], radius: f64) -> Ball {
    let center = DVec3::new(x, y, z);
    Ball { center, radius }
}

pub(crate) fn ellipsoid(center: [f64; 3], radii: [f64; 3]) -> Ellipsoid {
    let [center, radii] = [center, radii].map(DVec3::from_array);
    Ellipsoid { center, radii }
}

/// Returns a round cone between two spheres, each given as `[x, y, z, radius]`.
pub(crate) fn cone(from: [f64; 4], to: [f64; 4]) -> RoundCone {
    let ends = [from, to].map(|[x, y, z, _]| DVec3::new(x, y, z));
    let radii = [from[3], to[3]];
    RoundCone { ends, radii }
}

/// Returns an ellipsoid rotated about z, then y, then x. The angles are in radians.
pub(crate) fn turned(center: [f64; 3], radii: [f64; 3], [x, y, z]: [f64; 3]) -> Placed<Ellipsoid> {
    let rotation = rotation(DVec3::X, x) * rotation(DVec3::Y, y) * rotation(DVec3::Z, z);
    Placed {
        solid: ellipsoid([0.0; 3], radii),
        rotation,
        offset: DVec3::from_array(center),
    }
}
