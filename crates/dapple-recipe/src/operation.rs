//! Operations on the values at a single position.

use crate::plan::{Layers, Values, blend_values};
use crate::{Levels, LevelsCurve, Power, RecipeError, Wave, Waveform};
use dapple_color::{ColorRamp, LinearRgb};
use dapple_worley::Profile;
use glam::DVec2;

/// What a step does with the values of its inputs at a position.
#[derive(Clone, Debug)]
pub(crate) enum Operation {
    Add,
    Subtract,
    Multiply,
    Divide,
    Minimum,
    Maximum,
    Absolute,
    Power(f32),
    Wave {
        frequency: f64,
        phase: f64,
        form: Waveform,
    },
    Levels {
        from: [f32; 2],
        to: [f32; 2],
        curve: LevelsCurve,
    },
    Profile(Profile),
    Mix,
    Ramp(ColorRamp),
    Blend(Layers),
}

/// A range stretched to another: `from[0]` becomes `to[0]`, `from[1]` becomes `to[1]`.
pub(crate) fn levels(value: f32, from: [f32; 2], to: [f32; 2], curve: LevelsCurve) -> f32 {
    let t = (value - from[0]) / (from[1] - from[0]);
    let t = match curve {
        LevelsCurve::Unclamped => t,
        LevelsCurve::Linear => t.clamp(0.0, 1.0),
        LevelsCurve::Smooth => {
            let t = t.clamp(0.0, 1.0);
            t * t * (3.0 - 2.0 * t)
        }
    };
    to[0] + (to[1] - to[0]) * t
}

/// How far along a direction a position is: `(position − center) · along`.
pub(crate) fn coordinate(position: DVec2, center: DVec2, along: DVec2) -> f32 {
    let offset = position - center;
    (offset.x * along.x + offset.y * along.y) as f32
}

/// How far from a center, or from the nearest of its repeats along the axes that wrap, a position is.
pub(crate) fn distance(position: DVec2, center: DVec2, extent: DVec2, wrap: [bool; 2]) -> f32 {
    let mut offset = position - center;
    for axis in 0..2 {
        if wrap[axis] {
            offset[axis] -= (offset[axis] / extent[axis] + 0.5).floor() * extent[axis];
        }
    }
    (offset.x * offset.x + offset.y * offset.y).sqrt() as f32
}

/// The smaller of two numbers; the first, where one is not a number.
pub(crate) fn minimum(a: f32, b: f32) -> f32 {
    if b < a { b } else { a }
}

/// The larger of two numbers; the first, where one is not a number.
pub(crate) fn maximum(a: f32, b: f32) -> f32 {
    if b > a { b } else { a }
}

/// The product of two colors, part by part.
pub(crate) fn multiply_colors(a: LinearRgb, b: LinearRgb) -> LinearRgb {
    LinearRgb::new(a.r * b.r, a.g * b.g, a.b * b.b)
}

/// A wave of a number, from 0 to 1: see [`Wave`].
pub(crate) fn wave(value: f32, frequency: f64, phase: f64, form: Waveform) -> f32 {
    let t = f64::from(value) * frequency + phase;
    let t = t - t.floor();
    let wave = match form {
        Waveform::Sine => 0.5 + 0.5 * libm::sin(core::f64::consts::TAU * t),
        Waveform::Triangle => 1.0 - (2.0 * t - 1.0).abs(),
        Waveform::Sawtooth => t,
        Waveform::Square if t < 0.5 => 0.0,
        Waveform::Square if t.is_nan() => t,
        Waveform::Square => 1.0,
    };
    wave as f32
}

/// A number to a power; below 0 it counts as 0.
pub(crate) fn power(value: f32, exponent: f32) -> f32 {
    let positive = if value < 0.0 { 0.0 } else { value };
    libm::powf(positive, exponent)
}

/// A part of the way from one number to another, cut off at both.
pub(crate) fn mix(from: f32, to: f32, by: f32) -> f32 {
    from + (to - from) * by.clamp(0.0, 1.0)
}

/// A part of the way from one color to another, cut off at both.
pub(crate) fn mix_colors(from: LinearRgb, to: LinearRgb, by: f32) -> LinearRgb {
    from.lerp(to, by.clamp(0.0, 1.0))
}

/// The quotient of two numbers; 0 where the second is 0.
pub(crate) fn quotient(dividend: f32, divisor: f32) -> f32 {
    if divisor == 0.0 {
        0.0
    } else {
        dividend / divisor
    }
}

impl Operation {
    pub(crate) fn power(node: &Power) -> Result<Self, RecipeError> {
        let exponent = node.exponent;
        let holds = exponent > 0.0 && exponent.is_finite();
        RecipeError::check(holds, "exponent", exponent.into(), "above 0 and finite")?;
        Ok(Self::Power(exponent))
    }

    pub(crate) fn wave(node: &Wave) -> Result<Self, RecipeError> {
        RecipeError::check(
            node.frequency.is_finite(),
            "frequency of the wave",
            node.frequency,
            "finite",
        )?;
        RecipeError::check(node.phase.is_finite(), "phase", node.phase, "finite")?;
        Ok(Self::Wave {
            frequency: node.frequency,
            phase: node.phase,
            form: node.form,
        })
    }

    pub(crate) fn levels(node: &Levels) -> Result<Self, RecipeError> {
        for end in node.from.into_iter().chain(node.to) {
            RecipeError::check(end.is_finite(), "end of a range", end.into(), "finite")?;
        }
        let length = node.from[1] - node.from[0];
        let holds = length != 0.0 && length.is_finite();
        RecipeError::check(
            holds,
            "length of the range `from`",
            length.into(),
            "finite and not 0",
        )?;
        Ok(Self::Levels {
            from: node.from,
            to: node.to,
            curve: node.curve,
        })
    }

    /// The profile, checked as its constructors do.
    pub(crate) fn profile(shape: Profile) -> Result<Self, RecipeError> {
        shape.check()?;
        Ok(Self::Profile(shape))
    }

    /// Whether an input may be a color.
    pub(crate) fn takes_color(&self, input: usize) -> bool {
        match self {
            Self::Add | Self::Multiply => true,
            Self::Mix => input < 2,
            _ => false,
        }
    }

    /// Whether the result is a color, whatever the inputs are.
    pub(crate) fn makes_color(&self) -> bool {
        matches!(self, Self::Ramp(_))
    }

    /// The values at all positions, of which there are `count`.
    pub(crate) fn apply(&self, inputs: &[&Values], count: usize) -> Result<Values, RecipeError> {
        Ok(match self {
            Self::Add => fold(inputs, |a, b| a + b, |a, b| a + b),
            Self::Multiply => fold(inputs, |a, b| a * b, multiply_colors),
            Self::Subtract => pairs(inputs, |a, b| a - b),
            Self::Divide => pairs(inputs, quotient),
            Self::Minimum => fold(inputs, minimum, |a, _| a),
            Self::Maximum => fold(inputs, maximum, |a, _| a),
            Self::Absolute => each(inputs, f32::abs),
            &Self::Power(exponent) => each(inputs, |value| power(value, exponent)),
            &Self::Wave {
                frequency,
                phase,
                form,
            } => each(inputs, |value| wave(value, frequency, phase, form)),
            &Self::Levels { from, to, curve } => {
                each(inputs, |value| levels(value, from, to, curve))
            }
            &Self::Profile(shape) => each(inputs, |value| shape.height(value)),
            Self::Mix => mix_values(inputs),
            Self::Ramp(ramp) => Values::Colors(
                numbers(inputs[0])
                    .iter()
                    .map(|&value| ramp.at(value))
                    .collect(),
            ),
            Self::Blend(layers) => blend_values(layers, inputs, [count as u32, 1])?,
        })
    }
}

/// The numbers of an input that the plan has made sure to be one.
fn numbers(values: &Values) -> &[f32] {
    match values {
        Values::Numbers(numbers) => numbers,
        Values::Colors(_) => &[],
    }
}

fn each(inputs: &[&Values], change: impl Fn(f32) -> f32) -> Values {
    Values::Numbers(
        numbers(inputs[0])
            .iter()
            .map(|&value| change(value))
            .collect(),
    )
}

fn pairs(inputs: &[&Values], combine: impl Fn(f32, f32) -> f32) -> Values {
    let pairs = numbers(inputs[0]).iter().zip(numbers(inputs[1]));
    Values::Numbers(pairs.map(|(&a, &b)| combine(a, b)).collect())
}

/// Combines all inputs from the first to the last; as colors if one of them is.
fn fold(
    inputs: &[&Values],
    combine: impl Fn(f32, f32) -> f32,
    combine_colors: impl Fn(LinearRgb, LinearRgb) -> LinearRgb,
) -> Values {
    let is_color = inputs
        .iter()
        .any(|values| matches!(values, Values::Colors(_)));
    if is_color {
        let mut result = colors(inputs[0]);
        for &input in &inputs[1..] {
            result
                .iter_mut()
                .zip(colors(input))
                .for_each(|(a, b)| *a = combine_colors(*a, b));
        }
        return Values::Colors(result);
    }
    let mut result = numbers(inputs[0]).to_vec();
    for &input in &inputs[1..] {
        result
            .iter_mut()
            .zip(numbers(input))
            .for_each(|(a, &b)| *a = combine(*a, b));
    }
    Values::Numbers(result)
}

fn mix_values(inputs: &[&Values]) -> Values {
    let by = numbers(inputs[2]);
    if let [Values::Numbers(from), Values::Numbers(to), _] = inputs {
        let ends = from.iter().zip(to).zip(by);
        return Values::Numbers(ends.map(|((&from, &to), &by)| mix(from, to, by)).collect());
    }
    let ends = colors(inputs[0]).into_iter().zip(colors(inputs[1])).zip(by);
    Values::Colors(
        ends.map(|((from, to), &by)| mix_colors(from, to, by))
            .collect(),
    )
}

/// The values as colors; numbers are grays.
pub(crate) fn colors(values: &Values) -> Vec<LinearRgb> {
    values.clone().into_colors()
}
