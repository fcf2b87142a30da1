//! Checks shared by the tests of all maps from heights.

use crate::{ColorErrorKind, HeightPlane};
use dapple_raster::glam::DVec2;
use dapple_raster::{Raster, Wrap};

/// Checks that a strength that is not finite and an invalid extent are errors.
pub(crate) fn bad_planes_are_refused(refusal: impl Fn(HeightPlane) -> ColorErrorKind) {
    for strength in [f64::NAN, f64::INFINITY] {
        let refused = refusal(HeightPlane {
            strength,
            ..HeightPlane::default()
        });
        let is_strength = matches!(refused, ColorErrorKind::NotFinite { .. });
        assert!(is_strength, "{refused:?}");
    }
    for extent in [[0.0, 0.0], [1.0, -1.0], [f64::NAN, 1.0]].map(DVec2::from) {
        let refused = refusal(HeightPlane {
            extent,
            ..HeightPlane::default()
        });
        let is_extent = matches!(refused, ColorErrorKind::Extent { .. });
        assert!(is_extent, "{refused:?}");
    }
}

/// Checks that a radius is an error if it is not finite, negative, or above 2^14 pixels in a raster of 4 × 4.
pub(crate) fn bad_radii_are_refused(refusal: impl Fn(f64) -> ColorErrorKind) {
    for radius in [f64::NAN, f64::INFINITY] {
        let refused = refusal(radius);
        let is_radius = matches!(refused, ColorErrorKind::NotFinite { .. });
        assert!(is_radius, "{refused:?}");
    }
    for radius in [-0.1, 4097.0, f64::MAX] {
        let refused = refusal(radius);
        let is_radius = matches!(refused, ColorErrorKind::Radius { .. });
        assert!(is_radius, "{refused:?}");
    }
}

/// Returns a height, also past the edges of the raster: along an axis that does not repeat, it is reflected at the
/// outermost pixel, repeatedly if necessary.
pub(crate) fn continued(height: &Raster<f32>, [x, y]: [i64; 2], wrap: [Wrap; 2]) -> f64 {
    let size = height.size().map(i64::from);
    for axis in [1, 0] {
        let (at, last) = ([x, y][axis], size[axis] - 1);
        if wrap[axis] != Wrap::Repeat && !(0..=last).contains(&at) {
            let side = if at < 0 { 0 } else { last };
            let moved = |to: i64| if axis == 0 { [to, y] } else { [x, to] };
            return 2.0 * continued(height, moved(side), wrap)
                - continued(height, moved(2 * side - at), wrap);
        }
    }
    f64::from(*height.at(x, y, wrap))
}

/// Returns planes with a slope along the axes that do not repeat, for all four combinations of axes.
pub(crate) fn open_planes() -> Vec<(Raster<f32>, HeightPlane, DVec2)> {
    let size = [21, 14];
    let mut planes = Vec::new();
    for open in [Wrap::Clamp, Wrap::Mirror] {
        for wrap in [
            [Wrap::Repeat; 2],
            [open, Wrap::Repeat],
            [Wrap::Repeat, open],
            [open; 2],
        ] {
            // Multiples of an eighth are exact in single precision.
            let step = [0, 1].map(|axis| match wrap[axis] {
                Wrap::Repeat => 0.0,
                _ => [0.25, -0.625][axis],
            });
            let plane = Raster::from_fn(size, |x, y| {
                (step[0] * f64::from(x) + step[1] * f64::from(y)) as f32
            });
            let options = HeightPlane {
                extent: DVec2::new(size[0].into(), size[1].into()),
                wrap,
                ..HeightPlane::default()
            };
            planes.push((plane.unwrap(), options, DVec2::from(step)));
        }
    }
    planes
}

/// Checks that a map has the same bits with one, two and seven threads.
pub(crate) fn threads_do_not_change_a_bit<T>(bits: impl Fn() -> Raster<T> + Sync)
where
    T: PartialEq + core::fmt::Debug + Send,
{
    let on_threads = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap().install(&bits)
    };
    let one = on_threads(1);
    for threads in [2, 7] {
        assert_eq!(on_threads(threads), one, "{threads} threads");
    }
}

/// Checks that options survive a round trip through JSON, and that an unknown name is an error.
#[cfg(feature = "serde")]
pub(crate) fn options_are_data<T>(options: &T)
where
    T: PartialEq + core::fmt::Debug + serde::Serialize + serde::de::DeserializeOwned,
{
    let text = serde_json::to_string(options).unwrap();
    assert_eq!(
        &serde_json::from_str::<T>(&text).unwrap(),
        options,
        "{text}"
    );
    let error = serde_json::from_str::<T>(r#"{"radios": 0.25}"#).unwrap_err();
    assert!(error.to_string().contains("radios"), "{error}");
}
