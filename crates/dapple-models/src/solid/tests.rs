//! Tests the distances of solids against sampled distances.

use super::{
    Ball, Bent, Blend, Ellipsoid, Grown, Mirrored, Placed, RoundBox, RoundCone, Scaled, Solid,
    Torus, Tube,
};
use dapple_hash::Seed;
use dapple_mesh::rotation;
use glam::DVec3;

fn ellipsoid() -> Ellipsoid {
    Ellipsoid {
        center: DVec3::new(0.1, 0.2, -0.1),
        radii: DVec3::new(1.0, 0.1, 0.4),
    }
}

fn cone() -> RoundCone {
    RoundCone {
        ends: [DVec3::new(-0.5, 0.1, 0.0), DVec3::new(0.6, 0.4, 0.3)],
        radii: [0.4, 0.1],
    }
}

fn solids() -> Vec<(&'static str, Box<dyn Solid>)> {
    let tube = Tube::through(&[
        [-0.8, 0.0, 0.0, 0.2],
        [0.0, 0.5, 0.0, 0.1],
        [0.7, 0.0, 0.4, 0.05],
    ]);
    let torus = Torus {
        center: DVec3::X * 0.2,
        axis: DVec3::new(0.6, 0.0, 0.8),
        ring: 0.6,
        tube: 0.2,
    };
    let rounded = RoundBox {
        center: DVec3::Y * 0.1,
        half: DVec3::new(0.3, 0.5, 0.8),
        rounding: 0.1,
    };
    let placed = Placed {
        solid: ellipsoid(),
        rotation: rotation(DVec3::X, 0.7),
        offset: DVec3::Z * 0.3,
    };
    let scale = DVec3::new(1.0, 0.3, 0.7);
    let ball = Ball {
        center: DVec3::Y * 0.3,
        radius: 0.6,
    };
    vec![
        ("ball", Box::new(ball)),
        ("ellipsoid", Box::new(ellipsoid())),
        ("cone", Box::new(cone())),
        ("torus", Box::new(torus)),
        ("box", Box::new(rounded)),
        ("tube", Box::new(tube.clone())),
        ("placed", Box::new(placed)),
        ("mirrored", Box::new(Mirrored(cone()))),
        (
            "scaled",
            Box::new(Scaled {
                solid: torus,
                scale,
            }),
        ),
        (
            "grown",
            Box::new(Grown {
                solid: rounded,
                by: 0.1,
            }),
        ),
        ("bent", Box::new(Bent::new(cone(), -0.4))),
        (
            "blend",
            Box::new(Blend::of(torus).with_pair(tube, 0.2).with(ball, 0.1)),
        ),
    ]
}

/// Iterates over positions in a cube that contains the solids.
fn positions() -> impl Iterator<Item = DVec3> {
    let part =
        |number: u64| (Seed(5).child("position", number).0 >> 11) as f64 / (1_u64 << 53) as f64;
    (0..3000).map(move |index| {
        DVec3::from_array([0, 1, 2].map(|axis| 4.0 * part(3 * index + axis) - 2.0))
    })
}

#[test]
fn distances_change_no_faster_than_the_position() {
    for (name, solid) in solids() {
        let mut last = DVec3::ZERO;
        for at in positions() {
            for other in [last, at + DVec3::new(1e-3, -2e-3, 1.5e-3)] {
                let change = (solid.distance(at) - solid.distance(other)).abs();
                // The tolerance covers rounding.
                let most = (at - other).length() + 1e-9;
                assert!(change <= most, "{name} at {at} and {other}: {change}");
            }
            last = at;
        }
    }
}

#[test]
fn solids_lie_within_their_bounds() {
    for (name, solid) in solids() {
        let [low, high] = solid.bounds();
        for at in positions().filter(|&at| solid.distance(at) < 0.0) {
            assert!(
                at.cmpge(low).all() && at.cmple(high).all(),
                "{name} at {at}"
            );
        }
    }
}

#[test]
fn distance_of_an_ellipsoid_equals_the_nearest_of_many_points() {
    let Ellipsoid { center, radii } = ellipsoid();
    let outside = |at: &DVec3| ((*at - center) / radii).length() > 1.0;
    let on = |at: DVec3| center + radii * at.normalize();
    for at in positions().filter(outside).take(100) {
        // Random search for the nearest point, with steps of decreasing size.
        let mut best = on(at);
        let mut reach = 1.0;
        for _ in 0..8 {
            for step in positions().take(600) {
                let other = on((best - center) / radii + step * reach);
                if at.distance_squared(other) < at.distance_squared(best) {
                    best = other;
                }
            }
            reach *= 0.3;
        }
        let (fast, slow) = (ellipsoid().distance(at), at.distance(best));
        // The search ends within some 1e-4 of the nearest point, and the distance is flat there.
        assert!((fast - slow).abs() < 1e-5, "{at}: {fast}, {slow}");
    }
}

#[test]
fn distance_of_a_round_cone_equals_that_of_many_balls() {
    let RoundCone { ends, radii } = cone();
    for at in positions() {
        let balls = (0..=4000).map(|index| {
            let part = f64::from(index) / 4000.0;
            at.distance(ends[0].lerp(ends[1], part)) - (radii[0] + (radii[1] - radii[0]) * part)
        });
        let slow = balls.fold(f64::INFINITY, f64::min);
        let fast = cone().distance(at);
        // The balls are 3e-4 apart, and the distance has a crease there on the axis.
        assert!((fast - slow).abs() < 2e-4, "{at}: {fast}, {slow}");
    }
}

#[test]
fn a_ball_in_a_ball_is_the_bigger_one() {
    for radii in [[0.5, 0.1], [0.1, 0.5], [0.3, 0.3]] {
        let ends = [
            DVec3::ZERO,
            DVec3::X * if radii[0] == radii[1] { 0.0 } else { 0.2 },
        ];
        let bigger = if radii[0] >= radii[1] {
            ends[0]
        } else {
            ends[1]
        };
        let distance = RoundCone { ends, radii }.distance(DVec3::Y);
        let ball = Ball {
            center: bigger,
            radius: radii[0].max(radii[1]),
        };
        assert_eq!(distance, ball.distance(DVec3::Y), "{radii:?}");
    }
}

#[test]
fn odd_sizes_do_not_panic() {
    let odd = [0.0, -1.0, f64::NAN, f64::INFINITY];
    for size in odd {
        let ball = Ball {
            center: DVec3::ZERO,
            radius: size,
        };
        let flat = Ellipsoid {
            center: DVec3::ZERO,
            radii: DVec3::new(1.0, size, 1.0),
        };
        let cone = RoundCone {
            ends: [DVec3::ZERO, DVec3::X * size],
            radii: [size, 0.1],
        };
        let solid = Blend::of(ball)
            .with(flat, size)
            .with(cone, 0.1)
            .with(Tube::through(&[]), 0.1);
        let distance = Bent::new(solid, size).distance(DVec3::splat(0.4));
        assert!(
            distance.is_nan() || distance >= f64::NEG_INFINITY,
            "a number or none"
        );
    }
}
