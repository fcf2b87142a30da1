//! Tests that the models are closed, connected, and have the requested number of triangles.

use super::{blended_tori, bunny, elephant, octopus, ray, zebra};
use crate::polygonize::tests::euler;
use crate::{ModelError, ModelErrorKind};
use dapple_mesh::Mesh;
use glam::DVec3;

type Model = fn(usize) -> Result<Mesh, ModelError>;

const MODELS: [(&str, Model, i64); 6] = [
    ("ray", ray, 2),
    ("octopus", octopus, 2),
    ("bunny", bunny, 2),
    ("blended_tori", blended_tori, -12),
    ("zebra", zebra, 2),
    ("elephant", elephant, 2),
];

#[test]
fn models_have_their_topology_and_number_of_triangles() {
    for (name, model, characteristic) in MODELS {
        for wanted in [2000, 6_000] {
            let mesh = model(wanted).expect("the number is good");
            assert_eq!(mesh.faces().len(), wanted, "{name}");
            assert_eq!(euler(&mesh), characteristic, "{name} with {wanted}");
        }
    }
}

#[test]
fn models_are_about_two_units_large() {
    for (name, model, _) in MODELS {
        let mesh = model(2000).expect("the number is good");
        let low = mesh
            .positions()
            .iter()
            .fold(DVec3::INFINITY, |low, at| low.min(*at));
        let high = mesh
            .positions()
            .iter()
            .fold(DVec3::NEG_INFINITY, |high, at| high.max(*at));
        let size = (high - low).max_element();
        assert!((1.8..2.6).contains(&size), "{name}: {size}");
        let off = ((low + high) * 0.5).abs().max_element();
        assert!(off < 0.3, "{name}: {off} from the origin");
    }
}

#[test]
fn places_lie_on_their_models() {
    let places: [(Model, &[DVec3]); 5] = [
        (ray, &[ray::SNOUT, ray::LEFT_WING, ray::TAIL]),
        (octopus, &[octopus::CROWN]),
        (bunny, &[bunny::NOSE, bunny::LEFT_EAR, bunny::TAIL]),
        (zebra, &[zebra::MUZZLE, zebra::BACK]),
        (
            elephant,
            &[elephant::TRUNK, elephant::FOREHEAD, elephant::BACK],
        ),
    ];
    for (model, places) in places {
        let mesh = model(12_000).expect("the number is good");
        for &place in places {
            let nearest = mesh.positions().iter().map(|at| at.distance(place));
            let nearest = nearest.fold(f64::INFINITY, f64::min);
            // About the length of an edge.
            assert!(nearest < 0.03, "{place}: {nearest}");
        }
    }
}

#[test]
fn a_number_of_triangles_out_of_range_is_refused() {
    for (name, model, _) in MODELS {
        let error = model(3).expect_err("three triangles close nothing");
        assert!(
            matches!(error.kind(), ModelErrorKind::Range { .. }),
            "{name}: {error}"
        );
    }
}
