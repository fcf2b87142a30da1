//! Tests of cells, cows, layers of cells, reference images and colors.

use super::common::paper_window;
use dapple_hash::Seed;
use dapple_points::Domain;
use dapple_pups::*;
use dapple_raster::{Field, FieldExt as _, Raster};
use glam::DVec2;

#[test]
fn cells_of_one_point_have_a_label_for_each() {
    let texture = cells(&CellsOptions::default(), Seed(1)).unwrap();
    assert_eq!(texture.values().len(), texture.pups().n_points());
    let window = paper_window(64);
    let labels = texture.label_raster(&window).unwrap();
    let values = texture.to_raster(&window).unwrap();
    for ((column, row), (&label, &value)) in (0..64 * 64)
        .map(|at| (at % 64, at / 64))
        .zip(labels.pixels().iter().zip(values.pixels()))
    {
        assert_eq!(value, texture.values()[label as usize]);
        assert_eq!(texture.label(window.position(column, row)), Some(label));
    }
}

#[test]
fn orientations_move_the_borders_of_cells() {
    let plain = CellsOptions {
        net: NetOptions::default(),
        ..CellsOptions::default()
    };
    let [random, plain] = [CellsOptions::default(), plain].map(|options| {
        cells(&options, Seed(1))
            .unwrap()
            .label_raster(&paper_window(128))
            .unwrap()
    });
    let moved = random
        .pixels()
        .iter()
        .zip(plain.pixels())
        .filter(|(a, b)| a != b)
        .count();
    let share = moved as f64 / 16384.0;
    assert!(
        (0.02..0.5).contains(&share),
        "{share} of the pixels have another cell"
    );
}

#[test]
fn a_cow_is_half_black_and_half_white() {
    let raster = cow(&CowOptions::default(), Seed(1))
        .unwrap()
        .to_raster(&paper_window(128))
        .unwrap();
    let only_two = raster
        .pixels()
        .iter()
        .all(|value| [0.0, 1.0].contains(value));
    assert!(only_two, "a third value");
    let mean = raster.statistics().mean;
    // 279 labels: a standard deviation of 0.03.
    assert!((mean - 0.5).abs() < 0.12, "mean {mean}");
}

#[test]
fn cellular_noise_sums_four_layers() {
    let sum = cellular_noise(&CellularNoiseOptions::default(), Seed(1)).unwrap();
    assert_eq!((sum.layers().len(), sum.maximum()), (4, 1.875));
    let n_points = |layer: usize| sum.layers()[layer].pups().n_points();
    for layer in 1..4 {
        let ratio = n_points(layer) as f64 / n_points(layer - 1) as f64;
        // The first layer has 17 points or so, which spread.
        assert!(
            (3.0..5.2).contains(&ratio),
            "{ratio} times the points in layer {layer}"
        );
    }
    let at = DVec2::new(0.1, 0.7);
    let expected: f32 = (0..4)
        .map(|i| sum.layers()[i].sample(at) * sum.amplitudes()[i])
        .sum();
    assert_eq!(sum.sample(at), expected);
}

/// Returns a reference image with a white disk of radius ½ and a gray transition at its border.
fn disc() -> ReferenceImage {
    let image = Raster::from_window(&paper_window(64), |at| {
        (4.5 - 8.0 * at.length()).clamp(0.0, 1.0) as f32
    });
    ReferenceImage::new(image.unwrap()).unwrap()
}

#[test]
fn reference_textures_show_their_image() {
    let texture = reference_texture(&disc(), &ReferenceOptions::default(), Seed(1)).unwrap();
    for (at, value) in [(0.0, 1.0), (0.3, 1.0), (0.75, 0.0), (0.95, 0.0)] {
        for direction in [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::ONE.normalize()] {
            assert_eq!(
                texture.sample(direction * at),
                value,
                "at {at} of {direction}"
            );
        }
    }
}

#[test]
fn iterations_double_their_points_and_sharpen() {
    for points in [IterationPoints::Fresh, IterationPoints::Nested] {
        let options = IteratedOptions {
            points,
            ..IteratedOptions::default()
        };
        let iterations = iterated_reference(&disc(), &options, Seed(1)).unwrap();
        assert_eq!(iterations.len(), 4);
        let counts: Vec<usize> = iterations
            .iter()
            .map(|texture| texture.pups().n_points())
            .collect();
        let grays: Vec<usize> = iterations
            .iter()
            .map(|texture| {
                assert!(
                    texture
                        .values()
                        .iter()
                        .all(|value| [0.0, 1.0].contains(value)),
                    "{points:?}"
                );
                let raster = texture.to_raster(&paper_window(128)).unwrap();
                assert_eq!(
                    [raster.row(64)[64], raster.row(3)[3]],
                    [1.0, 0.0],
                    "{points:?}"
                );
                raster
                    .pixels()
                    .iter()
                    .filter(|value| (0.05..0.95).contains(*value))
                    .count()
            })
            .collect();
        for pair in counts.windows(2) {
            let ratio = pair[1] as f64 / pair[0] as f64;
            assert!((1.8..2.2).contains(&ratio), "{points:?}: {counts:?} points");
        }
        assert!(grays[3] < grays[0], "{points:?}: {grays:?} gray pixels");
        if points == IterationPoints::Nested {
            for pair in iterations.windows(2) {
                let [before, after] = [pair[0].values(), pair[1].values()];
                assert_eq!(before, &after[..before.len()], "a point has lost its label");
            }
        }
    }
}

#[test]
fn colors_come_from_the_palette() {
    let options = ColorNoiseOptions::default();
    let texture = color_noise(&options, Seed(1)).unwrap();
    assert!(
        texture
            .values()
            .iter()
            .all(|color| options.palette.contains(color)),
        "a foreign color"
    );
    for color in &options.palette {
        assert!(texture.values().contains(color), "{color:?} is missing");
    }
    let palette = vec![[1.0, 0.0], [0.0, 1.0]];
    let colored = cow(&CowOptions::default(), Seed(1))
        .unwrap()
        .with_vectors(palette)
        .unwrap();
    let window = paper_window(32);
    let raster = colored.to_raster(&window).unwrap();
    for (column, row) in [(0, 0), (5, 9), (31, 31)] {
        let color = colored.sample(window.position(column, row));
        assert_eq!(
            raster.row(row)[column as usize],
            color,
            "at {column}, {row}"
        );
    }
    assert!(colored.sample(DVec2::NAN)[0].is_nan(), "a color nowhere");
}

#[test]
fn spacings_agree() {
    let torus = Domain::paper_torus();
    let count = |spacing: Spacing| spacing.points(torus, Seed(1)).unwrap().len();
    assert_eq!(
        count(Spacing::from(0.1)),
        count(Spacing::Density((0.697 / 0.01).into()))
    );
    assert!(
        (660..740).contains(&count(Spacing::Count(700))),
        "{}",
        count(Spacing::Count(700))
    );
    let varying = Spacing::Distance(raster::Varying::function(|_| 0.1));
    // A maximal set has 279 points, with a spread of a few.
    assert!(
        (260..300).contains(&count(varying.clone())),
        "{}",
        count(varying.clone())
    );
    let four_times = count(varying.finer(2.0));
    assert!((1060..1170).contains(&four_times), "{four_times}");
}
