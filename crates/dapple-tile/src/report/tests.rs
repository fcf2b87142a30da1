//! Tests of whole reports: their numbers, text and limits.

use super::{Fault, SeamOptions, SeamReport, SeamReports};
use crate::test_fields::gravel;
use crate::{Crossfade, Feather, Map, Method, Seamless, SoftCut, TileError, TileErrorKind};
use dapple_color::LinearRgb;
use dapple_hash::{Seed, hash2, unit_f32};
use dapple_raster::Raster;
use proptest::prelude::*;

/// Returns periodic white noise from 0 to 1.
fn noise(size: [u32; 2], seed: u64) -> Raster<f32> {
    let pixel = |x, y| unit_f32(hash2(Seed(seed), [i64::from(x), i64::from(y)], 0) as u32);
    Raster::from_fn(size, pixel).unwrap()
}

fn kind(result: Result<SeamReport, TileError>) -> TileErrorKind {
    result.unwrap_err().kind().clone()
}

#[test]
fn report_beside_a_source_tells_the_same_about_the_tile() {
    let (source, tile) = (noise([80, 70], 1), noise([64, 64], 2));
    let options = SeamOptions::default();
    let alone = SeamReport::of(&tile, &options).unwrap();
    let beside = SeamReport::beside(&source, &tile, &options).unwrap();
    assert_eq!(
        SeamReport {
            kept: None,
            ..beside.clone()
        },
        alone
    );
    let kept = beside.kept.unwrap();
    assert_eq!((kept.source_size, kept.octaves.len()), ([80, 70], 3));
    // Both are white noise of several thousand pixels.
    assert!((kept.contrast - 1.0).abs() < 0.05, "{kept:?}");
    assert!((kept.octaves[0] - 1.0).abs() < 0.1, "{kept:?}");
}

#[test]
fn contrast_is_a_ratio_of_deviations() {
    let source = noise([32, 32], 3);
    let contrast = |tile: &Raster<f32>| {
        let report = SeamReport::beside(&source, tile, &SeamOptions::default()).unwrap();
        report.kept.unwrap().contrast
    };
    let half = source.map(|value| 0.5 * value + 3.0);
    // The pixels are rounded to 2^-22.
    assert!((contrast(&half) - 0.5).abs() < 1e-6, "{}", contrast(&half));
    assert_eq!(contrast(&source), 1.0);
    let flat = Raster::filled([32, 32], 0.5).unwrap();
    assert_eq!(contrast(&flat), 0.0);
    let of_flat = SeamReport::beside(&flat, &source, &SeamOptions::default()).unwrap();
    assert_eq!(of_flat.kept.unwrap().contrast, SeamReport::MOST);
}

#[test]
fn gate_passes_noise_and_stops_seams() {
    let options = SeamOptions::default();
    let tile = noise([64, 64], 4);
    assert!(SeamReport::of(&tile, &options).unwrap().passes());
    let ramp = |scale: f32| {
        let pixel = |x: u32, y: u32| tile.row(y)[x as usize] + scale * x as f32;
        Raster::from_fn([64, 64], pixel).unwrap()
    };
    assert!(!SeamReport::of(&ramp(0.05), &options).unwrap().passes());
    // The wrap along x is not measured.
    let y_only = SeamOptions {
        axes: [false, true],
        ..options
    };
    assert!(SeamReport::of(&ramp(0.05), &y_only).unwrap().passes());
    // The step is too small to be visible between pixels, but not between means of 4.
    let faint = SeamReport::of(&ramp(0.005), &options).unwrap();
    assert!(faint.seams[0].both.unwrap().ratio < 1.25, "{faint}");
    assert!(!faint.passes(), "{faint}");
    // There are no means of 4 pixels inside.
    assert!(
        !SeamReport::of(&noise([7, 7], 5), &options)
            .unwrap()
            .passes()
    );
}

#[test]
fn faults_name_what_crossfades_and_mirrors_do() {
    // The joints are above 0, so that nothing is clipped.
    let source = gravel(4, [160; 2], false).map(|value| 0.2 + 0.6 * value);
    let grain = noise([160; 2], 6);
    let faults = |source: &Raster<f32>, method| {
        let tile = Seamless::new(method).apply(source).unwrap();
        let report = SeamReport::beside(source, &tile, &SeamOptions::default());
        report.unwrap().faults()
    };
    let feather = Method::Feather(Feather::Margin {
        margin: 32,
        crossfade: Crossfade::Linear,
    });
    let half = Method::Feather(Feather::HalfShift);
    assert_eq!(faults(&source, Method::SoftCut(SoftCut::default())), []);
    // In the middle of the crossfade, noise keeps 0.71 of its deviation.
    assert!(faults(&grain, feather).contains(&Fault::Soft));
    assert!(faults(&source, half).contains(&Fault::Ghosts));
    assert!(faults(&source, Method::Mirror).contains(&Fault::Mirrored));
}

/// Returns a black disk with a radius of 60 pixels in noise from 0.3 to 0.7. No mean of two noise values is outside of
/// that range.
fn disk_in_noise() -> Raster<f32> {
    let grain = noise([256; 2], 7);
    Raster::from_fn([256; 2], |x, y| {
        let [dx, dy] = [x, y].map(|at| i64::from(at) - 128);
        match dx * dx + dy * dy {
            0..3600 => 0.0,
            _ => 0.3 + 0.4 * grain.row(y)[x as usize],
        }
    })
    .unwrap()
}

#[test]
fn black_of_the_source_is_not_clipped_by_a_method_that_crops() {
    let source = disk_in_noise();
    let tile = Seamless::new(Method::SoftCut(SoftCut::default()))
        .apply(&source)
        .unwrap();
    let black = |image: &Raster<f32>| {
        let pixels = image.pixels().iter();
        pixels.filter(|value| **value <= 0.0).count()
    };
    // All of the disk is still in the tile, as 22.5 % of it; it was 17.2 % of the source.
    assert_eq!((tile.size(), black(&tile)), ([224; 2], black(&source)));
    let report = SeamReport::beside(&source, &tile, &SeamOptions::default()).unwrap();
    assert_eq!(report.kept.as_ref().unwrap().clipped, 0.0, "{report}");
    // Displayed colors end at 0 and 1, so clipping is counted in linear light.
    let [source, tile] = [source, tile]
        .map(|image| Map::Color(image.map(|&value| LinearRgb::new(value, value, 0.5))));
    let report = SeamReports::beside(&source, &tile, &SeamOptions::default()).unwrap();
    for of in report.channels() {
        let kept = of.report.kept.as_ref().unwrap();
        assert_eq!(kept.clipped, 0.0, "{}: {report}", of.channel);
    }
}

#[test]
fn samples_of_colors_past_the_range_are_clipped() {
    let source = Raster::filled([64; 2], LinearRgb::new(0.5, 0.5, 0.5)).unwrap();
    let tile = Raster::from_fn([64; 2], |x, _| match x {
        0..16 => LinearRgb::new(1.2, 0.5, -0.1),
        _ => LinearRgb::new(0.5, 0.5, 0.5),
    });
    let maps = [source, tile.unwrap()].map(Map::Color);
    let report = SeamReports::beside(&maps[0], &maps[1], &SeamOptions::default()).unwrap();
    let clipped = |index: usize| {
        report.channels()[index]
            .report
            .kept
            .as_ref()
            .unwrap()
            .clipped
    };
    assert_eq!([0, 1, 2].map(clipped), [0.25, 0.0, 0.25]);
}

#[test]
fn a_good_cut_passes_where_the_source_is_clipped() {
    // Strong contrast, like a wet photograph: a quarter of the samples is black or white.
    let source = gravel(4, [160; 2], false).map(|value| (2.0 * value - 0.5).clamp(0.0, 1.0));
    let ends = source.pixels().iter();
    let ends = ends
        .filter(|value| **value <= 0.0 || **value >= 1.0)
        .count();
    assert!(ends > 160 * 160 / 4, "{ends}");
    let tile = Seamless::new(Method::SoftCut(SoftCut::default()))
        .apply(&source)
        .unwrap();
    let report = SeamReport::beside(&source, &tile, &SeamOptions::default()).unwrap();
    assert!(report.passes(), "{report}");
}

/// Returns upright bricks of 22 × 60 pixels whose joints lean more and more to the right, as in a view from one side.
fn leaning_bricks() -> Raster<f32> {
    Raster::from_fn([192; 2], |x, y| {
        let [x, y] = [f64::from(x), f64::from(y)];
        let across = (x - 96.0) / (1.0 + y / 400.0) / 22.0;
        let column = across.floor();
        let down = (y + 27.0 * column) / 60.0;
        let joint = |at: f64, width: f64| {
            let from = (at - at.round()).abs();
            ((width - from) / width * 3.0).clamp(0.0, 1.0)
        };
        let grain = f64::from(unit_f32(hash2(Seed(8), [x as i64, y as i64], 0) as u32));
        let joint = joint(across, 0.1).max(joint(down, 0.04));
        (0.2 + 0.4 * joint + 0.12 * grain) as f32
    })
    .unwrap()
}

#[test]
fn courses_that_break_at_a_cut_are_strange_at_a_coarse_scale() {
    let source = leaning_bricks();
    let tile = Seamless::new(Method::SoftCut(SoftCut::default()))
        .apply(&source)
        .unwrap();
    let report = SeamReport::beside(&source, &tile, &SeamOptions::default()).unwrap();
    // Squares of 8 × 8 pixels have matches elsewhere for all parts of bricks and joints.
    let fine = report.kept.as_ref().and_then(|kept| kept.strangeness);
    assert!(fine.is_some_and(|fine| fine < 0.8), "{report}");
    assert!(report.faults().contains(&Fault::Strange), "{report}");
}

#[test]
fn a_frame_of_one_color_and_a_soft_seam_are_no_faults() {
    let framed = Raster::from_fn([64; 2], |x, y| match x.min(y).min(63 - x).min(63 - y) {
        0..6 => 1.0,
        _ => unit_f32(hash2(Seed(1), [x.into(), y.into()], 0) as u32),
    });
    let report = SeamReport::of(&framed.unwrap(), &SeamOptions::default()).unwrap();
    assert_eq!(report.seams[0].both.unwrap().ratio, 0.0);
    assert!(report.passes(), "{report}");
}

#[test]
fn axes_that_do_not_repeat_are_not_measured() {
    let tile = noise([40, 24], 6);
    let options = SeamOptions {
        axes: [true, false],
        lattice: [8, 7],
    };
    let report = SeamReport::of(&tile, &options).unwrap();
    for seam in report.seams {
        assert_eq!(
            (seam.y, seam.both),
            (None, seam.x),
            "at {} pixels",
            seam.width
        );
        assert!(seam.x.is_some(), "at {} pixels", seam.width);
    }
}

#[test]
fn bad_input_is_refused_by_name() {
    let tile = noise([12, 8], 7);
    let of = |axes, lattice| SeamReport::of(&tile, &SeamOptions { axes, lattice });
    let TileErrorKind::Count { what, count, .. } = kind(of([false; 2], [1; 2])) else {
        panic!("no axis repeats");
    };
    assert_eq!((what, count), ("axes that repeat", 0));
    for (lattice, value) in [([5, 1], 5.0), ([1, 0], 0.0), ([24, 1], 24.0)] {
        let TileErrorKind::Range { value: told, .. } = kind(of([true; 2], lattice)) else {
            panic!("{lattice:?} does not divide the sides");
        };
        assert_eq!(told, value);
    }
    let mut bad = tile.clone();
    bad.pixels_mut()[12 + 3] = f32::NAN;
    let refused = [
        SeamReport::of(&bad, &SeamOptions::default()),
        SeamReport::beside(&bad, &tile, &SeamOptions::default()),
        SeamReport::beside(&tile, &bad, &SeamOptions::default()),
    ];
    for report in refused {
        let TileErrorKind::NotFinite { column, row, .. } = kind(report) else {
            panic!("a pixel is not a number");
        };
        assert_eq!([column, row], [3, 1]);
    }
}

#[test]
fn table_fits_in_eighty_columns() {
    let steps = Raster::from_fn([128, 128], |x, _| if x < 2 { 0.1 } else { 0.7e9 }).unwrap();
    let options = SeamOptions {
        lattice: [8; 2],
        ..SeamOptions::default()
    };
    let (large, small) = (noise([129, 130], 8), noise([3, 3], 9));
    for (source, tile, options) in [
        (&large, &steps, options),
        (&large, &small, SeamOptions::default()),
        (&steps, &large, SeamOptions::default()),
    ] {
        let table = SeamReport::beside(source, tile, &options)
            .unwrap()
            .to_string();
        let widest = table.lines().map(|line| line.chars().count()).max();
        assert!(widest <= Some(80), "{table}");
        assert!(!table.contains("NaN") && !table.contains("inf"), "{table}");
    }
}

#[test]
fn table_reads_as_it_should() {
    let ramp = Raster::from_fn([64, 64], |x, y| (x + y) as f32).unwrap();
    let half = ramp.map(|value| value * 0.5);
    let report = SeamReport::beside(&ramp, &half, &SeamOptions::default()).unwrap();
    let expected = "\
a tile of 64 × 64 pixels: does not pass
  (the seam shows, most at 1 px)
  (contrast is lost, as in a double exposure)
  (the seam is unlike anything in the source)
seam ratio                           x               y            both
  at 1 px                 63.00 ± 0.00    63.00 ± 0.00    63.00 ± 0.00
  at 2 px                 31.00 ± 0.00    31.00 ± 0.00    31.00 ± 0.00
  at 4 px                 15.00 ± 0.00    15.00 ± 0.00    15.00 ± 0.00
  at 8 px                  7.00 ± 0.00     7.00 ± 0.00     7.00 ± 0.00
seam stands out by       1 px: 185 2 px: 91.33 4 px: 44.87 8 px: 21.47
lowest local detail              0.707  (of the source 0.707)
detail kept                  1/2: 0.25       1/4: 0.25       1/8: 0.25
contrast kept                     0.50
strangeness                      58.59  (of 16 px 2.91)
clipped                          0.0 %";
    assert_eq!(report.to_string(), expected);
}

#[cfg(feature = "json")]
#[test]
fn json_comes_back_as_the_same_report() {
    let ramp = Raster::from_fn([64, 64], |x, y| (x + y) as f32).unwrap();
    let report = SeamReport::beside(&ramp, &noise([32, 32], 9), &SeamOptions::default()).unwrap();
    let text = report.to_json().unwrap();
    assert!(text.contains("\"lowest_local_detail\""), "{text}");
    let back: SeamReport = serde_json::from_str(&text).unwrap();
    assert_eq!(back, report);
}

proptest! {
    #[test]
    fn reports_of_any_image_are_finite(
        size in [1_u32..20, 1_u32..20],
        source_size in [1_u32..40, 1_u32..40],
        axes in [any::<bool>(), any::<bool>()],
        scale in prop::sample::select(vec![0.0, 1e-40, 1.0, f32::MAX]),
        seed in any::<u64>(),
    ) {
        let tile = noise(size, seed).map(|value| (value - 0.5) * scale);
        let options = SeamOptions { axes, ..SeamOptions::default() };
        let report = SeamReport::beside(&noise(source_size, seed), &tile, &options);
        prop_assert_eq!(report.is_ok(), axes != [false; 2]);
        if let Ok(report) = report {
            let ratios = report.seams.iter().flat_map(|seam| [seam.x, seam.y, seam.both]).flatten();
            let kept = report.kept.clone().unwrap();
            let numbers = ratios
                .flat_map(|ratio| [Some(ratio.ratio), ratio.spread])
                .flatten()
                .chain(kept.octaves)
                .chain(report.seams.iter().filter_map(|seam| seam.stands_out))
                .chain(kept.strangeness)
                .chain(kept.coarse_strangeness)
                .chain([kept.contrast, report.lowest_local_detail, kept.source_lowest_local_detail])
                .chain([kept.clipped, report.badness()]);
            for number in numbers {
                prop_assert!((0.0..=SeamReport::MOST).contains(&number), "{}", number);
            }
            prop_assert_eq!(report.passes(), report.badness() <= 1.0, "{}", report);
        }
    }
}
