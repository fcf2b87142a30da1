//! Maps the texture coordinates and normals of face corners from a mesh file to the repaired mesh.

use crate::error::Hint;
use anyhow::{Result, anyhow};
use dapple::mesh::{CREASE, FaceIdx, Model, Repair, Surface};
use dapple::points::glam::{DVec2, DVec3};

/// Returns the texture coordinates in the mesh file, for the corners of the repaired mesh's faces.
pub(super) fn own_uvs(
    surface: &Surface,
    model: &Model,
    repair: &Repair,
) -> Result<Vec<[DVec2; 3]>> {
    let Some(uvs) = &model.uvs else {
        return Err(anyhow!("the mesh has no texture coordinates").hint("take --atlas charts"));
    };
    let own = repair.corners_before(&model.mesh, surface.mesh(), uvs);
    let whole = own.map(|[a, b, c]| Some([a?, b?, c?]));
    whole.collect::<Option<_>>().ok_or_else(|| {
        anyhow!("a face was cut in repair, and its texture coordinates are gone")
            .hint("take --atlas charts, or repair the mesh before")
    })
}

/// Returns the normals at the corners of all faces: those in the mesh file, or computed ones if there are none or
/// `crease` is given. `crease` is the minimum angle of a crease, in radians.
pub(super) fn shading(
    crease: Option<f64>,
    surface: &Surface,
    model: &Model,
    repair: &Repair,
) -> Vec<[DVec3; 3]> {
    let mut normals = surface.mesh().corner_normals(crease.unwrap_or(CREASE));
    let own = model.normals_of_corners().filter(|_| crease.is_none());
    let Some(own) = own else { return normals };
    let own = repair.corners_before(&model.mesh, surface.mesh(), &own);
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
