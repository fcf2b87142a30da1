//! Tests with handwritten STL files, and round trips.

use super::*;
use crate::test_meshes::{cube, mesh, soup};
use proptest::prelude::*;

const TEXT: &str = "solid part #1\r\n  facet normal 0 0 1\r\n    outer loop\r\n      vertex 0 0 0\r\n      vertex 1 0 0\r\n      vertex 1 1e0 -0\r\n    endloop\r\n  endfacet\r\nendsolid part #1\r\n\
SOLID\nFACET NORMAL 0 0 0\nOUTER LOOP\nVERTEX 0 0 0\nVERTEX 1 1 0\nVERTEX 0 1 0\nENDLOOP\nENDFACET\nENDSOLID\n";

fn why(bytes: &[u8]) -> String {
    match read(bytes).expect_err("it is refused").kind() {
        MeshIoErrorKind::File { format: "STL", why } => why.clone(),
        kind => panic!("{kind:?}"),
    }
}

/// Returns a binary file with the same square as the text file.
fn square(head: &[u8], attributes: u8) -> Vec<u8> {
    let mut bytes = head.to_vec();
    bytes.resize(80, 0);
    bytes.extend(2u32.to_le_bytes());
    for corners in [
        [0.0, 0.0, 1.0, 0.0, 1.0, 1.0f32],
        [0.0, 0.0, 1.0, 1.0, 0.0, 1.0],
    ] {
        let parts = corners
            .as_chunks::<2>()
            .0
            .iter()
            .flat_map(|[x, y]| [*x, *y, 0.0]);
        let parts = [0.0, 0.0, 1.0].into_iter().chain(parts);
        bytes.extend(parts.flat_map(f32::to_le_bytes));
        bytes.extend([attributes, 0]);
    }
    bytes
}

#[test]
fn text_and_binary_files_read_as_the_same_mesh_of_shared_vertices() {
    let want = mesh(
        &[
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [0.0, 1.0, 0.0],
        ],
        &[[0, 1, 2], [0, 2, 3]],
    );
    for (name, bytes) in [
        ("text", TEXT.as_bytes().to_vec()),
        (
            "text with a mark",
            [b"\xef\xbb\xbf", TEXT.as_bytes()].concat(),
        ),
        ("binary", square(b"made by hand", 0)),
        ("binary that begins like text", square(b"solid part", 0)),
        (
            "binary with bytes behind",
            [square(b"", 0), vec![7; 9]].concat(),
        ),
    ] {
        let model = read(&bytes).expect(name);
        assert_eq!(model.mesh, want, "{name}");
        assert!(model.left_out.is_empty(), "{name}");
    }
    let model = read(&square(b"", 3)).expect("it is valid");
    assert_eq!(model.left_out, ["attributes of faces"]);
}

#[test]
fn what_is_wrong_is_said() {
    assert_eq!(
        why(b""),
        "it is neither text nor as long as its number of faces says"
    );
    let cut = square(b"", 0);
    assert!(read(&cut[..100]).is_err(), "a binary file that is cut off");
    let change = |from: &str, to: &str| why(TEXT.replacen(from, to, 1).as_bytes());
    assert_eq!(
        change("solid part", "part"),
        "line 1: the first word is not `solid`"
    );
    assert_eq!(
        change("vertex 1 0 0", "vertex 1 0"),
        "line 5: a number is needed in place 4"
    );
    assert_eq!(
        change("vertex 1 0 0", "vertex 1 0 1e31"),
        "line 5: a number is 1e31, but it must be between -1e30 and 1e30"
    );
    assert_eq!(
        change("      vertex 1 0 0\r\n", ""),
        "line 6: a face has 2 corners, but must have 3"
    );
    assert_eq!(
        change("vertex", "vertices"),
        "line 4: this is nothing that a text of STL says"
    );
    let mut nan = square(b"", 0);
    nan[96..100].copy_from_slice(&f32::NAN.to_le_bytes());
    assert!(read(&nan).is_err(), "a position that is not a number");
}

#[test]
fn meshes_far_from_zero_are_written_as_text_with_all_digits() {
    let near = Model::from(cube());
    let bytes = write(&near).expect("it is valid");
    assert_eq!(bytes.len(), HEAD + FACE * near.mesh.faces().len());
    let place = DVec3::new(500_000.1, 4_649_776.3, 120.7);
    let positions = near
        .mesh
        .positions()
        .iter()
        .map(|at| place + 0.1 * at)
        .collect();
    let faces: Vec<_> = near
        .mesh
        .faces()
        .iter()
        .map(|face| face.map(|vertex| vertex.0))
        .collect();
    let far = Model::from(Mesh::new(positions, &faces).expect("it is in range"));
    let back = read(&write(&far).expect("it is valid")).expect("it is valid");
    let all = |model: &Model| corners(&model.mesh).collect::<Vec<_>>();
    assert_eq!(all(&back), all(&far));
    // Area of a cube with an edge of 0.1.
    let area: f64 = corners(&back.mesh)
        .map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length())
        .sum();
    let edge = (near.mesh.positions()[0] - near.mesh.positions()[1])
        .abs()
        .max_element()
        * 0.1;
    assert!((area - 6.0 * edge * edge).abs() < 1e-8, "{area}");
}

proptest! {
    #[test]
    fn faces_read_back_as_floats(soup in soup()) {
        let bytes = write(&Model::from(soup.clone())).expect("it is valid");
        let back = read(&bytes).expect("it is valid");
        let is_text = bytes.starts_with(b"solid");
        let rounded = |part: f64| if is_text { part } else { f64::from(narrow(part)) };
        let want: Vec<_> = corners(&soup).map(|face| face.map(|corner| corner.map(rounded))).collect();
        let found: Vec<_> = corners(&back.mesh).collect();
        prop_assert_eq!(found, want);
    }
}
