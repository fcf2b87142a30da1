//! Tests of the reconstruction from bands.

use super::*;
use crate::WaveletErrorKind;
use crate::oracle::{all_filters, noise};

const PERIODIC: [Border; 2] = [Border::Periodic; 2];

fn noise_raster(size: [u32; 2]) -> Raster<f32> {
    let values = noise(size[0] as usize * size[1] as usize);
    Raster::from_vec(size, values.iter().map(|&value| value as f32).collect()).expect("a good size")
}

#[test]
fn synthesize_undoes_analyze() {
    for filter in all_filters() {
        for (size, levels, borders) in [
            ([32, 16], 3, PERIODIC),
            ([32, 16], 0, PERIODIC),
            ([29, 18], 2, [Border::Mirror; 2]),
            ([12, 7], 1, [Border::Periodic, Border::Mirror]),
        ] {
            let raster = noise_raster(size);
            let bands = filter
                .analyze(&raster, levels, borders)
                .expect("a good raster");
            assert_eq!(
                bands.details.len(),
                levels as usize,
                "a detail for each level"
            );
            let again = filter.synthesize(&bands, borders).expect("its own bands");
            let gaps = again
                .pixels()
                .iter()
                .zip(raster.pixels())
                .map(|(a, b)| (a - b).abs());
            let gap = gaps.fold(0.0, f32::max);
            // Tolerance: two roundings to f32 per level, of values up to 2.
            assert!(gap < 1e-6, "{filter:?}, {size:?}, {levels} levels: {gap}");
        }
    }
}

#[test]
fn analyze_of_no_levels_is_the_raster() {
    let raster = noise_raster([5, 3]);
    let bands = SplineFilter::default()
        .analyze(&raster, 0, PERIODIC)
        .expect("zero levels");
    assert_eq!(
        bands,
        Bands {
            details: vec![],
            coarse: raster
        },
        "zero levels"
    );
}

#[test]
fn details_are_what_is_lost() {
    let filter = SplineFilter::default();
    let raster = noise_raster([24, 16]);
    let bands = filter.analyze(&raster, 2, PERIODIC).expect("a good raster");
    let kept = filter.project(&raster, 1, PERIODIC).expect("a good raster");
    let lost = raster
        .zip_map(&kept, |fine, kept| fine - kept)
        .expect("equal sizes");
    assert_eq!(bands.details[0], lost, "the first detail");
    assert_eq!(bands.details[1].size(), [12, 8], "the second detail");
    assert_eq!(bands.coarse.size(), [6, 4], "the rest");
    // Halving the detail again gives zero.
    let rest = filter
        .down(&bands.details[0], PERIODIC)
        .expect("a good raster");
    assert!(
        rest.pixels().iter().all(|value| value.abs() < 1e-6),
        "{rest:?}"
    );
}

#[test]
fn bad_bands_are_refused() {
    let filter = SplineFilter::default();
    let raster = noise_raster([12, 8]);
    let error = filter
        .analyze(&raster, 3, PERIODIC)
        .expect_err("12 is not a multiple of 8");
    let kind = WaveletErrorKind::NotDivisible {
        length: 12,
        levels: 3,
    };
    assert_eq!(*error.kind(), kind, "{error}");
    let good = filter.analyze(&raster, 2, PERIODIC).expect("a good raster");
    let mut bands = good.clone();
    bands.details.swap(0, 1);
    let error = filter
        .synthesize(&bands, PERIODIC)
        .expect_err("details in the wrong order");
    assert!(
        matches!(error.kind(), WaveletErrorKind::Length { .. }),
        "{error}"
    );
    let mut bands = good.clone();
    bands.details[0].pixels_mut()[7] = f32::NAN;
    let error = filter
        .synthesize(&bands, PERIODIC)
        .expect_err("NaN in a detail");
    assert!(
        matches!(error.kind(), WaveletErrorKind::NotFinite { index: 7, .. }),
        "{error}"
    );
    let mut bands = good;
    bands.coarse.pixels_mut()[1] = f32::NAN;
    let error = filter
        .synthesize(&bands, PERIODIC)
        .expect_err("NaN in the rest");
    assert!(
        matches!(error.kind(), WaveletErrorKind::NotFinite { index: 1, .. }),
        "{error}"
    );
}
