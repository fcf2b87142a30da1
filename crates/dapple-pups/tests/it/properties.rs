//! Tests of properties that hold for every net.

use super::sets::{cases, positions, values};
use dapple_graph::{EdgeDirection, Graph, delaunay, gabriel, k_nearest, yao};
use dapple_hash::Seed;
use dapple_points::{Domain, PointIdx, poisson_disk, white_noise};
use dapple_pups::{Orientation, Pups, PupsOptions};
use dapple_raster::FieldExt as _;
use glam::{DVec2, DVec3};

#[test]
fn values_stay_between_those_of_the_control_points() {
    for case in cases() {
        let texture = case.texture();
        let values = texture.values();
        let least = values.iter().copied().fold(f32::INFINITY, f32::min);
        let most = values.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        // A sum of at most some forty products, and a quotient: each rounds once.
        let slack = 40.0 * f32::EPSILON;
        for position in positions(case.points.domain(), 500) {
            let value = texture.sample(position);
            assert!(
                value >= least - slack && value <= most + slack,
                "{}: {value} at {position}",
                case.name
            );
        }
    }
}

#[test]
fn constants_are_reproduced() {
    for case in cases() {
        let texture = case.pups().texture(vec![0.7; case.points.len()]).unwrap();
        for position in positions(case.points.domain(), 100) {
            let off = (texture.sample(position) - 0.7).abs();
            assert!(
                off < 40.0 * f32::EPSILON,
                "{}: off by {off} at {position}",
                case.name
            );
        }
    }
}

#[test]
fn control_points_are_interpolated_up_to_axis_scale_1() {
    for case in cases().into_iter().filter(|case| {
        case.is_delaunay && case.options.axis_scale <= 1.0 && case.options.fade == 0.0
    }) {
        let texture = case.texture();
        for (point, position) in case.points.iter() {
            let (value, own) = (texture.sample(position), texture.values()[point.index()]);
            // The projection of a neighbor is 1 up to 1e-7, so that its weight is not zero but up to 1e-13, which an
            // orientation raises to the power of one minus its strength.
            let strength = case
                .options
                .orientation
                .as_ref()
                .map_or(0.0, |orientation| orientation.strength);
            let slack = 1e-6 + libm::pow(1e-13, 1.0 - strength);
            let off = f64::from(value - own).abs();
            assert!(
                off < slack,
                "{}: {value} at point {point:?} of {own}",
                case.name
            );
        }
    }
}

#[test]
fn the_mean_coverage_is_four_times_the_square_of_the_axis_scale() {
    let points = poisson_disk(Domain::paper_torus(), 0.06, Seed(5)).unwrap();
    let graph = delaunay(&points).unwrap();
    for scale in [0.6, 1.0, 1.5, 2.0] {
        let pups = Pups::new(
            &points,
            &graph,
            PupsOptions {
                axis_scale: scale,
                ..PupsOptions::default()
            },
        )
        .unwrap();
        let count = 20_000;
        let inside = positions(points.domain(), count).map(|position| pups.weights(position).len());
        let mean = inside.sum::<usize>() as f64 / count as f64;
        // Coverage varies by about one from place to place, so its mean over the samples by 0.01 at most.
        let expected = 4.0 * scale * scale;
        assert!(
            (mean / expected - 1.0).abs() < 0.01,
            "coverage is {mean} at scale {scale}, not {expected}"
        );
    }
}

#[test]
fn control_points_are_interpolated_by_delaunay_axes_only() {
    let points = poisson_disk(Domain::paper_torus(), 0.2, Seed(10)).unwrap();
    let largest_error = |graph: &Graph| {
        let pups = Pups::new(&points, graph, PupsOptions::default()).unwrap();
        let texture = pups.texture(values(points.len())).unwrap();
        let off = |(point, position): (PointIdx, DVec2)| {
            (texture.sample(position) - texture.values()[point.index()]).abs()
        };
        points.iter().map(off).fold(0.0, f32::max)
    };
    assert!(
        largest_error(&delaunay(&points).unwrap()) < 1e-6,
        "Delaunay axes interpolate"
    );
    let sparse = yao(&points, 4, EdgeDirection::Directed).unwrap();
    assert!(
        largest_error(&sparse) > 1e-3,
        "four axes cannot keep all other points out"
    );
}

#[test]
fn supports_cover_the_torus_whatever_the_graph() {
    let points = white_noise(Domain::paper_torus(), 60, Seed(11)).unwrap();
    let alone: Vec<Vec<PointIdx>> = vec![Vec::new(); 60];
    let graphs = [
        k_nearest(&points, 1, EdgeDirection::Directed).unwrap(),
        k_nearest(&points, 3, EdgeDirection::Symmetric).unwrap(),
        gabriel(&points).unwrap(),
        Graph::from_adjacency(&points, &alone).unwrap(),
    ];
    for graph in graphs {
        let pups = Pups::new(&points, &graph, PupsOptions::default()).unwrap();
        for position in positions(points.domain(), 500) {
            let total: f32 = pups
                .weights(position)
                .iter()
                .map(|(_, weight)| weight)
                .sum();
            assert!(
                (total - 1.0).abs() < 1e-5,
                "weights sum to {total} at {position}"
            );
        }
    }
}

#[test]
fn a_single_control_point_rules_everywhere() {
    let plane = white_noise(Domain::rectangle(DVec2::ZERO, DVec2::ONE), 1, Seed(6)).unwrap();
    let torus = white_noise(Domain::torus(DVec2::ZERO, DVec2::ONE), 1, Seed(6)).unwrap();
    for points in [plane, torus] {
        let texture = Pups::delaunay(&points)
            .unwrap()
            .texture(vec![0.25])
            .unwrap();
        for position in [DVec2::ZERO, DVec2::splat(0.9), DVec2::new(-1e300, 1e9)] {
            assert!((texture.sample(position) - 0.25).abs() < 1e-6, "{position}");
        }
    }
}

#[test]
fn positions_that_are_not_finite_give_one_nan() {
    let points = white_noise(
        Domain {
            wrap: [true, false],
            ..Domain::paper_torus()
        },
        20,
        Seed(7),
    )
    .unwrap();
    let pups = Pups::delaunay(&points).unwrap();
    let texture = pups.texture(values(20)).unwrap();
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for position in [
            DVec2::new(bad, 0.0),
            DVec2::new(0.0, bad),
            DVec2::splat(bad),
        ] {
            assert_eq!(
                texture.sample(position).to_bits(),
                f32::NAN.to_bits(),
                "{position}"
            );
            assert!(
                pups.weights(position).is_empty() && pups.strongest(position).is_none(),
                "{position}"
            );
        }
    }
}

#[test]
fn far_away_a_plane_has_values_and_none_is_lost() {
    let points = white_noise(Domain::rectangle(DVec2::ZERO, DVec2::ONE), 30, Seed(8)).unwrap();
    let texture = Pups::delaunay(&points)
        .unwrap()
        .texture(values(30))
        .unwrap();
    for far in [1e2, 1e5, 1e9, 1e300] {
        for direction in [
            DVec2::X,
            DVec2::Y,
            DVec2::ONE,
            DVec2::new(-1.0, 0.3),
            DVec2::NEG_Y,
        ] {
            let value = texture.sample(direction * far);
            assert!(
                (0.0..1.0).contains(&value),
                "{value} at {}",
                direction * far
            );
        }
    }
}

#[test]
fn weights_that_all_but_vanish_leave_the_nearest_value() {
    let points = poisson_disk(Domain::paper_torus(), 0.3, Seed(9)).unwrap();
    let graph = delaunay(&points).unwrap();
    let center = points.position(PointIdx(0));
    let away = |position: DVec2| {
        let vector = points.domain().delta(center + DVec2::splat(0.01), position);
        DVec3::new(vector.x, vector.y, 1e-9)
    };
    let vectors = points
        .positions()
        .iter()
        .map(|&position| away(position))
        .collect();
    let orientation = Some(Orientation::new(vectors).with_strength(0.999_999));
    let pups = Pups::new(
        &points,
        &graph,
        PupsOptions {
            orientation,
            ..PupsOptions::default()
        },
    )
    .unwrap();
    let texture = pups.texture(values(points.len())).unwrap();
    for position in positions(points.domain(), 2000) {
        let value = texture.sample(position);
        assert!((0.0..1.0).contains(&value), "{value} at {position}");
    }
}
