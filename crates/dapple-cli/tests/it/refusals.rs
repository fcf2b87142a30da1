//! Tests of errors: inputs that are missing, empty, directories, unreadable or of another kind, and invalid outputs.

use crate::support::{Folder, assert_refused, stderr, stdout};
use dapple::color::LinearRgb;
use dapple::image::{Depth, write_color_png};
use dapple::raster::Raster;
use std::fs;

/// Command lines of each subcommand that reads a file. `INPUT` stands for the file under test; all other inputs exist.
const READERS: [&str; 24] = [
    "bake INPUT -o out/ --size 8",
    "pups control --points INPUT --size 8 -o out.png",
    "pups reference --reference INPUT --size 8 -o out.png",
    "tile INPUT -o out.png",
    "tile photo.png --normal INPUT -o out/",
    "tile INPUT --report",
    "copies INPUT --size 16 -o out.png",
    "copies rock.png,normal=INPUT grass.png,normal=normal.png --size 16 -o out/",
    "blend INPUT grass.png -o out.png",
    "blend rock.png grass.png,weight=INPUT -o out.png",
    "blend rock.png,height=INPUT grass.png,height=height.png -o out.png",
    "blend rock.png grass.png --tile INPUT -o out.png",
    "blend-map INPUT -o out.png",
    "synth INPUT --size 16 -o out.png",
    "synth checker.png --detail INPUT --size 16 -o out.png",
    "synth checker.png --map roughness=INPUT --size 16 -o out.png",
    "synth checker.png --example INPUT --size 16 -o out.png",
    "synth checker.png --example rock.png --which INPUT -o out.png",
    "synth checker.png --guide INPUT -o out.png",
    "synth checker.png --guide photo.png --guide-of INPUT -o out.png",
    "synth checker.png --mesh INPUT --sites 500 -o out.glb",
    "synth checker.png --mesh model.obj --directions INPUT --sites 500 -o out.glb",
    "points variable --density INPUT --count 50 -o out.csv",
    "info INPUT",
];

/// Invalid command lines that clap does not detect.
const WRONG: [&str; 53] = [
    "bake flagstone --frames 2 --flipbook 2x1 -o out/",
    "bake flagstone --flipbook 2x1 -o rock.glb",
    "bake flagstone --samples corners --sheet -o out/",
    "bake flagstone --samples corners -o rock.glb",
    "noise --samples corners --size 1x5 -o out.png",
    "bake flagstone -o out.png --name rock",
    "bake flagstone --frames 2 -o rock.glb",
    "bake flagstone --frames 2 --maps height -o -",
    "bake flagstone --frames 2 --json=all.json -o out/",
    "bake flagstone --frames 2 --frame 1/2 -o out/",
    "pups cow --motion nan -o out.png",
    "pups cow --motion 2 -o out.png",
    "bake flagstone",
    "bake flagstone --maps height,height -o out/",
    "worley --size 100x64 -o out.png",
    "worley --frames 3 -o -",
    "wavelet --cells 5 -o out.png",
    "wavelet --size 640x480 -o out.png",
    "pups noise --octaves 3 -o out.png",
    "pups color-noise --ramp ember -o out.png",
    "tile photo.png",
    "tile -o out.png",
    "tile photo.png -o out.jpg",
    "tile photo.png -o out.png --format exr",
    "tile photo.png -o out.png --levels 2",
    "tile photo.png -o out.png --wrap none",
    "tile photo.png height.png -o -",
    "tile photo.png --sheet -o -",
    "tile photo.png --json -o -",
    "copies photo.png --tiles -o out/",
    "copies photo.png --size 64 --width 8 -o out.png",
    "copies photo.png --size 64 --method corners -o out.png",
    "copies photo.png grass.png --size 64 --method disturb -o out.png",
    "copies photo.png rock.png grass.png sand.png stones.png --size 64 --method corners -o out.png",
    "copies rock.png grass.png,normal=normal.png --size 64 -o out/",
    "copies rock.png grass.png,weight=0.5 --size 64 -o out.png",
    "blend rock.png grass.png,normal=normal.png -o out/",
    "blend rock.png grass.png --weighting mask -o out.png",
    "blend rock.png grass.png --sharpness 2 -o out.png",
    "synth checker.png --sites 100 -o out.png",
    "synth checker.png --mesh model.obj --size 64 -o out.glb",
    "synth photo.png --mesh model.obj --repair scratch.png -o out.glb",
    "synth photo.png --repair scratch.png --size 64 -o out.png",
    "synth photo.png --which scratch.png -o out.png",
    "synth photo.png --guide-weight 2 -o out.png",
    "synth photo.png --guide rock.png --size 64 -o out.png",
    "synth photo.png --guide rock.png --guide-blur 65 -o out.png",
    "synth photo.png --example rock.png --region 0,0,32,32 -o out.png",
    "synth photo.png --example rock.png --map height=height.png --size 16 -o out.png",
    "tile photo.png --seed 3 -o out.png",
    "synth checker.png --mesh model.obj -o out.nothing",
    "points white --radius 0.1",
    "points --count 5 -o out.svg",
];

/// Command lines with a value that a library rejects, and a substring of the error message.
const LIMITS: [(&str, &str); 31] = [
    ("bake flagston -o out/", "flagstone"),
    (
        "bake flagstone --region 60,0,8,8 --size 64 -o out/",
        "region",
    ),
    ("bake craters --size 1000000 -o out/", "hint: add --banded"),
    (
        "bake craters --size 1000000 --maps height,normal -o out/",
        "2 maps of 1000000 × 1000000 pixels: 8.00 TB before compression, about ",
    ),
    ("bake stone-and-grass --banded --size 64 -o out/", "whole"),
    ("bake flagstone --relief 1e300 -o out/", "from -1e6 to 1e6"),
    ("bake flagstone --relief nan -o out/", "--relief nan: "),
    ("bake flagstone --relief inf -o out/", "--relief inf: "),
    (
        "tile dot.png --method synth --threads 1 -o out.png",
        "error: the side of the exemplar is 1, ",
    ),
    (
        "worley --threads 3 --gain 3 --octaves 2 -o out.png",
        "--gain 3: ",
    ),
    ("worley --density 1000 -o out.png", "--density 1000: "),
    ("pups cow --spacing 0 -o out.png", "--spacing 0: "),
    ("worley --octaves 2 --gain -3 -o out.png", "--gain -3: "),
    (
        "tile photo.png --method soft-cut --margin 40 -o out.png",
        "margin",
    ),
    (
        "copies photo.png --size 64 --margin 200 -o out.png",
        "--margin",
    ),
    (
        "copies photo.png grass.png --size 64 --share 3 -o out.png",
        "--share 3: ",
    ),
    (
        "copies photo.png rock.png --size 64 --method borders --width 90 -o out.png",
        "--width",
    ),
    ("tile photo.png --region 60,0,8,8 -o out.png", "photo.png"),
    (
        "tile photo.png --method spline --levels 9 -o out.png",
        "--levels",
    ),
    (
        "blend photo.png grass.png --mixing pyramid --levels 20 -o out.png",
        "--levels",
    ),
    (
        "blend-map photo.png --feature-size 0 -o out.png",
        "--feature-size 0: ",
    ),
    ("synth checker.png --levels 9 -o out.png", "--levels"),
    (
        "synth photo.png --guide rock.png --guide-weight 0 -o out.png",
        "weight of a plane",
    ),
    (
        "synth photo.png --guide rock.png --guide-of checker.png -o out.png",
        "--guide-of",
    ),
    (
        "tile photo.png --method synth --margin 40 -o out.png",
        "--margin",
    ),
    ("points --radius 3", "--radius 3: "),
    ("points --radius 0", "--radius 0: "),
    ("points nested --radii 0.1,0.2", "radius"),
    (
        "blend rock.png grass.png --depth 0.1 -o out.png",
        "--depth has no effect on this blend\nhint: add --weighting height",
    ),
    (
        "copies photo.png --size 64 --share 0.5 -o out.png",
        "hint: add --method corners",
    ),
    (
        "blend rock.png grass.png --tile cracks.png --gain inf -o out.png",
        "--gain must be finite",
    ),
];

/// Command lines whose input files do not match each other, and a substring of the error message.
const UNLIKE: [(&str, &str); 9] = [
    ("tile photo.png checker.png -o out/", CHECKER),
    ("blend photo.png checker.png -o out.png", CHECKER),
    ("blend photo.png checker.png -o out.png", "hint: --size"),
    (
        "blend photo.png grass.png,weight=checker.png -o out.png",
        CHECKER,
    ),
    ("copies photo.png checker.png --size 64 -o out.png", CHECKER),
    (
        "copies photo.png checker.png --size 64 -o out.png",
        "32 × 32 pixels, but",
    ),
    (
        "synth photo.png --map cover=checker.png --size 16 -o out.png",
        CHECKER,
    ),
    ("synth photo.png --repair checker.png -o out.png", CHECKER),
    (
        "synth rock.png --example sand.png --which photo.png --guide checker.png -o out.png",
        CHECKER,
    ),
];

/// Error message with the names and sizes of both files.
const CHECKER: &str = "checker.png has 32 × 32 pixels, but photo.png has 64 × 64";

/// Command lines that clap rejects, and a substring of the error message.
const SLIPS: [(&str, &str); 10] = [
    ("worley --frequency 8 -o out.png", "--cells"),
    ("worley --scale=8 -o out.png", "--cells"),
    ("wavelet --Frequency 8 -o out.png", "--cells"),
    ("pups cow --scale 3 -o out.png", "--spacing"),
    ("tile photo.png --axes x -o out.png", "--wrap"),
    (
        "bake flagstone --maps heigth -o out/",
        "did you mean height",
    ),
    (
        "worley --value f2-minus-f -o out.png",
        "did you mean f2_minus_f1",
    ),
    ("worley --seed -1 -o out.png", "not negative"),
    ("points --seed -1", "not negative"),
    (
        "blend rock.png grass.png,weigth=0.3 -o out.png",
        "did you mean weight?",
    ),
];

/// Splits a line into words.
fn words(line: &str) -> Vec<&str> {
    line.split(' ').collect()
}

/// Uses `input` as the input of every subcommand that reads a file. Checks the error messages, and that no files are
/// left.
fn try_all(name: &str, input: &str, part: &str) {
    let folder = Folder::with_inputs(name);
    fs::write(folder.path("empty.png"), b"").unwrap();
    fs::create_dir(folder.path("folder.png")).unwrap();
    fs::write(folder.path("text.png"), b"neither an image nor a mesh").unwrap();
    fs::write(folder.path("broken.obj"), b"v 0 0\nf 1 2 3\n").unwrap();
    let before = folder.names();
    for line in READERS {
        let line = line.replace("INPUT", input);
        assert_refused(&folder.run(&words(&line)), 1, part, &line);
        assert_eq!(folder.names(), before, "{line} leaves nothing");
    }
}

#[test]
fn missing_inputs_are_named() {
    try_all("missing", "none.png", "none.png: there is no such file");
}

#[test]
fn empty_inputs_are_named() {
    try_all("empty", "empty.png", "empty.png is empty");
}

#[test]
fn folders_as_inputs_are_named() {
    try_all("folders", "folder.png", "folder.png is a folder");
}

#[test]
fn inputs_of_another_kind_are_named() {
    try_all("kinds", "text.png", "text.png");
    try_all("meshes", "broken.obj", "broken.obj");
}

#[cfg(unix)]
#[test]
fn unreadable_inputs_are_named() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::with_inputs("unreadable");
    let path = folder.path("closed.png");
    fs::copy(folder.path("photo.png"), &path).unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o0)).unwrap();
    if fs::File::open(&path).is_ok() {
        eprintln!("skipped: this user may read everything");
        return;
    }
    for line in READERS {
        let line = line.replace("INPUT", "closed.png");
        assert_refused(&folder.run(&words(&line)), 1, "closed.png", &line);
    }
}

#[test]
fn a_slip_in_a_name_is_answered_with_the_name() {
    let folder = Folder::with_inputs("slip");
    let output = folder.run(&["info", "phoot.png"]);
    assert_refused(&output, 1, "hint: there is photo.png", "a slip");
}

#[test]
fn wrong_usage_exits_with_2() {
    let folder = Folder::with_inputs("usage");
    let before = folder.names();
    for line in WRONG {
        assert_refused(&folder.run(&words(line)), 2, "", line);
        assert_eq!(folder.names(), before, "{line} leaves nothing");
    }
    for arguments in [
        &["tile", "--size"][..],
        &["nothing"],
        &["points", "--seed", "-1"],
        &[],
    ] {
        let output = folder.run(arguments);
        assert_eq!(
            output.status.code(),
            Some(2),
            "{arguments:?}: {}",
            stderr(&output)
        );
    }
}

#[test]
fn values_that_a_library_refuses_are_wrong_usage_and_named_as_typed() {
    let folder = Folder::with_inputs("limits");
    let dot = Raster::filled([1, 1], LinearRgb::WHITE).unwrap();
    write_color_png(folder.path("dot.png"), &dot, Depth::Eight).unwrap();
    for (line, part) in LIMITS {
        let output = folder.run(&words(line));
        assert_refused(&output, 2, part, line);
        // Users who typed no recipe know no nodes.
        assert!(
            line.starts_with("bake") || !stderr(&output).contains("in the node"),
            "{line}: {}",
            stderr(&output)
        );
    }
    for (line, part) in UNLIKE {
        assert_refused(&folder.run(&words(line)), 2, part, line);
    }
}

#[test]
fn a_repair_is_promised_only_where_synth_makes_one() {
    let folder = Folder::with_inputs("promise");
    let points = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (faces, is_promised) in [
        ("", false),
        ("f 1 2 1\n", false),
        ("f 1 2 3\nf 1 2 3\n", true),
    ] {
        fs::write(folder.path("a.obj"), format!("{points}{faces}")).unwrap();
        let text = stdout(&folder.run(&["info", "a.obj"]));
        assert_eq!(text.contains("synth repairs it"), is_promised, "{text}");
        let line = "synth checker.png --mesh a.obj --sites 500 --force -o out.glb";
        let is_made = folder.run(&words(line)).status.success();
        assert_eq!(is_made, is_promised, "{faces:?}");
    }
    fs::write(folder.path("a.obj"), "Dear Sir,\n").unwrap();
    let output = folder.run(&["info", "a.obj"]);
    assert_refused(&output, 1, "not a valid OBJ file", "a letter");
}

#[test]
fn synth_and_info_say_what_is_not_used_of_a_mesh() {
    let folder = Folder::with_inputs("not-used");
    let quads = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n\
        vt 2 0\nvt 2 1\nusemtl a\nf 1/1 2/2 3/3 4/4\nf 2/2 5/5 6/6 3/3\n";
    fs::write(folder.path("u.obj"), format!("mtllib lost.mtl\n{quads}")).unwrap();
    fs::write(folder.path("a.mtl"), "newmtl a\nmap_Kd lost.png\n").unwrap();
    fs::write(folder.path("b.obj"), format!("mtllib a.mtl\n{quads}")).unwrap();
    fs::write(folder.path("c.mtl"), "newmtl a\nmap_Kd photo.png\n").unwrap();
    let colored = quads.replace("v 1 1 0\n", "v 1 1 0 1 0 0\n");
    fs::write(folder.path("c.obj"), format!("mtllib c.mtl\n{colored}")).unwrap();
    let squares = "2 unit squares (1001, 1002)";
    let library = "the material library lost.mtl, which cannot be read";
    for (line, parts) in [
        ("info u.obj", [library, squares]),
        (
            "synth photo.png --mesh u.obj --atlas uv --sites 500 --texture-size 32 -o u.glb",
            [library, squares],
        ),
        (
            "synth c.obj --mesh u.obj --sites 500 --texture-size 128 -o c.glb",
            [
                "c.obj: not used: the colors of vertices beside the texture",
                squares,
            ],
        ),
        (
            "synth b.obj --mesh u.obj --sites 500 --texture-size 128 -o b.glb",
            [
                "b.obj has neither a texture nor colors",
                "the texture lost.png, which cannot be read",
            ],
        ),
    ] {
        let words: Vec<_> = line.split(' ').collect();
        let run = folder.run(&words);
        let text = stdout(&run) + &stderr(&run);
        assert_eq!(
            run.status.success(),
            !line.contains("synth b.obj"),
            "{text}"
        );
        for part in parts {
            assert!(text.contains(part), "{line}: {text}");
        }
    }
    let line = "synth photo.png --mesh u.obj --sites 500 --texture-size 32 --quiet -o q.glb";
    let words: Vec<_> = line.split(' ').collect();
    assert_eq!(stderr(&folder.run(&words)), "");
}

#[test]
fn info_says_what_was_left_out_of_a_mesh() {
    let folder = Folder::new("left-out");
    fs::write(
        folder.path("a.obj"),
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1//1 2//2 3//3\n",
    )
    .unwrap();
    let text = stdout(&folder.run(&["info", "a.obj"]));
    assert!(text.contains("without normals that faces name"), "{text}");
    fs::write(
        folder.path("b.obj"),
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\nusemtl b\nf 3 2 1\n",
    )
    .unwrap();
    let text = stdout(&folder.run(&["info", "b.obj"]));
    assert!(
        text.contains("without the materials of faces but the first"),
        "{text}"
    );
}

#[test]
fn slips_are_answered_with_what_to_type() {
    let folder = Folder::with_inputs("slips");
    for (line, part) in SLIPS {
        assert_refused(&folder.run(&words(line)), 2, part, line);
    }
    assert!(!folder.path("out.png").exists(), "nothing is written");
}
