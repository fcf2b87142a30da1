//! Tests of invalid bytes: every reader returns a model or an error, and never panics.

use super::*;
use crate::test_meshes::cube;
use dapple_color::{LinearRgb, LinearRgba};
use dapple_mesh::{AlphaMode, EncodedImage, Model};
use glam::{DVec2, DVec3};
use proptest::collection::vec;
use proptest::prelude::*;

/// Returns a small model with all attributes.
fn model() -> Model {
    let mut model = Model::from(cube());
    let count = model.mesh.positions().len();
    model.colors = Some(vec![LinearRgba::opaque(LinearRgb::gray(0.5)); count]);
    model.normals = Some(vec![DVec3::Z; count]);
    model.uvs = Some(vec![
        [DVec2::ZERO, DVec2::X, DVec2::Y];
        model.mesh.faces().len()
    ]);
    model.material.base_color = EncodedImage::new(b"\x89PNG\r\n\x1a\n".to_vec()).ok();
    model
}

/// Returns a cube with corner normals that differ at every edge.
fn creased() -> Model {
    let mut model = model();
    model.normals = None;
    model.corner_normals = Some(model.mesh.corner_normals(dapple_mesh::CREASE));
    model
}

/// Returns the position and the normal of each corner.
fn corners(model: &Model) -> Vec<(DVec3, DVec3)> {
    let normals = model.normals_of_corners().expect("it has normals");
    let corners = model.mesh.faces().iter().zip(&normals);
    let corners = corners.flat_map(|(face, normals)| face.iter().zip(normals));
    let positions = model.mesh.positions();
    corners
        .map(|(vertex, &normal)| (positions[vertex.index()], normal))
        .collect()
}

#[test]
fn normals_of_corners_go_through_every_format() {
    let model = creased();
    let read = [
        ("OBJ", obj::read(&obj::write(&model).expect("it is valid"))),
        ("PLY", ply::read(&ply::write(&model).expect("it is valid"))),
        (
            "GLB",
            gltf::read(&gltf::write(&model).expect("it is valid")),
        ),
    ];
    for (format, read) in read {
        let read = read.expect("it is valid");
        assert_eq!(corners(&read), corners(&model), "{format}");
        assert_eq!(read.uvs, model.uvs, "{format}");
        // Convert the result to GLB and back.
        let again = gltf::read(&gltf::write(&read).expect("it is valid")).expect("it is valid");
        assert_eq!(corners(&again), corners(&model), "{format} to GLB");
    }
}

/// Returns one valid file in each format.
fn files() -> Vec<Vec<u8>> {
    let mut files = Vec::new();
    files.push(obj::write(&model()).expect("it is valid"));
    files.extend(
        [ply::write(&model()), ply::write_text(&model())].map(|file| file.expect("it is valid")),
    );
    files.push(gltf::write(&model()).expect("it is valid"));
    files.push(obj::write(&creased()).expect("it is valid"));
    files.push(stl::write(&model()).expect("it is valid"));
    files.push(b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n".to_vec());
    files.push(b"STCNOFF # all\n3 1 0\n0 0 0 0 0 1 1 0 0 1 .5 .5\n1 0 0 0 0 1 0 1 0 0 1 1\n0 1 0 0 0 1 255 0 0 255 0 1\n3 0 1 2\n".to_vec());
    files
}

/// Reads the bytes as each format. Models in writable formats are written and read again.
fn read_all(bytes: &[u8]) {
    for format in FORMATS {
        let name = format.name();
        // Use the same bytes as library, buffer and texture.
        let Ok(model) = format.read(bytes, &mut |_| Some(bytes.to_vec())) else {
            continue;
        };
        assert!(model.check().is_ok(), "{name}");
        if format.written_ending().is_some() {
            let files = format.write(&model, "a").expect("it was checked");
            let main = files.last().expect("there is a main file");
            let resolve = |name: &str| files.iter().find(|file| file.name == name);
            let again = format.read(&main.bytes, &mut |name| {
                resolve(name).map(|file| file.bytes.clone())
            });
            assert!(again.is_ok(), "{name}");
        }
    }
    if let Ok(model) = obj::read_with(bytes, &mut |_| Some(bytes.to_vec())) {
        let alone = obj::write(&model).expect("it was checked");
        assert!(obj::read(&alone).is_ok(), "OBJ without its other files");
    }
}

#[test]
fn truncated_files_never_panic() {
    for file in files() {
        for end in 0..file.len() {
            read_all(&file[..end]);
        }
    }
}

#[test]
fn digits_and_quotes_anywhere_never_panic() {
    for file in files() {
        for i in 0..file.len() {
            // Two of five bytes at each place; `tests/hostile` damages files in more ways.
            for k in [i, i + 2] {
                let mut changed = file.clone();
                changed[i] = [b'9', b'-', b'/', b'"', 0xff][k % 5];
                read_all(&changed);
            }
        }
    }
}

proptest! {
    #[test]
    fn random_bytes_never_panic(bytes in vec(any::<u8>(), 0..200)) {
        read_all(&bytes);
    }

    #[test]
    fn random_words_never_panic(words in vec(prop::sample::select(WORDS), 0..60)) {
        read_all(words.join(" ").replace(" \n ", "\n").as_bytes());
        read_all(format!("OFF\n{}", words.join(" ").replace(" \n ", "\n")).as_bytes());
        read_all(format!("ply\nformat ascii 1.0\n{}", words.join(" ").replace(" \n ", "\n")).as_bytes());
    }

    #[test]
    fn mutated_files_never_panic(
        file in prop::sample::select(files()),
        changes in vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
        cut in any::<prop::sample::Index>(),
        paste in any::<prop::sample::Index>(),
        length in 0usize..40,
    ) {
        let mut bytes = file;
        for (at, byte) in changes {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        // Copy a part of the bytes to another location.
        let from = cut.index(bytes.len());
        let part = bytes[from..(from + length).min(bytes.len())].to_vec();
        let to = paste.index(bytes.len());
        bytes.splice(to..to, part);
        read_all(&bytes);
    }
}

/// Words of the text formats, for random files.
const WORDS: &[&str] = &[
    "v",
    "vt",
    "vn",
    "f",
    "usemtl",
    "mtllib",
    "newmtl",
    "map_Kd",
    "-s",
    "-mm",
    "\n",
    "\n",
    "\n",
    "\\\n",
    "#",
    "1",
    "2",
    "3",
    "-1",
    "0",
    "1/1/1",
    "1//1",
    "0.5",
    "nan",
    "inf",
    "1e400",
    "4294967295",
    "18446744073709551616",
    "element",
    "vertex",
    "face",
    "property",
    "list",
    "uchar",
    "int",
    "float",
    "x",
    "y",
    "z",
    "red",
    "vertex_indices",
    "texcoord",
    "end_header",
];

#[test]
fn alpha_that_cuts_or_blends_reads_back_from_gltf() {
    let back = |model: &Model| {
        let bytes = gltf::write(model).expect("it is valid");
        gltf::read(&bytes).expect("it is valid").material.alpha
    };
    for alpha in [AlphaMode::Opaque, AlphaMode::Mask, AlphaMode::Blend] {
        let mut model = model();
        model.material.alpha = alpha;
        assert_eq!(back(&model), alpha);
    }
    let mut clear = model();
    clear.material.base_color_factor.alpha = 0.5;
    assert_eq!(
        back(&clear),
        AlphaMode::Blend,
        "a factor that is not opaque"
    );
}
