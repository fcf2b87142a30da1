//! Meshes covered with all maps of a material.

use crate::support::{Folder, assert_done, assert_refused, read_gray};
use dapple::color::LinearRgb;
use dapple::image::{
    Depth, Image, Limits, PngPixels, decode_image, write_color_png, write_gray_png,
};
use dapple::mesh::{EncodedImage, Model};
use dapple::mesh_io::read_model;
use dapple::raster::Raster;
use std::fs;

/// A folder with the maps `ao.png`, `rough.png` and `metal.png` of `checker.png`, all of them different.
fn folder(name: &str) -> Folder {
    let folder = Folder::with_inputs(name);
    let maps: [(&str, fn(u32, u32) -> u32); 3] = [
        ("ao.png", |x, y| 55 + 3 * x + y),
        ("rough.png", |x, y| 20 + (x * y) % 200),
        ("metal.png", |x, y| {
            255 * u32::from((x / 8 + y / 8) % 2 == 0)
        }),
    ];
    for (name, code) in maps {
        let plane = Raster::from_fn([32; 2], |x, y| code(x, y) as f32 / 255.0).unwrap();
        write_gray_png(folder.path(name), &plane, Depth::Eight).unwrap();
    }
    folder
}

/// Covers the model of a folder with its checker, with more options.
fn cover(folder: &Folder, more: &str) {
    let line = format!(
        "synth checker.png --mesh model.obj --edges wrap --sites 600 --texture-size 256 {more}"
    );
    let words: Vec<_> = line.split_whitespace().collect();
    assert_done(&folder.run(&words), &line);
}

/// The codes of an image with 16 bits in three channels.
fn codes(image: &EncodedImage) -> Vec<[u16; 3]> {
    match decode_image(image.bytes(), &Limits::default()).unwrap() {
        Image::Png(png) => match png.pixels {
            PngPixels::Rgb16(raster) => raster.into_pixels(),
            other => panic!("{:?} pixels without 16 bits", other.size()),
        },
        other => panic!("{:?} is no PNG", other.channels()),
    }
}

/// The image with occlusion, roughness and metalness of a model, which has one for all three.
fn packed(model: &Model) -> Vec<[u16; 3]> {
    let image = model.material.metallic_roughness.as_ref().unwrap();
    assert_eq!(model.material.occlusion.as_ref(), Some(image));
    codes(image)
}

/// The codes of a gray image with 16 bits.
fn gray_codes(folder: &Folder, name: &str) -> Vec<u16> {
    let values = read_gray(folder, name).into_pixels();
    values
        .iter()
        .map(|value| (value * 65535.0).round() as u16)
        .collect()
}

#[test]
fn maps_of_the_example_are_the_channels_of_the_material() {
    let folder = folder("whole");
    let maps = "--map roughness=rough.png --map metallic=metal.png --map occlusion=ao.png \
        --map normal=checker.png --map height=rough.png";
    cover(&folder, &format!("{maps} --format png16 -o whole.glb"));
    let model = read_model(folder.path("whole.glb")).unwrap();
    let packed = packed(&model);
    let channels = ["occlusion", "roughness", "metallic"];
    for (channel, name) in channels.into_iter().enumerate() {
        let own = gray_codes(&folder, &format!("whole_{name}.png"));
        let of_model: Vec<_> = packed.iter().map(|codes| codes[channel]).collect();
        assert!(of_model == own, "{name}");
        assert!(own.iter().max() > own.iter().min(), "{name} is not flat");
    }
    let normal = model.material.normal.unwrap();
    assert!(normal.bytes() == fs::read(folder.path("whole_normal.png")).unwrap());
    // The texture is that without maps, and each map is that which is baked alone.
    cover(
        &folder,
        "--map roughness=rough.png --format png16 -o alone.glb",
    );
    let alone = read_model(folder.path("alone.glb")).unwrap();
    assert!(alone.material.base_color == model.material.base_color);
    let bytes = |name: &str| fs::read(folder.path(name)).unwrap();
    assert!(bytes("alone_roughness.png") == bytes("whole_roughness.png"));
}

#[test]
fn a_map_that_is_not_given_is_open_rough_and_no_metal() {
    let folder = folder("defaults");
    for (map, channel) in [
        ("Occlusion=ao.png", 0),
        ("roughness=rough.png", 1),
        ("metallic=metal.png", 2),
    ] {
        let name = format!("{channel}.glb");
        cover(&folder, &format!("--map {map} --format png16 -o {name}"));
        let packed = packed(&read_model(folder.path(&name)).unwrap());
        for (other, default) in [65535, 65535, 0].into_iter().enumerate() {
            let is_default = packed.iter().all(|codes| codes[other] == default);
            assert_eq!(is_default, other != channel, "channel {other} with {map}");
        }
    }
    cover(&folder, "--map height=ao.png -o none.glb");
    let material = read_model(folder.path("none.glb")).unwrap().material;
    assert_eq!(
        (material.occlusion, material.metallic_roughness),
        (None, None)
    );
}

#[test]
fn numbers_in_three_equal_channels_are_those_of_a_gray_image() {
    let folder = folder("equal");
    let gray = read_gray(&folder, "rough.png");
    let color = gray.map(|value| LinearRgb::from_srgb([(value * 255.0).round() as u8; 3]));
    write_color_png(folder.path("color.png"), &color, Depth::Eight).unwrap();
    let read = |name: &str| {
        cover(
            &folder,
            &format!("--map roughness={name} --format png16 --force -o out.glb"),
        );
        packed(&read_model(folder.path("out.glb")).unwrap())
    };
    for (gray, color) in read("rough.png").into_iter().zip(read("color.png")) {
        // Codes are mixed in 16 bits, and read back from linear light.
        assert!(gray[1].abs_diff(color[1]) <= 2, "{gray:?} and {color:?}");
    }
}

#[test]
fn a_map_has_one_name() {
    let folder = folder("names");
    let line = "synth checker.png --map ao=ao.png --map occlusion=rough.png --size 16 -o out.png";
    let run = folder.run(&line.split_whitespace().collect::<Vec<_>>());
    assert_refused(&run, 2, "--map ao and --map occlusion are one map", line);
}
