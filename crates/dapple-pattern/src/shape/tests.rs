//! Compares shapes with the distances to many points on their borders, which come from the definitions of the shapes.

use super::{Shape, ShapeKind, ShapeOptions, ShapeValue, length};
use crate::PatternErrorKind;
use core::f64::consts::TAU;
use dapple_raster::{Field as _, FieldExt as _, Named as _, Window};
use proptest::prelude::*;

/// Returns whether a position relative to the center of an upright shape without rounding is inside, from the
/// definition of the shape.
fn is_inside(options: &ShapeOptions, [x, y]: [f64; 2]) -> bool {
    let ShapeOptions {
        size, ratio, sides, ..
    } = *options;
    let radius = length([x, y]);
    // Angle from the top, in sectors of one side or point
    let sector = TAU / f64::from(sides);
    let angle = libm::atan2(x, -y).rem_euclid(sector);
    match options.kind {
        ShapeKind::Circle => radius < size,
        ShapeKind::Box => x.abs() < size && y.abs() < size * ratio,
        ShapeKind::Polygon => {
            radius * libm::cos(angle - sector / 2.0) < size * libm::cos(sector / 2.0)
        }
        ShapeKind::Star => {
            // A side leads from a point on the axis of the sector to an inner corner at half of the sector.
            let angle = angle.min(sector - angle);
            let inner =
                [libm::cos(sector / 2.0), libm::sin(sector / 2.0)].map(|part| size * ratio * part);
            let at = [radius * libm::cos(angle), radius * libm::sin(angle)];
            let side = [inner[0] - size, inner[1]];
            side[0] * at[1] - side[1] * (at[0] - size) > 0.0
        }
        ShapeKind::Capsule => length([(x.abs() - size * (1.0 - ratio)).max(0.0), y]) < size * ratio,
        ShapeKind::Ring => radius < size && radius > size * ratio,
        ShapeKind::Moon => radius < size && length([x - 2.0 * ratio * size, y]) > size,
        ShapeKind::Heart => {
            // A square on its corner, and half-disks on its upper sides
            let scale = size / (0.25 + 0.125_f64.sqrt());
            let (x, y) = (x.abs() / scale, (0.75 + 0.125_f64.sqrt()) / 2.0 - y / scale);
            (y > x && x + y < 1.0) || length([x - 0.25, y - 0.75]) < 0.125_f64.sqrt()
        }
    }
}

/// Returns points of the border of an upright shape: changes between inside and outside along rows and columns.
fn border(options: &ShapeOptions) -> Vec<[f64; 2]> {
    let n = 600;
    let at = |index: i32| 1.05 * options.size * f64::from(index) / f64::from(n) + 1e-9;
    let mut points = Vec::new();
    for (along, across) in (-n..n).flat_map(|along| (-n..n).map(move |across| (along, across))) {
        for is_row in [true, false] {
            let place = |across: f64| {
                if is_row {
                    [across, at(along)]
                } else {
                    [at(along), across]
                }
            };
            let (mut first, mut last) = (at(across), at(across + 1));
            let start = is_inside(options, place(first));
            if start == is_inside(options, place(last)) {
                continue;
            }
            for _ in 0..30 {
                let middle = 0.5 * (first + last);
                if is_inside(options, place(middle)) == start {
                    first = middle;
                } else {
                    last = middle;
                }
            }
            points.push(place(first));
        }
    }
    points
}

#[test]
fn distances_equal_those_to_points_of_the_border() {
    for (&kind, ratio) in ShapeKind::ALL
        .iter()
        .flat_map(|kind| [0.3, 0.7].map(|ratio| (kind, ratio)))
    {
        let options = ShapeOptions {
            kind,
            ratio,
            center: [0.0; 2],
            size: 1.0,
            sides: 5,
            ..ShapeOptions::default()
        };
        let shape = Shape::new(options).unwrap();
        let points = border(&options);
        for (row, column) in (-9..=9).flat_map(|row| (-9..=9).map(move |column| (row, column))) {
            let at = [
                f64::from(column) * 0.17 + 0.003,
                f64::from(row) * 0.17 + 0.001,
            ];
            let distances = points
                .iter()
                .map(|point| length([at[0] - point[0], at[1] - point[1]]));
            let distance = distances.fold(f64::INFINITY, f64::min);
            let expected = if is_inside(&options, at) {
                -distance
            } else {
                distance
            };
            let found = f64::from(shape.field(ShapeValue::Distance).sample(at));
            // Rows and columns are 0.00175 apart. A point of the border, also a sharp corner, is within two of them from
            // one of the points.
            let tolerance = 0.0035;
            assert!(
                (found - expected).abs() < tolerance,
                "{kind} {ratio} at {at:?}: {found}, but {expected}"
            );
        }
    }
}

fn options() -> impl Strategy<Value = ShapeOptions> {
    let kind = proptest::sample::select(ShapeKind::ALL);
    let center = [-1.0..1.0_f64, -1.0..1.0_f64];
    let numbers = (
        0.01..2.0_f64,
        -400.0..400.0_f64,
        3..9_u32,
        0.05..=1.0_f64,
        0.0..0.9_f64,
        0.0..0.5_f64,
    );
    let frequency = [0.3..3.0_f64, 0.3..3.0_f64];
    (kind, center, numbers, frequency).prop_map(|(kind, center, numbers, frequency)| ShapeOptions {
        kind,
        center,
        size: numbers.0,
        rotation: numbers.1,
        sides: numbers.2,
        ratio: numbers.3,
        rounding: numbers.4,
        onion: numbers.5,
        edge: 0.1,
        frequency: frequency.map(Some),
    })
}

proptest! {
    #[test]
    fn repeated_shapes_equal_the_nearest_of_all_copies(
        options in options(),
        repeats in [any::<bool>(), any::<bool>()],
        at in [-4.0..4.0_f64, -4.0..4.0_f64],
    ) {
        let frequency = [0, 1].map(|axis| options.frequency[axis].filter(|_| repeats[axis]));
        let shape = Shape::new(ShapeOptions { frequency, ..options }).unwrap();
        let single = Shape::new(ShapeOptions { frequency: [None; 2], ..options }).unwrap();
        let steps = |axis: usize| if repeats[axis] { -40..=40_i32 } else { 0..=0 };
        let mut expected = f64::INFINITY;
        for (row, column) in steps(1).flat_map(|row| steps(0).map(move |column| (row, column))) {
            let moved = |axis: usize, step: i32| match frequency[axis] {
                Some(frequency) => at[axis] - f64::from(step) / frequency,
                None => at[axis],
            };
            expected = expected.min(single.distance([moved(0, column), moved(1, row)]));
        }
        let found = shape.distance(at);
        // Offsets of copies are rounded at magnitudes of up to 100.
        prop_assert!((found - expected).abs() < 1e-11, "{found}, but {expected}");
    }

    #[test]
    fn distances_change_by_at_most_the_length_of_a_step(
        options in options(),
        at in [-2.0..2.0_f64, -2.0..2.0_f64],
        step in [-0.1..0.1_f64, -0.1..0.1_f64],
    ) {
        let shape = Shape::new(options).unwrap();
        let change = shape.distance([at[0] + step[0], at[1] + step[1]]) - shape.distance(at);
        prop_assert!(change.abs() <= length(step) + 1e-12, "{change}");
    }

    #[test]
    fn masks_are_from_0_to_1_and_follow_the_distance(
        options in options(),
        at in [-2_147_483_648.0..2_147_483_648.0_f64, -2_147_483_648.0..2_147_483_648.0_f64],
    ) {
        let shape = Shape::new(options).unwrap();
        let mask = shape.field(ShapeValue::Mask).sample(at);
        let distance = shape.field(ShapeValue::Distance).sample(at);
        prop_assert!((0.0..=1.0).contains(&mask), "{mask}");
        prop_assert!(mask == 0.5 || (mask > 0.5) == (distance < 0.0), "{mask} at {distance}");
    }
}

fn repeated(kind: ShapeKind) -> Shape {
    let options = ShapeOptions {
        kind,
        center: [0.3, 0.6],
        size: 0.2,
        rotation: 20.0,
        rounding: 0.1,
        onion: 0.2,
        frequency: [Some(2.0), Some(1.0)],
        ..ShapeOptions::default()
    };
    Shape::new(options).unwrap()
}

#[test]
fn values_repeat_exactly_and_windows_equal_samples() {
    for (&kind, &value) in ShapeKind::ALL
        .iter()
        .flat_map(|kind| ShapeValue::ALL.iter().map(move |value| (kind, value)))
    {
        let field = repeated(kind).field(value);
        assert_eq!(field.period(), [Some(0.5), Some(1.0)]);
        let window = Window::new([0.0; 2], [1.0; 2], [32, 32]).unwrap();
        let raster = field.to_raster(&window).unwrap();
        for far in [[0.5, 0.0], [0.0, -1.0], [2_147_483_647.5, -2_147_483_648.0]] {
            let moved = Window::new(far, [1.0; 2], [32, 32]).unwrap();
            assert_eq!(
                field.to_raster(&moved).unwrap(),
                raster,
                "{kind} {value} at {far:?}"
            );
        }
        for (column, row) in [(0, 0), (17, 21), (31, 5)] {
            let sample = field.sample(window.position(column, row));
            assert_eq!(raster.row(row)[column as usize], sample, "{kind} {value}");
        }
    }
}

#[test]
fn rounding_keeps_the_width_and_an_onion_is_a_shell() {
    for (&kind, rounding) in ShapeKind::ALL
        .iter()
        .flat_map(|kind| [0.0, 0.3].map(|rounding| (kind, rounding)))
    {
        let options = ShapeOptions {
            kind,
            rounding,
            center: [0.0; 2],
            ..ShapeOptions::default()
        };
        let shape = Shape::new(options).unwrap();
        // The first position on the shape from the left or, for polygons, from the top
        let is_upright = matches!(kind, ShapeKind::Polygon | ShapeKind::Star);
        let first = (0..4000)
            .map(|index| -0.5 + f64::from(index) * 1e-4)
            .find(|&first| {
                (0..400).any(|across| {
                    let across = -0.25 + f64::from(across) * 0.00125;
                    shape.distance(if is_upright {
                        [across, first]
                    } else {
                        [first, across]
                    }) <= 0.0
                })
            });
        let found = first.expect("the shape is met");
        // Rows are 0.00125 apart, and the shape is at most a tenth of a row narrower between them.
        assert!(
            (found + 0.25).abs() < 3e-4,
            "{kind} with rounding {rounding}: {found}"
        );

        let shell = Shape::new(ShapeOptions {
            onion: 0.2,
            ..options
        })
        .unwrap();
        let at = [0.11, -0.17];
        assert_eq!(shell.distance(at), shape.distance(at).abs() - 0.1 * 0.25);
    }
}

#[test]
fn options_out_of_range_are_refused() {
    let refused = |options: ShapeOptions| {
        let error = Shape::new(options).unwrap_err();
        assert!(
            matches!(error.kind(), PatternErrorKind::Range { .. }),
            "{error}"
        );
        error.to_string()
    };
    let options = ShapeOptions::default();
    assert_eq!(
        refused(ShapeOptions {
            size: 1.0,
            frequency: [Some(20.0), None],
            ..options
        }),
        "the size of the shape is 20, but it must be at most 16 times the distance of copies"
    );
    assert_eq!(
        refused(ShapeOptions {
            sides: 2,
            ..options
        }),
        "the number of sides is 2, but it must be from 3 to 64"
    );
    assert_eq!(
        refused(ShapeOptions {
            rotation: f64::NAN,
            ..options
        }),
        "the rotation is NaN, but it must be finite"
    );
}

#[test]
fn positions_that_are_not_finite_have_no_value() {
    let field = repeated(ShapeKind::Star).field(ShapeValue::Distance);
    for at in [[f64::NAN, 0.0], [0.0, f64::INFINITY]] {
        assert!(field.sample(at).is_nan(), "{at:?}");
    }
    assert!(field.sample([1e300, -1e300]).is_finite());
}

#[test]
fn value_stability_shapes() {
    let field = |kind| repeated(kind).field(ShapeValue::Distance);
    let found: Vec<f32> = ShapeKind::ALL
        .iter()
        .map(|&kind| field(kind).sample([0.41, 0.83]))
        .collect();
    assert_eq!(found, PINNED);
}

const PINNED: [f32; 8] = [
    0.034950975,
    0.058528017,
    0.04301983,
    0.04301983,
    0.07645314,
    0.034950975,
    0.054770514,
    0.09857841,
];
