//! Tests of `dapple synth` with a mesh as the example: textures lifted onto another mesh, and repairs.

use crate::support::{Folder, SHELL_SIDE, assert_done, shell, stderr};
use dapple::color::{LinearRgb, LinearRgba};
use dapple::image::{Image, Limits, PngPixels, decode_image};
use dapple::mesh::{EncodedImage, Model};
use dapple::mesh_io::{read_model, write_model};
use dapple::raster::Raster;

/// Runs a line in a folder.
fn run(folder: &Folder, line: &str) -> std::process::Output {
    folder.run(&line.split_whitespace().collect::<Vec<_>>())
}

/// The codes of an image with 8 bits in three channels.
fn codes(image: Option<&EncodedImage>) -> Raster<[u8; 3]> {
    match decode_image(image.unwrap().bytes(), &Limits::default()).unwrap() {
        Image::Png(png) => match png.pixels {
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
    let mut n_new = 0;
    for y in 0..SHELL_SIDE {
        for x in 0..SHELL_SIDE {
            let is_stain = x.abs_diff(128) < 24 && y.abs_diff(128) < 24;
            let [before, after] = [&before, &after].map(|map| map.row(y)[x as usize]);
            assert!(is_stain || before == after, "texel {x} {y}");
            n_new += usize::from(before != after);
        }
    }
    assert!(n_new > 0, "something is made again");
    assert_eq!(clean.uvs, read_model(folder.path("shell.glb")).unwrap().uvs);
}

/// The JSON of a GLB file, which is its first chunk.
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
