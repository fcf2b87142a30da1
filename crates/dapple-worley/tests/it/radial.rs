//! Tests of cells on a sphere.

use dapple_hash::{Seed, hash1, unit_f64};
use dapple_worley::{Combination, Metric, Radial, RadialCells, Worley3, WorleyErrorKind};
use glam::DVec3;

fn star(around: u32, polar: f64, radial: f64) -> Radial {
    let hull = Worley3::new(Seed(7))
        .with_metric(Metric::Manhattan)
        .unwrap();
    let cells = RadialCells {
        around,
        polar,
        radial,
    };
    Radial::new(hull.combine(Combination::F2_MINUS_F1), cells).unwrap()
}

#[test]
fn azimuth_closes_without_a_seam() {
    let star = star(12, 6.0, 2.0);
    for index in 0..500 {
        let height = unit_f64(hash1(Seed(1), [index], 0)) - 0.5;
        let [a, b] = [1e-9, -1e-9].map(|y| star.value([0.7, y, height]));
        // Two steps of 2^-21 cells along the azimuth, whose distance changes by as much, twice for F2 - F1.
        assert!((a - b).abs() < 4e-6, "{a} and {b} at height {height}");
    }
}

#[test]
fn gradient_is_that_of_differences() {
    let star = star(9, 5.0, 3.0);
    let mut smooth = 0;
    for index in 0..300 {
        let at =
            DVec3::from_array([0, 1, 2].map(|axis| unit_f64(hash1(Seed(2), [index], axis)) - 0.4));
        if at.truncate().length() < 0.1 {
            continue;
        }
        let h = 1e-4;
        let slopes = [DVec3::X, DVec3::Y, DVec3::Z]
            .map(|axis| [at + axis * h, at - axis * h].map(|at| f64::from(star.value(at))));
        let differences = DVec3::from_array(slopes.map(|[a, b]| (a - b) / (2.0 * h)));
        // Where the distances have a crease within the difference, or are rounded to steps, they disagree.
        smooth += u32::from((differences - star.gradient(at)).length() < 0.05);
    }
    assert!(smooth > 240, "only {smooth} of 300 gradients agree");
}

#[test]
fn poles_and_center_have_finite_gradients() {
    let star = star(9, 5.0, 3.0);
    for at in [
        DVec3::ZERO,
        DVec3::Z,
        -DVec3::Z,
        DVec3::new(1e-200, 0.0, 1.0),
    ] {
        assert!(star.value(at) >= 0.0, "{at}");
        assert!(!star.gradient(at).is_nan(), "{at}");
    }
    assert!(star.value([f64::NAN, 0.0, 0.0]).is_nan());
}

#[test]
fn bad_numbers_of_cells_are_refused() {
    for (around, polar, radial) in [
        (0, 1.0, 1.0),
        (1, 0.0, 1.0),
        (1, f64::NAN, 0.0),
        (1, 1.0, -1.0),
    ] {
        let texture = Worley3::new(Seed(7)).combine(Combination::F1);
        let error = Radial::new(
            texture,
            RadialCells {
                around,
                polar,
                radial,
            },
        )
        .unwrap_err();
        assert!(
            matches!(error.kind(), WorleyErrorKind::Range { .. }),
            "{error}"
        );
    }
}
