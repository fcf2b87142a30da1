//! Tests of the written files, and of the protection against overwriting.

use crate::support::{Folder, assert_done, assert_refused, stderr, stdout};
use dapple::image::{Image, Limits, decode_image, read_image};
use std::fs;
use std::process::Stdio;

/// Command lines that each write one file, and the name of that file.
const WRITERS: [(&str, &[&str]); 7] = [
    ("out.png", &["tile", "photo.png", "-o", "out.png"]),
    (
        "out.png",
        &["copies", "photo.png", "--size", "16", "-o", "out.png"],
    ),
    (
        "out.png",
        &["blend", "rock.png", "grass.png", "-o", "out.png"],
    ),
    ("out.exr", &["blend-map", "stones.png", "-o", "out.exr"]),
    (
        "out.png",
        &["synth", "checker.png", "--size", "16", "-o", "out.png"],
    ),
    ("out.csv", &["points", "--count", "20", "-o", "out.csv"]),
    ("out.json", &["info", "photo.png", "-o", "out.json"]),
];

#[test]
fn nothing_is_overwritten_without_force() {
    let folder = Folder::with_inputs("force");
    for (name, arguments) in WRITERS {
        let what = arguments.join(" ");
        fs::write(folder.path(name), b"mine").unwrap();
        assert_refused(&folder.run(arguments), 1, "--force", &what);
        assert_eq!(fs::read(folder.path(name)).unwrap(), b"mine", "{what}");
        let forced = [arguments, &["--force"]].concat();
        assert_done(&folder.run(&forced), &what);
        assert_ne!(fs::read(folder.path(name)).unwrap(), b"mine", "{what}");
    }
    let temporary = folder
        .names()
        .into_iter()
        .find(|name| name.ends_with(".part"));
    assert_eq!(temporary, None, "no temporary file is left");
}

#[test]
fn one_file_of_several_in_the_way_stops_all() {
    let folder = Folder::with_inputs("several");
    fs::create_dir(folder.path("tiles")).unwrap();
    fs::write(folder.path("tiles/height.png"), b"mine").unwrap();
    let output = folder.run(&["tile", "photo.png", "height.png", "-o", "tiles/"]);
    assert_refused(&output, 1, "height.png exists already", "tile");
    assert!(
        !folder.path("tiles/photo.png").exists(),
        "the other was not written"
    );
}

#[test]
fn standard_output_gets_the_same_bytes_as_a_file() {
    let folder = Folder::with_inputs("stdout");
    for (name, arguments) in &WRITERS[..6] {
        let what = arguments.join(" ");
        assert_done(&folder.run(&[arguments, &["--force"][..]].concat()), &what);
        let mut piped: Vec<_> = arguments.to_vec();
        let last = piped.len() - 1;
        piped[last] = "-";
        if name.ends_with("exr") {
            piped.extend(["--format", "exr"]);
        }
        let output = folder.run(&piped);
        assert_done(&output, &what);
        assert_eq!(
            output.stdout,
            fs::read(folder.path(name)).unwrap(),
            "{what}"
        );
    }
}

#[test]
fn reports_do_not_mix_with_an_image_on_standard_output() {
    let folder = Folder::with_inputs("mix");
    let output = folder.run(&["tile", "photo.png", "--report", "-o", "-"]);
    assert_done(&output, "tile");
    assert!(
        decode_image(&output.stdout, &Limits::default()).is_ok(),
        "an image alone"
    );
    assert!(
        String::from_utf8_lossy(&output.stderr).contains("seam ratio"),
        "the report"
    );
}

#[test]
fn an_image_comes_from_standard_input() {
    let folder = Folder::with_inputs("stdin");
    let mut command = folder.command(&["info", "-", "--format", "json"]);
    command.stdin(Stdio::from(
        fs::File::open(folder.path("photo.png")).unwrap(),
    ));
    let output = command.output().unwrap();
    assert_done(&output, "info");
    assert!(
        stdout(&output).contains("standard input"),
        "{}",
        stdout(&output)
    );
}

#[test]
fn formats_follow_the_ending_and_what_is_written() {
    let folder = Folder::with_inputs("formats");
    for (input, output, extra, bits) in [
        ("photo.png", "a.png", &[][..], Some(8)),
        ("height.png", "b.png", &[], Some(16)),
        ("photo.png", "c.png", &["--format", "png16"], Some(16)),
        ("height.png", "d.png", &["--format", "png8"], Some(8)),
        ("photo.png", "e.exr", &[], None),
        ("height.exr", "f.png", &["--ramp", "lagoon"], Some(16)),
    ] {
        let arguments = [&["tile", input, "-o", output], extra].concat();
        assert_done(&folder.run(&arguments), output);
        let image = read_image(folder.path(output), &Limits::default()).unwrap();
        match image {
            Image::Codes(..) => {
                let info = stdout(&folder.run(&["info", output]));
                let expected = format!("{} bits per channel", bits.unwrap_or(0));
                assert!(info.contains(&expected), "{output}: {info}");
            }
            _ => assert_eq!(bits, None, "{output} is EXR"),
        }
    }
}

#[test]
fn the_sidecar_tells_how_to_do_it_again() {
    let folder = Folder::with_inputs("sidecar");
    let arguments = [
        "synth",
        "checker.png",
        "--size",
        "16",
        "--seed",
        "5",
        "-o",
        "a.png",
        "--json",
    ];
    assert_done(&folder.run(&arguments), "synth");
    let text = fs::read_to_string(folder.path("a.json")).unwrap();
    let sidecar: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(sidecar["dapple"], env!("CARGO_PKG_VERSION"));
    assert_eq!(sidecar["command"], "synth");
    assert_eq!(sidecar["options"]["matching"]["seed"], 5, "{text}");
    let output = &sidecar["outputs"][0];
    assert_eq!(output["size"], serde_json::json!([16, 16]), "{text}");
    let length = fs::metadata(folder.path("a.png")).unwrap().len();
    assert_eq!(output["bytes"], length, "{text}");
    assert_eq!(output["sha256"].as_str().map(str::len), Some(64), "{text}");
    // The same arguments give the same bytes.
    let again = folder.run(&[
        "synth",
        "checker.png",
        "--size",
        "16",
        "--seed",
        "5",
        "-o",
        "-",
    ]);
    assert_eq!(again.stdout, fs::read(folder.path("a.png")).unwrap());
}

#[cfg(unix)]
#[test]
fn a_reader_that_goes_away_is_no_error() {
    let folder = Folder::new("pipe");
    let output = folder.shell("TMPDIR=. dapple points white --count 200000 | head -n 1");
    assert_done(&output, "a pipe");
    assert_eq!(stdout(&output), "x,y\n");
    assert_eq!(
        String::from_utf8_lossy(&output.stderr),
        "",
        "nothing is said"
    );
    assert_eq!(folder.names(), Vec::<String>::new(), "nothing is left");
}

#[cfg(unix)]
#[test]
fn what_is_thrown_away_was_written() {
    let folder = Folder::with_inputs("away");
    // Programs open the null device for reading, too, to throw away an output: Python's `DEVNULL`, for example. A closed
    // output cannot be told from it, since the null device is opened in its place when a process begins.
    for away in [">/dev/null", "1<>/dev/null", ">&-"] {
        let output = folder.shell(&format!("dapple tile photo.png -o - {away}"));
        assert_done(&output, away);
        let output = folder.shell(&format!("dapple info photo.png --check {away}"));
        assert_eq!(output.status.code(), Some(3), "{away}: {}", stderr(&output));
    }
}

#[test]
fn a_document_comes_after_the_files_that_it_names() {
    let folder = Folder::new("document");
    let line = "bake flagstone --size 16 -o a.mtlx";
    assert_done(&folder.run(&line.split(' ').collect::<Vec<_>>()), line);
    let n_images = folder.names().len() - 1;
    for name in folder.names() {
        fs::remove_file(folder.path(&name)).unwrap();
    }
    // Over a file system that fails at an image, the document is not there.
    fs::create_dir(folder.path("b_height.png")).unwrap();
    let output = folder.run(&["bake", "flagstone", "--size", "16", "-o", "b.mtlx"]);
    assert_refused(&output, 1, "b_height.png", "a folder in the way");
    assert_eq!(folder.names(), ["b_height.png"], "{n_images} images before");
}

#[cfg(unix)]
#[test]
fn a_full_disk_is_told_with_the_name_of_the_file() {
    let folder = Folder::new("full");
    // No file may have more than a few blocks; without the signal, writing fails as on a full disk.
    let line = "trap '' XFSZ; ulimit -f 8; dapple bake flagstone --size 256 --maps height -o h.exr";
    for line in [
        line,
        &line
            .replace("bake flagstone", "worley")
            .replace("--maps height", ""),
    ] {
        assert_refused(&folder.shell(line), 1, "h.exr cannot be written", line);
        assert_eq!(folder.names(), [""; 0], "{line} leaves nothing");
    }
}
