//! Tests of the spelling of option names, values and file names.

use crate::support::{Folder, assert_done, assert_refused, stderr, stdout};
use std::fs;

/// Pairs of command lines that must have the same effect.
const SAME: [[&str; 2]; 10] = [
    ["worley --value f2_minus_f1", "worley --Value F2-Minus-F1"],
    ["worley --metric manhattan", "worley --metric Manhattan"],
    [
        "worley --octaves 3 --gain 0.7",
        "worley --octaves 3 --persistence 0.7",
    ],
    ["worley --format png16", "worley --format PNG"],
    [
        "wavelet --cells 8 --octaves 2 --gain 0.7",
        "wavelet --cells 8 --octaves 2 --persistence 0.7",
    ],
    [
        "wavelet --cells 8 --range=-2,2",
        "wavelet --cells 8 --range -2,2",
    ],
    ["pups color-noise", "pups Color_Noise"],
    [
        "pups cow --weight quintic --orientations random",
        "pups COW --weight Quintic --orientations RANDOM",
    ],
    [
        "bake wood-grain --maps albedo",
        "bake Wood_Grain --maps BaseColor",
    ],
    [
        "bake flagstone --maps height --seed 9 --relief 0.5",
        "bake flagstone --maps height --set seed=9 --set material.relief=0.5",
    ],
];

/// Command lines of every subcommand that writes to a folder, and the names of the files that they write.
const NAMED: [(&str, &[&str]); 16] = [
    ("worley", &["worley.png"]),
    ("worley --frames 2", &["worley_001.png", "worley_002.png"]),
    ("pups cow --format exr", &["pups.exr"]),
    ("pups cow --frames 2", &["pups_001.png", "pups_002.png"]),
    ("noise --octaves 3 --json", &["noise.json", "noise.png"]),
    ("wavelet --cells 8 --recipe", &["wavelet.toml"]),
    ("recipe flagstone --rust", &["flagstone.rs"]),
    ("bake flagstone --maps ao", &["flagstone_ao.png"]),
    (
        "bake flagstone --maps ao --frames 2",
        &["flagstone_ao_001.png", "flagstone_ao_002.png"],
    ),
    ("points --count 20 --format json", &["points.json"]),
    ("tile photo.png --sheet", &["photo.png", "photo_2x2.png"]),
    ("copies stones.png --size 16", &["copies.png"]),
    (
        "copies rock.png grass.png --method borders --tiles",
        &["copies_1.png", "copies_2.png"],
    ),
    (
        "blend rock.png,normal=normal.png grass.png,normal=normal.png",
        &["blend_base.png", "blend_normal.png"],
    ),
    ("blend-map stones.png", &["blend-map.png"]),
    ("info photo.png", &["info.json"]),
];

fn small(line: &str) -> Vec<&str> {
    let is_drawn = ["worley", "pups", "noise", "wavelet", "bake"]
        .iter()
        .any(|name| line.starts_with(name));
    let size: &[&str] = if is_drawn { &["--size", "16"] } else { &[] };
    line.split(' ').chain(size.iter().copied()).collect()
}

fn names(folder: &Folder, inside: &str) -> Vec<String> {
    let entries = fs::read_dir(folder.path(inside)).unwrap();
    let mut names: Vec<_> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn words_are_read_as_people_type_them() {
    let folder = Folder::new("spelled");
    for pair in SAME {
        let [one, other] = pair.map(|line| {
            let output = folder.run(&[&small(line)[..], &["-o", "-"]].concat());
            assert_done(&output, line);
            output.stdout
        });
        assert_eq!(one, other, "{pair:?}");
    }
}

#[test]
fn every_subcommand_writes_into_folders_that_are_there_or_are_made() {
    let folder = Folder::with_inputs("folders");
    fs::create_dir(folder.path("there")).unwrap();
    for (line, expected) in NAMED {
        let made = folder.run(&[&small(line)[..], &["-o", "new/deep/"]].concat());
        assert_done(&made, line);
        assert_eq!(names(&folder, "new/deep"), expected, "{line}");
        fs::remove_dir_all(folder.path("new")).unwrap();
        assert_done(
            &folder.run(&[&small(line)[..], &["-o", "there", "--name", "mine"]].concat()),
            line,
        );
        let written = names(&folder, "there");
        assert!(
            written.iter().all(|name| name.starts_with("mine")),
            "{line}: {written:?}"
        );
        fs::remove_dir_all(folder.path("there")).unwrap();
        fs::create_dir(folder.path("there")).unwrap();
    }
}

#[test]
fn several_files_are_named_after_a_file_or_lie_in_a_folder() {
    let folder = Folder::with_inputs("several-names");
    let run = |line: &str| {
        let output = folder.run(&small(line));
        assert_done(&output, line);
        stderr(&output)
    };
    run("bake flagstone --maps height,ao -o new/rock.png --json");
    assert_eq!(
        names(&folder, "new"),
        ["rock.json", "rock_ao.png", "rock_height.png"]
    );
    run("worley --frames 2 -o loop");
    assert_eq!(names(&folder, "loop"), ["worley_001.png", "worley_002.png"]);
    run("tile rock.png rock_height.png --name wet -o wet");
    assert_eq!(names(&folder, "wet"), ["wet_height.png", "wet_rock.png"]);
    run("synth checker.png --size 16 --map normal=checker.png -o grown/");
    assert_eq!(
        names(&folder, "grown"),
        ["checker.png", "checker_normal.png"]
    );
}

#[test]
fn set_changes_a_recipe_as_its_text_would_and_refuses_the_rest() {
    let folder = Folder::new("set");
    let set = ["--set", "joint.scatter={ jittered = { jitter = 0.3 } }"];
    let run = |words: &[&str], set: &[&str]| folder.run(&[words, set].concat());
    let written = run(&["recipe", "flagstone", "-o", "mine.toml"], &set);
    assert_done(&written, "a recipe is written");
    let bake = |recipe: &str, file: &str, set: &[&str]| {
        let words = [
            "bake", recipe, "--maps", "height", "--size", "48", "-o", file,
        ];
        assert_done(&run(&words, set), file);
        fs::read(folder.path(file)).expect("it is written")
    };
    let changed = bake("flagstone", "set.png", &set);
    assert_eq!(changed, bake("mine.toml", "text.png", &[]));
    assert_ne!(changed, bake("flagstone", "plain.png", &[]));

    let listed = run(
        &[
            "shards",
            "flagstone",
            "--size",
            "64",
            "--shard",
            "32",
            "-o",
            "parts/",
        ],
        &set,
    );
    assert_done(&listed, "shards");
    let words = "'--set=joint.scatter={ jittered = { jitter = 0.3 } }'";
    assert!(
        stdout(&listed).lines().all(|line| line.contains(words)),
        "{}",
        stdout(&listed)
    );

    for (value, part) in [
        ("jiont.seed=5", "did you mean `joint`?"),
        ("joint.sed=5", "did you mean `seed`?"),
        ("joint=5", "name one of its options"),
        ("material.relief=high", "expected a number"),
        ("relief", "NODE.OPTION=VALUE"),
        ("=5", "NODE.OPTION=VALUE"),
    ] {
        let refused = run(&["bake", "flagstone", "-o", "out/", "--set"], &[value]);
        assert_refused(&refused, 2, part, value);
    }
}
