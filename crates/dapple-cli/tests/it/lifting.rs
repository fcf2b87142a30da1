//! Tests of `dapple synth` with a mesh as the example: transfer of its texture to another mesh, and repairs.

use crate::support::{Folder, SHELL_SIDE, assert_done, assert_refused, shell, stderr};
use dapple::color::{LinearRgb, LinearRgba};
use dapple::image::{Image, Limits, PngPixels, Transfer, decode_image, encode_png};
use dapple::mesh::{EncodedImage, Material, Model, TileMaterial};
use dapple::mesh_io::{read_model, write_model};
use dapple::points::glam::DVec2;
use dapple::raster::Raster;

/// Runs the command in a folder. `line` holds its arguments.
fn run(folder: &Folder, line: &str) -> std::process::Output {
    folder.run(&line.split_whitespace().collect::<Vec<_>>())
}

/// Returns the codes of an image with three channels of 8 bits.
fn codes(image: Option<&EncodedImage>) -> Raster<[u8; 3]> {
    match decode_image(image.unwrap().bytes(), &Limits::default()).unwrap() {
        Image::Codes(_, png) => match png.pixels {
            PngPixels::Rgb8(raster) => raster,
            other => panic!("{:?} pixels without 8 bits", other.size()),
        },
        other => panic!("{:?} is no PNG", other.channels()),
    }
}

#[test]
fn texture_and_maps_of_a_mesh_are_lifted_onto_another() {
    let folder = Folder::with_inputs("lifting");
    let mut source = shell().clone();
    // Roughness and metalness that follow the color, and a relief that is flat.
    source.material.metallic_roughness = source.material.base_color.clone();
    let flat = std::fs::read(folder.path("normal.png")).unwrap();
    source.material.normal = Some(EncodedImage::new(flat).unwrap());
    write_model(folder.path("source.glb"), &source).unwrap();
    let line = "synth source.glb --mesh model.obj --sites 3000 --texture-size 256 -o lifted.glb";
    assert_done(&run(&folder, line), line);
    let model = read_model(folder.path("lifted.glb")).unwrap();
    let base = codes(model.material.base_color.as_ref());
    let packed = codes(model.material.metallic_roughness.as_ref());
    let mut greens = [0; 2];
    for (base, packed) in base.pixels().iter().zip(packed.pixels()) {
        // One of the two colors, or what lies between; green is roughness, and says the color.
        assert!(
            base[0].abs_diff(90) < 3 && base[2].abs_diff(60) < 3,
            "{base:?}"
        );
        assert!(base[1].abs_diff(packed[1]) < 3, "{base:?} {packed:?}");
        greens[usize::from(base[1] > 130)] += 1;
    }
    let least = base.pixels().len() / 4;
    assert!(greens.iter().all(|&count| count > least), "{greens:?}");
    assert!(model.material.normal.is_some(), "normals travel");
    // Sites, and the texture alone; a map that is given goes before that of the material.
    for line in [
        "synth source.glb --mesh model.obj --sites 600 -o lifted.ply",
        "synth source.glb --mesh model.obj --sites 600 --texture-size 128 -o lifted.png",
        "synth source.glb --mesh model.obj --sites 600 --example-sites 900 \
         --example-directions directions.csv --texture-size 128 --map normal=normal.png \
         --map height=height.png --displace 0.02 -o lifted.obj",
    ] {
        assert_done(&run(&folder, line), line);
    }
    let names = folder.names();
    for name in ["lifted.mtl", "lifted_normal.png", "lifted_height.png"] {
        assert!(names.iter().any(|other| other == name), "{name}: {names:?}");
    }
}

#[test]
fn colors_of_vertices_are_lifted_too() {
    let folder = Folder::with_inputs("vertices");
    let mut source = Model::from(shell().mesh.clone());
    let red = LinearRgba::opaque(LinearRgb::new(0.5, 0.1, 0.1));
    source.colors = Some(vec![red; source.mesh.positions().len()]);
    write_model(folder.path("red.ply"), &source).unwrap();
    let line = "synth red.ply --mesh model.obj --sites 500 --texture-size 128 -o red.glb";
    assert_done(&run(&folder, line), line);
    let model = read_model(folder.path("red.glb")).unwrap();
    let red = red.color.to_srgb::<u8>();
    for code in codes(model.material.base_color.as_ref()).pixels() {
        let off = code.iter().zip(red).map(|(a, b)| a.abs_diff(b)).max();
        assert!(off < Some(3), "{code:?} instead of {red:?}");
    }
}

/// Checks that no texels outside of the stain changed, and that some within it did.
fn assert_only_the_stain_is_new(before: &Raster<[u8; 3]>, after: &Raster<[u8; 3]>) {
    let mut n_new = 0;
    for y in 0..SHELL_SIDE {
        for x in 0..SHELL_SIDE {
            let is_stain = x.abs_diff(128) < 24 && y.abs_diff(128) < 24;
            let [before, after] = [before, after].map(|map| map.row(y)[x as usize]);
            assert!(is_stain || before == after, "texel {x} {y}");
            n_new += usize::from(before != after);
        }
    }
    assert!(n_new > 0, "something is made again");
}

#[test]
fn a_repair_of_a_mesh_changes_only_texels_that_are_white_in_its_mask() {
    let folder = Folder::with_inputs("mending");
    let line = "synth shell.glb --repair stain.png --example-sites 6000 -o clean.glb";
    assert_done(&run(&folder, line), line);
    let line = "synth shell.glb --repair stain.png --example-sites 6000 --format png8 -o clean.png";
    assert_done(&run(&folder, line), line);
    let clean = read_model(folder.path("clean.glb")).unwrap();
    let before = codes(shell().material.base_color.as_ref());
    let after = codes(clean.material.base_color.as_ref());
    let alone = std::fs::read(folder.path("clean.png")).unwrap();
    assert!(codes(Some(&EncodedImage::new(alone).unwrap())) == after);
    assert_only_the_stain_is_new(&before, &after);
    assert_eq!(clean.uvs, read_model(folder.path("shell.glb")).unwrap().uvs);
}

/// Returns the JSON of a GLB file, which is its first chunk.
fn document(path: std::path::PathBuf) -> serde_json::Value {
    let bytes = std::fs::read(path).unwrap();
    let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    serde_json::from_slice(&bytes[20..20 + length]).unwrap()
}

#[test]
fn a_repair_of_a_mesh_keeps_all_of_its_document_but_images() {
    let folder = Folder::with_inputs("document");
    // What a model has no place for.
    let mut before = document(folder.path("shell.glb"));
    let bytes = std::fs::read(folder.path("shell.glb")).unwrap();
    let material = &mut before["materials"][0];
    material["pbrMetallicRoughness"]["metallicFactor"] = 1.into();
    material["pbrMetallicRoughness"]["roughnessFactor"] = 0.25.into();
    material["emissiveFactor"] = serde_json::json!([1, 0.5, 0]);
    material["alphaMode"] = "MASK".into();
    material["alphaCutoff"] = 0.2.into();
    before["nodes"][0]["translation"] = serde_json::json!([500000.1, 4649776.3, 120]);
    before["nodes"][0]["name"] = "shell".into();
    let mut json = before.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let rest = &bytes[20 + u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize..];
    let length = (20 + json.len() + rest.len()) as u32;
    let head = [
        &b"glTF\x02\0\0\0"[..],
        &length.to_le_bytes(),
        &(json.len() as u32).to_le_bytes(),
        b"JSON",
    ];
    std::fs::write(
        folder.path("odd.glb"),
        [&head.concat(), &json, rest].concat(),
    )
    .unwrap();
    let line = "synth odd.glb --repair stain.png --example-sites 6000 -o clean.glb";
    assert_done(&run(&folder, line), line);
    let mut after = document(folder.path("clean.glb"));
    for file in [&mut before, &mut after] {
        for name in ["images", "bufferViews", "buffers"] {
            file.as_object_mut().unwrap().remove(name);
        }
    }
    assert_eq!(after, before);
    let positions = |name: &str| {
        read_model(folder.path(name))
            .unwrap()
            .mesh
            .positions()
            .to_vec()
    };
    assert_eq!(
        positions("clean.glb"),
        positions("odd.glb"),
        "far from zero, too"
    );
}

#[test]
fn meshes_without_texture_and_options_without_effect_are_refused() {
    let folder = Folder::with_inputs("no-example");
    let mut plain = shell().clone();
    plain.material.base_color = None;
    write_model(folder.path("plain.glb"), &plain).unwrap();
    let mut unmapped = shell().clone();
    unmapped.uvs = None;
    write_model(folder.path("unmapped.glb"), &unmapped).unwrap();
    let library = "newmtl a\nmap_Kd photo.png\nnewmtl b\n";
    std::fs::write(folder.path("two.mtl"), library).unwrap();
    let mesh = "mtllib two.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n\
        usemtl a\nf 1/1 2/2 3/3\nusemtl b\nf 1/1 3/3 4/4\n";
    std::fs::write(folder.path("two.obj"), mesh).unwrap();
    for (line, part) in [
        (
            "synth plain.glb --mesh model.obj -o a.glb",
            "neither a texture nor colors of vertices",
        ),
        (
            "synth two.obj --mesh model.obj -o a.glb",
            "faces of two.obj have several materials",
        ),
        ("synth unmapped.glb --mesh model.obj -o a.glb", "texture"),
        (
            "synth model.obj --mesh shell.glb -o a.glb",
            "neither a texture nor colors of vertices",
        ),
        ("synth shell.glb -o a.glb", "needs another one"),
        (
            "synth shell.glb --mesh model.obj --size 64 -o a.glb",
            "--size has no effect",
        ),
        (
            "synth shell.glb --mesh model.obj --region 0,0,8,8 -o a.glb",
            "--region has no effect",
        ),
        (
            "synth shell.glb --mesh model.obj --detail photo.png -o a.glb",
            "--detail has no effect",
        ),
        (
            "synth photo.png --example-sites 9 --mesh model.obj -o a.glb",
            "--example-sites has no effect",
        ),
        ("synth shell.glb --repair scratch.png -o a.glb", "64 × 64"),
        (
            "synth shell.glb --repair stain.png -o a.obj",
            "holds its texture",
        ),
        (
            "synth plain.glb --repair stain.png -o a.glb",
            "neither a texture",
        ),
        (
            "synth shell.glb --mesh model.obj --sites 9 --example-sites 0 -o a.glb",
            "sites",
        ),
    ] {
        let output = run(&folder, line);
        assert!(!output.status.success(), "{line}");
        let text = stderr(&output);
        assert!(text.contains(part), "{line}: {text}");
        assert!(
            !folder.names().iter().any(|name| name.starts_with("a.")),
            "{line}"
        );
    }
}

/// Returns the shell with its left half in UDIM tile 1001 and its right half in 1012. Each tile has its own image.
fn in_two_squares(images: [&EncodedImage; 2]) -> Model {
    let mut model = shell().clone();
    let positions = model.mesh.positions();
    let middle = positions.iter().map(|at| at.x).sum::<f64>() / positions.len() as f64;
    for (face, corners) in model.mesh.faces().iter().zip(model.uvs.as_mut().unwrap()) {
        let x: f64 = face.iter().map(|vertex| positions[vertex.index()].x).sum();
        if x / 3.0 > middle {
            corners
                .iter_mut()
                .for_each(|uv| *uv += DVec2::new(1.0, -1.0));
        }
    }
    let tile = |(number, image): (u32, &EncodedImage)| TileMaterial {
        number,
        material: Material {
            base_color: Some(image.clone()),
            ..Material::default()
        },
    };
    model.tiles = [1001, 1012].into_iter().zip(images).map(tile).collect();
    model.material = model.tiles[0].material.clone();
    assert_eq!(model.unit_squares(), [1001, 1012], "both have faces");
    model
}

/// Returns a square image of one color.
fn plain(side: u32, color: [u8; 3]) -> EncodedImage {
    let codes = Raster::filled([side; 2], color).unwrap();
    EncodedImage::new(encode_png(codes.view(), Transfer::Srgb).unwrap()).unwrap()
}

#[test]
fn each_unit_square_of_an_example_has_its_own_texture() {
    let folder = Folder::with_inputs("squares");
    let colors = [[200, 40, 40], [40, 40, 200]];
    let [red, blue] = colors.map(|color| plain(64, color));
    write_model(folder.path("skin.obj"), &in_two_squares([&red, &blue])).unwrap();
    let line = "synth skin.obj --mesh model.obj --sites 1500 --texture-size 128 -o out.glb";
    let output = run(&folder, line);
    assert_done(&output, line);
    assert!(!stderr(&output).contains("not used"), "{}", stderr(&output));
    let model = read_model(folder.path("out.glb")).unwrap();
    let base = codes(model.material.base_color.as_ref());
    let is_near = |code: &[u8; 3], color: [u8; 3]| {
        code.iter()
            .zip(color)
            .all(|(&code, color)| code.abs_diff(color) < 3)
    };
    for color in colors {
        let count = base
            .pixels()
            .iter()
            .filter(|code| is_near(code, color))
            .count();
        assert!(count > base.pixels().len() / 8, "{color:?}: {count}");
    }
    // A single mask is for no square in particular, and textures of two sizes have no common one.
    let line = "synth skin.obj --repair stain.png -o clean.png";
    assert_refused(&run(&folder, line), 2, "2 unit squares", line);
    let line = "synth skin.obj --repair stain.png -o clean.glb";
    assert_refused(&run(&folder, line), 2, "glTF holds one", line);
    let large = in_two_squares([&red, &plain(128, [0; 3])]);
    write_model(folder.path("skin.obj"), &large).unwrap();
    let line = "synth skin.obj --mesh model.obj --sites 500 -o out.glb --force";
    assert_refused(&run(&folder, line), 1, "1012 has 128 × 128 pixels", line);
    std::fs::remove_file(folder.path("skin_base_color.1012.png")).unwrap();
    assert_refused(&run(&folder, line), 1, "unit square 1012", line);
}

#[test]
fn a_repair_writes_an_image_for_each_unit_square() {
    let folder = Folder::with_inputs("mended-squares");
    let checker = shell().material.base_color.as_ref().unwrap();
    write_model(folder.path("skin.obj"), &in_two_squares([checker, checker])).unwrap();
    std::fs::write(
        folder.path("mask.1001.png"),
        plain(SHELL_SIDE, [0; 3]).bytes(),
    )
    .unwrap();
    std::fs::copy(folder.path("stain.png"), folder.path("mask.1012.png")).unwrap();
    let line =
        "synth skin.obj --repair mask.<UDIM>.png --example-sites 6000 --format png8 -o clean.png";
    assert_done(&run(&folder, line), line);
    let read = |name: &str| {
        let bytes = std::fs::read(folder.path(name)).unwrap();
        codes(Some(&EncodedImage::new(bytes).unwrap()))
    };
    let before = codes(Some(checker));
    assert!(read("clean.1001.png") == before, "its mask is black");
    let after = read("clean.1012.png");
    assert_only_the_stain_is_new(&before, &after);
}

#[test]
fn a_mesh_with_several_unit_squares_gets_a_texture_for_each() {
    let folder = Folder::with_inputs("covered-squares");
    let white = plain(8, [255; 3]);
    let target = in_two_squares([&white, &white]);
    write_model(folder.path("skin.obj"), &target).unwrap();
    let of = "synth rock.png --map normal=rock_normal.png --mesh skin.obj --atlas uv --sites 2000 --texture-size 64";
    let line = format!("{of} -o out.png");
    let output = run(&folder, &line);
    assert_done(&output, &line);
    assert!(
        !stderr(&output).contains("share one texture"),
        "{}",
        stderr(&output)
    );
    let line = format!("{of} --force -o out.obj");
    assert_done(&run(&folder, &line), &line);
    let model = read_model(folder.path("out.obj")).unwrap();
    let numbers: Vec<_> = model.tiles.iter().map(|tile| tile.number).collect();
    assert_eq!(numbers, [1001, 1012], "as the mesh has them");
    assert_eq!(model.uvs, read_model(folder.path("skin.obj")).unwrap().uvs);
    for tile in &model.tiles {
        let alone = std::fs::read(folder.path(&format!("out.{}.png", tile.number))).unwrap();
        let base = tile.material.base_color.as_ref().unwrap();
        assert!(base.bytes() == alone, "{} has the image alone", tile.number);
        assert!(
            tile.material.normal.is_some(),
            "{} has normals",
            tile.number
        );
    }
    let [first, second] = [0, 1].map(|at| model.tiles[at].material.base_color.clone());
    assert!(
        first != second,
        "each square has its own part of the texture"
    );
    let line = format!("{of} --force -o out.glb");
    let output = run(&folder, &line);
    assert_done(&output, &line);
    assert!(
        stderr(&output).contains("share one texture"),
        "glTF has one"
    );
}
