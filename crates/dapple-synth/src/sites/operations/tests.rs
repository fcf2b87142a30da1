//! Tests of down- and upsampling against the operations they consist of.

use super::*;
use crate::shapes::{geodesic_sphere, sheets};
use crate::{HierarchyOptions, SiteIdx, SynthErrorKind};
use dapple_mesh::Surface;

/// Returns a hierarchy of three levels.
fn hierarchy(surface: &Surface, n_sites: usize) -> Hierarchy {
    let options = HierarchyOptions {
        n_sites,
        ..HierarchyOptions::default()
    };
    Hierarchy::new(surface, &options).unwrap()
}

#[test]
fn downsampling_blurs_and_inherits() {
    let hierarchy = hierarchy(&geodesic_sphere(3), 1000);
    let column: Vec<f64> = hierarchy
        .sites()
        .positions()
        .iter()
        .map(|at| at.x * at.y)
        .collect();
    let coarse = hierarchy.downsample(0, &column).unwrap();
    let mut blurred = column;
    hierarchy
        .low_pass(0)
        .unwrap()
        .apply(&mut blurred, 0.1, 20)
        .unwrap();
    assert_eq!(coarse, blurred[..250], "the first of the blurred values");
    assert_eq!(
        hierarchy.downsample(1, &coarse).unwrap().len(),
        63,
        "a quarter, rounded up"
    );
}

#[test]
fn upsampling_interpolates_at_the_finer_sites() {
    let hierarchy = hierarchy(&geodesic_sphere(3), 1000);
    let coarse: Vec<f64> = hierarchy.sites().positions()[..250]
        .iter()
        .map(|at| at.z)
        .collect();
    let fine = hierarchy.upsample(1, &coarse).unwrap();
    assert_eq!(fine.len(), 1000, "a value for each site");
    for (site, value) in fine.iter().enumerate() {
        let [position, normal] =
            [hierarchy.sites().positions(), hierarchy.sites().normals()].map(|column| column[site]);
        let expected = hierarchy.interpolate(1, &coarse, position, normal).unwrap();
        assert_eq!(Some(*value), expected, "site {site}");
    }
}

#[test]
fn constant_columns_stay_constant_up_and_down() {
    for surface in [
        geodesic_sphere(2),
        sheets(&[0.0, 0.01]),
        sheets(&[0.0, 3.0, 9.0]),
    ] {
        let hierarchy = hierarchy(&surface, 300);
        let coarse = hierarchy.downsample(0, &[[0.3_f32, 0.9]; 300]).unwrap();
        assert_eq!(coarse, [[0.3, 0.9]; 75], "down");
        let fine = hierarchy.upsample(1, &coarse).unwrap();
        assert_eq!(fine, [[0.3, 0.9]; 300], "up");
    }
}

#[test]
fn upsampling_gives_a_value_to_sites_far_from_all_coarser_ones() {
    // With so few sites, some sheets may have no site of the coarsest level.
    let heights: Vec<f64> = (0..20).map(|sheet| f64::from(sheet) * 100.0).collect();
    let hierarchy = hierarchy(&sheets(&heights), 160);
    let n_coarse = hierarchy.levels()[2].n_sites();
    let fine = hierarchy.upsample(2, &vec![7.0; n_coarse]).unwrap();
    assert!(
        fine.iter().all(|value| *value == 7.0),
        "a site was left out"
    );
}

#[test]
fn operations_have_the_same_bits_at_any_number_of_threads() {
    let hierarchy = hierarchy(&geodesic_sphere(3), 5000);
    let column: Vec<f32> = hierarchy
        .sites()
        .positions()
        .iter()
        .map(|at| at.x as f32)
        .collect();
    let round_trip = || {
        let coarse = hierarchy.downsample(0, &column).unwrap();
        hierarchy.upsample(1, &coarse).unwrap()
    };
    let expected = round_trip();
    for threads in [1, 2, 7] {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        assert!(pool.install(round_trip) == expected, "{threads} threads");
    }
}

#[test]
fn operations_refuse_levels_and_columns_that_do_not_fit() {
    let hierarchy = hierarchy(&geodesic_sphere(2), 160);
    let is_range = |error: &SynthError| matches!(error.kind(), SynthErrorKind::Range { .. });
    let is_count = |error: &SynthError| matches!(error.kind(), SynthErrorKind::Count { .. });
    let at = DVec3::X;
    assert!(
        is_range(&hierarchy.interpolate(3, &[0.0; 10], at, at).unwrap_err()),
        "no level 3"
    );
    assert!(
        is_count(&hierarchy.interpolate(0, &[0.0; 10], at, at).unwrap_err()),
        "too few values"
    );
    assert!(
        is_range(&hierarchy.low_pass(usize::MAX).unwrap_err()),
        "no such level"
    );
    assert!(
        is_range(&hierarchy.downsample(2, &[0.0; 10]).unwrap_err()),
        "nothing is coarser"
    );
    assert!(
        is_range(&hierarchy.downsample(usize::MAX, &[0.0; 10]).unwrap_err()),
        "no such level"
    );
    assert!(
        is_count(&hierarchy.downsample(0, &[0.0; 10]).unwrap_err()),
        "too few values"
    );
    assert!(
        is_range(&hierarchy.upsample(0, &[0.0; 160]).unwrap_err()),
        "nothing is finer"
    );
    assert!(
        is_range(&hierarchy.upsample(3, &[0.0; 10]).unwrap_err()),
        "no level 3"
    );
    assert!(
        is_count(&hierarchy.upsample(1, &[0.0; 41]).unwrap_err()),
        "too many values"
    );
    assert!(
        is_count(
            &hierarchy
                .upsample_into(1, &[0.0; 40], &mut [0.0; 10])
                .unwrap_err()
        ),
        "no room"
    );
}

#[test]
fn levels_are_connected_on_their_own() {
    let hierarchy = hierarchy(&geodesic_sphere(3), 1000);
    for level in hierarchy.levels() {
        assert_eq!(level.graph().len(), level.n_sites(), "a row for each site");
        let connected = (0..level.n_sites() as u32)
            .all(|site| !level.graph().neighbors(SiteIdx(site)).is_empty());
        assert!(connected, "a site of {} is alone", level.n_sites());
        assert!(
            level.one_sided_edges() < level.graph().n_edges() / 5,
            "most stars must agree"
        );
    }
}
