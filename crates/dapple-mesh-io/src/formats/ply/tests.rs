//! Tests with handwritten PLY files, and round trips.

use super::*;
use crate::MeshIoErrorKind;
use crate::test_meshes::{cube, mesh, plane, soup};
use dapple_color::LinearRgb;
use dapple_mesh::VertexIdx;
use proptest::prelude::*;

/// A quad with elements and properties that other programs write.
const QUAD: &str = "ply\r\nformat ascii 1.0\r\ncomment by hand\r\nobj_info none\r\nelement camera 1\r\nproperty list uchar float view\r\nelement vertex 4\r\n\
property double x\r\nproperty float confidence\r\nproperty float y\r\nproperty float z\r\nproperty uchar red\r\nproperty uchar green\r\nproperty uchar blue\r\n\
element face 3\r\nproperty uchar flags\r\nproperty list uchar int vertex_index\r\nend_header\r\n\
2 0.5 0.5\r\n0 1 0 0 255 0 0\r\n0.1 1 0 0 0 188 0\r\n1 1 1 0 0 0 255\r\n0 1 1 0 255 255 255\r\n7 4 0 1 2 3\r\n7 3 3 2 1\r\n7 2 0 1\r\n";

fn faces(model: &Model) -> Vec<[u32; 3]> {
    let faces = model.mesh.faces().iter();
    faces
        .map(|face| face.map(|VertexIdx(vertex)| vertex))
        .collect()
}

fn why(bytes: &[u8]) -> String {
    match read(bytes).expect_err("it is refused").kind() {
        MeshIoErrorKind::File { format: "PLY", why } => why.clone(),
        kind => panic!("{kind:?}"),
    }
}

#[test]
fn quad_as_text_becomes_two_triangles_with_linear_colors() {
    let model = read(QUAD.as_bytes()).expect("it is valid");
    assert_eq!(faces(&model), [[0, 1, 2], [0, 2, 3], [3, 2, 1]]);
    assert_eq!(model.mesh.positions()[1], DVec3::new(0.1, 0.0, 0.0));
    let colors = model.colors.expect("it has colors");
    assert_eq!(
        colors[1],
        LinearRgba::opaque(LinearRgb::from_srgb([0, 188, 0u8]))
    );
    assert_eq!((model.normals, model.uvs), (None, None));
}

/// Header of a text file whose body has five vertices in the plane z = 0.
const FIVE: &str = "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n";

#[test]
fn strips_of_triangles_are_faces_with_one_orientation() {
    let text = format!(
        "{FIVE}element tristrips 2\nproperty uchar flags\nproperty list int int vertex_indices\nend_header\n\
         0 0 0\n0 1 0\n1 0 0\n1 1 0\n2 0 0\n7 9 0 2 1 3 -1 4 3 2 -1\n7 2 0 1\n"
    );
    let model = read(text.as_bytes()).expect("it is valid");
    assert_eq!(faces(&model), [[0, 2, 1], [2, 3, 1], [4, 3, 2]]);
    for normal in model.mesh.vertex_normals() {
        assert_eq!(normal, DVec3::Z, "counterclockwise from above");
    }
}

#[test]
fn both_byte_orders_read_as_the_same() {
    let header = |order: &str| {
        format!("ply\nformat binary_{order}_endian 1.0\nelement vertex 3\nproperty short x\nproperty double y\nproperty float z\nproperty ushort red\nproperty ushort green\nproperty ushort blue\nproperty float alpha\nelement face 1\nproperty list ushort uint vertex_indices\nend_header\n").into_bytes()
    };
    let (mut little, mut big) = (header("little"), header("big"));
    for i in 0..3i16 {
        little.extend((-i).to_le_bytes());
        big.extend((-i).to_be_bytes());
        little.extend((0.1 * f64::from(i * i)).to_le_bytes());
        big.extend((0.1 * f64::from(i * i)).to_be_bytes());
        little.extend(0.5f32.to_le_bytes());
        big.extend(0.5f32.to_be_bytes());
        for code in [0x1234u16, 0, 0xffff] {
            little.extend(code.to_le_bytes());
            big.extend(code.to_be_bytes());
        }
        little.extend(0.25f32.to_le_bytes());
        big.extend(0.25f32.to_be_bytes());
    }
    little.extend(3u16.to_le_bytes());
    big.extend(3u16.to_be_bytes());
    for corner in [2u32, 0, 1] {
        little.extend(corner.to_le_bytes());
        big.extend(corner.to_be_bytes());
    }
    let model = read(&little).expect("it is valid");
    assert_eq!(read(&big).expect("it is valid"), model);
    assert_eq!(model.mesh.positions()[2], DVec3::new(-2.0, 0.4, 0.5));
    let color = LinearRgba {
        color: LinearRgb::from_srgb([0x1234, 0, 0xffffu16]),
        alpha: 0.25,
    };
    assert_eq!(model.colors, Some(vec![color; 3]));
}

#[test]
fn colors_in_fractions_are_srgb_too() {
    let text = QUAD
        .replace("uchar red", "float red")
        .replace("uchar green", "double green")
        .replace("uchar blue", "float blue")
        .replace("255", "1")
        .replace("188", "0.5");
    let colors = read(text.as_bytes())
        .expect("it is valid")
        .colors
        .expect("it has colors");
    assert_eq!(
        colors[1],
        LinearRgba::opaque(LinearRgb::from_srgb([0, 32768, 0u16]))
    );
    assert_eq!(colors[3], LinearRgba::opaque(LinearRgb::WHITE));
}

#[test]
fn uvs_of_vertices_go_to_corners_and_turn_over() {
    let text = QUAD
        .replace("uchar red", "float s")
        .replace("uchar green", "float t")
        .replace("255", "1")
        .replace("188", "0.25");
    let model = read(text.as_bytes()).expect("it is valid");
    let uvs = model.uvs.expect("it has texture coordinates");
    assert_eq!(
        uvs[0],
        [
            DVec2::new(1.0, 1.0),
            DVec2::new(0.0, 0.75),
            DVec2::new(0.0, 1.0)
        ]
    );
    assert_eq!(model.colors, None, "blue alone is no color");
}

#[test]
fn counts_that_the_bytes_cannot_hold_are_refused_at_once() {
    let binary = b"ply\nformat binary_little_endian 1.0\nelement vertex 4294967296\nproperty float x\nproperty float y\nproperty float z\nend_header\nabc";
    assert_eq!(
        why(binary),
        "line 3: the header says 4294967296 of the element vertex, but there are only 3 bytes left"
    );
    let text = QUAD.replace("face 3", "face 18446744073709551615");
    assert!(
        why(text.as_bytes())
            .starts_with("line 15: the header says 18446744073709551615 of the element face"),
        "faces"
    );
    let list = b"ply\nformat binary_little_endian 1.0\nelement odd 1\nproperty list uint uchar x\nend_header\n\xff\xff\xff\xffabc";
    assert_eq!(
        why(list),
        "a list says it has 4294967295 items, but there are only 3 bytes left"
    );
    // Items without properties have no bytes.
    let nothing = b"ply\nformat ascii 1.0\nelement face 18446744073709551615\nelement odd 18446744073709551615\nend_header\n";
    assert_eq!(read(nothing), Ok(Model::default()));
}

#[test]
fn what_is_wrong_is_said() {
    assert_eq!(why(b"plyx\n"), "line 1: the first line is not `ply`");
    assert_eq!(why(b"ply\nformat ascii 1.0\n"), "the header does not end");
    assert_eq!(
        why(b"ply\nformat ebcdic 1.0\nend_header\n"),
        "line 2: this is nothing that a header of PLY says"
    );
    assert_eq!(
        why(b"ply\nend_header\n"),
        "line 2: this is nothing that a header of PLY says"
    );
    assert_eq!(
        why(QUAD.replace("double x", "double w").as_bytes()),
        "line 7: a vertex has no x, y or z"
    );
    assert_eq!(
        why(QUAD.replace("7 2 0 1", "7 2 0 -1").as_bytes()),
        "line 26: a corner of a face is vertex -1, but there are 4, counted from 0"
    );
    assert_eq!(
        why(QUAD.replace("7 3 3 2 1", "7 3 3 2 4").as_bytes()),
        "line 25: a corner of a face is vertex 4, but there are 4, counted from 0"
    );
    assert_eq!(
        why(QUAD.replace("0.1 1 0", "nan 1 0").as_bytes()),
        "line 21: a number is NaN, but it must be between -1e30 and 1e30"
    );
    let ends = "it ends early, or has something else in place of a number";
    let cut = QUAD.replace("7 2 0 1\r\n", "7 2 0");
    assert_eq!(why(cut.as_bytes()), format!("line 26: {ends}"));
    let word = QUAD.replace("188", "x");
    assert_eq!(why(word.as_bytes()), format!("line 21: {ends}"));
}

#[test]
fn cloud_of_points_keeps_normals_and_colors() {
    let mut cloud = Model::from(mesh(&[[0.1, 0.0, 0.0], [1.0, 2.0, 3.0]], &[]));
    cloud.normals = Some(vec![DVec3::X, DVec3::new(0.6, 0.0, 0.8)]);
    cloud.colors = Some(vec![
        LinearRgba::opaque(LinearRgb::from_srgb([1, 2, 3u8])),
        LinearRgba {
            color: LinearRgb::from_srgb([4, 5, 6u8]),
            alpha: 128.0 / 255.0,
        },
    ]);
    for bytes in [write(&cloud), write_text(&cloud)] {
        assert_eq!(read(&bytes.expect("it is valid")), Ok(cloud.clone()));
    }
}

#[test]
fn uvs_of_corners_read_back() {
    let mut model = Model::from(plane(2, 1));
    let uv = |i: usize, k: usize| DVec2::new(0.125 * i as f64, 0.25 * k as f64);
    model.uvs = Some(
        (0..model.mesh.faces().len())
            .map(|i| [uv(i, 0), uv(i, 1), uv(i, 4)])
            .collect(),
    );
    for bytes in [write(&model), write_text(&model)] {
        assert_eq!(read(&bytes.expect("it is valid")), Ok(model.clone()));
    }
}

#[test]
fn numbers_are_float_only_if_that_loses_nothing() {
    let header =
        |model: &Model| String::from_utf8_lossy(&write(model).expect("it is valid")).into_owned();
    assert!(
        header(&Model::from(cube())).contains("property float x\n"),
        "whole numbers"
    );
    assert!(
        header(&Model::from(mesh(&[[0.1; 3]], &[]))).contains("property double x\n"),
        "a tenth"
    );
}

#[test]
fn value_stability_ply_text() {
    let mut model = Model::from(mesh(
        &[[0.1, -0.0, 1e20], [1.0, 2.0, 3.0], [4.0, 5.0, 6.0]],
        &[[2, 0, 1]],
    ));
    model.colors = Some(vec![LinearRgba::opaque(LinearRgb::gray(0.5)); 3]);
    let text = String::from_utf8(write_text(&model).expect("it is valid")).expect("it is text");
    let want = "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0.1 -0 1e20 188 188 188\n1 2 3 188 188 188\n4 5 6 188 188 188\n3 2 0 1\n";
    assert_eq!(text, want);
}

proptest! {
    #[test]
    fn meshes_read_back_bit_for_bit(soup in soup()) {
        let model = Model::from(soup);
        for bytes in [write(&model), write_text(&model)] {
            let back = read(&bytes.expect("it is valid")).expect("it is valid");
            let bits = |model: &Model| model.mesh.positions().iter().map(|position| position.to_array().map(f64::to_bits)).collect::<Vec<_>>();
            prop_assert_eq!(bits(&back), bits(&model));
            prop_assert_eq!(back.mesh.faces(), model.mesh.faces());
        }
    }
}
