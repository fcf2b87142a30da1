//! Tests of unusual but valid files, and of invalid files that look valid.

use super::*;

#[test]
fn whole_numbers_may_have_a_fraction_of_zero() {
    let plain = square();
    let text = plain.to_string();
    let text = text
        .replace("\"mesh\":0", "\"mesh\":0.0")
        .replace("\"count\":4", "\"count\":4.0");
    let text = text
        .replace("5126", "5.126e3")
        .replace("\"nodes\":[0]", "\"nodes\":[0.0]");
    assert!(text.contains("5.126e3") && text.contains("[0.0]") && text.contains("4.0"));
    let model = read(text.as_bytes()).expect("it is valid");
    assert_eq!(model, read_json(&plain).expect("it is valid"));
    let half = text.replace("4.0", "4.5");
    assert!(read(half.as_bytes()).is_err(), "half a vertex");
}

#[test]
fn buffers_that_nothing_uses_need_no_bytes() {
    let mut document = square();
    let buffers = document["buffers"].as_array_mut().expect("it is a list");
    buffers.push(json!({ "byteLength": 100 }));
    buffers.push(json!({ "byteLength": 100, "uri": "lost.bin" }));
    let views = document["bufferViews"]
        .as_array_mut()
        .expect("it is a list");
    views.push(json!({ "buffer": 2, "byteLength": 100 }));
    let model = read_json(&document).expect("it is valid");
    assert_eq!(model, read_json(&square()).expect("it is valid"));
    document["accessors"][0]["bufferView"] = 3.into();
    assert_eq!(
        why(&document),
        "the bytes of buffer 2 are missing: lost.bin has to be a regular file beside it"
    );
}

#[test]
fn compressed_data_that_is_not_declared_as_required_is_refused_by_name() {
    let mut document = square();
    let compression = json!({ "KHR_draco_mesh_compression": { "bufferView": 0, "attributes": { "POSITION": 0 } } });
    document["meshes"][0]["primitives"][0]["extensions"] = compression;
    document["extensionsUsed"] = json!(["KHR_draco_mesh_compression"]);
    assert_eq!(
        read_json(&document),
        read_json(&square()),
        "there is plain data beside it"
    );
    document["accessors"][0]
        .as_object_mut()
        .expect("it is an object")
        .remove("bufferView");
    let error = read_json(&document).expect_err("it is refused").to_string();
    assert_eq!(
        error,
        "the glTF extension KHR_draco_mesh_compression is not supported"
    );
}
