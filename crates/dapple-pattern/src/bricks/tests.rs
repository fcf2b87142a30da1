//! Compares bricks with naive implementations that measure the distances to all faces around a position.

use super::{Bond, BrickOptions, BrickValue, Bricks};
use crate::PatternErrorKind;
use crate::lattice::length;
use dapple_hash::{CellHash, Seed, unit_f64};
use dapple_raster::{Field as _, FieldExt as _, Named as _, Window};
use proptest::prelude::*;

/// A rectangular face: its brick, its extent along x and y, and whether its long axis is vertical.
struct Face {
    id: [i64; 2],
    x: [f64; 2],
    y: [f64; 2],
    upright: bool,
}

/// Returns the cells of all rectangular bricks around the origin, from the definition of the bond.
fn cells(bricks: &Bricks) -> Vec<Face> {
    let options = bricks.options;
    let [w, h] = bricks.cell;
    let n = i64::from(options.length);
    let mut faces = Vec::new();
    let mut add = |id: [i64; 2], [x, y]: [f64; 2], [dx, dy]: [f64; 2], upright| {
        let (x, y) = ([x * w, (x + dx) * w], [y * h, (y + dy) * h]);
        faces.push(Face { id, x, y, upright });
    };
    for row in -12..12_i64 {
        let odd = row.rem_euclid(2);
        for column in -12..12_i64 {
            let (c, r, length) = (column as f64, row as f64, n as f64);
            let id = [column, row];
            match options.bond {
                Bond::Stack => add(id, [c, r], [1.0, 1.0], false),
                Bond::Running => add(id, [c + options.offset * odd as f64, r], [1.0; 2], false),
                Bond::Flemish if column % 2 == 0 => {
                    let left = c - odd as f64;
                    add(id, [left, r], [4.0 / 3.0, 1.0], false);
                    add(
                        [column + 1, row],
                        [left + 4.0 / 3.0, r],
                        [2.0 / 3.0, 1.0],
                        false,
                    );
                }
                // A horizontal brick begins at every square of the diagonals whose number is a multiple of two lengths,
                // and a vertical brick below this square.
                Bond::Herringbone if (column - row).rem_euclid(2 * n) == 0 => {
                    add(id, [c, r], [length, 1.0], false);
                    add([column, row + 1], [c, r + 1.0], [1.0, length], true);
                }
                Bond::Basket if column % n == 0 && row % n == 0 => {
                    for index in 0..n {
                        let along = index as f64;
                        if (column / n + row / n) % 2 == 0 {
                            add([column, row + index], [c, r + along], [length, 1.0], false);
                        } else {
                            add([column + index, row], [c + along, r], [1.0, length], true);
                        }
                    }
                }
                Bond::Planks => {
                    let seed = bricks.seed;
                    let offset = unit_f64(CellHash::new(seed.child("course", 0), [row]).at(0));
                    let border = |column: i64| {
                        let ends = seed.child("end", 0);
                        let random = unit_f64(CellHash::new(ends, [column, row]).at(0));
                        column as f64 + 0.5 * options.variation * (random - 0.5) - offset
                    };
                    let [left, right] = [border(column), border(column + 1)];
                    add(id, [left, r], [right - left, 1.0], false);
                }
                _ => {}
            }
        }
    }
    faces
}

/// Returns the depth of a position in a face with rounded corners. The face is inset by the radius; inside, the depth
/// is the radius plus the distance to the nearest inset side, and outside, the radius minus the distance to the inset
/// face.
fn depth(bricks: &Bricks, face: &Face, [x, y]: [f64; 2]) -> f64 {
    let inset = [0, 1, 2, 3].map(|side| bricks.inset(face.id, side));
    let (left, right) = (face.x[0] + inset[0], face.x[1] - inset[1]);
    let (top, bottom) = (face.y[0] + inset[2], face.y[1] - inset[3]);
    let radius = bricks.options.rounding * bricks.unit;
    let radius = radius.min((right - left) / 2.0).min((bottom - top) / 2.0);
    let nearest = [
        x.clamp(left + radius, (right - radius).max(left + radius)),
        y.clamp(top + radius, (bottom - radius).max(top + radius)),
    ];
    let outside = length([x - nearest[0], y - nearest[1]]);
    let inside = (x - left).min(right - x).min(y - top).min(bottom - y);
    if outside > 0.0 {
        radius - outside
    } else {
        inside
    }
}

const RECTANGLES: [Bond; 6] = [
    Bond::Stack,
    Bond::Running,
    Bond::Flemish,
    Bond::Herringbone,
    Bond::Basket,
    Bond::Planks,
];

fn options() -> impl Strategy<Value = BrickOptions> {
    let bond = proptest::sample::select(Bond::ALL);
    let frequency = [0.5..2.0_f64, 0.5..4.0_f64];
    let lengths = (0.0..0.5_f64, 0.0..0.5_f64, 0.0..0.5_f64, 0.0..1.0_f64);
    let rest = (0.0..1.0_f64, 1..4_u32, 0.0..1.0_f64);
    (bond, frequency, lengths, rest).prop_map(|(bond, frequency, lengths, rest)| BrickOptions {
        frequency,
        period: [None; 2],
        bond,
        offset: rest.0,
        length: rest.1,
        variation: rest.2,
        joint: lengths.0,
        bevel: lengths.1,
        rounding: lengths.2,
        jitter: lengths.3,
    })
}

/// Tolerance: sums of a few products of numbers of about 1.
const ROUNDING: f64 = 1e-12;

proptest! {
    #[test]
    fn rectangles_equal_the_nearest_of_all_faces(
        mut options in options(),
        bond in proptest::sample::select(&RECTANGLES),
        seed in any::<u64>(),
        at in [-1.0..1.0_f64, -1.0..1.0_f64],
    ) {
        options.bond = bond;
        let bricks = Bricks::new(seed, options).unwrap();
        let faces = cells(&bricks);
        let depths = faces.iter().map(|face| depth(&bricks, face, at));
        let expected = depths.fold(f64::NEG_INFINITY, f64::max);
        let found = bricks.rectangle_edge_distance(
            [0, 1].map(|axis| crate::lattice::Split::of(at[axis] * options.frequency[axis])),
        );
        prop_assert!((found - expected).abs() < ROUNDING, "{found}, but {expected}");
        // The brick whose cell holds the position gives the other values.
        let holds = |face: &&Face| {
            let inside = |[first, last]: [f64; 2], at: f64| at >= first && at < last;
            inside(face.x, at[0]) && inside(face.y, at[1])
        };
        let own: Vec<&Face> = faces.iter().filter(holds).collect();
        prop_assert_eq!(own.len(), 1, "cells divide the plane");
        let value = |value| bricks.field(value).sample(at);
        prop_assert_eq!(value(BrickValue::Random), bricks.random(own[0].id, 0));
        prop_assert_eq!(value(BrickValue::Row), own[0].id[1] as f32);
        prop_assert_eq!(value(BrickValue::Column), own[0].id[0] as f32);
        prop_assert_eq!(value(BrickValue::Direction) == 1.0, own[0].upright);
    }

    #[test]
    fn hexagons_equal_the_nearest_of_all_polygons(
        mut options in options(),
        seed in any::<u64>(),
        at in [-1.0..1.0_f64, -1.0..1.0_f64],
    ) {
        options.bond = Bond::Hexagons;
        let bricks = Bricks::new(seed, options).unwrap();
        let expected = polygons(&bricks, at);
        let found = f64::from(bricks.field(BrickValue::EdgeDistance).sample(at));
        // The field rounds to single precision.
        prop_assert!((found - expected).abs() < 1e-6, "{found}, but {expected}");
    }

    #[test]
    fn roof_tiles_equal_the_uppermost_of_all_tiles(
        mut options in options(),
        is_round in any::<bool>(),
        seed in any::<u64>(),
        at in [-1.0..1.0_f64, -1.0..1.0_f64],
    ) {
        options.bond = if is_round { Bond::RoofTiles } else { Bond::Slates };
        let bricks = Bricks::new(seed, options).unwrap();
        let (expected, id) = tiles(&bricks, at);
        let found = f64::from(bricks.field(BrickValue::EdgeDistance).sample(at));
        prop_assert!((found - expected).abs() < 1e-6, "{found}, but {expected}");
        if let Some(id) = id {
            let row = bricks.field(BrickValue::Row).sample(at);
            prop_assert_eq!(row, id[1] as f32);
            prop_assert_eq!(bricks.field(BrickValue::Random).sample(at), bricks.random(id, 0));
        }
    }

    #[test]
    fn values_are_within_their_ranges_at_any_position(
        options in options(),
        seed in any::<u64>(),
        at in [-2_147_483_648.0..2_147_483_648.0_f64, -2_147_483_648.0..2_147_483_648.0_f64],
    ) {
        let bricks = Bricks::new(seed, options).unwrap();
        for value in [BrickValue::Height, BrickValue::U, BrickValue::V, BrickValue::Direction] {
            let found = bricks.field(value).sample(at);
            prop_assert!((0.0..=1.0).contains(&found), "{value}: {found}");
        }
        for value in [BrickValue::Random, BrickValue::Random2, BrickValue::Random3] {
            let found = bricks.field(value).sample(at);
            prop_assert!((0.0..1.0).contains(&found), "{value}: {found}");
        }
        // A position is on a face exactly where the height is above 0, except on roofs, whose courses lie over others.
        let distance = bricks.field(BrickValue::EdgeDistance).sample(at);
        prop_assert!(f64::from(distance) <= bricks.cell[0].max(bricks.cell[1]) * 4.0);
        if !matches!(options.bond, Bond::RoofTiles | Bond::Slates) {
            let height = bricks.field(BrickValue::Height).sample(at);
            prop_assert!(height == 0.0 || distance >= 0.0);
        }
    }
}

/// Returns the depth of a position in the surrounding hexagon where it is largest. Corners are computed as
/// intersections of all pairs of sides.
fn polygons(bricks: &Bricks, at: [f64; 2]) -> f64 {
    let [w, h] = bricks.cell;
    let center = |[column, row]: [i64; 2]| {
        let odd = row.rem_euclid(2) as f64;
        [
            (column as f64 + 0.5 + 0.5 * odd) * w,
            (row as f64 + 0.5) * h,
        ]
    };
    let mut deepest = f64::NEG_INFINITY;
    for [row, column] in (-9..9).flat_map(|row| (-9..9).map(move |column| [row, column])) {
        let id = [column, row];
        let [x, y] = center(id);
        let sides = sides(bricks, id);
        let least = sides
            .iter()
            .fold(f64::INFINITY, |least, side| least.min(side.1));
        let radius = (bricks.options.rounding * bricks.unit).min(0.9 * least);
        let p = [at[0] - x, at[1] - y];
        let past = |side: &([f64; 2], f64), p: [f64; 2]| {
            side.0[0] * p[0] + side.0[1] * p[1] - side.1 + radius
        };
        let inside = sides
            .iter()
            .map(|side| -past(side, p))
            .fold(f64::INFINITY, f64::min);
        if inside >= 0.0 {
            deepest = deepest.max(radius + inside);
            continue;
        }
        // The nearest point is a corner, or the foot of the perpendicular to a side.
        let holds = |p: [f64; 2]| sides.iter().all(|side| past(side, p) <= 1e-9);
        let mut nearest = f64::INFINITY;
        for (index, a) in sides.iter().enumerate() {
            let over = past(a, p);
            let foot = [p[0] - over * a.0[0], p[1] - over * a.0[1]];
            if holds(foot) {
                nearest = nearest.min(over.abs());
            }
            for b in &sides[..index] {
                let cross = a.0[0] * b.0[1] - a.0[1] * b.0[0];
                if cross.abs() < 1e-9 {
                    continue;
                }
                let [da, db] = [a.1 - radius, b.1 - radius];
                let corner = [
                    (da * b.0[1] - db * a.0[1]) / cross,
                    (db * a.0[0] - da * b.0[0]) / cross,
                ];
                if holds(corner) {
                    nearest = nearest.min(length([p[0] - corner[0], p[1] - corner[1]]));
                }
            }
        }
        deepest = deepest.max(radius - nearest);
    }
    deepest
}

/// Returns the normals of the sides of a hexagon's face, and their distances from the center.
fn sides(bricks: &Bricks, id: [i64; 2]) -> Vec<([f64; 2], f64)> {
    let [w, h] = bricks.cell;
    let steps = [
        [-1.0, 0.0],
        [1.0, 0.0],
        [-0.5, -1.0],
        [0.5, -1.0],
        [-0.5, 1.0],
        [0.5, 1.0],
        [0.0, -2.0],
        [0.0, 2.0],
    ];
    let side = |(index, [columns, rows]): (u32, [f64; 2])| {
        let vector = [columns * w, rows * h];
        let length = length(vector);
        let distance = 0.5 * length - bricks.inset(id, index);
        (vector.map(|part| part / length), distance)
    };
    (0..).zip(steps).map(side).collect()
}

/// Returns the distance to the border of the uppermost roof tile at a position, and the tile's id; `None` in a joint.
fn tiles(bricks: &Bricks, at: [f64; 2]) -> (f64, Option<[i64; 2]>) {
    let [w, h] = bricks.cell;
    let options = bricks.options;
    let row = (at[1] / h).floor() as i64;
    let mut deepest = Vec::new();
    for row in row - 1..=row + 1 {
        let mut best = (f64::NEG_INFINITY, [0, row]);
        for column in -12..12 {
            let id = [column, row];
            let x = (column as f64 + options.offset * row.rem_euclid(2) as f64) * w;
            let [left, right, bottom] = [0, 1, 3].map(|side| bricks.inset(id, side));
            // A tile is a tall face with round corners at its lower end alone.
            let (left, right) = (x + left, x + w - right);
            let bottom = (row + 1) as f64 * h - (bottom - 0.5 * options.joint * bricks.unit);
            let half = 0.5 * (right - left);
            let radius = match options.bond {
                Bond::RoofTiles => half.min(0.75 * h),
                _ => (options.rounding * bricks.unit).min(half),
            };
            let nearest = [
                at[0].clamp(left + radius, (right - radius).max(left + radius)),
                at[1].min(bottom - radius),
            ];
            let outside = length([at[0] - nearest[0], at[1] - nearest[1]]);
            let inside = (at[0] - left).min(right - at[0]).min(bottom - at[1]);
            let depth = if outside > 0.0 {
                radius - outside
            } else {
                inside
            };
            if depth > best.0 {
                best = (depth, id);
            }
        }
        deepest.push(best);
    }
    match deepest[..] {
        [above, own, _] if own.0 >= 0.0 => (own.0.min(-above.0), Some(own.1)),
        [_, own, lower] if lower.0 >= 0.0 => (lower.0.min(-own.0), Some(lower.1)),
        [_, own, lower] => (own.0.max(lower.0), None),
        _ => unreachable!("three courses"),
    }
}

/// Returns bricks of a bond with a period of 8 bricks and 16 courses, four units of the plane along each axis.
fn periodic(bond: Bond) -> Bricks {
    let options = BrickOptions {
        frequency: [2.0, 4.0],
        period: [Some(8), Some(16)],
        bond,
        jitter: 0.5,
        ..BrickOptions::default()
    };
    Bricks::new(Seed(3), options).unwrap()
}

#[test]
fn values_repeat_exactly_and_windows_equal_samples() {
    for (&bond, &value) in Bond::ALL
        .iter()
        .flat_map(|bond| BrickValue::ALL.iter().map(move |value| (bond, value)))
    {
        let field = periodic(bond).field(value);
        assert_eq!(field.period(), [Some(4.0), Some(4.0)]);
        let window = Window::new([0.0; 2], [4.0; 2], [64, 64]).unwrap();
        let raster = field.to_raster(&window).unwrap();
        for far in [
            [4.0, 0.0],
            [0.0, -4.0],
            [2_147_483_648.0 - 4.0, -2_147_483_648.0],
        ] {
            let moved = Window::new(far, [4.0; 2], [64, 64]).unwrap();
            assert_eq!(
                field.to_raster(&moved).unwrap(),
                raster,
                "{bond} {value} at {far:?}"
            );
        }
        for (column, row) in [(0, 0), (17, 41), (63, 5)] {
            let sample = field.sample(window.position(column, row));
            assert_eq!(raster.row(row)[column as usize], sample, "{bond} {value}");
        }
    }
}

#[test]
fn joints_are_equally_wide_along_both_axes() {
    let options = BrickOptions {
        frequency: [1.0, 4.0],
        joint: 0.2,
        rounding: 0.0,
        ..BrickOptions::default()
    };
    let wall = Bricks::new(
        Seed(1),
        BrickOptions {
            bond: Bond::Stack,
            ..options
        },
    )
    .unwrap();
    // The shorter side is ¼: half of a joint is 0.025 along both axes.
    let distance = wall.field(BrickValue::EdgeDistance);
    for at in [[0.025, 0.125], [0.975, 0.125], [0.5, 0.025], [0.5, 0.225]] {
        assert!(
            distance.sample(at).abs() < 1e-7,
            "{at:?}: {}",
            distance.sample(at)
        );
    }
    // The middle of a crossing is a diagonal away from the corners.
    let expected = -(2.0_f32).sqrt() * 0.025;
    assert!((distance.sample([1.0, 0.25]) - expected).abs() < 1e-7);
}

#[test]
fn hexagons_are_regular_if_courses_are_half_of_the_root_of_three_apart() {
    let options = BrickOptions {
        frequency: [1.0, 2.0 / 3.0_f64.sqrt()],
        bond: Bond::Hexagons,
        joint: 0.0,
        rounding: 0.0,
        ..BrickOptions::default()
    };
    let bricks = Bricks::new(Seed(1), options).unwrap();
    let distance = bricks.field(BrickValue::EdgeDistance);
    // From the center of a hexagon, the six neighbors are 1 away in all six directions.
    let (center, third) = (
        [0.5, 0.5 / options.frequency[1]],
        core::f64::consts::FRAC_PI_3,
    );
    for index in 0..6 {
        let (sin, cos) = libm::sincos(third * f64::from(index));
        let at = [center[0] + 0.3 * cos, center[1] + 0.3 * sin];
        assert!((distance.sample(at) - 0.2).abs() < 1e-6, "{index}");
    }
    assert!((distance.sample(center) - 0.5).abs() < 1e-6);
}

#[test]
fn periods_that_do_not_suit_the_bond_are_refused() {
    for (bond, period, what) in [
        (
            Bond::Running,
            [Some(4), Some(3)],
            "number of courses in the period",
        ),
        (
            Bond::Flemish,
            [Some(3), Some(4)],
            "number of bricks in the period",
        ),
        (
            Bond::Herringbone,
            [Some(4), Some(6)],
            "number of courses in the period",
        ),
        (
            Bond::Stack,
            [Some(0), None],
            "number of bricks in the period",
        ),
    ] {
        let options = BrickOptions {
            period,
            bond,
            ..BrickOptions::default()
        };
        let error = Bricks::new(Seed(1), options).unwrap_err();
        let PatternErrorKind::Range { what: found, .. } = error.kind() else {
            panic!("{error}");
        };
        assert_eq!(*found, what, "{bond}");
    }
    let options = BrickOptions {
        joint: 1.0,
        ..BrickOptions::default()
    };
    let error = Bricks::new(Seed(1), options).unwrap_err();
    assert_eq!(
        error.to_string(),
        "the width of joints is 1, but it must be from 0 to 0.9"
    );
}

#[test]
fn positions_that_are_not_finite_have_no_value() {
    for &bond in Bond::ALL {
        let field = periodic(bond).field(BrickValue::Height);
        for at in [[f64::NAN, 0.0], [0.0, f64::INFINITY]] {
            assert!(field.sample(at).is_nan(), "{bond}");
        }
        assert!(field.sample([1e300, -1e300]).is_finite(), "{bond}");
    }
}

#[test]
fn value_stability_bricks() {
    let found: Vec<[f32; 3]> = Bond::ALL
        .iter()
        .map(|&bond| {
            let value = |value, at| periodic(bond).field(value).sample(at);
            [
                value(BrickValue::Height, [1.37, 2.02]),
                value(BrickValue::EdgeDistance, [1.3, 2.27]),
                value(BrickValue::Random2, [1.3, 2.27]),
            ]
        })
        .collect();
    assert_eq!(found, PINNED);
}

const PINNED: [[f32; 3]; 9] = [
    [0.013642672, -0.015728367, 0.5311925],
    [0.013642672, -0.015728367, 0.5311925],
    [0.013642672, -0.014461135, 0.7477752],
    [1.0, -0.014637213, 0.574564],
    [0.013642672, 0.1763047, 0.867598],
    [0.0, 0.008757246, 0.867598],
    [0.013642672, -0.014461135, 0.7477752],
    [0.54, 0.024023931, 0.5311925],
    [0.54, 0.023727458, 0.5311925],
];
