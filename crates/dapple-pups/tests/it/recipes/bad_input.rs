//! Tests that invalid input gives an error with the limit.

use super::common::paper_window;
use dapple_hash::Seed;
use dapple_points::{Domain, PointSet, poisson_disk};
use dapple_pups::*;
use dapple_raster::{Field, FieldExt as _, Ramp, Raster, Varying};
use glam::{DVec2, DVec3};

fn points() -> PointSet {
    poisson_disk(Domain::paper_torus(), 0.3, Seed(1)).unwrap()
}

#[track_caller]
fn assert_range<T>(result: Result<T, PupsError>) {
    let kind = result.err().map(|error| error.kind().clone());
    assert!(
        matches!(kind, Some(PupsErrorKind::Range { .. })),
        "{kind:?}"
    );
}

#[test]
fn attributes_out_of_range_are_refused() {
    let points = points();
    for probability in [-0.1, 1.1, f64::NAN] {
        assert_range(biased_labels(&points, &probability.into(), Seed(1)));
    }
    for value in [f64::NAN, 1e39] {
        assert_range(varying_values(&points, &value.into()));
    }
    assert_range(random_labels(5, 0, Seed(1)));
    assert_range(angle_orientations(&points, &f64::INFINITY.into()));
    assert_range(outward_orientations(&points, DVec2::new(0.0, f64::NAN)));
    for intensity in [-0.01, 1.01, f32::NAN] {
        let image = Raster::from_vec([2, 1], vec![0.5, intensity]).unwrap();
        assert_range(ReferenceImage::new(image));
    }
    let graph = graph::delaunay(&points).unwrap();
    for sizes in [[0, 3], [4, 3], [3, 17]] {
        assert_range(grouped_labels(&graph, sizes, Seed(1)));
    }
    let none = palette_values::<3>(&[0], &[]).unwrap_err();
    assert!(matches!(none.kind(), PupsErrorKind::Count { .. }), "{none}");
}

#[test]
fn recipe_options_out_of_range_are_refused() {
    let probability = Varying::function(|at| at.x);
    assert_range(cow(
        &CowOptions {
            probability,
            ..CowOptions::default()
        },
        Seed(1),
    ));
    let net = NetOptions {
        strength: 1.0,
        ..NetOptions::randomly_oriented()
    };
    assert_range(cells(
        &CellsOptions {
            net,
            ..CellsOptions::default()
        },
        Seed(1),
    ));
    let net = NetOptions {
        orientations: Orientations::Same(DVec3::ZERO),
        ..NetOptions::default()
    };
    assert_range(noise(
        &NoiseOptions {
            net,
            ..NoiseOptions::default()
        },
        Seed(1),
    ));
    let net = NetOptions {
        axis_scale: 0.5,
        ..NetOptions::default()
    };
    assert_range(noise(
        &NoiseOptions {
            net,
            ..NoiseOptions::default()
        },
        Seed(1),
    ));
    for pairs in [[2, 5], [20, 10], [10, 257]] {
        let options = SpaceGiraffeOptions {
            pairs,
            ..SpaceGiraffeOptions::default()
        };
        assert_range(space_giraffe(&options, Seed(1)));
    }
}

#[test]
fn numbers_of_layers_and_iterations_out_of_range_are_refused() {
    for points_per_cell in [[0, 1], [4, 3], [1, 99]] {
        let options = CellsOptions {
            points_per_cell,
            ..CellsOptions::default()
        };
        assert_range(cells(&options, Seed(1)));
    }
    for layers in [0, 17] {
        let options = CellularNoiseOptions {
            layers,
            ..CellularNoiseOptions::default()
        };
        assert_range(cellular_noise(&options, Seed(1)));
    }
    let image = ReferenceImage::new(Raster::filled([1, 1], 0.5).unwrap()).unwrap();
    for iterations in [0, 17] {
        let options = IteratedOptions {
            iterations,
            ..IteratedOptions::default()
        };
        assert_range(iterated_reference(&image, &options, Seed(1)));
    }
    let ramp = Ramp {
        from: DVec2::NEG_Y,
        to: DVec2::Y,
        start: 0.1,
        end: 0.2,
    };
    let options = IteratedOptions {
        spacing: Spacing::Distance(ramp.into()),
        points: IterationPoints::Nested,
        ..IteratedOptions::default()
    };
    let error = iterated_reference(&image, &options, Seed(1)).unwrap_err();
    assert!(
        matches!(error.kind(), PupsErrorKind::SpacingVaries),
        "{error}"
    );
    let palette = Vec::new();
    assert_range(color_noise(
        &ColorNoiseOptions {
            palette,
            ..ColorNoiseOptions::default()
        },
        Seed(1),
    ));
}

#[test]
fn labels_without_a_value_are_refused() {
    let points = points();
    let pups = Pups::delaunay(&points).unwrap();
    let n_points = points.len();
    let count = |labels: Vec<u32>, values: Vec<f32>| {
        let error = LabelTexture::new(pups.clone(), labels, values).unwrap_err();
        assert!(
            matches!(error.kind(), PupsErrorKind::Count { .. }),
            "{error}"
        );
    };
    count(vec![0; n_points + 1], vec![1.0]);
    count(vec![1; n_points], vec![1.0]);
    count(vec![u32::MAX; n_points], vec![]);
    assert_range(LabelTexture::new(
        pups.clone(),
        vec![0; n_points],
        vec![f32::NAN],
    ));
    let texture = LabelTexture::new(pups, vec![0; n_points], vec![1.0]).unwrap();
    let mut small = Raster::filled([3, 4], 0.0).unwrap();
    assert!(
        texture.render(&paper_window(4), small.view_mut()).is_err(),
        "a wrong size was accepted"
    );
    assert!(texture.sample(DVec2::INFINITY).is_nan(), "a value nowhere");
    assert_eq!(texture.label(DVec2::NAN), None);
}
