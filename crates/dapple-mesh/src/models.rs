//! Models to put textures on, made of blended shapes: our own stand-ins for those of Turk's figure 5.
//!
//! Each is one smooth closed surface about two units large around the origin. Animals look toward +z with y up, so that
//! their left is +x; their modules name places on the surface to start directions from. The functions take the number of
//! triangles that is wanted, from 16 to 2^24: 10,000 to 20,000 show all there is.
//!
//! # Examples
//!
//! ```
//! use dapple_mesh::models::{self, ray};
//!
//! let mesh = models::ray(2000)?;
//! assert_eq!(mesh.faces().len(), 2000);
//! assert!(ray::SNOUT.z > 0.0);
//! # Ok::<(), dapple_mesh::MeshError>(())
//! ```

pub mod blended_tori;
pub mod bunny;
pub mod elephant;
pub mod octopus;
pub mod ray;
pub mod zebra;

pub use blended_tori::blended_tori;
pub use bunny::bunny;
pub use elephant::elephant;
pub use octopus::octopus;
pub use ray::ray;
pub use zebra::zebra;

use crate::solid::{Ball, Ellipsoid, Placed, RoundCone, rotation};
use glam::DVec3;

fn ball([x, y, z]: [f64; 3], radius: f64) -> Ball {
    let center = DVec3::new(x, y, z);
    Ball { center, radius }
}

fn ellipsoid(center: [f64; 3], radii: [f64; 3]) -> Ellipsoid {
    let [center, radii] = [center, radii].map(DVec3::from_array);
    Ellipsoid { center, radii }
}

/// A round cone between two balls `[x, y, z, radius]`.
fn cone(from: [f64; 4], to: [f64; 4]) -> RoundCone {
    let ends = [from, to].map(|[x, y, z, _]| DVec3::new(x, y, z));
    let radii = [from[3], to[3]];
    RoundCone { ends, radii }
}

/// An ellipsoid turned by angles about z, then y, then x, in radians.
fn turned(center: [f64; 3], radii: [f64; 3], [x, y, z]: [f64; 3]) -> Placed<Ellipsoid> {
    let rotation = rotation(DVec3::X, x) * rotation(DVec3::Y, y) * rotation(DVec3::Z, z);
    Placed {
        solid: ellipsoid([0.0; 3], radii),
        rotation,
        offset: DVec3::from_array(center),
    }
}

#[cfg(test)]
mod tests;
