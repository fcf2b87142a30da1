//! Heights that move a mesh: displaced along the normals, not only shaded.
//!
//! Reference: our own.
//!
//! Units: heights times the scale are lengths in units of the mesh; positive ones go out. A mesh shows only heights that
//! change more slowly than its edges are long: the triangles of the sites show all, those of the input often do not.

use crate::maps::{check_column, check_finite};
use crate::{SynthError, Synthesizer};
use dapple_mesh::Mesh;
use glam::DVec3;

/// The triangles of the finest sites ([`Hierarchy::triangles`](crate::Hierarchy::triangles)), with every site moved
/// along its normal by its height times `scale`.
///
/// # Errors
///
/// [`SynthErrorKind::Count`](crate::SynthErrorKind::Count) unless there is a height for each site,
/// [`SynthErrorKind::Range`](crate::SynthErrorKind::Range) if one or the scale is not finite, and
/// [`SynthErrorKind::Mesh`](crate::SynthErrorKind::Mesh) if a vertex goes beyond 1e30.
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

/// The input mesh, with every vertex moved along its normal by the height interpolated there times `scale`.
///
/// Vertices that no face has stay where they are, and so do those with no site in reach. Vertices at one position that
/// are not joined have normals of their own and come apart: join them first, by [`Mesh::repair`].
///
/// # Errors
///
/// Those of [`displaced_sites`].
pub fn displaced_mesh(
    synthesizer: &Synthesizer,
    heights: &[f32],
    scale: f64,
) -> Result<Mesh, SynthError> {
    check(synthesizer, heights, scale)?;
    let mesh = synthesizer.surface().mesh();
    let normals = mesh.vertex_normals();
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

/// The mesh with every vertex moved along its normal.
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
