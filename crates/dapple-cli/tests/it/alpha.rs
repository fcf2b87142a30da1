//! Tests of partly transparent images.

use crate::support::{Folder, assert_done, assert_refused, stdout};
use dapple::color::{LinearRgb, LinearRgba};
use dapple::image::{Depth, Image, Limits, read_image, write_color_alpha_png, write_color_png};
use dapple::raster::Raster;
use std::fs;

/// Writes an image of 48 × 48 pixels. `pixel` maps a pseudorandom number to the pixel's color and alpha.
fn write(folder: &Folder, name: &str, pixel: impl Fn(f32) -> LinearRgba) {
    let pixels = Raster::from_fn([48; 2], |x, y| {
        pixel((7 * x + 3 * y * y + x * y) as f32 % 40.0 / 100.0 + 0.3)
    });
    write_color_alpha_png(folder.path(name), &pixels.unwrap(), Depth::Sixteen).unwrap();
}

/// Creates a folder with an image whose alpha equals its gray value.
fn folder(name: &str) -> Folder {
    let folder = Folder::with_inputs(name);
    write(&folder, "leaf.png", |value| LinearRgba {
        color: LinearRgb::gray(value),
        alpha: value,
    });
    folder
}

fn read(folder: &Folder, name: &str) -> Image {
    read_image(folder.path(name), &Limits::default()).unwrap()
}

#[test]
fn alpha_goes_the_way_of_the_colors_in_tile_and_synth() {
    let folder = folder("alpha");
    for (line, output) in [
        ("tile leaf.png --sheet -o a.png", "a.png"),
        ("info a_2x2.png", "a_2x2.png"),
        (
            "tile leaf.png --method soft-cut --margin 12 -o b.png",
            "b.png",
        ),
        ("synth leaf.png --size 40 --seed 3 -o c.png", "c.png"),
        (
            "synth checker.png --region 0,0,32,32 --map cover=d.png --size 20 -o e.png",
            "e_cover.png",
        ),
    ] {
        if line.contains("d.png") {
            let cut = "tile leaf.png --method periodic --region 0,0,32,32 -o d.png";
            assert_done(&folder.run(&cut.split(' ').collect::<Vec<_>>()), cut);
        }
        assert_done(&folder.run(&line.split(' ').collect::<Vec<_>>()), line);
        let pixels = read(&folder, output).color_alpha().unwrap();
        let mut alphas = pixels.pixels().iter().map(|pixel| pixel.alpha);
        assert!(alphas.any(|alpha| alpha < 0.6), "{line}");
        for pixel in pixels.pixels() {
            // 16 bits, of which the sRGB curve spreads those of color unevenly.
            let gap = (pixel.color.g - pixel.alpha).abs();
            assert!(gap < 1e-4, "{line}: {pixel:?}");
        }
    }
}

#[test]
fn hidden_colors_do_not_bleed_into_a_resampled_tile() {
    let folder = Folder::new("alpha-resampled");
    // Green columns between transparent red ones.
    let pixels = Raster::from_fn([48; 2], |x, _| match x % 2 {
        0 => LinearRgba {
            color: LinearRgb::new(0.0, 0.5, 0.0),
            alpha: 1.0,
        },
        _ => LinearRgba {
            color: LinearRgb::new(1.0, 0.0, 0.0),
            alpha: 0.0,
        },
    });
    write_color_alpha_png(folder.path("grid.png"), &pixels.unwrap(), Depth::Sixteen).unwrap();
    let line = "tile grid.png --method mirror --size 24 -o small.png";
    assert_done(&folder.run(&line.split(' ').collect::<Vec<_>>()), line);
    let pixels = read(&folder, "small.png").color_alpha().unwrap();
    assert_eq!(pixels.size(), [24; 2]);
    for pixel in pixels.pixels() {
        // Half of the area is green; 16 bits round the sRGB curve.
        let LinearRgba { color, alpha } = *pixel;
        assert!((alpha - 0.5).abs() < 1e-4 && color.r < 1e-4, "{pixel:?}");
        assert!((color.g - 0.5).abs() < 1e-4, "{pixel:?}");
    }
}

#[test]
fn color_goes_on_under_alpha_0_but_around_a_hole() {
    let folder = Folder::new("rims");
    let leaf = LinearRgba::opaque(LinearRgb::new(0.05, 0.3, 0.02));
    let is_leaf = |x: u32, y: u32| [x % 48, y % 48].iter().all(|at| (12..36).contains(at));
    let pixels = Raster::from_fn([96; 2], |x, y| match is_leaf(x, y) {
        true => leaf,
        false => LinearRgba::default(),
    });
    write_color_alpha_png(folder.path("leaf.png"), &pixels.unwrap(), Depth::Eight).unwrap();
    let mask = Raster::from_fn([96; 2], |x, y| {
        LinearRgb::gray(f32::from((40..48).contains(&x) && (40..48).contains(&y)))
    });
    write_color_png(folder.path("hole.png"), &mask.unwrap(), Depth::Eight).unwrap();
    for line in [
        "tile leaf.png --method periodic --format png8 -o out.png",
        "tile leaf.png --method mirror --format png16 -o out.png",
        "synth leaf.png --size 64 --format png8 -o out.png",
        "synth leaf.png --size 64 --wrap both --format png16 -o out.png",
        "copies leaf.png --size 200 --format png8 -o out.png",
        "blend leaf.png --size 100 -o out.png",
    ] {
        let line: Vec<_> = line.split(' ').chain(["--force"]).collect();
        assert_done(&folder.run(&line), &line.join(" "));
        let pixels = read(&folder, "out.png").color_alpha().unwrap();
        let clear = pixels.pixels().iter().filter(|pixel| pixel.alpha == 0.0);
        assert!(clear.clone().count() > 0, "{line:?}: some are clear");
        for pixel in clear {
            // The only color that is seen, with 8 bits, and what periodic spreads over it.
            let gap = (pixel.color.g - 0.3).abs();
            assert!(gap < 0.03, "{line:?}: {pixel:?}");
        }
    }
    let line = "synth leaf.png --repair hole.png --format png8 -o out.png --force";
    assert_done(&folder.run(&line.split(' ').collect::<Vec<_>>()), line);
    let pixels = read(&folder, "out.png").color_alpha().unwrap();
    let kept = pixels.row(0)[0];
    assert_eq!(kept, LinearRgba::default(), "around a hole bits are kept");
}

#[test]
fn what_is_transparent_lends_no_color_to_a_blend() {
    let folder = Folder::new("transparent-blend");
    let color = |color, alpha| move |_| LinearRgba { color, alpha };
    let (red, blue) = (LinearRgb::new(0.6, 0.1, 0.1), LinearRgb::new(0.0, 0.0, 1.0));
    write(&folder, "red.png", color(red, 1.0));
    write(&folder, "none.png", color(blue, 0.0));
    let line = ["blend", "red.png", "none.png,weight=0.25", "-o", "out.png"];
    assert_done(&folder.run(&line), "blend");
    for pixel in read(&folder, "out.png").color_alpha().unwrap().pixels() {
        // 16 bits.
        assert!((pixel.alpha - 0.75).abs() < 1e-4, "{pixel:?}");
        let gaps = [pixel.color.r - red.r, pixel.color.b - red.b];
        assert!(gaps.iter().all(|gap| gap.abs() < 1e-4), "{pixel:?}");
    }
}

#[test]
fn alpha_is_dropped_or_laid_over_a_color_where_asked() {
    let folder = folder("opaque");
    let tile = |alpha: &str, output: &str| {
        let options = ["--method", "soft-cut", "--margin", "4", "--alpha", alpha];
        let run = folder.run(&[&["tile", "leaf.png", "-o", output], &options[..]].concat());
        assert_done(&run, alpha);
        read(&folder, output).color().expect("no alpha is left")
    };
    let colors = tile("drop", "drop.png");
    let white = tile("over:white", "over.png");
    let mean = |colors: &Raster<LinearRgb>| {
        let greens: f32 = colors.pixels().iter().map(|color| color.g).sum();
        greens / colors.pixels().len() as f32
    };
    // Grays g of 0.3, 0.31, … 0.69 with an alpha of g: their mean, and that of g² + (1 - g). The cut and its crossfade
    // use some pixels more than others.
    assert!((mean(&colors) - 0.495).abs() < 0.02, "{}", mean(&colors));
    assert!((mean(&white) - 0.763).abs() < 0.02, "{}", mean(&white));
}

#[test]
fn alpha_that_has_nowhere_to_go_is_refused_with_the_option() {
    let folder = folder("nowhere");
    for line in [
        "synth checker.png --region 0,0,32,32 --map cover=leaf.png --mesh model.obj --sites 500 -o out.glb",
        "blend rock.png photo.png,weight=leaf.png --size 32 -o out.png",
        "blend rock.png,height=leaf.png photo.png,height=leaf.png --size 32 -o out.png",
    ] {
        let words: Vec<_> = line.split(' ').collect();
        assert_refused(
            &folder.run(&words),
            2,
            "leaf.png is partly transparent",
            line,
        );
        assert_refused(&folder.run(&words), 2, "--alpha drop", line);
        let dropped = [&words[..], &["--alpha", "drop"]].concat();
        assert_done(&folder.run(&dropped), line);
        fs::remove_file(folder.path(words[words.len() - 1])).unwrap();
    }
}

#[test]
fn info_says_how_much_is_transparent() {
    let folder = folder("alpha-info");
    let said = stdout(&folder.run(&["info", "leaf.png"]));
    let expected = "alpha: 0.0 % of the pixels are transparent, 100.0 % partly so";
    assert!(said.contains(expected), "{said}");
}

#[test]
fn what_takes_values_of_an_image_says_what_becomes_of_its_alpha() {
    let folder = folder("alpha-values");
    fs::write(
        folder.path("leaf.toml"),
        "dapple = 1\nnodes.leaf = { image = { file = \"leaf.png\" } }\n[material]\nalbedo = \"leaf\"\n",
    )
    .unwrap();
    for line in [
        "blend-map leaf.png -o out.png",
        "points variable --density leaf.png --count 50 -o out.csv",
        "pups reference --reference leaf.png --size 8 -o out.png",
    ] {
        let refused = folder.run(&line.split(' ').collect::<Vec<_>>());
        assert_refused(&refused, 2, "--alpha drop or --alpha over:COLOR", line);
        for alpha in ["drop", "over:white"] {
            let line = format!("{line} --alpha {alpha} --force");
            assert_done(&folder.run(&line.split(' ').collect::<Vec<_>>()), &line);
        }
        let line = format!("{line} --alpha keep --force");
        let refused = folder.run(&line.split(' ').collect::<Vec<_>>());
        assert_refused(&refused, 2, "--alpha", &line);
    }
}

#[test]
fn a_node_of_a_recipe_says_what_becomes_of_the_alpha_of_its_image() {
    let folder = folder("alpha-recipe");
    let bake = |alpha: &str| {
        let node = format!("nodes.leaf = {{ image = {{ file = \"leaf.png\"{alpha} }} }}");
        let text = format!("dapple = 1\n{node}\n[material]\nalbedo = \"leaf\"\n");
        fs::write(folder.path("leaf.toml"), text).unwrap();
        let line = "bake leaf.toml --maps albedo --size 48 --force -o out.png";
        folder.run(&line.split(' ').collect::<Vec<_>>())
    };
    assert_refused(&bake(""), 2, "alpha = \"drop\"", "without alpha");
    assert_refused(&bake(", alpha = \"keep\""), 1, "over:#ffffff", "keep");
    let mean = |alpha: &str| {
        assert_done(&bake(alpha), alpha);
        let colors = read(&folder, "out.png").color().unwrap();
        colors.map(|color| color.g).statistics().mean
    };
    let [dropped, white] = [", alpha = \"drop\"", ", alpha = \"over:#ffffff\""].map(mean);
    // The leaf is as gray as it is opaque: v, or v² and 1 - v of white, for v from 0.3 to 0.7.
    assert!((0.45..0.55).contains(&dropped), "{dropped}");
    assert!((0.7..0.85).contains(&white), "{white}");
}

#[test]
fn larger_example_is_shown_with_all_its_pixels() {
    let folder = folder("detail");
    // Every second pixel.
    let leaf = read(&folder, "leaf.png").color_alpha().unwrap();
    let small = Raster::from_fn([24; 2], |x, y| leaf.row(2 * y)[2 * x as usize].color).unwrap();
    write_color_png(folder.path("small.png"), &small, Depth::Sixteen).unwrap();
    let line =
        "synth small.png --detail leaf.png --map cover=leaf.png --size 20 --levels 2 -o out.png";
    assert_done(&folder.run(&line.split(' ').collect::<Vec<_>>()), line);
    let shown = read(&folder, "out.png").color_alpha().unwrap();
    assert_eq!(shown.size(), [40, 40]);
    let all: Vec<_> = leaf
        .pixels()
        .iter()
        .map(|pixel| pixel.alpha.to_bits())
        .collect();
    assert!(
        shown
            .pixels()
            .iter()
            .all(|pixel| all.contains(&pixel.alpha.to_bits()))
    );
    assert_eq!(
        shown,
        read(&folder, "out_cover.png").color_alpha().unwrap(),
        "a map follows"
    );
    for (line, message) in [
        (
            "synth leaf.png --detail small.png",
            "is not the 48 × 48 of leaf.png times a whole number",
        ),
        (
            "synth small.png --detail leaf.png --region 0,0,20,20",
            "cannot be used with",
        ),
        (
            "synth small.png --detail photo.png --mesh model.obj --paper",
            "--detail has no effect with --paper",
        ),
    ] {
        let line = [line, "-o no.png"].join(" ");
        assert_refused(
            &folder.run(&line.split(' ').collect::<Vec<_>>()),
            2,
            message,
            &line,
        );
    }
}
