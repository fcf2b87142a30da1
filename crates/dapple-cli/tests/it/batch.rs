//! Tests of several recipes in one run, and of sheets, previews, progress and watched recipes.

use crate::support::{Folder, assert_done, assert_refused, stderr, stdout};
use dapple::image::{Image, Limits, read_image};
use dapple::recipe::Recipe;
use std::fs;
use std::time::{Duration, Instant};

fn read(folder: &Folder, name: &str) -> Image {
    read_image(folder.path(name), &Limits::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn names(folder: &Folder, inside: &str) -> Vec<String> {
    let entries = fs::read_dir(folder.path(inside)).unwrap();
    let name = |entry: std::io::Result<fs::DirEntry>| entry.unwrap().file_name();
    let mut names: Vec<_> = entries
        .map(|entry| name(entry).into_string().unwrap())
        .collect();
    names.sort();
    names
}

/// Creates a folder with the recipes `a-cow.toml` and `a-rock.toml`.
fn with_recipes(name: &str) -> Folder {
    let folder = Folder::new(name);
    for name in ["cow", "rock"] {
        let text = Recipe::builtin_text(name).unwrap();
        fs::write(folder.path(&format!("a-{name}.toml")), text).unwrap();
    }
    folder
}

#[test]
fn several_recipes_and_patterns_are_baked_in_one_call() {
    let folder = with_recipes("batch");
    let bake = [
        "bake", "ice", "a-*.toml", "--maps", "height", "--size", "16", "-o", "all",
    ];
    let run = folder.run(&bake);
    assert_done(&run, "a batch");
    assert_eq!(
        names(&folder, "all"),
        ["cow_height.png", "ice_height.png", "rock_height.png"]
    );
    assert!(
        stderr(&run).ends_with("baked 3 of 3 recipes\n"),
        "{}",
        stderr(&run)
    );
    assert_refused(&folder.run(&bake), 1, "ice was not baked", "what is there");
    let builtin = ["bake", "?ce*", "--maps", "ao", "--size", "16", "-o", "-"];
    assert_done(&folder.run(&builtin), "a pattern of built-in recipes");
    for (wrong, part) in [
        (&["bake", "b-*.toml", "-o", "x/"][..], "matches b-*.toml"),
        (&["bake", "ice", "rock", "-o", "x.png"], "need a folder"),
        (&["bake", "ice", "ice", "-o", "x/"], "both called ice"),
        (
            &["bake", "ice", "rock", "-o", "x/", "--name", "y"],
            "--name",
        ),
    ] {
        assert_refused(&folder.run(wrong), 2, part, part);
        assert!(!folder.path("x").exists(), "{part}: nothing is left");
    }
}

#[test]
fn a_range_of_seeds_bakes_a_variant_with_each() {
    let folder = Folder::new("seeds");
    let bake = ["bake", "rock", "--maps", "height", "--size", "16"];
    let run = folder.run(&[&bake[..], &["--seed", "9-11", "-o", "all/"]].concat());
    assert_done(&run, "three seeds");
    assert_eq!(
        names(&folder, "all"),
        [
            "rock_09_height.png",
            "rock_10_height.png",
            "rock_11_height.png"
        ]
    );
    assert_done(
        &folder.run(&[&bake[..], &["--seed", "10", "-o", "ten.png"]].concat()),
        "one seed",
    );
    let sheet = ["--seed", "9-11", "--contact-sheet", "--force", "-o", "all/"];
    assert_done(
        &folder.run(&[&bake[..], &sheet].concat()),
        "a contact sheet",
    );
    assert!(names(&folder, "all").contains(&"contact_sheet.png".to_owned()));
    // Two columns and two rows of previews with gaps between them.
    let sheet = read(&folder, "all/contact_sheet.png");
    assert_eq!(sheet.size(), [2 * 256 + 3 * 8; 2]);
    let bytes = |name: &str| fs::read(folder.path(name)).unwrap();
    assert_eq!(bytes("ten.png"), bytes("all/rock_10_height.png"));
    assert_ne!(bytes("ten.png"), bytes("all/rock_11_height.png"));
    for (wrong, part) in [
        (
            &["bake", "rock", "--seed", "3-1", "-o", "x/"][..],
            "below 3",
        ),
        (
            &["bake", "rock", "--seed", "1-2", "-o", "x.png"],
            "need a folder",
        ),
        (
            &["shards", "rock", "--shard", "8", "--seed", "1-2"],
            "one seed is needed",
        ),
    ] {
        assert_refused(&folder.run(wrong), 2, part, part);
    }
}

#[test]
fn a_node_is_baked_alone_as_heights_or_colors() {
    let folder = Folder::new("nodes");
    let text = "dapple = 1\nname = \"two\"\n[nodes]\na = { noise = { octaves = 2 } }\nb = { ramp = { input = \"a\", \
        palette = \"ember\" } }\n[material]\n";
    fs::write(folder.path("two.toml"), text).unwrap();
    for (node, head) in [("a", "height = \"a\""), ("b", "albedo = \"b\"")] {
        let bake = [
            "bake", "two.toml", "--size", "24", "-o", "out/", "--node", node,
        ];
        assert_done(&folder.run(&bake), node);
        fs::write(folder.path("whole.toml"), format!("{text}{head}\n")).unwrap();
        let map = head.split(' ').next().unwrap();
        let file = format!("{node}.png");
        let bake = [
            "bake",
            "whole.toml",
            "--size",
            "24",
            "--maps",
            map,
            "-o",
            &file,
        ];
        assert_done(&folder.run(&bake), map);
        let bytes = |name: &str| fs::read(folder.path(name)).unwrap();
        assert_eq!(
            bytes(&file),
            bytes(&format!("out/two_{node}_{map}.png")),
            "{node}"
        );
    }
    let wrong = ["bake", "two.toml", "--node", "c", "-o", "x/"];
    assert_refused(&folder.run(&wrong), 2, "unknown node \"c\"", "no such node");
}

#[test]
fn variants_of_a_recipe_on_standard_input_equal_those_of_the_file() {
    let folder = with_recipes("piped-variants");
    let bake = |recipe: &str, options: &str| {
        let line = format!("bake {recipe} --maps height --size 16 --seed 1-2 {options}");
        let words: Vec<_> = line.split(' ').collect();
        let mut command = folder.command(&words);
        command.stdin(fs::File::open(folder.path("a-rock.toml")).unwrap());
        assert_done(&command.output().unwrap(), &line);
    };
    bake("-", "-o piped/");
    bake("a-rock.toml", "-o read/");
    assert_eq!(names(&folder, "piped").len(), 2);
    for name in names(&folder, "piped") {
        let bytes = |inside: &str| fs::read(folder.path(inside).join(&name)).unwrap();
        assert!(bytes("piped") == bytes("read"), "{name}");
    }
}

#[test]
fn a_batch_keeps_going_if_it_is_told_to() {
    let folder = with_recipes("keep-going");
    fs::write(folder.path("a-bad.toml"), "dapple = 1\nflowers = 3\n").unwrap();
    let bake = [
        "bake", "a-*.toml", "--maps", "height", "--size", "16", "-o", "all/",
    ];
    assert_refused(&folder.run(&bake), 1, "a-bad.toml was not baked", "a batch");
    assert!(
        !folder.path("all").exists(),
        "mistakes are found before the work"
    );
    let run = folder.run(&[&bake[..], &["--keep-going"]].concat());
    assert_eq!(run.status.code(), Some(1), "{}", stderr(&run));
    assert_eq!(names(&folder, "all"), ["cow_height.png", "rock_height.png"]);
    for part in [
        "a-bad.toml was not baked",
        "flowers",
        "baked 2 of 3 recipes",
    ] {
        assert!(stderr(&run).contains(part), "{part}: {}", stderr(&run));
    }
}

#[test]
fn a_sheet_is_two_by_two_copies_and_a_preview_is_lit() {
    let folder = Folder::new("sheet");
    let bake = [
        "bake",
        "flagstone",
        "--maps",
        "height,albedo",
        "--size",
        "32x16",
        "--sheet",
        "-o",
        "out/",
    ];
    assert_done(
        &folder.run(&[&bake[..], &["--preview=plane"]].concat()),
        "a sheet",
    );
    let (tile, sheet) = (
        read(&folder, "out/flagstone_height.png"),
        read(&folder, "out/flagstone_height_2x2.png"),
    );
    let (tile, sheet) = (tile.gray().unwrap(), sheet.gray().unwrap());
    assert_eq!(sheet.size(), [64, 32]);
    for first in [[0, 0], [32, 0], [0, 16], [32, 16]] {
        assert_eq!(
            sheet.crop(first, [32, 16]).unwrap(),
            tile,
            "the copy at {first:?}"
        );
    }
    let plane = read(&folder, "out/flagstone_preview.png").color().unwrap();
    let ball = [
        "bake",
        "flagstone",
        "--maps",
        "ao",
        "--size",
        "8",
        "--preview",
        "-o",
        "ball/",
    ];
    assert_done(&folder.run(&ball), "a ball");
    let ball = read(&folder, "ball/flagstone_preview.png").color().unwrap();
    assert_eq!((plane.size(), ball.size()), ([512, 512], [512, 512]));
    assert_ne!(plane, ball);
    let middle: Vec<f32> = [-40_i32, 0, 40]
        .map(|by| {
            let column = 256_i32.saturating_add(by).unsigned_abs() as usize;
            ball.row(256)[column].luminance()
        })
        .to_vec();
    assert!(
        middle.iter().all(|&light| light > 0.01),
        "it is lit: {middle:?}"
    );
}

#[test]
fn progress_as_json_is_a_line_for_each_step_and_file() {
    let folder = Folder::new("progress");
    let bake = [
        "bake",
        "ice",
        "--maps",
        "height",
        "--size",
        "32",
        "--progress",
        "json",
        "-o",
        "a.png",
    ];
    let run = folder.run(&bake);
    assert_done(&run, "bake");
    let said = stderr(&run);
    let lines: Vec<serde_json::Value> = said
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    assert_eq!(
        lines.first().map(|line| &line["step"]),
        Some(&"baking".into()),
        "{said}"
    );
    let whole = lines.iter().filter_map(|line| line["done"].as_u64()).max();
    assert_eq!(whole, Some(32), "all rows: {said}");
    assert_eq!(
        lines.last().map(|line| &line["wrote"]),
        Some(&"a.png".into()),
        "{said}"
    );
    assert_eq!(stdout(&run), "", "nothing on standard output");
}

#[test]
fn a_watched_recipe_is_baked_at_every_save_and_mistakes_do_not_end_it() {
    let folder = with_recipes("watched");
    let watch = [
        "watch",
        "a-rock.toml",
        "--maps",
        "height",
        "--size",
        "300x150",
        "-o",
        "out/",
    ];
    let mut child = folder
        .command(&watch)
        .stderr(std::process::Stdio::null())
        .spawn()
        .unwrap();
    let path = folder.path("out/rock_height.png");
    let begun = Instant::now();
    let wait_for = |what: &str, is_there: &dyn Fn(&[u8]) -> bool| loop {
        if let Some(bytes) = fs::read(&path).ok().filter(|bytes| is_there(bytes)) {
            break bytes;
        }
        assert!(
            begun.elapsed() < Duration::from_secs(120),
            "{what} never came"
        );
        std::thread::sleep(Duration::from_millis(20));
    };
    // The width of a PNG is in its bytes 16 to 19.
    let is_large = |bytes: &[u8]| bytes.get(16..20) == Some(&300_u32.to_be_bytes()[..]);
    let first = wait_for("the first bake", &is_large);
    let text = Recipe::builtin_text("rock").unwrap();
    fs::write(folder.path("a-rock.toml"), "dapple = 1\nflowers = 3\n").unwrap();
    std::thread::sleep(Duration::from_millis(300));
    assert_eq!(fs::read(&path).unwrap(), first, "a mistake changes nothing");
    let other = text.replacen("\nseed = ", "\nseed = 1", 1);
    assert_ne!(other, text, "the recipe has a seed");
    fs::write(folder.path("a-rock.toml"), other).unwrap();
    wait_for("the second bake", &|bytes| {
        is_large(bytes) && bytes != first
    });
    assert_eq!(child.try_wait().unwrap(), None, "it goes on");
    child.kill().unwrap();
    child.wait().unwrap();
}

#[test]
fn only_a_recipe_in_a_file_is_watched() {
    let folder = Folder::new("unwatched");
    for recipes in [&["rock"][..], &["rock", "ice"]] {
        let run = folder.run(&[&["watch"][..], recipes, &["-o", "out/"]].concat());
        assert_refused(&run, 2, "in a file", "a built-in recipe");
    }
}
