//! All methods on the same four crops, which do not repeat: fractal noise, stone, pebble and grass.
//!
//! No method is the best for every texture. The periodic part preserves all detail and is the choice for smooth noise.
//! The soft cut keeps grains whole and needs a margin. The blend tile alone hides no seam, at one level or at two. The
//! crossfades reduce contrast. The mirror has no seam, but its symmetry is obvious. A seam ratio is 1 where the wrap
//! is similar to the inside.

use super::{crops, tile_side};
use crate::draw::sheet;
use crate::figure::source;
use crate::{Figure, Panel};
use core::fmt::Write as _;
use dapple_raster::Raster;
use dapple_tile::{
    Crossfade, Feather, Method, SeamOptions, SeamReport, Seamless, SoftCut, SplineProject,
    WrapGradient, repeat,
};
use dapple_wavelet::Phase;

pub(super) const FIGURE: Figure = Figure {
    number: "extra",
    parameters: &[
        ("crops", "160 × 160 of a picture of 512"),
        ("margin", "32 pixels, where a method has one"),
        ("seam", "ratio at 1 and at 4 pixels, both axes"),
        ("fine", "power kept in the finest octave"),
        (
            "contrast, least",
            "deviation kept; least local detail over that of the source",
        ),
    ],
    source: source!(),
    render,
};

/// Returns the margin, in pixels, for a figure of `size` pixels. It is about a quarter of the tile, rounded to a
/// multiple that suits two levels.
pub(super) fn margin_of(size: u32) -> u32 {
    (tile_side(size) / 16 * 4).max(4)
}

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let margin = margin_of(size);
    let crops = crops(tile_side(size) + margin)?;
    methods(margin)
        .into_iter()
        .map(|(name, method)| {
            let tiles = crops.each_ref().map(|(_, crop)| match method {
                Some(method) => Seamless::new(method).apply(crop),
                None => Ok(crop.clone()),
            });
            let mut note = String::from("       seam 1 seam 4   fine contr. least\n");
            for ((crop_name, crop), tile) in crops.iter().zip(&tiles) {
                let tile = tile.as_ref().map_err(Clone::clone)?;
                note += &line(crop_name, crop, tile)?;
            }
            let picture = sheet([size; 2], [2, 2], size / 64, 1.0, |number, size| {
                let tile = tiles[number as usize].as_ref().map_err(Clone::clone)?;
                Ok(repeat(tile, size)?)
            })?;
            Ok(Panel::gray(name, picture).with_note(note))
        })
        .collect()
}

/// Returns the methods by name. The first entry leaves the crop unchanged.
pub(super) fn methods(margin: u32) -> [(&'static str, Option<Method>); 12] {
    let project = |levels, phase| SplineProject {
        levels,
        phase,
        ..SplineProject::default()
    };
    let feather = |crossfade| Method::Feather(Feather::Margin { margin, crossfade });
    [
        ("the crop itself", None),
        (
            "SplineProject, one level, centered",
            Some(Method::SplineProject(project(1, Phase::Centered))),
        ),
        (
            "SplineProject, one level, Cook and DeRose",
            Some(Method::SplineProject(project(1, Phase::CookDeRose))),
        ),
        (
            "SplineProject, two levels, Cook and DeRose",
            Some(Method::SplineProject(project(2, Phase::CookDeRose))),
        ),
        (
            "Periodic, which is Poisson with zero",
            Some(Method::Periodic),
        ),
        (
            "Poisson, extrapolated",
            Some(Method::Poisson(WrapGradient::Extrapolate)),
        ),
        (
            "PeriodicThenProject",
            Some(Method::PeriodicThenProject(project(1, Phase::Centered))),
        ),
        (
            "SoftCut",
            Some(Method::SoftCut(SoftCut {
                margin: Some(margin),
                half_width: Some(margin as f32 / 8.0),
                ..SoftCut::default()
            })),
        ),
        (
            "Feather over the margin, variance kept",
            Some(feather(Crossfade::KeepVariance)),
        ),
        (
            "Feather over the margin, linear",
            Some(feather(Crossfade::Linear)),
        ),
        (
            "Feather, moved by half",
            Some(Method::Feather(Feather::HalfShift)),
        ),
        ("Mirror", Some(Method::Mirror)),
    ]
}

/// Measures a tile. Returns its row of the table.
fn line(name: &str, crop: &Raster<f32>, tile: &Raster<f32>) -> anyhow::Result<String> {
    let [near, far, fine, contrast, least] = measured(crop, tile)?;
    let mut line = String::new();
    writeln!(
        line,
        "{name:<6} {near:6.2} {far:6.2} {fine:6.2} {contrast:6.2} {least:5.2}"
    )?;
    Ok(line)
}

/// Measures one tile: the seam ratios at 1 and at 4 pixels, the power preserved in the finest octave, the contrast,
/// and the minimum local detail relative to the source.
pub(super) fn measured(crop: &Raster<f32>, tile: &Raster<f32>) -> anyhow::Result<[f64; 5]> {
    let options = SeamOptions {
        lattice: [4; 2],
        ..SeamOptions::default()
    };
    let report = SeamReport::beside(crop, tile, &options)?;
    let ratio = |index: usize| report.seams[index].both.map_or(f64::NAN, |both| both.ratio);
    let (fine, contrast, least) =
        report
            .kept
            .as_ref()
            .map_or((f64::NAN, f64::NAN, f64::NAN), |kept| {
                (
                    kept.octaves.first().copied().unwrap_or(f64::NAN),
                    kept.contrast,
                    report.lowest_local_detail / kept.source_lowest_local_detail,
                )
            });
    Ok([ratio(0), ratio(2), fine, contrast, least])
}
