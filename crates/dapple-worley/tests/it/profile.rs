//! Tests of profiles for bumps.

use dapple_worley::Profile;

#[test]
fn profiles_go_from_end_to_end_and_their_slopes_are_their_derivatives() {
    let [spots, channels] = [
        Profile::spots(0.25).unwrap(),
        Profile::channels(0.25).unwrap(),
    ];
    assert_eq!(
        [spots.height(0.0), spots.height(0.25), spots.height(7.0)],
        [1.0, 0.0, 0.0]
    );
    let heights = [
        channels.height(0.0),
        channels.height(0.25),
        channels.height(7.0),
    ];
    assert_eq!(heights, [0.0, 1.0, 1.0]);
    for profile in [spots, channels] {
        for value in (0..50).map(|step| step as f32 / 100.0) {
            let h = 1e-3;
            let difference = (profile.height(value + h) - profile.height(value - h)) / (2.0 * h);
            // Second differences of a profile reach 48 per unit, and the step is 1e-3.
            assert!(
                (difference - profile.slope(value)).abs() < 0.06,
                "{profile:?} at {value}: {difference} for {}",
                profile.slope(value)
            );
        }
    }
}

#[test]
fn profiles_without_width_are_refused() {
    for bad in [0.0, -1.0, f32::NAN, f32::INFINITY, 1e-45] {
        assert!(Profile::spots(bad).is_err(), "{bad}");
        assert!(Profile::channels(bad).is_err(), "{bad}");
    }
}
