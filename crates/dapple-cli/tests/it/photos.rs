//! Tests of photographs: rectification by four corners, and estimated materials.

use crate::support::{Folder, assert_done, assert_refused, read_gray};
use dapple::color::{
    HeightPlane, LinearRgb, NormalOptions, OcclusionOptions, ambient_occlusion, normal_map,
};
use dapple::image::{Limits, read_image};
use dapple::raster::Raster;
use dapple::raster::glam::DVec2;
use dapple::tile::{EstimateOptions, Map, Method, Seamless, SoftCut, estimate_material, rectify};

const CORNERS: [[f64; 2]; 4] = [[8.0, 4.0], [60.0, 0.0], [62.0, 63.5], [3.0, 58.0]];
const CORNERS_TEXT: &str = "8,4,60,0,62,63.5,3,58";

fn read_colors(folder: &Folder, name: &str) -> Raster<LinearRgb> {
    let image = read_image(folder.path(name), &Limits::default()).unwrap();
    image.color().unwrap()
}

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
        for command in ["tile", "photo"] {
            let output = folder.run(&[command, "photo.png", "--rectify", corners, "-o", "out/"]);
            assert_refused(&output, 2, part, corners);
        }
    }
    let with_normals = [
        "tile",
        "photo.png",
        "--map",
        "normal=normal.png",
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

#[test]
fn photo_cuts_all_maps_alike_and_takes_normals_from_the_heights_of_the_tile() {
    let folder = Folder::with_inputs("photo");
    let arguments = [
        "photo",
        "grass.png",
        "--maps",
        "all",
        "--format",
        "exr",
        "-o",
        "out/",
    ];
    assert_done(&folder.run(&arguments), "photo");
    let photo = read_colors(&folder, "grass.png");
    let estimate = estimate_material(&photo, &EstimateOptions::default()).unwrap();
    let maps = [
        Map::Color(estimate.albedo),
        Map::Value(estimate.height),
        Map::Value(estimate.roughness),
    ];
    let seamless = Seamless::new(Method::SoftCut(SoftCut::default()));
    let tiles = seamless.apply_maps(&maps).unwrap();
    let [
        Map::Color(albedo),
        Map::Value(height),
        Map::Value(roughness),
    ] = tiles.as_slice()
    else {
        panic!("the kinds stay");
    };
    assert_eq!(read_colors(&folder, "out/grass_albedo.exr"), *albedo);
    assert_eq!(read_gray(&folder, "out/grass_height.exr"), *height);
    assert_eq!(read_gray(&folder, "out/grass_roughness.exr"), *roughness);
    // Normals and occlusion follow from the heights of the tile, which repeat. A unit is the shorter side.
    let size = height.size();
    let shorter = f64::from(size[0].min(size[1]));
    let plane = HeightPlane {
        strength: estimate.relief / shorter,
        extent: DVec2::new(size[0].into(), size[1].into()) / shorter,
        ..HeightPlane::default()
    };
    let normals = normal_map(height, &NormalOptions::from(plane)).unwrap();
    let written = read_colors(&folder, "out/grass_normal.exr");
    for (normal, color) in normals.pixels().iter().zip(written.pixels()) {
        let components = [color.r, color.g, color.b].map(|code| 2.0 * code - 1.0);
        for (component, expected) in components.into_iter().zip(normal.to_array()) {
            // A file with components from 0 to 1 rounds once.
            assert!(
                (component - expected).abs() < 1e-6,
                "{component} {expected}"
            );
        }
    }
    let options = OcclusionOptions {
        radius: 0.05,
        ..plane.into()
    };
    let seen = ambient_occlusion(height, &options).unwrap();
    assert_eq!(read_gray(&folder, "out/grass_ao.exr"), seen);
    assert!(
        seen.statistics().deviation > 0.001,
        "the heights hide the sky"
    );
}

#[test]
fn photo_writes_presets_and_previews() {
    let folder = Folder::with_inputs("photo-preset");
    let arguments = [
        "photo",
        "stones.png",
        "--preset",
        "unreal",
        "--size",
        "32",
        "--preview",
        "-o",
        "out/",
    ];
    assert_done(&folder.run(&arguments), "photo");
    let files = ["BaseColor", "Normal", "ORM", "Height", "preview"];
    for part in files {
        let name = format!("out/T_stones_{part}.png");
        let size = read_image(folder.path(&name), &Limits::default())
            .unwrap()
            .size();
        let side = if part == "preview" { 512 } else { 32 };
        assert_eq!(size, [side; 2], "{name}");
    }
    let whole = ["photo", "stones.png", "-o", "stones.glb"];
    assert_done(&folder.run(&whole), "photo");
    assert!(folder.path("stones.glb").is_file());
}

#[test]
fn photo_refuses_bad_options_and_images() {
    let folder = Folder::with_inputs("photo-bad");
    for (options, part) in [
        (
            &["photo.png", "--slope", "11"][..],
            "slope is 11, but it must be from 0 to 10",
        ),
        (
            &["photo.png", "--even", "0.5"],
            "radius of the light is 0.5",
        ),
        (
            &["photo.png", "--light", "-361"],
            "direction of the light is -361",
        ),
        (&["photo.png", "--margin", "60"], "margin"),
        (&["photo.png", "--levels", "2"], "--levels has no effect"),
        (&["leaves.png"], "partly transparent"),
        (&["my-rock.toml"], "my-rock.toml"),
    ] {
        let output = folder.run(&[&["photo"], options, &["-o", "out/"]].concat());
        assert_ne!(output.status.code(), Some(0), "{options:?}");
        assert!(
            crate::support::stderr(&output).contains(part),
            "{options:?}: {}",
            crate::support::stderr(&output)
        );
    }
    assert!(!folder.path("out").exists(), "no files are left");
}
