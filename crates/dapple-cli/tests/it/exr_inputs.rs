//! Tests of OpenEXR images as inputs: layers, windows, vectors, light with alpha 0, and values that are not finite.

use crate::support::{Folder, assert_done, assert_refused, read_gray, stderr, stdout};
use dapple::color::Normal;
use dapple::image::{Depth, ExrPlane, Limits, encode_exr, read_image, replace, write_gray_png};
use dapple::raster::Raster;
use std::fs;
use std::process::Output;

/// The side of the images, in pixels.
const SIDE: u32 = 32;

/// Name of an OpenEXR plane, and the function that returns its value at a pixel.
type PlaneOf<'a> = (&'a str, &'a dyn Fn(u32, u32) -> f32);

/// Writes an OpenEXR file of these planes.
fn write(folder: &Folder, name: &str, planes: &[PlaneOf<'_>]) {
    let plane = |(name, value): &PlaneOf<'_>| {
        ExrPlane::new(*name, Raster::from_fn([SIDE; 2], value).unwrap())
    };
    let planes: Vec<_> = planes.iter().map(plane).collect();
    replace(&folder.path(name), &encode_exr(&planes).unwrap()).unwrap();
}

/// Reads a plane of an OpenEXR file in a folder.
fn read(folder: &Folder, name: &str, plane: &str) -> Raster<f32> {
    match read_image(folder.path(name), &Limits::default()).unwrap() {
        dapple::image::Image::Planes(_, exr) => exr.plane(plane).unwrap().clone(),
        other => panic!("{name} is {}", other.format()),
    }
}

/// Runs a command line, which begins with `dapple`. Outputs are replaced.
fn shell(folder: &Folder, line: &str) -> Output {
    let words = line.split(' ').skip(1).chain(["--force"]);
    let words: Vec<_> = words.collect();
    folder.run(&words)
}

fn run(folder: &Folder, line: &str) {
    assert_done(&shell(folder, line), line);
}

/// Returns a function for pseudorandom values from 0.2 to 0.8, which differ by channel.
fn texture(channel: u32) -> impl Fn(u32, u32) -> f32 {
    move |x, y| {
        let mut state = (x + SIDE * y + SIDE * SIDE * channel).wrapping_mul(2_654_435_761);
        state ^= state >> 15;
        state = state.wrapping_mul(2_246_822_519);
        0.2 + 0.6 * ((state >> 8) as f32 / (1 << 24) as f32)
    }
}

/// Pairs of light and alpha: alpha 0, an alpha too small to divide by, ½, 1, and above 1.
const LIGHT: [[f32; 2]; 6] = [
    [5.0, 0.0],
    [1e5, 1e-38],
    [0.5, 0.5],
    [1.0, 1.0],
    [3.0, 2.0],
    [0.0, 0.0],
];

#[test]
fn light_without_cover_is_neither_lost_nor_divided() {
    let folder = Folder::new("light");
    let part = |at: usize, other: f32| {
        move |x: u32, y: u32| match y {
            8 => LIGHT.get(x as usize).map_or(other, |pixel| pixel[at]),
            _ => other,
        }
    };
    let (light, cover) = (part(0, 0.25), part(1, 1.0));
    let planes: [PlaneOf<'_>; 4] = [("R", &light), ("G", &light), ("B", &light), ("A", &cover)];
    write(&folder, "fire.exr", &planes);
    let hole = Raster::from_fn([SIDE; 2], |x, y| f32::from(x > 20 && y > 20)).unwrap();
    write_gray_png(folder.path("hole.png"), &hole, Depth::Eight).unwrap();
    for line in [
        "dapple blend fire.exr -o o.exr",
        "dapple synth fire.exr --repair hole.png -o o.exr",
    ] {
        run(&folder, line);
        for (plane, at) in [("R", 0), ("G", 0), ("B", 0), ("A", 1)] {
            let found = read(&folder, "o.exr", plane);
            let expected = LIGHT.map(|pixel| pixel[at]);
            assert_eq!(found.row(8)[..LIGHT.len()], expected, "{line}: {plane}");
        }
    }
    // Over black, light without cover is light.
    run(&folder, "dapple blend fire.exr --alpha over:black -o o.exr");
    assert_eq!(read(&folder, "o.exr", "R").row(8)[0], 5.0);
    // In PNG alpha is at most 1.
    run(&folder, "dapple blend fire.exr -o o.png");
    let image = read_image(folder.path("o.png"), &Limits::default()).unwrap();
    let pixels = image.color_alpha().unwrap();
    assert_eq!(pixels.row(8)[4].alpha, 1.0);
}

/// Writes `nan.exr` with one NaN in its green channel, `nan_y.exr` with one NaN in its only channel, and recipes and
/// masks that use these files.
fn write_nan(folder: &Folder) {
    let (r, g, b) = (texture(0), texture(1), texture(2));
    let broken = |x: u32, y: u32| match (x, y) {
        (9, 5) => f32::NAN,
        _ => texture(1)(x, y),
    };
    write(folder, "nan.exr", &[("R", &r), ("G", &broken), ("B", &b)]);
    write(folder, "ok.exr", &[("R", &r), ("G", &g), ("B", &b)]);
    write(folder, "nan_y.exr", &[("Y", &broken)]);
    let square = |x: u32, y: u32| f32::from((7..12).contains(&x) && (3..8).contains(&y));
    let hole = Raster::from_fn([SIDE; 2], square).unwrap();
    write_gray_png(folder.path("hole.png"), &hole, Depth::Eight).unwrap();
    let rest = hole.map(|value| 1.0 - value);
    write_gray_png(folder.path("rest.png"), &rest, Depth::Eight).unwrap();
    for (kind, file) in [("albedo", "nan.exr"), ("height", "nan_y.exr")] {
        let recipe = format!(
            "dapple = 1\nname = \"r\"\n[nodes.a.image]\nfile = \"{file}\"\n[material]\n{kind} = \"a\"\n"
        );
        fs::write(folder.path(&format!("{kind}.toml")), recipe).unwrap();
    }
}

/// Command lines that read an image with a value that is not finite, at a pixel that is used.
const LINES: [&str; 17] = [
    "dapple blend ok.exr nan.exr -o o.exr",
    "dapple blend nan.exr -o o.exr",
    "dapple blend ok.exr ok.exr,weight=nan_y.exr -o o.exr",
    "dapple blend ok.exr --tile nan_y.exr -o o.exr",
    "dapple copies nan.exr ok.exr --size 2x2 -o o.exr",
    "dapple tile nan.exr -o o.exr",
    "dapple tile ok.exr --normal nan.exr -o o/ --format exr",
    "dapple blend-map nan.exr -o o.exr",
    "dapple synth nan.exr --size 32 -o o.exr",
    "dapple synth ok.exr --size 32 --map rough=nan.exr -o o/ --format exr",
    "dapple synth ok.exr --guide nan.exr -o o.exr",
    "dapple synth ok.exr --example ok.exr --which nan.exr -o o.exr",
    "dapple synth ok.exr --scale nan.exr -o o.exr",
    "dapple synth ok.exr --directions nan.exr -o o.exr",
    "dapple points variable --count 50 --density nan.exr -o o.csv",
    "dapple bake albedo.toml --maps albedo --size 32 -o o.exr",
    "dapple bake height.toml --maps height --size 32 -o o.exr",
];

#[test]
fn numbers_that_are_not_finite_are_refused_with_file_channel_and_pixel() {
    let folder = Folder::new("nan");
    write_nan(&folder);
    for line in LINES {
        let output = shell(&folder, line);
        let (file, channel) = match line.contains("nan_y") || line.contains("height.toml") {
            true => ("nan_y.exr", "Y"),
            false => ("nan.exr", "G"),
        };
        let place = format!("{file}: the channel {channel} is NaN in column 9 and row 5");
        assert_refused(&output, 1, &place, line);
    }
}

#[test]
fn numbers_that_are_not_finite_are_replaced_on_request() {
    let folder = Folder::new("nan-replaced");
    write_nan(&folder);
    for (how, expected) in [("zero", 0.0), ("repair", mean_around())] {
        let line = format!("dapple blend nan.exr --nonfinite {how} -o o.exr");
        run(&folder, &line);
        let found = read(&folder, "o.exr", "G").row(5)[9];
        assert!((found - expected).abs() < 1e-6, "{how}: {found}");
    }
}

#[test]
fn numbers_of_images_of_recipes_are_replaced_on_request() {
    let folder = Folder::new("nan-recipes");
    write_nan(&folder);
    for (how, expected) in [("zero", 0.0), ("repair", mean_around())] {
        let line =
            format!("dapple bake albedo.toml --maps albedo --size 32 --nonfinite {how} -o o.exr");
        run(&folder, &line);
        let found = read(&folder, "o.exr", "G").row(5)[9];
        assert!((found - expected).abs() < 1e-6, "{how}: {found}");
    }
    let words = |line: &str| folder.run(&line.split(' ').collect::<Vec<_>>());
    let line = "recipe height.toml --check";
    assert_refused(&words(line), 1, "nan_y.exr: the channel Y is NaN", line);
    let line = "recipe height.toml --check --nonfinite zero";
    assert_done(&words(line), line);
    // Shards of other values belong to another list, whose commands replace the numbers, too.
    let list = |how: &str| {
        let line = format!("shards height.toml --size 32 --shard 16 --maps height{how} -o s");
        let output = words(&format!("{line} --force"));
        assert_done(&output, &line);
        (
            stdout(&output),
            fs::read_to_string(folder.path("s/shards.json")).unwrap(),
        )
    };
    let [(zero, of_zero), (repair, of_repair)] =
        ["zero", "repair"].map(|how| list(&format!(" --nonfinite {how}")));
    assert!(zero.contains(" --nonfinite=zero"), "{zero}");
    assert!(repair.contains(" --nonfinite=repair"), "{repair}");
    assert_ne!(of_zero, of_repair);
    let line = "shards height.toml --size 32 --shard 16 --maps height -o s";
    assert_refused(&words(line), 1, "nan_y.exr: the channel Y is NaN", line);
}

/// Returns the mean of the eight pixels around the NaN.
fn mean_around() -> f32 {
    let around = (4..7).flat_map(|y| (8..11).map(move |x| (x, y)));
    let others = around.filter(|&pixel| pixel != (9, 5));
    others.map(|(x, y)| texture(1)(x, y)).sum::<f32>() / 8.0
}

#[test]
fn pixels_that_are_not_used_may_be_anything() {
    let folder = Folder::new("nan-unused");
    write_nan(&folder);
    for (line, output) in [
        ("dapple synth nan.exr --repair hole.png -o o.exr", "o.exr"),
        (
            "dapple synth nan.exr --mask rest.png --size 32 -o o.exr",
            "o.exr",
        ),
        (
            "dapple synth ok.exr --map rough=nan.exr --repair hole.png -o o/ --format exr",
            "o/ok_rough.exr",
        ),
        (
            "dapple tile nan.exr --region 10,6,16,16 --method periodic -o o.exr",
            "o.exr",
        ),
    ] {
        run(&folder, line);
        for plane in ["R", "G", "B"] {
            let values = read(&folder, output, plane);
            assert!(
                values.pixels().iter().all(|value| value.is_finite()),
                "{line}"
            );
        }
    }
    let line = "dapple synth nan.exr --mask hole.png --size 32 -o o.exr";
    assert_refused(&shell(&folder, line), 1, "nan.exr: the channel G", line);
}

#[test]
fn layers_are_chosen_by_name() {
    let folder = Folder::new("layers");
    let (quarter, one) = (|_: u32, _: u32| 0.25, |_: u32, _: u32| 1.0);
    write(
        &folder,
        "b.exr",
        &[
            ("V.Combined.R", &quarter),
            ("V.Combined.G", &quarter),
            ("V.Combined.B", &quarter),
            ("V.Combined.A", &one),
            ("V.DiffCol.R", &one),
            ("V.DiffCol.G", &one),
            ("V.DiffCol.B", &one),
            ("V.Depth.Z", &texture(3)),
        ],
    );
    for (options, expected) in [("", 0.25), (" --layer V.DiffCol", 1.0)] {
        let line = format!("dapple blend b.exr{options} -o o.exr");
        run(&folder, &line);
        assert_eq!(read(&folder, "o.exr", "R").row(3)[3], expected, "{line}");
    }
    run(&folder, "dapple blend b.exr --layer V.Depth -o o.exr");
    assert_eq!(read_gray(&folder, "o.exr").row(3)[4], texture(3)(4, 3));
    let line = "dapple blend b.exr --layer Diffuse -o o.exr";
    assert_refused(&shell(&folder, line), 1, "b.exr", line);
    assert_refused(
        &shell(&folder, line),
        1,
        "V.Combined, V.Depth, V.DiffCol",
        line,
    );
    for (layer, expected) in [("", 0.25), ("layer = \"V.DiffCol\"\n", 1.0)] {
        let recipe = format!(
            "dapple = 1\nname = \"r\"\n[nodes.a.image]\nfile = \"b.exr\"\n{layer}[material]\nalbedo = \"a\"\n"
        );
        fs::write(folder.path("r.toml"), recipe).unwrap();
        run(
            &folder,
            "dapple bake r.toml --maps albedo --size 32 -o o.exr",
        );
        let found = read(&folder, "o.exr", "R").row(3)[3];
        assert_eq!(found, expected, "{layer:?} in a recipe");
    }
    let recipe = |node: &str| {
        let text = format!(
            "dapple = 1\nname = \"r\"\n[nodes.a.image]\nfile = \"b.exr\"\nlayer = \"V.DiffCol\"\n\
             [nodes.b.image]\nfile = \"{node}\"\n[nodes.c.mix]\nfrom = \"a\"\nto = \"b\"\nby = 0.5\n[material]\nalbedo = \"c\"\n"
        );
        fs::write(folder.path("two.toml"), text).unwrap();
        "dapple bake two.toml --maps albedo --size 32 -o o.exr"
    };
    // Two layers of one file are two images: the mean of 1 and 0.25.
    let line = recipe("b.exr");
    run(&folder, line);
    assert_eq!(read(&folder, "o.exr", "R").row(3)[3], 0.625);
    // A layer that a node names must be there.
    let hole = Raster::filled([SIDE; 2], 0.5).unwrap();
    write_gray_png(folder.path("gray.png"), &hole, Depth::Eight).unwrap();
    let line = recipe("gray.png\"\nlayer = \"V.Depth");
    assert_refused(&shell(&folder, line), 1, "PNG has no layers", line);
}

#[test]
fn a_layer_without_effect_is_named() {
    let folder = Folder::new("no-layers");
    let (r, y) = (texture(0), texture(1));
    write(&folder, "color.exr", &[("R", &r), ("G", &r), ("B", &r)]);
    write(&folder, "deep.exr", &[("Y", &r), ("V.Depth.Z", &y)]);
    let gray = Raster::filled([SIDE; 2], 0.5).unwrap();
    write_gray_png(folder.path("gray.png"), &gray, Depth::Eight).unwrap();
    for (file, is_named) in [("color.exr", true), ("gray.png", true), ("deep.exr", false)] {
        let line = format!("dapple blend {file} --layer V.Depth -o o.exr");
        let output = shell(&folder, &line);
        assert_done(&output, &line);
        let note = format!("note: {file} has no layers, so that --layer V.Depth has no effect");
        assert_eq!(
            stderr(&output).contains(&note),
            is_named,
            "{}",
            stderr(&output)
        );
        let output = shell(&folder, &format!("{line} --quiet"));
        assert!(
            !stderr(&output).contains("no layers"),
            "{}",
            stderr(&output)
        );
    }
}

#[test]
fn normals_are_vectors_or_codes() {
    let folder = Folder::new("vectors");
    let constant = |value: f32| move |_: u32, _: u32| value;
    let vector = [constant(-0.6), constant(0.0), constant(0.8)];
    let code = [constant(0.2), constant(0.5), constant(0.9)];
    write(
        &folder,
        "ok.exr",
        &[("R", &texture(0)), ("G", &texture(1)), ("B", &texture(2))],
    );
    for (names, parts) in [
        (["X", "Y", "Z"], vector),
        (["R", "G", "B"], vector),
        (["R", "G", "B"], code),
    ] {
        let planes: Vec<PlaneOf<'_>> = names
            .iter()
            .zip(&parts)
            .map(|(&name, part)| (name, part as &dyn Fn(u32, u32) -> f32))
            .collect();
        write(&folder, "n.exr", &planes);
        run(
            &folder,
            "dapple tile ok.exr --normal n.exr --method periodic -o t/ --format png16",
        );
        let image = read_image(folder.path("t/n.png"), &Limits::default()).unwrap();
        let Normal { x, y, z } = image.normals().unwrap().pixels()[40];
        // A step of 16 bits is 2 / 65535.
        let error = [x + 0.6, y, z - 0.8].map(f32::abs);
        assert!(
            error.iter().all(|&error| error < 1e-4),
            "{names:?}: {x} {y} {z}"
        );
    }
    write(
        &folder,
        "n.exr",
        &[("X", &vector[0]), ("Y", &vector[1]), ("Z", &vector[2])],
    );
    let line = "dapple blend n.exr -o o.exr";
    assert_refused(&shell(&folder, line), 2, "vectors", line);
}
