//! Tests of the images that a session renders.

use crate::render_host::{Page, TestWorld, of_type, split};
use dapple::image::{Depth, Encoding, Image, Limits, PngPixels, RowWriter, decode_image};
use dapple::recipe::{Bake, BakeOptions, Images, MapKind, Plan, Recipe};
use dapple_studio::{Picture, Request, Shown};
use serde_json::json;
use std::io::Cursor;

fn view(size: u32, maps: &[&str], draft: bool) -> serde_json::Value {
    json!({ "type": "view", "size": [size, size], "maps": maps, "draft": draft, "paused": false })
}

/// Returns the pixels that a bake writes to an 8-bit PNG file.
fn baked(recipe: &str, kind: MapKind, side: u32) -> Vec<u8> {
    let plan = Plan::new(&Recipe::builtin(recipe).unwrap(), &Images::new(), 0.0).unwrap();
    let options = BakeOptions {
        size: [side; 2],
        maps: vec![kind],
        ..BakeOptions::default()
    };
    let (_, rows) = Bake::new(&plan, &options)
        .unwrap()
        .whole_maps()
        .unwrap()
        .remove(0);
    let sink = Cursor::new(Vec::new());
    let coding = Encoding::Png(Depth::Eight);
    let mut writer = RowWriter::new(sink, [side; 2], kind.content(), coding).unwrap();
    rows.write(&mut writer).unwrap();
    let bytes = writer.finish().unwrap().into_inner();
    let Image::Codes(_, image) = decode_image(&bytes, &Limits::default()).unwrap() else {
        panic!("it is a PNG file");
    };
    match image.pixels {
        PngPixels::Gray8(raster) => raster
            .pixels()
            .iter()
            .flat_map(|&gray| [gray, gray, gray, 255])
            .collect(),
        PngPixels::Rgb8(raster) => raster
            .pixels()
            .iter()
            .flat_map(|&[r, g, b]| [r, g, b, 255])
            .collect(),
        other => panic!("it has 8 bits: {other:?}"),
    }
}

/// Returns the pixels of all parts of a map, concatenated.
fn joined(pictures: &[Picture], shown: Shown) -> Vec<u8> {
    let parts = pictures
        .iter()
        .filter(|picture| picture.shown == shown && !picture.is_draft);
    let mut rows = 0;
    let mut pixels = Vec::new();
    for part in parts {
        assert_eq!(part.first[1], rows, "parts come in their order");
        rows += part.size[1];
        pixels.extend(&part.pixels);
    }
    pixels
}

#[test]
fn pictures_are_those_of_baked_files() {
    for name in ["flagstone", "giraffe", "rock"] {
        let mut page = Page::open(name);
        page.ask(view(96, &MapKind::ALL.map(MapKind::name), false));
        let (_, pictures) = page.draw();
        for kind in MapKind::ALL {
            let pixels = joined(&pictures, Shown::Map(kind));
            assert_eq!(pixels, baked(name, kind, 96), "{name}, {}", kind.name());
        }
    }
}

#[test]
fn large_pictures_come_in_parts_and_end_with_the_last() {
    // Large images are split by size, and slow ones also by time.
    for (size, pace, n_parts) in [(1280, 0.0, 2), (1280, 60.0, 6), (512, 60.0, 1)] {
        let mut page = Page::open("polka-dots");
        page.ask(view(size, &["height"], false));
        let world = TestWorld::default();
        world.pace.set(pace);
        page.renderer.draw(&page.session.job().unwrap(), &world);
        let (replies, pictures) = split(world.outputs.into_inner());
        assert_eq!(pictures.len(), n_parts, "{size} at {pace}");
        let last: Vec<_> = pictures.iter().map(|picture| picture.is_last).collect();
        assert_eq!(last.iter().filter(|is_last| **is_last).count(), 1);
        assert_eq!(
            joined(&pictures, Shown::Map(MapKind::Height)),
            baked("polka-dots", MapKind::Height, size)
        );
        assert_eq!(of_type(&replies, "began").len(), 1);
        assert_eq!(of_type(&replies, "rendered").len(), 1);
    }
}

#[test]
fn a_draft_is_the_same_tile_with_fewer_pixels() {
    let mut page = Page::open("marble");
    page.ask(view(512, &["albedo"], true));
    let (_, pictures) = page.draw();
    let draft = &pictures[0];
    assert!(
        draft.is_draft && draft.scale == 4 && draft.size == [128, 128],
        "{:?}",
        (draft.scale, draft.size)
    );
    assert_eq!(draft.pixels, baked("marble", MapKind::Albedo, 128));
}

#[test]
fn a_region_is_the_crop_of_the_tile() {
    let mut page = Page::open("cow");
    page.ask(json!({
        "type": "view", "size": [128, 128], "maps": ["normal"], "paused": false, "draft": false,
        "region": { "first": [40, 8], "size": [16, 4] },
    }));
    let (_, pictures) = page.draw();
    let whole = baked("cow", MapKind::Normal, 128);
    let row = |y: usize| &whole[4 * (128 * y + 40)..4 * (128 * y + 56)];
    assert_eq!(pictures[0].first, [40, 8]);
    assert_eq!(
        pictures[0].pixels,
        (8..12).flat_map(row).copied().collect::<Vec<_>>()
    );
}

#[test]
fn nodes_have_pictures_and_thumbnails_with_their_ranges() {
    let mut page = Page::open("stone-and-grass");
    page.ask(json!({ "type": "view", "size": [64, 64], "maps": ["albedo"], "paused": false, "thumbnails": true }));
    let (replies, pictures) = page.draw();
    let graph = of_type(&replies, "graph")[0];
    let thumbnails = pictures
        .iter()
        .filter(|picture| matches!(picture.shown, Shown::Thumbnail(_)));
    assert_eq!(thumbnails.count(), graph["nodes"].as_array().unwrap().len());
    let rendered = of_type(&replies, "rendered");
    let times = rendered.last().unwrap()["nodes"].as_array().unwrap();
    assert!(
        times.iter().all(|time| time["ms"].as_f64().unwrap() >= 0.0),
        "{times:?}"
    );
    let node = graph["nodes"][0]["name"].clone();
    page.ask(
        json!({ "type": "view", "size": [64, 64], "node": node, "paused": false, "draft": false }),
    );
    let (_, pictures) = page.draw();
    assert_eq!(
        (pictures[0].shown, pictures[0].pixels.len()),
        (Shown::Node, 64 * 64 * 4)
    );
}

#[test]
fn a_strip_shows_what_changes_would_make() {
    let mut page = Page::open("flagstone");
    let gain = |value: f64| json!({ "op": "set", "path": ["nodes", "grain", "noise", "gain"], "value": value });
    let message = json!({
        "type": "strip", "node": "grain", "size": 32, "changes": [[gain(0.25)], [gain(-3.0)], [gain(0.75)]],
    });
    let request: Request = serde_json::from_value(message).unwrap();
    let world = TestWorld::default();
    let text = page.session.document().text().to_owned();
    for variant in page.session.strip(request) {
        page.renderer.draw_variant(&variant, &world);
    }
    assert_eq!(page.session.document().text(), text);
    let (_, strip) = split(world.outputs.into_inner());
    let shown: Vec<_> = strip.iter().map(|picture| picture.shown).collect();
    // The recipe rejects the second value, so its thumbnail is missing.
    assert_eq!(shown, [Shown::Strip(0), Shown::Strip(2)]);
    page.ask(json!({ "type": "patch", "rev": 0, "ops": [gain(0.75)] }));
    page.ask(
        json!({ "type": "view", "size": [32, 32], "node": "grain", "paused": false, "draft": false }),
    );
    let (_, pictures) = page.draw();
    assert_eq!(strip[1].pixels, pictures[0].pixels);
    assert_ne!(strip[0].pixels, strip[1].pixels);
}

#[test]
fn what_is_no_longer_wanted_is_not_drawn() {
    let mut page = Page::open("giraffe");
    page.ask(view(1024, &["albedo"], true));
    let world = TestWorld::default();
    world.wanted.set(Some(2));
    page.renderer.draw(&page.session.job().unwrap(), &world);
    let (_, pictures) = split(world.outputs.into_inner());
    assert!(pictures.len() <= 1, "{}", pictures.len());
}

#[test]
fn a_draft_that_was_begun_is_shown() {
    let mut page = Page::open("polka-dots");
    page.ask(view(512, &["albedo"], true));
    page.draw();
    page.ask(view(1024, &["albedo"], true));
    let world = TestWorld::default();
    world.patience.set(Some(1));
    page.renderer.draw(&page.session.job().unwrap(), &world);
    let (_, pictures) = split(world.outputs.into_inner());
    // The first draft took no time, so this one is larger: it has more rows than a band, after which rendering checks
    // for newer jobs.
    let drawn: Vec<_> = pictures
        .iter()
        .map(|picture| (picture.is_draft, picture.is_last, picture.size))
        .collect();
    assert_eq!(drawn, [(true, true, [256; 2])]);
}

#[test]
fn maps_are_drawn_on_the_cpu_when_the_gpu_fails() {
    let draw = |has_broken_gpu: bool| {
        let mut page = Page::open("marble");
        page.ask(view(512, &["albedo", "height"], true));
        let world = TestWorld::default();
        world.has_broken_gpu.set(has_broken_gpu);
        page.renderer.draw(&page.session.job().unwrap(), &world);
        (
            split(world.outputs.into_inner()),
            world.gpu_errors.into_inner(),
        )
    };
    let (expected, none) = draw(false);
    assert!(none.is_empty(), "{none:?}");
    let (found, errors) = draw(true);
    assert!(found == expected);
    // The full images do not ask the GPU again.
    assert_eq!(errors, ["it is broken"]);
}

#[test]
fn a_view_that_shows_nothing_is_refused() {
    for view in [
        json!({ "type": "view", "size": [0, 64], "maps": ["albedo"], "paused": false }),
        json!({ "type": "view", "size": [5000, 64], "maps": ["albedo"], "paused": false }),
        json!({ "type": "view", "size": [64, 64], "maps": ["colour"], "paused": false }),
        json!({
            "type": "view", "size": [64, 64], "maps": ["albedo"], "paused": false,
            "region": { "first": [60, 0], "size": [8, 8] },
        }),
    ] {
        let mut page = Page::open("cow");
        page.ask(view);
        let (replies, pictures) = page.draw();
        assert!(pictures.is_empty(), "{}", pictures.len());
        assert_eq!(of_type(&replies, "refused")[0]["what"], "view");
    }
}

#[test]
fn the_header_of_a_picture_has_32_bytes() {
    let picture = Picture {
        generation: 7,
        shown: Shown::Map(MapKind::Normal),
        first: [1, 2],
        size: [1, 1],
        scale: 4,
        is_draft: true,
        is_last: true,
        pixels: vec![9, 8, 7, 255],
    };
    let header = [
        [1, 0, 0, 0],
        [7, 0, 0, 0],
        [1, 0, 0, 0],
        [1, 0, 0, 0],
        [2, 0, 0, 0],
        [1, 0, 0, 0],
        [1, 0, 0, 0],
        [4, 0, 3, 0],
    ];
    assert_eq!(
        picture.to_bytes(),
        [&header.concat()[..], &[9, 8, 7, 255]].concat()
    );
    assert_eq!(
        [Shown::Node, Shown::Preview, Shown::Thumbnail(3)].map(Shown::code),
        [100, 101, 203]
    );
}
