//! The figures of "Wavelet and Blend maps for texture synthesis".

mod fig_01;
mod fig_02;
mod fig_03;
mod fig_04;
mod fig_05;
mod fig_extra_copies;
mod fig_extra_materials;
mod fig_extra_methods;
mod fig_extra_terrain;
mod functions;
mod grass;
mod lump;
mod patch;
mod pebble;
mod perlin;
#[cfg(test)]
mod readme_tests;
mod soil;
mod stone;

use crate::Paper;
use crate::draw::enlarged;
use anyhow::Context;
use dapple_pups::hash::Seed;
use dapple_raster::{Raster, Wrap};
use dapple_tile::{
    Basis, BlendMap, Method, Pixels, Seam, SeamOptions, SeamReport, SoftCut, SplineProject, repeat,
};
use dapple_wavelet::{Degree, Phase};
use grass::grass;
use patch::{Edges, Material};
use pebble::pebble;
use perlin::perlin;
use stone::stone;

/// The paper, with its figures in order.
pub(super) const PAPER: Paper = Paper {
    key: "wavelet",
    title: "Wavelet and Blend maps for texture synthesis",
    reference: "Du Jin-Lian, Wang Song and Meng Xianhai, Beijing University of Technology",
    figures: &[
        fig_01::FIGURE,
        fig_02::FIGURE,
        fig_03::FIGURE,
        fig_04::FIGURE,
        fig_05::FIGURE,
        fig_extra_terrain::FIGURE,
        fig_extra_copies::FIGURE,
        fig_extra_methods::FIGURE,
        fig_extra_materials::FIGURE,
    ],
};

/// The paper's blend tile: halved and doubled once, with the phase that leaves the smaller step at the seam.
const BLEND_TILE: SplineProject = SplineProject {
    levels: 1,
    phase: Phase::CookDeRose,
    basis: Basis::Spline(Degree::Quadratic),
    pixels: Pixels::Coefficients,
};

/// Returns the side of a tile in a figure of `size` pixels: a quarter of the figure, as in the paper (128 of 512),
/// rounded to a multiple of 8.
fn tile_side(size: u32) -> u32 {
    (size / 32 * 8).max(8)
}

/// Returns the margin for a tile of `side` pixels, in pixels, and the soft cut with this margin. The image must be
/// larger than the tile by the margin.
fn cut(side: u32) -> (u32, Method) {
    let margin = side / 4;
    let cut = SoftCut {
        margin: Some(margin),
        half_width: Some(margin as f32 / 8.0),
        ..SoftCut::default()
    };
    (margin, Method::SoftCut(cut))
}

/// Returns the size of a stone or pebble, in pixels, in an image `side` pixels wide. It is a sixth of `side`, which
/// suits the larger stones.
fn stone_px(side: u32) -> f64 {
    (0.16 * f64::from(side)).max(1.0)
}

/// Returns the source images for the paper's blend tiles, by name: features of two textures, and noise. None of them
/// tiles.
fn originals(side: u32) -> anyhow::Result<[(&'static str, Raster<f32>); 4]> {
    let features = |ground: Material| {
        let features = BlendMap::new(stone_px(side)).with_wrap([Wrap::Mirror; 2]);
        features.apply_color(&ground.color)
    };
    Ok([
        ("stone", features(stone(side, Seed(1), Edges::Cropped)?)?),
        ("pebble", features(pebble(side, Seed(1), Edges::Cropped)?)?),
        ("one octave of noise", perlin(side, 5.3, 1, Seed(1))?),
        ("five octaves of noise", perlin(side, 3.3, 5, Seed(2))?),
    ])
}

/// Returns gray images that do not tile, by name, for the comparison of methods.
fn crops(side: u32) -> anyhow::Result<[(&'static str, Raster<f32>); 4]> {
    let gray = |ground: Material| ground.color.map(|color| color.luminance().sqrt());
    Ok([
        ("noise", perlin(side, 4.3, 5, Seed(2))?),
        ("stone", gray(stone(side, Seed(1), Edges::Cropped)?)),
        ("pebble", gray(pebble(side, Seed(1), Edges::Cropped)?)),
        ("grass", gray(grass(side, Seed(1), Edges::Cropped)?)),
    ])
}

/// Returns the [`SeamReport`] of a tile compared with its original, as four short lines and a verdict.
fn report(original: &Raster<f32>, tile: &Raster<f32>) -> anyhow::Result<String> {
    let options = SeamOptions {
        lattice: [1 << BLEND_TILE.levels; 2],
        ..SeamOptions::default()
    };
    let report = SeamReport::beside(original, tile, &options)?;
    let kept = report.kept.as_ref().context("there is an original")?;
    let row = |numbers: &mut dyn Iterator<Item = f64>| -> String {
        numbers.map(|number| format!("{number:6.2}")).collect()
    };
    let ratio = |seam: &Seam| seam.both.map_or(f64::NAN, |both| both.ratio);
    let seams = row(&mut report.seams.iter().map(ratio));
    let octaves = row(&mut kept.octaves.iter().copied());
    let local = row(&mut [report.lowest_local_detail, kept.source_lowest_local_detail].into_iter());
    let contrast = row(&mut core::iter::once(kept.contrast));
    Ok(format!(
        "seam at 1, 2, 4, 8 px{seams}\n\
         detail, finest first {octaves}\n\
         least detail, before {local}\n\
         contrast             {contrast}\n\
         {}\n",
        verdict(&report)
    ))
}

/// Returns the defects of a tile, one per line.
fn verdict(report: &SeamReport) -> String {
    let faults: Vec<_> = report.faults().iter().map(ToString::to_string).collect();
    match faults.as_slice() {
        [] => "passes".to_owned(),
        faults => format!("does not pass: {}", faults.join(",\n  ")),
    }
}

/// Returns copies of a tile, two rows of them, in an image `width` pixels wide.
fn tiled(tile: &Raster<f32>, width: u32) -> anyhow::Result<Raster<f32>> {
    Ok(repeat(tile, [width, 2 * tile.height()])?)
}

#[cfg(test)]
mod tests {
    use super::patch::{Edges, Material};
    use super::{grass::grass, pebble::pebble, perlin::perlin, soil::soil, stone::stone};
    use crate::draw::shrink;
    use dapple_points::hash::Seed;
    use dapple_raster::Raster;
    use dapple_tile::{SeamOptions, SeamReport};

    type Make = fn(u32, Seed, Edges) -> anyhow::Result<Material>;

    const MATERIALS: [(&str, Make); 4] = [
        ("stone", stone),
        ("pebble", pebble),
        ("grass", grass),
        ("soil", soil),
    ];

    /// Returns the seam ratio at one pixel, over both axes.
    fn seam_ratio(raster: &Raster<f32>) -> f64 {
        let report = SeamReport::of(raster, &SeamOptions::default()).unwrap();
        report.seams[0].both.unwrap().ratio
    }

    #[test]
    fn heights_and_gaps_stay_in_their_range() {
        for (name, make) in MATERIALS {
            for seed in 1..4 {
                let made = make(96, Seed(seed), Edges::Cropped).unwrap();
                let [height, gap] = [&made.height, &made.gap].map(Raster::statistics);
                assert!(height.min > -0.2 && height.max < 1.2, "{name}: {height:?}");
                assert!(gap.min >= 0.0 && gap.max <= 1.0, "{name}: {gap:?}");
                assert!(gap.mean > 0.005 && gap.mean < 0.5, "{name}: {gap:?}");
            }
        }
    }

    #[test]
    fn borders_fit_only_where_the_material_repeats() {
        for (name, make) in MATERIALS {
            let ratio = |edges| seam_ratio(&make(256, Seed(1), edges).unwrap().height);
            let [repeating, cropped] = [Edges::Repeating, Edges::Cropped].map(ratio);
            // A column of 256 pixels with features of about ten pixels varies by about a fifth.
            assert!((0.5..1.5).contains(&repeating), "{name}: {repeating}");
            assert!(cropped > 1.5, "{name}: {cropped}");
        }
    }

    #[test]
    fn a_small_picture_shows_the_same_as_a_large_one() {
        for (name, make) in [("stone", stone as Make), ("pebble", pebble)] {
            let [small, large] =
                [64, 256].map(|size| make(size, Seed(1), Edges::Cropped).unwrap().gap);
            let large = shrink(&large, 4).unwrap();
            let apart = small.zip_map(&large, |a, b| (a - b).abs()).unwrap();
            // Supersampled edges and averaged edges differ in the pixels on an edge.
            let mean = apart.statistics().mean;
            assert!(mean < 0.15, "{name}: {mean}");
        }
    }

    #[test]
    fn perlin_tiles_are_centered_and_have_a_seam() {
        let tile = perlin(128, 4.0, 5, Seed(5)).unwrap();
        let range = tile.statistics();
        assert!((range.mean - 0.5).abs() < 0.1, "{range:?}");
        assert!(range.min >= 0.0 && range.max <= 1.0, "{range:?}");
        assert!(range.deviation > 0.1, "{range:?}");
        assert!(seam_ratio(&tile) > 3.0, "no seam");
    }
}
