//! Splits vertices, for formats that have normals only per vertex.

use dapple_mesh::{Mesh, MeshError, Model, VertexIdx};
use glam::DVec3;
use std::borrow::Cow;

/// Converts a model's corner normals to vertex normals.
///
/// A vertex is split where its corners have different normals. Vertices keep their indices, and additional ones
/// follow.
///
/// # Errors
///
/// If the mesh would have too many vertices, as in [`Mesh::new`].
pub(crate) fn with_vertex_normals(model: &Model) -> Result<Cow<'_, Model>, MeshError> {
    let Some(corner_normals) = &model.corner_normals else {
        return Ok(Cow::Borrowed(model));
    };
    let mut split = Split::new(&model.mesh);
    let mut faces = Vec::with_capacity(corner_normals.len());
    for (&[a, b, c], &[na, nb, nc]) in model.mesh.faces().iter().zip(corner_normals) {
        faces.push(
            [(a, na), (b, nb), (c, nc)].map(|(vertex, normal)| split.vertex_with(vertex, normal).0),
        );
    }
    let spread = |vertex: &usize| model.mesh.positions()[*vertex];
    let mesh = Mesh::new(split.vertex.iter().map(spread).collect(), &faces)?;
    let colors = model.colors.as_ref();
    let colors = colors.map(|colors| split.vertex.iter().map(|&vertex| colors[vertex]).collect());
    let normals = split.normals.into_iter().map(Option::unwrap_or_default);
    Ok(Cow::Owned(Model {
        mesh,
        colors,
        uvs: model.uvs.clone(),
        normals: Some(normals.collect()),
        corner_normals: None,
        material: model.material.clone(),
        tiles: model.tiles.clone(),
        left_out: Vec::new(),
    }))
}

struct Split {
    /// For each new vertex, the mesh vertex that it is a copy of. The first entries are the mesh vertices in order.
    vertex: Vec<usize>,
    /// Normal of each new vertex; `None` until a corner sets it.
    normals: Vec<Option<DVec3>>,
    /// For each new vertex, the next copy of the same mesh vertex; `None` for the last copy.
    next: Vec<Option<usize>>,
}

impl Split {
    fn new(mesh: &Mesh) -> Self {
        let count = mesh.positions().len();
        Self {
            vertex: (0..count).collect(),
            normals: vec![None; count],
            next: vec![None; count],
        }
    }

    /// Returns the copy of a vertex that has this normal. The copy is created if it does not exist.
    fn vertex_with(&mut self, vertex: VertexIdx, normal: DVec3) -> VertexIdx {
        let mut at = vertex.index();
        while *self.normals[at].get_or_insert(normal) != normal {
            let new = self.vertex.len();
            at = *self.next[at].get_or_insert(new);
            if at == new {
                self.vertex.push(vertex.index());
                self.normals.push(None);
                self.next.push(None);
            }
        }
        // The index fits for up to 2^30 faces, whose normals alone take 72 GiB.
        VertexIdx(at as u32)
    }
}
