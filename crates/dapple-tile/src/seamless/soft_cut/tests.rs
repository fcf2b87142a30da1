//! Tests of soft cuts: unchanged pixels, periods, and the quality of the seam on two textures.

use super::{SoftCut, Widths, differences};
use crate::test_fields::{fbm, gravel, same_on_threads, seam_ratio, step_at, top_power, turned};
use crate::{Crossfade, TileError, TileErrorKind};
use core::slice;
use dapple_raster::Raster;
use proptest::prelude::*;

const BOTH: [bool; 2] = [true; 2];

fn tile(
    planes: &[Raster<f32>],
    cut: &SoftCut,
    axes: [bool; 2],
) -> Result<Vec<Raster<f32>>, TileError> {
    super::tile(planes, cut, axes, &|| false)
}

fn cut(margin: u32, half_width: f32) -> SoftCut {
    SoftCut {
        margin: Some(margin),
        half_width: Some(half_width),
        ..SoftCut::default()
    }
}

#[test]
fn tile_is_smaller_by_the_margin_and_keeps_what_is_past_it() {
    let image = gravel(1, [70, 60], false);
    for (axes, size) in [
        ([false; 2], [70, 60]),
        ([true, false], [54, 60]),
        ([false, true], [70, 44]),
        (BOTH, [54, 44]),
    ] {
        let tiles = tile(slice::from_ref(&image), &cut(16, 4.0), axes).unwrap();
        assert_eq!(tiles[0].size(), size, "{axes:?}");
        let first = axes.map(|repeats| if repeats { 16 } else { 0 });
        let inside = [size[0] - first[0], size[1] - first[1]];
        let kept = image.crop(first, inside).unwrap();
        assert_eq!(tiles[0].crop(first, inside).unwrap(), kept, "{axes:?}");
    }
}

#[test]
fn tile_of_a_hard_cut_changes_once_per_row_from_the_last_columns_to_the_first() {
    let image = fbm(2, [64, 40], false);
    let tiles = tile(slice::from_ref(&image), &cut(20, 0.0), [true, false]).unwrap();
    for row in 0..40 {
        let [from, to] = [image.row(row), tiles[0].row(row)];
        let end = (0..20)
            .take_while(|&x| to[x] == from[44 + x] && to[x] != from[x])
            .count();
        assert_eq!(to[end..], from[end..44], "row {row}");
        assert!(end < 20, "row {row}");
    }
}

#[test]
fn tile_never_touches_the_columns_that_meet_outside_of_the_margin() {
    // Even a ramp as wide as the margin ends inside it, so the tile is continuous where it is not cut.
    for (margin, half_width) in [(1, 0.5), (2, 1.0), (5, 2.5), (8, 4.0), (9, 4.2)] {
        let image =
            Raster::from_fn([40, 30], |x, y| if x < 20 { x } else { x + y } as f32).unwrap();
        let tiles = tile(
            slice::from_ref(&image),
            &cut(margin, half_width),
            [true, false],
        )
        .unwrap();
        assert_eq!(tiles[0].width(), 40 - margin);
        for row in 0..30 {
            let rest = margin as usize..(40 - margin) as usize;
            assert_eq!(
                tiles[0].row(row)[rest.clone()],
                image.row(row)[rest],
                "margin {margin}"
            );
        }
    }
}

#[test]
fn tile_of_an_image_that_repeats_is_the_image() {
    let source = fbm(3, [48, 48], true);
    let image = source.tile([2, 2]).unwrap().crop([0, 0], [64, 64]).unwrap();
    for crossfade in [Crossfade::KeepVariance, Crossfade::Linear] {
        let cut = SoftCut {
            margin: Some(16),
            half_width: Some(4.0),
            crossfade,
        };
        let tiles = tile(slice::from_ref(&image), &cut, BOTH).unwrap();
        let pixels = tiles[0].pixels().iter().zip(source.pixels());
        let worst = pixels.fold(0.0_f32, |worst, (a, b)| worst.max((a - b).abs()));
        // Equal values are blended in `f64` by shares whose sum is 1 up to rounding.
        assert!(worst < 1e-6, "{crossfade:?}: {worst}");
    }
}

#[test]
fn tile_cuts_all_planes_alike_whatever_their_units() {
    let [height, shade] = [fbm(4, [90, 80], false), gravel(5, [90, 80], false)];
    // Scales that are powers of two do not change a bit of the result.
    let scaled = [
        height.map(|value| value * 1024.0),
        shade.map(|value| value / 256.0),
    ];
    let cut = cut(24, 4.0);
    let tiles = tile(&[height.clone(), shade.clone()], &cut, BOTH).unwrap();
    let scaled = tile(&scaled, &cut, BOTH).unwrap();
    assert_eq!(scaled[0], tiles[0].map(|value| value * 1024.0));
    assert_eq!(scaled[1], tiles[1].map(|value| value / 256.0));
    let twice = tile(&[height.clone(), height.clone()], &cut, BOTH).unwrap();
    assert_eq!(twice[0], twice[1], "one cut for both");
    assert_eq!(twice[0], tile(&[height], &cut, BOTH).unwrap()[0]);
}

#[test]
fn differences_are_squares_over_the_variance_of_each_plane() {
    let a = Raster::from_vec([4, 1], vec![0.0, 2.0, 4.0, 2.0]).unwrap();
    let flat = Raster::filled([4, 1], 3.0).unwrap();
    // The variance is 2; column 0 differs by 4, column 1 by 0.
    let differences = differences(
        &[a, flat],
        Widths {
            margin: 2,
            half_width: 0.0,
        },
        &|| false,
    )
    .unwrap();
    let [first, second] = [differences.row(0)[0], differences.row(0)[1]];
    assert!(
        (first - 8.0).abs() < 1e-12 && second == 0.0,
        "{first}, {second}"
    );
}

/// Returns four ratios of 24 tiles to their sources: the mean seam at 1 and at 4 pixels, the power of the top octave,
/// and the steps across the center of all cuts.
fn quality(texture: fn(u64, [u32; 2], bool) -> Raster<f32>) -> [f64; 4] {
    let cut = SoftCut::default();
    let sums = (0..24).map(|seed| {
        let image = texture(seed, [160, 160], false);
        let tile = tile(slice::from_ref(&image), &cut, BOTH).unwrap().remove(0);
        // Include a pixel past each end, so that differences across the wrap count, too.
        let wrapped = tile.tile([2, 2]).unwrap().crop([0, 0], [132, 132]).unwrap();
        let steps = |raster: &Raster<f32>| {
            let turned = turned(raster);
            (4..28)
                .map(|at| step_at(raster, at, 1) + step_at(&turned, at, 1))
                .sum::<f64>()
        };
        [
            [
                seam_ratio(&tile, 1),
                seam_ratio(&tile, 4),
                top_power(&wrapped),
                steps(&tile),
            ],
            [1.0, 1.0, top_power(&image), steps(&image)],
        ]
    });
    let sums = sums.fold([[0.0; 4]; 2], |sum, one| {
        [0, 1].map(|part| [0, 1, 2, 3].map(|at| sum[part][at] + one[part][at]))
    });
    [0, 1, 2, 3].map(|at| sums[0][at] / sums[1][at])
}

#[test]
fn tile_has_no_seam_and_all_detail_on_noise_and_on_grains() {
    for (name, texture) in [
        ("fbm", fbm as fn(u64, [u32; 2], bool) -> _),
        ("gravel", gravel),
    ] {
        let [seam_1, seam_4, top, steps] = quality(texture);
        println!("{name}: seam ratios {seam_1:.3} {seam_4:.3}, top {top:.3}, margin {steps:.3}");
        assert!(
            (0.9..=1.1).contains(&seam_1),
            "{name}: seam ratio at 1 px is {seam_1}"
        );
        assert!(
            (0.9..=1.1).contains(&seam_4),
            "{name}: seam ratio at 4 px is {seam_4}"
        );
        assert!(
            (0.98..=1.02).contains(&top),
            "{name}: power of the top octave {top}"
        );
        // The cut itself is not a seam: steps in the margin that it crosses equal the steps of the source.
        assert!(
            (0.95..=1.05).contains(&steps),
            "{name}: steps in the margin {steps}"
        );
    }
}

#[test]
fn default_widths_grow_with_the_image() {
    let widths = |size: [u32; 2]| {
        let cut = SoftCut::default();
        let margin = cut.margin_of(size);
        (margin, cut.half_width_of(margin))
    };
    // A quarter of tiny images, 32 pixels up to a side of 256, and an eighth above.
    for (size, expected) in [
        ([1, 1], (1, 0.5)),
        ([20, 40], (5, 2.5)),
        ([160, 160], (32, 4.0)),
        ([256, 900], (32, 4.0)),
        ([4000, 3000], (375, 23.4375)),
    ] {
        assert_eq!(widths(size), expected, "{size:?}");
    }
    let image = gravel(1, [800, 700], false);
    let tiles = tile(&[image], &SoftCut::default(), BOTH).unwrap();
    assert_eq!(tiles[0].size(), [800 - 87, 700 - 87]);
}

#[test]
fn default_weights_stay_within_the_two_sides() {
    // Both sides are dark bars on a bright ground, at other heights: variance-preserving weights get darker than black.
    let bars = Raster::from_fn([96, 96], |x, y| {
        let bar = if x < 48 { 20..50 } else { 40..70 };
        if bar.contains(&y) { 0.0 } else { 1.0 }
    })
    .unwrap();
    let range = |cut| {
        let tiles = tile(slice::from_ref(&bars), &cut, [true, false]).unwrap();
        tiles[0].statistics()
    };
    let linear = range(SoftCut::default());
    assert!(linear.min >= 0.0 && linear.max <= 1.0, "{linear:?}");
    let kept = range(SoftCut {
        crossfade: Crossfade::KeepVariance,
        ..SoftCut::default()
    });
    assert!(kept.min < -0.01, "{kept:?}");
}

#[test]
fn tile_refuses_margins_and_widths_that_do_not_fit() {
    let image = fbm(1, [10, 31], false);
    let kind = |margin, half_width, axes| {
        let planes = [image.clone()];
        tile(&planes, &cut(margin, half_width), axes)
            .unwrap_err()
            .kind()
            .clone()
    };
    let too_wide = TileErrorKind::Margin {
        margin: 6,
        length: 10,
        most: 5,
    };
    assert_eq!(kind(6, 1.0, [true, false]), too_wide);
    let too_wide = TileErrorKind::Margin {
        margin: 16,
        length: 31,
        most: 15,
    };
    assert_eq!(kind(16, 1.0, [false, true]), too_wide);
    assert!(matches!(kind(0, 0.0, BOTH), TileErrorKind::Range { .. }));
    for half_width in [-0.1, 2.1, f32::NAN, f32::INFINITY] {
        assert!(
            matches!(kind(4, half_width, BOTH), TileErrorKind::Range { .. }),
            "{half_width}"
        );
    }
}

#[test]
fn tile_has_the_same_bits_on_any_number_of_threads() {
    let image = gravel(3, [80, 90], false);
    let cut = cut(16, 4.0);
    assert!(same_on_threads(|| tile(
        slice::from_ref(&image),
        &cut,
        BOTH
    )
    .unwrap()
    .remove(0)));
}

#[test]
fn value_stability_soft_cut() {
    let image = gravel(9, [40, 36], false);
    let tiles = tile(&[image], &cut(12, 3.0), BOTH).unwrap();
    let bits = [[0, 0], [5, 3], [11, 20], [20, 7]]
        .map(|[x, y]: [usize; 2]| tiles[0].row(y as u32)[x].to_bits());
    assert_eq!(bits, [1061468962, 1043236179, 1057672393, 1038144739]);
}

proptest! {
    #[test]
    fn tile_is_finite_or_refused_for_any_size(
        size in [1_u32..24, 1_u32..24],
        margin in 0_u32..14,
        half_width in -1.0_f32..8.0,
        axes in [any::<bool>(), any::<bool>()],
    ) {
        let image = gravel(7, size, false);
        let result = tile(&[image], &cut(margin, half_width), axes);
        let fits = (0..2).all(|axis| !axes[axis] || margin <= size[axis] / 2);
        let soft = (0.0..=margin as f32 / 2.0).contains(&half_width);
        prop_assert_eq!(result.is_ok(), margin >= 1 && fits && soft);
        for tile in result.into_iter().flatten() {
            prop_assert!(tile.pixels().iter().all(|value| value.is_finite()));
        }
    }
}
