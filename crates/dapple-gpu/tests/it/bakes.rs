//! Bakes on the GPU against bakes on the CPU.

use crate::{gpu, on_gpu, recipe};
use dapple_gpu::{Gpu, GpuPlan};
use dapple_recipe::{Bake, BakeOptions, Images, MapKind, MapRows, Picture, Plan, Recipe, Samples};

/// Maps that read all nodes of a material.
const MAPS: [MapKind; 5] = [
    MapKind::Height,
    MapKind::Normal,
    MapKind::Albedo,
    MapKind::Orm,
    MapKind::Curvature,
];

pub(crate) fn options(size: [u32; 2]) -> BakeOptions {
    BakeOptions {
        size,
        maps: MAPS.to_vec(),
        ..BakeOptions::default()
    }
}

/// Returns the number of channels of maps whose bits differ.
pub(crate) fn differing(on_gpu: &[(MapKind, MapRows)], on_cpu: &[(MapKind, MapRows)]) -> usize {
    let words = |map: &MapRows| -> Vec<u32> {
        match map {
            MapRows::Gray(raster) => raster.pixels().iter().map(|x| x.to_bits()).collect(),
            MapRows::Color(raster) => {
                let colors = raster.pixels().iter();
                colors
                    .flat_map(|color| color.to_array().map(f32::to_bits))
                    .collect()
            }
            MapRows::Normal(raster) => {
                let normals = raster.pixels().iter();
                normals
                    .flat_map(|normal| normal.to_array().map(f32::to_bits))
                    .collect()
            }
            MapRows::Packed(raster) => {
                let pixels = raster.pixels().iter();
                pixels.flat_map(|pixel| pixel.map(f32::to_bits)).collect()
            }
        }
    };
    let pairs = on_gpu
        .iter()
        .zip(on_cpu)
        .map(|((_, gpu), (_, cpu))| (words(gpu), words(cpu)));
    let differ = pairs.map(|(gpu, cpu)| {
        assert_eq!(gpu.len(), cpu.len(), "sizes");
        gpu.iter().zip(&cpu).filter(|(gpu, cpu)| gpu != cpu).count()
    });
    differ.sum()
}

pub(crate) fn bake(plan: &Plan, options: &BakeOptions) -> Vec<(MapKind, MapRows)> {
    let bake = Bake::new(plan, options).expect("a bake");
    bake.whole_maps().expect("maps")
}

pub(crate) fn compare(gpu: &Gpu, recipe: &Recipe, options: &BakeOptions) {
    let plan = Plan::new(recipe, &Images::new(), 0.0).expect("a plan");
    let on_gpu = GpuPlan::new(gpu, recipe, &plan).expect("a plan on the GPU");
    let [made, expected] = [on_gpu.plan(), &plan].map(|plan| bake(plan, options));
    assert_eq!(differing(&made, &expected), 0, "{}", recipe.name);
}

/// Distance in the list of the recipes that are baked: lavapipe takes many seconds to compile the shaders of one. The tests
/// of `dapple-wgsl-tests` compare the shaders of more.
const STEP: usize = 40;

#[test]
fn bakes_of_builtin_recipes_have_the_bits_of_the_cpu() {
    let Some(gpu) = gpu() else { return };
    for name in Recipe::builtin_names().step_by(STEP) {
        let recipe = Recipe::builtin(name).expect("a recipe");
        compare(&gpu, &recipe, &options([48, 40]));
    }
}

/// Nodes of all kinds of steps: on the GPU, on the CPU below and above it, in the neighborhood and over the whole tile.
const ALL_STEPS: &str = r##"
    dapple = 1
    extent = [4.0, 3.0]
    [nodes]
    cells.worley = { frequency = 2.0, value = "f2_minus_f1" }
    hills.noise = { basis = "gradient", frequency = 3.0 }
    bumps.worley = { frequency = 2.0, value = "f4" }
    swell.noise = { basis = "pups", frequency = 2.0, octaves = 2 }
    sum.add = ["cells", "bumps", "swell"]
    soft.blur = { input = "sum", radius = 0.2 }
    even.equalize = { input = "hills" }
    height.mix = { from = "soft", to = "even", by = "cells" }
    color.ramp = { input = "height", colors = ["#204060", "#f0e0d0"], space = "linear" }
    stain.blur = { input = "color", radius = 0.1 }
    albedo.mix = { from = "stain", to = "color", by = "bumps" }
    [material]
    height = "height"
    albedo = "albedo"
    roughness = "cells"
    metallic = "height"
    "##;

#[test]
fn bakes_of_all_kinds_of_steps_have_the_bits_of_the_cpu() {
    let Some(gpu) = gpu() else { return };
    let (recipe, _) = recipe(ALL_STEPS);
    let size = [61, 47];
    compare(&gpu, &recipe, &options(size));
    let samples = Samples::Corners;
    compare(
        &gpu,
        &recipe,
        &BakeOptions {
            samples,
            ..options(size)
        },
    );
    let region = dapple_recipe::Region {
        first: [5, 7],
        size: [40, 33],
    };
    let region = BakeOptions {
        region: Some(region),
        band_pixels: 640,
        ..options(size)
    };
    compare(&gpu, &recipe, &region);
}

#[test]
fn images_of_nodes_have_the_bits_of_the_cpu() {
    let Some(gpu) = gpu() else { return };
    let made = recipe(ALL_STEPS);
    let on_gpu = on_gpu(&gpu, &made);
    for node in made.1.node_names() {
        let [found, expected] =
            [on_gpu.plan(), &made.1].map(|plan| plan.node_picture(node, [33, 20], None));
        let same = match (found.expect("an image"), expected.expect("an image")) {
            (Picture::Numbers(a), Picture::Numbers(b)) => a == b,
            (Picture::Colors(a), Picture::Colors(b)) => a == b,
            _ => false,
        };
        assert!(same, "{node}");
    }
}
