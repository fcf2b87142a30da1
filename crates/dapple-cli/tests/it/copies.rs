//! Tests of maps of varied copies, and of sets of tiles.

use crate::support::{Folder, assert_done, assert_refused};
use dapple::hash::Seed;
use dapple::image::{Depth, Limits, read_image, write_gray_exr, write_gray_png};
use dapple::raster::glam::DVec2;
use dapple::raster::{Field as _, Raster, Window};
use dapple::tile::{BorderSource, CornerTiles, Disturbance, Map, MatchBorders};
use dapple::worley::{Combination, Worley2};
use std::fs;

/// Writes a repeating tile of cracks as `name.exr` and `name.png`, and returns it.
fn write(folder: &Folder, name: &str, seed: u64) -> Raster<f32> {
    let worley = Worley2::new(Seed(seed)).with_period([Some(5); 2]).unwrap();
    let cracks = worley
        .combine(Combination::F2_MINUS_F1)
        .normalized()
        .unwrap();
    let extent = DVec2::splat(5.0);
    let window = Window::new(DVec2::ZERO, extent, [48; 2]).unwrap();
    let tile = cracks.to_raster(&window).unwrap();
    write_gray_exr(folder.path(&format!("{name}.exr")), &tile).unwrap();
    write_gray_png(folder.path(&format!("{name}.png")), &tile, Depth::Eight).unwrap();
    tile
}

fn read(folder: &Folder, name: &str) -> Raster<f32> {
    let image = read_image(folder.path(name), &Limits::default());
    image.unwrap().gray().unwrap()
}

fn run(folder: &Folder, line: &str) {
    assert_done(&folder.run(&line.split(' ').collect::<Vec<_>>()), line);
}

/// Returns the raster of the only map, which must have one number per pixel.
fn value(maps: Vec<Map>) -> Raster<f32> {
    match maps.into_iter().next() {
        Some(Map::Value(raster)) => raster,
        other => panic!("{other:?}"),
    }
}

#[test]
fn maps_of_copies_are_what_the_library_makes() {
    let folder = Folder::new("copies");
    let tiles = [1, 2, 3].map(|seed| write(&folder, &format!("t{seed}"), seed));
    let maps = tiles.each_ref().map(|tile| vec![Map::Value(tile.clone())]);
    let size = [144, 96];

    run(&folder, "copies t1.exr --size 144x96 --seed 9 -o a.exr");
    let disturbance = Disturbance {
        frozen: 4,
        margin: 12,
        seed: Seed(9),
    };
    let expected = disturbance.render(&tiles[0], [0, 0], size).unwrap();
    assert_eq!(read(&folder, "a.exr"), expected);

    run(
        &folder,
        "copies t1.exr t2.exr t3.exr --size 144x96 --seed 9 -o b.exr",
    );
    let set = CornerTiles::new(&maps).unwrap().with_width(0.75).unwrap();
    let periodic = set.clone().with_period([Some(3), Some(2)]).unwrap();
    let expected = periodic.render(Seed(9), [0, 0], size).unwrap();
    assert_eq!(read(&folder, "b.exr"), value(expected));

    let line = "copies t1.exr t2.exr --method borders --width 16 --source middle --size 144x96";
    run(&folder, &format!("{line} --seed 9 -o c.exr"));
    let borders = MatchBorders {
        width: 16,
        source: BorderSource::Middle,
    };
    let expected = borders.render(&maps[..2], Seed(9), [0, 0], size).unwrap();
    assert_eq!(read(&folder, "c.exr"), value(expected));
}

#[test]
fn sets_of_tiles_are_files_that_fit() {
    let folder = Folder::new("sets");
    let tiles = [1, 2].map(|seed| write(&folder, &format!("t{seed}"), seed));
    run(&folder, "copies t1.exr t2.exr --tiles --format exr -o set/");
    let set = CornerTiles::new(&tiles.each_ref().map(|tile| vec![Map::Value(tile.clone())]));
    let set = set.unwrap().with_width(0.75).unwrap();
    for (name, colors) in [
        ("1111", [0; 4]),
        ("2111", [1, 0, 0, 0]),
        ("1221", [0, 1, 1, 0]),
    ] {
        let expected = value(set.tile(colors).unwrap());
        assert_eq!(read(&folder, &format!("set/copies_{name}.exr")), expected);
    }
    let n_files = fs::read_dir(folder.path("set")).unwrap().count();
    assert_eq!(n_files, 16);

    run(
        &folder,
        "copies t1.exr t2.exr --method borders --tiles --name b --format exr -o all/",
    );
    assert_eq!(
        read(&folder, "all/b_1.exr"),
        tiles[0],
        "the first one keeps its borders"
    );
    assert_eq!(read(&folder, "all/b_2.exr").row(0), tiles[0].row(0));
}

#[test]
fn all_maps_of_a_tile_are_cut_alike() {
    let folder = Folder::new("copied-maps");
    for seed in [1, 2] {
        write(&folder, &format!("t{seed}"), seed);
    }
    for (tiles, name) in [
        ("t1.png,height=t1.png", "one"),
        ("t1.png,height=t1.png t2.png,height=t2.png", "two"),
    ] {
        run(
            &folder,
            &format!("copies {tiles} --size 96 --name {name} -o out/"),
        );
        let [base, height] =
            ["base", "height"].map(|map| read(&folder, &format!("out/{name}_{map}.png")));
        assert_eq!(base, height, "{tiles}");
    }
}

#[test]
fn maps_are_named_by_an_option_or_behind_commas() {
    let folder = Folder::with_inputs("maps");
    for (command, options) in [
        ("copies", &["--size", "32"][..]),
        ("blend", &["--weighting", "given"]),
        ("tile", &["--method", "periodic"]),
    ] {
        let (commas, option): (Vec<&str>, Vec<&str>) = match command {
            "tile" => (
                vec!["rock.png", "--normal", "normal.png"],
                vec!["rock.png", "--map", "normal=normal.png"],
            ),
            _ => (
                vec![
                    "rock.png,normal=normal.png",
                    "sand.png,normal=rock_normal.png",
                ],
                vec![
                    "rock.png",
                    "sand.png",
                    "--map",
                    "normal=normal.png",
                    "--map",
                    "normal=rock_normal.png",
                ],
            ),
        };
        for (arguments, output) in [(commas, "commas"), (option, "option")] {
            let output = format!("{command}-{output}/");
            let arguments = [&[command], &arguments[..], options, &["-o", &output]].concat();
            assert_done(&folder.run(&arguments), command);
        }
        let files = |way: &str| -> Vec<_> {
            let entries = fs::read_dir(folder.path(&format!("{command}-{way}"))).unwrap();
            let mut files: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
            files.sort();
            files
                .iter()
                .map(|file| {
                    (
                        file.file_name().unwrap().to_owned(),
                        fs::read(file).unwrap(),
                    )
                })
                .collect()
        };
        assert_eq!(files("commas"), files("option"), "{command}");
        assert!(files("option").len() >= 2, "{command}");
    }
}

#[test]
fn maps_that_belong_to_no_image_are_refused() {
    let folder = Folder::with_inputs("maps-bad");
    for (maps, part) in [
        (
            &[
                "rock.png",
                "--map",
                "normal=normal.png",
                "--map",
                "normal=normal.png",
            ][..],
            "2 times, but the number of images is 1",
        ),
        (
            &["rock.png,normal=normal.png", "--map", "normal=normal.png"],
            "has normal twice",
        ),
        (
            &["rock.png", "--map", "normal.png"],
            "is not a map: give NAME=FILE",
        ),
    ] {
        let arguments = [&["copies"], maps, &["--size", "32", "-o", "no/"]].concat();
        assert_refused(&folder.run(&arguments), 2, part, part);
    }
}
