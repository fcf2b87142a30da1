//! Tests of baking recipes and single fields: files, crops, threads and killed processes.

use crate::support::{Folder, ROCK, assert_done, assert_refused, stdout};
use dapple::image::{Image, Limits, decode_image, read_image};
use std::fs;
use std::time::{Duration, Instant};

fn read(folder: &Folder, name: &str) -> Image {
    read_image(folder.path(name), &Limits::default()).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn fields_on_corners_have_square_spaces_and_meet() {
    let folder = Folder::new("corners");
    for line in [
        // 32 × 16 spaces have 8 × 4 cells, and 33 × 17 pixels would have none that repeat.
        "wavelet --cells 4 --size 33x17 --samples corners -o out.exr",
        "worley --cells 2 --size 33x17 --samples corners -o out.exr --force",
        "noise --cells 2 --size 33x17 --samples corners -o out.exr --force",
        "pups noise --size 33x17 --samples corners -o out.exr --force",
    ] {
        let run = folder.run(&line.split(' ').collect::<Vec<_>>());
        assert_done(&run, line);
        let values = read(&folder, "out.exr").gray().unwrap();
        assert_eq!(values.row(0), values.row(16), "{line}");
        for row in 0..17 {
            assert_eq!(values.row(row)[0], values.row(row)[32], "{line}");
        }
        assert_ne!(values.row(0), values.row(15), "{line}");
    }
}

#[test]
fn a_bake_writes_a_file_for_each_map() {
    let folder = Folder::new("maps");
    let maps = [
        "height",
        "normal",
        "ao",
        "curvature",
        "albedo",
        "roughness",
        "metallic",
        "orm",
    ];
    let asked = maps.join(",");
    let run = folder.run(&[
        "bake",
        "flagstone",
        "-o",
        "out/",
        "--size",
        "48x32",
        "--maps",
        &asked,
        "--json",
    ]);
    assert_done(&run, "bake");
    for map in maps {
        let image = read(&folder, &format!("out/flagstone_{map}.png"));
        assert_eq!((image.size(), image.bits()), ([48, 32], 16), "{map}");
        let is_gray = !["normal", "albedo", "orm"].contains(&map);
        assert_eq!(image.gray().is_ok(), is_gray, "{map}");
    }
    let json = fs::read_to_string(folder.path("out/flagstone.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["report"]["name"], "flagstone", "the recipe");
    assert!(json["options"]["baked"]["nodes"].is_object(), "all of it");
    let heights = &json["outputs"][0]["range"];
    assert!(
        heights[0].as_f64() >= Some(0.0) && heights[1].as_f64() <= Some(1.0),
        "{heights}"
    );
}

#[test]
fn all_built_in_recipes_bake() {
    let folder = Folder::new("builtin");
    let list = stdout(&folder.run(&["recipe", "--list"]));
    let names: Vec<_> = list
        .lines()
        .filter_map(|line| line.strip_prefix("  ")?.split_whitespace().next())
        .collect();
    assert!(names.len() >= 20, "all that the papers name: {names:?}");
    for name in names {
        let run = folder.run(&["bake", name, "-o", &format!("{name}/"), "--size", "64"]);
        assert_done(&run, name);
        let height = read(&folder, &format!("{name}/{name}_height.png"))
            .gray()
            .unwrap();
        let statistics = height.statistics();
        assert!(
            statistics.max - statistics.min > 0.1,
            "{name} has a relief: {statistics:?}"
        );
    }
}

#[test]
fn recipes_are_listed_by_family_and_by_words() {
    let folder = Folder::new("recipe-list");
    let list = stdout(&folder.run(&["recipe", "--list"]));
    let families = list.lines().filter(|line| !line.starts_with(' '));
    let families: Vec<_> = families.collect();
    assert!(
        families.is_sorted() && families.contains(&"stone"),
        "{families:?}"
    );
    // A tag, a name and a word of the sentence, in upper or lower case, and a node by a word of other programs.
    for (word, name) in [
        ("Voronoi", "worley"),
        ("timber", "wood-grain"),
        ("Marble", "marble"),
        ("joints", "flagstone"),
    ] {
        let found = stdout(&folder.run(&["recipe", "--list", word]));
        assert!(found.contains(&format!("  {name} ")), "{word}: {found}");
        assert!(!found.contains("  craters "), "{word}: {found}");
    }
    assert_refused(
        &folder.run(&["recipe", "--list", "xyzzy"]),
        2,
        "no built-in recipe is about `xyzzy`",
        "`dapple recipe --list` names all",
    );
}

#[test]
fn a_region_is_a_crop_and_threads_do_not_matter() {
    let folder = Folder::new("region");
    let bake = |output: &str, more: &[&str]| {
        let run = [
            "bake", "ice", "--size", "96", "--maps", "albedo", "--format", "exr", "-o", output,
        ];
        assert_done(&folder.run(&[&run[..], more].concat()), output);
        read(&folder, output).color().unwrap()
    };
    let whole = bake("whole.exr", &["--threads", "1"]);
    let part = bake("part.exr", &["--region", "17,30,50,41", "--threads", "3"]);
    assert_eq!(whole.crop([17, 30], [50, 41]).unwrap(), part, "bit for bit");
    let other = bake("other.exr", &["--seed", "9"]);
    assert_ne!(whole, other, "another seed");
}

#[test]
fn banded_and_whole_bakes_have_the_same_bytes() {
    let folder = Folder::new("banded");
    for (output, banded) in [("a.exr", None), ("b.exr", Some("--banded"))] {
        let run = [
            "bake", "craters", "--size", "1500x900", "--maps", "normal", "-o", output,
        ];
        assert_done(&folder.run(&[&run[..], banded.as_slice()].concat()), output);
    }
    assert_eq!(
        fs::read(folder.path("a.exr")).unwrap(),
        fs::read(folder.path("b.exr")).unwrap()
    );
}

// `tests/on_gpu` bakes with the feature.
#[cfg(not(feature = "gpu"))]
#[test]
fn a_bake_on_a_gpu_without_the_feature_names_it() {
    let folder = Folder::new("gpu");
    let output = folder.run(&["bake", "marble", "--size", "64", "-o", "a/", "--gpu"]);
    assert_refused(&output, 2, "--features gpu", "without the feature");
}

#[test]
fn a_mistake_in_a_recipe_is_told_with_its_line() {
    let folder = Folder::with_inputs("mistake");
    let bake = |text: String| {
        fs::write(folder.path("bad.toml"), text).unwrap();
        folder.run(&["bake", "bad.toml", "-o", "out/", "--size", "8"])
    };
    let run = bake(ROCK.replace("value =", "valeu ="));
    assert_refused(&run, 1, "line 7", "a field");
    assert_refused(&run, 1, "did you mean `value`", "a field");
    assert_refused(
        &bake(ROCK.replace("\"cells\"", "\"cell\"")),
        1,
        "did you mean `cells`",
        "a node",
    );
    assert_refused(
        &bake(ROCK.replace("photo.png", "foto.png")),
        1,
        "foto.png",
        "an image",
    );
    assert!(!folder.path("out").exists(), "nothing is left");
}

#[test]
fn what_a_field_prints_as_its_recipe_bakes_to_the_same_bits() {
    let folder = Folder::new("same");
    for command in [
        "worley --value f2_minus_f1 --seed 4",
        "pups turbulence --seed 4",
        "wavelet --cells 8 --seed 4",
    ] {
        let run = |more: &[&str]| {
            let words: Vec<_> = command
                .split(' ')
                .chain(["--size", "40"])
                .chain(more.iter().copied())
                .collect();
            let output = folder.run(&words);
            assert_done(&output, command);
            output
        };
        run(&["--recipe", "-o", "field.toml", "--force"]);
        let written = fs::read_to_string(folder.path("field.toml")).unwrap();
        assert_eq!(written, stdout(&run(&["--recipe"])), "{command}");
        let drawn = run(&["-o", "-"]).stdout;
        let bake = [
            "bake",
            "field.toml",
            "--size",
            "40",
            "--maps",
            "height",
            "-o",
            "-",
        ];
        assert_eq!(drawn, folder.run(&bake).stdout, "{command}");
    }
}

#[test]
fn a_recipe_is_written_in_the_format_of_its_ending() {
    let folder = Folder::new("ending");
    for (file, begins) in [("a.json", "{"), ("b.JSON", "{"), ("c.toml", "dapple = 1")] {
        let arguments = ["recipe", "giraffe", "--seed", "3", "-o", file];
        assert_done(&folder.run(&arguments), file);
        let text = fs::read_to_string(folder.path(file)).unwrap();
        assert!(text.starts_with(begins), "{file}: {text}");
        assert_done(&folder.run(&["recipe", file, "--check"]), file);
    }
}

#[test]
fn the_pictures_of_a_loop_differ_and_are_numbered() {
    let folder = Folder::new("loop");
    let run = [
        "worley", "--frames", "3", "--cells", "2", "--size", "24", "-o", "sea.png",
    ];
    assert_done(&folder.run(&run), "a loop");
    assert_eq!(
        folder.names(),
        ["sea_001.png", "sea_002.png", "sea_003.png"]
    );
    let bytes = |name: &str| fs::read(folder.path(name)).unwrap();
    assert_ne!(bytes("sea_001.png"), bytes("sea_002.png"));
}

/// Text of a recipe with a node that moves.
const LOOP: &str = "dapple = 1\nname = \"tide\"\nextent = [2.0, 2.0]
[nodes.waves.pups.noise]\nspacing = 0.4\nnet = { motion = { radius = 0.25 } }
[nodes.sand.pups.cells]\nspacing = 0.3
[nodes.rock.image]\nfile = \"rock.png\"
[nodes.all]\nadd = [\"waves\", \"sand\"]
[material]\nheight = \"all\"\nalbedo = \"rock\"\nroughness = \"sand\"\n";

#[test]
fn all_pictures_of_a_loop_are_those_baked_one_by_one() {
    let folder = Folder::with_inputs("all-frames");
    fs::write(folder.path("tide.toml"), LOOP).unwrap();
    let run = |line: &str| {
        let words: Vec<_> = line.split(' ').collect();
        assert_done(&folder.run(&words), line);
    };
    let bake =
        "bake tide.toml --size 40x24 --preview --sheet --maps height,normal,albedo,roughness";
    run(&format!("{bake} --frames 3 -o all/ --json"));
    let files = |name: &str| fs::read_dir(folder.path(name)).unwrap().count();
    assert_eq!(files("all"), 3 * (4 + 4 + 1 + 1));
    for number in 1..=3 {
        run(&format!("{bake} --frame {number}/3 -o one/"));
    }
    assert_eq!(files("one"), 27);
    for entry in fs::read_dir(folder.path("one")).unwrap() {
        let name = entry.unwrap().file_name();
        let bytes = |of: &str| fs::read(folder.path(of).join(&name)).unwrap();
        assert!(bytes("one") == bytes("all"), "{name:?}");
    }
    let bytes = |name: &str| fs::read(folder.path(name)).unwrap();
    assert_ne!(
        bytes("all/tide_height_001.png"),
        bytes("all/tide_height_002.png")
    );
    assert_eq!(
        bytes("all/tide_roughness_001.png"),
        bytes("all/tide_roughness_002.png")
    );
    run("bake tide.toml --size 40x24 --frames 2 --maps height -o h.png");
    assert!(folder.path("h_001.png").is_file() && folder.path("h_002.png").is_file());
    assert!(
        bytes("h_001.png") == bytes("one/tide_height_001.png"),
        "a loop begins at the same time"
    );
}

#[test]
fn noise_on_a_sphere_meets_itself() {
    let folder = Folder::new("sphere");
    for line in [
        "noise --sphere --cells 3 --octaves 4 --size 33x17 --samples corners -o planet.exr",
        "noise --cube --cells 3 --octaves 4 --size 9 --samples corners --format exr -o sky/",
    ] {
        let words: Vec<_> = line.split(' ').collect();
        assert_done(&folder.run(&words), line);
    }
    let planet = read(&folder, "planet.exr").gray().unwrap();
    for y in 0..17 {
        assert_eq!(planet.row(y)[0].to_bits(), planet.row(y)[32].to_bits());
    }
    for pole in [planet.row(0), planet.row(16)] {
        assert!(
            pole.iter()
                .all(|value| value.to_bits() == pole[0].to_bits())
        );
    }
    let face = |name: &str| {
        read(&folder, &format!("sky/noise_{name}.exr"))
            .gray()
            .unwrap()
    };
    let [px, nz, py, pz] = ["px", "nz", "py", "pz"].map(face);
    for at in 0..9 {
        // The right side of +z is the left side of +x, and the right side of +x the left side of −z.
        assert_eq!(pz.row(at)[8].to_bits(), px.row(at)[0].to_bits());
        assert_eq!(px.row(at)[8].to_bits(), nz.row(at)[0].to_bits());
        assert_eq!(
            py.row(8)[at as usize].to_bits(),
            pz.row(0)[at as usize].to_bits()
        );
    }
    // Both images show the same sphere: their centers look along x.
    assert_eq!(planet.row(8)[16].to_bits(), px.row(4)[4].to_bits());
    for (line, part) in [
        ("noise --sphere --size 64 -o a.png", "twice as wide"),
        ("noise --cube --size 64x32 -o a/", "square"),
        ("noise --sphere --cube -o a/", "--cube"),
        ("noise --sphere --size 1048576x524288 -o a.png", "pixels"),
        ("noise --sphere --size 64x32 --cells nan -o a.png", "extent"),
        ("noise --sphere --size 64x32 --cells inf -o a.png", "extent"),
        ("noise --cube --size 8 --gain -1 -o a/", "gain"),
    ] {
        let words: Vec<_> = line.split(' ').collect();
        assert_refused(&folder.run(&words), 2, part, line);
    }
}

#[test]
fn a_flipbook_holds_the_frames_of_a_loop_row_by_row() {
    let folder = Folder::with_inputs("flipbook");
    fs::write(folder.path("tide.toml"), LOOP).unwrap();
    let maps = ["height", "normal", "albedo"];
    for line in [
        "bake tide.toml --size 40x24 --maps height,normal,albedo --flipbook 3x2 -o book/",
        "bake tide.toml --size 40x24 --maps height,normal,albedo --frames 6 -o all/",
    ] {
        let words: Vec<_> = line.split(' ').collect();
        assert_done(&folder.run(&words), line);
    }
    let read = |name: &str| read_image(folder.path(name), &Limits::default()).unwrap();
    for map in maps {
        let book = read(&format!("book/tide_{map}.png")).color().unwrap();
        assert_eq!(book.size(), [3 * 40, 2 * 24], "{map}");
        for frame in 0..6 {
            let [left, top] = [40 * (frame % 3), 24 * (frame / 3)];
            let image = read(&format!("all/tide_{map}_{:03}.png", frame + 1));
            let image = image.color().unwrap();
            for y in 0..24 {
                let part = &book.row(top + y)[left as usize..][..40];
                assert_eq!(part, image.row(y), "row {y} of frame {frame} of {map}");
            }
        }
    }
    let first = read("all/tide_height_001.png");
    assert_ne!(first, read("all/tide_height_002.png"), "the loop moves");
    for (line, part) in [
        (
            "bake tide.toml --size 1024 --flipbook 1000x1000 --maps height -o large/",
            "2^30",
        ),
        (
            "bake tide.toml --size 1 --flipbook 32768x32768 --maps height -o large/",
            "100000",
        ),
    ] {
        let words: Vec<_> = line.split(' ').collect();
        assert_refused(&folder.run(&words), 2, part, line);
    }
    assert!(!folder.path("large").exists());
    let line = "bake tide.toml --size 16 --preset unity --flipbook 2x1 -o unity/";
    let words: Vec<_> = line.split(' ').collect();
    assert_done(&folder.run(&words), line);
    let meta = fs::read_to_string(folder.path("unity/tide_Normal.png.meta")).unwrap();
    assert!(meta.starts_with("fileFormatVersion: 2\n"), "{meta}");
}

#[test]
fn control_points_move_in_the_loop_that_their_recipe_bakes() {
    let folder = Folder::with_inputs("points-loop");
    for line in [
        "pups reference --reference rock.png --frames 3 --size 32 -o a/",
        "pups cow --motion 0.1 --frames 3 --size 32 -o b/",
        "pups cow --motion 0.1 --size 32 --recipe -o cow.toml",
        "bake cow.toml --frames 3 --size 32 --maps height -o c/",
    ] {
        let words: Vec<_> = line.split(' ').collect();
        assert_done(&folder.run(&words), line);
    }
    let bytes = |name: &str| fs::read(folder.path(name)).unwrap();
    assert_ne!(bytes("a/pups_001.png"), bytes("a/pups_003.png"));
    assert_ne!(bytes("b/pups_001.png"), bytes("b/pups_002.png"));
    assert!(bytes("b/pups_003.png") == bytes("c/pups_height_003.png"));
}

#[cfg(unix)]
#[test]
fn a_bake_that_is_killed_at_any_moment_leaves_old_files_or_whole_new_ones() {
    let folder = Folder::new("killed");
    let bake = |seed: &str| {
        let run = [
            "bake",
            "flagstone",
            "--size",
            "256",
            "--maps",
            "height,normal",
            "--seed",
            seed,
            "--force",
            "-o",
            "out/",
        ];
        folder.command(&run)
    };
    let names = ["out/flagstone_height.png", "out/flagstone_normal.png"];
    let bytes = || names.map(|name| fs::read(folder.path(name)).unwrap());
    let begun = Instant::now();
    assert!(
        bake("2").output().unwrap().status.success(),
        "the new files"
    );
    let whole_run = begun.elapsed();
    let new = bytes();
    assert!(
        bake("1").output().unwrap().status.success(),
        "the old files"
    );
    let old = bytes();
    // Kills the process at evenly spread moments from before the first byte to after the last, by the golden ratio.
    for round in 0..16 {
        let part = (f64::from(round) * 0.618_033_988_75).fract();
        let mut child = bake("2")
            .stdout(std::process::Stdio::null())
            .stderr(std::process::Stdio::null())
            .spawn()
            .unwrap();
        std::thread::sleep(Duration::from_secs_f64(
            whole_run.as_secs_f64() * 1.2 * part,
        ));
        // A child that has ended cannot be killed, which is fine.
        let _ = child.kill();
        child.wait().unwrap();
        for ((found, old), new) in bytes().iter().zip(&old).zip(&new) {
            assert!(
                found == old || found == new,
                "round {round}: a file is neither the old nor the new one"
            );
            assert!(
                decode_image(found, &Limits::default()).is_ok(),
                "round {round}: a whole image"
            );
        }
    }
    assert!(bake("2").output().unwrap().status.success(), "the next run");
    assert_eq!(bytes(), new, "after all");
    let rubbish = fs::read_dir(folder.path("out")).unwrap().count();
    assert_eq!(rubbish, 2, "the next run takes away what was left");
}
