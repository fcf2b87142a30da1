//! Tests of unusual input paths: pipes and devices instead of files, absurd sizes, and names with special characters.

#![cfg(unix)]

use crate::support::{Folder, assert_done, assert_refused, stderr, stdout};
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// Runs a shell command that must end by itself within a time limit.
fn ends(folder: &Folder, line: &str) -> Output {
    // The limit is far above what any of these takes on a busy machine, and far below forever.
    let output = folder.shell(&format!("timeout -s KILL 60 {line}"));
    assert_ne!(output.status.code(), Some(137), "{line} does not end");
    output
}

fn make_pipe(path: &Path) {
    let made = Command::new("mkfifo").arg(path).status().unwrap();
    assert!(made.success(), "{} is made", path.display());
}

#[test]
fn a_pipe_under_a_temporary_name_is_not_waited_for() {
    let folder = Folder::with_inputs("fifo");
    for made in ["tmp", "out"] {
        fs::create_dir(folder.path(made)).unwrap();
        make_pipe(&folder.path(made).join(".dapple-a.part"));
        std::os::unix::fs::symlink(
            folder.path(made).join(".dapple-a.part"),
            folder.path(made).join(".dapple-b.part"),
        )
        .unwrap();
    }
    for line in [
        "env TMPDIR=tmp dapple info photo.png",
        "env TMPDIR=tmp dapple recipe rock -o -",
        "env TMPDIR=tmp dapple worley --size 16 -o -",
        "dapple worley --size 16 -o out/a.png",
    ] {
        assert_done(&ends(&folder, line), line);
    }
    assert!(folder.path("out/.dapple-a.part").exists(), "it is not ours");
}

#[test]
fn small_outputs_of_a_pipeline_need_no_folder_for_temporary_files() {
    let folder = Folder::new("no-tmp");
    let output = folder.shell("TMPDIR=/nonexistent dapple worley --size 16 -o -");
    assert_done(&output, "no TMPDIR");
    assert!(output.stdout.starts_with(b"\x89PNG"), "a picture");
}

#[test]
fn images_are_regular_files() {
    let folder = Folder::with_inputs("devices");
    make_pipe(&folder.path("pipe.png"));
    for (file, part) in [("/dev/zero", "is a device"), ("pipe.png", "a pipe")] {
        let recipe = format!(
            "dapple = 1\nname = \"a\"\n[nodes.a.image]\nfile = \"{file}\"\n[material]\nheight = \"a\"\n"
        );
        fs::write(folder.path("a.toml"), recipe).unwrap();
        for line in [
            "dapple bake a.toml --size 8 --maps height -o a.png",
            "dapple shards a.toml --size 8 --shard 4 --maps height -o parts",
        ] {
            assert_refused(&ends(&folder, line), 1, part, line);
        }
    }
    let line = "dapple info /dev/zero";
    assert_refused(&ends(&folder, line), 1, "/dev/zero is a device", line);
    // What never begins like an image is not read to its end, which it may not have.
    for line in [
        "dapple info - </dev/zero",
        "sh -c 'cat /dev/zero | dapple info /dev/stdin'",
    ] {
        assert_refused(&ends(&folder, line), 1, "of no format that is known", line);
    }
    // A pipe on the command line is what the user has made.
    let line = "sh -c 'cat photo.png | dapple info /dev/stdin'";
    assert_done(&ends(&folder, line), line);
}

#[test]
fn a_list_of_absurd_sizes_is_refused_at_once() {
    let folder = Folder::new("absurd");
    let line = "dapple shards flagstone --size 32 --shard 16 --maps height -o parts";
    assert_done(&folder.shell(line), line);
    let path = folder.path("parts/shards.json");
    let list: serde_json::Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
    for (key, value, part) in [
        (
            "size",
            serde_json::json!([1_000_000, 1_000_000]),
            "3906250000 files of shards, but the limit is 1048576",
        ),
        ("size", serde_json::json!([u32::MAX, 1]), "268435456 files"),
        ("frames", serde_json::json!(u32::MAX), "17179869180 files"),
        ("maps", serde_json::json!([]), "no maps"),
        ("sha256", serde_json::json!("../../../.."), "no checksum"),
        ("size", serde_json::json!([0, 16]), "shards.json"),
        // Within the limit, with folders that are not there.
        (
            "size",
            serde_json::json!([16, 16_700_000]),
            "files are missing",
        ),
    ] {
        let mut bad = list.clone();
        bad[key] = value;
        fs::write(&path, bad.to_string()).unwrap();
        let line = "dapple join parts/ -o a.png";
        assert_refused(&ends(&folder, line), 1, part, key);
    }
    let line = "dapple shards flagstone --size 1000000 --shard 1 --maps height -o more";
    assert_refused(&ends(&folder, line), 2, "the limit is 1048576", line);
    assert!(!folder.path("more").exists(), "nothing is made");
}

#[test]
fn outputs_in_very_many_missing_folders_are_refused_at_once() {
    let folder = Folder::new("deep");
    let deep = "a/".repeat(2000);
    for line in [
        format!("dapple worley --size 8 -o {deep}b.png"),
        format!("dapple shards flagstone --size 8 --shard 8 --maps height -o {deep}"),
    ] {
        assert_refused(
            &ends(&folder, &line),
            2,
            "64 folders that do not exist",
            "deep",
        );
        assert_eq!(folder.names(), [""; 0], "nothing is made");
    }
    let deep = "a/".repeat(64);
    let line = format!("dapple worley --size 8 -o {deep}b.png");
    assert_done(&ends(&folder, &line), "as deep as possible");
}

#[test]
fn texts_of_others_do_not_reach_the_terminal_as_commands() {
    let folder = Folder::with_inputs("escapes");
    let recipe =
        "dapple = 1\nname = \"a\"\n[nodes.a.worley]\n[material]\nheight = \"zz\\u001b[5m\"\n";
    fs::write(folder.path("a.toml"), recipe).unwrap();
    fs::rename(folder.path("sand.png"), folder.path("a\u{1b}[31mred.png")).unwrap();
    fs::write(folder.path("b\u{9b}.obj"), "v 0 0\n").unwrap();
    let lines = [
        &[
            "bake", "a.toml", "--size", "8", "--maps", "height", "-o", "a.png",
        ][..],
        &["info", "a\u{1b}[31mrde.png"],
        &["info", "a\u{1b}[31mred.png"],
        &["info", "b\u{9b}.obj"],
        &["tile", "a\u{1b}[31mred.png", "--report"],
        &["tile", "a\u{1b}[31mred.png", "-o", "c\u{1b}.png"],
    ];
    for line in lines {
        let output = folder.run(line);
        let text = stdout(&output) + &stderr(&output);
        let odd = text.find(|c: char| c.is_control() && c != '\n');
        assert_eq!(odd, None, "{line:?}: {text:?}");
        assert!(
            text.contains("\\u{"),
            "{line:?}: the code is printed: {text}"
        );
    }
}
