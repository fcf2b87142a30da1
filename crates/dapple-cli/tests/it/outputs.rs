//! Tests of formats for other programs: presets, documents, arrays and raw heights.

use crate::support::{Folder, assert_done, assert_refused, stderr, stdout};
use dapple::image::{Limits, PngPixels, decode_png, read_image};
use dapple::mesh_io::gltf;
use dapple::raster::Raster;
use std::fs;

/// A recipe whose maps all vary and differ from one another.
const VARIED: &str = r##"
dapple = 1
seed = 5
extent = [2.0, 1.0]

[nodes.cells.worley]
frequency = 3.0

[nodes.stones.levels]
input = "cells"
from = [0.0, 0.8]

[nodes.rough.levels]
input = "cells"
from = [0.0, 2.0]
to = [0.9, 0.2]

[nodes.metal.wavelet]
frequency = 4.0

[nodes.shine.levels]
input = "metal"
from = [-1.0, 1.0]

[nodes.paint.ramp]
input = "stones"
colors = ["#203040", "#e0a060"]

[material]
height = "stones"
relief = 0.25
albedo = "paint"
roughness = "rough"
metallic = "shine"
normal_y = "directx"
"##;

const SIZE: &str = "48x24";

/// Creates a folder with the recipe.
fn folder(name: &str) -> Folder {
    let folder = Folder::new(name);
    fs::write(folder.path("varied.toml"), VARIED).unwrap();
    folder
}

/// Returns the channels of a PNG as 16-bit codes. 8-bit codes are multiplied by 257. A gray image has one channel.
fn channels(folder: &Folder, name: &str) -> Vec<Vec<u16>> {
    fn split<const N: usize>(raster: &Raster<[u16; N]>) -> Vec<Vec<u16>> {
        let channel = |at: usize| raster.pixels().iter().map(|pixel| pixel[at]).collect();
        (0..N).map(channel).collect()
    }
    let bytes = fs::read(folder.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
    let wide = |code: u8| u16::from(code) * 257;
    match decode_png(&bytes, &Limits::default()).unwrap().pixels {
        PngPixels::Gray8(raster) => split(&raster.map(|&code| [wide(code)])),
        PngPixels::Gray16(raster) => split(&raster.map(|&code| [code])),
        PngPixels::Rgb8(raster) => split(&raster.map(|codes| codes.map(wide))),
        PngPixels::Rgb16(raster) => split(&raster),
        PngPixels::Rgba8(raster) => split(&raster.map(|codes| codes.map(wide))),
        other => panic!("{name}: {other:?}"),
    }
}

/// Returns the channels of a map that is baked alone.
fn map(folder: &Folder, name: &str, normal_y: &str, format: &str) -> Vec<Vec<u16>> {
    let file = format!("own_{name}_{normal_y}_{format}.png");
    if !folder.path(&file).exists() {
        let run = [
            "bake",
            "varied.toml",
            "--size",
            SIZE,
            "--maps",
            name,
            "--normal-y",
            normal_y,
            "--format",
            format,
            "-o",
            &file,
        ];
        assert_done(&folder.run(&run), name);
    }
    channels(folder, &file)
}

/// File name without its extension, format, and the expected content of each channel.
type File = (&'static str, &'static str, &'static str);

/// Expected files of each preset, as the engines document them: the name, the direction of green, and the files. A
/// channel is written as a map and the index of a channel in it. `!` inverts the map, and `1` is white.
const EXPECTED: [(&str, &str, &[File]); 5] = [
    (
        "unity",
        "opengl",
        &[
            ("varied_BaseMap", "png8", "albedo.0 albedo.1 albedo.2"),
            ("varied_Normal", "png8", "normal.0 normal.1 normal.2"),
            ("varied_MaskMap", "png8", "metallic.0 ao.0 1 !roughness.0"),
            (
                "varied_MetallicSmoothness",
                "png8",
                "metallic.0 metallic.0 metallic.0 !roughness.0",
            ),
            ("varied_Occlusion", "png8", "ao.0"),
            ("varied_Height", "png16", "height.0"),
        ],
    ),
    (
        "unreal",
        "directx",
        &[
            ("T_varied_BaseColor", "png8", "albedo.0 albedo.1 albedo.2"),
            ("T_varied_Normal", "png8", "normal.0 normal.1 normal.2"),
            ("T_varied_ORM", "png8", "ao.0 roughness.0 metallic.0"),
            ("T_varied_Height", "png16", "height.0"),
        ],
    ),
    (
        "godot",
        "opengl",
        &[
            ("varied_albedo", "png8", "albedo.0 albedo.1 albedo.2"),
            ("varied_normal", "png8", "normal.0 normal.1 normal.2"),
            ("varied_orm", "png8", "ao.0 roughness.0 metallic.0"),
            ("varied_height", "png16", "height.0"),
        ],
    ),
    (
        "gltf",
        "opengl",
        &[
            ("varied_baseColor", "png8", "albedo.0 albedo.1 albedo.2"),
            ("varied_normal", "png8", "normal.0 normal.1 normal.2"),
            (
                "varied_occlusionRoughnessMetallic",
                "png8",
                "ao.0 roughness.0 metallic.0",
            ),
        ],
    ),
    (
        "blender",
        "opengl",
        &[
            ("varied_basecolor", "png8", "albedo.0 albedo.1 albedo.2"),
            ("varied_roughness", "png16", "roughness.0"),
            ("varied_metallic", "png16", "metallic.0"),
            ("varied_normal", "png16", "normal.0 normal.1 normal.2"),
            ("varied_height", "png16", "height.0"),
            ("varied_ao", "png16", "ao.0"),
        ],
    ),
];

#[test]
fn presets_write_the_files_and_channels_of_their_programs() {
    let folder = folder("presets");
    for (preset, normal_y, files) in EXPECTED {
        let output = format!("{preset}/");
        let run = [
            "bake",
            "varied.toml",
            "--size",
            SIZE,
            "--preset",
            preset,
            "-o",
            &output,
        ];
        assert_done(&folder.run(&run), preset);
        let mut names: Vec<_> = files
            .iter()
            .map(|(file, ..)| format!("{file}.png"))
            .collect();
        if preset == "unity" {
            names.extend(names.clone().iter().map(|name| format!("{name}.meta")));
        }
        if preset == "godot" {
            names.push("varied.tres".to_owned());
        }
        names.sort();
        let mut written: Vec<_> = fs::read_dir(folder.path(preset))
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        written.sort();
        assert_eq!(written, names, "{preset}");
        for (file, format, expected) in files {
            let found = channels(&folder, &format!("{preset}/{file}.png"));
            let expected: Vec<_> = expected.split(' ').collect();
            assert_eq!(
                found.len(),
                expected.len(),
                "{preset}: the channels of {file}"
            );
            for (found, expected) in found.iter().zip(expected) {
                check_channel(&folder, found, expected, normal_y, format);
            }
        }
    }
}

/// Checks that a channel has the expected content, written as in [`EXPECTED`].
fn check_channel(folder: &Folder, found: &[u16], expected: &str, normal_y: &str, format: &str) {
    if expected == "1" {
        assert!(found.iter().all(|&code| code == u16::MAX), "white");
        return;
    }
    let (name, channel) = expected.trim_start_matches('!').split_once('.').unwrap();
    let map = &map(folder, name, normal_y, format)[channel.parse::<usize>().unwrap()];
    let range = map.iter().max().unwrap() - map.iter().min().unwrap();
    assert!(range > 2000, "{name} varies, or nothing is tested: {range}");
    if expected.starts_with('!') {
        // A half is rounded up on both ways, which is one code of 8 bits.
        let is_near = |(&found, &code): (&u16, &u16)| found.abs_diff(u16::MAX - code) <= 257;
        assert!(found.iter().zip(map).all(is_near), "{expected}");
    } else {
        assert_eq!(found, map, "{expected}");
    }
}

#[test]
fn presets_and_documents_say_what_does_not_go_with_them() {
    let folder = folder("conflicts");
    let run = |more: &str| {
        let words = ["bake", "varied.toml", "--size", "16"];
        let words: Vec<_> = words.into_iter().chain(more.split(' ')).collect();
        folder.run(&words)
    };
    assert_refused(
        &run("--preset unity --maps ao -o a/"),
        2,
        "--maps",
        "maps of a preset",
    );
    assert_refused(&run("--preset unitty -o a/"), 2, "unity", "a slip");
    assert_refused(
        &run("-o a.glb --maps ao"),
        2,
        "--maps",
        "maps of a document",
    );
    assert_refused(
        &run("-o a.glb --sheet"),
        2,
        "--sheet",
        "a sheet of a document",
    );
    assert_refused(
        &run("-o a.mtlx --normal-y directx"),
        2,
        "--normal-y directx",
        "normals",
    );
    assert_refused(&run("--preset glb -o a.png"), 2, ".glb", "another ending");
    assert_refused(&run("--preset unity -o a.exr"), 2, "PNG", "another format");
    assert_refused(
        &run("--preset unity,unreal -o a.png"),
        2,
        "folder",
        "a file for two presets",
    );
    assert_refused(&run("-o a.tres --frames 2"), 2, "--frames", "a loop");
    assert_eq!(folder.names(), ["varied.toml"], "nothing is left");
}

#[test]
fn several_presets_have_a_folder_each_with_the_files_of_each_alone() {
    let folder = folder("several-presets");
    let bake = |preset: &str, output: &str| {
        let line = format!("bake varied.toml --size 16 --preset {preset} -o {output}");
        let words: Vec<_> = line.split(' ').collect();
        assert_done(&folder.run(&words), &line);
    };
    bake("unreal,godot,unreal", "all/");
    let names = |path: &str| {
        let entries = fs::read_dir(folder.path(path)).unwrap();
        let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<_> = names.collect();
        names.sort();
        names
    };
    assert_eq!(names("all"), ["godot", "unreal"]);
    for preset in ["unreal", "godot"] {
        let (all, one) = (format!("all/{preset}"), format!("one/{preset}"));
        bake(preset, &format!("{one}/"));
        assert_eq!(names(&all), names(&one));
        for name in names(&all) {
            let bytes = |of: &str| fs::read(folder.path(of).join(&name)).unwrap();
            assert!(bytes(&all) == bytes(&one), "{name} of {preset}");
        }
    }
    let line = "bake varied.toml --size 16 --seed 1-2 --preset unity,gltf --contact-sheet -o v/";
    let words: Vec<_> = line.split(' ').collect();
    assert_done(&folder.run(&words), line);
    assert_eq!(names("v"), ["contact_sheet.png", "gltf", "unity"]);
    assert_eq!(names("v/gltf").len(), 2 * 3);
}

#[test]
fn unity_reads_import_settings_beside_each_image() {
    let folder = folder("metas");
    let bake = |more: &str| {
        let line = format!("bake varied.toml --size 16 --preset unity -o u/{more}");
        let words: Vec<_> = line.split(' ').collect();
        folder.run(&words)
    };
    assert_done(&bake(""), "unity");
    let meta = |name: &str| fs::read_to_string(folder.path(&format!("u/varied_{name}.png.meta")));
    for (name, srgb, kind) in [
        ("BaseMap", 1, 0),
        ("Normal", 0, 1),
        ("MaskMap", 0, 0),
        ("Height", 0, 0),
    ] {
        let text = meta(name).unwrap();
        for line in [
            format!("    sRGBTexture: {srgb}"),
            format!("  textureType: {kind}"),
            "    wrapU: 0".to_owned(),
        ] {
            assert!(text.lines().any(|found| found == line), "{line} in {text}");
        }
        let id = text.lines().nth(1).unwrap().strip_prefix("guid: ").unwrap();
        assert!(id.len() == 32 && id.bytes().all(|digit| digit.is_ascii_hexdigit()));
    }
    let id = |name: &str| meta(name).unwrap().lines().nth(1).unwrap().to_owned();
    assert_ne!(id("BaseMap"), id("Normal"));
    // Settings that were changed in Unity remain.
    fs::write(folder.path("u/varied_Normal.png.meta"), "changed").unwrap();
    assert_done(&bake(" --force"), "again");
    assert_eq!(meta("Normal").unwrap(), "changed");
}

#[test]
fn a_material_of_godot_names_its_images() {
    let folder = folder("tres");
    fs::write(folder.path("glowing.toml"), GLOWING).unwrap();
    for line in [
        "bake varied.toml --size 16 -o rock.tres",
        "bake glowing.toml --size 16 --preset godot -o glowing/",
        "bake varied.toml --size 16 --preset godot --frames 2 -o loop/",
    ] {
        let words: Vec<_> = line.split(' ').collect();
        let run = folder.run(&words);
        assert_done(&run, line);
        let note = "note: --frames leaves out the material for Godot, varied.tres\n";
        let count = stderr(&run).matches(note).count();
        assert_eq!(count, usize::from(line.contains("--frames")), "{line}");
    }
    let text = fs::read_to_string(folder.path("rock.tres")).unwrap();
    assert!(text.starts_with("[gd_resource type=\"ORMMaterial3D\" load_steps=5 format=3]\n\n"));
    for map in ["albedo", "normal", "orm", "height"] {
        let file = format!("rock_{map}.png");
        assert!(folder.path(&file).is_file(), "{file}");
        assert!(text.contains(&format!(
            "[ext_resource type=\"Texture2D\" path=\"{file}\" id="
        )));
    }
    // Each texture of the material is one of the listed files, and each file is used once.
    for id in 1..=4 {
        assert_eq!(text.matches(&format!("ExtResource(\"{id}\")")).count(), 1);
    }
    for line in [
        "normal_enabled = true",
        "ao_enabled = true",
        "texture_repeat = true",
    ] {
        assert!(text.lines().any(|found| found == line), "{line} in {text}");
    }
    assert!(!text.contains("transparency"), "{text}");
    let text = fs::read_to_string(folder.path("glowing/glowing.tres")).unwrap();
    for line in [
        "transparency = 2",
        "alpha_scissor_threshold = 0.25",
        "emission_energy_multiplier = 4.0",
        "clearcoat_roughness = 0.03",
    ] {
        assert!(text.lines().any(|found| found == line), "{line} in {text}");
    }
    assert!(
        !folder.path("loop/varied.tres").exists(),
        "a loop has no material"
    );
    assert!(folder.path("loop/varied_orm_002.png").is_file());
}

#[test]
fn a_glb_is_a_plane_with_the_whole_material() {
    let folder = folder("glb");
    let run = [
        "bake",
        "varied.toml",
        "--size",
        SIZE,
        "-o",
        "v.glb",
        "--preview",
    ];
    assert_done(&folder.run(&run), "glb");
    assert_eq!(folder.names(), ["v.glb", "v_preview.png", "varied.toml"]);
    let run = [
        "bake",
        "varied.toml",
        "--size",
        SIZE,
        "--preset",
        "gltf",
        "-o",
        "own/",
    ];
    assert_done(&folder.run(&run), "gltf");
    let model = gltf::read(&fs::read(folder.path("v.glb")).unwrap()).unwrap();
    let own = |part: &str| Some(fs::read(folder.path(&format!("own/varied_{part}.png"))).unwrap());
    let bytes = |image: &Option<dapple::mesh::EncodedImage>| {
        image.as_ref().map(|image| image.bytes().to_vec())
    };
    let material = &model.material;
    assert_eq!(bytes(&material.base_color), own("baseColor"));
    assert_eq!(bytes(&material.normal), own("normal"));
    assert_eq!(
        bytes(&material.metallic_roughness),
        own("occlusionRoughnessMetallic")
    );
    assert_eq!(material.occlusion, material.metallic_roughness);
    // The tile is 2 by 1 meters; u goes along x, v along z, and it is seen from above.
    let uvs = model.uvs.as_ref().unwrap();
    for (face, uvs) in model.mesh.faces().iter().zip(uvs) {
        let corners = face.map(|vertex| model.mesh.positions()[vertex.index()]);
        for (corner, uv) in corners.iter().zip(uvs) {
            assert_eq!(corner.to_array(), [2.0 * uv.x - 1.0, 0.0, uv.y - 0.5]);
        }
        assert!(
            (corners[1] - corners[0]).cross(corners[2] - corners[0]).y > 0.0,
            "it looks up"
        );
    }
}

#[test]
fn a_document_of_materialx_names_its_images_and_their_color_spaces() {
    let folder = folder("mtlx");
    let run = ["bake", "varied.toml", "--size", SIZE, "-o", "a&b.mtlx"];
    assert_done(&folder.run(&run), "mtlx");
    let parts = ["basecolor", "height", "metallic", "normal", "roughness"];
    let mut names: Vec<_> = parts.iter().map(|part| format!("a&b_{part}.png")).collect();
    names.extend(["a&b.mtlx".to_owned(), "varied.toml".to_owned()]);
    names.sort();
    assert_eq!(folder.names(), names);
    let text = fs::read_to_string(folder.path("a&b.mtlx")).unwrap();
    for part in parts {
        let space = if part == "basecolor" {
            "srgb_texture"
        } else {
            "raw"
        };
        let file = format!("value=\"a&amp;b_{part}.png\" colorspace=\"{space}\"");
        assert!(text.contains(&file), "{file} in {text}");
    }
    let scale = "name=\"scale\" type=\"float\" value=\"0.25\" unittype=\"distance\" unit=\"meter\"";
    assert!(text.contains(scale), "{text}");
    let flat = [
        "bake",
        "varied.toml",
        "--size",
        SIZE,
        "--relief",
        "0",
        "-o",
        "flat.mtlx",
    ];
    assert_done(&folder.run(&flat), "without a relief");
    let text = fs::read_to_string(folder.path("flat.mtlx")).unwrap();
    assert!(!text.contains("displacement"), "{text}");
}

#[test]
fn an_array_has_the_numbers_of_an_exr_also_in_bands() {
    let folder = folder("npy");
    let bake = |more: &[&str]| {
        let words = [
            "bake",
            "varied.toml",
            "--size",
            "1500x700",
            "--maps",
            "albedo",
        ];
        assert_done(&folder.run(&[&words[..], more].concat()), "npy");
    };
    bake(&["-o", "a.npy"]);
    bake(&["-o", "b.npy", "--banded"]);
    bake(&["-o", "a.exr"]);
    let bytes = fs::read(folder.path("a.npy")).unwrap();
    assert!(bytes == fs::read(folder.path("b.npy")).unwrap(), "in bands");
    let exr = read_image(folder.path("a.exr"), &Limits::default()).unwrap();
    let numbers = exr.color().unwrap().into_pixels().into_iter();
    let numbers: Vec<u8> = numbers
        .flat_map(|color| color.to_array())
        .flat_map(f32::to_le_bytes)
        .collect();
    let (header, data) = bytes.split_at(128);
    let shape = "'shape': (700, 1500, 3)";
    assert!(
        String::from_utf8_lossy(header).contains(shape),
        "{header:?}"
    );
    assert!(data == numbers, "the numbers");
}

#[test]
fn raw_heights_have_the_codes_of_a_png_and_a_json_file_with_their_size() {
    let folder = folder("r16");
    for (output, banded) in [
        ("a.r16", None),
        ("b.r16", Some("--banded")),
        ("a.png", None),
    ] {
        let run = [
            "bake",
            "varied.toml",
            "--size",
            "33x17",
            "--maps",
            "height",
            "-o",
            output,
        ];
        assert_done(&folder.run(&[&run[..], banded.as_slice()].concat()), output);
    }
    let bytes = fs::read(folder.path("a.r16")).unwrap();
    assert_eq!(bytes, fs::read(folder.path("b.r16")).unwrap());
    let codes: Vec<u8> = channels(&folder, "a.png")[0]
        .iter()
        .flat_map(|code| code.to_le_bytes())
        .collect();
    assert_eq!(bytes, codes);
    let json = fs::read_to_string(folder.path("a.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    let raw = [&json["width"], &json["height"], &json["bpp"]];
    assert_eq!(raw, [33, 17, 16], "as Unreal reads it");
    let report = &json["report"];
    assert_eq!([&report["meters_per_unit"], &report["relief"]], [1.0, 0.25]);
    assert_eq!(report["extent"], serde_json::json!([2.0, 1.0]));
    // In a folder the JSON file has the name of the heights.
    let run = [
        "bake",
        "varied.toml",
        "--size",
        "9",
        "--maps",
        "height",
        "--format",
        "r16",
        "-o",
        "out/",
    ];
    assert_done(&folder.run(&run), "a folder");
    assert!(
        folder.path("out/varied_height.json").is_file(),
        "beside the heights"
    );
    let run = [
        "bake",
        "varied.toml",
        "--size",
        "9",
        "--maps",
        "albedo",
        "-o",
        "c.r16",
    ];
    assert_refused(&folder.run(&run), 2, "one number", "colors");
}

#[test]
fn every_command_that_draws_writes_arrays_and_raw_heights() {
    let folder = Folder::with_inputs("draws");
    for command in [
        "worley",
        "pups turbulence",
        "wavelet",
        "tile height.png",
        "blend mask.png cracks.png,weight=0.5",
        "synth mask.png --size 16",
    ] {
        for ending in ["npy", "r16"] {
            let output = format!("{}.{ending}", command.replace([' ', '.', ',', '='], "-"));
            let mut words: Vec<_> = command.split(' ').collect();
            if ["worley", "pups", "wavelet"].contains(&words[0]) {
                words.extend(["--size", "16"]);
            }
            words.extend(["-o", &output]);
            assert_done(&folder.run(&words), &output);
            assert!(folder.path(&output).is_file(), "{output}");
            let sidecar = folder.path(&output).with_extension("json");
            assert_eq!(sidecar.is_file(), ending == "r16", "{output}");
            let _ = fs::remove_file(sidecar);
        }
    }
}

#[test]
fn the_help_has_a_line_for_each_image_of_each_preset() {
    let folder = Folder::new("preset-help");
    let help = stdout(&folder.run(&["help", "bake"]));
    for (_, _, files) in EXPECTED {
        for (file, ..) in files {
            let file = file.replace("varied", "NAME");
            assert!(help.contains(&format!("{file}.png")), "{file}");
        }
    }
}

/// A recipe whose material has all optional maps.
const GLOWING: &str = r##"
dapple = 1
[nodes.x.coordinate]
[material]
height = "x"
albedo = "#804020"
emission = "#ff8000"
emission_strength = 4
opacity = "x"
opacity_cutoff = 0.25
specular = "x"
clearcoat = 0.5
"##;

#[test]
fn optional_maps_of_a_material_are_in_presets_and_documents() {
    let folder = Folder::new("glowing");
    fs::write(folder.path("glowing.toml"), GLOWING).unwrap();
    let bake = |line: &str| {
        let words: Vec<_> = line.split_whitespace().collect();
        assert_done(&folder.run(&words), line);
    };
    for preset in ["unity", "unreal", "godot", "gltf", "blender", "materialx"] {
        let line = format!("bake glowing.toml --size 8 --preset {preset} -o {preset}/");
        bake(&line);
    }
    let is_there = |name: &str| folder.path(name).exists();
    for name in [
        "unity/glowing_Emission.png",
        "unity/glowing_ClearCoat.png",
        "unreal/T_glowing_Emissive.png",
        "unreal/T_glowing_Opacity.png",
        "godot/glowing_emission.png",
        "gltf/glowing_specular.png",
        "blender/glowing_alpha.png",
        "materialx/glowing_clearcoat.png",
    ] {
        assert!(is_there(name), "{name}");
    }
    // The opacity is the alpha of the base color where a program expects it, and Unreal halves the specular.
    let image = |name: &str| read_image(folder.path(name), &Limits::default()).unwrap();
    let colors = image("unity/glowing_BaseMap.png").color_alpha().unwrap();
    let alphas: Vec<_> = colors.row(0).iter().map(|pixel| pixel.alpha).collect();
    assert!(
        alphas.is_sorted() && alphas[0] < 0.1 && alphas[7] > 0.9,
        "{alphas:?}"
    );
    let halves = image("unreal/T_glowing_Specular.png").gray().unwrap();
    assert!((halves.row(0)[7] - 0.5 * alphas[7]).abs() < 0.01);
    // MaterialX compares the opacity with the cut-off.
    let document = fs::read_to_string(folder.path("materialx/glowing.mtlx")).unwrap();
    for part in [
        r#"<input name="emission" type="float" value="4" />"#,
        r#"<input name="value2" type="float" value="0.25" />"#,
        r#"<input name="opacity" type="color3" nodegraph="maps""#,
        r#"<input name="coat_roughness" type="float" value="0.03" />"#,
    ] {
        assert!(document.contains(part), "{part} in {document}");
    }
    // By default, a bake has the optional maps that the material sets; `all` has no others.
    for (maps, is_all) in [("", false), ("--maps all", true)] {
        let line = format!("bake glowing.toml --size 8 {maps} -o maps{is_all}/");
        bake(&line);
        for map in ["emission", "opacity", "specular", "clearcoat"] {
            assert!(
                is_there(&format!("maps{is_all}/glowing_{map}.png")),
                "{map}"
            );
        }
    }
    let line = "bake rock --size 8 --maps all -o rock/";
    bake(line);
    assert!(is_there("rock/rock_orm.png") && !is_there("rock/rock_opacity.png"));
    let line = "bake rock --size 8 --preset unity -o rock-unity/";
    bake(line);
    assert!(!is_there("rock-unity/rock_Emission.png"));
    // A map that is named is baked with its default.
    let line = "bake rock --size 8 --maps opacity -o opaque.png";
    bake(line);
    assert!(
        image("opaque.png")
            .gray()
            .unwrap()
            .pixels()
            .iter()
            .all(|&alpha| alpha == 1.0)
    );
}
