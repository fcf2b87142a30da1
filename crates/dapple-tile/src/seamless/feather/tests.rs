//! Tests of crossfades: their periods, kept detail, and cost.

use super::{Feather, tent};
use crate::test_fields::{fbm, gravel, seam_ratio};
use crate::{Crossfade, TileError, TileErrorKind};
use core::slice;
use dapple_raster::Raster;
use proptest::prelude::*;

const BOTH: [bool; 2] = [true; 2];

fn tile(
    planes: &[Raster<f32>],
    feather: &Feather,
    axes: [bool; 2],
) -> Result<Vec<Raster<f32>>, TileError> {
    super::tile(planes, feather, axes, &|| false)
}

fn margin(margin: u32, crossfade: Crossfade) -> Feather {
    Feather::Margin { margin, crossfade }
}

#[test]
fn tent_hides_both_places_where_an_image_has_its_ends() {
    for length in 4..40 {
        let half = length / 2;
        assert_eq!(
            [0, length - 1].map(|at| tent(at, length)),
            [0.0; 2],
            "{length}"
        );
        // The rolled image continues from its last pixel to its first between these two columns.
        let ends = [length - half - 1, length - half];
        assert_eq!(ends.map(|at| tent(at, length)), [1.0; 2], "{length}");
        assert!(
            (0..length).all(|at| (0.0..=1.0).contains(&tent(at, length))),
            "{length}"
        );
    }
}

#[test]
fn half_shift_keeps_the_size_and_shows_the_middle_at_the_border() {
    let image = Raster::from_fn([8, 5], |x, y| (x + 10 * y) as f32).unwrap();
    let tiles = tile(slice::from_ref(&image), &Feather::HalfShift, [true, false]).unwrap();
    assert_eq!(tiles[0].size(), [8, 5]);
    for row in 0..5 {
        let [from, to] = [image.row(row), tiles[0].row(row)];
        assert_eq!(
            [to[0], to[7]],
            [from[4], from[3]],
            "the middle at the border"
        );
        assert_eq!(to[3..5], from[3..5], "the image in its middle");
        // A third of pixel 1 plus two thirds of pixel 5.
        let expected = from[1] / 3.0 + from[5] * (1.0 - 1.0 / 3.0);
        assert!((to[1] - expected).abs() < 1e-5, "{} and {expected}", to[1]);
    }
}

#[test]
fn half_shift_along_y_is_half_shift_along_x_of_the_turned_image() {
    let image = gravel(3, [20, 13], false);
    let turned = crate::test_fields::turned(&image);
    let down = tile(&[image], &Feather::HalfShift, [false, true]).unwrap();
    let right = tile(&[turned], &Feather::HalfShift, [true, false]).unwrap();
    assert_eq!(crate::test_fields::turned(&down[0]), right[0]);
}

#[test]
fn margin_mixes_the_ends_linearly() {
    let image = Raster::from_vec([6, 1], vec![1.0, 5.0, 9.0, 2.0, 3.0, 8.0]).unwrap();
    let feather = margin(2, Crossfade::Linear);
    let tiles = tile(&[image], &feather, [true, false]).unwrap();
    // Weights ¼ and ¾ of the first pixels; all numbers are exact in binary.
    assert_eq!(
        tiles[0].pixels(),
        [0.25 + 0.75 * 3.0, 0.75 * 5.0 + 0.25 * 8.0, 9.0, 2.0]
    );
}

#[test]
fn margin_that_keeps_variance_keeps_contrast_where_the_linear_one_does_not() {
    let mut share = [0.0; 2];
    for seed in 0..16 {
        let image = gravel(seed, [96, 96], false);
        let whole = image.statistics().deviation;
        for (share, crossfade) in share
            .iter_mut()
            .zip([Crossfade::KeepVariance, Crossfade::Linear])
        {
            let tile = tile(slice::from_ref(&image), &margin(32, crossfade), BOTH)
                .unwrap()
                .remove(0);
            let mixed = tile.crop([8, 8], [16, 16]).unwrap();
            *share += mixed.statistics().deviation / whole / 16.0;
        }
    }
    // The center of both margins, 16 × 16 pixels, is a small sample with an error of a few percent.
    assert!((0.9..1.1).contains(&share[0]), "keeps {}", share[0]);
    assert!(share[1] < 0.75, "flattens to {}", share[1]);
}

#[test]
fn tiles_have_no_seam() {
    for (feather, side) in [
        (Feather::HalfShift, 128),
        (margin(32, Crossfade::Linear), 160),
        (margin(32, Crossfade::KeepVariance), 160),
    ] {
        for texture in [fbm, gravel] {
            let ratios = (0..8).map(|seed| {
                let image = texture(seed, [side, side], false);
                seam_ratio(&tile(&[image], &feather, BOTH).unwrap()[0], 1) / 8.0
            });
            let ratio: f64 = ratios.sum();
            // A half shift has the source at the border, and flattened detail elsewhere, so the ratio is above 1 there.
            assert!((0.8..1.5).contains(&ratio), "{feather:?}: {ratio}");
        }
    }
}

#[test]
fn tile_refuses_sides_that_are_too_short() {
    for (size, axes) in [
        ([3, 9], [true, false]),
        ([9, 1], [false, true]),
        ([1, 1], BOTH),
    ] {
        let image = gravel(1, size, false);
        let kind = |feather| {
            tile(slice::from_ref(&image), &feather, axes)
                .unwrap_err()
                .kind()
                .clone()
        };
        assert!(matches!(
            kind(Feather::HalfShift),
            TileErrorKind::TooSmall { least: 4, .. }
        ));
        assert!(matches!(
            kind(margin(9, Crossfade::Linear)),
            TileErrorKind::Margin { .. }
        ));
        assert!(matches!(
            kind(margin(u32::MAX, Crossfade::Linear)),
            TileErrorKind::Margin { .. }
        ));
        let zero = kind(margin(0, Crossfade::Linear));
        assert!(matches!(zero, TileErrorKind::Range { .. }), "{zero:?}");
        assert!(
            tile(slice::from_ref(&image), &Feather::HalfShift, [false; 2]).is_ok(),
            "nothing to do"
        );
    }
}

proptest! {
    #[test]
    fn tiles_of_any_size_have_their_size_or_are_refused(
        size in [1_u32..14, 1_u32..14], width in 0_u32..9, axes: [bool; 2], linear: bool,
    ) {
        let image = gravel(1, size, false);
        let crossfade = if linear { Crossfade::Linear } else { Crossfade::KeepVariance };
        for (feather, less) in [(Feather::HalfShift, 0), (margin(width, crossfade), width)] {
            match tile(slice::from_ref(&image), &feather, axes) {
                Ok(tiles) => {
                    let expected = [0, 1].map(|axis| size[axis] - if axes[axis] { less } else { 0 });
                    prop_assert_eq!(tiles[0].size(), expected);
                    prop_assert!(tiles[0].pixels().iter().all(|value| value.is_finite()));
                }
                Err(error) => prop_assert!(matches!(
                    error.kind(),
                    TileErrorKind::TooSmall { .. } | TileErrorKind::Margin { .. } | TileErrorKind::Range { .. }
                ), "{}", error),
            }
        }
    }
}

#[test]
fn value_stability_feather() {
    let image = gravel(9, [40, 36], false);
    let bits = |feather| {
        let tiles = tile(slice::from_ref(&image), &feather, BOTH).unwrap();
        [[0, 0], [5, 3], [11, 20]].map(|[x, y]: [usize; 2]| tiles[0].row(y as u32)[x].to_bits())
    };
    assert_eq!(
        bits(Feather::HalfShift),
        [1050621739, 1046275844, 1052337054]
    );
    assert_eq!(
        bits(margin(12, Crossfade::KeepVariance)),
        [1062187046, 1047518838, 1057825057]
    );
}
