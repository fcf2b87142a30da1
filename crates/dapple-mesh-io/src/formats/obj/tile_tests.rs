//! Tests of textures for each unit square (UDIM).

use super::{read_with, write_files};
use dapple_mesh::{EncodedImage, Model};

const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";

/// Returns a PNG file that contains its name.
fn png(name: &str) -> Vec<u8> {
    [PNG, name.as_bytes()].concat()
}

/// Returns an OBJ text with a triangle in each of the given unit squares, with v pointing up.
fn text(squares: &[[f64; 2]]) -> String {
    let mut text = "mtllib a.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\n".to_owned();
    for (at, [u, v]) in squares.iter().enumerate() {
        let (u1, v1, first) = (u + 1.0, v + 1.0, 3 * at + 1);
        text += &format!("vt {u} {v}\nvt {u1} {v}\nvt {u} {v1}\n");
        text += &format!("f 1/{first} 2/{} 3/{}\n", first + 1, first + 2);
    }
    text
}

/// Reads an OBJ with a triangle in each of the given unit squares. `material` is the text of its material; `files` are
/// the files in its folder.
fn read(squares: &[[f64; 2]], material: &str, files: &[&str]) -> Model {
    let library = format!("newmtl a\n{material}\n");
    let mut resolve = |name: &str| match name {
        "a.mtl" => Some(library.clone().into_bytes()),
        _ => files.contains(&name).then(|| png(name)),
    };
    read_with(text(squares).as_bytes(), &mut resolve).expect("it is valid")
}

/// Returns the numbers of the unit squares, with the names of their texture files.
fn tiles(model: &Model) -> Vec<(u32, String)> {
    let name = |image: &Option<EncodedImage>| {
        let bytes = image
            .as_ref()
            .map_or(&b""[..], |image| &image.bytes()[PNG.len()..]);
        String::from_utf8(bytes.to_vec()).expect("a name")
    };
    let tile = |tile: &dapple_mesh::TileMaterial| (tile.number, name(&tile.material.base_color));
    model.tiles.iter().map(tile).collect()
}

const SQUARES: [[f64; 2]; 3] = [[0.0, 1.0], [0.0, 0.0], [1.0, 0.0]];

#[test]
fn each_unit_square_has_the_texture_with_its_number() {
    for (name, of) in [
        (
            "skin.<UDIM>.png",
            ["skin.1001.png", "skin.1002.png", "skin.1011.png"],
        ),
        (
            "skin_<udim>.png",
            ["skin_1001.png", "skin_1002.png", "skin_1011.png"],
        ),
        (
            "<UVTILE>/skin.png",
            ["u1_v1/skin.png", "u2_v1/skin.png", "u1_v2/skin.png"],
        ),
        (
            "skin.1001.png",
            ["skin.1001.png", "skin.1002.png", "skin.1011.png"],
        ),
        (
            "skin1011.png",
            ["skin1001.png", "skin1002.png", "skin1011.png"],
        ),
    ] {
        let model = read(&SQUARES, &format!("map_Kd {name}"), &of);
        let want = [1001, 1002, 1011].into_iter().zip(of.map(str::to_owned));
        assert_eq!(tiles(&model), want.collect::<Vec<_>>(), "{name}");
        assert_eq!(model.material, model.tiles[0].material, "{name}");
        assert_eq!(model.left_out, [""; 0], "{name}");
    }
    let one = read(&[[0.0, 0.0]], "map_Kd skin.<UDIM>.png", &["skin.1001.png"]);
    assert!(one.tiles.is_empty() && one.material.base_color.is_some());
    let moved = "map_Kd -o 1 0 skin.<UDIM>.png";
    let moved = read(&[[0.0, 0.0]], moved, &["skin.1002.png"]);
    assert!(
        moved.material.base_color.is_some(),
        "the square after the offset"
    );
}

#[test]
fn textures_that_unit_squares_lack_are_listed() {
    let files = ["skin.1001.png"];
    let model = read(&SQUARES, "map_Kd skin.<UDIM>.png", &files);
    let why = "the texture skin.1002.png, which cannot be read, and 1 more of its unit squares";
    assert_eq!(model.left_out, [why]);
    assert_eq!(model.tiles.len(), 3);
    // A number in the name is not a pattern if the other files are missing.
    let model = read(&SQUARES, "map_Kd skin.1001.png", &files);
    assert!(model.tiles.is_empty() && model.material.base_color.is_some());
    assert_eq!(model.left_out, [""; 0]);
    let across = read(&[[0.5, 0.0]], "map_Kd skin.<UDIM>.png", &files);
    assert!(across.material.base_color.is_none());
    assert!(
        across.left_out[0].contains("across unit squares"),
        "{:?}",
        across.left_out
    );
    let material = "map_Kd skin.<UDIM>.png\nnorm n.png";
    let files = ["skin.1001.png", "skin.1002.png", "skin.1011.png", "n.png"];
    let model = read(&SQUARES, material, &files);
    assert_eq!(
        model.left_out,
        ["the texture n.png, which all unit squares share"]
    );
}

#[test]
fn textures_of_unit_squares_are_written_and_read_again() {
    let files = ["skin.1001.png", "skin.1002.png", "skin.1011.png"];
    let model = read(&SQUARES, "map_Kd skin.<UDIM>.png", &files);
    let written = write_files(&model, "out").expect("it is written");
    let names: Vec<_> = written.iter().map(|file| file.name.as_str()).collect();
    let [a, b, c] = [1001, 1002, 1011].map(|number| format!("out_base_color.{number}.png"));
    assert_eq!(names, [&a, &b, &c, "out.mtl", "out.obj"]);
    let mut resolve = |name: &str| {
        let found = written.iter().find(|file| file.name == name);
        found.map(|file| file.bytes.clone())
    };
    let again = read_with(&written[4].bytes, &mut resolve).expect("it is valid");
    assert_eq!(again, model);
}

#[cfg(feature = "gltf")]
#[test]
fn gltf_refuses_textures_of_unit_squares() {
    let files = ["skin.1001.png", "skin.1002.png", "skin.1011.png"];
    let model = read(&SQUARES, "map_Kd skin.<UDIM>.png", &files);
    let error = crate::gltf::write(&model).expect_err("it has one material");
    assert!(error.to_string().contains("UDIM"), "{error}");
}
