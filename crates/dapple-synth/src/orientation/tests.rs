//! Tests of orientation fields on surfaces with known fields.

mod symmetric;

use super::*;
use crate::links::{Links, components};
use crate::shapes::{moved, sites_on, sphere, square, tube, two_squares};
use crate::{Hierarchy, SiteIdx};
use dapple_mesh::rotation;
use proptest::prelude::*;

/// Tolerance: rounding of some hundred sums of unit vectors.
const ROUNDING: f64 = 1e-12;

fn toward(at: DVec3, vector: DVec3) -> Direction {
    Direction { at, vector }
}

/// Asserts that every vector is a unit tangent vector.
fn assert_tangent(hierarchy: &Hierarchy, orientation: &Orientation) {
    let normals = hierarchy.sites().normals();
    assert_eq!(orientation.vectors().len(), normals.len());
    for (site, (vector, normal)) in orientation.vectors().iter().zip(normals).enumerate() {
        assert!(
            (vector.length() - 1.0).abs() < ROUNDING,
            "{site}: {vector} is not a unit vector"
        );
        assert!(
            vector.dot(*normal).abs() < ROUNDING,
            "{site}: {vector} leaves the plane of {normal}"
        );
    }
}

/// Returns the site nearest to a position, by a search through all sites.
fn nearest(hierarchy: &Hierarchy, at: DVec3) -> usize {
    let positions = hierarchy.sites().positions();
    let key = |&site: &usize| (positions[site].distance(at), site);
    (0..positions.len())
        .min_by(|a, b| key(a).partial_cmp(&key(b)).unwrap())
        .unwrap()
}

#[test]
fn orientation_is_constant_on_a_plane_with_one_direction() {
    for n_levels in 1..=4 {
        let hierarchy = sites_on(square(), 2000, n_levels);
        let wanted = DVec3::new(0.6, -0.8, 0.0);
        let direction = toward(DVec3::new(0.2, 0.7, 0.1), wanted * 7.0 + DVec3::Z);
        let orientation = Orientation::new(&hierarchy, &[direction]).unwrap();
        let graph = hierarchy.levels()[0].graph();
        let components = components(graph);
        let own = components[nearest(&hierarchy, direction.at)];
        for (site, vector) in orientation.vectors().iter().enumerate() {
            // Components without the direction are oriented along the axis.
            let wanted = if components[site] == own {
                wanted
            } else {
                Orientation::AXIS
            };
            assert!(
                vector.distance(wanted) < ROUNDING,
                "{n_levels} levels, site {site}: {vector}"
            );
        }
        assert!(
            components
                .iter()
                .filter(|&&component| component == own)
                .count()
                > 1990,
            "a good graph"
        );
    }
}

#[test]
fn orientation_turns_with_the_mesh_and_the_directions() {
    let turn = rotation(DVec3::new(2.0, 3.0, 6.0) / 7.0, 0.7);
    let directions = [
        toward(DVec3::X, DVec3::Y),
        toward(DVec3::NEG_Z, DVec3::new(1.0, 1.0, 0.0)),
    ];
    let turned_directions =
        directions.map(|direction| toward(turn * direction.at, turn * direction.vector));
    let hierarchy = sites_on(sphere(), 1500, 3);
    let turned = sites_on(moved(&sphere(), |position| turn * position), 1500, 3);
    let plain = Orientation::new(&hierarchy, &directions).unwrap();
    let field = Orientation::new(&turned, &turned_directions).unwrap();
    // Rounding can move sites, so the fields are compared by position: at nearly all sites the vector equals the vector
    // of the nearest site of the other field, within the change of the field over a spacing.
    let near = (0..hierarchy.sites().len()).filter(|&site| {
        let other = nearest(&turned, turn * hierarchy.sites().positions()[site]);
        (turn * plain.vectors()[site]).distance(field.vectors()[other]) < 0.1
    });
    assert!(
        near.count() > 1470,
        "the turned field is not the field turned"
    );
}

#[test]
fn orientation_follows_a_rotation_of_the_directions() {
    let hierarchy = sites_on(square(), 1000, 3);
    let turn = rotation(DVec3::Z, 1.1);
    let directions = [
        toward(DVec3::new(0.1, 0.1, 0.0), DVec3::X),
        toward(DVec3::new(0.9, 0.5, 0.0), DVec3::new(1.0, 1.0, 0.0)),
        toward(DVec3::new(0.2, 0.8, 0.0), DVec3::new(0.9, -0.4, 0.0)),
    ];
    let turned = directions.map(|direction| toward(direction.at, turn * direction.vector));
    let plain = Orientation::new(&hierarchy, &directions).unwrap();
    let field = Orientation::new(&hierarchy, &turned).unwrap();
    let components = components(hierarchy.levels()[0].graph());
    for (site, (a, b)) in plain.vectors().iter().zip(field.vectors()).enumerate() {
        // The arithmetic is the same except for the rounding of the rotation, which the solver amplifies up to its
        // tolerance.
        assert!(
            components[site] != 0 || (turn * *a).distance(*b) < 1e-3,
            "site {site}: {a} became {b}"
        );
    }
}

#[test]
fn orientation_of_one_direction_covers_a_sphere() {
    for n_levels in [1, 3] {
        let hierarchy = sites_on(sphere(), 2000, n_levels);
        let orientation = Orientation::new(&hierarchy, &[toward(DVec3::X, DVec3::Y)]).unwrap();
        assert_tangent(&hierarchy, &orientation);
    }
}

#[test]
fn orientation_goes_through_the_directions_at_their_sites() {
    let hierarchy = sites_on(sphere(), 4000, 4);
    let directions: Vec<Direction> = (0..12)
        .map(|i| {
            // A golden-angle spiral keeps the directions apart.
            let z = (f64::from(2 * i) - 11.0) / 12.0;
            let around = rotation(DVec3::Z, 2.4 * f64::from(i));
            let at = around * DVec3::new((1.0 - z * z).sqrt(), 0.0, z);
            toward(at, DVec3::new(0.3, f64::from(i % 3) - 0.9, 1.0))
        })
        .collect();
    let orientation = Orientation::new(&hierarchy, &directions).unwrap();
    assert_tangent(&hierarchy, &orientation);
    for direction in &directions {
        let site = nearest(&hierarchy, direction.at);
        let wanted = tangent(direction.vector, hierarchy.sites().normals()[site]).unwrap();
        let found = orientation.vectors()[site];
        assert!(
            found.distance(wanted) < ROUNDING,
            "{found} instead of {wanted}"
        );
        for other in hierarchy.levels()[0]
            .graph()
            .neighbors(SiteIdx(site as u32))
        {
            let turn = orientation.vectors()[other.index()].dot(wanted);
            assert!(turn > 0.85, "the field jumps beside a direction: {turn}");
        }
    }
}

#[test]
fn orientation_solves_the_averages_on_one_level() {
    // Oracle: equation 4 with projection, repeated until it converges, as in the paper.
    let hierarchy = sites_on(sphere(), 120, 1);
    let directions = [
        toward(DVec3::X, DVec3::Y),
        toward(DVec3::Z, DVec3::X),
        toward(DVec3::NEG_Y, DVec3::X),
    ];
    let orientation = Orientation::new(&hierarchy, &directions).unwrap();
    let links = Links::new(&hierarchy, 0);
    let normals = hierarchy.sites().normals();
    let mut vectors = vec![DVec3::ZERO; links.len()];
    let mut fixed = vec![false; links.len()];
    for direction in directions {
        let site = nearest(&hierarchy, direction.at);
        vectors[site] = tangent(direction.vector, normals[site]).unwrap();
        fixed[site] = true;
    }
    for _ in 0..5000 {
        let before = vectors.clone();
        for site in (0..links.len()).filter(|&site| !fixed[site] && links.sums()[site] > 0.0) {
            let parts = links.neighbors(site).iter().zip(links.weights(site));
            let sum: DVec3 = parts
                .map(|(other, weight)| before[other.index()] * *weight)
                .sum();
            vectors[site] = flat_part(sum / links.sums()[site], normals[site]);
        }
    }
    for (site, (found, wanted)) in orientation.vectors().iter().zip(vectors).enumerate() {
        // Tolerance: the solver's 1e-5, amplified by some hundred steps across the surface.
        assert!(
            wanted == DVec3::ZERO || found.distance(wanted.normalize()) < 1e-3,
            "site {site}: {found} {wanted}"
        );
    }
}

#[test]
fn directions_at_one_site_are_averaged() {
    let hierarchy = sites_on(square(), 500, 2);
    let at = DVec3::new(0.5, 0.5, 0.0);
    let directions = [toward(at, DVec3::X), toward(at, DVec3::Y * 9.0)];
    let orientation = Orientation::new(&hierarchy, &directions).unwrap();
    let found = orientation.vectors()[nearest(&hierarchy, at)];
    let wanted = DVec3::new(1.0, 1.0, 0.0).normalize();
    assert!(found.distance(wanted) < ROUNDING, "{found}");
}

#[test]
fn directions_that_cancel_leave_the_site_to_the_others() {
    let hierarchy = sites_on(square(), 500, 3);
    let at = DVec3::new(0.5, 0.5, 0.0);
    let opposed = [toward(at, DVec3::X), toward(at, DVec3::NEG_X)];
    let alone = Orientation::new(&hierarchy, &opposed).unwrap();
    assert_eq!(alone, Orientation::new(&hierarchy, &[]).unwrap());
    let other = toward(DVec3::new(0.1, 0.1, 0.0), DVec3::Y);
    let with_other = Orientation::new(&hierarchy, &[opposed[0], other, opposed[1]]).unwrap();
    assert_eq!(with_other, Orientation::new(&hierarchy, &[other]).unwrap());
}

#[test]
fn contradictory_directions_give_unit_tangents() {
    let at = DVec3::new(0.5, 0.5, 0.0);
    let beside = DVec3::new(0.52, 0.5, 0.0);
    for n_levels in [1, 2, 4] {
        let hierarchy = sites_on(square(), 1000, n_levels);
        let directions = [toward(at, DVec3::X), toward(beside, DVec3::NEG_X)];
        let orientation = Orientation::new(&hierarchy, &directions).unwrap();
        assert_tangent(&hierarchy, &orientation);
    }
}

#[test]
fn components_without_a_direction_run_along_the_axis() {
    let hierarchy = sites_on(two_squares(), 1000, 3);
    let directions = [toward(DVec3::new(0.5, 0.5, 0.0), DVec3::X)];
    let orientation =
        Orientation::with_axis(&hierarchy, &directions, DVec3::new(-3.0, 0.0, 1.0)).unwrap();
    let mut n_above = 0;
    for (vector, at) in orientation
        .vectors()
        .iter()
        .zip(hierarchy.sites().positions())
    {
        if at.z > 1.0 {
            n_above += 1;
            assert!(vector.distance(DVec3::NEG_X) < ROUNDING, "{vector}");
        }
    }
    assert!(
        n_above > 100,
        "the upper square has a fifth of the sites: {n_above}"
    );
}

#[test]
fn axis_that_is_normal_to_the_surface_gives_way_to_another() {
    let hierarchy = sites_on(square(), 100, 2);
    let orientation = Orientation::with_axis(&hierarchy, &[], DVec3::Z).unwrap();
    assert_tangent(&hierarchy, &orientation);
    let first = orientation.vectors()[0];
    assert!(
        orientation.vectors().iter().all(|&vector| vector == first),
        "one direction for all"
    );
}

#[test]
fn orientation_of_a_function_is_projected() {
    let hierarchy = sites_on(tube(), 600, 2);
    let orientation = Orientation::from_fn(&hierarchy, |at, normal| {
        if at.z < 1.0 {
            DVec3::NAN
        } else if at.z < 2.0 {
            normal
        } else {
            DVec3::new(0.0, 0.0, 1e-200)
        }
    });
    assert_tangent(&hierarchy, &orientation);
    for (vector, at) in orientation
        .vectors()
        .iter()
        .zip(hierarchy.sites().positions())
    {
        assert!(at.z < 2.0 || vector.z > 0.99, "{vector} at {at}");
    }
}

#[test]
fn orientation_refuses_directions_without_a_tangent() {
    let hierarchy = sites_on(square(), 100, 2);
    let good = toward(DVec3::ZERO, DVec3::X);
    for bad in [
        toward(DVec3::ZERO, DVec3::ZERO),
        toward(DVec3::ZERO, DVec3::Z),
        toward(DVec3::ZERO, DVec3::new(1e-4, 0.0, 1.0)),
        toward(DVec3::ZERO, DVec3::new(f64::NAN, 1.0, 0.0)),
        toward(DVec3::ZERO, DVec3::new(f64::INFINITY, 1.0, 0.0)),
        toward(DVec3::new(0.0, f64::NAN, 0.0), DVec3::X),
    ] {
        let error = Orientation::new(&hierarchy, &[good, bad]).unwrap_err();
        assert_eq!(
            error.kind(),
            &SynthErrorKind::Direction { direction: 1 },
            "{bad:?}"
        );
    }
    for axis in [DVec3::ZERO, DVec3::NAN, DVec3::INFINITY] {
        let error = Orientation::with_axis(&hierarchy, &[], axis).unwrap_err();
        assert!(
            matches!(error.kind(), SynthErrorKind::Range { .. }),
            "{axis}: {error}"
        );
    }
}

#[test]
fn orientation_of_few_sites_holds() {
    for n_sites in [1, 2, 3, 5] {
        for n_levels in [1, 2, 3] {
            let hierarchy = sites_on(sphere(), n_sites, n_levels);
            let direction = toward(DVec3::ONE, DVec3::new(0.1, -0.2, 0.4));
            for directions in [&[][..], &[direction][..]] {
                let orientation = Orientation::new(&hierarchy, directions).unwrap();
                assert_tangent(&hierarchy, &orientation);
            }
        }
    }
}

#[test]
fn orientation_has_the_same_bits_on_any_number_of_threads() {
    let hierarchy = sites_on(sphere(), 6000, 3);
    let directions = [toward(DVec3::X, DVec3::Y), toward(DVec3::Z, DVec3::X)];
    let on = |n_threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(n_threads)
            .build()
            .unwrap();
        pool.install(|| Orientation::new(&hierarchy, &directions).unwrap())
    };
    assert_eq!(on(1), on(2), "two threads");
    assert_eq!(on(1), on(7), "seven threads");
}

#[test]
fn value_stability_tangents() {
    let normal = DVec3::new(2.0, 3.0, 6.0) / 7.0;
    let found = tangent(DVec3::new(1.0, -2.0, 0.5), normal).unwrap();
    assert_eq!(
        found.to_array(),
        [
            0.45513496321822344,
            -0.8478004216810044,
            0.27218855643442774
        ]
    );
    assert_eq!(
        axis_tangent(normal, normal).to_array(),
        [
            -0.06593406593406592,
            0.9010989010989012,
            -0.4285714285714286
        ]
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn orientation_of_any_directions_is_tangent_or_refused(
        numbers in proptest::collection::vec(prop_oneof![-2.0..2.0, Just(0.0), Just(1e300), Just(-1e-300), Just(f64::NAN)], 0..30),
        n_sites in 1_usize..200,
        n_levels in 1_usize..4,
    ) {
        let hierarchy = sites_on(two_squares(), n_sites, n_levels);
        let vector = |at: &[f64]| DVec3::new(at[0], at[1], at[2]);
        let directions: Vec<Direction> = numbers.chunks_exact(6).map(|six| toward(vector(six), vector(&six[3..]))).collect();
        match Orientation::new(&hierarchy, &directions) {
            Ok(orientation) => assert_tangent(&hierarchy, &orientation),
            Err(error) => {
                let is_direction = matches!(error.kind(), SynthErrorKind::Direction { .. });
                prop_assert!(is_direction, "{}", error);
            }
        }
    }
}
