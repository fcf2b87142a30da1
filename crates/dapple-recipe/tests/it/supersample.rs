//! Tests of bakes with several samples per pixel.

use crate::bakes::{ALL_NODES, bake, crop, options, plan};
use dapple_recipe::{
    Bake, BakeMemory, BakeOptions, Images, MapKind, Plan, Recipe, RecipeErrorKind, Region, Samples,
};

/// A recipe with a neighborhood, heights that are not linear, and colors, on a tile that repeats along one axis.
const BLURRED: &str = r##"
dapple = 1
extent = [2.0, 1.5]
wrap = [true, false]
[nodes.cells.worley]
frequency = 2.0
[nodes.soft.blur]
input = "cells"
radius = 0.05
[nodes.height]
maximum = ["soft", "cells"]
[nodes.color.ramp]
input = "height"
colors = ["#102030", "#f0e0c0"]
[material]
height = "height"
albedo = "color"
roughness = "soft"
"##;

fn supersampled(size: [u32; 2], supersample: u32) -> BakeOptions {
    BakeOptions {
        supersample,
        ..options(size)
    }
}

fn numbers(bits: &[u32]) -> Vec<f32> {
    bits.iter().copied().map(f32::from_bits).collect()
}

/// Returns the means of blocks of `per_axis` × `per_axis` samples, row by row. `[width, height]` is the size of the
/// result in pixels.
fn means(
    samples: &[f32],
    [width, height]: [usize; 2],
    per_axis: usize,
    channels: usize,
) -> Vec<f32> {
    let mut means = Vec::new();
    for row in 0..height {
        for column in 0..width {
            for channel in 0..channels {
                let mut sum = 0.0;
                for y in row * per_axis..(row + 1) * per_axis {
                    for x in column * per_axis..(column + 1) * per_axis {
                        sum += f64::from(samples[(y * width * per_axis + x) * channels + channel]);
                    }
                }
                means.push((sum / (per_axis * per_axis) as f64) as f32);
            }
        }
    }
    means
}

#[test]
fn a_pixel_is_the_mean_of_its_samples() {
    // The pixel sizes of 4 × 3 samples are exact, so that a larger bake has the same samples.
    let plan = plan(ALL_NODES);
    let size = [48, 36];
    for per_axis in [2_u32, 4] {
        let fine = bake(&plan, &options(size.map(|side| side * per_axis)));
        let coarse = bake(&plan, &supersampled(size, per_axis));
        for ((kind, fine), coarse) in MapKind::ALL.into_iter().zip(&fine).zip(&coarse) {
            let channels = match kind {
                // Computed from averaged heights.
                MapKind::Normal | MapKind::Occlusion | MapKind::Curvature | MapKind::Orm => {
                    continue;
                }
                MapKind::Albedo | MapKind::Emission => 3,
                _ => 1,
            };
            let sides = size.map(|side| side as usize);
            let want = means(&numbers(fine), sides, per_axis as usize, channels);
            assert!(numbers(coarse) == want, "{kind:?} at {per_axis}");
        }
    }
}

#[test]
fn one_sample_per_pixel_changes_nothing_and_constants_stay_exact() {
    let plan = plan(ALL_NODES);
    assert!(bake(&plan, &options([40, 30])) == bake(&plan, &supersampled([40, 30], 1)));
    let flat = "dapple = 1\n[material]\nheight = 0.1\nroughness = 0.3\nalbedo = \"#c08040\"";
    let flat = self::plan(flat);
    assert!(bake(&flat, &options([5, 4])) == bake(&flat, &supersampled([5, 4], 3)));
}

#[test]
fn windows_bands_and_corners_of_a_supersampled_bake_are_crops() {
    for (text, memory) in [
        (ALL_NODES, BakeMemory::Whole),
        (BLURRED, BakeMemory::Banded),
    ] {
        let plan = plan(text);
        for (size, samples) in [([47, 35], Samples::Centers), ([33, 25], Samples::Corners)] {
            let all = BakeOptions {
                samples,
                ..supersampled(size, 3)
            };
            let whole = bake(&plan, &all);
            for (first, part) in [([0, 0], [9, 7]), ([20, 13], [13, 12]), ([32, 24], [1, 1])] {
                let region = Region { first, size: part };
                let window = BakeOptions {
                    region: Some(region),
                    band_pixels: 2000,
                    memory,
                    ..all.clone()
                };
                for ((kind, whole), part) in
                    MapKind::ALL.iter().zip(&whole).zip(bake(&plan, &window))
                {
                    assert!(
                        crop(whole, size, region) == part,
                        "{kind:?} {region:?} {samples:?}"
                    );
                }
            }
            let bands = BakeOptions {
                band_pixels: 3000,
                memory,
                ..all
            };
            assert!(whole == bake(&plan, &bands), "bands");
        }
    }
}

#[test]
fn bands_of_a_supersampled_bake_have_as_many_samples_as_the_options_allow() {
    let plan = plan(BLURRED);
    let options = BakeOptions {
        maps: vec![MapKind::Albedo],
        ..supersampled([256, 2048], 4)
    };
    let options = BakeOptions {
        band_pixels: 1 << 18,
        ..options
    };
    let band = Bake::new(&plan, &options).unwrap().next().unwrap().unwrap();
    let [width, rows] = band.maps[0].1.size();
    assert!(width * rows * 16 <= 1 << 18, "{rows} rows");
}

#[test]
fn numbers_of_samples_out_of_range_are_refused() {
    let plan = Plan::new(&Recipe::builtin("rock").unwrap(), &Images::new(), 0.0).unwrap();
    for (size, supersample) in [([8, 8], 0), ([8, 8], 17), ([8, u32::MAX], 2)] {
        let error = Bake::new(&plan, &supersampled(size, supersample)).unwrap_err();
        assert!(
            matches!(error.kind(), RecipeErrorKind::Range { .. }),
            "{error}"
        );
    }
}
