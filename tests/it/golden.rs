//! Golden images: small pictures of what a crate draws, compared pixel for pixel with `tests/golden/`.
//!
//! `cargo xtask golden --bless` rewrites the files. A run that fails leaves what it drew as `<name>.new.png` in
//! `target/tmp/golden/`, to be looked at beside the old one. One subject an image, at most 8 KiB.
#![expect(clippy::disallowed_methods, reason = "golden images are files")]

use anyhow::{Context, bail, ensure};
use dapple_color::LinearRgb;
use dapple_gallery::draw::{Canvas, label_color};
use dapple_gallery::{Panel, Picture};
use dapple_graph::delaunay;
use dapple_hash::{Seed, hash2, unit_f32, unit_f64};
use dapple_image::{Limits, Transfer, decode_png, encode_png};
use dapple_points::{Domain, PointSet};
use dapple_pups::Pups;
use dapple_raster::{Field, Raster, Window, glam::DVec2};
use std::path::{Path, PathBuf};
use std::{env, fs};

/// The largest file, in bytes.
const BYTES_MAX: usize = 8 * 1024;

/// The pixels along a side.
const SIZE: u32 = 96;

/// An image: its name, and how it is drawn.
type Golden = (&'static str, fn() -> anyhow::Result<Panel>);

/// The images.
const GOLDEN: &[Golden] = &[
    ("graph-delaunay-torus", graph_delaunay_torus),
    ("pups-labels", pups_labels),
    ("pups-noise", pups_noise),
];

#[test]
fn golden_images_are_as_they_were() {
    let problems: Vec<String> = GOLDEN
        .iter()
        .filter_map(|golden| check(golden).err())
        .map(|error| format!("{error:#}"))
        .collect();
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

#[test]
fn golden_folder_holds_nothing_else() {
    for entry in fs::read_dir(folder()).expect("the folder is there") {
        let name = entry.expect("the folder can be read").file_name();
        let name = name.to_string_lossy();
        let known = GOLDEN
            .iter()
            .any(|(golden, _)| format!("{golden}.png") == name);
        assert!(known, "tests/golden/{name} belongs to no image");
    }
}

/// Compares an image with its file, or rewrites the file where the environment asks for it.
fn check((name, draw): &Golden) -> anyhow::Result<()> {
    let panel = draw().with_context(|| format!("{name} was not drawn"))?;
    let bytes = encode(&panel)?;
    ensure!(
        bytes.len() <= BYTES_MAX,
        "{name}.png has {} bytes, but {BYTES_MAX} is the limit",
        bytes.len()
    );
    let path = folder().join(format!("{name}.png"));
    if env::var_os("DAPPLE_BLESS").is_some() {
        return fs::write(&path, bytes).with_context(|| format!("cannot write {}", path.display()));
    }
    let same = match fs::read(&path) {
        Ok(old) => decode_png(&old, &Limits::default())? == decode_png(&bytes, &Limits::default())?,
        Err(_) => false,
    };
    if !same {
        let new = Path::new(env!("CARGO_TARGET_TMPDIR")).join("golden");
        fs::create_dir_all(&new)?;
        let new = new.join(format!("{name}.new.png"));
        fs::write(&new, bytes)?;
        bail!(
            "{} is not as drawn now, which is {}; accept it with `cargo xtask golden --bless`",
            path.display(),
            new.display()
        );
    }
    Ok(())
}

/// The image as a file, with its pixels in the way that the gallery writes them.
fn encode(panel: &Panel) -> anyhow::Result<Vec<u8>> {
    let bytes = match &panel.picture {
        Picture::Gray(_) => encode_png(
            Raster::from_vec(panel.size(), panel.bytes())?.view(),
            Transfer::Data,
        ),
        Picture::Color(raster) => encode_png(
            raster.map(|color| color.to_srgb::<u8>()).view(),
            Transfer::Srgb,
        ),
    };
    Ok(bytes?)
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("golden")
}

fn graph_delaunay_torus() -> anyhow::Result<Panel> {
    let points = jittered_points()?;
    let graph = delaunay(&points)?;
    let mut canvas = Canvas::new(&window()?, 1.0)?;
    canvas.graph(&points, &graph, 1.0, 0.0);
    canvas.points(&points, 2.0, 0.5);
    Ok(Panel::gray("", canvas.into_raster()))
}

fn pups_labels() -> anyhow::Result<Panel> {
    let pups = Pups::delaunay(&jittered_points()?)?;
    let labels: Vec<LinearRgb> = (0..).map(label_color).take(pups.n_points()).collect();
    Ok(Panel::color("", pups.label_raster(&window()?, &labels)?))
}

fn pups_noise() -> anyhow::Result<Panel> {
    let pups = Pups::delaunay(&jittered_points()?)?;
    let value = |index: i64| unit_f32(hash2(Seed(2), [index, 0], 0) as u32);
    let noise = pups.texture((0..).map(value).take(pups.n_points()).collect())?;
    Ok(Panel::gray("", noise.to_raster(&window()?)?))
}

/// A point in each of 6 × 6 cells of the unit torus.
fn jittered_points() -> anyhow::Result<PointSet> {
    let cells = (0..36).map(|cell| [cell % 6, cell / 6]);
    let jitter = |cell, axis| unit_f64(hash2(Seed(1), cell, axis));
    let positions = cells.map(|cell| {
        DVec2::new(
            cell[0] as f64 + jitter(cell, 0),
            cell[1] as f64 + jitter(cell, 1),
        ) / 6.0
    });
    Ok(PointSet::new(
        Domain::torus(DVec2::ZERO, DVec2::ONE),
        positions.collect(),
    )?)
}

fn window() -> anyhow::Result<Window> {
    Ok(Window::unit([SIZE; 2])?)
}
