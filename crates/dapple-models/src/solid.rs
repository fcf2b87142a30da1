//! Solids made of a few shapes that blend into each other, defined by distance functions.
//!
//! A [`Solid`] is defined by a signed distance function. The shapes are [`Ball`], [`Ellipsoid`], [`RoundCone`],
//! [`Tube`] along a curve, [`Torus`] and [`RoundBox`]. [`Blend`] joins solids with rounded seams.
//! [`Placed`], [`Mirrored`], [`Scaled`], [`Grown`] and [`Bent`] transform a solid;
//! [`rotation`](dapple_mesh::rotation) gives the rotation of a [`Placed`] solid. [`polygonize`](crate::polygonize())
//! converts a solid to a mesh.
//!
//! Reference: John C. Hart, "Sphere Tracing: A Geometric Method for the Antialiased Ray Tracing of Implicit Surfaces",
//! The Visual Computer 12 (1996), doi 10.1007/s003710050084, for distance bounds and how they compose; the formulas of
//! the shapes are derived here. Lengths are in units of the caller.
//!
//! # Examples
//!
//! ```
//! use dapple_mesh::glam::DVec3;
//! use dapple_models::polygonize;
//! use dapple_models::solid::{Ball, Blend, RoundCone};
//!
//! // A lollipop.
//! let head = Ball { center: DVec3::Y, radius: 0.5 };
//! let stick = RoundCone { ends: [DVec3::ZERO, DVec3::Y], radii: [0.1, 0.1] };
//! let mesh = polygonize(&Blend::of(head).with(stick, 0.1), 0.1)?;
//! assert!(mesh.faces().len() > 100);
//! # Ok::<(), dapple_models::ModelError>(())
//! ```

mod change;
mod combine;
mod shape;
mod tube;

pub use change::{Bent, Grown, Mirrored, Placed, Scaled};
pub use combine::Blend;
pub use shape::{Ball, Ellipsoid, RoundBox, RoundCone, Torus};
pub use tube::Tube;

use glam::DVec3;

/// A region of space, given by a distance function.
///
/// Invalid sizes (negative or not finite) give an empty or distorted solid, never a panic.
pub trait Solid: Sync {
    /// Returns the signed distance from `at` to the surface, negative inside.
    ///
    /// It may be inexact. It must change by at most 1.2 times the change of the position; otherwise parts of the
    /// surface may be missed.
    fn distance(&self, at: DVec3) -> f64;

    /// Returns the minimum and maximum corners of a bounding box. The distance is only used within it.
    fn bounds(&self) -> [DVec3; 2];
}

/// Returns the signed distance to a box, negative inside.
pub(crate) fn box_distance([low, high]: [DVec3; 2], at: DVec3) -> f64 {
    let out = (low - at).max(at - high);
    out.max(DVec3::ZERO).length() + out.max_element().min(0.0)
}

#[cfg(test)]
mod tests;
