//! Exact gradients of fields, computed by the chain rule.

use super::values::unit;
use super::{
    Extruded, FractalShape, Linear, Mapped, Mixed, Pair, PairOperation, Rotated, Scaled, Slice,
    Translated, Warped,
};
use crate::{Change as _, Constant, Displacement, Field, Fractal};
use std::sync::Arc;

/// A field with an analytic gradient.
///
/// The gradient is the derivative of the formula, not a finite difference. It has one number per axis, in value per
/// position unit. At a crease, such as a border between cells, it is the limit from one side. Compositions of such
/// fields have gradients too, except [`map`](crate::FieldExt::map) with an arbitrary function.
///
/// # Examples
///
/// ```
/// use dapple_raster::{Field, FieldExt, Gradient};
///
/// struct Bowl;
///
/// impl Field for Bowl {
///     fn value(&self, [x, y]: [f64; 2]) -> f32 {
///         (x * x + y * y) as f32
///     }
/// }
///
/// impl Gradient for Bowl {
///     fn value_and_gradient(&self, [x, y]: [f64; 2]) -> (f32, [f32; 2]) {
///         (self.value([x, y]), [2.0 * x as f32, 2.0 * y as f32])
///     }
/// }
///
/// let (value, gradient) = Bowl.frequency(3.0).sample_with_gradient([0.5, 0.0]);
/// assert_eq!((value, gradient), (2.25, [9.0, 0.0]));
/// ```
pub trait Gradient<const N: usize = 2>: Field<N> {
    /// Returns the value at a position, equal to [`Field::value`] bit for bit, and its derivative along each axis.
    fn value_and_gradient(&self, position: [f64; N]) -> (f32, [f32; N]);
}

macro_rules! forward_gradient {
    ($($holder:ty),*) => {$(
        impl<const N: usize, F: Gradient<N> + ?Sized> Gradient<N> for $holder {
            fn value_and_gradient(&self, position: [f64; N]) -> (f32, [f32; N]) {
                (**self).value_and_gradient(position)
            }
        }
    )*};
}

forward_gradient!(&F, Box<F>, Arc<F>);

impl<const N: usize> Gradient<N> for Constant {
    fn value_and_gradient(&self, _position: [f64; N]) -> (f32, [f32; N]) {
        (self.0, [0.0; N])
    }
}

/// Multiplies a gradient by a scalar.
fn times<const N: usize>(mut gradient: [f32; N], factor: f32) -> [f32; N] {
    for part in &mut gradient {
        *part *= factor;
    }
    gradient
}

/// Adds two gradients.
fn plus<const N: usize>(mut gradient: [f32; N], other: [f32; N]) -> [f32; N] {
    for (part, other) in gradient.iter_mut().zip(other) {
        *part += other;
    }
    gradient
}

impl<F: Gradient<N>, const N: usize> Gradient<N> for Scaled<F, N> {
    fn value_and_gradient(&self, position: [f64; N]) -> (f32, [f32; N]) {
        let (value, mut gradient) = self.field.value_and_gradient(self.moved(position));
        for (part, frequency) in gradient.iter_mut().zip(self.frequency) {
            *part = (f64::from(*part) * frequency) as f32;
        }
        (value, gradient)
    }
}

impl<F: Gradient<N>, const N: usize> Gradient<N> for Translated<F, N> {
    fn value_and_gradient(&self, position: [f64; N]) -> (f32, [f32; N]) {
        self.field.value_and_gradient(self.moved(position))
    }
}

impl<F: Gradient<N>, const N: usize> Gradient<N> for Rotated<F> {
    fn value_and_gradient(&self, position: [f64; N]) -> (f32, [f32; N]) {
        let (value, mut gradient) = self.field.value_and_gradient(self.moved(position));
        // Apply the transpose of the rotation of positions.
        let [cos, sin] = self.direction.map(|part| part as f32);
        let [x, y] = [gradient[0], gradient[1]];
        gradient[0] = x * cos - y * sin;
        gradient[1] = x * sin + y * cos;
        (value, gradient)
    }
}

/// Displacement fields with gradients: an array of fields of one type, or a tuple of different types.
pub trait DisplacementGradient<const N: usize = 2>: Displacement<N> {
    /// Returns the displacement field along `axis`, which must be below `N`.
    fn gradient_along(&self, axis: usize) -> &dyn Gradient<N>;
}

impl<const N: usize, F: Gradient<N>> DisplacementGradient<N> for [F; N] {
    fn gradient_along(&self, axis: usize) -> &dyn Gradient<N> {
        &self[axis]
    }
}

macro_rules! displacement {
    ($n:literal: $($field:ident $index:tt),*) => {
        impl<$($field: Gradient<$n>),*> DisplacementGradient<$n> for ($($field),*) {
            fn gradient_along(&self, axis: usize) -> &dyn Gradient<$n> {
                let along: [&dyn Gradient<$n>; $n] = [$(&self.$index),*];
                along[axis]
            }
        }
    };
}

displacement!(2: X 0, Y 1);
displacement!(3: X 0, Y 1, Z 2);
displacement!(4: X 0, Y 1, Z 2, W 3);

impl<F: Gradient<N>, D: DisplacementGradient<N>, const N: usize> Gradient<N> for Warped<F, D> {
    fn value_and_gradient(&self, position: [f64; N]) -> (f32, [f32; N]) {
        let mut moved = position;
        let mut slopes = [[0.0; N]; N];
        for axis in 0..N {
            let (by, slope) = self.by.gradient_along(axis).value_and_gradient(position);
            moved[axis] += self.amount * f64::from(by);
            slopes[axis] = times(slope, self.amount as f32);
        }
        let (value, outer) = self.field.value_and_gradient(moved);
        // Chain rule: the sampled position depends on the position and on each displacement.
        let gradient = (0..N).fold(outer, |sum, axis| {
            plus(sum, times(slopes[axis], outer[axis]))
        });
        (value, gradient)
    }
}

impl<F: Gradient<N>, const N: usize> Gradient<N> for Mapped<F, Linear> {
    fn value_and_gradient(&self, position: [f64; N]) -> (f32, [f32; N]) {
        let (value, gradient) = self.field.value_and_gradient(position);
        let Linear { length, to, .. } = self.function;
        let slope = (to[1] - to[0]) / length;
        (self.function.change(value), times(gradient, slope))
    }
}

impl<A: Gradient<N>, B: Gradient<N>, const N: usize> Gradient<N> for Pair<A, B> {
    fn value_and_gradient(&self, position: [f64; N]) -> (f32, [f32; N]) {
        let (a, by_a) = self.first.value_and_gradient(position);
        let (b, by_b) = self.second.value_and_gradient(position);
        let gradient = match self.operation {
            PairOperation::Add => plus(by_a, by_b),
            PairOperation::Subtract => plus(by_a, times(by_b, -1.0)),
            PairOperation::Multiply => plus(times(by_a, b), times(by_b, a)),
            PairOperation::Minimum if b < a => by_b,
            PairOperation::Maximum if b > a => by_b,
            PairOperation::Minimum | PairOperation::Maximum => by_a,
        };
        (self.operation.apply(a, b), gradient)
    }
}

impl<A: Gradient<N>, B: Gradient<N>, T: Gradient<N>, const N: usize> Gradient<N>
    for Mixed<A, B, T>
{
    fn value_and_gradient(&self, position: [f64; N]) -> (f32, [f32; N]) {
        let (from, by_from) = self.from.value_and_gradient(position);
        let (to, by_to) = self.to.value_and_gradient(position);
        let (by, by_by) = self.by.value_and_gradient(position);
        let part = unit(by);
        let mut gradient = plus(times(by_from, 1.0 - part), times(by_to, part));
        if part == by {
            gradient = plus(gradient, times(by_by, to - from));
        }
        (from + (to - from) * part, gradient)
    }
}

impl<F: Gradient<N>, const N: usize> Gradient<N> for Fractal<F> {
    fn value_and_gradient(&self, position: [f64; N]) -> (f32, [f32; N]) {
        let (mut sum, mut gradient) = (0.0, [0.0; N]);
        for (octave, weight) in self.scaled() {
            let (value, slope) = octave.value_and_gradient(position);
            let shape = self.shape();
            sum += weight * shape.of(value);
            let sign = if value < 0.0 { -1.0 } else { 1.0 };
            let of_shape = match shape {
                FractalShape::Sum => 1.0,
                FractalShape::Ridged => -sign,
                FractalShape::Billow => sign,
            };
            gradient = plus(gradient, times(slope, weight * of_shape));
        }
        (sum, gradient)
    }
}

impl<F: Gradient<N>, const N: usize> Gradient for Slice<F, N> {
    fn value_and_gradient(&self, position: [f64; 2]) -> (f32, [f32; 2]) {
        let (value, gradient) = self.field.value_and_gradient(self.in_space(position));
        (value, [gradient[0], gradient[1]])
    }
}

impl<F: Gradient, const N: usize> Gradient<N> for Extruded<F> {
    fn value_and_gradient(&self, position: [f64; N]) -> (f32, [f32; N]) {
        if position.iter().any(|part| !part.is_finite()) {
            return (f32::NAN, [f32::NAN; N]);
        }
        let (value, flat) = self.field.value_and_gradient([position[0], position[1]]);
        let mut gradient = [0.0; N];
        gradient[..2].copy_from_slice(&flat);
        (value, gradient)
    }
}

#[cfg(test)]
mod tests {
    use super::Gradient;
    use crate::{Constant, Field, FieldExt as _, Fractal, FractalShape};

    /// A 3-D sum of waves with exact derivatives.
    #[derive(Clone, Copy)]
    struct Waves;

    impl Field<3> for Waves {
        fn value(&self, [x, y, z]: [f64; 3]) -> f32 {
            (libm::sin(x) * libm::cos(2.0 * y) + 0.5 * libm::sin(z)) as f32
        }
    }

    impl Gradient<3> for Waves {
        fn value_and_gradient(&self, [x, y, z]: [f64; 3]) -> (f32, [f32; 3]) {
            let gradient = [
                libm::cos(x) * libm::cos(2.0 * y),
                -2.0 * libm::sin(x) * libm::sin(2.0 * y),
                0.5 * libm::cos(z),
            ];
            (self.value([x, y, z]), gradient.map(|part| part as f32))
        }
    }

    /// Compares gradients with finite differences at several positions.
    fn check<const N: usize>(name: &str, field: &dyn Gradient<N>) {
        const STEP: f64 = 1.0 / 256.0;
        for index in 0..40 {
            let position: [f64; N] =
                core::array::from_fn(|axis| 0.37 * f64::from(index) + 0.61 * axis as f64 - 3.0);
            let (value, gradient) = field.value_and_gradient(position);
            assert_eq!(value.to_bits(), field.value(position).to_bits(), "{name}");
            for axis in 0..N {
                let at = |step: f64| {
                    let mut moved = position;
                    moved[axis] += step;
                    f64::from(field.value(moved))
                };
                let difference = (at(STEP) - at(-STEP)) / (2.0 * STEP);
                // Values are rounded to 2^-22 here, and third derivatives are below 500.
                let error = (f64::from(gradient[axis]) - difference).abs();
                assert!(
                    error < 2e-3,
                    "{name} along {axis} at {position:?}: {} and {difference}",
                    gradient[axis]
                );
            }
        }
    }

    #[test]
    fn gradients_of_compositions_are_those_of_differences() {
        let other = Waves.offset([1.0, -2.0, 0.3]);
        check("frequency", &Waves.frequency_per_axis([1.5, 0.3, -2.0]));
        check("offset", &other);
        check("rotate", &Waves.rotate(0.7));
        check(
            "warp",
            &Waves.warp((other, Constant(0.25), Waves.frequency(0.5)), 0.3),
        );
        check("warp of one type", &Waves.warp([other; 3], 0.3));
        check("remap", &Waves.remap([-1.0, 1.0], [3.0, 7.0]).unwrap());
        check("add", &Waves.add(other));
        check("sub", &Waves.sub(other));
        check("mul", &Waves.mul(other));
        check(
            "mix",
            &Waves.mix(other, Waves.frequency(0.3).mul(0.5).add(0.25)),
        );
        check("slice", &Waves.slice([0.7]));
        check(
            "extrude",
            &<_ as crate::FieldExt<2>>::extrude(Waves.slice([0.7])).mul(Waves),
        );
        let fractal = Fractal::new([Waves; 3], 0.5, 1.5, FractalShape::Sum).unwrap();
        check("fractal", &fractal);
    }

    #[test]
    fn gradients_beside_creases_are_those_of_one_side() {
        let slope = |number: f32| Waves.mul(number);
        for (name, field) in [
            ("min", slope(1.0).min(slope(-1.0))),
            ("max", slope(1.0).max(slope(-1.0))),
        ] {
            for at in [[0.5, 0.1, 0.2], [-0.5, 0.1, -0.2]] {
                let sign = if (Waves.value(at) > 0.0) == (name == "max") {
                    1.0
                } else {
                    -1.0
                };
                let expected = Waves.value_and_gradient(at).1.map(|part| sign * part);
                assert_eq!(field.value_and_gradient(at).1, expected, "{name}");
            }
        }
        for (shape, sign) in [(FractalShape::Ridged, -1.0), (FractalShape::Billow, 1.0)] {
            let field = Fractal::new([Waves], 0.5, 2.0, shape).unwrap();
            for at in [[0.5, 0.1, 0.2], [-0.5, 0.1, -0.2]] {
                let sign = if Waves.value(at) < 0.0 { -sign } else { sign };
                let expected = Waves.value_and_gradient(at).1.map(|part| sign * part);
                assert_eq!(field.value_and_gradient(at).1, expected, "{shape:?}");
            }
        }
    }
}
