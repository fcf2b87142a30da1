//! Tests of conformal scales on fields with a known conformal factor.

use super::shifts;
use crate::shapes::{sites_on, sphere, square, torus, two_squares};
use crate::{Hierarchy, HierarchyOptions, Orientation, SiteIdx, Symmetry};
use glam::DVec3;

/// Asserts that the scales are proportional to `wanted` at the sites for which `counts` holds. `most` is the maximum
/// relative error, as a root mean square.
fn assert_in_proportion(
    hierarchy: &Hierarchy,
    orientation: &Orientation,
    wanted: impl Fn(DVec3) -> f64,
    counts: impl Fn(DVec3) -> bool,
    most: f64,
) {
    let scales = orientation
        .conformal_scales(hierarchy, [0.125, 8.0])
        .unwrap();
    let positions = hierarchy.sites().positions();
    let logs: Vec<f64> = scales
        .iter()
        .zip(positions)
        .filter(|&(_, &at)| counts(at))
        .map(|(&scale, &at)| libm::log(f64::from(scale) / wanted(at)))
        .collect();
    assert!(logs.len() > 500, "only {} sites count", logs.len());
    let mean = logs.iter().sum::<f64>() / logs.len() as f64;
    let squares = logs.iter().map(|log| (log - mean) * (log - mean));
    let deviation = (squares.sum::<f64>() / logs.len() as f64).sqrt();
    assert!(deviation < most, "off by {deviation} on the average");
}

#[test]
fn sizes_grow_with_the_distance_from_the_middle_of_rays_and_circles() {
    // The conformal maps are logarithms, whose derivative is the inverse of the distance.
    let middle = DVec3::new(-0.3, 0.5, 0.0);
    for n_levels in [1, 3] {
        let hierarchy = sites_on(square(), 2000, n_levels);
        let rays = Orientation::from_fn(&hierarchy, |at, _| at - middle);
        let circles = Orientation::from_fn(&hierarchy, |at, normal| normal.cross(at - middle));
        for orientation in [rays, circles] {
            let distance = |at: DVec3| at.distance(middle);
            // Tolerance: rotation rates are first-order fits, and values are interpolated between the 130 sites of the
            // coarsest level.
            assert_in_proportion(&hierarchy, &orientation, distance, |_| true, 0.03);
        }
    }
}

#[test]
fn sizes_are_those_of_mercator_on_a_sphere_and_follow_the_rings_of_a_torus() {
    let hierarchy = sites_on(sphere(), 4000, 2);
    let meridians = Orientation::from_fn(&hierarchy, |_, normal| {
        DVec3::Z - normal * normal.dot(DVec3::Z)
    });
    let from_axis = |at: DVec3| at.truncate().length();
    // At the poles the scale is 0.
    let is_far = |at: DVec3| from_axis(at) > 0.3;
    assert_in_proportion(&hierarchy, &meridians, from_axis, is_far, 0.05);

    let options = HierarchyOptions {
        n_sites: 4000,
        n_levels: 2,
        ..HierarchyOptions::default()
    };
    let hierarchy = Hierarchy::new(&torus(64, 32), &options).unwrap();
    let around = Orientation::from_fn(&hierarchy, |at, _| DVec3::Z.cross(at));
    assert_in_proportion(&hierarchy, &around, from_axis, |_| true, 0.03);
}

#[test]
fn sizes_are_alike_along_a_straight_field_and_along_turns_of_it() {
    let hierarchy = sites_on(square(), 2000, 2);
    let straight = Orientation::from_fn(&hierarchy, |_, _| DVec3::new(0.6, -0.8, 0.0));
    for scale in straight.conformal_scales(&hierarchy, [0.5, 1.0]).unwrap() {
        // In logarithms, the center of the bounds is their geometric mean.
        assert!((scale - 0.5_f32.sqrt()).abs() < 1e-6, "{scale}");
    }
    // This field has cuts between eight singularities.
    let hierarchy = sites_on(sphere(), 2000, 2);
    let (axis, symmetry) = (Orientation::AXIS, Symmetry::Four);
    let four = Orientation::symmetric(&hierarchy, &[], axis, symmetry).unwrap();
    let sizes = four.conformal_scales(&hierarchy, [0.125, 8.0]).unwrap();
    let graph = hierarchy.levels()[0].graph();
    for site in 0..sizes.len() {
        for other in graph.neighbors(SiteIdx(site as u32)) {
            let ratio = sizes[site] / sizes[other.index()];
            assert!((0.8..1.25).contains(&ratio), "no jump at cuts: {ratio}");
        }
    }
}

#[test]
fn parts_that_are_not_connected_have_sizes_of_their_own() {
    let hierarchy = sites_on(two_squares(), 2000, 2);
    let middle = DVec3::new(-0.2, 0.5, 0.0);
    let rays = Orientation::from_fn(&hierarchy, |at, _| at - middle);
    let bounds = [0.7, 1.3];
    let scales = rays.conformal_scales(&hierarchy, bounds).unwrap();
    let graph = hierarchy.levels()[0].graph();
    let components = crate::links::components(graph);
    for component in 0..2 {
        let of_component = scales.iter().zip(&components);
        let of_component = of_component.filter(|&(_, &other)| other == component);
        let (least, most) = of_component.fold((8.0_f32, 0.0_f32), |(least, most), (&scale, _)| {
            (least.min(scale), most.max(scale))
        });
        assert!(bounds[0] <= least && most <= bounds[1], "{least} to {most}");
        assert!(least < 1.0 && most > 0.95, "{component}: {least} to {most}");
    }
}

#[test]
fn shifts_take_the_longest_run_to_the_middle_of_the_bounds() {
    let values = [5.0, 0.0, 0.5, 9.0, 1.0, 9.25, 30.0];
    // The values 0, 0.5 and 1 of component 0 are the longest run within a width of 1, and are centered.
    let found = shifts(&[0, 0, 0, 0, 0, 0, 1], &values, [2.0, 3.0]);
    assert_eq!(found, [2.0, -27.5]);
    assert!(shifts(&[], &[], [0.0, 1.0]).is_empty());
}

#[test]
fn value_stability_conformal_scales() {
    let hierarchy = sites_on(sphere(), 300, 2);
    let field = Orientation::from_fn(&hierarchy, |at, normal| normal.cross(at + DVec3::X));
    let scales = field.conformal_scales(&hierarchy, [0.5, 2.0]).unwrap();
    let some: Vec<f32> = scales.iter().step_by(60).copied().collect();
    assert_eq!(
        some,
        [1.5698905, 1.6340414, 1.019497, 1.7547146, 1.2257903],
        "some sizes"
    );
}
