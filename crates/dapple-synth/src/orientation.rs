//! Which way the texture runs: a tangent vector at every site from a few directions of the user.
//!
//! Source: Greg Turk, "Texture Synthesis on Surfaces", SIGGRAPH 2001, section 4.1,
//! <https://doi.org/10.1145/383259.383297>; after the pull-push of Steven Gortler, Radek Grzeszczuk, Richard Szeliski and
//! Michael Cohen, "The Lumigraph", SIGGRAPH 1996, <https://doi.org/10.1145/237170.237200>.
//!
//! All of the method: directions go to their nearest sites and are pulled up to the coarsest level, diffused there with
//! the known ones held fixed, and pushed down to the finest. Where the paper is silent or slow:
//!
//! * a weight travels with every pulled vector, as in the Lumigraph; a coarse site is known where it is at least 0.01,
//!   and on the way down each level mixes the known vectors in by their weights, so that a site with a direction gets
//!   just that direction;
//! * the diffusion on the coarsest level is filled in breadth first and then solved, not repeated until it settles, as
//!   that takes as many steps as the square of the number of sites across the surface;
//! * the way down ends, on every level, with a few sweeps of equation 4, which take out the facets of interpolation;
//! * a connected part of the surface without any direction runs along a fixed axis.
//!
//! Fields with a [`Symmetry`] are the smoothest ones on the coarsest level (`smooth.rs`). Of the turns at a place one is stored,
//! that of most neighbors (`comb.rs`), and on the way down means are those of the nearest turns.
//!
//! Positions are in units of the mesh; the vectors of the result have unit length.

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

/// Shorter squared parts of unit vectors in a tangent plane count as none: a thousandth of a radian off the normal.
const LEAST_TANGENT_SQ: f64 = 1e-6;

/// A direction that the texture is to have near a position.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Direction {
    /// A position; the nearest site gets the direction.
    pub at: DVec3,
    /// Any vector; the direction of its part in the tangent plane counts.
    pub vector: DVec3,
}

/// A unit tangent vector O at every site: the texture's "down".
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
    /// The axis of parts of the surface without a direction: down in files, in which y points up.
    pub const AXIS: DVec3 = DVec3::NEG_Y;

    /// Interpolates directions over the surface; connected parts without any run along [`AXIS`](Self::AXIS).
    ///
    /// Sites that are nearest to a direction get its part in their tangent plane. Of several directions at one site the
    /// mean counts; if they cancel, it is as if none were given there.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Direction`] if a position or a vector is not finite, or if a vector is zero or within a
    /// thousandth of a radian of the normal of its site.
    pub fn new(hierarchy: &Hierarchy, directions: &[Direction]) -> Result<Self, SynthError> {
        Self::with_axis(hierarchy, directions, Self::AXIS)
    }

    /// Interpolates directions over the surface; connected parts without any run along an axis of the caller's.
    ///
    /// The axis is projected to the tangent planes; where it is normal to the surface, a vector at a right angle to it
    /// is.
    ///
    /// # Errors
    ///
    /// Those of [`new`](Self::new), and [`SynthErrorKind::Range`] if the axis is zero or not finite.
    pub fn with_axis(
        hierarchy: &Hierarchy,
        directions: &[Direction],
        axis: DVec3,
    ) -> Result<Self, SynthError> {
        let axis = checked(axis)?;
        let pulled = pull::pull(
            hierarchy,
            pull::known(hierarchy, directions, Symmetry::One)?,
        );
        Ok(Self {
            vectors: push::push(hierarchy, &pulled, axis, Symmetry::One),
            symmetry: Symmetry::One,
        })
    }

    /// The smoothest field of a symmetry that has these directions or turns of them; with [`Symmetry::One`] that of
    /// [`with_axis`](Self::with_axis).
    ///
    /// It has few singularities, which lie where the surface is most curved: a field of one direction turns around a point
    /// by whole turns, one of two or four also by half or quarter turns, and so less sharply. Connected parts without
    /// directions lie along the axis as a whole as well as they can, and not at every place.
    ///
    /// # Errors
    ///
    /// Those of [`with_axis`](Self::with_axis).
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
        let pulled = pull::pull_nearest(hierarchy, known, symmetry);
        Ok(Self {
            vectors: push::push(hierarchy, &pulled, axis, symmetry),
            symmetry,
        })
    }

    /// The field of a function of the position and the unit normal of a site, projected to the tangent planes.
    ///
    /// Where the vector is zero, not finite or normal to the surface, [`AXIS`](Self::AXIS) takes its place.
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

    /// How many directions at a place are as good as the one that is stored.
    #[must_use]
    pub fn symmetry(&self) -> Symmetry {
        self.symmetry
    }

    /// The turn of the direction of a site that is nearest to a vector.
    #[inline]
    pub(crate) fn nearest(&self, normals: &[DVec3], site: usize, vector: DVec3) -> DVec3 {
        self.symmetry
            .nearest(self.vectors[site], normals[site], vector)
    }

    /// How many quarter turns take the direction of a site nearest to the direction of another one after some quarter turns.
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

    /// The unit vectors at the sites, in the order of [`SiteIdx`](crate::SiteIdx); those of a coarser level are the
    /// first of them.
    #[must_use]
    pub fn vectors(&self) -> &[DVec3] {
        &self.vectors
    }
}

/// The unit vector along an axis.
fn checked(axis: DVec3) -> Result<DVec3, SynthError> {
    unit(axis).ok_or_else(|| {
        SynthError::new(SynthErrorKind::Range {
            what: "length of the axis",
            value: axis.length(),
            range: "finite and above 0",
        })
    })
}

/// The part of a vector in the plane with this unit normal.
#[inline]
fn flat_part(vector: DVec3, normal: DVec3) -> DVec3 {
    vector - normal * vector.dot(normal)
}

/// The unit vector in the plane with this unit normal that is nearest to a vector's direction, where there is one.
fn tangent(vector: DVec3, normal: DVec3) -> Option<DVec3> {
    let part = flat_part(unit(vector)?, normal);
    (part.length_squared() > LEAST_TANGENT_SQ).then(|| part.normalize())
}

/// The unit tangent along a unit axis, or where that is normal to the plane along another one, so that there always is
/// one.
fn axis_tangent(axis: DVec3, normal: DVec3) -> DVec3 {
    let across = axis.any_orthonormal_vector();
    tangent(axis, normal)
        .or_else(|| tangent(across, normal))
        .unwrap_or(across)
}

/// The unit vector of any finite vector but zero, without overflow.
fn unit(vector: DVec3) -> Option<DVec3> {
    let most = vector.abs().max_element();
    (vector.is_finite() && most > 0.0).then(|| (vector / most).normalize())
}
