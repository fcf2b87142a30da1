//! Displacement: moves the vertices of a mesh along their normals by heights, which changes the shape and not only the
//! shading.
//!
//! Reference: our own.
//!
//! Units: a height times the scale is a length in units of the mesh; positive heights move outward. A mesh can only
//! show heights whose features are larger than its edges: the triangles of the sites are fine enough for all features,
//! the triangles of the input mesh often are not.

use crate::maps::{check_column, check_finite};
use crate::{SynthError, Synthesizer};
use dapple_mesh::Mesh;
use glam::DVec3;

/// Builds the triangles of the finest sites ([`Hierarchy::triangles`](crate::Hierarchy::triangles)), with every site
/// moved along its normal by its height times `scale`.
///
/// # Errors
///
/// [`SynthErrorKind::Count`](crate::SynthErrorKind::Count) unless there is one height per site,
/// [`SynthErrorKind::Range`](crate::SynthErrorKind::Range) if a height or the scale is not finite, and
/// [`SynthErrorKind::Mesh`](crate::SynthErrorKind::Mesh) if a vertex moves beyond 1e30.
pub fn displaced_sites(
    synthesizer: &Synthesizer,
    heights: &[f32],
    scale: f64,
) -> Result<Mesh, SynthError> {
    check(synthesizer, heights, scale)?;
    let hierarchy = synthesizer.hierarchy();
    let mesh = hierarchy.triangles(0)?.mesh;
    let normals = hierarchy.sites().normals();
    moved(&mesh, normals, heights, scale)
}

/// Displaces the input mesh, moving every vertex along its normal by the interpolated height times `scale`.
///
/// Vertices without a face and vertices without a nearby site do not move. Separate vertices at the same position have
/// different normals and come apart, so join them first with [`Mesh::repair`].
///
/// # Errors
///
/// Same as [`displaced_sites`].
pub fn displaced_mesh(
    synthesizer: &Synthesizer,
    heights: &[f32],
    scale: f64,
) -> Result<Mesh, SynthError> {
    check(synthesizer, heights, scale)?;
    let mesh = synthesizer.surface().mesh();
    let normals = mesh.vertex_normals();
    // Interpolate the heights at the vertices.
    let at_vertices = mesh.positions().iter().zip(&normals).map(|(&at, &normal)| {
        let height = synthesizer
            .hierarchy()
            .interpolate(0, heights, at, normal)?;
        Ok(height.unwrap_or(0.0))
    });
    let at_vertices: Vec<f32> = at_vertices.collect::<Result<_, SynthError>>()?;
    moved(mesh, &normals, &at_vertices, scale)
}

fn check(synthesizer: &Synthesizer, heights: &[f32], scale: f64) -> Result<(), SynthError> {
    check_column(synthesizer, "heights", heights.len())?;
    SynthError::check(scale.is_finite(), "scale of the heights", scale, "finite")?;
    for &height in heights {
        check_finite("height", height)?;
    }
    Ok(())
}

/// Returns `mesh` with every vertex moved along its normal by its height times `scale`.
fn moved(mesh: &Mesh, normals: &[DVec3], heights: &[f32], scale: f64) -> Result<Mesh, SynthError> {
    let vertices = mesh.positions().iter().zip(normals).zip(heights);
    let moved = vertices.map(|((&at, &normal), &height)| at + normal * (f64::from(height) * scale));
    let faces: Vec<[u32; 3]> = mesh
        .faces()
        .iter()
        .map(|face| face.map(|vertex| vertex.0))
        .collect();
    Ok(Mesh::new(moved.collect(), &faces)?)
}

#[cfg(test)]
mod tests;
