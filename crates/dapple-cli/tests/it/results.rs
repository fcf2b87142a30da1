//! Compares the results of the command with those of the libraries.

use crate::support::{Folder, assert_done, assert_refused, read_gray, stderr, stdout};
use dapple::hash::Seed;
use dapple::image::{Depth, Limits, decode_image, read_image, write_gray_png};
use dapple::mesh_io::read_model;
use dapple::raster::glam::DVec2;
use dapple::raster::{Field as _, Raster, Window, Wrap};
use dapple::tile::{Map, Method, Seamless, SoftCut, even_out, resize};
use dapple::worley::{Combination, OctaveSeeds, Octaves, Worley2};
use std::fs;

#[test]
fn tile_is_what_the_library_makes() {
    let folder = Folder::with_inputs("tile");
    let arguments = [
        "tile",
        "height.exr",
        "--method",
        "soft-cut",
        "--margin",
        "16",
        "-o",
        "out.exr",
    ];
    assert_done(&folder.run(&arguments), "tile");
    let cut = SoftCut {
        margin: Some(16),
        ..SoftCut::default()
    };
    let source = read_gray(&folder, "height.exr");
    let expected = Seamless::new(Method::SoftCut(cut)).apply(&source).unwrap();
    assert_eq!(read_gray(&folder, "out.exr"), expected);
}

#[test]
fn blend_writes_the_blended_height_beside_the_other_maps() {
    let folder = Folder::with_inputs("heights");
    let layers = [
        "rock.png,height=rock_height.png",
        "grass.png,weight=0.25,height=mask.png",
    ];
    let run = |weighting, output| {
        let options = ["--weighting", weighting, "-o", output];
        folder.run(&[&["blend"], &layers[..], &options].concat())
    };
    assert_done(&run("given", "out/"), "blend");
    assert!(folder.path("out/blend_base.png").is_file(), "the first map");
    let expected = read_gray(&folder, "rock_height.png")
        .zip_map(&read_gray(&folder, "mask.png"), |rock, grass| {
            0.75 * rock + 0.25 * grass
        })
        .unwrap();
    let blended = read_gray(&folder, "out/blend_height.png");
    for (value, expected) in blended.pixels().iter().zip(expected.pixels()) {
        // A file with 16 bits.
        assert!(
            (value - expected).abs() < 1.0 / 65_535.0,
            "{value} {expected}"
        );
    }
    // A single file is enough for the first map only.
    assert_done(&run("height", "out.png"), "blend");
    // A height that some layers lack is not part of the blend.
    let some = [
        "blend",
        layers[0],
        "grass.png",
        "--tile",
        "cracks.png",
        "-o",
        "some/",
    ];
    assert_done(&folder.run(&some), "blend");
    assert!(!folder.path("some/blend_height.png").exists(), "no height");
}

#[test]
fn tile_cuts_by_default_with_a_margin_that_fits() {
    let folder = Folder::with_inputs("tile-default");
    assert_done(
        &folder.run(&["tile", "height.exr", "-o", "out.exr"]),
        "tile",
    );
    let source = read_gray(&folder, "height.exr");
    let cut = SoftCut::default();
    let side = source.width().min(source.height());
    assert_eq!(cut.margin_of(source.size()), 32.min(side / 4));
    let expected = Seamless::new(Method::SoftCut(cut)).apply(&source).unwrap();
    assert_eq!(read_gray(&folder, "out.exr"), expected);
}

#[test]
fn tile_evens_out_the_light_and_resamples_the_result() {
    let folder = Folder::with_inputs("tile-even");
    let arguments = [
        "tile",
        "height.exr",
        "--even=9",
        "--size",
        "24x20",
        "-o",
        "out.exr",
    ];
    let output = folder.run(&arguments);
    assert_done(&output, "tile");
    assert!(
        stdout(&output).contains("is stretched"),
        "{}",
        stdout(&output)
    );
    let source = Map::Value(read_gray(&folder, "height.exr"));
    let seamless = Seamless::new(Method::SoftCut(SoftCut::default()));
    let even = even_out(&source, 9.0).unwrap();
    let tile = seamless.apply_maps(&[even]).unwrap().remove(0);
    let expected = resize(&tile, [24, 20], [Wrap::Repeat; 2]).unwrap();
    assert_eq!(Map::Value(read_gray(&folder, "out.exr")), expected);
    let refused = folder.run(&["tile", "height.exr", "--even=0.5", "-o", "no.exr"]);
    assert_refused(
        &refused,
        2,
        "radius of the light is 0.5, but it must be from 1",
        "--even",
    );
}

#[test]
fn auto_names_its_method_and_is_never_worse_than_others() {
    let folder = Folder::with_inputs("tile-auto");
    let output = folder.run(&["tile", "height.exr", "--method", "auto", "-o", "out.exr"]);
    assert_done(&output, "tile");
    let said = stdout(&output);
    let name = said
        .lines()
        .find_map(|line| line.strip_prefix("auto takes "));
    let name = name.expect("the method is named");
    let mut again = vec!["tile", "height.exr", "-o", "again.exr", "--method"];
    again.extend(name.split(' '));
    assert_done(&folder.run(&again), name);
    assert_eq!(
        read_gray(&folder, "again.exr"),
        read_gray(&folder, "out.exr"),
        "{name}"
    );
}

/// Returns the name of the method that `--method auto` chooses for an image.
fn auto_of(folder: &Folder, image: &Raster<f32>) -> String {
    write_gray_png(folder.path("source.png"), image, Depth::Eight).unwrap();
    let output = folder.run(&["tile", "source.png", "--method", "auto", "-o", "best.png"]);
    assert_done(&output, "auto");
    fs::remove_file(folder.path("best.png")).unwrap();
    let said = stdout(&output);
    let name = said
        .lines()
        .find_map(|line| line.strip_prefix("auto takes "));
    name.expect("the method is named").to_owned()
}

#[test]
fn auto_takes_a_cut_where_half_of_the_source_is_clipped() {
    let folder = Folder::new("tile-auto-clipped");
    let cells = [
        "worley",
        "--cells",
        "12",
        "--wrap",
        "none",
        "--size",
        "160",
        "--format",
        "png8",
        "-o",
        "cells.png",
    ];
    assert_done(&folder.run(&cells), "worley");
    let strong = read_gray(&folder, "cells.png").map(|v| (2.2 * (v - 0.35)).clamp(0.0, 1.0));
    let black = strong.pixels().iter().filter(|value| **value <= 0.0);
    assert!(black.count() > 160 * 160 / 2);
    assert_eq!(auto_of(&folder, &strong), "soft-cut");
}

#[test]
fn auto_synthesizes_where_no_other_method_passes() {
    // A weave whose strands of 25.5 pixels do not fit into the image.
    let strand = |place: f64| {
        let beside = 2.0 * (place - place.floor()) - 1.0;
        (1.0 - beside * beside).sqrt()
    };
    let weave = Raster::from_fn([160; 2], |x, y| {
        let [u, v] = [x, y].map(|at| f64::from(at) / 25.5);
        let is_over = (u.floor() + v.floor()) % 2.0 == 0.0;
        (if is_over {
            0.9 * strand(u)
        } else {
            0.45 * strand(v)
        }) as f32
    });
    let folder = Folder::new("tile-auto-weave");
    assert_eq!(auto_of(&folder, &weave.unwrap()), "synth");
}

#[test]
fn noise_names_octaves_that_are_finer_than_a_pixel() {
    let folder = Folder::new("noise-fine");
    let run = |cells: &str, octaves: &str| {
        let arguments = [
            "noise",
            "--cells",
            cells,
            "--octaves",
            octaves,
            "--size",
            "32",
            "--force",
            "-o",
            "noise.png",
        ];
        let output = folder.run(&arguments);
        assert_done(&output, cells);
        stderr(&output)
    };
    assert!(!run("8", "2").contains("note:"));
    assert!(run("8", "3").contains("note: octaves from number 3 on"));
    assert!(run("64", "1").contains("note: octaves from number 1 on"));
}

#[test]
fn octaves_of_worley_are_those_of_the_library() {
    let folder = Folder::new("octaves");
    let octaves = |seeds, lacunarity| Octaves {
        count: 3,
        lacunarity,
        gain: -0.25,
        seeds,
    };
    let cases: [(&str, &[&str], Octaves); 4] = [
        (
            "usual.exr",
            &[],
            Octaves {
                count: 3,
                ..Octaves::default()
            },
        ),
        (
            "paper.exr",
            &["--octave-seeds", "same"],
            Octaves {
                count: 3,
                ..Octaves::paper()
            },
        ),
        (
            "own.exr",
            &["--octave-seeds", "own", "--lacunarity", "3", "--gain=-0.25"],
            octaves(OctaveSeeds::Own, 3.0),
        ),
        (
            "same.exr",
            &[
                "--octave-seeds=same",
                "--lacunarity=4",
                "--persistence",
                "-0.25",
            ],
            octaves(OctaveSeeds::Same, 4.0),
        ),
    ];
    let worley = Worley2::new(Seed(7).child("worley", 0));
    let worley = worley.with_period([Some(4); 2]).unwrap();
    let window = Window::new(DVec2::ZERO, DVec2::splat(4.0), [64; 2]).unwrap();
    for (name, options, octaves) in cases {
        let run = "worley --octaves 3 --cells 4 --size 64 --seed 7 -o";
        let run: Vec<&str> = run.split(' ').chain([name]).collect();
        assert_done(&folder.run(&[&run, options].concat()), name);
        let texture = worley.combine(Combination::F1).fractal(octaves).unwrap();
        assert_eq!(
            read_gray(&folder, name),
            texture.to_raster(&window).unwrap(),
            "{name}"
        );
    }
}

#[test]
fn threads_do_not_change_a_bit() {
    let folder = Folder::with_inputs("threads");
    let runs: [&[&str]; 4] = [
        &["tile", "photo.png", "-o", "-"],
        &[
            "blend",
            "rock.png",
            "grass.png,weight=mask.png",
            "--mixing",
            "pyramid",
            "-o",
            "-",
        ],
        &["synth", "checker.png", "--size", "24", "-o", "-"],
        &["points", "--count", "300"],
    ];
    for arguments in runs {
        let run = |threads| {
            folder
                .run(&[arguments, &["--threads", threads]].concat())
                .stdout
        };
        let one = run("1");
        assert!(!one.is_empty(), "{arguments:?} gives something");
        assert_eq!(run("2"), one, "{arguments:?}");
        assert_eq!(run("7"), one, "{arguments:?}");
    }
}

#[test]
fn maps_are_cut_together_into_a_folder_that_is_made() {
    let folder = Folder::with_inputs("maps");
    let arguments = [
        "tile",
        "albedo.png",
        "height.png",
        "--normal",
        "normal.png",
        "--method",
        "soft-cut",
        "--margin",
        "8",
        "--sheet",
        "--json",
        "-o",
        "new/tiles/",
    ];
    assert_done(&folder.run(&arguments), "tile");
    let read = |name: &str| {
        read_image(folder.path(name), &Limits::default())
            .unwrap()
            .size()
    };
    for name in ["albedo", "height", "normal"] {
        assert_eq!(read(&format!("new/tiles/{name}.png")), [56, 56], "{name}");
        assert_eq!(
            read(&format!("new/tiles/{name}_2x2.png")),
            [112, 112],
            "{name}"
        );
    }
    assert!(
        folder.path("new/tiles/albedo.json").is_file(),
        "the sidecar"
    );
}

#[test]
fn a_region_is_what_is_tiled() {
    let folder = Folder::with_inputs("region");
    let arguments = [
        "tile",
        "photo.png",
        "--region",
        "8,16,32,24",
        "--method",
        "periodic",
        "-o",
        "out.png",
    ];
    assert_done(&folder.run(&arguments), "tile");
    let size = read_image(folder.path("out.png"), &Limits::default())
        .unwrap()
        .size();
    assert_eq!(size, [32, 24]);
}

#[test]
fn check_exits_with_3_for_a_seam() {
    let folder = Folder::with_inputs("check");
    assert_done(&folder.run(&["info", "grain.png", "--check"]), "noise");
    let output = folder.run(&["info", "photo.png", "--check"]);
    assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
    assert!(
        stdout(&output).contains("does not pass"),
        "{}",
        stdout(&output)
    );
}

#[test]
fn weights_are_shares_and_the_ground_gets_the_rest() {
    let folder = Folder::with_inputs("weights");
    let arguments = [
        "blend",
        "height.exr",
        "grain.png,weight=0.25",
        "-o",
        "out.exr",
    ];
    assert_done(&folder.run(&arguments), "blend");
    let [ground, over] = ["height.exr", "grain.png"].map(|name| read_gray(&folder, name));
    let blended = read_gray(&folder, "out.exr");
    for at in [0, 100, 4000] {
        let [ground, over] = [&ground, &over].map(|raster| raster.pixels()[at]);
        let expected = 0.75 * ground + 0.25 * over;
        // A few roundings of f32 near 1.
        assert!((blended.pixels()[at] - expected).abs() < 1e-6, "pixel {at}");
    }
}

#[test]
fn gray_layers_become_color_where_others_are() {
    let folder = Folder::with_inputs("gray");
    assert_done(
        &folder.run(&["blend", "height.png", "photo.png", "-o", "out.png"]),
        "blend",
    );
    let image = read_image(folder.path("out.png"), &Limits::default()).unwrap();
    assert!(
        image.gray().is_err() && image.color().is_ok(),
        "it is color"
    );
}

#[test]
fn an_option_of_a_blend_that_is_not_given_has_its_default() {
    let folder = Folder::with_inputs("defaults");
    let run = |options: &[&str]| {
        let layers = ["blend", "height.exr,height=rock_height.png"];
        let output = ["grain.png,height=grain.png", "--force", "-o", "out.png"];
        let arguments = [&layers[..], &output, options].concat();
        assert_done(&folder.run(&arguments), "blend");
        fs::read(folder.path("out.png")).unwrap()
    };
    for (chosen, given, other) in [
        (&["--tile", "cracks.png"][..], ["--gain", "8"], "4"),
        (&["--weighting", "height"], ["--depth", "0.2"], "0.4"),
        (&["--mixing", "pyramid"], ["--levels", "4"], "2"),
    ] {
        let default = run(chosen);
        assert_eq!(default, run(&[chosen, &given].concat()), "{given:?}");
        assert_ne!(default, run(&[chosen, &[given[0], other]].concat()));
    }
}

#[test]
fn a_layer_over_the_ground_begins_where_the_tile_is_low() {
    let folder = Folder::with_inputs("cracks");
    let arguments = [
        "blend",
        "height.exr",
        "grain.png,weight=0.25",
        "--tile",
        "cracks.png",
        "--gain",
        "1e9",
        "-o",
        "out.exr",
    ];
    assert_done(&folder.run(&arguments), "blend");
    let [over, blended, tile] =
        ["grain.png", "out.exr", "cracks.png"].map(|name| read_gray(&folder, name));
    let is_over: Vec<_> = over
        .pixels()
        .iter()
        .zip(blended.pixels())
        .map(|(a, b)| a == b)
        .collect();
    let share = is_over.iter().filter(|&&is_over| is_over).count() as f64 / is_over.len() as f64;
    // A pixel more or less, and noise that happens to equal the ground.
    assert!(
        (share - 0.25).abs() < 0.01,
        "a quarter is covered, not {share}"
    );
    let lowest = tile.statistics().min;
    let at = tile
        .pixels()
        .iter()
        .position(|&value| value == lowest)
        .unwrap();
    assert!(is_over[at], "the lowest place is covered");
}

#[test]
fn points_are_in_the_domain_and_read_back() {
    let folder = Folder::with_inputs("points");
    let arguments = [
        "points", "nested", "--count", "200", "--levels", "2", "--domain", "2x1", "--origin",
        "-1,3",
    ];
    let output = folder.run(&arguments);
    assert_done(&output, "points");
    let text = stdout(&output);
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("x,y,level"));
    let rows = lines.map(|line| line.split(',').map(|part| part.parse::<f64>().unwrap()));
    let rows: Vec<Vec<f64>> = rows.map(Iterator::collect).collect();
    assert!((180..220).contains(&rows.len()), "{} points", rows.len());
    let inside = |row: &Vec<f64>| (-1.0..1.0).contains(&row[0]) && (3.0..4.0).contains(&row[1]);
    assert!(rows.iter().all(inside), "all in the domain");
    assert!(
        rows.is_sorted_by_key(|row| row[2]),
        "the coarse level first"
    );
    assert_eq!(rows.last().map(|row| row[2]), Some(1.0), "two levels");
}

#[test]
fn a_covered_mesh_reads_back_with_its_texture() {
    let folder = Folder::with_inputs("mesh");
    let common = [
        "synth",
        "checker.png",
        "--mesh",
        "model.obj",
        "--sites",
        "600",
        "--edges",
        "wrap",
    ];
    let texture = ["--texture-size", "256"];
    for (name, extra) in [
        ("out.glb", &["--map", "normal=checker.png"][..]),
        ("two.obj", &[]),
        ("three.ply", &[]),
    ] {
        let extra = match name {
            "three.ply" => vec!["-o", name],
            _ => [&texture[..], extra, &["-o", name]].concat(),
        };
        let output = folder.run(&[&common[..], &extra].concat());
        assert_done(&output, name);
        let model = read_model(folder.path(name)).unwrap();
        let is_ply = name == "three.ply";
        assert_eq!(
            model.material.base_color.is_none(),
            is_ply,
            "{name} has a texture"
        );
        assert_eq!(model.colors.is_some(), is_ply, "{name} has colors");
        assert_eq!(
            model.material.normal.is_some(),
            name == "out.glb",
            "{name} has normals"
        );
    }
    let info = stdout(&folder.run(&["info", "out.glb", "--format", "json"]));
    assert!(info.contains("a texture of normals"), "{info}");
}

#[test]
fn a_synthesized_tile_has_pixels_of_the_photograph_in_all_maps() {
    let folder = Folder::with_inputs("synthesized");
    let line = "tile photo.png height.png --method synth --margin 12 --format png16 -o out/";
    for _ in 0..2 {
        let line = format!("{line} --force");
        assert_done(&folder.run(&line.split(' ').collect::<Vec<_>>()), &line);
    }
    let read = |name: &str| read_image(folder.path(name), &Limits::default()).unwrap();
    let [photo, tile] = ["photo.png", "out/photo.png"].map(|name| read(name).color().unwrap());
    let [height, low] = ["height.png", "out/height.png"].map(|name| read(name).gray().unwrap());
    assert_eq!(tile.size(), low.size(), "one tile");
    for side in tile.size() {
        assert!((32..=58).contains(&side) && side % 4 == 0, "{side}");
    }
    // Codes of colors are of one pixel with the height there.
    let pairs: Vec<_> = photo.pixels().iter().zip(height.pixels()).collect();
    for pair in tile.pixels().iter().zip(low.pixels()) {
        let is_pixel = pairs.iter().any(|&(color, height)| {
            color.to_srgb::<u8>() == pair.0.to_srgb::<u8>() && height == pair.1
        });
        assert!(is_pixel, "{pair:?}");
    }
}

#[test]
fn a_gray_photograph_keeps_its_codes_on_a_mesh() {
    let folder = Folder::with_inputs("gray");
    let squares = Raster::from_fn([32; 2], |x, y| [91, 131][((x / 8 + y / 8) % 2) as usize]);
    let codes: Raster<u8> = squares.unwrap();
    let values = codes.map(|&code| f32::from(code) / 255.0);
    write_gray_png(folder.path("gray.png"), &values, Depth::Eight).unwrap();
    let arguments = ["synth", "gray.png", "--mesh", "model.obj", "--sites", "600"];
    let size = ["--texture-size", "256"];
    for (name, size) in [("out.glb", &size[..]), ("out.obj", &size), ("out.ply", &[])] {
        let arguments = [&arguments, size, &["-o", name]].concat();
        assert_done(&folder.run(&arguments), name);
        let model = read_model(folder.path(name)).unwrap();
        let colors = match &model.material.base_color {
            Some(texture) => {
                let image = decode_image(texture.bytes(), &Limits::default()).unwrap();
                image.color().unwrap().pixels().to_vec()
            }
            None => model.colors.unwrap().iter().map(|at| at.color).collect(),
        };
        let codes = colors.iter().flat_map(|color| color.to_srgb::<u8>());
        // Between sites, codes are mixed.
        assert_eq!(codes.clone().min(), Some(91), "{name}");
        assert_eq!(codes.max(), Some(131), "{name}");
    }
}

#[test]
fn infos_of_many_files_are_one_json() {
    let folder = Folder::with_inputs("infos");
    let output = folder.run(&[
        "info",
        "photo.png",
        "height.exr",
        "model.obj",
        "--format",
        "json",
    ]);
    assert_done(&output, "info");
    let infos: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    let kinds: Vec<_> = infos
        .as_array()
        .unwrap()
        .iter()
        .map(|info| &info["kind"])
        .collect();
    assert_eq!(kinds, ["image", "image", "mesh"]);
    let names: Vec<_> = infos[0]["channels"].as_array().unwrap().iter().collect();
    assert_eq!(names.len(), 3, "red, green and blue");
}

#[test]
fn quiet_runs_say_nothing() {
    let folder = Folder::with_inputs("quiet");
    let output = folder.run(&["tile", "photo.png", "-q", "-o", "out.png"]);
    assert_done(&output, "tile");
    assert_eq!(
        (stdout(&output), stderr(&output)),
        (String::new(), String::new())
    );
    assert!(
        fs::metadata(folder.path("out.png")).is_ok(),
        "the tile is there"
    );
}
