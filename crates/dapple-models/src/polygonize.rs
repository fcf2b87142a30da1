//! Polygonization of solids: closed, manifold and consistently wound meshes with nearly equilateral triangles.
//!
//! References: Akio Doi and Akio Koide, "An Efficient Method of Triangulating Equi-Valued Surfaces by Using
//! Tetrahedral Cells", IEICE Transactions E74 (1991), for marching tetrahedra; Mario Botsch and Leif Kobbelt, "A
//! Remeshing Approach to Multiresolution Modeling", SGP 2004, doi 10.1145/1057432.1057457, for remeshing.
//!
//! The lattice is body-centered cubic and divides space into congruent tetrahedra. Every tetrahedron that the surface
//! crosses gets one or two triangles with corners on its edges. Two triangles therefore meet at every edge for any
//! solid, which marching cubes and surface nets do not guarantee. Remeshing then collapses the shortest edges where
//! the topology allows it, flips edges, and moves vertices along the surface. Every vertex is on the surface within
//! [`TOLERANCE`].

mod sheet;
mod tetrahedra;

use crate::solid::{Solid, box_distance};
use crate::{ModelError, ModelErrorKind};
use dapple_mesh::Mesh;
use glam::DVec3;
use sheet::Sheet;

/// Maximum distance of a vertex from the surface, as measured by the solid, relative to the side of the lattice's
/// cubes.
pub const TOLERANCE: f64 = 1e-6;

/// Fraction of the lattice's triangles that remain after short edges are collapsed.
const KEPT: f64 = 0.5;
/// Maximum number of cells along an axis.
const CELLS_MAX: f64 = 4096.0;
/// Maximum number of triangles in a mesh.
const TRIANGLES_MAX: usize = 1 << 24;

/// Converts a solid to a mesh, on a lattice of cubes with sides of length `side`.
///
/// Parts thinner than about half of `side` may be missed. The edges of the mesh are about as long as `side`. A solid
/// that extends beyond its bounds is clipped.
///
/// # Errors
///
/// [`ModelErrorKind::Range`] if the side is not above 0 or below 1/4096 of the bounds, or the bounds are not finite;
/// [`ModelErrorKind::NoSurface`] if no surface was found; [`ModelErrorKind::Open`] if the surface has holes because
/// the distance changes faster than [`Solid::distance`] allows.
pub fn polygonize(solid: &dyn Solid, side: f64) -> Result<Mesh, ModelError> {
    let cut = Cut::new(solid, side)?;
    let sheet = cut.sheet()?;
    let count = KEPT * sheet.n_faces() as f64;
    evened(&cut, sheet, count as usize)
}

/// Converts a solid to a mesh with the given number of triangles, on a lattice of cubes with sides of length `side`
/// or less.
///
/// The side determines which parts and holes are found. The number of triangles determines how finely they are
/// meshed. It is met exactly (one less if odd), unless it is too small for the shape: a mesh of a few hundred
/// triangles may have slightly more.
///
/// # Errors
///
/// Same as [`polygonize`], and [`ModelErrorKind::Range`] unless `n_triangles` is from 16 to 2^24.
pub fn polygonize_n(solid: &dyn Solid, side: f64, n_triangles: usize) -> Result<Mesh, ModelError> {
    let holds = (16..=TRIANGLES_MAX).contains(&n_triangles);
    let wanted = n_triangles as f64;
    ModelError::check(holds, "number of triangles", wanted, "from 16 to 2^24")?;
    let mut cut = Cut::new(solid, side)?;
    let mut sheet = cut.sheet()?;
    // The number of triangles grows with the inverse square of the side, and slightly more where thin parts are
    // found.
    while (sheet.n_faces() as f64) * KEPT < 0.9 * wanted {
        let finer = (sheet.n_faces() as f64 * KEPT / wanted).sqrt().max(0.25);
        cut = Cut::new(solid, cut.side * finer)?;
        sheet = cut.sheet()?;
    }
    // A closed mesh has an even number of triangles.
    evened(&cut, sheet, n_triangles / 2 * 2)
}

/// A solid clipped at its bounds, and the side of the lattice's cubes.
struct Cut<'a> {
    solid: &'a dyn Solid,
    bounds: [DVec3; 2],
    side: f64,
}

impl<'a> Cut<'a> {
    fn new(solid: &'a dyn Solid, side: f64) -> Result<Self, ModelError> {
        let bounds = solid.bounds();
        for corner in bounds {
            let largest = corner.abs().max_element();
            let holds = corner.is_finite() && largest <= 1e15;
            ModelError::check(holds, "bound of the solid", largest, "at most 1e15")?;
        }
        let least = (bounds[1] - bounds[0]).max_element() / CELLS_MAX;
        let holds = side > 0.0 && side >= least && side <= 1e15;
        let range = "above 0, at least 1/4096 of the bounds, and at most 1e15";
        ModelError::check(holds, "side of the lattice's cells", side, range)?;
        Ok(Self {
            solid,
            bounds,
            side,
        })
    }

    fn tolerance(&self) -> f64 {
        TOLERANCE * self.side
    }

    fn distance(&self, at: DVec3) -> f64 {
        let distance = self.solid.distance(at);
        if distance.is_nan() {
            return f64::MAX;
        }
        distance.max(box_distance(self.bounds, at))
    }

    /// Marches the tetrahedra of the lattice and returns the surface.
    fn sheet(&self) -> Result<Sheet, ModelError> {
        let (positions, faces) = tetrahedra::march(self);
        if faces.is_empty() {
            return Err(ModelError::new(ModelErrorKind::NoSurface));
        }
        Sheet::new(positions, faces)
    }
}

/// Remeshes a closed surface until about `count` triangles remain.
fn evened(cut: &Cut, mut sheet: Sheet, count: usize) -> Result<Mesh, ModelError> {
    /// Maximum number of rounds. Each round removes at least a few percent of the faces until no edge can be
    /// collapsed.
    const ROUNDS: u32 = 60;
    /// Number of final rounds without collapses. More rounds hardly improve the angles.
    const LAST_ROUNDS: u32 = 3;
    for _ in 0..ROUNDS {
        let before = sheet.n_faces();
        if before <= count {
            break;
        }
        sheet.collapse(cut, count);
        if sheet.n_faces() == before {
            break;
        }
        sheet.flip();
        sheet.smooth(cut);
    }
    for _ in 0..LAST_ROUNDS {
        sheet.flip();
        sheet.smooth(cut);
    }
    sheet.into_mesh()
}

#[cfg(test)]
pub(crate) mod tests;
