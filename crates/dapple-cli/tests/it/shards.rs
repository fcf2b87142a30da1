//! Tests of shards of an image: listing, baking by processes that are killed, and joining.

#![cfg(unix)]

use crate::support::{Folder, assert_done, assert_refused, stderr, stdout};
use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::time::Duration;

/// Returns the lines that `dapple shards` prints.
fn list(folder: &Folder, arguments: &str) -> Vec<String> {
    let words: Vec<_> = arguments.split(' ').collect();
    let run = folder.run(&words);
    assert_done(&run, arguments);
    stdout(&run).lines().map(str::to_owned).collect()
}

/// Runs the command lines, and returns their standard error.
fn run_all(folder: &Folder, lines: &[String]) -> String {
    let mut said = String::new();
    for line in lines {
        let run = folder.shell(line);
        assert_done(&run, line);
        said += &stderr(&run);
    }
    said
}

fn bytes(folder: &Folder, name: &str) -> Vec<u8> {
    let path = folder.path(name);
    fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Returns the number of files in a folder and its subfolders.
fn n_files(folder: &Path) -> usize {
    let entries = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path());
    entries
        .map(|path| if path.is_dir() { n_files(&path) } else { 1 })
        .sum()
}

#[test]
fn shards_of_runs_that_died_are_resumed_and_joined_to_the_bytes_of_the_whole() {
    let folder = Folder::with_inputs("shards");
    let of = "my-rock.toml --size 250x200 --maps height,normal,albedo,orm";
    let lines = list(&folder, &format!("shards {of} --shard 64 -o parts/"));
    assert_eq!(lines.len(), 16);
    // Two are never begun, two are killed, at once and in the middle, and one loses a single map.
    run_all(&folder, &lines[4..]);
    for (line, wait) in lines[2..4].iter().zip([0, 25]) {
        let words: Vec<_> = line.split(' ').skip(1).collect();
        let mut child = folder
            .command(&words)
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        std::thread::sleep(Duration::from_millis(wait));
        let _ = child.kill();
        child.wait().unwrap();
    }
    let run = folder.run(&["join", "parts/", "-o", "early.exr"]);
    assert_refused(&run, 1, "of 64 files are missing", "early");
    assert_refused(&run, 1, "x0_y0_height.exr", "early");
    let lists = fs::read_dir(folder.path("parts")).unwrap();
    let lists = lists.map(|entry| entry.unwrap().path());
    let shards = lists.into_iter().find(|path| path.is_dir()).unwrap();
    fs::remove_file(shards.join("y3/x3_y3_normal.exr")).unwrap();
    let said = run_all(&folder, &lines);
    assert!(said.contains("x3_y3_height.exr is there already"), "{said}");
    assert!(said.contains("x3_y3_normal.exr: 58 × 8 pixels"), "{said}");
    assert_eq!(n_files(&shards), 64, "and nothing else");
    let said = run_all(&folder, &lines);
    assert!(!said.contains("wrote"), "all is done: {said}");
    for (ending, format) in [("exr", "exr"), ("png", "png8"), ("png", "png16")] {
        let options = format!("--format {format}");
        list(&folder, &format!("join parts/ -o {format}/ {options}"));
        list(&folder, &format!("bake {of} -o whole-{format}/ {options}"));
        for map in ["height", "normal", "albedo", "orm"] {
            let [joined, whole] = ["", "whole-"]
                .map(|whole| bytes(&folder, &format!("{whole}{format}/my-rock_{map}.{ending}")));
            assert!(joined == whole, "{map} as {format}");
        }
    }
    let run = folder.run(&["join", "parts/", "-o", "arrays/", "--format", "npy"]);
    assert_refused(&run, 2, "normals", "normals in shards are rounded");
}

#[test]
fn shards_that_overlap_share_their_borders_and_are_joined_to_the_bytes_of_the_whole() {
    let folder = Folder::with_inputs("overlap");
    let of = "my-rock.toml --size 129x100 --maps height";
    let lines = list(
        &folder,
        &format!("shards {of} --shard 65 --overlap 1 -o parts/"),
    );
    assert_eq!(lines.len(), 4, "two beside each other, and two below them");
    run_all(&folder, &lines);
    let text = list(
        &folder,
        &format!("shards {of} --shard 65 --overlap 1 -o parts/ --format json"),
    );
    let document: serde_json::Value = serde_json::from_str(&text.join("\n")).unwrap();
    let tile = |index: usize| {
        let file = document["shards"][index]["files"][0].as_str().unwrap();
        let path = folder.path("parts").join(file);
        let image = dapple::image::read_image(path, &dapple::image::Limits::default());
        image.unwrap().gray().unwrap()
    };
    let [left, right, below] = [0, 1, 2].map(tile);
    assert_eq!(
        [left.size(), right.size(), below.size()],
        [[65, 65], [65, 65], [65, 36]]
    );
    for row in 0..65 {
        let [a, b] = [left.row(row)[64], right.row(row)[0]];
        assert_eq!(a.to_bits(), b.to_bits(), "row {row}");
    }
    assert_eq!(left.row(64), below.row(0));
    list(&folder, "join parts/ -o joined.exr");
    list(&folder, &format!("bake {of} -o whole.exr"));
    assert!(bytes(&folder, "joined.exr") == bytes(&folder, "whole.exr"));
}

#[test]
fn shards_on_corners_are_joined_to_the_whole_whose_last_samples_equal_the_first() {
    let folder = Folder::with_inputs("corners");
    let of = "my-rock.toml --size 65x49 --samples corners --maps height,normal";
    let shards = format!("shards {of} --shard 33 --overlap 1 -o parts/");
    let lines = list(&folder, &shards);
    assert!(lines[0].contains("--samples=corners"), "{}", lines[0]);
    run_all(&folder, &lines);
    list(&folder, "join parts/ -o joined/");
    list(&folder, &format!("bake {of} --format exr -o whole/"));
    for map in ["my-rock_height.exr", "my-rock_normal.exr"] {
        let [joined, whole] =
            ["joined", "whole"].map(|name| bytes(&folder, &format!("{name}/{map}")));
        assert!(joined == whole, "{map}");
    }
    let path = folder.path("whole/my-rock_height.exr");
    let image = dapple::image::read_image(path, &dapple::image::Limits::default());
    let heights = image.unwrap().gray().unwrap();
    assert_eq!(heights.row(0), heights.row(48));
    for row in 0..49 {
        assert_eq!(
            heights.row(row)[0].to_bits(),
            heights.row(row)[64].to_bits()
        );
    }
    let other = folder.run(&["join", "parts/", "-o", "joined/", "--force"]);
    assert_done(&other, "the list is there");
    let centers = shards.replace(" --samples corners", "");
    let run = folder.run(&centers.split(' ').collect::<Vec<_>>());
    assert_refused(
        &run,
        1,
        "lists shards of my-rock",
        "other samples are other shards",
    );
}

#[test]
fn arrays_and_raw_heights_are_joined_to_the_bytes_of_the_whole() {
    let folder = Folder::new("arrays");
    let of = "rock --size 100x70 --maps height";
    run_all(
        &folder,
        &list(&folder, &format!("shards {of} --shard 64x32 -o parts/")),
    );
    for name in ["height.npy", "height.r16"] {
        list(&folder, &format!("join parts/ -o joined-{name}"));
        list(&folder, &format!("bake {of} -o {name}"));
        assert!(
            bytes(&folder, name) == bytes(&folder, &format!("joined-{name}")),
            "{name}"
        );
    }
}

#[test]
fn shards_of_another_recipe_are_not_mistaken_for_finished_ones() {
    let folder = Folder::with_inputs("changed");
    let listing = "shards my-rock.toml --size 96 --shard 64 --maps height,albedo -o parts/";
    let lines = list(&folder, listing);
    run_all(&folder, &lines);
    let recipe = fs::read_to_string(folder.path("my-rock.toml")).unwrap();
    let change_recipe = || {
        fs::write(
            folder.path("my-rock.toml"),
            recipe.replace("seed = 3", "seed = 4"),
        )
        .unwrap();
    };
    let change_image = || {
        fs::write(folder.path("my-rock.toml"), &recipe).unwrap();
        fs::copy(folder.path("checker.png"), folder.path("photo.png")).unwrap();
    };
    for change in [&change_recipe as &dyn Fn(), &change_image] {
        change();
        let run = folder.shell(&lines[0]);
        assert_refused(&run, 1, "not these", "a shard among others");
        let words: Vec<_> = listing.split(' ').collect();
        assert_refused(&folder.run(&words), 1, "not these", "a list among others");
    }
    let lines = list(&folder, &format!("{listing} --force"));
    let run = folder.run(&["join", "parts/", "-o", "joined/"]);
    assert_refused(&run, 1, "8 of 8 files are missing", "none is old");
    run_all(&folder, &lines);
    list(&folder, "join parts/ -o joined/");
    list(
        &folder,
        "bake my-rock.toml --size 96 --maps albedo --format exr -o whole.exr",
    );
    assert!(bytes(&folder, "joined/my-rock_albedo.exr") == bytes(&folder, "whole.exr"));
}

#[test]
fn options_of_the_list_reach_the_bakes() {
    let folder = Folder::with_inputs("options");
    fs::rename(folder.path("my-rock.toml"), folder.path("my rock's.toml")).unwrap();
    let options = "--seed 9 --relief -0.5 --normal-y directx --maps normal --size 80";
    let recipe = r#""my rock's.toml""#;
    let listed = folder.shell(&format!(
        "dapple shards {recipe} {options} --shard 64 -o 'a b' --threads 1"
    ));
    assert_done(&listed, "a list");
    let lines: Vec<_> = stdout(&listed).lines().map(str::to_owned).collect();
    assert!(lines[0].contains(" --threads=1 "), "{lines:?}");
    run_all(&folder, &lines);
    assert_done(&folder.run(&["join", "a b", "-o", "joined.exr"]), "join");
    let whole = folder.shell(&format!("dapple bake {recipe} {options} -o whole.exr"));
    assert_done(&whole, "bake");
    assert!(bytes(&folder, "joined.exr") == bytes(&folder, "whole.exr"));
}

#[test]
fn the_document_names_the_files_that_the_bakes_write() {
    let folder = Folder::new("document");
    let of = "shards rock --size 100x70 --shard 64 --maps height,ao --frames 2 -o parts/";
    let text = list(&folder, &format!("{of} --format json")).join("\n");
    let document: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(document["recipe"], "rock");
    assert_eq!(document["maps"], serde_json::json!(["height", "ao"]));
    let shards = document["shards"].as_array().unwrap();
    assert_eq!(shards.len(), 8);
    assert_eq!(shards[7]["index"], 7);
    assert_eq!(shards[7]["frame"], "2/2");
    assert_eq!(shards[7]["first"], serde_json::json!([64, 64]));
    assert_eq!(shards[7]["size"], serde_json::json!([36, 6]));
    run_all(&folder, &list(&folder, of));
    let files = shards
        .iter()
        .flat_map(|shard| shard["files"].as_array().unwrap());
    let files: Vec<_> = files.map(|file| file.as_str().unwrap()).collect();
    assert_eq!(files.len(), 16);
    for file in files {
        assert!(folder.path("parts").join(file).is_file(), "{file}");
    }
}

#[test]
fn the_pictures_of_a_loop_are_baked_alone_and_in_shards() {
    let folder = Folder::new("loop-shards");
    let field = "--frames 3 --cells 2 --size 48";
    list(&folder, &format!("worley {field} -o sea.png"));
    list(&folder, &format!("worley {field} --recipe -o sea.toml"));
    let bake = "bake sea.toml --size 48 --maps height,albedo";
    list(&folder, &format!("{bake} --frame 2/3 -o bakes/"));
    assert!(bytes(&folder, "bakes/worley_height_002.png") == bytes(&folder, "sea_002.png"));
    let lines = list(
        &folder,
        "shards sea.toml --size 48 --maps height,albedo --frames 3 --shard 32 -o parts/",
    );
    assert_eq!(lines.len(), 12);
    run_all(&folder, &lines);
    list(&folder, "join parts/ -o joined/ --format png16 --json");
    for number in ["001", "002", "003"] {
        let joined = bytes(&folder, &format!("joined/worley_height_{number}.png"));
        assert!(
            joined == bytes(&folder, &format!("sea_{number}.png")),
            "{number}"
        );
        assert!(
            folder
                .path(&format!("joined/worley_{number}.json"))
                .is_file(),
            "{number}"
        );
    }
    assert_eq!(n_files(&folder.path("joined")), 9);
}

#[test]
fn what_cannot_be_done_in_shards_is_refused_before_anything_is_written() {
    let folder = Folder::new("refused-shards");
    for (arguments, code, part) in [
        (
            "shards stone-and-grass --size 256 --shard 64",
            2,
            "whole tile",
        ),
        ("shards - --size 256 --shard 64", 2, "put it into a file"),
        ("shards rock --size 256 --shard 0", 2, "1 to"),
        ("bake rock --size 256 --shard 4,0,64 -o parts/", 2, "4 x 4"),
        ("bake rock --size 256 --shard 0,0,64", 2, "missing output"),
        (
            "bake rock --size 256 --shard 0,0,64 -o rock.glb",
            2,
            "--shard",
        ),
        (
            "bake stone-and-grass --size 256 --shard 0,0,64 -o a/",
            2,
            "whole tile",
        ),
        ("bake rock --frame 4/3 -o a/", 2, "3/24"),
        ("join . -o a.exr", 1, "shards.json"),
    ] {
        let words: Vec<_> = arguments.split(' ').collect();
        let run = folder.run(&words);
        assert_refused(&run, code, part, arguments);
        assert_eq!(stdout(&run), "", "{arguments}");
    }
    let left = folder
        .names()
        .iter()
        .map(|name| n_files(&folder.path(name)))
        .sum::<usize>();
    assert_eq!(left, 0, "no files: {:?}", folder.names());
}

#[test]
fn runs_that_make_one_shard_at_the_same_time_all_succeed() {
    let folder = Folder::new("race");
    let of = "shards rock --size 96 --shard 64 --maps height -o parts/";
    let lines = list(&folder, of);
    for line in &lines {
        let words: Vec<_> = line.split(' ').skip(1).collect();
        let start = |_| {
            folder
                .command(&words)
                .stderr(Stdio::piped())
                .spawn()
                .unwrap()
        };
        let runs: Vec<_> = (0..6).map(start).collect();
        for run in runs {
            assert_done(&run.wait_with_output().unwrap(), line);
        }
    }
    assert_eq!(
        n_files(&folder.path("parts")),
        5,
        "four shards and the list"
    );
}

#[test]
fn a_damaged_shard_is_named() {
    let folder = Folder::new("damaged");
    let of = "shards rock --size 96 --shard 64 --maps height -o parts/ --format json";
    let document: serde_json::Value = serde_json::from_str(&list(&folder, of).join("\n")).unwrap();
    run_all(&folder, &list(&folder, &of.replace(" --format json", "")));
    let files = [0, 1].map(|index| {
        let file = document["shards"][index]["files"][0].as_str().unwrap();
        folder.path("parts").join(file)
    });
    fs::copy(&files[0], &files[1]).unwrap();
    let run = folder.run(&["join", "parts/", "-o", "a.exr"]);
    assert_refused(&run, 1, "x1_y0_height.exr", "of another size");
    let half = fs::read(&files[0]).unwrap();
    fs::write(&files[1], &half[..half.len() / 2]).unwrap();
    let run = folder.run(&["join", "parts/", "-o", "a.exr"]);
    assert_refused(&run, 1, "x1_y0_height.exr", "half of it");
    assert!(!folder.path("a.exr").exists());
}

#[test]
fn a_job_template_is_valid_and_bakes_all_shards() {
    let folder = Folder::with_inputs("openjd");
    if !folder.shell("command -v openjd").status.success() {
        eprintln!("openjd is not installed: its template is not tried");
        return;
    }
    let of = "my-rock.toml --size 80x40 --shard 64 --maps albedo";
    // A template names files below its own folder; others, such as an absolute path, are texts.
    let absolute = format!("-o {}", folder.path("parts2").display());
    let outputs = ["-o parts0", "--frames 2 -o parts1", &absolute];
    for (number, more) in outputs.into_iter().enumerate() {
        let line = format!("dapple shards {of} {more} --format openjd > job{number}.json");
        assert_done(&folder.shell(&line), &line);
        for step in ["check", "run"] {
            let line = format!("openjd {step} job{number}.json");
            assert_done(&folder.shell(&line), &line);
        }
        let line = format!("dapple join parts{number} -o joined{number}/");
        assert_done(&folder.shell(&line), &line);
    }
    list(
        &folder,
        "bake my-rock.toml --size 80x40 --maps albedo -o whole.exr",
    );
    let whole = bytes(&folder, "whole.exr");
    for joined in [
        "joined0/my-rock_albedo.exr",
        "joined1/my-rock_albedo_002.exr",
        "joined2/my-rock_albedo.exr",
    ] {
        assert!(bytes(&folder, joined) == whole, "{joined}");
    }
}
