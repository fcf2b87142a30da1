//! Ramp tests: at stops, between and outside them, and with invalid stops.

use super::{ColorRamp, ColorStop, Interpolation, Outside, RampSpace};
use crate::{ColorErrorKind, LinearRgb};
use dapple_raster::Raster;
use proptest::prelude::*;

fn stop(position: f32, gray: f32) -> ColorStop {
    let color = LinearRgb::gray(gray);
    ColorStop { position, color }
}

/// Returns a ramp with the linear-light grays 0, 1 and 5 at the positions 1, 2 and 4.
fn ramp() -> ColorRamp {
    let ramp = ColorRamp::new([stop(1.0, 0.0), stop(2.0, 1.0), stop(4.0, 5.0)]).unwrap();
    ramp.with_space(RampSpace::Linear)
}

const SPACES: [RampSpace; 3] = [RampSpace::Oklab, RampSpace::Srgb, RampSpace::Linear];

fn grays<const N: usize>(ramp: &ColorRamp, values: [f32; N]) -> [f32; N] {
    values.map(|value| ramp.at(value).r)
}

#[test]
fn linear_ramps_are_straight_and_clamped() {
    let values = [-9.0, 1.0, 1.25, 2.0, 2.5, 4.0, 99.0];
    assert_eq!(
        grays(&ramp(), values),
        [0.0, 0.0, 0.25, 1.0, 2.0, 5.0, 5.0],
        "linear"
    );
}

#[test]
fn stepped_and_smooth_ramps_meet_the_stops() {
    let stepped = ramp().with_interpolation(Interpolation::Stepped);
    let values = [0.0, 1.0, 1.9, 2.0, 3.9, 4.0];
    assert_eq!(
        grays(&stepped, values),
        [0.0, 0.0, 0.0, 1.0, 1.0, 5.0],
        "stepped"
    );
    let smooth = ramp().with_interpolation(Interpolation::Smooth);
    let values = [1.0, 1.25, 1.5, 2.0, 3.0, 4.0];
    assert_eq!(
        grays(&smooth, values),
        [0.0, 0.15625, 0.5, 1.0, 3.0, 5.0],
        "smooth"
    );
}

#[test]
fn repeated_ramps_begin_again_at_the_last_stop() {
    let repeated = ramp().with_outside(Outside::Repeat);
    // The length of the ramp is 3.
    let values = [1.25, 4.25, -1.75, 4.0, 2.0 + 300.0];
    assert_eq!(
        grays(&repeated, values),
        [0.25, 0.25, 0.25, 0.0, 1.0],
        "a period of 3"
    );
}

#[test]
fn two_stops_at_one_position_make_an_edge() {
    let edge = ColorRamp::new([
        stop(0.0, 0.0),
        stop(0.5, 0.0),
        stop(0.5, 1.0),
        stop(1.0, 1.0),
    ]);
    let edge = edge.unwrap();
    assert_eq!(
        grays(&edge, [0.5_f32.next_down(), 0.5, 0.75]),
        [0.0, 1.0, 1.0],
        "the later stop"
    );
    let single = ColorRamp::new([stop(0.5, 0.25)]).unwrap();
    for outside in [Outside::Clamp, Outside::Repeat] {
        let single = single.clone().with_outside(outside);
        assert_eq!(grays(&single, [-1.0, 0.5, 2.0]), [0.25; 3], "one color");
    }
}

#[test]
fn every_space_mixes_as_it_is_defined() {
    let [from, to] = [[200_u8, 40, 10], [20, 90, 250]].map(LinearRgb::from_srgb);
    let of_space = |space| ColorRamp::even(&[from, to]).unwrap().with_space(space);
    for step in 0..=16 {
        let part = step as f32 / 16.0;
        let at = |space| of_space(space).at(part);
        assert_eq!(at(RampSpace::Linear), from.lerp(to, part));
        // Mixed 8-bit codes, within their rounding.
        let codes = at(RampSpace::Srgb).to_srgb::<u8>();
        for (code, [from, to]) in
            codes
                .into_iter()
                .zip([[200.0, 20.0], [40.0, 90.0], [10.0, 250.0]])
        {
            let expected: f32 = from + (to - from) * part;
            assert!(
                (f32::from(code) - expected).abs() < 0.51,
                "{code} and {expected}"
            );
        }
        let [from, to, mixed] = [from, to, at(RampSpace::Oklab)].map(LinearRgb::to_oklab);
        for axis in 0..3 {
            let expected = from[axis] + (to[axis] - from[axis]) * f64::from(part);
            // The mixed color is rounded to single precision.
            assert!((mixed[axis] - expected).abs() < 1e-6, "{mixed:?} at {part}");
        }
    }
    let middle = |space| of_space_of_gray(space).at(0.5).r;
    assert!(
        (middle(RampSpace::Oklab) - 0.125).abs() < 1e-7,
        "half the lightness is an eighth of the light"
    );
    assert!(
        (middle(RampSpace::Srgb) - 0.214_041_14).abs() < 1e-7,
        "IEC 61966-2-1 at a half"
    );
    assert_eq!(middle(RampSpace::Linear), 0.5);
}

/// Returns a ramp from black to white.
fn of_space_of_gray(space: RampSpace) -> ColorRamp {
    let ramp = ColorRamp::even(&[LinearRgb::BLACK, LinearRgb::WHITE]).unwrap();
    ramp.with_space(space)
}

#[test]
fn every_space_meets_the_stops_and_keeps_one_color() {
    let colors = [[0.1, 0.7, 3.0], [-0.25, 0.5, 0.0], [-0.25, 0.5, 0.0]].map(LinearRgb::from);
    for space in SPACES {
        let ramp = ColorRamp::even(&colors).unwrap().with_space(space);
        assert_eq!(
            [0.0, 0.5, 0.6, 0.9, 1.0].map(|at| ramp.at(at)),
            [colors[0], colors[1], colors[1], colors[1], colors[1]],
            "{space:?}"
        );
        let near = ramp.at(0.5_f32.next_down()).to_array();
        for (near, part) in near.into_iter().zip(colors[1].to_array()) {
            // The matrices for both directions have ten digits.
            assert!((near - part).abs() < 1e-5, "{space:?}: {near} and {part}");
        }
    }
}

#[test]
fn value_stability_ramp_spaces() {
    let bits = SPACES.map(|space| {
        let ramp = ColorRamp::from_hex(&["#204060", "#ffd080"]).unwrap();
        ramp.with_space(space).at(0.3).to_array().map(f32::to_bits)
    });
    assert_eq!(
        bits,
        [
            [0x3def_34b6, 0x3e14_fc5f, 0x3e24_b3f4],
            [0x3dfe_fd8d, 0x3e17_275c, 0x3e12_68ec],
            [0x3e9e_c6d4, 0x3e66_84c0, 0x3e16_282c]
        ],
        "{bits:?}"
    );
}

#[test]
fn even_ramps_reach_from_zero_to_one() {
    let even = ColorRamp::from_hex(&["000", "888", "fff", "f00", "0f0"]).unwrap();
    let positions: Vec<f32> = even.stops().iter().map(|stop| stop.position).collect();
    assert_eq!(positions, [0.0, 0.25, 0.5, 0.75, 1.0], "the positions");
    assert_eq!(
        ColorRamp::from_hex(&["fff"]).unwrap().at(0.3),
        LinearRgb::WHITE,
        "one color"
    );
}

#[test]
fn bands_have_equal_width() {
    let bands = ColorRamp::bands(&[0.0, 0.5, 1.0, 2.0].map(LinearRgb::gray)).unwrap();
    let values = [-1.0, 0.0, 0.24, 0.25, 0.49, 0.5, 0.75, 1.0, 3.0];
    let expected = [0.0, 0.0, 0.0, 0.5, 0.5, 1.0, 2.0, 2.0, 2.0];
    assert_eq!(grays(&bands, values), expected, "four bands");
}

#[test]
fn bad_stops_are_refused() {
    let kind = |stops: &[ColorStop]| ColorRamp::new(stops).unwrap_err().kind().clone();
    assert_eq!(kind(&[]), ColorErrorKind::NoStops, "no stop");
    let (before, position) = (0.5, 0.25);
    let unsorted = ColorErrorKind::Unsorted { position, before };
    assert_eq!(
        kind(&[stop(before, 0.0), stop(position, 0.0)]),
        unsorted,
        "not in order"
    );
    for bad in [
        stop(f32::NAN, 0.0),
        stop(f32::INFINITY, 0.0),
        stop(0.0, f32::NAN),
    ] {
        let refused = kind(&[stop(0.0, 0.0), bad]);
        assert!(
            matches!(refused, ColorErrorKind::NotFinite { .. }),
            "{refused:?}"
        );
    }
}

#[test]
fn numbers_that_are_not_finite_have_a_color_of_the_ramp() {
    for outside in [Outside::Clamp, Outside::Repeat] {
        let ramp = ramp().with_outside(outside);
        let values = [f32::NAN, f32::NEG_INFINITY, f32::INFINITY];
        assert_eq!(grays(&ramp, values), [0.0, 0.0, 5.0], "{outside:?}");
    }
}

#[test]
fn a_raster_is_colored_pixel_by_pixel() {
    let values = Raster::from_fn([4, 3], |x, y| (x + y) as f32 * 0.75).unwrap();
    let colors = ramp().apply(&values);
    assert_eq!(colors, values.map(|&value| ramp().at(value)), "every pixel");
}

proptest! {
    #[test]
    fn colors_stay_within_the_stops(
        positions in proptest::collection::vec(-1e30_f32..1e30, 1..8),
        grays in proptest::collection::vec(0.0_f32..1.0, 8),
        value in any::<f32>(),
        repeat in any::<bool>(),
        space in proptest::sample::select(SPACES.to_vec()),
    ) {
        let mut positions = positions;
        positions.sort_by(f32::total_cmp);
        let stops: Vec<ColorStop> = positions.iter().zip(&grays).map(|(&p, &g)| stop(p, g)).collect();
        let outside = if repeat { Outside::Repeat } else { Outside::Clamp };
        for interpolation in [Interpolation::Linear, Interpolation::Stepped, Interpolation::Smooth] {
            let ramp = ColorRamp::new(stops.clone()).unwrap();
            let ramp = ramp.with_interpolation(interpolation).with_outside(outside).with_space(space);
            let gray = ramp.at(value).r;
            // Two products and a sum round up by at most 2^-23 of the total, and the matrices of Oklab have ten
            // digits.
            prop_assert!((-1e-8..=1.000_001).contains(&gray), "{gray} at {value}");
        }
    }
}

#[cfg(feature = "serde")]
#[test]
fn ramps_survive_as_data_and_bad_data_is_refused() {
    let ramp = ramp().with_interpolation(Interpolation::Smooth);
    let text = serde_json::to_string(&ramp).unwrap();
    assert_eq!(
        serde_json::from_str::<ColorRamp>(&text).unwrap(),
        ramp,
        "{text}"
    );
    let error = serde_json::from_str::<ColorRamp>(r#"{"stops": []}"#).unwrap_err();
    assert!(error.to_string().contains("at least one stop"), "{error}");
}
