//! Tests of meshes that are textured with all maps of a material.

use crate::support::{Folder, assert_done, assert_refused, read_gray, stdout};
use dapple::color::{LinearRgb, LinearRgba};
use dapple::image::{
    Depth, Image, Limits, PngPixels, decode_image, write_color_alpha_png, write_color_png,
    write_gray_png,
};
use dapple::mesh::{AlphaMode, EncodedImage, Mesh, Model};
use dapple::mesh_io::read_model;
use dapple::raster::Raster;
use std::fs;

/// Creates a folder with the maps `ao.png`, `rough.png` and `metal.png` of `checker.png`. All of them differ.
fn folder(name: &str) -> Folder {
    let folder = Folder::with_inputs(name);
    let write = |name: &str, code: fn(u32, u32) -> u32| {
        let plane = Raster::from_fn([32; 2], |x, y| code(x, y) as f32 / 255.0).unwrap();
        write_gray_png(folder.path(name), &plane, Depth::Eight).unwrap();
    };
    write("ao.png", |x, y| 55 + 3 * x + y);
    write("rough.png", |x, y| 20 + (x * y) % 200);
    write("metal.png", |x, y| 255 * ((x / 8 + y / 8) % 2));
    folder
}

/// Synthesizes a texture of the checkerboard on the folder's model. `more` are further arguments.
fn cover(folder: &Folder, more: &str) {
    let line = format!(
        "synth checker.png --mesh model.obj --edges wrap --sites 400 --texture-size 128 {more}"
    );
    let words: Vec<_> = line.split_whitespace().collect();
    assert_done(&folder.run(&words), &line);
}

/// Returns the codes of an image with three channels of 16 bits.
fn codes(image: &EncodedImage) -> Vec<[u16; 3]> {
    match decode_image(image.bytes(), &Limits::default()).unwrap() {
        Image::Codes(_, png) => match png.pixels {
            PngPixels::Rgb16(raster) => raster.into_pixels(),
            other => panic!("{:?} pixels without 16 bits", other.size()),
        },
        other => panic!("{:?} is no PNG", other.channels()),
    }
}

/// Returns the codes of a model's packed image of occlusion, roughness and metalness.
fn packed(model: &Model) -> Vec<[u16; 3]> {
    let image = model.material.metallic_roughness.as_ref().unwrap();
    let occlusion = model.material.occlusion.as_ref();
    assert!(occlusion == Some(image), "one image for all three");
    codes(image)
}

/// Returns the codes of a 16-bit gray image.
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
    let info = stdout(&folder.run(&["info", "whole.glb"]));
    assert!(
        info.contains("a texture of roughness, a texture of occlusion"),
        "{info}"
    );
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

/// Creates a folder with `plain.png`, a uniformly gray example, and `bumps.png`, its height map: a checkerboard of two
/// heights.
fn bumps(name: &str) -> Folder {
    let folder = Folder::with_inputs(name);
    let write = |name: &str, value: fn(u32, u32) -> f32| {
        let plane = Raster::from_fn([48; 2], value).unwrap();
        write_gray_png(folder.path(name), &plane, Depth::Eight).unwrap();
    };
    write("plain.png", |_, _| 0.5);
    write("bumps.png", |x, y| {
        0.2 + 0.6 * f32::from((x / 8 + y / 8) % 2 == 0)
    });
    folder
}

/// Returns the fraction of horizontally adjacent pixel pairs whose values differ by more than 0.1.
fn steps(image: &Raster<f32>) -> f64 {
    let [width, height] = image.size();
    let rows = (0..height).map(|y| image.row(y));
    let pairs = rows.flat_map(|row| row.windows(2));
    let n_steps = pairs.filter(|pair| (pair[0] - pair[1]).abs() > 0.1).count();
    n_steps as f64 / f64::from((width - 1) * height)
}

#[test]
fn a_map_with_a_weight_is_matched_and_one_without_follows() {
    let folder = bumps("weights");
    let grow = |more: &str| {
        let line = format!(
            "synth plain.png --map height=bumps.png --size 64 --coherence 0 --seed 3 --force -o out.png {more}"
        );
        assert_done(
            &folder.run(&line.split_whitespace().collect::<Vec<_>>()),
            &line,
        );
        fs::read(folder.path("out_height.png")).unwrap()
    };
    let follows = grow("");
    assert!(
        follows == grow("--weight height=0"),
        "a weight of 0 is none"
    );
    let of_following = steps(&read_gray(&folder, "out_height.png"));
    assert!(follows != grow("--weight height=1"));
    let of_matched = steps(&read_gray(&folder, "out_height.png"));
    // Where nothing is to be seen all pixels match, and one of them is taken everywhere.
    assert_eq!(of_following, 0.0);
    let ratio = of_matched / steps(&read_gray(&folder, "bumps.png"));
    assert!(
        (0.8..1.2).contains(&ratio),
        "{ratio} as many steps as in the example"
    );
}

#[test]
fn a_map_with_a_weight_is_matched_on_a_mesh_and_beside_a_larger_example() {
    let folder = bumps("weights-mesh");
    let bumps = read_gray(&folder, "bumps.png");
    let twice = Raster::from_fn([96; 2], |x, y| bumps.row(y / 2)[(x / 2) as usize]).unwrap();
    write_gray_png(folder.path("large.png"), &twice, Depth::Eight).unwrap();
    let cover = |more: &str| {
        let line = format!(
            "synth plain.png --mesh model.obj --sites 1000 --texture-size 128 --force -o out.glb {more}"
        );
        assert_done(
            &folder.run(&line.split_whitespace().collect::<Vec<_>>()),
            &line,
        );
        steps(&read_gray(&folder, "out_height.png"))
    };
    for map in [
        "--map height=bumps.png",
        "--detail large.png --map height=large.png",
    ] {
        let [follows, matched] =
            ["", "--weight height=1"].map(|weight| cover(&format!("{map} {weight}")));
        assert!(matched < 0.7 * follows, "{map}: {matched}, {follows}");
        // Where nothing is to be seen all pixels match: by colors one of them is taken everywhere.
        let colors = format!("{map} --matching colors");
        let [follows, matched] =
            ["", "--weight height=1"].map(|weight| cover(&format!("{colors} {weight}")));
        assert!(
            matched > 0.02 && follows == 0.0,
            "{colors}: {matched}, {follows}"
        );
    }
}

#[test]
fn weights_of_no_map_are_refused() {
    let folder = bumps("weights-refused");
    for (more, message) in [
        ("--weight height=1", "--map"),
        (
            "--map height=bumps.png --weight hight=1",
            "there is no --map hight",
        ),
        (
            "--map height=bumps.png --weight height=1 --weight height=2",
            "given twice",
        ),
        (
            "--map height=bumps.png --weight height=-1",
            "is not a weight",
        ),
        (
            "--map height=bumps.png --weight height=nan",
            "is not a weight",
        ),
        (
            "--map height=bumps.png --weight height=1 --replay places.exr",
            "cannot be used with",
        ),
        (
            "--map height=bumps.png --weight height=1e30",
            "weighted value",
        ),
    ] {
        let line = format!("synth plain.png {more} -o out.png");
        assert_refused(
            &folder.run(&line.split_whitespace().collect::<Vec<_>>()),
            2,
            message,
            &line,
        );
    }
}

/// Creates a folder with `leaf.png`, whose alpha equals its gray value, and `holes.png`, which is green with
/// transparent red holes.
fn leaves(name: &str) -> Folder {
    let folder = Folder::with_inputs(name);
    let write = |name: &str, pixel: fn(u32, u32) -> LinearRgba| {
        let pixels = Raster::from_fn([48; 2], pixel).unwrap();
        write_color_alpha_png(folder.path(name), &pixels, Depth::Sixteen).unwrap();
    };
    write("leaf.png", |x, y| {
        let value = (7 * x + 3 * y * y + x * y) as f32 % 40.0 / 100.0 + 0.3;
        LinearRgba {
            color: LinearRgb::gray(value),
            alpha: value,
        }
    });
    write("holes.png", |x, y| match (x / 8 + y / 8) % 3 {
        0 => LinearRgba {
            color: LinearRgb::new(1.0, 0.0, 0.0),
            alpha: 0.0,
        },
        _ => LinearRgba::opaque(LinearRgb::new(0.0, 0.5, 0.1)),
    });
    folder
}

#[test]
fn alpha_of_the_example_is_that_of_the_material() {
    let folder = leaves("alpha-model");
    for (name, mode) in [
        ("leaf.png", AlphaMode::Blend),
        ("holes.png", AlphaMode::Mask),
    ] {
        let line = format!(
            "synth {name} --mesh model.obj --sites 2000 --texture-size 256 --force -o out.glb"
        );
        assert_done(&folder.run(&line.split(' ').collect::<Vec<_>>()), &line);
        let material = read_model(folder.path("out.glb")).unwrap().material;
        assert_eq!(
            (material.alpha, material.double_sided),
            (mode, true),
            "{name}"
        );
        let texture = decode_image(material.base_color.unwrap().bytes(), &Limits::default());
        let pixels = texture.unwrap().color_alpha().unwrap();
        let shown = pixels.pixels().iter().filter(|pixel| pixel.alpha > 0.05);
        match mode {
            AlphaMode::Mask => {
                let n_clear = pixels
                    .pixels()
                    .iter()
                    .filter(|pixel| pixel.alpha == 0.0)
                    .count();
                assert!(
                    (8_000..40_000).contains(&n_clear),
                    "{n_clear} of 65536 texels"
                );
                // Alpha has 16 bits.
                assert!(
                    shown.clone().all(|pixel| pixel.color.r < 0.001),
                    "red shows nowhere"
                );
            }
            // Where alpha is even, it is as gray as at a pixel.
            _ => assert!(shown.clone().any(|pixel| pixel.alpha < 0.5)),
        }
        assert!(shown.count() > 20_000, "{name}");
    }
    let info = stdout(&folder.run(&["info", "out.glb"]));
    assert!(info.contains("alpha that cuts"), "{info}");
    // The texture alone is that of the model, and sites have alpha of their own.
    let line = "synth holes.png --mesh model.obj --sites 2000 --texture-size 256 -o out.png";
    assert_done(&folder.run(&line.split(' ').collect::<Vec<_>>()), line);
    let model = read_model(folder.path("out.glb")).unwrap();
    let texture = model.material.base_color.unwrap();
    assert!(texture.bytes() == fs::read(folder.path("out.png")).unwrap());
    let line = "synth holes.png --mesh model.obj --sites 2000 -o out.ply";
    assert_done(&folder.run(&line.split(' ').collect::<Vec<_>>()), line);
    let colors = read_model(folder.path("out.ply")).unwrap().colors.unwrap();
    for color in &colors {
        assert_eq!(color.alpha == 0.0, color.color.r > 0.5, "{color:?}");
    }
    assert!(colors.iter().any(|color| color.alpha == 0.0));
}

#[test]
fn an_opaque_example_makes_an_opaque_material() {
    let folder = leaves("opaque-model");
    for options in [
        "checker.png",
        "holes.png --alpha drop",
        "holes.png --alpha over:white",
    ] {
        let line = format!(
            "synth {options} --mesh model.obj --sites 500 --texture-size 128 --force -o out.glb"
        );
        assert_done(&folder.run(&line.split(' ').collect::<Vec<_>>()), &line);
        let material = read_model(folder.path("out.glb")).unwrap().material;
        assert_eq!(
            (material.alpha, material.double_sided),
            (AlphaMode::Opaque, false),
            "{options}"
        );
    }
}

#[test]
fn normals_of_an_obj_are_one_file() {
    let folder = folder("obj");
    cover(
        &folder,
        "--map normal=checker.png --map roughness=rough.png -o out.obj",
    );
    let material = read_model(folder.path("out.obj")).unwrap().material;
    let normal = fs::read(folder.path("out_normal.png")).unwrap();
    assert!(material.normal.unwrap().bytes() == normal);
    let names = folder.names();
    let of_output = names.iter().filter(|name| name.starts_with("out"));
    let expected = [
        "out.mtl",
        "out.obj",
        "out_base_color.png",
        "out_normal.png",
        "out_roughness.png",
    ];
    assert_eq!(of_output.collect::<Vec<_>>(), expected);
}

/// Returns the displacement of each vertex from mesh `from` to mesh `to`: its component along the normal, and its
/// length perpendicular to the normal.
fn moved(from: &Mesh, to: &Mesh) -> Vec<[f64; 2]> {
    let normals = from.vertex_normals();
    let vertices = from.positions().iter().zip(to.positions()).zip(normals);
    let parts = vertices.map(|((from, to), normal)| {
        let along = (*to - *from).dot(normal);
        [along, (*to - *from - along * normal).length()]
    });
    parts.collect()
}

#[test]
fn heights_move_the_mesh_of_a_whole_material() {
    let folder = folder("displaced");
    let maps = "--map height=rough.png --map metallic=metal.png --map ao=ao.png";
    cover(&folder, &format!("{maps} -o flat.glb"));
    cover(&folder, &format!("{maps} --displace 0.1 -o high.glb"));
    cover(
        &folder,
        &format!("{maps} --displace -0.1 --map normal=checker.png -o low.glb"),
    );
    let [flat, high, low] =
        ["flat.glb", "high.glb", "low.glb"].map(|name| read_model(folder.path(name)).unwrap());
    for other in [&high, &low] {
        assert!(flat.uvs == other.uvs, "the layout is the same");
        assert!(
            flat.mesh.faces() == other.mesh.faces(),
            "no crease has come to it"
        );
        let [own, moved] = [&flat, other].map(|model| &model.material);
        assert!(own.base_color == moved.base_color && own.occlusion == moved.occlusion);
        assert!(moved.metallic_roughness == moved.occlusion && moved.occlusion.is_some());
    }
    // Vertices of the input, as repair has left them; the file splits them where pieces of the texture meet.
    let input = read_model(folder.path("model.obj"))
        .unwrap()
        .mesh
        .repair()
        .0;
    let n = input.positions().len();
    let first = |model: &Model| Mesh::new(model.mesh.positions()[..n].to_vec(), &[]).unwrap();
    let mut range = [f64::INFINITY, f64::NEG_INFINITY];
    for (out, inward) in moved(&input, &first(&high))
        .into_iter()
        .zip(moved(&input, &first(&low)))
    {
        // Heights of 20 to 219 in 255, times the length. Positions have single precision.
        assert!(
            (0.1 * 20.0 / 255.0 - 1e-4..0.1 * 219.0 / 255.0 + 1e-4).contains(&out[0]),
            "{out:?}"
        );
        assert!(
            (out[0] + inward[0]).abs() < 1e-4 && out[1] < 1e-4,
            "{out:?} {inward:?}"
        );
        range = [range[0].min(out[0]), range[1].max(out[0])];
    }
    assert!(range[1] - range[0] > 0.02, "{range:?}");
    // A map of normals is in the frames of the mesh as it was.
    assert!(low.normals_of_corners() == flat.normals_of_corners());
    assert!(high.normals_of_corners() != flat.normals_of_corners());
}

#[test]
fn heights_move_all_sites_and_are_refused_where_nothing_moves() {
    let folder = folder("displaced-sites");
    let run = |more: &str| {
        let line = format!("synth checker.png --mesh model.obj --edges wrap --sites 600 {more}");
        folder.run(&line.split_whitespace().collect::<Vec<_>>())
    };
    assert_done(&run("-o flat.ply"), "flat");
    let line = "--map height=rough.png --displace 0.1 -o high.ply";
    assert_done(&run(line), line);
    let line = "--map height=rough.png --weight height=1 -o weighted.ply";
    assert_done(&run(line), line);
    let [flat, high] = ["flat.ply", "high.ply"].map(|name| read_model(folder.path(name)).unwrap());
    assert_eq!(flat.colors, high.colors);
    let ways = flat.mesh.positions().iter().zip(high.mesh.positions());
    let ways = ways.map(|(from, to)| from.distance(*to));
    assert!(ways.clone().all(|way| (0.0078..0.0860).contains(&way)));
    assert!(ways.clone().fold(0.0, f64::max) > ways.fold(1.0, f64::min) + 0.03);
    for (more, message) in [
        ("--displace 0.1 -o out.glb", "--displace needs heights"),
        (
            "--map height=rough.png --displace nan -o out.glb",
            "is not a length",
        ),
        (
            "--map height=rough.png --displace 1 --texture-size 128 -o out.png",
            "no effect on an image",
        ),
        (
            "--map height=rough.png --map ao=ao.png --displace 1 -o out.ply",
            "no further maps",
        ),
    ] {
        assert_refused(&run(more), 2, message, more);
    }
    let line = "synth checker.png --map height=rough.png --displace 1 -o out.png";
    let run = folder.run(&line.split_whitespace().collect::<Vec<_>>());
    assert_refused(&run, 2, "--displace has no effect without a mesh", line);
}
