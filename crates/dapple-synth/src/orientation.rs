//! Orientation field: a unit tangent vector at every site, interpolated from a few directions that the user specifies.
//!
//! Reference: Greg Turk, "Texture Synthesis on Surfaces", SIGGRAPH 2001, section 4.1,
//! <https://doi.org/10.1145/383259.383297>; after the pull-push of Steven Gortler, Radek Grzeszczuk, Richard Szeliski
//! and Michael Cohen, "The Lumigraph", SIGGRAPH 1996, <https://doi.org/10.1145/237170.237200>.
//!
//! Directions are assigned to their nearest sites and pulled up to the coarsest level. There they are diffused, with
//! the known directions held fixed, and then pushed down to the finest level. The following differs from the paper, or
//! is not specified in it:
//!
//! * every pulled vector has a weight, as in the Lumigraph. A coarse site is known if its weight is at least 0.01. On
//!   the way down each level mixes in the known vectors by their weights, so that a site with a direction gets exactly
//!   that direction;
//! * the diffusion on the coarsest level is initialized breadth first and then solved by conjugate gradients. Repeated
//!   averaging would take as many iterations as the square of the number of sites across the surface;
//! * on every finer level a few sweeps of equation 4 remove the facets of interpolation;
//! * a connected component of the surface without any given direction is oriented along a fixed axis.
//!
//! Fields with a [`Symmetry`] of two or four have equivalent directions at each site. On the coarsest level the
//! smoothest field is computed (`smooth.rs`). One direction per site is stored, chosen to agree with most neighbors
//! (`comb.rs`). On the way down, each vector is rotated to the equivalent direction nearest to the others before a mean
//! is computed.
//!
//! Positions are in units of the mesh; the resulting vectors have unit length.

mod comb;
mod pull;
mod push;
mod scales;
mod smooth;
mod symmetry;
#[cfg(test)]
mod tests;

pub use symmetry::Symmetry;
pub(crate) use symmetry::{offset_after, offset_before, turned};

use crate::{Hierarchy, SynthError, SynthErrorKind, columns};
use glam::DVec3;

/// Minimum squared length of the tangential part of a unit vector. Vectors within a thousandth of a radian of the
/// normal have no usable direction in the tangent plane.
const LEAST_TANGENT_SQ: f64 = 1e-6;

/// A texture direction near a position, specified by the user.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Direction {
    /// Position in space, in units of the mesh. The direction applies to the nearest site.
    pub at: DVec3,
    /// Vector of any length. The direction of its projection onto the tangent plane is used.
    pub vector: DVec3,
}

/// Orientation field: a unit tangent vector O at every site, which is the "down" direction of the texture.
///
/// # Examples
///
/// ```
/// use dapple_mesh::{Mesh, Surface, glam::DVec3};
/// use dapple_synth::{Direction, Hierarchy, HierarchyOptions, Orientation};
///
/// let corners = vec![DVec3::ZERO, DVec3::X, DVec3::ONE - DVec3::Z, DVec3::Y];
/// let surface = Surface::new(Mesh::new(corners, &[[0, 1, 2], [0, 2, 3]])?)?;
/// let hierarchy = Hierarchy::new(&surface, &HierarchyOptions { n_sites: 500, ..Default::default() })?;
///
/// let direction = Direction { at: DVec3::ZERO, vector: DVec3::new(3.0, 0.0, 1.0) };
/// let orientation = Orientation::new(&hierarchy, &[direction])?;
/// assert!(orientation.vectors().iter().all(|vector| vector.distance(DVec3::X) < 1e-6));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Orientation {
    vectors: Vec<DVec3>,
    symmetry: Symmetry,
}

impl Orientation {
    /// Default direction of connected components for which none is given: −y, which is down in files with y up.
    pub const AXIS: DVec3 = DVec3::NEG_Y;

    /// Interpolates `directions` over the surface. Connected components without any direction are oriented along
    /// [`AXIS`](Self::AXIS).
    ///
    /// Each direction is projected onto the tangent plane of its nearest site. Several directions at one site are
    /// averaged; if they cancel, the site counts as having none.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Direction`] if a position or a vector is not finite, or if a vector is zero or within a
    /// thousandth of a radian of the normal of its site.
    pub fn new(hierarchy: &Hierarchy, directions: &[Direction]) -> Result<Self, SynthError> {
        Self::with_axis(hierarchy, directions, Self::AXIS)
    }

    /// Interpolates `directions` over the surface. Connected components without any direction are oriented along
    /// `axis`.
    ///
    /// The axis is projected onto the tangent planes. Where it is normal to the surface, a vector perpendicular to it
    /// is used instead.
    ///
    /// # Errors
    ///
    /// Same as [`new`](Self::new), or [`SynthErrorKind::Range`] if the axis is zero or not finite.
    pub fn with_axis(
        hierarchy: &Hierarchy,
        directions: &[Direction],
        axis: DVec3,
    ) -> Result<Self, SynthError> {
        let axis = checked(axis)?;
        // Section 4.1: pull the directions up to the coarsest level, and push the field down from there.
        let pulled = pull::pull(
            hierarchy,
            pull::known(hierarchy, directions, Symmetry::One)?,
        );
        Ok(Self {
            vectors: push::push(hierarchy, &pulled, axis, Symmetry::One),
            symmetry: Symmetry::One,
        })
    }

    /// Computes the smoothest field with the given symmetry that matches the directions up to the rotations of the
    /// symmetry. With [`Symmetry::One`] this is the field of [`with_axis`](Self::with_axis).
    ///
    /// The field has few singularities, and they are where the surface is most curved. Around a singularity, a field of
    /// one direction rotates by full turns. A field of two or four directions can rotate by half or quarter turns, and
    /// so bends less sharply. A connected component without directions is rotated as a whole to fit the axis best on
    /// average.
    ///
    /// # Errors
    ///
    /// Same as [`with_axis`](Self::with_axis).
    pub fn symmetric(
        hierarchy: &Hierarchy,
        directions: &[Direction],
        axis: DVec3,
        symmetry: Symmetry,
    ) -> Result<Self, SynthError> {
        if symmetry == Symmetry::One {
            return Self::with_axis(hierarchy, directions, axis);
        }
        let axis = checked(axis)?;
        let known = pull::known(hierarchy, directions, symmetry)?;
        // Equivalent directions cannot be blurred, since they could cancel. Pull each to its nearest site instead.
        let pulled = pull::pull_nearest(hierarchy, known, symmetry);
        Ok(Self {
            vectors: push::push(hierarchy, &pulled, axis, symmetry),
            symmetry,
        })
    }

    /// Evaluates a function of position and unit normal at each site, and projects the result onto the tangent plane.
    ///
    /// Where the result is zero, not finite or normal to the surface, [`AXIS`](Self::AXIS) is used instead.
    pub fn from_fn(hierarchy: &Hierarchy, field: impl Fn(DVec3, DVec3) -> DVec3 + Sync) -> Self {
        let sites = hierarchy.sites();
        let vectors = columns::column(sites.len(), |site| {
            let (at, normal) = (sites.positions()[site], sites.normals()[site]);
            tangent(field(at, normal), normal).unwrap_or_else(|| axis_tangent(Self::AXIS, normal))
        });
        Self {
            vectors,
            symmetry: Symmetry::One,
        }
    }

    /// Returns the symmetry of the field: the number of equivalent directions at each site. One of them is stored.
    #[must_use]
    pub fn symmetry(&self) -> Symmetry {
        self.symmetry
    }

    /// Returns the direction nearest to a vector, among a site's equivalent directions.
    #[inline]
    pub(crate) fn nearest(&self, normals: &[DVec3], site: usize, vector: DVec3) -> DVec3 {
        self.symmetry
            .nearest(self.vectors[site], normals[site], vector)
    }

    /// Returns the rotation, in quarter turns, that brings the direction of `site` nearest to the direction of `other`
    /// rotated by `quarters`.
    #[inline]
    pub(crate) fn quarters_toward(
        &self,
        normals: &[DVec3],
        site: usize,
        other: usize,
        quarters: u8,
    ) -> u8 {
        if self.symmetry == Symmetry::One {
            return 0;
        }
        let other = turned(self.vectors[other], normals[other], quarters);
        self.symmetry
            .quarters_toward(self.vectors[site], normals[site], other)
    }

    /// Returns the unit vectors at the sites, in the order of [`SiteIdx`](crate::SiteIdx). The sites of coarser levels
    /// come first.
    #[must_use]
    pub fn vectors(&self) -> &[DVec3] {
        &self.vectors
    }
}

/// Returns the unit vector along an axis, or an error if the axis is zero or not finite.
fn checked(axis: DVec3) -> Result<DVec3, SynthError> {
    unit(axis).ok_or_else(|| {
        SynthError::new(SynthErrorKind::Range {
            what: "length of the axis",
            value: axis.length(),
            range: "finite and above 0",
        })
    })
}

/// Returns the component of a vector in the plane with the given unit normal.
#[inline]
fn flat_part(vector: DVec3, normal: DVec3) -> DVec3 {
    vector - normal * vector.dot(normal)
}

/// Returns the unit vector along the projection of a vector onto the plane with the given unit normal. `None` if the
/// vector is normal to the plane, zero or not finite.
fn tangent(vector: DVec3, normal: DVec3) -> Option<DVec3> {
    let part = flat_part(unit(vector)?, normal);
    (part.length_squared() > LEAST_TANGENT_SQ).then(|| part.normalize())
}

/// Returns the unit tangent along a unit axis, or along a perpendicular axis if the first one is normal to the plane.
/// Never fails.
fn axis_tangent(axis: DVec3, normal: DVec3) -> DVec3 {
    // The axis and a vector perpendicular to it cannot both be normal to the plane.
    let across = axis.any_orthonormal_vector();
    tangent(axis, normal)
        .or_else(|| tangent(across, normal))
        .unwrap_or(across)
}

/// Returns the unit vector along a vector, computed without overflow. `None` if the vector is zero or not finite.
fn unit(vector: DVec3) -> Option<DVec3> {
    // Divide by the largest component, so that squares neither overflow nor underflow.
    let most = vector.abs().max_element();
    (vector.is_finite() && most > 0.0).then(|| (vector / most).normalize())
}
