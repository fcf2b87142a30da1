//! Maps the texture coordinates and normals of face corners from a mesh file to the repaired mesh.

use crate::error::Hint;
use anyhow::{Result, anyhow};
use dapple::mesh::{CREASE, FaceIdx, Model, Repair, Surface};
use dapple::points::glam::{DVec2, DVec3};

/// Returns the mesh's own texture coordinates for the faces of the repaired mesh.
pub(super) fn own_uvs(
    surface: &Surface,
    model: &Model,
    repair: &Repair,
) -> Result<Vec<[DVec2; 3]>> {
    let Some(uvs) = &model.uvs else {
        return Err(anyhow!("the mesh has no texture coordinates").hint("take --atlas charts"));
    };
    let own = before_repair(surface, model, repair, uvs);
    let whole = own.map(|[a, b, c]| Some([a?, b?, c?]));
    whole.collect::<Option<_>>().ok_or_else(|| {
        anyhow!("a face was cut in repair, and its texture coordinates are gone")
            .hint("take --atlas charts, or repair the mesh before")
    })
}

/// Returns, for each repaired face, the values of its corners in `column`, which has the values before the repair;
/// `None` for a corner that the repair has moved.
fn before_repair<'a, T: Copy>(
    surface: &'a Surface,
    model: &'a Model,
    repair: &'a Repair,
    column: &'a [[T; 3]],
) -> impl Iterator<Item = [Option<T>; 3]> + 'a {
    let mesh = surface.mesh();
    let faces = mesh.faces().iter().zip(&repair.face_before);
    faces.map(move |(face, &before)| {
        let corners_before = model.mesh.corners(before);
        // Match corners by position: repair may have reversed the face, or merged vertices at equal positions.
        face.map(|vertex| {
            let at = mesh.positions()[vertex.index()];
            let corner = corners_before.iter().position(|&other| other == at);
            corner.map(|corner| column[before.index()][corner])
        })
    })
}

/// Returns the normals at the corners of all faces. These are the mesh's own normals, or computed ones if the mesh has
/// none or `crease` is given. `crease` is the angle, in radians, above which an edge counts as a crease.
pub(super) fn shading(
    crease: Option<f64>,
    surface: &Surface,
    model: &Model,
    repair: &Repair,
) -> Vec<[DVec3; 3]> {
    let mut normals = surface.mesh().corner_normals(crease.unwrap_or(CREASE));
    let own = model.normals_of_corners().filter(|_| crease.is_none());
    let Some(own) = own else { return normals };
    let own = before_repair(surface, model, repair, &own);
    for ((face, corners), own) in (0..).map(FaceIdx).zip(&mut normals).zip(own) {
        let own = own.map(Option::unwrap_or_default);
        // Flip the normals of a face whose orientation the repair has reversed.
        let is_other_side = own.iter().sum::<DVec3>().dot(surface.face_normal(face)) < 0.0;
        for (corner, own) in corners.iter_mut().zip(own) {
            let own = if is_other_side { -own } else { own };
            *corner = own.try_normalize().unwrap_or(*corner);
        }
    }
    normals
}
