//! Tests with handwritten OBJ and MTL files, round trips, and real files.

use super::*;
use crate::MeshIoErrorKind;
use crate::test_meshes::{cube, mesh, soup};
use dapple_mesh::{EncodedImage, Material, VertexIdx};
use proptest::prelude::*;

/// A quad of two triangles, with CRLF line ends.
const QUAD: &[u8] =
    b"# a quad \\\r\nmtllib my house.mtl\r\no one\r\nv 0 0 0 1 0 0 # red\r\nv 1 0 0\r\n\r\n\
v 1 1 0\r\nv -0.5 1e-7 .25 0 0.5 1\r\nvt 0 0\r\nvt 1 0.25\r\nvt 1 1 0\r\nvt 0 1\r\nvn 0 0 1\r\n\
usemtl other\r\nusemtl wall #2\r\nf 1/1/1 2/2/1 \\\r\n 3/3/1 -1/-1/-1\r\nl 1 2\r\n";

fn faces(model: &Model) -> Vec<[u32; 3]> {
    let faces = model.mesh.faces().iter();
    faces
        .map(|face| face.map(|VertexIdx(vertex)| vertex))
        .collect()
}

fn why(text: &str) -> String {
    match read(text.as_bytes()).expect_err("it is refused").kind() {
        MeshIoErrorKind::File { format: "OBJ", why } => why.clone(),
        kind => panic!("{kind:?}"),
    }
}

#[test]
fn quad_with_comments_and_crlf_becomes_two_triangles() {
    let model = read(QUAD).expect("it is valid");
    assert_eq!(faces(&model), [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(model.mesh.positions()[3], DVec3::new(-0.5, 1e-7, 0.25));
    assert_eq!(model.normals, Some(vec![DVec3::Z; 4]));
    // The v axis points down in the model.
    let uvs = [[0.0, 1.0], [1.0, 0.75], [1.0, 0.0], [0.0, 0.0]].map(DVec2::from_array);
    assert_eq!(
        model.uvs,
        Some(vec![[uvs[0], uvs[1], uvs[2]], [uvs[0], uvs[2], uvs[3]]])
    );
}

#[test]
fn vertex_colors_are_srgb_and_white_where_there_are_none() {
    let colors = read(QUAD)
        .expect("it is valid")
        .colors
        .expect("it has colors");
    let blue = LinearRgb::from_srgb([0, 32768, 65535u16]);
    let want = [
        LinearRgb::new(1.0, 0.0, 0.0),
        LinearRgb::WHITE,
        LinearRgb::WHITE,
        blue,
    ];
    assert_eq!(colors, want.map(LinearRgba::opaque));
    assert!(
        (0.213..0.215).contains(&blue.g),
        "half of a code is a fifth of the light: {}",
        blue.g
    );
    assert_eq!(read(b"v 0 0 0 1\n").expect("a weight").colors, None);
}

#[test]
fn corners_without_a_texture_coordinate_have_zero() {
    let model =
        read(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt .5 .5\nf 1 2 3\nf 1/1 2/1 3\n").expect("it is valid");
    let half = DVec2::splat(0.5);
    assert_eq!(
        model.uvs,
        Some(vec![[DVec2::ZERO; 3], [half, half, DVec2::ZERO]])
    );
}

#[test]
fn normals_stay_with_the_corners_at_creases() {
    let head = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 9 9 9\nvn 0 0 1\nvn 1 0 0\nvn 0 0 1\n";
    let model = |faces: &str| read(format!("{head}{faces}").as_bytes()).expect("it is valid");
    let of = |faces: &str| model(faces).normals;
    assert_eq!(
        of("f 1//1 2//2 3//1\nf 3//3 2//2 1//1"),
        Some(vec![DVec3::Z, DVec3::X, DVec3::Z, DVec3::ZERO])
    );
    let crease = model("f 1//1 2//2 3//1\nf 3//2 2//2 1//1");
    assert_eq!(crease.normals, None, "a vertex has two");
    let corners = vec![
        [DVec3::Z, DVec3::X, DVec3::Z],
        [DVec3::X, DVec3::X, DVec3::Z],
    ];
    assert_eq!(crease.corner_normals, Some(corners));
    let again = read(&write(&crease).expect("it is valid")).expect("it is valid");
    assert_eq!(again, crease, "they are written");
    assert_eq!(of("f 1//1 2 3//1"), None, "a corner without");
    assert_eq!(of(""), None, "four points and three normals");
}

#[test]
fn what_corners_name_in_vain_is_left_out() {
    let head = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt .5 .5\n";
    let [uvs, normals] = ["texture coordinates", "normals"]
        .map(|what| format!("{what} that faces name and the file does not have"));
    for (face, left_out) in [
        ("f 1/1 2/1 3", vec![]),
        ("f 1/1/1 2/1/1 3", vec![normals.clone()]),
        ("f 1/1/-1 2/1/-1 3//-1", vec![normals.clone()]),
        ("f 1/1 2/1 3/2", vec![uvs.clone()]),
        ("f 1/1 2/1 3/-2", vec![uvs.clone()]),
        ("f 1/1/0 2/1/9 3/99999999999/9", vec![uvs, normals]),
    ] {
        let model = read(format!("{head}{face}\n").as_bytes()).expect(face);
        let half = DVec2::splat(0.5);
        assert_eq!(model.uvs, Some(vec![[half, half, DVec2::ZERO]]), "{face}");
        assert_eq!(model.normals, None, "{face}");
        assert_eq!(model.left_out, left_out, "{face}");
    }
}

#[test]
fn what_is_wrong_is_named_with_its_line() {
    assert_eq!(
        why("v 0 0 0\nv 1 x 0\n"),
        "line 2: a number is needed in place 3"
    );
    for corner in [
        "0",
        "-2",
        "4294967296",
        "1/2/3/4",
        "a",
        "/1",
        "1//",
        "99999999999999999999",
    ] {
        let text = format!("v 0 0 0\nf {corner} 1 1\n");
        if corner == "1//" {
            assert!(
                read(text.as_bytes()).is_ok(),
                "nothing behind a slash is nothing"
            );
        } else {
            assert_eq!(
                why(&text),
                "line 2: a corner is not v, v/vt, v//vn or v/vt/vn",
                "{corner}"
            );
        }
    }
    assert_eq!(
        why("v 0 0 0\n\nf 1 1 1 1 \\\n 1\nf 1 1 \\\r\n1\nf 1 1 2\nf 1 1 1\nv 0 nan 0\n"),
        "line 9: a number is NaN, but it must be between -1e30 and 1e30",
        "lines that go on keep the numbers of those behind"
    );
    assert_eq!(
        why("v 0 0 0\nf 1 1 1 1 \\\n 1\nf 1 2 1\nf 1 1 1\n"),
        "line 4: a corner of a face is vertex 2, but there are 1"
    );
    for number in ["vt 0 inf", "vn 0 -1e31 0"] {
        let text = format!("v 0 0 0\n# here\n{number}\n");
        assert!(why(&text).starts_with("line 3: a number is "), "{number}");
    }
}

#[test]
fn what_has_neither_vertices_nor_faces_is_no_obj() {
    let wide: Vec<u8> = "v 0 0 0\n"
        .encode_utf16()
        .flat_map(u16::to_le_bytes)
        .collect();
    for bytes in [
        b"".as_slice(),
        b"Dear Sir,\nf you\n",
        &[7, 200, 0, 255, 10, 3],
        &wide,
    ] {
        let error = read(bytes).expect_err("it is no OBJ file");
        let text = error.to_string();
        assert!(text.starts_with("this is not a valid OBJ file: "), "{text}");
    }
    assert!(read(b"v 0 0 0\n").is_ok(), "a cloud of one point");
}

#[test]
fn material_is_found_beside_the_file() {
    let library = b"newmtl roof\nKd 1 0 0\nnewmtl wall\nKd 0 0 0\nnewmtl wall #2\nKd .2 .2 .2\nd 0.5\nmap_Kd -s 2 2 -clamp on my textures\\brick wall.png\nnorm -s 2 2 missing.png\n";
    let image = b"\x89PNG\r\n\x1a\n...".to_vec();
    let mut asked = Vec::new();
    let model = read_with(QUAD, &mut |name| {
        asked.push(name.to_owned());
        match name {
            "my house.mtl" => Some(library.to_vec()),
            "my textures/brick wall.png" => Some(image.clone()),
            _ => None,
        }
    })
    .expect("it is valid");
    assert_eq!(
        asked,
        ["my house.mtl", "my textures/brick wall.png", "missing.png"]
    );
    let want = Material {
        base_color_factor: LinearRgba {
            color: LinearRgb::WHITE,
            alpha: 0.5,
        },
        base_color: EncodedImage::new(image).ok(),
        ..Material::default()
    };
    assert_eq!(model.material, want);
    let want = [
        "lines",
        "the texture missing.png, which cannot be read",
        "the option -clamp of the texture, which repeats here",
    ];
    assert_eq!(model.left_out, want);
    assert_eq!(
        read(QUAD).expect("it is valid").material,
        Material::default(),
        "nothing is beside it"
    );
}

#[test]
fn several_libraries_of_one_line_are_found() {
    let text = b"mtllib a.mtl b.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl two\nf 1 2 3\nusemtl one\nf 1 2 3\n";
    let model = read_with(text, &mut |name| match name {
        "a.mtl" => Some(b"newmtl one\nKd 0 0 0".to_vec()),
        "b.mtl" => Some(b"newmtl two\nKd 1 0.5 nan\nKd 1 .5 .25\nd nan".to_vec()),
        _ => None,
    });
    let factor = model.expect("it is valid").material.base_color_factor;
    assert_eq!(factor, LinearRgba::opaque(LinearRgb::new(1.0, 0.5, 0.25)));
}

#[test]
fn further_materials_of_faces_are_listed() {
    let left_out = |uses: &str| {
        let text = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{uses}");
        read(text.as_bytes()).expect("it is valid").left_out
    };
    for one in [
        "usemtl a\nf 1 2 3\nusemtl a\nf 1 2 3\n",
        "usemtl b\nusemtl a\nf 1 2 3\nusemtl b\n",
        "usemtl a\nf 1 2 3\nusemtl b\nusemtl a\nf 1 2 3\n",
    ] {
        assert!(left_out(one).is_empty(), "{one}");
    }
    let two = "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\n";
    assert_eq!(left_out(two), [Model::FURTHER_MATERIALS]);
}

#[test]
fn a_diffuse_color_beyond_single_precision_is_refused() {
    let text = b"mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";
    let read = |kd: &str| {
        let library = format!("newmtl a\nKd {kd}\n").into_bytes();
        read_with(text, &mut |_| Some(library.clone()))
    };
    for kd in ["0 1e300 0", "1e39 0 0", "0 0 -inf", "0 0 1e400"] {
        let error = read(kd).expect_err(kd);
        assert!(
            matches!(error.kind(), MeshIoErrorKind::File { format: "MTL", why } if why.contains("line 2") && why.contains("3.4028235e38")),
            "{kd}: {error}"
        );
    }
    let model = read("0 3e38 0").expect("it is finite");
    assert!(model.check().is_ok(), "what is read can be written");
}

#[test]
fn files_of_a_model_read_back_as_the_same() {
    let mut model = Model::from(cube());
    let count = model.mesh.positions().len();
    let uv = |i: usize| DVec2::new(0.125 * i as f64, 1.0 - 0.0625 * i as f64);
    model.uvs = Some(
        (0..model.mesh.faces().len())
            .map(|i| [uv(i), uv(i + 1), uv(0)])
            .collect(),
    );
    model.normals = Some(model.mesh.vertex_normals());
    let color = |i: usize| {
        LinearRgba::opaque(LinearRgb::from_srgb([
            i as u16 * 7919,
            65535 - i as u16,
            12345,
        ]))
    };
    model.colors = Some((0..count).map(color).collect());
    model.material.base_color = EncodedImage::new(b"\xff\xd8\xff base".to_vec()).ok();
    model.material.normal = EncodedImage::new(b"\x89PNG\r\n\x1a\n normal".to_vec()).ok();
    let files = write_files(&model, "box").expect("it is valid");
    let names: Vec<_> = files.iter().map(|file| file.name.as_str()).collect();
    assert_eq!(
        names,
        ["box_base_color.jpg", "box_normal.png", "box.mtl", "box.obj"]
    );
    let mut resolve = |name: &str| Some(files.iter().find(|file| file.name == name)?.bytes.clone());
    let back = read_with(&files[3].bytes, &mut resolve).expect("it is valid");
    assert_eq!(back, model);
}

#[test]
fn stems_that_no_line_can_name_are_refused() {
    for stem in ["", "a b", "a/b", "a\\b", "a#b", "a\nb"] {
        let error = write_files(&Model::default(), stem).expect_err("it is refused");
        assert!(
            matches!(error.kind(), MeshIoErrorKind::Name { .. }),
            "{error}"
        );
    }
}

#[test]
fn value_stability_obj_text() {
    let mut model = Model::from(mesh(
        &[
            [0.1, -0.0, 1e-300],
            [1e30, 2.0, 1.0 / 3.0],
            [123.0, -1e-5, 5e15],
        ],
        &[[2, 0, 1]],
    ));
    model.uvs = Some(vec![[DVec2::ZERO, DVec2::new(0.3, 0.75), DVec2::ZERO]]);
    model.colors = Some(vec![LinearRgba::opaque(LinearRgb::new(0.5, 0.0, 1.0)); 3]);
    let text = String::from_utf8(write(&model).expect("it is valid")).expect("it is text");
    let want = "v 0.1 -0 1e-300 0.735363 0 1\nv 1e30 2 0.3333333333333333 0.735363 0 1\nv 123 -0.00001 5000000000000000 0.735363 0 1\nvt 0 1\nvt 0.3 0.25\nf 3/1 1/2 2/1\n";
    assert_eq!(text, want);
}

/// Checks that the files have the numbers of vertices and faces that their sources state.
#[test]
fn real_files_have_the_counts_that_are_known() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data/meshes/");
    let read = |name: &str| crate::read_model(format!("{folder}{name}"));
    if !std::path::Path::new(folder).exists() {
        println!("skipped: there is no {folder}");
        return;
    }
    let spot = read("spot.obj").expect("it is valid");
    let report = spot.mesh.report();
    assert_eq!(
        (report.vertices, report.faces, report.boundary_edges),
        (2930, 5856, 0)
    );
    assert!(spot.uvs.is_some(), "it has texture coordinates");
    let gazebo = read("degenerate/gazebo.obj")
        .expect("it is valid")
        .mesh
        .report();
    assert_eq!((gazebo.vertices, gazebo.faces), (480, 730));
    for name in [
        "cube",
        "degenerate_edge",
        "double_sided",
        "duplicate_edge",
        "zero_area_face",
        "zero_length_edge",
    ] {
        let model = read(&format!("degenerate/{name}.obj")).expect("it is valid");
        assert!(!model.mesh.faces().is_empty(), "{name}");
    }
}

proptest! {
    #[test]
    fn meshes_read_back_bit_for_bit(soup in soup()) {
        let back = read(&write(&Model::from(soup.clone())).expect("it is valid")).expect("it is valid");
        let bits = |mesh: &Mesh| mesh.positions().iter().map(|position| position.to_array().map(f64::to_bits)).collect::<Vec<_>>();
        prop_assert_eq!(bits(&back.mesh), bits(&soup));
        prop_assert_eq!(back.mesh.faces(), soup.faces());
    }

    #[test]
    fn positions_read_back_bit_for_bit_at_all_scales(bits in any::<[u64; 3]>()) {
        // Without the highest exponent bit, the number is below 2.
        let position = DVec3::from_array(bits.map(|bits| f64::from_bits(bits & !(1 << 62))));
        let mesh = Mesh::new(vec![position], &[]).expect("it is in range");
        let back = read(&write(&Model::from(mesh)).expect("it is valid")).expect("it is valid");
        prop_assert_eq!(back.mesh.positions()[0].to_array().map(f64::to_bits), position.to_array().map(f64::to_bits));
    }
}
