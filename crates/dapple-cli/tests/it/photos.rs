//! Photographs: rectified by four corners, and materials that are estimated from them.

use crate::support::{Folder, assert_done, assert_refused, read_gray};
use dapple::tile::{Map, Method, Seamless, SoftCut, rectify};

const CORNERS: [[f64; 2]; 4] = [[8.0, 4.0], [60.0, 0.0], [62.0, 63.5], [3.0, 58.0]];
const CORNERS_TEXT: &str = "8,4,60,0,62,63.5,3,58";

#[test]
fn tile_rectifies_before_it_cuts() {
    let folder = Folder::with_inputs("rectify");
    let rectified = [
        "tile",
        "height.exr",
        "--rectify",
        CORNERS_TEXT,
        "-o",
        "out.exr",
    ];
    assert_done(&folder.run(&rectified), "tile");
    let source = Map::Value(read_gray(&folder, "height.exr"));
    let flat = rectify(&source, CORNERS, None).unwrap();
    let seamless = Seamless::new(Method::SoftCut(SoftCut::default()));
    let expected = seamless.apply_maps(&[flat]).unwrap().remove(0);
    assert_eq!(Map::Value(read_gray(&folder, "out.exr")), expected);
}

#[test]
fn rectify_refuses_bad_corners_and_normals() {
    let folder = Folder::with_inputs("rectify-bad");
    for (corners, part) in [
        ("0,0,65,0,64,64,0,64", "corner 2 at (65, 0) is outside"),
        ("0,0,64,64,64,0,0,64", "clockwise around a convex"),
        ("0,0,64,0,10,10,0,64", "at corner 3"),
        ("1,2,3", "8 numbers"),
    ] {
        for command in ["tile"] {
            let output = folder.run(&[command, "photo.png", "--rectify", corners, "-o", "out/"]);
            assert_refused(&output, 2, part, corners);
        }
    }
    let with_normals = [
        "tile",
        "photo.png",
        "--normal", "normal.png",
        "--rectify",
        CORNERS_TEXT,
        "-o",
        "out/",
    ];
    assert_refused(
        &folder.run(&with_normals),
        2,
        "normals cannot be rectified",
        "normals",
    );
    let both = [
        "tile",
        "photo.png",
        "--region",
        "0,0,9,9",
        "--rectify",
        CORNERS_TEXT,
        "-o",
        "a.png",
    ];
    assert_refused(&folder.run(&both), 2, "cannot be used with", "region");
    assert!(!folder.path("out").exists(), "no files are left");
}
