//! Converts meshes from and to arrays and files.

use crate::arrays;
use crate::error::{Error, Result};
use crate::threads;
use dapple::color::LinearRgba;
use dapple::mesh::Mesh;
use dapple::mesh::glam::DVec3;
use dapple::mesh_io;
use numpy::{AllowTypeChange, PyArrayLikeDyn, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

/// Reads vectors of `N` numbers from an array. `axes` are the lengths of the array's last axes.
pub(crate) fn vectors<const N: usize>(
    what: &str,
    data: &Bound<'_, PyAny>,
    axes: &[usize],
) -> Result<Vec<[f64; N]>> {
    let array: PyArrayLikeDyn<'_, f64, AllowTypeChange> = data.extract()?;
    let array = array.as_array();
    if array.ndim() != axes.len() + 1 || array.shape()[1..] != *axes {
        let message = format!(
            "the {what} have the shape {:?}, but they must be (n, {})",
            array.shape(),
            axes.iter()
                .map(usize::to_string)
                .collect::<Vec<_>>()
                .join(", ")
        );
        return Err(Error::new("shape", message));
    }
    let numbers: Vec<f64> = array.iter().copied().collect();
    Ok(numbers.as_chunks().0.to_vec())
}

/// Reads a mesh from an object with `.vertices` and `.faces`, or a pair of arrays.
pub(crate) fn mesh(data: &Bound<'_, PyAny>) -> Result<Mesh> {
    if data.hasattr("vertices")? && data.hasattr("faces")? {
        return mesh_of(&data.getattr("vertices")?, &data.getattr("faces")?);
    }
    let (vertices, faces): (Bound<'_, PyAny>, Bound<'_, PyAny>) = data.extract().map_err(|_| {
        let message = format!(
            "a mesh has `.vertices` and `.faces`, or is a scene of trimesh, an object of Blender, or a pair of arrays, \
             and not {}",
            data.get_type()
        );
        Error::new("type", message)
    })?;
    mesh_of(&vertices, &faces)
}

/// Converts a trimesh or Blender mesh to an object with vertices, faces and texture coordinates; other objects are
/// unchanged. The second value is whether the mesh is from Blender.
pub(crate) fn plain<'py>(data: &Bound<'py, PyAny>) -> Result<(Bound<'py, PyAny>, bool)> {
    let helper = data.py().import("dapple_textures._meshes")?;
    Ok(helper.call_method1("plain", (data,))?.extract()?)
}

/// Builds a mesh from an array of vertices and an array of faces.
pub(crate) fn mesh_of(vertices: &Bound<'_, PyAny>, faces: &Bound<'_, PyAny>) -> Result<Mesh> {
    let vertices = vectors::<3>("vertices", vertices, &[3])?;
    if let Ok(array) = faces.cast::<PyUntypedArray>()
        && !matches!(array.dtype().getattr("kind")?.extract::<char>()?, 'i' | 'u')
    {
        let message = "faces are whole numbers, those of their vertices";
        return Err(Error::new("type", message));
    }
    let faces: Vec<[i64; 3]> = {
        let array: PyArrayLikeDyn<'_, i64, AllowTypeChange> = faces.extract()?;
        let array = array.as_array();
        if array.ndim() != 2 || array.shape()[1] != 3 {
            let message = format!(
                "the faces have the shape {:?}, but they must be (n, 3)",
                array.shape()
            );
            return Err(Error::new("shape", message));
        }
        let numbers: Vec<i64> = array.iter().copied().collect();
        numbers.as_chunks().0.to_vec()
    };
    let wrong = |at: i64| !(0..vertices.len() as i64).contains(&at);
    for (face, vertex) in (0..)
        .zip(&faces)
        .flat_map(|(face, all): (usize, _)| all.map(|at| (face, at)))
    {
        if wrong(vertex) {
            let message = format!(
                "face {face} names vertex {vertex}, but there are only {}, from 0",
                vertices.len()
            );
            return Err(Error::new("corner", message));
        }
    }
    // The indices were checked above, and a mesh has fewer than 2^32 vertices.
    let faces = faces
        .iter()
        .map(|face| face.map(|at| u32::try_from(at).unwrap_or(u32::MAX)));
    let vertices = vertices.into_iter().map(DVec3::from).collect();
    Ok(Mesh::new(vertices, &faces.collect::<Vec<_>>())?)
}

/// Converts positions to an array (n, 3).
pub(crate) fn positions<'py>(py: Python<'py>, positions: &[DVec3]) -> Result<Bound<'py, PyAny>> {
    let numbers: Vec<[f64; 3]> = positions.iter().map(|at| at.to_array()).collect();
    arrays::array(py, numbers.into_flattened(), &[positions.len(), 3])
}

/// Converts the vertex indices of faces to an array (n, 3).
pub(crate) fn faces<'py>(py: Python<'py>, mesh: &Mesh) -> Result<Bound<'py, PyAny>> {
    let faces = mesh.faces().iter().flatten();
    let numbers = faces.map(|vertex| i64::from(vertex.0)).collect();
    arrays::array(py, numbers, &[mesh.faces().len(), 3])
}

/// Converts attributes of face corners to an array (n, 3, N).
pub(crate) fn corners<'py, const N: usize>(
    py: Python<'py>,
    corners: impl ExactSizeIterator<Item = [[f64; N]; 3]>,
) -> Result<Bound<'py, PyAny>> {
    let n_faces = corners.len();
    let numbers: Vec<f64> = corners.flatten().flatten().collect();
    arrays::array(py, numbers, &[n_faces, 3, N])
}

/// Reads a mesh file: OBJ, PLY, glTF, GLB, OFF or STL, chosen by its extension.
///
/// Parameters
/// ----------
/// path : str or os.PathLike
///     The path of the file.
///
/// Returns
/// -------
/// MeshFile
///     `MeshFile(vertices, faces, uv, normals, colors, texture, left_out)`. `vertices` is (n, 3) and `faces` (m, 3).
///     Per face corner, `uv` is (m, 3, 2), with v pointing down, and `normals` is (m, 3, 3). Per vertex, `colors` is
///     (n, 4) in linear light. `texture` is the base color image. Attributes that the file lacks are None; `left_out`
///     lists content that was not read.
///
/// Raises
/// ------
/// DappleError
///     If the file format is unknown, or the file is damaged.
/// OSError
///     If the system cannot read or write the file: `FileNotFoundError` if it does not exist.
///
/// Examples
/// --------
/// >>> import os, tempfile, dapple_textures as dp
/// >>> path = os.path.join(tempfile.mkdtemp(), "triangle.obj")
/// >>> _ = open(path, "w").write("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
/// >>> dp.read_model(path).faces.tolist()
/// [[0, 1, 2]]
#[pyfunction]
pub(crate) fn read_model(py: Python<'_>, path: PathBuf) -> Result<Bound<'_, PyAny>> {
    let mut model = threads::run(py, move || mesh_io::read_model(&path))??;
    let n_tiles = model.tiles.len();
    if n_tiles > 0 {
        // Skip textures with UDIM tiles, since the texture of the first tile would cover all faces.
        model.material.base_color = None;
        let what = format!("the textures of {n_tiles} unit squares (UDIM)");
        model.left_out.push(what);
    }
    let uv = model
        .uvs
        .as_ref()
        .map(|uvs| corners(py, uvs.iter().map(|face| face.map(|uv| uv.to_array()))));
    let normals = model.normals_of_corners().map(|normals| {
        corners(
            py,
            normals
                .iter()
                .map(|face| face.map(|normal| normal.to_array())),
        )
    });
    let colors = model.colors.as_ref().map(|colors| {
        let part = |at: &LinearRgba| [at.color.r, at.color.g, at.color.b, at.alpha];
        let numbers: Vec<f32> = colors.iter().flat_map(part).collect();
        arrays::array(py, numbers, &[colors.len(), 4])
    });
    let texture = model.material.base_color.as_ref().map(|image| {
        let decode = py.import("dapple_textures")?.getattr("decode_image")?;
        let content = PyDict::new(py);
        content.set_item("content", "color")?;
        decode.call((image.bytes(),), Some(&content))
    });
    let fields = (
        positions(py, model.mesh.positions())?,
        faces(py, &model.mesh)?,
        uv.transpose()?,
        normals.transpose()?,
        colors.transpose()?,
        texture.transpose()?,
        model.left_out.clone(),
    );
    let file = py.import("dapple_textures._meshes")?.getattr("MeshFile")?;
    Ok(file.call1(fields)?)
}

/// Counts the elements and faults of a mesh.
///
/// Parameters
/// ----------
/// mesh : mesh
///     Any object with `.vertices` (n, 3) and `.faces` (m, 3), such as a trimesh mesh, or a pair of such arrays.
///
/// Returns
/// -------
/// dict
///     The number of elements or faults of each kind, by name.
///
/// Raises
/// ------
/// DappleError
///     If the mesh is not one of those above, or a face refers to a missing vertex.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> report = dp.mesh_report(([[0, 0, 0], [1, 0, 0], [0, 1, 0], [5, 5, 5]], [[0, 1, 2]]))
/// >>> report["boundary_edges"], report["unused_vertices"]
/// (3, 1)
#[pyfunction]
pub(crate) fn mesh_report<'py>(
    py: Python<'py>,
    mesh: &Bound<'py, PyAny>,
) -> Result<Bound<'py, PyDict>> {
    let (mesh, _) = plain(mesh)?;
    let mesh = self::mesh(&mesh)?;
    let report = threads::run(py, move || mesh.report())?;
    let counts = PyDict::new(py);
    for (name, count) in [
        ("vertices", report.vertices),
        ("faces", report.faces),
        ("components", report.components),
        ("boundary_edges", report.boundary_edges),
        ("non_manifold_edges", report.non_manifold_edges),
        ("non_manifold_vertices", report.non_manifold_vertices),
        ("winding_edges", report.winding_edges),
        ("degenerate_faces", report.degenerate_faces),
        ("duplicate_faces", report.duplicate_faces),
        ("back_to_back_faces", report.back_to_back_faces),
        ("duplicate_vertices", report.duplicate_vertices),
        ("unused_vertices", report.unused_vertices),
    ] {
        counts.set_item(name, count)?;
    }
    Ok(counts)
}
