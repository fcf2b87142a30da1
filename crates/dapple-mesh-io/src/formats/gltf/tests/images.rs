//! Tests of image replacement.

use super::*;

fn png(text: &str) -> EncodedImage {
    EncodedImage::new([b"\x89PNG\r\n\x1a\n", text.as_bytes()].concat()).expect("it begins as PNG")
}

/// Returns the square with three images in its buffer, located between and after other buffer views. The document also
/// has properties that a model cannot represent.
fn document() -> (Value, Vec<u8>) {
    let mut document = square();
    let uri = document["buffers"][0]["uri"]
        .as_str()
        .expect("it is text")
        .to_owned();
    let mut bytes = container::data(&uri).expect("it is base64");
    bytes.resize(72, 0);
    for image in [
        png("old base"),
        png("kept"),
        png("old normal, which is longer"),
    ] {
        let range =
            json!({ "buffer": 0, "byteOffset": bytes.len(), "byteLength": image.bytes().len() });
        document["bufferViews"]
            .as_array_mut()
            .expect("it is a list")
            .push(range);
        bytes.extend(image.bytes());
        bytes.resize(bytes.len().next_multiple_of(4), 0);
    }
    // The view of the indices comes last.
    document["bufferViews"][1]["byteOffset"] = bytes.len().into();
    bytes.extend([0, 1, 2, 3]);
    document["buffers"] = json!([{ "byteLength": bytes.len(), "name": "all" }]);
    document["images"] = json!([
        { "bufferView": 3, "mimeType": "image/png", "name": "base" },
        { "bufferView": 4, "mimeType": "image/png" },
        { "bufferView": 5, "mimeType": "image/png" },
    ]);
    document["textures"] = json!([{ "source": 0 }, { "source": 1 }, { "source": 2 }]);
    document["materials"] = json!([{
        "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 }, "metallicFactor": 1, "roughnessFactor": 0.25 },
        "normalTexture": { "index": 2, "scale": 0.7 },
        "emissiveTexture": { "index": 1 },
        "emissiveFactor": [1, 0.5, 0.1],
        "alphaMode": "MASK", "alphaCutoff": 0.2,
        "extensions": { "KHR_materials_clearcoat": { "clearcoatFactor": 0.3 } },
    }]);
    document["meshes"][0]["primitives"][0]["material"] = 0.into();
    document["meshes"][0]["extras"] =
        json!({ "note": "0.1 and 1e-7", "number": 0.300_000_011_920_928_96 });
    document["nodes"][0]["translation"] = json!([500000.1, 4649776.3, 1]);
    // The other reader requires bounds of positions.
    document["accessors"][0]["min"] = json!([0, 0, 0]);
    document["accessors"][0]["max"] = json!([1, 1, 0]);
    document["animations"] = json!([{ "name": "none", "channels": [], "samplers": [] }]);
    (document, bytes)
}

/// Returns a GLB file's document without images, buffer views and buffers, and the bytes of its images.
fn parts(bytes: &[u8]) -> (Value, Vec<Vec<u8>>) {
    let file = ::gltf::Gltf::from_slice(bytes).expect("it is valid");
    let blob = file.blob.as_deref().unwrap_or_default();
    let images = file.images().map(|image| match image.source() {
        ::gltf::image::Source::View { view, .. } => blob[view.offset()..][..view.length()].to_vec(),
        ::gltf::image::Source::Uri { uri, .. } => uri.as_bytes().to_vec(),
    });
    let images = images.collect();
    let mut document: Value =
        parse(Container::read(bytes).expect("it is valid").json).expect("it is JSON");
    let object = document.as_object_mut().expect("it is an object");
    for name in ["images", "bufferViews", "buffers"] {
        object.remove(name);
    }
    (document, images)
}

#[test]
fn a_document_with_other_images_is_the_same_but_for_them() {
    let (document, bytes) = document();
    let file = write::container(document.to_string().into_bytes(), bytes).expect("it is small");
    let (base, normal) = (
        png("new base, which is much longer than the old one"),
        png("new"),
    );
    let pairs = [
        (png("old base"), base.clone()),
        (png("old normal, which is longer"), normal.clone()),
    ];
    let new = replace_images(&file, &mut |_| None, &pairs).expect("it is valid");
    let ((before, _), (after, images)) = (parts(&file), parts(&new));
    assert_eq!(after, before);
    assert_eq!(images, [base.bytes(), png("kept").bytes(), normal.bytes()]);
    let (old, new_model) = (
        read(&file).expect("it is valid"),
        read(&new).expect("it is valid"),
    );
    assert_eq!(
        (new_model.mesh, new_model.colors),
        (old.mesh, old.colors),
        "views are in their new places"
    );
    let gone = |old: &[u8]| !new.windows(old.len()).any(|part| part == old);
    assert!(
        pairs.iter().all(|(old, _)| gone(old.bytes())),
        "old images are cut off"
    );
    let same = replace_images(&file, &mut |_| None, &[]).expect("it is valid");
    assert_eq!(parts(&same), parts(&file), "nothing is replaced");
}

#[test]
fn buffers_and_images_in_other_files_become_part_of_the_file() {
    let (mut document, bytes) = document();
    document["buffers"] = json!([
        { "byteLength": 68, "uri": square()["buffers"][0]["uri"] },
        { "byteLength": bytes.len(), "uri": "all%20.bin" },
    ]);
    for view in 1..6 {
        document["bufferViews"][view]["buffer"] = 1.into();
    }
    document["images"][1] = json!({ "uri": "kept.jpg" });
    document["images"][2] = json!({ "uri": "normal.png" });
    let jpeg = b"\xff\xd8\xff kept".to_vec();
    let mut resolve = |name: &str| match name {
        "all .bin" => Some(bytes.clone()),
        "kept.jpg" => Some(jpeg.clone()),
        "normal.png" => Some(png("old normal").bytes().to_vec()),
        _ => None,
    };
    let text = document.to_string();
    let old = read_with(text.as_bytes(), &mut resolve).expect("it is valid");
    let pairs = [
        (png("old base"), png("new base")),
        (png("old normal"), png("new normal")),
    ];
    let new = replace_images(text.as_bytes(), &mut resolve, &pairs).expect("it is valid");
    let (_, images) = parts(&new);
    assert_eq!(
        images,
        [png("new base").bytes(), &jpeg, png("new normal").bytes()]
    );
    let new = read(&new).expect("it needs no other file");
    assert_eq!((new.mesh, new.colors), (old.mesh, old.colors));
    assert_eq!(new.material.base_color, Some(png("new base")));
}

#[test]
fn a_missing_buffer_is_an_error_if_a_view_has_it() {
    let (mut document, bytes) = document();
    let buffers = document["buffers"].as_array_mut().expect("it is a list");
    buffers.push(json!({ "byteLength": 100, "uri": "lost.bin" }));
    let file = |document: &Value| {
        let json = document.to_string().into_bytes();
        write::container(json, bytes.clone()).expect("it is small")
    };
    let replace = |document: &Value| replace_images(&file(document), &mut |_| None, &[]);
    assert!(replace(&document).is_ok(), "nothing uses it");
    let views = document["bufferViews"]
        .as_array_mut()
        .expect("it is a list");
    views.push(json!({ "buffer": 1, "byteLength": 100 }));
    let error = replace(&document).expect_err("it is refused").to_string();
    assert!(
        error.contains("the bytes of buffer 1 are missing"),
        "{error}"
    );
}

#[test]
fn copies_in_other_formats_of_a_replaced_image_are_dropped() {
    let (mut document, bytes) = document();
    let webp = json!({ "EXT_texture_webp": { "source": 1 } });
    document["textures"][0]["extensions"] = webp.clone();
    document["textures"][2]["extensions"] = webp.clone();
    let file = write::container(document.to_string().into_bytes(), bytes).expect("it is small");
    let pairs = [(png("old base"), png("new base"))];
    let new = replace_images(&file, &mut |_| None, &pairs).expect("it is valid");
    let (document, _) = parts(&new);
    assert_eq!(document["textures"][0], json!({ "source": 0 }));
    assert_eq!(document["textures"][2]["extensions"], webp);
}

#[test]
fn views_that_something_else_uses_stay() {
    let (mut document, bytes) = document();
    document["images"][1]["bufferView"] = 3.into();
    document["meshes"][0]["extras"]["bufferView"] = 5.into();
    let file = write::container(document.to_string().into_bytes(), bytes).expect("it is small");
    let pairs = [
        (png("old base"), png("new base")),
        (png("old normal, which is longer"), png("new normal")),
    ];
    let new = replace_images(&file, &mut |_| None, &pairs).expect("it is valid");
    let (_, images) = parts(&new);
    assert_eq!(
        images,
        [
            png("new base").bytes(),
            png("new base").bytes(),
            png("new normal").bytes()
        ]
    );
    let old = png("old normal, which is longer");
    assert!(
        new.windows(old.bytes().len())
            .any(|part| part == old.bytes())
    );
}

#[test]
fn damaged_documents_are_refused_or_keep_their_images() {
    let (document, bytes) = document();
    let pairs = [(png("old base"), png("new"))];
    for (pointer, value) in [
        ("/bufferViews/3/byteOffset", json!(u64::MAX)),
        ("/bufferViews/3/byteLength", json!(u64::MAX)),
        ("/bufferViews/4/byteOffset", json!(1u64 << 63)),
        ("/bufferViews/3", json!([0, 0, 4])),
        ("/bufferViews", json!([])),
        ("/images/0/bufferView", json!(99)),
        ("/buffers", json!([])),
        ("/textures", json!([null])),
        ("", json!([])),
    ] {
        let mut document = document.clone();
        *document.pointer_mut(pointer).expect("it is there") = value;
        let file = write::container(document.to_string().into_bytes(), bytes.clone());
        let file = file.expect("it is small");
        // The result is an error or a container with JSON, never a panic.
        if let Ok(new) = replace_images(&file, &mut |_| None, &pairs) {
            let container = Container::read(&new).expect("it is one");
            assert!(parse::<Value>(container.json).is_ok(), "{pointer}");
        }
    }
}
