//! Compares golden images, which are small images of a crate's output, with the files in `tests/golden/` pixel by
//! pixel.
//!
//! `cargo xtask golden --bless` rewrites the files. A failed run leaves the new image as `<name>.new.png` in
//! `target/tmp/golden/`, for comparison with the old one. Every image shows one subject and has at most 8 KiB.
#![expect(clippy::disallowed_methods, reason = "golden images are files")]

use anyhow::{Context, bail, ensure};
use dapple_color::{Code, ColorRamp, HeightPlane, LinearRgb, Palette, normal_map};
use dapple_gallery::draw::{Canvas, label_color};
use dapple_graph::delaunay;
use dapple_hash::{Seed, hash2, unit_f32, unit_f64};
use dapple_image::{Limits, Transfer, decode_png, encode_png};
use dapple_points::{
    Domain, PointSet, VariablePoissonOptions, poisson_disk, variable_poisson_disk,
};
use dapple_pups::{
    CowOptions, OctavesOptions, Pups, SpaceGiraffeOptions, cow, space_giraffe, turbulence,
};
use dapple_raster::{Field, Named, Ramp, Raster, Varying, Window, Wrap, glam::DVec2};
use dapple_tile::{
    Blend, CornerTiles, Layer, Map, Method, Mixing, Seamless, SoftCut, Weighting, blend_by_tile,
    rank_equalize, repeat,
};
use dapple_wavelet::{WaveletNoise2, wavelet_tile};
use dapple_worley::{Combination, Metric, Octaves, Plane, Worley2, Worley3};
use std::path::{Path, PathBuf};
use std::{env, fs};

/// Maximum size of a golden image file, in bytes.
const BYTES_MAX: usize = 8 * 1024;

/// Width and height of most images, in pixels.
const SIZE: u32 = 96;

/// A golden image: its name, and the function that renders its file.
type Golden = (&'static str, fn() -> anyhow::Result<Vec<u8>>);

/// All golden images.
const GOLDEN: &[Golden] = &[
    ("color-normal-map", color_normal_map),
    ("color-palettes", color_palettes),
    ("graph-delaunay-torus", graph_delaunay_torus),
    ("points-poisson-disk", points_poisson_disk),
    ("points-variable-radius", points_variable_radius),
    ("pups-cow", pups_cow),
    ("pups-giraffe", pups_giraffe),
    ("pups-labels", pups_labels),
    ("pups-noise", pups_noise),
    ("pups-turbulence", pups_turbulence),
    ("tile-corner-tiles", tile_corner_tiles),
    ("tile-mask", tile_mask),
    ("tile-soft-cut", tile_soft_cut),
    ("wavelet-noise", wavelet_noise),
    ("worley-cells", worley_cells),
    ("worley-combinations", worley_combinations),
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

/// Compares an image with its file, or rewrites the file if the environment variable is set.
fn check((name, draw): &Golden) -> anyhow::Result<()> {
    let bytes = draw().with_context(|| format!("{name} was not drawn"))?;
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

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("golden")
}

fn color_normal_map() -> anyhow::Result<Vec<u8>> {
    let dome = |at: DVec2| (0.2 - (at - DVec2::splat(0.5)).length_squared()).max(0.0) as f32;
    let height = Raster::from_window(&window()?, dome)?;
    let normals = normal_map(
        &height,
        &HeightPlane::for_window(&window()?, [Wrap::Repeat; 2]).into(),
    )?;
    let codes = normals.map(|normal| normal.to_codes::<u8>());
    Ok(encode_png(codes.view(), Transfer::Data)?)
}

fn color_palettes() -> anyhow::Result<Vec<u8>> {
    let ramps: Vec<ColorRamp> = Palette::ALL.iter().map(|palette| palette.ramp()).collect();
    color(&Raster::from_fn(
        [SIZE, 8 * ramps.len() as u32],
        |column, row| ramps[row as usize / 8].at(column as f32 / (SIZE - 1) as f32),
    )?)
}

fn graph_delaunay_torus() -> anyhow::Result<Vec<u8>> {
    let points = jittered_points()?;
    let mut canvas = Canvas::new(&window()?, 1.0)?;
    canvas.graph(&points, &delaunay(&points)?, 1.0, 0.0);
    canvas.points(&points, 2.0, 0.5);
    gray(&canvas.into_raster())
}

fn points_poisson_disk() -> anyhow::Result<Vec<u8>> {
    dots(&poisson_disk(unit_torus(), 0.08, Seed(3))?)
}

fn points_variable_radius() -> anyhow::Result<Vec<u8>> {
    let cylinder = Domain {
        wrap: [false, true],
        ..unit_torus()
    };
    let radius = Varying::Ramp(Ramp {
        from: DVec2::ZERO,
        to: DVec2::X,
        start: 0.03,
        end: 0.15,
    });
    dots(&variable_poisson_disk(
        cylinder,
        &radius,
        &VariablePoissonOptions::default(),
        Seed(4),
    )?)
}

fn pups_cow() -> anyhow::Result<Vec<u8>> {
    gray(&cow(&CowOptions::default(), Seed(5))?.to_raster(&paper_window()?)?)
}

fn pups_giraffe() -> anyhow::Result<Vec<u8>> {
    let giraffe = space_giraffe(&SpaceGiraffeOptions::default(), Seed(6))?;
    gray(&giraffe.to_raster(&paper_window()?)?)
}

fn pups_turbulence() -> anyhow::Result<Vec<u8>> {
    let turbulence = turbulence(&OctavesOptions::default(), Seed(7))?.normalized();
    // The right half would exceed the size limit of a golden image.
    gray(&turbulence.to_raster(&paper_window()?.crop([0, 0], [SIZE / 2, SIZE])?)?)
}

fn pups_labels() -> anyhow::Result<Vec<u8>> {
    let pups = Pups::delaunay(&jittered_points()?)?;
    let labels: Vec<LinearRgb> = (0..).map(label_color).take(pups.n_points()).collect();
    color(&pups.label_raster(&window()?, &labels)?)
}

fn pups_noise() -> anyhow::Result<Vec<u8>> {
    let pups = Pups::delaunay(&jittered_points()?)?;
    let value = |index: i64| unit_f32(hash2(Seed(2), [index, 0], 0) as u32);
    let noise = pups.texture((0..).map(value).take(pups.n_points()).collect())?;
    gray(&noise.to_raster(&window()?)?)
}

/// Returns the points of a jittered grid: a random point in each of 6 × 6 cells of the unit torus.
fn jittered_points() -> anyhow::Result<PointSet> {
    let jitter = |cell, axis| unit_f64(hash2(Seed(1), cell, axis));
    let position = |cell: [i64; 2]| {
        let corner = DVec2::new(cell[0] as f64, cell[1] as f64);
        (corner + DVec2::new(jitter(cell, 0), jitter(cell, 1))) / 6.0
    };
    let positions = (0..36).map(|cell| position([cell % 6, cell / 6]));
    Ok(PointSet::new(unit_torus(), positions.collect())?)
}

/// Renders corner tiles with random corner colors. They are built from two source tiles of cracks, one finer than the
/// other.
fn tile_corner_tiles() -> anyhow::Result<Vec<u8>> {
    let cracks = |cells: u16| {
        let period = Some(u32::from(cells));
        let worley = Worley2::new(Seed(4)).with_period([period; 2])?;
        let cracks = worley.combine(Combination::F2_MINUS_F1).normalized()?;
        let window = Window::new(DVec2::ZERO, DVec2::splat(cells.into()), [32; 2])?;
        Ok::<_, anyhow::Error>(cracks.to_raster(&window)?)
    };
    let sources = [cracks(2)?, cracks(4)?].map(|source| vec![Map::Value(source)]);
    let maps = CornerTiles::new(&sources)?.render(Seed(1), [0, 0], [SIZE; 2])?;
    let [Map::Value(map)] = maps.as_slice() else {
        anyhow::bail!("numbers became something else");
    };
    gray(map)
}

/// Renders black and white, blended by a noise tile, with more white to the right.
fn tile_mask() -> anyhow::Result<Vec<u8>> {
    let tile = rank_equalize(&wavelet_tile([32; 2], &[0.0, 0.5, 1.0], Seed(5))?)?;
    let tile = repeat(&tile, [SIZE; 2])?;
    let [black, white] = [0.0, 1.0].map(|shade| Raster::filled([SIZE; 2], shade).map(Map::Value));
    let maps = [[white?], [black?]];
    let rising = Raster::from_window(&Window::unit([SIZE; 2])?, |at| at.x as f32)?;
    let weights = [rising.clone(), rising.map(|share| 1.0 - share)];
    let layer = |maps, weight| Layer {
        maps,
        weight,
        height: None,
    };
    let layers = [layer(&maps[0], &weights[0]), layer(&maps[1], &weights[1])];
    let how = Blend::new(Weighting::Mask { gain: 6.0 }, Mixing::Linear);
    match blend_by_tile(&layers, &tile, &how)?.as_slice() {
        [Map::Value(blended)] => gray(blended),
        other => bail!("{other:?} is not one map of values"),
    }
}

/// Renders two by two copies of a tile: a crop of cells that does not repeat, made seamless by a soft cut.
fn tile_soft_cut() -> anyhow::Result<Vec<u8>> {
    let cells = Worley2::new(Seed(6)).combine(Combination::F1);
    let crop = Window::new(DVec2::ZERO, DVec2::splat(4.0), [64; 2])?;
    let cut = SoftCut {
        margin: Some(16),
        ..SoftCut::default()
    };
    let tile = Seamless::new(Method::SoftCut(cut)).apply(&cells.to_raster(&crop)?)?;
    gray(&repeat(&tile, [SIZE; 2])?)
}

/// Renders three bands of a noise tile of eight cells, repeated one and a half times.
fn wavelet_noise() -> anyhow::Result<Vec<u8>> {
    let noise = WaveletNoise2::new(8, Seed(7))?.with_weights(&[0.2, 0.05, 0.01])?;
    let window = Window::new(DVec2::ZERO, DVec2::splat(12.0), [SIZE; 2])?;
    gray(&noise.to_raster(&window)?.map(|value| 0.5 + value))
}

/// Renders Manhattan cells with a period of four, colored by their ids.
fn worley_cells() -> anyhow::Result<Vec<u8>> {
    let period = [Some(4), Some(4)];
    let worley = Worley2::new(Seed(3)).with_metric(Metric::Manhattan)?;
    let worley = worley.with_period(period)?;
    let window = Window::new(DVec2::ZERO, DVec2::splat(5.0), [SIZE; 2])?;
    let cells = Raster::from_window(&window, |at| {
        label_color(worley.sample::<1>(at)[0].id as u32 % 64)
    })?;
    color(&cells)
}

/// Renders F1 at the top and F2 - F1 at the bottom; single octaves on the left and fractal sums on the right.
fn worley_combinations() -> anyhow::Result<Vec<u8>> {
    let worley = Worley3::new(Seed(5));
    let half = SIZE / 2;
    let window = Window::new(DVec2::ZERO, DVec2::splat(3.0), [half; 2])?;
    let mut picture = Raster::filled([SIZE; 2], 0.0)?;
    for (row, combination) in [Combination::F1, Combination::F2_MINUS_F1]
        .into_iter()
        .enumerate()
    {
        let plane = Plane::slice([0.0, 0.0, 0.3].into());
        let texture = worley.combine(combination);
        let fractal = texture.fractal(Octaves::paper())?;
        let above = row as u32 * half;
        let plain = picture.view_mut().crop([0, above], [half; 2])?;
        texture.normalized()?.render_plane(&plane, &window, plain)?;
        let range = fractal.measure_range(Seed(6), 2000)?;
        let right = picture.view_mut().crop([half, above], [half; 2])?;
        fractal
            .with_range(range)?
            .render_plane(&plane, &window, right)?;
    }
    gray(&picture)
}

fn dots(points: &PointSet) -> anyhow::Result<Vec<u8>> {
    let mut canvas = Canvas::new(&window()?, 1.0)?;
    canvas.points(points, 1.5, 0.0);
    gray(&canvas.into_raster())
}

fn gray(values: &Raster<f32>) -> anyhow::Result<Vec<u8>> {
    Ok(encode_png(
        values.map(|&value| u8::from_unit(value)).view(),
        Transfer::Data,
    )?)
}

fn color(colors: &Raster<LinearRgb>) -> anyhow::Result<Vec<u8>> {
    Ok(encode_png(
        colors.map(|color| color.to_srgb::<u8>()).view(),
        Transfer::Srgb,
    )?)
}

fn unit_torus() -> Domain {
    Domain::torus(DVec2::ZERO, DVec2::ONE)
}

/// Returns the window of the whole torus used in the paper on partition-of-unity parametrics.
fn paper_window() -> anyhow::Result<Window> {
    let Domain { origin, size, .. } = Domain::paper_torus();
    Ok(Window::new(origin, size, [SIZE; 2])?)
}

fn window() -> anyhow::Result<Window> {
    Ok(Window::unit([SIZE; 2])?)
}
