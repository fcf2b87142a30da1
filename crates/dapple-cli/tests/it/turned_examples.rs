//! Tests of `dapple synth`: rotated examples, masks and repairs with several examples, and diagnostic images.

use crate::support::{Folder, assert_done, read_gray, stderr};
use dapple::color::{LinearRgb, LinearRgba, Normal};
use dapple::image::{
    Depth, Limits, read_image, write_color_alpha_png, write_gray_png, write_normal_png,
};
use dapple::raster::Raster;
use std::fs;

/// Writes a gray image.
fn write(folder: &Folder, name: &str, size: [u32; 2], value: impl FnMut(u32, u32) -> f32) {
    let plane = Raster::from_fn(size, value).unwrap();
    write_gray_png(folder.path(name), &plane, Depth::Eight).unwrap();
}

/// Runs the command with arguments separated by spaces. It must succeed.
fn run(folder: &Folder, line: &str) {
    assert_done(
        &folder.run(&line.split_whitespace().collect::<Vec<_>>()),
        line,
    );
}

#[test]
fn turned_examples_have_turned_maps() {
    let folder = Folder::with_inputs("turned");
    // A ramp to the right, whose normal leans to the left everywhere; turned it leans to all four sides.
    write(&folder, "ramp.png", [48; 2], |x, _| x as f32 / 47.0);
    let left = Raster::filled(
        [48; 2],
        Normal {
            x: -0.6,
            y: 0.0,
            z: 0.8,
        },
    )
    .unwrap();
    write_normal_png(folder.path("ramp_n.png"), &left, Depth::Eight).unwrap();
    run(
        &folder,
        "synth ramp.png --turned quarters --map normal=ramp_n.png --size 128 -o out.png",
    );
    let out = read_gray(&folder, "out.png");
    let image = read_image(folder.path("out_normal.png"), &Limits::default()).unwrap();
    let codes = |color: &LinearRgb| Normal::from_codes(color.to_srgb::<u8>());
    let normals = image.color().unwrap().map(codes);
    let mut counts = [0; 4];
    let mut n_uphill = 0;
    for [x, y] in (1..127).flat_map(|y| (1..127).map(move |x| [x, y])) {
        let Normal {
            x: east, y: north, ..
        } = normals.row(y)[x as usize];
        let side = match [east.abs() > 0.5, east > 0.0, north > 0.0] {
            [true, false, _] => 0,
            [true, true, _] => 1,
            [false, _, false] => 2,
            [false, _, true] => 3,
        };
        counts[side] += 1;
        // Normals lean away from where the heights of this pixel's neighbors grow.
        let at = |x: u32, y: u32| out.row(y)[x as usize];
        let slope = [at(x + 1, y) - at(x - 1, y), at(x, y - 1) - at(x, y + 1)];
        n_uphill += usize::from(east * slope[0] + north * slope[1] > 0.0);
    }
    assert!(
        counts.iter().all(|&count| count > 126 * 126 / 20),
        "{counts:?}"
    );
    assert!(n_uphill < 126 * 126 / 5, "{n_uphill} normals lean uphill");
}

#[test]
fn a_hole_is_filled_from_another_example_where_a_mask_says_so() {
    let folder = Folder::with_inputs("fill");
    let grain = |x: u32, y: u32| f32::from((x * 7 + y * 13) % 11 < 5) * 0.2;
    write(&folder, "a.png", [64; 2], grain);
    write(&folder, "b.png", [48, 40], |x, y| 0.6 + grain(x, y));
    write(&folder, "none.png", [64; 2], |_, _| 0.0);
    write(&folder, "all.png", [48, 40], |_, _| 1.0);
    run(
        &folder,
        "synth a.png --example b.png --repair scratch.png --mask none.png --mask all.png \
         --origins origins.png -o out.png",
    );
    let [out, origins] = ["out.png", "origins.png"].map(|name| read_gray(&folder, name));
    let [before, scratch] = ["a.png", "scratch.png"].map(|name| read_gray(&folder, name));
    assert_eq!(out.size(), [64; 2], "that of the first example");
    let pixels = out.pixels().iter().zip(before.pixels());
    for ((out, before), (made, origin)) in pixels.zip(scratch.pixels().iter().zip(origins.pixels()))
    {
        assert_eq!(*origin, *made, "from the second example in the hole alone");
        assert!(*made > 0.5 || out == before, "{out} {before}");
        assert!(*made < 0.5 || *out > 0.5, "{out}");
    }
    let line = "synth a.png --example b.png --mask none.png -o no.png";
    let output = folder.run(&line.split(' ').collect::<Vec<_>>());
    assert_eq!(output.status.code(), Some(2), "{line}");
    let text = stderr(&output);
    assert!(text.contains("masks: 1; examples: 2"), "{text}");
}

#[test]
fn a_channel_is_a_mask_of_what_is_made_again() {
    let folder = Folder::with_inputs("channel");
    let is_hole = |x: u32, y: u32| (28..36).contains(&x) && (20..44).contains(&y);
    let picture = |x: u32, y: u32| LinearRgba {
        color: match (x / 4 + y / 4) % 2 {
            0 => LinearRgb::new(0.9, 0.8, 0.1),
            _ => LinearRgb::new(0.6, 0.3, 0.9),
        },
        alpha: f32::from(!is_hole(x, y)),
    };
    let picture = Raster::from_fn([64; 2], picture).unwrap();
    write_color_alpha_png(folder.path("hole.png"), &picture, Depth::Eight).unwrap();
    run(
        &folder,
        "synth hole.png --repair-channel a --format png8 -o by_channel.png",
    );
    run(
        &folder,
        "synth hole.png --alpha drop --repair scratch.png --format png8 -o by_mask.png",
    );
    let bytes = |name: &str| fs::read(folder.path(name)).unwrap();
    assert!(bytes("by_channel.png") == bytes("by_mask.png"));
    for (line, part) in [
        (
            "synth photo.png --repair-channel a -o no.png",
            "has no channel a",
        ),
        (
            "synth height.png --repair-channel r -o no.png",
            "has no channel r",
        ),
    ] {
        let output = folder.run(&line.split(' ').collect::<Vec<_>>());
        assert_eq!(output.status.code(), Some(2), "{line}");
        let text = stderr(&output);
        assert!(text.contains(part), "{line}: {text}");
    }
}

#[test]
fn pieces_meet_where_the_example_does_not_go_on() {
    let folder = Folder::with_inputs("pieces");
    run(
        &folder,
        "synth photo.png --size 48 --pieces pieces.png --differences differences.exr --sources sources.exr -o out.png",
    );
    let read = |name: &str| {
        let image = read_image(folder.path(name), &Limits::default()).unwrap();
        image.color().unwrap()
    };
    let [pieces, sources] = ["pieces.png", "sources.exr"].map(read);
    let (mut n_same, mut n_other) = (0, 0);
    for [x, y] in (0..48).flat_map(|y| (1..48).map(move |x| [x, y])) {
        let pair = |raster: &Raster<LinearRgb>| [x - 1, x].map(|x| raster.row(y)[x as usize]);
        let ([a, b], [from, to]) = (pair(&pieces), pair(&sources));
        if from.r + 1.0 == to.r && from.g == to.g {
            assert_eq!(a, b, "{x} {y}");
            n_same += 1;
        } else {
            n_other += usize::from(a != b);
        }
    }
    assert!(n_same > 300 && n_other > 0, "{n_same} and {n_other}");
    let differences = read_image(folder.path("differences.exr"), &Limits::default()).unwrap();
    let differences = differences.color().unwrap();
    let is_in_range = |color: &LinearRgb| (0.0..=4.0).contains(&color.r);
    assert!(
        differences.pixels().iter().all(is_in_range),
        "from 0 to 4 times 1"
    );
}
