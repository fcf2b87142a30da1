//! Tests that positions are rounded down to whole steps of a cell.

use dapple_hash::Seed;
use dapple_worley::{POSITION_STEP, Worley2};

#[test]
fn places_are_rounded_down_to_steps() {
    let worley = Worley2::new(Seed(7));
    let step = f64::from(POSITION_STEP);
    for (position, place) in [
        (1.5 + 0.9 * step, 1.5),
        (-0.25 + 0.9 * step, -0.25),
        (-0.25 - 0.1 * step, -0.25 - step),
        (1e9 + 0.5 + 0.25 * step, 1e9 + 0.5),
        // Rounded up to the next cell, since its fraction is that close to 1.
        (-1e-30, 0.0),
        (-0.0, 0.0),
    ] {
        for at in [|x| [x, 0.5], |y| [0.5, y]] {
            let [found, expected] = [position, place].map(|x: f64| worley.sample::<4>(at(x)));
            assert_eq!(found, expected, "{position}");
        }
    }
}

#[test]
fn positions_without_a_cell_have_no_place() {
    let worley = Worley2::new(Seed(7));
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e19, -1e300] {
        assert!(worley.sample::<1>([0.0, bad])[0].distance.is_nan(), "{bad}");
    }
    let [far] = worley.sample::<1>([4e18, -4e18]);
    assert!(far.distance >= 0.0, "4e18 is within 2^62");
}

#[test]
fn one_coordinate_is_rounded_like_many_everywhere() {
    // Many coordinates are rounded in SIMD lanes, by another formula than one.
    let worley = Worley2::new(Seed(7));
    let step = f64::from(POSITION_STEP);
    let limit = (1_u64 << 30) as f64;
    let mut coordinates = Vec::new();
    for near in [
        0.0,
        step,
        0.5,
        0.5 + step,
        1.0,
        3.25,
        1e6,
        limit,
        2.0 * limit,
        1e15,
    ] {
        for tiny in [0.0, 1e-30, 1e-17, 6e-17, 1e-10, 0.4 * step, 0.5 * step] {
            coordinates.extend([near + tiny, near - tiny, -near + tiny, -near - tiny]);
        }
        let near_f64: [f64; 2] = [near, -near];
        coordinates.extend(
            near_f64
                .into_iter()
                .flat_map(|at| [at.next_up(), at.next_down()]),
        );
    }
    for &at in &coordinates {
        let mut many = [worley.sample::<2>([0.0; 2])];
        worley.sample_many(&[[at, 0.3]], &mut many).unwrap();
        assert_eq!(worley.sample::<2>([at, 0.3]), many[0], "{at:e}");
    }
}
