//! Solids of a few shapes that blend into each other, defined by their distance functions.
//!
//! A [`Solid`] is defined by the distance of a position from its surface. Shapes are a [`Ball`], an [`Ellipsoid`], a
//! [`RoundCone`], a [`Tube`] along a curve, a [`Torus`] and a [`RoundBox`]. [`Blend`] joins any of them with rounded
//! seams; [`Placed`], [`Mirrored`], [`Scaled`], [`Grown`] and [`Bent`] transform a solid;
//! [`rotation`](dapple_mesh::rotation) makes the rotation of a [`Placed`] one. [`polygonize`](crate::polygonize())
//! makes a mesh.
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

/// A part of space with an inside and an outside.
///
/// Invalid sizes (negative, not finite) make a solid that is empty or odd, never a panic.
pub trait Solid: Sync {
    /// The distance to the surface, below zero inside.
    ///
    /// It may be inexact, but must change by at most a fifth more than the position moves: otherwise parts of the
    /// surface may be missed.
    fn distance(&self, at: DVec3) -> f64;

    /// The low and the high corner of a box around the solid. The distance is only used inside of it.
    fn bounds(&self) -> [DVec3; 2];
}

/// The distance to a box, below zero inside.
pub(crate) fn box_distance([low, high]: [DVec3; 2], at: DVec3) -> f64 {
    let out = (low - at).max(at - high);
    out.max(DVec3::ZERO).length() + out.max_element().min(0.0)
}

#[cfg(test)]
mod tests;
