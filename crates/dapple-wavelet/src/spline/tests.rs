//! Tests of B-splines against their definition.

use super::*;
use crate::oracle::{DEGREES, all_filters, spread};

/// Returns the value at `x` of the B-spline of degree `d`, by the recursion of Cox and de Boor, starting with the box
/// function.
fn cox_de_boor(d: i64, x: f64) -> f64 {
    if d == 0 {
        return f64::from(u8::from((-0.5..0.5).contains(&x)));
    }
    let half = (d + 1) as f64 / 2.0;
    let [left, right] = [cox_de_boor(d - 1, x + 0.5), cox_de_boor(d - 1, x - 0.5)];
    ((half + x) * left + (half - x) * right) / d as f64
}

fn positions() -> impl Iterator<Item = f64> {
    // Avoid multiples of one half, where low degrees are discontinuous.
    (-200..200).map(|i| (f64::from(i) + 0.37) / 64.0)
}

#[test]
fn value_agrees_with_cox_and_de_boor() {
    for degree in DEGREES {
        for x in positions() {
            let gap = (degree.value(x) - cox_de_boor(degree.order(), x)).abs();
            assert!(gap < 1e-15, "{degree:?} at {x}: {gap}");
        }
    }
}

#[test]
fn values_of_shifts_add_up_to_one() {
    for degree in DEGREES {
        for i in 0..64 {
            let x = f64::from(i) / 64.0;
            let sum: f64 = (-3..=3)
                .map(|shift| degree.value(x + f64::from(shift)))
                .sum();
            assert!((sum - 1.0).abs() < 1e-15, "{degree:?} at {x}: {sum}");
        }
    }
}

#[test]
fn derivative_is_the_difference_of_two_lower_splines() {
    for (d, degree) in (0_i64..).zip(DEGREES).skip(1) {
        for x in positions() {
            let needed = cox_de_boor(d - 1, x + 0.5) - cox_de_boor(d - 1, x - 0.5);
            let gap = (degree.derivative(x) - needed).abs();
            assert!(gap < 1e-15, "{degree:?} at {x}: {gap}");
        }
    }
    assert_eq!(Degree::Constant.derivative(0.1), 0.0, "steps are flat");
}

#[test]
fn value_and_derivative_vanish_far_away_and_for_nan() {
    for degree in DEGREES {
        for x in [2.0, -2.5, 1e300, f64::INFINITY, f64::NEG_INFINITY, f64::NAN] {
            assert_eq!(degree.value(x), 0.0, "{degree:?} at {x}");
            assert_eq!(degree.derivative(x), 0.0, "{degree:?} at {x}");
        }
    }
}

#[test]
fn jumps_and_bends_belong_to_the_right() {
    assert_eq!(
        [-0.5, 0.5].map(|x| Degree::Constant.value(x)),
        [1.0, 0.0],
        "the step"
    );
    assert_eq!(
        [-1.0, 0.0, 1.0].map(|x| Degree::Linear.derivative(x)),
        [1.0, -1.0, 0.0],
        "the tent"
    );
}

#[test]
fn first_tap_is_that_of_the_table() {
    for filter in all_filters() {
        let (first, last) = spread(filter);
        assert_eq!(filter.first_tap(), first, "{filter:?}");
        assert_eq!(last - first, filter.degree.order() + 1, "{filter:?}");
    }
}

#[cfg(feature = "serde")]
#[test]
fn filters_are_data() {
    let filter: SplineFilter =
        serde_json::from_str(r#"{"phase":"cook_de_rose"}"#).expect("a filter");
    assert_eq!(
        filter,
        SplineFilter {
            phase: Phase::CookDeRose,
            ..SplineFilter::default()
        },
        "defaults"
    );
    let text = serde_json::to_string(&filter).expect("a filter");
    assert_eq!(
        text, r#"{"degree":"quadratic","phase":"cook_de_rose","fit":"function"}"#,
        "as text"
    );
}
