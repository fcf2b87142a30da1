//! Tests with handwritten files, round trips, and the crate `gltf` as a second reader.

use super::*;
use crate::MeshIoErrorKind;
use crate::test_meshes::{cube, mesh, plane, soup, tetrahedron};
use dapple_color::{LinearRgb, LinearRgba};
use dapple_mesh::{EncodedImage, VertexIdx};
use glam::{DVec2, DVec3};
use proptest::prelude::*;
use serde_json::{Value, json};

mod images;
mod left_out;
mod materials;
mod origin;
mod valid;

/// Encodes bytes as base64, with the digits of RFC 4648.
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for part in bytes.chunks(3) {
        let bits = part
            .iter()
            .chain([&0, &0])
            .take(3)
            .fold(0u32, |bits, &byte| bits << 8 | u32::from(byte));
        for digit in 0..=part.len() {
            text.push(char::from(DIGITS[(bits >> (18 - 6 * digit) & 63) as usize]));
        }
    }
    text + &"=="[..(3 - bytes.len() % 3) % 3]
}

/// Returns a document with the four corners of a square, the indices 0 to 3, and integer colors.
fn square() -> Value {
    let positions = [
        0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0f32,
    ];
    let mut bytes: Vec<u8> = positions
        .iter()
        .flat_map(|part| part.to_le_bytes())
        .collect();
    bytes.extend([
        0, 1, 2, 3, 255, 0, 51, 9, 0, 255, 102, 9, 0, 0, 255, 9, 255, 255, 255, 9,
    ]);
    let uri = format!("data:application/octet-stream;base64,{}", base64(&bytes));
    json!({
        "asset": { "version": "2.0" },
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0, "COLOR_0": 2 }, "indices": 1, "mode": 5 }] }],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3" },
            { "bufferView": 1, "componentType": 5121, "count": 4, "type": "SCALAR" },
            { "bufferView": 2, "componentType": 5121, "normalized": true, "count": 4, "type": "VEC3" },
        ],
        "bufferViews": [
            { "buffer": 0, "byteLength": 48 },
            { "buffer": 0, "byteOffset": 48, "byteLength": 4 },
            { "buffer": 0, "byteOffset": 52, "byteLength": 16, "byteStride": 4 },
        ],
        "buffers": [{ "byteLength": 68, "uri": uri }],
    })
}

fn read_json(document: &Value) -> Result<Model, MeshIoError> {
    read(document.to_string().as_bytes())
}

fn why(document: &Value) -> String {
    match read_json(document).expect_err("it is refused").kind() {
        MeshIoErrorKind::File {
            format: "glTF",
            why,
        } => why.clone(),
        kind => panic!("{kind:?}"),
    }
}

fn faces(model: &Model) -> Vec<[u32; 3]> {
    let faces = model.mesh.faces().iter();
    faces
        .map(|face| face.map(|VertexIdx(vertex)| vertex))
        .collect()
}

/// Returns a cube with all attributes. The attributes of corners at the same vertex differ.
fn full() -> Model {
    let mut model = Model::from(cube());
    let uv = |i: usize, k: usize| DVec2::new(0.125 * (i % 4) as f64, 0.25 * k as f64);
    model.uvs = Some(
        (0..model.mesh.faces().len())
            .map(|i| [uv(i, 0), uv(i, 1), uv(i, 4)])
            .collect(),
    );
    let color = |i: usize| LinearRgba {
        color: LinearRgb::new(0.125 * i as f32, 0.5, 1.0),
        alpha: 0.75,
    };
    model.colors = Some((0..model.mesh.positions().len()).map(color).collect());
    model.normals = Some(vec![DVec3::Y; model.mesh.positions().len()]);
    let png = |rest: &[u8]| EncodedImage::new([b"\x89PNG\r\n\x1a\n", rest].concat()).ok();
    model.material.base_color = png(b"base");
    model.material.normal = png(b"normals");
    model.material.metallic_roughness = EncodedImage::new(b"\xff\xd8\xff rough".to_vec()).ok();
    model.material.base_color_factor = LinearRgba::opaque(LinearRgb::new(1.0, 0.5, 0.25));
    model
}

#[test]
fn strip_with_bytes_of_colors_becomes_triangles() {
    let model = read_json(&square()).expect("it is valid");
    assert_eq!(faces(&model), [[0, 1, 2], [1, 3, 2]]);
    let colors = model.colors.expect("it has colors");
    // Colors are linear, unlike in the other formats.
    assert_eq!(colors[0], LinearRgba::opaque(LinearRgb::new(1.0, 0.0, 0.2)));
    assert_eq!(colors[3], LinearRgba::opaque(LinearRgb::WHITE));
    let mut fan = square();
    fan["meshes"][0]["primitives"][0]["mode"] = 6.into();
    assert_eq!(
        faces(&read_json(&fan).expect("it is valid")),
        [[0, 1, 2], [0, 2, 3]]
    );
}

#[test]
fn instances_are_copies_of_the_mesh() {
    let mut document = square();
    // Two instances, the second one mirrored at x.
    let steps = [
        0.0, 0.0, 5.0, 0.0, 0.0, 7.0, 1.0, 1.0, 1.0, -1.0, 1.0, 1.0f32,
    ];
    let bytes: Vec<u8> = steps.iter().flat_map(|part| part.to_le_bytes()).collect();
    let uri = format!("data:;base64,{}", base64(&bytes));
    let add = |list: &mut Value, item: Value| list.as_array_mut().expect("a list").push(item);
    add(
        &mut document["buffers"],
        json!({ "byteLength": 48, "uri": uri }),
    );
    for offset in [0, 24] {
        let view = json!({ "buffer": 1, "byteOffset": offset, "byteLength": 24 });
        add(&mut document["bufferViews"], view);
    }
    for view in [3, 4] {
        let accessor =
            json!({ "bufferView": view, "componentType": 5126, "count": 2, "type": "VEC3" });
        add(&mut document["accessors"], accessor);
    }
    let attributes = json!({ "TRANSLATION": 3, "SCALE": 4, "_ID": 1 });
    document["nodes"][0]["translation"] = json!([100, 0, 0]);
    document["nodes"][0]["extensions"] =
        json!({ "EXT_mesh_gpu_instancing": { "attributes": attributes } });
    document["extensionsRequired"] = json!(["EXT_mesh_gpu_instancing"]);
    let model = read_json(&document).expect("it is valid");
    let positions = model.mesh.positions();
    assert_eq!(positions[1], DVec3::new(101.0, 0.0, 5.0), "the first copy");
    assert_eq!(positions[5], DVec3::new(99.0, 0.0, 7.0), "the mirrored one");
    let both = [[0, 1, 2], [1, 3, 2], [4, 6, 5], [5, 6, 7]];
    assert_eq!(faces(&model), both, "turned over in the mirror");
    document["accessors"][4]["count"] = 1.into();
    assert_eq!(
        why(&document),
        "attributes of instances have different counts"
    );
    document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = json!({});
    assert_eq!(
        why(&document),
        "instances have no translation, rotation or scale"
    );
}

#[test]
fn transforms_of_nodes_are_applied_and_mirrors_turn_faces_over() {
    let mut document = square();
    // A quarter turn about z, then a mirror at x and a translation.
    let half = 0.5f64.sqrt();
    document["nodes"] = json!([
        { "children": [1], "scale": [-1, 1, 1], "translation": [10, 0, 0] },
        { "mesh": 0, "rotation": [0, 0, half, half] },
    ]);
    let model = read_json(&document).expect("it is valid");
    let want = [
        [10.0, 0.0, 0.0],
        [10.0, 1.0, 0.0],
        [11.0, 0.0, 0.0],
        [11.0, 1.0, 0.0],
    ];
    for (got, want) in model.mesh.positions().iter().zip(want) {
        // The square root of one half is rounded.
        assert!(
            got.distance(DVec3::from_array(want)) < 1e-15,
            "{got} is not {want:?}"
        );
    }
    assert_eq!(faces(&model), [[0, 2, 1], [1, 2, 3]]);
    document["nodes"][1] =
        json!({ "mesh": 0, "matrix": [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 1, 2, 3, 1] });
    let model = read_json(&document).expect("it is valid");
    assert_eq!(model.mesh.positions()[3], DVec3::new(7.0, 4.0, 3.0));
}

#[test]
fn primitives_merge_and_share_vertices() {
    let mut document = square();
    let first = document["meshes"][0]["primitives"][0].clone();
    document["meshes"][0]["primitives"] = json!([
        first, first,
        { "attributes": { "POSITION": 0 }, "mode": 0 },
        { "attributes": { "POSITION": 0 }, "mode": 1 },
    ]);
    let model = read_json(&document).expect("it is valid");
    assert_eq!(
        (model.mesh.positions().len(), model.mesh.faces().len()),
        (8, 4)
    );
    assert_eq!(
        model.colors.expect("some have colors")[7],
        LinearRgba::opaque(LinearRgb::WHITE)
    );
}

#[test]
fn sparse_accessors_replace_elements() {
    let mut document = square();
    document["accessors"][0] = json!({
        "componentType": 5126, "count": 4, "type": "VEC3",
        "sparse": {
            "count": 1,
            "indices": { "bufferView": 1, "byteOffset": 2, "componentType": 5121 },
            "values": { "bufferView": 0, "byteOffset": 36 },
        },
    });
    let positions = read_json(&document)
        .expect("it is valid")
        .mesh
        .positions()
        .to_vec();
    assert_eq!(
        positions,
        [
            DVec3::ZERO,
            DVec3::ZERO,
            DVec3::new(1.0, 1.0, 0.0),
            DVec3::ZERO
        ]
    );
    document["accessors"][0]["count"] = 2.into();
    assert_eq!(why(&document), "a sparse index is too large");
}

#[test]
fn lies_about_counts_and_cycles_of_nodes_are_refused() {
    let changed = |path: &str, value: Value| {
        let mut document = square();
        *document.pointer_mut(path).expect("the path is there") = value;
        why(&document)
    };
    assert_eq!(
        changed("/accessors/0/count", 4_000_000_000u64.into()),
        "it says much more than it has bytes for"
    );
    assert_eq!(
        changed("/accessors/0/count", 5.into()),
        "an accessor has more elements than its buffer view has bytes for"
    );
    assert_eq!(
        changed(
            "/accessors/0",
            json!({ "componentType": 5126, "count": u64::MAX, "type": "VEC3" })
        ),
        "it says much more than it has bytes for"
    );
    assert_eq!(
        changed("/bufferViews/0/byteLength", u64::MAX.into()),
        "there are no bytes for buffer view 0"
    );
    assert_eq!(
        changed("/bufferViews/2/byteStride", 2.into()),
        "the stride of buffer view 2 is less than an element"
    );
    assert_eq!(
        changed("/buffers/0/byteLength", 69.into()),
        "the bytes of buffer 0 are missing"
    );
    assert_eq!(
        changed("/nodes/0", json!({ "children": [0] })),
        "node 0 has two parents"
    );
    assert_eq!(changed("/nodes/0/mesh", 1.into()), "there is no mesh 1");
    assert_eq!(
        changed("/accessors/1/componentType", 5120.into()),
        "accessor 1 has a type that is not for indices"
    );
    assert_eq!(
        changed("/accessors/2/count", 3.into()),
        "attributes of a primitive have different counts"
    );
}

#[test]
fn what_is_not_read_is_named() {
    let feature = |bytes: &[u8]| match read(bytes).expect_err("it is refused").kind() {
        MeshIoErrorKind::Unsupported { feature } => feature.clone(),
        kind => panic!("{kind:?}"),
    };
    // In version 1, references are names instead of numbers.
    let first =
        br#"{"asset": {"version": "1.0"}, "meshes": {"a": {}}, "nodes": {"b": {"meshes": ["a"]}}}"#;
    assert_eq!(feature(first), "glTF 1.0");
    assert_eq!(feature(b"glTF\x01\0\0\0"), "version 1 of binary glTF");
    let mut draco = square();
    draco["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]);
    let named = "the glTF extension KHR_draco_mesh_compression";
    assert_eq!(feature(draco.to_string().as_bytes()), named);
}

#[test]
fn buffers_and_textures_are_found_beside_the_file() {
    let mut document = square();
    document["buffers"][0] = json!({ "byteLength": 68, "uri": "my%20data.bin" });
    document["materials"] =
        json!([{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }]);
    document["textures"] = json!([{ "source": 0 }]);
    document["images"] = json!([{ "uri": "base.png" }]);
    document["meshes"][0]["primitives"][0]["material"] = 0.into();
    assert_eq!(
        why(&document),
        "the bytes of buffer 0 are missing: my data.bin has to be a regular file beside it"
    );
    let image = EncodedImage::new(b"\x89PNG\r\n\x1a\n".to_vec()).expect("it begins as a PNG");
    let model = read_with(document.to_string().as_bytes(), &mut |name| match name {
        "my data.bin" => Some(vec![0; 68]),
        "base.png" => Some(image.bytes().to_vec()),
        _ => None,
    });
    assert_eq!(model.expect("it is valid").material.base_color, Some(image));
}

#[test]
fn base64_of_rfc_4648_is_read() {
    for (text, bytes) in [
        ("", ""),
        ("Zg==", "f"),
        ("Zm8=", "fo"),
        ("Zm9v", "foo"),
        ("Zm9vYg", "foob"),
        ("Zm9vYmFy", "foobar"),
    ] {
        assert_eq!(
            container::data(&format!("data:;base64,{text}")).as_deref(),
            Some(bytes.as_bytes())
        );
    }
    for text in ["data:;base64,Zm9v!", "data:text/plain,abc", "data:;base64"] {
        assert_eq!(container::data(text), None, "{text}");
    }
}

#[test]
fn vertices_are_split_only_where_texture_coordinates_differ() {
    let mut model = Model::from(plane(1, 1));
    let corner = |vertex: &VertexIdx| model.mesh.positions()[vertex.index()].truncate();
    let uvs: Vec<_> = model
        .mesh
        .faces()
        .iter()
        .map(|face| face.each_ref().map(corner))
        .collect();
    model.uvs = Some(uvs.clone());
    let back = read(&write(&model).expect("it is valid")).expect("it is valid");
    assert_eq!(back.mesh, model.mesh, "a smooth map splits nothing");
    model.uvs = Some(vec![uvs[0], uvs[1].map(|uv| uv + 1.0)]);
    let back = read(&write(&model).expect("it is valid")).expect("it is valid");
    assert_eq!(back.mesh.positions().len(), 6, "both vertices of the edge");
    assert_eq!(
        (&back.uvs, &back.mesh.positions()[..4]),
        (&model.uvs, model.mesh.positions())
    );
    let (repaired, repair) = back.mesh.repair();
    assert_eq!(
        (repaired.positions().len(), repair.face_before.len()),
        (4, 2),
        "the seam closes"
    );
}

#[test]
fn model_reads_back_with_all_that_it_has() {
    let model = full();
    let back = read(&write(&model).expect("it is valid")).expect("it is valid");
    assert_eq!((&back.material, &back.uvs), (&model.material, &model.uvs));
    let corners = |model: &Model| -> Vec<_> {
        let colors = model.colors.clone().expect("it has colors");
        let corner = |vertex: &VertexIdx| {
            (
                model.mesh.positions()[vertex.index()],
                colors[vertex.index()],
            )
        };
        model.mesh.faces().iter().flatten().map(corner).collect()
    };
    assert_eq!(corners(&back), corners(&model));
    assert!(
        back.normals
            .expect("it has normals")
            .iter()
            .all(|&normal| normal == DVec3::Y),
        "all normals"
    );
}

#[test]
fn an_image_of_occlusion_roughness_and_metalness_is_written_once() {
    let mut model = full();
    let n_images = |model: &Model| {
        let bytes = write(model).expect("it is valid");
        let material = read(&bytes).expect("it is valid").material;
        assert_eq!(material, model.material);
        let file = ::gltf::Gltf::from_slice(&bytes).expect("it is valid");
        file.images().len()
    };
    assert_eq!(n_images(&model), 3);
    model.material.occlusion = model.material.metallic_roughness.clone();
    assert_eq!(n_images(&model), 3);
    model.material.occlusion = model.material.base_color.clone();
    assert_eq!(n_images(&model), 4);
}

#[test]
fn clouds_and_nothing_read_back() {
    let mut cloud = Model::from(mesh(&[[0.5, 0.0, 1.0], [1.0, 2.0, 3.0]], &[]));
    cloud.normals = Some(vec![DVec3::X, DVec3::Z]);
    assert_eq!(read(&write(&cloud).expect("it is valid")), Ok(cloud));
    assert_eq!(
        read(&write(&Model::default()).expect("it is valid")),
        Ok(Model::default())
    );
}

/// A file that must be refused: it passes the validation of the crate `gltf` and makes that crate panic. It is the
/// reason for our own reader.
#[test]
fn file_that_makes_the_crate_gltf_panic_is_refused() {
    let mut document = square();
    // The validation requires bounds of positions.
    document["accessors"][0]["min"] = json!([0, 0, 0]);
    document["accessors"][0]["max"] = json!([1, 1, 0]);
    document["accessors"][1] =
        json!({ "bufferView": 0, "componentType": 5126, "count": 4, "type": "SCALAR" });
    assert_eq!(
        why(&document),
        "accessor 1 has a type that is not for indices"
    );
    let bytes = document.to_string().into_bytes();
    let ::gltf::Gltf { document, .. } = ::gltf::Gltf::from_slice(&bytes).expect("it passes");
    let read = std::panic::AssertUnwindSafe(|| {
        let primitives = document.meshes().flat_map(|mesh| mesh.primitives());
        let has_indices = |primitive: &::gltf::Primitive<'_>| {
            primitive.reader(|_| Some(&bytes)).read_indices().is_some()
        };
        primitives.filter(has_indices).count()
    });
    let panicked = std::panic::catch_unwind(read).is_err();
    assert!(panicked, "the crate reads it: it may serve by now");
}

#[test]
fn written_file_is_valid_for_another_reader() {
    let model = full();
    let bytes = write(&model).expect("it is valid");
    assert_eq!(bytes.len() % 4, 0, "chunks are aligned");
    // The crate validates all references and required properties.
    let ::gltf::Gltf { document, blob } = ::gltf::Gltf::from_slice(&bytes).expect("it is valid");
    let blob = blob.expect("it has a binary chunk");
    let primitive = document
        .meshes()
        .next()
        .and_then(|mesh| mesh.primitives().next())
        .expect("it has one");
    let reader = primitive.reader(|_| Some(&blob));
    let indices: Vec<_> = reader
        .read_indices()
        .expect("it has indices")
        .into_u32()
        .collect();
    let positions: Vec<_> = reader.read_positions().expect("it has positions").collect();
    let colors: Vec<_> = reader
        .read_colors(0)
        .expect("it has colors")
        .into_rgba_f32()
        .collect();
    let uvs: Vec<_> = reader
        .read_tex_coords(0)
        .expect("it has texture coordinates")
        .into_f32()
        .collect();
    let mut corners = indices.iter().map(|&index| index as usize);
    for (face, want_uvs) in model
        .mesh
        .faces()
        .iter()
        .zip(model.uvs.as_deref().expect("it has them"))
    {
        for (vertex, uv) in face.iter().zip(want_uvs) {
            let at = corners.next().expect("three for each face");
            assert_eq!(
                DVec3::from(positions[at].map(f64::from)),
                model.mesh.positions()[vertex.index()]
            );
            assert_eq!(DVec2::from(uvs[at].map(f64::from)), *uv);
            assert_eq!(colors[at], [0.125 * vertex.0 as f32, 0.5, 1.0, 0.75]);
        }
    }
    let bounds = primitive.bounding_box();
    assert_eq!((bounds.min, bounds.max), bound(&positions));
    let material = primitive.material();
    assert!(!material.double_sided(), "a cube is closed");
    let texture = material
        .pbr_metallic_roughness()
        .base_color_texture()
        .expect("it has one");
    let ::gltf::image::Source::View { view, mime_type } = texture.texture().source().source()
    else {
        panic!("the texture is not in the file")
    };
    let image = &blob[view.offset()..view.offset() + view.length()];
    assert_eq!(
        (image, mime_type),
        (b"\x89PNG\r\n\x1a\nbase".as_slice(), "image/png")
    );
}

/// Returns the minimum and maximum of each component.
fn bound(positions: &[[f32; 3]]) -> ([f32; 3], [f32; 3]) {
    let fold = |choose: fn(f32, f32) -> f32| {
        [0, 1, 2].map(|axis| {
            positions
                .iter()
                .map(|position| position[axis])
                .reduce(choose)
                .unwrap_or_default()
        })
    };
    (fold(f32::min), fold(f32::max))
}

proptest! {
    #[test]
    fn meshes_read_back_as_floats_or_nearer(soup in soup()) {
        let bytes = write(&Model::from(soup.clone())).expect("it is valid");
        let back = read(&bytes).expect("it is valid");
        prop_assert_eq!(back.mesh.faces(), soup.faces());
        // The largest `f32` that is at most 1e30.
        let max = 1e30f32.next_down();
        let floats: Vec<_> = soup.positions().iter().map(|position| position.map(|part| f64::from((part as f32).clamp(-max, max)))).collect();
        let has_origin = ::gltf::Gltf::from_slice(&bytes).expect("it is valid").nodes().any(|node| node.transform().decomposed().0 != [0.0; 3]);
        if has_origin {
            let moved = |from: &[DVec3]| from.iter().zip(soup.positions()).map(|(at, other)| (at - other).abs().max_element()).fold(0.0, f64::max);
            prop_assert!(moved(back.mesh.positions()) <= moved(&floats));
        } else {
            prop_assert_eq!(back.mesh.positions(), floats);
        }
    }
}

#[test]
fn normals_that_were_read_are_written_with_the_same_bits() {
    let mut model = Model::from(mesh(
        &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        &[[0, 1, 2]],
    ));
    for index in 0..100 {
        let along = DVec3::new(f64::from(index), 100.0 - f64::from(index), 46.756);
        model.normals = Some(vec![along; 3]);
        let once = read(&write(&model).expect("it is valid")).expect("it is valid");
        let twice = read(&write(&once).expect("it is valid")).expect("it is valid");
        assert_eq!(once.normals, twice.normals, "{along}");
    }
}
