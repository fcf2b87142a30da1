//! Tests that images made tileable have no seam and preserve their detail.
//!
//! Fractal noise and gravel are generated. Photographs are read from `shared/data/exemplars`, next to the workspace,
//! and are skipped if they do not exist.

use anyhow::{Context, Result};
use dapple_hash::Seed;
use dapple_image::{Limits, read_image};
use dapple_raster::{Field, Raster, Window, glam::DVec2};
use dapple_tile::{Method, SeamOptions, SeamReport, Seamless, SoftCut};
use dapple_wavelet::WaveletNoise2;
use dapple_worley::{Combination, Worley2};
use std::path::Path;

/// Width and height of a crop in pixels.
const CROP: u32 = 128;

/// Photographs of sand, gravel, rock and grass. Bricks are left out, since they are longer than the margin of a soft
/// cut.
const PHOTOGRAPHS: [&str; 6] = [
    "skimage_grass_gray_512.png",
    "skimage_gravel_gray_512.png",
    "sand_cc0_256.png",
    "grass_cc0_256.png",
    "ground037_cc0_256.png",
    "rock023_cc0_256.png",
];

/// Means of the seam reports of all crops of an image.
#[derive(Debug, Default)]
struct Means {
    seam_at_1: f64,
    seam_at_4: f64,
    top_octave: f64,
    /// Maximum deviation of the finest octave's ratio from 1.
    furthest: f64,
    /// Minimum local detail, relative to the local detail of the source.
    local: f64,
}

#[test]
fn soft_cuts_leave_no_seam_and_keep_detail() -> Result<()> {
    let cut = SoftCut {
        margin: Some(32),
        ..SoftCut::default()
    };
    for (name, image) in sources()? {
        let raw = means(&image, None)?;
        assert!(raw.seam_at_1 > 1.2, "{name} has a seam before: {raw:?}");
        let means = means(&image, Some(Method::SoftCut(cut)))?;
        for seam in [means.seam_at_1, means.seam_at_4] {
            assert!((0.9..=1.1).contains(&seam), "{name}: {means:?}");
        }
        let kept = (means.top_octave - 1.0).abs() < 0.02 && means.local > 0.9;
        assert!(kept, "{name}: {means:?}");
    }
    Ok(())
}

#[test]
fn periodic_parts_leave_no_seam_and_keep_all_detail() -> Result<()> {
    for (name, image) in sources()? {
        let means = means(&image, Some(Method::Periodic))?;
        let smooth = means.seam_at_1.max(means.seam_at_4);
        assert!(smooth < 1.25, "{name}: {means:?}");
        assert!(means.furthest < 0.001, "{name}: {means:?}");
    }
    Ok(())
}

/// Returns all images with their names.
fn sources() -> Result<Vec<(&'static str, Raster<f32>)>> {
    let mut images = vec![("fractal noise", fractal_noise()?), ("gravel", gravel()?)];
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data/exemplars");
    for name in PHOTOGRAPHS {
        let path = folder.join(name);
        if path.exists() {
            let colors = read_image(&path, &Limits::default())?.color()?;
            images.push((name, colors.map(|color| color.g)));
        } else {
            eprintln!("skipped: there is no {}", path.display());
        }
    }
    Ok(images)
}

/// Generates four octaves of noise, the first with ten cells per crop. The lattice does not align with the pixels, so
/// that crops begin at arbitrary positions within a cell.
fn fractal_noise() -> Result<Raster<f32>> {
    let noise = WaveletNoise2::new(64, Seed(5))?.with_weights(&[1.0, 0.5, 0.25, 0.125])?;
    let window = Window::new(DVec2::ZERO, DVec2::splat(41.0), [512; 2])?;
    Ok(noise.to_raster(&window)?)
}

/// Generates Worley cells that are 12 pixels wide.
fn gravel() -> Result<Raster<f32>> {
    let window = Window::new(DVec2::ZERO, DVec2::splat(512.0 / 12.0), [512; 2])?;
    let texture = Worley2::new(Seed(6)).combine(Combination::F2_MINUS_F1);
    Ok(texture.to_raster(&window)?)
}

/// Returns the means over all crops of an image. Crops are made tileable with `method`; if it is `None`, they are not
/// changed.
fn means(image: &Raster<f32>, method: Option<Method>) -> Result<Means> {
    let [columns, rows] = image.size().map(|side| side / CROP);
    let n = f64::from(columns * rows);
    let mut means = Means::default();
    for (column, row) in (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row))) {
        let crop = image.crop([column * CROP, row * CROP], [CROP; 2])?;
        let tile = match method {
            Some(method) => Seamless::new(method).apply(&crop)?,
            None => crop.clone(),
        };
        // A soft cut removes the last columns and rows. Compare with a source of the same size, so that the report
        // shows the effect of the method and not the difference between parts of an image.
        let source = crop.crop([0; 2], tile.size())?;
        let report = SeamReport::beside(&source, &tile, &SeamOptions::default())?;
        let ratio = |index: usize| report.seams[index].both.context("too small");
        let kept = report.kept.as_ref().context("without a source")?;
        means.seam_at_1 += ratio(0)?.ratio / n;
        means.seam_at_4 += ratio(2)?.ratio / n;
        means.top_octave += kept.octaves[0] / n;
        means.furthest = means.furthest.max((kept.octaves[0] - 1.0).abs());
        means.local += report.lowest_local_detail / kept.source_lowest_local_detail / n;
    }
    Ok(means)
}
