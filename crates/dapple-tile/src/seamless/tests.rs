//! Tests of properties of every method.

use super::*;
use crate::test_fields::{check_cancel, fbm};
use crate::{Crossfade, TileErrorKind};
use core::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use dapple_color::{HeightPlane, Normal, normal_map};
use dapple_raster::{RasterErrorKind, Wrap};
use proptest::prelude::*;

fn ramp(size: [u32; 2]) -> Raster<f32> {
    Raster::from_fn(size, |column, row| {
        (column * column + 3 * row) as f32 / 16.0
    })
    .expect("the size is small and not empty")
}

/// Returns methods that process every plane separately, for any size.
fn methods() -> [Method; 3] {
    [
        Method::Periodic,
        Method::Poisson(WrapGradient::Zero),
        Method::Poisson(WrapGradient::Extrapolate),
    ]
}

/// Returns all methods, with margins of one pixel.
fn every_method() -> Vec<Method> {
    let cut = SoftCut {
        margin: Some(1),
        half_width: Some(0.0),
        ..SoftCut::default()
    };
    let margin = Feather::Margin {
        margin: 1,
        crossfade: Crossfade::Linear,
    };
    let others = [
        Method::SoftCut(cut),
        Method::SplineProject(SplineProject::default()),
        Method::PeriodicThenProject(SplineProject::default()),
        Method::Feather(Feather::HalfShift),
        Method::Feather(margin),
        Method::Mirror,
    ];
    methods().into_iter().chain(others).collect()
}

/// Returns all methods, with default widths, and with samples and sines.
fn usual_methods() -> Vec<Method> {
    let samples = SplineProject {
        pixels: Pixels::Samples,
        ..SplineProject::default()
    };
    let sines = SplineProject {
        basis: Basis::Sines,
        ..SplineProject::default()
    };
    let margin = Feather::Margin {
        margin: 16,
        crossfade: Crossfade::KeepVariance,
    };
    let others = [
        Method::SoftCut(SoftCut::default()),
        Method::SplineProject(samples),
        Method::PeriodicThenProject(sines),
        Method::Feather(Feather::HalfShift),
        Method::Feather(margin),
        Method::Mirror,
    ];
    methods().into_iter().chain(others).collect()
}

#[test]
fn every_method_can_be_cancelled_at_every_call() {
    let maps = [Map::Value(ramp([64, 48])), Map::Value(ramp([64, 48]))];
    for method in usual_methods() {
        let seamless = Seamless::new(method);
        let made = seamless.apply_maps(&maps).expect("all is finite");
        let n_calls = check_cancel(&made, |stop| seamless.apply_maps_cancellable(&maps, stop));
        // One call comes first, and each plane has one pass at least.
        assert!(n_calls > 2, "{n_calls} calls, {method:?}");
    }
}

#[test]
fn callbacks_come_once_for_65536_pixels_of_large_images() {
    let maps = [Map::Value(ramp([1024, 1024]))];
    for method in usual_methods() {
        let n_calls = AtomicUsize::new(0);
        let count = || {
            n_calls.fetch_add(1, Relaxed);
            false
        };
        let tiles = Seamless::new(method).apply_maps_cancellable(&maps, &count);
        assert!(tiles.is_ok(), "{method:?}");
        // A plane goes through two passes at least, one for each axis. One of them calls this often.
        let n_calls = n_calls.into_inner();
        assert!(n_calls >= 16, "{n_calls} calls, {method:?}");
    }
}

#[test]
fn colors_and_maps_have_the_tiles_of_their_planes() {
    let value = ramp([9, 6]);
    let color = value.map(|&v| LinearRgb::new(v, 2.0 - v, v * v));
    for method in methods() {
        let seamless = Seamless::new(method).with_axes([true, false]);
        let plane = |plane: &Raster<f32>| seamless.apply(plane).expect("all is finite");
        let tile = seamless.apply_color(&color).expect("all is finite");
        assert_eq!(tile.map(|c| c.r), plane(&color.map(|c| c.r)), "red");
        assert_eq!(tile.map(|c| c.g), plane(&color.map(|c| c.g)), "green");
        assert_eq!(tile.map(|c| c.b), plane(&color.map(|c| c.b)), "blue");
        let maps = [Map::Color(color.clone()), Map::Value(value.clone())];
        let tiles = seamless.apply_maps(&maps).expect("all is finite");
        assert_eq!(
            tiles,
            [Map::Color(tile), Map::Value(plane(&value))],
            "in order"
        );
    }
}

#[test]
fn normals_come_back_as_long_as_one_and_flat_ones_stay_flat() {
    let tilted = ramp([8, 8]).map(|&v| Normal {
        x: 0.6 * (v - 4.0) / 10.0,
        y: -0.3,
        z: 0.8,
    });
    let flat = tilted.map(|_| Normal::FLAT);
    let maps = [Map::Normal(tilted), Map::Normal(flat.clone())];
    let tiles = Seamless::default()
        .apply_maps(&maps)
        .expect("all is finite");
    let [Map::Normal(tilted), Map::Normal(still)] = tiles.as_slice() else {
        panic!("{tiles:?} are other kinds");
    };
    for normal in tilted.pixels() {
        let length_sq = normal.x * normal.x + normal.y * normal.y + normal.z * normal.z;
        // Three squares, each rounded to f32.
        assert!(
            (length_sq - 1.0).abs() < 5e-7,
            "{normal:?} is not as long as 1"
        );
    }
    assert_eq!(*still, flat, "a constant slope has no jump");
}

#[test]
fn maps_that_do_not_fit_together_are_refused() {
    let seamless = Seamless::default();
    let maps = [Map::Value(ramp([4, 4])), Map::Value(ramp([4, 5]))];
    let error = seamless.apply_maps(&maps).expect_err("the sizes differ");
    let TileErrorKind::Raster(error) = error.kind() else {
        panic!("{error} is of another kind");
    };
    assert!(
        matches!(error.kind(), RasterErrorKind::SizeMismatch { .. }),
        "{error}"
    );
    let error = seamless.apply_maps(&[]).expect_err("there is no map");
    assert!(
        matches!(error.kind(), TileErrorKind::Count { count: 0, .. }),
        "{error}"
    );
}

#[test]
fn a_side_of_one_pixel_cannot_be_made_to_repeat_by_any_method() {
    for method in every_method() {
        for (size, axes) in [
            ([1, 1], [true, true]),
            ([1, 8], [true, false]),
            ([8, 1], [false, true]),
        ] {
            let refused = Seamless::new(method).with_axes(axes).apply(&ramp(size));
            let error = refused.expect_err("a pixel has no neighbor");
            assert_eq!(
                *error.kind(),
                TileErrorKind::TooSmall {
                    length: 1,
                    least: 2
                },
                "{method:?}"
            );
        }
    }
}

#[cfg(feature = "serde")]
#[test]
fn options_refuse_fields_that_they_do_not_have() {
    use crate::{BlendMap, Disturbance, MatchBorders, Pyramid, SeamOptions};
    fn message<T: serde::de::DeserializeOwned>(text: &str) -> String {
        let error = serde_json::from_str::<T>(text).err();
        error.map_or_else(|| "taken".to_owned(), |error| error.to_string())
    }
    let text = r#"{"tpyo": 1}"#;
    let variant = r#"{"margin": {"margin": 3, "tpyo": 1}}"#;
    for message in [
        message::<Seamless>(text),
        message::<SplineProject>(text),
        message::<SoftCut>(text),
        message::<SeamOptions>(text),
        message::<Disturbance>(text),
        message::<MatchBorders>(text),
        message::<BlendMap>(text),
        message::<Pyramid>(text),
        message::<crate::Blend>(text),
        message::<Feather>(variant),
        message::<crate::Weighting>(r#"{"mask": {"gain": 3.0, "tpyo": 1}}"#),
    ] {
        assert!(message.starts_with("unknown field `tpyo`"), "{message}");
    }
    let feather: Feather = serde_json::from_str(r#"{"margin": {"margin": 3}}"#).unwrap();
    let crossfade = Crossfade::KeepVariance;
    let margin = 3;
    assert_eq!(feather, Feather::Margin { margin, crossfade });
}

proptest! {
    #[test]
    fn any_size_gives_a_finite_tile_or_a_typed_error(
        width in 1_u32..14, height in 1_u32..14, axes: [bool; 2],
    ) {
        for method in every_method() {
            match Seamless::new(method).with_axes(axes).apply(&ramp([width, height])) {
                Ok(tile) => {
                    prop_assert!(tile.pixels().iter().all(|value| value.is_finite()), "{:?}", method);
                    let twice = |axis: usize| 1 + u32::from(axes[axis]);
                    let expected = [width * twice(0), height * twice(1)];
                    prop_assert!(method != Method::Mirror || tile.size() == expected);
                }
                Err(error) => prop_assert!(matches!(
                    error.kind(),
                    TileErrorKind::TooSmall { .. } | TileErrorKind::Margin { .. } | TileErrorKind::Wavelet(_)
                        | TileErrorKind::Range { .. }
                ), "{:?}: {}", method, error),
            }
        }
    }

    #[test]
    fn pixels_that_are_not_finite_are_refused_with_their_place(
        width in 1_u32..9, height in 1_u32..9, at in 0_usize..81,
        bad in prop_oneof![Just(f32::NAN), Just(f32::INFINITY), Just(f32::NEG_INFINITY)],
    ) {
        let mut plane = ramp([width, height]);
        let at = at % plane.pixels().len();
        plane.pixels_mut()[at] = bad;
        for method in every_method() {
            let error = Seamless::new(method).apply(&plane).expect_err("a pixel is not finite");
            let TileErrorKind::NotFinite { column, row, .. } = *error.kind() else {
                panic!("{error} is of another kind");
            };
            prop_assert_eq!((row * width + column) as usize, at);
        }
    }

    #[test]
    fn any_size_gives_a_tile_of_that_size(width in 2_u32..40, height in 2_u32..40, axes: [bool; 2]) {
        for method in methods() {
            let tile = Seamless::new(method).with_axes(axes).apply(&ramp([width, height]));
            let tile = tile.expect("any size can be made periodic");
            prop_assert_eq!(tile.size(), [width, height]);
            prop_assert!(tile.pixels().iter().all(|value| value.is_finite()), "all is finite");
        }
    }
}

/// Returns the normals of heights, for pixels with a side of one unit of the plane.
fn normals_of(height: &Raster<f32>, wrap: Wrap) -> Raster<Normal> {
    let [width, height_px] = height.size().map(f64::from);
    let plane = HeightPlane {
        strength: 12.0,
        extent: [width, height_px].into(),
        wrap: [wrap; 2],
    };
    normal_map(height, &plane.into()).expect("the plane is right")
}

/// Returns the tile of heights and the tile of their normals, from one cut.
fn height_and_normals(seamless: &Seamless, height: &Raster<f32>) -> (Raster<f32>, Raster<Normal>) {
    let normals = normals_of(height, Wrap::Clamp);
    let maps = [Map::Value(height.clone()), Map::Normal(normals)];
    let tiles = seamless.apply_maps(&maps).expect("the size allows it");
    match <[Map; 2]>::try_from(tiles) {
        Ok([Map::Value(height), Map::Normal(normals)]) => (height, normals),
        _ => panic!("maps keep their kinds"),
    }
}

#[test]
fn mirrored_normals_are_those_of_the_mirrored_heights() {
    let height = fbm(3, [40, 24], false);
    for axes in [[true; 2], [true, false], [false, true]] {
        let seamless = Seamless::new(Method::Mirror).with_axes(axes);
        let (tile, normals) = height_and_normals(&seamless, &height);
        let expected = normals_of(&tile, Wrap::Repeat);
        for row in 1..tile.height() - 1 {
            for column in 1..tile.width() as usize - 1 {
                // Heights have a crease next to their mirror image.
                let at = [column as u32, row];
                let meets = |axis: usize| axes[axis] && at[axis].abs_diff(height.size()[axis]) <= 1;
                if meets(0) || meets(1) {
                    continue;
                }
                let [a, b] = [&normals, &expected].map(|map| map.row(row)[column].to_array());
                // Slopes are rounded to single precision on the way.
                let is_near = a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-5);
                assert!(
                    is_near,
                    "{axes:?}, column {column}, row {row}: {a:?}, not {b:?}"
                );
            }
        }
    }
}

#[test]
fn steep_normals_of_every_method_lean_as_the_tiled_heights_do() {
    let height = fbm(5, [96, 80], false);
    let cut = SoftCut {
        margin: Some(16),
        half_width: Some(4.0),
        ..SoftCut::default()
    };
    let margin = Feather::Margin {
        margin: 16,
        crossfade: Crossfade::Linear,
    };
    let methods = every_method().into_iter().map(|method| match method {
        Method::SoftCut(_) => Method::SoftCut(cut),
        Method::Feather(Feather::Margin { .. }) => Method::Feather(margin),
        method => method,
    });
    for method in methods {
        let (tile, normals) = height_and_normals(&Seamless::new(method), &height);
        let expected = normals_of(&tile, Wrap::Repeat);
        let (mut n_steep, mut n_wrong) = (0_u32, 0_u32);
        for (is, right) in normals.pixels().iter().zip(expected.pixels()) {
            for (is, right) in [(is.x, right.x), (is.y, right.y)] {
                if right.abs() > 0.3 {
                    n_steep += 1;
                    n_wrong += u32::from(is * right < 0.0);
                }
            }
        }
        assert!(n_steep > 2000, "{method:?}: {n_steep} are steep");
        // Where images are blended, normals are blended, too, and do not include the slope of the changing weight.
        let share = f64::from(n_wrong) / f64::from(n_steep);
        assert!(
            share < 0.05,
            "{method:?}: {share} of them lean the wrong way"
        );
    }
}

#[test]
fn flat_normals_of_images_are_one_color_when_mirrored() {
    for code in [127_u8, 128] {
        let flat = Raster::filled([5, 4], Normal::from_codes([code, 128, 255])).unwrap();
        let maps = [Map::Normal(flat)];
        let tiles = Seamless::new(Method::Mirror).apply_maps(&maps).unwrap();
        let [Map::Normal(tile)] = tiles.as_slice() else {
            panic!("normals remain normals");
        };
        let is_flat = |normal: &Normal| normal.to_codes::<u8>() == [128, 128, 255];
        assert!(tile.pixels().iter().all(is_flat), "{code}");
    }
}
