//! Converts a glTF scene to a single mesh.

use super::accessor::{Budget, Column};
use super::document::{Instancing, Primitive};
use super::material::Placement;
use super::skin::{Influences, Pose};
use super::transform::{local, trs};
use super::{Source, unsupported, wrong};
use crate::MeshIoError;
use crate::polygon::{fan, strip};
use dapple_color::{LinearRgb, LinearRgba};
use dapple_mesh::{Mesh, Model};
use glam::{DAffine2, DMat4, DVec2, DVec3};
use std::collections::{BTreeMap, BTreeSet};

/// Accessors of positions, normals, colors and texture coordinates.
type Attributes = [Option<usize>; 4];

/// Sources of the vertices of a primitive: accessors and morph targets.
struct Vertices<'a> {
    attributes: Attributes,
    /// Transform of texture coordinates.
    map: DAffine2,
    /// Morph targets with nonzero weights.
    targets: Vec<(f64, &'a BTreeMap<String, usize>)>,
    /// Accessors of joints and weights, if the mesh has a skin.
    influences: Vec<[usize; 2]>,
}

struct Draft<'a> {
    source: &'a Source<'a>,
    budget: Budget,
    positions: Vec<DVec3>,
    /// Normals of all vertices; incomplete if a primitive lacks them.
    normals: Vec<DVec3>,
    /// Colors of the vertices, up to the last vertex that has one. The field `uvs` is shortened in the same way.
    colors: Vec<LinearRgba>,
    uvs: Vec<DVec2>,
    faces: Vec<[u32; 3]>,
    material: Option<usize>,
    /// Indices of the materials that the faces use; `None` for the default material.
    materials: BTreeSet<Option<usize>>,
    /// Whether the scene has lines. `has_further_uvs` is whether it has texture coordinate sets that no texture uses.
    has_lines: bool,
    has_further_uvs: bool,
}

/// Reads the model without its material, and the index of the material. `n_bytes` is the size of the file and its
/// buffers.
pub(super) fn read(
    source: &Source<'_>,
    n_bytes: usize,
) -> Result<(Model, Option<usize>), MeshIoError> {
    let mut draft = Draft {
        source,
        budget: Budget::new(n_bytes),
        positions: Vec::new(),
        normals: Vec::new(),
        colors: Vec::new(),
        uvs: Vec::new(),
        faces: Vec::new(),
        material: None,
        materials: BTreeSet::new(),
        has_lines: false,
        has_further_uvs: false,
    };
    let nodes = &source.document.nodes;
    let has_skins = nodes.iter().any(|node| node.skin.is_some());
    let worlds = if has_skins {
        source.worlds()
    } else {
        Vec::new()
    };
    let mut seen = vec![false; nodes.len()];
    let mut open: Vec<_> = roots(source)?
        .into_iter()
        .rev()
        .map(|root| (root, DMat4::IDENTITY))
        .collect();
    while let Some((index, parent)) = open.pop() {
        let node = nodes
            .get(index)
            .ok_or_else(|| wrong(format!("there is no node {index}")))?;
        // Nodes form trees, so each is visited once.
        if core::mem::replace(&mut seen[index], true) {
            return Err(wrong(format!("node {index} has two parents")));
        }
        let transform = parent * local(node);
        open.extend(node.children.iter().rev().map(|&child| (child, transform)));
        let Some(mesh) = node.mesh else {
            continue;
        };
        let weights = node.weights.as_deref();
        let extensions = node.extensions.as_deref().filter(|_| node.skin.is_none());
        match extensions.and_then(|extensions| extensions.instancing.as_ref()) {
            None => {
                let pose = source.pose(node, transform, &worlds, &mut draft.budget)?;
                draft.add_mesh(mesh, weights, &pose)?;
            }
            Some(instancing) => {
                for copy in draft.copies(instancing)? {
                    draft.add_mesh(mesh, weights, &Pose::Node(transform * copy))?;
                }
            }
        }
    }
    draft.into_model()
}

/// Returns the root nodes of the default scene. A file without scenes has all nodes without a parent as roots.
fn roots(source: &Source<'_>) -> Result<Vec<usize>, MeshIoError> {
    let document = &source.document;
    if document.scene.is_none() && document.scenes.is_empty() {
        let mut root = vec![true; document.nodes.len()];
        for &child in document.nodes.iter().flat_map(|node| &node.children) {
            if let Some(root) = root.get_mut(child) {
                *root = false;
            }
        }
        return Ok((0..root.len()).filter(|&node| root[node]).collect());
    }
    let scene = document.scene.unwrap_or(0);
    let scene = document
        .scenes
        .get(scene)
        .ok_or_else(|| wrong(format!("there is no scene {scene}")))?;
    Ok(scene.nodes.clone())
}

impl Draft<'_> {
    /// Returns the transform of each instance of a node's mesh.
    fn copies(
        &mut self,
        instancing: &Instancing,
    ) -> Result<impl Iterator<Item = DMat4> + use<>, MeshIoError> {
        let mut column = |name: &str, width: usize| {
            let accessor = instancing.attributes.get(name).copied();
            self.column(accessor, width..=width, false)
        };
        let translations = column("TRANSLATION", 3)?;
        let rotations = column("ROTATION", 4)?;
        let scales = column("SCALE", 3)?;
        let count = |column: &Column| column.values.len() / column.width;
        let columns = [&translations, &rotations, &scales];
        let counts: Vec<_> = columns.into_iter().flatten().map(count).collect();
        let Some(&n_copies) = counts.first() else {
            return Err(wrong("instances have no translation, rotation or scale"));
        };
        if counts.iter().any(|&count| count != n_copies) {
            return Err(wrong("attributes of instances have different counts"));
        }
        Ok((0..n_copies).map(move |i| {
            let (translation, scale) = (element(&translations, i), element(&scales, i));
            trs(translation, element(&rotations, i), scale)
        }))
    }

    fn add_mesh(
        &mut self,
        index: usize,
        weights: Option<&[f64]>,
        pose: &Pose,
    ) -> Result<(), MeshIoError> {
        let mesh = self.source.document.meshes.get(index);
        let mesh = mesh.ok_or_else(|| wrong(format!("there is no mesh {index}")))?;
        let weights = weights.or(mesh.weights.as_deref()).unwrap_or_default();
        let turned = pose.is_mirrored();
        // First vertex of each combination of attributes that was already added.
        let mut known = BTreeMap::new();
        for primitive in &mesh.primitives {
            self.budget.take(1)?;
            let mode = primitive.mode.unwrap_or(4);
            if !matches!(mode, 0 | 4..=6) {
                self.has_lines = true;
                continue;
            }
            let vertices = self.vertices(primitive, weights, pose);
            let Some(positions) = vertices.attributes[0] else {
                continue;
            };
            // Compressed data without an uncompressed fallback would be read as zeros.
            if self.source.is_without_bytes(positions)? {
                let extensions = primitive.extensions.as_ref().into_iter().flatten();
                let compression = |name: &&String| name.as_str() == "KHR_draco_mesh_compression";
                if let Some(name) = extensions.map(|(name, _)| name).find(compression) {
                    return Err(unsupported(format!("the glTF extension {name}")));
                }
            }
            let n_vertices = self.source.count(positions)?;
            let key = vertices.key(primitive);
            let first = match known.get(&key) {
                Some(&first) => first,
                None => self.add_vertices(&vertices, pose)?,
            };
            known.insert(key, first);
            self.material = self.material.or(primitive.material);
            if mode != 0 {
                self.materials.insert(primitive.material);
                self.add_faces(primitive, first, n_vertices, turned)?;
            }
        }
        Ok(())
    }

    fn vertices<'p>(
        &mut self,
        primitive: &'p Primitive,
        weights: &[f64],
        pose: &Pose,
    ) -> Vertices<'p> {
        let material = primitive.material;
        let placement =
            material.map_or(Placement::PLAIN, |material| self.source.placement(material));
        let attribute = |name: &str| primitive.attributes.get(name).copied();
        let uvs = format!("TEXCOORD_{}", placement.set);
        let is_further = |name: &String| name.starts_with("TEXCOORD_") && *name != uvs;
        self.has_further_uvs |= primitive.attributes.keys().any(is_further);
        let influences = |set: usize| {
            let joints = attribute(&format!("JOINTS_{set}"))?;
            Some([joints, attribute(&format!("WEIGHTS_{set}"))?])
        };
        let influences = (0..).map_while(influences);
        let targets = weights.iter().copied().zip(&primitive.targets);
        Vertices {
            attributes: [
                attribute("POSITION"),
                attribute("NORMAL"),
                attribute("COLOR_0"),
                attribute(&uvs),
            ],
            map: placement.map,
            targets: targets.filter(|(weight, _)| *weight != 0.0).collect(),
            influences: match pose {
                Pose::Node(_) => Vec::new(),
                Pose::Skin(_) => influences.collect(),
            },
        }
    }

    /// Reads a vector attribute and applies the morph targets.
    fn vectors(
        &mut self,
        name: &str,
        accessor: Option<usize>,
        vertices: &Vertices<'_>,
    ) -> Result<Option<Vec<DVec3>>, MeshIoError> {
        let Some(column) = self.column(accessor, 3..=3, name == "NORMAL")? else {
            return Ok(None);
        };
        let vectors = column.values.chunks_exact(3).map(DVec3::from_slice);
        let mut vectors: Vec<_> = vectors.collect();
        for (weight, target) in &vertices.targets {
            let Some(moves) = self.column(target.get(name).copied(), 3..=3, false)? else {
                continue;
            };
            if moves.values.len() != column.values.len() {
                return Err(wrong("attributes of a morph target have different counts"));
            }
            let moves = moves.values.chunks_exact(3).map(DVec3::from_slice);
            for (vector, by) in vectors.iter_mut().zip(moves) {
                *vector += *weight * by;
            }
        }
        Ok(Some(vectors))
    }

    /// Reads the joints and weights of the vertices.
    fn influences(&mut self, vertices: &Vertices<'_>) -> Result<Influences, MeshIoError> {
        let mut influences = Influences::default();
        for &[joints, weights] in &vertices.influences {
            let joints = self.source.column(joints, false, &mut self.budget)?;
            influences.add(joints, self.source.column(weights, true, &mut self.budget)?);
        }
        Ok(influences)
    }

    /// Adds vertices, and returns the index of the first one.
    fn add_vertices(&mut self, vertices: &Vertices<'_>, pose: &Pose) -> Result<u32, MeshIoError> {
        let [positions, normals, colors, uvs] = vertices.attributes;
        let first = self.positions.len();
        let whole = self.normals.len() == first;
        let mut positions = self
            .vectors("POSITION", positions, vertices)?
            .unwrap_or_default();
        let normals = self.vectors("NORMAL", normals, vertices)?.filter(|_| whole);
        let mut normals = normals.unwrap_or_default();
        let influences = self.influences(vertices)?;
        if !influences.fits(positions.len()) {
            return Err(wrong(
                "a vertex has not four joints and weights in each set",
            ));
        }
        pose.apply(&influences, &mut positions, &mut normals)?;
        self.positions.append(&mut positions);
        self.normals.append(&mut normals);
        let end = self.positions.len();
        if let Some(colors) = self.column(colors, 3..=4, true)? {
            self.colors
                .resize(first, LinearRgba::opaque(LinearRgb::WHITE));
            self.colors
                .extend(colors.values.chunks_exact(colors.width).map(color));
        }
        if let Some(uvs) = self.column(uvs, 2..=2, true)? {
            self.uvs.resize(first, DVec2::ZERO);
            let uvs = uvs.values.chunks_exact(2).map(DVec2::from_slice);
            if vertices.map == DAffine2::IDENTITY {
                self.uvs.extend(uvs);
            } else {
                self.uvs
                    .extend(uvs.map(|uv| vertices.map.transform_point2(uv)));
            }
        }
        // A longer column would overlap the vertices of the next primitive.
        if [self.normals.len(), self.colors.len(), self.uvs.len()]
            .into_iter()
            .any(|n| n > first && n != end)
        {
            return Err(wrong("attributes of a primitive have different counts"));
        }
        // All indices fit if the last one does.
        let fits = u32::try_from(end).is_ok();
        let first = u32::try_from(first).ok().filter(|_| fits);
        first.ok_or_else(|| wrong("there are too many vertices"))
    }

    /// Reads an attribute, if the primitive has it.
    fn column(
        &mut self,
        accessor: Option<usize>,
        widths: core::ops::RangeInclusive<usize>,
        fractions: bool,
    ) -> Result<Option<Column>, MeshIoError> {
        let Some(accessor) = accessor else {
            return Ok(None);
        };
        let column = self.source.column(accessor, fractions, &mut self.budget)?;
        if !widths.contains(&column.width) {
            return Err(wrong(format!(
                "accessor {accessor} has {} numbers in each element",
                column.width
            )));
        }
        Ok(Some(column))
    }

    fn add_faces(
        &mut self,
        primitive: &Primitive,
        first: u32,
        n_vertices: usize,
        turned: bool,
    ) -> Result<(), MeshIoError> {
        let indices = match primitive.indices {
            Some(accessor) => self.source.indices(accessor, &mut self.budget)?,
            None => {
                self.budget.take(n_vertices)?;
                (0..n_vertices as u32).collect()
            }
        };
        if let Some(index) = indices.iter().find(|&&index| index as usize >= n_vertices) {
            return Err(wrong(format!(
                "an index is {index}, but there are {n_vertices} vertices"
            )));
        }
        // In strips and fans each index is used for up to three corners.
        self.budget.take(indices.len().saturating_mul(3))?;
        let mut add = |[a, b, c]: [u32; 3]| {
            let [b, c] = if turned { [c, b] } else { [b, c] };
            self.faces.push([a, b, c].map(|index| first + index));
        };
        match primitive.mode {
            Some(5) => strip(&indices).for_each(&mut add),
            Some(6) => fan(&indices).for_each(&mut add),
            _ => indices.as_chunks().0.iter().copied().for_each(&mut add),
        }
        Ok(())
    }

    fn into_model(mut self) -> Result<(Model, Option<usize>), MeshIoError> {
        let count = self.positions.len();
        let mut model = Model::from(Mesh::new(self.positions, &self.faces)?);
        if count > 0 && self.normals.len() == count {
            model.normals = Some(self.normals);
        }
        if !self.colors.is_empty() {
            self.colors
                .resize(count, LinearRgba::opaque(LinearRgb::WHITE));
            model.colors = Some(self.colors);
        }
        if !self.uvs.is_empty() {
            self.uvs.resize(count, DVec2::ZERO);
            let face = |face: &[u32; 3]| face.map(|vertex| self.uvs[vertex as usize]);
            model.uvs = Some(self.faces.iter().map(face).collect());
        }
        if self.materials.len() > 1 {
            model.left_out.push(Model::FURTHER_MATERIALS.to_owned());
        }
        for (is_there, what) in [
            (self.has_lines, "lines"),
            (self.has_further_uvs, "further sets of texture coordinates"),
        ] {
            if is_there {
                model.left_out.push(what.to_owned());
            }
        }
        Ok((model, self.material))
    }
}

impl Vertices<'_> {
    /// Returns a key that identifies the vertices of a primitive. Primitives of a mesh with equal keys share their
    /// vertices.
    fn key(&self, primitive: &Primitive) -> (Attributes, Option<usize>, Vec<Option<usize>>) {
        let material = primitive
            .material
            .filter(|_| self.map != DAffine2::IDENTITY);
        let targets = self.targets.iter();
        let targets =
            targets.flat_map(|(_, target)| [target.get("POSITION"), target.get("NORMAL")]);
        let influences = self.influences.iter().flatten().copied().map(Some);
        (
            self.attributes,
            material,
            targets
                .map(Option::<&usize>::copied)
                .chain(influences)
                .collect(),
        )
    }
}

/// Returns the components of element `index`; `None` if there is no column.
fn element<const N: usize>(column: &Option<Column>, index: usize) -> Option<[f64; N]> {
    let (elements, _) = column.as_ref()?.values.as_chunks();
    elements.get(index).copied()
}

fn color(parts: &[f64]) -> LinearRgba {
    let part = |i: usize| parts.get(i).map_or(1.0, |&part| part as f32);
    LinearRgba {
        color: LinearRgb::new(part(0), part(1), part(2)),
        alpha: part(3),
    }
}
