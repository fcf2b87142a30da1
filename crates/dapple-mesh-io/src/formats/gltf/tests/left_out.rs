//! Tests of skins, morph targets and texture transforms, and of the list of omitted parts.

use super::*;
use dapple_mesh::Model;

fn png() -> String {
    format!("data:image/png;base64,{}", base64(b"\x89PNG\r\n\x1a\n..."))
}

/// Returns a square with texture coordinates equal to its positions, four joints and weights per corner, and a morph
/// target that lifts it by 5.
fn posed() -> Value {
    let positions: [[f32; 3]; 4] = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
    ];
    let mut bytes: Vec<u8> = positions
        .iter()
        .flatten()
        .flat_map(|part| part.to_le_bytes())
        .collect();
    let mut views = vec![json!({ "buffer": 0, "byteOffset": 0, "byteLength": 48 })];
    let mut accessors =
        vec![json!({ "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3" })];
    let mut add = |part: Vec<u8>, kind: u32, count: usize, shape: &str| {
        views.push(json!({ "buffer": 0, "byteOffset": bytes.len(), "byteLength": part.len() }));
        accessors.push(json!({ "bufferView": views.len() - 1, "componentType": kind, "count": count, "type": shape }));
        bytes.extend(part);
    };
    let floats = |parts: &[f32]| {
        parts
            .iter()
            .flat_map(|part| part.to_le_bytes())
            .collect::<Vec<_>>()
    };
    add(vec![0, 0, 1, 0, 2, 0, 0, 0, 2, 0, 3, 0], 5123, 6, "SCALAR");
    add(
        vec![0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0],
        5121,
        4,
        "VEC4",
    );
    add(floats(&[1.0, 0.0, 0.0, 0.0].repeat(4)), 5126, 4, "VEC4");
    let mut eye = [0.0; 16];
    (eye[0], eye[5], eye[10], eye[15]) = (1.0, 1.0, 1.0, 1.0);
    add(floats(&eye.repeat(2)), 5126, 2, "MAT4");
    add(floats(&[0.0, 0.0, 5.0].repeat(4)), 5126, 4, "VEC3");
    add(
        floats(&[0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0]),
        5126,
        4,
        "VEC2",
    );
    json!({
        "asset": { "version": "2.0" },
        "scenes": [{ "nodes": [0, 2] }],
        "nodes": [
            { "children": [1], "translation": [1, 0, 0] },
            { "mesh": 0, "translation": [0, 1, 0] },
            { "children": [3] },
            { "translation": [0, 3, 0] },
        ],
        "skins": [{ "joints": [2, 3], "inverseBindMatrices": 4 }],
        "meshes": [{ "primitives": [{
            "attributes": { "POSITION": 0, "JOINTS_0": 2, "WEIGHTS_0": 3, "TEXCOORD_0": 6 },
            "indices": 1, "targets": [{ "POSITION": 5 }], "material": 0,
        }] }],
        "materials": [{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }],
        "textures": [{ "source": 0 }],
        "images": [{ "uri": png() }],
        "accessors": accessors, "bufferViews": views,
        "buffers": [{ "byteLength": bytes.len(), "uri": format!("data:;base64,{}", base64(&bytes)) }],
    })
}

fn bounds(document: &Value) -> [[f64; 3]; 2] {
    let model = read_json(document).expect("it is valid");
    let positions = model.mesh.positions().iter().copied();
    let [least, most] = [DVec3::min, DVec3::max]
        .map(|choose: fn(DVec3, DVec3) -> DVec3| positions.clone().reduce(choose));
    [least, most].map(|corner| corner.expect("it has vertices").to_array())
}

#[test]
fn skins_replace_the_transform_of_the_node() {
    let mut document = posed();
    assert_eq!(
        bounds(&document),
        [[1.0, 1.0, 0.0], [2.0, 2.0, 0.0]],
        "without a skin"
    );
    document["nodes"][1]["skin"] = 0.into();
    // Values from Blender for this file: joint 1 lifts the upper vertices by 3, and the transform of the node has no
    // effect.
    assert_eq!(bounds(&document), [[0.0, 0.0, 0.0], [1.0, 4.0, 0.0]]);
    let mut moved = document.clone();
    moved["nodes"][2]["translation"] = json!([0, 0, 2]);
    assert_eq!(
        bounds(&moved),
        [[0.0, 0.0, 2.0], [1.0, 4.0, 2.0]],
        "a joint above another"
    );
    let mut plain = document.clone();
    plain["skins"][0]
        .as_object_mut()
        .expect("it is an object")
        .remove("inverseBindMatrices");
    assert_eq!(
        bounds(&plain),
        [[0.0, 0.0, 0.0], [1.0, 4.0, 0.0]],
        "identities"
    );
    for (pointer, value, why_not) in [
        (
            "/nodes/1/skin",
            json!(1),
            "a node has a skin that there is not",
        ),
        (
            "/skins/0/joints",
            json!([2]),
            "a vertex has a joint that there is not",
        ),
        ("/skins/0/joints", json!([2, 9]), "there is no node 9"),
        (
            "/skins/0/joints",
            json!([2, 3, 3]),
            "a joint has no inverse bind matrix",
        ),
        (
            "/accessors/3/count",
            json!(2),
            "a vertex has not four joints and weights in each set",
        ),
    ] {
        let mut wrong = document.clone();
        *wrong.pointer_mut(pointer).expect("it is there") = value;
        assert_eq!(why(&wrong), why_not);
    }
    document["nodes"][3]["children"] = json!([2]);
    assert!(
        read_json(&document).is_ok() || why(&document).contains("node"),
        "nodes in a ring end"
    );
}

#[test]
fn weights_of_morph_targets_are_applied() {
    let mut document = posed();
    document["meshes"][0]["weights"] = json!([1]);
    assert_eq!(bounds(&document)[1][2], 5.0);
    document["nodes"][1]["weights"] = json!([0.5]);
    assert_eq!(bounds(&document)[1][2], 2.5, "the node goes before");
    document["nodes"][1]["skin"] = 0.into();
    assert_eq!(
        bounds(&document),
        [[0.0, 0.0, 2.5], [1.0, 4.0, 2.5]],
        "with a skin"
    );
    document["accessors"][5]["count"] = 3.into();
    assert_eq!(
        why(&document),
        "attributes of a morph target have different counts"
    );
}

#[test]
fn transforms_of_textures_are_applied_to_corners() {
    let uvs = |transform: Value| {
        let mut document = posed();
        document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] =
            json!({ "KHR_texture_transform": transform });
        document["extensionsRequired"] = json!(["KHR_texture_transform"]);
        let model = read_json(&document).expect("it is valid");
        assert!(model.left_out.is_empty(), "{:?}", model.left_out);
        let mut corners: Vec<_> = model
            .uvs
            .expect("it has them")
            .into_iter()
            .flatten()
            .collect();
        // Corners 0, 1, 2 and the last of the second face.
        corners.swap_remove(4);
        corners.swap_remove(3);
        corners
    };
    let near = |found: &[DVec2], want: [[f64; 2]; 4]| {
        // The sine of pi is 1e-16.
        found
            .iter()
            .zip(want)
            .all(|(uv, want)| uv.distance(want.into()) < 1e-9)
    };
    let half = uvs(json!({ "scale": [0.5, 0.5] }));
    assert!(
        near(&half, [[0.0, 0.0], [0.5, 0.0], [0.5, 0.5], [0.0, 0.5]]),
        "{half:?}"
    );
    let flipped = uvs(json!({ "offset": [0, 1], "scale": [1, -1] }));
    assert!(
        near(&flipped, [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]]),
        "{flipped:?}"
    );
    // The example of the extension: the lower left quadrant, where v is from 1/2 to 1, rotated clockwise.
    let turned = uvs(
        json!({ "offset": [0, 1], "rotation": core::f64::consts::FRAC_PI_2, "scale": [0.5, 0.5] }),
    );
    assert!(
        near(&turned, [[0.0, 1.0], [0.0, 0.5], [0.5, 0.5], [0.5, 1.0]]),
        "{turned:?}"
    );
}

#[test]
fn textures_with_other_coordinates_than_the_base_color_are_listed() {
    let mut document = posed();
    let transform =
        json!({ "index": 0, "extensions": { "KHR_texture_transform": { "scale": [2, 2] } } });
    document["materials"][0]["normalTexture"] = transform;
    document["materials"][0]["occlusionTexture"] = json!({ "index": 0, "texCoord": 1 });
    document["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] = 6.into();
    let model = read_json(&document).expect("it is valid");
    let want = [
        "further sets of texture coordinates",
        "the texture of normals, which has other texture coordinates",
        "the texture of occlusion, which has other texture coordinates",
    ];
    assert_eq!(model.left_out, want);
    assert!(model.material.normal.is_none() && model.material.base_color.is_some());
}

fn left_out(change: impl FnOnce(&mut Value)) -> Vec<String> {
    let mut document = posed();
    change(&mut document);
    read_json(&document).expect("it is valid").left_out
}

#[test]
fn textures_that_are_not_read_are_named() {
    let webp = format!("data:image/webp;base64,{}", base64(b"RIFF....WEBP"));
    for (image, want) in [
        (
            json!({ "uri": "lost%20one.png" }),
            "the texture lost%20one.png, which cannot be read",
        ),
        (
            json!({ "uri": webp, "name": "bark" }),
            "the texture bark, which is neither PNG nor JPEG",
        ),
        (
            json!({ "bufferView": 0 }),
            "the texture 0, which is neither PNG nor JPEG",
        ),
    ] {
        assert_eq!(left_out(|document| document["images"][0] = image), [want]);
    }
    let only = json!([{ "extensions": { "EXT_texture_webp": { "source": 0 } } }]);
    let want = ["texture 0, which only the extension EXT_texture_webp has"];
    assert_eq!(left_out(|document| document["textures"] = only), want);
    assert_eq!(
        left_out(|document| document["textures"] = json!([{}])),
        ["texture 0, which has no image"]
    );
}

#[test]
fn wraps_matter_only_beyond_the_texture() {
    let wrap = |code: u32, scale: f64| {
        left_out(|document| {
            document["samplers"] = json!([{ "wrapS": 10497, "wrapT": code }]);
            document["textures"][0]["sampler"] = 0.into();
            document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] =
                json!({ "KHR_texture_transform": { "scale": [scale, scale] } });
        })
    };
    assert_eq!(
        wrap(33648, 2.0),
        ["the wrap MIRRORED_REPEAT of the texture, which repeats here"]
    );
    assert_eq!(
        wrap(33071, 2.0),
        ["the wrap CLAMP_TO_EDGE of the texture, which repeats here"]
    );
    assert!(wrap(33071, 1.0).is_empty() && wrap(10497, 2.0).is_empty());
}

#[test]
fn other_parts_of_a_file_are_listed() {
    let all = left_out(|document| {
        document["animations"] = json!([{ "channels": [], "samplers": [] }]);
        let mut lines = document["meshes"][0]["primitives"][0].clone();
        lines["mode"] = 1.into();
        document["meshes"][0]["primitives"]
            .as_array_mut()
            .expect("it is a list")
            .push(lines);
        let material = &mut document["materials"][0];
        material["emissiveFactor"] = json!([1, 0, 0]);
        material["pbrMetallicRoughness"]["metallicFactor"] = 1.into();
        material["extensions"] = json!({ "KHR_materials_sheen": {} });
    });
    let want = [
        "lines",
        "properties of the material: metallicFactor, emissiveFactor, KHR_materials_sheen",
        "the animations",
    ];
    assert_eq!(all, want);
    let written = write(&full()).expect("it is valid");
    assert!(
        read(&written).expect("it is valid").left_out.is_empty(),
        "what we write is read whole"
    );
    let mut plain = Model::from(plane(1, 1));
    plain.material.alpha = dapple_mesh::AlphaMode::Mask;
    let written = write(&plain).expect("it is valid");
    assert!(read(&written).expect("it is valid").left_out.is_empty());
}
