//! Tests of `dapple synth`: windows, methods, repairs, sources, examples and guides.

use crate::support::{Folder, assert_done, read_gray, stderr};
use core::ops::Range;
use dapple::color::LinearRgb;
use dapple::image::{Depth, Limits, read_image, write_color_png, write_gray_png};
use dapple::raster::Raster;
use std::fs;

#[test]
fn windows_of_one_texture_fit_together() {
    let folder = Folder::with_inputs("windows");
    let gray = |more: &str| {
        let line = format!("synth height.png --map more=height.png --force -o out.png {more}");
        assert_done(&folder.run(&line.split(' ').collect::<Vec<_>>()), &line);
        let [out, map] = ["out.png", "out_more.png"].map(|name| read_gray(&folder, name));
        assert!(out == map, "maps follow");
        out
    };
    let whole = gray("--size 96x64 --at -40,1000");
    let part = gray("--size 16x8 --at -20,1030");
    let crop = |whole: &Raster<f32>, [left, top]: [u32; 2]| {
        let value = |x: u32, y: u32| whole.row(top + y)[(left + x) as usize];
        Raster::from_fn([16, 8], value).unwrap()
    };
    assert!(part == crop(&whole, [20, 30]));
    // A texture that wraps goes on with its beginning.
    let tile = gray("--size 64 --wrap x");
    let beside = gray("--size 64 --wrap x --at 64,0");
    assert!(tile == beside, "the period is the width");
    assert!(
        tile != gray("--size 64 --wrap x --at 0,64"),
        "rows do not repeat"
    );
}

#[test]
fn the_method_is_the_first_that_can() {
    let folder = Folder::with_inputs("methods");
    let run = |line: &str| folder.run(&line.split_whitespace().collect::<Vec<_>>());
    let bytes = |more: &str| {
        let line = format!("synth checker.png --size 24 --force -o out.png {more}");
        assert_done(&run(&line), &line);
        fs::read(folder.path("out.png")).unwrap()
    };
    let [endless, sweep] = ["endless", "sweep"].map(|name| bytes(&format!("--method {name}")));
    assert!(bytes("") == endless, "endless by default");
    assert!(endless != sweep, "the methods differ");
    assert!(bytes("--wrap both --levels 3") == bytes("--wrap both --levels 3 --method endless"));
    // Columns that repeat after 24 have no fourth level.
    assert!(bytes("--wrap both --levels 4") == bytes("--wrap both --levels 4 --method sweep"));
    assert!(bytes("--evenness 1") == sweep, "an option of the sweep");
    for (more, part) in [
        (
            "--method endless --coherence 1",
            "--coherence has no effect",
        ),
        ("--at 3,4 --paper", "--paper has no effect"),
        ("--at 3,4 --guide photo.png", "--guide has no effect"),
        ("--at 3,4 --method sweep", "--at has no effect"),
        ("--method sweep --repair scratch.png", "cannot be used with"),
        ("--at 3,4 --mesh model.obj", "--at has no effect on a mesh"),
        (
            "--method endless --size 24 --wrap x --levels 4",
            "with 4 levels it must be a multiple of 16",
        ),
        ("--at 4503599627370497,0", "from -2^52 to 2^52"),
    ] {
        let line = format!("synth checker.png {more} -o none.png");
        let output = run(&line);
        assert_eq!(output.status.code(), Some(2), "{line}");
        let text = stderr(&output);
        assert!(text.contains(part), "{line}: {text}");
    }
}

#[test]
fn textures_in_the_plane_follow_images_of_directions_and_scales() {
    let folder = Folder::with_inputs("along");
    let run = |line: &str| folder.run(&line.split_whitespace().collect::<Vec<_>>());
    let gray = |more: &str| {
        let line =
            format!("synth height.png --map more=height.png --levels 2 --force -o out.png {more}");
        assert_done(&run(&line), &line);
        let [out, map] = ["out.png", "out_more.png"].map(|name| read_gray(&folder, name));
        assert!(out == map, "maps follow");
        out
    };
    let size = read_gray(&folder, "mask.png").size();
    let scaled = gray("--scale mask.png");
    assert_eq!(scaled.size(), size);
    assert!(
        scaled == gray("--scale mask.png --scales 1,2"),
        "the default"
    );
    assert!(scaled != gray("--scale mask.png --scales 1,1"));
    let turned = gray("--directions mask.png --scale mask.png");
    let straight = gray("--directions mask.png");
    assert!(turned != scaled && turned != straight);
    assert!(straight != gray("--directions mask.png --scales 0.5,2"));
    assert!(
        straight == gray("--directions mask.png --scales 1,1"),
        "the default"
    );
    for (more, part) in [
        ("--scale mask.png --size 24", "--size has no effect with"),
        (
            "--directions mask.png --guide photo.png",
            "--guide has no effect",
        ),
        (
            "--directions mask.png --detail height.png",
            "--detail has no effect",
        ),
        ("--directions mask.png --scale places.exr", "have one size"),
        ("--scale mask.png --scales 9,9", "from 1/8 to 8"),
        ("--scales 1,2", "--scales has no effect without"),
        ("--directions mask.png --scales 2,1", "the lower scale is 2"),
        ("--scales 0.1,1 --mesh model.obj", "from 1/8"),
    ] {
        let line = format!("synth height.png {more} -o none.png");
        let output = run(&line);
        assert_eq!(output.status.code(), Some(2), "{line}");
        let text = stderr(&output);
        assert!(text.contains(part), "{line}: {text}");
    }
}

#[test]
fn a_repair_changes_only_what_is_white_in_its_mask() {
    let folder = Folder::with_inputs("repair");
    // Paint the scratch black, a color that the photograph lacks.
    let is_scratch = |x: u32, y: u32| (28..36).contains(&x) && (20..44).contains(&y);
    let photo = read_image(folder.path("photo.png"), &Limits::default()).unwrap();
    let photo = photo.color().unwrap();
    let scratched = Raster::from_fn(photo.size(), |x, y| {
        if is_scratch(x, y) {
            LinearRgb::BLACK
        } else {
            photo.pixels()[(y * 64 + x) as usize]
        }
    });
    write_color_png(folder.path("photo.png"), &scratched.unwrap(), Depth::Eight).unwrap();
    let repair = |more: &str| {
        let line = format!("synth photo.png --repair scratch.png --format png8 {more}");
        folder.run(&line.split(' ').collect::<Vec<_>>())
    };
    assert_done(&repair("--map height=height.png -o out.png"), "repair");
    let pixels = |name: &str| {
        let image = read_image(folder.path(name), &Limits::default()).unwrap();
        image.color().unwrap().into_pixels()
    };
    let (before, after) = (pixels("photo.png"), pixels("out.png"));
    let mut n_new = 0;
    for (at, (before, after)) in before.iter().zip(&after).enumerate() {
        let is_scratch = is_scratch(at as u32 % 64, at as u32 / 64);
        assert!(is_scratch || before == after, "pixel {at}");
        n_new += usize::from(before != after);
    }
    assert_eq!(n_new, 8 * 24, "no pixel of the scratch stays black");
    // A mask that leaves nothing out changes nothing, and one that leaves all out is refused.
    let gray = |name: &str, value| {
        let plane = Raster::filled([64; 2], value).unwrap();
        write_gray_png(folder.path(name), &plane, Depth::Eight).unwrap();
    };
    gray("white.png", 1.0);
    gray("black.png", 0.0);
    assert_done(&repair("--mask white.png -o all.png"), "all of it");
    assert!(pixels("all.png") == after, "a white mask");
    let text = stderr(&repair("--mask black.png -o none.png"));
    assert!(text.contains("the mask leaves no neighborhood"), "{text}");
}

#[test]
fn examples_go_where_the_map_of_them_says_with_all_their_maps() {
    let folder = Folder::with_inputs("which");
    let write = |name: &str, value: fn(u32, u32) -> f32, size: [u32; 2]| {
        let plane = Raster::from_fn(size, value).unwrap();
        write_gray_png(folder.path(name), &plane, Depth::Eight).unwrap();
    };
    // Three examples of three grays, whose relief says which they are, too.
    write("a.png", |x, _| 0.1 * f32::from(x % 2 == 0), [40, 40]);
    write("b.png", |_, y| 0.4 + 0.1 * f32::from(y % 2 == 0), [48, 36]);
    write(
        "c.png",
        |x, y| 0.8 + 0.1 * f32::from((x + y) % 2 == 0),
        [36, 48],
    );
    write("a_h.png", |_, _| 0.0, [40, 40]);
    write("b_h.png", |_, _| 0.2, [48, 36]);
    write("c_h.png", |_, _| 1.0, [36, 48]);
    write(
        "which.png",
        |x, _| [0.0, 0.5, 1.0][(x / 24) as usize],
        [72, 40],
    );
    let line = "synth a.png --example b.png --example c.png --which which.png \
        --map height=a_h.png --map height=b_h.png --map height=c_h.png -o out.png";
    let words: Vec<_> = line.split_whitespace().collect();
    assert_done(&folder.run(&words), line);
    let (out, heights) = (
        read_gray(&folder, "out.png"),
        read_gray(&folder, "out_height.png"),
    );
    for [x, y] in (0..40).flat_map(|y| (0..72).map(move |x| [x, y])) {
        let example = (x / 24) as usize;
        let [value, height] = [&out, &heights].map(|image| image.row(y)[x as usize]);
        let range = [0.0..0.12, 0.38..0.52, 0.78..0.92][example].clone();
        assert!(range.contains(&value), "{value} in column {x} and row {y}");
        let expected = [0.0, 0.2, 1.0][example];
        // Heights are written with 16 bits.
        assert!(
            (height - expected).abs() < 1e-4,
            "{height} in column {x} and row {y}"
        );
    }
}

#[test]
fn examples_go_where_a_map_on_a_mesh_says() {
    let folder = Folder::with_inputs("which_mesh");
    write_square(&folder);
    let write = |name: &str, size: u32, value: fn(u32, u32) -> f32| {
        let plane = Raster::from_fn([size; 2], value).unwrap();
        write_gray_png(folder.path(name), &plane, Depth::Eight).unwrap();
    };
    write("dark.png", 40, |x, y| 0.1 * f32::from((x / 2 + y) % 2 == 0));
    write("light.png", 40, |x, y| {
        0.9 + 0.1 * f32::from((x / 2 + y) % 2 == 0)
    });
    write("which.png", 8, |x, y| f32::from(x >= 4 && y >= 4));
    let line = "synth dark.png --example light.png --which which.png --mesh square.obj --sites 2000 \
        --atlas uv --texture-size 64 -o out.png";
    assert_done(
        &folder.run(&line.split_whitespace().collect::<Vec<_>>()),
        line,
    );
    let out = read_gray(&folder, "out.png");
    let places = (0..64).flat_map(|y| (0..64).map(move |x| [x, y]));
    let is_obeyed = |&[x, y]: &[u32; 2]| (out.row(y)[x as usize] > 0.5) == (x >= 32 && y >= 32);
    // But for texels at the border, which is 64 long and has sites at every 1.5 texels.
    let n_obeyed = places.filter(is_obeyed).count();
    assert!(n_obeyed > 64 * 64 - 2 * 64, "{n_obeyed} of 4096");
}

#[test]
fn repeats_across_a_mesh_set_the_number_of_sites() {
    let folder = Folder::with_inputs("repeats");
    write_square(&folder);
    let plane = Raster::from_fn([40; 2], |x, y| f32::from((x / 2 + y) % 2 == 0)).unwrap();
    write_gray_png(folder.path("checks.png"), &plane, Depth::Eight).unwrap();
    let run = |more: &str| {
        let line = format!("synth checks.png --mesh square.obj --force -o sites.ply {more}");
        folder.run(&line.split_whitespace().collect::<Vec<_>>())
    };
    let done = run("--repeat 0.5");
    assert_done(&done, "--repeat");
    let said = stderr(&done);
    assert!(said.contains("repeats about 0.5 times"), "{said}");
    // Half of the example, 20 pixels, along a side of length 1: a hexagonal lattice with this spacing has 2 / √3 times as
    // many sites as a square one with 400.
    let sites = dapple::mesh_io::read_model(folder.path("sites.ply")).unwrap();
    assert_eq!(sites.mesh.positions().len(), 462);
    // By default the example repeats five times, which takes (5 / 0.5)² times as many sites.
    let done = run("");
    assert_done(&done, "the default");
    let said = stderr(&done);
    assert!(said.contains("46188 sites"), "{said}");
    assert!(said.contains("repeats about 5.0 times"), "{said}");
    for (more, word) in [
        ("--repeat 1 --sites 500", "--sites"),
        ("--repeat 0", "repeats"),
        ("--repeat nan", "repeats"),
    ] {
        let refused = run(more);
        let said = stderr(&refused);
        assert_eq!(refused.status.code(), Some(2), "{more}: {said}");
        assert!(said.contains(word), "{more}: {said}");
    }
}

#[test]
fn sites_and_directions_are_refused_before_charts_are_cut() {
    let folder = Folder::with_inputs("refused_early");
    write_square(&folder);
    let run = |more: &str| {
        let line = format!("synth checker.png --mesh square.obj --texture-size 1 {more}");
        let refused = folder.run(&line.split_whitespace().collect::<Vec<_>>());
        assert_ne!(refused.status.code(), Some(0), "{line}");
        stderr(&refused)
    };
    // A chart with its padding has no room in one texel, which is said last.
    let said = run("-o a.glb");
    assert!(said.contains("side of the texture map"), "{said}");
    for (more, word) in [
        ("--repeat 0 -o b.glb", "the number of repeats is 0"),
        ("--sites 0 -o c.glb", "there are 0 sites"),
        ("--directions none.csv -o d.glb", "none.csv"),
    ] {
        let said = run(more);
        assert!(said.contains(word), "{more}: {said}");
        assert!(!said.contains("side of the texture map"), "{more}: {said}");
    }
}

#[test]
fn colors_of_vertices_say_what_an_image_of_them_says() {
    let folder = Folder::with_inputs("painted_mesh");
    // A square that is painted black on the left and white on the right.
    let header = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
        property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n\
        property list uchar int vertex_indices\nend_header\n";
    let vertices = "0 0 0 0 0 0\n1 0 0 255 255 255\n1 1 0 255 255 255\n0 1 0 0 0 0\n";
    let square = format!("{header}{vertices}4 0 1 2 3\n");
    fs::write(folder.path("painted.ply"), square).unwrap();
    write_square(&folder);
    let write = |name: &str, value: fn(u32, u32) -> f32| {
        let plane = Raster::from_fn([40; 2], value).unwrap();
        write_gray_png(folder.path(name), &plane, Depth::Eight).unwrap();
    };
    write("dark.png", |x, y| 0.1 * f32::from((x / 2 + y) % 2 == 0));
    write("light.png", |x, y| {
        0.9 + 0.1 * f32::from((x / 2 + y) % 2 == 0)
    });
    let run = |more: &str| {
        let line = format!(
            "synth dark.png --mesh square.obj --sites 2000 --atlas uv --texture-size 64 --force \
             -o out.png {more}"
        );
        folder.run(&line.split_whitespace().collect::<Vec<_>>())
    };
    for more in [
        "--example light.png --which painted.ply",
        "--example light.png --guide painted.ply",
        "--example light.png --which painted.ply --scale painted.ply --scales 1,1",
    ] {
        assert_done(&run(more), more);
        let out = read_gray(&folder, "out.png");
        let places = (0..64).flat_map(|y| (0..64).map(move |x| [x, y]));
        let is_obeyed = |&[x, y]: &[u32; 2]| (out.row(y)[x as usize] > 0.5) == (x >= 32);
        let n_obeyed = places.filter(is_obeyed).count();
        // A guide of lightness leaves more to the examples near its middle.
        assert!(n_obeyed > 3700, "{more}: {n_obeyed} of 4096");
    }
    for (more, part) in [
        (
            "--mesh square.obj --guide model.obj",
            "no colors of vertices",
        ),
        ("--mesh model.obj --scale painted.ply", "of 4 vertices, but"),
    ] {
        let line = format!("synth dark.png -o none.png {more}");
        let output = folder.run(&line.split_whitespace().collect::<Vec<_>>());
        assert_eq!(output.status.code(), Some(1), "{line}");
        let text = stderr(&output);
        assert!(text.contains(part), "{line}: {text}");
    }
    let flat = folder.run(&[
        "synth",
        "dark.png",
        "--guide",
        "painted.ply",
        "-o",
        "none.png",
    ]);
    assert_eq!(flat.status.code(), Some(1), "a mesh for an image");
}

/// Writes a mesh of a square whose texture coordinates equal its positions.
fn write_square(folder: &Folder) {
    let square =
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";
    fs::write(folder.path("square.obj"), square).unwrap();
}

#[test]
fn features_on_a_mesh_have_the_sizes_of_an_image_or_of_the_directions() {
    let folder = Folder::with_inputs("scale_mesh");
    write_square(&folder);
    let write = |name: &str, value: fn(u32, u32) -> f32| {
        let plane = Raster::from_fn([32; 2], value).unwrap();
        write_gray_png(folder.path(name), &plane, Depth::Eight).unwrap();
    };
    write("stripes.png", |_, y| f32::from(y % 8 < 4));
    write("right.png", |x, _| f32::from(x >= 16));
    // Rays from a point below the square: rows grow toward the top.
    let rays = "0,1,0,-0.5,1.5,0\n0,0,0,-0.5,0.5,0\n1,1,0,0.5,1.5,0\n1,0,0,0.5,0.5,0\n";
    fs::write(folder.path("rays.csv"), rays).unwrap();
    let rows = |more: &str| {
        let line = format!(
            "synth stripes.png --edges wrap --mesh square.obj --sites 16000 --atlas uv \
             --texture-size 128 --force -o out.png {more}"
        );
        let words: Vec<_> = line.split_whitespace().collect();
        assert_done(&folder.run(&words), &line);
        read_gray(&folder, "out.png")
    };
    // How often values pass a half along the columns of a part.
    let n_passes = |out: &Raster<f32>, columns: Range<u32>, rows: Range<u32>| {
        let places = rows.flat_map(|y| columns.clone().map(move |x| [x, y]));
        let value = |x: u32, y: u32| out.row(y)[x as usize] > 0.5;
        places
            .filter(|&[x, y]| value(x, y) != value(x, y + 1))
            .count() as f64
    };
    let line = "synth stripes.png --mesh model.obj --scale right.png -o none.glb";
    let run = folder.run(&line.split(' ').collect::<Vec<_>>());
    assert_eq!(run.status.code(), Some(1), "no texture coordinates");
    assert!(
        stderr(&run).contains("texture coordinates"),
        "{}",
        stderr(&run)
    );
    let out = rows("--scale right.png --scales 1,2");
    let ratio = n_passes(&out, 8..56, 8..120) / n_passes(&out, 72..120, 8..120);
    assert!((1.6..2.4).contains(&ratio), "{ratio} times as many");
    let [one, of_rays] = ["", "--scales 0.5,2"].map(|more| {
        let out = rows(&format!("--directions rays.csv {more}"));
        n_passes(&out, 40..88, 80..120) / n_passes(&out, 40..88, 8..48)
    });
    assert!((0.8..1.25).contains(&one), "{one} times as many below");
    // Of true rays 1.78, the ratio of distances; between directions at the corners alone a field bends less.
    assert!(
        (1.25..1.9).contains(&of_rays),
        "{of_rays} times as many below"
    );
}

#[test]
fn a_texture_is_light_where_its_guide_is() {
    let folder = Folder::with_inputs("guide");
    let spot = |x: u32, y: u32| f32::from(x.abs_diff(32) < 12 && y.abs_diff(20) < 10);
    let spot = Raster::from_fn([64, 48], spot).unwrap();
    write_gray_png(folder.path("spot.png"), &spot, Depth::Eight).unwrap();
    let ramp = Raster::from_fn([64, 64], |x, y| {
        (x as f32 / 64.0 + 0.1 * f32::from(y % 3 == 0)).min(1.0)
    });
    write_gray_png(folder.path("ramp.png"), &ramp.unwrap(), Depth::Eight).unwrap();
    for more in ["", "--guide-of ramp.png --guide-blur 1"] {
        let line = format!("synth ramp.png --guide spot.png --force -o out.png {more}");
        let words: Vec<_> = line.split_whitespace().collect();
        assert_done(&folder.run(&words), &line);
        let out = read_gray(&folder, "out.png");
        assert_eq!(out.size(), [64, 48], "that of the guide");
        let [mut inside, mut outside] = [(0.0, 0.0); 2];
        for (value, &is_inside) in out.pixels().iter().zip(spot.pixels()) {
            let sum = if is_inside == 1.0 {
                &mut inside
            } else {
                &mut outside
            };
            *sum = (sum.0 + value, sum.1 + 1.0);
        }
        let [inside, outside] = [inside, outside].map(|(sum, n)| sum / n);
        assert!(inside > outside + 0.3, "{inside} and {outside}");
    }
    // The model of the tests has no texture coordinates.
    let line = "synth ramp.png --guide spot.png --mesh model.obj --sites 500 -o out.glb";
    let output = folder.run(&line.split(' ').collect::<Vec<_>>());
    let text = stderr(&output);
    assert!(text.contains("texture coordinates"), "{text}");
}

#[test]
fn sources_that_were_written_lay_out_another_example_in_the_same_way() {
    let folder = Folder::with_inputs("sources");
    let run = |line: &str| folder.run(&line.split(' ').collect::<Vec<_>>());
    let first = "synth checker.png --size 24 --sources own.exr -o first.png";
    assert_done(&run(first), first);
    for (example, out) in [
        ("checker.png", "again.png"),
        ("height.png --region 0,0,32,32", "low.png"),
    ] {
        let line = format!("synth {example} --replay own.exr -o {out}");
        assert_done(&run(&line), &line);
    }
    let bytes = |name: &str| fs::read(folder.path(name)).unwrap();
    assert!(bytes("again.png") == bytes("first.png"), "the same texture");
    let places = read_image(folder.path("own.exr"), &Limits::default()).unwrap();
    let [height, low] = ["height.png", "low.png"].map(|name| read_gray(&folder, name));
    for (place, low) in places.color().unwrap().pixels().iter().zip(low.pixels()) {
        assert_eq!(
            height.row(place.g as u32)[place.r as usize],
            *low,
            "{place:?}"
        );
    }
    for (line, part) in [
        (
            "synth photo.png --replay height.exr -o out.png",
            "height.exr",
        ),
        (
            "synth photo.png --replay photo.png -o out.png",
            "has no sources",
        ),
        (
            "synth checker.png --region 0,0,8,8 --replay own.exr -o out.png",
            "8 x 8",
        ),
        (
            "synth checker.png --sources places.png -o out.png",
            "OpenEXR",
        ),
    ] {
        let output = run(line);
        assert_eq!(output.status.code(), Some(2), "{line}");
        assert!(
            stderr(&output).contains(part),
            "{line}: {}",
            stderr(&output)
        );
    }
}
