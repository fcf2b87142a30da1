//! Tests of stamps: an oracle that visits all stamps of a tile and of its copies, and shapes and limits.
//!
//! Reference: our own.

use super::shape::Outline;
use super::{Stamp, StampOptions, StampOverlap, StampShape, StampValue, Stamps};
use crate::PatternErrorKind;
use crate::near::NearCells as _;
use dapple_hash::Seed;
use dapple_raster::{Field, FieldExt as _, Named as _, Raster, Window};

const PERIOD: u32 = 4;

fn tile() -> StampOptions {
    StampOptions {
        period: [Some(PERIOD), Some(PERIOD)],
        ..StampOptions::default()
    }
}

fn stamps(options: StampOptions) -> Stamps {
    Stamps::new(Seed(7), options).unwrap()
}

/// Returns stamps with all kinds of options. Their numbers are chosen so that positions in cells are computed without
/// rounding.
fn examples() -> Vec<Stamps> {
    let mut examples = Vec::new();
    for (index, &shape) in StampShape::ALL.iter().enumerate() {
        examples.push(stamps(StampOptions {
            shape,
            overlap: StampOverlap::ALL[index % 4],
            size: [0.5, 2.5],
            aspect: [0.25, 1.0],
            density: [1.0, 2.5, 0.25][index % 3],
            lift: 0.25,
            tilt: [-0.5, 0.0, 1.0][index % 3],
            row_offset: [0.0, 0.5, -0.25][index % 3],
            cell_height: [1.0, 0.5, 2.0][index % 3],
            height: [0.25, 1.0],
            ..tile()
        }));
    }
    examples.push(stamps(StampOptions {
        density: 3.0,
        spacing: 0.75,
        row_offset: 0.5,
        cell_height: 0.5,
        ..tile()
    }));
    // Long stamps reach over the whole tile.
    examples.push(stamps(StampOptions {
        shape: StampShape::Capsule,
        size: [4.0, 8.0],
        aspect: [0.02, 0.05],
        ..tile()
    }));
    examples
}

/// Returns the cells and indices of the points that the spacing keeps in a period, by adding points one at a time.
fn kept_points(stamps: &Stamps) -> Vec<([i64; 2], usize)> {
    let period = i64::from(PERIOD);
    let cells = (0..period * period).map(|cell| [cell % period, cell / period]);
    let mut points: Vec<_> = cells
        .flat_map(|cell| {
            let points = stamps.points(cell).enumerate();
            points.map(move |(index, point)| {
                let priority = point.hash.at(point.first + 7);
                let [x, y] = point.position;
                (
                    priority,
                    cell,
                    index,
                    [x + cell[0] as f64, y + cell[1] as f64],
                )
            })
        })
        .collect();
    points.sort_by_key(|&(priority, ..)| core::cmp::Reverse(priority));
    let mut kept: Vec<([i64; 2], usize, [f64; 2])> = Vec::new();
    for (_, cell, index, [x, y]) in points {
        let is_close = |&(_, _, [other_x, other_y]): &([i64; 2], usize, [f64; 2])| {
            (0..9).any(|copy| {
                let dx = x - other_x + f64::from(PERIOD) * f64::from(copy % 3 - 1);
                let dy = y - other_y + f64::from(PERIOD) * f64::from(copy / 3 - 1);
                let dy = dy * stamps.options.cell_height;
                dx * dx + dy * dy < stamps.options.spacing * stamps.options.spacing
            })
        };
        if !kept.iter().any(is_close) {
            kept.push((cell, index, [x, y]));
        }
    }
    kept.into_iter()
        .map(|(cell, index, _)| (cell, index))
        .collect()
}

/// Returns all stamps of a period and its copies around it, in stamping order.
fn all_stamps(stamps: &Stamps) -> Vec<Stamp> {
    let mut all = Vec::new();
    let kept = kept_points(stamps);
    let reach = 3 * i64::from(PERIOD);
    for y in -reach..reach {
        for x in -reach..reach {
            let home = [x, y].map(|cell| cell.rem_euclid(PERIOD.into()));
            for (index, mut point) in stamps.points(home).enumerate() {
                if !kept.contains(&(home, index)) {
                    continue;
                }
                point.position[0] += x as f64;
                point.position[1] += y as f64;
                all.push(stamps.stamp(&point));
            }
        }
    }
    all
}

/// Computes a value by brute force over all stamps.
fn oracle(stamps: &Stamps, all: &[Stamp], value: StampValue, position: [f64; 2]) -> f32 {
    let mut hits = Vec::new();
    for stamp in all {
        let [u, v] = stamp.local(position);
        let inside = u.abs() <= 1.0 && v.abs() <= 1.0;
        let at = |()| stamps.options.shape.at(&stamp.outline, u as f32, v as f32);
        if let Some((edge, profile)) = inside.then_some(()).and_then(at) {
            let height = stamps.height_of(stamp, u as f32, profile);
            hits.push((stamp, u as f32, v as f32, edge, height));
        }
    }
    let sum = hits.iter().map(|hit| hit.4).sum();
    // The last of equal stamps is on top.
    let Some((stamp, u, v, edge, height)) =
        hits.into_iter()
            .max_by(|a, b| match stamps.options.overlap {
                StampOverlap::Highest | StampOverlap::Add => a.4.total_cmp(&b.4),
                StampOverlap::Order => a.0.order.total_cmp(&b.0.order),
                StampOverlap::Rows => b.0.center[1].floor().total_cmp(&a.0.center[1].floor()),
            })
    else {
        return 0.0;
    };
    match value {
        StampValue::Height if stamps.options.overlap == StampOverlap::Add => sum,
        StampValue::Height => height,
        StampValue::Mask => 1.0,
        StampValue::Random => stamp.randoms[0],
        StampValue::Random2 => stamp.randoms[1],
        StampValue::Random3 => stamp.randoms[2],
        StampValue::U => 0.5 + 0.5 * u,
        StampValue::V => 0.5 + 0.5 * v,
        StampValue::EdgeDistance => edge,
        StampValue::Angle => stamp.angle,
    }
}

fn bits(values: &[f32]) -> Vec<u32> {
    values.iter().map(|value| value.to_bits()).collect()
}

#[test]
fn values_equal_those_of_all_stamps_of_the_tile_and_its_copies() {
    // The position and the size of a pixel are powers of two, so that the oracle does not round.
    let window = Window::new([-0.5, -0.25], [4.0, 4.0], [32, 32]).unwrap();
    let positions: Vec<_> = (0..32 * 32)
        .map(|pixel| window.position(pixel % 32, pixel / 32))
        .collect();
    for stamps in examples() {
        let all = all_stamps(&stamps);
        for &value in StampValue::ALL {
            let expected: Vec<_> = positions
                .iter()
                .map(|&position| oracle(&stamps, &all, value, position))
                .collect();
            assert!(expected.iter().any(|&value| value > 0.0), "{stamps:?}");
            let field = stamps.field(value);
            let raster = field.to_raster(&window).unwrap();
            assert_eq!(bits(raster.pixels()), bits(&expected), "{value} {stamps:?}");
            let mut values = vec![0.0; positions.len()];
            field.values(&positions, &mut values).unwrap();
            assert_eq!(bits(&values), bits(&expected), "{value} {stamps:?}");
            for (&position, &expected) in positions.iter().zip(&expected).step_by(7) {
                assert_eq!(
                    field.value(position).to_bits(),
                    expected.to_bits(),
                    "{value} {stamps:?}"
                );
            }
        }
    }
}

#[test]
fn windows_are_crops_and_equal_single_positions() {
    for stamps in examples() {
        let field = stamps.field(StampValue::Height);
        // A pixel larger than a cell, one as in a bake, and one that mirrors the plane
        for extent in [[70.0, 90.0], [3.3, 2.9], [-0.7, 1.9]] {
            let window = Window::new([-1.3, 1e6 + 0.2], extent, [70, 90]).unwrap();
            let whole = field.to_raster(&window).unwrap();
            let part = field
                .to_raster(&window.crop([13, 21], [31, 66]).unwrap())
                .unwrap();
            let crop = whole.crop([13, 21], [31, 66]).unwrap();
            assert_eq!(bits(part.pixels()), bits(crop.pixels()), "{stamps:?}");
            for (column, row) in [(0, 0), (69, 89), (33, 40), (5, 71)] {
                let value = field.value(window.position(column, row));
                let pixel = whole.row(row)[column as usize];
                assert_eq!(value.to_bits(), pixel.to_bits(), "{stamps:?}");
            }
        }
    }
}

#[test]
fn periods_are_exact() {
    for stamps in examples() {
        for value in [StampValue::Height, StampValue::Random, StampValue::U] {
            let field = stamps.field(value);
            assert_eq!(field.period(), [Some(4.0); 2]);
            let window = |x, y| Window::new([x, y], [4.0, 4.0], [32, 32]).unwrap();
            let render = |x, y| -> Raster<f32> { field.to_raster(&window(x, y)).unwrap() };
            let expected = render(0.0, 0.0);
            for (x, y) in [(4.0, 0.0), (0.0, 4.0), (-4.0, 8.0), (4e6, -4e9)] {
                assert_eq!(
                    bits(render(x, y).pixels()),
                    bits(expected.pixels()),
                    "{stamps:?}"
                );
            }
        }
    }
}

#[test]
fn a_regular_lattice_has_known_heights() {
    let options = StampOptions {
        jitter: 0.0,
        size: [0.5; 2],
        rotation: [0.0; 2],
        ..StampOptions::default()
    };
    let stamps = stamps(options);
    let height = stamps.field(StampValue::Height);
    // A half ball with a radius of a quarter of a cell
    assert_eq!(height.sample([3.5, -2.5]), 1.0);
    assert_eq!(height.sample([3.625, -2.5]), 0.75_f32.sqrt());
    assert_eq!(height.sample([3.76, -2.5]), 0.0);
    let [u, v] = [StampValue::U, StampValue::V].map(|value| stamps.field(value));
    assert_eq!(
        [u.sample([0.625, 0.375]), v.sample([0.625, 0.375])],
        [0.75, 0.25]
    );
    // A quarter turn leads from x to y.
    let turned = self::stamps(StampOptions {
        rotation: [90.0; 2],
        ..options
    });
    let [u, v] = [StampValue::U, StampValue::V].map(|value| turned.field(value));
    assert_eq!(
        [u.sample([0.625, 0.375]), v.sample([0.625, 0.375])],
        [0.25, 0.25]
    );
    let angle = turned.field(StampValue::Angle);
    assert_eq!(angle.sample([0.5, 0.5]), 0.25);
    // Rows are shifted by half a cell.
    let shifted = self::stamps(StampOptions {
        row_offset: 0.5,
        ..options
    });
    let height = shifted.field(StampValue::Height);
    assert_eq!(
        [height.sample([0.5, 0.5]), height.sample([1.0, 1.5])],
        [1.0; 2]
    );
    assert_eq!(height.sample([0.5, 1.5]), 0.0);
}

#[test]
fn the_overlap_decides_which_stamp_is_on_top() {
    // Disks of two cells cover their neighbors.
    let options = StampOptions {
        shape: StampShape::Disk,
        jitter: 0.0,
        size: [2.0; 2],
        height: [0.1, 1.0],
        ..tile()
    };
    let stamps = stamps(options);
    let at = [1.5, 1.0];
    let read = |overlap: StampOverlap, value: StampValue| {
        let stamps = self::stamps(StampOptions { overlap, ..options });
        stamps.field(value).sample(at)
    };
    let upper = stamps.field(StampValue::Height);
    let all = all_stamps(&stamps);
    let covering: Vec<_> = all
        .iter()
        .filter(|stamp| {
            let [u, v] = stamp.local(at).map(|local| local as f32);
            stamps.options.shape.at(&stamp.outline, u, v).is_some()
        })
        .collect();
    assert_eq!(covering.len(), 2, "one above, one below");
    let height = |index: usize| {
        let stamp = covering[index];
        let [u, v] = stamp.local(at).map(|local| local as f32);
        let (_, profile) = stamps.options.shape.at(&stamp.outline, u, v).unwrap();
        stamp.height * profile
    };
    let [above, below] = [height(0), height(1)];
    assert_eq!(upper.sample(at), above.max(below));
    assert_eq!(read(StampOverlap::Rows, StampValue::Height), above);
    assert_eq!(read(StampOverlap::Add, StampValue::Height), above + below);
    let last = usize::from(covering[1].order >= covering[0].order);
    assert_eq!(read(StampOverlap::Order, StampValue::Height), height(last));
    let random = read(StampOverlap::Order, StampValue::Random);
    assert_eq!(random, covering[last].randoms[0]);
}

#[test]
fn the_density_is_the_mean_number_of_stamps() {
    for density in [0.25, 1.0, 2.5] {
        let options = StampOptions {
            density,
            ..StampOptions::default()
        };
        let stamps = Stamps::new(Seed(3), options).unwrap();
        let side = 64;
        let cells = (0..side * side).map(|cell| [cell % side, cell / side]);
        let count: usize = cells.map(|cell| stamps.points(cell).count()).sum();
        // The standard deviation of the mean of 4096 coins is at most 0.008.
        let mean = count as f64 / f64::from(4096);
        assert!((mean - density).abs() < 0.03, "{density}: {mean}");
    }
}

#[test]
fn the_spacing_leaves_out_close_points() {
    let options = StampOptions {
        density: 3.0,
        spacing: 0.75,
        ..tile()
    };
    let spaced = stamps(options);
    let kept = kept_points(&spaced).len();
    // A saturated set has 0.70 points per squared distance, 20 in the tile; there are 48 candidates.
    assert!((12..=20).contains(&kept), "{kept}");
    // The stamps are as small as points.
    let dots = stamps(StampOptions {
        size: [0.001; 2],
        ..options
    });
    let field = dots.field(StampValue::Mask);
    let mut near = Vec::new();
    field.near([0, 0], [2.0; 2], [2.0; 2], &mut near);
    assert_eq!(near.len(), kept);
}

#[test]
fn shapes_are_inside_of_their_box_and_their_profile_is_a_height() {
    let steps = 200;
    for &shape in StampShape::ALL {
        for seed in 0..20_u8 {
            let random = [3, 5, 7, 11].map(|prime| f32::from(seed * prime % 20) / 20.0);
            let outline = Outline {
                aspect: 0.4,
                bevel: 0.3,
                random,
            };
            let mut covered = 0;
            for step in 0..(steps + 1) * (steps + 1) {
                let [u, v] = [step % (steps + 1), step / (steps + 1)]
                    .map(|at| (2 * at - steps) as f32 / steps as f32);
                let Some((edge, height)) = shape.at(&outline, u, v) else {
                    continue;
                };
                covered += 1;
                assert!((0.0..=1.0).contains(&height), "{shape}: {height}");
                assert!((0.0..=2.5).contains(&edge), "{shape}: {edge}");
                // The sides of the box do not cut the shape, except the root of a blade.
                let is_root = shape == StampShape::Blade && u == -1.0;
                let is_side = !is_root && (u.abs() == 1.0 || v.abs() == 1.0);
                assert!(!is_side || edge <= 0.03, "{shape} at {u}, {v}: {edge}");
            }
            let part = f64::from(covered) / f64::from((steps + 1) * (steps + 1));
            assert!((0.1..=1.0).contains(&part), "{shape} covers {part}");
        }
    }
}

/// Checks that changed options give the error for a number out of its range. `expected` is the name of the number.
fn assert_refused(change: impl Fn(&mut StampOptions), expected: &str) {
    let mut options = tile();
    change(&mut options);
    let error = Stamps::new(Seed(7), options).expect_err(expected);
    match error.kind() {
        PatternErrorKind::Range { what, .. } => assert_eq!(*what, expected, "{error}"),
        kind => panic!("{expected}: {kind:?}"),
    }
}

#[test]
fn options_out_of_range_are_refused_with_the_limit() {
    assert_refused(|of| of.size = [0.0, 1.0], "size of a stamp");
    assert_refused(|of| of.size = [1.0, 9.0], "size of a stamp");
    assert_refused(|of| of.size = [1.0, 0.5], "upper end of a range");
    assert_refused(|of| of.aspect = [0.0, 1.0], "aspect of a stamp");
    assert_refused(|of| of.jitter = 1.5, "jitter");
    assert_refused(|of| of.density = 0.0, "number of stamps per cell");
    assert_refused(|of| of.rotation = [0.0, f64::NAN], "rotation of a stamp");
    assert_refused(|of| of.height = [-0.1, 1.0], "height of a stamp");
    assert_refused(|of| of.spacing = 5.0, "spacing");
    assert_refused(|of| of.bevel = -0.1, "bevel");
    assert_refused(|of| of.lift = 2.0, "lift");
    assert_refused(|of| of.tilt = -2.0, "tilt");
    assert_refused(|of| of.row_offset = 2.0, "offset of a row");
    assert_refused(|of| of.cell_height = 0.0, "height of a cell");
    assert_refused(|of| of.period = [Some(0), None], "period");
}

#[test]
fn stamps_that_reach_too_far_or_break_the_period_are_refused() {
    let flat = |of: &mut StampOptions| (of.size, of.cell_height) = ([1.0, 2.0], 0.1);
    assert_refused(flat, "reach of a stamp in cells");
    let many = |of: &mut StampOptions| (of.size, of.density) = ([1.0, 8.0], 16.0);
    assert_refused(many, "number of stamps within reach of a position");
    let spaced = |of: &mut StampOptions| (of.period, of.spacing) = ([Some(1), None], 1.5);
    assert_refused(spaced, "spacing");
    let spaced = |of: &mut StampOptions| (of.density, of.spacing) = (16.0, 2.0);
    assert_refused(spaced, "number of points within the spacing");
    let shifted = |of: &mut StampOptions| of.row_offset = 0.3;
    assert_refused(shifted, "total offset of the rows of a period");
    stamps(StampOptions {
        row_offset: 0.25,
        ..tile()
    });
}

#[test]
fn positions_that_are_not_finite_have_no_value() {
    let field = stamps(tile()).field(StampValue::Mask);
    for position in [
        [f64::NAN, 0.0],
        [0.0, f64::INFINITY],
        [f64::NEG_INFINITY, 1.0],
    ] {
        let mut values = [0.0];
        field.values(&[position], &mut values).unwrap();
        assert!(values[0].is_nan() && field.value(position).is_nan());
    }
    // The farthest positions have one.
    assert!(field.value([1e300, -1e300]).is_finite());
}

#[test]
fn value_stability_stamps() {
    let stamps = stamps(StampOptions {
        shape: StampShape::Pebble,
        ..tile()
    });
    let height = stamps.field(StampValue::Height);
    let random = stamps.field(StampValue::Random);
    let at = [[0.5, 0.5], [1.25, 2.75], [3.5, 1.5]];
    let found = at.map(|at| [height.sample(at).to_bits(), random.sample(at).to_bits()]);
    let expected = [
        [0, 0],
        [1_056_927_906, 1_060_541_530],
        [1_063_532_844, 1_043_514_312],
    ];
    assert_eq!(found, expected);
}
