//! GLB encoder.

use super::container::{BIN, JSON, MAGIC};
use crate::single::{narrow, origin};
use crate::split::with_vertex_normals;
use crate::{MeshIoError, MeshIoErrorKind};
use dapple_color::LinearRgba;
use dapple_mesh::{AlphaMode, EncodedImage, Material, Mesh, Model};
use glam::DVec3;
use serde_json::{Map, Value, json};

const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
/// Target of a buffer view of attributes.
const ARRAY_BUFFER: u32 = 34962;
/// Target of a buffer view of indices.
const ELEMENT_ARRAY_BUFFER: u32 = 34963;
/// Filter that interpolates between texels, for magnification, and for minification without mipmaps.
const LINEAR: u32 = 9729;
/// Minification filter that interpolates between mipmap levels.
const LINEAR_MIPMAP_LINEAR: u32 = 9987;
/// Wrap mode that repeats the texture.
const REPEAT: u32 = 10497;

/// A binary chunk under construction, with its views and accessors.
#[derive(Default)]
struct Bin {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    images: Vec<Value>,
}

/// The vertices of a GLB file. A mesh vertex is split where its corners have different texture coordinates.
struct Split {
    /// For each vertex of the file, the mesh vertex that it is a copy of. The first entries are the mesh vertices in
    /// order.
    vertex: Vec<usize>,
    uvs: Vec<[f32; 2]>,
    faces: Vec<[u32; 3]>,
}

/// Encodes the model as a GLB file.
///
/// - Numbers are rounded to `f32`. If that would move a vertex by more than 2^-20 of the extent, because the mesh is
///   far from the origin, positions are relative to the center of the mesh, which becomes the translation of the node.
/// - Vertices keep their order; where corners have different texture coordinates or normals, additional vertices
///   follow.
/// - Normals are the normals of the model, with unit length, or else
///   [`Mesh::vertex_normals`](dapple_mesh::Mesh::vertex_normals). A zero normal, which glTF does not allow, becomes
///   +z.
/// - Colors are clamped to 0 to 1. Without texture coordinates, textures are omitted.
/// - The material is rough and not metallic unless a texture defines both. It is double-sided if the model is, or if
///   the mesh is open. Its alpha mode is blend if the model's is opaque but the base color factor is not.
/// - Emission, specular and clear coat are written as `emissiveTexture`, `KHR_materials_emissive_strength`,
///   `KHR_materials_specular` and `KHR_materials_clearcoat`. The reader lists these as left out.
/// - If the material disallows mipmaps, the samplers have a minification filter without them; otherwise viewers may
///   use any number of levels.
/// - A model without faces becomes a point cloud, and a model without vertices an empty scene.
///
/// # Errors
///
/// Same as [`Model::check`], plus [`MeshIoErrorKind::Unsupported`] for [textures of unit squares](Model::tiles);
/// [`MeshIoErrorKind::Size`] if the file would have 2^32 bytes or more.
pub fn write(model: &Model) -> Result<Vec<u8>, MeshIoError> {
    model.check()?;
    if !model.tiles.is_empty() {
        let feature = "a texture for each unit square (UDIM) in glTF".to_owned();
        return Err(MeshIoError::new(MeshIoErrorKind::Unsupported { feature }));
    }
    let mut bin = Bin::default();
    let mut document = json!({
        "asset": { "version": "2.0", "generator": "dapple" },
        "scene": 0,
        "scenes": [{}],
    });
    if !model.mesh.positions().is_empty() {
        let origin = origin(model.mesh.positions());
        let primitive = primitive(&*with_vertex_normals(model)?, origin, &mut bin);
        document["scenes"] = json!([{ "nodes": [0] }]);
        document["nodes"] = match origin {
            Some(origin) => json!([{ "mesh": 0, "translation": origin.to_array() }]),
            None => json!([{ "mesh": 0 }]),
        };
        document["meshes"] = json!([{ "primitives": [primitive] }]);
        let material = material(model, &mut bin);
        if let Some(extensions) = material["extensions"].as_object() {
            document["extensionsUsed"] = extensions.keys().cloned().collect();
        }
        document["materials"] = json!([material]);
        document["accessors"] = bin.accessors.into();
        document["bufferViews"] = bin.views.into();
        document["buffers"] = json!([{ "byteLength": bin.bytes.len() }]);
    }
    if !bin.images.is_empty() {
        let min_filter = if model.material.mipmaps {
            LINEAR_MIPMAP_LINEAR
        } else {
            LINEAR
        };
        let texture = |source: usize| json!({ "sampler": 0, "source": source });
        document["textures"] = (0..bin.images.len()).map(texture).collect();
        document["samplers"] = json!([{ "minFilter": min_filter, "magFilter": LINEAR, "wrapS": REPEAT, "wrapT": REPEAT }]);
        document["images"] = bin.images.into();
    }
    // Sort the keys, so that the feature `preserve_order` of serde_json, which another crate may enable, has no
    // effect.
    document.sort_all_objects();
    container(document.to_string().into_bytes(), bin.bytes)
}

/// Adds the attributes of a model without corner normals. Positions are relative to `origin`. Returns the primitive
/// that refers to them.
fn primitive(model: &Model, origin: Option<DVec3>, bin: &mut Bin) -> Value {
    let mesh = &model.mesh;
    let split = Split::new(model);
    let spread = |vectors: &[DVec3]| -> Vec<[f32; 3]> {
        let part = |&vertex: &usize| vectors[vertex].to_array().map(narrow);
        split.vertex.iter().map(part).collect()
    };
    let positions = match origin {
        Some(origin) => {
            let from_origin = mesh.positions().iter().map(|at| at - origin);
            spread(&from_origin.collect::<Vec<_>>())
        }
        None => spread(mesh.positions()),
    };
    let mut attributes = Map::new();
    attributes.insert("POSITION".into(), bin.floats(&positions).into());
    let last = bin.accessors.len() - 1;
    bin.accessors[last]["min"] = json!(bound(&positions, f32::min));
    bin.accessors[last]["max"] = json!(bound(&positions, f32::max));
    let computed = || (!mesh.faces().is_empty()).then(|| mesh.vertex_normals());
    if let Some(mut normals) = model.normals.clone().or_else(computed) {
        normals
            .iter_mut()
            .for_each(|normal| *normal = unit(*normal));
        attributes.insert("NORMAL".into(), bin.floats(&spread(&normals)).into());
    }
    if let Some(colors) = &model.colors {
        let colors: Vec<_> = split
            .vertex
            .iter()
            .map(|&vertex| clamped(colors[vertex]))
            .collect();
        attributes.insert("COLOR_0".into(), bin.floats(&colors).into());
    }
    if model.uvs.is_some() {
        attributes.insert("TEXCOORD_0".into(), bin.floats(&split.uvs).into());
    }
    if split.faces.is_empty() {
        return json!({ "attributes": attributes, "material": 0, "mode": 0 });
    }
    let indices = bin.indices(&split.faces);
    json!({ "attributes": attributes, "indices": indices, "material": 0 })
}

fn material(model: &Model, bin: &mut Bin) -> Value {
    let material = &model.material;
    let mut texture = |image: &Option<EncodedImage>| {
        let image = image.as_ref().filter(|_| model.uvs.is_some())?;
        Some(json!({ "index": bin.image(image) }))
    };
    let metallic_roughness = texture(&material.metallic_roughness);
    // The default of glTF without a texture is metallic.
    let metallic = if metallic_roughness.is_some() {
        1.0
    } else {
        0.0
    };
    let mut pbr = json!({
        "baseColorFactor": clamped(material.base_color_factor),
        "metallicFactor": metallic,
        "roughnessFactor": 1.0,
    });
    // Write an image with all three channels only once.
    let occlusion = match &metallic_roughness {
        Some(texture) if material.occlusion == material.metallic_roughness => Some(texture.clone()),
        _ => texture(&material.occlusion),
    };
    if let Some(texture) = metallic_roughness {
        pbr["metallicRoughnessTexture"] = texture;
    }
    if let Some(texture) = texture(&material.base_color) {
        pbr["baseColorTexture"] = texture;
    }
    let mut value = json!({ "pbrMetallicRoughness": pbr });
    if let Some(texture) = texture(&material.normal) {
        value["normalTexture"] = texture;
    }
    if let Some(texture) = occlusion {
        value["occlusionTexture"] = texture;
    }
    add_extensions(&mut value, material, texture);
    if material.double_sided || is_open(&model.mesh) {
        value["doubleSided"] = true.into();
    }
    let is_clear = material.base_color_factor.alpha < 1.0;
    match material.alpha {
        AlphaMode::Mask => {
            value["alphaMode"] = "MASK".into();
            if material.alpha_cutoff != 0.5 {
                value["alphaCutoff"] = material.alpha_cutoff.max(0.0).into();
            }
        }
        AlphaMode::Blend => value["alphaMode"] = "BLEND".into(),
        _ if is_clear => value["alphaMode"] = "BLEND".into(),
        _ => {}
    }
    value
}

/// Adds emission, specular and clear coat to a material, with the glTF extensions that they need. `texture` is a
/// callback that adds an image and returns the reference to its texture.
fn add_extensions(
    value: &mut Value,
    material: &Material,
    mut texture: impl FnMut(&Option<EncodedImage>) -> Option<Value>,
) {
    let mut extensions = Map::new();
    if let Some(texture) = texture(&material.emission) {
        value["emissiveTexture"] = texture;
        // A factor above 1 needs an extension.
        let strength = material.emission_strength.max(0.0);
        value["emissiveFactor"] = json!([strength.min(1.0), strength.min(1.0), strength.min(1.0)]);
        if strength > 1.0 {
            let strength = json!({ "emissiveStrength": strength });
            extensions.insert("KHR_materials_emissive_strength".into(), strength);
        }
    }
    if let Some(texture) = texture(&material.specular) {
        let specular = json!({ "specularTexture": texture });
        extensions.insert("KHR_materials_specular".into(), specular);
    }
    if let Some(texture) = texture(&material.clearcoat) {
        let clearcoat = json!({
            "clearcoatFactor": 1.0,
            "clearcoatTexture": texture,
            "clearcoatRoughnessFactor": material.clearcoat_roughness.clamp(0.0, 1.0),
        });
        extensions.insert("KHR_materials_clearcoat".into(), clearcoat);
    }
    if !extensions.is_empty() {
        value["extensions"] = extensions.into();
    }
}

/// Returns whether a mesh has a boundary edge.
fn is_open(mesh: &Mesh) -> bool {
    mesh.report().boundary_edges > 0
}

/// Returns a normal with length 1. A normal whose length is already 1 within single precision is unchanged, so that a
/// file that was read is written with the same bits.
fn unit(normal: DVec3) -> DVec3 {
    if (normal.length_squared() - 1.0).abs() < 1e-6 {
        normal
    } else {
        normal.normalize_or(DVec3::Z)
    }
}

fn clamped(color: LinearRgba) -> [f32; 4] {
    let [r, g, b] = color.color.to_array();
    [r, g, b, color.alpha].map(|part| part.clamp(0.0, 1.0))
}

fn bound(positions: &[[f32; 3]], choose: fn(f32, f32) -> f32) -> [f32; 3] {
    let choose =
        |a: [f32; 3], b: [f32; 3]| [choose(a[0], b[0]), choose(a[1], b[1]), choose(a[2], b[2])];
    positions.iter().copied().reduce(choose).unwrap_or_default()
}

/// Assembles a GLB file from its two chunks, each padded to a multiple of four bytes.
pub(super) fn container(mut json: Vec<u8>, mut bin: Vec<u8>) -> Result<Vec<u8>, MeshIoError> {
    json.resize(json.len().next_multiple_of(4), b' ');
    bin.resize(bin.len().next_multiple_of(4), 0);
    let header = 12;
    let bin_chunk = if bin.is_empty() { 0 } else { 8 + bin.len() };
    let count = header + 8 + json.len() + bin_chunk;
    let Ok(length) = u32::try_from(count) else {
        let (format, bytes) = ("GLB", count);
        return Err(MeshIoError::new(MeshIoErrorKind::Size { format, bytes }));
    };
    let mut bytes = Vec::with_capacity(count);
    bytes.extend(MAGIC);
    bytes.extend(2u32.to_le_bytes());
    bytes.extend(length.to_le_bytes());
    let mut chunk = |kind: &[u8; 4], content: &[u8]| {
        // The length fits because the total does.
        bytes.extend((content.len() as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(content);
    };
    chunk(JSON, &json);
    if !bin.is_empty() {
        chunk(BIN, &bin);
    }
    Ok(bytes)
}

impl Bin {
    /// Adds an array of `f32` vectors, and returns the index of its accessor.
    fn floats<const N: usize>(&mut self, column: &[[f32; N]]) -> usize {
        let bytes: Vec<_> = column
            .iter()
            .flatten()
            .flat_map(|part| part.to_le_bytes())
            .collect();
        let shape = format!("VEC{N}");
        let view = self.view(&bytes, Some(ARRAY_BUFFER));
        self.accessor(json!({ "bufferView": view, "componentType": FLOAT, "count": column.len(), "type": shape }))
    }

    /// Adds the indices of faces, and returns the index of their accessor.
    fn indices(&mut self, faces: &[[u32; 3]]) -> usize {
        let bytes: Vec<_> = faces
            .iter()
            .flatten()
            .flat_map(|index| index.to_le_bytes())
            .collect();
        let view = self.view(&bytes, Some(ELEMENT_ARRAY_BUFFER));
        self.accessor(json!({ "bufferView": view, "componentType": UNSIGNED_INT, "count": 3 * faces.len(), "type": "SCALAR" }))
    }

    /// Adds an image, and returns its index.
    fn image(&mut self, image: &EncodedImage) -> usize {
        let view = self.view(image.bytes(), None);
        self.images
            .push(json!({ "bufferView": view, "mimeType": image.format().media_type() }));
        self.images.len() - 1
    }

    fn view(&mut self, bytes: &[u8], target: Option<u32>) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let mut view =
            json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() });
        if let Some(target) = target {
            view["target"] = target.into();
        }
        self.bytes.extend(bytes);
        self.views.push(view);
        self.views.len() - 1
    }

    fn accessor(&mut self, accessor: Value) -> usize {
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }
}

impl Split {
    fn new(model: &Model) -> Self {
        let count = model.mesh.positions().len();
        let mut split = Self {
            vertex: (0..count).collect(),
            uvs: vec![[0.0; 2]; count],
            faces: model
                .mesh
                .faces()
                .iter()
                .map(|face| face.map(|vertex| vertex.0))
                .collect(),
        };
        let Some(uvs) = &model.uvs else {
            return split;
        };
        let mut used = vec![false; count];
        // Next file vertex of the same mesh vertex.
        let mut next = vec![None; count];
        for (face, uvs) in split.faces.iter_mut().zip(uvs) {
            for (corner, uv) in face.iter_mut().zip(uvs) {
                let uv = uv.to_array().map(narrow);
                let mut at = *corner as usize;
                if !core::mem::replace(&mut used[at], true) {
                    split.uvs[at] = uv;
                }
                while split.uvs[at] != uv {
                    at = *next[at].get_or_insert(split.vertex.len());
                    if at == split.vertex.len() {
                        split.vertex.push(*corner as usize);
                        split.uvs.push(uv);
                        next.push(None);
                    }
                }
                // There are at most 3 * 2^31 + 2^31 vertices, and files of 2^32 bytes or more are rejected.
                *corner = at as u32;
            }
        }
        split
    }
}
