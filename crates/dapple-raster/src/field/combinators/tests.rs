//! Tests of every combinator against its formula, through all sampling methods, and of its errors.

use super::FieldExt;
use crate::{Constant, Field, Fractal, FractalShape, RasterErrorKind, Window, field_fn};
use core::f64::consts::{FRAC_PI_2, TAU};
use glam::DVec2;

/// A field with a period of 2 along x and 3 along y, and values from -1 to 1.
#[derive(Clone, Copy, Debug)]
struct Waves;

impl Field for Waves {
    fn value(&self, [x, y]: [f64; 2]) -> f32 {
        (libm::sin(x * TAU / 2.0) * libm::cos(y * TAU / 3.0)) as f32
    }

    fn period(&self) -> [Option<f64>; 2] {
        [Some(2.0), Some(3.0)]
    }
}

/// Returns a fractal sum whose octaves are copies of one field.
fn octaves<F: Clone>(
    field: F,
    count: usize,
    gain: f64,
    lacunarity: f64,
    shape: FractalShape,
) -> Result<Fractal<F>, crate::RasterError> {
    let fields = core::iter::repeat_n(field, count);
    Fractal::new(fields, gain, lacunarity, shape)
}

fn slope(position: DVec2) -> f32 {
    (0.5 * position.x - 0.25 * position.y) as f32
}

/// Checks that all sampling methods give the values of a formula, on a window larger than a band and at irregular
/// positions.
fn check(name: &str, field: &dyn Field, formula: impl Fn(DVec2) -> f32) {
    let origin = DVec2::new(-1.3, 0.7);
    let whole = Window::new(origin, DVec2::new(5.1, 3.3), [420, 340]).unwrap();
    let window = whole.scaled(DVec2::new(0.9, 1.1)).unwrap();
    let window = window.crop([7, -3], [410, 330]).unwrap();
    let raster = field.to_raster(&window).unwrap();
    let positions: Vec<[f64; 2]> = (0..330)
        .flat_map(|row| (0..410).map(move |column| window.position(column, row)))
        .collect();
    let mut many = vec![0.0; positions.len()];
    field.values(&positions, &mut many).unwrap();
    for ((&position, &rendered), &many) in positions.iter().zip(raster.pixels()).zip(&many) {
        let expected = formula(position.into()).to_bits();
        let sampled = field.sample(DVec2::from(position));
        assert_eq!(sampled.to_bits(), expected, "{name} sampled");
        assert_eq!(rendered.to_bits(), expected, "{name} rendered");
        assert_eq!(many.to_bits(), expected, "{name}, many samples");
    }
}

#[test]
fn combinators_are_their_formulas_bit_for_bit() {
    let (waves, slopes) = (|p: DVec2| Waves.sample(p), field_fn(|p| slope(p.into())));
    check("frequency", &Waves.frequency(1.7), |p| waves(p * 1.7));
    let uneven = DVec2::new(2.0, -0.3);
    check("frequencies", &Waves.frequency_per_axis(uneven), |p| {
        waves(p * uneven)
    });
    check("offset", &Waves.offset(uneven), |p| waves(p + uneven));
    check("warp", &Waves.warp((slopes, Waves), 0.2), |p| {
        waves(p + 0.2 * DVec2::new(slope(p).into(), waves(p).into()))
    });
    check("map", &Waves.map(|v| v * v), |p| waves(p) * waves(p));
    check("add", &Waves.add(slopes), |p| waves(p) + slope(p));
    check("sub", &Waves.sub(slopes), |p| waves(p) - slope(p));
    check("mul", &Waves.mul(slopes), |p| waves(p) * slope(p));
    check("min", &Waves.min(slopes), |p| {
        if slope(p) < waves(p) {
            slope(p)
        } else {
            waves(p)
        }
    });
    check("max", &Waves.max(slopes), |p| {
        if slope(p) > waves(p) {
            slope(p)
        } else {
            waves(p)
        }
    });
    check("mix", &Waves.mix(0.25_f32, slopes), |p| {
        waves(p) + (0.25 - waves(p)) * slope(p).clamp(0.0, 1.0)
    });
    let remapped = Waves.remap([-1.0, 1.0], [3.0, 4.0]).unwrap();
    check("remap", &remapped, |p| {
        3.0 + (4.0 - 3.0) * ((waves(p) - -1.0) / 2.0)
    });
}

#[test]
fn fractals_are_their_sums_bit_for_bit() {
    let sum = |shape: fn(f32) -> f32| {
        move |p: DVec2| {
            let octave = |frequency: f64| shape(Waves.sample(p * frequency));
            0.0 + octave(1.0) + 0.5 * octave(3.0) + 0.25 * octave(9.0)
        }
    };
    check(
        "fbm",
        &octaves(Waves, 3, 0.5, 3.0, FractalShape::Sum).unwrap(),
        sum(|value| value),
    );
    check(
        "ridged",
        &octaves(Waves, 3, 0.5, 3.0, FractalShape::Ridged).unwrap(),
        sum(|value| 1.0 - value.abs()),
    );
    check(
        "billow",
        &octaves(Waves, 3, 0.5, 3.0, FractalShape::Billow).unwrap(),
        sum(f32::abs),
    );
    assert_eq!(
        octaves(Waves, 3, -0.5, 3.0, FractalShape::Sum)
            .unwrap()
            .weight(),
        1.75
    );
}

#[test]
fn a_turn_moves_features_clockwise() {
    let right = field_fn(|[x, _y]| x as f32).rotate(FRAC_PI_2);
    assert!(
        (right.sample(DVec2::Y) - 1.0).abs() < 1e-7,
        "x points down now; sincos is rounded"
    );
    let odd = Waves.rotate(0.3);
    let (sin, cos) = libm::sincos(0.3);
    check("rotate", &odd, |DVec2 { x, y }| {
        Waves.sample(DVec2::new(x * cos + y * sin, y * cos - x * sin))
    });
}

#[test]
fn periods_follow_from_those_of_the_parts() {
    let period = |field: &dyn Field| field.period();
    assert_eq!(period(&Waves.frequency(4.0)), [Some(0.5), Some(0.75)]);
    assert_eq!(
        period(&Waves.frequency_per_axis(DVec2::new(0.0, -2.0))),
        [Some(0.0), Some(1.5)]
    );
    assert_eq!(
        period(&Waves.offset(DVec2::X).map(f32::abs)),
        [Some(2.0), Some(3.0)]
    );
    assert_eq!(period(&Waves.add(1.0_f32)), [Some(2.0), Some(3.0)]);
    assert_eq!(
        period(&Waves.add(Waves.frequency(0.75))),
        [Some(8.0), Some(12.0)]
    );
    assert_eq!(
        period(&octaves(Waves, 4, 0.5, 2.0, FractalShape::Sum).unwrap()),
        [Some(2.0), Some(3.0)]
    );
    assert_eq!(
        period(&Waves.warp((Waves, Constant(0.0)), 0.1)),
        [Some(2.0), Some(3.0)]
    );
    assert_eq!(
        period(&Waves.mix(Waves, field_fn(|p| slope(p.into())))),
        [None; 2]
    );
    assert_eq!(period(&Waves.rotate(1.0)), [None; 2]);
}

#[test]
fn a_tile_repeats_to_the_last_bit() {
    let field = Waves.frequency(0.5).warp([Constant(0.0); 2], 1.0);
    let tile = field.tile_raster([16, 24]).unwrap();
    let twice = Window::new(DVec2::ZERO, DVec2::new(8.0, 12.0), [32, 48]).unwrap();
    let twice = field.to_raster(&twice).unwrap();
    // The sine of the test field is not exactly periodic.
    for row in 0..48 {
        for column in 0..32 {
            let [one, other] = [tile.row(row % 24), twice.row(row)];
            let difference = one[column % 16] - other[column];
            assert!(difference.abs() < 1e-6, "at {column}, {row}");
        }
    }
}

#[test]
fn numbers_out_of_range_are_refused() {
    let refused = |result: Result<Fractal<Waves>, crate::RasterError>| {
        let error = result.unwrap_err();
        assert!(
            matches!(error.kind(), RasterErrorKind::Range { .. }),
            "{error}"
        );
        error.to_string()
    };
    assert!(refused(octaves(Waves, 0, 0.5, 2.0, FractalShape::Sum)).contains("number of octaves"));
    assert!(
        refused(octaves(Waves, usize::MAX, 0.5, 2.0, FractalShape::Sum)).contains("33"),
        "all are not made first"
    );
    assert!(refused(octaves(Waves, 3, 1.5, 2.0, FractalShape::Ridged)).contains("gain is 1.5"));
    assert!(refused(octaves(Waves, 3, f64::NAN, 2.0, FractalShape::Billow)).contains("gain"));
    assert!(refused(octaves(Waves, 3, 0.5, 0.5, FractalShape::Sum)).contains("lacunarity is 0.5"));
    assert!(refused(Fractal::new([], 0.5, 2.0, FractalShape::Sum)).contains("octaves"));
    for ends in [[1.0, 1.0], [0.0, f32::INFINITY], [f32::NAN, 0.0]] {
        assert!(Waves.remap(ends, [0.0, 1.0]).is_err(), "from {ends:?}");
    }
    assert!(Waves.remap([0.0, 1.0], [0.0, f32::NAN]).is_err(), "to NaN");
}

#[test]
fn numbers_keep_their_own_methods_beside_the_trait() {
    use crate::prelude::*;
    use core::ops::{Add as _, Mul as _, Sub as _};

    // All of these names are also methods of `FieldExt`.
    let values = [-1.0_f32, 0.5, 3.0];
    let clipped: Vec<f32> = values.iter().map(|value| value.max(0.0)).collect();
    assert_eq!(clipped, [0.0, 0.5, 3.0]);
    let halved: Vec<f32> = values.iter().map(|value| value.mul(0.5).min(1.0)).collect();
    assert_eq!(halved, [-0.5, 0.25, 1.0]);
    let sum: f32 = (&values[1]).add(&values[2]);
    assert_eq!(sum, 3.5);
    assert_eq!(values[2].clamp(0.0, 1.0), 1.0);
    let lengths = [3_usize, 4].map(|length| length.max(values.len() + 1));
    assert_eq!(lengths, [4, 4]);
    assert_eq!(1.0_f32.sub(0.25), 0.75);
    // Numbers are accepted in place of fields.
    let field = Waves
        .mix(1.0, 0.25)
        .add(2.0)
        .max(0.5)
        .warp((Constant(0.0), Waves), 0.1);
    assert_eq!(field.period(), [Some(2.0), Some(3.0)]);
}

/// A 3-D field with the periods 1, 2 and 3.
#[derive(Clone, Copy, Debug)]
struct Solid;

impl Field<3> for Solid {
    fn value(&self, [x, y, z]: [f64; 3]) -> f32 {
        let [x, y, z] = [x, y / 2.0, z / 3.0].map(|at| at - at.floor());
        (x * y - z) as f32
    }

    fn period(&self) -> [Option<f64>; 3] {
        [Some(1.0), Some(2.0), Some(3.0)]
    }
}

#[test]
fn fields_of_space_have_the_same_combinators_bit_for_bit() {
    let field = octaves(Solid, 3, 0.5, 2.0, FractalShape::Ridged)
        .unwrap()
        .warp((Solid, Constant(0.25), Solid.frequency(2.0)), 0.3)
        .rotate(0.4)
        .offset([0.5, -0.25, 8.0])
        .frequency_per_axis([0.3, 1.7, 2.0])
        .add(Solid.mul(Waves.extrude()))
        .mix(1.0, 0.25)
        .map(|value| value * value);
    let formula = |[x, y, z]: [f64; 3]| {
        let [u, v, w] = [x * 0.3 + 0.5, y * 1.7 + -0.25, z * 2.0 + 8.0];
        let (sin, cos) = libm::sincos(0.4);
        let turned = [u * cos + v * sin, v * cos - u * sin, w];
        let by = [
            Solid.value(turned),
            0.25,
            Solid.value(turned.map(|at| at * 2.0)),
        ];
        let mut moved = turned;
        for axis in 0..3 {
            moved[axis] += 0.3 * f64::from(by[axis]);
        }
        let mut sum = 0.0;
        for (frequency, weight) in [(1.0, 1.0), (2.0, 0.5), (4.0, 0.25)] {
            let value = Solid.value(moved.map(|at| at * frequency));
            sum += weight * (1.0 - value.abs());
        }
        let value = sum + Solid.value([x, y, z]) * Waves.sample([x, y]);
        let mixed = value + (1.0 - value) * 0.25;
        mixed * mixed
    };
    let window = Window::new([-1.3, 0.7], [5.1, 3.3], [420, 340]).unwrap();
    let window = window.in_space([0.0, 0.0, 0.7]);
    let raster = field.to_raster(&window).unwrap();
    let slice = (&field).slice([0.7]);
    assert_eq!(slice.to_raster(&window.in_plane()).unwrap(), raster);
    let positions: Vec<_> = (0..340)
        .flat_map(|row| (0..420).map(move |column| window.position(column, row)))
        .collect();
    let mut many = vec![0.0; positions.len()];
    field.sample_many(&positions, &mut many).unwrap();
    assert_eq!(raster.pixels(), many);
    for (&position, &rendered) in positions.iter().zip(raster.pixels()) {
        let expected = formula(position).to_bits();
        assert_eq!(rendered.to_bits(), expected, "rendered at {position:?}");
        assert_eq!(
            field.sample(glam::DVec3::from(position)).to_bits(),
            expected
        );
        let [x, y, _] = position;
        assert_eq!(slice.sample([x, y]).to_bits(), expected, "sliced");
    }
    let period = field.period();
    assert_eq!(
        period,
        [None, None, Some(3.0)],
        "turned about the third axis"
    );
    assert_eq!(Solid.slice([0.5]).period(), [Some(1.0), Some(2.0)]);
}

#[test]
fn a_tile_of_space_lies_where_further_coordinates_are_0() {
    let tile = Solid.tile_raster([4, 2]).unwrap();
    let window = Window::new([0.0; 2], [1.0, 2.0], [4, 2]).unwrap();
    assert_eq!(tile, Solid.slice([0.0]).to_raster(&window).unwrap());
}
